# SPDX-License-Identifier: MIT
"""The table of methods. Every tool offers the methods of the table by their names."""
import pytest
from tools import (BENCH, ENERGY, MAP, ORDER, ROUNDING, RUN, SCENE, STABILITY, VALIDATE, WORK, choices, run,
                   table)

TABLE = table('spring-methods')


def methods(holds):
    return [row['method'] for row in TABLE if holds(row)]


SPRINGS = methods(lambda row: row['springs'] == '1')
STEPPERS = methods(lambda row: row['springs'] == '1' and row['order'] != '0')
SCENES = methods(lambda row: row['scenes'] == '1')


def test_columns():
    assert list(TABLE[0]) == 'method label order forces_per_step symplectic springs scenes'.split()
    assert len({row['method'] for row in TABLE}) == len({row['label'] for row in TABLE}) == len(TABLE)


@pytest.mark.parametrize('tool, offered', [(ORDER, SPRINGS), (RUN, SPRINGS), (ENERGY, SPRINGS), (ROUNDING, STEPPERS),
                                           (SCENE, SCENES), (MAP, SCENES)])
def test_offers(tool, offered):
    assert choices(tool, '--method') == offered
    assert f' {", ".join(offered)}\n' in run(tool, '--help').stdout


@pytest.mark.parametrize('method', SCENES)
def test_scene_moves_by_the_method_it_names(method):
    """Its stable step is that of the same method in spring-scene-map."""
    result = run(SCENE, *'--scene chain --duration 1 --fps 1'.split(), '--dt', '0.001', '--method', method)
    assert f'# method: {method}, ' in result.stdout
    stable, = (line.split()[-2] for line in result.stdout.splitlines() if line.startswith('# method: '))
    of_map, = {row['stable_step_s'] for row in table(MAP, '--quick', '--scene', 'chain', '--method', method)}
    assert stable == of_map


@pytest.mark.parametrize('tool, args, column, expected', [
    pytest.param(STABILITY, '--map --points 1', 'method', STEPPERS, id='spring-stability'),
    pytest.param(VALIDATE, '--case turning-point', 'method', SPRINGS, id='spring-validate, a spring'),
    pytest.param(VALIDATE, '--case pair', 'method', SCENES, id='spring-validate, a scene'),
    pytest.param(MAP, '--scene chain --quick', 'method', SCENES, id='spring-scene-map'),
    pytest.param(WORK, '--problem ideal-1 --quick', 'solver', SPRINGS, id='spring-work'),
])
def test_rows_of_every_method(tool, args, column, expected):
    found = {row[column] for row in table(tool, *args.split())}
    assert set(expected) <= found


def test_benchmarks_of_every_method():
    kernels = set(choices(BENCH, '--kernel'))
    assert {f'{m}{end}' for m in STEPPERS for end in ('', '_batch_1', '_batch_16')} <= kernels
    assert {f'{m}_sheet_16' for m in SCENES} <= kernels
