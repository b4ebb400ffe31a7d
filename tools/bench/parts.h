/* SPDX-License-Identifier: MIT */
/* The parts of spring-bench. */
#ifndef SPRINGSTEP_BENCH_PARTS_H
#define SPRINGSTEP_BENCH_PARTS_H

#include <stdbool.h>

#include <springstep/spring.h>

/* Each function adds the rows of its part to the table. */
void bench_add_springs(void);
void bench_add_batches(void);
void bench_add_scenes(void);

/** The textbook formula of a spring that is not critically damped; `damped`, `loaded` are false if g, a are zero. */
spring_state bench_textbook(spring_state s, double w, double g, double a, double t, bool damped, bool loaded);

#endif
