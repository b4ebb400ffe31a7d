# SPDX-License-Identifier: MIT
"""spring-plan: an error and a duration in, methods and steps out."""
import math

import pytest
from test_methods import SCENES, SPRINGS, TABLE
from tools import PLAN, SCENE, column, is_failure, parse, run, table

FORCES = {row['method']: int(row['forces_per_step']) for row in TABLE}
COLUMNS = 'method dt_s steps force_evaluations predicted_error measured_error time_s'.split()
PRESETS = ['rope', 'cloth', 'jelly', 'chain', 'water']


def plan(*args):
    return table(PLAN, *' '.join(args).split())


def is_a_plan(rows, methods, duration):
    assert list(rows[0])[:len(COLUMNS)] == COLUMNS
    assert sorted(row['method'] for row in rows) == sorted(methods)
    assert column(rows, 'time_s') == sorted(column(rows, 'time_s')), 'the cheapest first'
    for row in rows:
        steps = int(row['steps'])
        assert int(row['force_evaluations']) == steps * FORCES[row['method']]
        if steps == 0:
            assert (float(row['dt_s']), row['time_s']) == (0, 'inf')
        else:
            assert abs(float(row['dt_s']) * steps / duration - 1) <= 1e-14


@pytest.mark.parametrize('error', ['0.1', '0.003', '1e-6'])
def test_a_spring(error):
    rows = plan('--duration 20 --mass 1.3 --stiffness 2.7 --damping 0.3 --error', error)
    is_a_plan(rows, SPRINGS, 20)
    for row in rows:
        predicted, measured = float(row['predicted_error']), float(row['measured_error'])
        if row['method'] == 'exact':
            assert (int(row['steps']), predicted, measured) == (1, 0, 0)
        else:
            assert 0.5 * float(error) < predicted <= float(error)
            assert 0.999 <= predicted / measured <= 1.05, 'what spring_step_error() promises'


def test_a_frequency_is_a_stiffness():
    omega = 2 * math.pi * 3
    by_frequency = plan('--error 0.01 --duration 2 --hertz 3 --damping-ratio 0.1')
    by_stiffness = plan(f'--error 0.01 --duration 2 --mass 2 --stiffness {2 * omega**2!r} --damping {0.4 * omega!r}')
    assert {row['method']: row['steps'] for row in by_frequency} == {
        row['method']: row['steps'] for row in by_stiffness}


def test_rounding_is_in_the_way():
    rows = plan('--error 1e-15 --duration 100 --hertz 1')
    is_a_plan(rows, SPRINGS, 100)
    assert rows[0]['method'] == 'exact'
    assert all(row['steps'] == '0' for row in rows[1:])


def test_in_words():
    words = [run(PLAN, *f'--duration 100 --hertz 1 --error {error}'.split()).stdout for error in ['0.01', '1e-15']]
    said = [[line for line in text.splitlines() if line.startswith('# plan: ')] for text in words]
    assert [len(lines) for lines in said] == [1, 1]
    assert 'exact solution' in said[0][0] and 'RK4 in ' in said[0][0]
    assert 'no stepper' in said[1][0]


@pytest.mark.parametrize('scene', PRESETS)
def test_a_scene(scene):
    rows = plan('--error 0.05 --duration 0.3 --size 8 --scene', scene)
    is_a_plan(rows, SCENES, 0.3)
    known = [row for row in rows if row['steps'] != '0']
    assert {'leapfrog', 'rk4'} <= {row['method'] for row in known}
    for row in known:
        assert float(row['measured_error']) <= 0.05
        assert float(row['uncertainty']) <= 0.05 / 20
        assert int(row['steps']) % 18 == 0, 'whole numbers of steps in a frame'


def test_a_scene_that_a_method_is_not_for():
    rows = plan('--error 0.05 --duration 0.3 --size 6 --damping 0.1 --scene cloth')
    is_a_plan(rows, SCENES, 0.3)
    assert {row['method'] for row in rows if row['steps'] == '0'} == {'rkn8'}


def positions(path):
    frames = {}
    for row in parse(path.read_text()):
        frames.setdefault(float(row['t_s']), []).extend(float(row[axis]) for axis in ['x_m', 'y_m', 'z_m'])
    return list(frames.values())


def test_measured_error_of_a_scene(tmp_path):
    """Against runs of spring-scene, by a definition written a second time."""
    for row in plan('--error 0.003 --duration 1 --scene chain'):
        runs = []
        for method, steps in [(row['method'], int(row['steps'])), ('rkn8', 60 * 16)]:
            path = tmp_path / 'positions.tsv'
            run(SCENE, *f'--scene chain --duration 1 --dt {1 / steps!r} --method {method} --positions {path}'.split())
            runs.append(positions(path))
        start = runs[1][0]
        assert len(runs[0]) == len(runs[1]) == 61
        error = max(math.dist(*pair) for pair in zip(*runs, strict=True))
        motion = max(math.dist(start, frame) for frame in runs[1])
        assert abs(error / motion - float(row['measured_error'])) <= 2e-3 * error / motion + float(row['uncertainty'])
        if row['predicted_error'] != 'nan':
            assert 0.5 <= float(row['predicted_error']) / float(row['measured_error']) <= 2, 'the power law'


def mesh_file(tmp_path, *lines):
    path = tmp_path / 'mesh.obj'
    path.write_text('\n'.join(lines) + '\n')
    return path


@pytest.mark.parametrize('elements, links', [
    (['f 1 2 3'], 3),
    (['f 1/1 2//7 3/1/7', 'f 3 2 4'], 5),  # which share an edge
    (['f 1 2 4 3'], 6),  # both diagonals
    (['l 1 2 4', 'l 4 2'], 2),
    (['l -1 -4', 'f 1 2 3', 'vt 0.5 0.5', 'usemtl cloth'], 4),
])
def test_a_mesh(tmp_path, elements, links):
    path = mesh_file(tmp_path, '# a square', 'v 0.5 1 0', 'v 1.5 1 -0.5', 'v 0 0 0.2', 'v 1 0 0.1', *elements)
    args = f'--error 0.01 --duration 0.1 --mass 1.3 --stiffness 27 --drag 0.6 --mesh {path}'.split()
    printed = run(PLAN, *args).stdout
    assert f'# scene: {path}, 4 particles, {links} links\n' in printed
    rows = parse(printed)
    is_a_plan(rows, SCENES, 0.1)
    assert all(float(row['measured_error']) <= 0.01 for row in rows)


def test_a_mesh_hangs_by_its_highest_vertex(tmp_path):
    """One link that is let go at its rest length is one spring; the distance it falls is twice its amplitude."""
    path = mesh_file(tmp_path, 'v 0 0 0', 'v 0 -2 0', 'l 1 2')
    spring = '--duration 5 --mass 1.3 --stiffness 2700'
    steps, of_mesh = ({row['method']: int(row['steps']) for row in plan(*words)}['leapfrog']
                      for words in [('--error 0.02', spring), ('--error 0.01', spring, '--mesh', str(path))])
    assert abs(of_mesh / steps - 1) <= 0.1, 'in whole steps a frame, seen at frames'


@pytest.mark.parametrize('line, message', [
    ('v 1 2', 'line 2: a vertex should have three finite numbers'),
    ('v 1 2 nan', 'line 2: a vertex should have three finite numbers'),
    ('f 1 2 3', 'line 2: a corner should be the number of a vertex above'),
    ('f 1 1', 'line 2: a face should have three corners'),
    ('l 1 1', 'line 2: an edge should join two vertices'),
    ('l 1', 'line 2: a line should have two ends'),
    ('l 1 x', 'line 2: a corner should be the number of a vertex above'),
    ('l 1 0', 'line 2: a corner should be the number of a vertex above'),
    ('l ' + '1 ' * 65, 'line 2: a face should not have more than 64 corners'),
    ('l ' + '1 ' * 5000, 'line 2: a line should not be longer than 4094 bytes'),
    ('', 'should have faces or lines'),
])
def test_what_is_not_a_mesh(tmp_path, line, message):
    path = mesh_file(tmp_path, 'v 0 0 0', line)
    done = run(PLAN, *f'--error 0.1 --duration 1 --stiffness 3 --mesh {path}'.split())
    is_failure(done, 2, str(path), message)


def test_presets():
    rows = table(PLAN, '--presets', '--quick')
    assert {(row['scene'], row['method']) for row in rows} == {(scene, m) for scene in PRESETS for m in SCENES}
    for scene in PRESETS:
        for method in SCENES:
            three = [row for row in rows if (row['scene'], row['method']) == (scene, method)]
            assert column(three, 'error') == [0.1, 0.01, 0.001]
            found = [int(row['substeps']) for row in three if row['substeps'] != '0']
            assert found == sorted(found)
            assert all(row['substeps'] == '0' or float(row['measured_error']) <= float(row['error']) for row in three)
            assert len({row['stable_substeps'] for row in three}) == 1
