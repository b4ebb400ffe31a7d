# SPDX-License-Identifier: MIT
"""spring-energy: the energies of the study, and their theory."""
import math

import pytest
from tools import ENERGY, NEVER_STABLE, NOT_STABLE, STAGES, column, run, table

STUDY = {
    'euler': ['5.024831e-03', '5.258270e-02', '8.590730e-01', '1.100723e+04', '1.337355e+43'],
    'leapfrog --half-step-velocity': ['2.268005e-03', '2.287520e-03', '2.176101e-03', '2.312644e-03', '1.628639e-03'],
    'leapfrog': ['8.850965e-06', '3.699963e-06', '3.200530e-06', '8.594982e-06', '1.487909e-06'],
    STAGES: ['6.939449e-13', '6.943834e-12', '6.944789e-11', '6.944327e-10', '6.944331e-09'],
}


def energies(how, *remarks):
    """Without damping no step of Euler is stable."""
    return table(ENERGY, '--method', *how.split(), remarks=[NEVER_STABLE] if how.startswith('euler') else remarks)


@pytest.mark.parametrize('how', STUDY)
def test_study(how):
    rows = energies(f'{how} --duration 1e4')
    assert ['%.6e' % error for error in column(rows, 'energy_error_J')] == STUDY[how]
    velocity = 'half_step_ahead' if '--half-step-velocity' in how else 'synchronised'
    assert [(r['method'], r['velocity'], r['duration_s'], r['steps']) for r in rows] == [
        (how.split()[0], velocity, str(10**i), str(10**(i + 2))) for i in range(5)]


@pytest.mark.parametrize('how, name, want', [
    pytest.param('leapfrog --duration 9999', 'duration_s', ['1', '10', '100', '1000'], id='powers of ten'),
    pytest.param('leapfrog --duration 100 --dt 0.03', 'steps', ['33', '333', '3333'], id='whole steps, nearest'),
    pytest.param('exact --duration 100 --dt 0.06', 'steps', ['17', '167', '1667'], id='up as well as down'),
    pytest.param('exact --duration 100 --dt 3', 'steps', ['1', '3', '33'], id='at least one step'),
    pytest.param('rk4 --duration 1 --dt 10', 'duration_s', ['10'], id='the time that was run, of one step'),
    pytest.param('rk4 --duration 10 --dt 0.75', 'duration_s', ['0.75', '9.75'], id='the time that was run'),
])
def test_rows(how, name, want):
    remarks = [NOT_STABLE] if '--dt 10' in how else []
    assert [row[name] for row in energies(how, *remarks)] == want


def test_overflow_is_inf_with_status_0():
    assert [row['energy_error_J'] for row in energies('euler --duration 1e6')][5:] == ['inf', 'inf']


def test_state_that_overflows_has_infinite_energy():
    errors = column(energies('euler --duration 1e4 --dt 1'), 'energy_error_J')
    assert errors[3] < math.inf == errors[4]


def test_jitter_breaks_the_bound_of_leapfrog():
    fixed, varied = energies('leapfrog --dt 0.1 --duration 1e4'), energies('leapfrog --dt 0.1 --duration 1e4 --jitter')
    assert [row['steps'] for row in varied] == [row['steps'] for row in fixed]
    bound = 0.5 * 0.1**2 / 4
    assert max(column(fixed, 'energy_error_J')) <= bound < 10 * bound < float(varied[-1]['energy_error_J']) < 0.5
    assert energies('leapfrog --dt 0.1 --duration 1e4 --jitter') == varied


def test_longest_step_of_jitter_is_compared():
    """With the stable step, 2 s."""
    told = {dt: run(ENERGY, '--method', 'leapfrog', '--duration', '10', '--jitter', '--dt', dt).stderr for dt in ('1.33', '1.34')}
    assert told == {'1.33': '', '1.34': 'spring-energy: the step of 2.01 s is not below the stable step of leapfrog here, 2 s\n'}
