#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Speed against error of all methods for one kind of spring, drawn with matplotlib.

    speed_against_error.py [PICTURE]

A batch of springs runs for ten seconds, in more and more steps; what it took is measured, and the exact solution says how
far off it ended. Where lines cross, the error that is allowed decides which method is the fastest.
"""
import sys
import time

import matplotlib.pyplot as plt
import numpy as np

import springstep

COUNT = 4096
DURATION = 10.0  # [s]
STEPS = [2**power for power in range(5, 16)]


def springs() -> springstep.Batch[np.float64]:
    """Springs of half a hertz to two, lightly damped, all drawn aside by a metre."""
    omega2 = np.linspace(np.pi, 4 * np.pi, COUNT) ** 2
    return springstep.Batch(np.ones(COUNT), np.zeros(COUNT), omega2, gamma=0.1)


def measure(method: springstep.MethodName, steps: int, exact: springstep.Batch[np.float64]) -> tuple[float, float]:
    """[s] for one step of one spring, and the largest error [m], infinite where springs have blown up."""
    least, batch = np.inf, springs()
    for _ in range(3):
        batch = springs()
        start = time.perf_counter()
        try:
            batch.advance(DURATION / steps, steps, method)
        except springstep.NonFiniteError:
            return np.nan, np.inf
        least = min(least, time.perf_counter() - start)
    return least / COUNT, np.abs(batch.x - exact.x).max()


exact = springs()
exact.advance(DURATION, 1, "exact")

figure, axes = plt.subplots(figsize=(8, 5.5), layout="constrained")
for method, marker in zip((m for m in springstep.methods() if m.springs), "osD^v<>"):
    if method.name == "exact":
        cost, _ = measure("exact", 1, exact)
        axes.axhline(cost * 1e9, color="black", linestyle=":", label=f"{method.label}: no error but rounding")
        continue
    points = [measure(method.name, steps, exact) for steps in STEPS]
    cost, error = np.array([point for point in points if point[1] < 1]).T
    axes.loglog(error, cost * 1e9, marker=marker, label=f"{method.label}, order {method.order}")
axes.set(xlabel="largest error after 10 s / m", ylabel="time for one spring / ns",
         title=f"{COUNT} damped springs, 0.5 Hz to 2 Hz: cheaper is lower, more accurate is left")
axes.invert_xaxis()
axes.grid(which="major", alpha=0.3)
axes.legend()
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "speed_against_error.png", dpi=120)
