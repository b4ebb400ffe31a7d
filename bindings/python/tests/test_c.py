# SPDX-License-Identifier: MIT
"""The package has the whole library, as the C compiler sees it."""
import os
import re
import subprocess
from pathlib import Path

import pytest

import springstep
from springstep import ffi, lib

ROOT = Path(__file__).parents[3]


def names(pattern):
    text = "".join(header.read_text() for header in (ROOT / "include/springstep").glob("*.h"))
    return sorted(set(re.findall(pattern, text, re.M)))


def test_every_function_is_there():
    exports = (ROOT / "tests/headers/exports.txt").read_text().split()
    assert [name for name in dir(lib) if name.startswith("spring_")] == exports


def test_every_type_is_there():
    declared = names(r"\} (spring_\w+);$") + ["spring_scene", "spring_scenef"]
    assert len(declared) > 10 and not set(declared) - {name for group in ffi.list_types() for name in group}


def test_every_value_is_there():
    declared = names(r"^#define (SPRING_\w+) +(?:UINT32_C|\d)") + names(r"^    (SPRING_[A-Z_0-9]+),? *(?:/\*|$)")
    assert len(declared) > 25 and not [name for name in declared if not hasattr(lib, name)]


def structures():
    """Of each public structure its size, and the places of its fields."""
    types = sorted(set(names(r"^\} (spring_\w+);$")))
    return {name: ffi.typeof(name) for name in types if ffi.typeof(name).kind == "struct"}


def test_sizes_and_offsets_are_those_of_the_compiler(tmp_path):
    seen, lines = [], []
    for name, kind in structures().items():
        seen.append(f"{name} {ffi.sizeof(kind)}")
        lines.append(f'printf("{name} %zu\\n", sizeof({name}));')
        for field, place in kind.fields:
            size = ffi.sizeof(place.type)
            seen.append(f"{name}.{field} {place.offset} {size}")
            lines.append(f'printf("{name}.{field} %zu %zu\\n", offsetof({name}, {field}), sizeof((({name} *)0)->{field}));')
    source = tmp_path / "layout.c"
    includes = "".join(f"#include <springstep/{header.name}>\n" for header in (ROOT / "include/springstep").glob("*.h"))
    source.write_text(f"#include <stddef.h>\n#include <stdio.h>\n{includes}int main(void) {{ {' '.join(lines)} }}\n")
    subprocess.run([os.environ.get("CC", "cc"), "-I", ROOT / "include", source, "-o", tmp_path / "layout"], check=True)
    assert len(structures()) >= 10
    assert subprocess.run(tmp_path / "layout", capture_output=True, text=True, check=True).stdout.splitlines() == seen


def test_links_in_numpy_lie_as_in_c():
    kind = ffi.typeof("spring_link")
    assert springstep.LINK.itemsize == ffi.sizeof(kind)
    assert [(name, springstep.LINK.fields[name][1]) for name in springstep.LINK.names] == \
        [(name, field.offset) for name, field in kind.fields]


def test_version_is_that_of_the_header():
    header = (ROOT / "include/springstep/version.h").read_text()
    assert springstep.__version__ == re.search(r'SPRING_VERSION "(.*)"', header)[1]


def test_arithmetic_is_what_the_bits_need():
    springstep.self_test()


def test_methods_are_the_table():
    text = subprocess.run("spring-methods", capture_output=True, text=True, check=True).stdout
    rows = [line.split("\t") for line in text.splitlines() if not line.startswith("#")]
    assert [method.name for method in springstep.methods()] == [row[rows[0].index("method")] for row in rows[1:]]


@pytest.mark.parametrize("method", springstep.methods(), ids=lambda method: method.name)
def test_a_method_is_as_described(method):
    info = next(lib.spring_method_describe(number) for number in range(lib.SPRING_METHOD_COUNT)
                if ffi.string(lib.spring_method_name(number)).decode() == method.name)
    assert ffi.string(info.label).decode() == method.label
    assert (info.order, info.forces_per_step, info.symplectic, info.springs, info.scenes, info.positions_only) == \
        (method.order, method.forces_per_step, method.symplectic, method.springs, method.scenes, method.positions_only)
