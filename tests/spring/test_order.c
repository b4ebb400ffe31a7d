/* SPDX-License-Identifier: MIT */
/* Order and error constant of each method, in position and velocity, undamped, damped, overdamped and loaded. */
#include <math.h>

#include "check.h"
#include "harness/reference.h"
#include "test_methods.h"

typedef struct matrix {
    double a[2][2];
} matrix;

static matrix sum(matrix p, double factor, matrix q) /* p + factor q */
{
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            p.a[i][j] += factor * q.a[i][j];
    return p;
}

static matrix product(matrix p, matrix q)
{
    matrix r;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            r.a[i][j] = p.a[i][0] * q.a[0][j] + p.a[i][1] * q.a[1][j];
    return r;
}

typedef struct problem {
    spring_params p;
    spring_state start;
    double duration; /* [s] */
} problem;

static const problem problems[] = {
    {{1.3, 2.7, 0, 0}, {0.8, -0.9}, 2.3},    {{1.3, 2.7, 0.6, 0}, {0.8, -0.9}, 2.3},
    {{1.3, 2.7, 9.1, 0}, {-0.8, 1.9}, 1.7},  {{0.7, 1.9, 0.6, 1.4}, {0.8, 0.9}, 2.3},
    {{0.7, 1.9, 0, -0.8}, {-0.3, 0.9}, 1.1},
};
static const size_t problem_count = sizeof problems / sizeof problems[0];

static int order_of(spring_method m)
{
    return spring_method_describe(m)->order;
}

/* So many that the next order, a power of h smaller, is not seen, and that rounding is not either. */
static uint64_t steps_for(spring_method m)
{
    return 51200 / (uint64_t)pow(order_of(m), 3);
}

/* What one step's matrix lacks of exp(h A), divided by h^(order+1), as h -> 0: of the reference solutions in multiple
   precision, from two basis states of a spring of 1 kg, so that they agree on w and g. */
static matrix local_error(spring_method m, double w, double g)
{
    const int exponent = -30; /* relative error 2^-30 times a rate in 1/s */
    const double h = ldexp(1, exponent);
    const spring_params p = {1, w, g, 0};
    reference step, solution;
    matrix L;
    reference_init(&step);
    reference_init(&solution);
    for (int j = 0; j < 2; j++) {
        const spring_state basis = {j == 0, j == 1};
        reference_start(&step, &p, basis);
        reference_start(&solution, &p, basis);
        reference_iterate(&step, &p, m, h, 1);
        reference_exact(&solution, &p, h);
        mpfr_sub(step.x, step.x, solution.x, MPFR_RNDN);
        mpfr_sub(step.v, step.v, solution.v, MPFR_RNDN);
        L.a[0][j] = ldexp(mpfr_get_d(step.x, MPFR_RNDN), -exponent * (order_of(m) + 1));
        L.a[1][j] = ldexp(mpfr_get_d(step.v, MPFR_RNDN), -exponent * (order_of(m) + 1));
    }
    reference_clear(&step);
    reference_clear(&solution);
    return L;
}

/* Phi(t) as a matrix, from the exact solution of two unloaded basis states. */
static matrix propagator(const spring_params *p, double t)
{
    const spring_params unloaded = {p->mass, p->stiffness, p->damping, 0};
    spring_state x = {1, 0}, v = {0, 1};
    spring_step_exact(&x, &unloaded, t);
    spring_step_exact(&v, &unloaded, t);
    return (matrix){{{x.x, v.x}, {x.v, v.v}}};
}

/* The leading error h^order times this: the integral over s of Phi(T - s) L Phi(s) (y0 - rest), by Simpson's rule. */
static spring_state error_constant(const problem *q, spring_method m)
{
    const int panels = 200; /* relative error 1e-9 for these smooth integrands */
    const matrix L = local_error(m, q->p.stiffness / q->p.mass, q->p.damping / q->p.mass);
    matrix all = {{{0, 0}, {0, 0}}};
    for (int i = 0; i <= panels; i++) {
        const double s = q->duration * i / panels;
        const double weight = (i == 0 || i == panels ? 1 : 2 + 2 * (i % 2)) * q->duration / panels / 3;
        all = sum(all, weight, product(propagator(&q->p, q->duration - s), product(L, propagator(&q->p, s))));
    }
    const double x = q->start.x - q->p.load / q->p.stiffness, v = q->start.v;
    return (spring_state){all.a[0][0] * x + all.a[0][1] * v, all.a[1][0] * x + all.a[1][1] * v};
}

static spring_state measured_error(const problem *q, spring_method m, uint64_t n)
{
    spring_state got = q->start, want = q->start;
    spring_advance(&got, &q->p, m, q->duration / (double)n, n);
    spring_step_exact(&want, &q->p, q->duration);
    return (spring_state){got.x - want.x, got.v - want.v};
}

static void constants(void)
{
    for (size_t i = 0; i < problem_count; i++)
        for (const spring_method *m = steppers(); *m != no_method; m++) {
            const problem *q = &problems[i];
            const uint64_t n = steps_for(*m);
            const double h = q->duration / (double)n, scale = pow(h, order_of(*m));
            const spring_state want = error_constant(q, *m);
            const spring_state got = measured_error(q, *m, n);
            const double size = hypot(want.x, want.v);
            CHECK_CLOSE(got.x / scale, want.x, 0.02 * size, "the next order is O(h), below 2 % here");
            CHECK_CLOSE(got.v / scale, want.v, 0.02 * size, "the next order is O(h), below 2 % here");
        }
}

static void slopes(void)
{
    for (size_t i = 0; i < problem_count; i++)
        for (const spring_method *m = steppers(); *m != no_method; m++) {
            const uint64_t coarse = steps_for(*m) / 2;
            double sx = 0, sy = 0, sxx = 0, sxy = 0;
            const int points = 5;
            for (int j = 0; j < points; j++) {
                const uint64_t n = coarse + coarse * (uint64_t)j / 2;
                const spring_state e = measured_error(&problems[i], *m, n);
                const double lx = log((double)n), ly = log(hypot(e.x, e.v));
                sx += lx, sy += ly, sxx += lx * lx, sxy += lx * ly;
            }
            const double slope = (points * sxy - sx * sy) / (points * sxx - sx * sx);
            CHECK_CLOSE(slope, -order_of(*m), 0.02, "least squares over a factor of 3 in n");
        }
}

/* What textbooks say of the spring of the original study. */
static void textbook_constants(void)
{
    const problem original = {{1, 1, 0, 0}, {1, 0}, 1};
    const struct {
        spring_method method;
        double constant;
    } want[] = {{SPRING_EULER, cos(1) / 2}, {SPRING_LEAPFROG, sin(1) / 24}, {SPRING_RK4, sin(1) / 120}};
    for (size_t i = 0; i < sizeof want / sizeof want[0]; i++)
        CHECK_CLOSE(fabs(error_constant(&original, want[i].method).x), want[i].constant, 1e-8 * want[i].constant,
                    "textbook value; the step of the reference is 2^-30 s");
}

/* A drive cos(2 t) sampled once a step: at the start of the step order 1, in the middle order 2, if the method has
   it. */
static void sampled_load(void)
{
    const spring_params p = {.mass = 1.3, .stiffness = 2.7};
    const double drive = 2.0, amplitude = 0.7, duration = 3, w = p.stiffness / p.mass, omega = sqrt(w);
    /* x'' + w x = (F/m) cos(drive t) from (x0, v0) = (0.4, 0.3) */
    const double A = amplitude / p.mass / (w - drive * drive);
    const double want =
        A * cos(drive * duration) + (0.4 - A) * cos(omega * duration) + 0.3 / omega * sin(omega * duration);
    for (const spring_method *m = spring_methods(); *m != no_method; m++)
        for (int middle = 0; middle <= 1; middle++) {
            double error[2];
            for (int j = 0; j < 2; j++) {
                const int n = j == 0 ? 2000 : 4000;
                const double dt = duration / n;
                spring_state s = {0.4, 0.3};
                for (int i = 0; i < n; i++) {
                    spring_params now = p;
                    now.load = amplitude * cos(drive * ((i + 0.5 * middle) * dt));
                    spring_advance(&s, &now, *m, dt, 1);
                }
                error[j] = s.x - want;
            }
            CHECK_CLOSE(log2(error[0] / error[1]), middle && order_of(*m) != 1 ? 2 : 1, 0.02,
                        "the load is constant over each step");
        }
}

int main(void)
{
    static const test tests[] = {
        {"error constants", constants},
        {"slopes", slopes},
        {"textbook constants", textbook_constants},
        {"a load sampled once a step", sampled_load},
    };
    return RUN_TESTS("order", tests);
}
