# SPDX-License-Identifier: MIT
"""spring-plan: methods and steps for an error and a duration."""
import math
import re

import pytest
from test_methods import SCENES, SPRINGS, TABLE
from tools import PLAN, SCENE, column, in_little_memory, is_failure, parse, run, table

FORCES = {row['method']: int(row['forces_per_step']) for row in TABLE}
COLUMNS = 'method dt_s steps force_evaluations predicted_error measured_error time_s'.split()
PRESETS = ['rope', 'cloth', 'jelly', 'chain', 'water']


def plan(*args):
    return table(PLAN, *' '.join(args).split())


def is_sorted(rows):
    """Each row is the most accurate of those that take less than a tenth longer than the fastest from there on."""
    for i, row in enumerate(rows):
        fastest = min(column(rows[i:], 'time_s'))
        if fastest == math.inf:
            break
        rounding = 1e-3  # of printed times: on the limit either is right
        surely, perhaps = ([r for r in rows[i:] if float(r['time_s']) < 1.1 * fastest * (1 + sign * rounding)]
                           for sign in (-1, 1))
        assert row in perhaps and float(row['measured_error']) <= min(column(surely, 'measured_error'))


def is_a_plan(rows, methods, duration):
    assert list(rows[0])[:len(COLUMNS)] == COLUMNS
    assert sorted(row['method'] for row in rows) == sorted(methods)
    is_sorted(rows)
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
    assert all(row['steps'] == '0' for row in rows)


@pytest.mark.parametrize('options, exact', [
    ('--error 1e-9 --duration 1e9 --hertz 2', False), ('--error 1e-4 --duration 1e9 --hertz 2', True),
    ('--error 1e-9 --duration 1e9 --hertz 2 --damping-ratio 0.01', True), ('--error 1e-17 --duration 1 --hertz 2', False)])
def test_rounding_of_the_exact_solution(options, exact):
    """The bound of spring_step_exact(), until the motion has decayed."""
    rows = {row['method']: row for row in plan(options)}
    assert (int(rows['exact']['steps']) == 1) == exact


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


@pytest.mark.parametrize('damping', ['0', '1e-4', '0.03', '1'])
def test_cost_of_damped_links(damping):
    text = run(PLAN, *f'--error 0.05 --duration 0.1 --size 6 --scene jelly --damping {damping}'.split()).stdout
    said = re.findall(r'# damping: dt G = (\S+), .* damping alone (\d+) time', text)
    assert len(said) == (damping != '0')
    for reach, times in said:
        assert int(times) in ([0, 1] if float(reach) <= 0.6 else [max(2, math.ceil(math.sqrt(2.6 * float(reach) + 1)) - 1)])


def test_a_scene_that_a_method_is_not_for():
    rows = plan('--error 0.05 --duration 0.3 --size 6 --damping 0.1 --scene cloth')
    is_a_plan(rows, SCENES, 0.3)
    assert {row['method'] for row in rows if row['steps'] == '0'} == {'srkn6', 'rkn8'}


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
    (['  l -1 -4 # both ends', 'f 1 2 3\r', 'vt 0.5 0.5', 'usemtl cloth'], 4),
])
def test_a_mesh(tmp_path, elements, links):
    path = mesh_file(tmp_path, '# a square', 'v 0.5 1 0', 'v 1.5 1 -0.5', 'v 0 0 0.2', 'v 1 0 0.1', *elements)
    args = f'--error 0.01 --duration 0.1 --mass 1.3 --stiffness 27 --drag 0.6 --mesh {path}'.split()
    printed = run(PLAN, *args).stdout
    assert f'# scene: a mesh, 4 particles, {links} links\n' in printed
    assert f'# command: spring-plan {" ".join(args)}\n' in printed
    rows = parse(printed)
    is_a_plan(rows, SCENES, 0.1)
    assert all(float(row['measured_error']) <= 0.01 for row in rows)


@pytest.mark.parametrize('option', ['--mass 2', '--stiffness 30', '--damping 3', '--drag 3'])
def test_options_reach_the_mesh(option, tmp_path):
    """They change the error of a number of steps, or the number of steps."""
    path = mesh_file(tmp_path, 'v 0.5 1 0', 'v 1.5 1 -0.5', 'v 0 0 0.2', 'v 1 0 0.1', 'f 1 2 4 3')
    base = f'--error 0.01 --duration 0.1 --mass 1.3 --stiffness 27 --mesh {path}'
    plans = [{row['method']: (row['steps'], row['measured_error']) for row in plan(base, more)} for more in ('', option)]
    assert plans[0]['rk4'] != plans[1]['rk4']


@pytest.mark.parametrize('corners', [3, 4, 5, 64, 65, 1000])
def test_faces_and_lines_of_any_length(tmp_path, corners):
    """A line of N vertices has N - 1 links, a face N; of four corners it has two more across."""
    vertices = [f'v {math.cos(i)} {math.sin(i)} 0' for i in range(corners)]
    numbers = ' '.join(str(i + 1) for i in range(corners))
    for element, links in ('l', corners - 1), ('f', corners if corners != 4 else 6):
        path = mesh_file(tmp_path, *vertices, f'{element} {numbers}')
        printed = run(PLAN, *f'--error 0.3 --duration 0.02 --stiffness 27 --mesh {path}'.split()).stdout
        assert f'# scene: a mesh, {corners} particles, {links} links\n' in printed


@pytest.mark.parametrize('name, word', [
    ('a flag.obj', "'a flag.obj'"), ("it's $HOME.obj", r"'it'\''s $HOME.obj'"), ('~a', "'~a'"), ('a*;b', "'a*;b'"),
    ('Fl\u00e4che', "'Fl\u00e4che'"), ('a-b_C.1,2%+=:@', 'a-b_C.1,2%+=:@'),
])
def test_the_command_can_be_pasted(tmp_path, name, word):
    (tmp_path / name).write_text('v 0 0 0\nv 0 -2 0\nl 1 2\n')
    args = '--error 0.1 --duration 0.1 --stiffness 3 --mesh'.split()
    printed = run(PLAN, *args, name, cwd=tmp_path).stdout
    command = printed.splitlines()[1]
    assert command == '# command: ' + ' '.join([PLAN, *args, word])
    again = run('bash', '-c', command.removeprefix('# command: '), cwd=tmp_path).stdout
    assert (again.splitlines()[1], parse(again)[0].keys()) == (command, parse(printed)[0].keys())


@pytest.mark.parametrize('start, endless, message', [
    ('', 'cat /dev/zero', 'line 1: the file should be text without NUL bytes'),
    ('v 0 0 0\\n', 'yes | tr -d "\\n"', 'line 2: a line should not be longer than 16 MiB'),
])
def test_a_mesh_without_lines(start, endless, message):
    """Is not read to its end, which there may be none."""
    mesh = f'<(printf "{start}"; {endless} | head -c 600000000)'
    result = in_little_memory('bash', '-c', f'exec {PLAN} --error 0.1 --duration 1 --stiffness 3 --mesh {mesh}')
    assert (result.returncode, result.stdout) == (2, '') and message in result.stderr and '--mesh: "/' in result.stderr


@pytest.mark.parametrize('line, message', [
    ('v 1 2', 'line 2: a vertex should have three finite numbers'),
    ('v 1 2 nan', 'line 2: a vertex should have three finite numbers'),
    ('f 1 2 3', 'line 2: a corner should be the number of a vertex above'),
    ('f 1 1', 'line 2: a face should have three corners'),
    ('l 1 1', 'line 2: an edge should join two vertices'),
    ('l 1', 'line 2: a line should have two ends'),
    ('l 1 x', 'line 2: a corner should be the number of a vertex above'),
    ('l 1 0', 'line 2: a corner should be the number of a vertex above'),
    ('v 1 1e308 0\nv 1 -1e308 0\nl 2 3', 'the length of the edge between vertices 2 and 3 should be finite'),
    ('v 1 2 3a', 'line 2: a vertex should have three finite numbers'),
    ('\0', 'line 2: the file should be text without NUL bytes'),
    ('# l 1 1', 'should have faces or lines'),
    ('v 1 0 1\nl 1 2', 'is level'),
])
def test_what_is_not_a_mesh(tmp_path, line, message):
    path = mesh_file(tmp_path, 'v 0 0 0', line)
    done = run(PLAN, *f'--error 0.1 --duration 1 --stiffness 3 --mesh {path}'.split())
    is_failure(done, 2, str(path), message)


def test_a_mesh_of_another_system(tmp_path):
    path = tmp_path / 'mesh.obj'
    path.write_bytes(b'\xef\xbb\xbfv 0 0 0\r\nv 0 -2 0\r\nl 1 2')
    is_a_plan(plan(f'--error 0.1 --duration 0.1 --stiffness 3 --mesh {path}'), SCENES, 0.1)


def test_heights_whose_difference_overflows(tmp_path):
    path = mesh_file(tmp_path, 'v 0 1e308 0', 'v 0 0 0', 'v 0 -1e308 0', 'l 1 2 3')
    done = run(PLAN, *f'--error 0.1 --duration 1 --stiffness 3 --mesh {path}'.split(), stdout=None)
    is_failure(done, 1, 'the reference of this scene overflows')


@pytest.mark.parametrize('options, status, message', [
    ('--duration 1e9', 2, '--duration: "1e+09" of this scene is too long; it should be at most'),
    ('--duration 1 --stiffness 1e20', 1, 'the reference of this scene would need'),
    ('--duration 1e-300', 1, 'overflows, or does not move'),
])
def test_a_scene_that_takes_too_long(options, status, message):
    is_failure(run(PLAN, *f'--error 0.1 --scene rope {options}'.split(), stdout=None), status, message)


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


SAG_COLUMNS = 'limit stiffness_N_per_m scene_stretch link_stretch stable_step_s steps_per_frame dt_s time_per_frame_s precision'.split()


def hang(options, fraction=0.9):
    """The rows of --sag in double precision by limit, as numbers. Each is followed by its row in single precision."""
    rows = plan('--sag', options)
    assert all(list(row) == SAG_COLUMNS for row in rows)
    assert [row.pop('precision') for row in rows] == ['double', 'float'] * (len(rows) // 2)
    limits = [row.pop('limit') for row in rows]
    assert limits[::2] == limits[1::2]
    rows = [{name: float(number) for name, number in row.items()} for row in rows]
    for double, single in zip(rows[::2], rows[1::2], strict=True):
        has_the_steps(single, fraction)
        assert all(double[name] == single[name] for name in ('stiffness_N_per_m', 'scene_stretch', 'link_stretch'))
        assert single['stable_step_s'] == pytest.approx(double['stable_step_s'], rel=1e-6), 'coefficients in float'
    return dict(zip(limits[::2], rows[::2], strict=True))


def has_the_steps(row, fraction):
    """As few steps in a frame as the fraction of the stable step allows."""
    assert row['dt_s'] == pytest.approx(1 / 60 / row['steps_per_frame'], rel=1e-15)
    assert row['dt_s'] <= row['stable_step_s'] * fraction * (1 + 1e-15)
    assert row['steps_per_frame'] == math.ceil(1 / 60 / (fraction * row['stable_step_s']))
    assert row['time_per_frame_s'] > 0


@pytest.mark.parametrize('sag', [0.001, 0.02, 0.3])
@pytest.mark.parametrize('size, mass', [(2, 0.7), (9, 0.03)])
def test_a_rope_that_hangs(size, mass, sag):
    """n links of stiffness k, each with the weight of all particles below: in all they stretch by m g n (n + 1)/(2 k)."""
    links, weight = size - 1, mass * 9.81
    rows = hang(f'{sag} --scene rope --size {size} --mass {mass}', 0.5)
    spacing = 2 / links
    want = {'scene': weight * (links + 1) / 2 / (sag * spacing), 'link': weight * links / (sag * spacing)}
    window = 1e-3 + 1e-4  # a stretch of up to 0.1 % less; balance to 1e-5 of gravity, twice for the extrapolation
    for limit, row in rows.items():
        assert -1e-4 <= row['stiffness_N_per_m'] / want[limit] - 1 <= window
        assert sag * (1 - 1e-3) <= row[f'{limit}_stretch'] <= sag
        ratio = (links + 1) / (2 * links)
        assert row['scene_stretch'] / row['link_stretch'] == pytest.approx(ratio, rel=2e-4)
        highest = {2: 1, 9: 4}[size] * row['stiffness_N_per_m'] / mass  # between a pin and a particle, or two
        assert row['stable_step_s'] == pytest.approx(2 / math.sqrt(highest), rel=1e-12)
        has_the_steps(row, 0.5)
    assert set(rows) == {'scene', 'link'}


@pytest.mark.parametrize('scene, height', [('cloth', 2), ('jelly', 0.7)])
def test_a_cloth_and_jelly(scene, height, tmp_path):
    """Settled by another program, with the stiffness that is printed."""
    for limit, row in hang(f'0.03 --scene {scene} --size 6 --mass 0.02').items():
        has_the_steps(row, 0.9)
        drag = 0.02 * 2 * math.sqrt(9.81 / height)
        path = tmp_path / f'{limit}.tsv'
        run(SCENE, *f'--scene {scene} --size 6 --mass 0.02 --drag {drag} --stiffness {row["stiffness_N_per_m"]} '
                    f'--method leapfrog --duration 20 --positions {path}'.split())
        last = positions(path)[-1]
        heights = last[2::3]
        sign = {'cloth': 1, 'jelly': -1}[scene]
        stretch = sign * ((max(heights) - min(heights)) / height - 1)
        assert stretch == pytest.approx(row['scene_stretch'], rel=0.02), 'the height without stretch is extrapolated'
        assert row[f'{limit}_stretch'] == pytest.approx(0.03, rel=1e-3) and row['scene_stretch'] <= row['link_stretch']
        at = [last[3 * i:3 * i + 3] for i in range(len(last) // 3)]
        pairs = [(i, i + 6) for i in range(30)] if scene == 'cloth' else [(i, i + 36) for i in range(5 * 36)]
        strains = [sign * (math.dist(at[i], at[j]) / (height / 5) - 1) for i, j in pairs]
        assert max(strains) == pytest.approx(row['link_stretch'], rel=0.01), 'upright links are stretched most'


def test_meshes_that_hang(tmp_path):
    """Of half the spacing and all of the mass, hung by an edge: columns are ropes. Their rows do not stretch."""
    columns, links, mass, spacing = 3, 4, 0.2, 0.5
    vertices = [f'v {spacing * i} {-spacing * j} 0' for j in range(links + 1) for i in range(columns)]
    lines = ['l ' + ' '.join(str(j * columns + i + 1) for j in range(links + 1)) for i in range(columns)]
    lines += ['l ' + ' '.join(str(j * columns + i + 1) for i in range(columns)) for j in range(links + 1)]
    path = mesh_file(tmp_path, *vertices, *lines, 'v 7 7 7')
    rows = hang(f'0.05 --mass {mass} --damping 0.3 --drag 0.1 --mesh {path}')
    for limit, row in rows.items():
        weights = {'scene': (links + 1) / 2, 'link': links}[limit]
        assert -1e-4 <= row['stiffness_N_per_m'] / (mass * 9.81 * weights / (0.05 * spacing)) - 1 <= 1.1e-3
        has_the_steps(row, 0.9)
    assert set(rows) == {'scene', 'link'}


def test_damping_and_drag_leave_the_stiffness():
    one, other = (hang(f'0.05 --scene cloth --size 5 {options}') for options in ['', '--damping 70 --drag 3'])
    for limit in one:
        assert one[limit]['stiffness_N_per_m'] == other[limit]['stiffness_N_per_m']
        assert one[limit]['steps_per_frame'] == other[limit]['steps_per_frame'], 'damping does not limit leapfrog'


def test_tethers_save_steps():
    """README's cloth needs less than half of the steps, and its most stretched link is stretched less."""
    rows = [hang(f'0.02 --scene cloth {options}')['scene'] for options in ['', '--tethers 0.05', '--tethers 0.05 --bend 1e-3']]
    steps = [row['steps_per_frame'] for row in rows]
    assert steps[0] == 13 and steps[1] <= 7 and steps[2] <= 7
    assert rows[1]['link_stretch'] < 0.7 * rows[0]['link_stretch']


def test_a_hammock(tmp_path):
    """A taut rope between two points sags by the cube root of 1/stiffness, far more than its links stretch."""
    path = mesh_file(tmp_path, 'v 0 1 0', 'v 1 0.99 0', 'v 2 0.99 0', 'v 3 1 0', 'l 1 2 3 4')
    printed = run(PLAN, *f'--sag 0.02 --mesh {path}'.split()).stdout
    assert 'depends on more than the stretch of its links' in printed
    row, single = parse(printed)
    assert [row['precision'], single['precision']] == ['double', 'float'] and row['limit'] == single['limit']
    assert row['limit'] == 'link' and float(row['scene_stretch']) > 10 * float(row['link_stretch'])


@pytest.mark.parametrize('options, status, words', [
    ('--sag 0.02', 2, ['--sag: "0.02"', '--scene or --mesh']),
    ('--sag 0 --scene rope', 2, ['--sag: "0"']),
    ('--sag 2 --scene rope', 2, ['--sag: "2"', 'from 1e-4 to 1']),
    ('--sag 1e-5 --scene rope', 2, ['--sag: "1e-05"', 'from 1e-4 to 1']),
    ('--sag 0.02 --scene water', 2, ['gravity of this scene is "0"', 'should not be 0']),
    ('--sag 0.02 --scene chain', 2, ['gravity of this scene is "0"', 'should not be 0']),
    ('--sag 0.5 --scene jelly', 1, ['--sag: "0.5" cannot be reached', 'N/m']),
    ('--sag 0.02 --scene rope --stiffness 3', 2, ['--stiffness: "3"', '--sag']),
    ('--sag 0.02 --scene rope --error 0.1', 2, ['--error: "0.1"', '--sag']),
    ('--sag 0.02 --scene rope --duration 3', 2, ['--duration: "3"', '--sag']),
    ('--sag 0.02 --scene rope --hertz 3', 2, ['--hertz: "3"', 'scene']),
    ('--sag 0.02 --scene jelly --bend 3', 2, ['--bend: "3"', 'rope, cloth and water']),
    ('--error 0.02 --duration 1 --scene water --tethers 0.05', 2, ['--tethers: "0.05"', 'one axis']),
    ('--error 0.02 --duration 1 --hertz 2 --tethers 0.05', 2, ['--tethers: "0.05"', 'scene']),
    ('--sag 0.02 --presets', 2, ['--sag: "0.02"', '--presets']),
    ('--sag 0.9 --scene jelly --size 4', 2, ['--sag: "0.9"', 'stands on its pins', 'at most 0.5']),
])
def test_what_does_not_hang(options, status, words):
    is_failure(run(PLAN, *options.split(), stdout=None), status, *words)


@pytest.mark.parametrize('options, fraction, words', [
    ('--error 0.1 --duration 1 --scene cloth', 0.9, 'a sheet or a block with drag'),
    ('--error 0.1 --duration 1 --scene rope', 0.5, 'a rope with drag'),
    ('--error 0.1 --duration 1 --scene rope --tethers 0.05', 0.5, 'a rope with drag'),
    ('--error 0.1 --duration 1 --scene rope --drag 0', 0.5, 'smooth motion without damping'),
    ('--error 0.3 --duration 61 --scene chain --size 3 --damping 0', 0.25, 'a long run without damping'),
    ('--error 0.1 --duration 1 --scene rope --drag 0 --damping 3', 0.9, 'damped links'),
    ('--sag 0.1 --scene jelly --size 4', 0.9, 'a sheet or a block with drag'),
])
def test_the_rule_for_steps(options, fraction, words):
    """As many steps as the fraction allows, in both precisions."""
    printed = run(PLAN, *options.split()).stdout
    rule = r'# steps: for (.*), leapfrog may take (\S+) of the stable step: (\S+) s, (\d+) per frame \(float: (\S+) s, (\d+)\)\.'
    found = re.findall(rule, printed)
    assert found
    for what, allowed, step, steps, single, single_steps in found:
        assert what.startswith(words) and float(allowed) == fraction and step == single
        assert int(steps) == int(single_steps) == math.ceil(1 / 60 / float(step) - 1e-3)
    first = parse(printed)[0]
    if '--sag' in options:
        assert float(found[0][2]) == pytest.approx(fraction * float(first['stable_step_s']), rel=1e-3)
    elif first['method'] == 'leapfrog':
        beyond = float(first['dt_s']) > float(found[0][2]) / fraction
        assert ('\n# limit: the step of the plan is longer than the stable step' in printed) == beyond


@pytest.mark.parametrize('options', ['--sag 0.3 --scene cloth --size 13', '--sag 1 --scene rope --damping 3'])
def test_links_of_more_than_twice_their_length(options):
    """Half of the stable step where links are longer than that, and 0.9 where they are not."""
    printed = run(PLAN, *options.split()).stdout
    rows = parse(printed)
    assert {float(row['link_stretch']) > 1 for row in rows} == {False, True}
    assert ['0.5', '0.9'] == re.findall(r'leapfrog may take (\S+) of the stable step', printed)
    for row in rows:
        allowed = 0.5 if float(row['link_stretch']) > 1 else 0.9
        assert int(row['steps_per_frame']) == math.ceil(1 / 60 / (allowed * float(row['stable_step_s'])))


@pytest.mark.parametrize('options', ['--error 0.01 --duration 0.1 --scene chain --mass 1e30 --stiffness 1e40',
                                     '--sag 0.02 --scene rope --mass 1e-40'])
def test_a_scene_that_is_not_representable_in_single_precision(options):
    printed = run(PLAN, *options.split()).stdout
    assert '(float: not representable)' in printed and 'nan' not in printed.partition('plan: ')[2].partition('limit\t')[2]
    assert all(row.get('precision', 'double') == 'double' for row in parse(printed)) and parse(printed)


def test_a_part_that_falls(tmp_path):
    path = mesh_file(tmp_path, 'v 0 1 0', 'v 1 0 0', 'v 5 0 0', 'v 5 -1.5 0', 'l 1 2', 'l 3 4')
    is_failure(run(PLAN, '--sag', '0.02', '--mesh', str(path), stdout=None), 2, '--sag: the vertex at "5 ', 'to no pin')
