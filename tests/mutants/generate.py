# SPDX-License-Identifier: MIT
"""Generates mutants of C files: changes every operator, comparison, constant and statement in turn.

A mutant is named definition:change:ordinal. The definition is a function, a table, an enumeration or a macro, and the
ordinal counts the same change within it. So names do not change with edits elsewhere, comments or layout. Comments,
strings, preprocessor lines (except macros with parameters), declarations of pointers and sizes of arrays are not
changed. A macro that is called between two definitions belongs to the second.
"""

import hashlib
import re
from typing import NamedTuple

TOKEN = re.compile(
    r"""(?P<space>/\*.*?\*/|//[^\n]*|\\\n|\s+)
      | (?P<directive>^[ \t]*\#(?:/\*.*?\*/|\\\n|[^\n])*)
      | (?P<text>"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*')
      | (?P<number>(?:0[xX][0-9a-fA-F.]+(?:[pP][+-]?\d+)?|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)[uUlLfF]*)
      | (?P<word>[A-Za-z_]\w*)
      | (?P<operator>->|\+\+|--|<<|>>|[-+*/<>=!&|]=|&&|\|\||.)""",
    re.VERBOSE | re.MULTILINE | re.DOTALL,
)
MACRO = re.compile(r"[ \t]*#[ \t]*define[ \t]+(\w+)\([^)]*\)")

CHANGES = {
    "+": ["-"],
    "-": ["+"],
    "*": ["/"],
    "/": ["*"],
    "&": ["|"],
    "|": ["&"],
    "+=": ["-="],
    "-=": ["+="],
    "*=": ["/="],
    "/=": ["*="],
    "&=": ["|="],
    "|=": ["&="],
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
NO_TYPES = {"return", "else", "case", "goto", "sizeof", "break", "continue", "default"}


class Token(NamedTuple):
    kind: str
    text: str
    start: int
    end: int


class Definition(NamedTuple):
    name: str
    tokens: list
    is_macro: bool = False

    def body(self):
        """Where the body of a function begins and ends, braces included; None if this is none."""
        for before, token in zip(self.tokens, self.tokens[1:]):
            if token.text == "{":
                return (token.start, self.tokens[-1].end) if before.text == ")" else None
        return None

    def declares_only(self):
        return not any(token.text in ("{", "=") for token in self.tokens)

    def code(self):
        """Changes with the definition, and not with its comments or layout."""
        return hashlib.sha256(" ".join(token.text for token in self.tokens).encode()).hexdigest()[:12]


class Change(NamedTuple):
    name: str
    start: int
    end: int
    new: str

    def apply(self, text):
        return text[: self.start] + self.new + text[self.end :]


def scan(text, start, end):
    matches = (match for match in TOKEN.finditer(text, start, end) if match.lastgroup != "space")
    return [Token(match.lastgroup, match.group(), match.start(), match.end()) for match in matches]


def opening(tokens, i):
    """The index of the parenthesis that this one closes."""
    depth = 1
    while depth > 0 and i > 0:
        i -= 1
        depth += (tokens[i].text == ")") - (tokens[i].text == "(")
    return i


def name_of(tokens):
    """The name that a definition gives, from all its tokens."""
    words = [token.text for token in tokens]
    head = words[: words.index("{")] if "{" in words else words[:-1]
    if "enum" in head[-2:]:
        return words[len(head) + 1]  # the first of its constants: most have no other name
    if "=" in head:
        head = head[: head.index("=")]
        return head[head.index("[") - 1] if "[" in head else head[-1]
    if head[-1:] != [")"]:
        return head[-1] if head else ""
    at = opening(tokens, len(head) - 1)  # of the parameters
    return head[at - 2] if head[at - 1] == ")" else head[at - 1]  # SCENE(advance)(...) is named by a macro


def definitions(text):
    """All that a file defines, and what else ends in a semicolon or a brace."""
    depth, tokens = 0, []
    for token in scan(text, 0, len(text)):
        if token.kind == "directive":
            macro = MACRO.match(token.text)
            if macro:
                yield Definition(macro.group(1), scan(text, token.start + macro.end(), token.end), is_macro=True)
            continue
        tokens.append(token)
        depth += (token.text == "{") - (token.text == "}")
        if depth == 0 and token.text in (";", "}"):
            yield Definition(name_of(tokens), tokens)
            tokens = []
    if depth != 0:
        raise ValueError("braces do not match")


def other_number(text):
    """One more for a small whole number, a thousandth more for any other."""
    hexadecimal = text[:2].lower() == "0x"
    digits = text.rstrip("uUlL" if hexadecimal and "p" not in text.lower() else "uUlLfF")
    value = float.fromhex(digits) if hexadecimal else float(digits)
    if value < 1000 and value == int(value):
        value = int(value) + 1
        return f"{value}.0" if "." in digits else str(value)
    whole = digits.isdigit() or (hexadecimal and value == int(value))
    return str(int(value * 1.001)) if whole else repr(value * 1.001)


def binary(tokens, i):
    """Is this operator one of two operands? clang-format puts a space behind such, and none behind others."""
    return i + 1 < len(tokens) and tokens[i].end < tokens[i + 1].start


def declares(tokens, name):
    """Is this name one that is being declared?"""
    before = tokens[name - 1]
    if before.kind == "word":
        return before.text not in NO_TYPES
    if before.text == "*":
        return not binary(tokens, name - 1)
    if before.text != ",":
        return False
    depth, first = 0, name - 1  # one more of a declaration of several, or of the operands of an expression?
    while first > 0 and (depth > 0 or tokens[first - 1].text not in (";", "{", "}", "(")):
        first -= 1
        depth += (tokens[first].text in (")", "}", "]")) - (tokens[first].text in ("(", "{", "["))
    second = first + 1
    while tokens[second].text == "*" and not binary(tokens, second):
        second += 1
    return tokens[first].kind == tokens[second].kind == "word" and tokens[first].text not in NO_TYPES


def size_of_array(tokens, i):
    """Is this number between the brackets of a declaration?"""
    if [token.text for token in tokens[i - 1 : i + 2 : 2]] != ["[", "]"]:
        return False
    if [token.text for token in tokens[i + 2 : i + 4]] == ["=", "{"]:
        return True
    first = i - 1
    while tokens[first - 1].text == "]":
        first -= 3
    return declares(tokens, first - 1)


def starts_statement(tokens, i):
    before = tokens[i - 1].text
    if before == ")":  # of a condition, not of a cast
        return tokens[opening(tokens, i - 1) - 1].text in ("if", "for", "while")
    return before in (";", "{", "}", "else")


def statement(tokens, i):
    """The offset behind the assignment, the call or the if (...) return ...; that begins at a token, or None."""
    if not starts_statement(tokens, i) or not (tokens[i].kind == "word" or tokens[i].text == "*"):
        return None
    name = i + 1 + (tokens[i + 1].text == "*")
    if tokens[i].text in NO_TYPES or tokens[i].kind == tokens[name].kind == "word" and declares(tokens, name):
        return None
    if tokens[i].text in ("if", "for", "while"):
        inner = next(j for j in range(i + 2, len(tokens)) if tokens[j].text == ")" and opening(tokens, j) == i + 1) + 1
        if tokens[i].text != "if" or tokens[inner].text not in ("return", "break", "continue"):
            return None
    for token in tokens[i:]:
        if token.text in ("{", "}", ";"):
            return token.end if token.text == ";" else None
    return None


def changes(tokens, i):
    kind, text = tokens[i][:2]
    if kind == "number":
        return [] if size_of_array(tokens, i) else [other_number(text)]
    if text in ("+", "-", "*", "/", "&") and not binary(tokens, i):
        return [""] if text == "-" else []
    return CHANGES.get(text, [])


def generate(text):
    """All mutants of a file: for each its definition and what is changed."""
    count = {}

    def change(definition, what, start, end, new):
        name = f"{definition.name}:{what}"
        count[name] = count.get(name, 0) + 1
        return definition, Change(f"{name}:{count[name]}", start, end, new)

    for definition in definitions(text):
        if definition.name == "_Static_assert":  # of no effect but to compile or not
            continue
        tokens = definition.tokens
        function = definition.body() is not None
        parentheses = 0
        for i, token in enumerate(tokens):
            parentheses += (token.text == "(") - (token.text == ")")
            for new in changes(tokens, i):
                yield change(definition, f"{token.text} to {new or 'nothing'}", token.start, token.end, new)
            end = statement(tokens, i) if function and parentheses == 0 and i > 0 else None
            if end:
                yield change(definition, "statement to nothing", token.start, end, ";")
