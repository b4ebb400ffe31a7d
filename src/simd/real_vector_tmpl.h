/* SPDX-License-Identifier: MIT */
/* `real` as a vector of SPRING_VECTOR bytes; see real_tmpl.h. */
typedef scalar real __attribute__((vector_size(SPRING_VECTOR)));
typedef scalar_bits lane_mask __attribute__((vector_size(SPRING_VECTOR))); /* of a comparison: -1 or 0 in each lane */
typedef lane_mask real_bits;

SPRING_INLINE real splat(scalar s)
{
    return s - (real){0}; /* -0.0 stays -0.0 */
}

/* Not 0 in lanes that are infinite or NaN. */
SPRING_INLINE lane_mask not_finite(real a)
{
    return (lane_mask)(a - a);
}

SPRING_INLINE lane_mask sign_bit(real a)
{
    return (lane_mask)a & (lane_mask)splat(-(scalar)0);
}

/* Whether any bit is set. */
SPRING_INLINE bool any(lane_mask t)
{
#if SPRING_X86_64 && SPRING_VECTOR == 64
    return _mm512_test_epi64_mask((__m512i)t, (__m512i)t) != 0;
#elif SPRING_X86_64 && SPRING_VECTOR == 32
    return !_mm256_testz_si256((__m256i)t, (__m256i)t);
#elif SPRING_X86_64
    return _mm_movemask_epi8(_mm_cmpeq_epi8((__m128i)t, _mm_setzero_si128())) != 0xffff;
#elif defined(__wasm_simd128__) && SPRING_VECTOR == 16
    return wasm_v128_any_true((v128_t)t);
#else
    uint64_t part[sizeof t / sizeof(uint64_t)], all = 0;
    memcpy(part, &t, sizeof t);
    for (size_t i = 0; i < sizeof part / sizeof part[0]; i++)
        all |= part[i];
    return all != 0;
#endif
}

SPRING_INLINE lane_mask not_mask(lane_mask t)
{
    return ~t;
}

SPRING_INLINE real select_real(lane_mask t, real a, real b)
{
    return (real)((t & (lane_mask)a) | (~t & (lane_mask)b));
}

/* a, but 0 where a < 0. */
SPRING_INLINE real vec_not_negative(real a)
{
#if SPRING_X86_64 && SPRING_VECTOR == 64 && defined(SPRING_FLOAT)
    return (real)_mm512_max_ps(_mm512_setzero_ps(), (__m512)a); /* the second operand if they are equal or NaN */
#elif SPRING_X86_64 && SPRING_VECTOR == 64
    return (real)_mm512_max_pd(_mm512_setzero_pd(), (__m512d)a);
#elif SPRING_X86_64 && SPRING_VECTOR == 32 && defined(SPRING_FLOAT)
    return (real)_mm256_max_ps(_mm256_setzero_ps(), (__m256)a);
#elif SPRING_X86_64 && SPRING_VECTOR == 32
    return (real)_mm256_max_pd(_mm256_setzero_pd(), (__m256d)a);
#elif SPRING_X86_64 && defined(SPRING_FLOAT)
    return (real)_mm_max_ps(_mm_setzero_ps(), (__m128)a);
#elif SPRING_X86_64
    return (real)_mm_max_pd(_mm_setzero_pd(), (__m128d)a);
#else
    return select_real(a < 0, splat(0), a);
#endif
}

/* From one byte per lane, -1 or 0. */
SPRING_INLINE lane_mask vec_load_mask(const int8_t *p)
{
#if SPRING_X86_64 && SPRING_VECTOR == 64 && defined(SPRING_FLOAT)
    return (lane_mask)_mm512_cvtepi8_epi32(_mm_loadu_si128((const __m128i *)p));
#elif SPRING_X86_64 && SPRING_VECTOR == 64
    return (lane_mask)_mm512_cvtepi8_epi64(_mm_loadl_epi64((const __m128i *)p));
#elif SPRING_X86_64 && SPRING_VECTOR == 32 && defined(SPRING_FLOAT)
    return (lane_mask)_mm256_cvtepi8_epi32(_mm_loadl_epi64((const __m128i *)p));
#elif SPRING_X86_64 && SPRING_VECTOR == 32
    int four;
    memcpy(&four, p, sizeof four);
    return (lane_mask)_mm256_cvtepi8_epi64(_mm_cvtsi32_si128(four));
#elif SPRING_X86_64 /* unpacking repeats each byte */
    int32_t bytes = 0;
    memcpy(&bytes, p, sizeof(lane_mask) / sizeof(scalar));
    const __m128i each = _mm_cvtsi32_si128(bytes), twice = _mm_unpacklo_epi8(each, each);
    const __m128i four = _mm_unpacklo_epi16(twice, twice);
    return (lane_mask)(sizeof(scalar) == sizeof(float) ? four : _mm_unpacklo_epi32(four, four));
#elif defined(__wasm_simd128__) && SPRING_VECTOR == 16 && !defined(SPRING_FLOAT)
    const v128_t both = wasm_v128_load16_splat(p);
    return (lane_mask)wasm_i8x16_shuffle(both, both, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1);
#else
    lane_mask t = {0};
    for (size_t i = 0; i < sizeof t / sizeof(scalar); i++)
        t[i] = p[i];
    return t;
#endif
}

/* Lane i is from[place[i]]. */
SPRING_INLINE real vec_load_places(const scalar *from, const size_t *place)
{
    real a = {0};
    SPRING_UNROLL
    for (size_t i = 0; i < sizeof a / sizeof(scalar); i++)
        a[i] = from[place[i]];
    return a;
}

/* 32 bits in each lane. */
typedef lane_mask lane_bits;

typedef uint32_t packed_bits __attribute__((vector_size(sizeof(uint32_t) * SPRING_VECTOR / sizeof(scalar))));

SPRING_INLINE lane_bits load_bits(const uint32_t *p)
{
    packed_bits b;
    memcpy(&b, p, sizeof b);
    return __builtin_convertvector(b, lane_bits);
}

SPRING_INLINE void store_bits(uint32_t *p, lane_bits b)
{
    const packed_bits packed = __builtin_convertvector(b, packed_bits);
    memcpy(p, &packed, sizeof packed);
}

/* `bits` in the lanes of a mask, 0 in other lanes. */
SPRING_INLINE lane_bits bits_where(lane_mask t, uint32_t bits)
{
    return t & (scalar_bits)bits;
}

/* Lanes that have exactly these bits. */
SPRING_INLINE lane_mask are_bits(lane_bits b, uint32_t bits)
{
    return b == (scalar_bits)bits;
}

SPRING_INLINE real vec_sqrt(real a)
{
#if SPRING_X86_64 && SPRING_VECTOR == 64 && defined(SPRING_FLOAT)
    return (real)_mm512_sqrt_ps((__m512)a);
#elif SPRING_X86_64 && SPRING_VECTOR == 64
    return (real)_mm512_sqrt_pd((__m512d)a);
#elif SPRING_X86_64 && SPRING_VECTOR == 32 && defined(SPRING_FLOAT)
    return (real)_mm256_sqrt_ps((__m256)a);
#elif SPRING_X86_64 && SPRING_VECTOR == 32
    return (real)_mm256_sqrt_pd((__m256d)a);
#elif SPRING_X86_64 && defined(SPRING_FLOAT)
    return (real)_mm_sqrt_ps((__m128)a);
#elif SPRING_X86_64
    return (real)_mm_sqrt_pd((__m128d)a);
#elif defined(__wasm_simd128__) && SPRING_VECTOR == 16 && defined(SPRING_FLOAT)
    return (real)wasm_f32x4_sqrt((v128_t)a);
#elif defined(__wasm_simd128__) && SPRING_VECTOR == 16
    return (real)wasm_f64x2_sqrt((v128_t)a);
#else
    scalar each[sizeof a / sizeof(scalar)];
    memcpy(each, &a, sizeof a);
    for (size_t i = 0; i < sizeof each / sizeof each[0]; i++)
        each[i] = scalar_sqrt(each[i]);
    memcpy(&a, each, sizeof a);
    return a;
#endif
}

#ifndef SPRING_FLOAT
SPRING_INLINE real_bits to_bits(real a)
{
    return (real_bits)a;
}

SPRING_INLINE real from_bits(real_bits b)
{
    return (real)b;
}

typedef float real_in_float __attribute__((vector_size(SPRING_VECTOR / 2)));

SPRING_INLINE real vec_load_float(const float *p) /* of any alignment */
{
#if SPRING_X86_64 && SPRING_VECTOR == 64
    return (real)_mm512_cvtps_pd(_mm256_loadu_ps(p));
#elif SPRING_X86_64 && SPRING_VECTOR == 32
    return (real)_mm256_cvtps_pd(_mm_loadu_ps(p));
#else
    real_in_float r;
    memcpy(&r, p, sizeof r);
    return __builtin_convertvector(r, real);
#endif
}

SPRING_INLINE void vec_store_float(float *p, real r)
{
#if SPRING_X86_64 && SPRING_VECTOR == 64
    _mm256_storeu_ps(p, _mm512_cvtpd_ps((__m512d)r));
#elif SPRING_X86_64 && SPRING_VECTOR == 32
    _mm_storeu_ps(p, _mm256_cvtpd_ps((__m256d)r));
#else
    const real_in_float rounded = __builtin_convertvector(r, real_in_float);
    memcpy(p, &rounded, sizeof rounded);
#endif
}

/* 1/sqrt(a) in float. */
SPRING_INLINE real vec_seed(real a)
{
#if SPRING_X86_64 && SPRING_VECTOR == 64
    return (real)_mm512_cvtps_pd(1 / _mm256_sqrt_ps(_mm512_cvtpd_ps((__m512d)a)));
#elif SPRING_X86_64 && SPRING_VECTOR == 32
    return (real)_mm256_cvtps_pd(1 / _mm_sqrt_ps(_mm256_cvtpd_ps((__m256d)a)));
#elif SPRING_X86_64
    return (real)_mm_cvtps_pd(1 / _mm_sqrt_ps(_mm_cvtpd_ps((__m128d)a)));
#elif defined(__wasm_simd128__) && SPRING_VECTOR == 16
    const v128_t root = wasm_f32x4_sqrt(wasm_f32x4_demote_f64x2_zero((v128_t)a));
    return (real)wasm_f64x2_promote_low_f32x4(wasm_f32x4_div(wasm_f32x4_const_splat(1), root));
#else
    for (size_t i = 0; i < sizeof a / sizeof(scalar); i++)
        a[i] = (scalar)(1 / (float)spring_sqrt((double)(float)a[i]));
    return a;
#endif
}
#endif

SPRING_INLINE real vec_abs(real a)
{
    return (real)(~(lane_mask)splat(-(scalar)0) & (lane_mask)a);
}

SPRING_INLINE real vec_minus_abs(real a)
{
    return (real)((lane_mask)splat(-(scalar)0) | (lane_mask)a);
}

/* The smaller; b if a is NaN. */
SPRING_INLINE real vec_min(real a, real b)
{
#if SPRING_X86_64 && SPRING_VECTOR == 64 && defined(SPRING_FLOAT)
    return (real)_mm512_min_ps((__m512)a, (__m512)b);
#elif SPRING_X86_64 && SPRING_VECTOR == 64
    return (real)_mm512_min_pd((__m512d)a, (__m512d)b);
#elif SPRING_X86_64 && SPRING_VECTOR == 32 && defined(SPRING_FLOAT)
    return (real)_mm256_min_ps((__m256)a, (__m256)b);
#elif SPRING_X86_64 && SPRING_VECTOR == 32
    return (real)_mm256_min_pd((__m256d)a, (__m256d)b);
#elif SPRING_X86_64 && defined(SPRING_FLOAT)
    return (real)_mm_min_ps((__m128)a, (__m128)b);
#elif SPRING_X86_64
    return (real)_mm_min_pd((__m128d)a, (__m128d)b);
#else
    return select_real(a < b, a, b);
#endif
}

#ifndef SPRING_FLOAT
/* vec_inverse_sqrt() for numbers of any size. */
SPRING_NOINLINE void vec_inverse_sqrt_of_any(real *a, int many)
{
    const lane_mask least = (lane_mask)splat(0x1p-84), beyond = (lane_mask){0} - ((int64_t)1 << 59);
    for (int k = 0; k < many; k++) {
        const lane_mask fits = (((lane_mask)a[k] - least) & beyond) == 0;
        const real one = select_real(fits, a[k], splat(1)), seed = vec_seed(one), rest = 1 - one * (seed * seed);
        const real root = seed + seed * rest * ((scalar)0.5 + (scalar)0.375 * rest);
        a[k] = select_real(fits, root, select_real(a[k] > 0, 1 / vec_sqrt(a[k]), splat(0)));
    }
}
#endif

/* 1/sqrt(a) for a > 0, and 0 for 0, of several vectors at once. Lanes outside of `where` have any result. The error is
   1 ulp with a seed, and 1.5 ulp with a quotient, as in float (tests/batch/test_inverse_sqrt.c).

   In double, the seed y comes from a square root and a quotient in float, which are several times as fast. The result
   is y (1 + r/2 + 3/8 r^2), r = 1 - a y^2. y has 24 bits, so its square is exact. |r| < 2^-20, so the omitted terms are
   below 2^-61. The last sum adds half an ulp at most, and a y^2 as much. Lanes with an exponent outside of
   2^-84 ... 2^43 use the quotient in double. This is a choice per lane, so results are the same in any vector. */
SPRING_INLINE void vec_inverse_sqrt(real *a, const lane_mask *where, int many)
{
#ifdef SPRING_FLOAT
    (void)where;
    SPRING_UNROLL
    for (int k = 0; k < many; k++)
        a[k] = select_real(a[k] > 0, 1 / vec_sqrt(a[k]), splat(0));
#else
    /* There are 128 exponents, so the difference to the bits of the least number has 7 + 52 bits. */
    const lane_mask least = (lane_mask)splat(0x1p-84), beyond = (lane_mask){0} - ((int64_t)1 << 59);
    real y[8], r[8];
    lane_mask wrong = {0};
    SPRING_UNROLL
    for (int k = 0; k < many; k++)
        wrong |= where[k] & ((lane_mask)a[k] - least);
    if (SPRING_UNLIKELY(any(wrong & beyond))) {
        real any_size[8]; /* a copy, so that a stays in registers */
        SPRING_UNROLL
        for (int k = 0; k < many; k++)
            any_size[k] = a[k];
        vec_inverse_sqrt_of_any(any_size, many);
        SPRING_UNROLL
        for (int k = 0; k < many; k++)
            a[k] = any_size[k];
        return;
    }
    SPRING_UNROLL
    for (int k = 0; k < many; k++)
        y[k] = vec_seed(a[k]);
    SPRING_UNROLL
    for (int k = 0; k < many; k++)
        r[k] = 1 - a[k] * (y[k] * y[k]);
    SPRING_UNROLL
    for (int k = 0; k < many; k++)
        a[k] = y[k] + y[k] * r[k] * ((scalar)0.5 + (scalar)0.375 * r[k]);
#endif
}
