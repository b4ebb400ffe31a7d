/* SPDX-License-Identifier: MIT */
/*
 * A hundred thousand blades of grass in single precision, bent by a gust that crosses the field: a time-dependent load.
 *
 *     cc -std=c11 -O2 grass.c -lspringstep -lm -o grass
 *
 * Each blade has its own stiffness; all share one damping. Before each step, the load is set to its value at the middle
 * of the step, which keeps leapfrog second order.
 */
#include <springstep/batch.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { BLADES = 100000 };
static const float field = 100;        /* [m]; blade i stands at field * i / BLADES */
static const float gust_speed = 8;     /* [m/s] */
static const float gust_length = 5;    /* [m] */
static const float gust_strength = 40; /* [m/s^2] on the tip of a blade */
static const double dt = 1.0 / 120;    /* [s] */

static float place(int i)
{
    return field * (float)i / BLADES;
}

/* A bump centred at gust_speed * t. It has finite length, so most blades need no arithmetic. */
static void blow(float *accel, double t)
{
    const float top = (float)(gust_speed * t);
    for (int i = 0; i < BLADES; i++) {
        const float d = (place(i) - top) / gust_length;
        const float h = 1 - d * d;
        accel[i] = h > 0 ? gust_strength * h * h : 0;
    }
}

int main(void)
{
    float *memory = malloc(4 * BLADES * sizeof *memory);
    if (memory == NULL)
        return 1;
    float *tip = memory, *v = tip + BLADES, *omega2 = v + BLADES, *accel = omega2 + BLADES;
    uint32_t random = 1;
    for (int i = 0; i < BLADES; i++) {
        random = random * 1664525 + 1013904223;                             /* Numerical Recipes */
        const float hertz = 1.5f + (float)(random >> 8) / (float)(1 << 24); /* 1.5 ... 2.5 Hz */
        tip[i] = v[i] = 0;
        omega2[i] = (6.2831853f * hertz) * (6.2831853f * hertz);
    }
    const float gamma = 5; /* [1/s]: a fifth of critical damping */
    const spring_batchf grass = {.count = BLADES,
                                 .x = tip,
                                 .v = v,
                                 .omega2 = omega2,
                                 .gamma = &gamma,
                                 .accel = accel,
                                 .shared = SPRING_SHARED_GAMMA};
    if (!(dt < spring_batchf_stable_step(&grass, SPRING_LEAPFROG)))
        return 1;
    for (int step = 0; step < 1200; step++) {
        blow(accel, (step + 0.5) * dt);
        if (spring_batchf_advance(&grass, SPRING_LEAPFROG, dt, 1) != SPRING_OK)
            return 1;
        if ((step + 1) % 120 != 0)
            continue;
        int most = 0;
        double sum = 0, sum_place = 0; /* mean position of the bent grass */
        for (int i = 0; i < BLADES; i++) {
            if (tip[i] > tip[most])
                most = i;
            sum += tip[i];
            sum_place += tip[i] * place(i);
        }
        const double t = (step + 1) * dt;
        printf("%4.1f s  gust at %6.2f m  grass bent around %6.2f m  most %.3f m  at the far end %.6f m\n", t,
               gust_speed * t, sum_place / sum, (double)tip[most], (double)tip[BLADES - 1]);
    }
    free(memory);
    return 0;
}
