/* SPDX-License-Identifier: MIT */
/** @file
 * springstep: simulation of many independent springs, stored as structures of arrays.
 *
 *     x[i]'' = accel[i] - omega2[i] x[i] - gamma[i] x[i]'
 *
 *     double x[1000], v[1000], omega2[1000];                         // owned by you; any alignment of double
 *     const double gamma = 0.3;
 *     spring_batch b = {1000, x, v, omega2, &gamma, NULL, SPRING_SHARED_GAMMA};
 *     spring_batch_advance(&b, SPRING_LEAPFROG, 1.0 / 240, 4);
 *
 * These rules hold for every function in this file, in addition to the rules in spring.h:
 *  - Determinism. In double precision, advancing spring i is bit-identical to advancing the single spring
 *    {1, omega2[i], gamma[i], accel[i]}, in every batch, at every index and with every instruction set. To use threads,
 *    a batch may therefore be split into ranges. In single precision the arithmetic is done in float, except parts of
 *    the exact solution (see spring_batch_advance()), and the results do not depend on the index either.
 *  - A feature whose array is NULL is disabled: it is neither read nor computed. A shared array has one element.
 *    docs/performance.md lists the cost of each feature.
 *  - Each call reads and writes the state once, for any number of steps.
 *  - On x86-64 the widest of SSE2, AVX2 and AVX-512 that the processor supports is used. Elsewhere the compiler's code
 *    for SIMD vectors of 16 bytes is used, or plain loops.
 */
#ifndef SPRINGSTEP_BATCH_H
#define SPRINGSTEP_BATCH_H

#include <stddef.h>

#include <springstep/spring.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SPRING_SHARED_OMEGA2 UINT32_C(1) /**< for spring_batch.shared: one omega2 for all springs */
#define SPRING_SHARED_GAMMA  UINT32_C(2) /**< one gamma for all springs */
#define SPRING_SHARED_ACCEL  UINT32_C(4) /**< one accel for all springs */

/** A batch. Set the fields of unused features to zero. x and v must not overlap each other or another array. The other
   arrays may be the same array. */
typedef struct spring_batch {
    size_t count;         /**< number of springs */
    double *x;            /**< [count] displacement from the unloaded rest position [m] */
    double *v;            /**< [count] velocity [m/s] */
    const double *omega2; /**< [count] stiffness/mass [1/s^2] >= 0; required */
    const double *gamma;  /**< [count] damping/mass [1/s] >= 0; NULL: no damping, at no cost */
    const double *accel;  /**< [count] load/mass [m/s^2];       NULL: no load, at no cost */
    uint32_t shared;      /**< SPRING_SHARED_OMEGA2 | SPRING_SHARED_GAMMA | SPRING_SHARED_ACCEL */
} spring_batch;

/** The single-precision version of spring_batch, with half the memory. docs/performance.md compares the time. */
typedef struct spring_batchf {
    /** As in spring_batch.
     * @{ */
    size_t count;
    float *x, *v;
    const float *omega2;
    const float *gamma;
    const float *accel;
    uint32_t shared;
    /** @} */
} spring_batchf;

/**
 * Advances every spring of a batch by n steps.
 *
 * The batch as a whole is checked first; if it is invalid, nothing changes. Otherwise each spring succeeds or fails
 * independently. A spring that would become non-finite keeps its state, and all other springs advance. The same holds
 * for a spring that spring_advance() would reject, because its state or one of its own parameters is not finite or a
 * parameter is negative. With a count of 0, n = 0 or dt = 0, nothing changes and the springs are not checked.
 *
 * SPRING_EXACT is one evaluation over n dt. If omega2 is shared, and gamma is shared or NULL, its coefficients are
 * computed once, and a spring costs six multiplications and two additions. Otherwise each spring has its own
 * coefficients, also computed with SIMD. In single precision, shared coefficients are computed in double and rounded
 * once, while a spring with its own coefficients is advanced in double and rounded at the end. In no other case does
 * sharing change a result. Rounded coefficients change the state by rounding errors, which have the same direction in
 * every call: the amplitude of a spring changes by up to 6.4e-8 of itself. Over many calls, use springs with their own
 * coefficients, or double precision. The coefficient of accel is about t^2/2 in short steps, so it is in the range of
 * float only if t is above 1.6e-19 s.
 *
 * The state of a damped spring decays to denormal numbers, below about 1e-308 (1e-38 in float), which are slow on many
 * processors. They are not set to zero, because this would change the results. Leave settled springs out of the batch,
 * or let the processor flush denormal numbers to zero in the threads that advance it.
 *
 * @param[in,out] b   batch
 * @param[in]     m   method
 * @param[in]     dt  finite time step [s]; a negative step integrates backwards
 * @param[in]     n   number of steps
 * @return SPRING_OK: all springs advanced.
 *         SPRING_EINVAL, nothing changed: b is NULL; count is not 0, and x, v or omega2 is NULL; x or v overlaps another array;
 *         unknown method or bit in shared; dt or a shared parameter is not finite, or a shared parameter is negative
 *         where it must not be.
 *         SPRING_EUNSUPPORTED, nothing changed: a method for scenes only.
 *         SPRING_EPARTIAL, all other springs advanced: a spring's own state or parameters are invalid, or it would
 *         have become non-finite; spring_batch_advance_marked() tells which and why. A group of neighbours that have
 *         all overflowed is abandoned within SPRING_CHECK_INTERVAL steps.
 * @par Threads   re-entrant; allocates nothing and keeps no state; disjoint ranges of a batch may be advanced
 *                concurrently
 */
SPRING_API spring_status spring_batch_advance(const spring_batch *b, spring_method m, double dt, uint64_t n);

/** The single-precision version. dt is rounded to float once, at the start. A step that rounds to 0 changes nothing and
   returns SPRING_OK. A step that is not finite as a float returns SPRING_EINVAL. */
SPRING_API spring_status spring_batchf_advance(const spring_batchf *b, spring_method m, double dt, uint64_t n);

/**
 * Advances a batch like spring_batch_advance(), and returns the status of each spring.
 *
 * A call takes longer than with spring_batch_advance(), because the springs are copied first. With many steps the
 * difference is small. Springs are advanced in groups of some hundred. A group in which a spring fails is advanced twice.
 *
 * @param[out] failed  [count] status of spring i: SPRING_OK, which is 0, if it advanced; SPRING_EINVAL if its state or
 *                     parameters are invalid, and SPRING_ENONFINITE if it would have become non-finite. It must not
 *                     overlap another array. Not written if nothing changed because of an error of the whole batch.
 * @return as spring_batch_advance(); SPRING_EINVAL also if failed is NULL or overlaps another array
 */
SPRING_API spring_status spring_batch_advance_marked(const spring_batch *b, spring_method m, double dt, uint64_t n,
                                                     uint8_t *failed);

/** The single-precision version; dt as in spring_batchf_advance(). */
SPRING_API spring_status spring_batchf_advance_marked(const spring_batchf *b, spring_method m, double dt, uint64_t n,
                                                      uint8_t *failed);

/**
 * Advances a batch in which each spring follows its own target, by the exact solution, and counts the springs that
 * still move.
 *
 *     x[i]'' = accel[i] - omega2[i] (x[i] - target[i]) - gamma[i] x[i]'
 *
 * Spring i is advanced like the single spring {1, omega2[i], gamma[i], accel[i]} by spring_follow() with a target
 * velocity of 0, and is placed on its target by the same rule. In double precision the result is bit-identical. Its
 * rest position is target[i] + accel[i]/omega2[i], and exactly target[i] without accel. After the step, a spring
 * within x_tol of its rest position whose speed is at most v_tol is placed at its rest position with v = 0. Without
 * stiffness, a spring with a load never counts as at rest, and a spring without load counts as at rest only on its
 * target (unlike in spring_at_rest()).
 *
 * Coefficients are shared as in spring_batch_advance(). As in spring_batch_advance(), each spring fails independently.
 * A spring also fails if its target is not finite. With dt = 0 nothing moves, and the springs are counted in their
 * current state. With a count of 0, *moving is 0.
 *
 * @param[in,out] b       batch
 * @param[in]     target  [count] targets [m]; must not overlap x or v
 * @param[in]     dt      finite time step [s]; a negative step integrates backwards
 * @param[in]     x_tol   >= 0 [m]
 * @param[in]     v_tol   >= 0 [m/s]
 * @param[out]    moving  number of springs that are not at rest on their target; springs that failed are counted. NULL:
 *                        not needed. Not written if nothing changed because of an error of the whole batch.
 * @return as spring_batch_advance(); SPRING_EINVAL, nothing changed, also if target is NULL or overlaps x or v, or a
 *         tolerance is negative or NaN
 * @par Threads   re-entrant; allocates nothing and keeps no state; disjoint ranges of a batch may be advanced
 *                concurrently
 */
SPRING_API spring_status spring_batch_follow(const spring_batch *b, const double *target, double dt, double x_tol,
                                             double v_tol, size_t *moving);

/** The single-precision version. In the rule of spring_follow() by which springs are placed on their targets, the ulp
   is that of float, and FLT_MIN and 2^-11 replace DBL_MIN and 2^-16. A spring is therefore placed from at most 2304
   ulps + 2.4e-35 away; the ulps are less than 0.03 % of the larger of |x| and |rest position|. It may stop before it
   is placed if slow dt < 2^-11: half-lives above 23 s at 60 Hz, 5.9 s at 240 Hz and 0.029 s at 48 kHz. Rest positions
   are computed in float and tolerances are rounded to float; dt is not rounded. */
SPRING_API spring_status spring_batchf_follow(const spring_batchf *b, const float *target, double dt, double x_tol,
                                              double v_tol, size_t *moving);

/**
 * Advances a batch like spring_batch_follow(), with a velocity for each target.
 *
 *     x[i]'' = accel[i] - omega2[i] (x[i] - T[i]) - gamma[i] (x[i]' - T[i]')
 *
 * Spring i is advanced like a single spring by spring_follow(), where T[i] is target[i] at the end of the step and T[i]'
 * is target_velocity[i]. In double precision the result is bit-identical. After the step, a spring within x_tol of its
 * rest position whose velocity relative to its target is at most v_tol is placed at its rest position with the
 * velocity of its target. It counts as moving while that velocity is not 0.
 *
 * The motion relative to the targets is advanced with SIMD. The rest is done one spring at a time.
 *
 * @param[in] target_velocity  [count] mean velocities of the targets in the step, (target - previous target)/dt [m/s];
 *                             must not overlap x or v. NULL: 0, as in spring_batch_follow()
 * All other parameters, results and errors are those of spring_batch_follow(). A spring also fails if the velocity of
 * its target is not finite.
 * @par Threads   re-entrant; allocates nothing and keeps no state; disjoint ranges of a batch may be advanced
 *                concurrently
 */
SPRING_API spring_status spring_batch_follow_moving(const spring_batch *b, const double *target,
                                                    const double *target_velocity, double dt, double x_tol,
                                                    double v_tol, size_t *moving);

/** The single-precision version; see spring_batchf_follow(). Target velocities times dt are rounded to float. */
SPRING_API spring_status spring_batchf_follow_moving(const spring_batchf *b, const float *target,
                                                     const float *target_velocity, double dt, double x_tol,
                                                     double v_tol, size_t *moving);

/**
 * Returns the stability limit of a batch: the smallest spring_stable_step() of its springs [s].
 *
 * It visits every spring that has its own parameters, and computes square roots. Call it when parameters change, not
 * every frame.
 *
 * @return limit [s]; INFINITY for a batch without springs; NaN for an invalid batch, method or spring
 */
SPRING_API double spring_batch_stable_step(const spring_batch *b, spring_method m);

/** The single-precision version. The limit is computed in double and rounded to float once, so it is a float value, and
   INFINITY above FLT_MAX. */
SPRING_API double spring_batchf_stable_step(const spring_batchf *b, spring_method m);

#ifdef __cplusplus
}
#endif

#endif
