# SPDX-License-Identifier: MIT
"""Many independent springs, as arrays."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any, Generic, NoReturn, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from springstep._common import (Guard, MethodName, SpringError, fail, fail_step, finite, invalid, method_number,
                                remade, springs_method, step_count)
from springstep._native import ffi, lib

F = TypeVar("F", bound=np.floating[Any])

# Prefix of the functions and the structure in C, and the type of an array in C.
_PRECISIONS = {np.dtype(np.float64): ("spring_batch", "double[]"), np.dtype(np.float32): ("spring_batchf", "float[]")}


def _rounded(field: str, value: Any, dtype: np.dtype[F], underflows: bool = False) -> Any:
    """Return a number in a precision. A finite number must not overflow, or underflow to 0 unless this is allowed."""
    if not hasattr(value, "__float__"):
        raise TypeError(f"{field}: a {type(value).__name__}, neither an array nor a number")
    with np.errstate(over="ignore", under="ignore"):
        number = np.asarray(value, dtype)
    if np.isfinite(value) and not (np.isfinite(number) and (underflows or number != 0 or value == 0)):
        invalid(field, float(value), reason=f"out of the range of {dtype}")
    return number


class Batch(Generic[F]):
    """Many independent springs: x[i]'' = accel[i] - omega2[i] x[i] - gamma[i] x[i]'.

    The arrays are used in place and not copied: `advance` changes the arrays x and v that were passed. An array that would
    have to be copied is refused with `TypeError`. A copy of a batch (module copy, pickle) has copies of all its arrays. While
    one thread advances a batch, its methods raise `RuntimeError` in other threads.

    Parameters
    ----------
    x : ndarray
        Displacements from the unloaded rest position [m], of float64 or float32, which is the precision of the simulation.
    v : ndarray
        Velocities [m/s].
    omega2 : ndarray or float
        stiffness/mass >= 0 [1/s^2]. Parameters are arrays like x, or one number for all springs, which must be 0 or in the
        range of the precision.
    gamma : ndarray or float, optional
        damping/mass >= 0 [1/s]; None: no damping, without cost.
    accel : ndarray or float, optional
        load/mass [m/s^2]; None: no load, without cost.
    """

    __slots__ = ("_name", "_pointer", "_steps", "_follows", "_follows_moving", "_guard", "_batch", "_x", "_v", "_failed",
                 "_marks", "_parameters", "__weakref__")

    def __init__(self, x: NDArray[F], v: NDArray[F], omega2: NDArray[F] | float, gamma: NDArray[F] | float | None = None,
                 accel: NDArray[F] | float | None = None) -> None:
        if not isinstance(x, np.ndarray) or x.dtype not in _PRECISIONS:
            raise TypeError("x: not an array of float64 or float32")
        self._name, self._pointer = _PRECISIONS[x.dtype]
        self._steps: Callable[..., int] = getattr(lib, f"{self._name}_advance_marked")
        self._follows: Callable[..., int] = getattr(lib, f"{self._name}_follow")
        self._follows_moving: Callable[..., int] = getattr(lib, f"{self._name}_follow_moving")
        self._guard = Guard("the batch is being advanced by another thread")
        self._batch: Any = ffi.new(f"{self._name} *", {"count": len(x)})
        self._x, self._v, self._failed = x, v, np.zeros(len(x), np.uint8)
        self._marks = ffi.from_buffer("uint8_t[]", self._failed)
        self._parameters: dict[str, NDArray[F] | None] = {}
        for field, array in (("x", x), ("v", v)):
            self._lend(field, array)
            if not array.flags.writeable:
                raise TypeError(f"{field}: not writeable")
        for field, given in (("omega2", omega2), ("gamma", gamma), ("accel", accel)):
            values: Any = given
            if np.ndim(values) == 0 and (values is not None or field == "omega2"):
                values = _rounded(field, values, x.dtype)
                self._batch.shared |= getattr(lib, f"SPRING_SHARED_{field.upper()}")
            self._parameters[field] = values
            if values is not None:
                self._lend(field, values)
        for field, lent in (("v", v), *self._parameters.items()):
            for name, state in (("x", x), ("v", v)):
                if field != name and lent is not None and np.may_share_memory(state, lent):
                    raise ValueError(f"{field}: shares memory with {name}")

    def _as_lent(self, field: str, array: Any) -> Any:
        """Return a pointer to the data of an array, without a copy."""
        if not isinstance(array, np.ndarray) or array.dtype != self._x.dtype or not (
                array.flags.c_contiguous and array.flags.aligned):
            raise TypeError(f"{field}: not a contiguous array of {self._x.dtype}")
        one_for_all = field in self._parameters and array.ndim == 0
        if not one_for_all and (array.ndim != 1 or array.shape != self._x.shape):
            raise ValueError(f"{field}: its shape is {array.shape}, of x {self._x.shape}")
        return ffi.from_buffer(self._pointer, array)

    def _lend(self, field: str, array: Any) -> None:
        """Let the C library use an array without a copy."""
        setattr(self._batch, field, self._as_lent(field, array))

    @property
    def x(self) -> NDArray[F]:
        """[m] the array that was passed"""
        return self._x

    @property
    def v(self) -> NDArray[F]:
        """[m/s] the array that was passed"""
        return self._v

    @property
    def omega2(self) -> NDArray[F]:
        """[1/s^2] the array that was passed, or an array of one number"""
        omega2 = self._parameters["omega2"]
        assert omega2 is not None
        return omega2

    @property
    def gamma(self) -> NDArray[F] | None:
        """[1/s] the array that was passed, or an array of one number, or None"""
        return self._parameters["gamma"]

    @property
    def accel(self) -> NDArray[F] | None:
        """[m/s^2] the array that was passed, or an array of one number, or None"""
        return self._parameters["accel"]

    @property
    def dtype(self) -> np.dtype[F]:
        """float64 or float32, the precision of the simulation."""
        return self._x.dtype

    def __len__(self) -> int:
        """Number of springs."""
        return len(self._x)

    def _first_invalid(self, index: int | None, target: NDArray[F] | None = None,
                       target_velocity: NDArray[F] | None = None) -> None:
        """Raise InvalidError for an invalid state or parameter of a spring, or an invalid shared parameter."""
        for field, values in (("x", self._x), ("v", self._v), ("target", target), ("target_velocity", target_velocity),
                              *self._parameters.items()):
            if values is None or (index is None and values.ndim):
                continue
            value = float(values[index] if values.ndim else values)
            if not np.isfinite(value) or (value < 0 and field in ("omega2", "gamma")):
                invalid(field, value, index if values.ndim else None)

    def _advance(self, number: int, dt: float, steps: int) -> tuple[int, NDArray[np.intp] | None]:
        """The status and, after an error, the indices of springs that have kept their state."""
        status = self._steps(self._batch, number, dt, steps, self._marks)
        if status == lib.SPRING_OK:
            return status, None
        failed = np.flatnonzero(self._failed)
        self._failed[:] = 0
        return status, failed

    def advance(self, dt: float, steps: int = 1, method: MethodName = "leapfrog") -> None:
        """Advance every spring by a number of steps.

        A spring fails if its state or parameters are invalid, or if its state would become infinite or NaN. It then keeps
        its state, and all other springs advance. The exception describes the first spring that failed, and its attribute
        `failed` has the indices of all springs that failed. After any other error nothing has changed, and `failed` is empty.

        Parameters
        ----------
        dt : float
            Length of a step [s]; a negative step integrates backwards.
        steps : int
            Number of steps.
        method : str
            Name of the method, see `methods`.
        """
        status, failed = self._guard.long(self._advance, method_number(method), dt, step_count(steps))
        if failed is None:
            return
        if status == lib.SPRING_EUNSUPPORTED:
            fail(status, "method", method)
        self._fail(status, failed, dt, method)

    def _fail(self, status: int, failed: NDArray[np.intp], dt: float, method: MethodName,
              target: NDArray[F] | None = None, target_velocity: NDArray[F] | None = None) -> NoReturn:
        """Raise the exception for a status, with the indices of the springs that have kept their state."""
        first = int(failed[0]) if len(failed) else None
        try:
            finite("dt", dt)
            if status == lib.SPRING_EINVAL and abs(dt) > float(np.finfo(self.dtype).max):
                invalid("dt", dt, reason=f"out of the range of {self.dtype}")
            for index in failed if len(failed) else [None]:
                self._first_invalid(None if index is None else int(index), target, target_velocity)
            if first is None:
                fail(status)
            stable_step = self._one(first).stable_step(method)
            fail_step(lib.SPRING_ENONFINITE, dt, method, stable_step, "x", float(self._x[first]), first)
        except SpringError as error:
            error.failed = failed
            raise

    def _status_of_follow(self, target: NDArray[F], target_velocity: NDArray[F] | None, dt: float, x_tol: float = 0,
                          v_tol: float = 0, moving: Any = ffi.NULL) -> int:
        goals = self._as_lent("target", target)
        if target_velocity is None:
            return self._follows(self._batch, goals, dt, x_tol, v_tol, moving)
        speeds = self._as_lent("target_velocity", target_velocity)
        return self._follows_moving(self._batch, goals, speeds, dt, x_tol, v_tol, moving)

    def _follow(self, target: NDArray[F], target_velocity: NDArray[F] | None, dt: float, x_tol: float,
                v_tol: float) -> tuple[int, int, NDArray[np.intp] | None]:
        """The status, the number of springs that move and, after an error, the indices of springs that have kept their
        state: those that are where they were, and fail again alone."""
        moving = ffi.new("size_t *")
        x, v = self._x.copy(), self._v.copy()
        status = self._status_of_follow(target, target_velocity, dt, x_tol, v_tol, moving)
        if status == lib.SPRING_OK:
            return status, moving[0], None
        if status != lib.SPRING_EPARTIAL:
            return status, 0, np.empty(0, np.intp)
        bits = f"u{x.itemsize}"
        kept = (x.view(bits) == self._x.view(bits)) & (v.view(bits) == self._v.view(bits))
        failed = [index for index in np.flatnonzero(kept) if self._fails(int(index), target, target_velocity, dt)]
        return status, moving[0], np.array(failed, np.intp)

    def _one(self, index: int) -> Batch[F]:
        """Return a batch of one of the springs."""
        part = slice(index, index + 1)
        parameters: list[Any] = [values if values is None or not values.ndim else values[part]
                                 for values in self._parameters.values()]
        return Batch(self._x[part].copy(), self._v[part].copy(), *parameters)

    def _fails(self, index: int, target: NDArray[F], target_velocity: NDArray[F] | None, dt: float) -> bool:
        """Return whether this spring would fail by itself."""
        part = slice(index, index + 1)
        speed = None if target_velocity is None else target_velocity[part]
        return self._one(index)._status_of_follow(target[part], speed, dt) != lib.SPRING_OK

    def _target(self, field: str, target: Any) -> NDArray[F]:
        """Return an array like x that does not share its memory."""
        goals: NDArray[F] = target
        if np.ndim(target) == 0:
            goals = np.full(len(self), _rounded(field, target, self.dtype, underflows=True), self.dtype)
        self._as_lent(field, goals)
        for name, state in (("x", self._x), ("v", self._v)):
            if np.may_share_memory(state, goals):
                raise ValueError(f"{field}: shares memory with {name}")
        return goals

    def follow(self, target: ArrayLike, dt: float, x_tol: float = 0.0, v_tol: float = 0.0,
               target_velocity: ArrayLike = 0.0) -> int:
        """Advance every spring by one step towards its target, by the exact solution.

        A damped spring lands on its target as with `Spring.follow`; in float32 from a distance below 3e-4 of its value, if
        its half-life is not longer than 1400 steps. Springs that fail keep their state, are counted, and are named by the
        exception, as in `advance`.

        Parameters
        ----------
        target : ndarray or float
            Positions of the targets at the end of the step [m], an array like x, or one number for all springs.
        dt : float
            Length of the step [s].
        x_tol, v_tol : float
            A spring within both tolerances of its target and of the target's velocity is placed there [m], [m/s].
        target_velocity : ndarray or float
            Mean velocities of the targets during the step [m/s], like `target`; 0 for targets that jump. A spring is placed
            on its target with this velocity, and moves while it is not 0.

        Returns
        -------
        moving : int
            Number of springs that still move.
        """
        for field, value in (("x_tol", x_tol), ("v_tol", v_tol)):
            if not value >= 0:
                invalid(field, value)
        goals = self._target("target", target)
        still = np.ndim(target_velocity) == 0 and target_velocity == 0
        speeds = None if still else self._target("target_velocity", target_velocity)
        status, moving, failed = self._guard.long(self._follow, goals, speeds, dt, x_tol, v_tol)
        if failed is not None:
            self._fail(status, failed, dt, "exact", goals, speeds)
        return moving

    def stable_step(self, method: MethodName = "leapfrog") -> float:
        """Return the smallest stable step of all springs [s]: 0 if no step is stable, infinity if every step is.

        Parameters
        ----------
        method : str
            Name of the method.
        """
        step: float = self._guard.short(getattr(lib, f"{self._name}_stable_step"), self._batch, springs_method(method))
        if np.isnan(step):
            for index in [None, *range(len(self))]:
                self._first_invalid(index)
        return step

    def snapshot(self) -> tuple[NDArray[F], NDArray[F]]:
        """Return copies of x and v, for `restore`."""
        return self._guard.short(lambda: (self._x.copy(), self._v.copy()))

    def restore(self, snapshot: tuple[NDArray[F], NDArray[F]]) -> None:
        """Return to a snapshot.

        Parameters
        ----------
        snapshot : tuple of ndarray
            See `snapshot`.
        """
        x, v = (np.asarray(values, self._x.dtype) for values in snapshot)
        if x.shape != self._x.shape or v.shape != x.shape:
            raise ValueError(f"snapshot: its shapes are {x.shape} and {v.shape}, not {self._x.shape}")

        def restore() -> None:
            self._x[:], self._v[:] = x, v

        self._guard.short(restore)

    def __reduce__(self) -> tuple[Any, ...]:
        """Copies are independent batches."""
        parameters = (None if values is None else values.copy() for values in self._parameters.values())
        return remade, (type(self), Batch, (*self.snapshot(), *parameters), {}), getattr(self, "__dict__", None)

    def __repr__(self) -> str:
        return f"<Batch of {len(self)} springs, {self.dtype}>"
