# SPDX-License-Identifier: MIT
"""spring-engines: a table of the library compared with physics engines. Speeds are not tested."""
import pytest
from tools import ENGINES, parse, run


@pytest.mark.parametrize('engine', ['bullet', 'chipmunk'])
def test_rows(engine):
    result = run(ENGINES, '--quick', '--engine', engine)  # an engine may say what it likes on standard error
    assert result.returncode == 0
    rows = parse(result.stdout)
    assert [(row['engine'], row['links'], row['substeps']) for row in rows] == [
        (engine, links, '16') for links in ('6868', '96520')]
    for row in rows:
        speedup, theirs, ours = (float(row[name]) for name in ('speedup', 'engine_ns', 'our_ns'))
        assert theirs > 0 and ours > 0 and abs(speedup - theirs / ours) <= 2e-3 * speedup
        assert row['precision'] in ('double', 'float') and row['verdict'] in ('ok', 'noisy', 'above_goal')
