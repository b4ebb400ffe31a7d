/* SPDX-License-Identifier: MIT */
/*
 * Saving and loading the state of a scene, and setting its time.
 *
 * Format    Little-endian: a header of 64-bit words, sections of numbers, each padded with zeros to a multiple of 8
 *           bytes, and a check value. docs/details.md describes it. list_sections() is the only list of the sections:
 *           the size, save and load follow it. A new field is a row there, or a word of the header.
 * Loading   checks everything before it changes the scene. Sections are checked and read in the order of the list, so
 *           that a section may use those before it.
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

/* `hash` with one more word. */
static inline uint64_t hashed(uint64_t hash, uint64_t word)
{
    const uint64_t sum = hash + word;
    return (sum << 31 | sum >> 33) * UINT64_C(0x9E3779B97F4A7C15);
}

/* size: a multiple of 8 */
static uint64_t check_value(const uint8_t *bytes, size_t size)
{
    enum { lanes = 8, word = 8 };
    uint64_t lane[lanes] = {0}, hash = size;
    size_t i = 0;
    for (; i + lanes * word <= size; i += lanes * word) {
        SPRING_UNROLL
        for (size_t k = 0; k < lanes; k++)
            lane[k] = hashed(lane[k], word_at(bytes + i + k * word));
    }
    for (size_t k = 0; i < size; i += word, k++)
        lane[k] = hashed(lane[k], word_at(bytes + i));
    for (size_t k = 0; k < lanes; k++)
        hash = hashed(hash, lane[k]);
    return hash ^ hash >> 32;
}

/* Whether all numbers are finite, and not negative unless any_sign. The numbers of a word of a padded section are tested
   at once: adding 1 to an exponent of ones carries into the sign. Adding 1 + headroom finds numbers that would not be
   finite if they were multiplied by a number below 2^headroom, which is less than the largest. */
static bool numbers_valid(const uint8_t *in, size_t count, bool any_sign, uint64_t headroom)
{
    const uint64_t first = sizeof(scalar) == sizeof(float) ? UINT64_C(1) << 32 | 1 : 1; /* bit 0 of each number */
    const unsigned sign = 8 * sizeof(scalar) - 1, fraction = sizeof(scalar) == sizeof(float) ? 23 : 52;
    const uint64_t exponents = (first << sign) - (first << fraction), one = first * (1 + headroom) << fraction;
    const size_t bytes = (count * sizeof(scalar) + sizeof one - 1) / sizeof one * sizeof one;
    uint64_t carries = 0, signs = 0;
    size_t i = 0;
    for (; i + 4 * sizeof one <= bytes; i += 4 * sizeof one) {
        SPRING_UNROLL
        for (size_t k = 0; k < 4; k++) {
            carries |= (word_at(in + i + k * sizeof one) & exponents) + one;
            signs |= word_at(in + i + k * sizeof one);
        }
    }
    for (; i < bytes; i += sizeof one) {
        carries |= (word_at(in + i) & exponents) + one;
        signs |= word_at(in + i);
    }
    return ((carries | (any_sign ? 0 : signs)) & first << sign) == 0;
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
enum { format_version = 1, word_bytes = sizeof(uint64_t) };

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

/* How a section is written, checked and read. */
typedef struct section_kind {
    void (*write)(const spring_scene *s, const section *row, uint8_t *out);
    bool (*valid)(arriving *state, const section *row, const uint8_t *in);
    void (*read)(spring_scene *s, const section *row, const uint8_t *in);
} section_kind;

struct section {
    const section_kind *kind;
    scene_array array;
    size_t count; /* elements */
    size_t bits;  /* of an element */
};

static size_t section_bytes(const section *row)
{
    return (row->count * row->bits + 63) / 64 * word_bytes;
}

#include "../simd/size_end.h"

static inline bool bit_at(const uint8_t *at, size_t i)
{
    return (at[i / 8] >> i % 8 & 1) != 0;
}

/* Sets bit i, which is 0. */
static inline void set_bit(uint8_t *at, size_t i, bool bit)
{
    at[i / 8] = (uint8_t)(at[i / 8] | bit << i % 8);
}

/* A quantity: all particles on the first axis, then on the next. */

static void write_quantity(const spring_scene *s, const section *row, uint8_t *out)
{
    const size_t particles = s->layout.particles;
    for (uint32_t a = 0; a < s->layout.axes; a++, out += particles * sizeof(scalar))
        copy_numbers(out, scene_read_axis(s, row->array, a), particles, sizeof(scalar));
}

static bool quantity_valid(arriving *state, const section *row, const uint8_t *in)
{
    (void)state;
    return numbers_valid(in, row->count, true, 0);
}

/* Kept forces may be infinite: RKN8 uses the last ones only in the next call, which then fails. */
static bool any_numbers(arriving *state, const section *row, const uint8_t *in)
{
    (void)state, (void)row, (void)in;
    return true;
}

static void read_quantity(spring_scene *s, const section *row, const uint8_t *in)
{
    const size_t particles = s->layout.particles;
    for (uint32_t a = 0; a < s->layout.axes; a++, in += particles * sizeof(scalar))
        copy_numbers(scene_axis(s, row->array, a), in, particles, sizeof(scalar));
}

/* A coefficient of all links of an editable scene, in the order of their indices. */

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

/* [bytes] from the start of the block; an editable scene stores all coefficients by slot. */
static inline size_t coefficient_at(const coefficient_storage *c, size_t link)
{
    const size_t slot = c->slots != NULL ? c->slots[link] : link;
    return (slot < c->band_slots ? c->banded : c->unbanded) + slot * sizeof(scalar);
}

static void write_coefficients(const spring_scene *s, const section *row, uint8_t *out)
{
    const coefficient_storage c = storage_of(s, row->array);
    for (size_t i = 0; i < row->count; i++)
        copy_numbers(out + i * sizeof(scalar), (const char *)s + coefficient_at(&c, i), 1, sizeof(scalar));
}

static void read_coefficients(spring_scene *s, const section *row, const uint8_t *in)
{
    const coefficient_storage c = storage_of(s, row->array);
    for (size_t i = 0; i < row->count; i++)
        copy_numbers((char *)s + coefficient_at(&c, i), in + i * sizeof(scalar), 1, sizeof(scalar));
}

/* Makes what follows from the coefficients of links, after they have been read. */
static void settle_links(spring_scene *s, uint64_t damped)
{
    const scene_layout *const l = &s->layout;
    const coefficient_storage rest = storage_of(s, ARRAY_LINK_REST), d = storage_of(s, ARRAY_LINK_DAMPING);
    scalar *const damping = scene_memory(s, ARRAY_BAND_DAMPING), *const unbanded = scene_memory(s, ARRAY_LINK_DAMPING);
    const scalar *const stiffness = scene_read(s, ARRAY_BAND_STIFFNESS);
    int8_t *const occupied = scene_memory(s, ARRAY_OCCUPIED);
    tether *const tethers = scene_memory(s, ARRAY_TETHERS);
    for (size_t i = 0; i < l->unbanded && damped == 0; i++)
        unbanded[i] = 0;
    for (size_t i = 0; i < l->tethers && damped == 0; i++)
        tethers[i].damping = 0;
    for (size_t i = 0; i < l->band_slots; i++) {
        damping[i] = damped > 0 ? damping[i] : 0;
        occupied[i] = stiffness[i] > 0 || damping[i] > 0 ? -1 : 0;
    }
    s->damped_links = s->isotropic_links = 0;
    for (size_t i = 0; i < l->links && damped > 0; i++) {
        scalar size, damper;
        memcpy(&size, (const char *)s + coefficient_at(&rest, i), sizeof size);
        memcpy(&damper, (const char *)s + coefficient_at(&d, i), sizeof damper);
        scene_count_damped(s, (double)size, (double)damper, true);
    }
    s->bounds_known = false;
}

/* Inverse masses of particles while they are free, and pins. */

static void write_masses(const spring_scene *s, const section *row, uint8_t *out)
{
    copy_numbers(out, scene_read(s, row->array), row->count, sizeof(scalar));
}

static bool masses_valid(arriving *state, const section *row, const uint8_t *in)
{
    state->masses = in;
    return numbers_valid(in, row->count, false, 0);
}

static void read_masses(spring_scene *s, const section *row, const uint8_t *in)
{
    copy_numbers(scene_memory(s, row->array), in, row->count, sizeof(scalar));
}

static void write_pins(const spring_scene *s, const section *row, uint8_t *out)
{
    for (size_t i = 0; i < row->count; i++)
        set_bit(out, i, inverse_mass_at(s, i) == 0);
}

static bool pins_valid(arriving *state, const section *row, const uint8_t *in)
{
    state->pins = in;
    for (size_t i = 0; i < row->count; i++) {
        const scalar inverse = number_at(state->masses, i);
        if (bit_at(in, i))
            continue;
        if (inverse == 0)
            return false;
        state->lightest = inverse > state->lightest ? inverse : state->lightest;
    }
    return scene_fits(state->s->drag * (double)state->lightest);
}

static void read_pins(spring_scene *s, const section *row, const uint8_t *in)
{
    const scalar *const freed = scene_read(s, ARRAY_FREE_MASS);
    for (size_t i = 0; i < row->count; i++)
        scene_set_inverse_mass(s, i, bit_at(in, i) ? 0 : freed[i]);
}

#include "../simd/size_begin.h"

/* The inverse mass of a particle in the state. */
static double arriving_inverse_mass(const arriving *state, size_t i)
{
    return bit_at(state->pins, i) ? 0 : (double)number_at(state->masses, i);
}

/* Stiffness or damping. As in spring_scene_check(), twice the value divided by the mass of an end must be finite. Usually
   all values would be valid for the lightest particle. */
static bool strengths_valid(arriving *state, const section *row, const uint8_t *in)
{
    uint64_t headroom = 0;
    for (double bound = 0.5; bound <= (double)state->lightest; bound *= 2)
        headroom++;
    if (numbers_valid(in, row->count, false, headroom))
        return true;
    for (size_t i = 0; i < row->count; i++) {
        const link_place at = scene_link_place(state->s, i);
        const double lighter = fmax(arriving_inverse_mass(state, at.a), arriving_inverse_mass(state, at.b));
        const double strength = (double)number_at(in, i);
        if (!scene_not_negative(strength) || !scene_fits(2 * (strength * lighter)))
            return false;
    }
    return true;
}

/* Stiffness or damping of tethers: while they do not act, they have coefficients of 0 elsewhere. */

static scalar *of_tether(tether *t, scene_array array)
{
    return array == ARRAY_LINK_STIFFNESS ? &t->stiffness : &t->damping;
}

static void write_strengths(const spring_scene *s, const section *row, uint8_t *out)
{
    const tether *const tethers = scene_read(s, ARRAY_TETHERS);
    write_coefficients(s, row, out);
    for (size_t i = 0; i < s->layout.tethers; i++) {
        tether t = tethers[i];
        copy_numbers(out + t.link * sizeof(scalar), of_tether(&t, row->array), 1, sizeof(scalar));
    }
}

static void read_strengths(spring_scene *s, const section *row, const uint8_t *in)
{
    tether *const tethers = scene_memory(s, ARRAY_TETHERS);
    const coefficient_storage c = storage_of(s, row->array);
    read_coefficients(s, row, in);
    for (size_t i = 0; i < s->layout.tethers; i++) {
        const link_place at = scene_link_place(s, tethers[i].link);
        const bool acts = (inverse_mass_at(s, at.a) == 0) != (inverse_mass_at(s, at.b) == 0);
        const scalar strength = number_at(in, tethers[i].link), acting = acts ? strength : 0;
        *of_tether(&tethers[i], row->array) = strength;
        memcpy((char *)s + coefficient_at(&c, tethers[i].link), &acting, sizeof acting);
    }
}

static bool dampings_valid(arriving *state, const section *row, const uint8_t *in)
{
    size_t damped = 0;
    for (size_t i = 0; i < row->count; i++)
        damped += number_at(in, i) > 0;
    return damped == state->header[WORD_DAMPED] && strengths_valid(state, row, in);
}

/* Rest lengths. With one axis, a link from the upper to the lower end has a negative one. Links of bands are stored like
   that, other links with the sign for their order of the ends. With more axes, links with flags are stored with a sign. */

static bool rests_valid(arriving *state, const section *row, const uint8_t *in)
{
    return numbers_valid(in, row->count, state->s->layout.axes == 1, 0);
}

/* Whether the stored rest length has another sign than that of the state. */
static bool has_other_sign(const spring_scene *s, size_t link)
{
    if (s->layout.axes > 1)
        return scene_link_flags(s, link) != 0;
    const link_place at = scene_link_place(s, link);
    return at.a > at.b;
}

static bool signs_differ(const spring_scene *s)
{
    const bool flagged = scene_has(s, ARRAY_FLAGS) || (s->layout.flags & SPRING_SCENE_TENSION_ONLY) != 0;
    return s->layout.axes == 1 ? s->layout.unbanded > 0 : flagged;
}

static void write_rests(const spring_scene *s, const section *row, uint8_t *out)
{
    write_coefficients(s, row, out);
    for (size_t i = 0; i < row->count && signs_differ(s); i++)
        if (has_other_sign(s, i))
            out[(i + 1) * sizeof(scalar) - 1] ^= 0x80;
}

static void read_rests(spring_scene *s, const section *row, const uint8_t *in)
{
    read_coefficients(s, row, in);
    const coefficient_storage c = storage_of(s, row->array);
    for (size_t i = 0; i < row->count && signs_differ(s); i++)
        if (has_other_sign(s, i)) {
            const scalar rest = -number_at(in, i);
            memcpy((char *)s + coefficient_at(&c, i), &rest, sizeof rest);
        }
}

/* Weighted links of an editable scene: four weights, rest length, stiffness, damping, and 1 if a band computes it. */

enum { weighted_numbers = 8 };

static void write_weighted(const spring_scene *s, const section *row, uint8_t *out)
{
    const stored_weighted *const all = scene_read(s, row->array);
    for (size_t i = 0; i < row->count; i++) {
        const stored_weighted *const l = &all[i];
        scalar numbers[weighted_numbers] = {0, 0, 0, 0, l->rest, l->stiffness, l->damping, l->banded};
        for (int k = 0; k < l->points; k++)
            numbers[l->place[k]] = l->weight[k];
        copy_numbers(out + i * sizeof numbers, numbers, weighted_numbers, sizeof(scalar));
    }
}

static spring_weighted_link weighted_at(const stored_weighted *l, const uint8_t *in)
{
    spring_weighted_link link = {
        .rest = (double)number_at(in, 4), .stiffness = (double)number_at(in, 5), .damping = (double)number_at(in, 6)};
    for (int k = 0; k < l->points; k++) {
        link.particle[l->place[k]] = l->particle[k];
        link.weight[l->place[k]] = (double)number_at(in, l->place[k]);
    }
    return link;
}

static bool weighted_valid(arriving *state, const section *row, const uint8_t *in)
{
    const stored_weighted *l = scene_read(state->s, row->array);
    for (size_t i = 0; i < row->count; i++, l++, in += weighted_numbers * sizeof(scalar)) {
        spring_weighted_link link = weighted_at(l, in);
        const double rounding = sizeof(scalar) < sizeof(double) ? 4 * (double)SCALAR_EPSILON : 1e-12;
        double inverse[4] = {0}, sum = 0, largest = 0;
        for (int k = 0; k < 4; k++) {
            inverse[k] = link.weight[k] != 0 ? arriving_inverse_mass(state, link.particle[k]) : 0;
            sum += link.weight[k];
            largest = fmax(largest, fabs(link.weight[k]));
        }
        const scalar banded = number_at(in, 7);
        if (!spring_finite(sum) || !(fabs(sum) <= rounding * largest) || !scene_not_negative(link.rest) ||
            !scene_not_negative(link.stiffness) || !scene_not_negative(link.damping) ||
            weighted_overflows(&link, inverse) != NULL || (banded != 0 && banded != 1) ||
            (banded == 1 && (l->slot == no_slot || three_points_of(&link).offset == 0)))
            return false;
    }
    return true;
}

/* After settle_links(). */
static void read_weighted(spring_scene *s, const section *row, const uint8_t *in)
{
    stored_weighted *l = scene_memory(s, row->array);
    s->loose = 0;
    for (size_t i = 0; i < row->count; i++, l++, in += weighted_numbers * sizeof(scalar)) {
        const spring_weighted_link link = weighted_at(l, in);
        scene_write_weighted(s, l, &link);
        if (l->banded && number_at(in, 7) == 0) { /* before its weights were rounded, it did not fit into a band */
            l->banded = false;
            const link_place at = scene_slot_place(s, l->slot);
            ((scalar *)scene_memory(s, ARRAY_BAND_STIFFNESS))[at.index] = 0;
            ((scalar *)scene_memory(s, ARRAY_BAND_DAMPING))[at.index] = 0;
            ((int8_t *)scene_memory(s, ARRAY_OCCUPIED))[at.slot] = 0;
        }
        s->damped_links += l->damping > 0;
        s->loose += !l->banded;
    }
}

/* Colliders. */

/* The numbers of a collider, in the order of the format. */
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

static void write_colliders(const spring_scene *s, const section *row, uint8_t *out)
{
    const spring_collider *const c = scene_read(s, row->array);
    for (size_t i = 0; i < row->count; i++) {
        const uint64_t first = c[i].shape | (uint64_t)c[i].mask << 32;
        copy_numbers(out, &first, 1, word_bytes);
        out += word_bytes;
        for (int k = 0; k < collider_fields; k++) {
            copy_numbers(out, (const char *)&c[i] + collider_numbers[k].offset, collider_numbers[k].count, word_bytes);
            out += collider_numbers[k].count * word_bytes;
        }
    }
}

/* Collider i of a state, with the function of collider i of the scene. */
static spring_collider collider_at(const spring_scene *s, const uint8_t *in, size_t i)
{
    in += i * collider_words * word_bytes;
    spring_collider c = {.shape = (spring_shape)(uint32_t)word_at(in), .mask = (uint32_t)(word_at(in) >> 32)};
    if (i < s->colliders) {
        const spring_collider *const own = scene_read(s, ARRAY_COLLIDERS);
        c.gap = own[i].gap;
        c.user = own[i].user;
    }
    in += word_bytes;
    for (int k = 0; k < collider_fields; k++) {
        copy_numbers((char *)&c + collider_numbers[k].offset, in, collider_numbers[k].count, word_bytes);
        in += collider_numbers[k].count * word_bytes;
    }
    return c;
}

static bool colliders_valid(arriving *state, const section *row, const uint8_t *in)
{
    for (size_t i = 0; i < row->count; i++) {
        const spring_collider c = collider_at(state->s, in, i), *own = scene_read(state->s, row->array);
        const bool custom = i < state->s->colliders && own[i].shape == SPRING_CUSTOM;
        if ((uint32_t)word_at(in + i * collider_words * word_bytes) > SPRING_CUSTOM ||
            (c.shape == SPRING_CUSTOM) != custom ||
            spring_scene_check_colliders(state->s, &c, 1, NULL, NULL) != SPRING_OK)
            return false;
    }
    return true;
}

static void read_colliders(spring_scene *s, const section *row, const uint8_t *in)
{
    spring_collider *const c = scene_memory(s, row->array);
    for (size_t i = 0; i < row->count; i++)
        c[i] = collider_at(s, in, i);
}

/* The particles that touch colliders, and their bits. */

static void write_touching(const spring_scene *s, const section *row, uint8_t *out)
{
    const uint32_t *const touched = scene_read(s, touched_in(s->buffer));
    for (size_t i = 0; i < row->count; i++)
        set_bit(out, i, touched[i] != 0);
}

static bool touching_valid(arriving *state, const section *row, const uint8_t *in)
{
    size_t count = 0;
    for (size_t i = 0; i < row->count; i++)
        count += bit_at(in, i);
    return count == state->header[WORD_TOUCHING];
}

static void read_touching(spring_scene *s, const section *row, const uint8_t *in)
{
    uint32_t *const touched = scene_memory(s, touched_in(s->buffer));
    for (size_t i = 0; i < row->count; i++)
        touched[i] = bit_at(in, i);
}

static void write_touched(const spring_scene *s, const section *row, uint8_t *out)
{
    const uint32_t *touched = scene_read(s, touched_in(s->buffer));
    for (size_t i = 0; i < row->count; touched++)
        if (*touched != 0) {
            for (size_t k = 0; k < row->bits / 8; k++)
                *out++ = (uint8_t)(*touched >> 8 * k);
            i++;
        }
}

static uint32_t touched_at(const section *row, const uint8_t *in, size_t i)
{
    uint32_t bits = 0;
    for (size_t k = 0; k < row->bits / 8; k++)
        bits |= (uint32_t)in[i * row->bits / 8 + k] << 8 * k;
    return bits;
}

static bool touched_valid(arriving *state, const section *row, const uint8_t *in)
{
    for (size_t i = 0; i < row->count; i++) {
        const uint64_t bits = touched_at(row, in, i);
        if (bits == 0 || bits >> state->header[WORD_COLLIDERS] != 0)
            return false;
    }
    return true;
}

/* After read_touching(). */
static void read_touched(spring_scene *s, const section *row, const uint8_t *in)
{
    uint32_t *touched = scene_memory(s, touched_in(s->buffer));
    for (size_t i = 0; i < row->count; touched++)
        if (*touched != 0)
            *touched = touched_at(row, in, i++);
}

static const section_kind quantity_section = {write_quantity, quantity_valid, read_quantity},
                          kept_force_section = {write_quantity, any_numbers, read_quantity},
                          masses_section = {write_masses, masses_valid, read_masses},
                          pins_section = {write_pins, pins_valid, read_pins},
                          rests_section = {write_rests, rests_valid, read_rests},
                          stiffnesses_section = {write_strengths, strengths_valid, read_strengths},
                          dampings_section = {write_strengths, dampings_valid, read_strengths},
                          weighted_section = {write_weighted, weighted_valid, read_weighted},
                          colliders_section = {write_colliders, colliders_valid, read_colliders},
                          touching_section = {write_touching, touching_valid, read_touching},
                          touched_section = {write_touched, touched_valid, read_touched};

enum { most_sections = 13 };

/* Lists the sections of a state, in their order. Returns their number. */
static int list_sections(const spring_scene *s, const uint64_t header[WORD_COUNT], section list[most_sections])
{
    const scene_layout *const l = &s->layout;
    const bool editable = (l->flags & SPRING_SCENE_EDITABLE) != 0, holds = (l->flags & SPRING_SCENE_FORCES) != 0;
    const size_t numbers = l->axes * l->particles, particles = editable ? l->particles : 0;
    const size_t links = editable ? l->links : 0, number = 8 * sizeof(scalar);
    const size_t bodies = (size_t)header[WORD_COLLIDERS];
    const section rows[] = {
        {&quantity_section, positions_in(s->buffer), numbers, number},
        {&quantity_section, velocities_in(s->buffer), numbers, number},
        {&kept_force_section, forces_in(s->buffer), header[WORD_KEPT] != NO_FORCE ? numbers : 0, number},
        {&quantity_section, ARRAY_HELD, holds ? numbers : 0, number},
        {&masses_section, ARRAY_FREE_MASS, particles, number},
        {&pins_section, ARRAY_INVERSE_MASS, particles, 1},
        {&rests_section, ARRAY_LINK_REST, links, number},
        {&stiffnesses_section, ARRAY_LINK_STIFFNESS, links, number},
        {&dampings_section, ARRAY_LINK_DAMPING, header[WORD_DAMPED] > 0 ? links : 0, number},
        {&weighted_section, ARRAY_WEIGHTED, editable ? l->weighted : 0, weighted_numbers * number},
        {&colliders_section, ARRAY_COLLIDERS, bodies, 64 * collider_words},
        {&touching_section, touched_in(s->buffer), bodies > 0 ? l->particles : 0, 1},
        {&touched_section, touched_in(s->buffer), (size_t)header[WORD_TOUCHING], (bodies + 7) / 8 * 8},
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
    uint8_t *at = (uint8_t *)out + sizeof header;
    for (int i = 0; i < count; at += section_bytes(&list[i]), i++) {
        const size_t all = section_bytes(&list[i]), zeros = list[i].bits == 1 ? all : word_bytes;
        memset(at + all - zeros, 0, zeros); /* padding, and the bytes to which bits are added */
        list[i].kind->write(s, &list[i], at);
    }
    const uint64_t check = check_value(out, size - word_bytes);
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
    const uint8_t *const end = (const uint8_t *)in + bytes - word_bytes;
    if (state_bytes(list, count) != bytes || check_value(in, bytes - word_bytes) != word_at(end))
        return SPRING_EINVAL;
    arriving state = {.s = s, .header = header};
    const uint8_t *at = (const uint8_t *)in + sizeof header;
    for (int i = 0; i < count; at += section_bytes(&list[i]), i++)
        if (!list[i].kind->valid(&state, &list[i], at))
            return SPRING_EINVAL;
    for (uint32_t buffer = 0; buffer < 2; buffer++) /* without colliders no step writes them */
        if (scene_has(s, touched_in(buffer)))
            memset(scene_memory(s, touched_in(buffer)), 0, s->layout.particles * sizeof(uint32_t));
    at = (const uint8_t *)in + sizeof header;
    bool settled = (s->layout.flags & SPRING_SCENE_EDITABLE) == 0;
    for (int i = 0; i < count; at += section_bytes(&list[i]), i++) {
        if (list[i].kind == &weighted_section) { /* all coefficients of links have been read */
            settle_links(s, header[WORD_DAMPED]);
            settled = true;
        }
        list[i].kind->read(s, &list[i], at);
    }
    if (!settled)
        settle_links(s, header[WORD_DAMPED]);
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
