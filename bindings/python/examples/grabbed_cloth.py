#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A cloth, hung by two corners, is grabbed in the middle, pulled towards us, and let go; drawn with matplotlib.

    grabbed_cloth.py [PICTURE]

To grab a particle is to pin it and to drive the pin; to let it go is to free it.
"""
import sys

import matplotlib.pyplot as plt
import numpy as np

import springstep

N = 25  # particles along an edge
LENGTH = 2.0  # [m] of an edge
MIDDLE = N // 2 * N + N // 2

cloth = springstep.grid([N, N], LENGTH / (N - 1), 500.0, 0.05, families=["structural", "shear", "bend"])
hanging = cloth.position[:, [0, 2, 1]] * [1, 1, -1]  # x to the right, y away from us, z up
cloth.pinned[[0, N - 1]] = True
scene = springstep.Scene(hanging, cloth.links, pinned=cloth.pinned, mass=0.01, drag=0.02, gravity=[0, 0, -9.81], editable=True)
frame = 1 / 60
steps = int(np.ceil(frame / (0.5 * scene.stable_step("leapfrog"))))


def run(seconds, target=None):
    """Advance, with the hand on its way to a target."""
    frames = round(seconds / frame)
    if target is not None:
        scene.drive(MIDDLE, target, frames * frame)
    for _ in range(frames):
        scene.advance(frame / steps, steps)
    if target is not None:
        scene.drive(MIDDLE, None)


pictures = []


def look(title):
    pictures.append((f"{scene.time:.1f} s: {title}", scene.position().reshape(N, N, 3)))


run(2.0)
look("it hangs")
scene.set_pinned([True], first=MIDDLE)
start = scene.position(MIDDLE, 1)[0]
run(0.6, start + [0.0, -0.8, 0.2])
look("a hand has pulled it")
scene.set_pinned([False], first=MIDDLE)
run(0.2)
look("let go, it swings back")
run(0.4)
look("and through")

figure = plt.figure(figsize=(10, 9), layout="constrained")
for place, (title, position) in enumerate(pictures, 1):
    axes = figure.add_subplot(2, 2, place, projection="3d", title=title)
    x, y, z = np.moveaxis(position, 2, 0)
    axes.plot_surface(x, y, z, rstride=1, cstride=1, color="#88ccee", edgecolor="#33669980", linewidth=0.4)
    axes.set(xlim=(-0.2, 2.2), ylim=(-1.2, 1.2), zlim=(-2.4, 0.2))
    axes.set(yticks=(-1, 0, 1), xlabel="x / m", ylabel="y / m", zlabel="z / m")
    axes.set_box_aspect((1, 1, 2.6 / 2.4))
    axes.view_init(elev=12, azim=-60)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "grabbed_cloth.png", dpi=100)
