/* SPDX-License-Identifier: MIT */
/* Advances the springs of standard input and writes their states, for tests/js: the JavaScript package must give
   bit-identical results. Numbers are doubles in the byte order of the machine.
       js_states single    records of one spring, struct single; after each step its status, x and v
       js_states steer     records of one spring whose target moves, and whose parameters change, struct steer; as single
       js_states settling  settling time, damping ratio, tolerance; stiffness and damping for mass 1
       js_states set       records of springs with shared parameters, struct set; x, v, number of moving springs, status
   A single spring at rest on its target is not advanced, because backwards it could get a velocity of -0. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include <springstep/batch.h>

enum { steps = 4, steered = 30, springs = 64 };

/* Half of the steps go to each target. */
struct single {
    double mass, stiffness, damping, x, v, target[2], dt[steps];
};

/* The second parameters are those of the second half of the steps. */
struct steer {
    double mass[2], stiffness[2], damping[2], x, v, target[steered], speed[steered], dt[steered];
};

struct set {
    double mass, stiffness, damping, dt, x_tol, v_tol, x[springs], v[springs], target[springs], speed[springs];
};

static bool single(const struct single *r)
{
    const spring_params p = {r->mass, r->stiffness, r->damping, 0};
    spring_state s = {r->x, r->v};
    double out[steps][3];
    for (int i = 0; i < steps; i++) {
        const double target = r->target[i * 2 / steps];
        const bool rests = s.x == target && s.v == 0;
        out[i][0] = spring_follow(&s, &p, target, 0, rests ? 0 : r->dt[i]);
        if (s.x == target && s.v == 0)
            s.v = 0; /* not -0 */
        out[i][1] = s.x;
        out[i][2] = s.v;
    }
    return fwrite(out, sizeof out, 1, stdout) == 1;
}

static bool steer(const struct steer *r)
{
    spring_state s = {r->x, r->v};
    double out[steered][3];
    for (int i = 0; i < steered; i++) {
        const int half = 2 * i / steered;
        const spring_params p = {r->mass[half], r->stiffness[half], r->damping[half], 0};
        const bool rests = s.x == r->target[i] && s.v == 0 && r->speed[i] == 0;
        out[i][0] = spring_follow(&s, &p, r->target[i], r->speed[i], rests ? 0 : r->dt[i]);
        if (s.v == 0)
            s.v = 0; /* not -0 */
        out[i][1] = s.x;
        out[i][2] = s.v;
    }
    return fwrite(out, sizeof out, 1, stdout) == 1;
}

static bool settling(const double r[3])
{
    const spring_params p = spring_params_settling(r[0], r[1], r[2]);
    const double out[] = {p.stiffness, p.damping};
    return fwrite(out, sizeof out, 1, stdout) == 1;
}

/* A batch, or for a mass other than 1, whose quotients a batch does not know, single springs. */
static spring_status advance_set(struct set *r, size_t *moving)
{
    *moving = 0;
    if (r->mass == 1) {
        const spring_batch batch = {.count = springs,
                                    .x = r->x,
                                    .v = r->v,
                                    .omega2 = &r->stiffness,
                                    .gamma = &r->damping,
                                    .shared = SPRING_SHARED_OMEGA2 | SPRING_SHARED_GAMMA};
        return spring_batch_follow_moving(&batch, r->target, r->speed, r->dt, r->x_tol, r->v_tol, moving);
    }
    spring_status status = SPRING_OK;
    const spring_params p = {r->mass, r->stiffness, r->damping, 0};
    for (int i = 0; i < springs; i++) {
        spring_state s = {r->x[i], r->v[i]};
        const spring_status one = spring_follow(&s, &p, r->target[i], r->speed[i], r->dt);
        const double u = s.v - r->speed[i];
        const bool near = fabs(s.x - r->target[i]) <= r->x_tol && fabs(u) <= r->v_tol, rests = near && r->speed[i] == 0;
        if (one == SPRING_OK && near && r->dt != 0)
            s = (spring_state){r->target[i], r->speed[i]};
        r->x[i] = s.x;
        r->v[i] = s.v;
        *moving += one != SPRING_OK || !(rests || (s.x == r->target[i] && s.v == 0 && r->speed[i] == 0));
        status = one != SPRING_OK && r->dt != 0 ? one : status; /* as a batch */
    }
    return status;
}

static bool set(struct set *r)
{
    size_t moving;
    const double status = advance_set(r, &moving), result[] = {(double)moving, status};
    return fwrite(r->x, sizeof r->x, 1, stdout) == 1 && fwrite(r->v, sizeof r->v, 1, stdout) == 1 &&
           fwrite(result, sizeof result, 1, stdout) == 1;
}

int main(int argc, char **argv)
{
    bool good = argc == 2;
    if (good && strcmp(argv[1], "single") == 0) {
        struct single r;
        while (good && fread(&r, sizeof r, 1, stdin) == 1)
            good = single(&r);
    } else if (good && strcmp(argv[1], "steer") == 0) {
        struct steer r;
        while (good && fread(&r, sizeof r, 1, stdin) == 1)
            good = steer(&r);
    } else if (good && strcmp(argv[1], "settling") == 0) {
        double r[3];
        while (good && fread(r, sizeof r, 1, stdin) == 1)
            good = settling(r);
    } else if (good) {
        struct set r;
        while (good && fread(&r, sizeof r, 1, stdin) == 1)
            good = set(&r);
    }
    return good && fflush(stdout) == 0 ? 0 : 1;
}
