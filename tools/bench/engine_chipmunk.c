/* SPDX-License-Identifier: MIT */
/* A sheet of Chipmunk's bodies and damped springs, in two dimensions. The force of a link is the same as in the
   library, with one iteration of the solver per step. Bodies have no shapes, so nothing collides. */
#define _XOPEN_SOURCE 700 /* POSIX 2008: dup() */
#include "engine.h"

#include <chipmunk/chipmunk.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

typedef struct world {
    cpSpace *space;
    cpBody *body[]; /* [particles] */
} world;

/* A build of Chipmunk with assertions, such as Debian's, prints a note on standard output when it creates its first
   space. Returns true if it did. The note is discarded, because the table is written to standard output. */
static bool first_space_reports(void)
{
    FILE *report = tmpfile();
    if (report == NULL)
        return false;
    fflush(stdout);
    const int kept = dup(STDOUT_FILENO);
    dup2(fileno(report), STDOUT_FILENO);
    cpSpaceFree(cpSpaceNew());
    fflush(stdout);
    dup2(kept, STDOUT_FILENO);
    close(kept);
    const bool reported = fseek(report, 0, SEEK_END) == 0 && ftell(report) > 0;
    fclose(report);
    return reported;
}

static const char *version(void)
{
    static char text[64];
    snprintf(text, sizeof text, "%s%s", cpVersionString, first_space_reports() ? ", with assertions" : "");
    return text;
}

static void *make(const spring_scene_def *def)
{
    world *w = malloc(sizeof *w + def->particles * sizeof w->body[0]);
    if (w == NULL)
        return NULL;
    w->space = cpSpaceNew();
    cpSpaceSetIterations(w->space, 1);
    cpSpaceSetGravity(w->space, cpv(def->gravity[0], def->gravity[1]));
    for (size_t i = 0; i < def->particles; i++) {
        w->body[i] = def->pinned[i] != 0 ? cpBodyNewStatic() : cpBodyNew(def->mass_all, (cpFloat)INFINITY);
        cpBodySetPosition(w->body[i], cpv(def->position[2 * i], def->position[2 * i + 1]));
        cpSpaceAddBody(w->space, w->body[i]);
    }
    for (const spring_link *link = def->link; link < def->link + def->links; link++)
        cpSpaceAddConstraint(w->space, cpDampedSpringNew(w->body[link->a], w->body[link->b], cpvzero, cpvzero,
                                                         link->rest, link->stiffness, link->damping));
    return w;
}

static void step(void *of, double dt)
{
    const world *w = of;
    cpSpaceStep(w->space, dt);
}

static void position(const void *of, size_t particle, double *x)
{
    const world *w = of;
    const cpVect at = cpBodyGetPosition(w->body[particle]);
    x[0] = at.x;
    x[1] = at.y;
}

const physics_engine engine_chipmunk = {
    .name = "chipmunk",
    .precision = sizeof(cpFloat) == sizeof(float) ? "float" : "double",
    .version = version,
    .axes = 2,
    .make = make,
    .step = step,
    .position = position,
};
