/* SPDX-License-Identifier: MIT */
/** @file
 * springstep: one spring through time.
 *
 *     mass x'' = load - stiffness x - damping x'
 *
 * by one of the methods of spring_method: steppers, or the exact (closed-form) solution.
 *
 *     spring_params p = {1.3, 2.7, 0, 0};                            // kg, N/m, no damping, no load
 *     spring_state  s = {1.0, 0.0};
 *     spring_advance(&s, &p, SPRING_LEAPFROG, 1.0 / 240, 240);       // one second
 *
 * What holds for every function here:
 *  - Bits. Every stepper first forms w = stiffness/mass, g = damping/mass, a = load/mass, each rounded once, and works
 *    from those. A feature that is zero costs nothing and changes no bit. No fused multiply-add, no reordering, no
 *    function of the C library that is not exact: the same bits from every compiler, C library and processor that
 *    follow IEEE 754. Options that do not, such as -ffast-math, are refused where they can be seen; spring_self_test()
 *    notices the others.
 *  - All or nothing. spring_advance() either happens or leaves the state as it was, and says why.
 *  - dt may be negative, and is never clamped or refused for being unstable: spring_stable_step() tells, you decide.
 *  - Nothing allocates, prints, aborts or keeps anything: every function is re-entrant.
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

/** What moves. Two numbers: copy it, send it, roll it back. */
typedef struct spring_state {
    double x; /**< [m]   displacement from the unloaded rest position; to follow a goal, load = stiffness * goal */
    double v; /**< [m/s] velocity, at the same time as x */
} spring_state;

/** What stays. Zero-initialise what is not modelled. Many states may share one. A load that changes with time: set it
   before each step to its value at t + dt/2 for second order; its value at t gives first order. No method gives more
   than second order from a load that is sampled once a step. */
typedef struct spring_params {
    double mass;      /**< [kg]    > 0 */
    double stiffness; /**< [N/m]   >= 0; 0 is a free particle */
    double damping;   /**< [N s/m] >= 0; critical at 2 sqrt(mass stiffness) */
    double load;      /**< [N]     a force held constant over the step */
} spring_params;

/** Values are only ever appended; tables show methods in the order of spring_method_at(). */
typedef enum spring_method {
    SPRING_EULER,    /**< order 1; for comparison: an undamped spring gains energy at every step size */
    SPRING_LEAPFROG, /**< order 2; one force a step, bounded energy error: the default for games and long runs */
    SPRING_RK4,      /**< order 4; the smallest error for short runs; slowly loses energy */
    SPRING_EXACT,    /**< the exact solution; for one linear spring no stepper beats it */
    SPRING_SYMPLECTIC_EULER, /**< order 1, bounded energy error: what many game engines run; leapfrog costs the same */
    SPRING_RKN8              /**< order 8; for scenes without damped links: many digits of a smooth motion */
} spring_method;

/** The number of methods, for array bounds and `#if`. A macro, so that C++ compilers do not warn
   when it is compared with a spring_method. */
#define SPRING_METHOD_COUNT 6

/** Steps after which a state that is not finite any more is noticed, at the latest. */
enum { SPRING_CHECK_INTERVAL = 4096 };

/** What a function says of a call. */
typedef enum spring_status {
    SPRING_OK,         /**< done */
    SPRING_EINVAL,     /**< bad input: NULL, non-finite, mass <= 0, negative stiffness or damping, unknown method, or a
                           quotient stiffness/mass, damping/mass, load/mass that is not finite */
    SPRING_ENONFINITE, /**< the state would have become infinite or NaN: unstable step, or numbers too large */
    SPRING_ENOMEM,     /**< the memory given is too small */
    SPRING_EALIGN,     /**< the memory given is not aligned */
    SPRING_ERANGE,     /**< an index or a count is out of range */
    SPRING_EUNSUPPORTED, /**< not offered for this kind of system */
    SPRING_EDISABLED,    /**< the definition of the scene did not ask for this */
    /* of spring_self_test(): */
    SPRING_EROUNDING, /**< rounding is not to nearest */
    SPRING_EFLUSHED,  /**< denormal numbers count as 0 */
    SPRING_EFUSED,    /**< a product and a sum are rounded once, not twice */
    SPRING_EBITS      /**< the bits of a short run are not those they should be */
} spring_status;

/** @} */

/** @defgroup kernels The kernels
 * One step, unchecked, for the inner loop. Check the parameters once, or use spring_advance().
 * @{ */

/**
 * Advance one spring by one step of explicit Euler.
 *
 *     x1 = x + dt v;   v1 = v + dt (a - w x - g v)
 *
 * First order. Multiplies the energy of an undamped spring by 1 + w dt^2 at every step, so it is never stable there;
 * with damping stable below spring_stable_step().
 *
 * @param[in,out] s   state
 * @param[in]     p   parameters, unchecked here
 * @param[in]     dt  step [s]; negative runs backwards
 * @par Accuracy  error C dt; tests/test_order.c pins the slope and C
 * @par Source    Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section I.7
 * @par Threads   re-entrant; allocates nothing, keeps nothing
 */
SPRING_API void spring_step_euler(spring_state *s, const spring_params *p, double dt);

/**
 * Advance one spring by one step of symplectic (semi-implicit) Euler, with its damping solved for.
 *
 *     v1 = (v + dt (a - w x)) / (1 + g dt);   x1 = x + dt v1
 *
 * What many game engines run. First order; symplectic without damping, where it is leapfrog seen half a step late: the
 * energy error stays bounded, about dt sqrt(w)/2 of the energy. Stable for 0 < dt < (g + sqrt(g^2 + 4 w))/w. For
 * negative dt the solved kick has a pole at g |dt| = 1.
 *
 * @param[in,out] s   state
 * @param[in]     p   parameters, unchecked here
 * @param[in]     dt  step [s]; negative runs backwards
 * @par Accuracy  error C dt; tests/test_order.c pins the slope and C
 * @par Source    Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), section I.1
 * @par Threads   re-entrant; allocates nothing, keeps nothing
 */
SPRING_API void spring_step_symplectic_euler(spring_state *s, const spring_params *p, double dt);

/**
 * Advance one spring by one step of leapfrog (kick, drift, kick; also called velocity Verlet).
 *
 *     v' = v + dt/2 (a - w x - g v);   x1 = x + dt v';   v1 = (v' + dt/2 (a - w x1)) / (1 + g dt/2)
 *
 * Second order, time-reversible and symplectic without damping. Stable for 0 < dt sqrt(w) < 2, whatever the damping.
 * Solving the last kick for v keeps the order at 2. For g dt > 2 it is stable, but it rings: a part of the velocity
 * changes sign at every step and dies away slowly, so take spring_step_exact() there. For negative dt the solved kick
 * has a pole at g |dt| = 2.
 *
 * @param[in,out] s   state, x and v at the same time
 * @param[in]     p   parameters, unchecked here
 * @param[in]     dt  step [s]; negative runs backwards
 * @par Accuracy  error C dt^2; tests/test_order.c pins the slope and C
 * @par Source    Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), section I.1
 * @par Threads   re-entrant; allocates nothing, keeps nothing
 */
SPRING_API void spring_step_leapfrog(spring_state *s, const spring_params *p, double dt);

/**
 * Advance one spring by one step of the classical Runge-Kutta method of order 4.
 *
 *     y1 = (1 + z + z^2/2 + z^3/6 + z^4/24) y,  z = dt times the matrix of the spring, plus the same for the load
 *
 * For a linear spring the four stages collapse exactly to this polynomial, and it is computed as Euler's step plus a
 * small correction, without evaluating a force. Fourth order. An undamped spring loses about (w dt^2)^3/72 of its
 * energy per step. Stable for dt sqrt(w) < 2 sqrt(2) without damping; see spring_stable_step() for the rest.
 *
 * @param[in,out] s   state
 * @param[in]     p   parameters, unchecked here
 * @param[in]     dt  step [s]; negative runs backwards
 * @par Accuracy  error C dt^4; tests/test_order.c pins the slope and C
 * @par Source    Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I (1993), section II.1
 * @par Threads   re-entrant; allocates nothing, keeps nothing
 */
SPRING_API void spring_step_rk4(spring_state *s, const spring_params *p, double dt);

/**
 * Advance one spring by its exact (closed-form) solution: any dt, any damping, no error but rounding.
 *
 * @param[in,out] s   state
 * @param[in]     p   parameters, unchecked here
 * @param[in]     dt  time [s]; of any size, as long as omega dt and dt damping/mass do not overflow; negative runs
 *                    backwards
 * @par Accuracy  without load, (x, v/omega) is within
 *                    4 eps (1 + omega t max(1, zeta)) |Phi| |(x, v/omega)| + DBL_MIN (1 + 1/omega)
 *                of the exact one, omega = sqrt(stiffness/mass), zeta the damping ratio, Phi the propagator of
 *                (x, v/omega), all norms Euclidean; critical damping is no exception. What a load a = load/mass adds to
 *                x is within 8 eps (1 + omega t) of itself, or of a/omega^2 where it oscillates (tests/test_exact.c)
 * @par Source    src/spring/exact_formula.h derives the formula
 * @par Threads   re-entrant; allocates nothing, keeps nothing
 */
SPRING_API void spring_step_exact(spring_state *s, const spring_params *p, double dt);

/** @} */

/** @defgroup safe The safe way in
 * @{ */

/**
 * Advance one spring by n steps, checked once.
 *
 * The same bits as n calls of the kernel, and faster: what depends only on the parameters is computed once.
 * SPRING_EXACT is one evaluation over n dt. dt = 0 or n = 0 changes nothing. Every step is taken: it is up to the
 * caller to ask for a number of steps that ends in time.
 *
 * @param[in,out] s   finite state; unchanged unless SPRING_OK is returned
 * @param[in]     p   parameters
 * @param[in]     m   method
 * @param[in]     dt  finite step [s]; negative runs backwards
 * @param[in]     n   number of steps
 * @return SPRING_OK; SPRING_EINVAL; SPRING_EUNSUPPORTED: a method for scenes alone; SPRING_ENONFINITE, noticed within
 *                    SPRING_CHECK_INTERVAL steps
 * @par Threads   re-entrant; allocates nothing, keeps nothing
 */
SPRING_API spring_status spring_advance(spring_state *s, const spring_params *p, spring_method m, double dt,
                                        uint64_t n);

/** @} */

/** @defgroup questions Questions to ask
 * @{ */

/** Energy m v^2/2 + k x^2/2 - load x [J]. Conserved by the exact solution when damping is 0. Unchecked, like the
   kernels. */
SPRING_API double spring_energy(const spring_state *s, const spring_params *p);

/**
 * The stable step of a method: for 0 < dt < this, no solution of the unloaded spring grows faster than the exact one.
 *
 * @return limit [s], to 8 ulp. 0: never stable (Euler without damping). INFINITY: always (the exact solution; no force
 *         at all; leapfrog without stiffness). NaN for bad parameters or an unknown method.
 * @par Source    the header of each method, such as src/methods/rk4.h, derives its limit
 */
SPRING_API double spring_stable_step(const spring_params *p, spring_method m);

/**
 * The step that is accurate enough: the error of a method stays within a tolerance, for every start.
 *
 * The error of n steps of h is, over the size |(x, v/Omega)| of the start and for the worst start,
 *
 *     E = the largest |(x, v/Omega) - exact| after any i <= n steps,   Omega = max(omega, 1/duration)
 *
 * where x is measured from the rest position. The answer is duration/n with the least n for which that is at most the
 * tolerance, and is so for every larger n; above 8192, n is up to one part in 8192 larger. It is computed from the
 * method's matrix, without a run. The worst start of a heavily damped spring is along its fast root, which then rules: for
 * a start at rest longer steps would do.
 *
 * @param[in] duration   > 0 [s]
 * @param[in] tolerance  > 0, relative to the start
 * @return step [s]. 0: none, since the rounding of n steps, sqrt(n) eps, exceeds the tolerance, or n is more than 2^53.
 *         `duration` for the exact solution. NaN for bad input, and a method that is not for one spring
 * @par Accuracy  the error of a run is at most 1.001 times the tolerance, and rarely below 0.9 times
 *                (tests/test_accurate_step.c)
 * @par Source    src/spring/accuracy.c derives the error
 */
SPRING_API double spring_accurate_step(const spring_params *p, spring_method m, double duration, double tolerance);

/**
 * The error E of a step that one has: see spring_accurate_step().
 *
 * @param[in] duration  > 0 [s]; of at least one step
 * @param[in] dt        > 0 [s]
 * @return E without rounding; 0 for the exact solution, INFINITY where it overflows, and for more than 2^53 steps. NaN for
 *         bad input, and a method that is not for one spring
 * @par Accuracy  E < 0.5 is within 0.999 ... 1.05 of that of a run (tests/test_accurate_step.c)
 */
SPRING_API double spring_step_error(const spring_params *p, spring_method m, double duration, double dt);

/**
 * Parameters from how the spring should feel: undamped frequency and damping ratio, mass 1 kg.
 *
 * @param[in] hertz          undamped frequency >= 0 [Hz]
 * @param[in] damping_ratio  >= 0; 1 is critical
 * @return parameters; all NaN for bad input or numbers out of range, which spring_advance() then refuses
 */
SPRING_API spring_params spring_params_hertz(double hertz, double damping_ratio);

/**
 * Parameters from how fast the spring should settle, mass 1 kg.
 *
 * The envelope is exp(-c t/2m) up to critical damping, and the slower of the two exponentials beyond.
 *
 * @param[in] half_life      time in which the envelope halves > 0 [s]
 * @param[in] damping_ratio  > 0; 1 is critical
 * @return parameters; all NaN for bad input or numbers out of range, which spring_advance() then refuses
 */
SPRING_API spring_params spring_params_half_life(double half_life, double damping_ratio);

/**
 * Is the spring within x_tol [m] of its rest position load/stiffness, and slower than or at v_tol [m/s]?
 *
 * Without stiffness every position is a rest position as long as there is no load, and none is under load.
 * A spring that has settled is best left alone: far below, its numbers become denormal, and steps slow.
 * False for bad input (NULL, bad parameters, a state that is not finite, NaN or negative tolerance).
 */
SPRING_API bool spring_at_rest(const spring_state *s, const spring_params *p, double x_tol, double v_tol);

/**
 * The settling time: after it the exact solution stays within x_tol of its rest position load/stiffness.
 *
 * Without stiffness and load the rest position is where the damping brings the particle to a stop.
 *
 * @param[in] x_tol  >= 0 [m]
 * @return [s]; 0 if it never leaves, INFINITY if it never stays; NaN for bad input
 * @par Accuracy  the crossing of the exact solution. A tolerance of no more than about 10 eps of
 *                |x| + |v|/omega + |load/stiffness| is within the rounding of the state, and its time means little
 */
SPRING_API double spring_settling_time(const spring_state *s, const spring_params *p, double x_tol);

/** Are these parameters that spring_advance() accepts? See SPRING_EINVAL; NULL is not. */
SPRING_API bool spring_params_valid(const spring_params *p);

/**
 * Has the library the arithmetic here that its bits depend on? Call it at the start of a program whose bits matter: a
 * compiler, a flag, or another library that changes how the processor rounds may take it away.
 *
 * Tried are rounding, numbers below the smallest normal ones, products beside sums, and a few steps of every method: of
 * one spring, of batches in both precisions, of a scene. Takes tens of microseconds, and up to 50 KB of the stack. It tells of the
 * thread that calls it.
 *
 * @return SPRING_OK; SPRING_EROUNDING, SPRING_EFLUSHED, SPRING_EFUSED, SPRING_EBITS: the first of these that is so
 */
SPRING_API spring_status spring_self_test(void);

/** @} */

/** @defgroup methods The methods
 * @{ */

/** What programs need to know to offer methods without naming them. */
typedef struct spring_method_info {
    const char *name;    /**< as on a command line: "leapfrog" */
    int order;           /**< error C dt^order; 0: no error but rounding */
    int forces_per_step; /**< evaluations; of scenes without forces that depend on velocities */
    bool symplectic;     /**< without damping: bounded energy error over any time */
    bool springs;        /**< offered for one spring and batches */
    bool scenes;         /**< offered for scenes */
    const char *label;   /**< as in a text: "RK4" */
    bool positions_only; /**< not for scenes with damped links or with a callback that may use velocities */
} spring_method_info;

/** One step of a method, unchecked; see spring_method_kernel(). */
typedef void spring_step_fn(spring_state *s, const spring_params *p, double dt);

/** What there is to know of a method; NULL for any other value. */
SPRING_API const spring_method_info *spring_method_describe(spring_method m);

/** The kernel, such as spring_step_euler(); NULL for a method that is not for one spring, and for any other value. */
SPRING_API spring_step_fn *spring_method_kernel(spring_method m);

/** The methods in the order in which tables and menus show them, 0 <= place < SPRING_METHOD_COUNT. Of any other place:
    SPRING_METHOD_COUNT, which is no method. */
SPRING_API spring_method spring_method_at(int place);

/** The name of a method, as in spring_method_info; NULL for any other value. */
SPRING_API const char *spring_method_name(spring_method m);

/** What a status means, in English; never NULL. */
SPRING_API const char *spring_status_string(spring_status s);

/** The version of the library that is linked, as in SPRING_VERSION. */
SPRING_API const char *spring_version(void);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
