# SPDX-License-Identifier: MIT
"""spring-work and spring-bench: their measurements and verdicts. Times are not tested."""
import functools
import math

import pytest
from tools import BENCH, METHODS, SCENE_STEPPERS, WORK, is_failure, parse, run, table

OURS = {*METHODS, *SCENE_STEPPERS}
NO_PEERS = {'leapfrog-softened', 'xpbd', 'bdf2-cg', 'projective'}

# --- spring-work ----------------------------------------------------------------------------------------------------

@pytest.fixture(scope='module', params=['ideal-1', 'elastic-pendulum'])
def work(request, tmp_path_factory):
    """A problem, its rows, and its table as text."""
    path = tmp_path_factory.mktemp('work') / 'table.tsv'
    forces = path.with_name('forces.tsv')
    rows = table(WORK, '--problem', request.param, '--quick', '--table', path, '--forces', forces)
    return request.param, rows, path.read_text(), parse(forces.read_text())


def test_work_rows(work):
    problem, rows, *_ = work
    fixed = 'problem solver steps force_evaluations time_s error'.split()
    assert list(rows[0])[:len(fixed)] == fixed
    assert {row['problem'] for row in rows} == {problem}
    assert all(row[name].isdecimal() for row in rows for name in ('steps', 'force_evaluations'))
    assert all(float(row['time_s']) > 0 and 0 <= float(row['error']) <= 3 for row in rows)
    exact = [row['force_evaluations'] for row in rows if row['solver'] == 'exact']
    assert exact == (['0'] if problem == 'ideal-1' else [])


def test_stamp_of_the_table(work, tmp_path_factory):
    text = work[2]
    assert str(tmp_path_factory.getbasetemp()) not in text
    assert [what for what in ('compiler', 'flags', 'processor', 'load', 'gsl', 'sundials', 'odeint') if f'# {what}:' not in text] == []


def test_forces(work):
    problem, _, _, forces = work
    assert [(row['problem'], row['evaluation'], row['links']) for row in forces] == [
        (problem, who, '1') for who in ('springstep', 'others')]
    ours, *_ = times = [float(row['time_ns']) for row in forces]
    assert min(times) > 0 and all(about(float(row['ratio']), time / ours) for row, time in zip(forces, times))


def cheapest(rows, error, among):
    """Time, and by whom, among the rows with stable steps that are exact enough, and so is the next finer one."""
    sweep = [row for row in rows if row['effort'] == 'sweep' and among(row['solver'])]
    finer = [b if a['solver'] == b['solver'] else a for a, b in zip(sweep, [*sweep[1:], sweep[-1]])]
    times = [(float(row['time_s']), row['solver']) for row, next_one in zip(sweep, finer)
             if max(float(row['error']), float(next_one['error'])) <= error and not float(row['stable_fraction']) >= 1]
    least = min(times, default=(math.nan, ''))[0]
    return f'{least:.4g}', {solver for time, solver in times if time == least} or {'none'}


def test_levels_of_the_table(work):
    problem, rows, text, _ = work
    levels = parse(text)
    assert [(row['problem'], row['error']) for row in levels] == [(problem, f'1e-{n}') for n in range(1, 13)]
    for row in levels:
        for solver, time, among in (('solver', 'time_s', lambda name: name in OURS - {'exact'}),
                                    ('peer', 'peer_time_s', lambda name: name not in OURS | NO_PEERS)):
            least, names = cheapest(rows, float(row['error']), among)
            assert row[time] == least and row[solver] in names
        ratio = float(row['peer_time_s']) / float(row['time_s'])
        assert math.isnan(ratio) == (row['ratio'] == 'nan') and not abs(float(row['ratio']) - ratio) > 2e-3 * ratio


def test_the_cape(tmp_path):
    """More steps stretch less, nothing is inside the figure at last, and all settings have a time at equal stretch."""
    path = tmp_path / 'equal.tsv'
    rows = table(WORK, '--problem', 'cape', '--quick', '--table', path)
    runs = [row for row in rows if row['effort'] == 'steps']
    assert {row['solver'] for row in runs} == {'leapfrog', 'xpbd-mesh', 'xpbd-sheet'}
    for few, many in zip(runs[::2], runs[1::2], strict=True):
        assert few['solver'] == many['solver'] and int(few['steps_per_frame']) < int(many['steps_per_frame'])
        assert 0 < float(many['column_stretch']) < float(few['column_stretch']) < 1
    for row in rows:
        assert float(row['column_stretch']) < float(row['link_stretch'])
        # Between the legs, XPBD moves a particle out of one leg into the other, by 1 cm: a particle has 2 cm, the gap 1 cm. Leapfrog's
        # are outside, up to the motion of a body that is not uniform.
        deepest = 0.001 if row['solver'] == 'leapfrog' else 0.012
        assert row['effort'] == 'no-figure' or float(row['depth_m']) < deepest, row
        assert float(row['time_us']) > 0 and float(row['kinetic_J']) > 1
        assert float(row['jitter_mps']) < 0.05, 'at rest after ten seconds'
    equal = parse(path.read_text())
    assert len(equal) == len(runs) and {row['stretch'] for row in equal} == {'0.06', '0.03'}


def test_the_rules_for_steps():
    """The rules of scene.h keep the energy, and some longer steps do not."""
    rows = table(WORK, '--problem', 'steps', '--quick')
    for row in rows:
        damped, rope = 'damped' in row['motion'], 'rope' in row['motion']
        small, tension, dragged = 'small' in row['motion'], 'tension' in row['motion'], float(row['drag_per_mass']) > 0
        rule = 0.9 if damped or (dragged and not rope) else 0.5 if dragged or small else 0.1 if tension else 0.25
        rule *= 0.5 if tension and (damped or dragged) else 1
        assert float(row['fraction']) > rule or float(row['energy_gain']) < 0.1, row
    assert any(float(row['energy_gain']) > 1e3 for row in rows if row['fraction'] == '0.9')


@pytest.mark.parametrize('args, option', [('cape --forces f', '--forces'), ('cape --long f', '--long'), ('steps --table f', '--table')])
def test_tables_of_other_problems(tmp_path, args, option):
    done = run(WORK, '--quick', '--problem', *args.split(), cwd=tmp_path)
    is_failure(done, 2, option)


# --- spring-bench ---------------------------------------------------------------------------------------------------

@functools.cache
def bench(args):
    return table(BENCH, '--quick', *args.split())


def about(got, want):
    """Of figures with four digits."""
    return abs(got - want) <= 2e-3 * abs(got)


@pytest.mark.parametrize('args', ['--part batch --count 1000', '--kernel leapfrog_batch_16',
                                  '--part spring --kernel rk4', '--part scene --count 7002',
                                  '--kernel leapfrog_rope_1'])
def test_bench_rows(args):
    fixed = 'kernel precision count ns_per_spring_step limit_ns ratio spread verdict'.split()
    rows = bench(args)
    assert list(rows[0])[:len(fixed)] == fixed
    for row in rows:
        time, limit, ratio, spread = (float(row[n]) for n in ('ns_per_spring_step', 'limit_ns', 'ratio', 'spread'))
        baseline, speedup = (float(row[name]) for name in ('baseline_ns', 'speedup'))
        goal_ratio, goal_time, goal_speedup = (float(row[name]) for name in ('goal_ratio', 'goal_ns', 'goal_speedup'))
        assert time > 0 and limit > 0 and about(ratio, time / limit)
        assert (math.isnan(speedup) and math.isnan(baseline)) or about(speedup, baseline / time)
        if spread != 0.05:
            assert (row['verdict'] == 'noisy') == (spread > 0.05)
        step, goal_excess = float(row['step_ns']), float(row['goal_excess_ns'])
        assert about(step, time * int(row['count']))
        excess = max(ratio / goal_ratio, time / goal_time, 0 if math.isnan(speedup) else goal_speedup / speedup)
        known = not about(1, excess)
        if goal_excess > 0: # a difference of figures with four digits
            further = step - limit * int(row['count'])
            excess = max(excess, further / goal_excess)
            known = known and abs(further - goal_excess) > 2e-3 * step
        if row['verdict'] != 'noisy' and known:
            assert (row['verdict'] == 'above_goal') == (excess > 1)


def test_bench_ropes():
    """Of few particles, which games have most: compared with a plain loop, and one step a call compared with sixteen."""
    for steps, limits in (16, {'streams', 'arithmetic'}), (1, {'16_steps'}):
        rows = bench(f'--kernel leapfrog_rope_{steps}')
        assert [int(row['count']) for row in rows] == [1, 2, 3, 7, 15, 31, 63]
        assert {row['limit'] for row in rows} <= limits
        assert 'nan' not in {row['speedup'] for row in rows}


def test_bench_calls_measures_nothing():
    assert bench('--calls 1 --count 1000') == []


def test_stiff_rope(tmp_path):
    """Solvers without stability limit start with a step per frame. Accurate solvers agree on long runs, and conserve energy."""
    path = tmp_path / 'long.tsv'
    rows = table(WORK, '--quick', '--problem', 'stiff-rope', '--long', path)
    runs = {solver: [row for row in rows if row['solver'] == solver] for solver in NO_PEERS}
    for first, *more in runs.values():
        assert first['steps'] == '15' and float(first['stretch']) > 0 and float(first['energy_error']) > 0
        assert all(float(row['error']) < float(first['error']) for row in more[-1:])  # under sanitizers, one run may take all time
    assert any(len(run) > 1 for run in runs.values())
    reference, *rows = parse(path.read_text())
    assert reference['solver'] == 'reference' and float(reference['error_500ms']) < 1e-6
    assert {row['solver'] for row in rows} >= {*SCENE_STEPPERS, *NO_PEERS} - {'euler'}
    best = [row for row in rows if row['solver'] in ('rkn8', 'srkn6') and row['steps_per_frame'] == '32']
    assert len(best) == 2 and all(abs(float(row['energy_change'])) < 1e-4 and float(row['error_1s']) < 1e-5 for row in best)
    assert all(abs(float(best[0][name]) - float(best[1][name])) < 1e-3 for name in ('sag_m', 'stretch_99'))
    assert all(float(row['frame_s']) > 0 and float(row['stretch_99']) <= float(row['stretch']) for row in rows)
