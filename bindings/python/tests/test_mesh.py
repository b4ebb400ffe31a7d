# SPDX-License-Identifier: MIT
"""Bending, tethers, attachments and triangle meshes."""
import numpy as np
import pytest

import springstep
from springstep import LINK, TENSION_ONLY, TETHER, WEIGHTED_LINK, Scene, bend_grid, bend_mesh, bend_rod, from_mesh, grid, tethers


def test_a_cantilever_bends_as_a_beam():
    n, length, rigidity, load = 20, 1.0, 0.01, 1e-3
    position = np.zeros((n + 2, 3))
    position[:, 0] = (np.arange(n + 2) - 1) * length / n
    pinned = np.arange(n + 2) < 2
    bend = bend_rod(position, rigidity, pinned=pinned)
    ends = np.stack([np.arange(n + 1), np.arange(1, n + 2)], 1)
    scene = Scene(position, ends, stiffness=20000.0, weighted_links=bend, pinned=pinned, mass=0.01, drag=0.015, held_forces=True,
                  force_ignores_velocity=True)
    force = np.zeros((1, 3))
    force[0, 1] = load
    scene.set_held_force(force, n + 1)
    dt = 0.5 * scene.stable_step()
    scene.advance(dt, int(40 / dt))
    assert scene.position()[-1, 1] == pytest.approx(load * length**3 / (3 * rigidity), rel=2e-3)


def test_tethers_keep_a_rope_from_stretching():
    g = grid([40], 0.05, 70.0, pinned=["first_x"])
    links = np.concatenate([g.links, tethers(g.position, g.links, g.pinned)])
    assert len(links) == 39 + 38 and (links["flags"][39:] == TETHER).all() and (links["b"][39:] == 0).all()
    assert links["rest"][-1] == pytest.approx(39 * 0.05) and links["stiffness"][39] == pytest.approx(0.05 * 4 * 70)
    longest = []
    for joined in (g.links, links):
        scene = Scene(g.position, joined, pinned=g.pinned, mass=0.005, gravity=[9.81, 0, 0], drag=0.02)
        scene.advance(1 / 240, 240 * 20)
        longest.append(scene.position()[-1, 0] / (39 * 0.05) - 1)
    assert longest[0] > 0.2 and longest[1] < 0.005
    g = grid([4000], 0.05, 70.0, pinned=["first_x"])
    assert len(tethers(g.position, g.links, g.pinned.tolist())) == 3998, "a list, too"


def test_sheets():
    both = bend_grid([5, 4], 0.5, 3.0)
    rows = bend_grid([5, 4], 0.5, 3.0, diagonals=False, damping_time=0.25)
    assert len(both) == 3 * 4 + 5 * 2 + 2 * 3 * 2 and len(rows) == 3 * 4 + 5 * 2
    assert rows["stiffness"].max() == 4 * 3 / 0.25 and (rows["damping"] == 0.25 * rows["stiffness"]).all()
    assert both.dtype == WEIGHTED_LINK and (both["weight"].sum(1) == 0).all()


def test_a_mesh_with_a_seam():
    position = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.0], [7, 7, 7]])
    mesh = from_mesh(position, [[0, 1, 2], [3, 5, 4]], 30.0, 0.5)
    assert mesh.particle_of.tolist() == [0, 1, 2, 1, 2, 3, 4] and mesh.triangles.tolist() == [[0, 1, 2], [1, 3, 2]]
    assert (mesh.position[mesh.particle_of] == position).all()
    assert list(zip(mesh.links["a"], mesh.links["b"])) == [(0, 1), (0, 2), (1, 2), (1, 3), (2, 3)]
    assert (mesh.links["stiffness"] == 30).all() and mesh.links["rest"][2] == pytest.approx(2**0.5)
    bend = bend_mesh(mesh.position, mesh.triangles, 2.0)
    assert bend["particle"].tolist() == [[1, 2, 0, 3]] and bend["stiffness"][0] == 2.0
    apart = from_mesh(position, [[0, 1, 2], [3, 5, 4]], 30.0, weld=None)
    assert len(apart.position) == 7 and len(apart.links) == 6
    Scene(mesh.position, mesh.links, weighted_links=bend).advance(1e-3, 5)


def test_an_attachment_and_flags():
    position = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.25, 0.25, 0]]
    attached = np.zeros(1, WEIGHTED_LINK)
    attached[0] = ([3, 0, 1, 2], [-1, 0.5, 0.25, 0.25], 0, 400, 2)
    scene = Scene(position, np.empty(0, LINK), weighted_links=attached, pinned=[True] * 3 + [False], gravity=[0, 0, -10],
                  editable=True)
    scene.advance(0.01, 1000)
    assert scene.position()[3] == pytest.approx([0.25, 0.25, -10 / 400], abs=1e-6)
    attached["stiffness"] = 800
    scene.set_weighted_links(attached)
    assert scene.weighted_link(0)["stiffness"] == 800
    slack = np.array([(0, 1, 2.0, 5.0, 0.0, TENSION_ONLY)], LINK)
    assert Scene(position, slack).tension(0) == 0


def test_weighted_links_are_found_by_the_names_of_their_fields():
    bend = bend_rod(np.eye(3, 2), 1.0, damping_time=0.5)
    other = np.zeros(1, [(name, bend.dtype[name]) for name in reversed(bend.dtype.names)])
    for name in bend.dtype.names:
        other[name] = bend[name]
    scene = Scene(np.eye(3), weighted_links=other, editable=True)
    assert scene.weighted_link(0) == bend[0]
    other["rest"] = 2
    scene.set_weighted_links(other)
    assert scene.weighted_link(0)["rest"] == 2
    with pytest.raises(ValueError, match="^weighted_links: fields"):
        Scene(np.eye(3), weighted_links=bend[["rest", "particle"]])


def test_links_that_are_soft_enough_and_sorted():
    g = grid([5, 5], 0.1, 500.0, 0.5)
    shuffled = np.random.default_rng(2).permutation(25)
    links, place = g.links.copy(), np.argsort(shuffled)
    links["a"], links["b"] = place[g.links["a"]], place[g.links["b"]]
    links, order, link_order = springstep.renumber(25, links)
    scene = Scene(g.position[shuffled][order], links)
    assert (np.diff(np.minimum(links["a"], links["b"]).astype(int)) >= 0).all() and scene.at_rest(0, 1e-9)
    assert sorted(order) == list(range(25)) and sorted(link_order) == list(range(len(links)))
    pinned, dt = np.arange(25) < 5, 1.5 * scene.stable_step()
    soft = springstep.soften(scene.position(), links, dt, fraction=0.9, pinned=pinned)
    assert Scene(scene.position(), soft, pinned=pinned).stable_step() == pytest.approx(dt / 0.9, rel=1e-3)
    assert (soft["stiffness"] <= links["stiffness"]).all() and (soft["damping"] == 0.5).all() and (links["stiffness"] == 500).all()


@pytest.mark.parametrize("call, error, field", [
    (lambda: bend_grid([3, 3], 0.0, 1.0), springstep.InvalidError, "spacing"),
    (lambda: bend_rod([0.0, 0.5, 1], 1e308), springstep.InvalidError, "rigidity"),
    (lambda: bend_grid([3, 3], 1e-3, 1e308), springstep.InvalidError, "rigidity"),
    (lambda: tethers(np.eye(3), [[0, 1], [0, 9]], [True, False, False], stiffness=1.0), springstep.RangeError, "link.b"),
    (lambda: tethers(np.eye(3), [[0, 1]], [True, False, False], stiffness=1.0, weighted_links=[((0, 1, 9, 3), (1, 1, -2, 0), 0, 1, 0)]),
     springstep.RangeError, "weighted_link.particle"),
    (lambda: springstep.soften(np.eye(3), [[0, 1]], 0.0, stiffness=1.0), springstep.InvalidError, "dt"),
    (lambda: springstep.soften(np.eye(3), [[0, 1]], 1.0, stiffness=1.0, fraction=2), springstep.InvalidError, "fraction"),
    (lambda: springstep.soften(np.eye(3), [[0, 1]], 1.0, stiffness=1.0, mass=[1, 0, 1]), springstep.InvalidError, "mass"),
    (lambda: springstep.renumber(2, [(0, 2, 1, 1, 0)]), springstep.RangeError, "links"),
    (lambda: springstep.renumber(-1, []), springstep.RangeError, "particles"),
    (lambda: bend_rod([[0, 0, 0]] * 3, 1.0), springstep.InvalidError, "position"),
    (lambda: bend_rod([0.0, 1, np.nan], 1.0), springstep.InvalidError, "position"),
    (lambda: bend_rod([0.0, 1, 2], -1.0), springstep.InvalidError, "rigidity"),
    (lambda: bend_rod([0.0, 1, 2], 1.0, damping_time=np.nan), springstep.InvalidError, "damping_time"),
    (lambda: bend_grid([5], 0.1, 1.0), springstep.InvalidError, "count"),
    (lambda: from_mesh(np.zeros((3, 3)), [[0, 1, 2]], 1.0), springstep.InvalidError, "triangles"),
    (lambda: from_mesh(np.eye(3), [[0, 1, 3]], 1.0), springstep.RangeError, "triangles"),
    (lambda: from_mesh(np.eye(3), [[0, 1, -1]], 1.0), springstep.RangeError, "triangles"),
    (lambda: from_mesh([[0, 0, np.nan]], np.empty((0, 3), int), 1.0), springstep.InvalidError, "position"),
    (lambda: bend_mesh(np.eye(3), [[0, 1, 2], [2, 1, 0]], 1.0), springstep.InvalidError, "triangles"),
    (lambda: tethers(np.eye(3), [[0, 1]], [True, False, False], stiffness=1.0, fraction=0), springstep.InvalidError, "fraction"),
    (lambda: tethers([0.0, 1], [[0, 1]], [True, False], stiffness=1.0), springstep.UnsupportedError, "links"),
])
def test_what_is_refused(call, error, field):
    with pytest.raises(error) as caught:
        call()
    assert caught.value.field == field
