# SPDX-License-Identifier: MIT
"""Sweeps: what becomes of a spring, or of a scene, at every point of a grid; here, or by the workers of a Dask client."""
from __future__ import annotations

import operator
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from springstep._common import invalid
from springstep._native import ffi, lib

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

_Words = tuple[str, tuple[str, ...], str, str]  # scene, axes, methods, measures: as spring-sweep takes them


class _Grid:
    """A grid from the words for it; InvalidError if they are not."""

    def __init__(self, scene: str, axes: Iterable[str], methods: str, measures: str):
        self.piece = 16 if scene == "spring" else 1  # points of one call of C, which nothing interrupts
        self.c = ffi.gc(ffi.new("grid *"), lib.grid_clear)
        lib.grid_init(self.c)
        self._say("scene", lib.grid_set_scene(self.c, scene.encode()))
        for axis in axes:
            self._say("over", lib.grid_add_axis(self.c, axis.encode()))
        self._say("methods", lib.grid_add_methods(self.c, methods.encode()))
        if measures:
            self._say("measure", lib.grid_add_measures(self.c, measures.encode()))
        self._say("over", lib.grid_finish(self.c))

    def _say(self, field: str, done: bool) -> None:
        if not done:
            invalid(field, ffi.string(self.c.message).decode())

    def measure(self, first: int, count: int) -> np.ndarray:
        """The rows of some points."""
        c = self.c
        values, results = np.empty((count, c.axes)), np.empty(count * c.methods, _RESULT)
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


def _task(words: _Words, first: int, count: int) -> np.ndarray:
    """The work of a process that knows nothing but this."""
    return _Grid(*words).measure(first, count)


def _axis(name: str, values: Any) -> str:
    if not isinstance(values, str):
        try:
            numbers = np.atleast_1d(values if hasattr(values, "__float__") else list(values))
            values = ",".join(repr(float(value)) for value in numbers)
        except (TypeError, ValueError):
            invalid("over", f"{name}={values!r}")
    return f"{name}={values}"


def _list(words: str | Iterable[str]) -> str:
    return words if isinstance(words, str) else ",".join(words)


def sweep(over: Mapping[str, str | float | Iterable[float]], methods: str | Iterable[str] = "all", *,
          scene: str = "spring", measure: str | Iterable[str] = (), client: Any = None,
          points_per_task: int | None = None, retries: int = 3) -> np.ndarray:
    """The rows of a sweep, as spring-sweep writes them, to the bit: an array with a field for each column.

    over: of each parameter its values, or "A:B:N", or "A:B:log:N"; the first one changes slowest
    methods: their names, or "all"
    scene: "spring", or a preset
    measure: further columns, such as "steps"
    client: of dask.distributed: its workers measure, and it looks after those that die; None: this thread measures
    points_per_task: how many a worker is given at a time; if nothing is said, a hundredth of its share
    retries: of a task that fails, by Dask

    Numbers have a decimal point: where the locale of the process (LC_NUMERIC) has a comma, they are refused.
    """
    if points_per_task is not None and operator.index(points_per_task) < 1:
        invalid("points_per_task", points_per_task)
    words = (scene, tuple(_axis(name, values) for name, values in over.items()), _list(methods), _list(measure))
    points = _Grid(*words).c.points
    if client is None:
        return _task(words, 0, points)
    if points_per_task is None:
        points_per_task = max(1, points // (100 * max(1, sum(client.nthreads().values()))))
    firsts = range(0, points, points_per_task)
    counts = [min(points_per_task, points - first) for first in firsts]
    futures = client.map(_task, [words] * len(firsts), firsts, counts, pure=False, retries=retries)
    return np.concatenate(client.gather(futures))
