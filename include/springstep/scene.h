/* SPDX-License-Identifier: MIT */
/** @file
 * springstep: simulation of mass-spring systems (rope, cloth, soft bodies, height-field water) in caller-owned memory.
 *
 *     mass x'' = link forces + mass gravity - drag x' + F(t, x, x')
 *
 *     static spring_scene_def def;                                      // all zero: every feature is off
 *     def.particles = 3, def.links = 2, def.position = p, def.pinned = pinned, def.link = links;
 *     def.gravity[1] = -9.81;
 *     size_t bytes;
 *     spring_scene *scene;
 *     spring_scene_bytes(&def, &bytes);
 *     void *memory = aligned_alloc(SPRING_SCENE_ALIGN, bytes);          // Windows: _aligned_malloc(bytes, ...)
 *     spring_scene_init(memory, bytes, &def, &scene);
 *     const double dt = fmin(1.0 / 240, 0.5 * spring_scene_stable_step(scene, SPRING_LEAPFROG));
 *     spring_scene_advance(scene, SPRING_LEAPFROG, dt, 4);
 *
 * These rules hold for every function in this file, in addition to those in spring.h:
 *  - A feature that the definition does not enable costs no time. It costs no memory either, with one exception: a
 *    scene without SPRING_SCENE_FORCE_IGNORES_VELOCITY takes more memory. docs/scenes.md lists the bytes of each
 *    feature, docs/performance.md the time.
 *  - All or nothing. After any status except SPRING_OK the scene is unchanged, except with SPRING_SCENE_NO_UNDO.
 *  - A scene begins at the first byte of its memory and holds no pointer to itself. After a memcpy() of its bytes to
 *    another place with the same alignment, in the same build, (spring_scene *)place is a working scene. So a snapshot
 *    is a memcpy(), and so is a rollback. The callback and its user pointer are copied unchanged.
 *  - Threads may use different scenes concurrently. They may also read one scene concurrently, with functions that take
 *    a const scene, while no thread changes it.
 *  - Results are bit-identical with every compiler, instruction set and SIMD vector width, if the callback's are.
 *  - Particles collide with colliders (planes, spheres, capsules, boxes), not with each other, and links do not collide.
 *
 * spring_scenef_... is the single-precision version, compiled from the same source. State and arithmetic are float:
 * half the memory and nearly twice the speed. Definitions, times, energies and spring_scenef_get() stay in double; only
 * its callback receives floats.
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

#define SPRING_SCENE_ALIGN 64 /**< alignment of the memory of a scene [bytes] */

/** A spring between two particles.
 *
 * With two or three axes, it pulls both ends along the line between them with the tension stiffness (length - rest) +
 * damping rate, where rate is the derivative of the length. If both ends are at the same place, this line has no
 * direction and there is no force. If the square of the length underflows (below about 1e-160 m, in float 1e-21 m), the
 * force is not meaningful. With one axis it is linear: it pulls a with stiffness ((x_b - x_a) - rest) +
 * damping (v_b - v_a). */
typedef struct spring_link {
    uint32_t a;       /**<         index of a particle */
    uint32_t b;       /**<         index of another particle */
    double rest;      /**< [m]     rest length >= 0 */
    double stiffness; /**< [N/m]   >= 0 */
    double damping;   /**< [N s/m] >= 0, along the link */
} spring_link;

/** A callback that adds forces to force[axis][particle] [N].
 *
 * It is called once per force evaluation, with the time t [s] of the positions [m] and velocities [m/s]. All positions
 * and velocities are finite. Arrays of axes that the scene does not have are NULL. With
 * SPRING_SCENE_FORCE_IGNORES_VELOCITY the contents of the velocity arrays are unspecified: do not read them.
 *
 * The callback must depend only on its arguments and *user; otherwise advance(10) is not 10 times advance(1). It must
 * not call a function on its own scene. After a change of *user, call spring_scene_set_force() again, because a force
 * may have been kept (SPRING_SCENE_FORCE_IGNORES_VELOCITY).
 *
 * If the force on a free particle is not finite, the call fails with SPRING_ENONFINITE. RKN8 keeps the last force of a
 * call without using it, so with RKN8 the next call fails. Forces on pinned particles are ignored. */
typedef void spring_scene_force_fn(void *user, double t, size_t particles, const double *const position[3],
                                   const double *const velocity[3], double *const force[3]);
/** The callback of a single-precision scene. */
typedef void spring_scenef_force_fn(void *user, double t, size_t particles, const float *const position[3],
                                    const float *const velocity[3], float *const force[3]);

/** Enables spring_scene_set_link(), _set_links(), _tear(), _set_pinned() and _set_mass(). Each link and each particle then has its own stored
   numbers, even if they are equal. */
#define SPRING_SCENE_EDITABLE UINT32_C(1)

/** The scene has no second copy of the state. A call of spring_scene_advance() that fails in a step loses the state:
   positions and velocities become NaN, and no step succeeds until spring_scene_set() has set all of them. */
#define SPRING_SCENE_NO_UNDO UINT32_C(2)

/** Promises that the callback does not use velocities; also for scenes that never have a callback. The velocities that
   the callback receives are unspecified. Leapfrog then keeps the force at the end of a step for the next step, which
   halves its work. If no link is damped or editable, leapfrog also needs no memory for predicted velocities. */
#define SPRING_SCENE_FORCE_IGNORES_VELOCITY UINT32_C(4)

/** Links pull and never push: rope, net, sail. A link that is not longer than its rest length is slack: it has no tension
   and no energy. A longer link has the tension max(0, stiffness (length - rest) + damping rate), so damping never pushes
   either. Requires two or three axes. Leapfrog and RK4 have order 2 where a link becomes taut or slack. */
#define SPRING_SCENE_TENSION_ONLY UINT32_C(8)

/** Room for held forces, see SPRING_FORCE. */
#define SPRING_SCENE_FORCES UINT32_C(16)

/** The shapes of colliders. */
typedef enum spring_shape {
    SPRING_PLANE,   /**< a half-space */
    SPRING_SPHERE,  /**< a ball */
    SPRING_CAPSULE, /**< all points within a distance of a line segment */
    SPRING_BOX      /**< a box in any orientation; with a radius its edges are rounded */
} spring_shape;

/** A convex body that free particles cannot enter. Zero-initialise. Fields that the shape does not use are ignored, and with two
 * axes so are the third elements. */
typedef struct spring_collider {
    spring_shape shape;    /**< of the body */
    double at[3];          /**< [m] a point of the plane; the centre; or one end of the axis of a capsule */
    double to[3];          /**< [m] capsule: the other end */
    double axis[3][3];     /**< plane: axis[0] is the unit normal, which points out of the body. Box: its unit axes */
    double half[3];        /**< [m] box: half of its size along each axis >= 0, without the radius */
    double radius;         /**< [m] >= 0 of a sphere or capsule; also rounds a box */
    double velocity[3];    /**< [m/s] of `at` */
    double velocity_to[3]; /**< [m/s] of `to` */
    /** [rad/s] angular velocity of the surface about `at` (capsule: about its axis), for friction only: the body does not
        turn. With two axes spin[2] */
    double spin[3];
    double friction;    /**< Coulomb coefficient >= 0 */
    double restitution; /**< 0 to 1: normal speed after an impact over that before */
} spring_collider;

/** The definition of a scene. Leave features that you do not use at zero. Every array is copied. */
typedef struct spring_scene_def {
    uint32_t axes;                /**< 1, 2 or 3; 0 means 3 */
    uint32_t flags;               /**< SPRING_SCENE_... */
    uint32_t methods;             /**< methods to be used, 1u << SPRING_EULER | ...; 0: all except RK4, RKN8, SRKN6 */
    size_t particles;             /**< 1 to nearly 2^32; at most 2^23 - 1 if addresses have 32 bits */
    size_t links;                 /**< less than 2^29; at most 2^23 - 1 if addresses have 32 bits */
    const double *position;       /**< [particles*axes] x0 y0 z0 x1 ... [m] */
    const double *velocity;       /**< [particles*axes] [m/s]; NULL: at rest */
    const double *mass;           /**< [particles] [kg] > 0 unless pinned; NULL: mass_all for every particle */
    double mass_all;              /**< [kg]; 0 means 1 */
    const uint8_t *pinned;        /**< [particles]; non-zero: ignores forces, keeps its velocity; NULL: none */
    const spring_link *link;      /**< [links]; sorted links are fastest, see docs/scenes.md */
    double gravity[3];            /**< [m/s^2]; elements beyond the axes are ignored */
    double drag;                  /**< [N s/m] >= 0, on every particle */
    spring_scene_force_fn *force; /**< callback; NULL: none */
    void *user;                   /**< passed to force */
    double max_speed;             /**< [m/s] a step after which a free particle is faster along an axis fails with
                                     SPRING_EUNSTABLE; 0: no limit */
    uint32_t colliders;           /**< maximum number of colliders, at most 32; 0: none */
    double particle_radius;       /**< [m] >= 0 of every particle, for contacts */
} spring_scene_def;

/** A scene, in caller-owned memory. */
typedef struct spring_scene spring_scene;

/**
 * Checks a definition.
 *
 * @param[out] field  name of the first invalid field, such as "mass" or "link.a"; NULL if the definition is valid. May
 *                    be NULL
 * @param[out] index  index of the particle or link; the axis of gravity; else 0. May be NULL
 * @return SPRING_OK; SPRING_EINVAL: an invalid value, or a mass or its reciprocal, 2 stiffness/mass, 2 damping/mass or
 *         drag/mass that is not finite in the precision of the scene; SPRING_ERANGE: an index of a particle or a count
 *         is too large; SPRING_EUNSUPPORTED: the methods include the exact solution, or RKN8 or SRKN6 for a scene with a
 *         damped link, tension-only links, colliders or a callback that may use velocities; or tension-only links or
 *         colliders on one axis
 */
SPRING_API spring_status spring_scene_check(const spring_scene_def *def, const char **field, size_t *index);

/**
 * Computes the size of a scene [bytes], a multiple of SPRING_SCENE_ALIGN.
 *
 * @return as spring_scene_check()
 */
SPRING_API spring_status spring_scene_bytes(const spring_scene_def *def, size_t *bytes);

/**
 * Creates a scene in the given memory. Its time is 0.
 *
 * @param[out] memory  aligned to SPRING_SCENE_ALIGN
 * @param[in]  bytes   size of memory, at least that of spring_scene_bytes()
 * @param[out] scene   the scene; NULL after an error. Only its memory needs to be released
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
 *     RK4               the four stages
 *     RKN8              X_i = x + c_i dt v + dt^2 sum a_ij A_j,   A_i = a(t + c_i dt, X_i),   i = 1 ... 8
 *                       x1 = x + dt v + dt^2 sum b_j A_j,   v1 = v + dt sum b'_j A_j
 *     SRKN6             v += dt b_i a(x),   x += dt a_i v,   i = 1 ... 11;   v1 = v + dt b_12 a(x1)
 *
 * Drag is implicit in the kick of symplectic Euler and in the last half kick of leapfrog. Link damping and callbacks
 * use predicted velocities in that half kick: v* = v' + dt/2 a*, v1 = v' + dt/2 a(x1, v*), where a* is the acceleration
 * by the forces of the first half kick and by the implicit drag at v*. This is still second order. Held forces act like
 * gravity, in every kick and stage.
 *
 * Leapfrog with heavy link damping. This explicit damping is stable for dt <= 2/(G + sqrt(G^2 + L)), with L and G as in
 * spring_scene_stable_step(). For a larger dt a step is leapfrog without link damping for dt/2, link damping for dt, and
 * leapfrog for dt/2. Damping for a time dt multiplies velocities by e^(-dt C/mass), with the directions of links at
 * dt/2, computed as a Chebyshev series. So leapfrog is stable for dt < 2/sqrt(L) at any link damping, and damping never
 * adds energy. The step is of second order for dt G up to about 3; beyond, motion that damping slows down has an error
 * of first order. A step costs two force evaluations and about 1.4 sqrt(dt G) evaluations of damping alone, each half
 * as expensive; at most 12 500 of them (single precision: 760), so that for dt G above 8e7 (3e5) damping acts for a
 * shorter time.
 *
 * RKN8 has order 8. It requires links without damping and a callback that does not use velocities. Drag enters through
 * y = e^(drag t/(2 mass)) (x - x0), to which the method is applied, so the order stays 8: with drag alone, the error is
 * 3e-11 of the distance for dt drag/mass = 1, and 2e-6 for dt drag/mass = 4. Forces must be smooth: a contact or a
 * force that starts suddenly reduces the order. RKN8 is not symplectic: for dt sqrt(L) = 0.4 (L as in
 * spring_scene_stable_step()) an oscillator loses 6e-11 of its energy per period.
 *
 * SRKN6 has order 6, is symplectic and time-reversible, and has the same requirements as RKN8. Use it for long runs with
 * three to six significant digits: without drag the energy error stays bounded. It needs fewer force evaluations than
 * leapfrog, and for such errors about as many as RKN8. Drag is solved exactly together with the drift, so the order
 * stays 6.
 *
 * Force evaluations per step: one for both Euler methods and leapfrog (two with heavy link damping), four for RK4, eight
 * for RKN8, eleven for SRKN6. Leapfrog, RKN8 and SRKN6 keep the force at the end of a step for the start of the next.
 * With damped links, the force that leapfrog keeps is
 * the one at v*. This force is then part of the state, and a snapshot contains it. It is evaluated again, at v, after
 * spring_scene_set(), after a change of links, pins, masses, the callback or the velocity of a pinned particle, and
 * after steps of another method. With a callback that may use velocities, leapfrog keeps no force and evaluates twice
 * per step, because what the callback reads may change between steps; see SPRING_SCENE_FORCE_IGNORES_VELOCITY.
 *
 * Contacts, see spring_scene_set_colliders(), have order 2 with leapfrog and RK4, also across impacts, and order 1 with
 * symplectic Euler. The stable step is the same with colliders.
 *
 * Time is not accumulated: step i of consecutive calls with the same dt is at t0 + i dt.
 *
 * @param[in] m   one of the methods in the definition
 * @param[in] dt  time step [s], finite in the precision of the scene; 0 does nothing, and neither does a step that
 *                rounds to 0 in the precision of the scene; a negative step integrates backwards, where leapfrog with
 *                drag has a pole at dt = -2 mass/drag, and symplectic Euler at half of this
 * @return SPRING_OK; SPRING_EINVAL; SPRING_EDISABLED: a method that is not in the definition; SPRING_EUNSUPPORTED: the
 *         exact solution, RKN8 or SRKN6 if forces now use velocities, or Euler with colliders; SPRING_ENONFINITE: the state or the time would
 *         become infinite or NaN, detected in the step where it happens; SPRING_EUNSTABLE: the same, or a particle would
 *         be faster than max_speed, if the definition has one
 * @par Source    Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), section I.1; Hairer, Norsett, Wanner,
 *                Solving Ordinary Differential Equations I (1993), section II.1; Dormand, El-Mikkawy, Prince,
 *                High-order embedded Runge-Kutta-Nystrom formulae, IMA J. Numer. Anal. 7 (1987); Blanes, Moan,
 *                Practical symplectic partitioned Runge-Kutta and Runge-Kutta-Nystrom methods, J. Comput. Appl. Math.
 *                142 (2002), method SRKN11b
 */
SPRING_API spring_status spring_scene_advance(spring_scene *s, spring_method m, double dt, uint64_t n);

/**
 * Returns a lower bound of the stability limit, from the stiffness of the links: below it, motion about rest does not
 * grow, if no link is compressed below half its rest length. Tension-only links may be compressed further.
 *
 * L is the largest sum of (2/mass) stiffness over the links of a particle, with 1/mass for links whose other end is
 * pinned. G is the same sum of damping, plus drag/mass. K is the largest sum of 2 stiffness, counted
 * likewise. The bounds are:
 *
 *     leapfrog          2/sqrt(L)
 *     RK4               2.61/max(sqrt(L), G)
 *     RKN8              min(3.14/sqrt(L), 40/G)
 *     SRKN6             min(9.07/sqrt(L), 20/G)
 *     Euler             min(drag/K, 2/G) with drag, else 0
 *     symplectic Euler  4/(p + sqrt(p^2 + 4 L)),   p = (G of the links alone) - drag/(largest mass)
 *
 * Without link damping the limit itself is 1.2 to 1.3 times larger for a height field, 1.5 to 1.8 times for cloth and 2
 * times for a soft body. With heavy damping it may be several times larger, except for leapfrog. Closer to the bound, links that rotate or
 * swing far can gain energy by resonance with the step: use half of the bound, and less if a link rotates faster than
 * it would oscillate. Forces of the callback are not considered.
 *
 * With SRKN6 an undamped mode of frequency omega grows by up to 0.07 % per step in two narrow ranges of dt omega below
 * this bound, 3.1414 ... 3.1424 and 6.3478 ... 6.3493. Drag of dt drag/mass > 0.0014 suppresses this growth.
 *
 * @return time step [s]. 0: no stable step is known. INFINITY: no links or drag that could become unstable. NaN for
 *         invalid input and for the exact solution
 * @par Source    Gershgorin's circles; tests/test_scene_limits.c measures the distance to the limit
 */
SPRING_API double spring_scene_stable_step(spring_scene *s, spring_method m);

/**
 * Lowers the stiffness of links until leapfrog is stable with a given time step, for scenes that are too stiff for the
 * steps that a frame can pay for. Softened links stretch more; damping stays as it is.
 *
 * Each link gets the smaller of the factors min(1, (2 fraction/dt)^2 mass/K) of its two ends, where K is the sum of 2
 * stiffness over the links of a particle, or stiffness for links whose other end is pinned. Afterwards
 * dt <= fraction spring_scene_stable_step(..., SPRING_LEAPFROG), and if a link was softened, this step is nearly
 * dt/fraction. Drag and callbacks are not considered.
 *
 * @param[in]  def       the definition of the scene
 * @param[in]  dt        time step > 0 [s]
 * @param[in]  fraction  of the stable step, 0 to 1; 0.5 is on the safe side, see spring_scene_stable_step()
 * @param[out] link      [links]; may be def->link
 * @return SPRING_OK; SPRING_EINVAL; otherwise as spring_scene_check(). Nothing is written after an error
 * @par Accuracy  time is proportional to links (1 + particles/1024)
 */
SPRING_API spring_status spring_links_soften(const spring_scene_def *def, double dt, double fraction,
                                             spring_link *link);

/** Returns the time [s] since spring_scene_init(); NaN for NULL. */
SPRING_API double spring_scene_time(const spring_scene *s);

/** The energies of a scene, as spring_scene_energy() returns them. */
typedef struct spring_scene_energies {
    double kinetic; /**< [J] of all free particles */
    double elastic; /**< [J] of all links; slack tension-only links have none */
    double gravity; /**< [J] of all free particles; 0 at the origin */
} spring_scene_energies;

/** Returns the energies of the links and of the free particles; NaN for NULL. Held forces and callbacks have none. */
SPRING_API spring_scene_energies spring_scene_energy(const spring_scene *s);

/** Returns whether every speed is at most v_tol [m/s] and the acceleration of every free particle is at most a_tol
    [m/s^2]. Acceleration that a collider in spring_scene_touching() balances, by its normal force or by static friction,
    does not count. May evaluate the forces. False for invalid input. */
SPRING_API bool spring_scene_at_rest(spring_scene *s, double v_tol, double a_tol);

/** @} */

/** @defgroup scene_state State and changes
 * @{ */

/** The quantities that spring_scene_get() and spring_scene_set() copy. */
typedef enum spring_quantity {
    SPRING_POSITION, /**< [m] */
    SPRING_VELOCITY, /**< [m/s] */
    SPRING_FORCE     /**< [N] held forces of a scene with SPRING_SCENE_FORCES: at first 0, constant until they are set
                        again. Wind, for example, is found from the state once a frame, and held for its steps. They are
                        part of snapshots, and a call that fails leaves them alone, also with SPRING_SCENE_NO_UNDO. They
                        do not act on a pinned particle until it is freed. Setting them costs no force evaluation */
} spring_quantity;

/**
 * Copies the state of particles first ... first + count - 1 out of a scene, or into it.
 *
 * spring_scene_getf() fills a float vertex buffer, which may hold other data between the positions. To move a pinned
 * particle, use spring_scene_drive(): spring_scene_set() makes it jump, and link damping does not see the motion.
 *
 * @param[in] stride  elements from one particle to the next >= axes; 0 means axes
 * @return SPRING_OK; SPRING_EINVAL: NULL, unknown quantity, stride below axes, a new value that is not finite;
 *         SPRING_ERANGE: there are not that many particles; SPRING_EDISABLED: SPRING_FORCE without SPRING_SCENE_FORCES
 * @{
 */
SPRING_API spring_status spring_scene_get(const spring_scene *s, spring_quantity q, double *out, size_t stride,
                                          size_t first, size_t count);
SPRING_API spring_status spring_scene_getf(const spring_scene *s, spring_quantity q, float *out, size_t stride,
                                           size_t first, size_t count);
SPRING_API spring_status spring_scene_set(spring_scene *s, spring_quantity q, const double *in, size_t stride,
                                          size_t first, size_t count);
/** @} */

/** Changes gravity [m/s^2]. Elements beyond the axes are ignored. SPRING_EINVAL for NULL or values that are not
   finite. */
SPRING_API spring_status spring_scene_set_gravity(spring_scene *s, const double gravity[3]);

/**
 * Replaces all colliders of a scene.
 *
  * Colliders are given at their pose now, and then move at their velocities until they are set again. In a game, set them once
 * per frame, with the velocities that bring them to their next pose. A particle that is inside a collider is moved to its surface in the next
 * step, without a change of velocity. Pinned particles pass through colliders.
 *
  * An impact with the relative velocity u multiplies the normal component by -restitution and reduces the tangential
 * component by at most friction (1 + restitution) |u_normal|. The time of impact within a step is found, so a bounce has
 * order 2, and no particle passes through a single collider that does not turn, at any speed. A capsule whose ends have
 * different velocities turns: let it turn by a small angle per step. A particle that static friction can hold is held exactly,
 * at any time step. An impact that moves less than 8 eps (|x| + radius) into the collider in a step is a rounding error, and
 * does not bounce.
 *
 * Colliders act in the order of their indices. In a wedge between colliders, a particle may be inside one of them by a
 * fraction of its motion in a step. Make a floor of one plane or box: at the seam of two boxes a particle can be caught. Links
 * are not tested, so a thin collider can pass between two particles. A step with negative dt does not undo a step.
 *
  * With restitution 1, no friction and no damping, energy is not conserved: it grows, and faster in longer steps. See
 * docs/evidence.md.
 *
 * @param[in] c      [count]; may be NULL if count is 0, which removes all colliders
 * @param[in] count  at most `colliders` of the definition
 * @return SPRING_OK; SPRING_EINVAL: NULL, an unknown shape, a number that is not finite in the precision of the scene
 *         (with the radius of particles, and for a plane axis[0] . at), a negative radius, half size or friction, restitution outside 0 ... 1, axes that are not orthonormal to 1e-6;
 *         SPRING_ERANGE: count is too large; SPRING_EDISABLED: the definition has no colliders
 */
SPRING_API spring_status spring_scene_set_colliders(spring_scene *s, const spring_collider *c, uint32_t count);

/**
 * Copies the masks of the colliders that particles first ... first + count - 1 touched in the last step. Bit i stands for collider i. The
 * bits are 0 after spring_scene_set_colliders(), after spring_scene_transform(), and for particles whose position or pin was
 * set.
 *
 * @param[out] mask  [count]
 * @return SPRING_OK; SPRING_EINVAL: NULL; SPRING_ERANGE: there are not that many particles; SPRING_EDISABLED: the scene has
 *         no room for colliders
 */
SPRING_API spring_status spring_scene_touching(const spring_scene *s, uint32_t *mask, size_t first, size_t count);

/** Changes the callback; NULL: none. */
SPRING_API spring_status spring_scene_set_force(spring_scene *s, spring_scene_force_fn *force, void *user);

/**
 * Changes a link of an editable scene. Stiffness 0 and damping 0 cut it.
 *
 * @param[in] link  a and b as defined. They may be swapped; with one axis this reverses the link
 * @return SPRING_OK; SPRING_EINVAL; SPRING_ERANGE: no such link; SPRING_EDISABLED: the scene is not editable
 */
SPRING_API spring_status spring_scene_set_link(spring_scene *s, size_t index, const spring_link *link);

/**
 * Changes links first ... first + count - 1 of an editable scene, all of them or none; as spring_scene_set_link(). To
 * reel in a rope, set the rest lengths of its links once a frame.
 *
 * @param[in] link  [count]
 * @return as spring_scene_set_link(); SPRING_ERANGE: there are not that many links
 */
SPRING_API spring_status spring_scene_set_links(spring_scene *s, size_t first, size_t count, const spring_link *link);

/**
 * Cuts all links of an editable scene that are longer than a limit. Call it once a frame: what tears depends on how often
 * the lengths are compared.
 *
 * Links are compared in double precision and in the order of their indices. Cut links and links of rest length 0 are left
 * alone. With one axis the length is x_b - x_a. A scene whose banded links all hold takes less than a nanosecond for each
 * of them. spring_links_components() finds the pieces.
 *
 * @param[in]  stretch  a link is cut if length > stretch rest; >= 0, INFINITY: none is. Ignored if limit is given
 * @param[in]  limit    [links] the same for each link; NULL: stretch for all
 * @param[out] torn     [room] the first `room` of the links that are cut now; may be NULL if room is 0
 * @param[in]  room     elements of torn
 * @param[out] count    number of links that are cut now, which may be larger than room; may be NULL
 * @return SPRING_OK; SPRING_EINVAL: NULL, a limit that is negative or NaN; SPRING_EDISABLED: the scene is not editable.
 *         torn and count are written only with SPRING_OK
 */
SPRING_API spring_status spring_scene_tear(spring_scene *s, double stretch, const double *limit, uint32_t *torn,
                                           size_t room, size_t *count);

/**
 * Moves all particles, pinned ones too, by an affine map: x1 = A x + b, v1 = A v. It teleports, turns, reflects or scales
 * a scene. Rest lengths, gravity, held forces and colliders stay as they are.
 *
 * @param[in] matrix  the rows of [A b]: A_xx A_xy A_xz b_x, A_yx ... With two axes the third row and the third column are
 *                    ignored, with one axis the second, too
 * @return SPRING_OK; SPRING_EINVAL: NULL, an element that is not finite; SPRING_ENONFINITE: a position or velocity would
 *         not be finite
 */
SPRING_API spring_status spring_scene_transform(spring_scene *s, const double matrix[12]);

/**
 * Copies the present values of a link, in the precision of the scene. With two or three axes a and b may be swapped.
 *
 * @return SPRING_OK; SPRING_EINVAL: NULL; SPRING_ERANGE: no such link
 */
SPRING_API spring_status spring_scene_get_link(const spring_scene *s, size_t index, spring_link *link);

/** Returns the smallest index of a link between two particles, in either order. Cut links are included. SIZE_MAX if
    there is none, and for NULL. Searches all links. */
SPRING_API size_t spring_scene_find_link(const spring_scene *s, uint32_t a, uint32_t b);

/**
 * Pins and frees particles first ... first + count - 1 of an editable scene. To grab a particle, pin it and move it
 * with spring_scene_drive(). To release it, free it; it keeps its velocity.
 *
 * A free particle that is pinned stops where it is. A particle that is already pinned keeps its velocity, and a
 * particle whose pin does not change is not affected. A freed particle has the mass that was last set, or else that of
 * the definition: mass[i] if it is positive, otherwise mass_all. May visit all links.
 *
 * @param[in] pinned  [count]; non-zero: pinned
 * @return SPRING_OK; SPRING_EINVAL: NULL, or a particle would be freed with a mass that spring_scene_check() rejects;
 *         SPRING_ERANGE: there are not that many particles; SPRING_EDISABLED: the scene is not editable
 */
SPRING_API spring_status spring_scene_set_pinned(spring_scene *s, size_t first, size_t count, const uint8_t *pinned);

/**
 * Changes the masses of particles first ... first + count - 1 of an editable scene. The mass of a pinned particle takes
 * effect when the particle is freed. May visit all links.
 *
 * @param[in] mass  [count] [kg]
 * @return SPRING_OK; SPRING_EINVAL: NULL, or a mass that spring_scene_check() rejects; SPRING_ERANGE: there are not
 *         that many particles; SPRING_EDISABLED: the scene is not editable
 */
SPRING_API spring_status spring_scene_set_mass(spring_scene *s, size_t first, size_t count, const double *mass);

/**
 * Sets a pinned particle's velocity so that it reaches `target` after `duration`, in any scene. Link damping sees this
 * velocity. The particle keeps moving at it until it is changed.
 *
 * @param[in] target    [axes] [m]; NULL: the particle stops
 * @param[in] duration  > 0 [s]: that of the next steps, n dt; ignored without a target
 * @return SPRING_OK; SPRING_EINVAL: NULL, a value, distance or velocity that is not finite, or a particle that is not
 *         pinned; SPRING_ERANGE: no such particle
 */
SPRING_API spring_status spring_scene_drive(spring_scene *s, size_t particle, const double *target, double duration);

/** Returns the force along a link [N], including its damping; > 0 pulls. At length 0 no force acts, and the result is
    the force of the stiffness. 0 for slack tension-only links. NaN for invalid input. */
SPRING_API double spring_scene_tension(const spring_scene *s, size_t index);

/** @} */

/** @defgroup scenef The single-precision version
 * @{ */

/** As spring_scene_def, except for the type of the callback. */
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
    /** @} */
} spring_scenef_def;

/** A single-precision scene. */
typedef struct spring_scenef spring_scenef;
/** The energies of a single-precision scene, in double. */
typedef spring_scene_energies spring_scenef_energies;

/** As spring_scene_..., for a single-precision scene.
 * @{ */
SPRING_API spring_status spring_scenef_check(const spring_scenef_def *def, const char **field, size_t *index);
SPRING_API spring_status spring_scenef_bytes(const spring_scenef_def *def, size_t *bytes);
SPRING_API spring_status spring_scenef_init(void *memory, size_t bytes, const spring_scenef_def *def,
                                            spring_scenef **scene);
SPRING_API spring_status spring_scenef_advance(spring_scenef *s, spring_method m, double dt, uint64_t n);
SPRING_API double spring_scenef_stable_step(spring_scenef *s, spring_method m);
SPRING_API spring_status spring_linksf_soften(const spring_scenef_def *def, double dt, double fraction,
                                              spring_link *link);
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
SPRING_API size_t spring_scenef_find_link(const spring_scenef *s, uint32_t a, uint32_t b);
SPRING_API spring_status spring_scenef_set_pinned(spring_scenef *s, size_t first, size_t count, const uint8_t *pinned);
SPRING_API spring_status spring_scenef_set_mass(spring_scenef *s, size_t first, size_t count, const double *mass);
SPRING_API spring_status spring_scenef_drive(spring_scenef *s, size_t particle, const double *target, double duration);
SPRING_API double spring_scenef_tension(const spring_scenef *s, size_t index);
SPRING_API spring_status spring_scenef_set_links(spring_scenef *s, size_t first, size_t count, const spring_link *link);
SPRING_API spring_status spring_scenef_tear(spring_scenef *s, double stretch, const double *limit, uint32_t *torn,
                                            size_t room, size_t *count);
SPRING_API spring_status spring_scenef_transform(spring_scenef *s, const double matrix[12]);
SPRING_API spring_status spring_scenef_set_colliders(spring_scenef *s, const spring_collider *c, uint32_t count);
SPRING_API spring_status spring_scenef_touching(const spring_scenef *s, uint32_t *mask, size_t first, size_t count);
/** @} */

/** @} */

/** @defgroup grids Ropes, sheets, blocks and meshes
 * @{ */

/** @name The springs of a grid
 * @{ */
#define SPRING_GRID_STRUCTURAL UINT32_C(1) /**< structural: to the next particle along each edge */
#define SPRING_GRID_SHEAR      UINT32_C(2) /**< shear: across the faces and through the middle of each cell */
#define SPRING_GRID_BEND       UINT32_C(4) /**< bend: to the particle after the next */
/** @} */

/** The faces of a grid whose particles are pinned: first or last along x, y or z. In a sheet, the first and the last
 * face along z contain all particles.
 * @{ */
#define SPRING_GRID_FIRST_X UINT32_C(1)
#define SPRING_GRID_LAST_X  UINT32_C(2)
#define SPRING_GRID_FIRST_Y UINT32_C(4)
#define SPRING_GRID_LAST_Y  UINT32_C(8)
#define SPRING_GRID_FIRST_Z UINT32_C(16)
#define SPRING_GRID_LAST_Z  UINT32_C(32)
/** @} */

/** A grid of cubes with a particle at each corner. One row of particles is a rope, one layer is a sheet, more layers
 * are a soft body. Particle (i, j, k) has index i + count[0] (j + count[1] k). Zero-initialise.
 *
 * Stretch under gravity g. The stretch of a link is its length over its rest length, minus 1. Under a weight it is
 * weight/(stiffness spacing). With n links below each other and particles of mass m:
 *
 *     rope, or sheet of structural springs, that hangs by an edge
 *         elongation                  m g n (n + 1)/(2 stiffness)
 *         largest stretch of a link   m g n/(stiffness spacing), at the edge
 *
 * A sheet that hangs by two corners, with the weight W of all free particles and q = W/(stiffness spacing):
 *
 *     structural springs only: the row between the corners is a cable that carries the whole sheet
 *         largest stretch of a link   (q^2/24)^(1/3)
 *         depth of this row           (distance of the corners) (3 q/64)^(1/3)
 *     with shear springs
 *         largest stretch of a link   0.30 q, at the corners; with shear and bend springs 0.175 q
 *
 * The formulas for two corners are within 5 % of settled square sheets with 12 to 32 particles along an edge and a
 * stretch of 1 to 4 %, and with shear springs from 8 to 24 particles and 1 % (tests/test_scene_hanging.c). For other scenes,
 * spring-plan --sag finds the stiffness. */
typedef struct spring_grid {
    uint32_t count[3]; /**< particles along x, y, z; 0 means 1 */
    uint32_t axes;     /**< of the positions: 1, 2 or 3; the grid extends along no other axes; 0 means 3 */
    bool height;       /**< height field: axes = 1, across the grid; positions and rest lengths are 0 */
    double spacing;    /**< [m] > 0 from one particle to the next, also in a height field */
    double stretch;    /**< length over rest length of every link > 0; 0 means 1; tension if above 1 */
    uint32_t families; /**< springs, SPRING_GRID_STRUCTURAL | ...; 0 means structural only */
    double stiffness;  /**< [N/m] of every link */
    double damping;    /**< [N s/m] of every link */
    uint32_t pinned;   /**< SPRING_GRID_FIRST_X | ... */
} spring_grid;

/**
 * Computes the number of particles and links of a grid.
 *
 * @return SPRING_OK; SPRING_EINVAL; SPRING_ERANGE: too many for 32-bit indices
 */
SPRING_API spring_status spring_grid_size(const spring_grid *g, size_t *particles, size_t *links);

/**
 * Fills the arrays of a definition, for either precision. The arrays are the caller's, who may change them before use.
 *
 * Links have a < b and are sorted by a. Links with the same a are in the order structural, shear, bend. Shear springs
 * are in the order of the faces xy, xz, yz, then through the cell. Within these groups, links are sorted by b.
 *
 * @param[out] position  [particles*axes], from the origin along the axes
 * @param[out] pinned    [particles]; may be NULL
 * @param[out] link      [links]; may be NULL
 * @return as spring_grid_size(); nothing is written after an error
 */
SPRING_API spring_status spring_grid_fill(const spring_grid *g, double *position, uint8_t *pinned, spring_link *link);

/**
 * Renumbers particles so that linked particles are near each other in memory, and sorts links by their lower, then
 * their upper ends. Use it before a scene of either precision is created from an unsorted mesh.
 *
 * A band is a set of links with a constant index offset between their ends. A scene evaluates bands faster than
 * unbanded links. Ropes get their order back and sheets their rows, which form bands, if the links along rows are at
 * least a fifth shorter than all other links, or if there are no other links. Other meshes get a small bandwidth.
 *
 * The caller permutes other arrays: new_mass[i] = mass[order[i]], new_link_name[i] = link_name[link_order[i]].
 *
 * Time is proportional to particles + links: ten passes over both ends of all links in random order, or fifteen if
 * there are no rows. The result depends only on the arguments.
 *
 * @param[in]     particles   fewer than 2^32 - 1
 * @param[in]     links       fewer than 2^29
 * @param[in,out] link        [links]; a stays a, and b stays b. May be NULL if there are none
 * @param[out]    order       [particles]; order[new index] = old index
 * @param[out]    link_order  [links]; link_order[new index] = old index. May be NULL
 * @param         work        [4*particles + 2*links + 1], used only during the call
 * @return SPRING_OK; SPRING_EINVAL: NULL, or a link from a particle to itself; SPRING_ERANGE: an index of a particle or
 *         a count is too large. Nothing is written after an error
 * @par Source    Cuthill, McKee, Reducing the bandwidth of sparse symmetric matrices (1969), and chains through its
 *                numbering, src/mesh/renumber.c
 */
SPRING_API spring_status spring_links_renumber(size_t particles, size_t links, spring_link *link, uint32_t *order,
                                               uint32_t *link_order, uint32_t *work);

/**
 * Finds the connected components of particles and links, such as the pieces of a torn scene. Links without stiffness and
 * damping do not connect.
 *
 * @param[in]  particles  fewer than 2^32
 * @param[in]  link       [links]; may be NULL if there are none
 * @param[out] component  [particles]; components have the numbers 0, 1, ... in the order of their least particles
 * @return number of components; 0 for invalid input (NULL, an index that is too large, a link from a particle to itself,
 *         negative stiffness or damping, or not finite), where nothing is written
 */
SPRING_API size_t spring_links_components(size_t particles, size_t links, const spring_link *link, uint32_t *component);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
