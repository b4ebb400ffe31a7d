# SPDX-License-Identifier: MIT
"""One short run of every program."""
from tools import EVERY, every_tool, parse, run


@every_tool
def test_a_short_run_prints_a_table(tool):
    result = run(tool, *EVERY[tool])
    assert (result.returncode, result.stderr) == (0, '')
    assert parse(result.stdout)
