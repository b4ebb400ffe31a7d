# SPDX-License-Identifier: MIT
"""Fixed time steps from frames of variable duration."""
from __future__ import annotations

import math
from typing import Any

from springstep._common import finite, invalid, remade, step_count
from springstep._native import ffi, lib


class Clock:
    """Divides frames of variable duration into fixed steps.

    Parameters
    ----------
    dt : float
        Length of a step > 0 [s].
    max_steps : int
        Largest number of steps per frame; further whole steps are dropped.
    """

    __slots__ = ("dt", "max_steps", "_clock", "_alpha", "__weakref__")

    def __init__(self, dt: float, max_steps: int = 8) -> None:
        if finite("dt", dt) <= 0:
            invalid("dt", dt)
        self.dt: float = dt
        self.max_steps: int = step_count(max_steps, "max_steps")
        self._clock: Any = ffi.new("spring_clock *")
        self._alpha = ffi.new("double *")

    def tick(self, frame_dt: float) -> tuple[int, float]:
        """Add a frame.

        Parameters
        ----------
        frame_dt : float
            Duration of the frame >= 0 [s].

        Returns
        -------
        steps : int
            Number of steps to take now.
        alpha : float
            In [0, 1): the remaining fraction of a step, for interpolation between the last two states.
        """
        if finite("frame_dt", frame_dt) < 0:
            invalid("frame_dt", frame_dt)
        steps = lib.spring_clock_tick(self._clock, frame_dt, self.dt, self.max_steps, self._alpha)
        if math.isnan(self._alpha[0]):
            invalid("dt, pending", (self.dt, self.pending))
        return steps, self._alpha[0]

    @property
    def pending(self) -> float:
        """[s] time carried over to the next frame; always less than one step"""
        return float(self._clock.pending)

    @property
    def dropped(self) -> float:
        """[s] total time dropped because frames required more than max_steps steps"""
        return float(self._clock.dropped)

    @property
    def skipped(self) -> float:
        """[s] time that the last tick dropped, usually 0"""
        return float(self._clock.skipped)

    def snapshot(self) -> tuple[float, float]:
        """Return pending and dropped time, for `restore`."""
        return self.pending, self.dropped

    def restore(self, snapshot: tuple[float, float]) -> None:
        """Return to a snapshot.

        Parameters
        ----------
        snapshot : tuple of float
            See `snapshot`.
        """
        pending, dropped = snapshot
        self._clock = ffi.new("spring_clock *", {"pending": pending, "dropped": dropped})

    def __reduce__(self) -> tuple[Any, ...]:
        """Copies are independent clocks."""
        times = {"pending": self.pending, "dropped": self.dropped, "skipped": self.skipped}
        return remade, (type(self), Clock, (self.dt, self.max_steps), {}), (times, getattr(self, "__dict__", {}))

    def __setstate__(self, state: tuple[dict[str, float], dict[str, Any]]) -> None:
        self._clock = ffi.new("spring_clock *", state[0])
        for name, value in state[1].items():
            setattr(self, name, value)

    def __repr__(self) -> str:
        return f"Clock(dt={self.dt!r}, max_steps={self.max_steps!r})"
