#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks that the test suite notices mistakes: makes each of them in a copy of the tree and runs the C tests.

usage: run.py [PATTERN]...
       run.py --texts   checks only that each text to be changed occurs once in its file, and that all changes compile

Makes the mistakes of mutants.tsv, or those whose name or file contains a PATTERN. Each must make the test that its row
names fail, or the case of the test, which then runs alone. Status 1 if one does not. The last line is "N passed, N failed,
N skipped".

Compiling takes longer than running. So the changed bodies of a function are compiled together with the original one, as
cases of a switch over the environment variable SPRING_MUTANT. A change outside of functions is compiled by itself.
"""

import concurrent.futures
import csv
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from typing import NamedTuple

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent

# Kernels of 16-byte vectors alone, and little optimisation: a quarter of the time to compile. Endless loops are
# undefined in C, and the compiler must not remove them.
OPTIONS = ["-Dtests=enabled", "-Dreport=disabled", "-Ddefault_library=static", "-Ddebug=false", "-Doptimization=1"]
FLAGS = "-w -fno-finite-loops -fwrapv -DSPRING_X86_64=0 -include {}/switch.h"

# Included first in each file. Weak symbols, since a program consists of many files; declared by hand, since a header would
# come before the feature macros of a file.
SWITCH = """
char *spring_getenv(const char *) __asm__("getenv");
int spring_atoi(const char *) __asm__("atoi");
__attribute__((weak)) int spring_mutant;
void spring_mutant_read(void);
__attribute__((weak, constructor)) void spring_mutant_read(void)
{
    const char *number = spring_getenv("SPRING_MUTANT");
    spring_mutant = number ? spring_atoi(number) : 0;
}
"""


# What a test program prints when a check fails, or at the end of a test in which one did.
FAILED = re.compile(r"# \S*/(?=\w+\.[ch]:\d+: )|not ok \d+ - ")


class Mutant(NamedTuple):
    name: str
    file: str
    test: str  # that must fail, or "test: case"
    start: int  # of the old text
    end: int
    new: str
    body: tuple  # start and end of the function's body, or None

    def apply(self, text):
        return text[: self.start] + self.new + text[self.end :]


class Program(NamedTuple):
    command: list
    targets: list  # for ninja
    tap: bool
    env: dict
    limit: int = 600  # [s] of processor time


class BuildFailed(Exception):
    pass


# ------------------------------------------------------------------------------------------------------- the mutants


def body_at(text, start):
    """The start and end of the body of the function at this offset, or None. In this layout its braces begin a line."""
    begin = text.rfind("\n{\n", 0, start) + 1
    end = text.find("\n}\n", begin) + 2
    return (begin, end) if 0 < begin <= start < end else None


def written_by_hand(patterns):
    with open(HERE / "mutants.tsv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader((line for line in file if not line.startswith("#")), delimiter="\t",
                                   quoting=csv.QUOTE_NONE))
    for row in rows:
        if patterns and not any(pattern in row["mistake"] or pattern in row["file"] for pattern in patterns):
            continue
        text = (ROOT / row["file"]).read_text(encoding="utf-8")
        found = list(re.finditer(r"\s+".join(map(re.escape, row["old"].split())), text))
        if len(found) != 1:
            sys.exit(f"mutants.tsv: {row['mistake']}: {row['file']} has this text {len(found)} times, expected once: "
                     f"{row['old']}")
        start, end = found[0].span()
        yield Mutant(row["mistake"], row["file"], row["test"], start, end, row["new"], body_at(text, start))


# ---------------------------------------------------------------------------------------------------------- programs


def failure_of(program, build, number=0):
    """What fails in a program, or "" if nothing does. The limit is of processor time, so a busy machine changes nothing."""
    points, plan = 0, None
    limited = ["sh", "-c", f'ulimit -t {program.limit} && exec "$@"', "sh", *program.command]
    with subprocess.Popen(limited, cwd=build, text=True, errors="replace", stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True,
                          env=os.environ | program.env | {"SPRING_MUTANT": str(number)}) as process:
        for line in process.stdout:
            if program.tap and FAILED.match(line):
                os.killpg(process.pid, signal.SIGKILL)
                return FAILED.sub("", line).strip()
            points += line.startswith("ok ")
            if line.startswith("1.."):
                plan = int(line[3:].split()[0])
    if process.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return "time limit"
    if process.returncode != 0:
        return f"status {process.returncode}"
    return "no complete plan" if program.tap and points != (plan or None) else ""


def compile_targets(build, programs):
    targets = {target for program in programs for target in program.targets}
    done = subprocess.run(["ninja", *targets], cwd=build, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          check=False)
    if done.returncode != 0:
        raise BuildFailed(done.stdout)


def configured(tree, tests):
    """The build folder of a tree, and the programs of these tests."""
    build = tree / "build"
    (tree / "switch.h").write_text(SWITCH, encoding="utf-8")
    done = subprocess.run(["meson", "setup", str(build), str(tree), *OPTIONS, f"-Dc_args={FLAGS.format(tree)}"],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(done.stdout + done.stderr)

    def introspect(what):
        return json.loads(subprocess.check_output(["meson", "introspect", f"--{what}", str(build)], text=True))

    built = {output for target in introspect("targets") for output in target["filename"]}
    how = {test["name"]: test for test in introspect("tests") if test["cmd"][0] in built}
    programs = {}
    for name in tests:
        test, _, case = name.partition(": ")
        if test not in how:
            sys.exit(f"mutants.tsv: no such test: {test}")
        command = how[test]["cmd"]
        targets = [os.path.relpath(build / word, build) for word in command if str(build / word) in built]
        programs[name] = Program(command, targets, how[test]["protocol"] == "tap", {"SPRING_CASE": case} if case else {})
    return build, programs


def with_limits(programs, build):
    """The programs, with limits from their time. Each must pass without a mutant."""

    def timed(name):
        start = time.monotonic()
        failure = failure_of(programs[name], build)
        if failure:
            sys.exit(f"run.py: {name} fails without a mutant: {failure}")
        return programs[name]._replace(limit=5 + round(2 * (time.monotonic() - start)))

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return dict(zip(programs, pool.map(timed, programs)))


# ----------------------------------------------------------------------------------------------------------- a build


def with_switches(text, mutants):
    """The text of a file, with all bodies of each function that is changed; mutants: by the number that selects them. Changes
    outside of functions are made for good. The compiler names the row in which it finds an error."""
    edits = [(mutant.start, mutant.end, mutant.new) for mutant in mutants.values() if not mutant.body]
    for start, end in {mutant.body for mutant in mutants.values() if mutant.body}:
        cases = ""
        for number, mutant in mutants.items():
            if mutant.body == (start, end):
                longer = len(mutant.new) - (mutant.end - mutant.start)
                cases += (f'case {number}: {{\n#line 1 "mutants.tsv: {mutant.name}"\n'
                          f"{mutant.apply(text)[start : end + longer]}\nbreak; }}\n")
        edits.append((start, end, f"{{ switch (spring_mutant) {{\n{cases}default: {{\n{text[start:end]}\nbreak; }} }} }}"))
    for start, end, new in sorted(edits, reverse=True):
        text = text[:start] + new + text[end:]
    return text


def write_switches(tree, mutants):
    for file in {mutant.file for mutant in mutants.values()}:
        text = (ROOT / file).read_text(encoding="utf-8")
        (tree / file).write_text(with_switches(text, {i: m for i, m in mutants.items() if m.file == file}),
                                 encoding="utf-8")


def failures(mutants, tree, build, programs):
    """What fails with each mutant, in their order; "" for those with which nothing does."""
    switched = {i: mutant for i, mutant in enumerate(mutants, 1) if mutant.body}
    write_switches(tree, switched)
    compile_targets(build, programs.values())
    programs = with_limits(programs, build)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(lambda i: failure_of(programs[switched[i].test], build, i), switched))
    found = dict(zip(switched, found))
    for i, mutant in enumerate(mutants, 1):
        if not mutant.body:
            path = tree / mutant.file
            kept = path.read_text(encoding="utf-8")
            path.write_text(mutant.apply((ROOT / mutant.file).read_text(encoding="utf-8")), encoding="utf-8")
            try:
                compile_targets(build, [programs[mutant.test]])
                found[i] = failure_of(programs[mutant.test], build)
            finally:
                path.write_text(kept, encoding="utf-8")
    return [found[i] for i in range(1, len(mutants) + 1)]


def check_texts():
    """Each text occurs once in its file, and all changes compile, together."""
    mutants = list(written_by_hand([]))
    print("1..2\nok 1 - each text to be changed occurs once")
    with tempfile.TemporaryDirectory(prefix="springstep-mutants-") as scratch:
        tree = pathlib.Path(scratch)
        for folder in ("include", "src", "tests", "tools"):
            shutil.copytree(ROOT / folder, tree / folder, ignore=shutil.ignore_patterns("node_modules"))
        (tree / "switch.h").write_text(SWITCH, encoding="utf-8")
        write_switches(tree, dict(enumerate(mutants, 1)))
        sources = {*tree.glob("src/*/*.c"), *(tree / mutant.file for mutant in mutants if mutant.file.endswith(".c"))}
        command = [*os.environ.get("CC", "cc").split(), "-std=c11", "-fsyntax-only", *FLAGS.format(tree).split(),
                   *(f"-I{tree / folder}" for folder in ("include", "src", "tests", "tools"))]

        def errors(source):
            done = subprocess.run([*command, source], capture_output=True, text=True, check=False)
            return done.stderr if done.returncode != 0 else ""

        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            found = "".join(pool.map(errors, sorted(sources)))
    print(re.sub("^", "# ", found.rstrip(), flags=re.M) + "\nnot ok" if found else "ok", "2 - all changes compile")
    return 1 if found else 0


def check_all(mutants, tree):
    build, programs = configured(tree, {mutant.test for mutant in mutants})
    failed = 0
    try:
        found = failures(mutants, tree, build, programs)
    except BuildFailed as error:
        print(f"{error}\nmutants.tsv: a mistake does not compile")
        found = [""] * len(mutants)
    for mutant, failure in zip(mutants, found):
        print(f"{mutant.name}\t{mutant.test}: {failure or 'PASSES'}", flush=True)
        failed += not failure
    print(f"{len(mutants) - failed} passed, {failed} failed, 0 skipped")
    return 1 if failed else 0


def main():
    patterns = sys.argv[1:]
    if patterns == ["--texts"]:
        return check_texts()
    if any(pattern.startswith("-") for pattern in patterns):
        print(__doc__)
        return 0 if patterns == ["--help"] else 2
    mutants = list(written_by_hand(patterns))
    if not mutants:
        sys.exit(f"run.py: {' '.join(patterns)}: no such mistake")
    with tempfile.TemporaryDirectory(prefix="springstep-mutants-") as scratch:
        tree = pathlib.Path(scratch).resolve() / "tree"
        shutil.copytree(ROOT, tree, symlinks=True, ignore=shutil.ignore_patterns("build*", ".git"))
        return check_all(mutants, tree)


if __name__ == "__main__":
    sys.exit(main())
