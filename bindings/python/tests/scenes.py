# SPDX-License-Identifier: MIT
"""Scenes that several tests use."""
import numpy as np
import pytest

import springstep
from springstep import Scene, grid

OF_SCENES = [method.name for method in springstep.methods() if method.scenes]
FLOATS = pytest.mark.parametrize("dtype", [np.float64, np.float32])


def cloth(n=25, length=2.0, **options):
    """The cloth of spring-scene."""
    g = grid([n, n], length / (n - 1), 500.0, families=["structural", "shear", "bend"])
    g.pinned[[0, n - 1]] = True
    return Scene.from_grid(g, **{"mass": 0.01, "drag": 0.01, "gravity": [0, 0, -9.81], **options})


def rope(**options):
    """Six particles, hung at the first, with links that are damped."""
    g = grid([6], 0.3, 170.0, 0.2, pinned=["first_x"])
    return Scene.from_grid(g, **{"mass": 0.13, "gravity": [0, -9.81, 0.4], **options})


def hung(stiffness=400.0, size=4, name="rope"):
    """A rope, or a cloth hung along an edge, of so many particles along an edge."""
    g = grid([size] * (1 if name == "rope" else 2), 1 / size, stiffness, 0.1, pinned=["first_x"])
    return Scene.from_grid(g, mass=0.1, gravity=[0, -9.81, 0], drag=0.05, max_speed=10)


def swing(t, position, velocity, force):
    force[0] += 0.3 * np.sin(9 * t) - 0.1 * velocity[0]


def saved_scenes(dtype):
    """Scenes after an eventful life: edits, tears, contacts, held forces, a force, one axis."""
    torn = cloth(9, dtype=dtype, editable=True, held_forces=True, colliders=2, mass=np.linspace(0.01, 0.02, 81))
    torn.set_colliders([springstep.sphere([1, 1, -0.3], 0.4, velocity=[0, 0, 0.2])])
    torn.set_held_force(np.full((81, 3), 0.01))
    torn.advance(1e-3, 200)
    torn.tear(1.02)
    torn.set_pinned([True, False], 40)
    torn.set_mass([0.5], 3)
    damped = rope(dtype=dtype, force=swing, undo=False, tension_only=True)
    water = Scene.from_grid(grid([7, 5], 0.2, 300.0, height=True, pinned=["first_x"]), dtype=dtype, methods=["rk4", "leapfrog"])
    water.set_velocity(np.linspace(-1, 1, 35))
    hair = Scene.from_grid(grid([9], 0.1, 300.0, pinned=["first_x"]), dtype=dtype, editable=True, weighted_links=springstep.bend_rod(
        np.arange(9)[:, np.newaxis] * [0.1, 0, 0], 0.02, damping_time=0.01, pinned=np.arange(9) == 0))
    hair.set_velocity(np.linspace(-1, 1, 27).reshape(9, 3))
    for scene in (torn, damped, water, hair):
        scene.advance(2e-3, 30)
        yield scene


def lowest(scene):
    return scene.position()[:, 1].min()


def fnv(scene):
    digest = 0xCBF29CE484222325
    for byte in scene.position().tobytes() + scene.velocity().tobytes():
        digest = (digest ^ byte) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
    return f"{digest:016x}"
