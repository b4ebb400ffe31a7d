# SPDX-License-Identifier: MIT
"""spring-run: trajectories, rows, the envelope of the error, overflow."""
import math
import re

import pytest
from tools import ENERGY, METHODS, NEVER_STABLE, NOT_STABLE, NOT_WHOLE, ROUNDING, RUN, SCENE, STAGES, STEPPERS, column, parse, run, table

M, K, C, F, X0, V0 = 1.3, 2.7, 0.6, 0.9, 0.4, -1.1  # a spring with everything, nothing 1
SPRING = ['--mass', '1.3', '--stiffness', '2.7', '--damping', '0.6', '--load', '0.9', '--x0', '0.4', '--v0', '-1.1',
          '--duration', '7']
DT = 7 / 700


def true_x(t):
    """Textbook solution of the underdamped spring."""
    b, rest = C / (2 * M), F / K
    nu = math.sqrt(K / M - b * b)
    y = X0 - rest
    return rest + math.exp(-b * t) * (y * math.cos(nu * t) + (V0 + b * y) / nu * math.sin(nu * t))


def spring(how, *args, steps=700, remarks=()):
    return table(RUN, '--method', *how.split(), *SPRING, '--steps', str(steps), *args, remarks=remarks)


# --- numbers --------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('how, error', [('euler', '2.88367e-02'), ('leapfrog', '3.44533e-07'), ('rk4', '9.76996e-15'),
                                        (STAGES, '2.39808e-14')])
def test_long_run_of_the_study(how, error):
    row, = table(RUN, '--method', *how.split(), '--duration', '1000', '--steps', '1e7',
                 remarks=[NEVER_STABLE] if how == 'euler' else [])
    assert ('%.5e' % float(row['error_m']), row['step'], row['t_s']) == (error, '10000000', '1000')


@pytest.mark.parametrize('how', [*METHODS, STAGES])
def test_columns(how):
    rows = spring(how, '--every', '1')
    assert [int(row['step']) for row in rows] == list(range(701))
    assert column(rows, 't_s') == [i * DT for i in range(701)]  # times are not accumulated
    assert max(abs(x - true_x(i * DT)) for i, x in enumerate(column(rows, 'exact_x_m'))) <= 1e-14
    for row in rows:
        x, v = float(row['x_m']), float(row['v_m_per_s'])
        assert float(row['error_m']) == abs(x - float(row['exact_x_m']))
        assert abs(float(row['energy_J']) - (M * v * v / 2 + K * x * x / 2 - F * x)) <= 1e-15


@pytest.mark.parametrize('how', [*STEPPERS, STAGES])
def test_last_row_is_the_final_state(how):
    assert spring(how) == spring(how, '--every', '1')[-1:]


# --- rows -----------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('args, chosen', [
    pytest.param('--every 300', [0, 300, 600, 700], id='--every 300 and the final state'),
    pytest.param('--every 350', [0, 350, 700], id='--every 350, the final state once'),
    pytest.param('--every 1e19', [0, 700], id='--every beyond the end'),
    pytest.param('--every 1 --from 6.5', range(650, 701), id='--from'),
    pytest.param('--every 1 --from -1', range(701), id='--from before the start'),
    pytest.param('--every 1 --from 8', [700], id='--from beyond the end'),
])
def test_rows(args, chosen):
    rows = spring('leapfrog', '--every', '1')
    assert spring('leapfrog', *args.split()) == [rows[i] for i in chosen]


def test_more_steps_from_row_to_row_than_are_taken_at_once():
    rows = table(RUN, '--method', 'euler', '--duration', '1', '--steps', '5e7', '--every', '2e7',
                 remarks=[NEVER_STABLE])
    assert [row['step'] for row in rows] == ['0', '20000000', '40000000', '50000000']


@pytest.mark.parametrize('steps, parts', [(700, 60), (701, 60), (60, 60), (59, 60), (7, 60), (1, 1)])
def test_envelope(steps, parts, tmp_path):
    path = tmp_path / 'envelope.tsv'
    how = {'steps': steps, 'remarks': [NOT_STABLE] if steps < 8 else []}
    plain = spring('euler', '--every', '1', **how)
    assert spring('euler', '--every', '1', '--envelope', path, '--columns', str(parts), **how) == plain
    errors = {}
    for row in plain:
        part = min(int(row['step']) * parts // steps, parts - 1)
        errors.setdefault(part, []).append(float(row['x_m']) - float(row['exact_x_m']))
    text = path.read_text()
    assert str(tmp_path) not in text and '--envelope FILE' in text
    assert text.splitlines()[4] == 'method\tt_s\terror_min_m\terror_max_m'
    rows = parse(text)
    assert column(rows, 'error_min_m') == [min(e) for e in errors.values()]
    assert column(rows, 'error_max_m') == [max(e) for e in errors.values()]
    assert all(abs(t - (part + 0.5) * 7 / parts) <= 1e-14 for t, part in zip(column(rows, 't_s'), errors, strict=True))


# --- how long, and how far apart ------------------------------------------------------------------------------------

THREE = {  # a tool with what it needs besides; dt, steps and duration of the same run
    RUN: (['--method', 'leapfrog', '--every', '1'], '0.25', '28', '7'),
    ENERGY: (['--method', 'leapfrog'], '0.25', '400', '100'),
    ROUNDING: (['--method', 'rk4', '--sum', 'plain'], '0.125', '80000', '10000'),
    SCENE: (['--scene', 'cloth', '--method', 'leapfrog'], '0x1p-10', '256', '0.25'),
}


@pytest.mark.parametrize('tool', THREE)
def test_two_give_the_third(tool):
    """To the bit: the numbers are exact in binary."""
    args, dt, steps, duration = THREE[tool]
    runs = [table(tool, *args, *two) for two in (['--dt', dt, '--steps', steps], ['--dt', dt, '--duration', duration],
                                                 ['--steps', steps, '--duration', duration])]
    assert runs[0] == runs[1] == runs[2] and len(runs[0]) > 1


@pytest.mark.parametrize('tool', [RUN, SCENE])
def test_steps_are_rounded_and_that_is_said(tool):
    args, dt, steps, duration = THREE[tool]
    for part, more in ((-0.4, 0), (0.4, 0), (0.6, 1)):  # of a step
        asked = float(duration) + part * float.fromhex(dt if dt.startswith('0x') else float(dt).hex())
        result = run(tool, *args, '--dt', dt, '--duration', repr(asked))
        assert result.returncode == 0
        assert re.fullmatch(f'{tool}: {NOT_WHOLE}', result.stderr.rstrip('\n'))
        assert f'takes {int(steps) + more} and ends at ' in result.stderr
    assert 'whole number' not in run(tool, *args, '--dt', dt, '--duration', duration).stderr


@pytest.mark.parametrize('tool', [ENERGY, ROUNDING])
def test_rows_alone_say_where_a_run_ends(tool):
    """Before the duration, at a power of ten: nothing is said of the steps that it would take."""
    args, _, _, duration = THREE[tool]
    result = run(tool, *args, '--dt', '0.7', '--duration', duration)
    assert (result.returncode, result.stderr) == (0, '')


def test_rounding_to_a_default_step_is_remarked_on_if_the_duration_is_given():
    args = ['--scene', 'rope', '--method', 'leapfrog', '--fps']
    assert re.fullmatch(f'{SCENE}: {NOT_WHOLE}', run(SCENE, *args, '7', '--duration', '0.1').stderr.rstrip('\n'))
    for more in (['7', '--duration', '1'], ['7.3']):
        result = run(SCENE, *args, *more)
        assert (result.returncode, result.stderr) == (0, '')


def test_times_of_a_given_step_are_its_multiples():
    rows = table(RUN, '--method', 'exact', '--dt', '0.1', '--steps', '1000', '--every', '1')
    assert column(rows, 't_s') == [0.1 * i for i in range(1001)]
    assert max(abs(x - math.cos(0.1 * i)) for i, x in enumerate(column(rows, 'exact_x_m'))) <= 1e-14


def stable_step(method, *spring):
    """As the program says it: the number at the end of its remark on an enormous step."""
    said = run(RUN, '--method', method, *spring, '--dt', '1e3', '--steps', '1').stderr
    return float(re.search('not below the stable step of .* ([^ ]+) s$', said)[1])


@pytest.mark.parametrize('how', [*STEPPERS, STAGES])
def test_step_that_is_not_stable_is_remarked_on(how):
    """One that grows, here by more than double, and none that does not."""
    method, spring = how.split()[0], ['--stiffness', '2.7', '--damping', '0.6', '--mass', '1.3']
    limit = stable_step(method, *spring)
    start = ['--method', *how.split(), *spring, '--steps', '2000']
    below, above = (run(RUN, *start, '--dt', repr(limit * factor)) for factor in (0.99, 1.01))
    assert (below.stderr, 'stable step' in above.stderr, above.returncode) == ('', True, 0)
    assert float(parse(below.stdout)[0]['energy_J']) < 1 < float(parse(above.stdout)[0]['energy_J']) / 2


def test_method_that_is_never_stable():
    result = run(RUN, '--method', 'euler', '--dt', '1e-3', '--steps', '10')
    assert (result.returncode, result.stderr) == (0, 'spring-run: no step of euler is stable here\n')


# --- overflow -------------------------------------------------------------------------------------------------------

EXPLODES = ['--duration', '1e6', '--steps', '1000', '--every']


def euler_until_overflow():
    h, state = 1e6 / 1000, (1.0, 0.0)
    while math.isfinite(state[0] * state[0] + state[1] * state[1]):
        yield state
        state = (state[0] + h * state[1], state[1] - h * state[0])


@pytest.mark.parametrize('every', [1, 7, 1000])
def test_overflow(every):
    states = list(euler_until_overflow())
    result = run(RUN, '--method', 'euler', *EXPLODES, str(every))
    rows = parse(result.stdout)
    assert (result.returncode, [int(row['step']) for row in rows]) == (1, list(range(0, len(states), every)))
    assert (float(rows[-1]['x_m']), float(rows[-1]['v_m_per_s'])) == states[(len(states) - 1) // every * every]
    assert result.stderr.startswith('spring-run: ')
    assert f'step {len(states)},' in result.stderr and f't = {len(states)}000 s' in result.stderr


@pytest.mark.parametrize('args', ['--every 1', '', '--every 60'])
def test_energy_that_overflows_ends_the_run(args, tmp_path):
    """The state is still finite at the end: nothing but its energy tells."""
    path = tmp_path / 'rows.tsv'
    result = run(RUN, '--method', 'euler', '--duration', '70000', '--steps', '70', *args.split(), '-o', path)
    assert result.returncode == 1 and 'explodes' in result.stderr and 't = 52000 s' in result.stderr
    assert all(math.isfinite(energy) for energy in column(parse(path.read_text()), 'energy_J'))
