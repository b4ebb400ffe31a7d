/* SPDX-License-Identifier: MIT */
/*
 * The error of n steps of a method on a linear spring, for the worst start, and the number of steps for a given error.
 *
 * Method    On (x, v/Omega) a step is a matrix R, and the exact solution over a step is F = e^Z, so
 *
 *               E(n) = max over i <= n of |R^i - F^i|, the spectral norm.
 *
 *           R - F is a power series in the step whose terms up to the order cancel exactly, so it is summed without
 *           them. The advance F^i - 1 and the error R^i - F^i are carried from i to i + k steps without cancellation:
 *
 *               R^(i+k) - F^(i+k) = R^i (R^k - F^k) + (R^i - F^i) F^k
 *
 *           If there are few steps, the maximum is searched at every i. If there are few periods, it is searched at
 *           enough times of each period. Otherwise it is searched at times in geometric progression, each over all
 *           phases of the oscillation (envelope_at()). The result is never below the error, and above it by a few
 *           percent.
 * Search    E follows a power law for small steps. With implicit damping, large steps may skip a fast decay and be more
 *           accurate than small ones (symplectic Euler with heavy damping). So the search starts with a step that is
 *           short compared with every time scale, and enlarges it until the error exceeds the tolerance: by 5 % at a
 *           time where the power law does not hold.
 * Rounding  n steps add about sqrt(n) eps. More than 2^53 steps are never accurate enough.
 * Accuracy  E within 0.999 ... 1.05 of the largest error of a run in multiple precision while it is below 0.5
 *           (tests/spring/test_accurate_step.c)
 * Source    Golub, Van Loan, Matrix Computations (2013), section 9.3 (the exponential by scaling and squaring);
 *           Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section II.3 (how errors add up)
 */
#include "accuracy.h"
#include "roots.h"

#include "../simd/size_begin.h"

static const spring_matrix matrix_identity = {1, 0, 0, 1};

/* i steps: F^i - 1 and R^i - F^i. */
typedef struct step_run {
    spring_matrix advance, error;
} step_run;

static spring_matrix matrix_plus(spring_matrix p, spring_matrix q)
{
    return matrix_sum(p, 1, q);
}

/* The matrix as the map z -> p z + q conj(z) of complex numbers z = x + i v/Omega. Its spectral norm is |p| + |q|. */
typedef struct turn_pair {
    double p[2], q[2];
} turn_pair;

static turn_pair turn_pair_of(spring_matrix m)
{
    return (turn_pair){{(m.xx + m.vv) / 2, (m.vx - m.xv) / 2}, {(m.xx - m.vv) / 2, (m.vx + m.xv) / 2}};
}

static double matrix_norm(spring_matrix m)
{
    const turn_pair t = turn_pair_of(m);
    const double p = t.p[0] * t.p[0] + t.p[1] * t.p[1], q = t.q[0] * t.q[0] + t.q[1] * t.q[1];
    return spring_sqrt(p) + spring_sqrt(q);
}

/* The run of i + k steps, from the runs of i and of k steps. */
static step_run runs_joined(step_run i, step_run k)
{
    const spring_matrix step = matrix_plus(i.advance, i.error);
    return (step_run){
        matrix_plus(matrix_plus(i.advance, k.advance), matrix_product(i.advance, k.advance)),
        matrix_plus(matrix_plus(k.error, matrix_product(step, k.error)),
                    matrix_plus(i.error, matrix_product(i.error, k.advance))),
    };
}

/* -------------------------------------------------------------------------------------------------------- one step */

static step_rates rates_of_step(const accuracy *of, double steps)
{
    return (step_rates){of->whole.a / steps, of->whole.c / steps, of->whole.G / steps};
}

/* Up to this size of Z the power series are summed. */
static const double series_limit = 1;

/* The first omitted term is 1/22! of the sum. */
enum { SERIES_TERMS = 22 };

static double rates_size(step_rates r)
{
    return fmax(r.a, r.G);
}

/* e^Z - 1: the series of Z/2^k, and (1 + P)^2 - 1 = 2 P + P^2, k times. */
static spring_matrix exact_advance(step_rates r)
{
    int halvings = 0;
    for (; rates_size(r) > series_limit; halvings++)
        r = (step_rates){r.a / 2, r.c / 2, r.G / 2};
    const spring_matrix Z = matrix_of(r);
    spring_matrix power = Z, sum = Z;
    for (int k = 2; k < SERIES_TERMS; k++) {
        power = next_power(power, Z, k);
        sum = matrix_plus(sum, power);
    }
    for (; halvings > 0; halvings--)
        sum = matrix_plus(matrix_plus(sum, sum), matrix_product(sum, sum));
    return sum;
}

/* R - F by the series; with q = implicit G
       (1 + q) (R - F) = sum over k > order of term[k] - Z^k/k! - q Z^(k-1)/(k-1)! */
static spring_matrix short_error(const step_terms *t, step_rates r, int order)
{
    const spring_matrix Z = matrix_of(r);
    const double q = t->implicit * r.G;
    spring_matrix power = matrix_identity, sum = {0};
    for (int k = 1; k < SERIES_TERMS; k++) {
        const spring_matrix before = power;
        power = next_power(power, Z, k);
        if (k <= order)
            continue;
        const spring_matrix exact = matrix_sum(power, q, before);
        sum = matrix_plus(sum, k < STEP_TERMS ? matrix_sum(t->term[k], -1, exact)
                                              : matrix_sum((spring_matrix){0}, -1, exact));
    }
    return matrix_sum((spring_matrix){0}, 1 / (1 + q), sum);
}

/* R - F = (R - 1) - (F - 1) */
static spring_matrix long_error(const step_terms *t, step_rates r, spring_matrix advance)
{
    const double q = t->implicit * r.G;
    spring_matrix sum = matrix_sum(t->term[1], -q, matrix_identity);
    for (int k = 2; k < STEP_TERMS; k++)
        sum = matrix_plus(sum, t->term[k]);
    return matrix_sum(matrix_sum((spring_matrix){0}, 1 / (1 + q), sum), -1, advance);
}

static step_run run_of_one_step(const accuracy *of, step_rates r)
{
    const step_terms t = of->terms(r);
    const spring_matrix advance = exact_advance(r);
    return (step_run){advance,
                      rates_size(r) <= series_limit ? short_error(&t, r, of->order) : long_error(&t, r, advance)};
}

/* ---------------------------------------------------------------------------------------- the phase of oscillations */

/* The part of a step without trace, divided by its imaginary eigenvalue: J of e^(angle J), J^2 = -1. */
typedef struct phase_rotation {
    bool turns;               /* both the steps and the exact solution oscillate */
    spring_matrix exact;      /* J of F */
    spring_matrix difference; /* J of R minus J of F */
} phase_rotation;

static spring_matrix matrix_without_trace(spring_matrix m)
{
    const double p = (m.xx - m.vv) / 2;
    return (spring_matrix){p, m.xv, m.vx, -p};
}

/* With F' and R' = F' + D' the parts without trace and s the eigenvalues,
       J_R - J_F = D'/s_R + F' (1/s_R - 1/s_F),   s_R^2 - s_F^2 = det D' + the part of det(F' + D') of first order
   F'xx, from damping, is omitted. With light damping, it changes the relevant difference by a few parts in a thousand.
   With heavier damping, the largest error comes in the first periods, where this is not used. */
static phase_rotation phase_rotation_of(step_run step)
{
    const spring_matrix F = matrix_without_trace(step.advance), D = matrix_without_trace(step.error);
    const double square = -F.xv * F.vx, more = -(F.xv * D.vx + D.xv * F.vx + D.xx * D.xx + D.xv * D.vx);
    const double exact = spring_sqrt(square), steps = spring_sqrt(square + more);
    if (!(exact * steps > 0))
        return (phase_rotation){0};
    const spring_matrix zero = {0};
    const double change = -more / (exact * steps * (exact + steps));
    return (phase_rotation){true, matrix_sum(zero, 1 / exact, F),
                            matrix_sum(matrix_sum(zero, 1 / steps, D), change, F)};
}

/* The largest |c cos t + s sin t| over t. */
static double largest_semiaxis(const double c[2], const double s[2])
{
    const double cc = c[0] * c[0] + c[1] * c[1], ss = s[0] * s[0] + s[1] * s[1], cs = c[0] * s[0] + c[1] * s[1];
    return spring_sqrt((cc + ss + spring_hypot(fabs(cc - ss), 2 * fabs(cs))) / 2);
}

/* The largest |R^i e^(t J_R) - F^i e^(t J_F)| over the phase t, or a little more: both terms of the norm are treated as
   largest at the same phase. */
static double envelope_at(step_run i, const phase_rotation *j)
{
    if (!j->turns)
        return matrix_norm(i.error);
    const spring_matrix R = matrix_plus(matrix_identity, matrix_plus(i.advance, i.error));
    const spring_matrix sine = matrix_plus(matrix_product(i.error, j->exact), matrix_product(R, j->difference));
    const turn_pair c = turn_pair_of(i.error), s = turn_pair_of(sine);
    return largest_semiaxis(c.p, s.p) + largest_semiaxis(c.q, s.q);
}

/* ------------------------------------------------------------------------------------------------ the largest error */

/* The largest value of a smooth function between ordered samples: the maximum of the parabola through three samples of
   which the middle one is largest, and through the last three, if it lies between them. */
typedef struct error_peak {
    double t[2], value[2]; /* the last two, newest first */
    double most;
} error_peak;

static void error_peak_add(error_peak *p, double t, double value, bool last)
{
    const bool middle = p->value[0] >= p->value[1] && p->value[0] > value;
    if (middle || (last && value >= p->value[0] && p->value[0] > p->value[1])) {
        const double before = p->t[0] - p->t[1], after = t - p->t[0];
        const double rise = (p->value[0] - p->value[1]) / before, fall = (p->value[0] - value) / after;
        const double curve = (rise + fall) / (before + after),
                     derivative = (rise * after - fall * before) / (before + after);
        if (middle || derivative < 2 * curve * after)
            p->most = fmax(p->most, p->value[0] + derivative * derivative / (4 * curve));
    }
    p->t[1] = p->t[0];
    p->value[1] = p->value[0];
    p->t[0] = t;
    p->value[0] = value;
}

/* resolved_periods: sampled at least 51 times each; a parabola through three samples has an error of 1e-5.
   first_periods: of longer runs; the largest error of a decay from the start is at a phase, not in its envelope. */
static const double most_samples = 1024, resolved_periods = 20, first_periods = 10;

enum { MOST_DOUBLINGS = 53 }; /* of the number of steps: 2^53 take a year */

/* level[j]: 2^j steps, up to n. Returns the number of levels. */
static int doublings_of(step_run level[MOST_DOUBLINGS + 1], step_run step, double n)
{
    int count = 1;
    level[0] = step;
    for (double i = 2; i <= n && count <= MOST_DOUBLINGS; i *= 2, count++)
        level[count] = runs_joined(level[count - 1], level[count - 1]);
    return count;
}

static step_run step_run_of(const step_run *level, int levels, double n)
{
    step_run all = {0};
    for (int j = levels; j-- > 0;)
        if (n >= ldexp(1, j)) {
            n -= ldexp(1, j);
            all = runs_joined(all, level[j]);
        }
    return all;
}

/* The largest error, or envelope, at every stride-th step of from ... to. now: the run of `from` steps. */
static double most_at_strides(const step_run *level, int levels, step_run now, double from, double to, double stride,
                              const phase_rotation *phase)
{
    const step_run leap = step_run_of(level, levels, stride);
    error_peak p = {0};
    double i = from + stride;
    for (; i <= to; i += stride) {
        now = runs_joined(now, leap);
        const double value = envelope_at(now, phase);
        if (stride > 1)
            error_peak_add(&p, i, value, i == to);
        else
            p.most = fmax(p.most, value); /* there are no steps in between */
    }
    const double left = to - (i - stride);
    if (left > 0)
        now = runs_joined(now, step_run_of(level, levels, left));
    const double last = envelope_at(now, phase);
    if (left > 0 && stride > 1)
        error_peak_add(&p, to, last, true);
    return spring_finite(last) ? fmax(p.most, last) : (double)INFINITY;
}

/* The samples at 1, 5/4, 3/2, 7/4 times 1, 2, 4, ... steps, and the interval around the largest of them. */
typedef struct power_samples {
    const phase_rotation *phase;
    step_run before, best_before; /* the sample before the last, before the largest */
    double i_before, from, to;    /* its steps; the interval around the largest */
    double most;
    bool rising; /* the largest was the last one: the next one ends its interval */
} power_samples;

static void power_sample(power_samples *s, double i, step_run now)
{
    const double value = envelope_at(now, s->phase);
    if (s->rising)
        s->to = i;
    s->rising = value > s->most;
    if (s->rising) {
        s->most = value;
        s->best_before = s->before;
        s->from = s->i_before;
        s->to = i;
    }
    s->before = now;
    s->i_before = i;
}

/* The largest envelope at times in geometric progression, from the last power of two below `from` steps on, and at the
   last step. */
static double most_at_powers(const step_run *level, int levels, double from, double n, const phase_rotation *phase)
{
    power_samples s = {.phase = phase};
    for (int j = 0; j < levels; j++) {
        const double i = ldexp(1, j);
        if (2 * i <= from)
            continue;
        if (from > 0 && s.i_before == 0) { /* earlier samples do not count */
            s.before = level[j];
            s.i_before = i;
        }
        const int finer = j > 2 ? j - 2 : 0;
        step_run now = level[j];
        for (double k = i; k < 2 * i && k < n; k += ldexp(1, finer), now = runs_joined(now, level[finer]))
            power_sample(&s, k, now);
    }
    power_sample(&s, n, step_run_of(level, levels, n));
    const double dense = 32, stride = fmax(1, floor((s.to - s.from) / dense));
    return fmax(s.most, most_at_strides(level, levels, s.best_before, s.from, s.to, stride, phase));
}

/* After this many decay times, an error that grows with time is below 1 % of its maximum. */
static const double decays_that_count = 8;

/* The number of steps in which the slower of R and F decays so far, or n. det R = 1 + trace + determinant of R - 1. */
static double steps_that_count(step_run step, double G, double n)
{
    const spring_matrix R = matrix_plus(step.advance, step.error); /* - 1 */
    const double loss = -(R.xx + R.vv + (R.xx * R.vv - R.xv * R.vx)) / 2;
    const double rate = fmin(loss, G / 2);
    return rate * n > decays_that_count ? ceil(decays_that_count / rate) : n;
}

double spring_error_of(const accuracy *of, double steps, double n)
{
    const double most = ldexp(1, MOST_DOUBLINGS);
    const step_rates r = rates_of_step(of, steps);
    if (!spring_finite(rates_size(r)) || steps > most * (1 + DBL_EPSILON))
        return (double)INFINITY;
    const step_run step = run_of_one_step(of, r);
    if (!spring_finite(matrix_norm(step.error)))
        return (double)INFINITY;
    n = fmin(n, most); /* larger doubles do not count single steps */
    step_run level[MOST_DOUBLINGS + 1];
    const step_run start = {0};
    const phase_rotation no_phase = {0};
    if (n <= most_samples)
        return most_at_strides(&step, 1, start, 0, n, 1, &no_phase);
    const int levels = doublings_of(level, step, n);
    /* For slow springs, r.a^2 is not w h^2, but they do not decay either. Overdamped springs have no single rate. */
    const double square = r.a * r.c - r.G / 2 * (r.G / 2);
    if (!(square > 0))
        return most_at_powers(level, levels, 0, n, &no_phase);
    const double period = 6.283185307179586 / spring_sqrt(square), count = steps_that_count(step, r.G, n);
    if (count <= fmax(most_samples, period * resolved_periods))
        return most_at_strides(level, levels, start, 0, count, ceil(count / most_samples), &no_phase);
    const double early = fmin(period * first_periods, count);
    const double stride = ceil(early / (most_samples * first_periods / resolved_periods));
    const phase_rotation phase = phase_rotation_of(step);
    return fmax(most_at_strides(level, levels, start, 0, floor(early), stride, &no_phase),
                most_at_powers(level, levels, early, n, &phase));
}

/* ------------------------------------------------------------------------------------------------------- the search */

/* a^(1/order) if the order is a power of two, else an approximation. */
static double order_root(double a, int order)
{
    for (; order > 1; order /= 2)
        a = spring_sqrt(a);
    return a;
}

/* The number of steps whose errors would add up to the tolerance, by the power law. */
static double steps_guess(const accuracy *of, double tolerance, double asymptotic)
{
    const step_run step = run_of_one_step(of, rates_of_step(of, asymptotic));
    return asymptotic * fmax(1, order_root(matrix_norm(step.error) * asymptotic / tolerance, of->order));
}

double spring_accurate_steps(const accuracy *of, double tolerance)
{
    const double most = floor(fmin(tolerance / DBL_EPSILON * (tolerance / DBL_EPSILON), ldexp(1, MOST_DOUBLINGS)));
    const double asymptotic = ceil(2 * rates_size(of->whole)); /* the power law holds from this number of steps on */
    const double resolution = 0x1p-13;                         /* of n */
    double n = fmin(ceil(steps_guess(of, tolerance, asymptotic)), most), good = (double)INFINITY, bad = 0;
    for (int tries = 0;; tries++) {
        const double error = spring_error_of(of, n, n);
        if (error <= tolerance)
            good = n;
        else
            bad = n;
        if (bad >= most)
            return (double)INFINITY;
        const double finest = fmax(1, floor(n * resolution));
        if (good - bad <= finest)
            return good;
        const double law = ceil(n * order_root(error / tolerance, of->order));
        if (good == (double)INFINITY)
            n = fmin(2 * n, most);
        else if (bad == 0) /* slowly where the power law does not hold, so that no maximum is skipped */
            n = floor(fmin(fmax(law, asymptotic), n / 1.05));
        else
            n = tries > 12 ? bad + floor((good - bad) / 2) : fmin(fmax(law, bad + finest), good - finest);
    }
}

#include "../simd/size_end.h"
