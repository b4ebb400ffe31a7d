/* SPDX-License-Identifier: MIT */
/* The self-test: it passes if the arithmetic is right, and otherwise names the fault. (tests/headers/contraction tests
   a library with fused products and sums.) */
#include <fenv.h>
#include <inttypes.h>
#include <stdio.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "check.h"
#include "spring/self_test.h"
#include "test_methods.h"

static void holds(void)
{
    CHECK(spring_self_test() == SPRING_OK, "here the arithmetic is right");
    for (int place = 0; place < SPRING_METHOD_COUNT; place++) {
        const spring_method m = spring_method_at(place);
        char what[80];
        snprintf(what, sizeof what, "%s: %#018" PRIx64, spring_method_name(m), spring_digest_of_method(m));
        CHECK(spring_digest_of_method(m) == spring_expected_digest(m), what);
    }
}

static void names_rounding(void)
{
    static const int ways[] = {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        CHECK(fesetround(ways[i]) == 0, "a way to round");
        const spring_status status = spring_self_test();
        fesetround(FE_TONEAREST);
        CHECK(status == SPRING_EROUNDING, "not to nearest");
    }
}

#if defined(__SSE2__)
static void names_flushing(void)
{
    static const unsigned ways[] = {0x8000, 0x0040}; /* results that are denormal become 0; operands count as 0 */
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        const unsigned before = _mm_getcsr();
        _mm_setcsr(before | ways[i]);
        const spring_status status = spring_self_test();
        _mm_setcsr(before);
        CHECK(status == SPRING_EFLUSHED, "no denormal numbers");
    }
}
#endif

int main(void)
{
    static const test tests[] = {
        {"holds", holds},
        {"names a way to round", names_rounding},
#if defined(__SSE2__)
        {"names flushed numbers", names_flushing},
#endif
    };
    return RUN_TESTS("self_test", tests);
}
