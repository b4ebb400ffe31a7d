#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes the library in two files, springstep.h and springstep.c, from its headers and sources as they are.

    generate.py SOURCE-ROOT OUTPUT-DIRECTORY DEPFILE SOURCE... -- COMPILER...      SOURCE: every .c file of the library

springstep.c reads itself: what is compiled once for each meaning of `real` stands in it once. Each such reading is a
pass, and names that belong to a pass, or to a precision, are macros then, which add its name. What that asks of src/:

  * A header has a guard, and includes what it needs before anything else. Or it has none: then it is inserted where it is
    included or, if that is at several places, read there by springstep.c from its one place.
  * A source that does nothing but define and include is a pass: of kernels, if it includes a header, else of the float
    twins of the sources that it includes.
  * A header that knows `real` declares no function and no type that several passes share. Those that do say
    SPRING_INTERNAL.
  * No two sources have a name at file scope in common, and none is a field of a structure of all passes.
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

PUBLIC = ["version", "spring", "clock", "batch", "scene"]

# Files that are left out with a part of the library.
PARTS = {
    "SPRING_NO_BATCH": r"batch",
    "SPRING_NO_SCENE": r"scene|force_kernels|motion_kernels|grid|renumber",
}

HEADER = """\
/*
 * springstep {version}: a library that moves springs through time, in two files, springstep.h and springstep.c.
 *
 * To use it, copy both into your program, compile springstep.c as C11 with the rest of it, and include springstep.h, from
 * C99 or C++11. It needs no flag; -O2 or -O3 makes it fast, -ffast-math is refused, and some systems want -lm.
 *
 *     #include "springstep.h"
 *
 *     spring_state s = {{.x = 1}};                                             // 1 m from rest
 *     const spring_params p = {{.mass = 1, .stiffness = 40, .damping = 2}};    // kg, N/m, N s/m
 *     spring_advance(&s, &p, SPRING_LEAPFROG, 1.0 / 60, 1);                   // a frame later
 *
 * To leave parts out, compile springstep.c with -DSPRING_NO_BATCH (many independent springs), -DSPRING_NO_SCENE (springs
 * that join particles) or -DSPRING_NO_FLOAT (batches and scenes in float). They stay declared; the linker tells who calls
 * them. spring_self_test() then looks at the arithmetic alone.
 *
 * Both files are put together from the headers and sources of the library when it is built; change those.
 *
{license}
 */
"""

SOURCE = """\
/* SPDX-License-Identifier: MIT */
/*
 * springstep {version}: see springstep.h. This file reads itself, so it has to be called springstep.c.
 *
 * First stands what is read once. The rest is read in several passes, in each with another meaning of `real`: the number,
 * or the vector of numbers, that formulas are written on. All names but those of springstep.h are static and begin with
 * spring_; no macro and no pragma is left behind.
 */
"""

BEGIN = """\
#include "springstep.h"

{systems}
#define SPRING_INTERNAL static
#define SPRING_TABLE    static

#if defined(__GNUC__)
#if !defined(__clang__)
#pragma GCC push_options
#endif
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function" /* no pass needs all that it reads */
#endif

"""

END = """\
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
#if defined(__clang__)
#pragma STDC FP_CONTRACT DEFAULT
#elif defined(__GNUC__)
#pragma GCC pop_options
#endif

"""

NAMES = """\
/* Names of a precision, and of a pass: spring_float_batch_block, spring_v256_real. */
#define SPRING_JOIN(of, name) spring_##of##_##name
#define SPRING_NAME(of, name) SPRING_JOIN(of, name)

"""

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"]+)".*\n', re.M)
TOKEN = re.compile(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])*\'|[A-Za-z_]\w*|\.?\d[\w.]*|\S')

ONCE, PRECISION, REAL = range(3)  # a file is read once, for each precision, or in each pass that needs it


class File:
    """A header or source, without licence tag and guard."""

    def __init__(self, path, src):
        self.path = path
        self.name = path.relative_to(src).as_posix()
        text = path.read_text().replace("/* SPDX-License-Identifier: MIT */\n", "")
        guard = re.search(r"#ifndef (SPRINGSTEP_\w+_H)\n#define \1\n(.*)#endif\n\Z", text, re.S)
        self.guarded = guard is not None
        self.text = text[: guard.start()] + guard.group(2) if guard else text
        self.includes = [(path.parent / name).resolve() for name in INCLUDE.findall(self.text)]
        code = without_comments(self.text)
        self.is_pass = path.suffix == ".c" and not re.sub(r"#[^\n]*|\s", "", code)
        words = set(re.findall(r"\w+", code))
        if "SPRING_VECTOR" in words or any(word.startswith("SPRING_SHAPE_") for word in words):
            self.scope = REAL
        else:
            self.scope = PRECISION if "SPRING_FLOAT" in words else ONCE
        self.is_float = "#define SPRING_FLOAT\n" in text
        self.readers = set()  # pass, and is it float?

    def settings(self):
        """The directives before the first #include of a source: they are for all that is read after them."""
        include = re.search(r"^#\s*include", self.text, re.M)
        return re.findall(r"^#.*\n", self.text[: include.start()], re.M) if include else []

    def code(self):
        """The text without these."""
        text = self.text
        for line in self.settings() if self.path.suffix == ".c" or not self.guarded else []:
            text = text.replace(line, "", 1)
        return text


def without_comments(text):
    return re.sub(r"/\*.*?\*/|//[^\n]*", " ", text, flags=re.S)


class Library:
    def __init__(self, root, sources, compiler):
        self.src = (root / "src").resolve()
        self.include = root / "include"
        self.files = {}
        self.sources = [self.load(Path(source).resolve()) for source in sources]
        passes = [source for source in self.sources if source.is_pass]
        self.kernels = [source for source in passes if source.includes[-1].suffix == ".h"]
        self.kernel_body = self.files[self.kernels[0].includes[-1]]
        (self.floats,) = [source for source in passes if source not in self.kernels]
        self.twins = [self.files[path] for path in self.floats.includes]
        self.find_scopes()
        self.order = []  # a file stands behind those that it includes; kernels first, since they begin a target
        for source in self.kernels + self.sources:
            self.place(source)
        self.declared = {}  # name: the least scope of a file that declares it
        self.preprocess(compiler)

    def load(self, path):
        if path not in self.files:
            file = self.files[path] = File(path, self.src)
            for included in file.includes:
                self.load(included)
        return self.files[path]

    def find_scopes(self):
        changed = True
        while changed:
            changed = False
            for file in self.files.values():
                near = [self.files[path] for path in file.includes]
                if self.is_inserted(file) or self.is_part(file):
                    near += self.sites(file)
                scope = max([file.scope] + [other.scope for other in near])
                changed = changed or scope != file.scope
                file.scope = scope

    def place(self, file):
        for path in file.includes:
            self.place(self.files[path])
        if file not in self.order:
            self.order.append(file)

    def sites(self, file):
        return [other for other in self.files.values() if file.path in other.includes]

    def twins_text(self):
        return self.files[self.src / "twins.h"].text

    def is_inserted(self, file):
        return not file.guarded and file.path.suffix == ".h" and file is not self.kernel_body and not self.is_part(file)

    def is_part(self, file):
        return not file.guarded and file is not self.kernel_body and len(self.sites(file)) > 1 and not file.path.suffix == ".c"

    def pass_of(self, source):
        if source in self.kernels:
            return "KERNELS"
        if source in self.twins or source is self.floats:
            return "SHAPES"
        return "ONE"

    def preprocess(self, compiler):
        """What the compiler reads for each source, with vectors and without, headers of the system being empty."""
        headers = list(self.files) + list(self.include.glob("*/*.h"))
        systems = {name for path in headers for name in re.findall(r"#\s*include <([\w.]+)>", path.read_text())}
        with tempfile.TemporaryDirectory() as empty:
            for name in systems:
                (Path(empty) / name).touch()
            for source in self.sources:
                reader = self.pass_of(source), source.is_float
                for vectors in "01":
                    command = compiler + ["-std=c11", "-E", "-nostdinc", "-isystem", empty, "-I", str(self.include)]
                    command += ["-DSPRING_VECTORS=" + vectors, "-D__x86_64__", str(source.path)]
                    text = subprocess.run(command, check=True, stdout=subprocess.PIPE, encoding="utf-8").stdout
                    self.look_at(text, reader)

    def look_at(self, text, reader):
        file, tokens, depth = None, [], 0
        for line in text.split("\n"):
            marker = re.match(r'#.* "(.*?)"', line)
            if marker:
                file = self.files.get(Path(marker.group(1)).resolve())
                if file:
                    file.readers.add(reader)
                continue
            for token in TOKEN.findall(without_directive(line)):
                depth -= token in ("}", ")", "]")
                tokens.append((token, depth))
                depth += token in ("{", "(", "[")
                if depth == 0 and (token == ";" or (token == "}" and is_function(tokens))):
                    for name in declared_by(tokens) if file else []:
                        self.declared[name] = min(self.declared.get(name, REAL), file.scope)
                    tokens = []


def without_directive(line):
    return "" if line.startswith("#") else line


def is_function(tokens):
    brace = next(i for i, (token, _) in enumerate(tokens) if token == "{")
    return tokens[brace - 1][0] == ")"


def declared_by(tokens):
    """The names that a declaration introduces at file scope."""
    names = []
    for i, (token, depth) in enumerate(tokens):  # tags, and the constants of enumerations
        if token not in ("struct", "union", "enum") or depth > 0:
            continue
        brace = i + 1 if tokens[i + 1][0] == "{" else i + 2
        if tokens[brace][0] != "{":
            continue
        names += [name for name, _ in tokens[i + 1 : brace]]
        first = True
        for name, inner in tokens[brace + 1 :] if token == "enum" else []:
            if inner == 0:
                break
            if first:
                names.append(name)
            first = inner == 1 and name == ","
    names += declarators([token for token, depth in tokens if depth == 0])
    return names


def declarators(outer):
    """The names before ; , = or a bracket, of a declaration without what is in its brackets."""
    while "__attribute__" in outer:
        at = outer.index("__attribute__")
        outer = outer[:at] + outer[at + 3 :]
    names, value = [], False
    for before, name, after in zip([""] + outer, outer, outer[1:]):
        value = value and name != ","
        if re.match(r"[A-Za-z_]", name) and after in list(";,=([") and not value:
            if before not in ("struct", "union", "enum") and name != "_Static_assert":
                names.append(name)
            if after == "(":
                break
        value = value or after == "="
    return names


# ------------------------------------------------------------------------------------------------------- the output


def tidy(text):
    """Without conditionals that hold nothing, and with single blank lines."""
    before = None
    while before != text:
        before = text
        text = re.sub(r"^#if.*\n(?:\s*#el(?:if|se).*\n)*\s*#endif.*\n", "", text, flags=re.M)
        text = re.sub(r"\n{3,}", "\n\n", text)
    return text.strip("\n") + "\n"


def part(file):
    return "SPRING_READ_" + file.path.stem.upper()


def body(library, file):
    """The text of a file, with what it includes inserted, or read, or gone because it stands before it."""

    def insert(match):
        other = library.files[(file.path.parent / match.group(1)).resolve()]
        if library.is_part(other):
            return f'#define {part(other)}\n#include "springstep.c"\n'
        return body(library, other) if library.is_inserted(other) else ""

    text = INCLUDE.sub(insert, file.code())
    return tidy(re.sub(r"^#include <(?!.*(?:intrin|simd)).*>.*\n", "", text, flags=re.M))


def conditions(file):
    """Of a section that is not read once."""
    found = []
    passes = sorted({name for name, _ in file.readers})
    if file.scope == PRECISION:
        found.append("SPRING_PASS == SPRING_SHAPES")
    elif len(passes) == 1:
        found.append(f"SPRING_PASS == SPRING_{passes[0]}")
    elif len(passes) == 2:
        found.append("SPRING_PASS != SPRING_" + ({"KERNELS", "ONE", "SHAPES"} - set(passes)).pop())
    if not any(is_float for _, is_float in file.readers) and passes != ["ONE"]:
        found.append("!defined(SPRING_FLOAT)")
    return found


def left_out(file):
    return [macro for macro, names in PARTS.items() if re.match(names, file.name)]


def unless_left_out(file, line):
    return "".join(f"#ifndef {macro}\n" for macro in left_out(file)) + line + "#endif\n" * len(left_out(file))


def section(library, file):
    text = f"/* {'-' * (114 - len(file.name))} {file.name} */\n\n"
    found = conditions(file) if file.scope != ONCE else []
    found += [f"!defined({macro})" for macro in left_out(file)]
    if not found:
        return text + body(library, file) + "\n"
    if len(found) > 1:
        found = [f"({each})" if " " in each else each for each in found]
    return text + f"#if {' && '.join(found)}\n" + body(library, file) + "#endif\n\n"


def read(comment, lines):
    """One pass: definitions, and the file once more."""
    opening = [line for line in lines if line.startswith("#if ")]
    lines = [line for line in lines if not line.startswith("#if ")]
    return comment + "".join(opening + lines) + '#include "springstep.c"\n' + "#endif\n" * len(opening) + "\n"


def passes(library):
    """All passes of double, and of float."""
    shapes = sorted({unless_left_out(file, line) for file in library.twins for line in file.settings()})
    one = sorted({line for file in library.order if file.readers and {name for name, _ in file.readers} == {"ONE"}
                  and file.path.suffix == ".c" and file.scope == REAL for line in file.settings()})
    for is_float in False, True:
        f = "f" if is_float else ""
        if is_float:
            yield "#ifndef SPRING_NO_FLOAT\n#define SPRING_FLOAT\n#define SPRING_PRECISION float\n\n"
        else:
            yield "#define SPRING_PRECISION double\n\n"
        yield read("/* What is there once for each precision: batches and scenes, but for kernels. */\n",
                   ["#define SPRING_PASS SPRING_SHAPES\n", f"#define SPRING_OF many{f}\n"] + shapes)
        if not is_float:
            yield read("/* One spring. */\n", ["#define SPRING_PASS SPRING_ONE\n", "#define SPRING_OF one\n"] + one)
        yield "#if !defined(SPRING_NO_BATCH) || !defined(SPRING_NO_SCENE)\n"
        for source in library.kernels:
            if source.is_float == is_float:
                settings = re.findall(r"^#(?:define|if).*\n", source.text, re.M)
                settings = [line for line in settings if line != "#define SPRING_FLOAT\n"]
                of = f"#define SPRING_OF {source.path.stem.split('_')[-1]}{f}\n"
                comment = re.match(r"/\*.*?\*/\n", source.text, re.S).group()
                yield read(comment, ["#define SPRING_PASS SPRING_KERNELS\n", of] + settings)
        yield "#endif\n\n#undef SPRING_PRECISION\n" + ("#undef SPRING_FLOAT\n#endif\n\n" if is_float else "")


def macros(text):
    return set(re.findall(r"^\s*#\s*define\s+(\w+)", text, re.M))


def undefine(names):
    return "".join(f"#undef {name}\n" for name in sorted(names)) + "\n"


def source_text(library, version):
    shown = [file for file in library.order if not file.is_pass and not library.is_inserted(file) and not library.is_part(file)]
    once = [section(library, file) for file in shown if file.scope == ONCE]
    passed = [section(library, file) for file in shown if file.scope != ONCE]
    of_real = "".join(body(library, file) for file in shown if file.scope == REAL)
    of_precision = "".join(body(library, file) for file in shown if file.scope == PRECISION)
    body_settings = "".join(library.kernel_body.settings())
    parts = [file for file in library.files.values() if library.is_part(file)]

    public = "".join(path.read_text() for path in library.include.glob("*/*.h"))
    known = set(re.findall(r"\bspring_\w+", without_comments(public + library.twins_text())))
    names = {scope: sorted(name for name, least in library.declared.items() if least == scope and name not in known
                           and not (scope == ONCE and name.startswith("spring_"))) for scope in range(3)}
    systems = {name for file in library.files.values() for name in re.findall(r"#include <(\w+\.h)>", file.text)}
    systems = sorted(name for name in systems if not re.search("intrin|simd", name))
    # No header of the system stands behind a name that might be one of its own.
    first = [text for text in once if "intrin" in text]
    own = "".join(f"#define {name} spring_own_{name}\n" for name in names[ONCE])
    own_once = "/* Names of what is read once. */\n" + own + "\n"
    pass_names = NAMES
    for scope, of in (PRECISION, "SPRING_PRECISION"), (REAL, "SPRING_OF"):
        pass_names += "".join(f"#define {name} SPRING_NAME({of}, {name})\n" for name in names[scope]) + "\n"
    kinds = "".join(f"#define SPRING_{name} {i}\n" for i, name in enumerate(["SHAPES", "ONE", "KERNELS"], 1)) + "\n"
    all_passes = "/* " + "-" * 108 + " passes */\n\n" + kinds + "".join(passes(library))
    outer = BEGIN.format(systems="".join(f"#include <{name}>\n" for name in systems))
    outer += "".join(first) + own_once + "".join(text for text in once if text not in first) + pass_names + all_passes
    inner = f"#if SPRING_PASS == SPRING_KERNELS\n{body_settings}#endif\n\n" + "".join(passed)
    read_parts = "".join(f"/* {'-' * (114 - len(file.name))} {file.name} */\n\n#elif defined({part(file)})\n#undef {part(file)}\n\n" + body(library, file) + "\n" for file in parts)
    of_passes = macros(all_passes) - macros(kinds)
    gone = of_passes - {"SPRING_PRECISION", "SPRING_FLOAT"} | macros(of_real + body_settings) - macros("".join(body(library, file) for file in parts))
    text = SOURCE.format(version=version) + "#if !defined(SPRING_PASS)\n\n" + outer
    text += undefine(macros(outer + of_precision) - of_passes)
    text += END + read_parts + "#else\n\n" + inner + undefine(gone) + "#endif\n"
    return tidy(text)


def header_text(root, version):
    license_text = (root / "LICENSE").read_text().strip()
    text = "/* SPDX-License-Identifier: MIT */\n"
    text += HEADER.format(version=version, license="\n".join((" * " + line).rstrip() for line in license_text.split("\n")))
    text += "#ifndef SPRINGSTEP_H\n#define SPRINGSTEP_H\n\n"
    for name in PUBLIC:
        one = (root / "include" / "springstep" / (name + ".h")).read_text()
        one = one.replace("/* SPDX-License-Identifier: MIT */\n", "")
        text += re.sub(r"#include <springstep/.*\n", "", one) + "\n"
    return tidy(text + "#endif\n")


def main(root, output, depfile, *rest):
    root, output = Path(root), Path(output)
    end = rest.index("--")
    version = re.search(r'SPRING_VERSION "(.*)"', (root / "include/springstep/version.h").read_text()).group(1)
    library = Library(root, rest[:end], list(rest[end + 1 :]))
    (output / "springstep.h").write_text(header_text(root, version))
    (output / "springstep.c").write_text(source_text(library, version))
    read_files = sorted(map(str, [*library.files, *library.include.glob("*/*.h"), root / "LICENSE"]))
    Path(depfile).write_text("single/springstep.h: " + " ".join(read_files).replace("\\", "/") + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
