# SPDX-License-Identifier: MIT
"""A rod buckles: a truss between two hinges, which approach each other.

The chords of a ladder with cells of A x A carry bending: EI = K A^3 / 2 for chords of stiffness K. Diagonals carry shear: their
stiffness is K, too. Theory: the elastica, with the load divided by 1 + (Euler load)/(shear stiffness) (Engesser).
"""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

import gallery

CELLS = 30
A = 1 / (CELLS + 1)  # [m] of a cell; the rod has a length of 1 m
K = 2e4  # [N/m]
EULER = np.pi**2 * K * A**3 / 2  # [N] EI pi^2/L^2
CRITICAL = EULER / (1 + EULER / (K * A))
SHORTENINGS = np.concatenate([np.linspace(0, 0.004, 9), [0.01, 0.025], np.linspace(0.05, 0.4, 8)])  # of the length
SHAPES = [0.05, 0.2, 0.4]


def simulate() -> gallery.Table:
    import springstep

    x = (np.arange(CELLS + 1) + 0.5) * A
    nodes = [(0.0, 0.0), *((at, side * A / 2) for at in x for side in (1, -1)), (1.0, 0.0)]
    end = len(nodes) - 1
    links = [(0, 1), (0, 2), (end - 2, end), (end - 1, end)]
    for top in range(1, end, 2):
        links.append((top, top + 1))
        if top + 2 < end:
            links += [(top, top + 2), (top + 1, top + 3), (top, top + 3), (top + 1, top + 2)]
    position = np.array(nodes)
    position[1:-1, 1] += 1e-4 * np.sin(np.pi * position[1:-1, 0])  # it is not quite straight
    scene = springstep.Scene(position, links, stiffness=K, mass=1e-3, drag=0.02, damping=0.05,
                             pinned=np.isin(np.arange(end + 1), [0, end]))
    dt, rows = scene.stable_step() / 2, []
    for shortening in SHORTENINGS:
        if shortening > scene.position(0, 1)[0, 0]:
            steps = int(np.ceil(0.05 / dt))
            scene.drive(end, [1 - shortening, 0], steps * dt)
            scene.advance(dt, steps)
            scene.drive(end, None)
        while not scene.at_rest(1e-4, 0.5):
            scene.advance(dt, 2000)
        now = scene.position()
        directions = (now[[1, 2]] - now[0]) / np.linalg.norm(now[[1, 2]] - now[0], axis=1, keepdims=True)
        load = -scene.tension(0) * directions[0, 0] - scene.tension(1) * directions[1, 0]
        middle = [now[0], *(now[1:-1:2] + now[2:-1:2]) / 2, now[end]]
        rows += [(shortening, load, *point) for point in middle]
    columns = np.array(rows).T
    return dict(zip(["shortening", "load_N", "x_m", "y_m"], columns))


def elastica() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Shortening and load, relative to the Euler load, of an elastica: complete elliptic integrals by the AGM."""
    m = np.linspace(0, 0.55, 400)
    a, b, c, total, power = np.ones_like(m), np.sqrt(1 - m), np.sqrt(m), m / 2, 0.5
    for _ in range(6):
        a, b, c = (a + b) / 2, np.sqrt(a * b), (a - b) / 2
        power *= 2
        total = total + power * c**2
    first = np.pi / (2 * a)
    return 2 * total, (2 * first / np.pi) ** 2


def draw(table: gallery.Table) -> Figure:
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.6, 3.4), layout="constrained", gridspec_kw={"width_ratios": [1.5, 1]})
    for shortening, colour in zip(SHAPES, gallery.COLOURS):
        own = np.isclose(table["shortening"], SHORTENINGS[np.abs(SHORTENINGS - shortening).argmin()])
        left.plot(table["x_m"][own], np.abs(table["y_m"][own]), color=colour, label=f"shortened by {100 * shortening:.0f} %")
    left.plot([0, 1], [0, 0], color="#767676", linewidth=1.2, label="straight")
    left.set(xlabel="x / m", ylabel="y / m", aspect="equal", ylim=(-0.04, 0.52))
    left.legend(loc="upper right", fontsize=9)
    steps, first = np.unique(table["shortening"], return_index=True)
    theory, load = elastica()
    strain = load * CRITICAL / (2 * K * A)  # shortening by compression alone, of two chords
    right.plot(100 * (theory + strain), load, color="#767676", linestyle="--", label="elastica")
    right.plot([0, 100 * CRITICAL / (2 * K * A)], [0, 1], color="#767676", linestyle=":", label="compression")
    right.plot(100 * steps, table["load_N"][first] / CRITICAL, "o", markersize=5, color=gallery.COLOURS[0], label="springstep")
    right.set(xlabel="shortening / %", ylabel="load / critical load", xlim=(-1, 42), ylim=(0, 1.45))
    right.legend(loc="lower right")
    return figure


if __name__ == "__main__":
    gallery.main(simulate, draw)
