/* SPDX-License-Identifier: MIT */
/*
 * Motions in contact that have closed forms, for spring-contacts and the tests of contacts. Each function returns the
 * distance [m] of a particle from its exact place, or from its exact state in (x, v/omega).
 */
#ifndef CONTACT_CLOSED_FORMS_H
#define CONTACT_CLOSED_FORMS_H

#include <math.h>

/* A particle on a spring whose rest position is 0.5 m below a plane, released at 1 m above it, after `end`. */
static inline double distance_on_spring(double omega, double restitution, double end, double y, double v)
{
    const double below = 0.5;
    double t = 0, exact_y = 1, exact_v = 0;
    for (;;) { /* between impacts, y = -below + amplitude cos(omega t + phase) */
        const double amplitude = hypot(exact_y + below, exact_v / omega),
                     phase = atan2(-exact_v / omega, exact_y + below);
        const double hit = acos(below / amplitude), wait = (hit - phase) / omega;
        if (t + wait > end) {
            exact_y = amplitude * cos(omega * (end - t) + phase) - below;
            exact_v = -amplitude * omega * sin(omega * (end - t) + phase);
            return hypot(y - exact_y, (v - exact_v) / omega);
        }
        t += wait;
        exact_y = 0, exact_v = restitution * amplitude * omega * sin(hit);
    }
}

/* A particle that starts at (0, 1 m) with a horizontal speed and bounces on y = 0. Each bounce takes friction (1 + e) of
   the normal speed from the tangential one. */
static inline double distance_of_bounces(double speed, double restitution, double friction, double end,
                                         const double x[3])
{
    const double g = 9.81; /* [m/s^2] */
    double impact = sqrt(2 * g), t = impact / g, at = speed * t;
    for (;;) {
        speed -= fmin(speed, friction * (1 + restitution) * impact);
        impact *= restitution;
        const double flight = 2 * impact / g;
        if (t + flight > end)
            break;
        t += flight, at += speed * flight;
    }
    return hypot(x[0] - at - speed * (end - t), x[1] - (impact * (end - t) - g / 2 * (end - t) * (end - t)));
}

/* A bead on a plane that turns under it from y = 0, rho'' = rate^2 rho - g sin(rate t). */
static inline double distance_on_turning_plane(double rate, double rho, double speed, double end, const double x[3])
{
    const double g = 9.81, turned = rate * end;
    const double exact =
        rho * cosh(turned) + (speed - g / (2 * rate)) / rate * sinh(turned) + g / (2 * rate * rate) * sin(turned);
    return hypot(x[0] - exact * cos(turned), x[1] - exact * sin(turned));
}

#endif
