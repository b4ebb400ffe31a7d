# SPDX-License-Identifier: MIT
"""spring-order: errors of the study, fits, the number of steps for an error."""
import math

import pytest
from tools import ORDER, STAGES, STEPPERS, column, run, table


def fit_line(rows):
    x, y = [math.log(n) for n in column(rows, 'n')], [math.log(e) for e in column(rows, 'error_m')]
    mx, my = math.fsum(x) / len(x), math.fsum(y) / len(y)
    slope = math.fsum((a - mx) * (b - my) for a, b in zip(x, y)) / math.fsum((a - mx) ** 2 for a in x)
    return math.exp(my - slope * mx), slope


STUDY = {  # first row and number of rows, the fit, the error for n = 10, error constant, evaluations a step
    'euler': (10, 1000, '0.2764 n^-1.0026', '3.048814e-02', math.cos(1) / 2, 1),
    'leapfrog': (10, 1000, '0.03506 n^-2.0000', '3.510549e-04', math.sin(1) / 24, 1),
    STAGES: (5, 200, '0.006763 n^-3.9949', '6.612487e-07', math.sin(1) / 120, 4),
}


@pytest.mark.parametrize('how', STUDY)
def test_study(how):
    first, points, law, error_10, coefficient, cost = STUDY[how]
    rows = table(ORDER, '--method', *how.split())
    assert [(int(row['n']), int(row['force_evaluations'])) for row in rows] == [
        (n, cost * n) for n in range(first, first * points + 1, first)]
    assert ['%.6e' % float(row['error_m']) for row in rows if row['n'] == '10'] == [error_10]
    fit, = table(ORDER, '--method', *how.split(), '--fit')
    assert '%.4g n^%.4f' % (float(fit['coefficient_m']), float(fit['exponent'])) == law
    assert abs(float(fit['theory_coefficient_m']) - coefficient) <= 1e-16


@pytest.mark.parametrize('how', [*STEPPERS, STAGES])
def test_rows_and_fit(how):
    rows = table(ORDER, '--method', *how.split())
    assert all((row['method'], float(row['dt_s'])) == (how.split()[0], 1 / int(row['n'])) for row in rows)
    fit, = table(ORDER, '--method', *how.split(), '--fit')
    coefficient, exponent = fit_line(rows)
    assert abs(float(fit['coefficient_m']) / coefficient - 1) <= 1e-10
    assert abs(float(fit['exponent']) - exponent) <= 1e-11
    assert 0.9998 < float(fit['r_squared']) <= 1 and fit['points'] == str(len(rows))


# --- --match-error --------------------------------------------------------------------------------------------------

@pytest.mark.parametrize('method, n, first', [('leapfrog', '34766', '630'), ('rk4', '3719', '1605')])
def test_as_accurate_as_eulers_1e7_steps(method, n, first):
    row, = table(ORDER, '--method', method, '--duration', '1000', '--match-error', '2.88367e-2')
    assert (row['n'], row['first_n']) == (n, first)


@pytest.mark.parametrize('method, error, most', [('euler', 0.3, 3000), ('leapfrog', 1e-3, 4000), ('rk4', 1e-6, 1500),
                                                 ('leapfrog', 0.5, 400)])
def test_match_error_among_all_errors(method, error, most):
    how = ['--method', method, '--duration', '10']
    row, = table(ORDER, *how, '--match-error', str(error))
    rows = table(ORDER, *how, '--n-min', '1', '--n-step', '1', '--n-max', str(most))
    errors = {int(r['n']): float(r['error_m']) for r in rows}
    beyond = max(n for n, e in errors.items() if e > error)
    first = min(n for n, e in errors.items() if e <= error)
    assert (int(row['n']), int(row['first_n'])) == (beyond + 1, first)
    assert float(row['error_m']) == errors[beyond + 1] <= error < errors[beyond] == float(row['previous_error_m'])
    assert float(row['match_error_m']) == error


# --- what cannot be computed ----------------------------------------------------------------------------------------

@pytest.mark.parametrize('args, message', [
    pytest.param('--method rk4 --match-error 1e-17', 'rounding', id='rk4: an error below rounding'),
    pytest.param('--method leapfrog --match-error 1e-13', 'rounding', id='leapfrog: an error below rounding'),
    pytest.param('--method rk4 --match-error 1 --duration 1e300', 'rounding', id='a time beyond all phases'),
    pytest.param('--method rk4 --n-min 2000 --n-max 4000 --n-step 1 --fit', 'the error is 0', id='a fit of no error'),
    pytest.param('--method rk4 --duration 1e9 --n-max 5000', 'steps of', id='overflow'),
])
def test_fails(args, message):
    result = run(ORDER, *args.split())
    assert result.returncode == 1 and message in result.stderr
