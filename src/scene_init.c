/* SPDX-License-Identifier: MIT */
/*
 * From a definition to a scene: checks, the plan of its memory, and filling it.
 *
 * Rows      The links of an offset, upper minus lower end, make a row as far as their lower ends ascend in the order of
 *           the links, so that no place is taken twice, if at least a quarter of the places between the first and the
 *           last is taken: then the row is cheaper than the list. Of too many rows the longest are kept. Offsets are
 *           counted in a small table. What finds no room there, or in its row, goes to the list, as do all links of
 *           particles without order.
 */
#include "scene_block.h"

#include <limits.h>

/* ------------------------------------------------------------------------------------------------------- checks */

typedef struct culprit {
    spring_status status;
    const char *field;
    size_t index;
} culprit;

static const culprit nobody = {SPRING_OK, NULL, 0};

static culprit invalid(const char *field, size_t index)
{
    return (culprit){SPRING_EINVAL, field, index};
}

static bool fits(double value) /* is finite as a scalar, too */
{
    return isfinite((scalar)value);
}

static bool not_negative(double value)
{
    return value >= 0 && fits(value);
}

static uint32_t axes_of(const scene_def *def)
{
    return def->axes == 0 ? 3 : def->axes;
}

static uint32_t methods_of(const scene_def *def)
{
    return def->methods == 0 ? 1u << SPRING_EULER | 1u << SPRING_LEAPFROG : def->methods;
}

static bool is_pinned(const scene_def *def, size_t i)
{
    return def->pinned != NULL && def->pinned[i] != 0;
}

static double mass_of(const scene_def *def, size_t i)
{
    return def->mass != NULL ? def->mass[i] : def->mass_all == 0 ? 1 : def->mass_all;
}

/* 0 for particles that nothing moves. */
static scalar inverse_mass_of(const scene_def *def, size_t i)
{
    return is_pinned(def, i) ? 0 : (scalar)(1 / mass_of(def, i));
}

static bool mass_valid(double mass)
{
    return mass > 0 && fits(mass) && fits(1 / mass);
}

static culprit check_head(const scene_def *def)
{
    const uint32_t flags = SPRING_SCENE_EDITABLE | SPRING_SCENE_NO_UNDO | SPRING_SCENE_FORCE_STILL;
    const uint32_t steppers = 1u << SPRING_EULER | 1u << SPRING_LEAPFROG | 1u << SPRING_RK4;
    if (def->axes > 3)
        return invalid("axes", 0);
    if ((def->flags & ~flags) != 0)
        return invalid("flags", 0);
    if ((def->methods & 1u << SPRING_EXACT) != 0)
        return (culprit){SPRING_EUNSUPPORTED, "methods", 0};
    if ((def->methods & ~steppers) != 0)
        return invalid("methods", 0);
    if (def->particles == 0)
        return invalid("particles", 0);
    if (def->particles > UINT32_MAX - padding || def->particles > SIZE_MAX / 64 / sizeof(double))
        return (culprit){SPRING_ERANGE, "particles", 0};
    if (def->links > UINT32_MAX / 8 || def->links > SIZE_MAX / 64 / sizeof(double))
        return (culprit){SPRING_ERANGE, "links", 0};
    if (def->position == NULL)
        return invalid("position", 0);
    if (def->link == NULL && def->links > 0)
        return invalid("link", 0);
    if (def->mass == NULL && def->mass_all != 0 && !mass_valid(def->mass_all))
        return invalid("mass_all", 0);
    for (uint32_t a = 0; a < axes_of(def); a++)
        if (!fits(def->gravity[a]))
            return invalid("gravity", a);
    return not_negative(def->drag) ? nobody : invalid("drag", 0);
}

static culprit check_particles(const scene_def *def)
{
    const uint32_t axes = axes_of(def);
    for (size_t i = 0; i < def->particles; i++) {
        for (uint32_t a = 0; a < axes; a++) {
            if (!fits(def->position[i * axes + a]))
                return invalid("position", i);
            if (def->velocity != NULL && !fits(def->velocity[i * axes + a]))
                return invalid("velocity", i);
        }
        if (!is_pinned(def, i) && !mass_valid(mass_of(def, i)))
            return invalid("mass", i);
        if (!fits(def->drag * (double)inverse_mass_of(def, i)))
            return invalid("drag", i);
    }
    return nobody;
}

/* Of numbers that do not depend on where a link is. */
static const char *wrong_in_link(const spring_link *link)
{
    return !not_negative(link->rest)        ? "link.rest"
           : !not_negative(link->stiffness) ? "link.stiffness"
           : !not_negative(link->damping)   ? "link.damping"
                                            : NULL;
}

/* Of numbers that are too large for the masses at the ends: w or g of rule "bad input" would overflow. */
static const char *too_much(const spring_link *link, double inverse_a, double inverse_b)
{
    const double lightest = fmax(inverse_a, inverse_b);
    return !fits(2 * (link->stiffness * lightest)) ? "link.stiffness"
           : !fits(2 * (link->damping * lightest)) ? "link.damping"
                                                   : NULL;
}

static culprit check_links(const scene_def *def)
{
    for (size_t i = 0; i < def->links; i++) {
        const spring_link *link = &def->link[i];
        if (link->a >= def->particles)
            return (culprit){SPRING_ERANGE, "link.a", i};
        if (link->b >= def->particles)
            return (culprit){SPRING_ERANGE, "link.b", i};
        if (link->a == link->b)
            return invalid("link.b", i);
        const char *field = wrong_in_link(link);
        if (field == NULL)
            field =
                too_much(link, (double)inverse_mass_of(def, link->a), (double)inverse_mass_of(def, link->b));
        if (field != NULL)
            return invalid(field, i);
    }
    return nobody;
}

static culprit check(const scene_def *def)
{
    if (def == NULL)
        return invalid("def", 0);
    culprit found = check_head(def);
    if (found.status == SPRING_OK)
        found = check_particles(def);
    if (found.status == SPRING_OK)
        found = check_links(def);
    return found;
}

spring_status SCENE(check)(const scene_def *def, const char **field, size_t *index)
{
    const culprit found = check(def);
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

typedef struct candidate { /* for a row */
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

static bool makes_a_row(const candidate *c)
{
    const uint32_t least = 8, sparsest = 4;
    return c->count >= least && c->count >= (c->last - c->first + 1) / sparsest;
}

static uint32_t longer_rows(const candidate table[candidates], const candidate *than)
{
    uint32_t longer = 0;
    for (const candidate *c = table; c < table + candidates; c++)
        longer += makes_a_row(c) && (c->count > than->count || (c->count == than->count && c < than));
    return longer;
}

static void plan_rows(const scene_def *def, scene_plan *plan)
{
    const bool editable = (def->flags & SPRING_SCENE_EDITABLE) != 0;
    candidate table[candidates] = {{0}};
    for (size_t i = 0; i < def->links; i++)
        count_link(table, &def->link[i]);
    plan->list_links = def->links;
    for (const candidate *c = table; c < table + candidates; c++) {
        if (!makes_a_row(c) || longer_rows(table, c) >= most_rows)
            continue;
        size_t at = plan->rows++;
        for (; at > 0 && plan->row[at - 1].offset > c->offset; at--)
            plan->row[at] = plan->row[at - 1];
        plan->row[at] = (row_place){c->offset, c->first, c->last + 1, c->equal && !editable, 0, 0, 0};
        plan->list_links -= c->count;
    }
    for (uint32_t r = 0; r < plan->rows; r++) {
        row_place *row = &plan->row[r];
        const size_t places = (row->end - row->first + 2 * padding + padding - 1) / padding * padding;
        row->start = plan->row_places;
        row->numbers = plan->row_numbers;
        row->present = plan->row_bytes;
        plan->row_places += places;
        plan->row_numbers += row->equal ? padding : places;
        plan->row_bytes += row->equal ? places : 0;
    }
}

/* Gives out the memory behind the scene. */
static size_t take(scene_plan *plan, size_t elements, size_t size)
{
    const size_t offset = plan->bytes;
    plan->bytes += (elements * size + SPRING_SCENE_ALIGN - 1) / SPRING_SCENE_ALIGN * SPRING_SCENE_ALIGN;
    return offset;
}

static bool any_damping(const scene_def *def)
{
    for (size_t i = 0; i < def->links; i++)
        if (def->link[i].damping > 0)
            return true;
    return false;
}

static void plan_memory(const scene_def *def, scene_plan *plan)
{
    const bool rk4 = (plan->methods & 1u << SPRING_RK4) != 0,
               leapfrog = (plan->methods & 1u << SPRING_LEAPFROG) != 0;
    const bool undo = (plan->flags & SPRING_SCENE_NO_UNDO) == 0,
               editable = (plan->flags & SPRING_SCENE_EDITABLE) != 0;
    const bool damped = editable || any_damping(def);
    const bool predicted = leapfrog && (damped || (plan->flags & SPRING_SCENE_FORCE_STILL) == 0);
    const size_t vector = plan->axes * plan->stride + padding;
    plan->bytes = (sizeof(scene) + SPRING_SCENE_ALIGN - 1) / SPRING_SCENE_ALIGN * SPRING_SCENE_ALIGN;
    plan->work = undo ? 2 : 1;
    for (uint32_t f = 0; f < most_frames; f++)
        if (f == 0 || (f == 1 && undo) || (f == plan->work && rk4)) {
            plan->x[f] = take(plan, vector, sizeof(scalar));
            plan->v[f] = take(plan, vector, sizeof(scalar));
        }
    plan->force = take(plan, vector, sizeof(scalar));
    plan->predicted = predicted ? take(plan, vector, sizeof(scalar)) : 0;
    plan->sum_x = rk4 ? take(plan, vector, sizeof(scalar)) : 0;
    plan->sum_v = rk4 ? take(plan, vector, sizeof(scalar)) : 0;
    plan->inverse_mass =
        def->mass != NULL || def->pinned != NULL ? take(plan, plan->stride, sizeof(scalar)) : 0;
    plan->row_present = take(plan, plan->row_bytes, 1);
    plan->row_stiffness = take(plan, plan->row_numbers, sizeof(scalar));
    plan->row_rest = take(plan, plan->row_numbers, sizeof(scalar));
    plan->row_damping = damped ? take(plan, plan->row_numbers, sizeof(scalar)) : 0;
    plan->list_a = take(plan, plan->list_links, sizeof(uint32_t));
    plan->list_b = take(plan, plan->list_links, sizeof(uint32_t));
    plan->list_stiffness = take(plan, plan->list_links + padding, sizeof(scalar));
    plan->list_rest = take(plan, plan->list_links + padding, sizeof(scalar));
    plan->list_damping = damped ? take(plan, plan->list_links + padding, sizeof(scalar)) : 0;
    plan->slot = take(plan, plan->links, sizeof(uint32_t));
}

static spring_status make_plan(const scene_def *def, scene_plan *plan)
{
    const spring_status status = SCENE(check)(def, NULL, NULL);
    if (status != SPRING_OK)
        return status;
    *plan = (scene_plan){
        .axes = axes_of(def),
        .flags = def->flags,
        .methods = methods_of(def),
        .particles = def->particles,
        .links = def->links,
        .stride = (def->particles + padding - 1) / padding * padding + padding,
    };
    plan_rows(def, plan);
    plan_memory(def, plan);
    return SPRING_OK;
}

spring_status SCENE(bytes)(const scene_def *def, size_t *bytes)
{
    if (bytes == NULL)
        return SPRING_EINVAL;
    scene_plan plan;
    const spring_status status = make_plan(def, &plan);
    if (status == SPRING_OK)
        *bytes = plan.bytes;
    return status;
}

/* ------------------------------------------------------------------------------------------------------ filling */

static void fill_particles(scene *s, const scene_def *def)
{
    const uint32_t axes = s->plan.axes;
    for (uint32_t a = 0; a < axes; a++) {
        scalar *x = scene_axis(s, s->plan.x[0], a), *v = scene_axis(s, s->plan.v[0], a);
        for (size_t i = 0; i < def->particles; i++) {
            x[i] = (scalar)def->position[i * axes + a];
            v[i] = def->velocity != NULL ? (scalar)def->velocity[i * axes + a] : 0;
        }
    }
    if (s->plan.inverse_mass != 0) {
        scalar *inverse_mass = scene_array(s, s->plan.inverse_mass);
        for (size_t i = 0; i < def->particles; i++)
            inverse_mass[i] = inverse_mass_of(def, i);
    }
}

static const row_place *row_of(const scene_plan *plan, uint32_t offset)
{
    for (const row_place *row = plan->row; row < plan->row + plan->rows && row->offset <= offset; row++)
        if (row->offset == offset)
            return row;
    return NULL;
}

/* Writes the numbers of a link to where it lies. */
static void place(scene *s, size_t index, const spring_link *link)
{
    const placed_link at = scene_link(s, index);
    *at.stiffness = (scalar)link->stiffness;
    const scalar rest = (scalar)fabs(link->rest); /* -0.0 would turn a link on one axis */
    *at.rest = s->plan.axes == 1 && at.a != link->a ? -rest : rest;
    if (at.damping != NULL)
        *at.damping = (scalar)link->damping;
}

/* Fills a vector with its first element. */
static void spread(scalar *vector)
{
    for (size_t i = 1; i < padding; i++)
        vector[i] = vector[0];
}

static void fill_links(scene *s, const scene_def *def)
{
    uint32_t *slot = scene_indices(s, s->plan.slot);
    uint32_t next[most_rows] = {0}; /* lower end that a row takes, or one above it */
    uint32_t listed = 0;
    for (size_t i = 0; i < def->links; i++) {
        const spring_link *link = &def->link[i];
        const uint32_t lower = lower_end(link);
        const row_place *row = row_of(&s->plan, offset_of(link));
        if (row != NULL && lower >= next[row - s->plan.row]) {
            next[row - s->plan.row] = lower + 1;
            slot[i] = (uint32_t)(row->start + padding + lower - row->first);
            if (row->equal)
                scene_bytes_at(s, s->plan.row_present)[row->present + slot[i] - row->start] = -1;
        } else {
            slot[i] = (uint32_t)(s->plan.row_places + listed);
            scene_indices(s, s->plan.list_a)[listed] = link->a;
            scene_indices(s, s->plan.list_b)[listed] = link->b;
            listed++;
        }
        place(s, i, link);
        s->damped_links += (scalar)link->damping > 0;
    }
    for (const row_place *row = s->plan.row; row < s->plan.row + s->plan.rows; row++)
        if (row->equal) {
            spread(scene_array(s, s->plan.row_stiffness) + row->numbers);
            spread(scene_array(s, s->plan.row_rest) + row->numbers);
            if (s->plan.row_damping != 0)
                spread(scene_array(s, s->plan.row_damping) + row->numbers);
        }
}

spring_status SCENE(init)(void *memory, size_t bytes, const scene_def *def, scene **result)
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
    memset(memory, 0, plan.bytes);
    scene *s = memory;
    *s = (scene){
        .plan = plan,
        .force = def->force,
        .user = def->user,
        .mass_all = def->mass_all == 0 ? 1 : def->mass_all,
        .drag = def->drag,
        .gravity = {def->gravity[0], def->gravity[1], def->gravity[2]},
    };
    fill_particles(s, def);
    fill_links(s, def);
    *result = s;
    return SPRING_OK;
}

spring_status SCENE(set_link)(scene *s, size_t index, const spring_link *link)
{
    if (s == NULL || link == NULL)
        return SPRING_EINVAL;
    if ((s->plan.flags & SPRING_SCENE_EDITABLE) == 0)
        return SPRING_EUNSUPPORTED;
    if (index >= s->plan.links)
        return SPRING_ERANGE;
    const placed_link old = scene_link(s, index);
    const bool same_ends = (link->a == old.a && link->b == old.b) || (link->a == old.b && link->b == old.a);
    if (!same_ends || wrong_in_link(link) != NULL ||
        too_much(link, inverse_mass_at(s, old.a), inverse_mass_at(s, old.b)) != NULL)
        return SPRING_EINVAL;
    s->damped_links -= *old.damping > 0;
    s->damped_links += (scalar)link->damping > 0;
    place(s, index, link);
    s->force_kept = false;
    s->limits_known = false;
    return SPRING_OK;
}
