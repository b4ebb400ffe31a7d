# SPDX-License-Identifier: MIT
"""The programs of docs/python.md run, and do what the page says."""
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import springstep
from scenes import FLOATS, rope, saved_scenes
from springstep import lib

PAGE = Path(__file__).parents[3] / "docs/python.md"
IN_C = {"numba": "numba", "ctypes": "ctypes", "cffi": "cffi", "SciPy": "scipy"}  # and the package that it needs


def programs(language="python"):
    """Yield (heading, program) of the page, each with the last heading or bold word before it."""
    heading = ""
    for found in re.finditer(r"^## (.+)\n|^\*\*(.+?)\*\*|^```(\w+)\n((?:.*\n)*?)```", PAGE.read_text(), re.M):
        heading = found[1] or found[2] or heading
        if found[3] == language:
            yield heading, found[4]


def run(heading):
    """The names of a program after it has run."""
    names = {}
    exec(dict(programs())[heading], names)
    return names


@pytest.mark.parametrize("heading", [heading for heading, _ in programs() if heading not in IN_C])
def test_it_runs(heading, tmp_path):
    program = dict(programs())[heading]
    if "import numba" in program:
        pytest.importorskip("numba")
    (tmp_path / "program.py").write_text(program)
    subprocess.run([sys.executable, "program.py"], cwd=tmp_path, check=True)


@pytest.mark.parametrize("heading", IN_C)
def test_forces_in_c(heading, tmp_path, monkeypatch):
    """All have the bits of the same force in Python."""
    pytest.importorskip(IN_C[heading])
    monkeypatch.chdir(tmp_path)
    (tmp_path / "wind.c").write_text(dict(programs("c"))["numba"])
    subprocess.run(dict(programs("sh"))["numba"], shell=True, check=True)
    scene = run(heading)["scene"]

    def wind(t, position, velocity, force):
        force += 0.05 * (np.array([[3.0], [0], [0]]) - velocity)

    cloth = springstep.grid([8, 8], 0.1, 400.0, families=["structural", "shear"], pinned=["first_x"])
    other = springstep.Scene.from_grid(cloth, mass=0.01, force=wind)
    other.advance(1 / 960, 480)
    assert (scene.position() == other.position()).all() and scene.time == other.time


def ends_hash(mixed, scene, directed):
    h = 0
    for i in range(scene.links):
        a, b = scene.link(i)[:2]
        low, high = (a, b) if directed or a < b else (b, a)
        h = mixed(h, low + (high << 32))
    return h


@FLOATS
def test_states_are_as_the_page_says(dtype):
    """The program of the page, which knows no more than the page, reads what `save` has written."""
    names = {}
    text = (PAGE.parent / "details.md").read_text()
    exec(re.search(r"^```python\n((?:.*\n)*?)```", text, re.M)[1], names)
    read_state = names["read_state"]
    for scene in saved_scenes(dtype):
        state = scene.save()
        read, n = read_state(state), len(scene)
        for name, values in (("position", scene.position()), ("velocity", scene.velocity())):
            assert (np.reshape(read[name], (scene.axes, n)).T == values).all()
        assert read["time"] == scene.time
        assert "weighted" in read or int.from_bytes(state[80:88], "little") == ends_hash(names["mixed"], scene, scene.axes == 1)
        if "weighted" in read:
            link = scene.weighted_link(3)
            first = int(np.argmax(np.abs(link["weight"])))
            others = [weight for weight in np.delete(link["weight"], first) if weight != 0]
            weights = [link["weight"][first], *others, *[0] * (3 - len(others))]
            assert np.allclose(read["weighted"][24:31], [*weights, link["rest"], link["stiffness"], link["damping"]])
        if "held force" in read:  # and editable, with colliders
            assert (np.reshape(read["held force"], (3, n)).T == scene.held_force()).all()
            links = [scene.link(i) for i in range(scene.links)]
            assert list(zip(read["rest"], read["stiffness"])) == [link[2:4] for link in links] and "damping" not in read
            assert 0 in read["stiffness"] and 1 / read["inverse mass"][3] == pytest.approx(0.5, rel=1e-7)
            assert [i for i in range(n) if read["pinned"][i]] == [0, 8, 40]
            shape, *numbers = read["colliders"]
            assert shape == lib.SPRING_SPHERE and numbers[:3] == [1, 1, -0.3] and numbers[18] == 0.4 and numbers[21] == 0.2
            touched = iter(read["touched"])
            assert [next(touched) if bit else 0 for bit in read["touching"]] == scene.touching().tolist() != [0] * n
        for wrong in (state[:-8], state[:300] + bytes([state[300] ^ 1]) + state[301:]):
            with pytest.raises(ValueError, match="truncated|damaged"):
                read_state(wrong)


EXAMPLES = PAGE.parents[1] / "bindings/python/examples"
DATA = PAGE.parent / "data/gallery"


def columns(file):
    header, *rows = [line.split("\t") for line in file.read_text().splitlines() if not line.startswith("#")]
    return dict(zip(header, zip(*rows)))


@pytest.mark.parametrize("name", sorted(path.stem for path in EXAMPLES.glob("*.py") if path.stem != "gallery"))
def test_examples(name, tmp_path):
    """They draw more than an empty frame, which takes a few kB, and data of the gallery are those that they write."""
    pytest.importorskip("matplotlib")
    program, picture, data = EXAMPLES / f"{name}.py", tmp_path / "picture.png", tmp_path / "data.tsv"
    if not (DATA / f"{name}.tsv").exists():
        subprocess.run([sys.executable, "-B", program, picture], check=True)
    else:
        subprocess.run([sys.executable, "-B", program, "--write", data], check=True)
        subprocess.run([sys.executable, "-B", program, "--read", DATA / f"{name}.tsv", picture], check=True)
        kept, now = columns(DATA / f"{name}.tsv"), columns(data)
        assert [*kept] == [*now]
        for values, others in zip(kept.values(), now.values()):
            if re.search("[a-z]{3}", values[0]):
                assert values == others
            else:
                old, new = np.array(values, float), np.array(others, float)
                assert new == pytest.approx(old, rel=0, abs=1e-3 * np.ptp(old))
    assert picture.stat().st_size > 20000


def test_the_gallery_has_all_its_pictures():
    page = (PAGE.parent / "gallery.md").read_text()
    names = sorted(path.stem for path in DATA.glob("*.tsv"))
    assert sorted(re.findall(r"\(pictures/gallery/(\w+)\.svg\)", page)) == names and len(names) >= 5
    assert sorted(path.stem for path in (PAGE.parent / "pictures/gallery").iterdir()) == names


def test_the_first_program():
    names = run("")
    positions = names["positions"]
    assert positions.shape == (31, 64, 3) and names["times"] == pytest.approx(np.arange(31) / 60)
    assert (positions[:, ::8] == positions[0, ::8]).all()  # pinned
    assert (positions[-1, 7::8, 0] > 0.7).all()  # the wind pulls


def test_colliders():
    assert run("Colliders")["scene"].touching().tolist() == [1]


def test_custom_bodies():
    pytest.importorskip("numba")
    (x, _, z), (_, _, far) = run("Custom bodies")["stones"].position()
    assert abs(z - 0.2 * np.sin(2 * x)) < 1e-9 and z < -0.1 and far < -9


def test_snapshots():
    names = run("Snapshots")
    assert names["scene"].time == 100 * names["dt"] and len(names["scene"]) == 625


def test_frames():
    names = run("Frames")
    assert names["drawn"][0] == pytest.approx([0, 0.5, 0], abs=1e-12)
    scene, clock = rope(max_speed=100), springstep.Clock(1 / 960, 64)
    for frame_time, x in ((1 / 60, 0.01), (1.0, 0.02), (1 / 144, 0.03)):  # one frame that is too long
        names["advance_frame"](scene, clock, frame_time, np.array([x, 0, 0]))
        assert (scene.position() + clock.pending * scene.velocity())[0] == pytest.approx([x, 0, 0], abs=1e-12)
    with pytest.raises(springstep.UnstableError):  # the hand jumps, and the scene with it
        names["advance_frame"](scene, clock, 0.01, np.array([500, 0, 0]))
    names["advance_frame"](scene, clock, 0.01, np.array([500, 0, 0]))
