/* SPDX-License-Identifier: MIT */
/* What a fuzz target offers to its driver, libFuzzer's or replay.c, and how it reports a fault. */
#ifndef FUZZ_H
#define FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static inline void must(bool holds, const char *what)
{
    if (holds)
        return;
    fprintf(stderr, "fuzz target: %s\n", what);
    abort();
}

#endif
