# SPDX-License-Identifier: MIT
"""Simulation of one spring."""
from __future__ import annotations

import functools
import math
from typing import Any

from springstep._common import fail, finite, invalid, method_number, springs_method, step_count
from springstep._native import ffi, lib


def _state(field: str, doc: str) -> property:
    return property(lambda self: getattr(self._state, field), lambda self, to: setattr(self._state, field, to), doc=doc)


def _parameter(field: str, doc: str) -> property:
    return property(lambda self: getattr(self._params, field), lambda self, to: setattr(self._params, field, to), doc=doc)


class Spring:
    """One spring: mass x'' = load - stiffness x - damping x'.

    stiffness: [N/m] >= 0; 0 is a free particle
    mass: [kg] > 0
    damping: [N s/m] >= 0; critical at 2 sqrt(mass stiffness)
    load: [N] a force held constant over the step
    x: [m] displacement from the unloaded rest position; with follow() the value itself
    v: [m/s] velocity

    All may be changed at any time, and are checked where they are used.
    """

    x = _state("x", "[m] displacement from the unloaded rest position")
    v = _state("v", "[m/s] velocity, at the same time as x")
    mass = _parameter("mass", "[kg] > 0")
    stiffness = _parameter("stiffness", "[N/m] >= 0; 0 is a free particle")
    damping = _parameter("damping", "[N s/m] >= 0; critical at 2 sqrt(mass stiffness)")
    load = _parameter("load", "[N] a force held constant over the step")

    def __init__(self, stiffness: float, mass: float = 1.0, damping: float = 0.0, load: float = 0.0, *,
                 x: float = 0.0, v: float = 0.0):
        self._params = ffi.new("spring_params *", [mass, stiffness, damping, load])
        self._state = ffi.new("spring_state *", [x, v])
        self._check_parameters()

    @classmethod
    def _made(cls, params: Any, x: float, v: float, *arguments: tuple[str, float, bool]) -> Spring:
        """The spring of parameters that C has made; if it has refused the arguments, the first that is not good is named."""
        for field, value, good in arguments if math.isnan(params.mass) else ():
            if not good:
                invalid(field, value)
        return cls(params.stiffness, params.mass, params.damping, x=x, v=v)

    @classmethod
    def hertz(cls, hertz: float, damping_ratio: float, *, x: float = 0.0, v: float = 0.0) -> Spring:
        """A spring of 1 kg from its undamped frequency >= 0 [Hz] and its damping ratio >= 0; 1 is critical."""
        return cls._made(lib.spring_params_hertz(hertz, damping_ratio), x, v, ("damping_ratio", damping_ratio, 0 <= damping_ratio < math.inf),
                         ("hertz", hertz, False))

    @classmethod
    def half_life(cls, half_life: float, damping_ratio: float, *, x: float = 0.0, v: float = 0.0) -> Spring:
        """A spring of 1 kg from the time in which its envelope halves > 0 [s] and its damping ratio > 0."""
        return cls._made(lib.spring_params_half_life(half_life, damping_ratio), x, v, ("damping_ratio", damping_ratio, 0 < damping_ratio < math.inf),
                         ("half_life", half_life, False))

    @classmethod
    def response(cls, response: float, damping_fraction: float, *, x: float = 0.0, v: float = 0.0) -> Spring:
        """A spring of 1 kg from a response > 0 [s] and a damping fraction >= 0, as in SwiftUI."""
        return cls._made(lib.spring_params_response(response, damping_fraction), x, v, ("damping_fraction", damping_fraction, 0 <= damping_fraction < math.inf),
                         ("response", response, False))

    @classmethod
    def bounce(cls, duration: float, bounce: float, *, x: float = 0.0, v: float = 0.0) -> Spring:
        """A spring of 1 kg from a duration > 0 [s] and a bounce, -1 < bounce <= 1, as in SwiftUI."""
        return cls._made(lib.spring_params_bounce(duration, bounce), x, v, ("bounce", bounce, -1 < bounce <= 1),
                         ("duration", duration, False))

    @classmethod
    def settling(cls, time: float, damping_ratio: float, tolerance: float = 1e-3, *, x: float = 0.0,
                 v: float = 0.0) -> Spring:
        """A spring of 1 kg from its settling time > 0 [s] and its damping ratio > 0.

        Released at rest, it stays within tolerance times the initial distance from the target from then on;
        0 < tolerance < 1.
        """
        return cls._made(lib.spring_params_settling(time, damping_ratio, tolerance), x, v,
                         ("damping_ratio", damping_ratio, 0 < damping_ratio < math.inf),
                         ("tolerance", tolerance, 0 < tolerance < 1), ("time", time, False))

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

    def advance(self, dt: float, steps: int = 1, method: str = "leapfrog") -> None:
        """Advance by a number of steps of dt [s]; a negative dt integrates backwards. An error changes nothing."""
        number = method_number(method)
        status = lib.spring_advance(self._state, self._params, number, dt, step_count(steps))
        if status == lib.SPRING_EINVAL:
            finite("dt", dt)
            finite("x", self.x)
            finite("v", self.v)
            self._check_parameters()
        if status:
            fail(status, "method" if status == lib.SPRING_EUNSUPPORTED else None, method)

    def follow(self, target: float, dt: float, target_velocity: float = 0.0) -> None:
        """Advance by dt [s] towards a target [m], by the exact solution. A damped spring lands on it, at rest,
        from a distance below 2e-11 of its value. If its half-life is longer than 45 000 steps, rounding error may stop it
        before.

        target: [m] position of the target at the end of the step
        target_velocity: [m/s] mean velocity of the target during the step; 0 for a target that jumps

        After an error nothing has changed.
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
        """Energy m v^2/2 + k x^2/2 - load x [J]."""
        return lib.spring_energy(self._state, self._params)

    def stable_step(self, method: str = "leapfrog") -> float:
        """The stability limit [s]: 0 if no step is stable, infinity if every step is."""
        self._check_parameters()
        return lib.spring_stable_step(self._params, springs_method(method))

    def accurate_step(self, duration: float, tolerance: float, method: str = "leapfrog") -> float:
        """The longest step [s] with which the error within duration > 0 [s] is at most tolerance, relative to the start.

        0: there is none.
        """
        number = springs_method(method)
        self._check_parameters()
        for field, value in (("duration", duration), ("tolerance", tolerance)):
            if finite(field, value) <= 0:
                invalid(field, value)
        return lib.spring_accurate_step(self._params, number, duration, tolerance)

    def step_error(self, duration: float, dt: float, method: str = "leapfrog") -> float:
        """The largest error within duration [s] with a step of dt > 0 [s], relative to the start."""
        number = springs_method(method)
        self._check_parameters()
        if finite("dt", dt) <= 0:
            invalid("dt", dt)
        error = lib.spring_step_error(self._params, number, duration, dt)
        if math.isnan(error):
            invalid("duration", duration)
        return error

    def at_rest(self, x_tol: float, v_tol: float) -> bool:
        """Whether the spring is within x_tol [m] of its rest position and not faster than v_tol [m/s]."""
        return lib.spring_at_rest(self._state, self._params, x_tol, v_tol)

    def settling_time(self, x_tol: float, v_tol: float = math.inf) -> float:
        """Time [s] from which on the exact solution stays within x_tol >= 0 [m] of the rest position, and not faster than
        v_tol >= 0 [m/s], or infinity."""
        self._check_parameters()
        time = lib.spring_rest_time(self._state, self._params, x_tol, v_tol)
        if math.isnan(time):
            finite("x", self.x)
            finite("v", self.v)
            invalid(*(("v_tol", v_tol) if x_tol >= 0 else ("x_tol", x_tol)))
        return time

    def snapshot(self) -> tuple[float, float]:
        """The state, x and v, for restore()."""
        return self.x, self.v

    def restore(self, snapshot: tuple[float, float]) -> None:
        """Return to a snapshot."""
        self.x, self.v = snapshot

    def __reduce__(self) -> tuple:
        """Copies are independent springs."""
        values = self.stiffness, self.mass, self.damping, self.load
        return functools.partial(Spring, x=self.x, v=self.v), values

    def __repr__(self) -> str:
        return (f"Spring(stiffness={self.stiffness!r}, mass={self.mass!r}, damping={self.damping!r}, "
                f"load={self.load!r}, x={self.x!r}, v={self.v!r})")
