#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Does the suite notice a wrong library? Applies mutants, one at a time, to a copy of the tree, and runs the C tests.

usage: run.py [--list | --sample] [-o FILE] [PATTERN]...

  PATTERN   only mutants whose names contain one of these
  --list    run nothing: names, and where they are
  --sample  a fixed small part of them, without those of equivalent.tsv: what no test kills takes longest
  -o FILE   the table, instead of standard output. A FILE that is there is continued: a mutant is not run again while
            the code of its function is what it was, unless it had survived.

The mutants are those that generate.py makes of every file of src/, file:function:change:ordinal, and those of
by_hand.toml. The table has one row a mutant: mutant, by (generator or hand), verdict, killed_by (program and test
point), reason (why it is equivalent, or what was meant to break), code (a hash of the function as it is changed,
without comments and layout). Verdicts:

  killed      a test fails
  same code   the compiler makes of it what it makes of the library as it is
  equivalent  no test fails, and equivalent.tsv says why none can
  survived    none of these

Status 1 if a mutant survives, if one of equivalent.tsv is killed or is not there any more, or if one of by_hand.toml
cannot be applied or compiled. The last line on standard error is "N passed, N failed, N skipped".
"""

import argparse
import concurrent.futures
import csv
import datetime
import hashlib
import json
import os
import pathlib
import queue
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
import zlib
from typing import NamedTuple

import generate

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
COLUMNS = ("mutant", "by", "verdict", "killed_by", "reason", "code")
SAMPLED = {"hand": 5, "generator": 90}  # one in so many
TIME_LIMIT = "time limit"
BROKEN = "does not compile"

# The library is linked into every program: one that does not contain what is changed stays as it is, and need not run.
# Vectors of 16 bytes are compiled four times as fast as all of them, so these are tried first.
OPTIONS = ["-Dtests=enabled", "-Dreport=disabled", "-Ddefault_library=static", "-Ddebug=false", "-Doptimization=1"]
BUILDS = {"build-narrow": ["-Dc_args=-DSPRING_X86_64=0"], "build": []}


class Mutant(NamedTuple):
    name: str
    file: str
    line: int
    text: str  # of the whole file
    code: str
    by: str
    reason: str
    only: str  # the one program that has to notice it, or ""


class Program(NamedTuple):
    name: str
    command: list  # words; those that lie in the build directory are relative to it
    targets: list  # to build first
    tap: bool
    limit: int  # [s]
    digest: str  # of the targets as they should be


class Build(NamedTuple):
    path: pathlib.Path
    programs: list  # fastest first
    objects: dict  # path and digest, as they should be


def mutant_of(name, path, text, definition, change, by="generator", reason="", only=""):
    after = change.apply(text)
    within = definition.tokens[0].start, definition.tokens[-1].end + len(after) - len(text)
    code = generate.Definition("", generate.scan(after, *within)).code()
    line = text.count("\n", 0, change.start) + 1
    return Mutant(name, path.relative_to(ROOT).as_posix(), line, after, code, by, reason, only)


def generated():
    for path in sorted((ROOT / "src").rglob("*.[ch]")):
        text = path.read_text(encoding="utf-8")
        for definition, change in generate.generate(text):
            name = f"{path.relative_to(ROOT / 'src').as_posix()}:{change.name}"
            yield mutant_of(name, path, text, definition, change)


def written_by_hand():
    """by_hand.toml says what is replaced: a token of a function, or its whole body."""
    for entry in tomllib.loads((HERE / "by_hand.toml").read_text(encoding="utf-8"))["mutant"]:
        path = ROOT / entry["file"]
        text = path.read_text(encoding="utf-8")
        found = [d for d in generate.definitions(text) if d.name == entry["function"] and not d.declares_only()]
        if len(found) != 1:
            sys.exit(f"by_hand.toml: {entry['name']}: {entry['file']} defines {len(found)} times {entry['function']}")
        if "body" in entry:
            start, end = found[0].body()
        else:
            tokens = [token for token in found[0].tokens if token.text == entry["token"]]
            if len(tokens) < entry["ordinal"]:
                sys.exit(f"by_hand.toml: {entry['name']}: {entry['token']} occurs {len(tokens)} times")
            start, end = tokens[entry["ordinal"] - 1][2:]
        change = generate.Change("", start, end, entry.get("body", entry.get("new")))
        yield mutant_of(entry["name"], path, text, found[0], change, "hand", entry["purpose"], entry.get("only", ""))


def rows_of(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader((row for row in file if not row.startswith("#")), delimiter="\t",
                                   quoting=csv.QUOTE_NONE))


def known_equivalents(mutants):
    reasons = {row["mutant"]: row["reason"] for row in rows_of(HERE / "equivalent.tsv")}
    unknown = [name for name in reasons if name not in mutants]
    if unknown:
        sys.exit("equivalent.tsv: no such mutant: " + ", ".join(unknown))
    return reasons


# --------------------------------------------------------------------------------------------- programs and builds


def execute(program, build):
    """What failed in a program, or "" if all is well. The limit is of processor time, which others do not use up."""
    points, plan = 0, None
    limited = ["sh", "-c", f'ulimit -t {program.limit} && exec "$@"', "sh", *program.command]
    with subprocess.Popen(limited, cwd=build, text=True, errors="replace", stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True) as process:
        for line in process.stdout:
            if program.tap and line.startswith("not ok"):
                os.killpg(process.pid, signal.SIGKILL)
                return line.strip().partition(" - ")[2]
            points += line.startswith("ok ")
            if line.startswith("1.."):
                plan = int(line[3:].split()[0])
    if process.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return TIME_LIMIT
    if process.returncode != 0:
        return f"status {process.returncode}"
    return "broke off" if program.tap and points != plan else ""


def ninja(build, *arguments):
    return subprocess.run(["ninja", *arguments], cwd=build, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          check=False)


def digest(paths):
    return hashlib.sha256(b"".join(path.read_bytes() for path in paths)).hexdigest()


def introspect(build, what):
    return json.loads(subprocess.run(["meson", "introspect", f"--{what}", str(build)], check=True, capture_output=True,
                                     text=True).stdout)


def programs_of(build):
    """Every test whose program is built here, fastest first. All must pass on the tree as it is."""
    outputs = {output for target in introspect(build, "targets") for output in target["filename"]}

    def inside(word):
        path = pathlib.Path(word)
        return f"./{path.relative_to(build)}" if build in path.parents else word

    programs = [
        Program(test["name"], [inside(word) for word in test["cmd"]],
                [os.path.relpath(build / word, build) for word in test["cmd"] if str(build / word) in outputs],
                test["protocol"] == "tap", 600, "")
        for test in introspect(build, "tests") if test["cmd"][0] in outputs
    ]
    built = ninja(build, *sorted({target for program in programs for target in program.targets}))
    if built.returncode != 0:
        sys.exit(built.stdout + built.stderr)

    def timed(program):
        start = time.monotonic()
        failure = execute(program, build)
        if failure:
            sys.exit(f"{program.name} fails without any mutant: {failure}")
        duration = time.monotonic() - start
        whole = digest([build / target for target in program.targets])
        return round(4 * duration), program._replace(limit=5 + round(5 * duration), digest=whole)

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        costs = list(pool.map(timed, programs))
    return [program for _, program in sorted(costs, key=lambda pair: (pair[0], pair[1].name))]


def set_up(tree):
    """The builds of a tree, in the order in which they are tried."""
    builds = []
    for name, options in BUILDS.items():
        path = tree / name
        done = subprocess.run(["meson", "setup", str(path), str(tree), *OPTIONS, *options], stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(done.stdout + done.stderr)
        programs = programs_of(path)
        objects = {str(file.relative_to(path)): digest([file]) for file in path.rglob("*.o")}
        builds.append(Build(path, programs, objects))
    return builds


# ----------------------------------------------------------------------------------------------------- one mutant


def try_program(build, program):
    """What failed, or "" if nothing did."""
    if ninja(build.path, "-j1", *program.targets).returncode != 0:
        return BROKEN
    if digest([build.path / target for target in program.targets]) == program.digest:
        return ""
    return execute(program, build.path)


def try_mutant(mutant, builds, last_killer):
    """(verdict, killed_by) of a mutant that is in the tree; not yet whether it is equivalent."""
    compiled, same = set(), True
    for build in builds:
        # Once is enough, if what is compiled is the same in all builds.
        if compiled and all(each.objects.get(name) == builds[0].objects[name] for name in compiled for each in builds):
            break
        programs = [program for program in build.programs if mutant.only in ("", program.name)]
        targets = {target for program in programs for target in program.targets}
        compiled |= set(re.findall(r"Compiling C object (\S+)", ninja(build.path, "-n", *targets).stdout))
        where = mutant.name.rsplit(":", 2)[0]
        for program in sorted(programs, key=lambda program: program.name != last_killer.get(where)):
            failure = try_program(build, program)
            if failure:
                last_killer[where] = program.name
                return "killed", f"{program.name}: {failure}"
        same = same and all(digest([build.path / name]) == build.objects[name] for name in compiled)
    return "same code" if compiled and same else "survived", "-"


def run(mutants):
    """Yields each with its verdict and what killed it."""
    if not mutants:
        return
    with tempfile.TemporaryDirectory(prefix="springstep-mutants-") as scratch:
        first = pathlib.Path(scratch).resolve() / "0"
        shutil.copytree(ROOT, first, symlinks=True, ignore=shutil.ignore_patterns("build*", ".git"))
        builds = set_up(first)
        trees = queue.SimpleQueue()
        trees.put(first)
        for i in range(1, os.cpu_count()):
            trees.put(pathlib.Path(shutil.copytree(first, first.with_name(str(i)), symlinks=True)))
        last_killer = {}

        def work(mutant):
            tree = trees.get()
            path = tree / mutant.file
            original = path.read_text(encoding="utf-8")
            try:
                path.write_text(mutant.text, encoding="utf-8")
                here = [build._replace(path=tree / build.path.name) for build in builds]
                return mutant, *try_mutant(mutant, here, last_killer)
            finally:
                path.write_text(original, encoding="utf-8")
                trees.put(tree)

        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            by_file = sorted(mutants, key=lambda mutant: mutant.file)  # a file is restored, and compiled again, once
            yield from pool.map(work, by_file)


# --------------------------------------------------------------------------------------------------------- the table


def row_of(mutant, verdict, killed_by, equivalent):
    reason = equivalent.get(mutant.name, mutant.reason)
    if verdict in ("survived", "equivalent"):
        verdict = "equivalent" if mutant.name in equivalent else "survived"
    return dict(zip(COLUMNS, (mutant.name, mutant.by, verdict, killed_by, reason, mutant.code)))


def failure_in(row, mutant, equivalent):
    """What is wrong with a row, or ""."""
    where = f"{mutant.file}:{mutant.line}: {mutant.name}"
    if row["verdict"] == "survived":
        return f"{where} survived" + (f" {mutant.only}" if mutant.only else "")
    if row["verdict"] == "killed" and mutant.name in equivalent:
        return f"{where} is listed as equivalent, and killed by {row['killed_by']}"
    if row["by"] == "hand" and row["killed_by"].endswith(BROKEN):
        return f"{where} does not compile"
    return ""


def kept_rows(path, mutants, equivalent):
    """Of an earlier run: what need not be run again, by name."""
    kept = {}
    for row in rows_of(path) if path and path.exists() else []:
        mutant = mutants.get(row["mutant"])
        if mutant and row["code"] == mutant.code:
            kept[mutant.name] = row_of(mutant, row["verdict"], row["killed_by"], equivalent)
    return {name: row for name, row in kept.items() if not failure_in(row, mutants[name], equivalent)}


def head(present):
    version = re.search('SPRING_VERSION "(.*)"', (ROOT / "include/springstep/version.h").read_text(encoding="utf-8"))
    return (f"# command: tests/mutants/run.py\n# version: {version.group(1)}\n# date: {datetime.date.today()}\n"
            f"# present: {present}\n" + "\t".join(COLUMNS))


def in_sample(mutant, equivalent):
    return mutant.name not in equivalent and zlib.crc32(mutant.name.encode()) % SAMPLED[mutant.by] == 0


def chosen(mutants, options, equivalent):
    for mutant in mutants:
        if options.patterns and not any(pattern in mutant.name for pattern in options.patterns):
            continue
        if not options.sample or in_sample(mutant, equivalent):
            yield mutant


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--sample", action="store_true")
    parser.add_argument("-o", dest="output", type=pathlib.Path)
    parser.add_argument("patterns", nargs="*")
    options = parser.parse_args()
    mutants = {mutant.name: mutant for mutant in (*written_by_hand(), *generated())}
    equivalent = known_equivalents(mutants)
    wanted = list(chosen(mutants.values(), options, equivalent))
    if options.list:
        for mutant in wanted:
            print(f"{mutant.name}\t{mutant.file}:{mutant.line}")
        return 0

    rows = kept_rows(options.output, mutants, equivalent)
    before = [head(len(mutants)), *("\t".join(row.values()) for row in rows.values())]
    if options.output:  # never less than it held before
        new = options.output.with_suffix(".new")
        new.write_text("\n".join(before) + "\n", encoding="utf-8")
        new.replace(options.output)
    with open(options.output, "a", encoding="utf-8") if options.output else sys.stdout as table:
        if not options.output:
            print(*before, sep="\n", flush=True)
        for mutant, verdict, killed_by in run([mutant for mutant in wanted if mutant.name not in rows]):
            rows[mutant.name] = row = row_of(mutant, verdict, killed_by, equivalent)
            print("\t".join(row.values()), file=table, flush=True)
            failure = failure_in(row, mutant, equivalent)
            if failure:
                print("FAILED:", failure, file=sys.stderr, flush=True)

    judged = [rows[mutant.name] for mutant in wanted]
    verdicts = [row["verdict"] for row in judged]
    failed = sum(failure_in(row, mutants[row["mutant"]], equivalent) != "" for row in judged)
    counts = (f"{verdicts.count(verdict)} {verdict}" for verdict in ("killed", "same code", "equivalent", "survived"))
    print(", ".join(counts), file=sys.stderr)
    print(f"{len(judged) - failed} passed, {failed} failed, 0 skipped", file=sys.stderr)
    return 1 if failed or not judged else 0


if __name__ == "__main__":
    sys.exit(main())
