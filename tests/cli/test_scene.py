# SPDX-License-Identifier: MIT
"""spring-scene: motion of the preset scenes, disturbances, frames, explosions."""
import math
import os
import re
import struct

import pytest
from tools import SCENE, SCENE_STEPPERS, column, is_failure, parse, run, table

SHEET = 2 * 25 * 24 + 2 * 24**2 + 2 * 25 * 23  # structural, shear and bend links
BLOCK = 3 * 7 * 8**2 + (2 * 3 * 7**2 * 8 + 4 * 7**3) + 3 * 6 * 8**2
SCENES = {'rope': (20, 19), 'cloth': (625, SHEET), 'jelly': (512, BLOCK), 'chain': (52, 51), 'water': (625, SHEET)}
FREE_WATER = ['--scene', 'water', '--size', '9', '--stiffness', '0', '--drag', '0', '--mass', '1.3', '--method', 'rk4',
              '--dt', '0x1p-12', '--fps', '16', '--duration', '0.5']


@pytest.fixture
def frames_of(tmp_path):
    """Rows of the last frame, and of the one before."""
    def frames_of(*args):
        path = tmp_path / 'positions.tsv'
        result = run(SCENE, *args, '--positions', path)
        assert result.returncode == 0, result.stderr
        rows = parse(path.read_text())
        times = sorted({float(row['t_s']) for row in rows})
        return [[row for row in rows if float(row['t_s']) == t] for t in times[-1:-3:-1]]
    return frames_of


def scene(name, *args, method='leapfrog'):
    return table(SCENE, '--scene', name, '--method', method, *args)


# --- scenes ---------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('method', SCENE_STEPPERS)
@pytest.mark.parametrize('name', SCENES)
def test_each_scene_with_each_method(name, method):
    result = run(SCENE, '--scene', name, '--method', method, '--duration', '0.1')
    rows = parse(result.stdout)
    assert result.returncode == 0
    particles, links = SCENES[name]
    assert f'{particles} particles, {links} links' in result.stdout
    for row in rows:
        energy, *parts = (float(row[name]) for name in ('energy_J', 'kinetic_J', 'elastic_J', 'gravity_J'))
        assert abs(energy - math.fsum(parts)) <= 1e-13 * (1 + abs(energy))
    assert [round(60 * t, 9) for t in column(rows, 't_s')] == list(range(7))  # 60 rows a second, evenly
    dt, stable_step = map(float, re.search(r', dt = (\S+) s, stable step (\S+) s', result.stdout).groups())
    assert (result.stderr == '') == (dt < stable_step)
    moved = column(rows, 'max_displacement_m')
    assert moved[0] == 0 < moved[-1] < (1 if dt < stable_step else math.inf)


def defaults_in_the_manual():
    """(option, scene, value) where the default is "by scene", and listed."""
    listed = re.findall(r"\\-\\-([a-z]+) .*\n.*by scene\)\n\.br\nDefaults: (.*)\.\n", run(SCENE, "--man").stdout)
    assert listed
    return [(option, *pair.split()) for option, pairs in listed for pair in pairs.split(", ")]


def test_defaults_by_scene():
    found = defaults_in_the_manual()
    assert len(found) == 5 * 5
    for option, name, value in found:
        hashes = {run(SCENE, "--scene", name, "--method", "leapfrog", "--steps", "3", "--dt", "0.001", "--hash", *args).stdout
                  for args in ((), (f"--{option}", value))}
        assert len(hashes) == 1 and re.fullmatch("[0-9a-f]{16}\n", hashes.pop()), (option, name, value)


def test_cloth_hangs_on_two_corners(frames_of):
    how = ['--scene', 'cloth', '--method', 'leapfrog', '--duration', '0.2', '--fps', '10']
    last = frames_of(*how)[0]
    assert [(row['i'], row['j']) for row in last if float(row['z_m']) == 0] == [('0', '0'), ('24', '0')]
    up = frames_of(*how, '--gravity', '-9.81')[0]
    assert [-z for z in column(up, 'z_m')] == column(last, 'z_m')


def test_chain_is_drawn_aside_by_half_a_spacing(frames_of):
    start = frames_of('--scene', 'chain', '--method', 'leapfrog', '--duration', '0.5', '--fps', '2')[1]
    aside = [x - 5 * i / 51 for i, x in enumerate(column(start, 'x_m'))]
    assert math.dist(aside, [5 / 51 * min(i, 51 - i) / 51 for i in range(52)]) <= 1e-14


# --- the step that is taken where none is given ---------------------------------------------------------------------

def test_whole_steps_a_frame_below_half_the_stable_step():
    how = ['--scene', 'chain', '--method', 'leapfrog', '--fps', '30', '--duration', '1']
    result = run(SCENE, *how)
    assert f'dt = {1 / 90:.16g}'[:18] in result.stdout
    assert table(SCENE, *how, '--dt', float.hex(1 / 90)) == parse(result.stdout)


def test_step_below_an_eighth_of_a_push():
    result = run(SCENE, *'--scene chain --method leapfrog --fps 100 --duration 1 --poke 0,2,0,1,1'.split())
    assert 'dt = 0.0025' in result.stdout and result.stderr == ''


def test_without_springs_a_step_is_a_frame_and_things_fall():
    result = run(SCENE, '--scene', 'rope', '--stiffness', '0', '--method', 'leapfrog', '--duration', '1', '--fps', '64')
    fallen = 9.81 / 0.2 * (1 - (1 - math.exp(-0.2)) / 0.2)  # drag/mass = 0.2/s
    assert result.returncode == 0 and 'dt = 0.015625 s' in result.stdout
    assert abs(column(parse(result.stdout), 'max_displacement_m')[-1] / fallen - 1) <= 1e-4


# --- pushes ---------------------------------------------------------------------------------------------------------

@pytest.fixture
def momentum(frames_of):
    """Of free particles [kg m/s], upwards: they have left their places, and nothing pulls them back."""
    def momentum(*args, mass=1.3):
        last, before = frames_of(*FREE_WATER, *args)
        dt = float(last[0]['t_s']) - float(before[0]['t_s'])
        return sum(mass * (b - a) / dt for a, b in zip(column(before, 'z_m'), column(last, 'z_m'), strict=True))
    return momentum


MEAN = 128 / 315  # of the profile (4 u (1 - u))^4
OF_POKE, OF_BOX = MEAN * 70 * 0.125, 2.5 * math.sqrt(2 * 9.81)


def of_sum(push):
    """How far the sum of the profile over steps may be from the integral, relative: by the jump of the fourth derivative
    at either end, 24 4^4, times h^5 B5/5!, |B5| <= 0.0245; twice that, since RK4 adds up by Simpson's rule; and rounding."""
    return 2 * 2 * 24 * 256 * 0.0245 / 120 * (2**-12 / push)**5 / MEAN + 1e-9


@pytest.mark.parametrize('args, want', [
    pytest.param('--poke 0.03125,1.3,2.6,70,0.9 --push-duration 0.125', -OF_POKE, id='a poke'),
    pytest.param('--poke 0,1.3,2.6,-70,1e-9 --push-duration 0.125', OF_POKE,
                 id='a poke between particles moves the nearest, and upwards where it pulls'),
    pytest.param('--drop-box 0.125,2.5', -OF_BOX, id='a box'),
    pytest.param('--drop-box 0.125,2.5 --poke 0,1,1,70,1 --push-duration 0.125', -OF_BOX - OF_POKE, id='both'),
    pytest.param('', -MEAN * 1e5 * 0.02, id='the poke that water gets anyway'),
])
def test_momentum_of_pushes(args, want, momentum):
    """By the profile that --help states."""
    assert abs(momentum(*args.split()) - want) <= of_sum(0.125 if '0.125' in args.split() else 0.02) * abs(want)


def test_momentum_of_rain(momentum):
    """In drops, of 10 m/s."""
    how = ['--duration', '2', '--fps', '32', '--push-duration', '0x1p-8', '--rain']
    bound = of_sum(2**-8)
    for rate in (200, 4):
        drops = momentum(*how, str(rate)) / -(1.3 * 10)
        late = 1 + rate * (1 / 32 + 2**-8)  # in the last frame, over which the speed is a mean
        assert 2 * rate - late <= drops + 2 * rate * bound and drops <= 2 * rate * (1 + bound)


INNER = [(i, j) for i in range(1, 32) for j in range(1, 32)]


@pytest.fixture
def shares(frames_of):
    """Free particles keep the speed that a push gave them, so their heights are in proportion to their shares."""
    def shares(*args):
        last = frames_of(*FREE_WATER, '--size', '33', *args)[0]
        heights = {(int(row['i']), int(row['j'])): -float(row['z_m']) for row in last}
        total = sum(heights.values())
        return {place: height / total for place, height in heights.items() if height != 0}
    return shares


@pytest.mark.parametrize('args, profile', [
    pytest.param('--poke 0,1.3,2.6,70,0.9',
                 lambda i, j: max(0, 1 - math.hypot(i / 8 - 1.3, j / 8 - 2.6)**2 * math.pi / 0.9)**2, id='a poke'),
    pytest.param('--drop-box 0,3', lambda i, j: max(abs(i - 16), abs(j - 16)) <= 2, id='a box'),  # within 0.25 m
])
def test_shapes_of_pushes(args, profile, shares):
    got, want = shares(*args.split()), {place: profile(*place) for place in INNER}
    total = sum(want.values())
    assert got.keys() <= want.keys() and max(abs(got.get(place, 0) - want[place] / total) for place in INNER) <= 1e-9


def test_rain_falls_everywhere(shares):
    wet = shares('--rain', '40', '--seed', '3')
    assert len({(i < 16, j < 16) for i, j in wet if 16 not in (i, j)}) == 4


@pytest.mark.parametrize('poke, place', [
    pytest.param('0,2,2,70,0.3', ('4', '4'), id='a small poke moves what is below it'),
    pytest.param('0,0,0,70,1e-9', ('1', '1'), id='pinned particles take no part'),
])
def test_places_of_pushes(poke, place, frames_of):
    last = frames_of(*FREE_WATER, '--poke', poke)[0]
    assert [(row['i'], row['j']) for row in last if float(row['z_m']) != 0] == [place]


# --- whole steps a frame, and the hash of the end -------------------------------------------------------------------

def test_steps_per_frame():
    """The step is 1/(R N), whatever N divides."""
    for rate, steps in ((60, 21), (37.5, 40)):
        result = run(SCENE, *f'--scene rope --method rk4 --frame-rate {rate} --steps-per-frame {steps}'.split())
        assert f'dt = {1 / (rate * steps):.17g} s' in result.stdout


def fnv(rows):
    """Of a rope on which nothing acts: its velocities are zeros."""
    value = 0xcbf29ce484222325
    positions = [float(row[name]) for row in rows for name in ('x_m', 'z_m')]
    for byte in struct.pack(f'<{2 * len(positions)}d', *positions, *[0] * len(positions)):
        value = (value ^ byte) * 0x100000001b3 % 2**64
    return f'{value:016x}'


ALIKE = [  # a run, and runs that end in the same state: options of the output, defaults, and what has no effect
    ('rope --duration 0.5', ['--end-mass 0.05', '--positions FILE']),
    ('water --duration 0.25 --steps-per-frame 21', ['--fps 7', '--rain 0']),
    ('water --duration 1 --rain 20', ['--seed 1']),
    ('cloth --duration 0.2', ['--tear 1e6', '--collider plane:z=-9']),
]
OTHER = [  # a run, and runs that do not
    ('rope --duration 0.5', ['--end-mass 0.15', '--gravity 3', '--size 8', '--length 2.5', '--drag 0.1', '--damping 1', '--stretch 1.1']),
    ('water --duration 0.25 --steps-per-frame 21', ['--method rk4', '--poke 0,2,2,1,1', '--axes 3', '--links structural', '--drop-box 0,1']),
    ('water --duration 1 --rain 20', ['--seed 2', '--rain 0']),
    ('cloth --duration 0.5', ['--bend 1e-3', '--tethers 0.05', '--tension-only', '--tear 1.01', '--collider plane:z=-.1', '--stiffness 9', '--mass 3']),
]


@pytest.mark.parametrize('scene, options', [(scene, options) for scene, more in ALIKE + OTHER for options in more])
def test_which_options_change_the_motion(scene, options, tmp_path):
    def ends(options):
        words = f'--scene {scene} {"" if "--method" in options else "--method leapfrog"} --hash {options}'
        result = run(SCENE, *words.replace('FILE', str(tmp_path / 'file')).split())
        assert result.returncode == 0 and re.fullmatch('[0-9a-f]{16}\n', result.stdout), result.stderr
        return result.stdout
    assert (ends('') == ends(options)) == (options in dict(ALIKE).get(scene, []))


def test_hash(tmp_path):
    path = tmp_path / 'positions.tsv'
    still = '--scene rope --gravity 0 --stiffness 0 --method leapfrog --duration 0.5 --hash'.split()
    result = run(SCENE, *still, '--positions', path)
    last = parse(path.read_text())[-20:]
    assert (result.stdout, result.stderr, result.returncode) == (fnv(last) + '\n', '', 0)


def test_hash_in_a_file(tmp_path):
    path = tmp_path / 'hash'
    short = '--scene rope --method leapfrog --duration 0.1 --hash'.split()
    written = run(SCENE, *short, '-o', path)
    assert (written.returncode, written.stdout, path.read_text()) == (0, '', run(SCENE, *short).stdout)


def test_hash_of_an_explosion_is_that_of_the_last_state_before():
    euler = [SCENE, *'--scene water --method euler --frame-rate 100 --steps-per-frame 1 --hash --duration'.split()]
    end = run(*euler, '5')
    steps = round(float(end.stderr.rpartition(' t = ')[2].split()[0]) * 100) - 1
    assert end.returncode == 1 and end.stdout == run(*euler, str(steps / 100)).stdout


# --- saved states ---------------------------------------------------------------------------------------------------

LONG = ['--scene cloth --method leapfrog --damping 0.3',
        '--scene cloth --method leapfrog --dt 1e-3 --fps 50 --tear 1.1 --collider sphere:x=1,y=1,z=-.6,radius=.4,vz=0.1',
        '--scene jelly --method symplectic-euler --dt 1e-3 --fps 50 --collider plane:z=-.2 --tension-only',
        '--scene water --method rk4 --rain 10 --dt 5e-4 --fps 50',
        '--scene rope --method leapfrog --rain 1 --seed 1 --dt 1e-3 --fps 50',  # the first drop is in the second half
        '--scene rope --method srkn6 --dt 0x1p-10 --fps 64 --poke .2,0,0,2,.1 --push-duration .2']


@pytest.mark.parametrize('words', LONG)
def test_a_run_can_be_continued(words, tmp_path):
    """The rows and the end are those of one run."""
    state, whole = tmp_path / 'state', run(SCENE, *words.split(), '--duration', '1')
    first = run(SCENE, *words.split(), '--duration', '0.5', '--save', state)
    second = run(SCENE, *words.split(), '--duration', '0.5', '--load', state, '--save', tmp_path / 'end')
    assert whole.returncode == first.returncode == second.returncode == 0, second.stderr
    before, after = parse(first.stdout), parse(second.stdout)
    assert before + after[1:] == parse(whole.stdout)  # where links tear, after[0] has less energy than before[-1]
    assert before[-1]['t_s'] == after[0]['t_s'] and f'# start: t = {after[0]["t_s"]} s\n' in second.stdout
    run(SCENE, *words.split(), '--duration', '1', '--save', tmp_path / 'other')
    assert (tmp_path / 'other').read_bytes() == (tmp_path / 'end').read_bytes() != state.read_bytes()


def test_rain_falls_until_the_end_of_the_last_step():
    """51 steps end after H: the raindrops of this time fall, too."""
    rain = '--scene rope --method rk4 --dt 0.002 --rain 1000 --hash'.split()
    by_time, by_steps = run(SCENE, *rain, '--duration', '0.1011'), run(SCENE, *rain, '--steps', '51')
    assert by_time.returncode == by_steps.returncode == 0 and by_time.stdout == by_steps.stdout


def test_states_of_other_scenes_are_refused(tmp_path):
    state = tmp_path / 'state'
    short = '--method leapfrog --duration 0.05'
    run(SCENE, *f'--scene cloth {short} --save {state}'.split())
    for words in ('--scene jelly', '--scene cloth --size 12', '--scene cloth --links structural', '--scene cloth --poke 0,1,1,1,1',
                  '--scene cloth --tear 3', '--scene cloth --method rk4'):
        is_failure(run(SCENE, *f'{short} {words} --load {state}'.split()), 2, '--load')
    for bytes_ in (b'', state.read_bytes()[:-1], state.read_bytes()[:300] + b'?' + state.read_bytes()[301:]):
        (tmp_path / 'wrong').write_bytes(bytes_)
        is_failure(run(SCENE, *f'--scene cloth {short} --load {tmp_path}/wrong'.split()), 2, '--load')
    is_failure(run(SCENE, *f'--scene cloth {short} --load {tmp_path}/none'.split()), 3, '--load')
    is_failure(run(SCENE, *f'--scene cloth {short} --load /dev/zero'.split()), 2, '--load', 'not a saved state')
    is_failure(run(SCENE, *f'--scene cloth {short} --load {state} --gravity 5'.split()), 2, '--gravity', '"-5"', '-9.81')


# --- frames ---------------------------------------------------------------------------------------------------------

NAMES = [f'frame-{i:06}.tsv' for i in range(11)]


@pytest.fixture
def jelly(tmp_path):
    """The arguments of a run, and the folder of the frames that it has written."""
    folder = tmp_path / 'frames'
    args = [*'--scene jelly --size 3 --method rk4 --duration 0.25 --fps 40 --frames'.split(), folder]
    table(SCENE, *args)
    return args, folder


def texts(folder):
    return [path.read_text() for path in sorted(folder.iterdir())]


def test_frames(jelly):
    folder = jelly[1]
    assert sorted(os.listdir(folder)) == NAMES
    assert all(str(folder) not in text for text in texts(folder))
    frames = [parse(text) for text in texts(folder)]
    assert list(frames[0][0]) == 't_s particle i j k x_m y_m z_m'.split()
    for n, frame in enumerate(frames):
        assert len(frame) == 27
        assert abs(float(frame[0]['t_s']) - n / 40) <= 1e-12
        assert all(int(row['particle']) == int(row['i']) + 3 * (int(row['j']) + 3 * int(row['k'])) for row in frame)
    pinned = {(row['x_m'], row['z_m']) for row in frames[-1] if (row['i'], row['k']) == ('1', '0')}
    assert pinned == {('0.34999999999999998', '0')}


def test_same_positions_in_one_file(jelly, tmp_path):
    args, folder = jelly
    positions = tmp_path / 'positions.tsv'
    table(SCENE, *args, '--positions', positions)
    assert parse(positions.read_text()) == [row for text in texts(folder) for row in parse(text)]


def test_same_frames_again(jelly):
    args, folder = jelly
    before = texts(folder)
    first, second = run(SCENE, *args), run(SCENE, *args)
    assert first.stdout == second.stdout and str(folder) not in first.stdout
    assert texts(folder) == before


@pytest.mark.parametrize('gone', [[], NAMES[5:6]], ids=['all', 'all but one'])
def test_frames_of_a_longer_run_stay(gone, jelly):
    args, folder = jelly
    for name in gone:
        (folder / name).unlink()
    before = texts(folder)
    is_failure(run(SCENE, *args, '--duration', '0.1'), 3, '/frame-0000', 'longer run')
    assert texts(folder) == before


def test_other_files_beside_frames_stay(tmp_path):
    args = ('--scene', 'rope', '--method', 'leapfrog', '--duration', '0.1', '--frames', tmp_path)
    for name in ('frame-000300.png', 'frame-9.tsv', 'frame-000300.tsv.gz'):
        (tmp_path / name).write_text('other')
    assert run(SCENE, *args).returncode == 0 and (tmp_path / 'frame-9.tsv').read_text() == 'other'


@pytest.mark.parametrize('option', ['--output', '--positions'])
def test_frames_stay_where_another_file_cannot_be_written(option, jelly, tmp_path):
    args, folder = jelly
    before = texts(folder)
    is_failure(run(SCENE, *args, option, tmp_path / 'no' / 'such'), 3, option)
    assert texts(folder) == before


def test_with_steps_longer_than_frames_some_show_the_same(jelly):
    args, folder = jelly
    result = run(SCENE, *args, '--dt', '0.04', '--method', 'leapfrog')
    assert result.returncode == 0
    assert [float(parse(text)[0]['t_s']) for text in texts(folder)[:4]] == [0, 0.04, 0.04, 0.08]
    times = column(parse(result.stdout), 't_s')
    assert times == sorted(set(times))  # no row twice


@pytest.mark.parametrize('path', ['no/such', 'old.tsv', 'x' * 300, 'x/' * 3000], ids=lambda path: path[:10])
def test_frames_that_cannot_be_written(path, older):
    rope = ['--scene', 'rope', '--method', 'leapfrog', '--duration', '0.1']
    is_failure(run(SCENE, *rope, '--frames', os.path.join(older.parent, path)), 3, '--frames: ')
    assert older.read_text() == 'older\n' and os.listdir(older.parent) == ['old.tsv']


# --- explosions -----------------------------------------------------------------------------------------------------

WATER = ['--scene', 'water', '--method', 'euler', '--dt', '0.01']
RK4_WATER = ['--scene', 'water', '--method', 'rk4', '--duration', '1', '--push-duration', '0.1', '--dt']


def test_explosion(tmp_path):
    rows, frames = tmp_path / 'rows.tsv', tmp_path / 'frames'
    result = run(SCENE, *WATER, '--duration', '5', '-o', rows, '--frames', frames)
    step, push, end = result.stderr.splitlines()
    assert result.returncode == 1
    assert 'not below the stable step of euler' in step and ' 0.01 s' in step
    assert 'quarter of --push-duration' in push and 'explodes' in end
    time, last = float(end.partition(' t = ')[2].split()[0]), parse(rows.read_text())[-1]
    assert 0 <= time - float(last['t_s']) <= 1 / 60 + 0.01
    assert all(math.isfinite(float(x)) for row in parse(rows.read_text()) for x in row.values())
    assert float(last['energy_J']) > 1e290
    # every step multiplies an undamped mode by at most sqrt(1 + (omega dt)^2), omega^2 <= 24 k/m
    assert time / 0.01 * math.log10(1 + 24 * 25000 * 0.01**2) >= 300
    assert 100 < len(os.listdir(frames)) < 200
    steps = round(time / 0.01)
    assert [run(SCENE, *WATER, '--duration', f'{0.01 * n}').returncode for n in (steps - 1, steps)] == [0, 1]


@pytest.mark.parametrize('length', ['1e200', '1.35386709505176e+155'])
def test_explosion_at_the_start(length):
    heavy = '--scene chain --method leapfrog --stiffness 1 --drag 100 --stretch 1e9 --dt 0.01 --duration 0.02'
    result = run(SCENE, *heavy.split(), '--length', length)
    assert (result.returncode, parse(result.stdout), 't = 0 s' in result.stderr) == (1, [], True)


def test_stable_step_is_told_above_it():
    below, above = run(SCENE, *RK4_WATER, '0.00336'), run(SCENE, *RK4_WATER, '0.00337')
    assert below.returncode == 0 and 'stable' not in below.stderr
    assert above.returncode == 0 and '0.00336' in above.stderr


def test_without_drag_no_step_of_euler_is_stable():
    result = run(SCENE, '--scene', 'chain', '--method', 'euler', '--duration', '1')
    assert result.returncode == 0 and 'no step of euler is stable' in result.stderr


# --- links that pull only, and that tear ------------------------------------------------------------------------------

def test_links_that_tear_take_their_energy_away():
    args = ['--duration', '1', '--drag', '0', '--fps', '8']
    kept = run(SCENE, '--scene', 'cloth', '--method', 'leapfrog', '--tear', '50', *args)
    torn = run(SCENE, '--scene', 'cloth', '--method', 'leapfrog', '--tear', '1.3', *args)
    assert f'spring-scene: 0 of {SHEET} links have torn' in kept.stderr
    count = int(torn.stderr.split()[1])
    assert 0 < count < SHEET and torn.returncode == 0
    energies = [column(parse(result.stdout), 'energy_J')[-1] for result in (kept, torn)]
    assert energies[1] < energies[0] - 1e-3


@pytest.mark.parametrize('args', ['--scene chain --tension-only', '--scene water --tear 2', '--scene cloth --tear 0',
                                  '--scene cloth --tension-only --method rkn8', '--scene water --tethers 0.1',
                                  '--scene cloth --tethers 0.1 --method srkn6', '--scene rope --tethers 0'])
def test_refused_for_tension_and_tear(args):
    is_failure(run(SCENE, '--method', 'leapfrog', *args.split()), 2, '--te')


# --- bending and tethers ----------------------------------------------------------------------------------------------

def test_a_rod_bends_as_a_beam(tmp_path):
    """The rope is pinned at one particle, a hinge, so it falls as far; a stiffer rod stays straighter."""
    def bow(bend):
        path = tmp_path / 'rope.tsv'
        run(SCENE, '--scene', 'rope', '--method', 'leapfrog', '--duration', '0.3', '--positions', path, *bend)
        last = parse(path.read_text())[-20:]
        at = [(float(row['x_m']), float(row['z_m'])) for row in last]
        ends, middle = [[at[i][k] - at[0][k] for k in range(2)] for i in (19, 10)]
        return abs(ends[0] * middle[1] - ends[1] * middle[0]) / math.hypot(*ends)
    assert bow(['--bend', '10']) < 0.2 * bow([])


@pytest.mark.parametrize('scene', ['jelly', 'chain'])
def test_refused_for_bending(scene):
    is_failure(run(SCENE, '--scene', scene, '--method', 'leapfrog', '--bend', '1'), 2, '--bend: "1"', scene)


# --- colliders --------------------------------------------------------------------------------------------------------

FALLING_ROPE = ['--drag', '0', '--stiffness', '0', '--size', '2', '--length', '1', '--method', 'leapfrog', '--fps', '16']


@pytest.mark.parametrize('restitution', [0, 0.9])
def test_free_end_of_a_rope_bounces(restitution):
    """A rope of two particles without stiffness: one falls from a height of 0 to -0.25 m, and bounces."""
    rows = scene('rope', *FALLING_ROPE[:-4], '--fps', '64', '--dt', '0x1p-10', '--duration', '0.5', '--collider',
                 f'plane:z=-0.25,restitution={restitution}')
    end = float(rows[-1]['gravity_J']) / (0.05 * 9.81)  # [m], of two particles, one of which is pinned
    fall = math.sqrt(0.5 / 9.81)
    rest = 0.5 - fall
    want = -0.25 + restitution * 9.81 * fall * rest - 9.81 / 2 * rest**2 if restitution else -0.25
    assert abs(end - want) <= 1e-5
    assert int(rows[-1]['touching']) == (0 if restitution else 1)


def test_fields_of_colliders(frames_of):
    """The box, the capsule and the plane of a wall stop a rope in a row of ways; a collider that is far away changes no bit."""
    def end(*colliders):
        row = frames_of('--scene', 'rope', *FALLING_ROPE, '--duration', '0.5', '--dt', '0x1p-10', *colliders)[0][-1]
        return float(row['x_m']), float(row['z_m'])

    def height(*colliders):
        return end(*colliders)[1]

    free = height()
    assert free == height('--collider', 'sphere:z=90,radius=1')
    assert abs(height('--collider', 'box:x=1,z=-.5,hx=.2,hz=.1,radius=.05') + 0.35) < 1e-12
    assert abs(height('--collider', 'capsule:x=0.5,z=-.5,x2=1.5,z2=-.5,radius=.1') + 0.4) < 1e-12
    assert abs(height('--collider', 'plane:z=-.5,nz=2', '--particle-radius', '.125') + 0.375) < 1e-12
    assert abs(height('--collider', 'plane:z=-1,vz=1') + 0.5) < 1e-12  # rises for half a second
    assert abs(height('--collider', 'plane:z=-1,az=4') + 0.5) < 1e-12
    for turned in ('wy=-.5', 'way=-2'):  # by 0.25 rad, so that x rises
        x, z = end('--collider', f'plane:z=-1,{turned}')
        assert abs(z + 1 - x * math.tan(0.25)) < 1e-12
    belt = end('--collider', 'plane:z=-.5,sx=1,friction=9')[0]
    assert abs(belt - 1 - (0.5 - math.sqrt(1 / 9.81))) < 1e-5  # from the impact on; it falls on a parabola of steps
    assert height('--collider', 'plane:z=-.5,mask=2') == height('--collider', 'plane:z=-.5,mask=4294967294') == -0.5
    assert free == height('--collider', 'plane:z=-.5,mask=1') == height('--collider', 'plane:nx=1,x=-9')


@pytest.mark.parametrize('words, wanted', [
    ('cube:x=1', ['cube', 'sphere:']),
    ('sphere:nx=1', ['"nx"', 'not a field of a sphere', 'radius']),
    ('sphere:radius=-1', ['radius=-1', '>= 0']),
    ('plane:restitution=2', ['restitution=2', 'from 0 to 1']),
    ('plane:friction', ['"friction"', '>= 0']),
    ('plane:mask=1.5', ['mask=1.5', 'integer from 0 to 2^32 - 1']),
    ('plane:mask=4294967296', ['mask=4294967296']),
    ('plane:z=1x', ['z=1x', 'finite number']),
    ('plane:z=', ['"z="']),
    ('plane:z=nan', ['z=nan']),
    ('plane:nx=0', ['no normal']),
    ('plane:x=1e999', ['x=1e999']),
    (' '.join(33 * ['plane:']), ['collider 33', 'at most 32']),
    ('plane: --method rkn8', ['rkn8']),
    ('plane: --method euler', ['euler']),
    ('plane: --scene chain', ['chain']),
    ('plane: --scene water', ['water']),
])
def test_refused_for_colliders(words, wanted):
    is_failure(run(SCENE, '--scene', 'cloth', '--method', 'leapfrog', '--collider', *words.split()), 2, '--collider', *wanted)


def test_particle_radius_needs_a_collider():
    is_failure(run(SCENE, '--scene', 'cloth', '--method', 'leapfrog', '--particle-radius', '1'), 2, '--particle-radius')
