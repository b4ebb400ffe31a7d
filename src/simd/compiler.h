/* SPDX-License-Identifier: MIT */
/* Compiler extensions. */
#ifndef SPRINGSTEP_COMPILER_H
#define SPRINGSTEP_COMPILER_H

#ifndef SPRING_INLINE /* a build for size may leave the choice to the compiler */
#if defined(__GNUC__)
#define SPRING_INLINE static inline __attribute__((always_inline)) /* folds constant flags at -O1 too */
#else
#define SPRING_INLINE static inline
#endif
#endif

#if defined(__GNUC__)
#define SPRING_NOINLINE            static __attribute__((noinline, unused)) /* one copy for all callers of a file */
#define SPRING_UNLIKELY(condition) __builtin_expect(condition, 0)
#define SPRING_PREFETCH(address)   __builtin_prefetch(address)
#else
#define SPRING_NOINLINE            static
#define SPRING_UNLIKELY(condition) (condition)
#define SPRING_PREFETCH(address)   (void)(address)
#endif

/* Before a loop whose arrays should be kept in registers. For RISC-V without vectors, clang does not unroll such a
   loop, and warns. A build for size may define it as nothing. */
#if defined(SPRING_UNROLL)
#elif defined(__clang__) && defined(__riscv) && !defined(__riscv_vector)
#define SPRING_UNROLL
#elif defined(__clang__)
#define SPRING_UNROLL _Pragma("clang loop unroll(full)")
#elif defined(__GNUC__)
#define SPRING_UNROLL _Pragma("GCC unroll 8")
#else
#define SPRING_UNROLL
#endif

/* Before a loop whose long body should not be unrolled. */
#if defined(__clang__)
#define SPRING_ROLLED _Pragma("clang loop unroll(disable)")
#elif defined(__GNUC__)
#define SPRING_ROLLED _Pragma("GCC unroll 1")
#else
#define SPRING_ROLLED
#endif

/* clang for POWER warns that comparisons of AltiVec vectors will change, which does not concern vectors of GNU C. */
#if defined(__clang__) && defined(__ALTIVEC__)
#if __has_warning("-Wdeprecated-altivec-src-compat")
#pragma clang diagnostic ignored "-Wdeprecated-altivec-src-compat"
#endif
#endif

#endif
