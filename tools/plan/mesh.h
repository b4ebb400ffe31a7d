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

/** A scene from a Wavefront OBJ file: a particle at each vertex, a link at its rest length along each edge of a face or a
    line, and across faces of four corners. y is up; the highest vertices are pinned, and those with no link.
    Particles are renumbered for speed. Exits with a message that names the line of a file that is not such a mesh. Release it with preset_clear(). */
preset mesh_read(const char *path, const mesh_settings *settings);

#endif
