# SPDX-License-Identifier: MIT
# A sphere pushes a cloth that hangs from two corners, with friction. The cloth has 25² particles. Leapfrog advances
# it by ten steps per frame of 1/60 s; every third frame is drawn, and every second row of particles.
import film


def draw(output, _, data):
    """One picture per frame."""
    sheet = film.Sheet(data[0])
    sphere = film.collider(data[0])
    view = film.View(28, 18, 140, (130, 105))
    frames = []
    for f, time in enumerate(sheet.times):
        centre = [sphere[a] + time * sphere.get("v" + a, 0) for a in "xyz"]
        ball = film.Ball(view, centre, sphere["radius"])
        frames.append(film.cloth(sheet, f, view, ball, every=2) + film.text(f"{time:.2f} s", 505, 28, "end"))
    film.write(output, "cloth-sphere", 440, frames, sheet.times[1] - sheet.times[0], 38)


film.main(draw, 1)
