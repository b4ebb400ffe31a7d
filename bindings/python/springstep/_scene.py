# SPDX-License-Identifier: MIT
"""Mass-spring systems: rope, cloth, soft bodies and height-field water."""
from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from types import TracebackType
from typing import Any, NamedTuple, NoReturn

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from springstep._common import Guard, fail, finite, invalid, method_number, names_of, step_count
from springstep._native import ffi, lib

#: A link, as in C: a and b [indices of particles], rest [m], stiffness [N/m], damping [N s/m].
LINK = np.dtype({
    "names": [name for name, _ in ffi.typeof("spring_link").fields],
    "formats": [{"double": np.float64, "uint32_t": np.uint32}[field.type.cname]
                for _, field in ffi.typeof("spring_link").fields],
    "offsets": [field.offset for _, field in ffi.typeof("spring_link").fields],
    "itemsize": ffi.sizeof("spring_link"),
})

#: force(t, position, velocity, force) writes forces [N] to the array force[axis, particle], which starts at 0 and is added
#: to the forces of links. It returns None. position[axis, particle] [m] and velocity[axis, particle] [m/s] at the time t [s]
#: are read-only, and valid during the call only: they are views of the memory of the scene, which changes later. With
#: force_ignores_velocity the velocities are zeros.
Force = Callable[[float, np.ndarray, np.ndarray, np.ndarray], None]

_PREFIXES = {np.dtype(np.float64): "spring_scene", np.dtype(np.float32): "spring_scenef"}
_FAMILIES = ("structural", "shear", "bend")
_FACES = ("first_x", "last_x", "first_y", "last_y", "first_z", "last_z")


class Energies(NamedTuple):
    """The energies of a scene [J]."""

    kinetic: float  #: of particles that are not pinned
    elastic: float  #: of all links
    gravity: float  #: of particles that are not pinned; 0 at the origin


class Grid(NamedTuple):
    """The arrays of a grid, to be changed and handed to Scene."""

    position: np.ndarray  #: [m], (particles, axes)
    pinned: np.ndarray  #: True: pinned
    links: np.ndarray  #: of LINK


class _Called:
    """A force, and what C is given to find it."""

    def __init__(self, function: Force, scene: Scene):
        self.function, self.shape = function, (scene.axes, len(scene))
        self.unseen = scene._unseen_velocity
        self.memory = scene._memory.view(scene.dtype)
        self.constant = self.memory.view()
        self.constant.flags.writeable = False
        self.start = ffi.cast("double *" if scene.dtype == np.float64 else "float *", scene._pointer)
        self.error: BaseException | None = None
        self.handle = ffi.new_handle(self)

    def array(self, memory: np.ndarray, pointers: Any) -> np.ndarray:
        """[axis, particle]. C points into the memory of the scene, at equal distances, and a view keeps this memory alive."""
        size = memory.itemsize
        stride = pointers[1] - pointers[0] if self.shape[0] > 1 else 0
        return np.ndarray(self.shape, memory.dtype, memory, (pointers[0] - self.start) * size, (stride * size, size))

    def call(self, t: float, position: Any, velocity: Any, force: Any) -> None:
        velocities = self.array(self.constant, velocity) if self.unseen is None else self.unseen
        added = np.zeros(self.shape, self.memory.dtype)
        returned = self.function(t, self.array(self.constant, position), velocities, added)
        if returned is not None:
            raise TypeError(f"force: returned a {type(returned).__name__}, not None; write to the array force[axis, particle]")
        total = self.array(self.memory, force)
        total += added

    def stop(self, force: Any) -> None:
        """Set all forces to NaN, so that the C function fails."""
        self.array(self.memory, force)[:] = np.nan


def _callback(user: Any, t: float, particles: int, position: Any, velocity: Any, force: Any) -> None:
    called = ffi.from_handle(user)
    if called.error is None:
        called.call(t, position, velocity, force)
    else:
        called.stop(force)


def _callback_raised(kind: type, error: BaseException, traceback: TracebackType) -> None:
    """Keep an exception for the caller of C. cffi finds any, even an interrupt before the first line of _callback."""
    arguments = traceback.tb_frame.f_locals
    called = ffi.from_handle(arguments["user"])
    called.error = error
    called.stop(arguments["force"])


ffi.def_extern("springstep_force", onerror=_callback_raised)(_callback)
ffi.def_extern("springstep_forcef", onerror=_callback_raised)(_callback)


def _bits(field: str, names: Iterable[str], known: Sequence[str]) -> int:
    """Return names as bits, in the order of the C library."""
    bits = 0
    for name in names_of(field, names):
        if name not in known:
            invalid(field, name)
        bits |= 1 << known.index(name)
    return bits


def grid(count: Sequence[int], spacing: float, stiffness: float, damping: float = 0.0, *,
         families: Iterable[str] = ("structural",), pinned: Iterable[str] = (), stretch: float = 1.0, axes: int = 3,
         height: bool = False) -> Grid:
    """The particles at the corners of a grid, and its links: a row is a rope, a layer a sheet, more a block.

    count: one to three numbers, the particles along x, y, z. Particle (i, j, k) has index i + count[0] (j + count[1] k)
    spacing: [m] > 0 from one particle to the next
    stiffness, damping: [N/m], [N s/m] of every link
    families: "structural" to the next particle, "shear" across faces, "bend" to the one after the next
    pinned: faces that are pinned: "first_x", "last_x", "first_y" ...
    stretch: length over rest length of every link; above 1 is tension
    axes: of the positions; height: a height field, of one axis across the grid
    """
    shape = tuple(operator.index(number) for number in count)
    if not 1 <= len(shape) <= 3:
        invalid("count", shape, reason="not one to three numbers")
    if not all(0 <= number < 2**32 for number in shape):
        fail(lib.SPRING_ERANGE, "count", shape)
    if axes not in (1, 2, 3):
        invalid("axes", axes, reason="not 1, 2 or 3")
    c = ffi.new("spring_grid *", {
        "count": [*shape, 1, 1][:3], "axes": 1 if height else axes, "height": height, "spacing": spacing, "stretch": stretch,
        "families": _bits("families", families, _FAMILIES), "stiffness": stiffness, "damping": damping,
        "pinned": _bits("pinned", pinned, _FACES),
    })
    particles, links = ffi.new("size_t *"), ffi.new("size_t *")
    if status := lib.spring_grid_size(c, particles, links):
        for field in ("spacing", "stretch"):
            if not 0 < getattr(c, field) < np.inf:
                invalid(field, getattr(c, field))
        for field in ("stiffness", "damping"):
            if not 0 <= getattr(c, field) < np.inf:
                invalid(field, getattr(c, field))
        if status == lib.SPRING_ERANGE:
            fail(status, "count", shape)
        if not height and len(shape) > axes and max(shape[axes:]) > 1:
            invalid("axes", axes, reason=f"fewer than the directions of count = {shape}")
        invalid("spacing", spacing)
    result = Grid(np.empty((particles[0], c.axes)), np.empty(particles[0], bool), np.empty(links[0], LINK))
    if status := lib.spring_grid_fill(c, ffi.from_buffer("double[]", result.position),
                                      ffi.from_buffer("uint8_t[]", result.pinned),
                                      ffi.cast("spring_link *", ffi.from_buffer(result.links))):
        fail(status)
    return result


_SHAPES = {"plane": lib.SPRING_PLANE, "sphere": lib.SPRING_SPHERE, "capsule": lib.SPRING_CAPSULE, "box": lib.SPRING_BOX}


@dataclass
class Collider:
    """A convex body that particles cannot enter, as in C; plane(), sphere(), capsule() and box() make one.

    Vectors have three numbers, or two for scenes on two axes, where a spin is a number.
    """

    shape: str  #: "plane", "sphere", "capsule" or "box"
    at: Sequence[float] = (0, 0, 0)  #: [m] a point of the plane, the centre, or one end of the capsule
    to: Sequence[float] = (0, 0, 0)  #: [m] the other end of the capsule
    axis: Sequence[Sequence[float]] = ((1, 0, 0), (0, 1, 0), (0, 0, 1))  #: the first: unit normal of the plane; box: unit axes
    half: Sequence[float] = (0, 0, 0)  #: [m] box: half of its size along each axis, without the radius
    radius: float = 0.0  #: [m] of a sphere or capsule; also rounds a box
    velocity: Sequence[float] = (0, 0, 0)  #: [m/s] of `at`
    velocity_to: Sequence[float] = (0, 0, 0)  #: [m/s] of `to`
    spin: Sequence[float] | float = (0, 0, 0)  #: [rad/s] of the surface: enters friction only, does not turn the body
    friction: float = 0.0  #: Coulomb coefficient >= 0
    restitution: float = 0.0  #: 0 to 1: normal speed after an impact over that before


def plane(at: Sequence[float], normal: Sequence[float], *, velocity: Sequence[float] = (0, 0, 0),
          spin: Sequence[float] | float = (0, 0, 0), friction: float = 0.0, restitution: float = 0.0) -> Collider:
    """A half-space, from a point of its surface [m] and its normal, of any length, which points out of it."""
    length = float(np.linalg.norm(normal))
    if not 0 < length < np.inf:
        invalid("normal", list(normal), reason="not a vector with a length greater than 0")
    unit = [component / length for component in normal]
    return Collider("plane", at, axis=(unit, (0, 0, 0), (0, 0, 0)), velocity=velocity, spin=spin, friction=friction,
                    restitution=restitution)


def sphere(at: Sequence[float], radius: float, *, velocity: Sequence[float] = (0, 0, 0),
           spin: Sequence[float] | float = (0, 0, 0), friction: float = 0.0, restitution: float = 0.0) -> Collider:
    """A sphere, from its centre and its radius [m]."""
    return Collider("sphere", at, radius=radius, velocity=velocity, spin=spin, friction=friction, restitution=restitution)


def capsule(at: Sequence[float], to: Sequence[float], radius: float, *, velocity: Sequence[float] = (0, 0, 0),
            velocity_to: Sequence[float] | None = None, spin: Sequence[float] | float = (0, 0, 0), friction: float = 0.0,
            restitution: float = 0.0) -> Collider:
    """All points within a radius of a line from `at` to `to` [m]. `to` has the velocity of `at` if none is given for it."""
    return Collider("capsule", at, to, radius=radius, velocity=velocity,
                    velocity_to=velocity if velocity_to is None else velocity_to, spin=spin, friction=friction,
                    restitution=restitution)


def box(at: Sequence[float], half: Sequence[float], *, axis: Sequence[Sequence[float]] = ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
        radius: float = 0.0, velocity: Sequence[float] = (0, 0, 0), spin: Sequence[float] | float = (0, 0, 0),
        friction: float = 0.0, restitution: float = 0.0) -> Collider:
    """A box, from its centre and half of its size along each of its unit axes [m]; a radius is added and rounds its edges."""
    return Collider("box", at, axis=axis, half=half, radius=radius, velocity=velocity, spin=spin, friction=friction,
                    restitution=restitution)


class Snapshot:
    """The state of a scene at a time, including its force, for Scene.restore()."""

    def __init__(self, scene: Scene, memory: bytes, called: _Called | None, pinned: np.ndarray):
        self._scene, self._memory, self._called, self._pinned = scene, memory, called, pinned

    def __len__(self) -> int:
        """Size of the snapshot [bytes]."""
        return len(self._memory)


class Scene:
    """A mass-spring system: mass x'' = link forces + mass gravity - drag x' + force(t, x, x').

    position: [m], (particles, axes); (particles,) for one axis
    links: tuples (a, b, rest [m], stiffness [N/m], damping [N s/m]), or an array of LINK. Any structured array with exactly
        these fields will do, in any order: they are found by their names
    velocity: [m/s], like position; None: at rest
    mass: [kg] > 0, of all or for each particle
    pinned: for each particle, True: it feels no force and keeps its velocity; None: none is
    gravity: [m/s^2], a number for each axis; None: none
    drag: [N s/m] >= 0, on every particle
    force: a function that adds forces, see Force
    force_ignores_velocity: force uses no velocities, and is shown zeros: leapfrog is twice as fast
    methods: names of those that will be used; None: all except those that store stages or drag factors
    editable: links, pins and masses may change
    undo: False: an advance that fails loses the state, and memory is saved
    max_speed: [m/s] a step after which a free particle is faster along an axis fails; 0: no limit
    colliders: there is room for so many, at most 32, see set_colliders(); for two or three axes
    particle_radius: [m] >= 0 of every particle, for contacts
    tension_only: links pull and never push, as those of ropes and nets; for two or three axes
    held_forces: there is room for forces that are held until they are changed, see set_held_force()
    dtype: float64 or float32: what the scene computes in

    Everything is copied into a block of memory, as C does; position(), velocity() and their like copy it out. While one
    thread advances a scene, its methods raise RuntimeError in other threads, and in its own force.
    """

    def __init__(self, position: ArrayLike, links: ArrayLike = (), *, velocity: ArrayLike | None = None,
                 mass: ArrayLike = 1.0, pinned: ArrayLike | None = None, gravity: ArrayLike | None = None,
                 drag: float = 0.0, force: Force | None = None, force_ignores_velocity: bool = False,
                 methods: Iterable[str] | None = None, editable: bool = False, undo: bool = True,
                 dtype: DTypeLike = np.float64, tension_only: bool = False, held_forces: bool = False,
                 max_speed: float = 0.0, colliders: int = 0, particle_radius: float = 0.0):
        self._dtype = np.dtype(dtype)
        if self._dtype not in _PREFIXES:
            raise TypeError("dtype: not float64 or float32")
        self._prefix = _PREFIXES[self._dtype]
        positions = np.ascontiguousarray(position, np.float64)
        if positions.ndim == 1:
            positions = positions[:, np.newaxis]
        if positions.ndim != 2 or not 1 <= positions.shape[1] <= 3:
            raise ValueError(f"position: its shape is {np.shape(position)}, not (particles, axes)")
        self._particles, self._axes = positions.shape
        joined = _joined(links)
        self._links = len(joined)
        methods = names_of("methods", methods or ())
        self._called: _Called | None = None
        self._unseen_velocity: np.ndarray | None = None
        if force_ignores_velocity:
            self._unseen_velocity = np.zeros((self._axes, self._particles), self._dtype)
            self._unseen_velocity.flags.writeable = False
        self._pinned = np.zeros(self._particles, bool)
        self._undo = undo
        self._guard = Guard("the scene is being advanced, or was called from its own force")

        given = {"position": positions, "link": joined}
        definition = ffi.new(f"{self._prefix}_def *", {
            "axes": self._axes, "particles": self._particles, "links": self._links, "drag": drag, "max_speed": max_speed,
            "colliders": min(_natural("colliders", colliders), 2**32 - 1), "particle_radius": particle_radius,
            "gravity": self._vector("gravity", gravity) if gravity is not None else [],
        })
        for flag, wanted in (("EDITABLE", editable), ("NO_UNDO", not undo),
                             ("FORCE_IGNORES_VELOCITY", force_ignores_velocity), ("TENSION_ONLY", tension_only),
                             ("FORCES", held_forces)):
            if wanted:
                definition.flags |= getattr(lib, f"SPRING_SCENE_{flag}")
        for method in methods:
            definition.methods |= 1 << method_number(method)
        if np.ndim(mass) == 0:
            if not 0 < float(mass) < np.inf:  # 0 would mean 1
                invalid("mass", mass)
            definition.mass_all = mass
        else:
            given["mass"] = self._numbers("mass", mass, (self._particles,))
        if velocity is not None:
            given["velocity"] = self._numbers("velocity", velocity, positions.shape)
        if pinned is not None:
            given["pinned"] = self._flags(pinned, self._particles)
            self._pinned[:] = given["pinned"]
        lent = {field: ffi.from_buffer(array) for field, array in given.items()}
        for field, buffer in lent.items():
            setattr(definition, field, ffi.cast(ffi.typeof(getattr(definition, field)), buffer))
        if force is not None:
            definition.force = self._function()

        field, index = ffi.new("const char **"), ffi.new("size_t *")
        if status := self._c("check")(definition, field, index):
            self._refuse(status, ffi.string(field[0]).decode() if field[0] else None, index[0], definition, given, methods)
        size = ffi.new("size_t *")
        self._c("bytes")(definition, size)
        self._take(size[0])
        if force is not None:
            self._called = _Called(force, self)
            definition.user = self._called.handle
        scene = ffi.new(f"{self._prefix} **")
        if status := self._c("init")(self._pointer, size[0], definition, scene):
            fail(status)

    # --- between Python and C

    def _c(self, name: str) -> Any:
        return getattr(lib, f"{self._prefix}_{name}")

    def _function(self) -> Any:
        return lib.springstep_force if self._prefix == "spring_scene" else lib.springstep_forcef

    def _take(self, size: int) -> None:
        """Allocate the memory of the scene."""
        self._memory = np.empty(size, np.uint8)
        self._lent = ffi.from_buffer(self._memory)
        self._pointer = ffi.cast(f"{self._prefix} *", self._lent)

    def _ask(self, name: str, *arguments: Any) -> Any:
        """Call a function of C that takes little time."""
        return self._guard.short(self._c(name), self._pointer, *arguments)

    def _vector(self, field: str, values: ArrayLike) -> list[float]:
        array = np.asarray(values, np.float64)
        if array.shape != (self._axes,):
            raise ValueError(f"{field}: its shape is {array.shape}, not ({self._axes},)")
        return [finite(field, value) for value in array.tolist()]

    @staticmethod
    def _numbers(field: str, values: ArrayLike, shape: tuple[int, ...]) -> np.ndarray:
        array = np.ascontiguousarray(values, np.float64)
        if array.ndim + 1 == len(shape) and shape[-1] == 1:
            array = array[:, np.newaxis]
        if array.shape != shape:
            raise ValueError(f"{field}: its shape is {array.shape}, not {shape}")
        return array

    @staticmethod
    def _flags(values: ArrayLike, count: int | None = None) -> np.ndarray:
        flags = np.ascontiguousarray(values, bool).view(np.uint8)
        if flags.ndim != 1 or (count is not None and len(flags) != count):
            raise ValueError(f"pinned: its shape is {flags.shape}, not {'(count,)' if count is None else (count,)}")
        return flags

    def _refuse(self, status: int, field: str | None, index: int, definition: Any, given: dict[str, np.ndarray],
                methods: tuple[str, ...]) -> None:
        """Raise the exception for an invalid definition."""
        name, _, part = (field or "").partition(".")
        if name in given and index < len(given[name]):
            value = given[name][index]
            fail(status, field, (value[part] if part else value).tolist(), index)
        if name == "methods":
            fail(status, field, methods)
        if name == "flags":
            fail(status, "tension_only", True)
        value = getattr(definition, name, None)
        fail(status, field, value if isinstance(value, (int, float)) else None)

    def _run(self, name: str, *arguments: Any) -> Any:
        """Call a C function that may call the force, and raise the exception of the force."""
        result = self._c(name)(self._pointer, *arguments)
        if self._called is not None and self._called.error is not None:
            error, self._called.error = self._called.error, None
            raise error
        return result

    def _advance(self, number: int, dt: float, steps: int) -> int:
        # C gives up at forces that are NaN, but does not use all forces: not those of pinned particles, nor, with a method
        # that uses positions only, the last ones of a call, which are kept for the next call.
        unused = self._pinned.all() or lib.spring_method_describe(number).positions_only
        before = self._save() if self._called is not None and self._undo and unused else None
        try:
            return self._run("advance", number, dt, steps)
        except BaseException:
            if before is not None:
                self._load(before)
            raise

    # --- what it is

    def __len__(self) -> int:
        """The number of particles."""
        return self._particles

    axes = property(lambda self: self._axes, doc="1, 2 or 3")
    links = property(lambda self: self._links, doc="number of links, cut ones included")
    dtype = property(lambda self: self._dtype, doc="float64 or float32: what the scene computes in")

    @property
    def nbytes(self) -> int:
        """Size of the scene and of a snapshot [bytes]."""
        return len(self._memory)

    @property
    def time(self) -> float:
        """Simulated time [s] since the scene was created."""
        return self._ask("time")

    def energy(self) -> Energies:
        """The energies [J]."""
        energies = self._ask("energy")
        return Energies(energies.kinetic, energies.elastic, energies.gravity)

    def at_rest(self, v_tol: float, a_tol: float) -> bool:
        """Whether every speed is at most v_tol [m/s] and every acceleration of a free particle at most a_tol [m/s^2]."""
        return self._guard.long(self._run, "at_rest", v_tol, a_tol)

    # --- steps

    def advance(self, dt: float, steps: int = 1, method: str = "leapfrog") -> None:
        """Advance by a number of steps of dt [s]; a negative dt integrates backwards.

        After an error, including an exception of force(), the scene is unchanged, except without undo. Ctrl-C takes effect
        in force() or after the call: split a long run into several calls, whose results are bit-identical.
        """
        status = self._guard.long(self._advance, method_number(method), dt, step_count(steps))
        if status == lib.SPRING_EINVAL:
            invalid("dt", dt)
        if status in (lib.SPRING_EUNSUPPORTED, lib.SPRING_EDISABLED):
            fail(status, "method", method)
        if status:
            fail(status)

    def stable_step(self, method: str = "leapfrog") -> float:
        """A lower bound of the stability limit [s]; use half. 0: none is known; infinity: every step is stable."""
        step = self._ask("stable_step", method_number(method))
        if np.isnan(step):
            fail(lib.SPRING_EUNSUPPORTED, "method", method)
        return step

    # --- state

    def _get(self, quantity: int, first: int, count: int | None, out: np.ndarray | None) -> np.ndarray:
        if out is None:
            out = np.empty((max(0, self._particles - first) if count is None else count, self._axes), self._dtype)
        elif not self._fits(out):
            raise TypeError(f"out: not a writeable array of float64 or float32, (count, {self._axes}), with rows in one piece")
        elif count is not None and count != len(out):
            raise ValueError("count: not that of out")
        get, pointer = ("get", "double *") if out.dtype == np.float64 else ("getf", "float *")
        stride = out.strides[0] // out.itemsize if len(out) > 1 else 0
        start = ffi.cast(pointer, out.ctypes.data)
        if status := self._ask(get, quantity, start, stride, _natural("first", first), len(out)):
            if status == lib.SPRING_EDISABLED:
                fail(status, "held_forces", False)
            fail(status, "first, count", (first, len(out)))
        return out

    def _fits(self, out: Any) -> bool:
        """Whether the C library can write rows to the array, with a stride."""
        if not isinstance(out, np.ndarray) or out.ndim != 2 or out.shape[1] != self._axes or out.dtype not in _PREFIXES:
            return False
        if not (out.flags.writeable and out.flags.aligned):
            return False
        stride, rest = divmod(out.strides[0], out.itemsize)
        return len(out) < 1 or (out.strides[1] == out.itemsize and (len(out) == 1 or (stride >= self._axes and rest == 0)))

    def _set(self, quantity: int, field: str, values: ArrayLike, first: int) -> None:
        array = np.asarray(values, np.float64)
        array = self._numbers(field, array, (len(array) if array.ndim else 0, self._axes))
        pointer = ffi.cast("double *", ffi.from_buffer(array))
        status = self._ask("set", quantity, pointer, 0, _natural("first", first), len(array))
        if status == lib.SPRING_EINVAL:
            with np.errstate(over="ignore"):
                row = int(np.flatnonzero(~np.isfinite(array.astype(self._dtype)).all(axis=1))[0])
            fail(status, field, array[row].tolist(), first + row)
        if status == lib.SPRING_EDISABLED:
            fail(status, "held_forces", False)
        if status:
            fail(status, "first, count", (first, len(array)))

    def position(self, first: int = 0, count: int | None = None, out: np.ndarray | None = None) -> np.ndarray:
        """Positions [m] of particles first ... first + count - 1, by default all: (count, axes).

        They are copied into `out` if it is given: an array of float64 or float32, such as a part of a vertex buffer.
        """
        return self._get(lib.SPRING_POSITION, first, count, out)

    def velocity(self, first: int = 0, count: int | None = None, out: np.ndarray | None = None) -> np.ndarray:
        """Velocities [m/s], as position()."""
        return self._get(lib.SPRING_VELOCITY, first, count, out)

    def set_position(self, values: ArrayLike, first: int = 0) -> None:
        """Set positions [m] of particles from `first` on: (count, axes). To move a pinned particle, use drive()."""
        self._set(lib.SPRING_POSITION, "position", values, first)

    def set_velocity(self, values: ArrayLike, first: int = 0) -> None:
        """Set velocities [m/s], as set_position()."""
        self._set(lib.SPRING_VELOCITY, "velocity", values, first)

    def held_force(self, first: int = 0, count: int | None = None, out: np.ndarray | None = None) -> np.ndarray:
        """Held forces [N] of a scene with held_forces, as position()."""
        return self._get(lib.SPRING_FORCE, first, count, out)

    def set_held_force(self, values: ArrayLike, first: int = 0) -> None:
        """Set the forces [N] that act on particles from `first` on until they are set again: (count, axes).

        They act like gravity, with every method, and changing them costs nothing. Wind, for example, is computed from the
        state once a frame and held for its steps.
        """
        self._set(lib.SPRING_FORCE, "held_force", values, first)

    def transform(self, matrix: ArrayLike) -> None:
        """Move all particles, pinned ones too: x = A x + b and v = A v, with the matrix [A b], (axes, axes + 1)."""
        array = self._numbers("matrix", matrix, (self._axes, self._axes + 1))
        rows = ffi.new("double[12]")
        for row in range(self._axes):
            for column in range(self._axes):
                rows[4 * row + column] = array[row, column]
            rows[4 * row + 3] = array[row, self._axes]
        if status := self._ask("transform", rows):
            fail(status, "matrix", array.tolist())

    def _save(self) -> Snapshot:
        return Snapshot(self, self._memory.tobytes(), self._called, self._pinned.copy())

    def _load(self, snapshot: Snapshot) -> None:
        self._memory[:] = np.frombuffer(snapshot._memory, np.uint8)
        self._called = snapshot._called
        self._pinned[:] = snapshot._pinned

    def snapshot(self) -> Snapshot:
        """All of it, to go back to."""
        return self._guard.short(self._save)

    def restore(self, snapshot: Snapshot) -> None:
        """Go back to a snapshot of this scene, to the bit."""
        if snapshot._scene is not self:
            raise ValueError("snapshot: of another scene")
        self._guard.short(self._load, snapshot)

    def __reduce__(self) -> NoReturn:
        raise TypeError("a scene is not copied: see snapshot()")

    # --- changes

    def set_gravity(self, gravity: ArrayLike) -> None:
        """Change gravity [m/s^2], a number for each axis."""
        self._ask("set_gravity", [*self._vector("gravity", gravity), 0, 0][:3])

    def set_colliders(self, colliders: Iterable[Collider]) -> None:
        """Replace all colliders, at most as many as there is room for; [] removes them.

        They are where they say now, and then move at their velocities. Set them once a frame.
        """
        given = list(colliders)
        array = ffi.new("spring_collider[]", len(given))
        for place, collider in enumerate(given):
            self._fill_collider(array[place], collider, place)
        if status := self._ask("set_colliders", array, len(given)):
            if status == lib.SPRING_EINVAL:
                self._refuse_colliders(array, given)
            fail(status, "colliders", len(given))

    def _fill_collider(self, c: Any, collider: Collider, place: int) -> None:
        if not isinstance(collider, Collider):
            raise TypeError(f"colliders[{place}]: a {type(collider).__name__}, not a Collider")
        if collider.shape not in _SHAPES:
            invalid("colliders.shape", collider.shape, place, reason=f"not one of {', '.join(_SHAPES)}")
        c.shape = _SHAPES[collider.shape]
        for field in ("at", "to", "half", "velocity", "velocity_to"):
            setattr(c, field, self._short_vector(f"colliders.{field}", getattr(collider, field), place))
        if np.ndim(collider.spin) == 0:
            if self._axes == 3:
                invalid("colliders.spin", collider.spin, place, reason="not three numbers")
            c.spin[2] = collider.spin
        else:
            c.spin = self._short_vector("colliders.spin", collider.spin, place)
        for row, axis in enumerate(collider.axis[:3]):
            c.axis[row] = self._short_vector("colliders.axis", axis, place)
        for field in ("radius", "friction", "restitution"):
            setattr(c, field, getattr(collider, field))

    def _short_vector(self, field: str, values: Sequence[float], place: int) -> list[float]:
        """Three numbers; two will do on two axes."""
        if np.ndim(values) != 1 or len(values) not in (self._axes, 3):
            invalid(field, values, place, reason=f"not {self._axes} numbers")
        return [*map(float, values), 0.0][:3]

    def _refuse_colliders(self, array: Any, given: list[Collider]) -> NoReturn:
        """The exception for colliders of which C refuses one."""
        field, index = ffi.new("const char **"), ffi.new("size_t *")
        status = self._ask("check_colliders", array, len(given), field, index)
        name = ffi.string(field[0]).decode()
        if name == "count":
            fail(status, "colliders")
        reason = {"axis": "not unit vectors at right angles", "restitution": "not 0 to 1"}.get(name)
        invalid(f"colliders.{name}", getattr(given[index[0]], name), index[0], reason)

    def touching(self, first: int = 0, count: int | None = None) -> np.ndarray:
        """Which colliders particles first ... first + count - 1 touched in the last step: bit i stands for collider i."""
        mask = np.empty(max(0, self._particles - first) if count is None else count, np.uint32)
        pointer = ffi.cast("uint32_t *", ffi.from_buffer(mask))
        if status := self._ask("touching", pointer, _natural("first", first), len(mask)):
            if status == lib.SPRING_EDISABLED:
                fail(status, "colliders", 0)
            fail(status, "first, count", (first, len(mask)))
        return mask

    def set_force(self, force: Force | None) -> None:
        """Change the force; None: none. Call it, too, after a change of what the force depends on."""
        called = None if force is None else _Called(force, self)

        def change() -> None:
            function, user = (self._function(), called.handle) if called else (ffi.NULL, ffi.NULL)
            self._c("set_force")(self._pointer, function, user)
            self._called = called

        self._guard.short(change)

    def link(self, index: int) -> tuple[int, int, float, float, float]:
        """A link as it is now: a, b, rest [m], stiffness [N/m], damping [N s/m]; a and b may be swapped."""
        link = ffi.new("spring_link *")
        if status := self._ask("get_link", _natural("link", index), link):
            fail(status, "link", index)
        return link.a, link.b, link.rest, link.stiffness, link.damping

    def set_link(self, index: int, *, rest: float | None = None, stiffness: float | None = None,
                 damping: float | None = None) -> None:
        """Change what is given of a link of an editable scene: [m], [N/m], [N s/m]; stiffness 0 and damping 0 cut it."""
        link = ffi.new("spring_link *")

        def change() -> int:
            link[0] = self.link(index)
            for field, value in (("rest", rest), ("stiffness", stiffness), ("damping", damping)):
                if value is not None:
                    setattr(link, field, value)
            return self._ask("set_link", index, link)

        if status := self._guard.short(change):
            if status == lib.SPRING_EINVAL:
                for field in ("rest", "stiffness", "damping"):
                    if not 0 <= getattr(link, field) < np.inf:
                        fail(status, f"link.{field}", getattr(link, field), index)
            fail(status, "link", (link.a, link.b, link.rest, link.stiffness, link.damping), index)

    def set_links(self, links: ArrayLike, first: int = 0) -> None:
        """Change links from `first` on of an editable scene, all of them or none: like `links` of Scene, a and b as there."""
        array = _joined(links)
        status = self._ask("set_links", _natural("first", first), len(array),
                           ffi.cast("spring_link *", ffi.from_buffer(array)))
        if status == lib.SPRING_EINVAL:
            for field in ("rest", "stiffness", "damping"):
                if (wrong := np.flatnonzero(~((array[field] >= 0) & np.isfinite(array[field])))).size:
                    fail(status, f"link.{field}", array[field][wrong[0]].item(), first + int(wrong[0]))
        if status:
            fail(status, "first, count" if status == lib.SPRING_ERANGE else "links", (first, len(array)))

    def tear(self, stretch: float | ArrayLike) -> np.ndarray:
        """Cut links of an editable scene that are longer than stretch times their rest length; returns their indices.

        stretch: a number, or one for each link; infinity: it never tears. Call it once a frame.
        """
        limits = None if np.ndim(stretch) == 0 else self._numbers("stretch", stretch, (self._links,))
        torn = np.empty(self._links, np.uint32)
        count = ffi.new("size_t *")
        status = self._ask("tear", stretch if limits is None else 0.0,
                           ffi.NULL if limits is None else ffi.cast("double *", ffi.from_buffer(limits)),
                           ffi.cast("uint32_t *", ffi.from_buffer(torn)), len(torn), count)
        if status == lib.SPRING_EINVAL:
            row = None if limits is None else int(np.flatnonzero(~(limits >= 0))[0])
            fail(status, "stretch", stretch if limits is None else limits[row].item(), row)
        if status:
            fail(status, "editable", False)
        return torn[:count[0]].copy()

    def find_link(self, a: int, b: int) -> int | None:
        """The first link between two particles, in either order, or None. Looks at all links."""
        index = self._ask("find_link", _natural("a", a), _natural("b", b))
        return index if index < self._links else None

    def set_pinned(self, pinned: ArrayLike, first: int = 0) -> None:
        """Pin and free particles from `first` on of an editable scene. What was free stops where it is; freed, it flies on."""
        flags = self._flags(pinned)

        def change() -> int:
            status = self._ask("set_pinned", _natural("first", first), len(flags), ffi.from_buffer("uint8_t[]", flags))
            if not status:
                self._pinned[first:first + len(flags)] = flags
            return status

        if status := self._guard.short(change):
            fail(status, "pinned", flags.astype(bool).tolist(), first)

    def set_mass(self, mass: ArrayLike, first: int = 0) -> None:
        """Change the masses [kg] of particles from `first` on of an editable scene."""
        array = self._numbers("mass", mass, (np.size(mass),))
        if status := self._ask("set_mass", _natural("first", first), len(array), ffi.from_buffer("double[]", array)):
            fail(status, "mass", array.tolist(), first)

    def drive(self, particle: int, target: ArrayLike | None, duration: float = 0.0) -> None:
        """Give a pinned particle the velocity that brings it to a target [m] within duration > 0 [s]; None: it stops."""
        to = None if target is None else self._vector("target", target)
        place = ffi.NULL if to is None else ffi.new("double[3]", to)
        if status := self._ask("drive", _natural("particle", particle), place, duration):
            if status == lib.SPRING_ERANGE:
                fail(status, "particle", particle)
            if not self._pinned[particle]:
                invalid("particle", particle, reason="not pinned")
            with np.errstate(over="ignore"):
                if 0 < duration < np.inf and not np.isfinite(to - self.position(particle, 1)).all():
                    invalid("target", to, reason="too far away")
            invalid("duration", duration, reason="not a finite time > 0 in which a finite velocity reaches the target")

    def tension(self, index: int) -> float:
        """The force along a link [N], > 0 pulls; its damping included."""
        if not 0 <= index < self._links:
            fail(lib.SPRING_ERANGE, "link", index)
        return self._ask("tension", index)

    def __repr__(self) -> str:
        return f"<Scene of {self._particles} particles and {self._links} links on {self._axes} axes, {self._dtype}>"


def _joined(links: ArrayLike) -> np.ndarray:
    """Links as an array of LINK."""
    if not isinstance(links, np.ndarray):
        links = list(links)
        records = len(links) > 0 and isinstance(links[0], np.void)  # elements of a structured array, with names
        links = np.array(links) if records else np.array([tuple(link) for link in links], LINK)
    if links.ndim != 1:
        raise ValueError(f"links: its shape is {links.shape}, not (links,)")
    if links.dtype.names is None:
        if len(links) > 0 and links.dtype != object:
            raise ValueError(f"links: an array of {links.dtype}, not of tuples or structures")
        return np.ascontiguousarray(links, LINK)
    missing = [name for name in LINK.names if name not in links.dtype.names]
    unknown = [name for name in links.dtype.names if name not in LINK.names]
    if missing or unknown:
        raise ValueError(f"links: missing fields {missing}, unknown fields {unknown}")
    joined = np.empty(len(links), LINK)
    for name in LINK.names:  # NumPy assigns structures by position
        joined[name] = links[name]
    return joined


def components(particles: int, links: ArrayLike) -> tuple[int, np.ndarray]:
    """How many pieces links join particles to, and the piece of each particle: 0, 1, ... by their first particles.

    Links without stiffness and damping, such as torn ones, do not join.
    """
    joined = _joined(links)
    piece = np.empty(_natural("particles", particles), np.uint32)
    count = lib.spring_links_components(len(piece), len(joined), ffi.cast("spring_link *", ffi.from_buffer(joined)),
                                        ffi.cast("uint32_t *", ffi.from_buffer(piece)))
    if count == 0 and len(piece) > 0:
        fail(lib.SPRING_EINVAL, "links")
    return count, piece


def _natural(field: str, index: int) -> int:
    """An index from 0 on: unlike those of lists they do not count from the end."""
    if index < 0:
        fail(lib.SPRING_ERANGE, field, index)
    return index
