# SPDX-License-Identifier: MIT
"""Counts the test cases of a Meson test run, and prints the failed ones, and the skipped ones with their reasons.

usage: count_tests.py BUILD/meson-logs

A TAP program counts once for each of its test points, pytest once for each of its cases, and every other program once.
Meson writes the cases to testlog.junit.xml, and the result of each program to testlog.json. A program that ended early,
or ran fewer points than planned, is a failure, even if each of its points passed.
"""

import collections
import json
import pathlib
import re
import sys
import xml.etree.ElementTree

NO_REASON = "", "Skipped", "unconditional skip"  # as pytest words it


def outcome(case, name):
    """The result of a case. A skip without a reason is a failure, since a program without output looks the same."""
    if case.find("failure") is not None or case.find("error") is not None:
        print(f"FAILED   {name}")
        return "failed"
    skipped = case.find("skipped")
    if skipped is None:
        return "passed"
    said = skipped.get("message", case.findtext("system-out", default="").strip())
    whole_program = re.search(r"^1\.\.0 *# *SKIP\S* *(.*)", said, re.IGNORECASE | re.MULTILINE)
    reason = whole_program.group(1) if whole_program else said
    if reason in NO_REASON:
        print(f"FAILED   {name}: skipped without a reason")
        return "failed"
    print(f"SKIPPED  {name}: {reason}")
    return "skipped"


logs = pathlib.Path(sys.argv[1])
counts = collections.Counter()
have_failed = set()
for suite in xml.etree.ElementTree.parse(logs / "testlog.junit.xml").iter("testsuite"):
    program = suite.get("name").partition(".")[2].removesuffix(".pytest")  # after the project; none for plain programs
    for case in suite.iter("testcase"):
        result = outcome(case, f"{program} {case.get('name')}".strip())
        counts[result] += 1
        if result == "failed":
            have_failed.add(program or case.get("name"))
for program in map(json.loads, open(logs / "testlog.json", encoding="utf-8")):
    if program["result"] not in ("OK", "SKIP", "EXPECTEDFAIL") and program["name"] not in have_failed:
        print(f"FAILED   {program['name']}: {program['result']}, though no case of it failed")
        counts["failed"] += 1
print(f"{counts['passed']} passed, {counts['failed']} failed, {counts['skipped']} skipped")
sys.exit(counts["failed"] > 0 or counts["passed"] == 0)
