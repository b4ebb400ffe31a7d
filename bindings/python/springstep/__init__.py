# SPDX-License-Identifier: MIT
"""Deterministic spring simulation: single springs, independent springs, and mass-spring systems such as rope and cloth.

Spring is a single spring. Batch is an array of independent springs. Scene is a system of particles joined by links. Clock
returns fixed steps for frames of variable duration. Results are bit-identical to those of the C library. ffi and lib give
access to the C functions with cffi.
"""
from springstep._batch import Batch
from springstep._clock import Clock
from springstep._colliders import Collider, box, capsule, custom, plane, sphere
from springstep._common import (InvalidError, Method, MethodName, NonFiniteError, RangeError, SpringError, UnstableError,
                                UnsupportedError, _text, methods, self_test)
from springstep._force import Force
from springstep._links import LINK, TENSION_ONLY, TETHER, WEIGHTED_LINK, Grid, components, grid
from springstep._mesh import Mesh, bend_grid, bend_mesh, bend_rod, from_mesh, renumber, soften, tethers
from springstep._native import ffi, lib
from springstep._scene import Energies, Scene, Snapshot
from springstep._spring import Spring
from springstep._sweep import sweep

__version__ = _text(lib.spring_version())

__all__ = [
    "Batch", "Clock", "Collider", "Energies", "Force", "Grid", "InvalidError", "LINK", "Mesh", "Method", "MethodName",
    "NonFiniteError", "RangeError", "Scene", "Snapshot", "Spring", "SpringError", "TENSION_ONLY", "TETHER", "UnstableError",
    "UnsupportedError", "WEIGHTED_LINK", "bend_grid", "bend_mesh", "bend_rod", "box", "capsule", "components", "custom", "ffi",
    "from_mesh", "grid", "lib", "methods", "plane", "renumber", "self_test", "soften", "sphere", "sweep", "tethers",
]
