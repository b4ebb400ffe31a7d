/* SPDX-License-Identifier: MIT */
/*
 * Saving and loading the state of a scene.
 *
 * Format    Little-endian: a header of 64-bit words, sections of numbers, each padded with zeros to a multiple of 8
 *           bytes, and a check value. docs/details.md describes it. list_sections() is the only list of the sections:
 *           the size, save and load follow it. A new field is a row there, or a word of the header.
 * Sections  For each kind of section, one function moves its numbers in both directions, and one checks them.
 * Loading   checks everything before it changes the scene. Sections are checked and moved in the order of the list, so
 *           that a section may use those before it.
 */
#include "state_numbers.h"
#include "weighted_links.h"

#include "../simd/size_begin.h"

/* ----------------------------------------------------------------------------------------------------------- header */

/* All members are words. Those before `bytes` must be equal in the scene that loads the state. */
typedef struct state_header {
    uint64_t magic, version;
    uint64_t precision; /* [bytes] of a number */
    uint64_t axes, flags, methods, most_colliders, particles, links, weighted_links;
    uint64_t ends; /* spring_scene.ends */
    uint64_t callback;
    uint64_t bytes;    /* of the state */
    uint64_t kept;     /* cached_force */
    uint64_t damped;   /* links; of an editable scene those that are damped when they act */
    uint64_t bodies;   /* colliders */
    uint64_t touching; /* particles that touch colliders */
    double t0, dt;
    uint64_t steps;
    double colliders_base;
    uint64_t colliders_from;
    double gravity[3];
} state_header;

enum { header_words = 25, format_version = 1 };
_Static_assert(sizeof(state_header) == header_words * word_bytes, "a header consists of words");

static uint64_t count_damped(const spring_scene *s)
{
    uint64_t count = s->damped_links;
    if (!scene_is_editable(s))
        return count;
    const tether *const tethers = scene_read(s, ARRAY_TETHERS);
    for (size_t i = 0; i < s->layout.tethers; i++)
        count += tethers[i].damping > 0 && !(scene_link(s, tethers[i].link).damping > 0);
    return count - s->damped_weighted;
}

static uint64_t state_magic(void)
{
    return word_at((const uint8_t *)"SPRSTATE");
}

/* The header without the number of bytes. */
static state_header header_of(const spring_scene *s)
{
    const scene_layout *const l = &s->layout;
    const uint32_t *const touched = scene_read(s, touched_in(s->buffer));
    state_header h = {
        .magic = state_magic(),
        .version = format_version,
        .precision = sizeof(scalar),
        .axes = l->axes,
        .flags = s->force != NULL ? l->flags : l->flags & ~(uint32_t)SPRING_SCENE_FORCE_IGNORES_VELOCITY,
        .methods = l->methods,
        .most_colliders = l->colliders,
        .particles = l->particles,
        .links = l->links,
        .weighted_links = l->weighted,
        .ends = s->ends,
        .callback = s->force != NULL,
        .kept = s->force_cache,
        .damped = count_damped(s),
        .bodies = s->colliders,
        .t0 = s->t0,
        .dt = s->dt,
        .steps = s->steps,
        .colliders_base = s->colliders > 0 ? s->colliders_base : 0,
        .colliders_from = s->colliders > 0 ? s->colliders_from : 0,
        .gravity = {s->gravity[0], s->gravity[1], s->gravity[2]},
    };
    for (size_t i = 0; i < l->particles && s->colliders > 0; i++)
        h.touching += touched[i] != 0;
    return h;
}

/* Whether the state is of a scene with this definition, as far as states show. */
static bool header_matches(const spring_scene *s, const state_header *h)
{
    const state_header own = header_of(s);
    return memcmp(h, &own, offsetof(state_header, bytes)) == 0 && (scene_is_editable(s) || h->damped == own.damped);
}

static bool header_valid(const spring_scene *s, const state_header *h)
{
    const scene_layout *const l = &s->layout;
    for (uint32_t a = 0; a < l->axes; a++)
        if (!value_fits(sizeof(scalar), h->gravity[a]))
            return false;
    const bool predicts = l->offset[ARRAY_FORCE_1] != l->offset[ARRAY_FORCE_0];
    return h->kept <= (predicts ? PREDICTED_FORCE : FORCE) && (!scene_is_editable(s) || h->damped <= l->links) &&
           h->bodies <= l->colliders && h->touching <= (h->bodies > 0 ? l->particles : 0) &&
           value_fits(sizeof(scalar), h->dt) && h->colliders_from <= h->steps &&
           spring_finite(h->t0 + (double)h->steps * h->dt) &&
           spring_finite(h->colliders_base + (double)(h->steps - h->colliders_from) * h->dt);
}

/* --------------------------------------------------------------------------------------------------------- sections */

/* Which numbers of a section are valid. STRENGTHS: not negative, and finite if multiplied by 2/mass of any particle */
typedef enum valid_numbers { ANY, FINITE, NOT_NEGATIVE, STRENGTHS } valid_numbers;

/* A state that is being checked. */
typedef struct arriving {
    const spring_scene *s;
    const state_header *header;
    const uint8_t *masses, *pins; /* sections of editable scenes */
    scalar lightest;              /* [1/kg] largest inverse mass of a free particle */
} arriving;

typedef struct section section;
struct section {
    /* Moves the section from the state to the scene (load), or from the scene, which stays as it is, to the state. */
    void (*move)(spring_scene *s, const section *row, uint8_t *state, bool load);
    /* fine: whether its numbers are valid. NULL: there is nothing else to check */
    bool (*valid)(arriving *a, const section *row, uint8_t *state, bool fine);
    valid_numbers numbers;
    scene_array array;
    size_t count; /* elements */
    size_t bits;  /* of an element */
};

static size_t section_bytes(const section *row)
{
    return (row->count * row->bits + 63) / 64 * word_bytes;
}

#include "../simd/size_end.h"

static inline scalar number_at(const uint8_t *state, size_t i)
{
    scalar number;
    copy_numbers(&number, state + i * sizeof number, 1, sizeof number);
    return number;
}

/* A quantity: all particles on the first axis, then on the next. */
static void move_quantity(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    const size_t particles = s->layout.particles;
    for (uint32_t a = 0; a < s->layout.axes; a++, state += particles * sizeof(scalar))
        move_numbers(scene_axis(s, row->array, a), state, particles, sizeof(scalar), load);
}

/* Inverse masses of particles while they are free, and pins. */

static void move_masses(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    move_numbers(scene_memory(s, row->array), state, row->count, sizeof(scalar), load);
}

static bool masses_valid(arriving *a, const section *row, uint8_t *state, bool fine)
{
    const uint8_t *const pins = state + section_bytes(row);
    scalar least = SCALAR_MAX, lightest = 0;
    for (size_t i = 0; i < row->count; i++) {
        const scalar inverse = number_at(state, i);
        if (bit_at(pins, i))
            continue;
        least = inverse < least ? inverse : least;
        lightest = inverse > lightest ? inverse : lightest;
    }
    a->masses = state;
    a->pins = pins;
    a->lightest = lightest;
    return fine && least > 0 && value_fits(sizeof(scalar), a->s->drag * (double)lightest);
}

static void move_pins(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    scalar *const inverse = scene_memory(s, row->array);
    if (load)
        memcpy(inverse, scene_read(s, ARRAY_FREE_MASS), row->count * sizeof *inverse);
    for (size_t i = 0; i < row->count && load; i = next_bit(state, i))
        if (bit_at(state, i))
            inverse[i] = 0;
    for (size_t i = 0; i < row->count && !load; i++)
        if (inverse[i] == 0)
            set_bit(state, i);
}

/* Coefficients of the links of an editable scene, in the order of their indices. The scene has them by slot. */

/* array: ARRAY_BAND_..., which ARRAY_LINK_... follows. The result is that of slot 0. */
static scalar *coefficients_of(spring_scene *s, scene_array array)
{
    return scene_memory(s, s->layout.bands > 0 ? array : (scene_array)(array + 1));
}

SPRING_INLINE void move_by_slot(scalar *first, const uint32_t *slots, uint8_t *state, size_t count, bool load)
{
    for (size_t i = 0; i < count; i++)
        move_numbers(&first[slots[i]], state + i * sizeof(scalar), 1, sizeof(scalar), load);
}

static void move_coefficients(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    const uint32_t *const slots = scene_read(s, ARRAY_SLOTS); /* NULL: each link has the slot of its index */
    scalar *const first = coefficients_of(s, row->array);
    if (slots == NULL)
        move_numbers(first, state, row->count, sizeof(scalar), load);
    else if (load)
        move_by_slot(first, slots, state, row->count, true);
    else
        move_by_slot(first, slots, state, row->count, false);
}

/* Rest lengths. With one axis, a link from the upper to the lower end has a negative one. Links of bands are stored
   like that, other links with the sign for their order of the ends. With more axes, links with flags are stored with a
   sign. */
static void move_rests(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    const uint32_t *const slots = scene_read(s, ARRAY_SLOTS);
    const uint32_t *const a = scene_read(s, ARRAY_LINK_A), *const b = scene_read(s, ARRAY_LINK_B);
    const uint8_t *const flags = scene_read(s, ARRAY_FLAGS);
    const bool directed = s->layout.axes == 1, all = (s->layout.flags & SPRING_SCENE_TENSION_ONLY) != 0;
    const size_t band_slots = s->layout.band_slots;
    scalar *const first = coefficients_of(s, row->array);
    move_coefficients(s, row, state, load);
    for (size_t i = 0; i < row->count && (directed ? a != NULL : all || flags != NULL); i++) {
        const size_t slot = slots != NULL ? slots[i] : i, at = slot - band_slots;
        if (directed ? slot < band_slots || a[at] < b[at] : !all && flags[i] == 0)
            continue;
        if (load)
            first[slot] = -first[slot];
        else
            state[(i + 1) * sizeof(scalar) - 1] ^= 0x80;
    }
}

/* Stiffness or damping. While a tether does not act, it has 0 where other links have their coefficients. */
static void move_strengths(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    scalar *const first = coefficients_of(s, row->array);
    tether *const tethers = scene_memory(s, ARRAY_TETHERS);
    move_coefficients(s, row, state, load);
    for (size_t i = 0; i < s->layout.tethers; i++) {
        const link_place at = scene_link_place(s, tethers[i].link);
        scalar *const own = row->array == ARRAY_BAND_STIFFNESS ? &tethers[i].stiffness : &tethers[i].damping;
        move_numbers(own, state + tethers[i].link * sizeof(scalar), 1, sizeof(scalar), load);
        if (load && (inverse_mass_at(s, at.a) == 0) == (inverse_mass_at(s, at.b) == 0))
            first[at.slot] = 0;
    }
}

/* The inverse mass of a particle in the state. */
static double arriving_inverse_mass(const arriving *a, size_t i)
{
    return bit_at(a->pins, i) ? 0 : (double)number_at(a->masses, i);
}

/* As in spring_scene_check(), twice the value divided by the mass of an end must be finite. Usually all values would be
   valid for the lightest particle. */
static bool strengths_valid(arriving *a, const section *row, uint8_t *state, bool fine)
{
    for (size_t i = 0; i < row->count && !fine; i++) {
        const link_place at = scene_link_place(a->s, i);
        const double lighter = fmax(arriving_inverse_mass(a, at.a), arriving_inverse_mass(a, at.b));
        const double strength = (double)number_at(state, i);
        if (!value_not_negative(sizeof(scalar), strength) || !value_fits(sizeof(scalar), 2 * (strength * lighter)))
            return false;
    }
    return true;
}

static bool dampings_valid(arriving *a, const section *row, uint8_t *state, bool fine)
{
    size_t damped = 0;
    for (size_t i = 0; i < row->count; i++)
        damped += number_at(state, i) > 0;
    return damped == a->header->damped && strengths_valid(a, row, state, fine);
}

/* Weighted links of an editable scene. The weights are in the order of stored_weighted. */

typedef struct weighted_numbers {
    scalar weight[4], rest, stiffness, damping; /* as in stored_weighted */
    scalar banded;                              /* 1 if a band computes it, otherwise 0 */
} weighted_numbers;

enum { weighted_count = sizeof(weighted_numbers) / sizeof(scalar) };
_Static_assert(offsetof(stored_weighted, damping) - offsetof(stored_weighted, weight) ==
                   offsetof(weighted_numbers, damping),
               "the numbers except the last are moved together");

static void move_weighted(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    stored_weighted *l = scene_memory(s, row->array);
    for (size_t i = 0; i < row->count; i++, l++, state += sizeof(weighted_numbers)) {
        scalar banded = l->banded;
        move_numbers((char *)l + offsetof(stored_weighted, weight), state, weighted_count - 1, sizeof(scalar), load);
        move_numbers(&banded, state + offsetof(weighted_numbers, banded), 1, sizeof(scalar), load);
        if (!load)
            continue;
        l->banded = banded != 0;
        if (l->slot != no_slot)
            scene_fill_slot(s, l, l->slot);
        scene_count_weighted(s, l, true);
    }
}

/* Whether no product of weights and masses is too large. */
static bool weighted_fits(const arriving *a, const stored_weighted *l, const weighted_numbers *n)
{
    spring_weighted_link link = {.stiffness = (double)n->stiffness, .damping = (double)n->damping};
    double inverse[4] = {0};
    for (int k = 0; k < l->points; k++) {
        link.weight[k] = (double)n->weight[k];
        inverse[k] = n->weight[k] != 0 ? arriving_inverse_mass(a, l->particle[k]) : 0;
    }
    return spring_weighted_overflows(&link, sizeof(scalar), inverse) == NULL;
}

static bool weighted_valid(arriving *a, const section *row, uint8_t *state, bool fine)
{
    const bool single = sizeof(scalar) < sizeof(double);
    const double rounding = single ? 4 * (double)SCALAR_EPSILON : 1e-12, denormal = single ? 0x1p-147 : 0;
    const double lightest = a->lightest > 1 ? (double)a->lightest : 1;
    const stored_weighted *l = scene_read(a->s, row->array);
    for (size_t i = 0; i < row->count && fine; i++, l++, state += sizeof(weighted_numbers)) {
        weighted_numbers n;
        copy_numbers(&n, state, weighted_count, sizeof(scalar));
        const scalar *const w = n.weight;
        const bool fits = l->slot != no_slot && weights_of_band(w);
        double sum = 0, largest = fabs((double)w[0]);
        for (int k = 0; k < 4 && !fits; k++) {
            const double weight = (double)w[k], size = fabs(weight);
            sum += weight;
            largest = size > largest ? size : largest;
            fine = fine && (k < l->points || weight == 0);
        }
        const double strength = (double)(n.stiffness > n.damping ? n.stiffness : n.damping);
        const double most = 4 * largest * largest * strength * lightest; /* 4 particles */
        fine = fine && fabs(sum) <= rounding * largest + denormal && n.rest >= 0 && n.stiffness >= 0 &&
               n.damping >= 0 && (n.banded == 0 || (n.banded == 1 && fits && n.rest == 0)) &&
               (most < (double)SCALAR_MAX / 2 || weighted_fits(a, l, &n));
    }
    return fine;
}

/* Counts damped links of rest length 0, or makes all damping 0 if the state has none. */
static void settle_damping(spring_scene *s, size_t first, size_t slots, bool damped)
{
    if (slots == 0)
        return;
    scalar *const damping = coefficients_of(s, ARRAY_BAND_DAMPING) + first;
    const scalar *const rest = coefficients_of(s, ARRAY_BAND_REST) + first;
    if (!damped)
        memset(damping, 0, slots * sizeof *damping);
    for (size_t i = 0; i < slots && damped && s->layout.axes > 1; i++)
        s->isotropic_links += (rest[i] == 0) & (damping[i] > 0);
}

/* What follows from the coefficients of links. */
static void settle_links(spring_scene *s, uint64_t damped)
{
    const scene_layout *const l = &s->layout;
    const size_t slots = l->three_point_bands > 0 ? l->band[l->bands - l->three_point_bands].slots : l->band_slots;
    const scalar *const stiffness = scene_read(s, ARRAY_BAND_STIFFNESS);
    const scalar *const damping = scene_read(s, ARRAY_BAND_DAMPING);
    int8_t *const occupied = scene_memory(s, ARRAY_OCCUPIED);
    tether *const tethers = scene_memory(s, ARRAY_TETHERS);
    settle_damping(s, 0, slots, damped > 0);
    settle_damping(s, l->band_slots, l->unbanded, damped > 0);
    for (size_t i = 0; i < l->tethers && damped == 0; i++)
        tethers[i].damping = 0;
    /* count_damped() returns the damped tethers that do not act, because no other link has been counted. */
    s->damped_links += damped - count_damped(s);
    for (size_t i = 0; i < slots; i++)
        occupied[i] = stiffness[i] + damping[i] > 0 ? -1 : 0;
}

#include "../simd/size_begin.h"

static void move_colliders(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    spring_state_colliders(scene_memory(s, row->array), s->colliders, row->count, state, load);
}

static bool colliders_valid(arriving *a, const section *row, uint8_t *state, bool fine)
{
    return fine && spring_state_colliders_valid(scene_read(a->s, row->array), a->s->colliders, row->count, state,
                                                sizeof(scalar), (double)a->s->largest_radius, a->s->layout.axes);
}

#include "../simd/size_end.h"

/* The particles that touch colliders, and the bits of these colliders. */

static void move_touching(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    uint32_t *const touched = scene_memory(s, row->array); /* 0 for load */
    for (size_t i = 0; i < row->count && load; i = next_bit(state, i))
        touched[i] = bit_at(state, i);
    for (size_t i = 0; i < row->count && !load; i++)
        if (touched[i] != 0)
            set_bit(state, i);
}

static bool touching_valid(arriving *a, const section *row, uint8_t *state, bool fine)
{
    size_t count = 0;
    for (size_t i = 0; i < row->count; i = next_bit(state, i))
        count += bit_at(state, i);
    return fine && count == a->header->touching;
}

static uint32_t touched_at(const section *row, const uint8_t *state, size_t i)
{
    uint32_t bits = 0;
    for (size_t k = 0; k < row->bits / 8; k++)
        bits |= (uint32_t)state[i * row->bits / 8 + k] << 8 * k;
    return bits;
}

static void move_touched(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    uint32_t *touched = scene_memory(s, row->array);
    for (size_t i = 0; i < row->count; i++, touched++) {
        while (*touched == 0)
            touched++;
        for (size_t k = 0; k < row->bits / 8 && !load; k++)
            state[i * row->bits / 8 + k] = (uint8_t)(*touched >> 8 * k);
        *touched = load ? touched_at(row, state, i) : *touched;
    }
}

static bool touched_valid(arriving *a, const section *row, uint8_t *state, bool fine)
{
    for (size_t i = 0; i < row->count; i++) {
        const uint64_t bits = touched_at(row, state, i);
        fine = fine && bits != 0 && bits >> a->header->bodies == 0;
    }
    return fine;
}

#include "../simd/size_begin.h"

enum { most_sections = 13 };

/* The sections of a state, in their order. A section without elements is omitted. */
static void list_sections(const spring_scene *s, const state_header *h, section list[most_sections])
{
    const scene_layout *const l = &s->layout;
    const bool editable = scene_is_editable(s), holds = (l->flags & SPRING_SCENE_FORCES) != 0;
    const size_t number = 8 * sizeof(scalar), numbers = l->axes * l->particles,
                 kept = h->kept != NO_FORCE ? numbers : 0;
    const size_t particles = editable ? l->particles : 0, links = editable ? l->links : 0;
    const size_t damped = h->damped > 0 ? links : 0, bodies = (size_t)h->bodies;
    const scene_array touched = touched_in(s->buffer);
    /* Kept forces may be infinite: RKN8 uses the last ones only in the next call, which then fails. */
    const section rows[most_sections] = {
        {move_quantity, NULL, FINITE, positions_in(s->buffer), numbers, number},
        {move_quantity, NULL, FINITE, velocities_in(s->buffer), numbers, number},
        {move_quantity, NULL, ANY, forces_in(s->buffer), kept, number},
        {move_quantity, NULL, FINITE, ARRAY_HELD, holds ? numbers : 0, number},
        {move_masses, masses_valid, NOT_NEGATIVE, ARRAY_FREE_MASS, particles, number},
        {move_pins, NULL, ANY, ARRAY_INVERSE_MASS, particles, 1},
        {move_rests, NULL, l->axes == 1 ? FINITE : NOT_NEGATIVE, ARRAY_BAND_REST, links, number},
        {move_strengths, strengths_valid, STRENGTHS, ARRAY_BAND_STIFFNESS, links, number},
        {move_strengths, dampings_valid, STRENGTHS, ARRAY_BAND_DAMPING, damped, number},
        {move_weighted, weighted_valid, FINITE, ARRAY_WEIGHTED, editable ? l->weighted : 0, weighted_count * number},
        {move_colliders, colliders_valid, ANY, ARRAY_COLLIDERS, bodies, 64 * collider_words},
        {move_touching, touching_valid, ANY, touched, bodies > 0 ? l->particles : 0, 1},
        {move_touched, touched_valid, ANY, touched, (size_t)h->touching, (bodies + 7) / 8 * 8},
    };
    memcpy(list, rows, sizeof rows);
}

static size_t state_bytes(const section list[most_sections])
{
    size_t bytes = (header_words + 1) * word_bytes; /* with the check value */
    for (int i = 0; i < most_sections; i++)
        bytes += section_bytes(&list[i]);
    return bytes;
}

static bool section_valid(arriving *a, const section *row, uint8_t *state)
{
    uint64_t headroom = 0;
    for (double bound = 0.5; row->numbers == STRENGTHS && bound <= (double)a->lightest; bound *= 2)
        headroom++;
    const bool fine = row->numbers == ANY ||
                      spring_state_valid(state, section_bytes(row), sizeof(scalar), row->numbers == FINITE, headroom);
    return row->valid != NULL ? row->valid(a, row, state, fine) : fine;
}

/* ------------------------------------------------------------------------------------------------- public functions */

spring_status spring_scene_save(const spring_scene *s, void *out, size_t *bytes)
{
    if (s == NULL || bytes == NULL)
        return SPRING_EINVAL;
    if (s->lost && !scene_finite(s))
        return SPRING_ENONFINITE;
    state_header h = header_of(s);
    section list[most_sections];
    list_sections(s, &h, list);
    const size_t room = *bytes;
    h.bytes = *bytes = state_bytes(list);
    if (out == NULL || room < h.bytes)
        return out == NULL ? SPRING_OK : SPRING_ENOMEM;
    copy_numbers(out, &h, header_words, word_bytes);
    uint8_t *at = (uint8_t *)out + sizeof h;
    for (int i = 0; i < most_sections; at += section_bytes(&list[i++])) {
        if (list[i].count == 0)
            continue;
        const size_t all = section_bytes(&list[i]), zeros = list[i].bits == 1 ? all : word_bytes;
        memset(at + all - zeros, 0, zeros); /* padding, and bits */
        list[i].move((spring_scene *)s, &list[i], at, false);
    }
    const uint64_t check = spring_state_check(out, *bytes - word_bytes);
    copy_numbers(at, &check, 1, word_bytes);
    return SPRING_OK;
}

spring_status spring_scene_load(spring_scene *s, const void *in, size_t bytes)
{
    state_header h;
    section list[most_sections];
    if (s == NULL || in == NULL || bytes < sizeof h + word_bytes || bytes % word_bytes != 0)
        return SPRING_EINVAL;
    copy_numbers(&h, in, header_words, word_bytes);
    uint8_t *const state = (uint8_t *)in, *at = state + sizeof h; /* which is not written to */
    if (h.magic != state_magic() || h.bytes != bytes ||
        spring_state_check(in, bytes - word_bytes) != word_at(state + bytes - word_bytes))
        return SPRING_EINVAL;
    if (!header_matches(s, &h))
        return SPRING_EMISMATCH;
    if (!header_valid(s, &h))
        return SPRING_EINVAL;
    list_sections(s, &h, list);
    if (state_bytes(list) != bytes)
        return SPRING_EINVAL;
    arriving coming = {.s = s, .header = &h};
    for (int i = 0; i < most_sections; at += section_bytes(&list[i++]))
        if (list[i].count > 0 && !section_valid(&coming, &list[i], at))
            return SPRING_EINVAL;
    for (uint32_t buffer = 0; buffer < 2; buffer++) /* without colliders no step writes them */
        if (scene_has(s, touched_in(buffer)))
            memset(scene_memory(s, touched_in(buffer)), 0, s->layout.particles * sizeof(uint32_t));
    if (scene_is_editable(s)) {
        s->bounds_known = false;
        s->damped_links = s->damped_weighted = s->isotropic_links = 0;
        s->loose = s->nonlinear = 0;
    }
    at = state + sizeof h;
    for (int i = 0; i < most_sections; at += section_bytes(&list[i++]))
        if (list[i].count > 0)
            list[i].move(s, &list[i], at, true);
    if (scene_is_editable(s))
        settle_links(s, h.damped);
    s->force_cache = (cached_force)h.kept;
    s->colliders = (uint32_t)h.bodies;
    s->t0 = h.t0;
    s->dt = h.dt;
    s->steps = h.steps;
    s->colliders_base = h.colliders_base;
    s->colliders_from = h.colliders_from;
    scene_clear_impulses(s);
    scene_store_gravity(s, h.gravity);
    return SPRING_OK;
}

#include "../simd/size_end.h"
