/* SPDX-License-Identifier: MIT */
/* The kernels of batches for one vector width (SPRING_VECTOR bytes) and one precision (double, or float with
   SPRING_FLOAT), and their table SPRING_BATCH_TABLE. Included by the sources batch*.c of this folder. */
#ifndef SPRINGSTEP_BATCH_TMPL_H
#define SPRINGSTEP_BATCH_TMPL_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "../simd/target_begin.h"

#include "springs_tmpl.h"

SPRING_TABLE const batch_kernels SPRING_BATCH_TABLE = {
    .group_size = group,
    .advance = advance_springs,
#if SPRING_VECTOR == 64
    .narrower = &spring_batch_v256,
#elif SPRING_VECTOR == 32 && SPRING_HAS_V128
    .narrower = &spring_batch_v128,
#endif
};

#include "../simd/target_end.h"
#endif
