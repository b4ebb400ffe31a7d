# SPDX-License-Identifier: MIT
"""What the programs of the gallery share: tables of numbers in files, and the style of figures.

    NAME.py [PICTURE]              simulates and draws; by default NAME.png
    NAME.py --write DATA           simulates and writes what is drawn
    NAME.py --read DATA PICTURE    draws what was written; needs no springstep
"""
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

matplotlib.use("Agg")
plt.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "springstep", "font.size": 11, "axes.grid": True, "grid.color": "#d9d9d9",
    "grid.linewidth": 0.6, "axes.axisbelow": True, "lines.linewidth": 1.8, "legend.framealpha": 0.9,
})
#: The palette of Okabe and Ito, which colour-blind readers can tell apart.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]

Table = Mapping[str, NDArray[Any]]  # columns of equal length, by name with unit


def write(path: Path, table: Table) -> None:
    """Write a table as tab-separated values."""
    lines = [f"# command: {Path(sys.argv[0]).name} --write {path.name}", "\t".join(table)]
    for row in zip(*table.values()):
        lines.append("\t".join(value if isinstance(value, str) else f"{value:.17g}" for value in row))
    path.write_text("\n".join(lines) + "\n")


def read(path: Path) -> Table:
    """Read a table that write() has written."""
    header, *rows = [line.split("\t") for line in path.read_text().splitlines() if not line.startswith("#")]
    columns = {}
    for name, *values in zip(header, *rows):
        numbers = all(value.strip("-+.0123456789e") in ("", "nan", "inf") for value in values)
        columns[name] = np.array(values, np.float64 if numbers else np.str_)
    return columns


def main(simulate: Callable[[], Table], draw: Callable[[Table], Figure]) -> None:
    """Do what the arguments of the program say."""
    options = sys.argv[1:]
    if options[:1] == ["--write"]:
        write(Path(options[1]), simulate())
        return
    table = read(Path(options[1])) if options[:1] == ["--read"] else simulate()
    picture = Path(options[-1]) if options else Path(sys.argv[0]).with_suffix(".png")
    draw(table).savefig(picture, dpi=110, metadata={"Date": None} if picture.suffix == ".svg" else {})
