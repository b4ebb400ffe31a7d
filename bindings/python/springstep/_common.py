# SPDX-License-Identifier: MIT
"""Common code of the package: the C library, its statuses as exceptions, and its methods by name."""
from __future__ import annotations

import math
import operator
import threading
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, NoReturn, TypeVar

from springstep._native import ffi, lib


class SpringError(Exception):
    """An error of the library.

    status: status of the C function, such as lib.SPRING_EINVAL
    field: name of the argument or field that is invalid, such as "mass" or "link.a", or None
    value: the invalid value
    index: of the particle, link or spring; None where there are not many
    failed: of a batch, the indices of the springs that have kept their state
    """

    failed: Sequence[int] = ()

    def __init__(self, status: int, field: str | None = None, value: Any = None, index: int | None = None,
                 reason: str | None = None):
        self.status, self.field, self.value, self.index = status, field, value, index
        message = reason or ffi.string(lib.spring_status_string(status)).decode()
        if field is not None:
            place = "" if index is None else f"[{index}]"
            message = f"{field}{place} = {value!r}: {message}"
        super().__init__(message)
        self._arguments = status, field, value, index, reason

    def __reduce__(self) -> tuple:
        """Pickled with all fields, so that errors of worker processes arrive."""
        return type(self), self._arguments, {"failed": self.failed}


class InvalidError(SpringError, ValueError):
    """Bad input: the field and its value are named."""


class RangeError(SpringError, IndexError):
    """An index or a count is out of range."""


class NonFiniteError(SpringError, ArithmeticError):
    """The state would have become infinite or NaN: the step is unstable, or numbers are too large."""


class UnstableError(NonFiniteError):
    """A particle would have become faster than the max_speed of its scene, or not finite."""


class UnsupportedError(SpringError):
    """Not supported for this kind of system, or not enabled when it was made."""


_CLASSES = {
    lib.SPRING_EINVAL: InvalidError,
    lib.SPRING_ERANGE: RangeError,
    lib.SPRING_ENONFINITE: NonFiniteError,
    lib.SPRING_EUNSTABLE: UnstableError,
    lib.SPRING_EUNSUPPORTED: UnsupportedError,
    lib.SPRING_EDISABLED: UnsupportedError,
}


def fail(status: int, field: str | None = None, value: Any = None, index: int | None = None) -> NoReturn:
    """Raise what belongs to a status."""
    raise _CLASSES.get(status, SpringError)(status, field, value, index)


def invalid(field: str, value: Any, index: int | None = None, reason: str | None = None) -> NoReturn:
    """Raise InvalidError. The reason says what was expected, where the name of the field does not."""
    raise InvalidError(lib.SPRING_EINVAL, field, value, index, reason)


Result = TypeVar("Result")


class Guard:
    """Keeps the calls on one object apart, which C does not do and which run without Python's global lock.

    Short calls of several threads wait for each other. While a long call runs, every other call raises RuntimeError.
    """

    def __init__(self, refusal: str):
        self._refusal = refusal
        self._lock = threading.RLock()  # a signal handler may call again, between the instructions of a short call
        self._busy = False

    def _check(self) -> None:
        if self._busy:
            raise RuntimeError(self._refusal)

    def short(self, function: Callable[..., Result], *arguments: Any) -> Result:
        """Call a function that takes little time."""
        with self._lock:
            self._check()
            return function(*arguments)

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
    """What there is to know of a method."""

    name: str
    label: str  #: as in a text: "RK4"
    order: int  #: error C dt^order; 0: no error but rounding
    forces_per_step: int  #: evaluations; of scenes without forces that depend on velocities
    symplectic: bool  #: without damping: bounded energy error of smooth motion over any time
    springs: bool  #: offered for one spring and batches
    scenes: bool  #: offered for scenes
    positions_only: bool  #: not for scenes with damped links or with a force that may use velocities


def _describe(number: int) -> Method:
    info = lib.spring_method_describe(number)
    text = {field: ffi.string(getattr(info, field)).decode() for field in ("name", "label")}
    return Method(**text, **{field: getattr(info, field) for field in Method._fields if field not in text})


_NUMBERS = {}
_METHODS = []
for _place in range(lib.SPRING_METHOD_COUNT):
    _METHODS.append(_describe(lib.spring_method_at(_place)))
    _NUMBERS[_METHODS[-1].name] = lib.spring_method_at(_place)


def methods() -> tuple[Method, ...]:
    """The methods, in the order in which tables show them."""
    return tuple(_METHODS)


def method_number(name: str) -> int:
    """The number of a method in C."""
    if name not in _NUMBERS:
        invalid("method", name)
    return _NUMBERS[name]


def names_of(field: str, names: Any) -> tuple[str, ...]:
    """The names in a list of names: a string is not taken for the list of its letters."""
    if isinstance(names, str):
        invalid(field, names, reason=f"not a list of names, such as [{names!r}]")
    return tuple(names)


def springs_method(name: str) -> int:
    """The number of a method that is offered for one spring and batches."""
    number = method_number(name)
    if not lib.spring_method_describe(number).springs:
        fail(lib.SPRING_EUNSUPPORTED, "method", name)
    return number


def step_count(steps: int) -> int:
    """A number of steps that C can count."""
    steps = operator.index(steps)
    if not 0 <= steps < 2**64:
        invalid("steps", steps)
    return steps


def finite(field: str, value: float) -> float:
    """A number that is finite."""
    if not math.isfinite(value):
        invalid(field, value)
    return value


def self_test() -> None:
    """Has the library the arithmetic here that its bits depend on? SpringError if not."""
    if status := lib.spring_self_test():
        fail(status)
