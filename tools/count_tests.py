# SPDX-License-Identifier: MIT
"""Counts the test cases of a Meson test run and says what was skipped, and why.

usage: count_tests.py BUILD/meson-logs

A program that speaks TAP counts once for each of its test points, every other program once. Meson writes the test
points to testlog.junit.xml, and to testlog.json what became of each program: one that broke off, or ran fewer points
than it had planned, is a failure although each of its points may have passed.
"""

import json
import pathlib
import re
import sys
import xml.etree.ElementTree

GOOD = ("OK", "EXPECTEDFAIL")


def outcome(case):
    """What became of one test point."""
    if case.find("failure") is not None or case.find("error") is not None:
        return "failed"
    return "skipped" if case.find("skipped") is not None else "passed"


def reason(case):
    """Why a test point was skipped: its own explanation, or the one of a program that skipped as a whole."""
    text = case.findtext("system-out", default="")
    whole = re.search(r"^1\.\.0 *# *SKIP\S* *(.*)", text, re.IGNORECASE | re.MULTILINE)
    return (whole.group(1) if whole else text.strip()) or "no reason given"


def main(logs):
    count = {"passed": 0, "failed": 0, "skipped": 0}
    programs_with_failures = set()
    for case in xml.etree.ElementTree.parse(logs / "testlog.junit.xml").iter("testcase"):
        name = "{classname}: {name}".format(**case.attrib)
        result = outcome(case)
        count[result] += 1
        if result == "failed":
            programs_with_failures.update((case.get("classname"), case.get("name")))
        if result == "skipped":
            print(f"SKIPPED  {name}: {reason(case)}")

    with open(logs / "testlog.json", encoding="utf-8") as lines:
        for program in map(json.loads, lines):
            name = program["name"].split(" / ")[-1]
            known = any(p and p.split(".")[-1] == name for p in programs_with_failures)
            if program["result"] not in GOOD + ("SKIP",) and not known:
                print(f"FAILED   {name}: {program['result']}, though each of its test points passed")
                count["failed"] += 1

    print("{passed} passed, {failed} failed, {skipped} skipped".format(**count))
    return count["failed"] > 0 or count["passed"] == 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
