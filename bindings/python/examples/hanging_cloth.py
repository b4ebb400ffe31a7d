# SPDX-License-Identifier: MIT
"""A cloth hangs from its corners, at rest under its weight; the colour is the tension of its threads."""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

import gallery

N = 25  # particles along an edge
EDGE = 1.0  # [m]


def simulate() -> gallery.Table:
    import springstep

    cloth = springstep.grid([N, N], EDGE / (N - 1), 60.0, 0.02, families=["structural", "shear"])
    cloth.pinned[[0, N - 1, N * (N - 1), N * N - 1]] = True
    cloth.position[:, :2] *= 0.85  # slack, between its corners
    scene = springstep.Scene.from_grid(cloth, mass=0.2 / N**2, gravity=[0, 0, -9.81], drag=1e-3, tension_only=True)
    dt = scene.stable_step() / 2
    while not scene.at_rest(1e-4, 1e-2):
        scene.advance(dt, 1000)
    pulled, threads = np.zeros(N * N), np.zeros(N * N)
    for i in range(scene.links):
        a, b, rest, *_ = scene.link(i)
        if rest < 1.1 * EDGE / (N - 1):  # not the diagonals
            pulled[[a, b]] += scene.tension(i)
            threads[[a, b]] += 1
    x, y, z = scene.position().T
    return {"x_m": x, "y_m": y, "z_m": z, "tension_N": pulled / threads}


def draw(table: gallery.Table) -> Figure:
    x, y, z, tension = (table[name].reshape(N, N) for name in ("x_m", "y_m", "z_m", "tension_N"))
    facets = (tension[:-1, :-1] + tension[1:, :-1] + tension[:-1, 1:] + tension[1:, 1:]) / 4
    colours = ScalarMappable(Normalize(0, float(np.quantile(facets, 0.98))), "cividis")
    figure = plt.figure(figsize=(6.8, 4.4))
    axes = figure.add_subplot(projection="3d", box_aspect=(1, 1, 0.5))
    axes.plot_surface(x, y, z, rstride=1, cstride=1, facecolors=colours.to_rgba(facets), linewidth=0.2, edgecolor="#00000030",
                      shade=False)
    axes.set(xlabel="x / m", ylabel="y / m", zlabel="z / m", zticks=(-0.4, -0.2, 0))
    axes.view_init(elev=22, azim=-62)
    figure.colorbar(colours, ax=axes, shrink=0.7, pad=0.12, extend="max", label="tension of a thread / N")
    figure.subplots_adjust(left=0, right=0.95, bottom=0, top=1.08)
    return figure


if __name__ == "__main__":
    gallery.main(simulate, draw)
