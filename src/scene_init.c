/* SPDX-License-Identifier: MIT */
/*
 * From a definition to a scene: checks, the plan of its memory, and filling it.
 *
 * Bands     The links of an offset, upper minus lower end, make a band as far as their lower ends ascend in the order
 *           of the links, so that no slot is occupied twice, if at least a quarter of the slots between the first and
 *           the last is occupied: then the band is cheaper than the edge list. Of too many bands the longest are kept.
 *           Offsets are counted in a small table. What finds no room there, or in its band, goes to the edge list, as
 *           do all links of particles without order.
 */
#include "scene_links.h"
#include "scene_step.h"

#include <limits.h>

/* ------------------------------------------------------------------------------------------------------- checks */

typedef struct def_error {
    spring_status status;
    const char *field;
    size_t index;
} def_error;

static const def_error no_error = {SPRING_OK, NULL, 0};

static def_error invalid(const char *field, size_t index)
{
    return (def_error){SPRING_EINVAL, field, index};
}

static uint32_t axes_of(const spring_scene_def *def)
{
    return def->axes == 0 ? 3 : def->axes;
}

/* Every method that stores nothing for its stages. */
static uint32_t default_methods(void)
{
    uint32_t methods = 0;
    for (int m = 0; m < SPRING_METHOD_COUNT; m++)
        if (spring_scene_methods[m]->step != NULL && spring_scene_methods[m]->stages == 0)
            methods |= 1u << m;
    return methods;
}

static uint32_t methods_of(const spring_scene_def *def)
{
    return def->methods == 0 ? default_methods() : def->methods;
}

/* What these methods store in a scene: the most that one of them does. */
typedef struct storage_needs {
    bool predicts;
    unsigned stages, factors;
} storage_needs;

static storage_needs needs_of(uint32_t methods)
{
    storage_needs most = {0};
    for (int m = 0; m < SPRING_METHOD_COUNT; m++) {
        const scene_method *method = spring_scene_methods[m];
        if ((methods & 1u << m) == 0)
            continue;
        most.predicts = most.predicts || method->predicts;
        most.stages = method->stages > most.stages ? method->stages : most.stages;
        most.factors = method->factors > most.factors ? method->factors : most.factors;
    }
    return most;
}

static def_error check_methods(uint32_t methods)
{
    for (int m = 0; m < SPRING_METHOD_COUNT; m++)
        if ((methods & 1u << m) != 0 && spring_scene_methods[m]->step == NULL)
            return (def_error){SPRING_EUNSUPPORTED, "methods", 0};
    return methods >> SPRING_METHOD_COUNT == 0 ? no_error : invalid("methods", 0);
}

static bool is_pinned(const spring_scene_def *def, size_t i)
{
    return def->pinned != NULL && def->pinned[i] != 0;
}

static double mass_of(const spring_scene_def *def, size_t i)
{
    return def->mass != NULL ? def->mass[i] : def->mass_all == 0 ? 1 : def->mass_all;
}

/* 0 for particles that nothing moves. */
static scalar inverse_mass_of(const spring_scene_def *def, size_t i)
{
    return is_pinned(def, i) ? 0 : (scalar)(1 / mass_of(def, i));
}

/* What it is when they are freed; 0: no valid mass. */
static scalar free_inverse_mass_of(const spring_scene_def *def, size_t i)
{
    const double all = def->mass_all == 0 ? 1 : def->mass_all;
    const double mass = def->mass != NULL && def->mass[i] > 0 ? def->mass[i] : all;
    return scene_mass_valid(mass) ? (scalar)(1 / mass) : 0;
}

static def_error check_head(const spring_scene_def *def)
{
    const uint32_t flags = SPRING_SCENE_EDITABLE | SPRING_SCENE_NO_UNDO | SPRING_SCENE_FORCE_IGNORES_VELOCITY;
    if (def->axes > 3)
        return invalid("axes", 0);
    if ((def->flags & ~flags) != 0)
        return invalid("flags", 0);
    if (check_methods(def->methods).status != SPRING_OK)
        return check_methods(def->methods);
    if (def->particles == 0)
        return invalid("particles", 0);
    if (def->particles > UINT32_MAX - padding || def->particles > SIZE_MAX / 64 / sizeof(double))
        return (def_error){SPRING_ERANGE, "particles", 0};
    if (def->links > UINT32_MAX / 8 || def->links > SIZE_MAX / 64 / sizeof(double))
        return (def_error){SPRING_ERANGE, "links", 0};
    if (def->position == NULL)
        return invalid("position", 0);
    if (def->link == NULL && def->links > 0)
        return invalid("link", 0);
    if (def->mass == NULL && def->mass_all != 0 && !scene_mass_valid(def->mass_all))
        return invalid("mass_all", 0);
    for (uint32_t a = 0; a < axes_of(def); a++)
        if (!scene_fits(def->gravity[a]))
            return invalid("gravity", a);
    return scene_not_negative(def->drag) ? no_error : invalid("drag", 0);
}

static def_error check_particles(const spring_scene_def *def)
{
    const uint32_t axes = axes_of(def);
    for (size_t i = 0; i < def->particles; i++) {
        for (uint32_t a = 0; a < axes; a++) {
            if (!scene_fits(def->position[i * axes + a]))
                return invalid("position", i);
            if (def->velocity != NULL && !scene_fits(def->velocity[i * axes + a]))
                return invalid("velocity", i);
        }
        if (!is_pinned(def, i) && !scene_mass_valid(mass_of(def, i)))
            return invalid("mass", i);
        if (!scene_fits(def->drag * (double)inverse_mass_of(def, i)))
            return invalid("drag", i);
    }
    return no_error;
}

static def_error check_links(const spring_scene_def *def)
{
    for (size_t i = 0; i < def->links; i++) {
        const spring_link *link = &def->link[i];
        if (link->a >= def->particles)
            return (def_error){SPRING_ERANGE, "link.a", i};
        if (link->b >= def->particles)
            return (def_error){SPRING_ERANGE, "link.b", i};
        if (link->a == link->b)
            return invalid("link.b", i);
        const char *field = scene_link_invalid_field(link);
        if (field == NULL)
            field = scene_link_overflows(link, (double)inverse_mass_of(def, link->a),
                                         (double)inverse_mass_of(def, link->b));
        if (field != NULL)
            return invalid(field, i);
    }
    return no_error;
}

static bool any_damping(const spring_scene_def *def)
{
    for (size_t i = 0; i < def->links; i++)
        if (def->link[i].damping > 0)
            return true;
    return false;
}

/* Forces that depend on velocities, for methods that do without. */
static def_error check_velocities(const spring_scene_def *def)
{
    const bool called = def->force != NULL && (def->flags & SPRING_SCENE_FORCE_IGNORES_VELOCITY) == 0;
    for (int m = 0; m < SPRING_METHOD_COUNT; m++)
        if ((def->methods & 1u << m) != 0 && spring_method_describe((spring_method)m)->positions_only &&
            (called || any_damping(def)))
            return (def_error){SPRING_EUNSUPPORTED, "methods", 0};
    return no_error;
}

static def_error check(const spring_scene_def *def)
{
    if (def == NULL)
        return invalid("def", 0);
    def_error found = check_head(def);
    if (found.status == SPRING_OK)
        found = check_particles(def);
    if (found.status == SPRING_OK)
        found = check_links(def);
    if (found.status == SPRING_OK)
        found = check_velocities(def);
    return found;
}

spring_status spring_scene_check(const spring_scene_def *def, const char **field, size_t *index)
{
    const def_error found = check(def);
    if (field != NULL)
        *field = found.field;
    if (index != NULL)
        *index = found.index;
    return found.status;
}

/* ----------------------------------------------------------------------------------------------------- the plan */

static uint32_t lower_end(const spring_link *link)
{
    return link->a < link->b ? link->a : link->b;
}

static uint32_t offset_of(const spring_link *link)
{
    return link->a < link->b ? link->b - link->a : link->a - link->b;
}

typedef struct candidate { /* for a band */
    uint32_t offset;       /* 0: free */
    uint32_t first, last, count;
    bool equal;
    const spring_link *sample;
} candidate;

enum { candidates = 256, probes = 8 };

static bool equal_links(const spring_link *a, const spring_link *b)
{
    return a->stiffness == b->stiffness && a->damping == b->damping && a->rest == b->rest &&
           (a->a > a->b) == (b->a > b->b);
}

static void count_link(candidate table[candidates], const spring_link *link)
{
    const uint32_t offset = offset_of(link), lower = lower_end(link);
    const uint32_t hash = offset * 2654435761u >> 24; /* Knuth's multiplicative hash: the high bits */
    for (uint32_t probe = 0; probe < probes; probe++) {
        candidate *c = &table[(hash + probe) % candidates];
        if (c->offset == 0)
            *c = (candidate){offset, lower, lower, 1, true, link};
        else if (c->offset == offset && lower > c->last) {
            c->equal = c->equal && equal_links(link, c->sample);
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

static uint32_t longer_bands(const candidate table[candidates], const candidate *than)
{
    uint32_t longer = 0;
    for (const candidate *c = table; c < table + candidates; c++)
        longer += makes_a_band(c) && (c->count > than->count || (c->count == than->count && c < than));
    return longer;
}

static void plan_bands(const spring_scene_def *def, scene_plan *plan)
{
    const bool editable = (def->flags & SPRING_SCENE_EDITABLE) != 0;
    candidate table[candidates] = {{0}};
    for (size_t i = 0; i < def->links; i++)
        count_link(table, &def->link[i]);
    for (const candidate *c = table; c < table + candidates; c++) {
        if (!makes_a_band(c) || longer_bands(table, c) >= most_bands)
            continue;
        size_t at = plan->bands++;
        for (; at > 0 && plan->band[at - 1].offset > c->offset; at--)
            plan->band[at] = plan->band[at - 1];
        plan->band[at] =
            (band_plan){.offset = c->offset, .first = c->first, .end = c->last + 1, .equal = c->equal && !editable};
        plan->edges -= c->count;
    }
    for (uint32_t r = 0; r < plan->bands; r++) {
        band_plan *band = &plan->band[r];
        const size_t slots = (band->end + tile - 1) / tile * tile - band->first / tile * tile;
        band->slots = plan->band_slots;
        band->coefficients = plan->band_coefficients;
        band->force = plan->band_force;
        /* the empty tiles before the slots and behind them share a place */
        const size_t until_read = ((size_t)band->offset + 2 * tile - 1) / tile * tile, all = slots + tile;
        band->ring = until_read < all ? until_read : all;
        band->back = band->offset % band->ring;
        plan->band_slots += slots;
        plan->band_coefficients += band->equal ? padding : slots;
        plan->band_force += plan->axes * (band->ring + tile);
    }
}

/* Reserve memory behind the scene: its offset. */
static size_t reserve(scene_plan *plan, size_t elements, size_t size)
{
    const uint64_t offset = plan->bytes, align = SPRING_SCENE_ALIGN;
    plan->bytes += ((uint64_t)elements * size + align - 1) / align * align;
    return (size_t)offset;
}

static void plan_memory(const spring_scene_def *def, scene_plan *plan)
{
    const bool rollback = (plan->flags & SPRING_SCENE_NO_UNDO) == 0,
               editable = (plan->flags & SPRING_SCENE_EDITABLE) != 0;
    const bool damped = editable || any_damping(def);
    const bool velocity_used = damped || (plan->flags & SPRING_SCENE_FORCE_IGNORES_VELOCITY) == 0;
    const storage_needs needs = needs_of(plan->methods);
    const bool predicts = needs.predicts && velocity_used;
    const bool records = plan->axes > 1 && !plan->small && plan->edges >= plan->particles;
    const size_t quantity =
        (plan->small ? quad_size * (plan->particles + quad_size) : plan->axes * plan->stride) + 2 * padding;
    plan->bytes = (sizeof(spring_scene) + SPRING_SCENE_ALIGN - 1) / SPRING_SCENE_ALIGN * SPRING_SCENE_ALIGN;
    for (uint32_t i = 0; i < (rollback ? buffers : 1); i++) {
        plan->x[i] = reserve(plan, quantity, sizeof(scalar));
        plan->v[i] = reserve(plan, quantity, sizeof(scalar));
    }
    plan->force[0] = reserve(plan, quantity, sizeof(scalar));
    plan->force[1] = predicts ? reserve(plan, quantity, sizeof(scalar)) : plan->force[0];
    if (predicts && damped && plan->edges > 0 && (plan->bands > 0 || !records))
        plan->predicted = reserve(plan, quantity, sizeof(scalar));
    plan->stage_step = quantity;
    plan->stages = reserve(plan, needs.stages * quantity, sizeof(scalar));
    const bool each = def->mass != NULL || def->pinned != NULL || editable;
    const size_t masses = !each ? padding : plan->small ? quantity : plan->stride;
    if (each)
        plan->inverse_mass = reserve(plan, masses, sizeof(scalar));
    if (editable)
        plan->free_inverse_mass = reserve(plan, plan->particles, sizeof(scalar));
    plan->factor_step = masses;
    plan->factors = reserve(plan, def->drag > 0 ? needs.factors * masses : 0, sizeof(scalar));
    plan->occupied = reserve(plan, plan->band_slots, 1);
    plan->rings = reserve(plan, plan->band_force, sizeof(scalar));
    plan->band_stiffness = reserve(plan, plan->band_coefficients, sizeof(scalar));
    plan->band_rest = reserve(plan, plan->band_coefficients, sizeof(scalar));
    plan->band_damping = damped ? reserve(plan, plan->band_coefficients, sizeof(scalar)) : 0;
    plan->edge_a = reserve(plan, plan->edges, sizeof(uint32_t));
    plan->edge_b = reserve(plan, plan->edges, sizeof(uint32_t));
    plan->edge_stiffness = reserve(plan, plan->edges + padding, sizeof(scalar));
    plan->edge_rest = reserve(plan, plan->edges + padding, sizeof(scalar));
    plan->edge_damping = damped ? reserve(plan, plan->edges + padding, sizeof(scalar)) : 0;
    plan->slot = plan->bands > 0 ? reserve(plan, plan->links, sizeof(uint32_t)) : 0;
    if (records)
        plan->records = reserve(plan, plan->particles * quad_size * (damped ? 3 : 2), sizeof(scalar));
    if (plan->small)
        plan->callback = reserve(plan, 3 * plan->axes * plan->particles, sizeof(scalar));
}

/* Links and particles of a small scene: below, vectors are not filled. */
enum { most_small = 12 };

static spring_status make_plan(const spring_scene_def *def, scene_plan *plan)
{
    const spring_status status = spring_scene_check(def, NULL, NULL);
    if (status != SPRING_OK)
        return status;
    *plan = (scene_plan){
        .axes = axes_of(def),
        .flags = def->flags,
        .methods = methods_of(def),
        .particles = def->particles,
        .links = def->links,
    };
    plan->small = plan->axes > 1 && def->particles <= most_small && def->links <= most_small;
    plan->step = plan->small ? quad_size : 1;
    plan->stride = plan->small ? 1 : (def->particles + tile - 1) / tile * tile + padding;
    plan->edges = def->links;
    if (!plan->small)
        plan_bands(def, plan);
    plan_memory(def, plan);
    return plan->bytes <= SIZE_MAX ? SPRING_OK : SPRING_ERANGE;
}

spring_status spring_scene_bytes(const spring_scene_def *def, size_t *bytes)
{
    if (bytes == NULL)
        return SPRING_EINVAL;
    scene_plan plan;
    const spring_status status = make_plan(def, &plan);
    if (status == SPRING_OK)
        *bytes = (size_t)plan.bytes;
    return status;
}

/* ------------------------------------------------------------------------------------------------------ filling */

static void fill_particles(spring_scene *s, const spring_scene_def *def)
{
    const uint32_t axes = s->plan.axes;
    for (uint32_t a = 0; a < axes; a++) {
        scalar *x = scene_axis(s, s->plan.x[0], a), *v = scene_axis(s, s->plan.v[0], a);
        for (size_t i = 0; i < def->particles; i++) {
            x[s->plan.step * i] = (scalar)def->position[i * axes + a];
            v[s->plan.step * i] = def->velocity != NULL ? (scalar)def->velocity[i * axes + a] : 0;
        }
    }
    for (size_t i = 0; i < def->particles && s->plan.inverse_mass != 0; i++)
        scene_place_inverse_mass(s, i, inverse_mass_of(def, i));
    for (size_t i = 0; i < def->particles && s->plan.free_inverse_mass != 0; i++)
        scene_array(s, s->plan.free_inverse_mass)[i] = free_inverse_mass_of(def, i);
}

static const band_plan *band_of(const scene_plan *plan, uint32_t offset)
{
    for (const band_plan *band = plan->band; band < plan->band + plan->bands && band->offset <= offset; band++)
        if (band->offset == offset)
            return band;
    return NULL;
}

/* Fills a vector with its first element. */
static void spread(scalar *vector)
{
    for (size_t i = 1; i < padding; i++)
        vector[i] = vector[0];
}

static void fill_links(spring_scene *s, const spring_scene_def *def)
{
    uint32_t *slot = scene_indices(s, s->plan.slot);
    uint32_t next[most_bands] = {0}; /* lower end that a band takes, or one above it */
    uint32_t edge = 0;
    for (size_t i = 0; i < def->links; i++) {
        const spring_link *link = &def->link[i];
        const uint32_t lower = lower_end(link);
        const band_plan *band = band_of(&s->plan, offset_of(link));
        size_t at;
        if (band != NULL && lower >= next[band - s->plan.band]) {
            next[band - s->plan.band] = lower + 1;
            at = band->slots + lower - band->first / tile * tile;
        } else {
            at = s->plan.band_slots + edge;
            scene_indices(s, s->plan.edge_a)[edge] = link->a;
            scene_indices(s, s->plan.edge_b)[edge] = link->b;
            edge++;
        }
        if (s->plan.slot != 0)
            slot[i] = (uint32_t)at;
        scene_place(s, i, link);
        s->damped_links += (scalar)link->damping > 0;
    }
    for (const band_plan *band = s->plan.band; band < s->plan.band + s->plan.bands; band++)
        if (band->equal) {
            spread(scene_array(s, s->plan.band_stiffness) + band->coefficients);
            spread(scene_array(s, s->plan.band_rest) + band->coefficients);
            if (s->plan.band_damping != 0)
                spread(scene_array(s, s->plan.band_damping) + band->coefficients);
        }
}

spring_status spring_scene_init(void *memory, size_t bytes, const spring_scene_def *def, spring_scene **result)
{
    if (result == NULL)
        return SPRING_EINVAL;
    *result = NULL;
    scene_plan plan;
    const spring_status status = make_plan(def, &plan);
    if (status != SPRING_OK)
        return status;
    if (memory == NULL)
        return SPRING_EINVAL;
    if ((uintptr_t)memory % SPRING_SCENE_ALIGN != 0)
        return SPRING_EALIGN;
    if (bytes < plan.bytes)
        return SPRING_ENOMEM;
    memset(memory, 0, (size_t)plan.bytes);
    spring_scene *s = memory;
    *s = (spring_scene){
        .plan = plan,
        .force = def->force,
        .user = def->user,
        .mass_all = def->mass_all == 0 ? 1 : def->mass_all,
        .drag = def->drag,
    };
    s->inverse_mass_vector[0] = (scalar)(1 / s->mass_all);
    spread(s->inverse_mass_vector);
    scene_place_gravity(s, def->gravity);
    fill_particles(s, def);
    fill_links(s, def);
    *result = s;
    return SPRING_OK;
}
