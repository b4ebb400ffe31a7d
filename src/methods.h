/* SPDX-License-Identifier: MIT */
/* The methods, in the order in which tables, help texts and figures show them. To add one: its header, and its row. */
#ifndef SPRINGSTEP_METHODS_H
#define SPRINGSTEP_METHODS_H

#include "euler.h"
#include "symplectic_euler.h"
#include "leapfrog.h"
#include "rk4.h"
#include "rkn8.h"
#include "exact.h"

#define SPRING_METHODS(ROW)                        \
    ROW(SPRING_EULER, euler)                       \
    ROW(SPRING_SYMPLECTIC_EULER, symplectic_euler) \
    ROW(SPRING_LEAPFROG, leapfrog)                 \
    ROW(SPRING_RK4, rk4)                           \
    ROW(SPRING_RKN8, rkn8)                         \
    ROW(SPRING_EXACT, exact)

#endif
