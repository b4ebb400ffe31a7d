/* SPDX-License-Identifier: MIT */
/*
 * Bounds on the forces of links, from which the stable step of each method follows (method_limits.c).
 *
 * Method    Gershgorin's circles: no eigenvalue of M^-1 K exceeds the largest absolute row sum of that matrix. A link
 *           adds at most 2 stiffness/mass to the row of each of its particles, or stiffness/mass if its other end is
 *           pinned. A weighted link adds stiffness/mass |w_i| times the sum of |w_j| of its particles that are free.
 */
#include "method_limits.h"
#include "weighted_links.h"

#include <limits.h>
#include <string.h>

#include "../simd/size_begin.h"

typedef enum link_coefficient { STIFFNESS, DAMPING } link_coefficient;

static double coefficient_of(const stored_link *link, link_coefficient which)
{
    return (double)(which == STIFFNESS ? link->stiffness : link->damping);
}

/* What a weighted link adds to the sums of its particles. Returns false if it adds nothing. */
static bool terms_of_weighted(const spring_scene *s, size_t index, link_coefficient which, spring_weighted_link *link,
                              double term[4])
{
    const stored_weighted *const all = scene_read(s, ARRAY_WEIGHTED);
    *link = scene_weighted(&all[index]);
    const double value = which == STIFFNESS ? link->stiffness : link->damping;
    double inverse[4];
    weighted_inverse_masses(s, link, inverse);
    for (int k = 0; k < 4; k++)
        term[k] = value * weighted_row(link->weight, inverse, k);
    return value > 0;
}

static int exponent_of(double value)
{
    int exponent;
    frexp(value, &exponent);
    return exponent;
}

/* Sums are scaled by powers of two, which is exact: by the exponent of the inverse mass of each particle, and by a
   common exponent that keeps the largest term below 1. So no sum overflows, and terms that underflow do not matter. */
static int mass_exponent(const spring_scene *s, size_t i, bool by_mass)
{
    const double inverse = inverse_mass_at(s, i);
    const int pinned = INT_MIN / 4; /* no term */
    return !by_mass ? 0 : inverse > 0 ? exponent_of(inverse) : pinned;
}

/* The exponent of the largest term of all sums; 0 if there is none. */
static int largest_exponent(const spring_scene *s, link_coefficient which, double own, bool by_mass)
{
    const int lowest = INT_MIN / 2;
    int largest = lowest;
    for (size_t i = 0; i < s->layout.particles && own > 0; i++) {
        const int exponent = exponent_of(own) + mass_exponent(s, i, by_mass);
        largest = exponent > largest ? exponent : largest;
    }
    for (size_t i = 0; i < s->layout.links; i++) {
        const stored_link link = scene_link(s, i);
        const double value = coefficient_of(&link, which);
        if (value == 0)
            continue;
        const int a = mass_exponent(s, link.a, by_mass), b = mass_exponent(s, link.b, by_mass);
        const int exponent = exponent_of(value) + (a > b ? a : b);
        largest = exponent > largest ? exponent : largest;
    }
    spring_weighted_link link;
    double term[4];
    for (size_t i = 0; i < s->layout.weighted; i++)
        for (int k = 0; terms_of_weighted(s, i, which, &link, term) && k < 4; k++)
            if (term[k] > 0) {
                const int exponent = exponent_of(term[k]) + mass_exponent(s, link.particle[k], by_mass);
                largest = exponent > largest ? exponent : largest;
            }
    return largest > lowest ? largest : 0;
}

/* Sums a coefficient over the links of each particle: twice the coefficient, or once if the other end is pinned. Returns
   the exponent by which the sums, and with by_mass also the inverse masses, are scaled. */
static int add_up_links(spring_scene *s, link_coefficient which, double own, bool by_mass)
{
    const int exponent = largest_exponent(s, which, own, by_mass);
    scalar *const sum = scene_memory(s, ARRAY_SUMS);
    memset(sum, 0, s->layout.particles * sizeof *sum);
    for (size_t i = 0; i < s->layout.links; i++) {
        const stored_link link = scene_link(s, i);
        const double value = coefficient_of(&link, which);
        if (value == 0)
            continue;
        const int twice_a = inverse_mass_at(s, link.b) > 0, twice_b = inverse_mass_at(s, link.a) > 0;
        sum[link.a] += (scalar)ldexp(value, twice_a + mass_exponent(s, link.a, by_mass) - exponent);
        sum[link.b] += (scalar)ldexp(value, twice_b + mass_exponent(s, link.b, by_mass) - exponent);
    }
    spring_weighted_link link;
    double term[4];
    for (size_t i = 0; i < s->layout.weighted; i++)
        for (int k = 0; terms_of_weighted(s, i, which, &link, term) && k < 4; k++)
            if (term[k] > 0)
                sum[link.particle[k]] += (scalar)ldexp(term[k], mass_exponent(s, link.particle[k], by_mass) - exponent);
    return exponent;
}

/* The sum of a particle plus `own`, scaled by the exponent of add_up_links(); by_mass: multiplied by the inverse mass.
   0 for pinned particles. */
static double sum_of_particle(const spring_scene *s, size_t i, int exponent, double own, bool by_mass)
{
    const scalar *const sum = scene_read(s, ARRAY_SUMS);
    const double inverse = inverse_mass_at(s, i);
    const int unit = mass_exponent(s, i, by_mass);
    return inverse > 0 ? ((double)sum[i] + ldexp(own, unit - exponent)) * (by_mass ? ldexp(inverse, -unit) : 1) : 0;
}

/* The largest of these sums. */
static double largest_sum(spring_scene *s, link_coefficient which, double own, bool by_mass)
{
    const int exponent = add_up_links(s, which, own, by_mass);
    double largest = 0;
    for (size_t i = 0; i < s->layout.particles; i++)
        largest = fmax(largest, sum_of_particle(s, i, exponent, own, by_mass));
    return ldexp(largest, exponent);
}

void spring_scene_find_roots(spring_scene *s, double dt, double most)
{
    const int exponent = add_up_links(s, DAMPING, 0, true);
    scalar *const sum = scene_memory(s, ARRAY_SUMS), *const root = scene_memory(s, ARRAY_ROOTS);
    for (size_t i = 0; i < s->layout.links; i++) {
        const stored_link link = scene_link(s, i);
        const double larger =
            fmax(sum_of_particle(s, link.a, exponent, 0, true), sum_of_particle(s, link.b, exponent, 0, true));
        const double factor = fmin(1, ldexp(most / (dt * larger), -exponent));
        const double size = spring_sqrt((double)link.damping * factor);
        root[scene_link_place(s, i).slot] = (scalar)(link.rest == 0 && s->layout.axes > 1 ? -size : size);
    }
    stored_weighted *const weighted = scene_memory(s, ARRAY_WEIGHTED);
    for (size_t i = 0; i < s->layout.weighted; i++) {
        stored_weighted *const link = &weighted[i];
        double larger = 0;
        for (int k = 0; k < link->points; k++)
            larger = fmax(larger, link->weight[k] != 0 ? sum_of_particle(s, link->particle[k], exponent, 0, true) : 0);
        const double factor = larger > 0 ? fmin(1, ldexp(most / (dt * larger), -exponent)) : 1;
        link->root = (scalar)spring_sqrt((double)link->damping * factor);
        if (link->banded)
            root[link->slot] = (scalar)(fabs((double)link->weight[1]) * spring_sqrt((double)link->damping * factor));
    }
    for (size_t i = 0; i < s->layout.particles; i++) {
        const double reach = dt * ldexp(sum_of_particle(s, i, exponent, 0, true), exponent);
        sum[i] = (scalar)(1 / (1 + reach * reach / 4));
    }
}

static double least_inverse_mass(const spring_scene *s) /* of the free particles; 0: there are none */
{
    double least = (double)INFINITY;
    for (size_t i = 0; i < s->layout.particles; i++)
        if (inverse_mass_at(s, i) > 0)
            least = fmin(least, inverse_mass_at(s, i));
    return least < (double)INFINITY ? least : 0;
}

static scene_bounds bounds_of(spring_scene *s)
{
    return (scene_bounds){
        .stiffness = largest_sum(s, STIFFNESS, 0, true),
        .link_damping = largest_sum(s, DAMPING, 0, true),
        .damping = largest_sum(s, DAMPING, s->drag, true),
        .stiffness_sum = largest_sum(s, STIFFNESS, 0, false),
        .drag = s->drag,
        .least_drag = s->drag * least_inverse_mass(s),
    };
}

const scene_bounds *spring_scene_find_bounds(spring_scene *s)
{
    if (!s->bounds_known) {
        s->bounds = bounds_of(s);
        s->bounds_known = true;
        s->roots_dt = 0;
    }
    return &s->bounds;
}

double spring_scene_stable_step(spring_scene *s, spring_method m)
{
    if (s == NULL || spring_method_describe(m) == NULL || spring_method_limits[m].stable_step == NULL)
        return (double)NAN;
    return spring_method_limits[m].stable_step(spring_scene_find_bounds(s));
}

#include "../simd/size_end.h"
