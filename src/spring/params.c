/* SPDX-License-Identifier: MIT */
/* Parameters of a spring of 1 kg from frequencies, durations and damping ratios. */
#include "../simd/arithmetic.h"

#include <math.h>

#include <springstep/spring.h>

#include "../simd/size_begin.h"

static const double two_pi = 6.283185307179586;

static bool positive_time(double t)
{
    return t > 0 && spring_finite(t);
}

static spring_params params_of(double omega, double damping_ratio)
{
    const spring_params p = {.mass = 1, .stiffness = omega * omega, .damping = 2 * damping_ratio * omega};
    const bool underflows = omega > 0 && p.stiffness < DBL_MIN;
    const double undefined = (double)NAN;
    return spring_params_valid(&p) && damping_ratio >= 0 && !underflows
               ? p
               : (spring_params){undefined, undefined, undefined, undefined};
}

spring_params spring_params_hertz(double hertz, double damping_ratio)
{
    return params_of(hertz >= 0 ? two_pi * hertz : (double)NAN, damping_ratio);
}

spring_params spring_params_half_life(double half_life, double damping_ratio)
{
    const double ln2 = 0.6931471805599453;
    const double z = damping_ratio;
    const double rate =
        z <= 1 ? z : 1 / (z + spring_sqrt(z - 1) * spring_sqrt(z + 1)); /* of the envelope, in units of omega */
    return params_of(positive_time(half_life) && z > 0 ? ln2 / half_life / rate : (double)NAN, z);
}

spring_params spring_params_response(double response, double damping_fraction)
{
    return params_of(positive_time(response) ? two_pi / response : (double)NAN, damping_fraction);
}

spring_params spring_params_bounce(double duration, double bounce)
{
    const bool valid = bounce > -1 && bounce <= 1;
    return spring_params_response(duration, !valid ? (double)NAN : bounce >= 0 ? 1 - bounce : 1 / (1 + bounce));
}

/* Settling times are inversely proportional to omega. */
spring_params spring_params_settling(double time, double damping_ratio, double tolerance)
{
    if (!positive_time(time) || !(damping_ratio > 0) || !(tolerance > 0 && tolerance < 1))
        return params_of((double)NAN, (double)NAN);
    const spring_params unit = params_of(1, damping_ratio); /* omega = 1/s */
    const spring_state released = {1, 0};
    return params_of(spring_settling_time(&released, &unit, tolerance) / time, damping_ratio);
}

#include "../simd/size_end.h"
