# SPDX-License-Identifier: MIT
"""Springs through time: one, a million, or joined to ropes, cloth, jelly and water.

Spring is one spring, Batch many that are not joined, Scene particles joined by springs, Clock fixed steps from frames of
any length. The numbers are those of the C library, bit for bit. ffi and lib are the library as it is in C, by cffi.
"""
from springstep._batch import Batch
from springstep._clock import Clock
from springstep._common import (InvalidError, Method, NonFiniteError, RangeError, SpringError, UnstableError,
                                UnsupportedError, methods, self_test)
from springstep._native import ffi, lib
from springstep._scene import (LINK, Collider, Energies, Grid, Scene, Snapshot, box, capsule, components, grid, plane,
                               sphere)
from springstep._spring import Spring
from springstep._sweep import sweep

__version__: str = ffi.string(lib.spring_version()).decode()

__all__ = [
    "Batch", "Clock", "Collider", "Energies", "Grid", "InvalidError", "LINK", "Method", "NonFiniteError",
    "RangeError", "Scene", "Snapshot", "Spring", "SpringError", "UnstableError", "UnsupportedError", "box", "capsule",
    "components", "ffi", "grid", "lib", "methods", "plane", "self_test", "sphere", "sweep",
]
