/* SPDX-License-Identifier: MIT */
/** @file
 * springstep: many independent springs at once, as structures of arrays.
 *
 *     x[i]'' = accel[i] - omega2[i] x[i] - gamma[i] x[i]'
 *
 *     double x[1000], v[1000], omega2[1000];                         // yours; aligned as any array of double is
 *     const double gamma = 0.3;
 *     spring_batch b = {1000, x, v, omega2, &gamma, NULL, SPRING_SHARED_GAMMA};
 *     spring_batch_advance(&b, SPRING_LEAPFROG, 1.0 / 240, 4);
 *
 * What holds for every function here, beside what spring.h says:
 *  - Bits. In double, advancing spring i is bitwise identical to advancing the single spring {1, omega2[i], gamma[i],
 *    accel[i]}, in every batch, at every index, with every instruction set. So a batch may be split by pointer, to use
 *    threads. A float spring does the same arithmetic in float; its bits do not depend on its index either.
 *  - An array that is NULL is not modelled: it is neither read nor computed with. An array that is shared has one
 *    element. docs/performance.md says what each feature costs.
 *  - Each call reads and writes the state once, however many steps it takes.
 *  - On x86-64 the widest of SSE2, AVX2 and AVX-512 that the processor has is used; elsewhere what the compiler makes
 *    of 16-byte vectors, or of plain loops.
 */
#ifndef SPRINGSTEP_BATCH_H
#define SPRINGSTEP_BATCH_H

#include <stddef.h>

#include <springstep/spring.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SPRING_SHARED_OMEGA2 UINT32_C(1) /**< for spring_batch.shared: one omega2 for all springs */
#define SPRING_SHARED_GAMMA  UINT32_C(2) /**< one gamma */
#define SPRING_SHARED_ACCEL  UINT32_C(4) /**< one accel */

/** A batch. Zero-initialise what is not modelled. x and v overlap nothing; the others may be the same array. */
typedef struct spring_batch {
    size_t count;         /**< springs */
    double *x;            /**< [count] displacement from the unloaded rest position [m] */
    double *v;            /**< [count] velocity [m/s] */
    const double *omega2; /**< [count] stiffness/mass [1/s^2] >= 0; required */
    const double *gamma;  /**< [count] damping/mass [1/s] >= 0; NULL: not modelled, not paid for */
    const double *accel;  /**< [count] load/mass [m/s^2];       NULL: not modelled, not paid for */
    uint32_t shared;      /**< SPRING_SHARED_OMEGA2 | SPRING_SHARED_GAMMA | SPRING_SHARED_ACCEL */
} spring_batch;

/** A batch in float: half the memory, half the time. */
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
 * Advance every spring of a batch by n steps.
 *
 * Each spring for itself: one that would become non-finite keeps its state, and all others advance. So does one that
 * spring_advance() would refuse, because its state or one of its own parameters is not finite or a parameter is
 * negative. What concerns the whole batch is checked first, and then nothing changes. A count of 0, n = 0 and dt = 0
 * change nothing, and the springs are not looked at.
 *
 * SPRING_EXACT is one evaluation over n dt. With omega2 shared and gamma shared or NULL its coefficients are computed
 * once, and a spring costs six multiplications and two additions; otherwise each spring has its own, in vectors too.
 * In float, shared coefficients are computed in double and rounded once, and a spring with parameters of its own is
 * moved in double and rounded at the end: here, and only here, sharing changes the last bit.
 *
 * Far below 1e-308 (1e-38 in float) numbers become denormal, as a damped spring's do when it has settled, and on many
 * processors slow. Nothing is cut off here, since that would change bits: leave settled springs out, or let the
 * processor flush denormals to zero in the threads that do this work.
 *
 * @param[in,out] b   the batch
 * @param[in]     m   method
 * @param[in]     dt  finite step [s]; negative runs backwards
 * @param[in]     n   number of steps
 * @return SPRING_OK: all springs advanced.
 *         SPRING_EINVAL, nothing changed: b, x, v or omega2 NULL; x or v overlapping another array; an unknown method
 *         or bit in shared; dt or a shared parameter not finite, or negative where it must not be.
 *         SPRING_EUNSUPPORTED, nothing changed: a method for scenes alone.
 *         SPRING_EINVAL, all others advanced: a spring's own state or parameters are not valid.
 *         SPRING_ENONFINITE, all others advanced: a spring would have become non-finite. A group of neighbours that
 *         have all overflowed is given up within SPRING_CHECK_INTERVAL steps.
 * @par Threads   re-entrant; allocates nothing, keeps nothing; distinct ranges of one batch may be advanced at once
 */
SPRING_API spring_status spring_batch_advance(const spring_batch *b, spring_method m, double dt, uint64_t n);

/** The single-precision version. dt is rounded to float once, at the start. A dt that rounds to 0 changes nothing and is
   SPRING_OK; a dt that is not finite as a float is SPRING_EINVAL. */
SPRING_API spring_status spring_batchf_advance(const spring_batchf *b, spring_method m, double dt, uint64_t n);

/**
 * spring_batch_advance(), and which springs have kept their state. As fast where none has; each group of some hundred
 * springs with one that has is advanced twice.
 *
 * @param[out] failed  [count] 1 where spring i has kept its state for a reason of its own, else 0; may not be part of
 *                     another array. Not written where nothing changed
 * @return as spring_batch_advance(); SPRING_EINVAL also where failed is NULL
 */
SPRING_API spring_status spring_batch_advance_marked(const spring_batch *b, spring_method m, double dt, uint64_t n,
                                                     uint8_t *failed);

/** The single-precision version; dt as in spring_batchf_advance(). */
SPRING_API spring_status spring_batchf_advance_marked(const spring_batchf *b, spring_method m, double dt, uint64_t n,
                                                      uint8_t *failed);

/**
 * The stable step of a batch: the least spring_stable_step() of its springs [s].
 *
 * Computed from scratch by looking at every spring that has parameters of its own, with square roots: call it when
 * parameters change, not for every frame.
 *
 * @return INFINITY for a batch without springs; NaN for a batch, a method or a spring that is not valid
 */
SPRING_API double spring_batch_stable_step(const spring_batch *b, spring_method m);

/** The single-precision version. The result is computed in double and rounded to float once, so it is a float value, and
   INFINITY above FLT_MAX. */
SPRING_API double spring_batchf_stable_step(const spring_batchf *b, spring_method m);

#ifdef __cplusplus
}
#endif

#endif
