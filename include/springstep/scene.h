/* SPDX-License-Identifier: MIT */
/** @file
 * springstep: particles joined by springs (rope, cloth, jelly, water), in memory that the caller owns.
 *
 *     mass x'' = link forces + mass gravity - drag x' + F(t, x, x')
 *
 *     static spring_scene_def def;                                      // all zero: everything is off
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
 * What holds for every function here, beside what spring.h says:
 *  - What the definition does not set costs no time and, but for SPRING_SCENE_FORCE_IGNORES_VELOCITY, no memory;
 *    docs/scenes.md says what each feature takes in bytes, docs/performance.md in time.
 *  - All or nothing: after any status but SPRING_OK the scene is as it was (but see SPRING_SCENE_NO_UNDO).
 *  - The scene is at the start of its memory, and holds no pointer to itself: after memcpy() of its bytes to another
 *    place with the same alignment, in the same build, (spring_scene *)place is a working scene. So a snapshot is a
 *    memcpy(), and rolling back another. The callback and its user pointer are copied as they are.
 *  - Distinct scenes may be used by distinct threads at once. One scene may be asked by several at once, by functions
 *    that take a const scene, as long as none changes it.
 *  - The same bits with every compiler, instruction set and vector length, as far as the callback does its part.
 *  - There is no position solver: for a contact, move particles between calls of spring_scene_advance(..., 1) with
 *    spring_scene_get() and spring_scene_set(), or push them in the callback.
 *
 * spring_scenef_... is the float twin, from the same source: state and arithmetic in float, half the memory, most of
 * twice the speed. Definitions, times, energies and spring_scenef_get() stay in double; only its callback sees floats.
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

#define SPRING_SCENE_ALIGN 64 /**< of the memory of a scene [bytes] */

/** A spring between two particles. On one axis it is linear, pulling a with stiffness ((x_b - x_a) - rest) + damping
   (v_b - v_a); on more it pulls both ends along the line between them with stiffness (length - rest) + damping (rate of
   length). Where both ends are at the same place that line has no direction, and there is no force; nor is there
   a sensible one where the square of the length underflows, below some 1e-160 m, in float 1e-21 m. */
typedef struct spring_link {
    uint32_t a;       /**<         index of a particle */
    uint32_t b;       /**<         index of another */
    double rest;      /**< [m]     length at which it does not pull >= 0 */
    double stiffness; /**< [N/m]   >= 0 */
    double damping;   /**< [N s/m] >= 0, along the link */
} spring_link;

/** Adds forces to force[axis][particle] [N]. Called once for each force evaluation with the time t [s] of the positions
   [m] and velocities [m/s]. Arrays of axes that the scene does not have are NULL. All positions and velocities are
   finite. With SPRING_SCENE_FORCE_IGNORES_VELOCITY the contents of the velocity arrays are unspecified: do not read them.
   The callback must depend on nothing but its arguments and *user, or advance(10)
   is not 10 times advance(1). It must not call a function on its own scene. After a change of what *user holds, call
   spring_scene_set_force() again, because a force may have been kept (SPRING_SCENE_FORCE_IGNORES_VELOCITY). If the force
   on a free particle is not finite, the call fails with SPRING_ENONFINITE. RKN8 keeps the last force of a call, so there
   the next call fails. Forces on pinned particles are ignored. */
typedef void spring_scene_force_fn(void *user, double t, size_t particles, const double *const position[3],
                                   const double *const velocity[3], double *const force[3]);
/** The same for a scene in float. */
typedef void spring_scenef_force_fn(void *user, double t, size_t particles, const float *const position[3],
                                    const float *const velocity[3], float *const force[3]);

/** spring_scene_set_link(), _set_pinned() and _set_mass() are allowed. Each link and each particle has numbers of its own,
   equal to others or not. */
#define SPRING_SCENE_EDITABLE UINT32_C(1)

/** No second copy of the state. An advance that fails in a step loses it: positions and velocities are NaN then, and no step
   succeeds until spring_scene_set() has set all of them. */
#define SPRING_SCENE_NO_UNDO UINT32_C(2)

/** No callback uses velocities, or there is none and none is going to be set. (What it is shown as velocities may be
   other numbers then.) Leapfrog keeps the force at the end of a step for the next then, which halves its work; and it
   needs no memory for a prediction where no link is damped or can be changed. */
#define SPRING_SCENE_FORCE_IGNORES_VELOCITY UINT32_C(4)

/** Zero-initialise what is not modelled. Every array is copied. */
typedef struct spring_scene_def {
    uint32_t axes;                /**< 1, 2 or 3; 0 means 3 */
    uint32_t flags;               /**< SPRING_SCENE_... */
    uint32_t methods;             /**< 1u << SPRING_EULER | ...: which will be used; 0: all but RK4, RKN8 */
    size_t particles;             /**< from 1 to nearly 2^32; where addresses have 32 bits, at most 2^23 - 1 */
    size_t links;                 /**< less than 2^29; likewise */
    const double *position;       /**< [particles*axes] x0 y0 z0 x1 ... [m] */
    const double *velocity;       /**< [particles*axes] [m/s]; NULL: at rest */
    const double *mass;           /**< [particles] [kg] > 0 unless pinned; NULL: mass_all for every one */
    double mass_all;              /**< [kg]; 0 means 1 */
    const uint8_t *pinned;        /**< [particles]; non-zero: feels no force, keeps its velocity; NULL: none */
    const spring_link *link;      /**< [links]; best in the order of their particles, see docs/scenes.md */
    double gravity[3];            /**< [m/s^2]; elements beyond the axes are ignored */
    double drag;                  /**< [N s/m] >= 0, on every particle */
    spring_scene_force_fn *force; /**< NULL: none */
    void *user;                   /**< handed to force */
} spring_scene_def;

/** A scene, in memory that the caller owns. */
typedef struct spring_scene spring_scene;

/**
 * Is a definition valid?
 *
 * @param[out] field  name of the first field that is not, such as "mass" or "link.a"; NULL if all are. May be NULL
 * @param[out] index  of the particle or link, of gravity the axis, else 0. May be NULL
 * @return SPRING_OK; SPRING_EINVAL: also where a mass or its reciprocal, 2 stiffness/mass, 2 damping/mass or drag/mass
 *         is not finite in the precision of the scene; SPRING_ERANGE: an index of a particle is too large, or a count;
 *         SPRING_EUNSUPPORTED: among the methods the exact solution, or RKN8 where a link is damped or the callback may
 *         use velocities
 */
SPRING_API spring_status spring_scene_check(const spring_scene_def *def, const char **field, size_t *index);

/**
 * The memory that a scene takes [bytes], a multiple of SPRING_SCENE_ALIGN.
 *
 * @return as spring_scene_check()
 */
SPRING_API spring_status spring_scene_bytes(const spring_scene_def *def, size_t *bytes);

/**
 * Make a scene in the memory given. Time is 0.
 *
 * @param[out] memory  aligned to SPRING_SCENE_ALIGN
 * @param[in]  bytes   of memory, at least what spring_scene_bytes() says
 * @param[out] scene   the scene; NULL after an error. There is nothing to release but the memory
 * @return SPRING_OK; SPRING_ENOMEM; SPRING_EALIGN; and as spring_scene_check()
 */
SPRING_API spring_status spring_scene_init(void *memory, size_t bytes, const spring_scene_def *def,
                                           spring_scene **scene);

/** @} */

/** @defgroup scene_steps Steps, and what to ask
 * @{ */

/**
 * Advance a scene by n steps.
 *
 *     Euler             x1 = x + dt v;   v1 = v + dt a(t, x, v)
 *     symplectic Euler  v1 = v + dt a(t, x, v);   x1 = x + dt v1
 *     leapfrog          v' = v + dt/2 a(t, x, v);   x1 = x + dt v';   v1 = v' + dt/2 a(t + dt, x1, v1)
 *     RK4               the four stages
 *     RKN8              X_i = x + c_i dt v + dt^2 sum a_ij A_j,   A_i = a(t + c_i dt, X_i),   i = 1 ... 8
 *                       x1 = x + dt v + dt^2 sum b_j A_j,   v1 = v + dt sum b'_j A_j
 *
 * Drag is solved for in the kick of symplectic Euler and in the last half kick of leapfrog. Velocities that enter link
 * damping and callbacks in that half kick are predicted, v* = v' + dt/2 a*, v1 = v' + dt/2 a(x1, v*), with a* the
 * acceleration by the forces of the first half kick and the drag at v*, solved for: still of second order.
 *
 * RKN8, of order 8, is for links without damping and callbacks that promise not to use velocities; they are shown those
 * at the start of the step. Drag goes into y = e^(drag t/2 mass) (x - x0), to which the method is applied: the order stays 8
 * (drag alone, at dt drag/mass = 1: 3e-11 of the way, at 4: 2e-6). Forces have to be smooth: a contact, or a push that sets in suddenly, leaves a low order. Not symplectic: at dt sqrt(L) = 0.4
 * an oscillator loses 6e-11 of its energy a period.
 *
 * Force evaluations a step: both Eulers one, RK4 four, RKN8 eight, leapfrog one. The force at the end of a step of
 * leapfrog or RKN8 is that at the start of the next, and is kept. Leapfrog's with damped links is the one at v*: it is
 * part of the state then, is copied with a snapshot, and is found afresh, at v, by one evaluation more, after
 * spring_scene_set(), a change of a link, of pins, masses, the callback or the velocity of a driven particle, or steps of
 * another method. What a callback finds may change between steps, so with one that may use velocities leapfrog keeps
 * nothing and evaluates twice, see SPRING_SCENE_FORCE_IGNORES_VELOCITY.
 *
 * Step i of a run of calls with the same dt is at t0 + i dt: time is not accumulated.
 *
 * @param[in] m   one of the methods of the definition
 * @param[in] dt  finite step [s]; negative runs backwards, where leapfrog with drag has a pole at dt = -2 mass/drag,
 *                symplectic Euler at half of it; 0, or in float what rounds to 0, does nothing
 * @return SPRING_OK; SPRING_EINVAL; SPRING_EDISABLED: a method that the definition does not have; SPRING_EUNSUPPORTED: the
 *         exact solution, or RKN8 where forces use velocities by now; SPRING_ENONFINITE: the state or the time would
 *         become infinite or NaN, noticed at the step where it does
 * @par Source    Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), section I.1; Hairer, Norsett, Wanner,
 *                Solving Ordinary Differential Equations I (1993), section II.1; Dormand, El-Mikkawy, Prince, High-order
 *                embedded Runge-Kutta-Nystrom formulae, IMA J. Numer. Anal. 7 (1987)
 */
SPRING_API spring_status spring_scene_advance(spring_scene *s, spring_method m, double dt, uint64_t n);

/**
 * A stable step, from the stiffness of the links: below it the method makes no motion about rest grow, as long as no
 * link is compressed below half its rest length.
 *
 * With L the largest sum of (2/mass) stiffness over the links of a particle (1/mass where the other end is pinned), and
 * G the same of damping, plus drag/mass: leapfrog 2/sqrt(L), with link damping 2/(G + sqrt(G^2 + L)); RK4
 * 2.61/max(sqrt(L), G); RKN8 min(3.14/sqrt(L), 40/G); Euler 0 without drag, and min(drag/K, 2/G) with it, K the largest
 * sum of 2 stiffness; symplectic Euler 4/(p + sqrt(p^2 + 4 L)), p = (the largest sum for links alone) - drag/(largest
 * mass).
 * A bound: without link damping the limit itself is 1.2 to 1.3 times larger on a height field, 1.5 to 1.8 times on
 * cloth, twice on jelly; with heavy damping it may be several times larger. Links that spin or swing far can gain
 * energy from the step by resonance closer to it: take half, and less where a link turns faster than it would swing.
 * The callback is not looked at.
 *
 * @return [s]; 0: none is known; INFINITY: no links or drag to be unstable with; NaN for bad input or the
 *         exact solution
 * @par Source    Gershgorin's circles; tests/test_scene_limits.c measures how far the limit is away
 */
SPRING_API double spring_scene_stable_step(spring_scene *s, spring_method m);

/** [s] since init; NaN for NULL. */
SPRING_API double spring_scene_time(const spring_scene *s);

/** The energies of a scene. */
typedef struct spring_scene_energies {
    double kinetic; /**< [J] of particles that are not pinned */
    double elastic; /**< [J] of all links */
    double gravity; /**< [J] of particles that are not pinned; 0 at the origin */
} spring_scene_energies;

/** Energies of the links and of the particles that are not pinned; gravity is 0 at the origin. NaN for NULL. */
SPRING_API spring_scene_energies spring_scene_energy(const spring_scene *s);

/** Is every speed at most v_tol [m/s], and every acceleration of a particle that is not pinned at most a_tol [m/s^2]?
    May evaluate the forces. False for bad input. */
SPRING_API bool spring_scene_at_rest(spring_scene *s, double v_tol, double a_tol);

/** @} */

/** @defgroup scene_state State and changes
 * @{ */

/** What spring_scene_get() and spring_scene_set() copy. */
typedef enum spring_quantity {
    SPRING_POSITION, /**< [m] */
    SPRING_VELOCITY  /**< [m/s] */
} spring_quantity;

/**
 * Copy the state of particles first ... first + count - 1 out of a scene, and into one.
 *
 * spring_scene_getf() fills a float vertex buffer, which may hold other things between the positions. To move a pin use
 * spring_scene_drive(): where its position is set it jumps, and link damping sees none of it.
 *
 * @param[in] stride  elements from one particle to the next >= axes; 0 means axes
 * @return SPRING_OK; SPRING_EINVAL: NULL, unknown quantity, stride below axes, a number to be set that is not finite;
 *         SPRING_ERANGE: there are not so many particles
 * @{
 */
SPRING_API spring_status spring_scene_get(const spring_scene *s, spring_quantity q, double *out, size_t stride,
                                          size_t first, size_t count);
SPRING_API spring_status spring_scene_getf(const spring_scene *s, spring_quantity q, float *out, size_t stride,
                                           size_t first, size_t count);
SPRING_API spring_status spring_scene_set(spring_scene *s, spring_quantity q, const double *in, size_t stride,
                                          size_t first, size_t count);
/** @} */

/** Change gravity [m/s^2]; elements beyond the axes are ignored. SPRING_EINVAL for NULL or numbers that are not
   finite. */
SPRING_API spring_status spring_scene_set_gravity(spring_scene *s, const double gravity[3]);

/** Change the callback; NULL: none. */
SPRING_API spring_status spring_scene_set_force(spring_scene *s, spring_scene_force_fn *force, void *user);

/**
 * Change a link of an editable scene; stiffness 0 and damping 0 cut it.
 *
 * @param[in] link  a and b as defined; swapped they mean the same, but on one axis, where that turns the link
 * @return SPRING_OK; SPRING_EINVAL; SPRING_ERANGE: no such link; SPRING_EDISABLED: the scene is not editable
 */
SPRING_API spring_status spring_scene_set_link(spring_scene *s, size_t index, const spring_link *link);

/**
 * A link as it is now, in the precision of the scene; of more than one axis a and b may be swapped.
 *
 * @return SPRING_OK; SPRING_EINVAL: NULL; SPRING_ERANGE: no such link
 */
SPRING_API spring_status spring_scene_get_link(const spring_scene *s, size_t index, spring_link *link);

/** The least index of a link between two particles, in either order, cut ones included; SIZE_MAX if there is none, and
    for NULL. Looks at all links. */
SPRING_API size_t spring_scene_find_link(const spring_scene *s, uint32_t a, uint32_t b);

/**
 * Pin particles first ... first + count - 1 of an editable scene, and free them: to grab one, pin it and drive it; to let
 * it go, free it, and it flies on.
 *
 * A particle that was free stops where it is, one that was pinned keeps its velocity, and what does not change is left
 * alone. A freed one has the mass last set, or that of the definition: mass[i] if it is positive, else mass_all. May look
 * at all links.
 *
 * @param[in] pinned  [count]; non-zero: pinned
 * @return SPRING_OK; SPRING_EINVAL: NULL, or one that would be freed has no mass that the scene could have been defined
 *         with; SPRING_ERANGE: there are not so many particles; SPRING_EDISABLED: the scene is not editable
 */
SPRING_API spring_status spring_scene_set_pinned(spring_scene *s, size_t first, size_t count, const uint8_t *pinned);

/**
 * Change the masses of particles first ... first + count - 1 of an editable scene; of a pinned one, what it will have when
 * it is freed. May look at all links.
 *
 * @param[in] mass  [count] [kg]
 * @return SPRING_OK; SPRING_EINVAL: NULL, or a mass that the scene could not have been defined with; SPRING_ERANGE: there
 *         are not so many particles; SPRING_EDISABLED: the scene is not editable
 */
SPRING_API spring_status spring_scene_set_mass(spring_scene *s, size_t first, size_t count, const double *mass);

/**
 * Give a pinned particle the velocity that brings it to a target, which the links see; beyond, it moves on. Any scene.
 *
 * @param[in] target    [axes] [m]; NULL: it stops
 * @param[in] duration  > 0 [s]: of the steps about to be taken, n dt; not used without a target
 * @return SPRING_OK; SPRING_EINVAL: NULL, numbers that are not finite, a distance or a velocity that is not, or a particle
 *         that is not pinned; SPRING_ERANGE: no such particle
 */
SPRING_API spring_status spring_scene_drive(spring_scene *s, size_t particle, const double *target, double duration);

/** The force along a link [N], > 0 pulls; its damping included. At length 0, where no force acts, that of its
    stiffness. NaN for bad input. */
SPRING_API double spring_scene_tension(const spring_scene *s, size_t index);

/** @} */

/** @defgroup scenef The float twin
 * @{ */

/** spring_scene_def, but for the callback. */
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
    /** @} */
} spring_scenef_def;

/** A scene in float. */
typedef struct spring_scenef spring_scenef;
/** Its energies, in double. */
typedef spring_scene_energies spring_scenef_energies;

/** As spring_scene_..., for a scene in float.
 * @{ */
SPRING_API spring_status spring_scenef_check(const spring_scenef_def *def, const char **field, size_t *index);
SPRING_API spring_status spring_scenef_bytes(const spring_scenef_def *def, size_t *bytes);
SPRING_API spring_status spring_scenef_init(void *memory, size_t bytes, const spring_scenef_def *def,
                                            spring_scenef **scene);
SPRING_API spring_status spring_scenef_advance(spring_scenef *s, spring_method m, double dt, uint64_t n);
SPRING_API double spring_scenef_stable_step(spring_scenef *s, spring_method m);
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
/** @} */

/** @} */

/** @defgroup grids Ropes, sheets and blocks
 * @{ */

/** @name The links of a grid
 * @{ */
#define SPRING_GRID_STRUCTURAL UINT32_C(1) /**< to the next particle along each edge */
#define SPRING_GRID_SHEAR      UINT32_C(2) /**< across the faces and through the middle of each cell */
#define SPRING_GRID_BEND       UINT32_C(4) /**< to the particle after the next */
/** @} */

/** The faces of a grid whose particles are pinned: first or last along x, y, z; of a sheet first and last along z are all of
 * it.
 * @{ */
#define SPRING_GRID_FIRST_X UINT32_C(1)
#define SPRING_GRID_LAST_X  UINT32_C(2)
#define SPRING_GRID_FIRST_Y UINT32_C(4)
#define SPRING_GRID_LAST_Y  UINT32_C(8)
#define SPRING_GRID_FIRST_Z UINT32_C(16)
#define SPRING_GRID_LAST_Z  UINT32_C(32)
/** @} */

/** Particles at the corners of a grid of cubes: one row of them is a rope, a layer a sheet, more a block of jelly.
   Particle (i, j, k) has index i + count[0] (j + count[1] k). Zero-initialise. */
typedef struct spring_grid {
    uint32_t count[3]; /**< particles along x, y, z; 0 means 1 */
    uint32_t axes;     /**< of the positions: 1, 2 or 3, as many as the grid has directions; 0 means 3 */
    bool height;       /**< a height field: axes = 1, across the grid; positions and rest lengths are 0 */
    double spacing;    /**< [m] > 0 from one particle to the next, of a height field too */
    double stretch;    /**< length over rest length of every link > 0; 0 means 1; above 1 is tension */
    uint32_t families; /**< SPRING_GRID_STRUCTURAL | ...; 0 means structural alone */
    double stiffness;  /**< [N/m] of every link */
    double damping;    /**< [N s/m] */
    uint32_t pinned;   /**< SPRING_GRID_FIRST_X | ... */
} spring_grid;

/**
 * How many particles and links a grid has.
 *
 * @return SPRING_OK; SPRING_EINVAL; SPRING_ERANGE: too many for 32-bit indices
 */
SPRING_API spring_status spring_grid_size(const spring_grid *g, size_t *particles, size_t *links);

/**
 * Fill the arrays of a definition, of either precision. They are the caller's, and may be changed before they are used.
 *
 * The links have a < b, and are sorted by a; those of one a are in the order structural, shear, bend; of these, shear
 * across faces xy, xz, yz, then through the cell; and of these by b.
 *
 * @param[out] position  [particles*axes], from the origin along the axes
 * @param[out] pinned    [particles]; may be NULL
 * @param[out] link      [links]; may be NULL
 * @return as spring_grid_size(); nothing is written after an error
 */
SPRING_API spring_status spring_grid_fill(const spring_grid *g, double *position, uint8_t *pinned, spring_link *link);

/**
 * Number particles so that those are near each other in memory which are joined, and sort links by their lower, then
 * their upper ends: before a scene is made, in either precision, of what is in no order. Ropes get back their order and
 * sheets their rows, which make bands, if the links along rows are the shortest (by a fifth) or all; other meshes get a
 * small bandwidth.
 *
 * The caller permutes his own arrays: new_mass[i] = mass[order[i]], new_link_name[i] = link_name[link_order[i]].
 *
 * Time is proportional to particles + links: ten passes over both ends of all links in random order, fifteen where
 * there are no rows to be found. What is done depends on nothing but the arguments.
 *
 * @param[in]     particles   fewer than 2^32 - 1
 * @param[in]     links       fewer than 2^29
 * @param[in,out] link        [links]; a stays a, and b stays b. May be NULL if there are none
 * @param[out]    order       [particles]; order[new index] = old index
 * @param[out]    link_order  [links]; link_order[new index] = old index. May be NULL
 * @param         work        [4*particles + 2*links + 1], not to be kept
 * @return SPRING_OK; SPRING_EINVAL: NULL, or a link from a particle to itself; SPRING_ERANGE: an index of a particle is
 *         too large, or a count. Nothing is written after an error
 * @par Source    Cuthill, McKee, Reducing the bandwidth of sparse symmetric matrices (1969), and chains through its
 *                numbering, src/mesh/renumber.c
 */
SPRING_API spring_status spring_links_renumber(size_t particles, size_t links, spring_link *link, uint32_t *order,
                                               uint32_t *link_order, uint32_t *work);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
