#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The C source of the module springstep._native, by cffi, from what the public headers declare.

    declarations.py OUTPUT INCLUDE-DIRECTORY COMPILER...

So a new function of a header is in the module by itself. What cffi takes for the size of a structure and the place of a
field is checked against the compiler's when the module is compiled and loaded.
"""
import re
import subprocess
import sys
from pathlib import Path

from cffi import FFI

# Forces of scenes: C calls Python. They only exist in Python, and are given no name in C.
CALLBACKS = """
extern "Python" void springstep_force(void *, double, size_t, const double *const *, const double *const *,
                                      double *const *);
extern "Python" void springstep_forcef(void *, double, size_t, const float *const *, const float *const *,
                                       float *const *);
"""


def declarations(include, compiler):
    """What the headers declare, preprocessed, and macros that are numbers."""
    headers = sorted((include / "springstep").glob("*.h"))
    source = "".join(f"#include <springstep/{header.name}>\n" for header in headers)
    text = subprocess.run([*compiler, "-E", "-I", include, "-x", "c", "-"], input=source, text=True, check=True,
                          stdout=subprocess.PIPE).stdout
    # "# LINE FILE" says where the lines after it come from: those of the C library are left out.
    ours, kept = False, []
    for line in text.splitlines():
        if marker := re.match(r'#(?:line)? *\d+ "(.*?)"', line):
            ours = Path(marker[1]).parent.name == "springstep"
        elif ours and not line.startswith("#"):
            kept.append(line)
    code = re.sub(r"__attribute__\s*\(\(.*?\)\)\s*\)?|__declspec\(\w+\)", "", "\n".join(kept))
    for header in headers:
        for name in re.findall(r"^#define (SPRING_\w+) +(?:UINT32_C\()?\d+\b", header.read_text(), re.M):
            code += f"\n#define {name} ..."
    return source, code


def main():
    output, include, *compiler = sys.argv[1:]
    source, code = declarations(Path(include), compiler)
    ffi = FFI()
    ffi.cdef(code + CALLBACKS)
    ffi.set_source("springstep._native", source)
    ffi.emit_c_code(output)


main()
