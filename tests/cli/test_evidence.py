# SPDX-License-Identifier: MIT
"""spring-validate, spring-stability, spring-rounding: checks, stability limits, rounding errors."""
import math
import sys

import pytest
from tools import CONTACTS, ROUNDING, STABILITY, STEPPERS, VALIDATE, column, table

# --- spring-validate ------------------------------------------------------------------------------------------------

MODES, KINDS = ['1-1', '2-1', '2-2', '3-1'], ['structural', 'mirrored', 'all']
SLOW = ['billion-steps', 'chaotic-50', 'van-der-pol-5', 'stiff-and-soft-10', 'heavy-end', 'stiff-links', 'cloth',
        'water', 'chain-1000', *(f'water-mode-{mode}-{kind}-{n}' for n in (25, 35) for mode in MODES for kind in KINDS)]


@pytest.fixture(scope='module')
def quick():
    return table(VALIDATE, '--quick')


def test_list(quick):
    rows = table(VALIDATE, '--list')
    names = [row['case'] for row in rows]
    assert len(set(names)) == len(names) >= 25 and all(row['purpose'] for row in rows)
    cases = {row['case'] for row in quick}
    assert [name for name in names if name not in cases] == SLOW


def test_quick_has_every_witness(quick):
    assert {row['shape'] for row in quick} == {'spring', 'scene'}
    assert {row['witness'] for row in quick} == {
        'iterate', 'solution', 'drive', 'gsl-rk4', 'arkode-rk4', 'gsl-rk8pd', 'cvode-adams', 'cvode-bdf', 'definition',
        'modes', 'reduced-mass', 'digits', 'formula', 'dispersion'}


def test_one_case(quick):
    assert table(VALIDATE, '--case', 'middle') == [row for row in quick if row['case'] == 'middle']


# --- spring-contacts ------------------------------------------------------------------------------------------------

@pytest.fixture(scope='module')
def contacts():
    return table(CONTACTS, '--quick')


def errors_of(contacts, case, scheme):
    """By steps per frame."""
    rows = [row for row in contacts if (row['case'], row['scheme']) == (case, scheme)]
    return {round(1 / 60 / float(row['dt_s'])): float(row['error']) for row in rows}


@pytest.mark.parametrize('case, steps, bound', [  # a factor of two above the prototype of the scheme
    ('bounce', 8, 3e-5), ('sphere', 4, 5e-5), ('creep', 4, 0), ('slide', 4, 1e-12), ('capstan', 8, 5e-3), ('capstan', 16, 5e-3),
    ('block-1', 4, 4e-4), ('block-3', 4, 7e-4), ('bat', 4, 5e-5), ('turning-plane', 4, 2e-4), ('turntable', 16, 1e-11),
    ('plate-80', 4, 0), ('plate-500', 4, 0)])
def test_contacts_of_the_library(contacts, case, steps, bound):
    assert errors_of(contacts, case, 'library')[steps] <= bound


def test_schemes_of_engines_are_of_lower_order(contacts):
    """The simple schemes are what they say: projection has order 1, penalty springs are passed by a fast plate."""
    for case in ('spring-on-plane', 'sphere'):
        library, projection = (errors_of(contacts, case, scheme) for scheme in ('library', 'projection'))
        assert abs(math.log2(projection[4] / projection[16]) / 2 - 1) <= 0.15
        assert math.log2(library[4] / library[16]) / 2 >= 1.7
        assert all(library[steps] < projection[steps] / 50 for steps in library)
    for case in ('block-1', 'block-2', 'block-3', 'turning-plane'):
        library = errors_of(contacts, case, 'library')
        assert math.log2(library[4] / library[16]) / 2 >= 1.9
    assert min(errors_of(contacts, 'plate-500', scheme)[4] for scheme in ('projection', 'penalty')) > 900
    assert errors_of(contacts, 'creep', 'penalty')[4] > 1e-4


def test_energy_of_bounces():
    """Close to the stable step: without any loss it grows, otherwise it never exceeds the start."""
    rows = table(CONTACTS, '--part', 'energy', '--quick')
    for row in rows:
        lossless = float(row['restitution']) == 1 and float(row['damping_Ns_per_m']) == 0
        assert (float(row['largest_energy']) > 1.02) == lossless and 1 <= float(row['largest_energy']) < 10
    assert len(rows) == 5


def test_list_of_contacts(contacts):
    assert [row['case'] for row in table(CONTACTS, '--part', 'list')] == list(dict.fromkeys(row['case'] for row in contacts))


# --- spring-stability -----------------------------------------------------------------------------------------------

@pytest.fixture(scope='module')
def limits():
    return table(STABILITY, '--points', '3')


def test_rows(limits):
    assert list(limits[0]) == 'method damping_ratio limit_measured limit_theory relative_error'.split()
    assert [(row['method'], float(row['damping_ratio'])) for row in limits] == [
        (method, zeta) for method in STEPPERS for zeta in (0, 0.01, 1, 100)]
    assert max(column(limits, 'relative_error')) <= 1e-4


def test_map(limits):
    cells = table(STABILITY, '--map', '--points', '9')
    assert len(cells) == len(STEPPERS) * 9 * 9
    errors = {(r['method'], *(round(math.log10(float(r[name])), 3) for name in ('omega_dt', 'damping_ratio'))):
              float(r['error']) for r in cells}
    assert errors['rk4', -2, -1] < errors['leapfrog', -2, -1] < errors['euler', -2, -1] < 1
    beyond = [r['method'] for r in limits if float(r['damping_ratio']) == 100 and float(r['limit_measured']) < 10]
    assert {'euler', 'leapfrog', 'rk4'} <= set(beyond)
    assert min(errors[method, 1, 2] for method in beyond) > 1e3


# --- spring-rounding ------------------------------------------------------------------------------------------------

@pytest.fixture(scope='module')
def leapfrog():
    """By kind of sum, with a step that is a power of two."""
    return {kind: table(ROUNDING, '--method', 'leapfrog', '--dt', '0x1p-7', '--sum', kind, '--steps', '1e5')
            for kind in ('plain', 'compensated')}


@pytest.mark.parametrize('kind', ['plain', 'compensated'])
def test_power_of_two_rounds_no_coefficient(kind, leapfrog):
    assert [(int(row['steps']), int(row['start'])) for row in leapfrog[kind]] == [
        (n, i) for n in (10000, 30000, 100000) for i in range(8)]
    assert {row['coefficient_error'] for row in leapfrog[kind]} == {'0'}


@pytest.mark.parametrize('name', ['state_error', 'energy_error'])
def test_compensated_sums(name, leapfrog):
    plain, better = (column(rows, name) for rows in leapfrog.values())
    assert all(error <= n * 2 * sys.float_info.epsilon for n, error in zip(column(leapfrog['plain'], 'steps'), plain))
    assert max(better) <= max(plain) / 10


@pytest.mark.parametrize('method', ['leapfrog', 'rk4'])
def test_with_a_decimal_step_the_coefficient_it_is(method):
    rows = table(ROUNDING, '--method', method, '--sum', 'compensated', '--steps', '1e6')[-8:]
    assert max(abs(float(row['state_error']) / float(row['coefficient_error']) - 1) for row in rows) <= 0.05
