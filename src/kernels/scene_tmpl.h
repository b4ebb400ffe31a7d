/* SPDX-License-Identifier: MIT */
/* The kernels of scenes for one vector width (SPRING_VECTOR bytes) and one precision (double, or float with
   SPRING_FLOAT), and their tables SPRING_SCENE_TABLE and SPRING_COMMON_TABLE. Included by the sources scene*.c of this
   folder. */
#ifndef SPRINGSTEP_SCENE_TMPL_H
#define SPRINGSTEP_SCENE_TMPL_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "../simd/target_begin.h"

#include "bands_tmpl.h"
#include "leapfrog_particles_tmpl.h"

#if SPRING_VECTOR < 64
#include "particles_tmpl.h"
#include "pressed_tmpl.h"
#include "stretch_tmpl.h"
#include "unbanded_tmpl.h"

SPRING_TABLE const common_kernels SPRING_COMMON_TABLE = {
    .unbanded_forces = compute_unbanded_forces,
    .record_forces = compute_record_forces,
    .kick_drift = move_kick_drift,
    .implicit_kick = move_implicit_kick,
    .implicit_kick_drift = move_implicit_kick_drift,
    .stage = move_stage,
    .first_stage = move_first_stage,
    .next_stage = move_next_stage,
    .last_stage = move_last_stage,
    .nystrom_stage = move_nystrom_stage,
    .nystrom_end = move_nystrom_end,
    .drift = move_drift,
    .residual = move_residual,
    .series_term = move_series_term,
    .last_series_term = move_last_series_term,
    .drift_kick_drift = move_drift_kick_drift,
    .kick_damped_drift = move_kick_damped_drift,
    .stretched = any_stretched,
    .keep_motion = copy_motion,
    .find_near = find_near_colliders,
    .stop_resting = stop_touching,
    .move_resting = advance_resting,
    .find_pressing = detect_pressing,
    .press_hold = begin_friction,
    .press_project = project_pressed,
    .press_free = free_pulled,
    .press_slide = change_friction,
    .press_restore = restore_loads,
};
#endif

SPRING_TABLE const scene_kernels SPRING_SCENE_TABLE = {
    .common = &SPRING_COMMON_TABLE,
    .band_forces = compute_band_forces,
    .kick_drift = move_kick_drift,
    .implicit_kick = move_implicit_kick,
};

#include "../simd/target_end.h"
#endif
