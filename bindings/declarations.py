#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What other languages know of the library, from what the public headers declare.

    declarations.py python OUTPUT INCLUDE-DIRECTORY - COMPILER...           the C source of springstep._native, by cffi
    declarations.py lua OUTPUT INCLUDE-DIRECTORY TEMPLATE COMPILER...       springstep.lua

So a new function of a header is there by itself. What cffi takes for the size of a structure and the place of a field is
checked against the compiler's when the module is compiled and loaded; for LuaJIT bindings/lua/test.lua does so.
"""
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


def python(include, _, compiler, output):
    from cffi import FFI
    ffi = FFI()
    ffi.cdef(declarations(include, compiler) + "".join(f"\n#define {name} ..." for name, _ in numbers(include)) + CALLBACKS + SWEEP)
    ffi.set_source("springstep._native", included(include) + '#include "sweep/grid.h"\n')
    ffi.emit_c_code(str(output))


def lua(include, template, compiler, output):
    constants = "".join(f"\n  {name} = {value}," for name, value in numbers(include))
    fields = {"DECLARATIONS": f"{declarations(include, compiler)}\nenum {{{constants}\n}};",
              **dict(macros(include, '"(.*)"'))}
    output.write_text(re.sub(r"@(\w+)@", lambda field: fields[field[1]], Path(template).read_text()))


def main():
    language, output, include, template, *compiler = sys.argv[1:]
    {"python": python, "lua": lua}[language](Path(include), template, compiler, Path(output))


main()
