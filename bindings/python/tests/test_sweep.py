# SPDX-License-Identifier: MIT
"""Sweeps: the rows of spring-sweep, by one process, and by the workers of a Dask client of which one is killed."""
import operator
import os
import signal
import subprocess
import threading
import time

import numpy as np
import pytest

import scenes
import springstep

OVER = {"omega_dt": "0.05:3:log:20", "damping_ratio": [0, 0.3, 1.7]}
WORDS = ["--over", "omega_dt=0.05:3:log:20", "--over", "damping_ratio=0,0.3,1.7"]
MORE = ["steps", "explode_time_s", "settling_time_s"]


def of_the_tool(*arguments):
    text = subprocess.run(["spring-sweep", *arguments], capture_output=True, text=True, check=True).stdout
    return [line.split("\t") for line in text.splitlines() if not line.startswith("#")]


def as_the_tool_writes(rows):
    """Columns and rows, a number with 17 digits."""
    return [list(rows.dtype.names), *([value if isinstance(value, str) else f"{value:.17g}" for value in row]
                                      for row in rows.tolist())]


def test_a_spring():
    assert as_the_tool_writes(springstep.sweep(OVER, measure=MORE)) == of_the_tool(*WORDS, "--measure", ",".join(MORE))


@pytest.mark.parametrize("scene", ["rope", "cloth", "jelly", "chain", "water"])
def test_a_scene(scene):
    rows = springstep.sweep({"stiffness": np.array([700.0, 3e3]), "duration": 0.1, "size": 5}, ("leapfrog", "rk4"),
                            scene=scene)
    assert as_the_tool_writes(rows) == of_the_tool("--scene", scene, "--over", "stiffness=700,3000", "duration=0.1",
                                                   "size=5", "--method", "leapfrog,rk4")


@pytest.mark.parametrize("values", [{1.0, 3.0}, (x for x in (1, 3)), range(1, 4, 2), ("1", "3"), np.array([1, 3])],
                         ids=lambda values: type(values).__name__)
def test_values_of_any_iterable(values):
    assert springstep.sweep({"omega_dt": values}, "exact")["omega_dt"].tolist() == [1, 3]


@pytest.mark.parametrize("arguments", [
    {"over": {"omega_dt": "0.01:3:log:300", "damping_ratio": "0:2:300", "periods": [100]}},
    {"over": {"stiffness": "500:5000:log:3000"}, "scene": "rope"}], ids=["springs", "scenes"])
def test_interrupted(arguments):
    """Ctrl-C ends what would take minutes."""
    before = signal.signal(signal.SIGALRM, signal.default_int_handler)
    signal.setitimer(signal.ITIMER_REAL, 0.5)
    start = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt):
            springstep.sweep(**arguments)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert time.monotonic() - start < 5


def test_the_plan():
    rows = springstep.sweep({"tolerance": "1e-6:0.1:log:6", "periods": [1, 50]}, measure="force_evaluations")
    assert as_the_tool_writes(rows) == of_the_tool("--over", "tolerance=1e-6:0.1:log:6", "periods=1,50", "--measure",
                                                   "force_evaluations")


@pytest.mark.parametrize("field, arguments", [
    ("over", {"over": {"omega": 1}}), ("over", {"over": {"omega_dt": -1}}), ("over", {"over": {"omega_dt": "1:2"}}),
    ("over", {"over": {"omega_dt": float("nan")}}), ("over", {"over": {"omega_dt": []}}),
    ("over", {"over": {"omega_dt": None}}), ("over", {"over": {"omega_dt": ["x"]}}),
    ("over", {"over": {"omega_dt": [[1, 2], [3, 4]]}}),
    ("points_per_task", {"over": {}, "points_per_task": 0}), ("points_per_task", {"over": {}, "points_per_task": -1}),
    ("methods", {"over": {}, "methods": "rkn8"}), ("scene", {"over": {}, "scene": "sea"}),
    ("measure", {"over": {}, "measure": "error"}),
    ("over", {"over": {"omega_dt": "1:2:9000000000", "damping_ratio": "0:1:9000000000"}}),
    *(("methods", {"over": {}, "methods": "a" * place + "é" * 3000}) for place in range(4)),  # a message that C cuts
])
def test_refused(field, arguments):
    with pytest.raises(springstep.InvalidError) as caught:
        springstep.sweep(**arguments)
    assert caught.value.field == field


@pytest.fixture(scope="module")
def client():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            yield client


OWN = {"stiffness": "200:800:log:3", "size": [3, 5], "name": ["rope", "cloth"], "duration": 3, "stable_fraction": [0.4, 4]}
OWN_MEASURES = {"lowest_m": scenes.lowest, "time_s": operator.attrgetter("time")}


def own(**options):
    return springstep.sweep(OWN, ["leapfrog", "rk4"], scene=scenes.hung, measure=OWN_MEASURES, **options)


def test_a_function_that_makes_a_scene():
    rows = own()
    assert rows.dtype.names == (*OWN, "method", "dt_s", "status", "lowest_m", "time_s") and len(rows) == 3 * 2 * 2 * 2 * 2
    assert rows["stiffness"][::16] == pytest.approx([200, 400, 800]) and rows["name"][:9:4].tolist() == ["rope", "cloth", "rope"]
    assert (rows["status"][rows["method"] == "rk4"] == "unsupported").all()
    for row in rows[rows["method"] == "leapfrog"]:
        scene = scenes.hung(row["stiffness"], row["size"], row["name"])
        assert row["dt_s"] == row["stable_fraction"] * scene.stable_step()
        assert row["status"] == ("finished" if row["stable_fraction"] < 1 else "exploded")
        if row["status"] == "finished":
            scene.advance(row["dt_s"], round(3 / row["dt_s"]))
            assert (row["lowest_m"], row["time_s"]) == (scenes.lowest(scene), scene.time)
        else:
            assert np.isnan(row["lowest_m"])
    rows = springstep.sweep({"steps_per_frame": [16, 32], "duration": [0.5]}, "leapfrog", scene=scenes.hung, measure=scenes.lowest)
    assert rows["dt_s"].tolist() == [1 / 960, 1 / 1920] and rows.dtype.names[-1] == "lowest"
    assert len(springstep.sweep({}, scene=scenes.hung, measure=scenes.lowest)) == 6
    row = springstep.sweep({"stable_fraction": [0.5]}, "euler", scene=lambda: springstep.Scene([0.0, 1.0], [(0, 1)], stiffness=3.0),
                           measure=scenes.lowest)[0]
    assert row["status"] == "no_step" and np.isnan(row["lowest"])


def test_processes():
    assert own(processes=2).tobytes() == own(processes=2, points_per_task=5).tobytes() == own().tobytes()
    assert springstep.sweep(OVER, processes=2).tobytes() == springstep.sweep(OVER).tobytes()


@pytest.mark.parametrize("kind, named, options", [
    (TypeError, "measure: ", {"measure": ()}), (TypeError, "measure: ", {"measure": "steps"}),
    (TypeError, "measure: ", {"measure": {"a": 1}}),
    (springstep.InvalidError, "method = 'verlet': not one of euler, ", {"methods": "verlet"}),
    (springstep.InvalidError, "over = 'size=1:2'", {"over": {"size": "1:2"}}),
    (springstep.InvalidError, "processes = 0", {"processes": 0}),
    (springstep.InvalidError, "duration = -1.0: not a number greater than 0", {"over": {"duration": [-1]}}),
    (springstep.InvalidError, "stable_fraction = 0.0", {"over": {"stable_fraction": [0.0]}}),
    (TypeError, ".*unexpected keyword argument 'length'", {"over": {"length": 2}}),
])
def test_what_own_scenes_refuse(kind, named, options):
    with pytest.raises(kind, match=f"^{named}"):
        springstep.sweep(**{"over": {"size": 3}, "scene": scenes.hung, "measure": scenes.lowest, **options})


def test_own_scenes_of_dask(client):
    assert own(client=client, points_per_task=3).tobytes() == own().tobytes()


def test_dask(client):
    assert as_the_tool_writes(springstep.sweep(OVER, client=client)) == of_the_tool(*WORDS)


def test_dask_with_a_worker_that_is_killed(client):
    """In the middle of its work, which another one takes over."""
    over = {"omega_dt": "0.05:3:log:200", "damping_ratio": "0:2:100"}
    workers = {worker["id"]: pid for worker, pid in zip(client.scheduler_info()["workers"].values(),
                                                        client.run(os.getpid).values())}
    killed = []

    def kill_one():
        time.sleep(0.2)
        os.kill(next(iter(workers.values())), signal.SIGKILL)
        killed.append(time.monotonic())

    thread = threading.Thread(target=kill_one)
    thread.start()
    rows = springstep.sweep(over, "leapfrog,rk4", client=client, points_per_task=50)
    finished = time.monotonic()
    thread.join()
    assert killed and killed[0] < finished, "it was killed in the middle"
    assert set(client.run(os.getpid).values()) != set(workers.values())
    assert rows.tobytes() == springstep.sweep(over, "leapfrog,rk4").tobytes()
