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
  equivalent  equivalent.tsv says why no test can fail; those that take a second or less do not
  survived    none of these

Status 1 if a mutant survives, if one of equivalent.tsv is killed or is not there any more, or if one of by_hand.toml
cannot be applied or compiled. The last line on standard error is "N passed, N failed, N skipped".

To compile takes longer than to run. So the mutants of a function are compiled together, as cases of a switch over a
number from the environment; and a program that never comes into the function, which is found out at the start, is not
run. A mutant that is not within a function, or does not compile there, is compiled alone.
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
BUILDS = {"build-narrow": "-DSPRING_X86_64=0", "build": ""}
ENDLESS = ["-fno-finite-loops", "-fwrapv"]  # or compilers leave out loops that do not end, which are undefined

# What each file of the builds includes first: in a program that is to run mutant 3 of its function SPRING_MUTANT is 3.
# Each process adds to the file SPRING_REACHED a byte a function: 1 if it came there. (Weak: there is one of each in a
# program. Declared by hand: headers would come before the macros that say what a file needs of them.)
FUNCTIONS = 1024
SWITCH = f"""
char *spring_getenv(const char *) __asm__("getenv");
int spring_atoi(const char *) __asm__("atoi");
int spring_open(const char *, int, ...) __asm__("open");
long spring_write(int, const void *, unsigned long) __asm__("write");
__attribute__((weak)) int spring_mutant;
__attribute__((weak)) unsigned char spring_reached[{FUNCTIONS}];
void spring_mutant_read(void);
void spring_reached_write(void);
__attribute__((weak, constructor)) void spring_mutant_read(void)
{{
    const char *number = spring_getenv("SPRING_MUTANT");
    spring_mutant = number ? spring_atoi(number) : 0;
}}
__attribute__((weak, destructor)) void spring_reached_write(void)
{{
    const char *path = spring_getenv("SPRING_REACHED");
    if (path)
        spring_write(spring_open(path, {os.O_WRONLY | os.O_CREAT | os.O_APPEND}, 0666), spring_reached, {FUNCTIONS});
}}
"""
QUICK = 7  # [s] the limit of programs that are run before it is asked whether the machine code differs
TOGETHER = 8000  # words of mutants that are compiled together, at most


class Mutant(NamedTuple):
    name: str
    file: str
    line: int
    text: str  # of the whole file
    code: str
    by: str
    reason: str
    only: str  # the one program that has to notice it, or ""
    function: str  # file and offset of the function's body, or ""
    body: str  # of the function


class Program(NamedTuple):
    name: str
    command: list  # words; those that lie in the build directory are relative to it
    targets: list  # to build first
    tap: bool
    limit: int  # [s]
    digest: str  # of the targets as they should be
    reaches: frozenset  # the functions that it comes into


class Build(NamedTuple):
    path: pathlib.Path
    programs: list  # fastest first
    objects: dict  # path and digest, as they should be, the smallest first


def function_at(file, start):
    return f"{file}:{start}"


def mutant_of(name, path, text, definition, change, by="generator", reason="", only=""):
    after = change.apply(text)
    longer = len(after) - len(text)
    within = definition.tokens[0].start, definition.tokens[-1].end + longer
    code = generate.Definition("", generate.scan(after, *within)).code()
    line = text.count("\n", 0, change.start) + 1
    file, function, body = path.relative_to(ROOT).as_posix(), "", ""
    start, end = (not definition.is_macro and definition.body()) or (len(text), 0)
    if start <= change.start:
        function, body = function_at(file, start), after[start : end + longer]
    return Mutant(name, file, line, after, code, by, reason, only, function, body)


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


def execute(program, build, **environment):
    """What failed in a program, or "" if all is well. The limit is of processor time, which others do not use up."""
    points, plan = 0, None
    limited = ["sh", "-c", f'ulimit -t {program.limit} && exec "$@"', "sh", *program.command]
    with subprocess.Popen(limited, cwd=build, text=True, errors="replace", stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True,
                          env=os.environ | environment) as process:
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


def with_notes(text, file, number):
    """A file whose functions note that they are run: for the function at body() the number."""
    for definition in reversed([d for d in generate.definitions(text) if d.body() and not d.is_macro]):
        start = definition.body()[0]
        index = number.setdefault(function_at(file, start), len(number))
        text = f"{text[: start + 1]} spring_reached[{index}] = 1; {text[start + 1 :]}"
    return text


def programs_of(build, number):
    """Every test whose program is built here, fastest first. All must pass on the tree as it is, with notes."""
    outputs = {output for target in introspect(build, "targets") for output in target["filename"]}

    def inside(word):
        path = pathlib.Path(word)
        return f"./{path.relative_to(build)}" if build in path.parents else word

    programs = [
        Program(test["name"], [inside(word) for word in test["cmd"]],
                [os.path.relpath(build / word, build) for word in test["cmd"] if str(build / word) in outputs],
                test["protocol"] == "tap", 600, "", frozenset())
        for test in introspect(build, "tests") if test["cmd"][0] in outputs
    ]
    built = ninja(build, *sorted({target for program in programs for target in program.targets}))
    if built.returncode != 0:
        sys.exit(built.stdout + built.stderr)

    def timed(program):
        start = time.monotonic()
        notes = build / f"{program.name}.reached"
        failure = execute(program, build, SPRING_REACHED=str(notes))
        if failure:
            sys.exit(f"{program.name} fails without any mutant: {failure}")
        duration = time.monotonic() - start
        seen = notes.read_bytes()  # of one process after the other
        reaches = frozenset(name for name, i in number.items() if any(seen[i :: FUNCTIONS]))
        return round(4 * duration), program._replace(limit=5 + round(2 * duration), reaches=reaches)

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        costs = list(pool.map(timed, programs))
    return [program for _, program in sorted(costs, key=lambda pair: (pair[0], pair[1].name))]


def set_up(tree):
    """The builds of a tree, in the order in which they are tried."""
    (tree / "switch.h").write_text(SWITCH, encoding="utf-8")
    originals = {path: path.read_text(encoding="utf-8") for path in sorted((tree / "src").rglob("*.[ch]"))}
    number = {}
    for path, text in originals.items():
        path.write_text(with_notes(text, path.relative_to(tree).as_posix(), number), encoding="utf-8")
    if len(number) > FUNCTIONS:
        sys.exit(f"{len(number)} functions: expected at most {FUNCTIONS}")
    programs = {}
    for name, macro in BUILDS.items():
        arguments = f"-Dc_args={' '.join(ENDLESS)} -include {tree}/switch.h {macro}"
        done = subprocess.run(["meson", "setup", str(tree / name), str(tree), *OPTIONS, arguments],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(done.stdout + done.stderr)
        programs[name] = programs_of(tree / name, number)
    for path, text in originals.items():
        path.write_text(text, encoding="utf-8")

    builds = []
    for name in BUILDS:
        path = tree / name
        ninja(path, *sorted({target for program in programs[name] for target in program.targets}))
        files = sorted(path.rglob("*.o"), key=lambda file: file.stat().st_size)
        objects = {str(file.relative_to(path)): digest([file]) for file in files}
        builds.append(Build(path, [
            program._replace(digest=digest([path / target for target in program.targets])) for program in programs[name]
        ], objects))
    return builds


# ------------------------------------------------------------------------------------------------------- the mutants


class NotCompiled(Exception):
    pass


def make(build, targets):
    if ninja(build.path, "-j1", *targets).returncode != 0:
        raise NotCompiled


def switched(mutants, text):
    """The file of one mutant or, of several, one that is as it was unless the program is asked for one of them."""
    if len(mutants) == 1:
        return mutants[0].text
    start = int(mutants[0].function.rpartition(":")[2])
    end = len(text) - (len(mutants[0].text) - start - len(mutants[0].body))
    cases = "".join(f"case {i}: {{\n{mutant.body}\nbreak; }}\n" for i, mutant in enumerate(mutants, 1))
    return (f"{text[:start]}{{ switch (spring_mutant) {{\n{cases}default: {{\n{text[start:end]}\nbreak; }} }} }}"
            f"{text[end:]}")


def compiled_in(build):
    """The objects that are to be compiled now, the smallest first."""
    targets = {target for program in build.programs for target in program.targets}
    found = set(re.findall(r"Compiling C object (\S+)", ninja(build.path, "-n", *targets).stdout))
    return [name for name in build.objects if name in found]


def same_object(build, name):
    make(build, [name])
    return digest([build.path / name]) == build.objects[name]


def try_programs(programs, build, mutants, killers, last_killer):
    """Adds to `killers` what killed the mutants that are compiled now."""
    changed, passed = {}, set()

    def concerned(program, mutant):
        if mutant.only or not mutant.file.startswith("src/"):
            return mutant.only in ("", program.name)
        if mutant.function:
            return mutant.function in program.reaches
        return mutant.file.endswith(".h") or any(function.startswith(mutant.file) for function in program.reaches)

    def failure_of(program, mutant):
        if not concerned(program, mutant):
            return ""
        if program.name not in changed:
            make(build, program.targets)
            changed[program.name] = digest([build.path / target for target in program.targets]) != program.digest
        if not changed[program.name]:
            return ""
        if len(mutants) == 1:
            return execute(program, build.path)
        failure = execute(program, build.path, SPRING_MUTANT=str(1 + mutants.index(mutant)))
        if failure and program.name not in passed:
            if execute(program, build.path):
                raise NotCompiled  # as it was meant: without a number the program has to pass
            passed.add(program.name)
        return failure

    for mutant in mutants:
        where = mutant.name.rsplit(":", 2)[0]
        for program in sorted(programs, key=lambda program: program.name != last_killer.get(where)):
            failure = mutant not in killers and failure_of(program, mutant)
            if failure:
                last_killer[where] = program.name
                killers[mutant] = f"{program.name}: {failure}"


def judge(mutants, path, switch, builds, last_killer, argued):
    path.write_text(switch, encoding="utf-8")
    killers, same, objects = {}, set(), [compiled_in(build) for build in builds]
    quick = [program for program in builds[0].programs if program.limit <= QUICK]
    try_programs(quick, builds[0], mutants, killers, last_killer)
    if argued:
        return [(mutant, "killed" if mutant in killers else "survived", killers.get(mutant, "-")) for mutant in mutants]
    for mutant in mutants:  # where the machine code is the same, no program need be run
        path.write_text(mutant.text, encoding="utf-8")
        if mutant not in killers and all(same_object(build, name) for build, names in zip(builds, objects)
                                         for name in names):
            same.add(mutant)
    path.write_text(switch, encoding="utf-8")
    judged = killers | dict.fromkeys(same, "-")
    for build, compiled in zip(builds, objects):
        # Once is enough, if what is compiled is the same in all builds.
        if build is builds[0] or any(build.objects.get(name) != builds[0].objects[name] for name in compiled):
            rest = [program for program in build.programs if build is not builds[0] or program not in quick]
            try_programs(rest, build, mutants, judged, last_killer)
    return [(mutant, "same code" if mutant in same else "killed" if mutant in judged else "survived",
             judged.get(mutant, "-")) for mutant in mutants]


def verdicts_of(mutants, path, builds, last_killer, argued):
    """Of the mutants of one function, or of a single one: each with its verdict, and what killed it. If there is a
    reason why they should survive (argued), only programs that are quick are asked."""
    original = path.read_text(encoding="utf-8")
    try:
        return judge(mutants, path, switched(mutants, original), builds, last_killer, argued)
    except NotCompiled:
        if len(mutants) == 1:
            return [(mutants[0], "killed", BROKEN)]
    finally:
        path.write_text(original, encoding="utf-8")
    half = len(mutants) // 2
    return [*verdicts_of(mutants[:half], path, builds, last_killer, argued),
            *verdicts_of(mutants[half:], path, builds, last_killer, argued)]


def groups(mutants, equivalent):
    """Those that can be compiled together. What is known to survive comes last."""
    group, words = [], 0
    for mutant in sorted(mutants, key=lambda mutant: (mutant.name in equivalent, mutant.file, mutant.function)):
        cost = len(mutant.body.split())
        known = group and group[0].name in equivalent
        if group and (not mutant.function or mutant.function != group[0].function or words + cost > TOGETHER or
                      known != (mutant.name in equivalent)):
            yield group
            group, words = [], 0
        group.append(mutant)
        words += cost
    if group:
        yield group


def run(mutants, equivalent):
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

        def work(group):
            tree = trees.get()
            try:
                here = [build._replace(path=tree / build.path.name) for build in builds]
                return verdicts_of(group, tree / group[0].file, here, last_killer, group[0].name in equivalent)
            finally:
                trees.put(tree)

        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            jobs = [pool.submit(work, group) for group in groups(mutants, equivalent)]
            for job in concurrent.futures.as_completed(jobs):
                yield from job.result()


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


def write_table(path, mutants, rows):
    """Never less than it held before, in the order of the files."""
    table = [head(len(mutants)), *("\t".join(rows[name].values()) for name in mutants if name in rows)]
    new = path.with_suffix(".new")
    new.write_text("\n".join(table) + "\n", encoding="utf-8")
    new.replace(path)


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
    if options.output:
        write_table(options.output, mutants, rows)
    else:
        print(head(len(mutants)), flush=True)
    with open(options.output, "a", encoding="utf-8") if options.output else sys.stdout as table:
        for mutant, verdict, killed_by in run([mutant for mutant in wanted if mutant.name not in rows], equivalent):
            rows[mutant.name] = row = row_of(mutant, verdict, killed_by, equivalent)
            print("\t".join(row.values()), file=table, flush=True)
            failure = failure_in(row, mutant, equivalent)
            if failure:
                print("FAILED:", failure, file=sys.stderr, flush=True)
    if options.output:
        write_table(options.output, mutants, rows)

    judged = [rows[mutant.name] for mutant in wanted]
    verdicts = [row["verdict"] for row in judged]
    failed = sum(failure_in(row, mutants[row["mutant"]], equivalent) != "" for row in judged)
    counts = (f"{verdicts.count(verdict)} {verdict}" for verdict in ("killed", "same code", "equivalent", "survived"))
    print(", ".join(counts), file=sys.stderr)
    print(f"{len(judged) - failed} passed, {failed} failed, 0 skipped", file=sys.stderr)
    return 1 if failed or not judged else 0


if __name__ == "__main__":
    sys.exit(main())
