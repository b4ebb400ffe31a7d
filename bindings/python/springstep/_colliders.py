# SPDX-License-Identifier: MIT
"""Bodies that the particles of a scene cannot enter."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from springstep._common import invalid
from springstep._native import lib

_SHAPES = {"plane": lib.SPRING_PLANE, "sphere": lib.SPRING_SPHERE, "capsule": lib.SPRING_CAPSULE, "box": lib.SPRING_BOX}


@dataclass(slots=True)
class Collider:
    """A convex body that particles cannot enter, as in C. `plane`, `sphere`, `capsule` and `box` make one.

    Vectors have three numbers, or two for scenes with two axes, where a spin is a number.
    """

    shape: Literal["plane", "sphere", "capsule", "box"]
    at: ArrayLike = (0, 0, 0)  #: [m] a point of the plane, the centre, or one end of the capsule
    to: ArrayLike = (0, 0, 0)  #: [m] the other end of the capsule
    axis: ArrayLike = ((1, 0, 0), (0, 1, 0), (0, 0, 1))  #: the first: unit normal of the plane; box: unit axes
    half: ArrayLike = (0, 0, 0)  #: [m] box: half of its size along each axis, without the radius
    radius: float = 0.0  #: [m] of a sphere or capsule; also rounds a box
    velocity: ArrayLike = (0, 0, 0)  #: [m/s] of `at`
    velocity_to: ArrayLike = (0, 0, 0)  #: [m/s] of `to`
    spin: ArrayLike = (0, 0, 0)  #: [rad/s] turns planes and boxes about `at`; of spheres and capsules the surface
    friction: float = 0.0  #: Coulomb coefficient >= 0
    restitution: float = 0.0  #: 0 to 1: normal speed after an impact divided by that before
    acceleration: ArrayLike = (0, 0, 0)  #: [m/s^2] of `at` and `to`
    spin_acceleration: ArrayLike = (0, 0, 0)  #: [rad/s^2]
    surface: ArrayLike = (0, 0, 0)  #: [m/s] further velocity of the surface, as of a conveyor belt

    def _fill(self, c: Any, axes: int, place: int) -> None:
        """Copy all fields to a structure of C, for a scene with so many axes."""
        if self.shape not in _SHAPES:
            invalid("colliders.shape", self.shape, place, reason=f"not one of {', '.join(_SHAPES)}")

        def vector(field: str, values: Any) -> list[float]:
            if np.ndim(values) != 1 or len(values) not in (axes, 3):
                invalid(f"colliders.{field}", values, place, reason=f"not {axes} numbers")
            return [*map(float, values), 0.0][:3]

        c.shape = _SHAPES[self.shape]
        for field in ("at", "to", "half", "velocity", "velocity_to", "acceleration", "surface"):
            setattr(c, field, vector(field, getattr(self, field)))
        for field in ("spin", "spin_acceleration"):
            value = getattr(self, field)
            if np.ndim(value) == 0:
                if axes == 3:
                    invalid(f"colliders.{field}", value, place, reason="not three numbers")
                getattr(c, field)[2] = value
            else:
                setattr(c, field, vector(field, value))
        rows: Any = self.axis
        for row, axis in enumerate(rows[:3]):
            c.axis[row] = vector("axis", axis)
        for field in ("radius", "friction", "restitution"):
            setattr(c, field, getattr(self, field))


def plane(at: ArrayLike, normal: ArrayLike, *, velocity: ArrayLike = (0, 0, 0), spin: ArrayLike = (0, 0, 0),
          friction: float = 0.0, restitution: float = 0.0) -> Collider:
    """Return a half-space, from a point of its surface and its normal.

    Parameters
    ----------
    at : array_like
        A point of the surface [m].
    normal : array_like
        Vector of any length > 0, which points out of the body.
    velocity, spin, friction, restitution
        See `Collider`.
    """
    length = float(np.linalg.norm(normal))
    if not 0 < length < np.inf:
        invalid("normal", normal, reason="not a vector with a length greater than 0")
    unit = [component / length for component in np.asarray(normal, np.float64).tolist()]
    return Collider("plane", at, axis=(unit, (0, 0, 0), (0, 0, 0)), velocity=velocity, spin=spin, friction=friction,
                    restitution=restitution)


def sphere(at: ArrayLike, radius: float, *, velocity: ArrayLike = (0, 0, 0), spin: ArrayLike = (0, 0, 0),
           friction: float = 0.0, restitution: float = 0.0) -> Collider:
    """Return a sphere.

    Parameters
    ----------
    at : array_like
        The centre [m].
    radius : float
        [m] > 0.
    velocity, spin, friction, restitution
        See `Collider`.
    """
    return Collider("sphere", at, radius=radius, velocity=velocity, spin=spin, friction=friction, restitution=restitution)


def capsule(at: ArrayLike, to: ArrayLike, radius: float, *, velocity: ArrayLike = (0, 0, 0),
            velocity_to: ArrayLike | None = None, spin: ArrayLike = (0, 0, 0), friction: float = 0.0,
            restitution: float = 0.0) -> Collider:
    """Return a capsule, which is all points within a radius of a line.

    Parameters
    ----------
    at, to : array_like
        The ends of the line [m].
    radius : float
        [m] > 0.
    velocity_to : array_like, optional
        Velocity of `to` [m/s]; None: that of `at`.
    velocity, spin, friction, restitution
        See `Collider`.
    """
    return Collider("capsule", at, to, radius=radius, velocity=velocity,
                    velocity_to=velocity if velocity_to is None else velocity_to, spin=spin, friction=friction,
                    restitution=restitution)


def box(at: ArrayLike, half: ArrayLike, *, axis: ArrayLike = ((1, 0, 0), (0, 1, 0), (0, 0, 1)), radius: float = 0.0,
        velocity: ArrayLike = (0, 0, 0), spin: ArrayLike = (0, 0, 0), friction: float = 0.0,
        restitution: float = 0.0) -> Collider:
    """Return a box.

    Parameters
    ----------
    at : array_like
        The centre [m].
    half : array_like
        Half of the size along each axis [m].
    axis : array_like
        Unit axes, one per row.
    radius : float
        Is added to the box, and rounds its edges [m].
    velocity, spin, friction, restitution
        See `Collider`.
    """
    return Collider("box", at, axis=axis, half=half, radius=radius, velocity=velocity, spin=spin, friction=friction,
                    restitution=restitution)
