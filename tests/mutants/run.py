#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Applies mutants one at a time to a copy of the tree and runs the quick suite until a program fails.

usage: run.py [--sample] [--new TABLE] [-o FILE] [PATTERN]...
       run.py --merge TABLE... [-o FILE]

  --sample      of the mutants in mutants.tsv a fixed 14th of those written by hand, a fixed 90th of the generated
  --new TABLE   only mutants that have no row in TABLE
  -o FILE       write the table to FILE instead of standard output
  PATTERN       only mutants whose names contain one of these
  --merge       run nothing: of each mutant that there is, the last row among the TABLEs, judged as after a run

The mutants are those of generate.py and of by_hand.toml. mutants.tsv beside this file is the table which the report
shows; it is merged of several runs. Columns: mutant, by (generator or hand), killed_by (program and test point), verdict
(killed, equivalent, survived), reason (why it is equivalent, or what was meant to break), caught_by_validate (does
spring-validate --quick see it? yes or no for mutants that change a trajectory, "-" for others), line (of source), date
(of the run). The comment "present" says how many mutants there are. Those known to be equivalent, and why, are in
equivalent.tsv.

Status 1 if a mutant survives, if one that is listed as equivalent is killed, if spring-validate misses a trajectory
mutant written by hand, or if a list names a mutant or a line that there is not. The last line on standard error is
"N passed, N failed, N skipped".
"""

import argparse
import concurrent.futures
import csv
import datetime
import json
import os
import pathlib
import queue
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import tomllib
import zlib
from typing import NamedTuple

import generate

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
VALIDATE = "validate"
TIME_LIMIT = "time limit"
SAMPLE_BY_HAND, SAMPLE_GENERATED = 14, 90
COLUMNS = ("mutant", "by", "killed_by", "verdict", "reason", "caught_by_validate", "line", "date")

# Where a generated mutant changes a trajectory: the steps, and not the limits of stability.
STEPPERS = ("euler.h", "leapfrog.h", "rk4.h", "exact.h", "exact.c", "loops.h")
NOT_STEPS = ("exact_stable_step",)

# Mutants are tried where only vectors of 16 bytes are compiled: a fourth of the work. What survives there, and may concern
# the others, is tried with all of them, by the tests that look at vectors, in a build that is made when it is needed.
NARROW, WIDE = "build", "build-wide"
ONLY_NARROW = "-Dc_args=-DSPRING_X86_64=0"
OF_VECTORS = re.compile("batch|scene")
WIDE_PROGRAMS = {}  # by tree
WITH_VECTORS = re.compile("src/(real_vector|processor|batch_kernels|batch_loop|scene_kernels)")

# Which programs a file concerns; no other calls what is in it. A file that is not here concerns all.
CONCERNS = {
    "src/batch": re.compile("batch|plain|fuzz-api|validate$"),
    "src/scene": re.compile("scene|plain|fuzz-scene|validate$"),
    "src/grid": re.compile("scene|fuzz-scene|validate$"),
    "src/real_vector": re.compile("batch|scene|plain|fuzz|validate$"),
}


class Mutant(NamedTuple):
    name: str
    file: str
    text: str  # of the whole file
    line: str
    reason: str
    trajectory: bool
    by_hand: bool


class Program(NamedTuple):
    name: str
    command: list  # words; those that lie in the build directory are relative to it
    targets: list  # to build first
    tap: bool
    limit: float  # [s]


def generated():
    for mutant in generate.generate(ROOT / "src"):
        text = (ROOT / mutant.file).read_text(encoding="utf-8")
        name, owner = mutant.name.split(":")[:2]
        yield Mutant(
            mutant.name, mutant.file, mutant.apply(text), mutant.line(text), "",
            name in STEPPERS and owner not in NOT_STEPS, False,
        )


def written_by_hand():
    for entry in tomllib.loads((HERE / "by_hand.toml").read_text(encoding="utf-8"))["mutant"]:
        text = (ROOT / entry["file"]).read_text(encoding="utf-8")
        if text.count(entry["old"]) != 1:
            sys.exit(f"by_hand.toml: {entry['name']}: the text to replace occurs {text.count(entry['old'])} times "
                     f"in {entry['file']}; it should occur once")
        yield Mutant(
            entry["name"], entry["file"], text.replace(entry["old"], entry["new"]),
            " ".join(entry["old"].split()), entry["purpose"], entry.get("trajectory", False), True,
        )


def rows_of(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader((row for row in file if not row.startswith("#")), delimiter="\t",
                                   quoting=csv.QUOTE_NONE))


def known_equivalents(mutants):
    """From equivalent.tsv: name, line of source, reason. A name that no longer means that line is an error."""
    lines = {mutant.name: mutant.line for mutant in mutants}
    reasons = {}
    for row in rows_of(HERE / "equivalent.tsv"):
        if lines.get(row["mutant"]) != row["line"]:
            sys.exit(f"equivalent.tsv: there is no {row['mutant']} in the line: {row['line']}")
        reasons[row["mutant"]] = row["reason"]
    return reasons


def execute(program, build):
    """What failed in a program, or "" if all is well."""
    def stop():
        stopped.append(True)
        process.kill()

    stopped = []
    points, plan = 0, None
    with subprocess.Popen(program.command, cwd=build, text=True, errors="replace", stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
        timer = threading.Timer(program.limit, stop)
        timer.start()
        for line in process.stdout:
            if program.tap and line.startswith("not ok"):
                process.kill()
                timer.cancel()
                return line.strip().partition(" - ")[2]
            points += line.startswith("ok ")
            if line.startswith("1.."):
                plan = int(line[3:].split()[0])
        process.wait()
        timer.cancel()
    if stopped:
        return TIME_LIMIT
    if process.returncode != 0:
        return f"status {process.returncode}"
    return "broke off" if program.tap and points != plan else ""


def make(build, targets, jobs=1):
    return subprocess.run(["ninja", f"-j{jobs}", *targets], cwd=build, stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, check=False)


def stamps(build, targets):
    return [(build / target).stat().st_mtime_ns for target in targets]


def programs_of(build, names=re.compile("")):
    """The quick suite, built: every test of these names whose program is built here, fastest first. All must pass on the
    tree as it is."""
    tests = json.loads(subprocess.run(["meson", "introspect", "--tests", str(build)], check=True,
                                      capture_output=True, text=True).stdout)
    outputs = {output for target in json.loads(
        subprocess.run(["meson", "introspect", "--targets", str(build)], check=True, capture_output=True,
                       text=True).stdout) for output in target["filename"]}
    programs = []
    for test in tests:
        if test["cmd"][0] not in outputs or "springstep:mutants" in test["suite"] or not names.match(test["name"]):
            continue
        def inside(word):
            path = pathlib.Path(word)
            return f"./{path.relative_to(build)}" if build in path.parents else word
        program = Program(test["name"], [inside(word) for word in test["cmd"]],
                          [os.path.relpath(build / word, build) for word in test["cmd"] if str(build / word) in outputs],
                          test["protocol"] == "tap", 600)
        programs.append(program)
    built = make(build, sorted({target for program in programs for target in program.targets}), os.cpu_count())
    if built.returncode != 0:
        sys.exit(built.stdout + built.stderr)
    timed = []
    for program in programs:
        start = time.monotonic()
        failure = execute(program, build)
        if failure:
            sys.exit(f"{program.name} fails without any mutant: {failure}")
        duration = time.monotonic() - start
        timed.append((round(4 * duration), program._replace(limit=max(5, 10 * duration))))
    return [program for _, program in sorted(timed, key=lambda pair: (pair[1].name == VALIDATE, pair[0], pair[1].name))]


def set_up(tree, name, flags):
    build = tree / name
    done = subprocess.run(["meson", "setup", str(build), str(tree), "-Dtests=enabled", "-Dreport=disabled", "-Ddebug=false",
                           "-Doptimization=1", *flags],
                          capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        sys.exit(done.stdout + done.stderr)
    return build


def concerns(mutant, program):
    return all(pattern.match(program.name) for start, pattern in CONCERNS.items() if mutant.file.startswith(start))


def wide_programs(tree):
    if not (tree / WIDE).exists():
        WIDE_PROGRAMS[tree] = programs_of(set_up(tree, WIDE, []), OF_VECTORS)
    return WIDE_PROGRAMS[tree]


def try_program(mutant, build, program):
    """What failed, or "" if nothing did."""
    before = stamps(build, program.targets)
    built = make(build, program.targets)
    if built.returncode != 0:
        return "does not compile"
    # The library is shared: a mutant of src/ changes no program. Any other that leaves a program as it was cannot change
    # what it does.
    if not mutant.file.startswith("src/") and stamps(build, program.targets) == before:
        return ""
    failure = execute(program, build)
    if failure == TIME_LIMIT: # a program that hangs, or a machine that was busy?
        failure = execute(program._replace(limit=4 * program.limit), build)
    return failure


def try_mutant(mutant, tree, programs):
    """(killed by, caught by validate) of one mutant in a private tree."""
    path = tree / mutant.file
    original = path.read_text(encoding="utf-8")
    killed_by, caught = "", "-"
    try:
        path.write_text(mutant.text, encoding="utf-8")
        for program in programs:
            wanted = mutant.trajectory and program.name == VALIDATE
            if killed_by and not wanted or not concerns(mutant, program):
                continue
            failure = try_program(mutant, tree / NARROW, program)
            if failure and not killed_by:
                killed_by = f"{program.name}: {failure}"
            if wanted:
                caught = "yes" if failure else "no"
        if not killed_by and WITH_VECTORS.match(mutant.file):
            path.write_text(original, encoding="utf-8")
            wide = wide_programs(tree)
            path.write_text(mutant.text, encoding="utf-8")
            for program in wide:
                failure = try_program(mutant, tree / WIDE, program)
                if failure:
                    return f"{program.name}: {failure}", caught
    finally:
        path.write_text(original, encoding="utf-8")
    return killed_by, caught


def run(mutants, equivalent, table):
    with tempfile.TemporaryDirectory(prefix="springstep-mutants-") as scratch:
        first = pathlib.Path(scratch).resolve() / "0"
        shutil.copytree(ROOT, first, symlinks=True, ignore=shutil.ignore_patterns("build*", ".git"))
        programs = programs_of(set_up(first, NARROW, [ONLY_NARROW]))
        trees = queue.SimpleQueue()
        trees.put(first)
        for i in range(1, os.cpu_count()):
            trees.put(pathlib.Path(shutil.copytree(first, first.with_name(str(i)), symlinks=True)))

        def work(mutant):
            tree = trees.get()
            try:
                return mutant, *try_mutant(mutant, tree, programs)
            finally:
                trees.put(tree)

        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            rows = (row_of(mutant, killed_by or "-", caught, datetime.date.today(), equivalent)
                    for mutant, killed_by, caught in pool.map(work, mutants))
            return write(rows, equivalent, table)


def write(rows, equivalent, table):
    """Writes rows as they come; the status."""
    counts = {"killed": 0, "equivalent": 0, "survived": 0}
    failures = []
    for row in rows:
        print(*row.values(), sep="\t", file=table, flush=True)
        counts[row["verdict"]] += 1
        if row["verdict"] == "survived":
            failures.append(f"{row['mutant']} survived: {row['line']}")
        elif row["verdict"] == "killed" and row["mutant"] in equivalent:
            failures.append(f"{row['mutant']} is listed as equivalent, and killed by {row['killed_by']}")
        elif row["by"] == "hand" and row["caught_by_validate"] == "no":
            failures.append(f"{row['mutant']}: spring-validate misses it")
    for failure in failures:
        print("FAILED:", failure, file=sys.stderr)
    print("{killed} killed, {equivalent} equivalent, {survived} survived".format(**counts), file=sys.stderr)
    print(f"{sum(counts.values()) - len(failures)} passed, {len(failures)} failed, 0 skipped", file=sys.stderr)
    return 1 if failures or sum(counts.values()) == 0 else 0


def row_of(mutant, killed_by, caught, date, equivalent):
    verdict = "killed" if killed_by != "-" else "equivalent" if mutant.name in equivalent else "survived"
    reason = equivalent.get(mutant.name, mutant.reason)
    values = (mutant.name, "hand" if mutant.by_hand else "generator", killed_by, verdict, reason, caught, mutant.line, date)
    return dict(zip(COLUMNS, values))


def merge(tables, mutants, equivalent, table):
    """Of each mutant the last row, if it was in the same line of source."""
    last = {(row["mutant"], row["line"]): row for rows in tables for row in rows}
    known = ((mutant, last[mutant.name, mutant.line]) for mutant in mutants if (mutant.name, mutant.line) in last)
    return write((row_of(mutant, row["killed_by"], row["caught_by_validate"] if mutant.trajectory else "-", row["date"],
                         equivalent)
                  for mutant, row in known), equivalent, table)


def in_sample(mutant, table):
    if (mutant.name, mutant.line) not in table:
        return False
    return zlib.crc32(mutant.name.encode()) % (SAMPLE_BY_HAND if mutant.by_hand else SAMPLE_GENERATED) == 0


def version():
    header = (ROOT / "include/springstep/version.h").read_text(encoding="utf-8")
    return re.search('SPRING_VERSION "(.*)"', header).group(1)


def main():
    parser = argparse.ArgumentParser(add_help=True, usage=__doc__)
    parser.add_argument("--sample", action="store_true")
    parser.add_argument("--new")
    parser.add_argument("--merge", action="store_true")
    parser.add_argument("-o", dest="output")
    parser.add_argument("names", nargs="*")
    options = parser.parse_args()
    mutants = [*written_by_hand(), *generated()]
    equivalent = known_equivalents(mutants)
    known = {(row["mutant"], row["line"]) for row in rows_of(options.new)} if options.new else set()
    tables = [rows_of(path) for path in options.names] if options.merge else []
    run_before = {(row["mutant"], row["line"]) for row in rows_of(HERE / "mutants.tsv")} if options.sample else set()
    with open(options.output, "w", encoding="utf-8") if options.output else sys.stdout as table:
        print(f"# command: tests/mutants/run.py\n# version: {version()}\n# date: {datetime.date.today()}\n"
              f"# present: {len(mutants)}", file=table)
        print(*COLUMNS, sep="\t", file=table)
        if options.merge:
            return merge(tables, mutants, equivalent, table)
        chosen = [
            mutant for mutant in mutants
            if (not options.sample or in_sample(mutant, run_before)) and (mutant.name, mutant.line) not in known
            and (not options.names or any(pattern in mutant.name for pattern in options.names))
        ]
        return run(chosen, equivalent, table)


if __name__ == "__main__":
    sys.exit(main())
