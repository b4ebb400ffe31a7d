/* SPDX-License-Identifier: MIT */
/*
 * The layout of a scene: finding bands, placing arrays, and finding the slot of each link.
 *
 * Bands     Links with the same index offset (upper minus lower end) form a band as long as their lower ends ascend in
 *           the order of the links, so that no slot is used twice. At least a quarter of the slots from the first to
 *           the last must be in use; otherwise single links are faster. If there are more than most_bands bands, the
 *           longest are kept. Offsets are counted in a small hash table. Links that do not fit into the table or into
 *           their band are unbanded. So are the links of particles without a regular order.
 */
#include "contact.h"
#include "definition.h"
#include "method_limits.h"
#include "state_numbers.h"

#include "../simd/size_begin.h"

/* ------------------------------------------------------------------------------------------------------------ bands */

static uint32_t lower_end(const spring_link *link)
{
    return link->a < link->b ? link->a : link->b;
}

static uint32_t offset_of(const spring_link *link)
{
    return link->a < link->b ? link->b - link->a : link->a - link->b;
}

/* A candidate for a band. */
typedef struct candidate {
    uint32_t offset; /* 0: this entry is free */
    uint32_t first, last, count;
    bool equal;
    const spring_link *sample; /* NULL: a three-point link */
} candidate;

enum { candidates = 256, probes = 8 };

static bool equal_links(const spring_link *a, const spring_link *b)
{
    return a->stiffness == b->stiffness && a->damping == b->damping && a->rest == b->rest && a->flags == b->flags &&
           (a->a > a->b) == (b->a > b->b);
}

static void count_link(candidate table[candidates], uint32_t offset, uint32_t lower, const spring_link *link)
{
    const uint32_t hash = offset * 2654435761u >> 24; /* Knuth's multiplicative hash: the high bits */
    for (uint32_t probe = 0; probe < probes; probe++) {
        candidate *c = &table[(hash + probe) % candidates];
        if (c->offset == 0)
            *c = (candidate){offset, lower, lower, 1, link != NULL, link};
        else if (c->offset == offset && lower > c->last) {
            c->equal = c->equal && link != NULL && c->sample != NULL && equal_links(link, c->sample);
            c->last = lower;
            c->count++;
        }
        if (c->offset == offset)
            return;
    }
}

static bool makes_a_band(const candidate *c)
{
    const uint32_t least = 8, sparsest = 4;
    return c->count >= least && c->count >= (c->last - c->first + 1) / sparsest;
}

static uint32_t count_longer(const candidate table[candidates], const candidate *than)
{
    uint32_t longer = 0;
    for (const candidate *c = table; c < table + candidates; c++)
        longer += makes_a_band(c) && (c->count > than->count || (c->count == than->count && c < than));
    return longer;
}

static band_kind kind_of(const spring_link *link)
{
    return (link->flags & SPRING_LINK_TETHER) != 0 ? BAND_OF_TETHERS : BAND_OF_LINKS;
}

/* Finds the bands of a kind, as many as there is still room for. */
static void find_bands_of(band_kind kind, const spring_scene_def *def, scene_layout *l)
{
    const bool editable = (def->flags & SPRING_SCENE_EDITABLE) != 0;
    const uint32_t room = most_bands - l->bands;
    candidate table[candidates] = {{0}};
    for (size_t i = 0; i < def->links && kind != BAND_OF_THREE_POINTS; i++)
        if (kind_of(&def->link[i]) == kind)
            count_link(table, offset_of(&def->link[i]), lower_end(&def->link[i]), &def->link[i]);
    for (size_t i = 0; i < def->weighted_links && kind == BAND_OF_THREE_POINTS; i++) {
        const three_points points = three_points_of(&def->weighted_link[i]);
        if (points.offset > 0)
            count_link(table, points.offset, points.lower, NULL);
    }
    for (const candidate *c = table; c < table + candidates; c++) {
        if (!makes_a_band(c) || count_longer(table, c) >= room)
            continue;
        const band_layout band = {.kind = (uint8_t)kind,
                                  .offset = c->offset,
                                  .first = c->first,
                                  .end = c->last + 1,
                                  .equal = c->equal && !editable && kind != BAND_OF_TETHERS};
        const bool three = kind == BAND_OF_THREE_POINTS;
        size_t at = l->bands++;
        for (; at > (three ? l->bands - 1 - l->three_point_bands : 0) && l->band[at - 1].offset > c->offset; at--)
            l->band[at] = l->band[at - 1];
        l->band[at] = band;
        *(three ? &l->loose : &l->unbanded) -= c->count;
        l->three_point_bands += three;
    }
}

static void find_bands(const spring_scene_def *def, scene_layout *l)
{
    find_bands_of(BAND_OF_LINKS, def, l);
    if (l->tethers > 0)
        find_bands_of(BAND_OF_TETHERS, def, l);
    if (l->weighted > 0)
        find_bands_of(BAND_OF_THREE_POINTS, def, l);
    for (uint32_t r = 0; r < l->bands; r++) {
        band_layout *band = &l->band[r];
        const size_t slots = (band->end + tile - 1) / tile * tile - band->first / tile * tile;
        band->slots = l->band_slots;
        band->coefficients = l->band_coefficients;
        band->ring_start = l->band_ring;
        /* the empty tiles before and behind the slots share a tile */
        const size_t reach = band->kind == BAND_OF_THREE_POINTS ? 2 * (size_t)band->offset : band->offset;
        const size_t until_read = (reach + 2 * tile - 1) / tile * tile, all = slots + tile;
        band->ring = until_read < all ? until_read : all;
        l->reach = reach > l->reach ? reach : l->reach;
        l->band_slots += slots;
        l->band_coefficients += band->equal ? padding : slots;
        l->band_ring += l->axes * (band->ring + tile);
    }
}

/* ----------------------------------------------------------------------------------------------------------- arrays */

/* The methods that store nothing for stages or masses. */
static uint32_t default_methods(void)
{
    uint32_t methods = 0;
    for (int m = 0; m < SPRING_METHOD_COUNT; m++)
        if (spring_method_limits[m].stable_step != NULL && spring_method_limits[m].stage_arrays == 0 &&
            spring_method_limits[m].mass_factors == 0)
            methods |= 1u << m;
    return methods;
}

static uint32_t methods_of(const spring_scene_def *def)
{
    return def->methods == 0 ? default_methods() : def->methods;
}

/* Storage for the methods of a scene: the largest that one of them needs. */
typedef struct storage_needs {
    bool predicts;
    unsigned stage_arrays, mass_factors;
} storage_needs;

static storage_needs needs_of(uint32_t methods)
{
    storage_needs most = {0};
    for (int m = 0; m < SPRING_METHOD_COUNT; m++) {
        const method_limits *method = &spring_method_limits[m];
        if ((methods & 1u << m) == 0)
            continue;
        most.predicts = most.predicts || method->predicts;
        most.stage_arrays = method->stage_arrays > most.stage_arrays ? method->stage_arrays : most.stage_arrays;
        most.mass_factors = method->mass_factors > most.mass_factors ? method->mass_factors : most.mass_factors;
    }
    return most;
}

static size_t count_tethers(const spring_scene_def *def)
{
    size_t tethers = 0;
    for (size_t i = 0; i < def->links; i++)
        tethers += kind_of(&def->link[i]) == BAND_OF_TETHERS;
    return tethers;
}

/* Whether a scene has so few particles and links that it has neither bands, which are computed in whole SIMD vectors,
   nor records. The results of bands and of unbanded links differ in rounding errors, so this limit is part of the
   results. */
static bool has_few_links(const spring_scene_def *def)
{
    const size_t few = 12;
    return axes_of(def) > 1 && def->particles <= few && def->links - count_tethers(def) <= few;
}

/* A row of the table of arrays. */
typedef struct array_row {
    size_t element; /* [bytes] */
    size_t count;
    bool present;
} array_row;

/* The arrays of a scene. Sizes and conditions are defined by this table alone; docs/details.md describes it. */
static void list_arrays(const spring_scene_def *def, const element_sizes *size, const scene_layout *l,
                        array_row row[ARRAY_COUNT])
{
    const bool rollback = (l->flags & SPRING_SCENE_NO_UNDO) == 0, editable = (l->flags & SPRING_SCENE_EDITABLE) != 0;
    const bool damped = editable || has_damped_links(def);
    const bool velocity_used = damped || (l->flags & SPRING_SCENE_FORCE_IGNORES_VELOCITY) == 0;
    const storage_needs needs = needs_of(l->methods);
    const bool predicts = needs.predicts && velocity_used, kicks = needs.predicts && damped;
    const bool records = l->axes > 1 && l->unbanded + l->loose >= l->particles && !has_few_links(def);
    const bool collides = l->colliders > 0, flagged = link_flags(def) != 0;
    /* Their velocities are read after the forces of bands have been stored. */
    const bool reads_later = l->weighted > 0 || (l->unbanded > 0 && (l->bands > 0 || !records));
    const size_t number = size->number, index = sizeof(uint32_t), quantity = l->quantity;
    const size_t chunk = contact_chunk_bytes / number, chunks = (l->particles + chunk - 1) / chunk;
    const size_t coefficients = l->band_coefficients, unbanded = l->unbanded + padding;
    const array_row rows[ARRAY_COUNT] = {
        [ARRAY_X_0] = {number, quantity, true},
        [ARRAY_V_0] = {number, quantity, true},
        [ARRAY_X_1] = {number, quantity, rollback},
        [ARRAY_V_1] = {number, quantity, rollback},
        [ARRAY_FORCE_0] = {number, quantity, true},
        [ARRAY_FORCE_1] = {number, quantity, predicts},
        [ARRAY_PREDICTED] = {number, quantity, predicts && damped && reads_later},
        [ARRAY_STAGES] = {number, needs.stage_arrays * quantity, needs.stage_arrays > 0},
        [ARRAY_INVERSE_MASS] = {number, l->masses, def->mass != NULL || def->pinned != NULL || editable},
        [ARRAY_FREE_MASS] = {number, l->particles, editable},
        [ARRAY_MASS_FACTORS] = {number, needs.mass_factors * l->masses, def->drag > 0 && needs.mass_factors > 0},
        [ARRAY_OCCUPIED] = {1, l->band_slots, l->bands > 0},
        [ARRAY_RINGS] = {number, l->band_ring, l->bands > 0},
        [ARRAY_BAND_STIFFNESS] = {number, coefficients, l->bands > 0},
        [ARRAY_BAND_REST] = {number, coefficients, l->bands > 0},
        [ARRAY_BAND_DAMPING] = {number, coefficients, l->bands > 0 && damped},
        [ARRAY_LINK_A] = {index, l->unbanded, l->unbanded > 0},
        [ARRAY_LINK_B] = {index, l->unbanded, l->unbanded > 0},
        [ARRAY_LINK_STIFFNESS] = {number, unbanded, l->unbanded > 0},
        [ARRAY_LINK_REST] = {number, unbanded, l->unbanded > 0},
        [ARRAY_LINK_DAMPING] = {number, unbanded, l->unbanded > 0 && damped},
        [ARRAY_FLAGS] = {1, l->links, flagged},
        [ARRAY_TETHERS] = {size->tether_link, l->tethers, l->tethers > 0},
        [ARRAY_WEIGHTED] = {size->weighted, l->weighted, l->weighted > 0},
        [ARRAY_SLOTS] = {index, l->links, l->bands > 0},
        [ARRAY_RECORDS] = {number, l->particles * quad_size * (damped ? 3 : 2), records},
        [ARRAY_ROOTS] = {number, l->band_slots + unbanded, kicks},
        [ARRAY_FROZEN] = {number, 2 * (l->band_slots + unbanded), kicks},
        [ARRAY_KICK] = {number, (collides ? 4 : 3) * quantity, kicks},
        [ARRAY_PRESSED] = {number, pressed_values * l->stride, kicks && collides},
        [ARRAY_SUMS] = {number, l->particles, true},
        [ARRAY_HELD] = {number, quantity, (l->flags & SPRING_SCENE_FORCES) != 0},
        [ARRAY_COLLIDERS] = {sizeof(spring_collider), l->colliders, collides},
        [ARRAY_PLACED] = {sizeof(contact_body), l->colliders, collides},
        [ARRAY_BOUNDS] = {1, size->bounds_head + l->colliders * size->bound, collides},
        [ARRAY_CLEARANCE] = {number, chunks * clearance_stride(l->colliders), collides},
        [ARRAY_IMPULSES] = {sizeof(spring_impulse), 2 * (size_t)l->colliders, collides},
        [ARRAY_ORIGINS] = {sizeof(double[3]), l->colliders, collides},
        [ARRAY_RADIUS] = {number, l->particles + padding, collides && def->radius != NULL},
        [ARRAY_FRICTION] = {number, l->particles + padding, collides && def->friction != NULL},
        [ARRAY_BITS] = {index, l->particles, collides && def->mask != NULL},
        [ARRAY_TOUCHED_0] = {sizeof(uint32_t), l->particles + padding, collides},
        [ARRAY_TOUCHED_1] = {sizeof(uint32_t), l->particles + padding, collides && rollback},
    };
    memcpy(row, rows, sizeof rows);
}

static uint64_t aligned(uint64_t bytes)
{
    return (bytes + SPRING_SCENE_ALIGN - 1) / SPRING_SCENE_ALIGN * SPRING_SCENE_ALIGN;
}

static void place_arrays(const spring_scene_def *def, const element_sizes *size, scene_layout *l)
{
    array_row row[ARRAY_COUNT];
    list_arrays(def, size, l, row);
    l->bytes = aligned(size->block) + SPRING_SCENE_ALIGN; /* room for align_arrays() */
    for (int a = 0; a < ARRAY_COUNT; a++) {
        l->offset[a] = row[a].present ? (size_t)l->bytes - SPRING_SCENE_ALIGN : SIZE_MAX;
        l->bytes += row[a].present ? aligned((uint64_t)row[a].count * row[a].element) : 0;
    }
    if (!row[ARRAY_FORCE_1].present)
        l->offset[ARRAY_FORCE_1] = l->offset[ARRAY_FORCE_0];
}

spring_status spring_definition_layout(const spring_scene_def *def, const element_sizes *size, scene_layout *l)
{
    const spring_status status = spring_definition_check(def, size->number, NULL, NULL);
    if (status != SPRING_OK)
        return status;
    *l = (scene_layout){
        .axes = axes_of(def),
        .flags = def->flags,
        .methods = methods_of(def),
        .colliders = def->colliders,
        .particles = def->particles,
        .links = def->links,
        .weighted = def->weighted_links,
        .tethers = count_tethers(def),
        .unbanded = def->links,
        .loose = def->weighted_links,
    };
    const bool each_mass = def->mass != NULL || def->pinned != NULL || (def->flags & SPRING_SCENE_EDITABLE) != 0;
    if (!has_few_links(def))
        find_bands(def, l);
    /* Loops over bands read whole tiles, and vectors that start at upper ends. Other loops read whole vectors. */
    const size_t unit = l->bands > 0 ? tile : padding, beyond = l->bands > 0 ? padding : 0;
    l->stride = (def->particles + unit - 1) / unit * unit + beyond;
    l->quantity = l->axes * l->stride + 2 * padding;
    l->masses = each_mass ? l->stride : padding;
    place_arrays(def, size, l);
    return l->bytes <= SIZE_MAX ? SPRING_OK : SPRING_ERANGE;
}

/* ----------------------------------------------------------------------------------------------------------- slots */

static const band_layout *band_of(const scene_layout *l, band_kind kind, uint32_t offset)
{
    for (const band_layout *band = l->band; band < l->band + l->bands; band++)
        if (band->offset == offset && band->kind == kind)
            return band;
    return NULL;
}

static uint32_t slot_in_band(const scene_layout *l, band_kind kind, uint32_t offset, uint32_t lower,
                             uint32_t next[most_bands])
{
    const band_layout *const band = band_of(l, kind, offset);
    if (band == NULL || lower < next[band - l->band])
        return no_slot;
    next[band - l->band] = lower + 1;
    return (uint32_t)(band->slots + lower - band->first / tile * tile);
}

void spring_layout_links(const scene_layout *l, const spring_scene_def *def, uint32_t *slots, uint32_t *end_a,
                         uint32_t *end_b, uint8_t *flags)
{
    uint32_t next[most_bands] = {0}, unbanded = 0;
    for (size_t i = 0; i < def->links; i++) {
        const spring_link *link = &def->link[i];
        uint32_t slot = slot_in_band(l, kind_of(link), offset_of(link), lower_end(link), next);
        if (slot == no_slot) {
            slot = (uint32_t)l->band_slots + unbanded;
            end_a[unbanded] = link->a;
            end_b[unbanded] = link->b;
            unbanded++;
        }
        if (slots != NULL)
            slots[i] = slot;
        if (flags != NULL)
            flags[i] = (uint8_t)link->flags;
    }
}

uint32_t spring_layout_weighted_slot(const scene_layout *l, const spring_weighted_link *link, uint32_t next[most_bands])
{
    const three_points points = three_points_of(link);
    return points.offset > 0 ? slot_in_band(l, BAND_OF_THREE_POINTS, points.offset, points.lower, next) : no_slot;
}

uint8_t spring_weighted_points(const spring_weighted_link *link, uint32_t particle[4], uint8_t place[4])
{
    int first = 0;
    uint8_t points = 0;
    for (int i = 1; i < 4; i++)
        if (fabs(link->weight[i]) > fabs(link->weight[first]))
            first = i;
    for (int i = 0; i < 4; i++) {
        const int at = i == 0 ? first : i <= first ? i - 1 : i;
        if (link->weight[at] == 0)
            continue;
        place[points] = (uint8_t)at;
        particle[points++] = link->particle[at];
    }
    return points;
}

/* ------------------------------------------------------------------------------------------------------------- ends */

static uint64_t hashed_numbers(uint64_t hash, const double *number, size_t count)
{
    for (size_t i = 0; i < count && number != NULL; i++) {
        const double value = number[i] + 0; /* -0 counts as 0 */
        uint64_t bits;
        memcpy(&bits, &value, sizeof bits);
        hash = hashed(hash, bits);
    }
    return hashed(hash, number != NULL);
}

uint64_t spring_definition_ends(const spring_scene_def *def)
{
    const bool directed = axes_of(def) == 1 && (def->flags & SPRING_SCENE_EDITABLE) == 0;
    uint64_t hash = 0;
    for (size_t i = 0; i < def->links; i++) {
        const uint64_t a = def->link[i].a, b = def->link[i].b;
        hash = hashed(hash, directed || a < b ? a | b << 32 : b | a << 32);
        if (def->link[i].flags != 0)
            hash = hashed(hash, def->link[i].flags);
    }
    for (size_t i = 0; i < def->weighted_links; i++) {
        uint32_t particle[4];
        uint8_t place[4];
        const uint8_t points = spring_weighted_points(&def->weighted_link[i], particle, place);
        for (uint64_t k = 0; k < points; k++)
            hash = hashed(hash, particle[k] | k << 32 | (uint64_t)place[k] << 40);
    }
    if (def->colliders == 0 || (def->radius == NULL && def->friction == NULL && def->mask == NULL))
        return hash;
    hash = hashed_numbers(hash, def->radius, def->particles);
    hash = hashed_numbers(hash, def->friction, def->particles);
    for (size_t i = 0; i < def->particles && def->mask != NULL; i++)
        hash = hashed(hash, def->mask[i]);
    return hash;
}

#include "../simd/size_end.h"
