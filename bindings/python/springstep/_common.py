# SPDX-License-Identifier: MIT
"""Common code of the package: the C library, its statuses as exceptions, and its methods by name."""
from __future__ import annotations

import math
import operator
import threading
from collections.abc import Callable, Iterable, Sequence
from typing import Any, Literal, NamedTuple, NoReturn, TypeVar

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from springstep._native import ffi, lib

#: Names of methods, see methods().
MethodName = Literal["euler", "symplectic-euler", "leapfrog", "rk4", "srkn6", "rkn8", "exact"]


def _text(characters: Any) -> str:
    """Return a string of C."""
    text: bytes = ffi.string(characters)
    return text.decode()


class SpringError(Exception):
    """An error of the library.

    Attributes
    ----------
    status : int
        Status of the C function, such as ``lib.SPRING_EINVAL``.
    field : str or None
        Name of the invalid argument or field, such as ``"mass"`` or ``"link.a"``.
    value : object
        The invalid value.
    index : int or None
        Index of the particle, link or spring.
    failed : sequence of int
        Of a batch: indices of the springs that have kept their state.
    dt, stable_step : float or None
        Of a step that failed: its length and the stable step of its method [s].
    recorded : tuple or None
        Of `Scene.run`: the frames before the error, as `run` returns them.
    """

    failed: NDArray[np.intp] | Sequence[int] = ()
    dt: float | None = None
    stable_step: float | None = None
    recorded: tuple[NDArray[np.float64] | NDArray[np.float32], ...] | None = None

    def __init__(self, status: int, field: str | None = None, value: object = None, index: int | None = None,
                 reason: str | None = None) -> None:
        self.status: int = status
        self.field: str | None = field
        self.value: object = value
        self.index: int | None = index
        message = reason or _text(lib.spring_status_string(status))
        if field is not None:
            place = "" if index is None else f"[{index}]"
            given = "" if value is None else f" = {value!r}"
            message = f"{field}{place}{given}: {message}"
        super().__init__(message)
        self._arguments = status, field, value, index, reason

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled with all fields, so that errors of worker processes arrive."""
        kept = {name: getattr(self, name) for name in ("failed", "dt", "stable_step", "recorded")}
        return type(self), self._arguments, kept


class InvalidError(SpringError, ValueError):
    """Invalid input, with its field and value."""


class RangeError(SpringError, IndexError):
    """An index or a count is out of range."""


class NonFiniteError(SpringError, ArithmeticError):
    """The state would have become infinite or NaN: the step is unstable, or numbers are too large."""


class UnstableError(NonFiniteError):
    """A particle would have become faster than the max_speed of its scene, or not finite."""


class UnsupportedError(SpringError):
    """Not supported for this kind of system, or not enabled when it was created."""


_CLASSES = {
    lib.SPRING_EINVAL: InvalidError,
    lib.SPRING_ERANGE: RangeError,
    lib.SPRING_ENONFINITE: NonFiniteError,
    lib.SPRING_EUNSTABLE: UnstableError,
    lib.SPRING_EUNSUPPORTED: UnsupportedError,
    lib.SPRING_EDISABLED: UnsupportedError,
}


def fail(status: int, field: str | None = None, value: object = None, index: int | None = None) -> NoReturn:
    """Raise the exception of a status."""
    raise _CLASSES.get(status, SpringError)(status, field, value, index)


def invalid(field: str, value: object, index: int | None = None, reason: str | None = None) -> NoReturn:
    """Raise InvalidError. The reason states what was expected, where the name of the field does not."""
    raise InvalidError(lib.SPRING_EINVAL, field, value, index, reason)


def fail_step(status: int, dt: float, method: str, stable_step: float, field: str = "dt", value: object = None,
              index: int | None = None) -> NoReturn:
    """Raise the exception of a step that failed, with its length and the stable step."""
    reason = f"{_text(lib.spring_status_string(status))} (dt {dt!r} s, stable step of {method} {stable_step!r} s)"
    error = _CLASSES[status](status, field, dt if field == "dt" else value, index, reason)
    error.dt, error.stable_step = dt, stable_step
    raise error


Result = TypeVar("Result")
Name = TypeVar("Name", bound=str)


class Guard:
    """Separates the calls on one object, which run without Python's global lock.

    Short calls of several threads wait for each other. While a long call runs, every other call raises RuntimeError.
    """

    __slots__ = ("_refusal", "_lock", "_busy", "_unfinished")

    def __init__(self, refusal: str) -> None:
        self._refusal = refusal
        self._lock = threading.RLock()  # a signal handler may call again, between the instructions of a short call
        self._busy = False
        self._unfinished: Callable[[], object] | None = None  # a change that an interrupt has ended

    def _check(self) -> None:
        if self._busy:
            raise RuntimeError(self._refusal)
        if self._unfinished is not None:
            self._unfinished()
            self._unfinished = None

    def short(self, function: Callable[..., Result], *arguments: Any) -> Result:
        """Call a function that takes little time."""
        with self._lock:
            self._check()
            return function(*arguments)

    def change(self, function: Callable[[], Result]) -> Result:
        """Call a function that changes state in C and in Python, and that may be called twice.

        A signal handler may raise an exception between the two changes. The next call then repeats the function, which keeps
        the objects of both states alive until then.
        """
        with self._lock:
            self._check()
            while True:
                self._unfinished = function
                result = function()
                if self._unfinished is function:  # otherwise a signal handler has called this object in between
                    self._unfinished = None
                    return result

    def long(self, function: Callable[..., Result], *arguments: Any) -> Result:
        """Call a function that may take long, or that calls Python."""
        entered = False
        try:
            with self._lock:
                self._check()
                entered = self._busy = True
            return function(*arguments)
        finally:
            if entered:
                self._busy = False


class Method(NamedTuple):
    """Properties of a method."""

    name: MethodName  #: for the functions of this package
    label: str  #: for texts: "RK4"
    order: int  #: error C dt^order; 0: exact, except for rounding error
    forces_per_step: int  #: force evaluations; of scenes without forces that depend on velocities
    symplectic: bool  #: without damping: bounded energy error of smooth motion over any time
    springs: bool  #: available for single springs and batches
    scenes: bool  #: available for scenes
    positions_only: bool  #: not for scenes with damped links or with a force that may use velocities


def _describe(number: int) -> Method:
    info: Any = lib.spring_method_describe(number)
    fields = [getattr(info, field) for field in Method._fields]
    texts: list[Any] = [field if isinstance(field, int) else _text(field) for field in fields]
    return Method(*texts)


_NUMBERS = {}
_METHODS = []
for _place in range(lib.SPRING_METHOD_COUNT):
    _METHODS.append(_describe(lib.spring_method_at(_place)))
    _NUMBERS[_METHODS[-1].name] = lib.spring_method_at(_place)


def methods() -> tuple[Method, ...]:
    """Return the methods, in the order of tables."""
    return tuple(_METHODS)


def method_number(name: MethodName) -> int:
    """Return the number of a method in C."""
    if name not in _NUMBERS:
        invalid("method", name, reason=f"not one of {', '.join(_NUMBERS)}")
    return _NUMBERS[name]


def names_of(field: str, names: Iterable[Name]) -> tuple[Name, ...]:
    """The names in a list of names: a string is not taken for the list of its letters."""
    if isinstance(names, str):
        invalid(field, names, reason=f"not a list of names, such as [{names!r}]")
    return tuple(names)


def springs_method(name: MethodName) -> int:
    """Return the number of a method for single springs and batches."""
    number = method_number(name)
    if not next(method for method in _METHODS if method.name == name).springs:
        fail(lib.SPRING_EUNSUPPORTED, "method", name)
    return number


def aligned(values: ArrayLike, dtype: DTypeLike) -> NDArray[Any]:
    """Return an array that C can read."""
    return np.require(values, dtype, ["C", "A", "E"])


def remade(kind: Any, base: Any, arguments: tuple[Any, ...], options: dict[str, Any]) -> Any:
    """Return an object as its base class makes it, for copies: a subclass may have other arguments."""
    made = kind.__new__(kind)
    base.__init__(made, *arguments, **options)
    return made


def step_count(steps: int, field: str = "steps") -> int:
    """Return a number of steps that C can count."""
    steps = operator.index(steps)
    if not 0 <= steps < 2**64:
        invalid(field, steps)
    return steps


def finite(field: str, value: float) -> float:
    """Return a finite number."""
    if not math.isfinite(value):
        invalid(field, value)
    return value


def self_test() -> None:
    """Check that the floating-point environment of this thread gives reproducible results.

    Raises
    ------
    SpringError
        If it does not.
    """
    if status := lib.spring_self_test():
        fail(status)
