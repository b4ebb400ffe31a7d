# SPDX-License-Identifier: MIT
"""examples/sdl: run by scripts with fixed frames, and once with a real key, under a separate X server. To run it by hand:

    SPRINGS=$PWD/build/examples/springs PATH=$PWD/build/tools:$PATH /usr/bin/python3 -m pytest tests/windows
"""
import os
import pathlib
import re
import shlex
import shutil
import struct
import subprocess

import pytest

SPRINGS = os.environ.get('SPRINGS')
SCENES = 'cloth', 'rope', 'water', 'drape', 'cape'
BELOW_TEXT = 0, 200, 1000, 660  # of the window: neither settings nor help
SETTINGS, TROUBLE = (8, 8, 374, 190), (0, 560, 1000, 640)
AMBER, RED = (255, 190, 70), (255, 104, 88)
RING = (255, 214, 64)  # around what the hand holds
NOT_FINITE, NOT_SUPPORTED = 'the state would become infinite or not a number', 'not supported'

pytestmark = pytest.mark.skipif(SPRINGS is None, reason='examples/sdl was not built: no SDL2 2.0.18 or later')


class Picture:
    """Rows of pixels, each blue, green, red."""

    def __init__(self, rows):
        self.rows = rows

    def lines(self, box):
        """Lines of (blue, green, red): of a box (left, top, right, bottom)."""
        left, top, right, bottom = box
        for row in self.rows[top:bottom]:
            row = row[3 * left:3 * right]
            yield list(zip(row[0::3], row[1::3], row[2::3]))

    def colors(self, box):
        """All (red, green, blue) that there are."""
        return {color[::-1] for line in self.lines(box) for color in set(line)}

    def changed(self, other, box):
        """How many pixels differ."""
        lines = zip(self.lines(box), other.lines(box), strict=True)
        return sum(sum(map(tuple.__ne__, *pair)) for pair in lines if pair[0] != pair[1])

    def ring(self, box):
        """The middle of the ring that marks the hand, or None."""
        left, top = box[:2]
        bgr = RING[::-1]
        lines = [(y, line) for y, line in enumerate(self.lines(box), top) if bgr in line]
        found = [(x, y) for y, line in lines for x, color in enumerate(line, left) if color == bgr]
        if not found:
            return None
        x, y = zip(*found)
        return (min(x) + max(x)) / 2, (min(y) + max(y)) / 2


def read_bmp(path):
    """24 bits a pixel, the lowest row first, each padded to 4 bytes."""
    data = pathlib.Path(path).read_bytes()
    offset, = struct.unpack_from('<I', data, 10)
    width, height = struct.unpack_from('<ii', data, 18)
    assert data[:2] == b'BM' and struct.unpack_from('<H', data, 28) == (24,)
    stride = (3 * width + 3) // 4 * 4
    rows = [data[offset + y * stride:offset + y * stride + 3 * width] for y in range(height)]
    return Picture(rows[::-1])


@pytest.fixture(name='screen')
def fixture_screen():
    """The environment of an X server without a window manager. Each test has its own: a server starts anew when its last
    window closes, and refuses whoever comes meanwhile."""
    for command in 'Xvfb', 'xdotool':
        if shutil.which(command) is None:
            pytest.skip(f'no {command}')
    read, write = os.pipe()
    with subprocess.Popen(['Xvfb', '-displayfd', str(write), '-screen', '0', '1024x768x24', '-nolisten', 'tcp'],
                          pass_fds=[write], stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as server:
        os.close(write)
        with os.fdopen(read) as number:
            display = number.readline().strip()
        assert display, 'Xvfb has not started'
        yield {**os.environ, 'DISPLAY': f':{display}', 'SDL_VIDEODRIVER': 'x11', 'SDL_RENDER_DRIVER': 'software',
               'SDL_FRAMEBUFFER_ACCELERATION': '0'}  # pixels straight to the server
        server.terminate()


def springs(*options, env=None):
    return subprocess.run([SPRINGS, *options], env=env, capture_output=True, text=True, timeout=120, check=False)


@pytest.fixture(name='play')
def fixture_play(screen, tmp_path):
    """Play a script, its lines divided by "; ": the states that it says, the pictures that it saves."""

    def play(*parts, scene='cloth', method='leapfrog'):
        script, pictures = tmp_path / 'script', []
        with script.open('w') as file:
            for line in '; '.join(parts).split('; '):
                if line == 'save':
                    pictures.append(tmp_path / f'{len(pictures)}.bmp')
                    line = f'save {pictures[-1]}'
                print(line, file=file)
        result = springs('--scene', scene, '--method', method, '--script', script, env=screen)
        assert (result.returncode, result.stderr) == (0, '')
        states = [dict(word.split('=') for word in shlex.split(line)) for line in result.stdout.splitlines()]
        return states, [read_bmp(picture) for picture in pictures]

    return play


def position(state):
    return float(state['x']), float(state['y'])


def distance(a, b):
    return max(abs(a[0] - b[0]), abs(a[1] - b[1]))


@pytest.mark.parametrize('options', [
    ['--nonsense', '1'], ['--scene'], ['--scene', 'jelly'], ['--method', 'nonsense'], ['--method', 'exact'],
    ['--script', '/nonexistent'],
])
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


@pytest.mark.parametrize('line', ['dance', 'wait', 'key nonsense', 'press nose', 'save /nonexistent/picture'])
def test_bad_script(screen, tmp_path, line):
    (tmp_path / 'script').write_text(f'wait 1\n{line}\n')
    result = springs('--script', tmp_path / 'script', env=screen)
    assert result.returncode == 1
    assert f'script:2: cannot {line}' in result.stderr


@pytest.mark.parametrize('scene', SCENES)
def test_something_moves(play, scene):
    (before, after), (first, second) = play('wait 1; say; save; wait 12; say; save', scene=scene)
    assert len(first.colors(BELOW_TEXT)) > 300
    assert first.changed(second, BELOW_TEXT) > 2000
    assert before['scene'] == scene and before['status'] == 'ok'
    assert float(after['time']) - float(before['time']) == pytest.approx(12 / 60, abs=1e-5)
    assert float(after['cost']) > 0


# Where to press, where to go, and how long the way takes at half the speed of waves. Water moves up and down alone.
@pytest.mark.parametrize('scene, press, go, frames', [
    ('cloth', (620, 400), (420, 480), 15), ('rope', (700, 226), (450, 300), 12), ('water', (500, 360), (500, 330), 30),
])
def test_what_is_grabbed_is_where_the_pointer_is(play, scene, press, go, frames):
    states, pictures = play(f'say; save; move {press[0]} {press[1]}; press left; move {go[0]} {go[1]}; wait {frames}; say; save',
                            'wait 5; say; release left; wait 15; say; save', scene=scene)
    assert [state['grabbed'] for state in states] == ['0', '1', '1', '0']
    x, y = position(states[1])
    assert abs(y - go[1]) < 0.1 and abs(x - go[0]) < (12 if scene == 'water' else 0.1)
    assert states[2]['particle'] == states[1]['particle'] and distance(position(states[2]), (x, y)) < 0.1
    # The ring, and in water a line to the pointer.
    assert distance(pictures[1].ring(BELOW_TEXT), (x, y)) < (12 if scene == 'water' else 1.5)
    assert pictures[0].ring(BELOW_TEXT) is None and pictures[2].ring(BELOW_TEXT) is None


def test_a_pin_can_be_moved_and_stays(play):
    """The upper right corner hangs on a hook."""
    states, _ = play('wait 1; move 872 102; press left; move 800 150; wait 12; say; release left',
                     'wait 30; press left; wait 1; say')
    assert [state['particle'] for state in states] == ['36', '36']
    for state in states:
        assert distance(position(state), (800, 150)) < 0.1


def test_the_rope_is_cut(play):
    """In 0.8 s what is cut off falls 3 m: out of the window. The pointer crosses the rope at its middle."""
    whole, _ = play('wait 50; say', scene='rope')
    cut, pictures = play('wait 2; save; move 540 330; press right; wait 1; move 780 250',
                         'release right; wait 47; say; save', scene='rope')
    assert position(whole[0])[1] < 700 and position(cut[0])[1] > 1000
    assert pictures[0].changed(pictures[1], BELOW_TEXT) > 2000


def test_what_is_cut_stays_cut(play):
    """Whatever the damping was when the rope was cut, and is after: at 0.2 it would hold the ball at 1.1 m/s."""
    (falls,), _ = play(*['key Right'] * 5, 'wait 2; move 540 330; press right; wait 1; move 780 250; release right',
                       'wait 2; key Left; wait 45; say', scene='rope')
    assert falls['damping'] == '0.100' and falls['status'] == 'ok'
    assert position(falls)[1] > 1000


@pytest.mark.parametrize('how', ['key Space', 'press middle', 'press right; move 601 400'])
def test_a_poke_brings_energy(play, how):
    """Where the water is still calm: half of the mass below the poke, at up to 8 m/s, is some 25 J."""
    (before, after), _ = play('wait 10; say; move 600 400', how, 'wait 1; say', scene='water')
    assert float(after['energy']) - float(before['energy']) > 10


def methods_of_scenes():
    said = subprocess.run(['spring-scene', '--method', 'nonsense'], capture_output=True, text=True, check=False)
    return said.stderr.rstrip('\n').partition('is not one of ')[2].split(', ')


def test_every_method_by_key(play):
    """In their order, and round; with N the other way."""
    methods = methods_of_scenes()
    states, _ = play(*['key M; wait 1; say'] * len(methods), 'key N; wait 1; say', scene='water', method=methods[0])
    assert [state['method'] for state in states] == methods[1:] + [methods[0], methods[-1]]
    assert len(methods) >= 5


def method_after_leapfrog():
    methods = methods_of_scenes()
    return methods[(methods.index('leapfrog') + 1) % len(methods)]


@pytest.mark.parametrize('key, name, value', [
    ('M', 'method', method_after_leapfrog), ('Up', 'steps', '21'), ('Right', 'damping', '0.010'),
    ('Left', 'damping', '0.002'),
])
def test_settings_change_the_motion(play, key, name, value):
    (before, without), _ = play('wait 10; say; wait 10; say', scene='rope')
    (same, after), _ = play('wait 10; say', f'key {key}; wait 10; say', scene='rope')
    assert after[name] == (value() if callable(value) else value) != before[name]
    assert {**before, 'cost': ''} == {**same, 'cost': ''}
    assert after['energy'] != without['energy']


def test_wind(play):
    (still,), _ = play('key W; key R; wait 32; say')
    (windy,), _ = play('key R; wait 32; say')
    assert distance(position(still), position(windy)) > 3


def test_an_explosion_is_noticed(play):
    """Euler explodes; all stands still, and the window says so. Another method and R: it goes on."""
    states, pictures = play('wait 15; say; save; wait 5; say; move 600 400; press left; key Space',
                            'wait 2; say; key M; wait 1; say; key R; wait 3; say; wait 10; say; save', method='euler')
    assert [state['status'] for state in states] == [NOT_FINITE] * 4 + ['ok'] * 2
    assert len({state['time'] for state in states[:4]}) == 1 and states[2]['grabbed'] == '0'
    assert states[3]['method'] == states[4]['method'] != 'euler'
    assert 0.25 > float(states[5]['time']) > float(states[4]['time'])
    assert RED in pictures[0].colors(TROUBLE) and RED not in pictures[1].colors(TROUBLE)
    assert AMBER in pictures[0].colors(SETTINGS) and AMBER not in pictures[1].colors(SETTINGS)


def test_a_method_that_is_not_for_damped_links(play):
    states, pictures = play('wait 2; say; save; key Left; key Left; wait 2; say; save; key Right; wait 2; say',
                            scene='water', method='rkn8')
    assert [state['status'] for state in states] == [NOT_SUPPORTED, 'ok', NOT_SUPPORTED]
    assert [float(state['time']) > 0 for state in states] == [False, True, True]
    assert RED in pictures[0].colors(TROUBLE) and RED not in pictures[1].colors(TROUBLE)


def test_scenes_by_key(play):
    states, _ = play('key 3; wait 1; say; key 2; wait 1; say; key 1; wait 1; say; key 4; wait 1; say; '
                     'key 5; wait 1; say', scene='rope')
    assert [state['scene'] for state in states] == ['water', 'rope', 'cloth', 'drape', 'cape']


@pytest.mark.parametrize('method, works', [('leapfrog', True), ('rk4', True), ('symplectic-euler', True), ('euler', False),
                                           ('rkn8', False)])
def test_methods_with_contacts(play, method, works):
    """A method without contacts stands still, says so, and the next one goes on."""
    (state, again), _ = play('wait 5; say; key M; key M; key M; wait 5; say' if method == 'rkn8' else 'wait 5; say; wait 5; say',
                             scene='drape', method=method)
    assert (state['status'] == 'ok') == works and (float(state['time']) > 0) == works
    assert (again['status'] == 'ok') == (works or method == 'rkn8')


def test_by_hand(screen):
    """A real key, in frames as they come."""
    with subprocess.Popen([SPRINGS, '--scene', 'rope'], env=screen, stdin=subprocess.DEVNULL) as program:
        try:
            find = ['xdotool', 'search', '--sync', '--onlyvisible', '--name', '^springstep$']
            # Down alone: the window, which the key closes, would not be there for the rest.
            subprocess.run([*find, 'keydown', 'Escape'], env=screen, check=True, timeout=60)
            assert program.wait(30) == 0
        finally:
            program.kill()


def test_the_command_in_the_first_comment():
    """It names all files and what they include; the library need not be installed, since nothing is linked, of which clang
    warns."""
    root = pathlib.Path(__file__).parents[2]
    text = (root / 'examples/sdl/main.c').read_text(encoding='utf-8')
    command, = re.findall(r'^ \* +cc (-std=.*)$', text, re.MULTILINE)
    command = f'{os.environ.get("CC", "cc")} -Wall -Wextra -Wpedantic -Wconversion -Werror -fsyntax-only '\
              f'-Wno-unused-command-line-argument {command}'
    subprocess.run(['bash', '-c', command], cwd=f'{root}/examples/sdl', env={**os.environ, 'CPATH': f'{root}/include'},
                   check=True, timeout=120)
