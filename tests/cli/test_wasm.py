# SPDX-License-Identifier: MIT
"""tools/bench/wasm/run: WebAssembly and plain JavaScript give the same motion. Speeds are not tested."""
import pathlib

import pytest
from tools import parse, run

RUN = pathlib.Path(__file__).parents[2] / 'tools/bench/wasm/run'


def test_rows():
    """Without SIMD and with it; all flags that it tries without being told take four times as long to compile."""
    flags = ['-O2', '-O2 -msimd128']
    result = run(RUN, '--quick', *flags, timeout=280)
    if result.returncode == 3:
        pytest.skip(result.stderr)
    assert (result.returncode, result.stderr) == (0, '')
    rows = parse(result.stdout)
    assert [(row['flags'], row['scene']) for row in rows] == [(f, scene) for f in flags for scene in ('cloth', 'water')]
    assert all(float(row[name]) > 0 for row in rows for name in ('library_ns_per_link_step', 'plain_ns_per_link_step'))


def test_usage():
    result = run(RUN, '--slowly')
    assert (result.returncode, result.stdout) == (2, '')
    assert result.stderr.startswith('usage: ')
