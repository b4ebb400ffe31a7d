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
      | (?P<operator>->|\+\+|--|[-+*/<>=!]=|&&|\|\||.)""",
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
    "==": ["!="],
    "!=": ["=="],
    "&&": ["||"],
    "||": ["&&"],
    "!": [""],
    "true": ["false"],
    "false": ["true"],
    "fabs": [""],
}
ALWAYS_BINARY = set(CHANGES) - set("+-*/!") - {"true", "false", "fabs"}

# What a pointer is declared with, besides the spring_ types of the headers.
TYPE = re.compile(r"char|const|double|bool|void|size_t|uint64_t|coefficients|propagator|"
                  r"spring_(state|params|rates|roots|clock|method_row)")


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
    digits = text.rstrip("uUlLfF")
    value = float.fromhex(digits) if digits[:2].lower() == "0x" else float(digits)
    if value < 1000 and value == int(value):
        value = int(value) + 1
        return f"{value}.0" if "." in digits else str(value)
    return str(int(value * 1.001)) if digits.isdigit() else repr(value * 1.001)


def operand_ends_with(token):
    """Is what follows this token a binary operator?"""
    return token is not None and (
        token[0] == "number"
        or token[1] in (")", "]")
        or (token[0] == "word" and token[1] != "return" and not TYPE.fullmatch(token[1]))
    )


def changes(tokens, i):
    kind, text = tokens[i][:2]
    before = tokens[i - 1] if i > 0 else None
    if kind == "number":
        size_of_array = before[1] == "[" and [t[1] for t in tokens[i + 1 : i + 4]] == ["]", "=", "{"]
        return [] if size_of_array else [other_number(text)]
    if text in ("+", "-", "*", "/", "&"):
        if operand_ends_with(before):
            return CHANGES.get(text, [])
        return [""] if text == "-" else []
    return CHANGES.get(text, [])


def owner_of(head):
    """The name that a definition at the top level of a file gives, from the tokens it starts with."""
    for i, token in enumerate(head):
        if token[1] in ("(", "=", "[") and i > 0 and head[i - 1][0] == "word":
            return head[i - 1][1]
    return head[-1][1] if head else ""


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
