/* SPDX-License-Identifier: MIT */
/* The stack that the functions of a scene need, as scene.h states it: each runs in a thread whose stack was filled with a
   pattern before. */
#define _XOPEN_SOURCE 600
#include <pthread.h>

#include "test_scene.h"

enum { size_of_stack = 1 << 18, allowed = 16 << 10, pattern = 0xA5 };

typedef struct sheet {
    model m;
    spring_scene *scene;
    const scene_kernels *kernels;
    spring_method method;
    double dt;
} sheet;

typedef void use(sheet *s);

typedef struct job {
    use *use;
    sheet *s;
    unsigned char *start;
} job;

static void *run(void *job_of_thread)
{
    job *const j = job_of_thread;
    unsigned char here = pattern;
    j->start = &here;
    j->use(j->s);
    return NULL;
}

/* The bytes of the stack below run() that are written, at least those that the end of a thread needs. */
static size_t stack_of(use *f, sheet *s)
{
    unsigned char *const stack = aligned_alloc(4096, size_of_stack);
    memset(stack, pattern, size_of_stack);
    pthread_attr_t attributes;
    pthread_t thread;
    job j = {f, s, stack};
    CHECK(pthread_attr_init(&attributes) == 0 && pthread_attr_setstack(&attributes, stack, size_of_stack) == 0 &&
              pthread_create(&thread, &attributes, run, &j) == 0 && pthread_join(thread, NULL) == 0,
          "a thread with this stack");
    pthread_attr_destroy(&attributes);
    size_t unchanged = 0;
    while (unchanged < size_of_stack && stack[unchanged] == pattern)
        unchanged++;
    const size_t written = (size_t)(j.start - stack) - unchanged;
    free(stack);
    return written;
}

static spring_status outcome; /* of the last call; CHECK() has a stack of its own */

static void fill_all(sheet *s)
{
    volatile char some[allowed];
    for (size_t i = 0; i < sizeof some; i++)
        some[i] = (char)s->method;
}

static void advance(sheet *s)
{
    outcome = spring_scene_advance_with(s->kernels, s->scene, s->method, s->dt, 4);
}

static void tear(sheet *s)
{
    outcome = spring_scene_tear(s->scene, 1.001, NULL, NULL, 0, NULL);
}

static void query(sheet *s)
{
    spring_scene_stable_step(s->scene, s->method);
    spring_scene_at_rest(s->scene, 1, 1);
    outcome = spring_scene_energy(s->scene).kinetic >= 0 ? SPRING_OK : SPRING_EINVAL;
}

static void define(sheet *s)
{
    size_t bytes;
    outcome = spring_scene_bytes(&s->m.def, &bytes);
    if (outcome == SPRING_OK)
        outcome = spring_scene_init(s->scene, bytes, &s->m.def, &s->scene);
}

static void soften(sheet *s)
{
    static spring_link soft[most_links];
    outcome = spring_links_soften(&s->m.def, 0.1, 0.5, soft);
}

static void renumber(sheet *s)
{
    static spring_link link[most_links];
    static uint32_t order[most], work[4 * most + 2 * most_links + 1];
    memcpy(link, s->m.link, s->m.def.links * sizeof *link);
    outcome = spring_links_renumber(s->m.def.particles, s->m.def.links, link, order, NULL, work);
}

static void check_call(use *f, sheet *s, const char *what)
{
    CHECK_CLOSE((double)stack_of(f, s), 0, allowed, what);
    CHECK(outcome == SPRING_OK, what);
}

static void test_stack(void)
{
    static sheet s;
    CHECK(stack_of(fill_all, &s) > allowed, "a function that needs more is noticed");
    for (unsigned variant = 0; variant < 4; variant++) {
        const unsigned features = OWN | DAMPED | MASSES | PINNED | DRAG | GRAVITY | EDITABLE |
                                  (variant & 1 ? STRAY : 0) | (variant & 2 ? SHUFFLED : 0);
        build(&s.m, (const uint32_t[]){20, 20, 1}, 3, features);
        s.m.def.particle_radius = 0.1;
        s.m.def.colliders = most_colliders;
        spring_collider c[most_colliders];
        for (size_t i = 0; i < most_colliders; i++)
            c[i] = (spring_collider){
                .shape = (spring_shape)(i % shape_count),
                .at = {random_uniform(0, 14), random_uniform(0, 14), -1.2},
                .to = {random_uniform(0, 14), random_uniform(0, 14), -1},
                .axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                .half = {1, 1, 1},
                .radius = 1,
                .friction = 0.5,
                .spin = {0, 0, 1},
            };
        s.scene = scene_of(&s.m.def);
        check_call(query, &s, "queries");
        for (int k = 0; k < kernel_count; k++) {
            s.kernels = kernels_of(k);
            if (s.kernels == NULL || s.kernels == &plain_scene)
                continue;
            const method_list list = methods_of(s.m.def);
            for (const spring_method *m = list.at; *m != no_method; m++) {
                s.method = *m;
                for (double dt = 1e-4; dt < 1; dt *= 300) { /* the longer one: beyond the limit of explicit damping */
                    s.dt = dt;
                    define(&s);
                    CHECK(spring_scene_set_colliders(s.scene, c, most_colliders) == SPRING_OK, "colliders");
                    if (*m != SPRING_EULER && (dt < 0.01 || *m == SPRING_LEAPFROG)) /* no colliders with Euler */
                        check_call(advance, &s, spring_method_name(*m));
                }
            }
        }
        check_call(tear, &s, "tear");
        check_call(define, &s, "a definition");
        check_call(soften, &s, "soften");
        check_call(renumber, &s, "renumber");
        free(s.scene);
    }
}

int main(void)
{
    static const test tests[] = {{"no function needs more stack than scene.h states", test_stack}};
    return RUN_TESTS("stack of scenes", tests);
}
