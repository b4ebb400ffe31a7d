# SPDX-License-Identifier: MIT
"""examples/sdl, with a real pointer and real keys."""
import contextlib
import os
import pathlib
import re
import subprocess

import pytest

SPRINGS = os.environ.get('SPRINGS')
SCENES = 'cloth', 'rope', 'water', 'drape', 'cape'
BELOW_TEXT = 0, 200, 1000, 660  # of the window: neither settings nor help
SETTINGS, TROUBLE = (8, 8, 374, 190), (0, 560, 1000, 640)
GREEN, AMBER, RED = (120, 215, 150), (255, 190, 70), (255, 104, 88)

pytestmark = pytest.mark.skipif(SPRINGS is None, reason='examples/sdl was not built: no SDL2 2.0.18 or later')


def springs(*options, env=None):
    return subprocess.run([SPRINGS, *options], env=env, capture_output=True, text=True, timeout=120, check=False)


@contextlib.contextmanager
def running(screen, *options):
    """The window of the program, when it shows a scene; in the end Escape closes it."""
    with subprocess.Popen([SPRINGS, *options], env=screen.environment, stdin=subprocess.DEVNULL) as program:
        try:
            window = screen.window('^springstep$')
            assert wait(screen, window, lambda picture: len(picture.colors(BELOW_TEXT)) > 100)
            yield window
            screen.key(window, 'Escape')
            assert program.wait(30) == 0
        finally:
            program.kill()


def wait(screen, window, what):
    """Does a picture come of which that is true?"""
    return what(screen.wait_for(window, what))


def press(screen, window, *names):
    for name in names:
        screen.do('key', '--window', window[0], name)


@pytest.mark.parametrize('options', [['--nonsense', '1'], ['--scene'], ['--scene', 'jelly'], ['--method', 'nonsense'],
                                     ['--method', 'exact']])
def test_bad_options(options):
    result = springs(*options)
    assert (result.returncode, result.stdout) == (2, '')
    message, = result.stderr.splitlines()
    assert options[-2 if options[0] == '--nonsense' else -1] in message


def test_no_window():
    nowhere = {**os.environ, 'SDL_VIDEODRIVER': 'x11', 'DISPLAY': ':nowhere'}
    result = springs(env=nowhere)
    assert (result.returncode, result.stdout) == (1, '')
    assert result.stderr.startswith('springs: no window: ')


@pytest.mark.parametrize('scene', SCENES)
def test_every_scene_moves(screen, scene):
    with running(screen, '--scene', scene) as window:
        first = screen.picture(window)
        assert wait(screen, window, lambda picture: picture.changed(first, BELOW_TEXT) > 2000)


def changes(screen, window, key, row):
    """Does the key change what stands in this row of the settings?"""
    place = 92, 20 + 17 * row, 300, 33 + 17 * row
    before = screen.picture(window)
    press(screen, window, key)
    return wait(screen, window, lambda picture: picture.changed(before, place) > 0)


def test_keys(screen):
    with running(screen, '--scene', SCENES[-1]) as window:
        for place in range(1, len(SCENES) + 1):
            assert changes(screen, window, str(place), 0)
        for key, row in [('m', 1), ('n', 1), ('Up', 2), ('Down', 2), ('Right', 4), ('Left', 4)]:
            assert changes(screen, window, key, row)


def test_grab_and_cut(screen):
    """The nail of the rope, a pin that is always there, follows the pointer. What is cut off falls out of the window."""
    def ring_is_at(x, y):
        return lambda picture: picture.ring() is not None and max(abs(picture.ring()[0] - x), abs(picture.ring()[1] - y)) < 1.5

    with running(screen, '--scene', 'rope') as window:
        screen.move(window, 500, 76)
        screen.do('mousedown', 1)
        screen.move(window, 640, 230)
        assert wait(screen, window, ring_is_at(640, 230))
        screen.do('mouseup', 1)
        assert wait(screen, window, lambda picture: picture.ring() is None)
        press(screen, window, 'r')
        ball = 0, 560, 1000, 660
        assert wait(screen, window, lambda picture: len(picture.colors(ball)) > 100)
        screen.move(window, 300, 330)
        screen.do('mousedown', 3)
        for x in range(320, 900, 20):
            screen.move(window, x, 330)
        screen.do('mouseup', 3)
        assert wait(screen, window, lambda picture: len(picture.colors(ball)) < 100)


def test_poke_and_wind(screen):
    """Only that nothing breaks: water and cloth move without them, too."""
    with running(screen, '--scene', 'water') as window:
        screen.move(window, 600, 400)
        screen.do('click', 2)
        press(screen, window, 'space', '1', 'w', 'space')
        assert RED not in screen.picture(window).colors(TROUBLE)


@pytest.mark.parametrize('scene, method, cure', [('cloth', 'euler', ['m', 'r']), ('water', 'rkn8', ['Left', 'Left']),
                                                 ('drape', 'rkn8', ['m', 'm', 'm']), ('drape', 'euler', ['m'])])
def test_trouble_is_told_and_cured(screen, scene, method, cure):
    """Euler's method explodes, or has no contacts; RKN8 is not for damped links, nor for contacts."""
    with running(screen, '--scene', scene, '--method', method) as window:
        assert wait(screen, window, lambda picture: RED in picture.colors(TROUBLE))
        press(screen, window, *cure)
        assert wait(screen, window, lambda picture: RED not in picture.colors(TROUBLE))


def test_steps_above_the_stable_step_are_marked(screen):
    with running(screen, '--scene', 'rope') as window:
        assert wait(screen, window, lambda picture: GREEN in picture.colors(SETTINGS))
        press(screen, window, *['Down'] * 12)
        assert wait(screen, window, lambda picture: AMBER in picture.colors(SETTINGS))


def test_the_command_in_the_first_comment():
    """It names all files and what they include; the library need not be installed, since nothing is linked, of which clang
    warns."""
    root = pathlib.Path(__file__).resolve().parents[2]
    with open(f'{root}/examples/sdl/main.c', encoding='utf-8') as file:
        command, = re.findall(r'^ \* +cc (-std=.*)$', file.read(), re.MULTILINE)
    command = f'{os.environ.get("CC", "cc")} -Wall -Wextra -Wpedantic -Wconversion -Werror -fsyntax-only '\
              f'-Wno-unused-command-line-argument {command}'
    subprocess.run(['bash', '-c', command], cwd=f'{root}/examples/sdl', env={**os.environ, 'CPATH': f'{root}/include'},
                   check=True, timeout=120)
