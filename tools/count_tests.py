# SPDX-License-Identifier: MIT
"""Counts the test cases of a Meson test run and says what was skipped, and why.

usage: count_tests.py BUILD/meson-logs

A program that speaks TAP counts once for each of its test points, every other program once. Meson writes the test
points to testlog.junit.xml, and to testlog.json what became of each program: one that broke off, or ran fewer points
than it had planned, is a failure although each of its points may have passed.
"""

import collections
import json
import pathlib
import re
import sys
import xml.etree.ElementTree


def reason(case):
    """Why a test point was skipped: its own explanation, or the one of a program that skipped as a whole."""
    text = case.findtext("system-out", default="")
    whole = re.search(r"^1\.\.0 *# *SKIP\S* *(.*)", text, re.IGNORECASE | re.MULTILINE)
    return whole.group(1) if whole else text.strip()


def outcome(case, name):
    """What became of one test point. To skip without a reason is to fail: a program that prints nothing does so."""
    if case.find("failure") is not None or case.find("error") is not None:
        return "failed"
    if case.find("skipped") is None:
        return "passed"
    if not reason(case):
        print(f"FAILED   {name}: skipped without a reason")
        return "failed"
    print(f"SKIPPED  {name}: {reason(case)}")
    return "skipped"


def main(logs):
    """Prints skips and failures that Meson does not show as such, and the counts."""
    counts = collections.Counter()
    failed_in = collections.Counter()
    for suite in xml.etree.ElementTree.parse(logs / "testlog.junit.xml").iter("testsuite"):
        _, points, program = suite.get("name").partition(".")  # project.program, or for plain programs the project
        for case in suite.iter("testcase"):
            name = f"{program}, {case.get('name')}" if points else case.get("name")
            result = outcome(case, name)
            counts[result] += 1
            failed_in[program or case.get("name")] += result == "failed"

    with open(logs / "testlog.json", encoding="utf-8") as lines:
        for program in map(json.loads, lines):
            if program["result"] not in ("OK", "SKIP", "EXPECTEDFAIL") and not failed_in[program["name"]]:
                print(f"FAILED   {program['name']}: {program['result']}, though none of its test points failed")
                counts["failed"] += 1

    print(f"{counts['passed']} passed, {counts['failed']} failed, {counts['skipped']} skipped")
    return counts["failed"] > 0 or counts["passed"] == 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
