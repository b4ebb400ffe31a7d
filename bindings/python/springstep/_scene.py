# SPDX-License-Identifier: MIT
"""Mass-spring systems: rope, cloth, soft bodies and height-field water."""
from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Generic, Literal, NamedTuple, NoReturn, TypedDict, TypeVar, overload

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from springstep._colliders import Collider, colliders_from
from springstep._common import (Guard, MethodName, SpringError, aligned, fail, fail_step, invalid, method_number, methods,
                                names_of, remade, step_count)
from springstep._force import AnyForce, CForce, PythonForce, called_force
from springstep._links import WEIGHTED_LINK, Grid, joined, lend, natural, weighted
from springstep._native import ffi, lib

if TYPE_CHECKING:
    from typing_extensions import Unpack

F = TypeVar("F", bound=np.floating[Any])

_PREFIXES = {np.dtype(np.float64): "spring_scene", np.dtype(np.float32): "spring_scenef"}
_VALUES = ("rest", "stiffness", "damping")  # of a link
_UNINTERRUPTED = 2**20  # numbers that run() advances by a step before it can be interrupted: some milliseconds
_POSITIONS_ONLY = {method.name for method in methods() if method.positions_only}


class Energies(NamedTuple):
    """The energies of a scene [J]."""

    kinetic: float  #: of particles that are not pinned
    elastic: float  #: of all links
    gravity: float  #: of particles that are not pinned; 0 at the origin


class SceneOptions(TypedDict, total=False):
    """The keyword arguments of `Scene`, except `dtype`."""

    rest: ArrayLike | None
    stiffness: ArrayLike | None
    damping: ArrayLike | None
    weighted_links: ArrayLike | None
    velocity: ArrayLike | None
    mass: ArrayLike
    pinned: ArrayLike | None
    gravity: ArrayLike | None
    drag: float
    force: AnyForce | None
    force_data: NDArray[Any] | None
    force_ignores_velocity: bool
    methods: Iterable[MethodName] | None
    editable: bool
    undo: bool
    tension_only: bool
    held_forces: bool
    max_speed: float
    colliders: int
    particle_radius: ArrayLike
    particle_friction: ArrayLike | None
    particle_mask: ArrayLike | None


class GridOptions(SceneOptions, total=False):
    """The keyword arguments of `Scene.from_grid`, except `dtype`."""

    position: ArrayLike
    links: ArrayLike


class Snapshot:
    """The state of a scene at a time, including its force, for `Scene.restore`."""

    __slots__ = ("_scene", "_memory", "_called", "_bodies", "_pinned", "_time")

    def __init__(self, scene: Scene[Any], time: float) -> None:
        self._scene, self._time = scene, time
        self._memory, self._called, self._bodies = scene._memory.tobytes(), scene._called, scene._bodies
        self._pinned = scene._pinned.copy()

    def __len__(self) -> int:
        """Size of the snapshot [bytes]."""
        return len(self._memory)

    def __repr__(self) -> str:
        return f"<Snapshot at {self._time!r} s of {self._scene!r}>"


class Scene(Generic[F]):
    """A mass-spring system: mass x'' = link forces + mass gravity - drag x' + force(t, x, x').

    The definition is copied into a block of memory, as in C. `position`, `velocity` and similar methods copy values out of
    it. While one thread advances a scene, its methods raise `RuntimeError` in other threads, and in its own force.

    Parameters
    ----------
    position : array_like
        [m], (particles, axes); (particles,) for one axis.
    links : array_like
        One row per link: (links, 5) with a, b, rest [m], stiffness [N/m] and damping [N s/m]; or (links, 2) with the indices
        a and b of its particles; or a structured array with fields `a` and `b`, or `ends` for both, and any of the others.
    rest, stiffness, damping : array_like, optional
        What `links` does not have, for all links or for each. By default the rest length is the initial length, and
        the damping 0.
    weighted_links : array_like, optional
        Springs between weighted points, as an array of WEIGHTED_LINK: from `bend_rod` and similar functions, or attachments.
    velocity : array_like, optional
        [m/s], like position. By default all particles are at rest.
    mass : array_like
        [kg] > 0, of all or for each particle.
    pinned : array_like, optional
        For each particle, True: no force acts on it, and it keeps its velocity. By default none is pinned.
    gravity : array_like, optional
        [m/s^2], one number per axis.
    drag : float
        [N s/m] >= 0, on every particle.
    force : callable, optional
        ``force(t, position, velocity, force)`` adds to ``force[axis, particle]`` [N] and returns None. Or a function in C,
        of type `spring_scene_force_fn`, or `spring_scenef_force_fn` for float32: a `numba.cfunc`, a
        `scipy.LowLevelCallable`, or a function of ctypes or cffi.
    force_data : ndarray, optional
        The C function receives a pointer to the first element of this array as `user`.
    force_ignores_velocity : bool
        The force does not use velocities, and a function in Python receives zeros. Leapfrog then needs one evaluation per
        step instead of two.
    methods : iterable of str, optional
        Names of the methods that will be used. By default all except those that store stages or drag factors.
    editable : bool
        Links, pins and masses may change.
    undo : bool
        False: an `advance` that fails loses the state, and memory is saved.
    dtype : dtype
        float64 or float32, the precision of the simulation.
    tension_only : bool
        Links pull and never push, as in ropes and nets; for two or three axes.
    held_forces : bool
        Reserves memory for forces that are held until they are changed, see `set_held_force`.
    max_speed : float
        [m/s] A step after which a free particle is faster along an axis fails; 0: no limit.
    colliders : int
        Maximum number of colliders, at most 32, see `set_colliders`; for two or three axes.
    particle_radius : array_like
        [m] >= 0, of all or for each particle, for contacts.
    particle_friction : array_like, optional
        >= 0, for each particle: a factor of the friction of colliders. By default 1.
    particle_mask : array_like, optional
        For each particle an integer. It collides with colliders whose `mask` has a bit in common, and with none if it is 0.
        By default all bits.

    Raises
    ------
    SpringError
        `InvalidError`, `RangeError` or `UnsupportedError`, for an invalid definition. `field`, `index` and `value` identify
        the invalid value.
    """

    __slots__ = ("_dtype", "_prefix", "_particles", "_axes", "_links", "_called", "_unseen_velocity", "_pinned", "_undo",
                 "_definition", "_guard", "_memory", "_lent", "_pointer", "_bodies", "__weakref__")

    @overload
    def __init__(self: Scene[np.float64], position: ArrayLike, links: ArrayLike = ..., *misplaced: NoReturn,
                 dtype: type[np.float64] | Literal["float64"] = ..., **options: Unpack[SceneOptions]) -> None: ...

    @overload
    def __init__(self: Scene[np.float32], position: ArrayLike, links: ArrayLike = ..., *misplaced: NoReturn,
                 dtype: type[np.float32] | Literal["float32"], **options: Unpack[SceneOptions]) -> None: ...

    @overload
    def __init__(self: Scene[Any], position: ArrayLike, links: ArrayLike = ..., *misplaced: NoReturn,
                 dtype: DTypeLike, **options: Unpack[SceneOptions]) -> None: ...

    def __init__(self, position: ArrayLike, links: ArrayLike = (), *misplaced: object, rest: ArrayLike | None = None,
                 stiffness: ArrayLike | None = None, damping: ArrayLike | None = None,
                 weighted_links: ArrayLike | None = None, velocity: ArrayLike | None = None, mass: ArrayLike = 1.0, pinned: ArrayLike | None = None, gravity: ArrayLike | None = None,
                 drag: float = 0.0, force: AnyForce | None = None, force_data: NDArray[Any] | None = None,
                 force_ignores_velocity: bool = False, methods: Iterable[MethodName] | None = None, editable: bool = False,
                 undo: bool = True, dtype: DTypeLike = np.float64, tension_only: bool = False, held_forces: bool = False,
                 max_speed: float = 0.0, colliders: int = 0, particle_radius: ArrayLike = 0.0,
                 particle_friction: ArrayLike | None = None, particle_mask: ArrayLike | None = None) -> None:
        if misplaced or isinstance(position, Grid):
            raise TypeError("Scene(position, links, ...): all other arguments have names; for a grid use Scene.from_grid()")
        self._dtype: np.dtype[Any] = np.dtype(dtype)
        if self._dtype not in _PREFIXES:
            raise TypeError("dtype: not float64 or float32")
        self._prefix = _PREFIXES[self._dtype]
        positions = aligned(position, np.float64)
        if positions.ndim == 1:
            positions = positions[:, np.newaxis]
        if positions.ndim != 2 or not 1 <= positions.shape[1] <= 3:
            raise ValueError(f"position: its shape is {np.shape(position)}, not (particles, axes)")
        self._particles, self._axes = map(int, positions.shape)
        link = joined(links, positions, rest=rest, stiffness=stiffness, damping=damping)
        self._links = len(link)
        names = names_of("methods", methods or ())
        self._called: PythonForce | CForce | None = None
        self._bodies: list[Collider] = []  # all colliders if one is custom, to keep functions and their data alive
        self._unseen_velocity: NDArray[Any] | None = None
        if force_ignores_velocity:
            self._unseen_velocity = np.zeros((self._axes, self._particles), self._dtype)
            self._unseen_velocity.flags.writeable = False
        self._pinned = np.zeros(self._particles, np.bool_)
        self._undo = undo
        self._guard = Guard("the scene is being advanced, or was called from its own force")

        bending = weighted(weighted_links)
        given: dict[str, NDArray[Any]] = {"position": positions, "link": link, "weighted_link": bending}
        definition = ffi.new(f"{self._prefix}_def *", {
            "axes": self._axes, "particles": self._particles, "links": self._links, "weighted_links": len(bending), "drag": drag, "max_speed": max_speed,
            "colliders": natural("colliders", colliders),
            "gravity": self._vector("gravity", gravity) if gravity is not None else [],
        })
        for flag, wanted in (("EDITABLE", editable), ("NO_UNDO", not undo),
                             ("FORCE_IGNORES_VELOCITY", force_ignores_velocity), ("TENSION_ONLY", tension_only),
                             ("FORCES", held_forces)):
            if wanted:
                definition.flags |= getattr(lib, f"SPRING_SCENE_{flag}")
        for name in names:
            definition.methods |= 1 << method_number(name)
        if np.ndim(mass) == 0:
            if not 0 < float(np.asarray(mass)) < np.inf:  # 0 would mean 1
                invalid("mass", mass)
            definition.mass_all = mass
        else:
            given["mass"] = self._numbers("mass", mass, (self._particles,))
        if velocity is not None:
            given["velocity"] = self._numbers("velocity", velocity, positions.shape)
        if pinned is not None:
            given["pinned"] = self._flags(pinned, self._particles)
            self._pinned[:] = given["pinned"]
        if np.ndim(particle_radius) == 0:
            definition.particle_radius = particle_radius
        else:
            given["radius"] = self._numbers("particle_radius", particle_radius, (self._particles,))
        if particle_friction is not None:
            given["friction"] = self._numbers("particle_friction", particle_friction, (self._particles,))
        if particle_mask is not None:
            given["mask"] = self._masks(particle_mask)
        for field in ("radius", "friction"):  # C reads them only if there are colliders
            values = given.get(field, np.empty(0))
            for row in np.flatnonzero(~((values >= 0) & (values < np.inf)))[:1].tolist():
                invalid(f"particle_{field}", values[row].item(), row)
        # For copies. Positions, velocities, gravity and the force are part of the state.
        self._definition: dict[str, Any] = {
            "links": link, "weighted_links": bending, "mass": np.array(mass), "pinned": self._pinned.copy(), "drag": drag,
            "force_ignores_velocity": force_ignores_velocity, "methods": names, "editable": editable, "undo": undo,
            "dtype": self._dtype, "tension_only": tension_only, "held_forces": held_forces, "max_speed": max_speed,
            "colliders": colliders, "particle_radius": np.array(particle_radius),
            **{f"particle_{field}": given[field].copy() for field in ("friction", "mask") if field in given},
        }
        if force is not None:  # for what depends on whether there is one
            definition.force = lib.springstep_force if self._dtype == np.float64 else lib.springstep_forcef

        lend(definition, given, self._c("check"), names)
        size = ffi.new("size_t *")
        self._c("bytes")(definition, size)
        self._memory = np.empty(size[0], np.uint8)
        self._lent = ffi.from_buffer(self._memory)
        self._pointer = ffi.cast(f"{self._prefix} *", self._lent)
        if force is not None:
            self._called = called_force(force, force_data, self)
            definition.force, definition.user = self._called.pointer, self._called.user
        scene = ffi.new(f"{self._prefix} **")
        if status := self._c("init")(self._pointer, size[0], definition, scene):
            fail(status)

    @overload
    @classmethod
    def from_grid(cls, grid: Grid, *, dtype: type[np.float64] | Literal["float64"] = ...,  # type: ignore[overload-overlap]
                  **overrides: Unpack[GridOptions]) -> Scene[np.float64]: ...

    @overload
    @classmethod
    def from_grid(cls, grid: Grid, *, dtype: type[np.float32] | Literal["float32"],
                  **overrides: Unpack[GridOptions]) -> Scene[np.float32]: ...

    @classmethod
    def from_grid(cls, grid: Grid, **overrides: Any) -> Scene[Any]:
        """Return a scene of the particles, links and pinned particles of a grid.

        Parameters
        ----------
        grid : Grid
            See `springstep.grid`.
        **overrides
            The other arguments of `Scene`, or arguments instead of those of the grid.
        """
        return cls(**{**grid._asdict(), **overrides})

    # --- between Python and C

    def _c(self, name: str) -> Any:
        return getattr(lib, f"{self._prefix}_{name}")

    def _ask(self, name: str, *arguments: Any) -> Any:
        """Call a function of C that takes little time."""
        return self._guard.short(self._c(name), self._pointer, *arguments)

    def _vector(self, field: str, values: ArrayLike) -> list[float]:
        array = np.asarray(values, np.float64)
        if array.shape != (self._axes,):
            raise ValueError(f"{field}: its shape is {array.shape}, not ({self._axes},)")
        with np.errstate(over="ignore"):
            for value in array[~np.isfinite(array.astype(self._dtype))][:1].tolist():
                invalid(field, value)
        return [*map(float, array)]

    @staticmethod
    def _numbers(field: str, values: ArrayLike, shape: tuple[int, ...]) -> NDArray[np.float64]:
        array = aligned(values, np.float64)
        if 0 < array.ndim == len(shape) - 1 and shape[-1] == 1:
            array = array[:, np.newaxis]
        if array.shape != shape:
            raise ValueError(f"{field}: its shape is {array.shape}, not {shape}")
        return array

    @staticmethod
    def _flags(values: ArrayLike, count: int | None = None) -> NDArray[np.uint8]:
        flags = np.asarray(values, np.bool_, order="C").view(np.uint8)
        if flags.ndim != 1 or (count is not None and len(flags) != count):
            raise ValueError(f"pinned: its shape is {flags.shape}, not {'(count,)' if count is None else (count,)}")
        return flags

    def _masks(self, values: ArrayLike) -> NDArray[np.uint32]:
        array = np.asarray(values)
        if array.shape != (self._particles,):
            raise ValueError(f"particle_mask: its shape is {array.shape}, not {(self._particles,)}")
        with np.errstate(invalid="ignore"):
            masks = array.astype(np.uint32)
        if (wrong := np.flatnonzero(masks != array)).size:
            invalid("particle_mask", array[wrong[0]].item(), int(wrong[0]), "not an integer from 0 to 2^32 - 1")
        return masks

    def _count(self, first: int, count: int | None) -> int:
        """Return a number of particles, by default all from the first on."""
        count = max(0, self._particles - first) if count is None else count
        if not 0 <= count <= self._particles:
            fail(lib.SPRING_ERANGE, "first, count", (first, count))
        return count

    def _set_rows(self, name: str, kind: str, field: str, array: NDArray[Any], first: int) -> None:
        """Change consecutive masses or links by a function of C. An error names the first value that it refuses."""
        first, pointer = natural("first", first), ffi.cast(kind, ffi.from_buffer(array))
        status = self._ask(name, first, len(array), pointer)
        if status == lib.SPRING_EINVAL:
            memory = self._guard.short(self._memory.copy)  # a scene, too, in which one row after the other is changed
            copied = ffi.cast(f"{self._prefix} *", ffi.from_buffer(memory))
            for row in range(len(array)):
                if self._c(name)(copied, first + row, 1, pointer + row):
                    value = array[row]
                    for part in _VALUES if value.dtype.names else ():
                        if not 0 <= value[part] <= np.finfo(self._dtype).max:
                            fail(status, f"{field}.{part}", value[part].item(), first + row)
                    fail(status, field, value.tolist(), first + row)
        if status:
            fail(status, "first, count" if status == lib.SPRING_ERANGE else field, (first, len(array)))

    def _run(self, name: str, *arguments: Any) -> int:
        """Call a C function that may call the force, and raise the exception of the force."""
        return self._call(self._c(name), *arguments)

    def _call(self, function: Any, *arguments: Any) -> int:
        result: int = function(self._pointer, *arguments)
        if self._called is not None and self._called.error is not None:
            error, self._called.error = self._called.error, None
            raise error
        return result

    def _advance(self, method: MethodName, dt: float, steps: int) -> int:
        # C gives up at forces that are NaN, but does not use all forces: not those of pinned particles, nor, with a method
        # that uses positions only, the last ones of a call, which are kept for the next call.
        before = None
        if isinstance(self._called, PythonForce) and self._undo and (self._pinned.all() or method in _POSITIONS_ONLY):
            before = self._save()
        try:
            return self._run("advance", method_number(method), dt, steps)
        except BaseException:
            if before is not None:
                self._load(before)
            raise

    def _check_step(self, status: int, dt: float, method: MethodName) -> None:
        """Raise the exception of advance() for a status."""
        if status == lib.SPRING_EINVAL:
            invalid("dt", dt)
        if status in (lib.SPRING_EUNSUPPORTED, lib.SPRING_EDISABLED):
            fail(status, "method", method)
        if status in (lib.SPRING_ENONFINITE, lib.SPRING_EUNSTABLE):
            fail_step(status, dt, method, self.stable_step(method))
        if status:
            fail(status)

    # --- what it is

    def __len__(self) -> int:
        """Number of particles."""
        return self._particles

    @property
    def axes(self) -> int:
        """1, 2 or 3."""
        return self._axes

    @property
    def links(self) -> int:
        """Number of links, including those that are cut."""
        return self._links

    @property
    def dtype(self) -> np.dtype[F]:
        """float64 or float32, the precision of the simulation."""
        return self._dtype

    @property
    def nbytes(self) -> int:
        """Size of the scene and of a snapshot [bytes]."""
        return len(self._memory)

    @property
    def time(self) -> float:
        """Simulated time [s] since the scene was created."""
        time: float = self._ask("time")
        return time

    def energy(self) -> Energies:
        """Return the energies [J]."""
        energies = self._ask("energy")
        return Energies(energies.kinetic, energies.elastic, energies.gravity)

    def at_rest(self, v_tol: float, a_tol: float) -> bool:
        """Return whether the scene is at rest.

        Parameters
        ----------
        v_tol : float
            Largest speed >= 0 [m/s].
        a_tol : float
            Largest acceleration of a free particle >= 0 [m/s^2].
        """
        for field, value in (("v_tol", v_tol), ("a_tol", a_tol)):
            if not value >= 0:
                invalid(field, value)
        return bool(self._guard.long(self._run, "at_rest", v_tol, a_tol))

    # --- steps

    def advance(self, dt: float, steps: int = 1, method: MethodName = "leapfrog") -> None:
        """Advance by a number of steps.

        After an error, including an exception of the force, the scene is unchanged, except with ``undo=False``. Ctrl-C takes
        effect in a force in Python, or after the call. Several calls give bit-identical results to one call.

        Parameters
        ----------
        dt : float
            Length of a step [s]; a negative step integrates backwards.
        steps : int
            Number of steps.
        method : str
            Name of the method, see `methods`.

        Raises
        ------
        NonFiniteError
            If the state would become infinite or NaN, or `UnstableError` in a scene with `max_speed`. The attributes `dt` and
            `stable_step` of the exception tell whether the step was too long.
        """
        self._check_step(self._guard.long(self._advance, method, dt, step_count(steps)), dt, method)

    @overload
    def run(self, dt: float, steps: int, every: int | None = ..., method: MethodName = ..., *,
            velocities: Literal[False] = ...,
            progress: Callable[[int, int], object] | None = ...) -> tuple[NDArray[np.float64], NDArray[F]]: ...

    @overload
    def run(self, dt: float, steps: int, every: int | None = ..., method: MethodName = ..., *, velocities: Literal[True],
            progress: Callable[[int, int], object] | None = ...) -> tuple[NDArray[np.float64], NDArray[F], NDArray[F]]: ...

    def run(self, dt: float, steps: int, every: int | None = None, method: MethodName = "leapfrog", *,
            velocities: bool = False, progress: Callable[[int, int], object] | None = None) -> tuple[NDArray[Any], ...]:
        """Advance by a number of steps, and record the motion.

        Parameters
        ----------
        dt, steps
            As in `advance`, with bit-identical results.
        every : int, optional
            Number of steps from one recorded frame to the next; None: 1. The start and the end are always recorded.
        method : str
            As in `advance`.
        velocities : bool
            Also record velocities.
        progress : callable, optional
            ``progress(done, steps)`` is called after each frame with the number of steps taken. It may query the scene.

        Returns
        -------
        times : ndarray
            [s], (frames,).
        positions : ndarray
            [m], (frames, particles, axes).
        velocities : ndarray
            [m/s], (frames, particles, axes), only with ``velocities=True``.

        Raises
        ------
        SpringError
            As in `advance`. Its attribute `recorded` has the frames before the error. After any exception, also that of
            Ctrl-C or of `progress`, the scene is as before the run, except with ``undo=False``.
        """
        steps, every = step_count(steps), 1 if every is None else step_count(every, "every")
        if every == 0:
            invalid("every", every, reason="not a number of steps >= 1")
        frames = 1 - -steps // every
        times = np.empty(frames)
        shape = (frames, self._particles, self._axes)
        arrays = [np.empty(shape, self._dtype) for _ in range(1 + velocities)]
        double = self._dtype == np.float64
        record, number = (lib.springstep_record, "double") if double else (lib.springstep_recordf, "float")
        size, recorded = shape[1] * shape[2], ffi.new("size_t *")
        to_times, *to = (ffi.from_buffer(f"{kind}[]", array) for kind, array in zip(("double", number, number), (times, *arrays)))
        most = 1 if progress is not None else max(1, _UNINTERRUPTED // max(1, every * size))
        start = self.snapshot() if self._undo else None
        done = frame = 0
        try:
            while frame < frames:
                count = min(most, frames - frame) if frame > 0 else 1
                taken = min(count * every, steps - done) if frame > 0 else 0
                pointers = [pointer + frame * size for pointer in to] + [ffi.NULL]
                status = self._guard.long(self._call, record, method_number(method), dt, every, taken, count, recorded,
                                          shape[1], size, to_times + frame, *pointers[:2])
                frame += recorded[0]
                self._check_step(status, dt, method)
                done += taken
                if progress is not None and taken > 0:
                    progress(done, steps)
        except BaseException as error:
            if start is not None:
                self.restore(start)
            if isinstance(error, SpringError):
                error.recorded = (times[:frame], *(array[:frame] for array in arrays))
            raise
        return (times, *arrays)

    def stable_step(self, method: MethodName = "leapfrog") -> float:
        """Return a lower bound of the stability limit [s]; 0: none is known; infinity: every step is stable.

        Parameters
        ----------
        method : str
            Name of the method.
        """
        step: float = self._ask("stable_step", method_number(method))
        if np.isnan(step):
            fail(lib.SPRING_EUNSUPPORTED, "method", method)
        return step

    # --- state

    def _get(self, quantity: int, first: int, count: int | None, out: NDArray[Any] | None) -> NDArray[Any]:
        if out is None:
            out = np.empty((self._count(first, count), self._axes), self._dtype)
        elif not self._fits(out):
            raise TypeError(f"out: not a writeable array of float64 or float32, (count, {self._axes}), with rows in one piece")
        elif count is not None and count != len(out):
            raise ValueError("count: not that of out")
        get, pointer = ("get", "double *") if out.dtype == np.float64 else ("getf", "float *")
        stride = out.strides[0] // out.itemsize if len(out) > 1 else 0
        start = ffi.cast(pointer, out.ctypes.data)
        if status := self._ask(get, quantity, start, stride, natural("first", first), len(out)):
            if status == lib.SPRING_EDISABLED:
                fail(status, "held_forces", False)
            fail(status, "first, count", (first, len(out)))
        return out

    def _fits(self, out: Any) -> bool:
        """Return whether the C library can write rows to the array, with a stride."""
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
        status = self._ask("set", quantity, pointer, 0, natural("first", first), len(array))
        if status == lib.SPRING_EINVAL:
            with np.errstate(over="ignore"):
                row = int(np.flatnonzero(~np.isfinite(array.astype(self._dtype)).all(axis=1))[0])
            fail(status, field, array[row].tolist(), first + row)
        if status == lib.SPRING_EDISABLED:
            fail(status, "held_forces", False)
        if status:
            fail(status, "first, count", (first, len(array)))

    def position(self, first: int = 0, count: int | None = None, out: NDArray[Any] | None = None) -> NDArray[F]:
        """Return positions [m], (count, axes).

        Parameters
        ----------
        first : int
            Index of the first particle.
        count : int, optional
            Number of particles; by default all from `first` on.
        out : ndarray, optional
            An array (count, axes) of float64 or float32, such as a part of a vertex buffer. The positions are copied into it.
        """
        return self._get(lib.SPRING_POSITION, first, count, out)

    def velocity(self, first: int = 0, count: int | None = None, out: NDArray[Any] | None = None) -> NDArray[F]:
        """Return velocities [m/s], (count, axes).

        Parameters
        ----------
        first, count, out
            As in `position`.
        """
        return self._get(lib.SPRING_VELOCITY, first, count, out)

    def set_position(self, values: ArrayLike, first: int = 0) -> None:
        """Set positions. To move a pinned particle, use `drive`.

        Parameters
        ----------
        values : array_like
            [m], (count, axes).
        first : int
            Index of the first particle.
        """
        self._set(lib.SPRING_POSITION, "position", values, first)

    def set_velocity(self, values: ArrayLike, first: int = 0) -> None:
        """Set velocities.

        Parameters
        ----------
        values : array_like
            [m/s], (count, axes).
        first : int
            Index of the first particle.
        """
        self._set(lib.SPRING_VELOCITY, "velocity", values, first)

    def held_force(self, first: int = 0, count: int | None = None, out: NDArray[Any] | None = None) -> NDArray[F]:
        """Return the held forces [N] of a scene with `held_forces`, (count, axes).

        Parameters
        ----------
        first, count, out
            As in `position`.
        """
        return self._get(lib.SPRING_FORCE, first, count, out)

    def set_held_force(self, values: ArrayLike, first: int = 0) -> None:
        """Set forces that act on particles until they are set again.

        They act like gravity, with every method, and cause no additional force evaluation. Wind, for example, is computed
        from the state once per frame and held for the steps of the frame.

        Parameters
        ----------
        values : array_like
            [N], (count, axes).
        first : int
            Index of the first particle.
        """
        self._set(lib.SPRING_FORCE, "held_force", values, first)

    def transform(self, matrix: ArrayLike) -> None:
        """Transform positions to A x + b and velocities to A v, those of pinned particles, too.

        Parameters
        ----------
        matrix : array_like
            [A b], (axes, axes + 1).
        """
        array = self._numbers("matrix", matrix, (self._axes, self._axes + 1))
        rows = ffi.new("double[12]")
        for row in range(self._axes):
            for column in range(self._axes):
                rows[4 * row + column] = array[row, column]
            rows[4 * row + 3] = array[row, self._axes]
        if status := self._ask("transform", rows):
            fail(status, "matrix", array.tolist())

    def _save(self) -> Snapshot:
        return Snapshot(self, self._c("time")(self._pointer))

    def _load(self, snapshot: Snapshot) -> None:
        self._memory[:] = np.frombuffer(snapshot._memory, np.uint8)
        self._called, self._bodies = snapshot._called, snapshot._bodies
        self._pinned[:] = snapshot._pinned

    def snapshot(self) -> Snapshot:
        """Return the whole state, for `restore`."""
        return self._guard.short(self._save)

    def restore(self, snapshot: Snapshot) -> None:
        """Return to a snapshot of this scene, bit for bit.

        Parameters
        ----------
        snapshot : Snapshot
            See `snapshot`.
        """
        if not isinstance(snapshot, Snapshot):
            raise TypeError(f"snapshot: a {type(snapshot).__name__}, not a Snapshot")
        if snapshot._scene is not self:
            raise ValueError("snapshot: of another scene")
        self._guard.change(lambda: self._load(snapshot))

    def save(self) -> bytes:
        """Return the state in a portable format: for `load`, on any processor and in any language.

        The format is described in the page "Memory layout and special cases" of the guide.
        """
        def save() -> bytes:
            size = ffi.new("size_t *")
            self._c("save")(self._pointer, ffi.NULL, size)
            state = ffi.new("char[]", size[0])
            if status := self._c("save")(self._pointer, state, size):
                fail(status)
            return bytes(ffi.buffer(state, size[0]))

        return self._guard.short(save)

    def load(self, state: bytes | bytearray | memoryview) -> None:
        """Load a state that `save` returned, or that was saved in C, LuaJIT, JavaScript or by spring-scene.

        The run then continues bit-identically, if the scene of the state had the same definition. Positions, velocities and
        gravity of the definition need not be the same. Masses, pinned particles and coefficients of links, unless the scene
        is editable, drag, max_speed, particle_radius and the force must be the same, and cannot be checked. Set custom bodies
        before, at the same places in the list of colliders: a state does not have their functions.

        Parameters
        ----------
        state : bytes-like
            The state.

        Raises
        ------
        InvalidError
            If the state is damaged, or that of a scene with another definition. The scene is unchanged.
        """
        state = bytes(memoryview(state))
        buffer = ffi.from_buffer(state)

        def load() -> int:
            status: int = self._c("load")(self._pointer, buffer, len(buffer))
            if not status and self._definition["editable"]:
                self._pinned[:] = _pins_in(state, self._definition["held_forces"])
            return status

        status = self._guard.change(load)
        if status:
            invalid("state", f"{len(state)} bytes",
                    reason=f"the state of a scene with another definition: {_difference(state, self.save())}"
                    if status == lib.SPRING_EMISMATCH else "damaged, truncated, or with custom bodies at other places")

    def set_time(self, t: float) -> None:
        """Set the time. Colliders stay where they are, and nothing else changes.

        Parameters
        ----------
        t : float
            [s]
        """
        if self._ask("set_time", t):
            invalid("t", t)

    def __reduce__(self) -> tuple[Any, ...]:
        """A copy has a state and memory of its own, and the same force."""
        state = self.save()  # first, because it may finish a change of the force
        force = (None, None) if self._called is None else self._called.given
        arguments = type(self), (self._particles, self._axes), self._definition, force, state, self._bodies
        return _copied, arguments, getattr(self, "__dict__", None)

    # --- changes

    def set_gravity(self, gravity: ArrayLike) -> None:
        """Change gravity.

        Parameters
        ----------
        gravity : array_like
            [m/s^2], one number per axis.
        """
        self._ask("set_gravity", [*self._vector("gravity", gravity), 0, 0][:3])

    def set_colliders(self, colliders: Iterable[Collider]) -> None:
        """Replace all colliders. Call it once per frame: they start where they say, and then move at their velocities.

        Parameters
        ----------
        colliders : iterable of Collider
            At most as many as `colliders` of the definition; [] removes all.
        """
        given = list(colliders)
        array = ffi.new("spring_collider[]", len(given))
        for place, collider in enumerate(given):
            if not isinstance(collider, Collider):
                raise TypeError(f"colliders[{place}]: a {type(collider).__name__}, not a Collider")
            collider._fill(array[place], self._axes, place)

        def change() -> int:
            status: int = self._c("set_colliders")(self._pointer, array, len(given))
            if not status:
                self._bodies = [replace(c) for c in given] if any(c.shape == "custom" for c in given) else []
            return status

        if status := self._guard.change(change):
            if status == lib.SPRING_EINVAL:
                self._refuse_colliders(array, given)
            fail(status, "colliders", len(given))

    def get_colliders(self) -> list[Collider]:
        """Return the colliders as they are now, with their present positions, axes, velocities and spins."""
        count = ffi.new("uint32_t *")

        def read() -> list[Collider]:
            self._c("get_colliders")(self._pointer, ffi.NULL, count)
            array = ffi.new("spring_collider[]", count[0])
            self._c("get_colliders")(self._pointer, array, count)
            return colliders_from(array, self._bodies)

        return self._guard.short(read)

    def _refuse_colliders(self, array: Any, given: list[Collider]) -> NoReturn:
        """Raise the exception for colliders of which C refuses one."""
        field, index = ffi.new("const char **"), ffi.new("size_t *")
        status = self._ask("check_colliders", array, len(given), field, index)
        name = ffi.string(field[0]).decode()
        if name == "count":
            fail(status, "colliders")
        reason = {"axis": "not unit vectors at right angles", "restitution": "not 0 to 1"}.get(name)
        invalid(f"colliders.{name}", getattr(given[index[0]], name), index[0], reason)

    def touching(self, first: int = 0, count: int | None = None) -> NDArray[np.uint32]:
        """Return the colliders that particles touched in the last step: bit i stands for collider i.

        Parameters
        ----------
        first : int
            Index of the first particle.
        count : int, optional
            Number of particles; by default all from `first` on.
        """
        mask = np.empty(self._count(first, count), np.uint32)
        pointer = ffi.cast("uint32_t *", ffi.from_buffer(mask))
        if status := self._ask("touching", pointer, natural("first", first), len(mask)):
            if status == lib.SPRING_EDISABLED:
                fail(status, "colliders", 0)
            fail(status, "first, count", (first, len(mask)))
        return mask

    def impulses(self, count: int, first: int = 0) -> NDArray[np.float64]:
        """Return what particles gave to colliders in the last call of `advance`.

        Parameters
        ----------
        count : int
            Number of colliders.
        first : int
            Index of the first collider.

        Returns
        -------
        ndarray
            [count, 2, 3]: of each collider the linear impulse [N s] and the angular impulse [N m s] about `at` at the end
            of the call.
        """
        if not 0 <= count <= 32:
            fail(lib.SPRING_ERANGE, "first, count", (first, count))
        sums = np.empty((count, 2, 3))
        pointer = ffi.cast("spring_impulse *", ffi.from_buffer(sums))
        if status := self._ask("impulses", pointer, natural("first", first), count):
            if status == lib.SPRING_EDISABLED:
                fail(status, "colliders", 0)
            fail(status, "first, count", (first, count))
        return sums

    def set_force(self, force: AnyForce | None, data: NDArray[Any] | None = None) -> None:
        """Change the force. Also call this function after changing anything that the force depends on.

        Parameters
        ----------
        force : callable or None
            As in `Scene`; None: none.
        data : ndarray, optional
            As `force_data` of `Scene`.
        """
        called = None if force is None else called_force(force, data, self)

        def change() -> None:
            self._c("set_force")(self._pointer, *((called.pointer, called.user) if called else (ffi.NULL, ffi.NULL)))
            self._called = called

        self._guard.change(change)

    def link(self, index: int) -> tuple[int, int, float, float, float]:
        """Return a link as it is now: a, b, rest [m], stiffness [N/m], damping [N s/m]. a and b may be swapped.

        Parameters
        ----------
        index : int
            Index of the link.
        """
        link: Any = ffi.new("spring_link *")
        if status := self._ask("get_link", natural("link", index), link):
            fail(status, "link", index)
        return link.a, link.b, link.rest, link.stiffness, link.damping

    def set_link(self, index: int, *, rest: float | None = None, stiffness: float | None = None,
                 damping: float | None = None) -> None:
        """Change the given values of a link of an editable scene. Stiffness 0 and damping 0 cut it.

        Parameters
        ----------
        index : int
            Index of the link.
        rest, stiffness, damping : float, optional
            [m], [N/m], [N s/m].
        """
        link = ffi.new("spring_link *")

        def change() -> int:
            link[0] = self.link(index)
            for field, value in zip(_VALUES, (rest, stiffness, damping)):
                if value is not None:
                    setattr(link, field, value)
            status: int = self._ask("set_link", index, link)
            return status

        if status := self._guard.short(change):
            if status == lib.SPRING_EINVAL:
                for field in _VALUES:
                    if not 0 <= getattr(link, field) < np.inf:
                        fail(status, f"link.{field}", getattr(link, field), index)
            fail(status, "link", (link.a, link.b, link.rest, link.stiffness, link.damping), index)

    def set_links(self, links: ArrayLike, first: int = 0) -> None:
        """Change links of an editable scene, all of them or none.

        Parameters
        ----------
        links : array_like
            As in `Scene`, with all values. a and b are those of the definition.
        first : int
            Index of the first link.
        """
        self._set_rows("set_links", "spring_link *", "link", joined(links, None), first)

    def set_weighted_links(self, links: ArrayLike, first: int = 0) -> None:
        """Change weighted links of an editable scene, all of them or none. Their particles are those of the definition.

        Parameters
        ----------
        links : array_like
            Of WEIGHTED_LINK.
        first : int
            Index of the first link.
        """
        self._set_rows("set_weighted_links", "spring_weighted_link *", "weighted_link", weighted(links), first)

    def weighted_link(self, index: int) -> NDArray[np.void]:
        """Return a weighted link as it is now, of WEIGHTED_LINK, without axes.

        Parameters
        ----------
        index : int
            Index of the link.
        """
        link = np.zeros((), WEIGHTED_LINK)
        pointer = ffi.cast("spring_weighted_link *", ffi.from_buffer(link))
        if status := self._ask("get_weighted_link", natural("weighted_link", index), pointer):
            fail(status, "weighted_link", index)
        return link

    def tear(self, stretch: ArrayLike) -> NDArray[np.uint32]:
        """Cut the links of an editable scene that are too long, and return their indices. Call it once per frame.

        Parameters
        ----------
        stretch : array_like
            Largest length divided by rest length, for all links or for each. Infinity: the link never tears.
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
        """Return the first link between two particles, or None. It searches all links.

        Parameters
        ----------
        a, b : int
            Indices of the particles, in either order.
        """
        index: int = self._ask("find_link", natural("a", a), natural("b", b))
        return index if index < self._links else None

    def set_pinned(self, pinned: ArrayLike, first: int = 0) -> None:
        """Pin and free particles of an editable scene. A pinned particle stops. A freed particle keeps its velocity.

        Parameters
        ----------
        pinned : array_like
            For each particle, True: pinned.
        first : int
            Index of the first particle.
        """
        flags, first = self._flags(pinned), natural("first", first)

        def change() -> int:
            status: int = self._c("set_pinned")(self._pointer, first, len(flags), ffi.from_buffer("uint8_t[]", flags))
            if not status:
                self._pinned[first:first + len(flags)] = flags
            return status

        if status := self._guard.change(change):
            fail(status, "pinned", flags.astype(bool).tolist(), first)

    def set_mass(self, mass: ArrayLike, first: int = 0) -> None:
        """Change masses of particles of an editable scene.

        Parameters
        ----------
        mass : array_like
            [kg] > 0, (count,).
        first : int
            Index of the first particle.
        """
        array = self._numbers("mass", mass, (np.size(mass),))
        self._set_rows("set_mass", "double *", "mass", array, first)

    def drive(self, particle: int, target: ArrayLike | None, duration: float = 0.0) -> None:
        """Set the velocity of a pinned particle so that it reaches a target. It keeps this velocity until it is changed.

        Parameters
        ----------
        particle : int
            Index of the particle.
        target : array_like or None
            Position [m] after `duration`; None: the particle stops.
        duration : float
            [s] > 0.
        """
        to = None if target is None else self._vector("target", target)
        place = ffi.NULL if to is None else ffi.new("double[3]", to)
        if status := self._ask("drive", natural("particle", particle), place, duration):
            if status == lib.SPRING_ERANGE:
                fail(status, "particle", particle)
            if not self._pinned[particle]:
                invalid("particle", particle, reason="not pinned")
            with np.errstate(over="ignore"):
                if to is not None and 0 < duration < np.inf and not np.isfinite(to - self.position(particle, 1)).all():
                    invalid("target", to, reason="too far away")
            invalid("duration", duration, reason="not a finite time > 0 in which a finite velocity reaches the target")

    def tension(self, index: int) -> float:
        """Return the force along a link [N], including its damping; > 0 pulls.

        Parameters
        ----------
        index : int
            Index of the link.
        """
        if not 0 <= index < self._links:
            fail(lib.SPRING_ERANGE, "link", index)
        tension: float = self._ask("tension", index)
        return tension

    def __repr__(self) -> str:
        return f"<Scene of {self._particles} particles and {self._links} links on {self._axes} axes, {self._dtype}>"


def _difference(state: bytes | bytearray | memoryview, own: bytes) -> str:
    """Return the first word of the headers of two states in which their definitions differ."""
    names = {1: "version", 2: "bytes of a number", 3: "axes", 4: "flags", 5: "methods", 6: "colliders", 7: "particles",
             8: "links", 9: "weighted links", 10: "hash of ends and flags of links, radius, friction and mask", 11: "force"}
    theirs, ours = (np.frombuffer(each, "<u8", 25) for each in (state, own))
    for place, name in names.items():
        if theirs[place] != ours[place]:
            return f"{name} {theirs[place]}, not {ours[place]}"
    return f"{theirs[14]} damped links, not {ours[14]}"


def _pins_in(state: bytes | bytearray | memoryview, held: bool) -> NDArray[np.bool_]:
    """Return which particles are pinned in the state of an editable scene."""
    header = np.frombuffer(state, "<u8", 25)
    number, axes, particles, kept = (int(header[word]) for word in (2, 3, 7, 13))
    before = [axes * particles * number] * (2 + (kept > 0) + held) + [particles * number]  # sections
    start = header.nbytes + sum(-(-size // 8) * 8 for size in before)
    bits = np.frombuffer(state, np.uint8, -(-particles // 8), start)
    return np.unpackbits(bits, count=particles, bitorder="little").astype(np.bool_)


def _copied(cls: type[Scene[Any]], shape: tuple[int, int], definition: dict[str, Any], force: tuple[Any, Any],
            state: bytes, bodies: list[Collider]) -> Scene[Any]:
    """Return a copy of a scene."""
    scene: Scene[Any] = remade(cls, Scene, (np.zeros(shape),), definition)
    if force[0] is not None:  # after that, since methods of the definition may be unavailable with a force
        scene.set_force(*force)
    if bodies:  # a state does not have their functions
        scene.set_colliders(bodies)
    scene.load(state)
    return scene
