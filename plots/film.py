# SPDX-License-Identifier: MIT
"""What the animations share: scenes in perspective, a picture for each instant, as one SVG that plays by style alone.

It plays wherever a browser or a code host shows pictures, takes the colours of the dark, stands still for those who ask for
that, and can be paused by a style of the page around it. A script is called as those for gnuplot are: OUTPUT METHODS DATA...
"""

import math
import pathlib
import sys

WIDTH = 520  # [px], as in style.gp
SCALE = 4  # coordinates are quarters of a pixel

STYLE = """
@supports (animation-name: none) {{
.{name} .frame {{ visibility: hidden; animation: {name} {seconds:g}s step-end infinite }}
}}
@keyframes {name} {{ 0% {{ visibility: visible }} {share:.4f}% {{ visibility: hidden }} }}
@media (prefers-reduced-motion: reduce) {{
.{name} .frame {{ animation: none }}
.{name} .still {{ visibility: visible }}
}}
.{name} {{ color: #1b1b1b }}
.{name} path {{ fill: none; stroke: #0072b2; stroke-width: 4; stroke-linejoin: round }}
.{name} .water {{ fill: #dcebf7; stroke-width: 3 }}
.{name} .wall {{ stroke: #b4b4b4 }}
.{name} .quiet {{ stroke: #b4b4b4; stroke-width: 5 }}
.{name} .box {{ fill: #b35a1f; stroke: #dcebf7; stroke-width: 6 }}
.{name} .pin {{ fill: currentColor }}
.{name} .ball {{ fill: #e69f00; stroke: #a06c00; stroke-width: 4 }}
.{name} .cloth path {{ stroke: #00558c; stroke-width: 2 }}
.{name} .t0 {{ fill: #4479ad }}
.{name} .t1 {{ fill: #6a9aca }}
.{name} .t2 {{ fill: #8db4de }}
.{name} .t3 {{ fill: #b3d0ef }}
.{name} text {{ fill: currentColor; font: {size}px sans-serif }}
@media (prefers-color-scheme: dark) {{
.{name} {{ color: #e8e8e8 }}
.{name} path {{ stroke: #62b8f2 }}
.{name} .water {{ fill: #17293a }}
.{name} .wall, .{name} .quiet {{ stroke: #5a5e62 }}
.{name} .cloth path {{ stroke: #0d2b45 }}
.{name} .box {{ fill: #ff9a52; stroke: #17293a }}
}}
"""


class DataError(Exception):
    """What a data file lacks."""


def columns(file_name, names):
    """The columns of a data file, by their names, as text: a list of rows."""
    with open(file_name, encoding="utf-8") as file:
        lines = [line.rstrip("\n").split("\t") for line in file if not line.startswith("#")]
    header = lines[0] if lines else []
    for name in names:
        if name not in header:
            raise DataError(f'{file_name}: no column "{name}"')
        if not any(line[header.index(name)] for line in lines[1:]):
            raise DataError(f'{file_name}: no value in column "{name}"')
    places = [header.index(name) for name in names]
    return [[line[place] for place in places] for line in lines[1:]]


def collider(file_name):
    """The fields of the --collider of the command that wrote a data file."""
    fields = setting(file_name, "--collider").split(":")[1].split(",")
    return {name: float(number) for name, number in (field.split("=") for field in fields)}


def setting(file_name, option):
    """The value of an option of the command that wrote a data file; it stands in its first lines."""
    with open(file_name, encoding="utf-8") as file:
        words = next((line for line in file if line.startswith("# command:")), "").split()
    if option not in words:
        raise DataError(f"{file_name}: made without {option}")
    return words[words.index(option) + 1]


def steppers(table):
    """Names and labels of the methods for scenes, in the order of the table, without the exact solution."""
    rows = columns(table, ["method", "label", "order", "scenes"])
    return [(name, label) for name, label, order, scenes in rows if int(order) > 0 and scenes == "1"]


class Sheet:
    """The positions of a square sheet at all its instants: at(frame, i, j) is (x, y, z)."""

    def __init__(self, file_name):
        rows = columns(file_name, ["t_s", "i", "x_m", "y_m", "z_m"])
        self.edge = max(int(row[1]) for row in rows) + 1
        particles = self.edge**2
        self.times = [float(row[0]) for row in rows[::particles]]
        self._points = [tuple(map(float, row[2:])) for row in rows]

    def at(self, frame, i, j):
        """Where the particle i along x and j along y is."""
        return self._points[(frame * self.edge + j) * self.edge + i]

    def highest(self, frame):
        """The largest distance from z = 0."""
        particles = self.edge**2
        return max(abs(z) for _, _, z in self._points[frame * particles : (frame + 1) * particles])


class View:
    """From the right of the y axis by some degrees and from above by some: where a point is in the picture."""

    def __init__(self, across, above, scale, origin, up=1):
        a, e = math.radians(across), math.radians(above)
        self._x = (scale * math.cos(a), scale * math.sin(a), 0)
        self._y = (scale * math.sin(a) * math.sin(e), -scale * math.cos(a) * math.sin(e), -scale * up * math.cos(e))
        self._origin = origin
        self._towards = (math.sin(a) * math.cos(e), -math.cos(a) * math.cos(e), math.sin(e))
        self.scale = scale

    def depth(self, point):
        """Return the coordinate of a point along the line of sight [m]; it is larger for nearer points."""
        return sum(a * p for a, p in zip(self._towards, point))

    def __call__(self, point):
        """In units of the drawing."""
        return tuple(round(SCALE * (o + sum(a * p for a, p in zip(axis, point))))
                     for axis, o in ((self._x, self._origin[0]), (self._y, self._origin[1])))


def lines(kind, *lists, closed=False):
    """Lines through points of the drawing: of each the distance from the one before, which takes the fewest letters."""
    data = ""
    for points in lists:
        steps = [f"{x - x0} {y - y0}" for (x0, y0), (x, y) in zip(points, points[1:])]
        data += f"M{points[0][0]} {points[0][1]}l{' '.join(steps)}{'z' * closed}".replace(" -", "-")
    return f'<path class="{kind}" d="{data}"/>'


def text(words, x, y, anchor="start"):
    """Words at a place in pixels."""
    return f'<text x="{SCALE * x:g}" y="{SCALE * y:g}" text-anchor="{anchor}">{words}</text>'


def pin(point):
    """A dot where a particle is held."""
    return f'<circle class="pin" cx="{point[0]}" cy="{point[1]}" r="{5 * SCALE}"/>'


def water(sheet, frame, view, every=1, most=math.inf):
    """A surface seen from the front: strips from the back to the front, each in front of those behind it; none beyond most."""

    def place(i, j):
        x, y, z = sheet.at(frame, i, j)
        return view((x, y, max(-most, min(most, z))))

    rows = [[place(i, j) for i in range(sheet.edge)] for j in range(0, sheet.edge, every)]
    return "".join(lines("water", back + front[::-1], closed=True) for back, front in zip(rows[:0:-1], rows[-2::-1]))


class Ball:
    """A sphere in the picture. Whatever is outside it and nearer than its centre is in front of it."""

    def __init__(self, view, centre, radius):
        x, y = view(centre)
        self.depth = view.depth(centre)
        self.drawing = f'<circle class="ball" cx="{x}" cy="{y}" r="{SCALE * view.scale * radius:g}"/>'


LIGHT = (0.3, -0.5, 0.81)  # towards the light, of length 1
TONES = 4


def cloth(sheet, frame, view, ball, every):
    """A cloth and a sphere: facets of every so many links, from the farthest to the nearest, in tones by their normals."""
    parts = [(ball.depth, ball.drawing)]
    for j in range(0, sheet.edge - every, every):
        for i in range(0, sheet.edge - every, every):
            corners = [sheet.at(frame, *at) for at in ((i, j), (i + every, j), (i + every, j + every), (i, j + every))]
            u, v = ([b - a for a, b in zip(corners[k], corners[k + 2])] for k in (0, 1))
            normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            share = abs(sum(a * b for a, b in zip(LIGHT, normal))) / math.hypot(*normal)
            tone = min(int(TONES * share), TONES - 1)
            parts.append((sum(map(view.depth, corners)) / 4, lines(f"t{tone}", [view(c) for c in corners], closed=True)))
    return f'<g class="cloth">{"".join(drawing for _, drawing in sorted(parts))}</g>'


def walls(view, length, depth):
    """The two sides that are seen of a block of water, whose edges are held: they hide what reaches lower than its front."""
    front = [(0, 0, 0), (length, 0, 0), (length, 0, -depth), (0, 0, -depth)]
    right = [(length, 0, 0), (length, length, 0), (length, length, -depth), (length, 0, -depth)]
    return "".join(lines("water wall", [view(p) for p in side], closed=True) for side in (front, right))


def write(output, name, height, frames, seconds, still, below="", above=""):
    """The SVG of frames, each a text of its elements, shown for so many seconds each, between what does not move.

    The frame numbered still, or the last, is shown where nothing may move, and by programs that know no animations.
    """
    if pathlib.Path(output).suffix != ".svg":
        raise DataError(f'"{output}": an animation is written to a file that ends in .svg')
    share = math.floor(1e6 / len(frames)) / 1e4  # rounded down, or two frames would be visible for a moment
    style = STYLE.format(name=name, seconds=seconds * len(frames), share=share, size=18 * SCALE)

    def group(k):
        kind = 'frame still"' if k == min(still, len(frames) - 1) else 'frame" visibility="hidden"'
        return f'<g class="{kind} style="animation-delay:{k * seconds:.3f}s">{frames[k]}</g>'

    groups = "\n".join(map(group, range(len(frames))))
    pathlib.Path(output).write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" class="film {name}"\n width="{WIDTH}" height="{height}"\n'
        f' viewBox="0 0 {SCALE * WIDTH} {SCALE * height}">\n<style>{style}</style>\n{below}\n{groups}\n{above}\n</svg>\n',
        encoding="utf-8")


def main(draw, files):
    """Calls draw(output, table, data files), of which there are so many, or as many as there are methods for scenes."""
    output, table, data = sys.argv[1], sys.argv[2], sys.argv[3].split()
    try:
        count = files or len(steppers(table))
        if len(data) != count:
            raise DataError(f"{len(data)} data files where there should be {count}: {sys.argv[3]}")
        draw(output, table, data)
    except DataError as error:
        sys.exit(f"{sys.argv[0]}: {error}")
    except OSError as error:
        sys.exit(f"{sys.argv[0]}: {error.filename}: {error.strerror}")
