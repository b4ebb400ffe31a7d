# SPDX-License-Identifier: MIT
"""Functions that make links: bending stiffness, tethers, and the links of triangle meshes."""
from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from springstep._common import aligned, fail, invalid
from springstep._links import LINK, WEIGHTED_LINK, as_c, grid_as_c, joined, lend, natural, weighted
from springstep._native import ffi, lib


class Mesh(NamedTuple):
    """The particles and links of a triangle mesh."""

    position: NDArray[np.float64]  #: [m], (particles, 3)
    links: NDArray[np.void]  #: of LINK
    triangles: NDArray[np.uint32]  #: of particles, (triangles, 3)
    particle_of: NDArray[np.uint32]  #: the particle of each vertex


def _positions(position: ArrayLike) -> NDArray[np.float64]:
    array = aligned(position, np.float64)
    array = array[:, np.newaxis] if array.ndim == 1 else array
    if array.ndim != 2 or not 1 <= array.shape[1] <= 3:
        raise ValueError(f"position: its shape is {array.shape}, not (particles, axes)")
    if (wrong := np.flatnonzero(~np.isfinite(array).all(1))).size:
        invalid("position", array[wrong[0]].tolist(), int(wrong[0]))
    return array


def _in_space(position: ArrayLike) -> NDArray[np.float64]:
    array = _positions(position)
    if array.shape[1] != 3:
        raise ValueError(f"position: its shape is {array.shape}, not (particles, 3)")
    return array


def _corners(triangles: ArrayLike, particles: int) -> NDArray[np.uint32]:
    array = np.asarray(triangles)
    if array.ndim != 2 or array.shape[1] != 3 or array.dtype.kind not in "iu":
        raise ValueError(f"triangles: an array of {array.dtype} and shape {array.shape}, not integers, (triangles, 3)")
    if (outside := np.flatnonzero(((array < 0) | (array >= particles)).any(1))).size:
        fail(lib.SPRING_ERANGE, "triangles", array[outside[0]].tolist(), int(outside[0]))
    return aligned(array, np.uint32)


def _each(field: str, values: ArrayLike, particles: int, dtype: DTypeLike) -> NDArray[Any]:
    array = aligned(values, dtype)
    if array.shape != (particles,):
        raise ValueError(f"{field}: its shape is {array.shape}, not {(particles,)}")
    return array


def _flags(pinned: ArrayLike | None, particles: int) -> Any:
    return ffi.NULL if pinned is None else ffi.from_buffer("uint8_t[]", _each("pinned", pinned, particles, np.bool_))


def _work(count: int, kind: str = "uint32_t") -> Any:
    return ffi.new(f"{kind}[]", max(count, 1))


def _made(kind: np.dtype[np.void], call: Callable[..., int], field: str, reason: str | None,
          **numbers: float) -> NDArray[np.void]:
    """Return what a function of C makes that first counts. It is called with a pointer to links, and the count. An
    error names the number that is negative or not finite, or else the field."""
    count = ffi.new("size_t *")
    c_name = "spring_link *" if kind is LINK else "spring_weighted_link *"
    result = np.empty(0, kind)
    if (status := call(ffi.cast(c_name, 0), count)) == lib.SPRING_OK:
        result = np.empty(count[0], kind)
        status = call(ffi.cast(c_name, ffi.from_buffer(result)), count)
    for name, value in numbers.items() if status else ():
        if not 0 <= value < np.inf or (name in ("fraction", "spacing") and value == 0):
            invalid(name, value)
    if status == lib.SPRING_EINVAL and "rigidity" in numbers and call(ffi.cast(c_name, 0), count, 0.0) == lib.SPRING_OK:
        invalid("rigidity", numbers["rigidity"], reason="the stiffness or the damping of a link is not finite")
    if status == lib.SPRING_EINVAL:
        invalid(field, None, reason=reason)
    if status:
        fail(status, field)
    return result


def bend_rod(position: ArrayLike, rigidity: float, *, pinned: ArrayLike | None = None,
             damping_time: float = 0.0) -> NDArray[np.void]:
    """Return weighted links that resist bending of a rod, such as a cable, hair or an antenna.

    Two pinned particles next to each other are a clamp.

    Parameters
    ----------
    position : array_like
        [m], (particles, axes), of the straight rod, in order.
    rigidity : float
        Bending stiffness EI >= 0 [N m^2].
    pinned : array_like, optional
        For each particle, whether it is pinned.
    damping_time : float
        Damping divided by stiffness of each link >= 0 [s].

    Returns
    -------
    ndarray of WEIGHTED_LINK
        For `weighted_links` of `Scene`.
    """
    at = _positions(position)
    flags = _flags(pinned, len(at))
    return _made(WEIGHTED_LINK, lambda out, count, rigidity=rigidity: lib.spring_bend_rod(
        len(at), at.shape[1], ffi.from_buffer("double[]", at), flags, rigidity, damping_time, out, count),
        "position", "neighbouring particles are at one place, or too far apart", rigidity=rigidity, damping_time=damping_time)


def bend_grid(count: Iterable[SupportsIndex], spacing: float, rigidity: float, *, pinned: ArrayLike | None = None,
              diagonals: bool = True, damping_time: float = 0.0) -> NDArray[np.void]:
    """Return weighted links that resist bending of a sheet, such as cloth or paper.

    Parameters
    ----------
    count, spacing
        As in `grid`, with two directions that have more than one particle.
    rigidity : float
        Bending stiffness D >= 0 [N m].
    pinned : array_like, optional
        For each particle, whether it is pinned.
    diagonals : bool
        False: along rows and columns only, at half of the cost.
    damping_time : float
        Damping divided by stiffness of each link >= 0 [s].

    Returns
    -------
    ndarray of WEIGHTED_LINK
        For `weighted_links` of `Scene`.
    """
    sheet = grid_as_c(count, spacing=spacing, axes=3)
    flags = _flags(pinned, int(np.prod([max(number, 1) for number in sheet.count])))
    families = lib.SPRING_BEND_ROWS | (lib.SPRING_BEND_DIAGONALS if diagonals else 0)
    return _made(WEIGHTED_LINK, lambda out, number, rigidity=rigidity: lib.spring_bend_grid(
        sheet, flags, families, rigidity, damping_time, out, number),
        "count", "not two directions with more than one particle", spacing=spacing, rigidity=rigidity, damping_time=damping_time)


def bend_mesh(position: ArrayLike, triangles: ArrayLike, rigidity: float, *, pinned: ArrayLike | None = None,
              damping_time: float = 0.0) -> NDArray[np.void]:
    """Return weighted links that resist bending of a flat triangle mesh, see `from_mesh`.

    Parameters
    ----------
    position : array_like
        [m], (particles, 3), at rest.
    triangles : array_like
        Indices of particles, (triangles, 3).
    rigidity : float
        Bending stiffness D >= 0 [N m].
    pinned : array_like, optional
        For each particle, whether it is pinned.
    damping_time : float
        Damping divided by stiffness of each link >= 0 [s].

    Returns
    -------
    ndarray of WEIGHTED_LINK
        For `weighted_links` of `Scene`.
    """
    at = _in_space(position)
    corners = _corners(triangles, len(at))
    flags, work = _flags(pinned, len(at)), _work(len(at) + 6 * len(corners) + 1)
    return _made(WEIGHTED_LINK, lambda out, count, rigidity=rigidity: lib.spring_bend_mesh(
        len(at), ffi.from_buffer("double[]", at), len(corners), ffi.from_buffer("uint32_t[]", corners), flags, rigidity,
        damping_time, out, count, work), "triangles", "a triangle has no area, or an edge has more than two triangles",
        rigidity=rigidity, damping_time=damping_time)


def _definition(position: ArrayLike, links: ArrayLike, pinned: ArrayLike | None, weighted_links: ArrayLike | None,
                columns: dict[str, ArrayLike | None], mass: ArrayLike = 1.0) -> tuple[Any, dict[str, NDArray[Any]]]:
    """Return a definition of C, and its arrays, which the caller keeps."""
    at = _positions(position)
    given = {"position": at, "link": joined(links, at, **columns), "weighted_link": weighted(weighted_links),
             "mass": _each("mass", np.full(len(at), mass) if np.ndim(mass) == 0 else mass, len(at), np.float64)}
    if pinned is not None:
        given["pinned"] = _each("pinned", pinned, len(at), np.bool_)
    definition = ffi.new("spring_scene_def *", {"axes": at.shape[1], "particles": len(at), "links": len(given["link"]),
                                                "weighted_links": len(given["weighted_link"])})
    lend(definition, given)
    return definition, given


def tethers(position: ArrayLike, links: ArrayLike, pinned: ArrayLike, *, fraction: float = 0.05, slack: float = 0.0,
            weighted_links: ArrayLike | None = None, **columns: ArrayLike | None) -> NDArray[np.void]:
    """Return tethers: tension-only links to the nearest pinned particle, which limit the stretch of ropes and cloth.

    ``links = np.concatenate([links, tethers(position, links, pinned)])`` adds them to an array of LINK, such as `grid`
    returns.

    Parameters
    ----------
    position, links, pinned, weighted_links
        As in `Scene`, for two or three axes.
    fraction : float
        Stiffness of a tether > 0, relative to the sum of the stiffness of its particle.
    slack : float
        Relative excess length >= 0.
    **columns
        `rest`, `stiffness` and `damping`, as in `Scene`, if the links do not have them.

    Returns
    -------
    ndarray of LINK
        One tether for each particle that hangs on a pinned one and is not next to it.
    """
    definition, given = _definition(position, links, pinned, weighted_links, columns)
    work, distance = _work(2 * definition.particles), _work(2 * definition.particles, "double")
    return _made(LINK, lambda out, count: lib.spring_links_tethers(definition, fraction, slack, out, count, work, distance),
                 "links", None, fraction=fraction, slack=slack)


def soften(position: ArrayLike, links: ArrayLike, dt: float, *, fraction: float = 0.5, mass: ArrayLike = 1.0,
           pinned: ArrayLike | None = None, weighted_links: ArrayLike | None = None,
           **columns: ArrayLike | None) -> NDArray[np.void]:
    """Return links as an array of LINK, with their stiffness lowered until leapfrog is stable with a time step.

    Parameters
    ----------
    position, links, mass, pinned, weighted_links
        As in `Scene`. Weighted links keep their stiffness.
    dt : float
        Time step > 0 [s].
    fraction : float
        Fraction of the stable step that `dt` may be, > 0 and <= 1.
    **columns
        As in `tethers`.
    """
    definition, given = _definition(position, links, pinned, weighted_links, columns, mass)
    if status := lib.spring_links_soften(definition, dt, fraction, as_c(given["link"])):
        for field, value, most in (("dt", dt, np.finfo(float).max), ("fraction", fraction, 1)):
            if not 0 < value <= most:
                invalid(field, value)
        fail(status, "weighted_links")
    return given["link"]


def renumber(particles: int, links: ArrayLike,
             **columns: ArrayLike | None) -> tuple[NDArray[np.void], NDArray[np.uint32], NDArray[np.uint32]]:
    """Return links as an array of LINK, with particles renumbered and links sorted: an unsorted mesh then runs faster.

    Parameters
    ----------
    particles : int
        Number of particles.
    links
        As in `Scene`, with all values.
    **columns
        As in `tethers`.

    Returns
    -------
    links, order, link_order : ndarray
        ``position[order]`` and ``names_of_links[link_order]`` sort other arrays in the same way.
    """
    array = joined(links, None, **columns)
    order, link_order = np.empty(natural("particles", particles), np.uint32), np.empty(len(array), np.uint32)
    if status := lib.spring_links_renumber(
            len(order), len(array), as_c(array), ffi.from_buffer("uint32_t[]", order),
            ffi.from_buffer("uint32_t[]", link_order), _work(4 * len(order) + 2 * len(array) + 1)):
        for row in np.flatnonzero((np.maximum(array["a"], array["b"]) >= len(order)) | (array["a"] == array["b"])).tolist():
            fail(status, "links", array[row].tolist(), row)
        fail(status, "particles", particles)
    return array, order, link_order


def from_mesh(position: ArrayLike, triangles: ArrayLike, stiffness: float, damping: float = 0.0, *,
              weld: float | None = 0.0) -> Mesh:
    """Return the particles and links of a triangle mesh for drawing, whose vertices may be split at seams.

    Parameters
    ----------
    position : array_like
        [m], (vertices, 3).
    triangles : array_like
        Indices of vertices, (triangles, 3).
    stiffness, damping : float
        Of every link [N/m], [N s/m].
    weld : float or None
        Vertices that are not farther apart become one particle [m]. None: each vertex is a particle.

    Returns
    -------
    Mesh
        A particle is at its first vertex. To draw the mesh, use ``scene.position()[mesh.particle_of]``.
    """
    at = _in_space(position)
    corners = _corners(triangles, len(at))
    work, distance = _work(3 * len(at) + 6 * len(corners) + 1), -1.0 if weld is None else weld
    if not 0 <= distance < np.inf and weld is not None:
        invalid("weld", weld)
    particle_of, particles = np.zeros(len(at), np.uint32), ffi.new("size_t *")
    links = _made(LINK, lambda out, count: lib.spring_links_from_mesh(
        len(at), ffi.from_buffer("double[]", at), len(corners), ffi.from_buffer("uint32_t[]", corners), distance,
        ffi.from_buffer("uint32_t[]", particle_of), particles, out, count, work),
        "triangles", "a triangle has no area")
    links["stiffness"], links["damping"] = stiffness, damping
    places = np.empty((particles[0], 3))
    places[particle_of[::-1]] = at[::-1]  # the first vertex of a particle comes last
    return Mesh(places, links, particle_of[corners], particle_of)
