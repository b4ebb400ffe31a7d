/* SPDX-License-Identifier: MIT */
/* Scenes from mesh files. */
#ifndef SPRINGSTEP_MESH_H
#define SPRINGSTEP_MESH_H

#include "scenes/presets.h"

typedef struct mesh_settings {
    double mass;      /* [kg] > 0 of a vertex */
    double stiffness; /* [N/m] of a link */
    double damping;   /* [N s/m] of a link */
    double drag;      /* [N s/m] of a vertex */
} mesh_settings;

/** Reads a scene from a Wavefront OBJ file: a particle at each vertex, and a link at its rest length along each edge of
    a face or a line, and across faces with four corners. y is up. The highest vertices and those without links are
    pinned. Particles are renumbered for speed. Exits with a message and the line number if the file is not valid.
    Release the scene with preset_clear(). */
preset mesh_read(const char *path, const mesh_settings *settings);

#endif
