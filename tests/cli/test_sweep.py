# SPDX-License-Identifier: MIT
"""spring-sweep: identical output for any number of parts, processes and interruptions, and its contents."""
import contextlib
import itertools
import math
import os
import random
import resource
import signal
import subprocess
import time

import pytest
from test_methods import SPRINGS, TABLE
from test_scene import SCENES
from tools import PLAN, RUN, SCENE, SWEEP, column, in_little_memory, is_failure, parse, run, table

FORCES = {row['method']: int(row['forces_per_step']) for row in TABLE}


def springs(periods):
    return ['--over', 'omega_dt=0.02:3:log:60', '--over', 'damping_ratio=0:2:50', f'periods={periods}', '--method', 'all']


GRID = springs(0.5)  # as many rows in a tenth of the time of SLOW, for tests where nothing interrupts the work
SLOW = springs(5)


def part(number, parts, path, grid=GRID, **how):
    return run(SWEEP, *grid, '--part', f'{number}/{parts}', '-o', path, **how)


def join(*paths):
    return run(SWEEP, '--join', *paths)


def is_done(result):
    assert (result.returncode, result.stdout, result.stderr) == (0, '', ''), result.args


@pytest.fixture(scope='module')
def whole():
    """The rows of GRID, by one process."""
    result = run(SWEEP, *GRID)
    assert (result.returncode, result.stderr) == (0, '')
    return result.stdout


@pytest.fixture(scope='module')
def parts(tmp_path_factory):
    """GRID in three parts, as files."""
    folder = tmp_path_factory.mktemp('parts')
    for i in (3, 1, 2):
        is_done(part(i, 3, folder / str(i)))
    return [folder / str(i) for i in (1, 2, 3)]


def copies(parts, folder):
    for path in parts:
        (folder / path.name).write_bytes(path.read_bytes())
    return [folder / path.name for path in parts]


# --- the same bytes -------------------------------------------------------------------------------------------------

def same(data, expected):
    """pytest would look for the differences of half a megabyte, for many minutes."""
    return data == expected


def test_header(whole):
    quoted = [*GRID[:4], '--over', *GRID[4:]]
    assert whole.splitlines()[1:3] == ['# command: spring-sweep ' + ' '.join(quoted),
                                       'omega_dt\tdamping_ratio\tperiods\tmethod\terror\tenergy_error\tstatus']


@pytest.mark.parametrize('count', [1, 2, 7, 40])
def test_parts_in_any_order(count, whole, tmp_path):
    numbers = random.Random(count).sample(range(1, count + 1), count)
    for i in numbers:
        is_done(part(i, count, tmp_path / f'{i}'))
    paths = random.Random(-count).sample([tmp_path / f'{i}' for i in numbers], count)
    assert same(join(*paths).stdout, whole)


def test_more_parts_than_blocks_and_more_than_files_may_be_open(tmp_path):
    grid = ['--over', 'omega_dt=0.5:1.5:5']
    paths = [tmp_path / str(i) for i in range(1, 41)]
    for i, path in enumerate(paths, 1):
        is_done(part(i, 40, path, grid))
    result = run(SWEEP, '--join', *paths,
                 preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (16, 16)))
    assert (result.stdout, result.stderr) == (run(SWEEP, *grid).stdout, '')


@pytest.mark.parametrize('count', [1, 2, 3])
def test_jobs(count, whole, tmp_path):
    is_done(run(SWEEP, *GRID, '--jobs', str(count), '-o', tmp_path / 'map.tsv'))
    assert [path.name for path in tmp_path.iterdir()] == ['map.tsv'] and same((tmp_path / 'map.tsv').read_text(), whole)


SCENE_GRID = ['--scene', 'rope', '--over', 'stiffness=500:5000:log:6', 'steps_per_frame=1,4,16', 'duration=0.5',
              '--measure', 'steps,explode_time_s']


def test_parts_of_a_scene(tmp_path):
    """What a process remembers from one point for the next is seen nowhere."""
    for i in range(1, 6):
        is_done(part(i, 5, tmp_path / str(i), SCENE_GRID))
    assert join(*(tmp_path / str(i) for i in range(1, 6))).stdout == run(SWEEP, *SCENE_GRID).stdout


# --- interruptions --------------------------------------------------------------------------------------------------

def killed(folder, *args):
    """Kills the command ever later until it is done. What is there is complete at every moment."""
    delay, kills = 0.001, 0
    while True:
        with subprocess.Popen([SWEEP, *args], stdin=subprocess.DEVNULL, start_new_session=True) as process:
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(delay)
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
        if process.returncode == 0:
            return kills, [path.name for path in folder.iterdir() if path.suffix != '.part']
        delay, kills = 1.5 * delay, kills + 1


def test_a_killed_part_is_repeated(parts, tmp_path):
    kills, left = killed(tmp_path, *GRID, '--part', '1/3', '-o', tmp_path / '1')
    assert kills > 0 and left == ['1'] and same((tmp_path / '1').read_bytes(), parts[0].read_bytes())


def test_killed_jobs_go_on(tmp_path):
    """With another number of jobs, and finished parts are not computed again."""
    path = tmp_path / 'map.tsv'
    with subprocess.Popen([SWEEP, *SLOW, '--jobs', '2', '-o', path], start_new_session=True) as process:
        while process.poll() is None and len(list(tmp_path.glob('*-of-1024'))) < 100:
            time.sleep(0.001)
        os.killpg(process.pid, signal.SIGKILL)
    finished = next(tmp_path.glob('*-of-1024'))
    rows = finished.read_text().split('status\n')
    finished.write_text(rows[0] + 'status\n' + rows[1].replace('stable', 'STABLE'))
    is_done(run(SWEEP, *SLOW, '--jobs', '3', '-o', path))
    assert [left for left in tmp_path.iterdir() if left.suffix != '.part'] == [path]
    assert 'STABLE' in path.read_text() and same(path.read_text().replace('STABLE', 'stable'), run(SWEEP, *SLOW).stdout)


LONG = ['--over', 'omega_dt=0.1:3:log:3000', 'damping_ratio=0:2:3000']


def test_jobs_end_with_the_process_that_started_them(tmp_path):
    with subprocess.Popen([SWEEP, *LONG, '--jobs', '2', '-o', tmp_path / 'map.tsv']) as process:
        while process.poll() is None and len(list(tmp_path.iterdir())) < 2:
            time.sleep(0.01)
        process.kill()
    end = time.monotonic() + 60
    while any(path.suffix == '.part' for path in tmp_path.iterdir()):
        assert time.monotonic() < end, 'a block takes a tenth of a second'
        time.sleep(0.1)
    assert not (tmp_path / 'map.tsv').exists()


def changed(data, seed):
    """A file that was cut, or lost bytes or has too many of them, in a way that the ends of blocks show."""
    cut = [0, 1, 20, 25, 1000, 5000, len(data) - 1, len(data) - 60]
    if seed < len(cut):
        return data[:cut[seed]]
    at = data.index(b'# block ', len(data) // 2)
    row = data.rindex(b'\n', 0, at - 1) + 1  # the last one of a block
    return [data + b'more\n', data[:at] + data[at:].partition(b'\n')[2], data[:at] + data[at - 2000:],
            data[:-1000] + bytes(10**8), data[:row] + data[at:], data[:at] + data[row:]][seed - len(cut)]


@pytest.mark.parametrize('seed', range(14))
def test_incomplete(seed, parts, tmp_path):
    """Not joined, and computed again."""
    path, *others = copies(parts, tmp_path)
    path.write_bytes(changed(path.read_bytes(), seed))
    is_failure(in_little_memory(SWEEP, '--join', path, *others), 3 if seed < 4 else 1, '--join: ', str(path))
    is_done(part(1, 3, path))
    assert same(path.read_bytes(), parts[0].read_bytes()) and len(list(tmp_path.iterdir())) == 3


def test_full_disk(whole, tmp_path):
    """As with a limit on the size of files."""
    command = [*GRID, '--jobs', '2', '-o', tmp_path / 'map.tsv']
    most = 1700  # the first four parts are smaller
    result = run(SWEEP, *command, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most)))
    assert result.returncode == 3 and 'File too large' in result.stderr
    assert result.stderr.splitlines()[-1] == f'{SWEEP}: the sweep is incomplete; the same command continues it'
    left = list(tmp_path.iterdir())
    assert len(left) > 1 and all(path.name.endswith('-of-1024') for path in left)
    is_done(run(SWEEP, *command))
    assert same((tmp_path / 'map.tsv').read_text(), whole)


@pytest.mark.parametrize('make', [os.mkdir, os.mkfifo, lambda path: os.symlink('nowhere', path)])
def test_jobs_without_a_file_to_write(make, tmp_path):
    """Refused before the work: no part is begun."""
    make(tmp_path / 'map.tsv')
    is_failure(run(SWEEP, *LONG, '--jobs', '2', '-o', tmp_path / 'map.tsv'), 3, '--output', f'"{tmp_path}/map.tsv"')
    assert len(list(tmp_path.iterdir())) == 1


def test_jobs_beside_parts_of_another_sweep(tmp_path):
    """Refused before the work."""
    other = tmp_path / 'map.tsv.2-of-1024'
    other.write_text('other\n')
    result = run(SWEEP, *LONG, '--jobs', '2', '-o', tmp_path / 'map.tsv')
    is_failure(result, 3, str(other), 'is not this part of this sweep')
    assert list(tmp_path.iterdir()) == [other] and other.read_text() == 'other\n'


# --- what is not joined ---------------------------------------------------------------------------------------------

def test_missing_and_double_parts(parts):
    is_failure(join(*parts[1:]), 1, '--join: 1 of 3 parts are missing: 1')
    is_failure(join(parts[0]), 1, '2 of 3 parts are missing: 2, 3')
    is_failure(join(*parts, parts[1]), 1, f'"{parts[1]}" is part 2, and so is "{parts[1]}"')


def test_foreign_parts(parts, tmp_path):
    other = [*GRID[:-1], 'leapfrog']
    is_done(part(2, 3, tmp_path / 'other', other))
    is_failure(join(parts[0], tmp_path / 'other', parts[2]), 1, str(tmp_path / 'other'), 'another sweep', '--method all',
               '--method leapfrog')
    is_done(part(2, 4, tmp_path / 'four'))
    is_failure(join(parts[0], tmp_path / 'four', parts[2]), 1, 'one of 4 parts', 'one of 3')
    older = tmp_path / 'older'
    older.write_bytes(parts[1].read_bytes().replace(b'# springstep ', b'# springstep 0', 1))
    is_failure(join(parts[0], older, parts[2]), 1, 'another sweep', '# springstep 0')
    is_failure(join(parts[0], __file__, parts[2]), 1, __file__, 'not a part of a sweep')
    is_failure(join(parts[0], tmp_path / 'nothing'), 3, 'No such file')
    whole = tmp_path / 'whole'
    is_done(run(SWEEP, *GRID, '-o', whole))
    is_failure(join(whole), 1, 'not a part of a sweep')


def test_a_file_without_lines(tmp_path):
    """Is not read to its end, which there may be none."""
    short = 'is not a part of a sweep: its header should be whole lines of fewer than 65536 bytes in all'
    is_failure(in_little_memory(SWEEP, '--join', '/dev/zero'), 3, f'--join: "/dev/zero" {short}')
    comments = tmp_path / 'comments'
    comments.write_text('# a line\n' * 8000)
    is_failure(join(comments), 3, f'"{comments}" {short}')


def test_the_output_is_none_of_the_parts(parts, tmp_path):
    paths = copies(parts, tmp_path)
    before = paths[1].read_bytes()
    link = tmp_path / 'link'
    link.symlink_to(paths[1])
    for output in paths[1], link:
        is_failure(run(SWEEP, '--join', *paths, '-o', output), 2, f'--output: "{output}" is one of the parts to join')
    assert same(paths[1].read_bytes(), before)


def test_a_file_of_something_else_is_left_alone(parts, older):
    is_failure(part(1, 3, older), 3, str(older), '"older"', 'is not this part of this sweep')
    assert older.read_text() == 'older\n'
    before = parts[1].read_bytes()
    is_failure(part(1, 3, parts[1]), 3, '# part 2 of 3', '# part 1 of 3')
    assert same(parts[1].read_bytes(), before)


# --- the grid -------------------------------------------------------------------------------------------------------

def sweep(*args):
    return table(SWEEP, *' '.join(args).split())


def test_order_and_values():
    rows = sweep('--over omega_dt=0.25:1:4 --over damping_ratio=0.5,0.1 --method rk4,euler')
    assert [(row['omega_dt'], row['damping_ratio'], row['method']) for row in rows] == [
        (step, ratio, method) for step in ('0.25', '0.5', '0.75', '1')
        for ratio in ('0.5', '0.10000000000000001') for method in ('rk4', 'euler')]


@pytest.mark.parametrize('first, last, count', [(0.01, 3, 301), (1, 1e-6, 61), (2e-6, 7e5, 1000)])
def test_logarithmic(first, last, count):
    values = column(sweep(f'--over omega_dt={first}:{last}:log:{count} periods=1e-6 --method exact'), 'omega_dt')
    assert len(values) == count and (values[0], values[-1]) == (first, last)
    for i, value in enumerate(values):
        want = first * (last / first) ** (i / (count - 1))
        assert value == float(f'{value:.11e}') and abs(value / want - 1) <= 6e-12, 'rounded to 12 digits'


def test_linear():
    values = column(sweep('--over damping_ratio=0:2:201 --method exact --over periods=0.1'), 'damping_ratio')
    assert values == [i / 100 for i in range(201)], 'as one would write them'
    near = column(sweep('--over damping_ratio=1:1.000000000001:101 --method exact --over periods=0.1'), 'damping_ratio')
    assert len(set(near)) == 101, 'distinct'


# --- what is measured -----------------------------------------------------------------------------------------------

def norm(a, b, c, d):
    return (math.hypot(a + d, b - c) + math.hypot(a - d, b + c)) / 2


def states(method, ratio, step, steps):
    """(x from x = 1, x from v = 1, v, v) after each step, by another program."""
    def run_from(start):
        rows = parse(run(RUN, *f'--method {method} --damping {2 * ratio!r} --dt {step} --steps {steps} --every 1'.split(), *start).stdout)
        return [(float(row['x_m']), float(row['v_m_per_s'])) for row in rows[1:]]
    return [(x, y, v, w) for (x, v), (y, w) in zip(run_from([]), run_from(['--x0', '0', '--v0', '1']), strict=True)]


@pytest.mark.parametrize('ratio', [0, 0.1, 1.3, 6])
@pytest.mark.parametrize('step', [0.3, 0.8, 2.5])
def test_a_spring(ratio, step):
    """By runs of spring-run from both starts."""
    rows = sweep(f'--over omega_dt={step} damping_ratio={ratio} periods=5 '
                 '--measure steps,force_evaluations,dt_s,stable_step_s,explode_time_s,settling_time_s')
    steps = round(10 * math.pi / step)
    exact = states('exact', ratio, step, steps)
    assert [row['method'] for row in rows] == SPRINGS
    for row in rows:
        got = states(row['method'], ratio, step, steps)
        assert (int(row['steps']), float(row['dt_s'])) == (steps, step)
        assert int(row['force_evaluations']) == steps * FORCES[row['method']]
        most = max(norm(*(p - q for p, q in zip(*pair))) for pair in zip(got, exact))
        energies = [(y[0]**2 + y[2]**2, y[1]**2 + y[3]**2) for y in got]
        off = max((y[k]**2 + y[2 + k]**2 - z[k]**2 - z[2 + k]**2 for y, z in zip(got, exact) for k in (0, 1)), key=abs)
        exploded = next((step * i for i, pair in enumerate(energies, 1) if max(pair) > 100), math.inf)
        loud = [i for i, y in enumerate(got, 1) if max(abs(y[0]), abs(y[2])) > 0.01]
        settled = step * (max(loud, default=0) + 1) if max(loud, default=0) < steps else math.inf
        rounding = 1e-11
        assert abs(float(row['error']) - most) <= rounding * max(1, most)
        assert abs(float(row['energy_error']) - off) <= rounding * max(1, abs(off))
        assert (float(row['explode_time_s']), float(row['settling_time_s'])) == (exploded, settled)
        stable = step < float(row['stable_step_s'])
        assert row['status'] == ('stable' if stable else 'exploded' if exploded < math.inf else 'growing')


def test_a_long_run_is_looked_at_often_enough():
    """Not at each step; yet the step that spring_accurate_step() gives for the error that was seen is the step."""
    for row in sweep('--over omega_dt=0.003 damping_ratio=0,0.2,3 periods=20 --method euler,leapfrog,rk4'):
        if float(row['error']) > 1e-9:
            plan, = sweep(f'--over tolerance={row["error"]} damping_ratio={row["damping_ratio"]} periods=20 '
                          f'--method {row["method"]} --measure dt_s')
            assert 0.95 < float(plan['dt_s']) / 0.003 < 1.06


def test_what_has_died_out_is_no_less_for_a_longer_run():
    for line in ('omega_dt=0.001 damping_ratio=0.1,0.3', 'omega_dt=0.1 damping_ratio=0.2'):
        short, long = (sweep(f'--over {line} periods={periods} --method euler,symplectic-euler,leapfrog '
                             '--measure settling_time_s') for periods in (30, 300))
        assert [{**row, 'periods': ''} for row in short] == [{**row, 'periods': ''} for row in long]


def test_tolerance_is_the_plan():
    rows = sweep('--over tolerance=1e-2,1e-4 damping_ratio=0,0.3 periods=7 --measure steps,dt_s,force_evaluations')
    for (tolerance, ratio), some in itertools.groupby(rows, lambda row: (row['tolerance'], row['damping_ratio'])):
        plan = {row['method']: row for row in table(
            PLAN, '--duration', repr(2 * math.pi * 7), '--error', tolerance, '--stiffness', '1', '--damping',
            repr(2 * float(ratio)))}
        for row in some:
            other = plan[row['method']]
            assert (row['steps'], row['dt_s'], row['error']) == (other['steps'], other['dt_s'], other['predicted_error'])
            assert (row['energy_error'], row['force_evaluations']) == ('nan', other['force_evaluations'])


def test_what_cannot_be_done_has_a_word():
    status = [row['status'] for row in sweep('--over omega_dt=1e-6 periods=1e8 --method rk4')]
    assert status == ['too_long']
    status = [row['status'] for row in sweep('--over tolerance=1e-16 periods=1e3 --method leapfrog,exact')]
    assert status == ['no_step', 'stable']
    status = [row['status'] for row in sweep('--scene rope --over damping=0.01 duration=0.1 --method rkn8,rk4')]
    assert status == ['unsupported', 'stable']
    status = [row['status'] for row in sweep('--scene chain --over stable_fraction=0.5 duration=0.1 --method euler')]
    assert status == ['no_step']
    status = [row['status'] for row in sweep('--scene cloth --over size=1000000 --method rk4')]
    assert status == ['too_long']
    status = [row['status'] for row in sweep('--scene cloth --over size=8 gravity=0 duration=0.1 --method rk4')]
    assert status == ['invalid'], 'nothing moves but by rounding'
    status = [row['status'] for row in sweep('--scene water --over stretch=0.5 duration=0.1 --method rk4')]
    assert status == ['invalid']


@pytest.mark.parametrize('scene', SCENES)
def test_a_scene(scene):
    """Its energies by spring-scene, in the steps that are asked for and in short ones."""
    def energies(method, substeps):
        result = run(SCENE, *f'--scene {scene} --method {method} --steps-per-frame {substeps} --duration 0.25'.split())
        return parse(result.stdout)
    rows = sweep(f'--scene {scene} --over steps_per_frame=4 duration=0.25 '
                 '--measure steps,force_evaluations,dt_s,stable_step_s')
    stable, = (float(row['stable_step_s']) for row in rows if row['method'] == 'leapfrog')
    reference = energies('rk4', math.ceil(1 / 60 / (stable / 16)))
    kinetic = max(column(reference, 'kinetic_J'))
    for row in rows:
        assert (int(row['steps']), float(row['dt_s'])) == (60, 1 / 240)
        assert int(row['force_evaluations']) == 60 * FORCES[row['method']]
        measured = energies(row['method'], 4)
        off = [float(a['energy_J']) - float(b['energy_J']) for a, b in zip(measured, reference)]
        exploded = any(float(a['kinetic_J']) > 10 * kinetic for a in measured)
        assert (row['status'] == 'exploded') == exploded
        if not exploded:
            assert abs(abs(float(row['energy_error'])) - max(map(abs, off)) / kinetic) <= 1e-9
            assert 0 < float(row['error']) < 1


def test_heavily_damped_links():
    """They limit the reference, RK4, and not leapfrog."""
    rows = sweep('--scene rope --over damping=0,30,1000 steps_per_frame=8 duration=0.1 --method leapfrog '
                 '--measure stable_step_s')
    assert [row['status'] for row in rows] == ['stable'] * 3
    assert len(set(column(rows, 'stable_step_s'))) == 1
    assert max(column(rows, 'error')) <= 0.01


@pytest.mark.parametrize('scene, bound', [('cloth', 1e-9), ('water', 2e-4)])
def test_reference_of_a_scene(scene, bound):
    """As right as the manual says: order 8 in short steps is nearer to the truth than the reference."""
    row, = sweep(f'--scene {scene} --over size=8 steps_per_frame=128 duration=2 --method rkn8')
    assert 0 < float(row['error']) <= bound


def test_angle():
    """Let go where it hangs, the rope does not swing: what moves is its length, far less than a swing."""
    hanging, level = sweep('--scene rope --over size=2 angle=1,90 steps_per_frame=64 duration=1 --method leapfrog')
    assert hanging['status'] == level['status'] == 'stable' and 0 < float(hanging['error']) < 1e-2


# --- bad input ------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('args, words', [
    ('--over omega=1', ['--over', '"omega" is not a parameter of one spring', 'omega_dt, damping_ratio']),
    ('--scene rope --over omega_dt=1', ['"omega_dt" is not a parameter of the scene rope', 'stretch, angle']),
    ('--scene cloth --over angle=1', ['"angle" is not a parameter of the scene cloth']),
    ('--over omega_dt', ['"omega_dt" is not NAME=A:B:N']),
    *[(f'--over omega_dt={values}', [f'"omega_dt={values}" is not NAME=A:B:N'])
      for values in ['', ':', '1:2', '1:2:1', '1:2:0', '1:2:-3', '1:2:3:4', '1:2:x', '1:2:log', '1:2:lin:3', '1,,2', '1,',
                     ',1', 'nan', 'inf', '1x', '1:nan:3', '1:2:1e-3', '1:2:99999999999999999999']],
    ('--over omega_dt=0:1:3', ['"omega_dt=0:1:3" has the value 0', 'from 1e-06 to 1e+06']),
    ('--over damping_ratio=0:1:log:3', ['logarithmic', 'greater than 0']),
    ('--over damping_ratio=1e6:1e-320:log:3', ['too far apart']),
    ('--scene rope --over size=2:3:3', ['"size=2:3:3" has the value 2.5', 'whole number']),
    ('--over omega_dt=1 omega_dt=2', ['"omega_dt=2"', 'already']),
    ('--over omega_dt=1 tolerance=0.1', ['"tolerance=0.1"', 'either', '"omega_dt"']),
    ('--scene rope --over stable_fraction=1 steps_per_frame=2', ['"steps_per_frame=2"', 'either']),
    ('--over omega_dt=1:2:9000000000 damping_ratio=0:1:9000000000', ['--over', 'more than 9007199254740992 points']),
    ('--method nothing', ['--method', '"nothing" is not one of all, euler']),
    ('--method rk4,rk4', ['--method', '"rk4" is listed twice']),
    ('--method rk4,', ['--method', '"" is not one of']),
    ('--measure error', ['--measure', '"error" is not one of steps']),
    ('--measure steps --measure steps', ['--measure', '"steps" is listed twice']),
    *[(f'--part {text} -o x', ['--part', f'"{text}" is not I/N'])
      for text in ['0/3', '4/3', '1', '1/', '/3', '1/3/4', '-1/3', 'a/3', '1/99999999999', '1/3x']],
    ('--part 1/3', ['--part', '--output']),
    ('--jobs 2', ['--jobs', '--output']),
    ('--jobs 2 --part 1/3 -o x', ['--part', 'combined with --jobs']),
    ('--part 1/2 2/2 -o x', ['--part', '"1/2" and "2/2"', 'only one part']),
    ('--join a --over omega_dt=1', ['--join', 'options other than --output']),
    ('--join a --scene rope', ['--join', 'options other than --output']),
])
def test_refused(args, words, tmp_path):
    is_failure(run(SWEEP, *args.split(), cwd=tmp_path), 2, *words)
    assert list(tmp_path.iterdir()) == []


def test_list():
    rows = table(SWEEP, '--list', '--scene', 'rope')
    assert {'mass_ratio', 'angle', 'steps_per_frame'} <= {row['name'] for row in rows}
    quick = {'duration': '0.002', 'drag': '0'}  # few steps of the reference, even with the least mass
    for row in rows:
        others = (name + '=' + value for name, value in quick.items() if name != row['name'])
        first = table(SWEEP, '--scene', 'rope', '--over', row['name'] + '=' + row['least'], *others, '--method', 'rk4')[0]
        assert len(row['meaning']) > 4 and list(first)[0] == row['column']
