# SPDX-License-Identifier: MIT
"""examples/love: with a real pointer, and with the library in each place where the game searches for it."""
import contextlib
import os
import shutil
import subprocess
import time

import pytest

GAME, LIBRARY = os.environ['GAME'], os.environ.get('SPRINGSTEP_LIBRARY')
# The folder where the library is built, with springstep.lua in it.
BUILD = os.path.dirname(LIBRARY or '')

pytestmark = [
    pytest.mark.skipif(shutil.which('love') is None, reason='no love'),
    pytest.mark.skipif(LIBRARY is None, reason='the library is not shared, or built with sanitizers'),
]


@contextlib.contextmanager
def running(screen, game, **variables):
    """The program, and what it prints."""
    environment = {name: value for name, value in screen.environment.items() if name != 'SPRINGSTEP_LIBRARY'}
    with subprocess.Popen(['love', game], env={**environment, **variables}, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as program:
        try:
            yield program
        finally:
            program.kill()


def ring_is_at(x, y):
    def there(picture):
        ring = picture.ring()
        return ring is not None and abs(ring[0] - x) < 1.5 and abs(ring[1] - y) < 1.5
    return there


def test_a_rope_on_the_pointer(screen, tmp_path):
    """A copy of the folder, with springstep.lua and the library in it."""
    game = shutil.copytree(GAME, tmp_path / 'game')
    shutil.copy(LIBRARY, game)
    shutil.copy(f'{BUILD}/springstep.lua', game)
    with running(screen, game) as program:
        window = screen.window('rope on the pointer')
        screen.move(window, 300, 120)
        first = screen.wait_for(window, ring_is_at(300, 120))
        assert ring_is_at(300, 120)(first) and len(first.colors()) > 100
        screen.move(window, 520, 180)
        second = screen.wait_for(window, ring_is_at(520, 180))
        assert ring_is_at(520, 180)(second) and first.changed(second) > 2000
        ball = 0, 360, window[3], window[4]  # it hangs there, and falls when the rope is cut
        assert len(screen.wait_for(window, lambda picture: len(picture.colors(ball)) > 20).colors(ball)) > 20
        screen.do('click', 1)
        assert len(screen.wait_for(window, lambda picture: len(picture.colors(ball)) == 1).colors(ball)) == 1
        time.sleep(1)  # it has not just swung higher
        assert len(screen.picture(window).colors(ball)) == 1
        screen.key(window, 'r')
        assert len(screen.wait_for(window, lambda picture: len(picture.colors(ball)) > 20).colors(ball)) > 20
        screen.key(window, 'Escape')
        assert program.wait(30) == 0
        assert program.stdout.read() == ''


def test_in_the_checkout(screen):
    """springstep.lua in LUA_PATH, and the library next to it."""
    with running(screen, GAME, LUA_PATH=f'{BUILD}/?.lua;;'):
        window = screen.window('rope on the pointer')
        screen.move(window, 400, 150)
        assert ring_is_at(400, 150)(screen.wait_for(window, ring_is_at(400, 150)))


def test_no_library(screen):
    """It says what is missing, and where it was looked for: in the window, and when that is closed to the shell."""
    with running(screen, GAME, LUA_PATH=f'{BUILD}/?.lua;;', SPRINGSTEP_LIBRARY='/nonexistent/library.so') as program:
        window = screen.window('rope on the pointer')
        blue = 89, 157, 220  # LÖVE's for errors
        assert blue in screen.wait_for(window, lambda picture: blue in picture.colors()).colors()
        screen.key(window, 'Escape')
        said, _ = program.communicate(timeout=30)
        assert program.returncode == 1
    for words in 'The springstep library is missing', 'SPRINGSTEP_LIBRARY', '/nonexistent/library.so':
        assert words in said
