# SPDX-License-Identifier: MIT
"""tools/bench/instructions: errors, and its table of cycles if llvm-mca is installed."""
import pathlib
import shutil

import pytest
from tools import parse, run

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / 'tools' / 'bench' / 'instructions'


@pytest.mark.parametrize('args', [[], ['--cycle'], ['--help'], ['--cycles', 'leapfrog', 'rk4']])
def test_usage(args):
    result = run(SCRIPT, *args)
    assert (result.returncode, result.stdout) == (2, '')
    assert result.stderr.startswith('usage: tools/bench/instructions BUILD-DIRECTORY')


@pytest.mark.parametrize('args, wanted', [(['--cycles'], 'requires llvm-mca, from Debian\'s package llvm'),
                                          (['build'], 'requires valgrind, from Debian\'s package valgrind')])
def test_what_is_missing_is_named(args, wanted, tmp_path):
    for command in 'bash', 'dirname':
        (tmp_path / command).symlink_to(shutil.which(command))
    result = run(shutil.which('bash'), SCRIPT, *args, env={'PATH': str(tmp_path)})
    assert (result.returncode, result.stdout) == (3, '')
    assert result.stderr == f'tools/bench/instructions: {wanted}\n'


@pytest.mark.skipif(None in map(shutil.which, ['llvm-mca', 'aarch64-linux-gnu-gcc']),
                    reason='llvm-mca or aarch64-linux-gnu-gcc is not installed')
def test_cycles():
    """Every vector length, precision and vendor; a spring or link takes some cycles, and not hundreds."""
    result = run(SCRIPT, '--cycles', '^(advance_springs|tile_on_3_axes)$', timeout=250)
    assert (result.returncode, result.stderr) == (0, '')
    assert f"# command: tools/bench/instructions --cycles '^(advance_springs|tile_on_3_axes)$'\n" in result.stdout
    rows = parse(result.stdout)
    assert list(rows[0]) == 'loop vector precision processor item cycles_per_item at_once'.split()
    for item in 'spring', 'link':
        of_item = [row for row in rows if row['item'] == item]
        assert {(row['vector'], row['precision']) for row in of_item} == {
            (vector, precision) for vector in ('128', '256', '512') for precision in ('double', 'float')}
        assert len({row['processor'] for row in of_item}) >= 3
        assert all(0.05 < float(row['cycles_per_item']) < 200 and int(row['at_once']) > 1 for row in of_item)
