/* SPDX-License-Identifier: MIT */
/* The binary interface for compiled programs and bindings: sizes of public structures, offsets of their fields, for
   64-bit and 32-bit addresses, and values. If a line here changes, the soversion must change, unless the line has not
   been released. Compiled for every target of the tests. */
#include <stddef.h>

#include <springstep/batch.h>
#include <springstep/clock.h>
#include <springstep/scene.h>
#include <springstep/spring.h>

struct natural {
    char before;
    double number;
};

/* Where a double in a structure lies at a multiple of 4, as on 32-bit x86 except for Windows, offsets are others. */
enum { WIDE = sizeof(void *) == 8, NATURAL = offsetof(struct natural, number) == 8 };

#define EXPECT(what, wide, narrow)    _Static_assert(!NATURAL || (what) == (WIDE ? (wide) : (narrow)), #what)
#define SIZE(type, wide, narrow)      EXPECT(sizeof(type), wide, narrow)
#define AT(type, field, wide, narrow) EXPECT(offsetof(type, field), wide, narrow)

extern int spring_layout; /* C forbids an empty unit */

SIZE(spring_state, 16, 16);
AT(spring_state, x, 0, 0);
AT(spring_state, v, 8, 8);

SIZE(spring_params, 32, 32);
AT(spring_params, mass, 0, 0);
AT(spring_params, stiffness, 8, 8);
AT(spring_params, damping, 16, 16);
AT(spring_params, load, 24, 24);

SIZE(spring_method_info, 40, 24);
AT(spring_method_info, name, 0, 0);
AT(spring_method_info, order, 8, 4);
AT(spring_method_info, forces_per_step, 12, 8);
AT(spring_method_info, symplectic, 16, 12);
AT(spring_method_info, springs, 17, 13);
AT(spring_method_info, scenes, 18, 14);
AT(spring_method_info, label, 24, 16);
AT(spring_method_info, positions_only, 32, 20);

SIZE(spring_batch, 56, 28);
AT(spring_batch, count, 0, 0);
AT(spring_batch, x, 8, 4);
AT(spring_batch, v, 16, 8);
AT(spring_batch, omega2, 24, 12);
AT(spring_batch, gamma, 32, 16);
AT(spring_batch, accel, 40, 20);
AT(spring_batch, shared, 48, 24);

SIZE(spring_batchf, 56, 28);
AT(spring_batchf, count, 0, 0);
AT(spring_batchf, x, 8, 4);
AT(spring_batchf, v, 16, 8);
AT(spring_batchf, omega2, 24, 12);
AT(spring_batchf, gamma, 32, 16);
AT(spring_batchf, accel, 40, 20);
AT(spring_batchf, shared, 48, 24);

SIZE(spring_link, 40, 40);
AT(spring_link, a, 0, 0);
AT(spring_link, b, 4, 4);
AT(spring_link, rest, 8, 8);
AT(spring_link, stiffness, 16, 16);
AT(spring_link, damping, 24, 24);
AT(spring_link, flags, 32, 32);

SIZE(spring_weighted_link, 72, 72);
AT(spring_weighted_link, particle, 0, 0);
AT(spring_weighted_link, weight, 16, 16);
AT(spring_weighted_link, rest, 48, 48);
AT(spring_weighted_link, stiffness, 56, 56);
AT(spring_weighted_link, damping, 64, 64);

SIZE(spring_collider, 360, 352);
AT(spring_collider, shape, 0, 0);
AT(spring_collider, at, 8, 8);
AT(spring_collider, to, 32, 32);
AT(spring_collider, axis, 56, 56);
AT(spring_collider, half, 128, 128);
AT(spring_collider, radius, 152, 152);
AT(spring_collider, velocity, 160, 160);
AT(spring_collider, velocity_to, 184, 184);
AT(spring_collider, spin, 208, 208);
AT(spring_collider, friction, 232, 232);
AT(spring_collider, restitution, 240, 240);
AT(spring_collider, acceleration, 248, 248);
AT(spring_collider, spin_acceleration, 272, 272);
AT(spring_collider, surface, 296, 296);
AT(spring_collider, mask, 320, 320);
AT(spring_collider, gap, 328, 324);
AT(spring_collider, user, 336, 328);
AT(spring_collider, thickness, 344, 336);
AT(spring_collider, bound, 352, 344);

SIZE(spring_impulse, 48, 48);
AT(spring_impulse, linear, 0, 0);
AT(spring_impulse, angular, 24, 24);

SIZE(spring_scene_def, 192, 136);
AT(spring_scene_def, axes, 0, 0);
AT(spring_scene_def, flags, 4, 4);
AT(spring_scene_def, methods, 8, 8);
AT(spring_scene_def, particles, 16, 12);
AT(spring_scene_def, links, 24, 16);
AT(spring_scene_def, position, 32, 20);
AT(spring_scene_def, velocity, 40, 24);
AT(spring_scene_def, mass, 48, 28);
AT(spring_scene_def, mass_all, 56, 32);
AT(spring_scene_def, pinned, 64, 40);
AT(spring_scene_def, link, 72, 44);
AT(spring_scene_def, gravity, 80, 48);
AT(spring_scene_def, drag, 104, 72);
AT(spring_scene_def, force, 112, 80);
AT(spring_scene_def, user, 120, 84);
AT(spring_scene_def, max_speed, 128, 88);
AT(spring_scene_def, colliders, 136, 96);
AT(spring_scene_def, particle_radius, 144, 104);
AT(spring_scene_def, weighted_links, 152, 112);
AT(spring_scene_def, weighted_link, 160, 116);
AT(spring_scene_def, radius, 168, 120);
AT(spring_scene_def, friction, 176, 124);
AT(spring_scene_def, mask, 184, 128);

SIZE(spring_scene_energies, 24, 24);
AT(spring_scene_energies, kinetic, 0, 0);
AT(spring_scene_energies, elastic, 8, 8);
AT(spring_scene_energies, gravity, 16, 16);

SIZE(spring_scene_info, 40, 28);
AT(spring_scene_info, particles, 0, 0);
AT(spring_scene_info, links, 8, 4);
AT(spring_scene_info, weighted_links, 16, 8);
AT(spring_scene_info, axes, 24, 12);
AT(spring_scene_info, flags, 28, 16);
AT(spring_scene_info, methods, 32, 20);
AT(spring_scene_info, colliders, 36, 24);

SIZE(spring_scenef_def, 192, 136);
AT(spring_scenef_def, axes, 0, 0);
AT(spring_scenef_def, flags, 4, 4);
AT(spring_scenef_def, methods, 8, 8);
AT(spring_scenef_def, particles, 16, 12);
AT(spring_scenef_def, links, 24, 16);
AT(spring_scenef_def, position, 32, 20);
AT(spring_scenef_def, velocity, 40, 24);
AT(spring_scenef_def, mass, 48, 28);
AT(spring_scenef_def, mass_all, 56, 32);
AT(spring_scenef_def, pinned, 64, 40);
AT(spring_scenef_def, link, 72, 44);
AT(spring_scenef_def, gravity, 80, 48);
AT(spring_scenef_def, drag, 104, 72);
AT(spring_scenef_def, force, 112, 80);
AT(spring_scenef_def, user, 120, 84);
AT(spring_scenef_def, max_speed, 128, 88);
AT(spring_scenef_def, colliders, 136, 96);
AT(spring_scenef_def, particle_radius, 144, 104);
AT(spring_scenef_def, weighted_links, 152, 112);
AT(spring_scenef_def, weighted_link, 160, 116);
AT(spring_scenef_def, radius, 168, 120);
AT(spring_scenef_def, friction, 176, 124);
AT(spring_scenef_def, mask, 184, 128);

SIZE(spring_grid, 72, 72);
AT(spring_grid, count, 0, 0);
AT(spring_grid, axes, 12, 12);
AT(spring_grid, height, 16, 16);
AT(spring_grid, spacing, 24, 24);
AT(spring_grid, stretch, 32, 32);
AT(spring_grid, families, 40, 40);
AT(spring_grid, stiffness, 48, 48);
AT(spring_grid, damping, 56, 56);
AT(spring_grid, pinned, 64, 64);

SIZE(spring_clock, 24, 24);
AT(spring_clock, pending, 0, 0);
AT(spring_clock, dropped, 8, 8);
AT(spring_clock, skipped, 16, 16);

/* An int, as most languages take an enumeration for. */
SIZE(spring_method, 4, 4);
SIZE(spring_status, 4, 4);
SIZE(spring_quantity, 4, 4);
SIZE(spring_shape, 4, 4);

#define VALUE(name, value) _Static_assert((name) == (value), #name)

VALUE(SPRING_EULER, 0);
VALUE(SPRING_LEAPFROG, 1);
VALUE(SPRING_RK4, 2);
VALUE(SPRING_EXACT, 3);
VALUE(SPRING_SYMPLECTIC_EULER, 4);
VALUE(SPRING_RKN8, 5);
VALUE(SPRING_SRKN6, 6);
#if SPRING_METHOD_COUNT < 7
#error "the number of methods only grows, and the preprocessor can compare it"
#endif

VALUE(SPRING_OK, 0);
VALUE(SPRING_EINVAL, 1);
VALUE(SPRING_ENONFINITE, 2);
VALUE(SPRING_ENOMEM, 3);
VALUE(SPRING_EALIGN, 4);
VALUE(SPRING_ERANGE, 5);
VALUE(SPRING_EUNSUPPORTED, 6);
VALUE(SPRING_EDISABLED, 7);
VALUE(SPRING_EROUNDING, 8);
VALUE(SPRING_EFLUSHED, 9);
VALUE(SPRING_EFUSED, 10);
VALUE(SPRING_EBITS, 11);
VALUE(SPRING_EUNSTABLE, 12);
VALUE(SPRING_EPARTIAL, 13);
VALUE(SPRING_EMISMATCH, 14);

VALUE(SPRING_POSITION, 0);
VALUE(SPRING_VELOCITY, 1);
VALUE(SPRING_FORCE, 2);

VALUE(SPRING_PLANE, 0);
VALUE(SPRING_SPHERE, 1);
VALUE(SPRING_CAPSULE, 2);
VALUE(SPRING_BOX, 3);
VALUE(SPRING_CUSTOM, 4);

VALUE(SPRING_CHECK_INTERVAL, 4096);

VALUE(SPRING_SHARED_OMEGA2, 1);
VALUE(SPRING_SHARED_GAMMA, 2);
VALUE(SPRING_SHARED_ACCEL, 4);

VALUE(SPRING_SCENE_ALIGN, 64);

VALUE(SPRING_SCENE_EDITABLE, 1);
VALUE(SPRING_SCENE_NO_UNDO, 2);
VALUE(SPRING_SCENE_FORCE_IGNORES_VELOCITY, 4);
VALUE(SPRING_SCENE_TENSION_ONLY, 8);
VALUE(SPRING_SCENE_FORCES, 16);

VALUE(SPRING_LINK_TENSION_ONLY, 1);
VALUE(SPRING_LINK_TETHER, 2);

VALUE(SPRING_GRID_STRUCTURAL, 1);
VALUE(SPRING_GRID_SHEAR, 2);
VALUE(SPRING_GRID_BEND, 4);
VALUE(SPRING_BEND_ROWS, 1);
VALUE(SPRING_BEND_DIAGONALS, 2);

VALUE(SPRING_GRID_FIRST_X, 1);
VALUE(SPRING_GRID_LAST_X, 2);
VALUE(SPRING_GRID_FIRST_Y, 4);
VALUE(SPRING_GRID_LAST_Y, 8);
VALUE(SPRING_GRID_FIRST_Z, 16);
VALUE(SPRING_GRID_LAST_Z, 32);
