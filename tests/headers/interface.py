#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The public interface, from the headers: functions, types, enumerators and macros, each with its declaration.

    interface.py list SOURCE-ROOT       prints it: tests/headers/released.tsv is this list, of the last release
    interface.py changes SOURCE-ROOT    does CHANGELOG.md name all that is not as in the last release?
    interface.py layout SOURCE-ROOT     does interface.c know every structure, field, value and flag?

Prints what is wrong; status 1 if anything is.
"""
import re
import sys
from pathlib import Path


def declarations(header):
    """Statements outside of functions, without comments, and macros with a value."""
    text = re.sub(r"/\*.*?\*/|//[^\n]*", " ", header.read_text(), flags=re.S)
    text = re.sub(r"#ifdef __cplusplus.*?#endif", "", text, flags=re.S)
    for name, value in re.findall(r"^#define (SPRING_(?!API\b|VERSION\b|BUILD_DLL\b)\w+) +(.+)$", text, re.M):
        yield f"#define {name} {value.strip()}"
    text = re.sub(r"^#.*$", "", text, flags=re.M)
    for statement in re.findall(r"(?:[^;{}]|\{[^{}]*\})+;", text):
        yield " ".join(statement.split()).removeprefix("SPRING_API ")


def interface(root):
    """{name: declaration}. An enumerator's is its value, so that an enumeration may grow."""
    names = {}
    for header in sorted((root / "include/springstep").glob("*.h")):
        for declaration in declarations(header):
            if enumeration := re.fullmatch(r"(?:typedef )?enum ?\w* ?\{(.*)\} ?(\w*);", declaration):
                value = -1
                for enumerator in enumeration[1].strip(" ,").split(","):
                    name, _, given = enumerator.partition("=")
                    value = int(given) if given else value + 1
                    names[name.strip()] = f"{enumeration[2]} {value}".strip()
                if enumeration[2]:
                    names[enumeration[2]] = "enum"
            elif macro := re.match(r"#define (\w+)", declaration):
                names[macro[1]] = declaration
            elif function := re.search(r"\b(spring_\w+)\(", declaration):
                names[function[1]] = re.sub(r" ?\b(?!void\b)\w+((?:\[\w*\])?[,)])", r"\1", declaration)  # types alone
            else:
                names[re.search(r"(\w+);$", declaration)[1]] = declaration
    return names


def wrong_changes(root):
    names = interface(root)
    released = (root / "tests/headers/released.tsv").read_text().splitlines()
    released = dict(line.split("\t") for line in released if not line.startswith("#"))
    version = re.search(r'SPRING_VERSION "(.*)"', (root / "include/springstep/version.h").read_text())[1]
    changelog = (root / "CHANGELOG.md").read_text()
    heading, section = re.search(r"^## (.*?)$(.*?)(?=^## |\Z)", changelog, re.M | re.S).groups()
    changed = {name for name in names.keys() | released.keys() if names.get(name) != released.get(name)}

    if heading != f"{version}, unreleased":
        if not re.fullmatch(re.escape(version) + r", \d{4}-\d\d-\d\d", heading):
            yield f'CHANGELOG.md begins with "{heading}", version.h says {version}'
        for name in sorted(changed):
            yield f"{name} is not as in released.tsv: CHANGELOG.md needs a part that is unreleased"
        return
    for name in sorted(changed):
        twin = re.sub(r"^(spring_(?:batch|scene))f(?=_|$)", r"\1", name)  # in float; named with that in double
        if not re.search(rf"\b({name}|{twin})\b", section):
            yield f"CHANGELOG.md does not name {name}, which is new, other, or gone"
    # The number of methods may grow: programs that are compiled keep theirs.
    breaks = (changed & released.keys()) - {"SPRING_METHOD_COUNT", "SPRING_SOVERSION"}
    if released and bool(breaks) != ("SPRING_SOVERSION" in changed):
        yield f"SPRING_SOVERSION has to change if and only if what is released does: {sorted(breaks)}"


def wrong_layout(root):
    layout = (root / "tests/headers/interface.c").read_text()
    for name, declaration in interface(root).items():
        if body := re.search(r"struct \w+ \{(.*)\}", declaration):
            wanted = [f"SIZE({name}, "]
            wanted += [f"AT({name}, {field}, " for field in re.findall(r"(\w+)(?:\[\w+\])?(?=[;,])", body[1])]
        elif name == "SPRING_METHOD_COUNT":  # may grow
            continue
        elif enumerator := re.fullmatch(r"(?:spring_\w+ )?(\d+)", declaration):
            wanted = [f"VALUE({name}, {enumerator[1]})"]
        elif macro := re.fullmatch(r'#define \w+ (?:UINT32_C\((.*)\)|([^"].*))', declaration):
            wanted = [f"VALUE({name}, {macro[1] or macro[2]})"]
        elif declaration == "enum":
            wanted = [f"SIZE({name}, "]
        else:
            continue
        for line in wanted:
            if line not in layout:
                yield f"interface.c has no {line}"


def main():
    what, root = sys.argv[1], Path(sys.argv[2])
    if what == "list":
        for name, declaration in sorted(interface(root).items()):
            print(f"{name}\t{declaration}")
        return 0
    wrong = list({"changes": wrong_changes, "layout": wrong_layout}[what](root))
    for line in wrong:
        print(line)
    return 1 if wrong else 0


sys.exit(main())
