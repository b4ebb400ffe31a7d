/* SPDX-License-Identifier: MIT */
/* The digests of methods for spring_self_test(). */
#ifndef SPRINGSTEP_SELF_TEST_H
#define SPRINGSTEP_SELF_TEST_H

#include "../simd/arithmetic.h"

#include <springstep/spring.h>

/* Only the whole library has digests: see springstep.c about leaving parts out. */
#if !defined(SPRING_NO_BATCH) && !defined(SPRING_NO_SCENE) && !defined(SPRING_NO_FLOAT) && !defined(SPRING_NO_DOUBLE)
#define SPRING_WHOLE
SPRING_INTERNAL uint64_t spring_digest_of_method(spring_method m); /* of a short run on this machine */
SPRING_INTERNAL uint64_t spring_expected_digest(spring_method m);  /* the digest of correct results */
#endif

#endif
