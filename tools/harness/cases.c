/* SPDX-License-Identifier: MIT */
/* The table of corner cases for one spring; see cases.h. */
#include "harness/cases.h"

#include <math.h>

segment case_segment(const validation_case *c, spring_method m, spring_state *start)
{
    segment s = {.p = {.mass = c->mass}, .dt = c->dt, .n = c->n};
    if (c->omega > 0) {
        s.p.stiffness = c->mass * c->omega * c->omega;
        s.p.damping = 2 * c->damping_ratio * c->mass * c->omega;
        s.p.load = s.p.stiffness * c->rest;
        *start = (spring_state){c->x0, c->v0 * c->omega};
    } else {
        s.p.damping = c->mass * c->damping_ratio;
        s.p.load = c->mass * c->rest;
        *start = (spring_state){c->x0, c->v0};
    }
    if (c->stable_fraction > 0) {
        const double limit = spring_stable_step(&s.p, m);
        s.dt = limit > 0 && isfinite(limit) ? c->stable_fraction * limit : 0.01 / c->omega;
    }
    return s;
}

bool case_takes(const validation_case *c, spring_method m)
{
    spring_state start;
    if (!spring_method_describe(m)->springs)
        return false;
    const segment s = case_segment(c, m, &start);
    const double limit = spring_stable_step(&s.p, m);
    return !c->stable_only || (c->stable_fraction > 0 ? limit > 0 : s.dt < limit);
}

/* ------------------------------------------------------------------------------- what changes from step to step */

/* Frame times within +-50 %, the same in every run: fractional parts of multiples of the golden ratio. */
static void jitter(const validation_case *c, uint64_t i, segment *s)
{
    (void)c;
    const double golden = 0.6180339887498949, part = (double)(i + 1) * golden;
    s->dt *= 0.5 + (part - floor(part));
}

/* Parametric resonance: the stiffness alternates by +-40 % every quarter of the period 2 pi/omega = 64 steps. */
static void pump(const validation_case *c, uint64_t i, segment *s)
{
    (void)c;
    s->p.stiffness *= i / 16 % 2 == 0 ? 1.4 : 0.6;
}

static const double drive_amplitude = 0.7; /* [m/s^2] */

/* The load of the drive a(t) = A cos(d t). */
static void drive(const validation_case *c, uint64_t i, segment *s)
{
    s->p.load = s->p.mass * drive_amplitude * cos(c->drive * (((double)i + c->sampled) * s->dt));
}

/* Added to the free motion: x = A t sin(w t)/(2 w) at resonance, A (cos d t - cos w t)/(w^2 - d^2) near it.

   The error in (x, v/w) from holding the load for a step follows from the Green's function H(t) = sin(w t)/w,
   |H| <= 1/w, |H'| <= 1. Sampled at the start: at most dt/2 |a'|/w per second; in the middle:
   dt^2 (|a'|/12 + |a''|/(24 w)). */
double case_driven(const validation_case *c, double dt, double t, spring_state *s)
{
    const double w = c->omega, A = drive_amplitude, d = c->drive;
    *s = (spring_state){c->x0 * cos(w * t) + c->v0 * sin(w * t), w * (c->v0 * cos(w * t) - c->x0 * sin(w * t))};
    if (d == w) {
        s->x += A * t * sin(w * t) / (2 * w);
        s->v += A / 2 * (t * cos(w * t) + sin(w * t) / w);
    } else {
        const double factor = A / (w * w - d * d);
        s->x += factor * (cos(d * t) - cos(w * t));
        s->v += factor * (w * sin(w * t) - d * sin(d * t));
    }
    return c->sampled == 0 ? t * dt / 2 * A * d / w : t * dt * dt * A * d * (1.0 / 12 + d / (24 * w));
}

/* ------------------------------------------------------------------------------------------------- the catalogue */

#define FRAME(hertz) .dt = 1.0 / (hertz)
#define START        .x0 = 0.8, .v0 = -0.9

const validation_case cases[] = {
    /* stiffness at frame steps */
    {"soft-30", "a spring that hardly moves", 1.3, 1e-6, 0, 0, START, FRAME(30), .n = 3000},
    {"slow-30", "a slow spring at a coarse frame", 1.3, 5, 0, 0, START, FRAME(30), .n = 3000, .external = true},
    {"brisk-60", "a brisk spring at a common frame", 0.7, 25, 0, 0, START, FRAME(60), .n = 300, .external = true},
    {"brisk-240", "the same at a fine frame", 0.7, 25, 0, 0, START, FRAME(240), .n = 1200, .external = true},
    {"stiff-240", "steps just above the leapfrog limit", 1.3, 481, 0.02, 0, START, FRAME(240), .n = 40},
    {"rigid-60", "omega dt = 1.7e7: every stepper explodes, and must do it exactly", 1.3, 1e9, 0, 0, START, FRAME(60),
     .n = 5},
    /* damping */
    {"damped-1e-12", "damping below the rounding of 1 + g dt", 1.3, 1.7, 1e-12, 0, START, .dt = 0.03, .n = 200000,
     .stable_only = true},
    {"damped-0.1", "light damping", 1.3, 1.7, 0.1, 0, START, .stable_fraction = 0.5, .n = 40, .external = true},
    {"damped-below-1", "critical damping from below", 1.3, 1.7, 1 - 1e-12, 0, START, .stable_fraction = 0.5, .n = 8,
     .external = true},
    {"damped-1", "critical damping", 1.3, 1.7, 1, 0, START, .stable_fraction = 0.5, .n = 8, .external = true},
    {"damped-above-1", "critical damping from above", 1.3, 1.7, 1 + 1e-12, 0, START, .stable_fraction = 0.5, .n = 8,
     .external = true},
    {"damped-10", "a heavily damped spring", 1.3, 1.7, 10, 0, START, .stable_fraction = 0.5, .n = 60, .external = true},
    {"damped-1e4", "two time scales 4e8 apart", 1.3, 1.7, 1e4, 0, START, .stable_fraction = 0.5, .n = 10000},
    {"settled-0.2", "long settled: with light damping, CVODE's BDF cannot take long steps", 1.3, 1.7, 0.2, 0, START,
     .dt = 0.1 / 1.7, .n = 10000, .external = true, .tolerance = 1e-6},
    {"settled-0.4", "the same with more damping: CVODE's BDF can take long steps", 1.3, 1.7, 0.4, 0, START,
     .dt = 0.1 / 1.7, .n = 10000, .external = true, .tolerance = 1e-6},
    /* the stability limit */
    {"limit-0.5", "half of the stable step", 1.3, 2.7, 0.3, 0, START, .stable_fraction = 0.5, .n = 20},
    {"limit-0.99", "close to the stable step", 1.3, 2.7, 0, 0, START, .stable_fraction = 0.99, .n = 1000,
     .stable_only = true},
    {"limit-0.999999", "a millionth below the stable step: errors grow a thousandfold", 1.3, 2.7, 0, 0, START,
     .stable_fraction = 0.999999, .n = 1000, .stable_only = true},
    {"limit-1.000001", "a millionth above the stable step", 1.3, 2.7, 0, 0, START, .stable_fraction = 1.000001,
     .n = 1000, .stable_only = true},
    {"limit-damped", "a millionth below the stable step, damped", 1.3, 2.7, 0.7, 0, START, .stable_fraction = 0.999999,
     .n = 300},
    {"limit-3", "three times the stable step", 1.3, 2.7, 0.2, 0, START, .stable_fraction = 3, .n = 60},
    /* magnitudes */
    {"mass-1e-12", "a tiny mass", 1e-12, 2.7, 0.2, 0.3, START, .dt = 0.02, .n = 500},
    {"mass-1e12", "a huge mass", 1e12, 2.7, 0.2, 0.3, START, .dt = 0.02, .n = 500},
    {"amplitude-1e-300", "squares underflow", 1.3, 2.7, 0.01, 0, .x0 = 0.8e-300, .v0 = -0.9e-300, .dt = 0.02, .n = 500},
    {"amplitude-1e300", "squares overflow", 1.3, 2.7, 0.01, 0, .x0 = 0.8e300, .v0 = -0.9e300, .dt = 0.02, .n = 500},
    {"denormal", "a settling spring with denormal numbers", 1.3, 2.7, 0.3, 0, .x0 = 0.8e-307, .v0 = -0.9e-307,
     .dt = 0.02, .n = 2000},
    /* starts */
    {"turning-point", "v = 0", 0.7, 2.7, 0, 0, .x0 = 0.8, .v0 = 0, .dt = 0.05, .n = 2000, .external = true},
    {"middle", "x = 0", 0.7, 2.7, 0, 0, .x0 = 0, .v0 = 0.8, .dt = 0.05, .n = 2000},
    {"at-rest", "at rest under load: it must stay", 0.7, 2.7, 0.1, -0.4, .x0 = -0.4, .v0 = 0, .dt = 0.05, .n = 2000},
    {"loaded", "a load, starting from the unloaded rest position", 0.7, 2.7, 0.1, -0.4, .x0 = 0, .v0 = 0, .dt = 0.05,
     .n = 500, .external = true},
    {"loaded-briefly", "a time so short that 1 - cos cancels", 1.3, 1.7, 0.3, -0.4, START, .dt = 0.01, .n = 20},
    {"loaded-heavily-damped", "the fast mode has decayed, the slow mode has hardly begun", 1.3, 1.7, 30, -0.4, START,
     .dt = 0.01, .n = 500},
    {"fast-root", "along the fast root of an overdamped spring", 0.7, 1.6, 1.25, 0, .x0 = 0.8, .v0 = -1.6, .dt = 0.05,
     .n = 200, .external = true},
    /* without stiffness */
    {"free-fall", "no stiffness, no damping", 1.3, 0, 0, -9.81, .x0 = 2, .v0 = 3, .dt = 0.05, .n = 100},
    {"drag-only", "no stiffness", 1.3, 0, 0.4, 0.3, .x0 = 2, .v0 = 3, .dt = 0.05, .n = 400},
    /* time */
    {"backwards", "dt < 0", 1.3, 2.7, 0, 0, START, .dt = -0.03, .n = 1000},
    {"backwards-damped", "dt < 0: damping is growth", 1.3, 2.7, 0.05, 0, START, .dt = -0.03, .n = 500},
    {"backwards-overdamped", "dt < 0: the fast mode grows", 1.3, 2.7, 2, 0, START, .dt = -0.01, .n = 200},
    {"decimal-step", "dt = 1e-4 is not a binary fraction", 1.3, 2.7, 0, 0, START, .dt = 1e-4, .n = 1000000},
    {"binary-step", "dt = 2^-13 is", 1.3, 2.7, 0, 0, START, .dt = 0x1p-13, .n = 1000000},
    {"billion-steps", "10^9 steps: biased rounding would be visible", 1.3, 1.7, 0, 0, START, .dt = 0.01,
     .n = 1000000000, .stable_only = true, .slow = true},
    /* what changes from step to step */
    {"jitter", "frame times that vary by 50 %", 1.3, 1.7, 0, 0, START, .dt = 0.1, .n = 2000, .vary = jitter},
    {"pumped", "stiffness switched every quarter period", 1.3, 1.7, 0, 0, START, .dt = 6.283185307179586 / 1.7 / 64,
     .n = 640, .vary = pump},
    {"resonance-start", "driven at resonance, load sampled at the start of each step: order 1", 1.3, 1.7, 0, 0, START,
     .dt = 0.01, .n = 2000, .vary = drive, .drive = 1.7},
    {"resonance-middle", "the same sampled in the middle: order 2", 1.3, 1.7, 0, 0, START, .dt = 0.01, .n = 2000,
     .vary = drive, .drive = 1.7, .sampled = 0.5},
    {"beating-start", "driven 10 % above resonance, sampled at the start", 1.3, 1.7, 0, 0, START, .dt = 0.01, .n = 5000,
     .vary = drive, .drive = 1.87},
    {"beating-middle", "the same sampled in the middle", 1.3, 1.7, 0, 0, START, .dt = 0.01, .n = 5000, .vary = drive,
     .drive = 1.87, .sampled = 0.5},
};

const size_t case_count = sizeof cases / sizeof cases[0];
