# SPDX-License-Identifier: MIT
"""A rope falls over a sphere, seen from the side: without friction it slides off, with friction it stays."""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Circle

import gallery

PARTICLES = 81
LENGTH, RADIUS, THICKNESS = 2.0, 0.25, 0.01  # [m]
FRICTIONS = [0.0, 0.5]
TIMES = np.linspace(0, 1.8, 7)  # [s]


def simulate() -> gallery.Table:
    import springstep

    rope = springstep.grid([PARTICLES], LENGTH / (PARTICLES - 1), 3000.0, 0.5, axes=2)
    rows = []
    for friction in FRICTIONS:
        scene = springstep.Scene.from_grid(rope, position=rope.position + [-0.42 * LENGTH, RADIUS + THICKNESS], mass=0.01,
                                           gravity=[0, -9.81], drag=0.02, colliders=1, particle_radius=THICKNESS)
        scene.set_colliders([springstep.sphere([0, 0], RADIUS, friction=friction)])
        steps = int(np.ceil(TIMES[1] / (scene.stable_step() / 2)))
        times, positions = scene.run(TIMES[1] / steps, steps * (len(TIMES) - 1), every=steps)
        rows += [(friction, t, *point) for t, position in zip(times, positions) for point in position]
    return dict(zip(["friction", "t_s", "x_m", "y_m"], np.array(rows).T))


def draw(table: gallery.Table) -> Figure:
    frictions, times = np.unique(table["friction"]), np.unique(table["t_s"])
    figure, panels = plt.subplots(len(frictions), len(times), figsize=(8.6, 5), layout="constrained", sharex=True, sharey=True)
    for row, friction, colour in zip(panels, frictions, gallery.COLOURS):
        for axes, t in zip(row, times):
            own = (table["friction"] == friction) & (table["t_s"] == t)
            axes.add_patch(Circle((0, 0), RADIUS, facecolor="#d9d9d9", edgecolor="none"))
            axes.plot(table["x_m"][own], table["y_m"][own], color=colour, clip_on=False)
            axes.set(aspect="equal", xlim=(-0.75, 0.75), ylim=(-1.75, 0.35), xticks=[], yticks=[])
            axes.spines[:].set_visible(False)
            if axes in panels[0]:
                axes.set_title(f"{t:.1f} s", fontsize=11)
        row[0].set_ylabel(f"friction {friction:g}")
    return figure


if __name__ == "__main__":
    gallery.main(simulate, draw)
