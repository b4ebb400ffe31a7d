/* SPDX-License-Identifier: MIT */
/* The list of methods. Tables, help texts and figures show the methods in the order of METHODS. */
#ifndef SPRINGSTEP_METHODS_H
#define SPRINGSTEP_METHODS_H

#include "euler_tmpl.h"
#include "exact.h"
#include "leapfrog_tmpl.h"
#include "rk4_tmpl.h"
#include "rkn8.h"
#include "srkn6.h"
#include "symplectic_euler_tmpl.h"

/* ROW(value, its description, its functions for one spring). Descriptions are a table of their own, so that a program
   without single springs does not contain their functions. */
#define METHODS(ROW)                                                             \
    ROW(SPRING_EULER, euler_info, euler_method)                                  \
    ROW(SPRING_SYMPLECTIC_EULER, symplectic_euler_info, symplectic_euler_method) \
    ROW(SPRING_LEAPFROG, leapfrog_info, leapfrog_method)                         \
    ROW(SPRING_RK4, rk4_info, rk4_method)                                        \
    ROW(SPRING_SRKN6, srkn6_info, srkn6_method)                                  \
    ROW(SPRING_RKN8, rkn8_info, rkn8_method)                                     \
    ROW(SPRING_EXACT, exact_info, exact_method)

/* ROW(value, prepare, start, step): the methods that advance springs step by step */
#define STEP_METHODS(ROW)                                                                        \
    ROW(SPRING_EULER, euler_prepare, keeps_nothing, euler_step)                                  \
    ROW(SPRING_SYMPLECTIC_EULER, symplectic_euler_prepare, keeps_nothing, symplectic_euler_step) \
    ROW(SPRING_LEAPFROG, leapfrog_prepare, leapfrog_force, leapfrog_step)                        \
    ROW(SPRING_RK4, rk4_prepare, keeps_nothing, rk4_step)

#endif
