#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What other languages know of the library, from what the public headers declare.

    declarations.py python OUTPUT INCLUDE-DIRECTORY - COMPILER...           the C source of springstep._native, by cffi
    declarations.py types OUTPUT INCLUDE-DIRECTORY - COMPILER...            its types, for type checkers
    declarations.py lua OUTPUT INCLUDE-DIRECTORY TEMPLATE LUA-DIRECTORY LIBRARY-DIRECTORY COMPILER...   springstep.lua, and
                                                               the directories to which it and the library are installed

So a new function of a header is there by itself. What cffi takes for the size of a structure and the place of a field is
checked against the compiler's when the module is compiled and loaded; for LuaJIT bindings/lua/test.lua does so.
"""
import os
import re
import subprocess
import sys
from pathlib import Path

# Forces of scenes: C calls Python. They only exist in Python, and are given no name in C.
CALLBACKS = """
extern "Python" void springstep_force(void *, double, size_t, const double *const *, const double *const *,
                                      double *const *);
extern "Python" void springstep_forcef(void *, double, size_t, const float *const *, const float *const *,
                                       float *const *);
"""

# What springstep.sweep() calls of tools/sweep, for the points of spring-sweep.
SWEEP = """
typedef struct sweep_memory sweep_memory;
typedef struct { double number[...]; int status; } sweep_result;
typedef struct { int parameter; ...; } axis;
typedef struct { const char *column; ...; } sweep_parameter_info;
typedef struct {
    size_t axes;
    axis axis[...];
    size_t methods;
    spring_method method[...];
    size_t measures;
    int measure[...];
    uint64_t points;
    char message[...];
    ...;
} grid;
extern const sweep_parameter_info sweep_parameters[];
extern const char *const sweep_measure_names[];
extern const char *const sweep_status_names[];
void grid_init(grid *g);
void grid_clear(grid *g);
bool grid_set_scene(grid *g, const char *name);
bool grid_add_axis(grid *g, const char *text);
bool grid_add_methods(grid *g, const char *names);
bool grid_add_measures(grid *g, const char *names);
bool grid_finish(grid *g);
bool grid_measure(const grid *g, sweep_memory *memory, uint64_t first, uint64_t count, double *values,
                  sweep_result *results);
sweep_memory *sweep_memory_new(void);
void sweep_memory_free(sweep_memory *memory);
"""

# What Scene.run() calls: `steps` steps, and frames after every `every` of them and after the last one. Returns a status and the
# number of frames that are recorded.
RECORD = """
static spring_status springstep_record{f}(spring_scene{f} *s, spring_method m, double dt, uint64_t every, uint64_t steps,
                                          size_t frames, size_t *recorded, size_t particles, size_t numbers,
                                          double *times, {number} *position, {number} *velocity)
{{
    for (*recorded = 0; *recorded < frames; ++*recorded) {{
        const uint64_t n = every < steps ? every : steps;
        const spring_status status = n > 0 ? spring_scene{f}_advance(s, m, dt, n) : SPRING_OK;
        if (status != SPRING_OK)
            return status;
        steps -= n;
        times[*recorded] = spring_scene{f}_time(s);
        spring_scene{f}_get{f}(s, SPRING_POSITION, position + *recorded * numbers, 0, 0, particles);
        if (velocity != NULL)
            spring_scene{f}_get{f}(s, SPRING_VELOCITY, velocity + *recorded * numbers, 0, 0, particles);
    }}
    return SPRING_OK;
}}
"""
RECORDS = "".join(RECORD.format(f=f, number=number) for f, number in (("", "double"), ("f", "float")))

# The objects of cffi in _native.pyi.
TYPES = '''# SPDX-License-Identifier: MIT
# Types of springstep._native. Generated from the headers: edit those instead.
from collections.abc import Callable, Iterator, Sequence
from typing import Any

class CData:
    """A C value, pointer, structure or array."""

    def __getattr__(self, name: str) -> Any: ...
    def __setattr__(self, name: str, value: Any) -> None: ...
    def __getitem__(self, index: int | slice) -> Any: ...
    def __setitem__(self, index: int | slice, value: Any) -> None: ...
    def __add__(self, count: int) -> CData: ...
    def __sub__(self, other: Any) -> Any: ...
    def __call__(self, *arguments: Any) -> Any: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[Any]: ...
    def __int__(self) -> int: ...
    def __float__(self) -> float: ...

_CData = CData

class FFI:
    """See https://cffi.readthedocs.io/en/stable/ref.html."""

    CData: type[_CData]
    NULL: _CData
    def addressof(self, value: Any, *fields: str | int) -> _CData: ...
    def buffer(self, pointer: _CData, size: int = ...) -> Any: ...
    def callback(self, kind: Any, function: Callable[..., Any], error: Any = ..., onerror: Any = ...) -> _CData: ...
    def cast(self, kind: Any, value: Any) -> _CData: ...
    def def_extern(self, name: str = ..., error: Any = ..., onerror: Any = ...) -> Callable[[Callable[..., Any]], Any]: ...
    def from_buffer(self, kind: Any, value: Any = ..., require_writable: bool = ...) -> _CData: ...
    def from_handle(self, handle: _CData) -> Any: ...
    def gc(self, value: _CData, destructor: Callable[..., Any] | None, size: int = ...) -> _CData: ...
    def getctype(self, kind: Any, extra: str = ...) -> str: ...
    def list_types(self) -> tuple[list[str], list[str], list[str]]: ...
    def memmove(self, to: Any, of: Any, bytes: int) -> None: ...
    def new(self, kind: Any, value: Any = ...) -> _CData: ...
    def new_handle(self, value: object) -> _CData: ...
    def offsetof(self, kind: Any, *fields: str | int) -> int: ...
    def sizeof(self, kind: Any) -> int: ...
    def string(self, value: Any, most: int = ...) -> Any: ...
    def typeof(self, kind: Any) -> Any: ...
    def unpack(self, value: _CData, count: int) -> Any: ...

class Lib:
    """Every function and constant of the headers."""

'''


def included(include):
    """C that includes every public header."""
    return "".join(f"#include <springstep/{header.name}>\n" for header in sorted((include / "springstep").glob("*.h")))


def declarations(include, compiler):
    """What the headers declare, preprocessed."""
    text = subprocess.run([*compiler, "-E", "-I", include, "-x", "c", "-"], input=included(include), text=True, check=True,
                          stdout=subprocess.PIPE).stdout
    # "# LINE FILE" says where the lines after it come from: those of the C library are left out.
    ours, kept = False, []
    for line in text.splitlines():
        if marker := re.match(r'#(?:line)? *\d+ "(.*?)"', line):
            ours = Path(marker[1]).parent.name == "springstep"
        elif ours and line.strip() and not line.startswith("#"):
            kept.append(line)
    return re.sub(r"__attribute__\s*\(\(.*?\)\)\s*\)?|__declspec\(\w+\)", "", "\n".join(kept))


def macros(include, value):
    """(name, value) of those whose value is written like that."""
    for header in sorted((include / "springstep").glob("*.h")):
        yield from re.findall(rf"^#define (SPRING_\w+) +{value}", header.read_text(), re.M)


def numbers(include):
    return macros(include, r"(?:UINT32_C\()?(\d+)\b")


def parsed(include, compiler):
    """What cffi knows of the headers."""
    from cffi import FFI
    ffi = FFI()
    ffi.cdef(declarations(include, compiler) + "".join(f"\n#define {name} ..." for name, _ in numbers(include)) + CALLBACKS + SWEEP)
    ffi.cdef(re.sub(r"\{.*?^\}", ";", RECORDS, flags=re.S | re.M))
    return ffi


def python(include, _, compiler, output):
    ffi = parsed(include, compiler)
    ffi.set_source("springstep._native", included(include) + '#include "sweep/grid.h"\n' + RECORDS)
    ffi.emit_c_code(str(output))


def type_in_python(c, argument):
    """The type of a C type: cffi accepts more as an argument than it returns."""
    kind, name = type(c).__name__, getattr(c, "name", "")
    if kind == "PrimitiveType":
        return {"double": "float", "float": "float", "_Bool": "bool"}.get(name, "int")
    if kind in ("VoidType", "EnumType"):
        return "None" if kind == "VoidType" else "int"
    pointed = getattr(getattr(c, "totype", None), "name", "")
    argument = argument and getattr(c, "quals", 0)  # a list may be passed as a pointer to const
    if argument and pointed in ("double", "float", "uint8_t", "uint32_t"):
        return "CData | Sequence[float]" if pointed in ("double", "float") else "CData | Sequence[int]"
    return "CData | bytes" if argument and pointed == "char" else "CData"


def types(include, _, compiler, output):
    ffi = parsed(include, compiler)
    lines = [f"    {name}: int" for name in ffi._parser._int_constants]
    for declared, (c, _) in ffi._parser._declarations.items():
        kind, name = declared.split(" ", 1)
        if kind == "function":
            arguments = ", ".join(type_in_python(argument, True) for argument in c.args)
            lines.append(f"    {name}: Callable[[{arguments}], {type_in_python(c.result, False)}]")
        elif kind in ("macro", "variable", "extern_python"):
            lines.append(f"    {name}: {'int' if kind == 'macro' else 'CData'}")
    output.write_text(TYPES + "\n".join(sorted(lines)) + "\n\nffi: FFI\nlib: Lib\n")


def lua(include, template, directories_and_compiler, output):
    module, library, *compiler = directories_and_compiler
    constants = "".join(f"\n  {name} = {value}," for name, value in numbers(include))
    fields = {"LIBRARY_FOLDER": os.path.relpath(library, module).replace("\\", "/"),
              "DECLARATIONS": f"{declarations(include, compiler)}\nenum {{{constants}\n}};",
              **dict(macros(include, '"(.*)"'))}
    output.write_text(re.sub(r"@(\w+)@", lambda field: fields[field[1]], Path(template).read_text()))


def main():
    language, output, include, template, *compiler = sys.argv[1:]
    {"python": python, "types": types, "lua": lua}[language](Path(include), template, compiler, Path(output))


main()
