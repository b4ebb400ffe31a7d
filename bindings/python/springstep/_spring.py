# SPDX-License-Identifier: MIT
"""Simulation of one spring."""
from __future__ import annotations

import math
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from springstep._common import (MethodName, fail, fail_step, finite, invalid, method_number, remade, springs_method,
                                step_count)
from springstep._native import ffi, lib


class _Number:
    """A number of the state or the parameters of a spring, as an attribute."""

    def __init__(self, part: str, name: str, doc: str) -> None:
        self.part, self.name, self.__doc__ = part, name, doc

    @overload
    def __get__(self, spring: None, owner: type[Spring]) -> _Number: ...

    @overload
    def __get__(self, spring: Spring, owner: type[Spring]) -> float: ...

    def __get__(self, spring: Spring | None, owner: type[Spring]) -> float | _Number:
        return self if spring is None else getattr(getattr(spring, self.part), self.name)

    def __set__(self, spring: Spring, value: float) -> None:
        setattr(getattr(spring, self.part), self.name, value)


class Spring:
    """One spring: mass x'' = load - stiffness x - damping x'.

    All parameters are attributes. They may be changed at any time, and are checked where they are used.

    Parameters
    ----------
    stiffness : float
        [N/m] >= 0; 0 is a free particle.
    mass : float
        [kg] > 0.
    damping : float
        [N s/m] >= 0; critical at 2 sqrt(mass stiffness).
    load : float
        Force [N], constant during a step.
    x : float
        Displacement from the unloaded rest position [m]; with `follow` the value itself.
    v : float
        Velocity [m/s].
    """

    __slots__ = ("_params", "_state", "__weakref__")

    x: _Number = _Number("_state", "x", "[m] displacement from the unloaded rest position")
    v: _Number = _Number("_state", "v", "[m/s] velocity, at the same time as x")
    mass: _Number = _Number("_params", "mass", "[kg] > 0")
    stiffness: _Number = _Number("_params", "stiffness", "[N/m] >= 0; 0 is a free particle")
    damping: _Number = _Number("_params", "damping", "[N s/m] >= 0; critical at 2 sqrt(mass stiffness)")
    load: _Number = _Number("_params", "load", "[N] a force, constant during a step")

    def __init__(self, stiffness: float, mass: float = 1.0, damping: float = 0.0, load: float = 0.0, *,
                 x: float = 0.0, v: float = 0.0) -> None:
        self._params = ffi.new("spring_params *", [mass, stiffness, damping, load])
        self._state = ffi.new("spring_state *", [x, v])
        self._check_parameters()

    @classmethod
    def _made(cls, params: Any, x: float, v: float, *arguments: tuple[str, float, bool]) -> Spring:
        """Return a spring of parameters that C has made. If C has refused its arguments, the first invalid one is named."""
        if math.isnan(params.mass):
            for field, value, good in arguments:
                if not good:
                    invalid(field, value)
            fields, values, _ = zip(*arguments)
            invalid(", ".join(fields), values, reason="stiffness or damping is out of range")
        return cls(params.stiffness, params.mass, params.damping, x=x, v=v)

    @classmethod
    def hertz(cls, hertz: float, damping_ratio: float, *, x: float = 0.0, v: float = 0.0) -> Spring:
        """Return a spring of 1 kg from a frequency.

        Parameters
        ----------
        hertz : float
            Undamped frequency >= 0 [Hz].
        damping_ratio : float
            >= 0; 1 is critical.
        x, v : float
            As in `Spring`.
        """
        return cls._made(lib.spring_params_hertz(hertz, damping_ratio), x, v,
                         ("damping_ratio", damping_ratio, 0 <= damping_ratio < math.inf),
                         ("hertz", hertz, 0 <= hertz < math.inf))

    @classmethod
    def half_life(cls, half_life: float, damping_ratio: float, *, x: float = 0.0, v: float = 0.0) -> Spring:
        """Return a spring of 1 kg from a half-life.

        Parameters
        ----------
        half_life : float
            Time in which the envelope halves > 0 [s].
        damping_ratio : float
            > 0; 1 is critical.
        x, v : float
            As in `Spring`.
        """
        return cls._made(lib.spring_params_half_life(half_life, damping_ratio), x, v,
                         ("damping_ratio", damping_ratio, 0 < damping_ratio < math.inf),
                         ("half_life", half_life, 0 < half_life < math.inf))

    @classmethod
    def response(cls, response: float, damping_fraction: float, *, x: float = 0.0, v: float = 0.0) -> Spring:
        """Return a spring of 1 kg from a response, as in SwiftUI.

        Parameters
        ----------
        response : float
            > 0 [s].
        damping_fraction : float
            >= 0; 1 is critical.
        x, v : float
            As in `Spring`.
        """
        return cls._made(lib.spring_params_response(response, damping_fraction), x, v,
                         ("damping_fraction", damping_fraction, 0 <= damping_fraction < math.inf),
                         ("response", response, 0 < response < math.inf))

    @classmethod
    def bounce(cls, duration: float, bounce: float, *, x: float = 0.0, v: float = 0.0) -> Spring:
        """Return a spring of 1 kg from a duration and a bounce, as in SwiftUI.

        Parameters
        ----------
        duration : float
            > 0 [s].
        bounce : float
            -1 < bounce <= 1.
        x, v : float
            As in `Spring`.
        """
        return cls._made(lib.spring_params_bounce(duration, bounce), x, v, ("bounce", bounce, -1 < bounce <= 1),
                         ("duration", duration, 0 < duration < math.inf))

    @classmethod
    def settling(cls, time: float, damping_ratio: float, tolerance: float = 1e-3, *, x: float = 0.0,
                 v: float = 0.0) -> Spring:
        """Return a spring of 1 kg from a settling time.

        Parameters
        ----------
        time : float
            Settling time > 0 [s]. A spring that is released at rest then stays within the tolerance.
        damping_ratio : float
            > 0; 1 is critical.
        tolerance : float
            Distance from the target, relative to the initial distance, between 0 and 1.
        x, v : float
            As in `Spring`.
        """
        return cls._made(lib.spring_params_settling(time, damping_ratio, tolerance), x, v,
                         ("damping_ratio", damping_ratio, 0 < damping_ratio < math.inf),
                         ("tolerance", tolerance, 0 < tolerance < 1), ("time", time, 0 < time < math.inf))

    def _check_parameters(self) -> None:
        """Raise InvalidError for the first invalid parameter."""
        if lib.spring_params_valid(self._params):
            return
        if not self.mass > 0 or not math.isfinite(self.mass):
            invalid("mass", self.mass)
        for field in ("stiffness", "damping"):
            if not getattr(self, field) >= 0:
                invalid(field, getattr(self, field))
        for field in ("stiffness", "damping", "load"):
            if not math.isfinite(getattr(self, field) / self.mass):
                invalid(field, getattr(self, field))
        fail(lib.SPRING_EINVAL)

    def advance(self, dt: float, steps: int = 1, method: MethodName = "leapfrog") -> None:
        """Advance by a number of steps. After an error the spring is unchanged.

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
            If the state would become infinite or NaN. The attributes `dt` and `stable_step` of the exception tell whether the
            step was too long.
        """
        number = method_number(method)
        status = lib.spring_advance(self._state, self._params, number, dt, step_count(steps))
        if status == lib.SPRING_EINVAL:
            finite("dt", dt)
            finite("x", self.x)
            finite("v", self.v)
            self._check_parameters()
        if status == lib.SPRING_ENONFINITE:
            fail_step(status, dt, method, self.stable_step(method))
        if status:
            fail(status, "method" if status == lib.SPRING_EUNSUPPORTED else None, method)

    def at(self, times: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return displacements and velocities at any times, by the exact solution. The spring is unchanged.

        Parameters
        ----------
        times : array_like
            [s] from now; negative times are in the past.

        Returns
        -------
        x, v : ndarray
            [m] and [m/s], of the shape of `times`, bit-identical to ``advance(time, 1, "exact")``.
        """
        t = np.asarray(times, np.float64)
        for index in np.flatnonzero(~np.isfinite(t))[:1].tolist():
            invalid("times", float(t.flat[index]), index if t.ndim else None)
        x, v = np.empty(t.shape), np.empty(t.shape)
        spring = Spring(self.stiffness, self.mass, self.damping, self.load)
        for index, time in enumerate(t.flat):
            spring.restore((self.x, self.v))
            spring.advance(float(time), 1, "exact")
            x.flat[index], v.flat[index] = spring.x, spring.v
        return x, v

    def follow(self, target: float, dt: float, target_velocity: float = 0.0) -> None:
        """Advance towards a target, by the exact solution. After an error the spring is unchanged.

        A damped spring lands on its target, at rest, from a distance below 2e-11 of its value. If its half-life is longer
        than 45 000 steps, rounding error may stop it before.

        Parameters
        ----------
        target : float
            Position of the target at the end of the step [m].
        dt : float
            Length of the step [s].
        target_velocity : float
            Mean velocity of the target during the step [m/s]; 0 for a target that jumps.
        """
        status = lib.spring_follow(self._state, self._params, target, target_velocity, dt)
        if status == lib.SPRING_EINVAL:
            for field, value in (("target", target), ("target_velocity", target_velocity), ("dt", dt), ("x", self.x),
                                 ("v", self.v)):
                finite(field, value)
            self._check_parameters()
        if status:
            fail(status)

    def energy(self) -> float:
        """Return the energy m v^2/2 + k x^2/2 - load x [J]."""
        return lib.spring_energy(self._state, self._params)

    def stable_step(self, method: MethodName = "leapfrog") -> float:
        """Return the stability limit [s]: 0 if no step is stable, infinity if every step is.

        Parameters
        ----------
        method : str
            Name of the method.
        """
        self._check_parameters()
        return lib.spring_stable_step(self._params, springs_method(method))

    def accurate_step(self, duration: float, tolerance: float, method: MethodName = "leapfrog") -> float:
        """Return the longest accurate step [s], or 0 if there is none.

        Parameters
        ----------
        duration : float
            > 0 [s].
        tolerance : float
            Largest error within the duration > 0, relative to the start.
        method : str
            Name of the method.
        """
        number = springs_method(method)
        self._check_parameters()
        for field, value in (("duration", duration), ("tolerance", tolerance)):
            if finite(field, value) <= 0:
                invalid(field, value)
        return lib.spring_accurate_step(self._params, number, duration, tolerance)

    def step_error(self, duration: float, dt: float, method: MethodName = "leapfrog") -> float:
        """Return the largest error, relative to the start.

        Parameters
        ----------
        duration : float
            [s].
        dt : float
            Length of a step > 0 [s].
        method : str
            Name of the method.
        """
        number = springs_method(method)
        self._check_parameters()
        if finite("dt", dt) <= 0:
            invalid("dt", dt)
        error = lib.spring_step_error(self._params, number, duration, dt)
        if math.isnan(error):
            invalid("duration", duration)
        return error

    def at_rest(self, x_tol: float, v_tol: float) -> bool:
        """Return whether the spring is at rest.

        Parameters
        ----------
        x_tol : float
            Largest distance from the rest position >= 0 [m].
        v_tol : float
            Largest speed >= 0 [m/s].
        """
        rests: bool = lib.spring_at_rest(self._state, self._params, x_tol, v_tol)
        if not rests:  # it does not for invalid input either
            self._check_parameters()
            finite("x", self.x)
            finite("v", self.v)
            for field, value in (("x_tol", x_tol), ("v_tol", v_tol)):
                if not value >= 0:
                    invalid(field, value)
        return rests

    def settling_time(self, x_tol: float, v_tol: float = math.inf) -> float:
        """Return the time [s] from which on the exact solution stays at rest, or infinity.

        Parameters
        ----------
        x_tol : float
            Largest distance from the rest position >= 0 [m].
        v_tol : float
            Largest speed >= 0 [m/s].
        """
        self._check_parameters()
        time = lib.spring_rest_time(self._state, self._params, x_tol, v_tol)
        if math.isnan(time):
            finite("x", self.x)
            finite("v", self.v)
            invalid(*(("v_tol", v_tol) if x_tol >= 0 else ("x_tol", x_tol)))
        return time

    def snapshot(self) -> tuple[float, float]:
        """Return x and v, for `restore`."""
        return self.x, self.v

    def restore(self, snapshot: tuple[float, float]) -> None:
        """Return to a snapshot.

        Parameters
        ----------
        snapshot : tuple of float
            See `snapshot`.
        """
        x, v = snapshot
        self._state = ffi.new("spring_state *", [x, v])

    def __reduce__(self) -> tuple[Any, ...]:
        """Copies are independent springs."""
        values = self.stiffness, self.mass, self.damping, self.load
        return remade, (type(self), Spring, values, {"x": self.x, "v": self.v}), getattr(self, "__dict__", None)

    def __repr__(self) -> str:
        return (f"Spring(stiffness={self.stiffness!r}, mass={self.mass!r}, damping={self.damping!r}, "
                f"load={self.load!r}, x={self.x!r}, v={self.v!r})")
