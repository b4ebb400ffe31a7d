# SPDX-License-Identifier: MIT
"""Many independent springs, as arrays."""
from __future__ import annotations

from typing import Any, NoReturn

import numpy as np

from springstep._common import Guard, SpringError, fail, finite, invalid, method_number, springs_method, step_count
from springstep._native import ffi, lib

# How the functions and the structure are called in C, and what an array is for C.
_PRECISIONS = {np.dtype(np.float64): ("spring_batch", "double[]"), np.dtype(np.float32): ("spring_batchf", "float[]")}


class Batch:
    """Many independent springs: x[i]'' = accel[i] - omega2[i] x[i] - gamma[i] x[i]'.

    x: [m] displacements from the unloaded rest position
    v: [m/s] velocities
    omega2: [1/s^2] stiffness/mass >= 0
    gamma: [1/s] damping/mass >= 0; None: no damping, which costs nothing
    accel: [m/s^2] load/mass; None: no load, which costs nothing

    x and v are arrays of float64 or of float32, which decides in what all are computed; a parameter is an array like
    them, or one number for all springs. Arrays are used where they are, not copied: advance() changes the arrays x and v
    that were handed over. An array that would have to be copied is refused with TypeError. A copy of a batch (module
    copy, pickle) has copies of all its arrays.

    While one thread advances a batch, its methods raise RuntimeError in other threads.
    """

    def __init__(self, x: np.ndarray, v: np.ndarray, omega2: np.ndarray | float, gamma: np.ndarray | float | None = None,
                 accel: np.ndarray | float | None = None):
        if not isinstance(x, np.ndarray) or x.dtype not in _PRECISIONS:
            raise TypeError("x: not an array of float64 or float32")
        self._name, self._pointer = _PRECISIONS[x.dtype]
        self._steps = getattr(lib, f"{self._name}_advance_marked")
        self._follows = getattr(lib, f"{self._name}_follow")
        self._follows_moving = getattr(lib, f"{self._name}_follow_moving")
        self._guard = Guard("the batch is being advanced by another thread")
        self._batch = ffi.new(f"{self._name} *", {"count": len(x)})
        self._x, self._v, self._failed = x, v, np.zeros(len(x), np.uint8)
        self._marks = ffi.from_buffer("uint8_t[]", self._failed)
        self._parameters: dict[str, np.ndarray | None] = {}
        for field, array in (("x", x), ("v", v)):
            self._lend(field, array)
            if not array.flags.writeable:
                raise TypeError(f"{field}: not writeable")
        for field, values in (("omega2", omega2), ("gamma", gamma), ("accel", accel)):
            if values is not None and np.ndim(values) == 0:
                values = np.asarray(values, x.dtype)
                self._batch.shared |= getattr(lib, f"SPRING_SHARED_{field.upper()}")
            self._parameters[field] = values
            if values is not None:
                self._lend(field, values)
        for field, values in (("v", v), *self._parameters.items()):
            for name, state in (("x", x), ("v", v)):
                if field != name and values is not None and np.may_share_memory(state, values):
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

    x = property(lambda self: self._x, doc="[m] the array that was passed")
    v = property(lambda self: self._v, doc="[m/s] the array handed over")
    omega2 = property(lambda self: self._parameters["omega2"], doc="[1/s^2] the array handed over, or of one number")
    gamma = property(lambda self: self._parameters["gamma"], doc="[1/s] the array handed over, or of one number, or None")
    accel = property(lambda self: self._parameters["accel"], doc="[m/s^2] the array handed over, or of one number, or None")
    dtype = property(lambda self: self._x.dtype, doc="float64 or float32: what all are computed in")

    def __len__(self) -> int:
        return self._batch.count

    def _first_invalid(self, index: int | None, target: np.ndarray | None = None,
                       target_velocity: np.ndarray | None = None) -> None:
        """Raise InvalidError for an invalid state or parameter of a spring, or an invalid shared parameter."""
        for field, values in (("x", self._x), ("v", self._v), ("target", target),
                              ("target_velocity", target_velocity), *self._parameters.items()):
            if values is None or (index is None and values.ndim):
                continue
            value = float(values[index] if values.ndim else values)
            if not np.isfinite(value) or (value < 0 and field in ("omega2", "gamma")):
                invalid(field, value, index if values.ndim else None)

    def _advance(self, number: int, dt: float, steps: int) -> tuple[int, np.ndarray | None]:
        """The status and, after an error, the indices of springs that have kept their state."""
        status = self._steps(self._batch, number, dt, steps, self._marks)
        if status == lib.SPRING_OK:
            return status, None
        failed = np.flatnonzero(self._failed)
        self._failed[:] = 0
        return status, failed

    def advance(self, dt: float, steps: int = 1, method: str = "leapfrog") -> None:
        """Advance every spring by a number of steps of dt [s]; negative runs backwards.

        A spring fails if its state or parameters are invalid, or if its state would become infinite or NaN. It then keeps
        its state, and all other springs advance. The exception describes the first spring that failed, and its attribute
        `failed` has the indices of all springs that failed. After any other
        error nothing has changed, and `failed` is empty.
        """
        status, failed = self._guard.long(self._advance, method_number(method), dt, step_count(steps))
        if failed is None:
            return
        if status == lib.SPRING_EUNSUPPORTED:
            fail(status, "method", method)
        self._fail(status, failed, dt)

    def _fail(self, status: int, failed: np.ndarray, dt: float, target: np.ndarray | None = None,
              target_velocity: np.ndarray | None = None) -> NoReturn:
        """Raise the exception for a status, with the indices of the springs that have kept their state."""
        first = int(failed[0]) if len(failed) else None
        try:
            finite("dt", dt)
            for index in failed if len(failed) else [None]:
                self._first_invalid(None if index is None else int(index), target, target_velocity)
            if first is None:
                fail(status)
            fail(lib.SPRING_ENONFINITE, "x", float(self._x[first]), first)
        except SpringError as error:
            error.failed = failed
            raise

    def _status_of_follow(self, target: np.ndarray, target_velocity: np.ndarray | None, dt: float, x_tol: float = 0,
                          v_tol: float = 0, moving: Any = ffi.NULL) -> int:
        goals = self._as_lent("target", target)
        if target_velocity is None:
            return self._follows(self._batch, goals, dt, x_tol, v_tol, moving)
        speeds = self._as_lent("target_velocity", target_velocity)
        return self._follows_moving(self._batch, goals, speeds, dt, x_tol, v_tol, moving)

    def _follow(self, target: np.ndarray, target_velocity: np.ndarray | None, dt: float, x_tol: float,
                v_tol: float) -> tuple[int, int, np.ndarray | None]:
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
        failed = [index for index in np.flatnonzero(kept) if self._fails(index, target, target_velocity, dt)]
        return status, moving[0], np.array(failed, np.intp)

    def _fails(self, index: int, target: np.ndarray, target_velocity: np.ndarray | None, dt: float) -> bool:
        """Return whether this spring would fail by itself."""
        def part(values: Any) -> Any:
            return values if values is None or not values.ndim else values[index:index + 1]

        one = Batch(part(self._x).copy(), part(self._v).copy(), *map(part, self._parameters.values()))
        return one._status_of_follow(part(target), part(target_velocity), dt) != lib.SPRING_OK

    def _target(self, field: str, target: np.ndarray | float) -> np.ndarray:
        """Return an array like x that does not share its memory."""
        if np.ndim(target) == 0:
            target = np.full(len(self), target, self._x.dtype)
        self._as_lent(field, target)
        for name, state in (("x", self._x), ("v", self._v)):
            if np.may_share_memory(state, target):
                raise ValueError(f"{field}: shares memory with {name}")
        return target

    def follow(self, target: np.ndarray | float, dt: float, x_tol: float = 0.0, v_tol: float = 0.0,
               target_velocity: np.ndarray | float = 0.0) -> int:
        """Advance every spring by dt [s] towards its target [m], by the exact solution; return how many still move.

        target: [m] positions of the targets at the end of the step, an array like x, or one number for all springs
        x_tol, v_tol: [m], [m/s] a spring within both tolerances of rest on its target is placed there
        target_velocity: [m/s] mean velocities of the targets during the step, an array like x, or one number; 0 for targets
            that jump. A spring is placed on its target with this velocity, and moves while it is not 0.

        A damped spring lands on its target as with Spring.follow(); in float32 from a distance below 3e-4 of its value, if its
        half-life is not longer than 1400 steps.

        Springs that fail keep their state, are counted, and are named by the exception, as in advance().
        """
        for field, value in (("x_tol", x_tol), ("v_tol", v_tol)):
            if not value >= 0:
                invalid(field, value)
        target = self._target("target", target)
        still = np.ndim(target_velocity) == 0 and target_velocity == 0
        speeds = None if still else self._target("target_velocity", target_velocity)
        status, moving, failed = self._guard.long(self._follow, target, speeds, dt, x_tol, v_tol)
        if failed is not None:
            self._fail(status, failed, dt, target, speeds)
        return moving

    def stable_step(self, method: str = "leapfrog") -> float:
        """The smallest stable step of all springs [s]: 0 if no step is stable, infinity if every step is."""
        step = self._guard.short(getattr(lib, f"{self._name}_stable_step"), self._batch, springs_method(method))
        if np.isnan(step):
            for index in [None, *range(len(self))]:
                self._first_invalid(index)
        return step

    def snapshot(self) -> tuple[np.ndarray, np.ndarray]:
        """Copies of x and v, for restore()."""
        return self._guard.short(lambda: (self._x.copy(), self._v.copy()))

    def restore(self, snapshot: tuple[np.ndarray, np.ndarray]) -> None:
        """Return to a snapshot."""
        def restore() -> None:
            self._x[:], self._v[:] = snapshot

        self._guard.short(restore)

    def __reduce__(self) -> tuple:
        """Copies are independent batches."""
        parameters = (None if values is None else values.copy() for values in self._parameters.values())
        return Batch, (*self.snapshot(), *parameters)

    def __repr__(self) -> str:
        return f"<Batch of {len(self)} springs, {self.dtype}>"
