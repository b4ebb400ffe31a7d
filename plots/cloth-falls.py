# SPDX-License-Identifier: MIT
# The cloth of the figure above in real time. Every second row of its links is drawn. The dots are the pinned corners,
# and the square below the cloth has the size of the cloth.
import film


def draw(output, _, data):
    """A picture an instant."""
    sheet = film.Sheet(data[0])
    edge = sheet.edge
    view = film.View(28, 24, 145, (95, 115))
    frames = []
    for f, time in enumerate(sheet.times):
        points = [[view(sheet.at(f, i, j)) for i in range(edge)] for j in range(edge)]
        threads = points[::2] + [list(row) for row in zip(*points)][::2]
        frames.append(film.lines("thread", *threads) + film.text(f"{time:.2f} s", 505, 28, "end"))
    floor = film.lines("quiet", [view((x, y, -2.1)) for x, y in ((0, 0), (2, 0), (2, 2), (0, 2))], closed=True)
    pins = "".join(film.pin(view((x, 0, 0))) for x in (0, 2))
    film.write(output, "cloth-falls", 480, frames, 0.04, 20, floor + pins)


film.main(draw, 1)
