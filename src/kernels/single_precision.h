/* SPDX-License-Identifier: MIT */
/* Batches and scenes are written for double. With SPRING_FLOAT, these names turn the same source into the
   single-precision version. Functions on definitions are compiled once: see scene/definition.h. */
#ifndef SPRINGSTEP_SINGLE_PRECISION_H
#define SPRINGSTEP_SINGLE_PRECISION_H

#include <springstep/batch.h>
#include <springstep/scene.h>

#ifdef SPRING_FLOAT
typedef spring_scenef_def public_scene_def;

#define spring_batch                spring_batchf
#define spring_batch_advance        spring_batchf_advance
#define spring_batch_advance_with   spring_batchf_advance_with
#define spring_batch_advance_marked spring_batchf_advance_marked
#define spring_batch_follow         spring_batchf_follow
#define spring_batch_follow_moving  spring_batchf_follow_moving
#define spring_batch_follow_with    spring_batchf_follow_with
#define spring_batch_stable_step    spring_batchf_stable_step
#define spring_batch_v128           spring_batchf_v128
#define spring_batch_v256           spring_batchf_v256
#define spring_batch_v512           spring_batchf_v512

#define spring_scene                    spring_scenef
#define spring_scene_add_weighted       spring_scenef_add_weighted
#define spring_scene_weighted_vector    spring_scenef_weighted_vector
#define spring_scene_set_weighted_links spring_scenef_set_weighted_links
#define spring_scene_get_weighted_link  spring_scenef_get_weighted_link
#define spring_scene_advance            spring_scenef_advance
#define spring_scene_advance_with       spring_scenef_advance_with
#define spring_scene_at_rest            spring_scenef_at_rest
#define spring_scene_bytes              spring_scenef_bytes
#define spring_scene_check              spring_scenef_check
#define spring_scene_check_colliders    spring_scenef_check_colliders
#define spring_scene_drive              spring_scenef_drive
#define spring_scene_energy             spring_scenef_energy
#define spring_scene_find_bounds        spring_scenef_find_bounds
#define spring_scene_find_roots         spring_scenef_find_roots
#define spring_scene_find_link          spring_scenef_find_link
#define spring_scene_force_fn           spring_scenef_force_fn
#define spring_scene_get                spring_scenef_get
#define spring_scene_getf               spring_scenef_getf
#define spring_scene_get_link           spring_scenef_get_link
#define spring_scene_get_colliders      spring_scenef_get_colliders
#define spring_scene_init               spring_scenef_init
#define spring_scene_steppers           spring_scenef_steppers
#define spring_scene_set                spring_scenef_set
#define spring_scene_set_force          spring_scenef_set_force
#define spring_scene_set_gravity        spring_scenef_set_gravity
#define spring_scene_set_link           spring_scenef_set_link
#define spring_scene_set_mass           spring_scenef_set_mass
#define spring_scene_set_pinned         spring_scenef_set_pinned
#define spring_scene_stable_step        spring_scenef_stable_step
#define spring_scene_tension            spring_scenef_tension
#define spring_scene_time               spring_scenef_time
#define spring_links_soften             spring_linksf_soften
#define spring_links_tethers            spring_linksf_tethers
#define spring_scene_v128               spring_scenef_v128
#define spring_scene_v256               spring_scenef_v256
#define spring_scene_v512               spring_scenef_v512
#define spring_common_v128              spring_commonf_v128
#define spring_common_v256              spring_commonf_v256
#define spring_scene_set_links          spring_scenef_set_links
#define spring_scene_tear               spring_scenef_tear
#define spring_scene_tear_with          spring_scenef_tear_with
#define spring_scene_transform          spring_scenef_transform
#define spring_scene_set_colliders      spring_scenef_set_colliders
#define spring_scene_touching           spring_scenef_touching
#define spring_scene_place_colliders    spring_scenef_place_colliders
#define spring_scene_balanced           spring_scenef_balanced
#define spring_scene_begin_impulses     spring_scenef_begin_impulses
#define spring_scene_end_impulses       spring_scenef_end_impulses
#define spring_scene_impulses           spring_scenef_impulses
#define spring_scene_describe           spring_scenef_describe
#define spring_scene_load               spring_scenef_load
#define spring_scene_save               spring_scenef_save
#define spring_scene_set_time           spring_scenef_set_time
#else
typedef spring_scene_def public_scene_def;
#endif

#endif
