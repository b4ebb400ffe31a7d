# SPDX-License-Identifier: MIT
"""Pictures, and an X server with a pointer and keys."""
import os
import struct
import subprocess
import time

RING = (255, 214, 64)  # what both examples draw around what the hand holds


class Picture:
    """Rows of pixels, each blue, green, red, and maybe a byte more."""

    def __init__(self, rows, width, depth):
        self.rows, self.width, self.height, self.depth = rows, width, len(rows), depth

    def lines(self, box):
        """Lines of (blue, green, red): of all of it, or of a box (left, top, right, bottom)."""
        left, top, right, bottom = box or (0, 0, self.width, self.height)
        for row in self.rows[top:bottom]:
            row = row[left * self.depth:right * self.depth]
            yield list(zip(row[0::self.depth], row[1::self.depth], row[2::self.depth]))

    def colors(self, box=None):
        """All (red, green, blue) that there are."""
        return {color[::-1] for line in self.lines(box) for color in set(line)}

    def changed(self, other, box=None):
        """How many pixels differ."""
        lines = zip(self.lines(box), other.lines(box), strict=True)
        return sum(sum(map(tuple.__ne__, *pair)) for pair in lines if pair[0] != pair[1])

    def ring(self, box=None):
        """The middle of the ring that marks the hand, or None."""
        left, top = box[:2] if box else (0, 0)
        bgr = RING[::-1]
        lines = [(y, line) for y, line in enumerate(self.lines(box), top) if bgr in line]
        found = [(x, y) for y, line in lines for x, color in enumerate(line, left) if color == bgr]
        if not found:
            return None
        x, y = zip(*found)
        return (min(x) + max(x)) / 2, (min(y) + max(y)) / 2


class Screen:
    def __init__(self, display, picture):
        self.environment = {**os.environ, 'DISPLAY': display, 'SDL_VIDEODRIVER': 'x11', 'SDL_RENDER_DRIVER': 'software',
                            'SDL_FRAMEBUFFER_ACCELERATION': '0'}  # pixels straight to the server
        self.file = picture

    def picture(self, window):
        """What is in the window now, from the server's XWD file."""
        data = self.file.read_bytes()
        header = struct.unpack_from('>25I', data)
        assert header[11] == 32 and header[7] == 0, 'not 32 bits a pixel, lowest byte first'
        start, stride = header[0] + 12 * header[19], header[12]
        _, left, top, width, height = window
        rows = [data[start + y * stride:start + (y + 1) * stride] for y in range(top, top + height)]
        return Picture([row[4 * left:4 * (left + width)] for row in rows], width, 4)

    def do(self, *words):
        return subprocess.run(['xdotool', *map(str, words)], env=self.environment, check=True, stdout=subprocess.PIPE,
                              text=True, timeout=30).stdout

    def window(self, name):
        """Wait for a window: its number, left, top, width, height."""
        number = self.do('search', '--sync', '--onlyvisible', '--name', name).split()[0]
        words = dict(line.split('=') for line in self.do('getwindowgeometry', '--shell', number).splitlines())
        return number, int(words['X']), int(words['Y']), int(words['WIDTH']), int(words['HEIGHT'])

    def key(self, window, name):
        """Down alone: a window that it closes would not be there to hear the rest."""
        self.do('keydown', '--window', window[0], name)

    def move(self, window, x, y):
        self.do('mousemove', window[1] + x, window[2] + y)

    def wait_for(self, window, what):
        """The first picture of which that is true; after half a minute the last."""
        end = time.monotonic() + 30
        while True:
            picture = self.picture(window)
            if what(picture) or time.monotonic() > end:
                return picture
            time.sleep(0.05)
