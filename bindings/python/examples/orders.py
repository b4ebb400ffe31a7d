# SPDX-License-Identifier: MIT
"""Error of every method against the step, for an oscillator: a line of slope p in a plot with logarithmic axes.

A particle on a spring with x'' = -x is released at 1 m. The error is the largest distance from cos(t) within ten seconds.
"""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

import gallery

DURATION = 10.0  # [s]


def simulate() -> gallery.Table:
    import springstep

    rows = []
    for method in springstep.methods():
        if not method.scenes:
            continue
        for steps in np.unique(np.geomspace(8, 20_000, 28).astype(int)):
            scene = springstep.Scene([0.0, 1.0], [(0, 1)], rest=0.0, stiffness=1.0, pinned=[True, False], methods=[method.name])
            dt = DURATION / steps
            times, positions = scene.run(dt, int(steps), method=method.name)
            error = np.abs(positions[:, 1, 0] - np.cos(times)).max()
            if error < 2:
                rows.append((method.label, method.order, dt, error))
    label, order, dt_s, error_m = zip(*rows)
    return {"method": np.array(label), "order": np.array(order), "dt_s": np.array(dt_s), "error_m": np.array(error_m)}


def draw(table: gallery.Table) -> Figure:
    figure, axes = plt.subplots(figsize=(6.8, 5.2), layout="constrained")
    for label, marker, colour in zip(dict.fromkeys(table["method"]), "osD^v<", gallery.COLOURS):
        own = table["method"] == label
        dt, error, order = table["dt_s"][own], table["error_m"][own], int(table["order"][own][0])
        axes.loglog(dt, error, marker=marker, markersize=4, color=colour, label=f"{label}, order {order}")
        start = int(np.argmin(np.abs(np.log(error / 1e-2))))  # a line of the slope of the order, from an error of 1 cm
        guide = dt[start] * np.array([1, (1e-12 / error[start]) ** (1 / order)])
        guide = np.maximum(guide, dt[-1])
        axes.loglog(guide, error[start] * (guide / dt[start]) ** order, color="black", linestyle=":", linewidth=1.2, zorder=3)
    axes.plot([], [], color="black", linestyle=":", linewidth=1.2, label="slope of the order")
    axes.set(xlabel="step / s", ylabel="largest error within 10 s / m", ylim=(1e-15, 2), xlim=(4e-4, 2))
    axes.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=2, frameon=False)
    return figure


if __name__ == "__main__":
    gallery.main(simulate, draw)
