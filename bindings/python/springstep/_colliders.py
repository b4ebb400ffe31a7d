# SPDX-License-Identifier: MIT
"""Bodies that the particles of a scene cannot enter."""
from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, Literal, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from springstep._common import invalid
from springstep._force import GivenInC, InC, function_in_c
from springstep._native import ffi, lib

if TYPE_CHECKING:
    from typing_extensions import Unpack

_SHAPES = {"plane": lib.SPRING_PLANE, "sphere": lib.SPRING_SPHERE, "capsule": lib.SPRING_CAPSULE, "box": lib.SPRING_BOX,
           "custom": lib.SPRING_CUSTOM}
_VECTORS = ("at", "to", "half", "velocity", "velocity_to", "acceleration", "surface")
_SPINS = ("spin", "spin_acceleration")
_NUMBERS = ("radius", "friction", "restitution", "thickness", "bound")


class ColliderOptions(TypedDict, total=False):
    """Fields of `Collider` that all shapes have."""

    velocity: ArrayLike
    spin: ArrayLike
    friction: float
    restitution: float
    acceleration: ArrayLike
    spin_acceleration: ArrayLike
    surface: ArrayLike
    mask: int


@dataclass(slots=True, repr=False)
class Collider:
    """A body that particles cannot enter, as in C. `plane`, `sphere`, `capsule`, `box` and `custom` make one.

    Vectors have three numbers, or two for scenes with two axes, where a spin is a number.
    """

    shape: Literal["plane", "sphere", "capsule", "box", "custom"]
    at: ArrayLike = (0, 0, 0)  #: [m] a point of the plane, the centre, or one end of the capsule
    to: ArrayLike = (0, 0, 0)  #: [m] the other end of the capsule
    axis: ArrayLike = ((1, 0, 0), (0, 1, 0), (0, 0, 1))  #: the first: unit normal of the plane; box, custom: unit axes
    half: ArrayLike = (0, 0, 0)  #: [m] box: half of its size along each axis, without the radius
    radius: float = 0.0  #: [m] of a sphere or capsule; also rounds a box; is added to a custom body
    velocity: ArrayLike = (0, 0, 0)  #: [m/s] of `at`
    velocity_to: ArrayLike = (0, 0, 0)  #: [m/s] of `to`
    spin: ArrayLike = (0, 0, 0)  #: [rad/s] turns bodies about `at`; of spheres and capsules only the surface
    friction: float = 0.0  #: Coulomb coefficient >= 0
    restitution: float = 0.0  #: 0 to 1: normal speed after an impact divided by that before
    acceleration: ArrayLike = (0, 0, 0)  #: [m/s^2] of `at` and `to`
    spin_acceleration: ArrayLike = (0, 0, 0)  #: [rad/s^2]
    surface: ArrayLike = (0, 0, 0)  #: [m/s] further velocity of the surface, as of a conveyor belt
    mask: int = 0  #: collides with particles whose mask has a bit in common; 0 means all bits
    gap: InC | None = None  #: custom: a function in C of type `spring_gap_fn`
    gap_data: NDArray[Any] | None = None  #: custom: the function receives a pointer to its first element as `user`
    thickness: float = 0.0  #: [m] custom: least thickness of the body, > 0
    bound: float = 0.0  #: [m] custom: radius of a sphere about `at` that contains the body without its radius; 0: none

    def __repr__(self) -> str:
        """Return the fields that differ from their defaults."""
        changed = [field.name for field in fields(self) if repr(getattr(self, field.name)) != repr(field.default)]
        return f"Collider({', '.join(f'{name}={getattr(self, name)!r}' for name in changed)})"

    def __eq__(self, other: object) -> bool:
        """Return whether all fields are equal, those that are arrays or other sequences by their elements."""
        if not isinstance(other, Collider):
            return NotImplemented
        pairs = ((getattr(self, field.name), getattr(other, field.name)) for field in fields(self))
        return all(a is b or np.array_equal(a, b) for a, b in pairs)

    def __reduce__(self) -> tuple[Any, ...]:
        """Copies share a function in C."""
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        given = None if self.gap is None else GivenInC(values.pop("gap"), values.pop("gap_data"))
        return _copied, (type(self), values, given)

    def _fill(self, c: Any, axes: int, place: int) -> None:
        """Copy all fields to a structure of C, for a scene with so many axes."""
        if self.shape not in _SHAPES:
            invalid("colliders.shape", self.shape, place, reason=f"not one of {', '.join(_SHAPES)}")

        def vector(field: str, values: Any, count: int = axes) -> list[float]:
            if np.ndim(values) != 1 or len(values) not in (count, 3):
                invalid(f"colliders.{field}", values, place, reason=f"not {axes} numbers" if count == axes else "not a number")
            return [*map(float, values), 0.0][:3]

        c.shape = _SHAPES[self.shape]
        for field in _VECTORS:
            setattr(c, field, vector(field, getattr(self, field)))
        for field in _SPINS:
            value = getattr(self, field)
            if np.ndim(value) == 0:
                if axes == 3:
                    invalid(f"colliders.{field}", value, place, reason="not three numbers")
                getattr(c, field)[2] = value
            else:
                setattr(c, field, vector(field, value, 3))
        rows: Any = self.axis
        for row, axis in enumerate(rows[:3]):
            c.axis[row] = vector("axis", axis)
        for field in _NUMBERS:
            setattr(c, field, getattr(self, field))
        if not 0 <= self.mask < 2**32:
            invalid("colliders.mask", self.mask, place, reason="not an integer from 0 to 2^32 - 1")
        c.mask = self.mask
        if self.shape == "custom":
            found = function_in_c(f"colliders[{place}].gap", self.gap, self.gap_data, _GAP, _is_gap)
            if found is None:
                raise TypeError(f"colliders[{place}].gap: a {type(self.gap).__name__}, not a function in C")
            c.gap, c.user = ffi.cast("spring_gap_fn *", found[0]), ffi.cast("void *", found[1])


def _copied(kind: type[Collider], values: dict[str, Any], given: GivenInC | None) -> Collider:
    return kind(**values) if given is None else kind(**values, gap=given.function, gap_data=given.data)


def colliders_from(array: Any, bodies: list[Collider]) -> list[Collider]:
    """Return colliders from structures of C. bodies: with the functions of custom bodies, each at its place."""
    names = {number: name for name, number in _SHAPES.items()}
    found = []
    for place, c in enumerate(array):
        given: dict[str, Any] = {name: tuple(getattr(c, name)) for name in _VECTORS + _SPINS}
        given |= {name: getattr(c, name) for name in (*_NUMBERS, "mask")}
        given |= {"shape": names[c.shape], "axis": tuple(map(tuple, c.axis))}
        if c.shape == lib.SPRING_CUSTOM:
            given |= {"gap": bodies[place].gap, "gap_data": bodies[place].gap_data}
        found.append(Collider(**given))
    return found


_GAP = "uint32_t (void *, double *, double *, double (*)[3])"


def _is_gap(result: str, arguments: list[str]) -> bool:
    """Return whether C functions with this signature are surfaces of custom bodies."""
    numbers = all(argument in ("double*", "double[3]", "double_Array_3*") for argument in arguments[1:])
    return result in ("uint32_t", "uint", "unsignedint") and len(arguments) == 4 and arguments[0].endswith("*") and numbers


def _unit_normal(normal: ArrayLike) -> list[float]:
    """Return the unit vector with the same bits on every machine, in JavaScript too. A unit vector stays as it is."""
    vector: list[float] = np.asarray(normal, np.float64).reshape(-1).tolist()
    largest = max(map(abs, vector), default=0.0)
    if not 0 < largest < np.inf or any(component != component for component in vector):
        invalid("normal", normal, reason="not a vector with a length greater than 0")
    square = sum(component * component for component in vector)
    if not 1e-280 < square < 1e280:
        vector = [component / largest for component in vector]
        square = sum(component * component for component in vector)
    return vector if abs(square - 1) <= 1e-15 else [component / math.sqrt(square) for component in vector]


def plane(at: ArrayLike, normal: ArrayLike, **options: Unpack[ColliderOptions]) -> Collider:
    """Return a half-space, from a point of its surface and its normal.

    Parameters
    ----------
    at : array_like
        A point of the surface [m].
    normal : array_like
        Vector of any length > 0, which points out of the body.
    **options
        velocity, spin, friction, restitution, acceleration, spin_acceleration, surface, mask: see `Collider`.
    """
    return Collider("plane", at, axis=(_unit_normal(normal), (0, 0, 0), (0, 0, 0)), **options)


def sphere(at: ArrayLike, radius: float, **options: Unpack[ColliderOptions]) -> Collider:
    """Return a sphere.

    Parameters
    ----------
    at : array_like
        The centre [m].
    radius : float
        [m] > 0.
    **options
        As of `plane`.
    """
    return Collider("sphere", at, radius=radius, **options)


def capsule(at: ArrayLike, to: ArrayLike, radius: float, *, velocity_to: ArrayLike | None = None,
            **options: Unpack[ColliderOptions]) -> Collider:
    """Return a capsule, which is all points within a radius of a line.

    Parameters
    ----------
    at, to : array_like
        The ends of the line [m].
    radius : float
        [m] > 0.
    velocity_to : array_like, optional
        Velocity of `to` [m/s]; None: that of `at`.
    **options
        As of `plane`.
    """
    end = options.get("velocity", (0, 0, 0)) if velocity_to is None else velocity_to
    return Collider("capsule", at, to, radius=radius, velocity_to=end, **options)


def box(at: ArrayLike, half: ArrayLike, *, axis: ArrayLike = ((1, 0, 0), (0, 1, 0), (0, 0, 1)), radius: float = 0.0,
        **options: Unpack[ColliderOptions]) -> Collider:
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
    **options
        As of `plane`.
    """
    return Collider("box", at, axis=axis, half=half, radius=radius, **options)


def custom(gap: InC, thickness: float, *, gap_data: NDArray[Any] | None = None, bound: float = 0.0,
           at: ArrayLike = (0, 0, 0), axis: ArrayLike = ((1, 0, 0), (0, 1, 0), (0, 0, 1)), radius: float = 0.0,
           **options: Unpack[ColliderOptions]) -> Collider:
    """Return a body that a function in C describes, as terrain.

    Parameters
    ----------
    gap : C function
        Of type `spring_gap_fn`: a `numba.cfunc`, a `scipy.LowLevelCallable`, or a function of ctypes or cffi.
    thickness : float
        Least thickness of the body [m] > 0.
    gap_data : ndarray, optional
        The function receives a pointer to the first element of this array as `user`. Do not change it during a step.
    bound : float
        Radius of a sphere about `at` that contains the body, without its radius [m]; 0: none, as for terrain.
    at, axis, radius
        See `Collider`.
    **options
        As of `plane`.
    """
    return Collider("custom", at, axis=axis, radius=radius, gap=gap, gap_data=gap_data, thickness=thickness, bound=bound,
                    **options)
