/* SPDX-License-Identifier: MIT */
/** @file
 * springstep: simulation of one spring.
 *
 *     mass x'' = load - stiffness x - damping x'
 *
 * The methods are steppers, whose error depends on the time step, and the exact (closed-form) solution.
 *
 *     spring_params p = {1.3, 2.7, 0, 0};                            // kg, N/m, no damping, no load
 *     spring_state  s = {1.0, 0.0};
 *     spring_advance(&s, &p, SPRING_LEAPFROG, 1.0 / 240, 240);       // one second
 *
 * These rules hold for every function in this file:
 *  - Determinism. Every stepper first computes omega2 = stiffness/mass, gamma = damping/mass and accel = load/mass,
 *    each rounded once, and then uses only these. Damping or load of zero costs nothing and changes no bit. There is no
 *    fused multiply-add, no reordering and no C library function that is not exact. Results are therefore bit-identical
 *    with every compiler, C library and processor that follow IEEE 754. Options that do not follow it, such as
 *    -ffast-math, are rejected at compile time where they can be detected. spring_self_test() detects the others. Do
 *    not enable traps of floating-point exceptions (feenableexcept()): some operations whose results are not used
 *    divide by zero or overflow.
 *  - All or nothing. spring_advance() either succeeds, or leaves the state unchanged and returns the reason.
 *  - dt may be negative. It is never clamped, and never rejected for being unstable. spring_stable_step() returns the
 *    stability limit.
 *  - Functions are re-entrant. They do not allocate, print, abort or keep state.
 *
 * In formulas, omega = sqrt(omega2).
 */
#ifndef SPRINGSTEP_SPRING_H
#define SPRINGSTEP_SPRING_H

#include <stdbool.h>
#include <stdint.h>

#include <springstep/version.h>

#ifdef __cplusplus
extern "C" {
#endif

/** @defgroup values State, parameters, statuses
 * @{ */

/** The state of a spring: two numbers, which are easy to copy, to send over a network and to roll back. */
typedef struct spring_state {
    double x; /**< [m]   displacement from the unloaded rest position; with spring_follow(), the position itself */
    double v; /**< [m/s] velocity, at the same time as x */
} spring_state;

/** The parameters of a spring. Set the fields of unused features to zero. Many springs may share the same parameters.
 *
 * If the load changes with time, set it before each step to its value at t + dt/2 for second order. Its value at t
 * gives first order. No method exceeds second order with a load that is sampled once per step. */
typedef struct spring_params {
    double mass;      /**< [kg]    > 0 */
    double stiffness; /**< [N/m]   >= 0; 0: a free particle */
    double damping;   /**< [N s/m] >= 0; critical at 2 sqrt(mass stiffness) */
    double load;      /**< [N]     external force, constant over the step */
} spring_params;

/** The methods. New values are only appended. Tables list the methods in the order of spring_method_at(). */
typedef enum spring_method {
    SPRING_EULER,    /**< order 1; for comparison: an undamped spring gains energy at every step size */
    SPRING_LEAPFROG, /**< order 2; one force per step (in scenes two with callbacks that may use velocities), bounded
                        energy error of smooth motion: the default for games and long runs, except with forces
                        perpendicular to the velocity, see spring_scene_advance() */
    SPRING_RK4,      /**< order 4; small error in short runs; an undamped spring slowly loses energy */
    SPRING_EXACT,    /**< the exact solution, with rounding error only; one spring and batches only */
    SPRING_SYMPLECTIC_EULER, /**< order 1, bounded energy error of smooth motion; common in game engines; leapfrog needs
                                  as many force evaluations, except with callbacks that use velocities */
    SPRING_RKN8,             /**< order 8; scenes without damped links; many significant digits of smooth motion */
    SPRING_SRKN6 /**< order 6, bounded energy error of smooth motion; scenes without damped links; long runs in which
                    the energy must not drift */
} spring_method;

/** The number of methods, for array bounds and `#if`. It is a macro, so that C++ compilers do not warn when it is
   compared with a spring_method. */
#define SPRING_METHOD_COUNT 7

/** A state that is no longer finite is detected after at most this many steps. */
enum { SPRING_CHECK_INTERVAL = 4096 };

/** The result of a call. */
typedef enum spring_status {
    SPRING_OK,     /**< success */
    SPRING_EINVAL, /**< invalid input: NULL, non-finite, mass <= 0, negative stiffness or damping, unknown method, or
                          a quotient stiffness/mass, damping/mass or load/mass that is not finite */
    SPRING_ENONFINITE,   /**< the state would become infinite or NaN: the step is unstable, or numbers are too large */
    SPRING_ENOMEM,       /**< the memory block is too small */
    SPRING_EALIGN,       /**< the memory block is not aligned */
    SPRING_ERANGE,       /**< an index or a count is out of range */
    SPRING_EUNSUPPORTED, /**< not supported for this kind of system */
    SPRING_EDISABLED,    /**< not enabled in the definition of the scene */
    /* returned by spring_self_test(): */
    SPRING_EROUNDING, /**< the rounding mode is not round-to-nearest */
    SPRING_EFLUSHED,  /**< denormal numbers are flushed to zero */
    SPRING_EFUSED,    /**< a product and a sum are fused: they are rounded once instead of twice */
    SPRING_EBITS,     /**< the results of a short run are not bit-identical to the expected ones */
    /* returned for scenes: */
    SPRING_EUNSTABLE, /**< in a scene with max_speed, a particle would become faster, or its state would become infinite
                           or NaN, including by a force that is not finite */
    /* returned for batches: */
    SPRING_EPARTIAL, /**< some springs of a batch failed and kept their state, and all others advanced */
    /* returned by spring_scene_load(): */
    SPRING_EMISMATCH /**< the state is undamaged, but of a scene with another definition, or of another format */
} spring_status;

/** @} */

/** @defgroup kernels Single steps
 * Kernels for inner loops: each advances a spring by one step and checks nothing. Check the parameters once, or use
 * spring_advance().
 * @{ */

/**
 * Advances one spring by one step of explicit Euler.
 *
 *     x1 = x + dt v;   v1 = v + dt (accel - omega2 x - gamma v)
 *
 * First order. Each step multiplies the energy of an undamped spring by 1 + omega2 dt^2, so with stiffness and without
 * damping the method is never stable. With damping it is stable below spring_stable_step().
 *
 * @param[in,out] s   state
 * @param[in]     p   parameters; not checked, see spring_advance()
 * @param[in]     dt  time step [s]; a negative step integrates backwards
 * @par Accuracy  error C dt; tests/spring/test_order.c verifies the order and C
 * @par Source    Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section I.7
 * @par Threads   re-entrant; allocates nothing and keeps no state
 */
SPRING_API void spring_step_euler(spring_state *s, const spring_params *p, double dt);

/**
 * Advances one spring by one step of symplectic (semi-implicit) Euler with implicit damping.
 *
 *     v1 = (v + dt (accel - omega2 x)) / (1 + gamma dt);   x1 = x + dt v1
 *
 * First order. Many game engines use this method. Without damping it is symplectic: the energy error stays bounded, at
 * about dt omega of the energy (dt omega/2 if the spring starts at rest). Without damping, it is leapfrog with v half a
 * step behind: x and v + dt/2 (accel - omega2 x) are a leapfrog run. Stable for 0 < dt < (gamma + sqrt(gamma^2 + 4
 * omega2))/omega2. For negative dt the implicit kick has a pole at gamma |dt| = 1.
 *
 * @param[in,out] s   state
 * @param[in]     p   parameters; not checked, see spring_advance()
 * @param[in]     dt  time step [s]; a negative step integrates backwards
 * @par Accuracy  error C dt; tests/spring/test_order.c verifies the order and C
 * @par Source    Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), section I.1
 * @par Threads   re-entrant; allocates nothing and keeps no state
 */
SPRING_API void spring_step_symplectic_euler(spring_state *s, const spring_params *p, double dt);

/**
 * Advances one spring by one step of leapfrog (kick-drift-kick, also called velocity Verlet).
 *
 *     v' = v + dt/2 (accel - omega2 x - gamma v);   x1 = x + dt v'
 *     v1 = (v' + dt/2 (accel - omega2 x1)) / (1 + gamma dt/2)
 *
 * Second order, even with the implicit damping of the last kick. Time-reversible and symplectic without damping. Stable
 * for 0 < dt omega < 2 at every damping. With gamma dt > 2 it is still stable below this limit, but a component of the
 * velocity changes sign at every step and decays slowly; use spring_step_exact() there. For negative dt the implicit
 * kick has a pole at gamma |dt| = 2.
 *
 * @param[in,out] s   state, x and v at the same time
 * @param[in]     p   parameters; not checked, see spring_advance()
 * @param[in]     dt  time step [s]; a negative step integrates backwards
 * @par Accuracy  error C dt^2; tests/spring/test_order.c verifies the order and C
 * @par Source    Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), section I.1
 * @par Threads   re-entrant; allocates nothing and keeps no state
 */
SPRING_API void spring_step_leapfrog(spring_state *s, const spring_params *p, double dt);

/**
 * Advances one spring by one step of the classical Runge-Kutta method of order 4.
 *
 *     y1 = y + (1 + z/2 + z^2/6 + z^3/24) dt y',   z = dt M,   where y = (x, v) and y' = M y + (0, accel)
 *
 * Fourth order. For a linear spring the four stages reduce exactly to this polynomial. It is computed as an explicit
 * Euler step plus a small correction, without evaluating a force. An undamped spring loses about (omega dt)^6/72 of its
 * energy per step. Stable for dt omega < 2 sqrt(2) without damping; see spring_stable_step() for damped springs.
 *
 * @param[in,out] s   state
 * @param[in]     p   parameters; not checked, see spring_advance()
 * @param[in]     dt  time step [s]; a negative step integrates backwards
 * @par Accuracy  error C dt^4; tests/spring/test_order.c verifies the order and C
 * @par Source    Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section II.1
 * @par Threads   re-entrant; allocates nothing and keeps no state
 */
SPRING_API void spring_step_rk4(spring_state *s, const spring_params *p, double dt);

/**
 * Advances one spring by its exact (closed-form) solution, for any dt and any damping, with rounding error only.
 *
 * @param[in,out] s   state
 * @param[in]     p   parameters; not checked, see spring_advance()
 * @param[in]     dt  time step t [s] of any size, if omega t and gamma t do not overflow; a negative step integrates
 *                    backwards, if also e^(gamma |t|/2) and e^(gamma |t|/2)/gamma do not overflow
 * @par Accuracy  Without load, the error of (x, v/omega) is at most
 *                    4 eps (1 + omega |dt| max(1, zeta)) |Phi| |(x, v/omega)| + DBL_MIN (1 + 1/omega)
 *                where zeta is the damping ratio, Phi is the propagator of (x, v/omega), and all norms are Euclidean.
 *                The bound also holds at critical damping. Without stiffness, the error of v is at most
 *                4 eps (1 + gamma |dt|) |v| + DBL_MIN. If v is not 0, that of x is at most 4 eps (1 + gamma |dt|) times
 *                (|x| + displacement in the step) + DBL_MIN; otherwise x does not change. A load adds a term P accel to
 *                x. If P [s^2] is in the range of normal numbers, the error of this term is at most
 *                    8 eps (1 + omega dt) times the term                 if dt > 0 and zeta >= 1
 *                    8 eps (1 + omega dt) times accel/omega2             if dt > 0 and zeta < 1
 *                    8 eps (1 + 2 zeta omega |dt|) times the term        if dt < 0 and zeta > 1
 *                    8 eps (1 + omega |dt|) times the larger of the term and e^(zeta omega |dt|) accel/omega2  otherwise
 *                (tests/spring/test_exact.c).
 * @par Source    src/spring/exact_formula_tmpl.h derives the formula
 * @par Threads   re-entrant; allocates nothing and keeps no state
 */
SPRING_API void spring_step_exact(spring_state *s, const spring_params *p, double dt);

/** @} */

/** @defgroup safe Checked steps
 * @{ */

/**
 * Advances one spring by n steps. The arguments are checked once.
 *
 * The result is bit-identical to n calls of the kernel, and faster: values that depend only on the parameters are
 * computed once. SPRING_EXACT is the exception: it is one evaluation over n dt. dt = 0 or n = 0 changes nothing. There
 * is no limit on n: the call takes all steps, however long this takes.
 *
 * @param[in,out] s   finite state; unchanged unless SPRING_OK is returned
 * @param[in]     p   parameters
 * @param[in]     m   method
 * @param[in]     dt  finite time step [s]; a negative step integrates backwards
 * @param[in]     n   number of steps
 * @return SPRING_OK; SPRING_EINVAL; SPRING_EUNSUPPORTED: a method for scenes only; SPRING_ENONFINITE: detected within
 *         SPRING_CHECK_INTERVAL steps
 * @par Threads   re-entrant; allocates nothing and keeps no state
 */
SPRING_API spring_status spring_advance(spring_state *s, const spring_params *p, spring_method m, double dt,
                                        uint64_t n);

/**
 * Advances one spring that follows a target, by its exact solution. The step may be of any length for which
 * spring_step_exact() does not overflow.
 *
 *     mass x'' = load - stiffness (x - T) - damping (x' - T')
 *
 * The target T moves at the constant velocity T' = target_velocity during the step, and reaches `target` at its end. A
 * target at constant velocity is therefore followed without lag, at any frame rate. For a target that jumps, or whose
 * velocity you do not know, pass target_velocity = 0. A new target keeps x and v.
 *
 * The rest position is target + load/stiffness, and exactly `target` without load. A damped spring reaches the rest
 * position: as soon as rounding error could prevent it from coming closer, it is placed there, with x = rest position
 * and v = target_velocity. The condition is dt > 0, slow > 0 and
 *
 *     hypot(x - rest position, (v - T')/omega) max(min(1, slow dt), 2^-16) <= 9/8 ulp + DBL_MIN
 *
 * where slow is the decay rate [1/s] of the slowest mode, and ulp is the larger of the ulp of x and the ulp of the rest
 * position. A spring is therefore placed only from at most 73 728 ulps + 1.5e-303 away. As dt varies, the result jumps
 * by at most this distance. The ulps are less than 1.7e-11 of the larger of |x| and |rest position|. If slow dt <
 * 2^-16, rounding error may stop the spring before it is placed, up to 1.2/(slow dt) ulps from its rest position. This
 * concerns half-lives above 757 s at 60 Hz, 189 s at 240 Hz and 0.94 s at 48 kHz. Without stiffness, damping brings the
 * velocity to T' + load/damping, and the position of the target has no effect.
 *
 * @param[in,out] s                state; unchanged unless SPRING_OK is returned
 * @param[in]     p                parameters
 * @param[in]     target           target at the end of the step [m], finite
 * @param[in]     target_velocity  mean velocity of the target in the step, (target - previous target)/dt [m/s], finite
 * @param[in]     dt               finite time step [s]; a negative step integrates backwards; 0 changes nothing
 * @return SPRING_OK; SPRING_EINVAL; SPRING_ENONFINITE
 * @par Accuracy  With y = x - rest position and u = v - T' before the step, the error of (x, v/omega) is at most the
 *                sum of
 *                    4 eps (1 + omega |dt| max(1, zeta)) |Phi| |(y, u/omega)| + DBL_MIN (1 + 1/omega)
 *                    2 eps max(1, |Phi|) (|rest position| + |load/stiffness| + |T' dt| + |T'|/omega)
 *                    9/8 ulp/max(min(1, slow dt), 2^-16), if the spring is placed on its target
 *                where the first line is the bound of spring_step_exact() (tests/spring/test_follow.c). Without stiffness,
 *                the errors of x and v are at most those of spring_step_exact() for (x, u), plus
 *                2 eps (|x| + |T' dt| + |T'|).
 *                For dt > 0 errors do not grow. Steps of any lengths therefore agree with one step over the same time
 *                to within the sum of their bounds.
 * @par Source    src/spring/follow_formula_tmpl.h derives the condition
 * @par Threads   re-entrant; allocates nothing and keeps no state
 */
SPRING_API spring_status spring_follow(spring_state *s, const spring_params *p, double target, double target_velocity,
                                       double dt);

/** @} */

/** @defgroup questions Energy, steps, parameters, rest
 * @{ */

/** Returns the energy mass v^2/2 + stiffness x^2/2 - load x [J]. The exact solution conserves it without damping.
   Arguments are not checked, as in the kernels. */
SPRING_API double spring_energy(const spring_state *s, const spring_params *p);

/**
 * Returns the stability limit of a method: for 0 < dt < limit, no solution of the unloaded spring grows. (Without
 * stiffness, its velocity does not grow.)
 *
 * @return limit [s], accurate to 8 ulp. 0: never stable (Euler with stiffness and without damping). INFINITY: always
 *         stable (the exact solution; a spring without stiffness and damping; leapfrog and symplectic Euler without
 *         stiffness). NaN for invalid parameters, an unknown method and a method that is not offered for one spring.
 * @par Source    the header of each method, such as src/methods/rk4_tmpl.h, derives its limit
 */
SPRING_API double spring_stable_step(const spring_params *p, spring_method m);

/**
 * Returns a time step that keeps the error of a method within a tolerance, for every initial state.
 *
 * For the worst start of the size |(x, v/Omega)| = 1, the error of n steps is
 *
 *     E = the largest |(x, v/Omega) - exact| after any i <= n steps,   Omega = max(omega, 1/duration)
 *
 * with x measured from the rest position. The result is duration/n, where n is the smallest number of steps such that E
 * is at most the tolerance for n and for every larger number of steps. Above 8192, n may be larger by one part in 8192.
 * E is computed from the step matrix of the method, without a run. The worst start of a heavily damped spring lies
 * along its fast mode, so this mode determines the step; a start at rest would allow longer steps.
 *
 * @param[in] duration   > 0 [s]
 * @param[in] tolerance  > 0, relative to the start; if it is above 1, steps shorter than the result may have an error
 *                       of up to 1.01 times the tolerance
 * @return time step [s]. 0: there is none, because the rounding error of n steps, sqrt(n) eps, exceeds the tolerance,
 *         or n exceeds 2^53. `duration` for the exact solution. NaN for invalid input and a method that is not offered
 *         for one spring.
 * @par Accuracy  the error of a run from the worst start is at most 1.001 times the tolerance. With 100 steps or more and
 *                a tolerance of at most 1, it is above 0.9 times the tolerance (tests/spring/test_accurate_step.c). A
 *                call takes much longer than a step, so call it when parameters change, not in every frame.
 * @par Source    src/spring/accuracy.c derives the error
 */
SPRING_API double spring_accurate_step(const spring_params *p, spring_method m, double duration, double tolerance);

/**
 * Returns the error E of a given time step; see spring_accurate_step().
 *
 * @param[in] duration  > 0 [s]; the error is computed for at least one step
 * @param[in] dt        > 0 [s]
 * @return E without rounding error. 0 for the exact solution. INFINITY if E overflows, and for more than 2^53 steps.
 *         NaN for invalid input and a method that is not offered for one spring.
 * @par Accuracy  for E < 0.5, E is 0.999 ... 1.05 times the error of a run (tests/spring/test_accurate_step.c)
 */
SPRING_API double spring_step_error(const spring_params *p, spring_method m, double duration, double dt);

/**
 * Makes parameters from an undamped frequency and a damping ratio, for mass 1 kg.
 *
 * @param[in] hertz          undamped frequency >= 0 [Hz]
 * @param[in] damping_ratio  >= 0; 1 is critical
 * @return parameters; all NaN, which spring_advance() rejects, for invalid input or numbers out of range
 */
SPRING_API spring_params spring_params_hertz(double hertz, double damping_ratio);

/**
 * Makes parameters from the half-life of the amplitude and a damping ratio, for mass 1 kg.
 *
 * The envelope is exp(-damping t/(2 mass)) up to critical damping, and the slower of the two exponentials above it.
 *
 * @param[in] half_life      time in which the envelope halves > 0 [s]
 * @param[in] damping_ratio  > 0; 1 is critical
 * @return parameters; all NaN, which spring_advance() rejects, for invalid input or numbers out of range
 */
SPRING_API spring_params spring_params_half_life(double half_life, double damping_ratio);

/**
 * Makes parameters from a response and a damping fraction, as in SwiftUI, for mass 1 kg.
 *
 * @param[in] response          period of the undamped spring > 0 [s]; omega = 2 pi/response
 * @param[in] damping_fraction  damping ratio >= 0; 1 is critical
 * @return parameters; all NaN, which spring_advance() rejects, for invalid input or numbers out of range
 */
SPRING_API spring_params spring_params_response(double response, double damping_fraction);

/**
 * Makes parameters from a duration and a bounce, as in SwiftUI, for mass 1 kg.
 *
 * The damping ratio is 1 - bounce, and 1/(1 + bounce) for a negative bounce. A bounce of 0 is critical damping, 1 is no
 * damping. The spring is not at rest after `duration`; see spring_params_settling().
 *
 * @param[in] duration  period of the undamped spring > 0 [s]; omega = 2 pi/duration
 * @param[in] bounce    -1 < bounce <= 1
 * @return parameters; all NaN, which spring_advance() rejects, for invalid input or numbers out of range
 */
SPRING_API spring_params spring_params_bounce(double duration, double bounce);

/**
 * Makes parameters from a settling time and a damping ratio, for mass 1 kg.
 *
 * A spring that is released at rest at distance 1 from its target stays within `tolerance` of the target from `time`
 * on.
 *
 * @param[in] time           settling time > 0 [s]
 * @param[in] damping_ratio  > 0; 1 is critical
 * @param[in] tolerance      0 < tolerance < 1, relative to the initial distance; 0.001 looks settled
 * @return parameters; all NaN, which spring_advance() rejects, for invalid input or numbers out of range
 * @par Accuracy  spring_settling_time() of such a spring is `time` to 1e-9 (tests/spring/test_follow.c) if the damping ratio
 *                is at least 1e-9, unless the tolerance is the amplitude of a turning point to within rounding errors
 */
SPRING_API spring_params spring_params_settling(double time, double damping_ratio, double tolerance);

/**
 * Returns whether the spring is within x_tol [m] of its rest position load/stiffness and its speed is at most
 * v_tol [m/s].
 *
 * Without stiffness, every position is a rest position if there is no load, and no position is a rest position if there
 * is a load. Stop advancing springs that are at rest: their state decays to denormal numbers, which make steps slow.
 *
 * @return false also for invalid input: NULL, invalid parameters, a state that is not finite, a tolerance that is NaN
 *         or negative
 */
SPRING_API bool spring_at_rest(const spring_state *s, const spring_params *p, double x_tol, double v_tol);

/**
 * Returns the settling time: after it, the exact solution stays within x_tol of its rest position load/stiffness.
 *
 * Without stiffness and load, the rest position is the position at which damping stops the particle.
 *
 * @param[in] x_tol  >= 0 [m]
 * @return time [s]. 0 if the spring is never farther from its rest position than x_tol. INFINITY if it never settles.
 *         NaN for invalid input
 * @par Accuracy  the result is the time at which the computed exact solution crosses the tolerance. A tolerance of at
 *                most about 10 eps (|x| + |v|/omega + |load/stiffness|) is within the rounding error of the state, and
 *                the result is then not significant.
 */
SPRING_API double spring_settling_time(const spring_state *s, const spring_params *p, double x_tol);

/**
 * Returns the time after which spring_at_rest() stays true: the exact solution stays within x_tol of its rest position,
 * and its speed stays at most v_tol. Without stiffness, the rest position is that of spring_settling_time(), while
 * spring_at_rest() ignores the position.
 *
 * @param[in] x_tol  >= 0 [m]
 * @param[in] v_tol  >= 0 [m/s]
 * @return time [s]; INFINITY if the spring never rests, or if its acceleration overflows; NaN for invalid input
 * @par Accuracy  as spring_settling_time(), for x and for v
 */
SPRING_API double spring_rest_time(const spring_state *s, const spring_params *p, double x_tol, double v_tol);

/** Returns whether spring_advance() accepts these parameters; see SPRING_EINVAL. False for NULL. */
SPRING_API bool spring_params_valid(const spring_params *p);

/**
 * Checks that the floating-point environment of this thread gives reproducible results.
 *
 * Call it at the start of a program that relies on determinism. A compiler, a compiler option, or another library that
 * changes the rounding mode can break determinism. The test covers rounding, denormal numbers, fused products and sums,
 * and a few steps of every method: of one spring, of batches in both precisions and of a scene. It takes tens of
 * microseconds and up to 50 KB of the stack.
 *
 * @return SPRING_OK, or the first of SPRING_EROUNDING, SPRING_EFLUSHED, SPRING_EFUSED and SPRING_EBITS that applies
 */
SPRING_API spring_status spring_self_test(void);

/** @} */

/** @defgroup methods Properties of methods
 * @{ */

/** Properties of a method, for programs that list the methods in tables or menus. */
typedef struct spring_method_info {
    const char *name;    /**< name on a command line, such as "leapfrog" */
    int order;           /**< order p of the error C dt^p; 0: no error except rounding error */
    int forces_per_step; /**< force evaluations in scenes whose forces do not depend on velocities */
    bool symplectic;     /**< without damping: bounded energy error of smooth motion over any time */
    bool springs;        /**< offered for one spring and batches */
    bool scenes;         /**< offered for scenes */
    const char *label;   /**< name in a text, such as "RK4" */
    bool positions_only; /**< not offered for scenes with damped links or a callback that may use velocities */
} spring_method_info;

/** One step of a method, without checks; see spring_method_kernel(). */
typedef void spring_step_fn(spring_state *s, const spring_params *p, double dt);

/** Returns the properties of a method; NULL for an unknown method. */
SPRING_API const spring_method_info *spring_method_describe(spring_method m);

/** Returns the kernel of a method, such as spring_step_euler(). NULL for an unknown method and a method that is not
   offered for one spring. */
SPRING_API spring_step_fn *spring_method_kernel(spring_method m);

/** Returns the method at a place, 0 <= place < SPRING_METHOD_COUNT, in the order of tables and menus. Any other place
   returns SPRING_METHOD_COUNT, which is not a method. */
SPRING_API spring_method spring_method_at(int place);

/** Returns the name of a method, as in spring_method_info; NULL for an unknown method. */
SPRING_API const char *spring_method_name(spring_method m);

/** Returns the meaning of a status in English; never NULL. */
SPRING_API const char *spring_status_string(spring_status s);

/** Returns the version of the linked library, as in SPRING_VERSION. */
SPRING_API const char *spring_version(void);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
