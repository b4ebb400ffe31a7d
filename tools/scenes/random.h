/* SPDX-License-Identifier: MIT */
/* Pseudorandom numbers, the same in every run. */
#ifndef SPRINGSTEP_RANDOM_H
#define SPRINGSTEP_RANDOM_H

#include <stdint.h>

/* Returns the next number, uniform in [0, 1). Any initial state is valid.
   Source: Steele, Lea, Flood, Fast splittable pseudorandom number generators, OOPSLA 2014. */
static inline double random_unit(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

#endif
