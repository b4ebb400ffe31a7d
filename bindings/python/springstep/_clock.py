# SPDX-License-Identifier: MIT
"""Fixed time steps from frames of variable duration."""
from __future__ import annotations

import math

from springstep._common import finite, invalid, step_count
from springstep._native import ffi, lib


class Clock:
    """Divides frames of variable duration into fixed steps.

    dt: length of a step > 0 [s]
    max_steps: largest number of steps per frame; further whole steps are dropped
    """

    def __init__(self, dt: float, max_steps: int = 8):
        if finite("dt", dt) <= 0:
            invalid("dt", dt)
        self.dt = dt
        self.max_steps = step_count(max_steps)
        self._clock = ffi.new("spring_clock *")
        self._alpha = ffi.new("double *")

    def tick(self, frame_dt: float) -> tuple[int, float]:
        """Add a frame of frame_dt >= 0 [s].

        Returns the number of steps to take now, and alpha in [0, 1): the remaining fraction of a step, for interpolation
        between the last two states.
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
        return self._clock.pending

    @property
    def dropped(self) -> float:
        """[s] total time dropped because frames required more than max_steps steps"""
        return self._clock.dropped

    @property
    def skipped(self) -> float:
        """[s] time that the last tick dropped, usually 0"""
        return self._clock.skipped

    def snapshot(self) -> tuple[float, float]:
        """pending and dropped, for restore()."""
        return self.pending, self.dropped

    def restore(self, snapshot: tuple[float, float]) -> None:
        """Return to a snapshot."""
        self._clock.pending, self._clock.dropped = snapshot
        self._clock.skipped = 0

    def __reduce__(self) -> tuple:
        """Copies are independent clocks."""
        return Clock, (self.dt, self.max_steps), self.snapshot()

    def __setstate__(self, snapshot: tuple[float, float]) -> None:
        self.restore(snapshot)

    def __repr__(self) -> str:
        return f"Clock(dt={self.dt!r}, max_steps={self.max_steps!r})"
