/* SPDX-License-Identifier: MIT */
/** @file
 * springstep: simulation of mass-spring systems (rope, cloth, soft bodies, height-field water) in caller-owned memory.
 *
 *     mass x'' = link forces + mass gravity - drag x' + F(t, x, x')
 *
 * F is the sum of the held forces (SPRING_FORCE) and the forces of the callback. Contacts with colliders act in
 * addition.
 *
 *     static spring_scene_def def;                                      // all zero: every feature is off
 *     def.particles = 3, def.links = 2, def.position = p, def.pinned = pinned, def.link = links;
 *     def.gravity[1] = -9.81;
 *     size_t bytes;
 *     spring_scene *scene;
 *     spring_scene_bytes(&def, &bytes);
 *     void *memory = malloc(bytes);
 *     spring_scene_init(memory, bytes, &def, &scene);
 *     const double dt = fmin(1.0 / 240, 0.5 * spring_scene_stable_step(scene, SPRING_LEAPFROG));
 *     spring_scene_advance(scene, SPRING_LEAPFROG, dt, 4);
 *     free(memory);
 *
 * These rules hold for every function in this file, in addition to the rules in spring.h:
 *  - A feature that the definition does not enable costs no time. It costs no memory either, with one exception:
 *    without SPRING_SCENE_FORCE_IGNORES_VELOCITY, leapfrog may need more memory, even if there is no callback.
 *    docs/details.md lists the bytes of each feature, and docs/performance.md the time.
 *  - All or nothing. After any status except SPRING_OK the scene is unchanged, except with SPRING_SCENE_NO_UNDO. (A
 *    failed step may drop kept forces, which the next step computes again.)
 *  - Snapshots. A scene begins at the first byte of its memory and holds no pointer to itself. To take or restore a
 *    snapshot, copy its bytes with memcpy(). The copy is a working scene at any address that is aligned to 8 bytes, in
 *    the same build of the library, with bit-identical results. Its arrays are aligned to SPRING_SCENE_ALIGN only if
 *    the two addresses are equal modulo SPRING_SCENE_ALIGN. Otherwise its steps take longer, with AVX-512 up to 1.4
 *    times as long (spring-bench --kernel leapfrog_jelly_16_copied). The pointers to the callback and its user data are
 *    copied unchanged.
 *  - Threads may use different scenes concurrently. They may also read the same scene concurrently, with functions that
 *    accept a const scene, while no thread changes it.
 *  - No function needs more than 16 KiB of the stack, compiled by gcc 12, gcc 14 or clang 14 with optimisation
 *    (tests/scene/test_stack.c). At most 16 KiB are in use when a callback is called.
 *  - Results are bit-identical with every compiler, instruction set and SIMD vector width, if the results of the
 *    callback are.
 *  - Particles collide with colliders: planes, spheres, capsules, boxes, and bodies that a function describes. They do
 *    not collide with each other. Links do not collide.
 *
 * spring_scenef_... is the single-precision version, compiled from the same source. It needs about 0.6 of the memory;
 * docs/performance.md compares the time. State and arithmetic are float, but contacts that are not computed with SIMD
 * use double arithmetic. Definitions, colliders, times, energies and tolerances are double, as are the arrays of
 * spring_scenef_get() and spring_scenef_set(). The callback and spring_scenef_getf() use float arrays.
 */
#ifndef SPRINGSTEP_SCENE_H
#define SPRINGSTEP_SCENE_H

#include <stddef.h>

#include <springstep/spring.h>

#ifdef __cplusplus
extern "C" {
#endif

/** @defgroup scene_def The definition
 * @{ */

#define SPRING_SCENE_ALIGN 64 /**< recommended alignment of the memory of a scene [bytes]; 8 is the least */

/** A spring between two particles.
 *
 * With two or three axes, a link pulls its ends towards each other with the tension
 *
 *     stiffness (length - rest) + damping rate
 *
 * where rate is the time derivative of the length. A negative tension pushes. If rest > 0 and both ends are at the same
 * place, the link has no direction and its force is 0. If the square of the length underflows (lengths below about
 * 1e-160 m, in single precision 1e-21 m), the force is undefined.
 *
 * If rest is 0, the link is linear, and damped in all directions: the force on a is
 * stiffness (x_b - x_a) + damping (v_b - v_a).
 *
 * With one axis, the link is also linear. The force on a is stiffness ((x_b - x_a) - rest) + damping (v_b - v_a), and
 * the force on b is its opposite. */
typedef struct spring_link {
    uint32_t a;       /**<         index of a particle */
    uint32_t b;       /**<         index of another particle */
    double rest;      /**< [m]     rest length >= 0 */
    double stiffness; /**< [N/m]   >= 0 */
    double damping;   /**< [N s/m] >= 0, along the link; in all directions if rest is 0 */
    uint32_t flags;   /**<         SPRING_LINK_... | ... */
} spring_link;

/** @name Flags of a link
 *
 * They require two or three axes, and are not allowed with RKN8 and SRKN6. spring_scene_set_link() does not change them.
 * @{ */
/** The link pulls and never pushes, like every link of a scene with SPRING_SCENE_TENSION_ONLY. The flag has no effect
   if rest is 0. */
#define SPRING_LINK_TENSION_ONLY UINT32_C(1)
/** A tension-only link that acts only while exactly one of its ends is pinned. It keeps a particle from moving away
   from a pinned particle that it hangs on; see spring_links_tethers(). While it does not act, its tension and its
   energy are 0, and it does not count in the stable step. spring_scene_set_pinned() may therefore lower the stable
   step. */
#define SPRING_LINK_TETHER UINT32_C(2)
/** @} */

/** A spring between two weighted points. Zero-initialise.
 *
 * Its vector is d = sum of weight[i] x[particle[i]], and its length is |d|. The weights (-1, 1) are those of a
 * spring_link from particle[0] to particle[1]. With (-1, a, b, c), a + b + c = 1, a particle is attached to a point in a
 * triangle. With (1/2, -1, 1/2), three particles resist bending; see spring_bend_rod(). The force on particle[i] is
 *
 *     rest > 0   -weight[i] tension d/length,   tension = stiffness (length - rest) + damping rate
 *     rest = 0   -weight[i] (stiffness d + damping d'),   d' = sum of weight[i] v[particle[i]]
 *
 * where rate is the time derivative of the length. If rest > 0 and the length is 0, the force is 0. On one axis, the
 * force on particle[i] is -weight[i] (stiffness (d - rest) + damping d').
 *
 * For rest = 0 the spring is linear. It is damped in all directions, and so exerts the external torque -damping
 * cross(d, d'). This brakes the rotation of free bodies: the angular velocity of a free hoop of n particles, whose
 * weights are (1/2, -1, 1/2), decays at the rate (1 - cos(2 pi/n))^2 damping/mass (tests/scene/test_links.c). Use
 * damping to attach a particle, and drag to damp bending of free bodies.
 *
 * SPRING_SCENE_TENSION_ONLY does not concern weighted links. */
typedef struct spring_weighted_link {
    uint32_t particle[4]; /**<         indices of different particles; ignored where the weight is 0 */
    double weight[4];     /**<         0: unused. Their sum is 0, to 1e-12 of the largest */
    double rest;          /**< [m]     rest length >= 0 */
    double stiffness;     /**< [N/m]   >= 0 */
    double damping;       /**< [N s/m] >= 0 */
} spring_weighted_link;

/** A callback that adds forces to force[axis][particle] [N].
 *
 * It is called once per force evaluation. t [s] is the time of position[axis][particle] [m] and
 * velocity[axis][particle] [m/s], which are all finite. Arrays of axes that the scene does not have are NULL. With
 * SPRING_SCENE_FORCE_IGNORES_VELOCITY the contents of the velocity arrays are unspecified: do not read them.
 *
 * The callback must depend only on its arguments and *user. Otherwise 10 steps in one call differ from 10 calls of one
 * step. It must not call a function on its own scene. After a change of *user, call spring_scene_set_force() again,
 * because the scene may keep forces from one step to the next (see SPRING_SCENE_FORCE_IGNORES_VELOCITY).
 *
 * If the force on a free particle is not finite, spring_scene_advance() fails with SPRING_ENONFINITE, or
 * SPRING_EUNSTABLE in a scene with max_speed. RKN8 uses the last force of a call only in the next call, so the next
 * call fails. Forces on pinned particles are ignored. */
typedef void spring_scene_force_fn(void *user, double t, size_t particles, const double *const position[3],
                                   const double *const velocity[3], double *const force[3]);
/** The callback of a single-precision scene. */
typedef void spring_scenef_force_fn(void *user, double t, size_t particles, const float *const position[3],
                                    const float *const velocity[3], float *const force[3]);

/** Enables spring_scene_set_link(), spring_scene_set_links(), spring_scene_set_weighted_links(), spring_scene_tear(),
   spring_scene_set_pinned() and spring_scene_set_mass(). The scene then stores the coefficients of every link and the
   mass of every particle, even if they are all equal. */
#define SPRING_SCENE_EDITABLE UINT32_C(1)

/** Saves the memory of a second copy of the state. If spring_scene_advance() then fails in a step, the state is lost:
   all positions and velocities become NaN, and no step succeeds until spring_scene_set() has set all of them. */
#define SPRING_SCENE_NO_UNDO UINT32_C(2)

/** Promises that the callback does not use velocities. Leapfrog then keeps the forces at the end of a step for the next
   step, which halves the force evaluations. Without a callback, leapfrog keeps them in any case. Leapfrog also needs no
   memory for predicted velocities, unless a link is damped or the scene is editable, so the flag also saves memory in
   scenes without a callback. The velocities that the callback receives are unspecified. */
#define SPRING_SCENE_FORCE_IGNORES_VELOCITY UINT32_C(4)

/** Links pull and never push, as in a rope, a net or a sail. A link that is not longer than its rest length is slack:
   it has no tension and no energy. A longer link has the tension max(0, stiffness (length - rest) + damping rate), so
   damping does not push either. (Exception: where leapfrog damps links by an exponential kick, see
   spring_scene_advance(), the damping of a taut link that becomes shorter may push.) Requires two or three axes.
   Where a link becomes taut or slack, leapfrog and RK4 have order 2 without damping of this link, and order 1 with
   damping. */
#define SPRING_SCENE_TENSION_ONLY UINT32_C(8)

/** Enables held forces, see SPRING_FORCE. */
#define SPRING_SCENE_FORCES UINT32_C(16)

/** The shapes of colliders. */
typedef enum spring_shape {
    SPRING_PLANE,   /**< a half-space */
    SPRING_SPHERE,  /**< a solid sphere */
    SPRING_CAPSULE, /**< all points within a distance `radius` of a line segment */
    SPRING_BOX,     /**< a box in any orientation; with a radius its edges are rounded */
    SPRING_CUSTOM   /**< a body of any form, which a function describes */
} spring_shape;

/** Computes the signed distance of a point from the surface of a SPRING_CUSTOM body, and the outward unit normal there.
 *
 * Writes one to three contacts, and returns their number. Return two or three where several parts of the surface are
 * near, as in a valley. The gap is negative everywhere inside the body. Its absolute value may be less than the
 * distance, if its sign is right and it never changes by more than the point moves (Lipschitz constant 1), like a
 * height field divided by sqrt(1 + slope^2). Far away, one contact with any lower bound is enough. The function must
 * depend only on its arguments and on data that does not change during a call.
 *
 * @param[in]  user    the pointer of the collider
 * @param[in]  point   [m] in the frame of the body. With two axes, [2] is 0
 * @param[out] gap     [m] the distances
 * @param[out] normal  in the frame of the body. With two axes, [2] is ignored
 */
typedef uint32_t spring_gap_fn(void *user, const double point[3], double gap[3], double normal[3][3]);

/** A rigid body that free particles cannot enter. All shapes are convex, except SPRING_CUSTOM. Zero-initialise. Fields
 * that the shape does not use are ignored. With two axes, the third elements are ignored too, except those of spin and
 * spin_acceleration, of which only the third is used. */
typedef struct spring_collider {
    spring_shape shape;     /**< shape of the body */
    double at[3];           /**< [m] plane: a point on it; sphere, box: the centre; capsule: one end of the segment */
    double to[3];           /**< [m] capsule: the other end of the segment */
    double axis[3][3];      /**< plane: axis[0] is the unit normal, which points out of the body; box: its unit axes.
                                Errors of up to 1e-3 in their dot products, as of rotations in single precision, are
                                removed */
    double half[3];         /**< [m] >= 0; box: half of its size along each of its axes, without the radius. A box
                                without thickness does not stop particles unless it or they have a radius */
    double radius;          /**< [m] >= 0; sphere, capsule: the radius; box: the radius of its rounded edges */
    double velocity[3];     /**< [m/s] velocity of `at` */
    double velocity_to[3];  /**< [m/s] capsule: velocity of `to` */
    double spin[3];         /**< [rad/s] angular velocity. It turns planes, boxes and custom bodies about `at`. It does
                                not move a sphere or a capsule, but adds spin x (distance from the centre or from the
                                segment) to the velocity of their surface */
    double friction;        /**< Coulomb coefficient >= 0 */
    double restitution;     /**< 0 to 1: ratio of the normal speeds after and before an impact */
    double acceleration[3]; /**< [m/s^2] of `at`, at + velocity t + acceleration t^2/2, and also of `to` of a
                                capsule */
    double spin_acceleration[3]; /**< [rad/s^2] turned by the vector spin t + spin_acceleration t^2/2 */
    double surface[3];           /**< [m/s] further velocity of the surface in the frame of the body, as of a conveyor
                                    belt. Its normal part is ignored. The frame of a plane, a sphere or a capsule has
                                    the axes of the scene at the time of the call */
    uint32_t mask;               /**< particles collide if this and their mask have a common bit; 0 means all bits */
    spring_gap_fn *gap;          /**< SPRING_CUSTOM: its surface. `axis` is its frame; all 0: the axes of the scene.
                                    `radius` is added to the body */
    void *user;                  /**< SPRING_CUSTOM: passed to gap */
    double thickness;            /**< [m] SPRING_CUSTOM: least thickness of the body, > 0 */
    double bound; /**< [m] SPRING_CUSTOM: radius of a sphere about `at` that contains the body without its
                                    radius; 0: none, as for terrain and hollow bodies */
} spring_collider;

/** The definition of a scene. Set the fields of unused features to zero. Every array is copied. */
typedef struct spring_scene_def {
    uint32_t axes;                /**< 1, 2 or 3; 0 means 3 */
    uint32_t flags;               /**< SPRING_SCENE_... | ... */
    uint32_t methods;             /**< methods to enable, 1u << SPRING_EULER | ...; 0: all except RK4, RKN8, SRKN6 */
    size_t particles;             /**< number, 1 to nearly 2^32; on 32-bit systems at most 2^23 - 1 */
    size_t links;                 /**< number, less than 2^29; on 32-bit systems at most 2^23 - 1 */
    const double *position;       /**< [particles*axes] x0 y0 z0 x1 ... [m] */
    const double *velocity;       /**< [particles*axes] [m/s]; NULL: at rest */
    const double *mass;           /**< [particles] [kg] > 0 unless pinned; NULL: mass_all for every particle */
    double mass_all;              /**< [kg]; 0 means 1 */
    const uint8_t *pinned;        /**< [particles]; non-zero: keeps its velocity whatever forces act; NULL: none */
    const spring_link *link;      /**< [links]; sorted links are fastest, see docs/details.md */
    double gravity[3];            /**< [m/s^2]; elements beyond the axes are ignored */
    double drag;                  /**< [N s/m] >= 0, for every particle */
    spring_scene_force_fn *force; /**< callback; NULL: none */
    void *user;                   /**< passed to the callback */
    double max_speed;             /**< [m/s] if a free particle is faster than this along an axis after a step, the call
                                     fails with SPRING_EUNSTABLE; 0: no limit */
    uint32_t colliders;           /**< maximum number of colliders, at most 32; 0: none */
    double particle_radius;       /**< [m] >= 0, radius of every particle in contacts */
    size_t weighted_links;        /**< number, less than 2^29; on 32-bit systems at most 2^23 - 1 */
    const spring_weighted_link *weighted_link; /**< [weighted_links] */
    const double *radius;                      /**< [particles] [m] >= 0, instead of particle_radius; NULL: equal */
    const double *friction;                    /**< [particles] >= 0: factor of the friction of colliders; NULL: 1 */
    const uint32_t *mask; /**< [particles] see spring_collider; NULL: all bits; 0: it never collides */
} spring_scene_def;

/** A scene, in caller-owned memory. */
typedef struct spring_scene spring_scene;

/**
 * Checks a definition.
 *
 * @param[out] field  name of the first invalid field, such as "mass" or "link.a"; NULL if the definition is valid. May
 *                    be NULL
 * @param[out] index  index of the invalid particle or link, or of the axis of gravity; otherwise 0. May be NULL
 * @return SPRING_OK.
 *         SPRING_EINVAL: NULL, an invalid value, or a mass or its reciprocal, 2 stiffness/mass, 2 damping/mass or
 *         drag/mass that is not finite in the precision of the scene.
 *         SPRING_ERANGE: an index of a particle or a count is too large.
 *         SPRING_EUNSUPPORTED: the methods include one that is not for scenes (the exact solution); they include RKN8 or
 *         SRKN6, and the scene has a damped link, tension-only links, colliders or a callback that may use
 *         velocities; or the scene has one axis and tension-only links or colliders
 */
SPRING_API spring_status spring_scene_check(const spring_scene_def *def, const char **field, size_t *index);

/**
 * Computes the size of the memory that a scene needs.
 *
 * @param[out] bytes  size [bytes], a multiple of SPRING_SCENE_ALIGN; not written after an error
 * @return as spring_scene_check(); SPRING_EINVAL also if bytes is NULL; SPRING_ERANGE also if the size does not fit in
 *         size_t
 */
SPRING_API spring_status spring_scene_bytes(const spring_scene_def *def, size_t *bytes);

/**
 * Creates a scene in the given memory. Its time is 0.
 *
 * The memory belongs to the caller and must stay valid as long as the scene is used. There is no function to destroy a
 * scene: release its memory.
 *
 * @param[out] memory  aligned to 8 bytes, as memory from malloc() is. The arrays of the scene are aligned to
 *                     SPRING_SCENE_ALIGN inside the memory
 * @param[in]  bytes   size of the memory, at least the result of spring_scene_bytes()
 * @param[out] scene   the scene; NULL after an error
 * @return SPRING_OK; SPRING_ENOMEM; SPRING_EALIGN; otherwise as spring_scene_check()
 */
SPRING_API spring_status spring_scene_init(void *memory, size_t bytes, const spring_scene_def *def,
                                           spring_scene **scene);

/** @} */

/** @defgroup scene_steps Steps, energy, rest
 * @{ */

/**
 * Advances a scene by n steps.
 *
 *     Euler             x1 = x + dt v;   v1 = v + dt a(t, x, v)
 *     symplectic Euler  v1 = v + dt a(t, x, v);   x1 = x + dt v1
 *     leapfrog          v' = v + dt/2 a(t, x, v);   x1 = x + dt v';   v1 = v' + dt/2 a(t + dt, x1, v1)
 *     RK4               the four stages of the classical Runge-Kutta method
 *     RKN8              X_i = x + c_i dt v + dt^2 sum a_ij A_j,   A_i = a(t + c_i dt, X_i),   i = 1 ... 8
 *                       x1 = x + dt v + dt^2 sum b_j A_j,   v1 = v + dt sum b'_j A_j
 *     SRKN6             v += dt b_i a(x),   x += dt a_i v,   i = 1 ... 11;   v1 = v + dt b_12 a(x1)
 *
 * Here a(...) is the acceleration of a particle, and a_ij, a_i, b_i and c_i are the coefficients of the method. Each
 * line is evaluated from left to right.
 *
 * Drag is implicit in the kick of symplectic Euler and in the last half kick of leapfrog. In the same half kick of
 * leapfrog, link damping and callbacks use predicted velocities: v* = v' + dt/2 a*, v1 = v' + dt/2 a1. Here a* has the
 * forces of the first half kick and drag at v*, and a1 has the forces at x1 and v*, and drag at v1. Leapfrog is still
 * second order. Held forces act like gravity, in every kick and stage.
 *
 * Leapfrog with heavy link damping. Explicit link damping is used for dt G <= 0.4 and dt D <= 0.9 (1 - dt^2 L/4), with
 * L as in spring_scene_stable_step(). G is the largest sum of 2 damping/mass over the links of a free particle, and D
 * is the largest such sum plus drag/mass. For a larger dt, a step is a drift for dt/2, one kick, and a drift for dt/2.
 * The kick is v1 = v0 + dt p(dt Z) r, where r is the acceleration at the positions after the first drift and at v0, Z
 * is the damping matrix of the links in their directions there, divided by the masses, and p(z) approximates (1 -
 * e^-z)/z by a Chebyshev series. A correction for the rotation of links during the step is included. Leapfrog is
 * therefore stable for dt < 2/sqrt(L) at any link damping, and a link that creeps does so at the rate
 * stiffness/damping. The kick adds no energy, with two exceptions: where damped links turn during the step, and with
 * friction, for dt G > 1000, or with very different masses for dt G > 100. In an impact of links that turn by 0.1 rad
 * in the step, the gain may be a large part of the kinetic energy; it decreases fast with the step. The step has order
 * 2 for dt G up to about 3. Beyond, the order falls to 1 (tests/scene/test_damping.c). A step evaluates forces once,
 * and damping alone once for dt G <= 0.6, and about 1.6 sqrt(dt G) times beyond. If links are overdamped, the error
 * just below dt G = 0.6 is two to three times as large as just above, where a second evaluation is added. Positions,
 * velocities and time are then the whole state: no force is kept. Callbacks are called at t + dt/2. A callback that may
 * use velocities is called twice, with v0 and with (v0 + v1)/2, where v1 follows from the first call. The series is
 * then computed twice. A negative dt always uses explicit damping.
 *
 * The damping of links saturates, so that dt G <= 30000 and a kick makes at most 279 evaluations of damping: the
 * damping of a link is multiplied by the smaller factor of its two ends. The factor of a particle is 30000/(dt G),
 * with its own sum G, but at most 1. A link with reduced damping relaxes within about 30000 mass/(stiffness dt^2)
 * steps. If a collider would pull particles during a kick, the kick is repeated, with these particles released from the
 * collider.
 *
 * RKN8 has order 8. It requires links without damping and a callback that does not use velocities. With drag, the
 * method is applied to y = e^(drag t/(2 mass)) (x - x0), so the order is still 8: with drag alone, the error is 3e-11
 * of the stopping distance for dt drag/mass = 1, and 2e-6 of it for dt drag/mass = 4. Forces must be smooth: a force
 * that starts suddenly reduces the order. RKN8 is not symplectic: for dt sqrt(L) = 0.4 (L as in
 * spring_scene_stable_step()) an oscillator loses 6e-11 of its energy per period.
 *
 * SRKN6 has order 6. It is symplectic and time-reversible, and has the same requirements as RKN8. Use it for long runs
 * in which the energy must not drift: without drag the energy error of smooth motion stays bounded. docs/methods.md
 * compares the methods. Drag is solved exactly together with the drift, so the order is still 6.
 *
 * Force evaluations per step: one for both Euler methods and leapfrog, four for RK4, eight for RKN8, eleven for SRKN6.
 * Leapfrog, RKN8 and SRKN6 keep the forces at the end of a step for the start of the next step. With explicitly damped
 * links, leapfrog keeps the forces at v*. These forces are then part of the state, and a snapshot contains them. They
 * are evaluated again, at v, after spring_scene_set() of positions or velocities, after spring_scene_transform(), after
 * a change of links, pins, masses, the callback or the velocity of a pinned particle, and after steps of another
 * method. With a callback that may use velocities, leapfrog keeps no forces and evaluates them twice per step, because
 * the data of the callback may change between steps; see SPRING_SCENE_FORCE_IGNORES_VELOCITY.
 *
 * Forces perpendicular to the velocity (magnetic, Coriolis, lift). With a callback that adds a force of the size mass
 * Omega |v| in such a direction, leapfrog gains energy, however small dt is. Without links, its energy grows by the
 * fraction (Omega dt)^4/4 per step. Fast vibrations of links gain more: for an angular frequency omega, a fraction of
 * about Omega dt (omega dt)^3/(8 sqrt(1 - (omega dt)^2/4)) per step, unless drag/mass exceeds this fraction divided by
 * dt. Use RK4, which loses energy: the fraction (Omega dt)^6/72 per step without links. Both Euler methods gain (Omega
 * dt)^2 (tests/scene/test_forces.c).
 *
 * Contacts have order 2 with leapfrog, even with colliders that turn and accelerate, and with friction across stops and
 * reversals of direction. Impacts have order 1 with drag, link damping or a callback that uses velocities, because
 * these forces jump. With RK4, friction has order 1 too with link damping or such a callback. With symplectic Euler,
 * contacts have order 1. See spring_scene_set_colliders(). Colliders do not change the stable step.
 *
 * Time is not accumulated: step i of consecutive calls with the same dt is at t0 + i dt.
 *
 * @param[in] m   method, enabled in the definition
 * @param[in] dt  time step [s], finite in the precision of the scene. A step that is 0, or rounds to 0 in the precision
 *                of the scene, changes nothing. A negative step integrates backwards. Leapfrog with drag then has a
 *                pole at dt = -2 mass/drag, and symplectic Euler at dt = -mass/drag
 * @param[in] n   number of steps; 0 changes nothing
 * @return SPRING_OK.
 *         SPRING_EINVAL: NULL, an unknown method, or dt is not finite.
 *         SPRING_EDISABLED: the definition does not enable the method.
 *         SPRING_EUNSUPPORTED: the exact solution; RKN8 or SRKN6 in a scene with link damping or a callback that may
 *         use velocities; Euler in a scene that has colliders now.
 *         SPRING_ENONFINITE: the time or, in a scene without max_speed, the state would become infinite or NaN;
 *         detected in the step in which it happens.
 *         SPRING_EUNSTABLE, only in a scene with max_speed: the state would become infinite or NaN, or a free particle
 *         would be faster than max_speed along an axis
 * @par Source    Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), section I.1; Hairer, Norsett, Wanner,
 *                Solving Ordinary Differential Equations I (1993), section II.1; Dormand, El-Mikkawy, Prince,
 *                High-order embedded Runge-Kutta-Nystrom formulae, IMA J. Numer. Anal. 7 (1987); Blanes, Moan,
 *                Practical symplectic partitioned Runge-Kutta and Runge-Kutta-Nystrom methods, J. Comput. Appl. Math.
 *                142 (2002), method SRKN11b
 */
SPRING_API spring_status spring_scene_advance(spring_scene *s, spring_method m, double dt, uint64_t n);

/**
 * Returns a lower bound of the stability limit: for 0 < dt < bound, small motion about rest does not grow (with SRKN6,
 * except in two narrow ranges of dt, see below).
 *
 * The bound holds however far links are stretched or compressed, because tension/length <= stiffness. (A compressed
 * scene may buckle with any step.) It follows from three sums over the links of a particle. Each is the largest sum of
 * any free particle. A link counts once instead of twice if its other end is pinned. For a weighted link, the factor 2
 * is replaced by |weight| of the particle times the sum of |weight| over the free particles of the link.
 *
 *     L [1/s^2]  sum of 2 stiffness/mass
 *     D [1/s]    sum of 2 damping/mass, plus drag/mass
 *     K [N/m]    sum of 2 stiffness
 *
 * The bounds are:
 *
 *     leapfrog          2/sqrt(L)
 *     RK4               2.61/max(sqrt(L), D)
 *     RKN8              min(3.14/sqrt(L), 40/D)
 *     SRKN6             9.07/sqrt(L);  with drag min(8/sqrt(L), 3/D)
 *     Euler             min(drag/K, 2/D);  2/D if K is 0
 *     symplectic Euler  4/(p + sqrt(p^2 + 4 L)),   p = G - drag/(largest mass);  G is D without drag
 *
 * The bound is for small motion. Links that rotate, oscillate with a large amplitude, or become taut and slack can gain
 * energy by resonance with the step, even at half of the bound. Use these fractions of the bound for leapfrog:
 *  - up to 0.9 if all links have a damping ratio, damping/sqrt(2 stiffness mass), of at least 0.02, and none becomes
 *    longer than twice its rest length, otherwise up to 0.5;
 *  - with drag/mass of at least 0.1/s, up to 0.9 for soft bodies and sheets with shear springs while no link is longer
 *    than twice its rest length, and up to 0.5 for ropes and other nets (0.25 if links become longer than twice their
 *    rest length);
 *  - half of these if there are tension-only links other than tethers;
 *  - without damping, 0.5 for smooth motion, 0.25 for violent motion (0.06 if links become longer than twice their rest
 *    length, or stretch by more than a quarter in a run of more than a minute), and 0.1 for tension-only links in runs
 *    of up to a minute.
 * `spring-work --problem steps` measures what longer steps cost. Use at most 0.7 of the bound where steady rotation
 * stretches links by more than a tenth (tests/scene/test_motion.c). The forces of a callback are not considered;
 * docs/games.md has a bound with them.
 *
 * At rest without link damping, the stability limit may be larger than the bound. With leapfrog, symplectic Euler and
 * SRKN6, it is 1.2 to 1.35 times the bound for a height field with structural, shear and bend springs and at least four
 * particles along each edge, 1.35 to 1.75 times for such a cloth (narrower ones 1 to 1.25 times), and about 2 times for
 * such a soft body of at least three particles along each edge (fewer: 1.3 to 1.9); with RK4 it is larger. It is closer
 * to the bound with fewer springs or under tension: the ratio is 1 for a rope and for a height field of structural
 * springs only, and 1.4 for a cloth that is stretched by half. With heavy damping, the limit may be several times the
 * bound, but not for leapfrog with drag alone.
 *
 * With SRKN6, an undamped mode of angular frequency omega grows by up to 0.07 % per step in two narrow ranges of dt
 * omega below the bound: 3.1414 ... 3.1424 and 6.3478 ... 6.3493. Drag with dt drag/mass > 0.0014 suppresses this
 * growth. Without drag, choose dt < 3.14/sqrt(L) for long runs of scenes with many modes.
 *
 * The sums are stored in the scene and computed again after a change of links, pins or masses, in time proportional to
 * particles + links.
 *
 * @return time step [s]. 0: no stable step is known. INFINITY: the scene has no links and no drag that could make the
 *         method unstable. NaN for NULL, an unknown method and the exact solution
 * @par Source    Gershgorin's circles; tests/scene/test_limits.c measures the distance to the limit
 */
SPRING_API double spring_scene_stable_step(spring_scene *s, spring_method m);

/**
 * Lowers the stiffness of links until leapfrog is stable with a given time step.
 *
 * Use it for a scene that is too stiff for the time step that you can afford. Softened links stretch more under load.
 * Their damping does not change.
 *
 * For each particle, let K be the sum of 2 stiffness over its links, where a link counts once if its other end is
 * pinned, and a tether that does not act does not count. Let W be the sum of its weighted links, as in
 * spring_scene_stable_step(): they keep their stiffness. The factor of the particle is
 * min(1, ((2 fraction/dt)^2 mass - W)/K). The stiffness of a link is multiplied by the smaller factor of its two ends.
 * Afterwards dt <= fraction spring_scene_stable_step(..., SPRING_LEAPFROG). If a link was softened, this stable step is
 * nearly dt/fraction. Drag and callbacks are not considered.
 *
 * The time is proportional to (links + weighted links) (1 + particles/512).
 *
 * @param[in]  def       definition of the scene
 * @param[in]  dt        time step > 0 [s]
 * @param[in]  fraction  fraction of the stable step that dt may be, 0 < fraction <= 1: 0.9 for cloth with shear springs
 *                       and soft bodies, both with drag, otherwise as at spring_scene_stable_step()
 * @param[out] link      [links] the softened links; may be def->link
 * @return SPRING_OK; SPRING_EINVAL; SPRING_ERANGE: weighted links leave nothing to the links of a particle; otherwise
 *         as spring_scene_check(). Nothing is written after an error
 */
SPRING_API spring_status spring_links_soften(const spring_scene_def *def, double dt, double fraction,
                                             spring_link *link);

/** Returns the time of a scene [s]: the simulated time since spring_scene_init(), unless spring_scene_set_time() or
    spring_scene_load() has changed it. NaN for NULL. */
SPRING_API double spring_scene_time(const spring_scene *s);

/** The energies of a scene, as spring_scene_energy() returns them. */
typedef struct spring_scene_energies {
    double kinetic; /**< [J] kinetic energy of all free particles */
    double elastic; /**< [J] elastic energy of all links; 0 for a slack tension-only link */
    double gravity; /**< [J] potential energy of all free particles in gravity; 0 at the origin */
} spring_scene_energies;

/** Returns the energies of the links and of the free particles. All are NaN for NULL. The work of held forces,
    callbacks and colliders is not included. */
SPRING_API spring_scene_energies spring_scene_energy(const spring_scene *s);

/** Returns whether the scene is at rest: the speed of every particle, including pinned particles, is at most v_tol
    [m/s], and the acceleration of every free particle is at most a_tol [m/s^2]. Acceleration that is balanced by the
    normal force or the static friction of a touched collider does not count. No collider is touched after
    spring_scene_set_colliders() until a step is taken, so call this after spring_scene_advance(). docs/games.md has
    tolerances for single precision. False for invalid input. May evaluate the forces. */
SPRING_API bool spring_scene_at_rest(spring_scene *s, double v_tol, double a_tol);

/** @} */

/** @defgroup scene_state State and changes
 * @{ */

/** The quantities that spring_scene_get() and spring_scene_set() copy. */
typedef enum spring_quantity {
    SPRING_POSITION, /**< [m] positions */
    SPRING_VELOCITY, /**< [m/s] velocities */
    SPRING_FORCE     /**< [N] held forces of a scene with SPRING_SCENE_FORCES. A held force is 0 at first, and constant
                        until it is set again. Use held forces for wind, for example: compute them from the state once
                        per frame. A held force that opposes the displacement with a stiffness K, and is set every T
                        seconds, adds a negative drag of about K T/2; use a callback instead. Held forces are part of
                        snapshots. A failed call does not change them, even with SPRING_SCENE_NO_UNDO. The held force of
                        a pinned particle acts once the particle is freed. Setting held forces causes no force
                        evaluation */
} spring_quantity;

/**
 * Copies a quantity of particles first ... first + count - 1 out of a scene (get, getf) or into it (set).
 *
 * Element stride*i + a of the array belongs to particle first + i and axis a. spring_scene_getf() fills a float vertex
 * buffer; with a larger stride, the buffer may hold other data between the positions. To move a pinned particle, use
 * spring_scene_drive(). With spring_scene_set() the particle jumps, and link damping does not see the motion.
 *
 * @param[in] q       quantity
 * @param[in] stride  elements from one particle to the next >= axes; 0 means axes
 * @return SPRING_OK; SPRING_EINVAL: NULL, an unknown quantity, a stride below axes, or a new value that is not finite
 *         in the precision of the scene; SPRING_ERANGE: the particles do not exist; SPRING_EDISABLED: SPRING_FORCE
 *         without SPRING_SCENE_FORCES
 * @{
 */
SPRING_API spring_status spring_scene_get(const spring_scene *s, spring_quantity q, double *out, size_t stride,
                                          size_t first, size_t count);
SPRING_API spring_status spring_scene_getf(const spring_scene *s, spring_quantity q, float *out, size_t stride,
                                           size_t first, size_t count);
SPRING_API spring_status spring_scene_set(spring_scene *s, spring_quantity q, const double *in, size_t stride,
                                          size_t first, size_t count);
/** @} */

/** Changes gravity [m/s^2]. Elements beyond the axes are ignored. Returns SPRING_EINVAL for NULL and for values that
   are not finite in the precision of the scene. */
SPRING_API spring_status spring_scene_set_gravity(spring_scene *s, const double gravity[3]);

/**
 * Replaces all colliders of a scene.
 *
 * The colliders are given at their pose at the current time of the scene. They then move with their velocity,
 * acceleration, spin and spin acceleration until they are set again. After an error, the colliders of the last call
 * keep moving. Axes that are not orthonormal to rounding are replaced by the nearest orthonormal axes. A particle that
 * is inside a collider is moved to its surface in the next step, and out of all of them if it is inside several, unless
 * these face or enclose it, as at the seam of two boxes. Out of a custom body whose gaps are less than distances, it is
 * moved in several steps. The move adds no velocity, but a velocity into the body is then treated as an impact. Pinned
 * particles pass through colliders. If a box has another collider near it, particles rest above all colliders by 32
 * rounding errors, so that they do not fall between boxes that touch (docs/details.md).
 *
 * To set colliders once per frame of length T, give the present pose, the present velocity V of the body, and the
 * acceleration that leads to the next position: 2 (next - present - V T)/T^2. Do the same with spin and
 * spin_acceleration. If V is not known, use (next - previous)/(2 T) and (next - 2 present + previous)/T^2, or take the
 * pose and the velocity V that the collider has reached, with the acceleration 16/9 (next - present - V T)/T^2: if V
 * has an error, the error of the pose then changes its sign in each frame, and after four more frames it is 6 % of the
 * first one. (With 2 instead of 16/9, it would not decrease.) A velocity without acceleration is enough for bodies that
 * nothing rests on: static friction breaks where the velocity jumps from frame to frame.
 *
 * An impact with the relative velocity u multiplies the normal component of u by -restitution and reduces the
 * tangential component by at most friction (1 + restitution) |u_normal|. The time of impact within a step is computed,
 * in the frame of the body. A bounce therefore has order 2 if no force depends on velocity, and no particle, however
 * fast, passes through a face of a single collider that turns by less than about 0.2 rad in the step (in single
 * precision, if the collider is thicker than 1e-3 of its size and of its distance from the origin). A fast particle may
 * pass through a collider that turns further, and a particle may pass around an edge within a step. A capsule whose
 * ends have different velocities also turns. A particle that static friction can hold is carried along with the motion
 * of the body, at any time step. On the spinning surface of a sphere or a capsule it is held to second order. If an
 * impact moves the particle less than 8 eps (|x| + |at| + size) into the collider in a step, this is treated as a
 * rounding error, and the particle does not bounce.
 *
 * A particle that touches several colliders is kept out of all of them, even in a groove of 0.5 degrees. In a groove of
 * 90 to 165 degrees without friction, it may keep oscillating at up to 2 g dt. A custom body that is concave
 * counts as several bodies only where it returns several contacts. Links do not collide, so a thin collider can pass
 * between two particles. A step with negative dt does not undo a step.
 *
 * The path of a particle near a custom body is searched in steps of the gap, at least 0.4 of `thickness`, so no
 * particle passes through it. The function is called a few times for a particle that rests, and at most 1500 times per
 * step if the particle touches no other collider. If more calls would be needed, the particle stops at the last point
 * that is known to be outside. A gap or a normal that is not finite makes the step fail with SPRING_ENONFINITE, or
 * SPRING_EUNSTABLE in a scene with max_speed.
 *
 * With restitution 1, no friction and no damping, the energy of particles with links is not conserved: it grows, and it
 * grows faster with longer steps. See docs/evidence.md.
 *
 * @param[in] c      [count] colliders; may be NULL if count is 0
 * @param[in] count  number of colliders, at most `colliders` of the definition; 0 removes all colliders
 * @return SPRING_OK.
 *         SPRING_EINVAL: NULL; an unknown shape; a number that is not finite in the precision of the scene (also after
 *         the largest radius of a particle is added to a radius, or to axis[0] . at of a plane); a negative radius, half
 *         size, friction or bound; a restitution outside 0 ... 1; a custom body without a function or a thickness; axes
 *         whose dot products differ from those of orthonormal axes by more than 1e-3. spring_scene_check_colliders()
 *         names the collider and the field.
 *         SPRING_ERANGE: count is too large.
 *         SPRING_EDISABLED: `colliders` of the definition is 0
 */
SPRING_API spring_status spring_scene_set_colliders(spring_scene *s, const spring_collider *c, uint32_t count);

/**
 * Checks colliders as spring_scene_set_colliders() does, and changes nothing.
 *
 * @param[out] field  name of the first invalid field of spring_collider, such as "axis", or "scene", "c" or "count" for
 *                    the arguments; NULL if all are valid. May be NULL
 * @param[out] index  index of the invalid collider; otherwise 0. May be NULL
 * @return as spring_scene_set_colliders()
 */
SPRING_API spring_status spring_scene_check_colliders(const spring_scene *s, const spring_collider *c, uint32_t count,
                                                      const char **field, size_t *index);

/**
 * Gets the colliders as they are now, with their present positions, axes, velocities and spins.
 *
 * spring_scene_set_colliders() with these colliders changes the motion of colliders by rounding errors only, if each
 * spin acceleration is parallel to the spin. Otherwise their later rotation differs. Use the function to draw the
 * colliders of a loaded state, or to change one collider and keep the others.
 *
 * @param[out]    out    may be NULL: only *count is written
 * @param[in,out] count  size of out; afterwards the number of colliders
 * @return SPRING_OK; SPRING_EINVAL: s or count is NULL; SPRING_ENOMEM: out is too small, and only *count was written
 */
SPRING_API spring_status spring_scene_get_colliders(const spring_scene *s, spring_collider *out, uint32_t *count);

/** Copies, for particles first ... first + count - 1, a mask of the colliders that the particle touched in the last
 * step.
 *
 * Bit i stands for collider i. All bits are 0 after spring_scene_set_colliders() and spring_scene_transform(). The bits
 * of a particle are 0 after its position is set, and after it is pinned or freed.
 *
 * @param[out] mask  [count]
 * @return SPRING_OK; SPRING_EINVAL: NULL; SPRING_ERANGE: the particles do not exist; SPRING_EDISABLED: `colliders` of
 *         the definition is 0
 */
SPRING_API spring_status spring_scene_touching(const spring_scene *s, uint32_t *mask, size_t first, size_t count);

/** What particles gave to a collider. */
typedef struct spring_impulse {
    double linear[3];  /**< [N s] */
    double angular[3]; /**< [N m s] about `at` at the end of the call */
} spring_impulse;

/** Copies the impulses that particles gave to colliders first ... first + count - 1 in the last successful call of
 * spring_scene_advance().
 *
 * They are 0 after a call without steps, spring_scene_init() and spring_scene_set_colliders(). A failed call keeps them.
 * The angular impulse of a capsule or a custom body is about its `at` as well. Impulses are not part of the state: no
 * step reads them. Sums of several calls differ from those of one call in rounding errors.
 *
 * @param[out] out  [count]
 * @return SPRING_OK; SPRING_EINVAL: NULL; SPRING_ERANGE: the scene does not have these colliders now; SPRING_EDISABLED:
 *         `colliders` of the definition is 0
 */
SPRING_API spring_status spring_scene_impulses(const spring_scene *s, spring_impulse *out, uint32_t first,
                                               uint32_t count);

/** Changes the callback and its user pointer. A NULL callback removes it. Returns SPRING_EINVAL if the scene is
    NULL. */
SPRING_API spring_status spring_scene_set_force(spring_scene *s, spring_scene_force_fn *force, void *user);

/**
 * Changes a link of an editable scene. To cut the link, set its stiffness and damping to 0.
 *
 * @param[in] link  the new values. The ends a and b must be those of the definition, and may be swapped; with one axis,
 *                  a swap reverses the link
 * @return SPRING_OK; SPRING_EINVAL: NULL, other ends, or values that spring_scene_check() rejects; SPRING_ERANGE: the
 *         link does not exist; SPRING_EDISABLED: the scene is not editable
 */
SPRING_API spring_status spring_scene_set_link(spring_scene *s, size_t index, const spring_link *link);

/** Changes links first ... first + count - 1 of an editable scene, as spring_scene_set_link() does. If one of the new
 * links is invalid, none is changed. To reel in a rope, set the rest lengths of its links once per frame.
 *
 * @param[in] link  [count]
 * @return as spring_scene_set_link(); SPRING_ERANGE: the links do not exist
 */
SPRING_API spring_status spring_scene_set_links(spring_scene *s, size_t first, size_t count, const spring_link *link);

/**
 * Changes weighted links first ... first + count - 1 of an editable scene. If one of the new links is invalid, none is
 * changed.
 *
 * A link of a band (see docs/details.md) whose weights are no longer (w, -2w, w), or whose rest length is no longer 0,
 * leaves its band, and takes longer.
 *
 * @param[in] link  [count] the new values. Where a weight is not 0, the particle must be the one of the definition, and
 *                  its weight there not 0
 * @return SPRING_OK; SPRING_EINVAL: NULL, other particles, or values that spring_scene_check() rejects; SPRING_ERANGE:
 *         the links do not exist; SPRING_EDISABLED: the scene is not editable
 */
SPRING_API spring_status spring_scene_set_weighted_links(spring_scene *s, size_t first, size_t count,
                                                         const spring_weighted_link *link);

/**
 * Cuts all links of an editable scene that are longer than a limit.
 *
 * Call it always after the same number of steps, because the result depends on how often the lengths are compared.
 * Links are compared in double precision and visited in the order of their indices. Links that are already cut, and
 * tethers and links of rest length 0, are skipped. With one axis, the length is x_b - x_a. Cutting a link also cuts
 * each weighted link that contains both of its ends. Use spring_links_components() to find the pieces.
 *
 * Banded links are first compared with SIMD, and one by one only if one of them may be too long: with limits, if any
 * link, even a cut one, is longer than the least limit allows. So set the limits of cut links and tethers to INFINITY.
 * For bands see spring_links_renumber().
 *
 * @param[in]  stretch  a link is cut if length > stretch rest; >= 0. INFINITY cuts no link. Ignored unless limit is
 *                      NULL
 * @param[in]  limit    [links] a value of `stretch` for each link; NULL: `stretch` for all links
 * @param[out] torn     [capacity] the indices of the links that this call cuts, at most the first `capacity` of them;
 *                      may be NULL if capacity is 0
 * @param[in]  capacity number of elements of torn
 * @param[out] count    number of links that this call cuts, which may be larger than capacity; may be NULL
 * @return SPRING_OK; SPRING_EINVAL: NULL, or a stretch or limit that is negative or NaN; SPRING_EDISABLED: the scene is
 *         not editable. torn and count are written only with SPRING_OK
 */
SPRING_API spring_status spring_scene_tear(spring_scene *s, double stretch, const double *limit, uint32_t *torn,
                                           size_t capacity, size_t *count);

/**
 * Transforms all particles, including pinned particles, by an affine map: x1 = A x + b, v1 = A v.
 *
 * Use it to teleport, rotate or reflect a scene. Rest lengths, gravity, held forces and colliders do not change. To
 * scale a scene, also change the rest lengths with spring_scene_set_links(). Otherwise all links are stretched or
 * compressed, and the scene springs back violently.
 *
 * @param[in] matrix  the rows of [A b], with b in [m]: A_xx A_xy A_xz b_x, A_yx ... With two axes, the third row and
 *                    the third column are ignored; with one axis, the second row and column too
 * @return SPRING_OK; SPRING_EINVAL: NULL, or an element that is not finite; SPRING_ENONFINITE: a position or velocity
 *         would not be finite
 */
SPRING_API spring_status spring_scene_transform(spring_scene *s, const double matrix[12]);

/** Copies the current values of a link, rounded to the precision of the scene. With two or three axes, the ends a and b
 * may be in the opposite order to the definition.
 *
 * @return SPRING_OK; SPRING_EINVAL: NULL; SPRING_ERANGE: the link does not exist
 */
SPRING_API spring_status spring_scene_get_link(const spring_scene *s, size_t index, spring_link *link);

/** Copies the current values of a weighted link, rounded to the precision of the scene. Where its weight is 0 in the
 * definition, the particle is 0.
 *
 * @return SPRING_OK; SPRING_EINVAL: NULL; SPRING_ERANGE: the link does not exist
 */
SPRING_API spring_status spring_scene_get_weighted_link(const spring_scene *s, size_t index,
                                                        spring_weighted_link *link);

/** Returns the smallest index of a link between particles a and b, in either order. Cut links are included. Returns
    SIZE_MAX if there is no such link, and for NULL. The search visits all links. */
SPRING_API size_t spring_scene_find_link(const spring_scene *s, uint32_t a, uint32_t b);

/**
 * Pins or frees particles first ... first + count - 1 of an editable scene.
 *
 * To drag a particle, pin it and move it with spring_scene_drive(). To release it, free it: it keeps its velocity.
 *
 * A free particle that becomes pinned stops where it is. A particle that is already pinned keeps its velocity. A freed
 * particle gets the mass that was last set with spring_scene_set_mass(). If none was set, it gets the mass of the
 * definition: mass[i] if this is positive, otherwise mass_all. The call may visit all links.
 *
 * @param[in] pinned  [count]; non-zero: pinned, 0: free
 * @return SPRING_OK; SPRING_EINVAL: NULL, or a particle would be freed with a mass that spring_scene_check() rejects;
 *         SPRING_ERANGE: the particles do not exist; SPRING_EDISABLED: the scene is not editable
 */
SPRING_API spring_status spring_scene_set_pinned(spring_scene *s, size_t first, size_t count, const uint8_t *pinned);

/**
 * Changes the masses of particles first ... first + count - 1 of an editable scene. The mass of a pinned particle takes
 * effect when the particle is freed. The call may visit all links.
 *
 * @param[in] mass  [count] [kg] > 0
 * @return SPRING_OK; SPRING_EINVAL: NULL, or a mass that spring_scene_check() rejects; SPRING_ERANGE: the particles do
 *         not exist; SPRING_EDISABLED: the scene is not editable
 */
SPRING_API spring_status spring_scene_set_mass(spring_scene *s, size_t first, size_t count, const double *mass);

/**
 * Moves a pinned particle: sets its velocity so that it reaches `target` after `duration`.
 *
 * The scene need not be editable. Link damping sees this velocity. The particle keeps moving at this velocity until the
 * velocity is changed. The velocity is rounded once, and the position in each step, so after n steps the particle may
 * miss the target by about n/2 + 5 ulp of the largest coordinate on its way; n + 5 ulp with heavily damped links, and
 * 6 n + 5 ulp with SRKN6.
 *
 * @param[in] target    [axes] [m] position to reach; NULL: the particle stops
 * @param[in] duration  > 0 [s], usually the duration n dt of the next call of spring_scene_advance(). If the target is
 *                      where a hand is now, and steps come from spring_clock_tick(): n dt + clock->pending, see
 *                      docs/games.md. Ignored if target is NULL
 * @return SPRING_OK; SPRING_EINVAL: the scene is NULL, the particle is not pinned, the duration is not positive and
 *         finite, or the distance or velocity is not finite; SPRING_ERANGE: the particle does not exist
 */
SPRING_API spring_status spring_scene_drive(spring_scene *s, size_t particle, const double *target, double duration);

/** Returns the tension of a link [N], including its damping, as in spring_link: positive if the link pulls. With two or
    three axes, the result at length 0 is the tension of the stiffness alone. 0 for a slack tension-only link and for a
    torn link. NaN for NULL and for a link that does not exist. */
SPRING_API double spring_scene_tension(const spring_scene *s, size_t index);

/** @} */

/** @defgroup scene_save Saved states
 * @{ */

/** What spring_scene_describe() returns. */
typedef struct spring_scene_info {
    size_t particles;      /**< number of particles */
    size_t links;          /**< number of links */
    size_t weighted_links; /**< number of weighted links */
    uint32_t axes;         /**< 1, 2 or 3 */
    uint32_t flags;        /**< flags of the definition */
    uint32_t methods;      /**< enabled methods, 1u << SPRING_EULER | ... */
    uint32_t colliders;    /**< maximum number of colliders */
} spring_scene_info;

/** Returns the sizes and options of a scene, with the defaults of the definition filled in. All are 0 for NULL. */
SPRING_API spring_scene_info spring_scene_describe(const spring_scene *s);

/**
 * Saves the state of a scene in a portable format, for spring_scene_load() in any build of the library, on any
 * processor and in any language. docs/details.md describes the format.
 *
 * The state consists of everything that a run depends on besides the definition: positions, velocities, the time and
 * the last time step, kept forces (see spring_scene_advance()), held forces, gravity, colliders, the time since they
 * were set, and the colliders that particles touch. The state of an editable scene also has all masses, pins and
 * coefficients of links and weighted links. Saving changes nothing. A call of spring_scene_advance() that fails may
 * drop the forces that are kept, which the next step then computes again. Apart from this, equal states of scenes with
 * the same definition have equal bytes, so saved states can be compared. (Fields of colliders that their shape does not
 * use are saved as they were set.)
 *
 * @param[out]    out    the state, at any address; NULL: only *bytes is written
 * @param[in,out] bytes  size of out [bytes]; afterwards the size of the state, which may change with each step. It is
 *                       at most 1.1 times the size of the values listed above, plus 256 bytes
 *                       (tests/scene/test_random.c)
 * @return SPRING_OK; SPRING_EINVAL: the scene or bytes is NULL; SPRING_ENOMEM: out is too small, and only *bytes was
 *         written; SPRING_ENONFINITE: the state was lost in a failed step, see SPRING_SCENE_NO_UNDO
 */
SPRING_API spring_status spring_scene_save(const spring_scene *s, void *out, size_t *bytes);

/**
 * Loads a state into a scene of the same definition. The run then continues bit-identically.
 *
 * The call checks that the state is complete and undamaged, and that precision, axes, flags, methods, the numbers of
 * particles, links and weighted links, the maximum number of colliders, the arrays of radius, friction and mask, the
 * ends, order and flags of links, the particles of weighted links, how many links are damped (unless the scene is
 * editable), and whether there is a callback are those of this scene. It cannot check the following, which a run also
 * depends on. They must be the same as in the scene that was saved:
 *  - drag, max_speed and particle_radius;
 *  - masses, pinned particles and the coefficients of links, unless the scene is editable;
 *  - the callback, and the data that it reads.
 *
 * Positions, velocities and gravity of the definition need not be the same.
 *
 * @param[in] in     a saved state, at any address
 * @param[in] bytes  its size
 * @return SPRING_OK; SPRING_EINVAL: NULL; the state is truncated or damaged; or it has a custom body where the scene has
 *         none now, or the reverse; SPRING_EMISMATCH: it is undamaged, but of a scene with another definition, or of
 *         another version of the format. Unless it returns SPRING_OK, nothing is changed, even with
 *         SPRING_SCENE_NO_UNDO
 */
SPRING_API spring_status spring_scene_load(spring_scene *s, const void *in, size_t bytes);

/**
 * Sets the time of a scene. Nothing else changes: colliders keep the time since they were set, so they stay where they
 * are. If there is a callback, forces are evaluated again.
 *
 * Two scenes of the same definition, which have run differently, run bit-identically after spring_scene_set_time(),
 * spring_scene_set() of positions and velocities and spring_scene_set_colliders() with the same values for both. Set
 * gravity, masses, pins, links and held forces as well where they differ.
 *
 * @param[in] t  time [s]
 * @return SPRING_OK; SPRING_EINVAL: NULL, or t is not finite
 */
SPRING_API spring_status spring_scene_set_time(spring_scene *s, double t);

/** @} */

/** @defgroup scenef The single-precision version
 * @{ */

/** The definition of a single-precision scene: as spring_scene_def, except for the type of the callback. */
typedef struct spring_scenef_def {
    /** As in spring_scene_def.
     * @{ */
    uint32_t axes;
    uint32_t flags;
    uint32_t methods;
    size_t particles;
    size_t links;
    const double *position;
    const double *velocity;
    const double *mass;
    double mass_all;
    const uint8_t *pinned;
    const spring_link *link;
    double gravity[3];
    double drag;
    spring_scenef_force_fn *force;
    void *user;
    double max_speed;
    uint32_t colliders;
    double particle_radius;
    size_t weighted_links;
    const spring_weighted_link *weighted_link;
    const double *radius;
    const double *friction;
    const uint32_t *mask;
    /** @} */
} spring_scenef_def;

/** A single-precision scene. */
typedef struct spring_scenef spring_scenef;
/** The energies of a single-precision scene, in double. */
typedef spring_scene_energies spring_scenef_energies;

/** As the functions spring_scene_..., spring_links_soften() and spring_links_tethers(), for a single-precision scene.
 * @{ */
SPRING_API spring_status spring_scenef_check(const spring_scenef_def *def, const char **field, size_t *index);
SPRING_API spring_status spring_scenef_bytes(const spring_scenef_def *def, size_t *bytes);
SPRING_API spring_status spring_scenef_init(void *memory, size_t bytes, const spring_scenef_def *def,
                                            spring_scenef **scene);
SPRING_API spring_status spring_scenef_advance(spring_scenef *s, spring_method m, double dt, uint64_t n);
SPRING_API double spring_scenef_stable_step(spring_scenef *s, spring_method m);
SPRING_API spring_status spring_linksf_soften(const spring_scenef_def *def, double dt, double fraction,
                                              spring_link *link);
SPRING_API spring_status spring_linksf_tethers(const spring_scenef_def *def, double fraction, double slack,
                                               spring_link *out, size_t *count, uint32_t *work, double *distance);
SPRING_API double spring_scenef_time(const spring_scenef *s);
SPRING_API spring_scenef_energies spring_scenef_energy(const spring_scenef *s);
SPRING_API bool spring_scenef_at_rest(spring_scenef *s, double v_tol, double a_tol);
SPRING_API spring_status spring_scenef_get(const spring_scenef *s, spring_quantity q, double *out, size_t stride,
                                           size_t first, size_t count);
SPRING_API spring_status spring_scenef_getf(const spring_scenef *s, spring_quantity q, float *out, size_t stride,
                                            size_t first, size_t count);
SPRING_API spring_status spring_scenef_set(spring_scenef *s, spring_quantity q, const double *in, size_t stride,
                                           size_t first, size_t count);
SPRING_API spring_status spring_scenef_set_gravity(spring_scenef *s, const double gravity[3]);
SPRING_API spring_status spring_scenef_set_force(spring_scenef *s, spring_scenef_force_fn *force, void *user);
SPRING_API spring_status spring_scenef_set_link(spring_scenef *s, size_t index, const spring_link *link);
SPRING_API spring_status spring_scenef_get_link(const spring_scenef *s, size_t index, spring_link *link);
SPRING_API spring_status spring_scenef_set_weighted_links(spring_scenef *s, size_t first, size_t count,
                                                          const spring_weighted_link *link);
SPRING_API spring_status spring_scenef_get_weighted_link(const spring_scenef *s, size_t index,
                                                         spring_weighted_link *link);
SPRING_API size_t spring_scenef_find_link(const spring_scenef *s, uint32_t a, uint32_t b);
SPRING_API spring_status spring_scenef_set_pinned(spring_scenef *s, size_t first, size_t count, const uint8_t *pinned);
SPRING_API spring_status spring_scenef_set_mass(spring_scenef *s, size_t first, size_t count, const double *mass);
SPRING_API spring_status spring_scenef_drive(spring_scenef *s, size_t particle, const double *target, double duration);
SPRING_API double spring_scenef_tension(const spring_scenef *s, size_t index);
SPRING_API spring_status spring_scenef_set_links(spring_scenef *s, size_t first, size_t count, const spring_link *link);
SPRING_API spring_status spring_scenef_tear(spring_scenef *s, double stretch, const double *limit, uint32_t *torn,
                                            size_t capacity, size_t *count);
SPRING_API spring_status spring_scenef_transform(spring_scenef *s, const double matrix[12]);
SPRING_API spring_status spring_scenef_set_colliders(spring_scenef *s, const spring_collider *c, uint32_t count);
SPRING_API spring_status spring_scenef_get_colliders(const spring_scenef *s, spring_collider *out, uint32_t *count);
SPRING_API spring_status spring_scenef_check_colliders(const spring_scenef *s, const spring_collider *c, uint32_t count,
                                                       const char **field, size_t *index);
SPRING_API spring_status spring_scenef_touching(const spring_scenef *s, uint32_t *mask, size_t first, size_t count);
SPRING_API spring_status spring_scenef_impulses(const spring_scenef *s, spring_impulse *out, uint32_t first,
                                                uint32_t count);
SPRING_API spring_scene_info spring_scenef_describe(const spring_scenef *s);
SPRING_API spring_status spring_scenef_save(const spring_scenef *s, void *out, size_t *bytes);
SPRING_API spring_status spring_scenef_load(spring_scenef *s, const void *in, size_t bytes);
SPRING_API spring_status spring_scenef_set_time(spring_scenef *s, double t);
/** @} */

/** @} */

/** @defgroup grids Ropes, sheets, blocks and meshes
 * @{ */

/** @name The springs of a grid
 *
 * Bend springs join second neighbours. They keep rows from being compressed or folded, but hardly resist bending: their
 * energy grows as the fourth power of the angle. For bending stiffness, use spring_bend_grid().
 * @{ */
#define SPRING_GRID_STRUCTURAL UINT32_C(1) /**< structural springs: to the next particle along each axis */
#define SPRING_GRID_SHEAR      UINT32_C(2) /**< shear springs: the diagonals of the faces and body of each cell */
#define SPRING_GRID_BEND       UINT32_C(4) /**< bend springs: to the second neighbour along each axis */
/** @} */

/** The faces of a grid whose particles are pinned: the first or last face along x, y or z. In a sheet in the plane of x
 * and y, both faces along z contain all particles.
 * @{ */
#define SPRING_GRID_FIRST_X UINT32_C(1)
#define SPRING_GRID_LAST_X  UINT32_C(2)
#define SPRING_GRID_FIRST_Y UINT32_C(4)
#define SPRING_GRID_LAST_Y  UINT32_C(8)
#define SPRING_GRID_FIRST_Z UINT32_C(16)
#define SPRING_GRID_LAST_Z  UINT32_C(32)
/** @} */

/** A grid of cubes with a particle at each corner: a row of particles is a rope, a layer is a sheet, and several layers
 * are a soft body. Particle (i, j, k) has the index i + count[0] (j + count[1] k). Zero-initialise.
 *
 * Stretch under gravity g. In the formulas below, the stretch of a link is length/rest - 1, which is
 * weight/(stiffness spacing) for a link that carries a weight. For n links in a vertical row and particles of mass m:
 *
 *     rope, or sheet of structural springs, that hangs by an edge
 *         elongation                  m g n (n + 1)/(2 stiffness)
 *         largest stretch of a link   m g n/(stiffness spacing), at the edge
 *
 * A sheet that hangs by two corners, with the weight W of all free particles and q = W/(stiffness spacing):
 *
 *     structural springs only (the row between the corners carries the sheet, like a cable)
 *         largest stretch of a link   (q^2/24)^(1/3)
 *         sag of this row             (distance of the corners) (3 q/64)^(1/3)
 *     with shear springs
 *         largest stretch of a link   0.30 q, at the corners; with shear and bend springs 0.175 q
 *
 * The formulas for two corners agree within 5 % with square sheets at rest: without shear springs for 12 to 32
 * particles along an edge and a stretch of 1 to 4 %, with shear springs for 8 to 24 particles and a stretch of 1 %
 * (tests/scene/test_hanging.c). For other scenes, use spring-plan --sag to find the stiffness. */
typedef struct spring_grid {
    uint32_t count[3]; /**< particles along x, y, z; 0 means 1 */
    uint32_t axes;     /**< axes of the positions, 1, 2 or 3; the grid extends along no other axes; 0 means 3 */
    bool height;       /**< height field: one axis, normal to the grid; positions and rest lengths are 0 */
    double spacing;    /**< [m] > 0, distance between neighbours along an axis, also in a height field */
    double stretch;    /**< > 0, length/rest of every link; 0 means 1; links are under tension above 1 */
    uint32_t families; /**< springs, SPRING_GRID_STRUCTURAL | ...; 0 means structural springs only */
    double stiffness;  /**< [N/m] >= 0, of every link */
    double damping;    /**< [N s/m] >= 0, of every link */
    uint32_t pinned;   /**< pinned faces, SPRING_GRID_FIRST_X | ...; 0: none */
} spring_grid;

/**
 * Computes the numbers of particles and links of a grid.
 *
 * @return SPRING_OK; SPRING_EINVAL: NULL or an invalid grid; SPRING_ERANGE: too many particles for 32-bit indices, or
 *         too many links for size_t. Nothing is written after an error
 */
SPRING_API spring_status spring_grid_size(const spring_grid *g, size_t *particles, size_t *links);

/**
 * Fills the arrays of a definition, for either precision. The arrays belong to the caller, who may change them before
 * creating a scene.
 *
 * Links have a < b and are sorted by a. Links with the same a are in the order structural, shear, bend. Shear springs
 * are in the order of the faces xy, xz, yz, followed by the diagonals of the body. Within each group, links are sorted
 * by b.
 *
 * @param[out] position  [particles*axes] [m]; the first particle is at the origin
 * @param[out] pinned    [particles] 1: pinned, 0: free; may be NULL
 * @param[out] link      [links]; may be NULL
 * @return as spring_grid_size(); SPRING_EINVAL also if position is NULL. Nothing is written after an error
 */
SPRING_API spring_status spring_grid_fill(const spring_grid *g, double *position, uint8_t *pinned, spring_link *link);

/**
 * Renumbers particles so that linked particles are near each other in memory, and sorts links by their lower, then by
 * their upper ends. Call it before you create a scene, of either precision, from an unsorted mesh. Tethers are renumbered
 * and sorted, but have no influence on the numbering.
 *
 * A band is a set of links with a constant index offset between their ends. A scene evaluates bands faster than
 * unbanded links. The particles of a rope are put in order, and the particles of a sheet in rows, so that their links
 * form bands. In a sheet, this requires that the links along its rows and columns are at most a quarter longer than the
 * shortest link, and that all other links are longer. In other meshes, linked particles get indices that differ by
 * little.
 *
 * Permute other arrays yourself: new_mass[i] = mass[order[i]], new_link_name[i] = link_name[link_order[i]].
 *
 * The time is proportional to particles + links: ten passes over both ends of all links, or fifteen if there are no
 * rows. The result depends only on the arguments.
 *
 * @param[in]     particles   fewer than 2^32 - 1
 * @param[in]     links       fewer than 2^29
 * @param[in,out] link        [links]; the ends a and b of a link are not swapped. May be NULL if links is 0
 * @param[out]    order       [particles]; order[new index] = old index
 * @param[out]    link_order  [links]; link_order[new index] = old index. May be NULL
 * @param         work        [4*particles + 2*links + 1] work space, used only during the call
 * @return SPRING_OK; SPRING_EINVAL: NULL, or a link from a particle to itself; SPRING_ERANGE: an index of a particle or
 *         a count is too large. Nothing is written after an error
 * @par Source    Cuthill, McKee, Reducing the bandwidth of sparse symmetric matrices (1969); src/mesh/renumber.c
 *                describes how the rows are found
 */
SPRING_API spring_status spring_links_renumber(size_t particles, size_t links, spring_link *link, uint32_t *order,
                                               uint32_t *link_order, uint32_t *work);

/** Finds the connected components of particles and links, such as the pieces of a torn scene. A link without stiffness
 * and damping, such as a cut link, does not connect its ends. A tether does not, either.
 *
 * @param[in]  particles  fewer than 2^32
 * @param[in]  links      number of links
 * @param[in]  link       [links]; may be NULL if links is 0
 * @param[out] component  [particles] the number of the component of each particle. Components are numbered 0, 1, ... in
 *                        the order of their smallest particle indices
 * @return number of components. 0, and nothing is written, for invalid input: NULL, an index that is too large, a link
 *         from a particle to itself, or stiffness or damping that is negative or not finite
 */
SPRING_API size_t spring_links_components(size_t particles, size_t links, const spring_link *link, uint32_t *component);

/**
 * Makes tethers: tension-only links (SPRING_LINK_TETHER) from particles to the pinned particles that they hang on. The
 * rest length of a tether is the length of the shortest way between its ends along links. Tethers keep ropes and cloth
 * from stretching if their links have to be soft for the time step. A rope of 40 links of 0.05 m that hangs at rest and
 * takes 4 steps per frame of 1/60 s, at half of the stable step, is 0.2 % too long with tethers of fraction 0.05, and
 * 28 % without (tests/scene/test_tethers.c).
 *
 * A free particle gets one tether if links connect it with a pinned particle, unless one of these links joins it to a
 * pinned particle directly. Links without stiffness, tethers of the definition and weighted links do not connect
 * particles. Tethers are in the ascending order of their particles:
 *
 *     a          the free particle
 *     b          the pinned particle with the least sum of rest lengths along links; the first one of several
 *     rest       this sum, times (1 + slack)
 *     stiffness  fraction K, where K is the sum of spring_scene_stable_step() for this particle alone
 *     flags      SPRING_LINK_TETHER
 *
 * The sum L of spring_scene_stable_step() grows at most by the factor 1 + fraction: with fraction 0.05, the stable step
 * of leapfrog shrinks by at most 2.5 %. Append the tethers to the links of the definition. When a piece of torn cloth
 * comes off, cut its tethers: see examples/c/curtain.c.
 *
 * The work is proportional to links times the number of sweeps over them, which is 2 to 10 for sorted ropes and sheets,
 * and at most two more than the links of the longest way for others. Call spring_links_renumber() first for an unsorted
 * mesh.
 *
 * @param[in]     def       definition of the scene, without the tethers; two or three axes
 * @param[in]     fraction  > 0; 0.05 is a good value
 * @param[in]     slack     >= 0, relative excess length of the tethers
 * @param[out]    out       [*count] the tethers; NULL: only *count and the work space are written
 * @param[in,out] count     before: number of elements of out; after: number of tethers
 * @param         work      [2*particles] work space, used only during the call
 * @param         distance  [2*particles] [m] work space; afterwards, the first half contains the sum of rest lengths for
 *                          each particle: 0 for pinned particles, INFINITY for particles that do not hang on one
 * @return SPRING_OK; SPRING_EINVAL: NULL, an invalid fraction or slack, or a tether that spring_scene_check() would
 *         reject; SPRING_EUNSUPPORTED: one axis; SPRING_ENOMEM: out is too small, and only *count and the work space are
 *         written; otherwise as spring_scene_check()
 */
SPRING_API spring_status spring_links_tethers(const spring_scene_def *def, double fraction, double slack,
                                              spring_link *out, size_t *count, uint32_t *work, double *distance);

/**
 * Makes the particles and links of a triangle mesh, such as an index buffer for drawing. Vertices that are split at
 * seams, for texture coordinates or normals, are welded: they become one particle.
 *
 * In ascending order, a vertex is welded to the first particle within the distance `weld`, or becomes a particle
 * itself. A particle is at the position of its first vertex, and particles are numbered in the order of their first
 * vertices. Vertices without a triangle also become particles. There is one link for each edge, from the particle with
 * the lower index, sorted by a, then by b. Its rest length is the distance of its ends and its stiffness is 1 N/m:
 * scale it. For a sheet of equilateral triangles, stiffness times 1.15 is Young's modulus times the thickness. In a
 * sheet of squares, the factor depends on the direction, strongly if all diagonals are parallel.
 *
 *     for (size_t v = vertices; v-- > 0;)                                  // positions of the particles
 *         memcpy(&x[3 * particle_of[v]], &position[3 * v], 3 * sizeof *x);
 *     for (size_t i = 0; i < 3 * triangles; i++)                           // triangles of particles
 *         triangle[i] = particle_of[triangle[i]];
 *
 * @param[in]     vertices     fewer than 2^32 - 1
 * @param[in]     position     [3*vertices] [m]
 * @param[in]     triangles    fewer than 2^29
 * @param[in]     triangle     [3*triangles] indices of vertices
 * @param[in]     weld         [m] 0: vertices at equal positions are welded; negative: none
 * @param[out]    particle_of  [vertices] the particle of each vertex; may be NULL if out is
 * @param[out]    particles    number of particles, at most `vertices`; may be NULL if out is
 * @param[out]    out          [*links]; NULL: only *links is written
 * @param[in,out] links        before: number of elements of out, of which 3*triangles are always enough; after: number
 *                             of links
 * @param         work         [3*vertices + 6*triangles + 1] work space, used only during the call
 * @return SPRING_OK; SPRING_EINVAL: NULL, a position or `weld` that is not finite, or a triangle without area, before
 *         or after welding, or with sides below about 1e-75 m or above 1e75 m; SPRING_ERANGE: an index of a vertex or a
 *         count is too large; SPRING_ENOMEM: out is too small. After an error nothing is written except the work space
 *         and, with SPRING_ENOMEM, *links
 */
SPRING_API spring_status spring_links_from_mesh(size_t vertices, const double *position, size_t triangles,
                                                const uint32_t *triangle, double weld, uint32_t *particle_of,
                                                size_t *particles, spring_link *out, size_t *links, uint32_t *work);

/** @name Links with bending stiffness
 *
 * These functions make weighted links that resist bending of a rod or a sheet that is straight or flat at rest. The
 * forces are linear in the positions, and do not resist stretching: add a spring_link for that. With damping_time > 0,
 * the weighted links are damped in all directions, see spring_weighted_link.
 *
 * Clamps. Two pinned particles next to each other hold the direction of a rod: a segment between pinned particles does
 * not bend, and bending at its end is concentrated on the free side, so the stiffness there is twice as large. Likewise
 * for triangles whose three corners are pinned. Links whose particles are all pinned are left out.
 *
 * `*count` is the number of elements of `out` before the call, and the number of links after it. If out is NULL, only
 * *count is written.
 *
 * They return SPRING_OK; SPRING_EINVAL: NULL, an invalid argument, or a stiffness or damping that is not finite;
 * SPRING_ERANGE: an index of a particle or a count is too large; SPRING_ENOMEM: out is too small. After an error nothing
 * is written except, with SPRING_ENOMEM, *count.
 * @{ */

#define SPRING_BEND_ROWS      UINT32_C(1) /**< along rows and columns */
#define SPRING_BEND_DIAGONALS UINT32_C(2) /**< along the diagonals of cells */

/**
 * Makes links that resist bending of a rod: hair, a cable, an antenna. For particle i between segments of lengths l1 and
 * l2, the weights of i - 1, i, i + 1 are (l2, -(l1 + l2), l1)/(l1 + l2), and
 *
 *     stiffness = rigidity/l ((l1 + l2)/(l1 l2))^2,   l = (l1 + l2)/2, with 0 for a segment between pinned particles
 *
 * which is 4 rigidity/h^3 for segments of length h. The stiffness of the links of a rod of Young's modulus E and
 * cross-section A is E A/h. To clamp the rod at its start, pin the particles 0 and 1.
 *
 * @param[in]     particles     of the rod, in order
 * @param[in]     axes          1, 2 or 3; 0 means 3
 * @param[in]     position      [particles*axes] [m] straight and different from one particle to the next; only the lengths
 *                              of the segments are used
 * @param[in]     pinned        [particles]; NULL: none
 * @param[in]     rigidity      bending stiffness EI >= 0 [N m^2]; pi r^4 E/4 for a round rod
 * @param[in]     damping_time  damping/stiffness >= 0 [s] of each link
 * @param[out]    out           [*count] in the order of particles; NULL: only *count is written
 * @param[in,out] count         at most particles - 2 links
 * @par Accuracy  Order 2. With 20 segments, the deflection of a cantilever differs from F L^3/(3 EI) by 0.13 %, its first
 *                frequency by 0.21 % and the buckling load of Euler by 0.21 %. With F L^2/EI = 1 ... 10, the tip is
 *                within 0.003 L of the elastica (tests/scene/test_bend.c)
 */
SPRING_API spring_status spring_bend_rod(size_t particles, uint32_t axes, const double *position, const uint8_t *pinned,
                                         double rigidity, double damping_time, spring_weighted_link *out,
                                         size_t *count);

/**
 * Makes links that resist bending of a sheet: cloth, paper, a flag. For a grid with two axes that have more than one
 * particle, and the distance h between neighbours, the weights are (1/2, -1, 1/2), and the stiffness is
 *
 *     SPRING_BEND_ROWS | SPRING_BEND_DIAGONALS   8 D/(3 h^2) along rows and columns, 2 D/(3 h^2) along diagonals
 *     SPRING_BEND_ROWS                           4 D/h^2 along rows and columns
 *
 * It is half as large along the edges of the sheet, and twice as large at clamps. With diagonals this is an isotropic
 * plate of Poisson ratio 1/3. Rows and columns alone cost half as much and bend along their directions as a plate of
 * Poisson ratio 0, but along a diagonal only half as stiffly, and they do not resist twisting. Their links form bands.
 *
 * @param[in]     g             the grid; its links need not exist
 * @param[in]     pinned        [particles], as from spring_grid_fill(); NULL: none
 * @param[in]     families      SPRING_BEND_ROWS or SPRING_BEND_ROWS | SPRING_BEND_DIAGONALS
 * @param[in]     rigidity      bending stiffness D >= 0 [N m]: E t^3/(12 (1 - nu^2)) for a plate of thickness t, and about
 *                              weight/area (L/2)^3 if a strip of length L that is clamped at one end droops until the
 *                              line from the clamp to its end is 41.5 degrees below the horizontal; 1e-6 to 1e-4 for
 *                              cloth
 * @param[in]     damping_time  damping/stiffness >= 0 [s] of each link
 * @param[out]    out           [*count] rows, then columns, then the two directions of diagonals, each in the order of
 *                              their middle particles; NULL: only *count is written
 * @param[in,out] count         at most 4 links for each particle
 * @par Accuracy  Exact for constant curvature, except that edges lack their diagonals. The deflection of a cantilever of
 *                20 segments differs by 0.13 % from the theory of beams for rows and columns. With diagonals it is
 *                between those of a plate and of a beam, but about 20 % larger for a strip of four particles
 *                (tests/scene/test_bend.c)
 */
SPRING_API spring_status spring_bend_grid(const spring_grid *g, const uint8_t *pinned, uint32_t families,
                                          double rigidity, double damping_time, spring_weighted_link *out,
                                          size_t *count);

/**
 * Makes links that resist bending of a flat triangle mesh, one over each edge of two triangles. The weights are those of
 * isometric bending: cotangents of the angles at the edge. The stiffness is rigidity/(area of both triangles), where a
 * triangle whose corners are all pinned does not count.
 *
 * Triangles must be welded, see spring_links_from_mesh(): edges with one triangle do not resist bending.
 *
 * @param[in]     particles     fewer than 2^32 - 1
 * @param[in]     position      [3*particles] [m] at rest
 * @param[in]     triangles     fewer than 2^29
 * @param[in]     triangle      [3*triangles] indices of particles
 * @param[in]     pinned        [particles]; NULL: none
 * @param[in]     rigidity      bending stiffness D >= 0 [N m], see spring_bend_grid()
 * @param[in]     damping_time  damping/stiffness >= 0 [s] of each link
 * @param[out]    out           [*count] in the order of the edges: by their lower, then by their upper ends; NULL: only
 *                              *count is written
 * @param[in,out] count         at most 3*triangles/2 links
 * @param         work          [particles + 6*triangles + 1] work space, used only during the call
 * @return SPRING_EINVAL also for a triangle without area, or with sides below about 1e-75 m or above 1e75 m, and for an
 *         edge of more than two triangles, or of two triangles with the same corners
 * @par Accuracy  For equilateral triangles exact for constant curvature, with the Poisson ratio -1/3. Other meshes are
 *                stiffer in some directions: by up to 1.5 times for squares with alternating diagonals, 3 times for
 *                squares with parallel diagonals, and about 4 times for irregular meshes. Long rectangles are stiffer
 *                still, and some directions are softer. As there are no links over the outer edges, a square cantilever
 *                is softer than a beam, by up to 21 % (for irregular meshes from 21 % softer to 5 % stiffer). Prefer
 *                spring_bend_grid() for grids of squares (tests/scene/test_bend.c)
 */
SPRING_API spring_status spring_bend_mesh(size_t particles, const double *position, size_t triangles,
                                          const uint32_t *triangle, const uint8_t *pinned, double rigidity,
                                          double damping_time, spring_weighted_link *out, size_t *count,
                                          uint32_t *work);

/** @} */

/** @} */

#ifdef __cplusplus
}
#endif

#endif
