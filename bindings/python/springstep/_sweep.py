# SPDX-License-Identifier: MIT
"""Sweeps: a spring, or a scene, at every point of a grid of parameters; here, in processes, or by the workers of Dask."""
from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import numpy as np
from numpy.typing import NDArray

from springstep._common import MethodName, NonFiniteError, UnsupportedError, invalid, method_number, methods as all_methods
from springstep._native import ffi, lib
from springstep._scene import Scene

_RESULT = np.dtype({
    "names": ["number", "status"],
    "formats": [(np.float64, ffi.offsetof("sweep_result", "status") // 8), np.int32],
    "offsets": [0, ffi.offsetof("sweep_result", "status")],
    "itemsize": ffi.sizeof("sweep_result"),
})


def _words(names: Any) -> list[str]:
    words: list[str] = []
    while names[len(words)] != ffi.NULL:
        words.append(ffi.string(names[len(words)]).decode())
    return words


_MEASURES, _STATUSES = _words(lib.sweep_measure_names), _words(lib.sweep_status_names)


class _Grid:
    """A grid of springs or preset scenes, from the words of spring-sweep."""

    def __init__(self, scene: str, axes: tuple[str, ...], methods: str, measures: str) -> None:
        self._words = scene, axes, methods, measures
        self.piece = 16 if scene == "spring" else 1  # points of one call of C, which nothing interrupts
        self.c: Any = ffi.gc(ffi.new("grid *"), lib.grid_clear)
        lib.grid_init(self.c)
        self._say("scene", lib.grid_set_scene(self.c, scene.encode()))
        for axis in axes:
            self._say("over", lib.grid_add_axis(self.c, axis.encode()))
        self._say("methods", lib.grid_add_methods(self.c, methods.encode()))
        if measures:
            self._say("measure", lib.grid_add_measures(self.c, measures.encode()))
        self._say("over", lib.grid_finish(self.c))

    def __reduce__(self) -> tuple[Any, ...]:
        return _Grid, self._words

    def __len__(self) -> int:
        return int(self.c.points)

    def _say(self, field: str, done: bool) -> None:
        if not done:
            invalid(field, ffi.string(self.c.message).decode(errors="replace"))  # C may cut the last character

    def measure(self, first: int, count: int) -> NDArray[np.void]:
        """Return the rows of some points."""
        c = self.c
        values, results = np.empty((count, int(c.axes))), np.empty(count * c.methods, _RESULT)
        to_values, to_results = ffi.from_buffer("double[]", values), ffi.from_buffer("sweep_result[]", results)
        memory = ffi.gc(lib.sweep_memory_new(), lib.sweep_memory_free)
        for done in range(0, count, self.piece):
            if not lib.grid_measure(c, memory, first + done, min(self.piece, count - done), to_values + done * c.axes,
                                    to_results + done * c.methods):
                raise MemoryError("no memory for the points of a sweep")
        axes = [ffi.string(lib.sweep_parameters[c.axis[i].parameter].column).decode() for i in range(c.axes)]
        measures = [c.measure[i] for i in range(c.measures)]
        rows = np.empty(count * c.methods, [
            *((name, np.float64) for name in axes), ("method", "U20"), ("error", np.float64), ("energy_error", np.float64),
            ("status", "U12"), *((_MEASURES[m], np.float64) for m in measures)])
        for i, name in enumerate(axes):
            rows[name] = np.repeat(values[:, i], c.methods)
        names = [ffi.string(lib.spring_method_name(c.method[k])).decode() for k in range(c.methods)]
        rows["method"] = np.tile(names, count)
        rows["status"] = np.array(_STATUSES)[results["status"]]
        for m in (0, 1, *measures):
            rows[_MEASURES[m]] = results["number"][:, m]
        return rows


class _Own:
    """A grid of scenes that a function makes."""

    run: dict[str, Any] = {"duration": 2.0, "steps_per_frame": 8, "stable_fraction": None}  # what is not for the function

    def __init__(self, make: Callable[..., Scene[Any]], over: Mapping[str, Any], methods: str | Iterable[str],
                 measure: Any) -> None:
        self._make = make
        self._axes = {name: _values(name, values) for name, values in over.items()}
        names: Any = methods.split(",") if isinstance(methods, str) else list(methods)
        self._methods: Any = [method.name for method in all_methods() if method.scenes] if names == ["all"] else names
        for method in self._methods:
            method_number(method)
        self._measures = {measure.__name__: measure} if callable(measure) else measure
        if not isinstance(self._measures, Mapping) or not self._measures or not all(map(callable, self._measures.values())):
            raise TypeError("measure: neither a function of the scene nor several by their names")

    def __len__(self) -> int:
        return math.prod(map(len, self._axes.values()))

    def _row(self, point: dict[str, Any], method: MethodName) -> tuple[Any, ...]:
        how = {name: point.get(name, default) for name, default in self.run.items()}
        for name, value in how.items():
            if value is not None and not 0 < value < np.inf:
                invalid(name, float(value), reason="not a number greater than 0")
        scene = self._make(**{name: value for name, value in point.items() if name not in self.run})
        dt, status = np.nan, "finished"
        try:
            dt = 1 / 60 / how["steps_per_frame"]
            if how["stable_fraction"] is not None:
                dt = how["stable_fraction"] * scene.stable_step(method)
            if 0 < dt < np.inf:
                scene.advance(dt, max(1, round(how["duration"] / dt)), method)
            else:
                status = "no_step"
        except UnsupportedError:
            status = "unsupported"
        except NonFiniteError:
            status = "exploded"
        values = (measure(scene) if status == "finished" else np.nan for measure in self._measures.values())
        return (*point.values(), method, dt, status, *values)

    def measure(self, first: int, count: int) -> NDArray[np.void]:
        """Return the rows of some points."""
        shape = [len(values) for values in self._axes.values()]
        rows = []
        for point in range(first, first + count):
            places = np.unravel_index(point, shape) if shape else ()
            values = {name: values[place] for (name, values), place in zip(self._axes.items(), places)}
            rows += [self._row(values, method) for method in self._methods]
        return np.array(rows, [*((name, values.dtype) for name, values in self._axes.items()), ("method", "U20"),
                               ("dt_s", np.float64), ("status", "U12"), *((name, np.float64) for name in self._measures)])


def _values(name: str, values: Any) -> NDArray[Any]:
    """Return the values of an axis: A:B:N, A:B:log:N, A,B,... or any values."""
    if not isinstance(values, str):
        return np.atleast_1d(values if hasattr(values, "__float__") else np.array(list(values)))
    first, *rest = values.split(":")
    try:
        if not rest:
            return np.array([float(value) for value in first.split(",")])
        last, *kind, count = rest
        if kind in ([], ["log"]):
            return (np.geomspace if kind else np.linspace)(float(first), float(last), int(count))
    except ValueError:
        pass
    invalid("over", f"{name}={values}")


def _axis(name: str, values: Any) -> str:
    if not isinstance(values, str):
        try:
            values = ",".join(repr(float(value)) for value in _values(name, values))
        except (TypeError, ValueError):
            invalid("over", f"{name}={values!r}")
    return f"{name}={values}"


def _list(words: str | Iterable[str]) -> str:
    return words if isinstance(words, str) else ",".join(words)


def sweep(over: Mapping[str, str | float | Iterable[Any]], methods: str | Iterable[str] = "all", *,
          scene: str | Callable[..., Scene[Any]] = "spring",
          measure: str | Iterable[str] | Callable[[Scene[Any]], float] | Mapping[str, Callable[[Scene[Any]], float]] = (),
          client: Any = None, processes: int | None = None, points_per_task: int | None = None,
          retries: int = 3) -> NDArray[np.void]:
    """Simulate a spring, or a scene, at every point of a grid of parameters.

    Numbers in strings have a decimal point. Where the locale of the process (LC_NUMERIC) has a comma, they are refused.

    Parameters
    ----------
    over : mapping
        Of each parameter its values, ``"A:B:N"``, or ``"A:B:log:N"``. The first parameter changes slowest.
    methods : str or iterable of str
        Names of methods, or ``"all"``.
    scene : str or callable
        ``"spring"``, a preset, or a function that returns a `Scene`. It is called with a point of the grid as arguments, for
        each method, without `duration` (default 2 s) and `stable_fraction` or `steps_per_frame` (default 8 per 1/60 s). They
        determine how long the scene is advanced, and its step.
    measure : str, iterable of str, callable or mapping
        Additional columns, such as ``"steps"``. With a function as `scene`: a function of the scene at the end that returns a
        number, or several by the names of their columns.
    client : distributed.Client, optional
        Dask client, whose workers do the work. Workers that die are replaced.
    processes : int, optional
        Number of processes that do the work. Functions must then be defined in a module. By default this thread does it.
    points_per_task : int, optional
        Points per task of a worker; by default a hundredth of its share.
    retries : int
        Of a task that fails, by Dask.

    Returns
    -------
    ndarray
        With a field for each column, one row per point and method. Rows of springs and presets are bit-identical to those
        of spring-sweep. A function's rows have the parameters, `method`, `dt_s`, `status` (``"finished"``, ``"exploded"``,
        ``"unsupported"``, or ``"no_step"`` if `stable_fraction` gives none), and the measures.
    """
    for name, number in (("points_per_task", points_per_task), ("processes", processes)):
        if number is not None and operator.index(number) < 1:
            invalid(name, number)
    points: _Own | _Grid
    if callable(scene):
        points = _Own(scene, over, methods, measure)
    else:
        names: Any = measure
        points = _Grid(scene, tuple(_axis(name, values) for name, values in over.items()), _list(methods), _list(names))
    count = len(points)
    if client is None and processes is None:
        return points.measure(0, count)
    if points_per_task is None:
        workers = processes if client is None else sum(client.nthreads().values())
        points_per_task = max(1, count // (100 * max(1, workers or 1)))
    firsts = range(0, count, points_per_task)
    counts = [min(points_per_task, count - first) for first in firsts]
    if client is not None:
        futures = client.map(points.measure, firsts, counts, pure=False, retries=retries)
        return np.concatenate(client.gather(futures))
    with ProcessPoolExecutor(processes) as pool:
        return np.concatenate(list(pool.map(points.measure, firsts, counts)))
