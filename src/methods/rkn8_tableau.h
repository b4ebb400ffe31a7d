/* SPDX-License-Identifier: MIT */
/* The coefficients of RKN8; its formula is in rkn8.h. */
#ifndef SPRINGSTEP_RKN8_TABLEAU_H
#define SPRINGSTEP_RKN8_TABLEAU_H

#include "../simd/scalar.h"

enum { rkn8_stages = 7 }; /* after the first */

/* Coefficients of the second to the eighth stage. */
static const double rkn8_c[rkn8_stages] = {1. / 20, 1. / 10, 3. / 10, 1. / 2, 7. / 10, 9. / 10, 1};
#define QUOTIENT(p, q) ((scalar)((double)(p) / (q)))
/* clang-format off */
static const scalar rkn8_a[rkn8_stages][rkn8_stages] = {
    {QUOTIENT(1, 800)},
    {QUOTIENT(1, 600), QUOTIENT(1, 300)},
    {QUOTIENT(9, 200), QUOTIENT(-9, 100), QUOTIENT(9, 100)},
    {QUOTIENT(-66701, 197352), QUOTIENT(28325, 32892), QUOTIENT(-2665, 5482), QUOTIENT(2170, 24669)},
    {QUOTIENT(227015747, 304251000), QUOTIENT(-54897451, 30425100), QUOTIENT(12942349, 10141700), QUOTIENT(-9499, 304251),
     QUOTIENT(539, 9250)},
    {QUOTIENT(-1131891597, 901789000), QUOTIENT(41964921, 12882700), QUOTIENT(-6663147, 3220675), QUOTIENT(270954, 644135),
     QUOTIENT(-108, 5875), QUOTIENT(114, 1645)},
    {QUOTIENT(13836959, 3667458), QUOTIENT(-17731450, 1833729), QUOTIENT(1063919505, 156478208), QUOTIENT(-33213845, 39119552),
     QUOTIENT(13335, 28544), QUOTIENT(-705, 14272), QUOTIENT(1645, 57088)},
};
static const scalar rkn8_b[rkn8_stages + 1] = {
    QUOTIENT(223, 7938), 0, QUOTIENT(1175, 8064), QUOTIENT(925, 6048), QUOTIENT(41, 448), QUOTIENT(925, 14112), QUOTIENT(1175, 72576)};
static const scalar rkn8_b_v[rkn8_stages + 1] = {
    QUOTIENT(223, 7938), 0, QUOTIENT(5875, 36288), QUOTIENT(4625, 21168), QUOTIENT(41, 224), QUOTIENT(4625, 21168), QUOTIENT(5875, 36288),
    QUOTIENT(223, 7938)};
/* clang-format on */

#endif
