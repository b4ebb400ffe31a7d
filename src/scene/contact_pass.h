/* SPDX-License-Identifier: MIT */
/* Motions of particles with contacts. All particles of a chunk are advanced without colliders first. Those that may be in
   contact are then advanced again: particles that rest or slide on one collider by the kernels for SIMD vectors, the
   others by contact.c, in the order of their indices. */
#ifndef SPRINGSTEP_CONTACT_PASS_H
#define SPRINGSTEP_CONTACT_PASS_H

#include "block.h"

#include <math.h>

/* The contacts of a step. */
typedef struct scene_contacts {
    contact_setting setting;
    const collider_bounds *bounds;
    const scalar *radius;   /* [m] */
    const scalar *friction; /* by particle: factor of the friction of colliders; NULL: 1 */
    size_t radius_stride;   /* from particle to particle: 1, or 0: one vector for all particles */
    scalar equal_radius[padding];
    const scalar *x;                /* [m] positions at the end of the step */
    const uint32_t *touched_before; /* by particle: bit i is set if collider i was touched in the previous step */
    uint32_t *touched;              /* written: the same for this step; may be `touched_before` */
    scalar *clearance;              /* [m] by chunk and collider: see contact_near_tmpl.h */
    bool begins;                    /* the first step of a call: the clearance is not known yet */
} scene_contacts;

/* A particle in a motion with contacts. Its free motion has the operations of leapfrog_particles_tmpl.h. */
typedef struct contact_state {
    scalar x0[3], v0[3], free[3]; /* free: the acceleration without drag */
    scalar drag;                  /* [1/s] */
    scalar leading, correction;   /* of an implicit kick */
    contact_particle c;
} contact_state;

static inline vector3 vector_plus(vector3 a, double s, vector3 b) /* a + s b */
{
    return (vector3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline vector3 vector_minus(vector3 a, vector3 b)
{
    return vector_plus(a, -1, b);
}

static inline double vector_dot(vector3 a, vector3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline vector3 vector_times(double s, vector3 a)
{
    return (vector3){s * a.x, s * a.y, s * a.z};
}

/* The components of a quantity of all particles, whose axes are `stride` apart. */
static inline vector3 load_vector(const scalar *quantity, size_t stride, uint32_t axes)
{
    return (vector3){(double)quantity[0], (double)quantity[stride], axes > 2 ? (double)quantity[2 * stride] : 0};
}

static inline void store_vector(scalar *quantity, size_t stride, uint32_t axes, vector3 v)
{
    quantity[0] = (scalar)v.x;
    quantity[stride] = (scalar)v.y;
    if (axes > 2)
        quantity[2 * stride] = (scalar)v.z;
}

static inline vector3 vector_from(const scalar v[3])
{
    return (vector3){(double)v[0], (double)v[1], (double)v[2]};
}

static inline void round_vector(scalar to[3], vector3 v)
{
    to[0] = (scalar)v.x;
    to[1] = (scalar)v.y;
    to[2] = (scalar)v.z;
}

/* The solution u of u = v + kick (free - drag u). */
static inline vector3 kicked_implicitly_by(const contact_state *p, scalar kick, const scalar v[3])
{
    scalar u[3];
    for (int a = 0; a < 3; a++) {
        u[a] = v[a] + kick * p->free[a];
        u[a] = p->drag != 0 ? p->leading * u[a] + p->correction * u[a] : u[a];
    }
    return vector_from(u);
}

static inline bool finite_vector(vector3 v)
{
    return spring_finite(v.x) && spring_finite(v.y) && spring_finite(v.z);
}

static inline bool too_fast_vector(const scene_motion *m, vector3 v)
{
    const double limit = (double)m->max_speed;
    return !(fabs(v.x) <= limit && fabs(v.y) <= limit && fabs(v.z) <= limit);
}

/* Whether the stored result of this particle is not finite, or too fast. */
static inline bool wrong_state(const scene_particles *p, const scene_motion *m, size_t i)
{
    const vector3 x = load_vector(m->x + i, p->stride, p->axes), v = load_vector(m->v + i, p->stride, p->axes);
    const bool ends = m->contacts != KICK_DRIFT_CONTACTS, pinned = p->inverse_mass[i * p->mass_stride] == 0;
    return !finite_vector(x) || !finite_vector(v) || (ends && !pinned && too_fast_vector(m, v)) ||
           (m->predicted != NULL && !finite_vector(load_vector(m->predicted + i, p->stride, p->axes)));
}

/* Advances a particle with contacts, and writes its results if they differ from the free motion. Returns false if they
   are not finite or too fast. */
static bool advance_in_contact(const scene_contacts *t, const scene_particles *p, const scene_motion *m, size_t i,
                               contact_state *q)
{
    const double drift = (double)m->drift, h = t->setting.h;
    scalar accel[3];
    const size_t stride = p->stride;
    const uint32_t axes = p->axes;
    vector3 v0 = vector_from(q->v0);
    bool fine = true;
    if (m->contacts == KICK_DRIFT_CONTACTS) {
        if (m->ends_previous) {
            v0 = kicked_implicitly_by(q, m->kick, q->v0);
            round_vector(q->v0, v0); /* to the stored precision, as at the end of a call */
            v0 = vector_from(q->v0);
            fine = !too_fast_vector(m, v0);
        }
        for (int a = 0; a < 3; a++) {
            accel[a] = q->drag != 0 ? q->free[a] - q->drag * q->v0[a] : q->free[a];
            q->v0[a] += m->kick * accel[a];
        }
        q->c.accel = vector_from(accel);
        q->c.w = vector_from(q->v0);
        q->c.d = vector_times(drift, q->c.w);
    } else if (m->contacts == IMPLICIT_KICK_DRIFT_CONTACTS) {
        q->c.w = kicked_implicitly_by(q, m->kick, q->v0);
        q->c.accel = vector_plus(vector_from(q->free), -(double)q->drag, q->c.w);
        q->c.d = vector_times(drift, q->c.w);
    } else { /* as for a drift with the mean velocity, and kicks by the mean acceleration */
        const vector3 v1 = load_vector(m->v + i, stride, axes);
        q->c.d = vector_minus(load_vector(m->x + i, stride, axes), q->c.x0);
        q->c.w = vector_times(1 / h, q->c.d);
        q->c.accel = vector_times(1 / h, vector_minus(v1, v0));
        q->c.kick = vector_minus(v1, q->c.w);
    }
    q->c.v0 = v0;
    if (!finite_vector(q->c.d) || !finite_vector(q->c.x0)) /* a function of a custom body sees finite numbers only */
        return false;
    spring_contact_drift(&t->setting, &q->c);
    t->touched[i] = q->c.touched;
    if (q->c.touched == 0)
        return fine && !q->c.wrong && !wrong_state(p, m, i);
    const vector3 x = vector_plus(q->c.x0, 1, q->c.d);
    vector3 v = q->c.w;
    if (m->contacts == WHOLE_STEP_CONTACTS) {
        v = vector_plus(v, 1, q->c.kick);
        spring_contact_stop(&t->setting, &q->c, q->c.touched, true, x, &v);
    }
    store_vector(m->x + i, stride, axes, x);
    store_vector(m->v + i, stride, axes, v);
    if (m->predicted != NULL) {
        contact_setting queries = t->setting;
        queries.records = false;
        round_vector(q->v0, v);
        vector3 predicted = kicked_implicitly_by(q, m->kick, q->v0);
        spring_contact_stop(&queries, &q->c, q->c.touched, true, x, &predicted);
        store_vector(m->predicted + i, stride, axes, predicted);
    }
    return fine && !q->c.wrong && !wrong_state(p, m, i);
}

/* Particle i, in place k of the chunk. */
static void prepare_state(const spring_scene *s, const scene_contacts *t, const scene_particles *p,
                          const scene_motion *m, const kept_motion *kept, size_t i, size_t k, contact_state *c)
{
    const scalar inverse_mass = p->inverse_mass[i * p->mass_stride], drag = p->drag * inverse_mass, q = m->kick * drag;
    c->drag = drag;
    if (drag != 0) {
        const bool light = q <= 1 && q >= -1;
        c->leading = light ? 1 : 0;
        c->correction = (light ? 0 - q : 1) / (1 + q);
    }
    scene_contact_particle(s, i, &c->c);
    c->c.friction = t->friction != NULL ? (double)t->friction[i] : 1;
    c->free[2] = c->v0[2] = c->x0[2] = 0;
    for (uint32_t a = 0; a < p->axes; a++) {
        const scalar force = kept->force[a * kept->force_stride + k] + p->held[(a * p->stride + i) * p->held_stride];
        c->free[a] = inverse_mass * force + p->gravity[a * padding];
        c->v0[a] = kept->v0[a][k];
        c->x0[a] = kept->x0[a][k];
    }
    c->c.x0 = vector_from(c->x0);
}

/* Advances particle i, in place k of the chunk. nearby: as in contact_particle; *way becomes at least the length of its
   path */
SPRING_NOINLINE bool advance_alone(const spring_scene *s, const scene_contacts *t, const scene_particles *p,
                                   const scene_motion *m, const kept_motion *kept, size_t i, size_t k, uint32_t nearby,
                                   double *way)
{
    contact_state q;
    prepare_state(s, t, p, m, kept, i, k, &q);
    q.c.nearby = nearby;
    const bool fine = advance_in_contact(t, p, m, i, &q);
    *way = fmax(*way, fabs(q.c.d.x) + fabs(q.c.d.y) + fabs(q.c.d.z));
    return fine;
}

/* Removes candidates that masks exclude. */
SPRING_NOINLINE void apply_masks(const spring_scene *s, candidate_chunk *r)
{
    const uint32_t *const masks = scene_read(s, ARRAY_BITS);
    for (uint32_t l = 0; l < r->listed && masks != NULL; l++) {
        const size_t k = r->list[l];
        for (unsigned c = 0; c < r->setting->count; c++)
            if ((r->setting->body[c].bits & masks[r->first + k]) == 0)
                r->candidate[k] &= ~(UINT32_C(1) << c);
    }
}

/* Prepares the arguments of a rest_kernel for a chunk of particles. */
SPRING_NOINLINE void begin_rest(const scene_contacts *t, const scene_particles *p, const scene_motion *m,
                                kept_motion *kept, size_t from, size_t count, candidate_chunk *r)
{
    r->setting = &t->setting;
    r->bounds = t->bounds;
    r->particles = p;
    r->step = m;
    r->kept = kept;
    r->radius = t->radius;
    r->friction = t->friction;
    r->radius_stride = t->radius_stride;
    r->first = from;
    r->count = count;
    r->clearance = t->clearance + from / contact_chunk * clearance_stride(t->setting.count);
    r->begins = t->begins;
}

/* Lists free particles that touch colliders, and these as candidates. Returns their number. */
static inline uint32_t list_touching(const spring_scene *s, candidate_chunk *r, const uint32_t *touched)
{
    const scene_particles *const p = r->particles;
    const scalar *const inverse_mass = p->inverse_mass + r->first * p->mass_stride;
    memset(r->done, 0, sizeof r->done);
    memset(r->candidate, 0, sizeof r->candidate);
    r->listed = r->nearby = 0;
    for (size_t k = 0; k < r->count; k++) {
        const uint32_t bits = inverse_mass[k * p->mass_stride] == 0 ? 0 : touched[k];
        r->candidate[k] = bits;
        r->nearby |= bits;
        r->list[r->listed] = (uint8_t)k;
        r->listed += bits != 0;
    }
    apply_masks(s, r);
    return r->listed;
}

/* The kick that ends a step, of a chunk of particles, some of which touch colliders at x. */
SPRING_NOINLINE bool stop_chunk(const spring_scene *s, const scene_contacts *t, const common_kernels *kernels,
                                particle_kernel *kernel, const scene_particles *p, const scene_motion *m, size_t from,
                                size_t count, const uint32_t *touched, const scalar *x, bool at_end)
{
    candidate_chunk r;
    scalar change[3][contact_chunk];
    const bool fine = kernel(p, m, from, from + count); /* false is no failure yet: stops may slow particles down */
    begin_rest(t, p, m, NULL, from, count, &r);
    r.change = change[0];
    r.place = x + from;
    r.at_end = at_end;
    list_touching(s, &r, touched);
    if (m->kick > 0) /* particles that touch one collider, with SIMD vectors */
        kernels->stop_resting(&r);
    bool all_fine = true;
    for (size_t l = 0; l < (fine ? r.listed : count); l++) {
        const size_t k = fine ? r.list[l] : l, i = from + k;
        if (r.done[k] != 0)
            continue;
        const bool pinned = p->inverse_mass[i * p->mass_stride] == 0;
        if (touched[k] != 0 && !pinned) {
            contact_particle q;
            scene_contact_particle(s, i, &q);
            q.x0 = load_vector(x + i, p->stride, p->axes);
            vector3 v = load_vector(m->v + i, p->stride, p->axes);
            spring_contact_stop(&t->setting, &q, touched[k], at_end, q.x0, &v);
            store_vector(m->v + i, p->stride, p->axes, v);
            all_fine = all_fine && !q.wrong;
        }
        const vector3 v = load_vector(m->v + i, p->stride, p->axes);
        all_fine = all_fine && finite_vector(v) && (pinned || !too_fast_vector(m, v));
    }
    return all_fine;
}

/* Advances a chunk of particles, of which none touched a collider in the previous step unless its last kick is
   complete. */
SPRING_NOINLINE bool move_chunk(const spring_scene *s, const scene_contacts *t, const common_kernels *kernels,
                                particle_kernel *kernel, const scene_particles *p, const scene_motion *m, size_t from,
                                size_t count)
{
    kept_motion kept;
    candidate_chunk r;
    kernels->keep_motion(p, m, from, count, &kept);
    const bool fine = kernel(p, m, from, from + count);
    memset(t->touched + from, 0, count * sizeof *t->touched);
    begin_rest(t, p, m, &kept, from, count, &r);
    r.change = kept.force_copy[0];
    if (!kernels->find_near(&r) && fine)
        return true;
    memset(r.done, 0, sizeof r.done);
    apply_masks(s, &r);
    if (t->setting.h > 0 && fine) /* particles that rest or slide on one collider */
        kernels->move_resting(&r);
    bool all_fine = true;
    double way = fine ? (double)r.way : (double)INFINITY;
    for (size_t l = 0; l < (fine ? r.listed : count); l++) {
        const size_t k = fine ? r.list[l] : l, i = from + k;
        const bool pinned = p->inverse_mass[i * p->mass_stride] == 0;
        if (r.done[k] != 0) {
            t->touched[i] = (r.done[k] & RESTS_TOUCHING) != 0 ? r.candidate[k] : 0;
            continue;
        }
        if (pinned || (fine && r.candidate[k] == 0)) {
            all_fine = all_fine && (fine || !wrong_state(p, m, i));
            continue;
        }
        const uint32_t nearby = fine ? r.candidate[k] : UINT32_MAX;
        all_fine = advance_alone(s, t, p, m, &kept, i, k, nearby, &way) && all_fine;
    }
    for (unsigned c = 0; c < t->setting.count && way > (double)r.way; c++) /* contacts made paths longer */
        r.clearance[c] -= (scalar)(rounded_up * way);
    return all_fine;
}

static inline bool any_set(const uint32_t *bits, size_t count)
{
    uint32_t all = 0;
    for (size_t k = 0; k < count; k++)
        all |= bits[k];
    return all != 0;
}

/* Advances a chunk of particles. The kick that ends the previous step is a motion of its own if it stops at colliders,
   so that it has the same results as at the end of a call. */
static bool move_chunk_in_contact(const spring_scene *s, const scene_contacts *t, const common_kernels *kernels,
                                  particle_kernel *kernel, const scene_particles *p, const scene_motion *m, size_t from,
                                  size_t count)
{
    const bool kicks = m->contacts == IMPLICIT_KICK_CONTACTS;
    const uint32_t *const touched = (kicks ? t->touched : t->touched_before) + from;
    const bool any_touched = (kicks || m->ends_previous) && any_set(touched, count);
    if (kicks)
        return !any_touched ? kernel(p, m, from, from + count)
                            : stop_chunk(s, t, kernels, kernel, p, m, from, count, touched, t->x, true);
    if (!any_touched)
        return move_chunk(s, t, kernels, kernel, p, m, from, count);
    scene_motion step = *m;
    const bool fine = stop_chunk(s, t, kernels, kernels->implicit_kick, p, m, from, count, touched, m->x0, false);
    step.v0 = m->v;
    step.ends_previous = false;
    return move_chunk(s, t, kernels, kernel, p, &step, from, count) && fine;
}

#endif
