/* SPDX-License-Identifier: MIT */
/*
 * The coefficients of SRKN6; its formula is in srkn6.h.
 *
 * Source    The paper gives 15 digits of b1 ... b5 and a1 ... a5; b6 = 1/2 - (b1 + ... + b5),
 *           a6 = 1 - 2 (a1 + ... + a5).
 *           tests/spring/srkn6_coefficients.py solves the order conditions to full precision. They have rank 6 in these
 *           ten numbers, so Newton's method takes the shortest step to a solution. It changes no coefficient by more
 *           than 6.2e-16.
 */
#ifndef SPRINGSTEP_SRKN6_COEFFICIENTS_H
#define SPRINGSTEP_SRKN6_COEFFICIENTS_H

enum { srkn6_stages = 11, srkn6_different = 6 };

/* Kicks before, and drifts, 1 ... 6. The following kicks and drifts have the same coefficients in reverse order. */
static const double srkn6_b[srkn6_different] = {
    0.04146499851826284329877813391470494,  0.1981286719180665411367264731814970,
    -0.04000619210415268688882836353594484, 0.07525398430158034112787887852704276,
    -0.01151138742068777006244320150128920, 0.2366699247869307313878880794139894};
static const double srkn6_a[srkn6_different] = {
    0.1232297759462711515610863803333668,  0.2905537977995582703664141693279162, -0.1270492126254169156625050538274859,
    -0.2463317610620754041949734891040629, 0.3572088727959277526198603496193105, 0.2047770542914702906202352873019108};

/* Time after each drift, as a fraction of the step. */
static const double srkn6_c[srkn6_stages] = {0.1232297759462711515610864,
                                             0.4137835737458294219275005,
                                             0.2867343611204125062649955,
                                             0.04040260005833710207002201,
                                             0.3976114728542648546898824,
                                             0.6023885271457351453101176,
                                             0.9595973999416628979299780,
                                             0.7132656388795874937350045,
                                             0.5862164262541705780724995,
                                             0.8767702240537288484389136,
                                             1};

/* Index of the coefficient of kick or drift i, if a step has n of them. */
static inline int srkn6_index(int i, int n)
{
    return i < n - i ? i : n - 1 - i;
}

#endif
