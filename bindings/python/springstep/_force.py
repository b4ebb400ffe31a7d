# SPDX-License-Identifier: MIT
"""Functions that scenes call: forces in Python, and functions in C of numba, SciPy, ctypes and cffi."""
from __future__ import annotations

import copy
import ctypes
import re
import types
from collections.abc import Callable
from typing import Any, NamedTuple, NoReturn, Protocol, Union

import numpy as np
from numpy.typing import NDArray

from springstep._native import ffi, lib

#: A force in Python: force(t, position, velocity, force) writes forces [N] to the array force[axis, particle], which starts
#: at 0 and is added to the forces of links. It returns None. position[axis, particle] [m] and velocity[axis, particle] [m/s]
#: at the time t [s] are read-only views of the memory of the scene, valid during the call only. With force_ignores_velocity
#: the velocities are zeros.
Force = Callable[[float, NDArray[Any], NDArray[Any], NDArray[Any]], None]


_CFuncPtr: Any = getattr(ctypes, "_CFuncPtr")  # the class of all functions of ctypes


class LowLevelCallable(Protocol):
    """A function in C, as scipy.LowLevelCallable holds it."""

    @property
    def signature(self) -> str: ...


class CFunc(Protocol):
    """A function in C, as numba.cfunc returns it."""

    @property
    def native_name(self) -> str: ...


#: A force in Python, or a C function of scene.h: numba.cfunc, scipy.LowLevelCallable, or a function of ctypes or cffi.
AnyForce = Union[Force, LowLevelCallable, CFunc]

#: A C function of scene.h. Functions of ctypes and cffi are callable.
InC = Union[LowLevelCallable, CFunc, Callable[..., int]]


class PythonForce:
    """A force in Python, as C calls it."""

    def __init__(self, function: Force, scene: Any) -> None:
        self.function, self.shape = function, (scene.axes, len(scene))
        self.given = function, None
        self.unseen = scene._unseen_velocity
        self.memory = scene._memory.view(scene.dtype)
        self.constant = self.memory.view()
        self.constant.flags.writeable = False
        self.start = ffi.cast("double *" if scene.dtype == np.float64 else "float *", scene._pointer)
        self.error: BaseException | None = None
        self.pointer = lib.springstep_force if scene.dtype == np.float64 else lib.springstep_forcef
        self.user = ffi.new_handle(self)

    def array(self, memory: NDArray[Any], pointers: Any) -> NDArray[Any]:
        """[axis, particle]. C points into the memory of the scene, at equal distances, and a view keeps this memory alive."""
        size = memory.itemsize
        stride = pointers[1] - pointers[0] if self.shape[0] > 1 else 0
        return np.ndarray(self.shape, memory.dtype, memory, (pointers[0] - self.start) * size, (stride * size, size))

    def call(self, t: float, position: Any, velocity: Any, force: Any) -> None:
        velocities = self.array(self.constant, velocity) if self.unseen is None else self.unseen
        added = np.zeros(self.shape, self.memory.dtype)
        # A function that is annotated correctly returns None, others may return what they have computed.
        returned: object = self.function(t, self.array(self.constant, position), velocities, added)
        if returned is not None:
            raise TypeError(f"force: returned a {type(returned).__name__}, not None; write to the array force[axis, particle]")
        total = self.array(self.memory, force)
        total += added

    def stop(self, force: Any) -> None:
        """Set all forces to NaN, so that the C function fails."""
        self.array(self.memory, force)[:] = np.nan


def _callback(user: Any, t: float, particles: int, position: Any, velocity: Any, force: Any) -> None:
    called = ffi.from_handle(user)
    if called.error is None:
        called.call(t, position, velocity, force)
    else:
        called.stop(force)


def _callback_raised(kind: type, error: BaseException, traceback: types.TracebackType) -> None:
    """Keep an exception for the caller of C. cffi finds any, even an interrupt before the first line of _callback."""
    arguments = traceback.tb_frame.f_locals
    called = ffi.from_handle(arguments["user"])
    called.error = error
    called.stop(arguments["force"])


ffi.def_extern("springstep_force", onerror=_callback_raised)(_callback)
ffi.def_extern("springstep_forcef", onerror=_callback_raised)(_callback)


class GivenInC(NamedTuple):
    """A function in C and its data, for copies. They share the function."""

    function: Any
    data: NDArray[Any] | None

    def __deepcopy__(self, memo: dict[int, Any]) -> GivenInC:
        return GivenInC(self.function, copy.deepcopy(self.data, memo))

    def __reduce__(self) -> NoReturn:
        raise TypeError("a function in C cannot be pickled: make the scene in the other process, and load() its state")


class CForce:
    """A function in C, with what must stay alive while it is used."""

    error: BaseException | None = None

    def __init__(self, address: int, user: int, dtype: np.dtype[Any], given: GivenInC) -> None:
        self.pointer = ffi.cast("spring_scene_force_fn *" if dtype == np.float64 else "spring_scenef_force_fn *", address)
        self.user = ffi.cast("void *", user)
        self.given = given


def _ctypes_name(kind: Any) -> str:
    """Return the name in C of a type of ctypes: double ** for LP_LP_c_double."""
    if kind is None or kind is ctypes.c_void_p:
        return "void" if kind is None else "void *"
    name: str = kind.__name__
    levels = len(re.match("(?:LP_)*", name)[0]) // 3  # type: ignore[index]
    return re.sub("^c_", "", name[3 * levels:]) + " " * bool(levels) + "*" * levels


def _of_capsule(capsule: object) -> tuple[int, int, str | None]:
    """Return the address, the context and the name of a PyCapsule, as SciPy stores a function."""
    name = ctypes.PYFUNCTYPE(ctypes.c_char_p, ctypes.py_object)(("PyCapsule_GetName", ctypes.pythonapi))(capsule)
    pointer = ctypes.PYFUNCTYPE(ctypes.c_void_p, ctypes.py_object, ctypes.c_char_p)(("PyCapsule_GetPointer", ctypes.pythonapi))
    context = ctypes.PYFUNCTYPE(ctypes.c_void_p, ctypes.py_object)(("PyCapsule_GetContext", ctypes.pythonapi))
    return pointer(capsule, name), context(capsule) or 0, name and name.decode()


def _function_in_c(force: Any) -> tuple[int, int, str | None] | None:
    """Return address, user pointer and signature of a C function; None: it is none. Signature None: it is not known."""
    if type(force).__module__.startswith("numba.") and hasattr(force, "native_name"):
        force = force.ctypes
    if isinstance(force, _CFuncPtr):
        address = ctypes.cast(force, ctypes.c_void_p).value or 0
        if force.argtypes is None:
            return address, 0, None
        return address, 0, f"{_ctypes_name(force.restype)} ({', '.join(map(_ctypes_name, force.argtypes))})"
    if isinstance(force, types.BuiltinFunctionType) and type(force.__self__).__name__ == "Lib":
        force = ffi.addressof(force.__self__, force.__name__)  # lib.function of a module that cffi has compiled
    if isinstance(force, ffi.CData):
        return int(ffi.cast("intptr_t", force)), 0, ffi.getctype(ffi.typeof(force)).replace("(*)", " ")
    if isinstance(force, tuple) and hasattr(force, "signature"):
        return _of_capsule(tuple.__getitem__(force, 0))
    return None


def _is_force(number: str) -> Callable[[str, list[str]], bool]:
    """Return whether C functions with a signature are forces of scenes, as a function of result and arguments."""
    def fits(result: str, given: list[str]) -> bool:
        if len(given) != 6:
            return False
        user, t, particles, *arrays = given
        count = particles.replace("unsigned", "u").removesuffix("_t")
        counts = count in ("size", "uintptr") or (count.startswith("u") and ctypes.sizeof(
            getattr(ctypes, f"c_{count}", ctypes.c_byte)) == ctypes.sizeof(ctypes.c_size_t))
        return result == "void" and user.endswith("*") and t == "double" and counts and arrays == [f"{number}**"] * 3

    return fits


def function_in_c(field: str, function: object, data: NDArray[Any] | None, wanted: str,
                  fits: Callable[[str, list[str]], bool]) -> tuple[int, int] | None:
    """Return address and user pointer of a C function whose signature fits; None: it is not a function in C."""
    found = _function_in_c(function)
    if found is None:
        return None
    address, user, signature = found
    if signature is not None:
        result, _, rest = re.sub(r"\bconst\b|\s", "", signature).partition("(")
        if not fits(result, rest.rstrip(")").split(",")):
            raise TypeError(f"{field}: its signature is {signature}, not {wanted}")
    if address == 0:
        raise TypeError(f"{field}: a null pointer")
    if data is not None:
        if not isinstance(data, np.ndarray) or not data.flags.c_contiguous:
            raise TypeError(f"{field}_data: not a contiguous array of NumPy")
        if user:
            raise TypeError(f"{field}_data: the LowLevelCallable has user data")
        user = data.ctypes.data
    return address, user


def called_force(force: AnyForce, data: NDArray[Any] | None, scene: Any) -> PythonForce | CForce:
    """Return a force as C calls it."""
    number = "double" if scene.dtype == np.float64 else "float"
    wanted = f"void (void *, double, size_t, {number} **, {number} **, {number} **)"
    found = function_in_c("force", force, data, wanted, _is_force(number))
    if found is not None:
        return CForce(*found, scene.dtype, GivenInC(force, data))
    if not callable(force):
        raise TypeError(f"force: a {type(force).__name__}, neither a function in Python nor one in C")
    if data is not None:
        raise TypeError("force_data: only for forces in C; a function in Python uses its own variables")
    return PythonForce(force, scene)
