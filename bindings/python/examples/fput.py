# SPDX-License-Identifier: MIT
"""The recurrence of Fermi, Pasta, Ulam and Tsingou: energy of the modes of a chain with quadratic forces.

Thirty-two particles between fixed ends, x_i'' = (D_{i+1} - D_i) (1 + ALPHA (D_{i+1} + D_i)) with D_i the extension of spring
i. The linear force is that of links, and the quadratic one a force in Python. All energy is in the first mode at the start.
"""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

import gallery

N = 32
ALPHA = 0.25
AMPLITUDE = 4.0  # of the first mode
PERIODS = 170  # of the first mode
SHOWN = 4  # modes


def simulate() -> gallery.Table:
    import springstep

    i = np.arange(N + 2)
    mode = np.sqrt(2 / (N + 1)) * np.sin(np.pi * np.outer(i[1:-1], i) / (N + 1))  # [mode, particle]
    omega = 2 * np.sin(np.pi * i[1:-1] / (2 * (N + 1)))

    def quadratic(t: float, x: NDArray[np.float64], v: NDArray[np.float64], force: NDArray[np.float64]) -> None:
        extension = np.diff(x[0]) - 1
        force[0, 1:-1] = ALPHA * np.diff(extension**2)

    scene = springstep.Scene(i + AMPLITUDE * mode[0], np.column_stack([i[:-1], i[1:]]), rest=1.0, stiffness=1.0,
                             pinned=(i == 0) | (i == N + 1), force=quadratic, force_ignores_velocity=True)
    period = 2 * np.pi / omega[0]
    steps = 640 * PERIODS
    times, positions, velocities = scene.run(period * PERIODS / steps, steps, every=320, velocities=True)
    a, b = (positions[:, :, 0] - i) @ mode.T, velocities[:, :, 0] @ mode.T
    energy = (b**2 + (omega * a) ** 2) / 2
    return {"t_periods": times / period, **{f"energy_{k}": energy[:, k - 1] for k in range(1, SHOWN + 1)}}


def draw(table: gallery.Table) -> Figure:
    t, first = table["t_periods"], table["energy_1"]
    figure, axes = plt.subplots(figsize=(6.8, 4.2), layout="constrained")
    for k in range(1, SHOWN + 1):
        axes.plot(t, table[f"energy_{k}"] / first[0], color=gallery.COLOURS[k - 1], label=f"mode {k}")
    late = np.flatnonzero(t > PERIODS / 2)
    back = late[np.argmax(first[late])]
    axes.annotate(f"after {t[back]:.1f} periods: {100 * first[back] / first[0]:.1f} %", (t[back], first[back] / first[0]),
                  (t[back] - 12, 1.1), ha="right", va="center", arrowprops={"arrowstyle": "->"})
    axes.set(xlabel="time / period of the first mode", ylabel="energy of a mode / initial energy", ylim=(0, 1.2), xlim=(0, PERIODS))
    axes.legend(loc="lower left", ncols=SHOWN, bbox_to_anchor=(0, 1), frameon=False)
    return figure


if __name__ == "__main__":
    gallery.main(simulate, draw)
