# SPDX-License-Identifier: MIT
"""A user's program for type checkers, which must accept it, and reject the lines that have an ignored error. It also runs."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any, Optional

import numpy as np
from numpy.typing import NDArray

import springstep
from springstep import Batch, Clock, Collider, Scene, Spring, ffi, lib

if TYPE_CHECKING:
    from typing_extensions import assert_type
else:
    def assert_type(value: Any, kind: Any) -> None:
        """Only type checkers see the types."""

Doubles = NDArray[np.float64]
Floats = NDArray[np.float32]


def wind(t: float, position: Doubles, velocity: Doubles, force: Doubles) -> None:
    force += 0.05 * (3.0 - velocity)


def mean_height(scene: Scene[Any]) -> float:
    return float(scene.position()[:, 2].mean())


def sheet(stiffness: float) -> Scene[np.float64]:
    return Scene.from_grid(springstep.grid([4, 4], 0.1, stiffness, families=["structural", "shear"], pinned=["first_x"]), mass=0.1)


grid = springstep.grid((5, 5), spacing=0.1, stiffness=300)
assert_type(grid.position, Doubles)
scene = Scene(grid.position, grid.links, pinned=grid.pinned, mass=0.01, gravity=[0, 0, -9.81], force=wind, editable=True,
              colliders=2, held_forces=True)
assert_type(scene, Scene[np.float64])
assert_type(scene.position(), Doubles)
assert_type(scene.time, float)
assert_type(scene.axes, int)
assert_type(scene.dtype, np.dtype[np.float64])
assert_type(scene.energy().elastic, float)
assert_type(scene.link(3), tuple[int, int, float, float, float])
assert_type(scene.find_link(0, 1), Optional[int])
assert_type(scene.tear(3.0), NDArray[np.uint32])
scene.set_colliders([springstep.sphere(np.zeros(3), 0.2, friction=0.3), Collider("plane")])
assert_type(scene.get_colliders(), list[Collider])
scene.set_held_force(np.zeros((25, 3)))
scene.drive(0, None) if grid.pinned[0] else None
times, positions = scene.run(1e-3, 20, every=5, progress=lambda done, steps: None)
assert_type(times, Doubles)
assert_type(positions, Doubles)
assert_type(scene.run(1e-3, 2, velocities=True)[2], Doubles)
single = Scene([[0.0, 0.0], [1.0, 0.0]], [(0, 1)], stiffness=3.0, dtype=np.float32)
assert_type(single.velocity(), Floats)
assert_type(Scene.from_grid(grid, dtype="float32", methods=["rk4"]).position(), Floats)

spring = Spring.hertz(2.0, 0.3, x=1.0)
assert_type(spring.x, float)
spring.damping = 3
x, v = spring.at([0, 0.1])
assert_type(x, Doubles)
batch = Batch(np.ones(3, np.float32), np.zeros(3, np.float32), 40.0)
assert_type(batch, Batch[np.float32])
assert_type(batch.x, Floats)
assert_type(batch.gamma, Optional[Floats])
for method in springstep.methods():
    if method.springs:
        batch.advance(0.01, 2, method.name)
assert_type(Clock(0.01).tick(0.1), tuple[int, float])
rows = springstep.sweep({"stiffness": [100, 200.0]}, "leapfrog", scene=sheet, measure={"height_m": mean_height})
assert_type(rows, NDArray[np.void])

state = ffi.new("spring_state *", [1, 0])
assert_type(lib.spring_energy(state, ffi.new("spring_params *", [1, 40, 0, 0])), float)
assert_type(lib.SPRING_OK, int)

scene.set_colliders([springstep.plane([0, 0, 0], [0, 0, 1], mask=3, acceleration=[0, 0, 1])])
assert_type(Scene(grid.position, colliders=1, particle_radius=np.full(25, 0.1), particle_mask=25 * [1]), Scene[np.float64])

if TYPE_CHECKING:  # functions in C
    springstep.custom(ctypes.CDLL("./ground.so").gap, 0.1, gap_data=np.zeros(3), friction=0.5)
    springstep.custom(ffi.cast("spring_gap_fn *", 0), 0.1)
    scene.set_force(ctypes.CDLL("./wind.so").wind, np.zeros(3))
    scene.set_force(ctypes.CFUNCTYPE(None, ctypes.c_void_p)())
    scene.set_force(ffi.cast("spring_scene_force_fn *", 0))

if TYPE_CHECKING:  # each line is an error
    scene.set_force(3)  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    Scene.from_grid(grid, force=lambda t, x: None)  # type: ignore[arg-type, misc]  # pyright: ignore
    scene.advance(0.01, method="verlet")  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    scene.advance("0.01")  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    Scene(*grid)  # type: ignore[call-overload]  # pyright: ignore[reportCallIssue, reportArgumentType]
    Scene(grid.position, masses=3)  # type: ignore[call-overload]  # pyright: ignore[reportCallIssue]
    spring.x = "1"  # type: ignore[assignment]  # pyright: ignore[reportAttributeAccessIssue]
    spring.stifness = 3  # type: ignore[attr-defined]  # pyright: ignore[reportAttributeAccessIssue]
    springstep.sphere([0, 0, 0], 1, colour=3)  # type: ignore[call-arg]  # pyright: ignore[reportCallIssue]
    Collider("cone")  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    lib.spring_energy(state)  # type: ignore[call-arg, misc]  # pyright: ignore[reportCallIssue]
