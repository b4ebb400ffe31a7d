/* SPDX-License-Identifier: MIT */
/*
 * Saving and loading the state of a scene, and setting its time.
 *
 * Format    Little-endian: a header of 64-bit words, sections of numbers, each padded with zeros to a multiple of 8
 *           bytes, and a check value. docs/details.md describes it. list_sections() is the only list of the sections:
 *           the size, save and load follow it. A new field is a row there, or a word of the header.
 * Sections  One function for each kind of section moves its numbers in both directions.
 * Loading   checks everything before it changes the scene: one pass over the state computes the check value and tests
 *           all numbers. Sections are checked and moved in the order of the list, so a section may use those before it.
 * Check     Eight lanes of 64-bit words, each with one rotation and one multiplication per word. CRC-32 and FNV-1a take
 *           a byte at a time, several times as long as two steps, and XXH64 has two multiplications per word. Adding a
 *           word, the rotation and the multiplication by an odd number are bijections, so a change of one word always
 *           changes the value. The rotation brings the sign bits of numbers where the multiplication spreads them.
 */
#include "weighted_links.h"

/* ----------------------------------------------------------------------------------------------- numbers of a state */

static bool little_endian(void)
{
    const uint16_t one = 1;
    uint8_t first;
    memcpy(&first, &one, sizeof first);
    return first == 1;
}

/* Copies numbers of this processor to or from a state. */
static inline void copy_numbers(void *to, const void *from, size_t count, size_t size)
{
    if (little_endian()) {
        memcpy(to, from, count * size);
        return;
    }
    uint8_t *const out = to;
    const uint8_t *const in = from;
    for (size_t i = 0; i < count * size; i += size)
        for (size_t k = 0; k < size; k++)
            out[i + k] = in[i + size - 1 - k];
}

/* Loads numbers from a state, or saves them. */
static inline void move_numbers(bool load, void *numbers, uint8_t *state, size_t count, size_t size)
{
    copy_numbers(load ? numbers : state, load ? state : numbers, count, size);
}

static inline uint64_t word_at(const uint8_t *at)
{
    uint64_t word;
    copy_numbers(&word, at, 1, sizeof word);
    return word;
}

static inline scalar number_at(const uint8_t *at, size_t i)
{
    scalar number;
    copy_numbers(&number, at + i * sizeof number, 1, sizeof number);
    return number;
}

static inline bool bit_at(const uint8_t *at, size_t i)
{
    return (at[i / 8] >> i % 8 & 1) != 0;
}

/* Sets bit i, which is 0. */
static inline void set_bit(uint8_t *at, size_t i, bool bit)
{
    at[i / 8] = (uint8_t)(at[i / 8] | bit << i % 8);
}

/* ------------------------------------------------------------------------------------------------------ check value */

enum { lanes = 8, word_bytes = sizeof(uint64_t) };

/* The check value of the words so far: word i is mixed into lane i % lanes. */
typedef struct digest {
    uint64_t lane[lanes];
    size_t words;
} digest;

/* `hash` with one more word. */
static inline uint64_t hashed(uint64_t hash, uint64_t word)
{
    const uint64_t sum = hash + word;
    return (sum << 31 | sum >> 33) * UINT64_C(0x9E3779B97F4A7C15);
}

static void add_words(digest *d, const uint8_t *in, size_t words)
{
    uint64_t lane[lanes];
    for (size_t k = 0; k < lanes; k++)
        lane[k] = d->lane[(d->words + k) % lanes];
    size_t i = 0;
    for (; i + lanes <= words; i += lanes) {
        SPRING_UNROLL
        for (size_t k = 0; k < lanes; k++)
            lane[k] = hashed(lane[k], word_at(in + (i + k) * word_bytes));
    }
    for (size_t k = 0; i < words; i++, k++)
        lane[k] = hashed(lane[k], word_at(in + i * word_bytes));
    for (size_t k = 0; k < lanes; k++)
        d->lane[(d->words + k) % lanes] = lane[k];
    d->words += words;
}

static uint64_t check_value(const digest *d)
{
    uint64_t hash = d->words * word_bytes;
    for (size_t k = 0; k < lanes; k++)
        hash = hashed(hash, d->lane[k]);
    return hash ^ hash >> 32;
}

/* Words that are tested at once. */
#if defined(__GNUC__)
typedef uint64_t word_group __attribute__((vector_size(2 * sizeof(uint64_t))));
#else
typedef uint64_t word_group;
#endif

/* The signs of those numbers that are not valid; other bits have no meaning. */
SPRING_INLINE word_group invalid_signs(word_group word, uint64_t exponents, uint64_t one, bool any_sign)
{
    return any_sign ? (word & exponents) + one : word | (word + one);
}

/* Whether all numbers are finite, also if they are multiplied by a number below 2^headroom, which is less than the largest;
   and not negative, unless any_sign. Adding `one` to an exponent that is too large carries into the sign. */
SPRING_INLINE bool test_numbers(const uint8_t *in, size_t words, uint64_t headroom, bool any_sign)
{
    enum { group = sizeof(word_group) / sizeof(uint64_t), groups = 4 };
    const uint64_t first = sizeof(scalar) == sizeof(float) ? UINT64_C(1) << 32 | 1 : 1; /* bit 0 of each number */
    const unsigned sign = 8 * sizeof(scalar) - 1, fraction = sizeof(scalar) == sizeof(float) ? 23 : 52;
    const uint64_t exponents = (first << sign) - (first << fraction), one = first * (1 + headroom) << fraction;
    word_group invalid = {0}, word = {0};
    size_t i = 0;
    for (; i + groups * group <= words; i += groups * group) {
        SPRING_UNROLL
        for (size_t k = 0; k < groups; k++) {
            copy_numbers(&word, in + (i + k * group) * word_bytes, group, word_bytes);
            invalid |= invalid_signs(word, exponents, one, any_sign);
        }
    }
    for (; i < words; i++) {
        copy_numbers(&word, in + i * word_bytes, 1, word_bytes);
        invalid |= invalid_signs(word, exponents, one, any_sign);
    }
    uint64_t part[group], all = 0;
    memcpy(part, &invalid, sizeof part);
    for (size_t k = 0; k < group; k++)
        all |= part[k];
    return (all & first << sign) == 0;
}

static bool numbers_valid(const uint8_t *in, size_t words, bool any_sign, uint64_t headroom)
{
    return any_sign ? test_numbers(in, words, headroom, true) : test_numbers(in, words, headroom, false);
}

#include "../simd/size_begin.h"

static uint64_t bits_of(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static uint64_t hashed_numbers(uint64_t hash, const double *number, size_t count)
{
    for (size_t i = 0; i < count && number != NULL; i++)
        hash = hashed(hash, bits_of(number[i] + 0)); /* -0 counts as 0 */
    return hashed(hash, number != NULL);
}

uint64_t spring_scene_identify(const spring_scene *s, const spring_scene_def *def)
{
    const bool directed = s->layout.axes == 1 && (def->flags & SPRING_SCENE_EDITABLE) == 0;
    const stored_weighted *const weighted = scene_read(s, ARRAY_WEIGHTED);
    uint64_t hash = 0;
    for (size_t i = 0; i < def->links; i++) {
        const uint64_t a = def->link[i].a, b = def->link[i].b;
        hash = hashed(hash, directed || a < b ? a | b << 32 : b | a << 32);
        if (def->link[i].flags != 0)
            hash = hashed(hash, def->link[i].flags);
    }
    for (size_t i = 0; i < def->weighted_links; i++)
        for (uint64_t k = 0; k < weighted[i].points; k++)
            hash = hashed(hash, weighted[i].particle[k] | k << 32 | (uint64_t)weighted[i].place[k] << 40);
    if (def->colliders == 0 || (def->radius == NULL && def->friction == NULL && def->mask == NULL))
        return hash;
    hash = hashed_numbers(hash, def->radius, def->particles);
    hash = hashed_numbers(hash, def->friction, def->particles);
    for (size_t i = 0; i < def->particles && def->mask != NULL; i++)
        hash = hashed(hash, def->mask[i]);
    return hash;
}

/* ----------------------------------------------------------------------------------------------------------- header */

/* The words of the header. Up to WORD_CALLBACK, they must be those of the scene that loads the state. */
enum {
    WORD_MAGIC,
    WORD_VERSION,
    WORD_PRECISION, /* [bytes] of a number */
    WORD_AXES,
    WORD_FLAGS,
    WORD_METHODS,
    WORD_MOST_COLLIDERS, /* of the definition */
    WORD_PARTICLES,
    WORD_LINKS,
    WORD_WEIGHTED_LINKS,
    WORD_ENDS, /* spring_scene_identify() */
    WORD_CALLBACK,
    WORD_BYTES,  /* of the state */
    WORD_KEPT,   /* cached_force */
    WORD_DAMPED, /* links; of an editable scene those that are damped when they act */
    WORD_COLLIDERS,
    WORD_TOUCHING, /* particles that touch colliders */
    WORD_T0,
    WORD_DT,
    WORD_STEPS,
    WORD_COLLIDERS_BASE,
    WORD_COLLIDERS_FROM,
    WORD_GRAVITY,
    WORD_COUNT = WORD_GRAVITY + 3
};

static const char magic[] = "SPRSTATE";
enum { format_version = 1 };

static double value_of(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static size_t count_touching(const spring_scene *s)
{
    const uint32_t *const touched = scene_read(s, touched_in(s->buffer));
    size_t count = 0;
    for (size_t i = 0; i < s->layout.particles && s->colliders > 0; i++)
        count += touched[i] != 0;
    return count;
}

static uint64_t count_damped(const spring_scene *s)
{
    uint64_t count = s->damped_links;
    const tether *const tethers = scene_read(s, ARRAY_TETHERS);
    const stored_weighted *const weighted = scene_read(s, ARRAY_WEIGHTED);
    if ((s->layout.flags & SPRING_SCENE_EDITABLE) == 0)
        return count;
    for (size_t i = 0; i < s->layout.weighted; i++)
        count -= weighted[i].damping > 0;
    for (size_t i = 0; i < s->layout.tethers; i++)
        count += tethers[i].damping > 0 && !(scene_link(s, tethers[i].link).damping > 0);
    return count;
}

/* All words but WORD_BYTES. */
static void make_header(const spring_scene *s, uint64_t header[WORD_COUNT])
{
    header[WORD_MAGIC] = word_at((const uint8_t *)magic);
    header[WORD_VERSION] = format_version;
    header[WORD_PRECISION] = sizeof(scalar);
    header[WORD_AXES] = s->layout.axes;
    header[WORD_FLAGS] = s->layout.flags;
    header[WORD_METHODS] = s->layout.methods;
    header[WORD_MOST_COLLIDERS] = s->layout.colliders;
    header[WORD_PARTICLES] = s->layout.particles;
    header[WORD_LINKS] = s->layout.links;
    header[WORD_WEIGHTED_LINKS] = s->layout.weighted;
    header[WORD_ENDS] = s->ends;
    header[WORD_CALLBACK] = s->force != NULL;
    header[WORD_KEPT] = s->force_cache;
    header[WORD_DAMPED] = count_damped(s);
    header[WORD_COLLIDERS] = s->colliders;
    header[WORD_TOUCHING] = count_touching(s);
    header[WORD_T0] = bits_of(s->t0);
    header[WORD_DT] = bits_of(s->dt);
    header[WORD_STEPS] = s->steps;
    header[WORD_COLLIDERS_BASE] = bits_of(s->colliders > 0 ? s->colliders_base : 0);
    header[WORD_COLLIDERS_FROM] = s->colliders > 0 ? s->colliders_from : 0;
    for (int a = 0; a < 3; a++)
        header[WORD_GRAVITY + a] = bits_of(s->gravity[a]);
}

static bool header_valid(const spring_scene *s, const uint64_t header[WORD_COUNT])
{
    const double t0 = value_of(header[WORD_T0]), dt = value_of(header[WORD_DT]);
    const double base = value_of(header[WORD_COLLIDERS_BASE]);
    const uint64_t steps = header[WORD_STEPS], from = header[WORD_COLLIDERS_FROM];
    uint64_t own[WORD_COUNT];
    make_header(s, own);
    for (int i = 0; i <= WORD_CALLBACK; i++)
        if (header[i] != own[i])
            return false;
    for (uint32_t a = 0; a < s->layout.axes; a++)
        if (!scene_fits(value_of(header[WORD_GRAVITY + a])))
            return false;
    const bool editable = (s->layout.flags & SPRING_SCENE_EDITABLE) != 0;
    const bool predicts = s->layout.offset[ARRAY_FORCE_1] != s->layout.offset[ARRAY_FORCE_0];
    return header[WORD_KEPT] <= (predicts ? PREDICTED_FORCE : FORCE) &&
           (editable ? header[WORD_DAMPED] <= s->layout.links : header[WORD_DAMPED] == own[WORD_DAMPED]) &&
           header[WORD_COLLIDERS] <= s->layout.colliders &&
           header[WORD_TOUCHING] <= (header[WORD_COLLIDERS] > 0 ? s->layout.particles : 0) && scene_fits(dt) &&
           from <= steps && spring_finite(t0 + (double)steps * dt) && spring_finite(base + (double)(steps - from) * dt);
}

/* --------------------------------------------------------------------------------------------------------- sections */

typedef struct section section;

/* A state that is being checked. */
typedef struct arriving {
    const spring_scene *s;
    const uint64_t *header;
    const uint8_t *masses, *pins; /* sections of editable scenes */
    scalar lightest;              /* [1/kg] largest inverse mass of a free particle */
} arriving;

/* Which numbers of a section are valid. STRENGTHS: not negative, and finite if multiplied by 2/mass of any particle */
typedef enum valid_numbers { ANY, FINITE, NOT_NEGATIVE, STRENGTHS } valid_numbers;

struct section {
    /* Moves the section from the state to the scene (load), or from the scene, which stays as it is, to the state, whose
       bits and padding are 0. */
    void (*move)(spring_scene *s, const section *row, uint8_t *state, bool load);
    /* fine: all numbers are valid. NULL: this is all there is to check */
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

/* A quantity: all particles on the first axis, then on the next. */
static void move_quantity(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    const size_t particles = s->layout.particles;
    for (uint32_t a = 0; a < s->layout.axes; a++, state += particles * sizeof(scalar))
        move_numbers(load, scene_axis(s, row->array, a), state, particles, sizeof(scalar));
}

/* Inverse masses of particles while they are free, and pins. */

static void move_masses(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    move_numbers(load, scene_memory(s, row->array), state, row->count, sizeof(scalar));
}

static bool masses_valid(arriving *a, const section *row, uint8_t *state, bool fine)
{
    (void)row;
    a->masses = state;
    return fine;
}

static void move_pins(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    const scalar *const freed = scene_read(s, ARRAY_FREE_MASS);
    scalar *const inverse = scene_memory(s, row->array);
    for (size_t i = 0; i < row->count && load; i++)
        inverse[i] = bit_at(state, i) ? 0 : freed[i];
    for (size_t i = 0; i < row->count && !load; i += 8) {
        unsigned bits = 0;
        for (size_t k = 0; k < 8 && i + k < row->count; k++)
            bits |= (inverse[i + k] == 0 ? 1u : 0) << k;
        state[i / 8] = (uint8_t)bits;
    }
}

static bool pins_valid(arriving *a, const section *row, uint8_t *state, bool fine)
{
    const uint8_t *const masses = a->masses;
    scalar lightest = 0;
    for (size_t i = 0; i < row->count; i++) {
        const scalar inverse = number_at(masses, i);
        if (bit_at(state, i))
            continue;
        fine = fine && inverse > 0;
        lightest = inverse > lightest ? inverse : lightest;
    }
    a->pins = state;
    a->lightest = lightest;
    return fine && scene_fits(a->s->drag * (double)lightest);
}

/* A coefficient of all links of an editable scene, in the order of their indices. The scene has it by slot. */

typedef struct coefficient_storage {
    const uint32_t *slots; /* NULL: each link has the slot of its index */
    size_t band_slots;
    size_t banded, unbanded; /* [bytes] where the coefficient of slot 0 would be, from the start of the block */
} coefficient_storage;

static coefficient_storage storage_of(const spring_scene *s, scene_array unbanded)
{
    const scene_array banded = unbanded == ARRAY_LINK_STIFFNESS ? ARRAY_BAND_STIFFNESS
                               : unbanded == ARRAY_LINK_REST    ? ARRAY_BAND_REST
                                                                : ARRAY_BAND_DAMPING;
    const size_t slots = s->layout.band_slots;
    return (coefficient_storage){scene_read(s, ARRAY_SLOTS), slots, s->layout.offset[banded],
                                 s->layout.offset[unbanded] - slots * sizeof(scalar)};
}

static inline size_t slot_of(const coefficient_storage *c, size_t link)
{
    return c->slots != NULL ? c->slots[link] : link;
}

static inline scalar *stored_coefficient(spring_scene *s, const coefficient_storage *c, size_t link)
{
    const size_t slot = slot_of(c, link);
    void *const at = (char *)s + ((slot < c->band_slots ? c->banded : c->unbanded) + slot * sizeof(scalar));
    return at;
}

static void move_coefficients(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    const coefficient_storage c = storage_of(s, row->array);
    if (c.slots == NULL) {
        move_numbers(load, scene_memory(s, row->array), state, row->count, sizeof(scalar));
    } else if (load) {
        for (size_t i = 0; i < row->count; i++)
            *stored_coefficient(s, &c, i) = number_at(state, i);
    } else {
        for (size_t i = 0; i < row->count; i++)
            copy_numbers(state + i * sizeof(scalar), stored_coefficient(s, &c, i), 1, sizeof(scalar));
    }
}

/* Rest lengths. With one axis, a link from the upper to the lower end has a negative one. Links of bands are stored like
   that, other links with the sign for their order of the ends. With more axes, links with flags are stored with a sign. */
static void move_rests(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    const coefficient_storage c = storage_of(s, row->array);
    const uint32_t *const a = scene_read(s, ARRAY_LINK_A), *const b = scene_read(s, ARRAY_LINK_B);
    const uint8_t *const flags = scene_read(s, ARRAY_FLAGS);
    const bool directed = s->layout.axes == 1, tension_only = (s->layout.flags & SPRING_SCENE_TENSION_ONLY) != 0;
    move_coefficients(s, row, state, load);
    for (size_t i = 0; i < row->count && (directed ? a != NULL : tension_only || flags != NULL); i++) {
        const size_t slot = slot_of(&c, i), at = slot - c.band_slots;
        if (directed ? slot < c.band_slots || a[at] < b[at] : !tension_only && flags[i] == 0)
            continue;
        scalar *const rest = stored_coefficient(s, &c, i);
        if (load)
            *rest = -*rest;
        else
            state[(i + 1) * sizeof(scalar) - 1] ^= 0x80;
    }
}

/* Stiffness or damping. While a tether does not act, it has coefficients of 0 where other links have theirs. */
static void move_strengths(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    const coefficient_storage c = storage_of(s, row->array);
    tether *const tethers = scene_memory(s, ARRAY_TETHERS);
    move_coefficients(s, row, state, load);
    for (size_t i = 0; i < s->layout.tethers; i++) {
        const size_t link = tethers[i].link;
        scalar *const own = row->array == ARRAY_LINK_STIFFNESS ? &tethers[i].stiffness : &tethers[i].damping;
        const link_place ends = scene_link_place(s, link);
        move_numbers(load, own, state + link * sizeof(scalar), 1, sizeof(scalar));
        if (load && (inverse_mass_at(s, ends.a) == 0) == (inverse_mass_at(s, ends.b) == 0))
            *stored_coefficient(s, &c, link) = 0;
    }
}

#include "../simd/size_begin.h"

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
        if (!scene_not_negative(strength) || !scene_fits(2 * (strength * lighter)))
            return false;
    }
    return true;
}

#include "../simd/size_end.h"

static bool dampings_valid(arriving *a, const section *row, uint8_t *state, bool fine)
{
    size_t damped = 0;
    for (size_t i = 0; i < row->count; i++)
        damped += number_at(state, i) > 0;
    return damped == a->header[WORD_DAMPED] && strengths_valid(a, row, state, fine);
}

/* Weighted links of an editable scene: four weights, rest length, stiffness, damping, and 1 if a band computes it. */

enum { weighted_numbers = 8 };

static void move_weighted(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    stored_weighted *l = scene_memory(s, row->array);
    for (size_t i = 0; i < row->count; i++, l++, state += weighted_numbers * sizeof(scalar)) {
        scalar n[weighted_numbers] = {0, 0, 0, 0, l->rest, l->stiffness, l->damping, l->banded};
        for (int k = 0; k < l->points; k++)
            n[l->place[k]] = l->weight[k];
        move_numbers(load, n, state, weighted_numbers, sizeof(scalar));
        if (!load)
            continue;
        for (int k = 0; k < l->points; k++)
            l->weight[k] = n[l->place[k]];
        l->rest = n[4];
        l->stiffness = n[5];
        l->damping = n[6];
        l->banded = n[7] != 0;
        if (l->slot != no_slot)
            scene_fill_slot(s, l, l->slot);
    }
}

/* The exact test, where products might overflow. */
static bool weighted_fits(const arriving *a, const stored_weighted *l, const scalar n[weighted_numbers])
{
    spring_weighted_link link = {.stiffness = (double)n[5], .damping = (double)n[6]};
    double inverse[4] = {0};
    for (int k = 0; k < l->points; k++) {
        const int place = l->place[k];
        link.weight[place] = (double)n[place];
        inverse[place] = n[place] != 0 ? arriving_inverse_mass(a, l->particle[k]) : 0;
    }
    return weighted_overflows(&link, inverse) == NULL;
}

static bool weighted_valid(arriving *a, const section *row, uint8_t *state, bool fine)
{
    const double rounding = sizeof(scalar) < sizeof(double) ? 4 * (double)SCALAR_EPSILON : 1e-12;
    const double lightest = a->lightest > 1 ? (double)a->lightest : 1;
    const stored_weighted *l = scene_read(a->s, row->array);
    for (size_t i = 0; i < row->count && fine; i++, l++, state += weighted_numbers * sizeof(scalar)) {
        scalar n[weighted_numbers], weight[4] = {0};
        double sum = 0, largest = 0;
        copy_numbers(n, state, weighted_numbers, sizeof(scalar));
        for (int k = 0; k < l->points; k++) {
            weight[k] = n[l->place[k]];
            sum += (double)weight[k];
            largest = fabs((double)weight[k]) > largest ? fabs((double)weight[k]) : largest;
        }
        /* those of a band are (w, -2w, w), the middle one first */
        const bool fits =
            l->slot != no_slot && weight[1] != 0 && weight[1] == weight[2] && weight[0] == -2 * weight[1] && n[4] == 0;
        const double strength = (double)(n[5] > n[6] ? n[5] : n[6]);
        fine = fabs(sum) <= rounding * largest && n[4] >= 0 && n[5] >= 0 && n[6] >= 0 &&
               (n[7] == 0 || (n[7] == 1 && fits)) &&
               (8 * largest * largest * strength * lightest < (double)SCALAR_MAX || weighted_fits(a, l, n));
    }
    return fine;
}

/* Adds damped links to those of the scene. isotropic: whether links of rest length 0 are */
static void count_damped_slots(spring_scene *s, const scalar *rest, const scalar *damping, size_t slots)
{
    uint64_t damped = 0, isotropic = 0;
    for (size_t i = 0; i < slots; i++) {
        damped += damping[i] > 0;
        isotropic += damping[i] > 0 && rest[i] == 0;
    }
    s->damped_links += damped;
    s->isotropic_links += s->layout.axes > 1 ? isotropic : 0;
}

/* Makes what follows from the coefficients of all links, after they have been loaded. damped: whether there was a section of
   damping */
static void settle_links(spring_scene *s, bool damped)
{
    const scene_layout *const l = &s->layout;
    const size_t slots = l->three_point_bands > 0 ? l->band[l->bands - l->three_point_bands].slots : l->band_slots;
    scalar *const damping = scene_memory(s, ARRAY_BAND_DAMPING), *const unbanded = scene_memory(s, ARRAY_LINK_DAMPING);
    const scalar *const stiffness = scene_read(s, ARRAY_BAND_STIFFNESS);
    int8_t *const occupied = scene_memory(s, ARRAY_OCCUPIED);
    tether *const tethers = scene_memory(s, ARRAY_TETHERS);
    const stored_weighted *const weighted = scene_read(s, ARRAY_WEIGHTED);
    for (size_t i = 0; i < slots; i++) {
        damping[i] = damped ? damping[i] : 0;
        occupied[i] = stiffness[i] > 0 || damping[i] > 0 ? -1 : 0;
    }
    for (size_t i = 0; i < l->unbanded && !damped; i++)
        unbanded[i] = 0;
    for (size_t i = 0; i < l->tethers && !damped; i++)
        tethers[i].damping = 0;
    s->damped_links = s->isotropic_links = s->loose = 0;
    if (damped) {
        count_damped_slots(s, scene_read(s, ARRAY_BAND_REST), damping, slots);
        count_damped_slots(s, scene_read(s, ARRAY_LINK_REST), unbanded, l->unbanded);
    }
    for (size_t i = 0; i < l->weighted; i++) {
        s->damped_links += weighted[i].damping > 0;
        s->loose += !weighted[i].banded;
    }
    s->bounds_known = false;
}

#include "../simd/size_begin.h"

/* Colliders: the shape and the mask, and numbers in the order of this table. */
static const struct {
    size_t offset, count;
} collider_numbers[] = {
    {offsetof(spring_collider, at), 3},           {offsetof(spring_collider, to), 3},
    {offsetof(spring_collider, axis), 9},         {offsetof(spring_collider, half), 3},
    {offsetof(spring_collider, radius), 1},       {offsetof(spring_collider, velocity), 3},
    {offsetof(spring_collider, velocity_to), 3},  {offsetof(spring_collider, spin), 3},
    {offsetof(spring_collider, friction), 1},     {offsetof(spring_collider, restitution), 1},
    {offsetof(spring_collider, acceleration), 3}, {offsetof(spring_collider, spin_acceleration), 3},
    {offsetof(spring_collider, surface), 3},      {offsetof(spring_collider, thickness), 1},
    {offsetof(spring_collider, bound), 1},
};
enum { collider_fields = sizeof collider_numbers / sizeof collider_numbers[0], collider_words = 1 + 41 };

static void move_collider(spring_collider *c, uint8_t *state, bool load)
{
    uint64_t first = c->shape | (uint64_t)c->mask << 32;
    move_numbers(load, &first, state, 1, word_bytes);
    c->shape = (spring_shape)(uint32_t)first;
    c->mask = (uint32_t)(first >> 32);
    state += word_bytes;
    for (int k = 0; k < collider_fields; k++) {
        move_numbers(load, (char *)c + collider_numbers[k].offset, state, collider_numbers[k].count, word_bytes);
        state += collider_numbers[k].count * word_bytes;
    }
}

/* Collider i of a state, with the function of collider i of the scene. */
static spring_collider collider_at(const spring_scene *s, uint8_t *state, size_t i)
{
    const spring_collider *const own = scene_read(s, ARRAY_COLLIDERS);
    spring_collider c = {.gap = i < s->colliders ? own[i].gap : NULL, .user = i < s->colliders ? own[i].user : NULL};
    move_collider(&c, state + i * collider_words * word_bytes, true);
    return c;
}

static void move_colliders(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    spring_collider *const c = scene_memory(s, row->array);
    for (size_t i = 0; i < row->count; i++) {
        spring_collider copy = load ? collider_at(s, state, i) : c[i];
        if (load)
            c[i] = copy;
        else
            move_collider(&copy, state + i * collider_words * word_bytes, false);
    }
}

static bool colliders_valid(arriving *a, const section *row, uint8_t *state, bool fine)
{
    const spring_collider *const own = scene_read(a->s, row->array);
    for (size_t i = 0; i < row->count && fine; i++) {
        const spring_collider c = collider_at(a->s, state, i);
        const bool custom = i < a->s->colliders && own[i].shape == SPRING_CUSTOM;
        fine = (uint32_t)c.shape <= SPRING_CUSTOM && (c.shape == SPRING_CUSTOM) == custom &&
               spring_scene_check_colliders(a->s, &c, 1, NULL, NULL) == SPRING_OK;
    }
    return fine;
}

#include "../simd/size_end.h"

/* The particles that touch colliders, and their bits. */

static void move_touching(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    uint32_t *const touched = scene_memory(s, row->array);
    for (size_t i = 0; i < row->count; i++)
        if (load)
            touched[i] = bit_at(state, i);
        else
            set_bit(state, i, touched[i] != 0);
}

static bool touching_valid(arriving *a, const section *row, uint8_t *state, bool fine)
{
    size_t count = 0;
    for (size_t i = 0; i < row->count; i++)
        count += bit_at(state, i);
    return fine && count == a->header[WORD_TOUCHING];
}

static uint32_t touched_at(const section *row, const uint8_t *state, size_t i)
{
    uint32_t bits = 0;
    for (size_t k = 0; k < row->bits / 8; k++)
        bits |= (uint32_t)state[i * row->bits / 8 + k] << 8 * k;
    return bits;
}

/* After move_touching(). */
static void move_touched(spring_scene *s, const section *row, uint8_t *state, bool load)
{
    uint32_t *touched = scene_memory(s, row->array);
    for (size_t i = 0; i < row->count; touched++) {
        if (*touched == 0)
            continue;
        for (size_t k = 0; k < row->bits / 8 && !load; k++)
            state[i * row->bits / 8 + k] = (uint8_t)(*touched >> 8 * k);
        if (load)
            *touched = touched_at(row, state, i);
        i++;
    }
}

static bool touched_valid(arriving *a, const section *row, uint8_t *state, bool fine)
{
    for (size_t i = 0; i < row->count; i++) {
        const uint64_t bits = touched_at(row, state, i);
        fine = fine && bits != 0 && bits >> a->header[WORD_COLLIDERS] == 0;
    }
    return fine;
}

#include "../simd/size_begin.h"

enum { most_sections = 13 };

/* Lists the sections of a state, in their order. Returns their number. */
static int list_sections(const spring_scene *s, const uint64_t header[WORD_COUNT], section list[most_sections])
{
    const scene_layout *const l = &s->layout;
    const bool editable = (l->flags & SPRING_SCENE_EDITABLE) != 0, holds = (l->flags & SPRING_SCENE_FORCES) != 0;
    const size_t numbers = l->axes * l->particles, particles = editable ? l->particles : 0;
    const size_t links = editable ? l->links : 0, number = 8 * sizeof(scalar);
    const size_t bodies = (size_t)header[WORD_COLLIDERS];
    const scene_array touched = touched_in(s->buffer);
    /* Kept forces may be infinite: RKN8 uses the last ones only in the next call, which then fails. */
    const section rows[] = {
        {move_quantity, NULL, FINITE, positions_in(s->buffer), numbers, number},
        {move_quantity, NULL, FINITE, velocities_in(s->buffer), numbers, number},
        {move_quantity, NULL, ANY, forces_in(s->buffer), header[WORD_KEPT] != NO_FORCE ? numbers : 0, number},
        {move_quantity, NULL, FINITE, ARRAY_HELD, holds ? numbers : 0, number},
        {move_masses, masses_valid, NOT_NEGATIVE, ARRAY_FREE_MASS, particles, number},
        {move_pins, pins_valid, ANY, ARRAY_INVERSE_MASS, particles, 1},
        {move_rests, NULL, l->axes == 1 ? FINITE : NOT_NEGATIVE, ARRAY_LINK_REST, links, number},
        {move_strengths, strengths_valid, STRENGTHS, ARRAY_LINK_STIFFNESS, links, number},
        {move_strengths, dampings_valid, STRENGTHS, ARRAY_LINK_DAMPING, header[WORD_DAMPED] > 0 ? links : 0, number},
        {move_weighted, weighted_valid, FINITE, ARRAY_WEIGHTED, editable ? l->weighted : 0, weighted_numbers * number},
        {move_colliders, colliders_valid, ANY, ARRAY_COLLIDERS, bodies, 64 * collider_words},
        {move_touching, touching_valid, ANY, touched, bodies > 0 ? l->particles : 0, 1},
        {move_touched, touched_valid, ANY, touched, (size_t)header[WORD_TOUCHING], (bodies + 7) / 8 * 8},
    };
    int count = 0;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (rows[i].count > 0)
            list[count++] = rows[i];
    return count;
}

static size_t state_bytes(const section *list, int count)
{
    size_t bytes = (WORD_COUNT + 1) * word_bytes; /* with the check value */
    for (int i = 0; i < count; i++)
        bytes += section_bytes(&list[i]);
    return bytes;
}

/* Whether all numbers of a section are valid. */
static bool section_valid(arriving *a, const section *row, uint8_t *state)
{
    uint64_t headroom = 0;
    for (double bound = 0.5; row->numbers == STRENGTHS && bound <= (double)a->lightest; bound *= 2)
        headroom++;
    const bool fine =
        row->numbers == ANY || numbers_valid(state, section_bytes(row) / word_bytes, row->numbers == FINITE, headroom);
    return row->valid == NULL ? fine : row->valid(a, row, state, fine);
}

/* ------------------------------------------------------------------------------------------------- public functions */

spring_status spring_scene_save(const spring_scene *s, void *out, size_t *bytes)
{
    if (s == NULL || bytes == NULL)
        return SPRING_EINVAL;
    if (s->lost && !scene_finite(s))
        return SPRING_ENONFINITE;
    uint64_t header[WORD_COUNT];
    section list[most_sections];
    make_header(s, header);
    const int count = list_sections(s, header, list);
    const size_t room = *bytes, size = state_bytes(list, count);
    *bytes = size;
    if (out == NULL)
        return SPRING_OK;
    if (room < size)
        return SPRING_ENOMEM;
    header[WORD_BYTES] = size;
    copy_numbers(out, header, WORD_COUNT, word_bytes);
    digest d = {{0}, 0};
    add_words(&d, out, WORD_COUNT);
    uint8_t *at = (uint8_t *)out + sizeof header;
    for (int i = 0; i < count; at += section_bytes(&list[i]), i++) {
        const size_t all = section_bytes(&list[i]), zeros = list[i].bits == 1 ? all : word_bytes;
        memset(at + all - zeros, 0, zeros);
        list[i].move((spring_scene *)s, &list[i], at, false); /* which does not write to it */
        add_words(&d, at, all / word_bytes);
    }
    const uint64_t check = check_value(&d);
    copy_numbers(at, &check, 1, word_bytes);
    return SPRING_OK;
}

spring_status spring_scene_load(spring_scene *s, const void *in, size_t bytes)
{
    uint64_t header[WORD_COUNT];
    section list[most_sections];
    if (s == NULL || in == NULL || bytes < sizeof header)
        return SPRING_EINVAL;
    copy_numbers(header, in, WORD_COUNT, word_bytes);
    if (header[WORD_BYTES] != bytes || !header_valid(s, header))
        return SPRING_EINVAL;
    const int count = list_sections(s, header, list);
    if (state_bytes(list, count) != bytes)
        return SPRING_EINVAL;
    uint8_t *const first = (uint8_t *)in + sizeof header, *at = first; /* nothing writes to it */
    arriving coming = {.s = s, .header = header};
    digest d = {{0}, 0};
    add_words(&d, in, WORD_COUNT);
    for (int i = 0; i < count; at += section_bytes(&list[i]), i++) {
        add_words(&d, at, section_bytes(&list[i]) / word_bytes);
        if (!section_valid(&coming, &list[i], at))
            return SPRING_EINVAL;
    }
    if (check_value(&d) != word_at(at))
        return SPRING_EINVAL;
    for (uint32_t buffer = 0; buffer < 2; buffer++) /* without colliders no step writes them */
        if (scene_has(s, touched_in(buffer)))
            memset(scene_memory(s, touched_in(buffer)), 0, s->layout.particles * sizeof(uint32_t));
    at = first;
    for (int i = 0; i < count; at += section_bytes(&list[i]), i++)
        list[i].move(s, &list[i], at, true);
    if ((s->layout.flags & SPRING_SCENE_EDITABLE) != 0)
        settle_links(s, header[WORD_DAMPED] > 0);
    s->force_cache = (cached_force)header[WORD_KEPT];
    s->colliders = (uint32_t)header[WORD_COLLIDERS];
    s->t0 = value_of(header[WORD_T0]);
    s->dt = value_of(header[WORD_DT]);
    s->steps = header[WORD_STEPS];
    s->colliders_base = value_of(header[WORD_COLLIDERS_BASE]);
    s->colliders_from = header[WORD_COLLIDERS_FROM];
    scene_clear_impulses(s);
    double gravity[3];
    for (int a = 0; a < 3; a++)
        gravity[a] = value_of(header[WORD_GRAVITY + a]);
    scene_store_gravity(s, gravity);
    return SPRING_OK;
}

spring_status spring_scene_set_time(spring_scene *s, double t)
{
    if (s == NULL || !spring_finite(t))
        return SPRING_EINVAL;
    s->colliders_base = colliders_time(s);
    s->colliders_from = 0;
    s->t0 = t;
    s->dt = 0;
    s->steps = 0;
    if (s->force != NULL) /* it may depend on the time */
        scene_drop_forces(s);
    return SPRING_OK;
}

spring_scene_info spring_scene_describe(const spring_scene *s)
{
    if (s == NULL)
        return (spring_scene_info){0};
    const scene_layout *const l = &s->layout;
    return (spring_scene_info){
        .particles = l->particles,
        .links = l->links,
        .weighted_links = l->weighted,
        .axes = l->axes,
        .flags = l->flags,
        .methods = l->methods,
        .colliders = l->colliders,
    };
}

#include "../simd/size_end.h"
