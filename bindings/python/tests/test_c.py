# SPDX-License-Identifier: MIT
"""The package has the whole library, as the C compiler sees it."""
import inspect
import re
import subprocess
import typing
from pathlib import Path

import numpy as np
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


def test_structures_are_those_of_the_compiler():
    """What interface.c says, which the compiler has held against the headers."""
    layout = (ROOT / "tests/headers/interface.c").read_text()
    here = 0 if ffi.sizeof("void *") == 8 else 1
    sizes = re.findall(r"^SIZE\((\w+), (\d+), (\d+)\)", layout, re.M)
    places = re.findall(r"^AT\((\w+), (\w+), (\d+), (\d+)\)", layout, re.M)
    assert len(sizes) > 10 and len(places) > 50
    assert [ffi.sizeof(name) for name, *_ in sizes] == [int(size[here]) for _, *size in sizes]
    assert [ffi.offsetof(name, field) for name, field, *_ in places] == [int(place[here]) for _, _, *place in places]


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


# --- what Python adds


def test_names_of_methods_are_a_type():
    assert typing.get_args(springstep.MethodName) == tuple(method.name for method in springstep.methods())


OBJECTS = [springstep.Spring(1.0), springstep.Batch(np.ones(100), np.ones(100), 1.0), springstep.Scene(np.ones((100, 3))),
           springstep.Scene([1.0]).snapshot(), springstep.Clock(1.0), springstep.sphere([0, 0, 0], 1.0),
           springstep.grid([10, 10], 0.1, 1.0), springstep.methods()[0]]


@pytest.mark.parametrize("thing", OBJECTS, ids=lambda thing: type(thing).__name__)
def test_objects_have_no_other_attributes_and_short_reprs(thing):
    with pytest.raises(AttributeError):
        thing.stifness = 300
    assert not hasattr(thing, "__dict__") and len(repr(thing)) < 300 and "array(" not in repr(thing)


def documented():
    """Yield (name, object with a docstring, function) of every public function, class and method."""
    for name in springstep.__all__:
        value = getattr(springstep, name)
        if inspect.isfunction(value):
            yield name, value, value
        elif name in ("Spring", "Batch", "Scene", "Clock"):
            yield name, value, value.__init__
            for part in vars(value):
                if not part.startswith("_") and callable(method := getattr(value, part)):
                    yield f"{name}.{part}", method, method


@pytest.mark.parametrize("documented, function", [pytest.param(*rest, id=name) for name, *rest in documented()])
def test_parameters_are_documented_as_numpydoc_has_it(documented, function):
    """All of them, and no others."""
    text = inspect.getdoc(documented)
    assert re.match(r"[A-Z].*[.:]", text)
    section = re.search(r"^Parameters\n-+\n((?:.*\n?)*?)(?=\n\w+\n-+\n|\Z)", text, re.M)
    names = re.findall(r"^\*{0,2}(\w+(?:, \w+)*)(?: : .*)?$", section[1] if section else "", re.M)
    wanted = [name for name in inspect.signature(function).parameters if name not in ("self", "misplaced")]
    assert sorted(name for row in names for name in row.split(", ")) == sorted(wanted)
