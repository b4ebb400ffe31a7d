# SPDX-License-Identifier: MIT
"""Fixed steps from frames of any length."""
from __future__ import annotations

from springstep._common import finite, invalid, step_count
from springstep._native import ffi, lib


class Clock:
    """Takes the whole fixed steps out of frames of any length.

    dt: length of a step > 0 [s]
    max_steps: most steps of one frame; what a frame asks for beyond them is dropped
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

        Returns the steps to take now, and alpha in [0, 1): the part of a step that is left over, to draw between the
        last two states.
        """
        if finite("frame_dt", frame_dt) < 0:
            invalid("frame_dt", frame_dt)
        steps = lib.spring_clock_tick(self._clock, frame_dt, self.dt, self.max_steps, self._alpha)
        return steps, self._alpha[0]

    @property
    def pending(self) -> float:
        """[s] waits for the next frame; always less than one step"""
        return self._clock.pending

    @property
    def dropped(self) -> float:
        """[s] given up since the start, because a frame asked for more than max_steps"""
        return self._clock.dropped

    def snapshot(self) -> tuple[float, float]:
        """pending and dropped, for restore()."""
        return self.pending, self.dropped

    def restore(self, snapshot: tuple[float, float]) -> None:
        """Go back to a snapshot."""
        self._clock.pending, self._clock.dropped = snapshot

    def __reduce__(self) -> tuple:
        """A copy is a clock of its own."""
        return Clock, (self.dt, self.max_steps), self.snapshot()

    def __setstate__(self, snapshot: tuple[float, float]) -> None:
        self.restore(snapshot)

    def __repr__(self) -> str:
        return f"Clock(dt={self.dt!r}, max_steps={self.max_steps!r})"
