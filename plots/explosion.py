# SPDX-License-Identifier: MIT
# The water of the figure above after a disturbance in the middle, in slow motion, with one picture per step of {{
# step('water-2ms-euler-energy') }}. Very large heights and depths are cut off, and the largest value is written below
# the surface.
import math

import film

MOST = 0.5  # [m]
EXPLODED = 1  # [m] from here on a surface is no longer one


def metres(z):
    """With a power of ten where it is large."""
    exponent = math.floor(math.log10(z))
    digits = str(exponent).translate(str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"{z:.0f} m" if z < 1000 else f"{z / 10**exponent:.0f}·10{digits} m"


def draw(output, table, data):
    """A surface for each method, and below it how high it is where it has exploded; from the first that is seen on."""
    sheets = [film.Sheet(name) for name in data]
    length = sheets[0].at(0, sheets[0].edge - 1, 0)[0]
    names = "".join(film.text(label, *place(m, 24), "middle") for m, (_, label) in enumerate(film.steppers(table)))
    first = next((f for f in range(len(sheets[0].times)) if sheets[0].highest(f) > 0.02), 0)
    frames = []
    for f in range(first, len(sheets[0].times)):
        elements = []
        for m, sheet in enumerate(sheets):
            x, y = place(m, 130)
            view = film.View(22, 27, 112 / length, (x - 70, y), 3.6)
            elements.append(film.water(sheet, f, view, 2, MOST))
            if sheet.highest(f) > EXPLODED:
                elements.append(film.text(metres(sheet.highest(f)), *place(m, 205), "middle"))
        time = film.text(f"{1000 * sheets[0].times[f]:.0f} ms", 505, height(len(sheets)) - 12, "end")
        frames.append("".join(elements) + time)
    film.write(output, "explosion", height(len(sheets)), frames, 0.1, 12, names)


def place(m, down):
    """So far down in the cell of the m-th method, in its middle."""
    return 520 * (m % 3 + 0.5) / 3, down + 220 * (m // 3)


def height(methods):
    """Of the picture."""
    return 220 * ((methods + 2) // 3) + 30


film.main(draw, 0)
