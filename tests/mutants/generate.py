#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Generates the mutants of the library: every operator, comparison and constant of src/ changed in turn.

usage: generate.py SRC     lists them, one a line: name, tab, the line of source it changes

A mutant is named file:function:change:ordinal, the ordinal counting the same change within the function, so a name
outlives edits elsewhere. Comments, strings, preprocessor lines, declarations of pointers and sizes of arrays are left
alone.
"""

import pathlib
import re
import sys
from typing import NamedTuple

TOKEN = re.compile(
    r"""(?P<skip>/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|^[ \t]*\#(?:\\\n|[^\n])*|\s+)
      | (?P<number>(?:0[xX][0-9a-fA-F.]+(?:[pP][+-]?\d+)?|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)[uUlLfF]*)
      | (?P<word>[A-Za-z_]\w*)
      | (?P<operator>->|\+\+|--|<<|>>|[-+*/<>=!]=|&&|\|\||.)""",
    re.VERBOSE | re.MULTILINE | re.DOTALL,
)

CHANGES = {
    "+": ["-"],
    "-": ["+"],
    "*": ["/"],
    "/": ["*"],
    "+=": ["-="],
    "-=": ["+="],
    "*=": ["/="],
    "/=": ["*="],
    "++": ["--"],
    "--": ["++"],
    "<": ["<=", ">="],
    "<=": ["<", ">"],
    ">": [">=", "<="],
    ">=": [">", "<"],
    "<<": [">>"],
    ">>": ["<<"],
    "==": ["!="],
    "!=": ["=="],
    "&&": ["||"],
    "||": ["&&"],
    "!": [""],
    "true": ["false"],
    "false": ["true"],
    "fabs": [""],
}
NO_TYPES = {"return", "else", "case", "goto", "sizeof"}


class Mutant(NamedTuple):
    name: str
    file: str
    start: int
    end: int
    new: str

    def apply(self, text):
        return text[: self.start] + self.new + text[self.end :]

    def line(self, text):
        """The line it changes, to be read by people and to notice that a name has moved to another place."""
        begin = text.rfind("\n", 0, self.start) + 1
        return " ".join(text[begin : text.find("\n", self.start)].split())


def other_number(text):
    """One more for a small whole number, a thousandth more for any other."""
    hexadecimal = text[:2].lower() == "0x"
    digits = text.rstrip("uUlL" if hexadecimal else "uUlLfF")
    value = float.fromhex(digits) if hexadecimal else float(digits)
    if value < 1000 and value == int(value):
        value = int(value) + 1
        return f"{value}.0" if "." in digits else str(value)
    whole = digits.isdigit() or (hexadecimal and value == int(value))
    return str(int(value * 1.001)) if whole else repr(value * 1.001)


def binary(tokens, i):
    """Is this operator one of two operands? clang-format puts a space behind such, and none behind others."""
    return tokens[i][3] < tokens[i + 1][2]


def declares(tokens, name):
    """Is this name one that is being declared?"""
    before = tokens[name - 1]
    if before[0] == "word":
        return before[1] not in NO_TYPES
    if before[1] == "*":
        return not binary(tokens, name - 1)
    if before[1] != ",":
        return False
    depth, first = 0, name - 1  # one more of a declaration of several, or of the operands of an expression?
    while depth > 0 or tokens[first - 1][1] not in (";", "{", "}", "("):
        first -= 1
        depth += (tokens[first][1] in (")", "}", "]")) - (tokens[first][1] in ("(", "{", "["))
    second = first + 1
    while tokens[second][1] == "*" and not binary(tokens, second):
        second += 1
    return tokens[first][0] == tokens[second][0] == "word" and tokens[first][1] not in NO_TYPES


def size_of_array(tokens, i):
    """Is this number between the brackets of a declaration?"""
    if tokens[i - 1][1] != "[" or tokens[i + 1][1] != "]":
        return False
    if [t[1] for t in tokens[i + 2 : i + 4]] == ["=", "{"]:
        return True
    first = i - 1
    while tokens[first - 1][1] == "]":
        first -= 3
    return declares(tokens, first - 1)


def changes(tokens, i):
    kind, text = tokens[i][:2]
    if kind == "number":
        return [] if size_of_array(tokens, i) else [other_number(text)]
    if text in ("+", "-", "*", "/") and not binary(tokens, i):
        return [""] if text == "-" else []
    return CHANGES.get(text, [])


def owner_of(head):
    """The name that a definition at the top level of a file gives, from the tokens it starts with."""
    words = [token[1] for token in head]
    if "enum" in words[:1]:
        return "enum"
    for i, word in enumerate(words):
        if word in ("(", "=", "[") and i > 0 and head[i - 1][0] == "word":
            made = words[i - 1] in ("BATCH", "METHOD", "SCENE") and i + 1 < len(words)  # a name made by a macro
            return words[i + 1] if made else words[i - 1]
    return words[-1] if words else ""


def mutants_of(name, text):
    tokens = [(m.lastgroup, m.group(), m.start(), m.end()) for m in TOKEN.finditer(text)]
    tokens = [token for token in tokens if token[0] != "skip"]
    found, count = [], {}
    depth, head = 0, []
    for i, (_, old, start, end) in enumerate(tokens):
        if depth == 0:
            if old in (";", "}"):
                head = []
            else:
                head.append(tokens[i])
        for new in changes(tokens, i):
            key = f"{name}:{owner_of(head)}:{old} to {new or 'nothing'}"
            count[key] = count.get(key, 0) + 1
            found.append(Mutant(f"{key}:{count[key]}", f"src/{name}", start, end, new))
        depth += (old == "{") - (old == "}")
        if depth == 0 and old == "}":
            head = []
    return found


def generate(src):
    """All mutants of the files of a folder."""
    return [
        mutant
        for path in sorted(path for path in pathlib.Path(src).iterdir() if path.suffix in (".c", ".h"))
        for mutant in mutants_of(path.name, path.read_text(encoding="utf-8"))
    ]


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    for each in generate(sys.argv[1]):
        source = (pathlib.Path(sys.argv[1]) / pathlib.Path(each.file).name).read_text(encoding="utf-8")
        print(f"{each.name}\t{each.line(source)}")
