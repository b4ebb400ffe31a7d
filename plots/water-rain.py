# SPDX-License-Identifier: MIT
# Rain on height-field water, and a box that hits the water after a quarter of a second, in slow motion. The heights of
# the water are exaggerated. The box is removed when it has come to rest. Leapfrog, two steps of {{
# step('water-rain-energy') }} per picture.
import math

import film

EXAGGERATED = 9  # heights of the water
HEIGHT = 1  # [m] that the box has fallen, see spring-scene --help
GRAVITY = 9.81  # [m/s^2]
FALL = math.sqrt(2 * HEIGHT / GRAVITY)  # [s]


def draw(output, _, data):
    """A picture an instant, from the first drops on."""
    sheet = film.Sheet(data[0])
    length = sheet.at(0, sheet.edge - 1, 0)[0]
    hits = float(film.setting(data[0], "--drop-box").split(",")[0])  # [s]
    stops = hits + float(film.setting(data[0], "--push-duration"))
    view = film.View(22, 27, 355 / length, (20, 275), EXAGGERATED)
    first = next((f for f in range(len(sheet.times)) if sheet.highest(f) > 0.01), 0)
    frames = []
    for f in range(first, len(sheet.times)):
        time = sheet.times[f]
        middle = sheet.at(f, sheet.edge // 2, sheet.edge // 2)[2]
        height = HEIGHT - GRAVITY / 2 * (time - hits + FALL) ** 2  # [m] of the box
        box = cube(view, length, height / EXAGGERATED if height > 0 else middle) if time < stops else ""
        frames.append(film.water(sheet, f, view) + box + film.text(f"{time:.2f} s", 505, 28, "end"))
    film.write(output, "water-rain", 415, frames, 0.04, 40, above=film.walls(view, length, 0.11))


def cube(view, length, above):
    """A box of an eighth of the length above the middle: its front, its right side and its top."""
    low, high = length * 7 / 16, length * 9 / 16
    top = above + length / 8 / EXAGGERATED
    faces = (
        [(low, low, above), (high, low, above), (high, low, top), (low, low, top)],
        [(high, low, above), (high, high, above), (high, high, top), (high, low, top)],
        [(low, low, top), (high, low, top), (high, high, top), (low, high, top)],
    )
    return "".join(film.lines("box", [view(p) for p in face], closed=True) for face in faces)


film.main(draw, 1)
