# SPDX-License-Identifier: MIT
"""Particles joined by springs."""
import copy
import ctypes
import gc
import math
import multiprocessing
import pickle
import subprocess
import sys
import threading
from concurrent.futures import ProcessPoolExecutor
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import springstep
from scenes import FLOATS, OF_SCENES, cloth, fnv, rope, saved_scenes, swing
from springstep import InvalidError, Scene, ffi, grid, lib
from springstep._common import Guard
from springstep._scene import _pins_in


@pytest.mark.parametrize("method", OF_SCENES)
def test_bits_are_those_of_spring_scene(method):
    scene = cloth(force_ignores_velocity=True, methods=[method])
    # Euler's cloth lives for a few dozen steps
    steps = 32 if method == "euler" else 512
    scene.advance(2**-11, steps, method)
    command = ["spring-scene", "--scene", "cloth", "--method", method, "--dt", "0x1p-11", "--duration", str(steps / 2048)]
    assert subprocess.run([*command, "--hash"], capture_output=True, text=True, check=True).stdout.strip() == fnv(scene)
    assert scene.time == steps / 2048


def test_states_travel_from_spring_scene_and_to_it(tmp_path):
    state, other = tmp_path / "state", tmp_path / "other"
    command = ["spring-scene", "--scene", "cloth", "--method", "leapfrog", "--dt", "0x1p-11", "--duration"]
    subprocess.run([*command, "0.0625", "--save", state], capture_output=True, check=True)
    scene = cloth(force_ignores_velocity=True, methods=["leapfrog"])
    scene.load(state.read_bytes())
    scene.advance(2**-11, 128)
    subprocess.run([*command, "0.125", "--save", other], capture_output=True, check=True)
    assert scene.save() == other.read_bytes() and scene.time == 0.125
    state.write_bytes(scene.save())
    scene.advance(2**-11, 128)
    end = subprocess.run([*command, "0.0625", "--load", state, "--hash"], capture_output=True, text=True, check=True)
    assert end.stdout.strip() == fnv(scene)


def test_bits_in_float_are_those_of_c():
    g = grid([6], 0.3, 170.0, 0.2, pinned=["first_x"])
    definition = ffi.new("spring_scenef_def *", {"axes": 3, "particles": 6, "links": 5, "mass_all": 0.13})
    definition.gravity = [0, -9.81, 0.4]
    definition.position = ffi.from_buffer("double[]", g.position)
    definition.pinned = ffi.from_buffer("uint8_t[]", g.pinned)
    definition.link = links = ffi.cast("spring_link *", ffi.from_buffer(g.links))
    assert links[1].a == 1 and links[1].damping == 0.2
    size, scene = ffi.new("size_t *"), ffi.new("spring_scenef **")
    assert lib.spring_scenef_bytes(definition, size) == lib.SPRING_OK
    room = np.empty(size[0] + 64, np.uint8)
    memory = ffi.cast("void *", room.ctypes.data + -room.ctypes.data % 64)
    assert lib.spring_scenef_init(memory, size[0], definition, scene) == lib.SPRING_OK
    assert lib.spring_scenef_advance(scene[0], lib.SPRING_LEAPFROG, 1e-3, 300) == lib.SPRING_OK
    out = np.empty((6, 3), np.float32)
    assert lib.spring_scenef_getf(scene[0], lib.SPRING_POSITION, ffi.from_buffer("float[]", out), 0, 0, 6) == lib.SPRING_OK

    ours = rope(dtype=np.float32)
    ours.advance(1e-3, 300)
    assert ours.position().dtype == np.float32 and (ours.position() == out).all() and ours.nbytes == size[0]
    assert ours.tension(2) == lib.spring_scenef_tension(scene[0], 2)


@FLOATS
def test_a_snapshot_brings_back_what_was(dtype):
    scene = cloth(dtype=dtype, editable=True)
    scene.advance(4e-4, 50)
    before, state = scene.snapshot(), (scene.position(), scene.velocity())
    scene.set_pinned([True, True], 300)
    scene.drive(300, [1.0, 0.5, 0.4], 0.1)
    scene.advance(4e-4, 250)
    after = scene.snapshot(), scene.position()
    assert scene.position(300, 1) == pytest.approx(np.array([[1.0, 0.5, 0.4]]), abs=1e-5)  # float rounds 250 steps
    scene.restore(before)
    assert (scene.position() == state[0]).all() and (scene.velocity() == state[1]).all() and scene.time == 50 * 4e-4
    scene.restore(after[0])
    assert (scene.position() == after[1]).all()
    with pytest.raises(ValueError, match="snapshot"):
        cloth(dtype=dtype, editable=True).restore(before)
    with pytest.raises(TypeError, match="^snapshot: a Scene, not a Snapshot"):
        scene.restore(scene)


def advanced(scene):
    scene.advance(2e-3, 40)
    return scene.position().tobytes() + scene.velocity().tobytes(), scene.save(), scene.time


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda it: pickle.loads(pickle.dumps(it))])
@FLOATS
def test_a_copy_goes_on_alike(copied, dtype):
    for scene in saved_scenes(dtype):
        state, twin = scene.save(), copied(scene)
        assert twin.save() == state == scene.save() and type(twin) is Scene and twin.dtype == dtype
        want = advanced(scene)
        assert advanced(twin) == want
        scene.load(memoryview(state))  # at any time, also again
        assert advanced(scene) == want


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda it: pickle.loads(pickle.dumps(it))])
def test_copies_of_subclasses(copied):
    for thing in (OwnScene(), OwnSpring(), OwnBatch(), OwnClock()):
        twin = copied(thing)
        assert type(twin) is type(thing) and vars(twin) == {"tag": [1]} and (twin.tag is thing.tag) == (copied is copy.copy)


class OwnScene(Scene):
    def __init__(self):
        super().__init__([[0, 0, 0]])
        self.tag = [1]


class OwnSpring(springstep.Spring):
    def __init__(self):
        super().__init__(2.0, x=1.0)
        self.tag = [1]


class OwnBatch(springstep.Batch):
    def __init__(self):
        super().__init__(np.ones(3), np.ones(3), 4.0)
        self.tag = [1]


class OwnClock(springstep.Clock):
    def __init__(self):
        super().__init__(0.1)
        self.tag = [1]


def test_a_copy_knows_its_pins():
    torn = next(saved_scenes(np.float64))
    twin = copy.copy(torn)
    twin.drive(40, [0, 0, 0], 1.0)
    with pytest.raises(InvalidError, match="not pinned"):
        twin.drive(41, [0, 0, 0], 1.0)
    torn.set_pinned([True] * 81)
    copy.copy(torn).drive(41, [0, 0, 0], 1.0)


def test_scenes_go_on_in_other_processes():
    scenes = list(saved_scenes(np.float64))
    with ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as pool:
        assert list(pool.map(advanced, scenes)) == [advanced(scene) for scene in scenes]


def test_states_that_do_not_fit_are_refused():
    scene = cloth(5)
    scene.advance(1e-3, 10)
    state = scene.save()
    for other, named in ((cloth(5, dtype=np.float32), "bytes of a number 8, not 4"), (cloth(6), "particles 25, not 36"),
                         (cloth(5, editable=True), "flags 0, not 1"), (cloth(5, held_forces=True), "flags 0, not 16"),
                         (cloth(5, force=swing), "force 0, not 1"), (cloth(5, colliders=1), "colliders 0, not 1"),
                         (cloth(5, methods=["rk4"]), "methods ")):
        before = other.save()
        with pytest.raises(InvalidError, match=f"^state = .*the state of a scene with another definition: {named}"):
            other.load(state)
        assert other.save() == before
    for wrong in (b"", state[:-1], state + b"\0", state[:200] + bytes([state[200] ^ 1]) + state[201:]):
        with pytest.raises(InvalidError, match="damaged, truncated"):
            scene.load(wrong)
    with pytest.raises(TypeError):
        scene.load("text")


def test_scenes_that_meet_go_on_alike():
    one, other = rope(), rope()
    other.advance(3e-3, 77)
    one.set_time(5.0)
    other.set_time(5.0)
    for scene in (one, other):
        scene.set_position(np.arange(18.0).reshape(6, 3))
        scene.set_velocity(np.zeros((6, 3)))
    assert one.time == other.time == 5 and advanced(one) == advanced(other)
    with pytest.raises(InvalidError, match="^t = nan"):
        one.set_time(np.nan)


def test_state_goes_in_and_out():
    scene = rope()
    assert (len(scene), scene.axes, scene.links, scene.dtype) == (6, 3, 5, np.float64)
    scene.set_position([[1, 2, 3], [4, 5, 6.5]], first=2)
    scene.set_velocity([[0.5, 0, 0]], first=5)
    assert scene.position(2, 2).tolist() == [[1, 2, 3], [4, 5, 6.5]] and scene.velocity()[5].tolist() == [0.5, 0, 0]
    vertices = np.full((6, 5), -1, np.float32)  # positions, and what else a vertex has
    assert scene.position(out=vertices[:, :3]).base is vertices
    assert (vertices[:, :3] == scene.position().astype(np.float32)).all() and (vertices[:, 3:] == -1).all()
    energy = scene.energy()
    assert energy.kinetic == pytest.approx(0.13 * 0.5**2 / 2, rel=1e-15)
    for out in (np.empty((6, 2)), np.empty((6, 3), int), np.empty((3, 6)).T, np.empty(18), np.empty((6, 3), ">f8")):
        with pytest.raises(TypeError, match="^out: "):
            scene.position(out=out)
    for first, count in ((5, 2), (-1, 1), (7, None)):
        with pytest.raises(springstep.RangeError):
            scene.position(first, count)


def test_changes():
    scene = rope(editable=True, drag=0.3)
    assert scene.find_link(3, 2) == 2 and scene.find_link(0, 5) is None
    scene.set_link(2, stiffness=0, damping=0)
    assert scene.link(2) == (2, 3, 0.3, 0, 0)
    scene.set_mass([0.2, 0.3], first=4)
    scene.set_gravity([0, 0, -1])
    scene.advance(1e-3, 4000)
    # What is cut off falls, at no less than 0.3 m/s in the end (m g/d is 0.43 m/s and more); two links of 0.3 m, longer by
    # some (0.26 kg) g/k = 0.0015 m, hold the others.
    assert (scene.position()[3:, 2] < -0.9).all() and (scene.position()[:3, 2] > -0.61).all()
    scene.set_pinned([True] * 6)
    assert scene.at_rest(0, 0)


def test_one_axis_is_one_number_a_particle():
    scene = Scene([0.0, 1.0], [(0, 1, 0.7, 2.7, 0.1)], velocity=[0.0, 0.2], mass=[1.3, 1.7], pinned=[True, False])
    scene.set_position([1.1], first=1)
    assert scene.position().tolist() == [[0], [1.1]] and scene.tension(0) == pytest.approx(2.7 * 0.4 + 0.1 * 0.2, rel=1e-14)


LINKS = [(0, 1, 0.3, 2.7, 0.0), (1, 2, 0.3, 2.7, 0.1)]


@pytest.mark.parametrize("change, kind, field, index", [
    ({"mass": 0}, springstep.InvalidError, "mass", None),
    ({"mass": [1.3, -1.3, 1]}, springstep.InvalidError, "mass", 1),
    ({"position": [[0, 0], [1, math.nan], [2, 0]]}, springstep.InvalidError, "position", 1),
    ({"velocity": [[0, 0], [0, 0], [math.inf, 0]]}, springstep.InvalidError, "velocity", 2),
    ({"gravity": [0, math.nan]}, springstep.InvalidError, "gravity", None),
    ({"drag": -0.1}, springstep.InvalidError, "drag", None),
    ({"links": [LINKS[0], (1, 3, 0.3, 2.7, 0)]}, springstep.RangeError, "link.b", 1),
    ({"links": [LINKS[0], (1, 1, 0.3, 2.7, 0)]}, springstep.InvalidError, "link.b", 1),
    ({"links": [LINKS[0], (1, 2, 0.3, -2.7, 0)]}, springstep.InvalidError, "link.stiffness", 1),
    ({"methods": ["verlet"]}, springstep.InvalidError, "method", None),
    ({"methods": "rk4"}, springstep.InvalidError, "methods", None),
    ({"methods": ["exact"]}, springstep.UnsupportedError, "methods", None),
    ({"methods": ["rkn8"]}, springstep.UnsupportedError, "methods", None),
])
def test_what_is_wrong_is_named(change, kind, field, index):
    whole = {"position": [[0, 0], [1, 0], [2, 0]], "links": LINKS}
    Scene(**whole)
    with pytest.raises(kind) as caught:
        Scene(**{**whole, **change})
    error = caught.value
    assert (error.field, error.index) == (field, index) and str(error).startswith(field) and error.value is not None


def structured(names, links=LINKS):
    """Links as a structured array, its fields in this order; of fields that a link does not have numbers of their own."""
    array = np.full(len(links), 9, [(name, np.float32 if name in "ab" else np.float64) for name in names])
    for name, values in zip(springstep.LINK.names, zip(*links)):
        if name in names:
            array[name] = values
    return array


ENDS = [link[:2] for link in LINKS]
VALUES = dict(zip(["rest", "stiffness", "damping"], zip(*[link[2:] for link in LINKS])))


@pytest.mark.parametrize("links, values", [
    (LINKS, {}), (np.array(LINKS), {}), (iter(LINKS), {}), (np.array(LINKS, object), {}),
    (ENDS, VALUES), (np.array(ENDS), {**VALUES, "rest": 0.3, "stiffness": 2.7}), (np.array(ENDS, float), VALUES),
    (structured(["damping", "stiffness", "b", "rest", "a"]), {}), (list(structured(["damping", "stiffness", "b", "rest", "a"])), {}),
    (np.rec.array(structured(["damping", "stiffness", "b", "rest", "a"])), {}),
    (np.array([(ends, *rest) for ends, rest in zip(ENDS, zip(*VALUES.values()))],
              [("ends", int, 2), ("rest", float), ("stiffness", float), ("damping", float)]), {}),
    (structured(["b", "a"]), VALUES), (structured(["a", "b", "stiffness", "rest"]), {"damping": VALUES["damping"]}),
])
def test_every_form_of_links_is_the_same_scene(links, values):
    scene = Scene([[0, 0], [1, 0], [2, 0]], links, **values)
    assert [scene.link(i) for i in range(scene.links)] == LINKS


@pytest.mark.parametrize("axes", [1, 2, 3])
def test_what_links_do_not_have_follows_from_the_positions(axes):
    position = np.cumsum(np.random.default_rng(3).uniform(0.3, 1, (5, axes)), axis=0)
    edges = [(0, 1), (1, 4), (2, 3)]
    scene = Scene(position, edges, stiffness=[10, 20, 30])
    for i, (a, b) in enumerate(edges):
        assert scene.link(i) == (a, b, pytest.approx(np.linalg.norm(position[b] - position[a]), rel=1e-15), 10 * (i + 1), 0)
    assert scene.at_rest(0, 1e-12)
    assert Scene(position, []).links == Scene(position, np.empty((0, 2)), stiffness=3).links == Scene(position, (), rest=[]).links == 0


@pytest.mark.parametrize("links, values, kind, named", [
    ([(0, 1.5)], {"stiffness": 1}, springstep.InvalidError, r"link.b\[0\] = 1.5: not an integer"),
    ([(0, 1, 0.3, 2.7, 0), (0.25, 1, 0.3, 2.7, 0)], {}, springstep.InvalidError, r"link.a\[1\] = 0.25: not an integer"),
    ([(0, math.nan)], {"stiffness": 1}, springstep.InvalidError, r"link.b\[0\] = nan: not an integer"),
    ([(0, 1), (-1, 2)], {"stiffness": 1}, springstep.RangeError, r"link.a\[1\] = -1"),
    ([(0, 2**32)], {"stiffness": 1}, springstep.RangeError, r"link.b\[0\] = 4294967296"),
    ([(0, 3)], {"stiffness": 1}, springstep.RangeError, r"link.b\[0\] = 3"),
    ([(0, 2**70)], {"stiffness": 1}, springstep.RangeError, r"link.b\[0\] = 1.18"),
    ([(0, 10**400)], {"stiffness": 1}, ValueError, "links: an array of object"),
    ([(0, None)], {"stiffness": 1}, springstep.InvalidError, r"link.b\[0\] = nan: not an integer"),
    ([(0, Fraction(1, 2))], {"stiffness": 1}, springstep.InvalidError, r"link.b\[0\] = 0.5: not an integer"),
    (np.array([(0, "b")], object), {"stiffness": 1}, ValueError, "links: an array of <U21"),
    (structured(["a", "b", "rest"], [(0, 1, 0.3)]), {"stiffness": 1, "rest": 1}, TypeError, "rest: the links have it, too"),
    (LINKS, {"damping": 0.1}, TypeError, "damping: the links have it, too"),
    (ENDS, {}, TypeError, "stiffness: missing"),
    (ENDS, {"stiffness": [1, 2, 3]}, ValueError, r"stiffness: its shape is \(3,\), not \(\) or \(2,\)"),
    (ENDS, {"stiffness": -1}, springstep.InvalidError, r"link.stiffness\[0\] = -1"),
    ([(0, 1), (1, 2, 0.3, 2.7, 0)], {}, ValueError, "links: rows of different lengths"),
    (np.zeros((2, 3)), {}, ValueError, r"links: an array of float64 and shape \(2, 3\)"),
    (np.array([0., 1, 1, 10, 0]), {}, ValueError, r"links: an array of float64 and shape \(5,\)"),
    (np.array([True, False]), {}, ValueError, "links: an array of bool"),
    ([("0", "1")], {"stiffness": 1}, ValueError, "links: an array of <U1"),
    (structured(["a", "rest", "stiffness", "damping"]), {}, ValueError, r"links: missing fields \['b'\], unknown fields \[\]"),
    (np.zeros(2, [("ends", int, 3)]), {}, ValueError, r"links: missing fields \['a', 'b'\]"),
    (structured(["a", "b", "k"]), {}, ValueError, r"links: missing fields \[\], unknown fields \['k'\]"),
    (structured(["a", "b", "k"], []), {}, ValueError, r"links: missing fields \[\], unknown fields \['k'\]"),
])
def test_wrong_links_are_named(links, values, kind, named):
    with pytest.raises(kind, match=f"^{named}"):
        Scene([[0, 0], [1, 0], [2, 0]], links, **values)


def test_links_on_one_axis_are_at_rest_in_either_direction():
    scene = Scene([2.0, 0.5, 1.0], [(0, 1), (1, 2), (0, 2)], stiffness=[1, 2, 3])
    assert [scene.link(i)[:4] for i in range(3)] == [(1, 0, 1.5, 1), (1, 2, 0.5, 2), (2, 0, 1, 3)] and scene.at_rest(0, 0)


def test_a_scene_from_a_grid():
    g = grid([4, 3], 0.1, 50.0, pinned=["first_y"])
    scene, other = Scene.from_grid(g, mass=0.2), Scene(g.position, g.links, pinned=g.pinned, mass=0.2)
    free, moved = Scene.from_grid(g, pinned=None, dtype=np.float32), Scene.from_grid(g, position=g.position + 1)
    for each in (scene, other):
        each.set_gravity([0, -9.81, 0])
        each.advance(1e-3, 50)
    free.set_gravity([0, -9.81, 0])
    free.advance(1e-3, 50)
    assert fnv(scene) == fnv(other) and (scene.position()[:4] == g.position[:4]).all()
    assert (free.position()[:4, 1] < g.position[:4, 1]).all() and free.dtype == np.float32
    assert (moved.position() == g.position + 1).all()
    for wrong in (lambda: Scene(*g), lambda: Scene(g)):
        with pytest.raises(TypeError, match="for a grid use Scene.from_grid"):
            wrong()


# --- recording


@FLOATS
@pytest.mark.parametrize("steps, every", [(20, 1), (20, None), (20, 7), (20, 5), (20, 20), (20, 30), (0, 1)])
def test_a_run_records_what_calls_of_advance_do(steps, every, dtype):
    scene, other, told = cloth(n=5, dtype=dtype), cloth(n=5, dtype=dtype), []
    times, positions, velocities = scene.run(1e-3, steps, every, "leapfrog", velocities=True,
                                             progress=lambda *step: told.append((*step, scene.time)))
    ends = [*range(0, steps, every or 1), steps]
    for i, end in enumerate(ends):
        if i > 0:
            other.advance(1e-3, end - ends[i - 1])
        assert times[i] == other.time == pytest.approx(end * 1e-3)
        assert (positions[i] == other.position()).all() and (velocities[i] == other.velocity()).all()
    assert len(times) == len(positions) == len(velocities) == len(ends) and positions.dtype == velocities.dtype == dtype
    assert fnv(scene) == fnv(other) and told == [(end, steps, time) for end, time in zip(ends[1:], times[1:])]
    assert len(scene.run(1e-3, steps, every)) == 2
    for one, other in zip(cloth(n=5, dtype=dtype).run(1e-3, steps, every, velocities=True), (times, positions, velocities)):
        assert (one == other).all()


@pytest.mark.parametrize("method", ["leapfrog", "rkn8"])
def test_a_force_that_raises_ends_a_run(method):
    def late(t, position, velocity, force):
        if t > 0.015:
            raise ZeroDivisionError

    scene = Scene.from_grid(grid([6], 0.3, 170.0, pinned=["first_x"]), gravity=[0, -9.81, 0.4], force=late,
                            force_ignores_velocity=True, methods=["leapfrog", "rkn8"])
    before = fnv(scene)
    with pytest.raises(ZeroDivisionError):
        scene.run(1e-3, 100, method=method)
    assert fnv(scene) == before and scene.time == 0
    scene.run(1e-3, 10, method=method)
    assert fnv(scene) != before


def test_a_run_that_fails_changes_nothing_and_has_its_frames():
    scene = rope(max_speed=20.0)
    before, step = fnv(scene), 3 * scene.stable_step()
    with pytest.raises(springstep.UnstableError, match="dt .* stable step of leapfrog") as caught:
        scene.run(step, 1000)
    times, positions = caught.value.recorded
    assert (fnv(scene), scene.time) == (before, 0) and (caught.value.dt, caught.value.stable_step) == (step, step / 3)
    assert 1 < len(times) == len(positions) < 1000
    scene.advance(step, len(times) - 1)
    assert scene.time == times[-1] and (scene.position() == positions[-1]).all()

    def stop(done, steps):
        if done == 3:
            raise KeyboardInterrupt

    before = fnv(scene)
    with pytest.raises(KeyboardInterrupt):
        scene.run(1e-4, 10, progress=stop)
    assert fnv(scene) == before
    for field, arguments in (("every", (1e-3, 10, 0)), ("every", (1e-3, 10, -1)), ("steps", (1e-3, -10)), ("dt", (math.nan, 10)),
                             ("method", (1e-3, 10, 1, "verlet"))):
        with pytest.raises(springstep.InvalidError) as caught:
            scene.run(*arguments)
        assert caught.value.field == field and fnv(scene) == before


@pytest.mark.parametrize("change", [{"position": np.zeros((3, 4))}, {"mass": [1, 2]}, {"pinned": [True]},
                                    {"gravity": [0, 0, 1]}, {"velocity": [1, 2, 3]}])
def test_a_shape_that_is_wrong_is_named(change):
    with pytest.raises(ValueError, match=f"^{[*change][0]}: its shape"):
        Scene(**{"position": [[0, 0], [1, 0], [2, 0]], "links": LINKS, **change})


@pytest.mark.parametrize("call, kind, field", [
    (lambda s: s.advance(math.nan), springstep.InvalidError, "dt"),
    (lambda s: s.advance(1e-3, -1), springstep.InvalidError, "steps"),
    (lambda s: s.advance(1e-3, 1, "rk4"), springstep.UnsupportedError, "method"),
    (lambda s: s.advance(1e-3, 1, "exact"), springstep.UnsupportedError, "method"),
    (lambda s: s.stable_step("exact"), springstep.UnsupportedError, "method"),
    (lambda s: s.advance(10.0, 1000), springstep.NonFiniteError, "dt"),
    (lambda s: s.set_link(0, stiffness=1), springstep.UnsupportedError, "link"),
    (lambda s: s.set_link(5, stiffness=1), springstep.RangeError, "link"),
    (lambda s: s.set_pinned([True]), springstep.UnsupportedError, "pinned"),
    (lambda s: s.set_mass([1.0]), springstep.UnsupportedError, "mass"),
    (lambda s: s.set_position([[0, math.nan, 0]], 3), springstep.InvalidError, "position"),
    (lambda s: s.set_gravity([0, math.nan, 0]), springstep.InvalidError, "gravity"),
    (lambda s: s.drive(1, [0, 0, 0], 1), springstep.InvalidError, "particle"),
    (lambda s: s.drive(0, [0, 0, 0], 0), springstep.InvalidError, "duration"),
    (lambda s: s.drive(0, [0, math.inf, 0], 1), springstep.InvalidError, "target"),
    (lambda s: s.drive(6, None), springstep.RangeError, "particle"),
    (lambda s: s.drive(6, [0, 0, 0], 0), springstep.RangeError, "particle"),
    (lambda s: s.drive(1, [0, 0, 0], 0), springstep.InvalidError, "particle"),
    (lambda s: s.drive(0, [0, 1e300, 0], 1e-300), springstep.InvalidError, "duration"),
    (lambda s: s.drive(0, [0, 1, 0], math.nan), springstep.InvalidError, "duration"),
    (lambda s: s.tension(5), springstep.RangeError, "link"),
    (lambda s: s.tension(2**70), springstep.RangeError, "link"),
    (lambda s: s.link(2**70), springstep.RangeError, "link"),
    (lambda s: s.find_link(0, 2**40), springstep.RangeError, "b"),
    (lambda s: s.position(0, 10**13), springstep.RangeError, "first, count"),
    (lambda s: s.position(0, -1), springstep.RangeError, "first, count"),
    (lambda s: s.position(2**70), springstep.RangeError, "first"),
    (lambda s: s.touching(0, 10**13), springstep.RangeError, "first, count"),
    (lambda s: s.impulses(2**33), springstep.RangeError, "first, count"),
    (lambda s: s.set_position([[0, 0, 0]], 2**70), springstep.RangeError, "first"),
    (lambda s: s.at_rest(math.nan, 1), springstep.InvalidError, "v_tol"),
    (lambda s: s.at_rest(1, -1), springstep.InvalidError, "a_tol"),
    (lambda s: rope(particle_radius=[0, 0, -1, 0, 0, 0]), springstep.InvalidError, "particle_radius"),
    (lambda s: rope(particle_friction=[0, 0, math.nan, 0, 0, 0]), springstep.InvalidError, "particle_friction"),
    (lambda s: rope(dtype=np.float32, gravity=[0, 1e39, 0]), springstep.InvalidError, "gravity"),
    (lambda s: rope(dtype=np.float32).set_gravity([0, 1e39, 0]), springstep.InvalidError, "gravity"),
])
def test_what_a_scene_refuses(call, kind, field):
    scene = rope()
    with pytest.raises(kind) as caught:
        call(scene)
    assert caught.value.field == field
    assert (scene.position() == rope().position()).all() and (scene.velocity() == 0).all()


@pytest.mark.parametrize("change, field", [
    ({"spacing": 0}, "spacing"), ({"stiffness": -1}, "stiffness"), ({"damping": math.nan}, "damping"),
    ({"count": [0x10000, 0x10000]}, "count"), ({"families": ["bent"]}, "families"), ({"pinned": ["top"]}, "pinned"),
    ({"count": []}, "count"), ({"count": [-1]}, "count"), ({"count": [2**32]}, "count"), ({"axes": 0}, "axes"),
    ({"axes": 7}, "axes"), ({"axes": 1}, "axes"), ({"spacing": 1e308}, "spacing"), ({"families": "shear"}, "families"),
    ({"pinned": "first_x"}, "pinned"), ({"count": [1, 2, 3, 4]}, "count"),
])
def test_a_wrong_grid(change, field):
    with pytest.raises(springstep.SpringError) as caught:
        grid(**{"count": [3, 2], "spacing": 0.3, "stiffness": 2.7, **change})
    assert caught.value.field == field


def pull(t, position, velocity, force):
    force[1] += 2


INTERRUPTED = {
    "set_force": lambda s, before, state: s.set_force(lambda *_: None),
    "set_colliders": lambda s, before, state: s.set_colliders([springstep.custom(gap_in_cffi(), 1, gap_data=np.array([-9.0]))]),
    "set_pinned": lambda s, before, state: s.set_pinned([False, False]),
    "restore": lambda s, before, state: s.restore(before),
    "load": lambda s, before, state: s.load(state),
}


def interrupt(scene):
    raise KeyboardInterrupt


def call_again(scene):
    scene.set_force(lambda *_: None)
    scene.set_colliders([springstep.sphere([0, 0, -9], 1.0)])


@pytest.mark.parametrize("handler", [interrupt, call_again])
@pytest.mark.parametrize("name", INTERRUPTED)
def test_a_signal_at_any_line_of_a_change_leaves_c_and_python_alike(name, handler):
    """A signal handler runs at any line of the package. C must not keep a force or a body that Python has freed."""
    package = Path(springstep.__file__).parent
    other = rope(force=pull, editable=True, colliders=1)
    other.set_pinned([False, True, True])
    line, lines = 0, math.inf
    while lines >= line:
        line, lines = line + 1, 0
        scene = rope(force=lambda *_: None, editable=True, colliders=1)
        before = scene.snapshot()
        scene.set_force(pull)
        scene.set_pinned([True] * 4)

        def trace(frame, event, argument):
            nonlocal lines
            lines += event == "line"
            if lines == line and event == "line":
                handler(scene)
            return trace

        old = sys.gettrace()
        sys.settrace(lambda frame, *_: trace if Path(frame.f_code.co_filename).parent == package else None)
        try:
            INTERRUPTED[name](scene, before, other.save())
        except KeyboardInterrupt:
            pass
        finally:
            sys.settrace(old)
        twin = copy.copy(scene)
        assert int(ffi.cast("intptr_t", scene._called.user)) in scene._memory.view(np.uintp)
        assert all(collider.gap is not None for collider in scene.get_colliders() if collider.shape == "custom")
        for each in (scene, twin):
            assert (each._pinned == _pins_in(scene.save(), False)).all()
            each.advance(1e-3, 2)
        assert twin.save() == scene.save()
    assert line > 10


def test_many_steps_are_the_bits_of_single_steps():
    """So a long call may be cut in parts, between which Ctrl-C is noticed."""
    whole, parts = cloth(), cloth()
    whole.advance(4e-4, 10)
    for _ in range(10):
        parts.advance(4e-4)
    assert fnv(whole) == fnv(parts) and whole.time == parts.time


def test_without_undo_the_state_is_lost():
    scene = rope(undo=False)
    with pytest.raises(springstep.NonFiniteError):
        scene.advance(10.0, 1000)
    assert np.isnan(scene.position()).all() and scene.nbytes < rope().nbytes


CALLS = [
    lambda s: s.advance(1e-3), lambda s: s.at_rest(1, 1), lambda s: s.time, lambda s: s.energy(), lambda s: s.stable_step(),
    lambda s: s.position(), lambda s: s.velocity(), lambda s: s.set_position([[0, 0, 0]]),
    lambda s: s.set_velocity([[0, 0, 0]]), lambda s: s.snapshot(), lambda s: s.set_gravity([0, 0, 0]),
    lambda s: s.set_force(None), lambda s: s.link(0),
    lambda s: s.set_link(0, rest=1), lambda s: s.find_link(0, 1), lambda s: s.set_pinned([True]), lambda s: s.set_mass([1.0]),
    lambda s: s.drive(0, None), lambda s: s.tension(0),
]


def test_calls_of_other_threads_are_refused_during_an_advance():
    inside, leave = threading.Event(), threading.Event()

    def wait(*_):
        inside.set()
        leave.wait(60)

    scene, seen = rope(editable=True, force=wait), []
    before = scene.snapshot()
    thread = threading.Thread(target=scene.advance, args=(1e-3,))
    thread.start()
    assert inside.wait(60)
    for call in (*CALLS, lambda s: s.restore(before)):
        with pytest.raises(RuntimeError, match="being advanced"):
            seen.append(call(scene))
    leave.set()
    thread.join()
    assert not seen and scene.time == 1e-3


def test_an_advance_waits_for_calls_of_other_threads():
    guard, inside, leave, order = Guard("busy"), threading.Event(), threading.Event(), []

    def short():
        inside.set()
        leave.wait(60)
        order.append("short")

    first = threading.Thread(target=guard.short, args=(short,))
    first.start()
    assert inside.wait(60)
    second = threading.Thread(target=guard.long, args=(order.append, "long"))
    second.start()
    second.join(0.1)  # without a guard it would end now
    leave.set()
    first.join()
    second.join()
    assert order == ["short", "long"]


def in_threads(*functions):
    """Call them at the same time; one alone: four times."""
    threads = [threading.Thread(target=function) for function in (functions if len(functions) > 1 else functions * 4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def test_questions_of_several_threads_are_all_answered():
    scene, answers = cloth(), []
    in_threads(lambda: answers.extend(scene.energy() for _ in range(200)))
    assert len(answers) == 800 and len(set(answers)) == 1


def test_scenes_in_threads():
    scenes = [cloth() for _ in range(4)]
    in_threads(*(lambda scene=scene: scene.advance(4e-4, 200) for scene in scenes))
    assert len({fnv(scene) for scene in scenes}) == 1 and scenes[0].time == 200 * 4e-4


# --- slack links, tearing, held forces, transform


def test_tension_only_links_do_not_push():
    scene = Scene([[0, 0], [0.5, 0], [2, 0]], [(0, 1, 1, 30, 0), (1, 2, 1, 30, 0)], tension_only=True)
    assert [scene.tension(0), scene.tension(1)] == [0, 15]


@FLOATS
def test_held_forces_go_in_and_out(dtype):
    scene = rope(dtype=dtype, held_forces=True)
    assert not scene.held_force().any()
    scene.set_held_force(np.tile([0, -9.81, 0.4], (6, 1)))
    assert scene.held_force(2, 1).tolist() == [[0, dtype(-9.81), dtype(0.4)]]
    out = np.empty((6, 5), np.float32)
    assert scene.held_force(out=out[:, :3])[3, 2] == np.float32(0.4)


@pytest.mark.parametrize("options, call, kind, named", [
    ({}, lambda s: s.held_force(), springstep.SpringError, "held_forces"),
    ({}, lambda s: s.set_held_force(np.zeros((6, 3))), springstep.SpringError, "held_forces"),
    ({"held_forces": True}, lambda s: s.set_held_force([[0, 0, np.nan]], first=2), springstep.InvalidError, "held_force"),
    ({}, lambda s: s.tear(1.5), springstep.SpringError, "editable"),
    ({"editable": True}, lambda s: s.tear(-1), springstep.InvalidError, "stretch"),
    ({"editable": True}, lambda s: s.tear([1, 1, 1, np.nan, 1]), springstep.InvalidError, r"stretch\[3\]"),
    ({"editable": True}, lambda s: s.tear([1, 1]), ValueError, "stretch"),
    ({}, lambda s: springstep.components(2, [(0, 1, 1, 1, 0), (0, 2, 1, 1, 0)]), springstep.InvalidError, r"links\[1\] = \(0, 2"),
    ({"editable": True}, lambda s: s.set_mass(1.0), ValueError, r"mass: its shape is \(\)"),
    ({"editable": True}, lambda s: s.set_pinned(True), ValueError, r"pinned: its shape is \(\)"),
    ({}, lambda s: s.touching(), springstep.UnsupportedError, "colliders"),
    ({}, lambda s: s.set_colliders([]), springstep.UnsupportedError, "colliders"),
    ({"colliders": 1}, lambda s: s.touching(3, 4), springstep.RangeError, "first"),
    ({"colliders": 1}, lambda s: s.set_colliders([(0, 0, 1)]), TypeError, r"colliders\[0\]"),
    ({"colliders": 1}, lambda s: s.set_colliders([springstep.sphere([0, 0, 0], 1)] * 2), springstep.RangeError, "colliders"),
    ({"colliders": 1, "dtype": np.float32}, lambda s: s.set_colliders([springstep.sphere([0, 0, 1e39], 1)]),
     springstep.InvalidError, r"colliders.at\[0\]"),
    ({}, lambda s: springstep.plane([0, 0, 0], [0, 0, 0]), springstep.InvalidError, "normal"),
    ({"pinned": [True] * 6}, lambda s: (s.set_position([[-1e308, 0, 0]]), s.drive(0, [1e308, 0, 0], 1)),
     springstep.InvalidError, "^target"),
    ({}, lambda s: s.position(0, None, out=[1]), TypeError, "^out: "),
    ({}, lambda s: s.position(0, 2, out=[1]), TypeError, "^out: "),
    ({}, lambda s: rope(colliders=33), springstep.SpringError, "colliders"),
    ({}, lambda s: rope(colliders=-1), springstep.RangeError, "colliders"),
    ({}, lambda s: rope(colliders=1, particle_radius=-1), springstep.InvalidError, "particle_radius"),
    ({}, lambda s: rope(colliders=1, methods=["rkn8"]), springstep.UnsupportedError, "rkn8"),
    ({"colliders": 1}, lambda s: (s.set_colliders([springstep.sphere([0, 0, 0], 1)]), s.advance(1e-3, method="euler")),
     springstep.UnsupportedError, "euler"),
    ({}, lambda s: rope(max_speed=-1.0), springstep.InvalidError, "max_speed"),
    ({}, lambda s: Scene([0, 1], [(0, 1, 1, 30, 0)], tension_only=True), springstep.UnsupportedError, "tension_only"),
    ({}, lambda s: rope(tension_only=True, methods=["rkn8"]), springstep.UnsupportedError, "methods"),
])
def test_what_is_refused_is_named(options, call, kind, named):
    scene = rope(**options)
    with pytest.raises(kind, match=named):
        call(scene)


def test_normals_of_planes():
    random = np.random.default_rng(3)
    for normal in [*random.normal(size=(200, 3)), [3e-200, 4e-200, 0], [3e200, 0, 4e200]]:
        unit = springstep.plane([0, 0, 0], normal).axis[0]
        x, y, z = scaled = [component / max(map(abs, normal)) for component in normal]
        assert np.allclose(unit, np.divide(scaled, np.sqrt(x * x + y * y + z * z)), rtol=1e-15, atol=0)
        assert springstep.plane([0, 0, 0], unit).axis[0] == unit


@FLOATS
def test_tear_and_components(dtype):
    scene = rope(editable=True, dtype=dtype)
    assert scene.tear(1.5).tolist() == []
    scene.set_position([[0.3 * 5 + 2, 0, 0]], first=5)
    assert scene.tear([np.inf] * 5).tolist() == []
    assert scene.tear(1.5).tolist() == [4]
    links = [scene.link(i) for i in range(scene.links)]
    count, piece = springstep.components(len(scene), links)
    assert (count, piece.tolist()) == (2, [0, 0, 0, 0, 0, 1])
    assert springstep.components(2, [])[1].tolist() == [0, 1]


def test_set_links():
    scene, one = rope(editable=True), rope(editable=True)
    links = [(a, b, 0.9 * rest, stiffness, damping) for a, b, rest, stiffness, damping in map(scene.link, range(1, 4))]
    scene.set_links(links, first=1)
    for i, link in enumerate(links):
        one.set_link(1 + i, rest=link[2])
    for each in (scene, one):
        each.advance(1e-3, 50)
    assert fnv(scene) == fnv(one)
    before = fnv(scene), scene.link(1)
    with pytest.raises(springstep.InvalidError, match=r"link.rest\[3\]"):
        scene.set_links([(*links[0][:2], 0.1, 1, 0), links[1], (*links[2][:2], -1, 1, 0)], first=1)
    with pytest.raises(springstep.InvalidError, match=r"^link\[1\] = \(1, 3, "):
        scene.set_links([(0, 1, 1, 1, 0), (1, 3, 1, 1, 0)])
    with pytest.raises(springstep.RangeError):
        scene.set_links(links, first=4)
    with pytest.raises(springstep.SpringError):
        rope().set_links(links)
    assert (fnv(scene), scene.link(1)) == before


@FLOATS
def test_the_first_bad_row_is_named(dtype):
    bend = springstep.bend_rod(np.arange(6.0), 1.0)
    scene = rope(editable=True, dtype=dtype, weighted_links=bend)
    before = scene.save()
    links = np.array([(*scene.link(i), 0) for i in range(5)], springstep.LINK)
    for set_rows, rows, bad in ((scene.set_links, links, {"stiffness": 1e300 if dtype == np.float32 else math.inf, "damping": -1}),
                                (scene.set_weighted_links, bend, {"rest": -1, "particle": [1, 2, 3, 4]})):
        for field, value in bad.items():
            wrong = rows[1:].copy()
            wrong[field][2] = value
            with pytest.raises(springstep.InvalidError) as caught:
                set_rows(wrong, first=1)
            name = "link" if rows is links else "weighted_link"
            assert (caught.value.field, caught.value.index) == (name if field == "particle" else f"{name}.{field}", 3)
    with pytest.raises(springstep.InvalidError, match=r"^mass\[3\] = 0.0: "):
        scene.set_mass([1, 2, 0, -1], first=1)
    assert scene.save() == before


def unaligned(values):
    array = np.asarray(values)
    memory = np.zeros(array.nbytes + 1, np.uint8)
    memory[1:] = np.frombuffer(array.tobytes(), np.uint8)
    return memory[1:].view(array.dtype).reshape(array.shape)


def test_arrays_that_are_not_aligned_are_copied(monkeypatch):
    """C reads no array at an odd address."""
    seen = []

    class Watched:
        def __getattr__(self, name):
            return getattr(ffi, name)

        def from_buffer(self, *arguments):
            seen.append(arguments[-1].ctypes.data % min(8, arguments[-1].itemsize))
            return ffi.from_buffer(*arguments)

    for module in ("_links", "_mesh", "_scene"):
        monkeypatch.setattr(f"springstep.{module}.ffi", Watched())
    g = grid([6], 0.3, 170.0)
    scene = Scene(unaligned(g.position), unaligned(g.links), velocity=unaligned(g.position), mass=unaligned(np.ones(6)), editable=True,
                  weighted_links=unaligned(springstep.bend_rod(g.position, 1.0)), particle_radius=unaligned(np.ones(6)))
    scene.set_position(unaligned(g.position))
    scene.set_mass(unaligned(np.ones(6)))
    scene.set_weighted_links(unaligned(springstep.bend_rod(g.position, 1.0)))
    scene.tear(unaligned(np.ones(5)))
    springstep.bend_rod(unaligned(g.position), 1.0)
    assert len(seen) > 10 and not any(seen)


def test_transform():
    flat, turned = Scene([[1, 2], [3, 4]]), rope()
    flat.transform([[1, 0, 5], [0, 2, 6]])
    assert flat.position().tolist() == [[6, 10], [8, 14]]
    turned.transform([[0, -1, 0, 3], [1, 0, 0, 0], [0, 0, 1, -2]])
    assert turned.position(2, 1).tolist() == [[3, 0.6, -2]]
    with pytest.raises(springstep.InvalidError, match="matrix"):
        flat.transform([[1, 0, np.nan], [0, 2, 6]])
    with pytest.raises(ValueError, match="matrix"):
        flat.transform(np.eye(3))


def test_a_scene_that_explodes_is_noticed_in_time():
    scene = rope(max_speed=20.0)
    step = 3 * scene.stable_step()
    before = None
    with pytest.raises(springstep.UnstableError):
        for _ in range(10_000):
            before = scene.position(), scene.time
            scene.advance(step, 1)
    assert (scene.position() == before[0]).all() and scene.time == before[1]
    assert np.abs(scene.velocity()).max() <= 20


# --- colliders


def drop(*colliders, axes=3, dtype=np.float64, velocity=None, **options):
    """A row of free particles at a height of 0.5 m, above colliders; the last axis points upwards."""
    up = axes - 1
    position = np.zeros((5, axes))
    position[:, 0] = np.arange(5) * 0.3
    position[:, up] = 0.5
    gravity = np.zeros(axes)
    gravity[up] = -9.81
    scene = Scene(position, velocity=velocity, gravity=gravity, dtype=dtype, colliders=4, mass=0.13, **options)
    scene.set_colliders(colliders)
    return scene


@pytest.mark.parametrize("axes", [2, 3])
@FLOATS
def test_shapes(axes, dtype):
    """Each particle falls on something else, but the last."""
    def at(x, z):
        return [x, z] if axes == 2 else [x, 0, z]

    half = [0.1, 0.1, 0.1][:axes]
    scene = drop(springstep.sphere(at(0.0, -0.1), 0.2, friction=0.3), springstep.box(at(0.3, 0.0), half, radius=0.05),
                 springstep.capsule(at(0.5, 0.0), at(0.7, 0.0), 0.05, friction=0.3),
                 springstep.plane(at(0, -0.25), at(0, 3.0)), axes=axes, dtype=dtype, particle_radius=0.01)
    scene.advance(1 / 240, 240)
    assert scene.touching().tolist() == [1, 2, 4, 8, 8]
    assert scene.touching(1, 2).tolist() == [2, 4] and scene.touching().dtype == np.uint32
    skin = 32 * np.finfo(dtype).eps * 0.75  # 0.75 m: the coordinates of the capsule
    wanted = np.array([0.11, 0.16, 0.06, -0.24, -0.24]) + skin
    assert abs(scene.position()[:, axes - 1] - wanted).max() <= 8 * np.finfo(dtype).eps
    assert not scene.velocity().any() and scene.at_rest(0, 1e-3)
    scene.set_colliders([])
    assert not scene.touching().any() and not scene.at_rest(0, 1e-3)


@pytest.mark.parametrize("axes", [2, 3])
def test_every_field_of_a_collider_reaches_c(axes):
    """C tests what they do. Each field has numbers of its own."""
    c = ffi.new("spring_collider *")
    given = springstep.Collider("capsule", *([10 * field + axis for axis in range(axes)] for field in (1, 2)),
                                radius=0.3, friction=0.4, restitution=0.5, mask=2**32 - 2, spin=7.0 if axes == 2 else [5, 6, 7])
    given.half, given.velocity, given.velocity_to = ([10 * field + axis for axis in range(axes)] for field in (3, 4, 5))
    given.acceleration, given.surface = ([10 * field + axis for axis in range(axes)] for field in (6, 7))
    given.spin_acceleration = 8.0 if axes == 2 else [8, 9, 10]
    given.axis = [[100 * row + column for column in range(axes)] for row in range(3)]
    given._fill(c, axes, 0)
    for field in ("at", "to", "half", "velocity", "velocity_to", "acceleration", "surface"):
        assert list(getattr(c, field)) == [*getattr(given, field), 0][:3]
    assert [list(row) for row in c.axis] == [[*row, 0][:3] for row in given.axis]
    assert list(c.spin) == ([0, 0, 7] if axes == 2 else [5, 6, 7]) and c.shape == lib.SPRING_CAPSULE
    assert list(c.spin_acceleration) == ([0, 0, 8] if axes == 2 else [8, 9, 10])
    assert (c.radius, c.friction, c.restitution, c.mask) == (0.3, 0.4, 0.5, 2**32 - 2)


@FLOATS
def test_values_of_particles(dtype):
    """Particles of their own radius on planes of their own. Friction holds two of them on a slope; masks are kept by copies."""
    radius, friction, mask = [0.01, 0.02, 0.03, 0, 0.05], [1, 0, 1, 1, 0.0], [1, 1, 2, 2**31, 0]
    scene = drop(springstep.plane([0, 0, 0], [0, 0, 1], friction=0.5, mask=1),
                 springstep.plane([0, 0, -1], [0, 0, 1], friction=0.5, mask=2**31 + 2), dtype=dtype, particle_radius=radius,
                 particle_friction=friction, particle_mask=mask)
    scene.set_gravity([0, 2, -9.81])
    scene.advance(1 / 240, 240)
    assert scene.touching().tolist() == [1, 1, 2, 2, 0]
    wanted = np.array([0.01, 0.02, -0.97, -1])
    assert abs(scene.position()[:4, 2] - wanted).max() <= 8 * np.finfo(dtype).eps and scene.position()[4, 2] < -4
    assert (scene.velocity()[:4, 1] > 0).tolist() == [False, True, False, False]
    again = pickle.loads(pickle.dumps(scene))
    for copied in (scene, again):
        copied.advance(1 / 240, 10)
    assert fnv(again) == fnv(scene)


@pytest.mark.parametrize("field, values, named", [
    ("particle_radius", [0, 0, -1, 0, 0], r"particle_radius\[2\] = -1"),
    ("particle_friction", [1, math.inf, 1, 1, 1], r"particle_friction\[1\] = inf"),
    ("particle_mask", [1, 2, 3, -1, 0], r"particle_mask\[3\] = -1"),
    ("particle_mask", [0.5, 1, 1, 1, 1], r"particle_mask\[0\] = 0.5"),
    ("particle_mask", [1], "particle_mask: its shape"),
    ("particle_radius", [1], "particle_radius: its shape"),
])
def test_bad_values_of_particles_are_named(field, values, named):
    with pytest.raises(ValueError, match=f"^{named}"):
        drop(**{field: values})


ARGUMENTS = [ctypes.c_void_p, *[ctypes.POINTER(ctypes.c_double)] * 3]


def gap_in_ctypes():
    def gap_of_ground(user, point, gap, normal):
        gap[0] = point[2] - ctypes.cast(user, ARGUMENTS[1])[0]
        normal[0], normal[1], normal[2] = 0, 0, 1
        return 1

    return ctypes.CFUNCTYPE(ctypes.c_uint32, *ARGUMENTS)(gap_of_ground)


def gap_in_numba():
    numba = pytest.importorskip("numba")

    @numba.cfunc("uint32(voidptr, CPointer(double), CPointer(double), CPointer(double))")
    def gap_of_ground(user, point, gap, normal):
        gap[0] = point[2] - numba.carray(user, 1, numba.float64)[0]
        normal[0], normal[1], normal[2] = 0, 0, 1
        return 1

    return gap_of_ground


def gap_in_cffi():
    def gap_of_ground(user, point, gap, normal):
        gap[0] = point[2] - ffi.cast("double *", user)[0]
        normal[0] = [0, 0, 1]
        return 1

    return ffi.callback("spring_gap_fn", gap_of_ground)


@FLOATS
@pytest.mark.parametrize("made", [gap_in_ctypes, gap_in_numba, gap_in_cffi])
def test_custom_bodies(made, dtype):
    """Ground as a custom body. A snapshot and a copy have its function."""
    ground = drop(springstep.plane([0, 0, 0.25], [0, 0, 1], friction=0.5), dtype=dtype, velocity=np.full((5, 3), 0.1))
    scene = drop(springstep.custom(made(), 1, gap_data=np.array([0.25]), friction=0.5), dtype=dtype, velocity=np.full((5, 3), 0.1))
    before = scene.snapshot()
    scene.set_colliders([])
    gc.collect()
    scene.restore(before)
    again = copy.copy(scene)
    for each in (ground, scene, again):
        each.advance(1 / 240, 100)
    assert abs(scene.position() - ground.position()).max() < 8 * np.finfo(dtype).eps and scene.touching().all()
    assert fnv(again) == fnv(scene)
    again.load(scene.save())
    again.set_colliders(again.get_colliders())
    assert again.get_colliders() == scene.get_colliders()
    again.set_colliders([])
    with pytest.raises(springstep.InvalidError, match="^state"):
        again.load(scene.save())


@pytest.mark.parametrize("gap, data, named", [
    (None, None, r"colliders\[0\].gap: a NoneType, not a function in C"),
    (ctypes.CFUNCTYPE(None, *ARGUMENTS)(lambda *_: None), None, r"colliders\[0\].gap: its signature is void .*, not uint32_t \("),
    (ffi.cast("uint32_t(*)(void *, double *, double *)", 1), None, r"colliders\[0\].gap: its signature is "),
    (ffi.cast("uint32_t(*)(void *, double *, double **, double *)", 1), None, r"colliders\[0\].gap: its signature is "),
    (ffi.cast("spring_gap_fn *", 0), None, r"colliders\[0\].gap: a null pointer"),
    (ffi.cast("spring_gap_fn *", 1), [0.25], r"colliders\[0\].gap_data: not a contiguous array"),
])
def test_what_is_no_surface_is_refused(gap, data, named):
    with pytest.raises(TypeError, match=f"^{named}"):
        drop(springstep.custom(gap, 1, gap_data=data))


@pytest.mark.parametrize("made", [gap_in_ctypes, gap_in_numba, gap_in_cffi])
def test_copies_of_custom_bodies(made):
    body = springstep.custom(made(), 1, gap_data=np.array([0.25]))
    scene = drop(body)
    own = copy.deepcopy(body)
    assert own == body == copy.copy(body) and own.gap is body.gap and own.gap_data is not body.gap_data
    for twin in (copy.copy(scene), copy.deepcopy(scene)):
        assert advanced(twin) == advanced(copy.copy(scene)) and twin.get_colliders()[0].gap is body.gap
    for thing in (body, scene):
        with pytest.raises(TypeError, match="^a function in C cannot be pickled"):
            pickle.dumps(thing)


def test_a_loaded_state_has_colliders_of_its_own():
    body, ball = springstep.custom(gap_in_cffi(), 1, gap_data=np.array([0.25])), springstep.sphere([0, 0, -9], 1.0)
    one, two = drop(body), drop(body, ball)
    both = two.save()
    two.load(one.save())
    one.load(both)
    assert [c.gap for c in one.get_colliders()] == [body.gap, None] and [c.gap for c in two.get_colliders()] == [body.gap]
    assert advanced(copy.copy(one)) == advanced(one)


def test_impulses_are_those_of_the_weight():
    scene = springstep.Scene([[2.0, 0.0, 0.0]], mass=[0.5], gravity=[0, 0, -10], colliders=2)
    scene.set_colliders([springstep.sphere([0, 0, 9], 1), springstep.plane([0, 0, 0], [0, 0, 1])])
    scene.advance(1 / 128, 64)
    far, floor = scene.impulses(2)
    assert not far.any() and floor == pytest.approx(np.array([[0, 0, -2.5], [0, 5, 0]])), "m g t, at 2 m from the origin"
    assert (scene.impulses(1, first=1)[0] == floor).all()
    with pytest.raises(springstep.RangeError, match=r"first, count = \(0, 3\)"):
        scene.impulses(3)
    with pytest.raises(springstep.UnsupportedError, match="colliders = 0"):
        springstep.Scene([[0.0, 0.0, 0.0]]).impulses(1)


def test_colliders_are_part_of_snapshots():
    scene = drop(springstep.plane([0, 0, 0], [0, 0, 1]))
    before = scene.snapshot()
    scene.advance(1 / 240, 200)
    landed, mask = fnv(scene), scene.touching()
    scene.restore(before)
    scene.set_colliders([])
    scene.advance(1 / 240, 200)
    assert fnv(scene) != landed
    scene.restore(before)
    scene.advance(1 / 240, 200)
    assert fnv(scene) == landed and (scene.touching() == mask).all() and mask.all()


def test_present_colliders():
    scene, other = cloth(3, colliders=2), cloth(3, colliders=2)
    assert scene.get_colliders() == []
    scene.set_colliders([springstep.box([0, 0, -9], [1, 2, 1], spin=[0, 0, 2], velocity=[0, 0, 1], mask=3),
                         springstep.sphere([0, 0, 9], 0.5, velocity=[1, 0, 0], acceleration=[0, 2, 0], friction=0.25)])
    scene.advance(1 / 1024, 512)
    found = scene.get_colliders()
    turned, ball = found
    assert (turned.shape, turned.half, turned.mask, ball.shape, ball.radius, ball.friction) == ("box", (1, 2, 1), 3, "sphere", 0.5, 0.25)
    assert turned.at == pytest.approx((0, 0, -8.5)) and turned.axis[0] == pytest.approx((math.cos(1), math.sin(1), 0))
    assert ball.at == pytest.approx((0.5, 0.25, 9)) and ball.velocity == pytest.approx((1, 1, 0))
    other.set_colliders(found)
    assert other.get_colliders() == found


def test_colliders_are_values():
    ball = springstep.sphere([0, 1, 2], 0.5, spin=[0, 0, 3], friction=0.3)
    again = pickle.loads(pickle.dumps(ball))
    assert again == ball == copy.deepcopy(ball) != springstep.sphere([0, 1, 2], 0.6, spin=[0, 0, 3], friction=0.3)
    assert springstep.capsule([0, 0, 0], [1, 0, 0], 0.1, velocity=[1, 2, 3]).velocity_to == [1, 2, 3]
    assert springstep.Collider("sphere", [0, 1, 2], radius=0.5, spin=[0, 0, 3], friction=0.3) == ball
    assert springstep.sphere(np.array([0, 1, 2]), 0.5, spin=np.array([0, 0, 3]), friction=0.3) == ball != 3
    assert springstep.sphere(np.array([0, 1, 3]), 0.5, spin=np.array([0, 0, 3]), friction=0.3) != ball
    with pytest.raises(springstep.InvalidError, match=r"^colliders.spin\[0\] = \(3, 4\): not a number"):
        drop(springstep.sphere([0, 0], 1.0, spin=(3, 4)), axes=2)


@pytest.mark.parametrize("field, value, shape, more", [
    ("at", [0, math.nan, 0], "sphere", {}),
    ("at", [0, 0], "sphere", {}),
    ("to", [math.inf, 0, 0], "capsule", {}),
    ("half", [1, -1, 1], "box", {}),
    ("radius", -1, "sphere", {}),
    ("radius", math.nan, "box", {}),
    ("velocity", [0, 0, math.inf], "plane", {}),
    ("velocity_to", [0, 0, math.inf], "capsule", {}),
    ("spin", [0, math.nan, 0], "plane", {}),
    ("spin", 1.0, "plane", {}),
    ("friction", -0.1, "plane", {}),
    ("friction", math.inf, "plane", {}),
    ("restitution", 1.5, "plane", {}),
    ("mask", -1, "plane", {}),
    ("mask", 2**32, "plane", {}),
    ("thickness", 0.0, "custom", {"gap": ffi.cast("spring_gap_fn *", 1)}),
    ("bound", -1.0, "custom", {"gap": ffi.cast("spring_gap_fn *", 1), "thickness": 1}),
    ("axis", [[1, 1, 0], [0, 1, 0], [0, 0, 1]], "plane", {}),
    ("axis", [[1, 0, 0], [1, 0, 0], [0, 0, 1]], "box", {}),
    ("shape", "cone", "cone", {}),
])
def test_bad_colliders_are_named(field, value, shape, more):
    scene = drop()
    before = scene.snapshot()
    bad = springstep.Collider(**{"shape": shape, field: value, **more})
    with pytest.raises(springstep.InvalidError, match=rf"colliders\.{field}\[1\]") as caught:
        scene.set_colliders([springstep.plane([0, 0, 0], [0, 0, 1]), bad])
    assert (caught.value.field, caught.value.index) == (f"colliders.{field}", 1) and caught.value.value is value
    scene.advance(1 / 240, 200)
    after = fnv(scene)
    scene.restore(before)
    scene.advance(1 / 240, 200)
    assert fnv(scene) == after
