# SPDX-License-Identifier: MIT
"""Links of scenes, and grids of particles with their links."""
from __future__ import annotations

import contextlib
import operator
from collections.abc import Callable, Iterable, Sequence
from typing import Any, Literal, NamedTuple, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, NDArray

from springstep._common import aligned, fail, invalid, names_of
from springstep._native import ffi, lib

_FORMATS: dict[str, Any] = {"double": np.float64, "uint32_t": np.uint32, "double[4]": (np.float64, 4),
                            "uint32_t[4]": (np.uint32, 4)}


def _dtype(struct: str) -> np.dtype[np.void]:
    """Return a structure of C as a dtype."""
    fields = ffi.typeof(struct).fields
    return np.dtype({
        "names": [name for name, _ in fields],
        "formats": [_FORMATS[field.type.cname] for _, field in fields],
        "offsets": [field.offset for _, field in fields],
        "itemsize": ffi.sizeof(struct),
    })


#: A link, as in C: a and b [indices of particles], rest [m], stiffness [N/m], damping [N s/m], flags, see TENSION_ONLY.
LINK: np.dtype[np.void] = _dtype("spring_link")
#: A weighted link, as in C: particle [4 indices], weight [4], rest [m], stiffness [N/m], damping [N s/m].
WEIGHTED_LINK: np.dtype[np.void] = _dtype("spring_weighted_link")
#: Values of `flags` of a link: it pulls only; and it acts only while exactly one of its ends is pinned.
TENSION_ONLY: int = lib.SPRING_LINK_TENSION_ONLY
TETHER: int = lib.SPRING_LINK_TETHER

Family = Literal["structural", "shear", "bend"]
Face = Literal["first_x", "last_x", "first_y", "last_y", "first_z", "last_z"]

_FAMILIES = ("structural", "shear", "bend")
_FACES = ("first_x", "last_x", "first_y", "last_y", "first_z", "last_z")
_COLUMNS = ("a", "b", "rest", "stiffness", "damping")


class Grid(NamedTuple):
    """The arrays of a grid, which may be changed, for `Scene.from_grid`."""

    position: NDArray[np.float64]  #: [m], (particles, axes)
    pinned: NDArray[np.bool_]  #: True: pinned
    links: NDArray[np.void]  #: of LINK

    def __repr__(self) -> str:
        return f"<Grid of {len(self.position)} particles and {len(self.links)} links on {self.position.shape[1]} axes>"


def _bits(field: str, names: Iterable[str], known: Sequence[str]) -> int:
    """Return names as bits, in the order of the C library."""
    bits = 0
    for name in names_of(field, names):
        if name not in known:
            invalid(field, name, reason=f"not one of {', '.join(known)}")
        bits |= 1 << known.index(name)
    return bits


def grid(count: Iterable[SupportsIndex], spacing: float, stiffness: float, damping: float = 0.0, *,
         families: Iterable[Family] = ("structural",), pinned: Iterable[Face] = (), stretch: float = 1.0, axes: int = 3,
         height: bool = False) -> Grid:
    """Return the particles at the corners of a grid, and its links: a row is a rope, a layer a sheet, more a block.

    Parameters
    ----------
    count : iterable of int
        One to three numbers, the particles along x, y and z. Particle (i, j, k) has index i + count[0] (j + count[1] k).
    spacing : float
        Distance from one particle to the next > 0 [m].
    stiffness, damping : float
        Of every link [N/m], [N s/m].
    families : iterable of str
        ``"structural"`` to the next particle, ``"shear"`` across faces, ``"bend"`` to the second next particle.
    pinned : iterable of str
        Pinned faces: ``"first_x"``, ``"last_x"``, ``"first_y"`` ...
    stretch : float
        Initial length of every link divided by its rest length. Above 1 there is tension.
    axes : int
        Number of axes of the positions, 1 to 3.
    height : bool
        A height field, with one axis perpendicular to the grid.

    Returns
    -------
    Grid
        Positions, pinned particles and links.
    """
    shape = tuple(operator.index(number) for number in count)
    c = grid_as_c(shape, axes=axes, height=height, spacing=spacing, stretch=stretch, stiffness=stiffness, damping=damping,
                  families=_bits("families", families, _FAMILIES), pinned=_bits("pinned", pinned, _FACES))
    particles, links = ffi.new("size_t *"), ffi.new("size_t *")
    if status := lib.spring_grid_size(c, particles, links):
        for field in ("spacing", "stretch"):
            if not 0 < getattr(c, field) < np.inf:
                invalid(field, getattr(c, field))
        for field in ("stiffness", "damping"):
            if not 0 <= getattr(c, field) < np.inf:
                invalid(field, getattr(c, field))
        if status == lib.SPRING_ERANGE:
            fail(status, "count", shape)
        if not height and len(shape) > axes and max(shape[axes:]) > 1:
            invalid("axes", axes, reason=f"fewer than the directions of count = {shape}")
        invalid("spacing", spacing)
    result = Grid(np.empty((int(particles[0]), int(c.axes))), np.empty(particles[0], np.bool_), np.empty(links[0], LINK))
    if status := lib.spring_grid_fill(c, ffi.from_buffer("double[]", result.position),
                                      ffi.from_buffer("uint8_t[]", result.pinned), as_c(result.links)):
        fail(status)
    return result


def grid_as_c(count: Iterable[SupportsIndex], *, axes: int, height: bool = False, **fields: float) -> Any:
    """Return a spring_grid of C."""
    shape = tuple(operator.index(number) for number in count)
    if not 1 <= len(shape) <= 3:
        invalid("count", shape, reason="not one to three numbers")
    if not all(0 <= number < 2**32 for number in shape):
        fail(lib.SPRING_ERANGE, "count", shape)
    if axes not in (1, 2, 3):
        invalid("axes", axes, reason="not 1, 2 or 3")
    return ffi.new("spring_grid *", {"count": [*shape, 1, 1][:3], "axes": 1 if height else axes, "height": height, **fields})


def as_c(links: NDArray[np.void]) -> Any:
    """Return a pointer to the first link."""
    return ffi.cast("spring_link *", ffi.from_buffer(links))


def _columns(links: Any) -> dict[str, NDArray[Any]]:
    """Return the columns that links have, by name."""
    if isinstance(links, np.ndarray) and links.dtype == object:
        links = links.tolist()
    if not isinstance(links, np.ndarray):
        try:
            links = np.array(list(links))
        except ValueError:
            raise ValueError("links: rows of different lengths") from None
        if links.dtype == object:  # integers of more than 64 bits, or fractions
            with contextlib.suppress(TypeError, ValueError, OverflowError):
                links = links.astype(np.float64)
    if names := links.dtype.names:
        columns = {name: links[name] for name in names}
        if (ends := columns.pop("ends", None)) is not None and ends.shape == (len(links), 2):
            columns["a"], columns["b"] = ends.T
        missing = [name for name in ("a", "b") if name not in columns]
        unknown = [name for name in columns if name not in LINK.names]  # type: ignore[operator]
        if missing or unknown or links.ndim != 1:
            raise ValueError(f"links: missing fields {missing}, unknown fields {unknown}, shape {links.shape}")
        return columns
    if links.size == 0:
        links = np.empty((0, 5))
    if links.dtype.kind not in "iuf" or links.ndim != 2 or links.shape[1] not in (2, 5):
        raise ValueError(f"links: an array of {links.dtype} and shape {links.shape}, not (links, 2), (links, 5) or structured")
    return dict(zip(_COLUMNS, links.T))


def joined(links: Any, position: NDArray[np.float64] | None, **given: ArrayLike | None) -> NDArray[np.void]:
    """Return links, or their columns, as an array of LINK. What they lack is given, or follows from the positions."""
    columns = links if isinstance(links, dict) else _columns(links)
    count = len(columns["a"])
    result = np.zeros(count, LINK)
    if count == 0:
        return result
    for name in ("a", "b"):
        ends = columns[name]
        if (fractions := np.flatnonzero(~np.equal(np.floor(ends), ends))).size:
            row = int(fractions[0])
            invalid(f"link.{name}", ends[row].item(), row, reason="not an integer")
        if (outside := np.flatnonzero((ends < 0) | (ends >= 2**32))).size:
            row = int(outside[0])
            fail(lib.SPRING_ERANGE, f"link.{name}", ends[row].item(), row)
    for name, values in columns.items():
        result[name] = values
    for name, value in given.items():
        if value is not None and name in columns:
            raise TypeError(f"{name}: the links have it, too")
        if value is not None:
            if np.shape(value) not in ((), (count,)):
                raise ValueError(f"{name}: its shape is {np.shape(value)}, not () or {(count,)}")
            result[name] = value
    for name in ("rest", "stiffness"):
        if name not in columns and given.get(name) is None and (name == "stiffness" or position is None):
            raise TypeError(f"{name}: missing, because the links do not have it")
    if "rest" not in columns and given.get("rest") is None and position is not None:
        inside = (result["a"] < len(position)) & (result["b"] < len(position))  # C refuses the others
        apart = position[result["b"][inside]] - position[result["a"][inside]]
        result["rest"][inside] = abs(apart[:, 0]) if position.shape[1] == 1 else np.linalg.norm(apart, axis=1)
        if position.shape[1] == 1:  # b must be above a
            down = np.flatnonzero(inside)[apart[:, 0] < 0]
            result["a"][down], result["b"][down] = result["b"][down], result["a"][down]
    return result


def components(particles: int, links: ArrayLike) -> tuple[int, NDArray[np.uint32]]:
    """Return the connected components of particles that links join.

    Parameters
    ----------
    particles : int
        Number of particles.
    links : array_like
        As in `Scene`. Pairs of particles will do. Links without stiffness and damping, such as torn ones, do not join.

    Returns
    -------
    count : int
        Number of components.
    component : ndarray of uint32
        Of each particle its component, in the order of their first particles.
    """
    columns = _columns(links)
    array = joined(columns, None, **{name: 1.0 for name in ("rest", "stiffness") if name not in columns})
    component = np.empty(natural("particles", particles), np.uint32)
    count = lib.spring_links_components(len(component), len(array), as_c(array),
                                        ffi.cast("uint32_t *", ffi.from_buffer(component)))
    if count == 0 and len(component) > 0:
        wrong = (array["a"] == array["b"]) | (np.maximum(array["a"], array["b"]) >= len(component))
        for name in ("stiffness", "damping"):
            wrong |= ~((array[name] >= 0) & (array[name] < np.inf))
        for index in np.flatnonzero(wrong)[:1].tolist():
            fail(lib.SPRING_EINVAL, "links", array[index].tolist(), index)
        fail(lib.SPRING_EINVAL, "particles", particles)
    return count, component


def natural(field: str, index: SupportsIndex) -> int:
    """Return an index >= 0 of 32 bits: unlike indices of lists, indices of particles do not count from the end."""
    number = operator.index(index)
    if not 0 <= number < 2**32:
        fail(lib.SPRING_ERANGE, field, number)
    return number


def weighted(links: ArrayLike | None) -> NDArray[np.void]:
    """Return a copy of weighted links, as an array of WEIGHTED_LINK. The fields of a structured array have any order."""
    given: Any = [] if links is None else links
    names = [*(WEIGHTED_LINK.names or ())]
    if fields := getattr(getattr(given, "dtype", None), "names", None):
        if sorted(fields) != sorted(names):
            raise ValueError(f"weighted_links: fields {[*fields]}, not {names}")
        given = given[names]  # NumPy converts by position
    array = np.array(given, WEIGHTED_LINK, order="C", ndmin=1)
    if array.ndim != 1:
        raise ValueError(f"weighted_links: its shape is {array.shape}, not (weighted_links,)")
    return array


def lend(definition: Any, given: dict[str, NDArray[Any]], check: Callable[..., int] = lib.spring_scene_check,
         methods: tuple[str, ...] = ()) -> None:
    """Let a definition point to arrays, which the caller keeps, and raise the exception if C refuses it."""
    for field, array in given.items():
        setattr(definition, field, ffi.cast(ffi.typeof(getattr(definition, field)), ffi.from_buffer(array)))
    wrong, place = ffi.new("const char **"), ffi.new("size_t *")
    if not (status := check(definition, wrong, place)):
        return
    named, index = ffi.string(wrong[0]).decode() if wrong[0] else None, place[0]
    name, _, part = (named or "").partition(".")
    if name in given and index < len(given[name]):
        row = given[name][index]
        named = f"particle_{name}" if name in ("radius", "friction") else named
        fail(status, named, (row[part] if part else row).tolist(), index)
    if name == "methods":
        fail(status, named, methods)
    if name == "flags":
        fail(status, "tension_only", True)
    value = getattr(definition, name, None)
    fail(status, named, value if isinstance(value, (int, float)) else None)
