# SPDX-License-Identifier: MIT
"""spring-scene-map: accuracy of methods on scenes, by steps per frame."""
import itertools
import math

import pytest
from test_scene import SCENES
from tools import MAP, SCENE_STEPPERS, parse, table


@pytest.fixture(scope='module')
def quick():
    return table(MAP, '--quick')


def test_scenes_and_methods(quick):
    assert {(row['scene'], row['method']) for row in quick} == set(itertools.product(SCENES, SCENE_STEPPERS))
    assert {(row['scene'], (int(row['particles']), int(row['links']))) for row in quick} == set(SCENES.items())
    assert all(abs(float(row['dt_s']) * int(row['substeps']) * 60 - 1) <= 1e-15 for row in quick)


def test_verdicts(quick):
    for row in quick:
        assert (row['verdict'] == 'fine') == (float(row['energy_error']) <= 0.05)
        stable = float(row['dt_s']) / float(row['stable_step_s']) if float(row['stable_step_s']) > 0 else math.inf
        if stable < 1:
            assert row['verdict'] != 'exploded'
            # energy that comes and goes: with symplectic Euler z/2 of it, z = 2 at the stable step
            assert row['verdict'] != 'gaining' or float(row['energy_error']) <= stable


def test_part_is_the_part(quick):
    assert table(MAP, '--quick', '--scene', 'jelly', '--method', 'rk4') == [
        row for row in quick if (row['scene'], row['method']) == ('jelly', 'rk4')]


def test_time(quick, tmp_path):
    """The numbers of steps that are timed; the times themselves are not checked."""
    verdicts = {}
    for row in quick:
        if row['scene'] == 'rope':
            verdicts.setdefault(row['method'], {})[int(row['substeps'])] = row['verdict']
    further = tmp_path / 'map.tsv'
    rows = table(MAP, '--quick', '--time', '--scene', 'rope', '--map', further)
    assert parse(further.read_text()) == [row for row in quick if row['scene'] == 'rope']
    assert [row['method'] for row in rows] == [method for method, of in verdicts.items() if of[64] == 'fine']
    for row in rows:
        of = verdicts[row['method']]
        below = math.floor(1 / 60 / float(row['stable_step_s'])) + 1
        assert int(row['substeps']) == min(
            n for n in of if n >= below and all(verdict == 'fine' for k, verdict in of.items() if k >= n))
        assert abs(float(row['particles_per_ms']) * float(row['frame_ms']) / int(row['particles']) - 1) <= 1e-3


def test_euler_explodes(quick):
    verdicts = {row['verdict'] for row in quick if row['method'] == 'euler' and row['scene'] != 'chain'}
    assert verdicts == {'exploded'}
