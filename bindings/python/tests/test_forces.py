# SPDX-License-Identifier: MIT
"""Forces of scenes, in Python and in C."""
import copy
import ctypes
import gc
import importlib
import math
import pickle
import subprocess
import sys
import sysconfig
import weakref
from pathlib import Path

import numpy as np
import pytest

import springstep
from scenes import FLOATS, OF_SCENES, fnv, rope
from springstep import Scene, ffi, grid, lib


@FLOATS
def test_a_force_in_python(dtype):
    seen = []

    def see(t, position, velocity, force):
        seen.append((t, position[0][5], velocity[1][5]))
        assert position.shape == velocity.shape == force.shape == (3, 6) and not force.any()
        assert position.dtype == velocity.dtype == force.dtype == dtype
        assert not position.flags.writeable and not velocity.flags.writeable

    scene = rope(dtype=dtype, force=see)
    scene.advance(1e-3, 100)
    assert seen[0] == (0, scene.dtype.type(1.5), 0) and len(seen) >= 200 and max(seen)[0] == pytest.approx(0.1)
    scene.set_force(None)
    calls = len(seen)
    scene.advance(1e-3)
    assert len(seen) == calls


@FLOATS
@pytest.mark.parametrize("axes", [1, 2, 3])
@pytest.mark.parametrize("particles", [2, 6, 40])
def test_a_force_is_added_to_the_forces_of_links_however_it_is_written(axes, dtype, particles):
    g = grid([particles], 0.3, 170.0, axes=axes, pinned=["first_x"])
    free, assigned, added, held = scenes = [Scene(g.position, g.links, pinned=g.pinned, mass=0.13, dtype=dtype, held_forces=True)
                                            for _ in range(4)]
    pull = np.random.default_rng(5).normal(0, 3, (axes, particles)).astype(dtype)

    def assign(t, position, velocity, force):
        force[:] = 7
        force[0] = 0
        force[0] += pull[0]
        force[1:][:] = pull[1:]

    def add(t, position, velocity, force):
        for particle in range(particles):
            force[:, particle] += pull[:, particle]

    assigned.set_force(assign)
    added.set_force(add)
    held.set_held_force(pull.T)
    for scene in scenes:
        scene.advance(1e-3, 200)
    assert fnv(assigned) == fnv(added)
    bound = 1000 * float(np.finfo(dtype).eps)  # rounding of 200 steps
    assert assigned.position() == pytest.approx(held.position(), abs=bound, rel=bound)
    assert abs(assigned.position() - free.position()).max() > 1e-3


@pytest.mark.parametrize("returned", [np.ones((3, 6)), 0, False, "force"])
def test_a_force_returns_none(returned):
    scene = rope(force=lambda *_: returned)
    before = scene.position()
    with pytest.raises(TypeError, match=f"^force: returned a {type(returned).__name__}, not None; write to the array force"):
        scene.advance(1e-3)
    assert (scene.position() == before).all() and scene.time == 0


@FLOATS
def test_an_exception_in_a_force_comes_back_and_nothing_changed(dtype):
    def breaks(t, position, velocity, force):
        if t > 0.005:
            raise KeyError("mine")

    scene = rope(dtype=dtype, force=breaks)
    scene.advance(1e-3, 3)
    before = scene.position(), scene.time
    with pytest.raises(KeyError, match="mine"):
        scene.advance(1e-3, 10)
    assert (scene.position() == before[0]).all() and scene.time == before[1]
    scene.advance(1e-3)
    scene.set_force(lambda t, position, velocity, force: force[1].fill(1))
    scene.advance(1e-3, 10)


@pytest.mark.parametrize("pinned", [[], [0], range(6)], ids=["free", "hung", "all_pinned"])
@pytest.mark.parametrize("method", OF_SCENES)
def test_an_exception_at_any_evaluation_undoes_the_call(method, pinned):
    fails_at = math.inf
    evaluations = 0

    def pull(t, position, velocity, force):
        nonlocal evaluations
        evaluations += 1
        if evaluations == fails_at:
            raise KeyError("mine")
        force[1] += 0.3 * position[0]

    g = grid([6], 0.3, 170.0)
    scene = Scene(g.position, g.links, velocity=np.full((6, 3), 0.1), mass=0.13, pinned=np.isin(range(6), pinned), force=pull,
                  force_ignores_velocity=True, methods=[method])
    start = scene.snapshot()
    scene.advance(1e-3, 2, method)
    before, state = scene.snapshot(), (scene.position().tobytes(), scene.velocity().tobytes(), scene.time)
    evaluations = 0
    scene.advance(1e-3, 3, method)
    after, count = (scene.position().tobytes(), scene.velocity().tobytes()), evaluations
    assert count >= 3 and state[0] != after[0]
    for fails_at in range(1, count + 1):
        scene.restore(start)
        scene.restore(before)
        evaluations = 0
        with pytest.raises(KeyError):
            scene.advance(1e-3, 3, method)
        assert evaluations == fails_at or len(pinned) == 6
        assert (scene.position().tobytes(), scene.velocity().tobytes(), scene.time) == state
        evaluations = -math.inf
        scene.advance(1e-3, 3, method)
        assert (scene.position().tobytes(), scene.velocity().tobytes()) == after


def test_a_force_that_is_not_finite():
    scene = rope(force=lambda t, position, velocity, force: force[1].fill(math.nan))
    before = scene.position()
    with pytest.raises(springstep.NonFiniteError):
        scene.advance(1e-3, 3)
    assert (scene.position() == before).all() and scene.time == 0


def test_a_force_of_pinned_particles_alone_may_raise():
    """Also after set_pinned() and restore()."""
    g = grid([3], 0.3, 170.0)
    scene = Scene(g.position, g.links, velocity=np.ones((3, 3)), pinned=[True, False, True], editable=True)
    scene.set_pinned([True], 1)
    all_pinned = scene.snapshot()
    for prepare in (lambda: scene.restore(all_pinned), lambda: scene.set_pinned([True], 1)):
        scene.set_pinned([False], 1)
        prepare()
        scene.set_force(lambda *_: 1 / 0)
        before = scene.position(), scene.velocity()
        with pytest.raises(ZeroDivisionError):
            scene.advance(0.5, 2)
        assert scene.time == 0 and (scene.position() == before[0]).all() and (scene.velocity() == before[1]).all()


def test_an_interrupt_at_any_line_of_a_callback_undoes_the_call():
    """Ctrl-C raises KeyboardInterrupt in whatever line of Python runs, lines of the package included."""
    scene = rope(force=lambda t, position, velocity, force: force[1].fill(0.1))
    before, lines, line = scene.position(), 0, 0

    def trace(frame, event, argument):
        nonlocal lines
        if event in ("call", "line"):
            lines += 1
            if lines == line:
                raise KeyboardInterrupt
        return trace

    def trace_callbacks(frame, event, argument):
        return trace(frame, event, argument) if frame.f_code.co_name == "_callback" or lines > 0 else None

    while True:
        line, lines = line + 1, 0
        old = sys.gettrace()
        sys.settrace(trace_callbacks)
        try:
            scene._run("advance", lib.SPRING_LEAPFROG, 1e-3, 1)
        except KeyboardInterrupt:
            pass
        else:
            break  # there is no such line
        finally:
            sys.settrace(old)
        assert (scene.position() == before).all() and scene.time == 0
    assert line > 20 and scene.time == 1e-3


def test_an_array_kept_by_a_force_outlives_its_scene():
    kept = []
    scene = rope(force=lambda t, position, velocity, force: kept.extend([*position, *velocity]))
    scene.advance(1e-3)
    values, gone = [array.copy() for array in kept], [weakref.ref(scene), weakref.ref(kept[0].base)]
    del scene
    gc.collect()
    assert gone[0]() is None and gone[1]() is not None and all(array.base is gone[1]() for array in kept)
    assert all((array == value).all() for array, value in zip(kept, values))
    kept.clear()
    gc.collect()
    assert gone[1]() is None  # and nothing else keeps it


def test_velocities_that_a_force_ignores_are_zeros():
    seen = []
    scene = rope(velocity=np.full((6, 3), 0.7), force=lambda t, position, velocity, force: seen.extend(velocity),
                 force_ignores_velocity=True)
    scene.advance(1e-3, 10)
    assert len(seen) == 33 and all(len(v) == 6 and not v.any() and not v.flags.writeable for v in seen)


def test_a_snapshot_has_its_force():
    broken = []

    def up(t, position, velocity, force):
        if broken:
            raise KeyError("mine")
        force[1] += 5

    scene = rope(force=up, methods=["leapfrog", "rk4"])
    before = scene.snapshot()
    scene.advance(1e-3, 20, "rk4")
    after = scene.position()
    scene.set_force(None)
    scene.advance(1e-3, 20, "rk4")
    scene.restore(before)
    scene.advance(1e-3, 20, "rk4")
    assert (scene.position() == after).all()
    broken.append(True)
    with pytest.raises(KeyError):
        scene.advance(1e-3)


@pytest.mark.parametrize("ignores, calls", [(False, 20), (True, 11)])  # twice a step, or once, and once at the start
def test_a_force_without_velocities_is_asked_once_a_step(ignores, calls):
    seen = []
    rope(force=lambda t, *_: seen.append(t), force_ignores_velocity=ignores, drag=0.1).advance(1e-3, 10)
    assert len(seen) == calls


def test_a_copy_with_a_force_that_was_set_later():
    """With a method that the definition would not have with this force."""
    scene = Scene(np.eye(3), methods=["leapfrog", "rkn8"])
    scene.set_force(lambda t, position, velocity, force: force[1].fill(1))
    twin = copy.copy(scene)
    for each in (scene, twin):
        each.advance(1e-3, 9)
    assert fnv(twin) == fnv(scene) != fnv(Scene(np.eye(3)))


def test_a_force_may_not_ask_its_scene():
    scene = rope()
    scene.set_force(lambda t, position, velocity, force: scene.advance(1e-3))
    with pytest.raises(RuntimeError, match="own force"):
        scene.advance(1e-3)
    assert scene.time == 0


# --- forces in C

C = """
#include <stddef.h>
#define WIND(name, number)                                                                                              \\
    void name(void *user, double t, size_t particles, const number *const *position, const number *const *velocity,     \\
              number *const *force)                                                                                     \\
    {                                                                                                                   \\
        const double *air = user;                                                                                       \\
        for (int axis = 0; axis < 3; axis++)                                                                            \\
            for (size_t i = 0; i < particles; i++)                                                                      \\
                force[axis][i] += (number)0.03125 * ((number)(air ? air[axis] : 1 + t) - velocity[axis][i]);            \\
    }
WIND(wind, double)
WIND(windf, float)
"""
DECLARED = "".join(f"void {name}(void *, double, size_t, const {number} *const *, const {number} *const *, {number} *const *);"
                   for name, number in (("wind", "double"), ("windf", "float")))


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    """The functions above, in a shared library."""
    folder = tmp_path_factory.mktemp("force")
    (folder / "wind.c").write_text(C)
    subprocess.run(["cc", "-O2", "-ffp-contract=off", "-shared", "-fPIC", "-o", "wind.so", "wind.c"], cwd=folder, check=True)
    return folder / "wind.so"


ARGUMENTS = [ctypes.c_void_p, ctypes.c_double, ctypes.c_size_t, *[ctypes.POINTER(ctypes.POINTER(ctypes.c_double))] * 3]


def in_ctypes_unchecked(library, dtype):
    return getattr(ctypes.CDLL(str(library)), "wind" if dtype == np.float64 else "windf")


def in_ctypes(library, dtype):
    function = in_ctypes_unchecked(library, dtype)
    vectors = ARGUMENTS[3] if dtype == np.float64 else ctypes.POINTER(ctypes.POINTER(ctypes.c_float))
    function.restype, function.argtypes = None, [*ARGUMENTS[:3], *[vectors] * 3]
    return function


def in_cffi(library, dtype):
    other = pytest.importorskip("cffi").FFI()
    other.cdef(DECLARED)
    opened = other.dlopen(str(library))
    KEPT.append(opened)
    return getattr(opened, "wind" if dtype == np.float64 else "windf")


def in_cffi_compiled(library, dtype):
    include, folder = sysconfig.get_paths()["include"], library.parent
    if not Path(include, "Python.h").exists():
        pytest.skip("no Python.h")
    if str(folder) not in sys.path:
        other = pytest.importorskip("cffi").FFI()
        other.cdef(DECLARED)
        other.set_source("_compiled_wind", C)
        other.emit_c_code(str(folder / "module.c"))
        subprocess.run(["cc", "-O2", "-ffp-contract=off", "-shared", "-fPIC", f"-I{include}", "-o", "_compiled_wind.abi3.so", "module.c"],
                       cwd=folder, check=True)
        sys.path.append(str(folder))
    return getattr(importlib.import_module("_compiled_wind").lib, "wind" if dtype == np.float64 else "windf")


def in_scipy(library, dtype):
    return pytest.importorskip("scipy").LowLevelCallable(in_ctypes(library, dtype))


def in_scipy_cffi(library, dtype):
    return pytest.importorskip("scipy").LowLevelCallable(in_cffi(library, dtype))


def in_numba(library, dtype):
    numba = pytest.importorskip("numba")
    kind = "float64" if dtype == np.float64 else "float32"
    number, vectors = getattr(np, kind), ", ".join([f"CPointer(CPointer({kind}))"] * 3)

    @numba.cfunc(f"void(voidptr, float64, uintp, {vectors})")
    def wind(user, t, particles, position, velocity, force):
        air = numba.carray(user, 3, numba.float64)
        for axis in range(3):
            for i in range(particles):
                force[axis][i] += number(0.03125) * (number(air[axis]) - velocity[axis][i])

    return wind


KEPT = []
IN_C = pytest.mark.parametrize("made", [in_ctypes, in_ctypes_unchecked, in_cffi, in_cffi_compiled, in_scipy, in_scipy_cffi,
                                        in_numba])


@FLOATS
@IN_C
def test_a_force_in_c_has_the_bits_of_the_same_force_in_python(made, dtype, library):
    air = np.array([3.0, -0.7, 0.2])

    def wind(t, position, velocity, force):
        force += dtype(0.03125) * (air.astype(dtype)[:, np.newaxis] - velocity)

    in_python = rope(dtype=dtype, force=wind)
    in_c = rope(dtype=dtype, force=made(library, dtype), force_data=air)
    gc.collect()
    for scene in (in_python, in_c):
        scene.advance(1e-3, 200)
    assert fnv(in_c) == fnv(in_python) != fnv(rope(dtype=dtype))
    before = in_c.snapshot()
    in_c.set_force(None)
    in_c.advance(1e-3, 10)
    still = fnv(in_c)
    in_c.restore(before)  # the force, too
    in_c.advance(1e-3, 10)
    in_python.advance(1e-3, 10)
    assert fnv(in_c) == fnv(in_python) != still


@IN_C
def test_copies_share_a_function_in_c(made, library):
    """A deep copy has data of its own. Such a scene cannot be pickled."""
    air = np.array([3.0, -0.7, 0.2])
    scene = rope(force=made(library, np.float64), force_data=air)
    shared, own = copy.copy(scene), copy.deepcopy(scene)
    assert own._called.given[0] is scene._called.given[0]
    air[0] = 5
    for each in (scene, shared, own):
        each.advance(1e-3, 50)
    assert fnv(scene) == fnv(shared) != fnv(own)
    with pytest.raises(TypeError, match="^a function in C cannot be pickled"):
        pickle.dumps(scene)


def test_user_data_of_scipy(library):
    scipy = pytest.importorskip("scipy")
    air = np.array([3.0, -0.7, 0.2])
    callable_ = scipy.LowLevelCallable(in_ctypes(library, np.float64), ctypes.c_void_p(air.ctypes.data))
    scenes = rope(force=callable_), rope(force=in_ctypes(library, np.float64), force_data=air)
    for scene in scenes:
        scene.advance(1e-3, 20)
    assert fnv(scenes[0]) == fnv(scenes[1])
    with pytest.raises(TypeError, match="^force_data: the LowLevelCallable has user data"):
        scenes[0].set_force(callable_, air)


@pytest.mark.parametrize("signature, fits", [
    ("void(*)(void *, double, size_t, double **, double **, double **)", True),
    ("void(*)(double *, double, uint64_t, const double *const *, const double **, double *const *)", ctypes.sizeof(ctypes.c_void_p) == 8),
    ("void(*)(void *, double, size_t, double **, double **)", False),
    ("void(*)(void *, double, size_t, double **, double **, float **)", False),
    ("void(*)(void *, double, size_t, double *, double *, double *)", False),
    ("void(*)(void *, float, size_t, double **, double **, double **)", False),
    ("void(*)(void *, double, int, double **, double **, double **)", False),
    ("void(*)(void *, double, char, double **, double **, double **)", False),
    ("void(*)(void *, double, uint16_t, double **, double **, double **)", False),
    ("void(*)(long, double, size_t, double **, double **, double **)", False),
    ("int(*)(void *, double, size_t, double **, double **, double **)", False),
    ("void *", False),
])
def test_signatures_in_c_are_checked(signature, fits, library):
    function = ffi.cast(signature, ffi.cast("intptr_t", in_cffi(library, np.float64)))
    scene = rope()
    if fits:
        scene.set_force(function)
        return
    with pytest.raises(TypeError, match=r"^force: its signature is .*, not void \(void \*, double, size_t, double \*\*"):
        scene.set_force(function)


def test_signatures_of_ctypes_scipy_and_numba_are_checked(library):
    wrong = [in_ctypes(library, np.float32), ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)(lambda _: 0)]
    for module in ("scipy", "numba"):
        try:
            imported = importlib.import_module(module)
        except ImportError:
            continue
        wrong.append(imported.LowLevelCallable(wrong[0]) if module == "scipy" else imported.cfunc("float64(float64)")(lambda x: x))
    for function in wrong:
        with pytest.raises(TypeError, match="^force: its signature is "):
            rope(force=function)


@pytest.mark.parametrize("made, data, named", [
    (lambda *_: 3, None, "force: a int, neither"), (lambda *_: print, np.ones(3), "force_data: only for forces in C"),
    (lambda *_: ctypes.CFUNCTYPE(None, *ARGUMENTS)(), None, "force: a null pointer"),
    (in_ctypes, [1.0, 2.0, 3.0], "force_data: not a contiguous array"),
    (in_ctypes, np.ones(6)[::2], "force_data: not a contiguous array"),
])
def test_what_is_no_force_is_refused(made, data, named, library):
    with pytest.raises(TypeError, match=f"^{named}"):
        rope(force=made(library, np.float64), force_data=data)
