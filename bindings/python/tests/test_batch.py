# SPDX-License-Identifier: MIT
"""Many springs."""
import copy
import math
import pickle
import re
import threading

import numpy as np
import pytest

import springstep
from springstep import Batch, Spring, lib

OF_SPRINGS = [method.name for method in springstep.methods() if method.springs]
COUNT = 1003  # no multiple of any vector


def example(dtype=np.float64):
    numbers = np.random.default_rng(7)
    x, v, accel = (numbers.uniform(-1, 1, COUNT).astype(dtype) for _ in range(3))
    omega2, gamma = (numbers.uniform(0.3, 3, COUNT).astype(dtype) for _ in range(2))
    return Batch(x, v, omega2, gamma, accel)


@pytest.mark.parametrize("method", OF_SPRINGS)
def test_bits_are_those_of_single_springs(method):
    batch = example()
    springs = [Spring(w, 1, g, a, x=x, v=v)
               for x, v, w, g, a in zip(batch.x, batch.v, batch.omega2, batch.gamma, batch.accel)]
    batch.advance(1 / 60, 7, method)
    for spring in springs:
        spring.advance(1 / 60, 7, method)
    assert (batch.x == [spring.x for spring in springs]).all() and (batch.v == [spring.v for spring in springs]).all()


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("shared", [False, True])
def test_bits_are_those_of_c(dtype, shared):
    name, pointer = ("spring_batch", "double[]") if dtype == np.float64 else ("spring_batchf", "float[]")
    batch = example(dtype)
    x, v = batch.snapshot()
    if shared:
        batch = Batch(batch.x, batch.v, 1.7, batch.gamma)
    c = springstep.ffi.new(f"{name} *", {"count": COUNT})
    lent = {"x": x, "v": v, "omega2": np.array([1.7], dtype) if shared else batch.omega2, "gamma": batch.gamma}
    if not shared:
        lent["accel"] = batch.accel
    for field, array in lent.items():
        setattr(c, field, springstep.ffi.from_buffer(pointer, array))
    c.shared = lib.SPRING_SHARED_OMEGA2 if shared else 0
    assert getattr(lib, f"{name}_advance")(c, lib.SPRING_LEAPFROG, 1 / 60, 100) == lib.SPRING_OK
    batch.advance(1 / 60, 100)
    assert batch.dtype == dtype and (batch.x == x).all() and (batch.v == v).all()
    assert batch.stable_step() == getattr(lib, f"{name}_stable_step")(c, lib.SPRING_LEAPFROG)


def test_arrays_are_used_where_they_are():
    x, v, omega2 = np.ones(COUNT), np.zeros(COUNT), np.full(COUNT, 2.7)
    batch = Batch(x, v, omega2)
    assert batch.x is x and batch.v is v and batch.omega2 is omega2 and len(batch) == COUNT
    batch.advance(0.01)
    assert (x < 1).all() and (v < 0).all()
    before = batch.snapshot()
    omega2[:] = 0
    v[:] = 0
    batch.advance(0.01)
    assert (x == before[0]).all()  # nothing pulls any more
    with pytest.raises(ValueError, match="snapshot"):
        batch.restore((before[0] + 1, before[1][1:]))
    assert (x == before[0]).all()
    batch.restore(before)
    assert (v == before[1]).all() and batch.v is v


@pytest.mark.parametrize("field, array", [("x", [1.0, 2.0]), ("x", np.ones(2, int)), ("v", np.ones(4)[::2]),
                                          ("v", np.ones(2, np.float32)), ("omega2", [1.0, 2.0]), ("x", np.ones((2, 2))),
                                          ("x", np.ones(2, ">f8")), ("v", np.ones(())), ("v", np.ones((2, 1))),
                                          ("v", np.ones(17, np.uint8)[1:].view(float)),
                                          ("gamma", np.ones(3))])
def test_what_would_be_copied_is_refused(field, array):
    arrays = {"x": np.ones(2), "v": np.ones(2), "omega2": np.ones(2)}
    arrays[field] = array
    with pytest.raises((TypeError, ValueError), match=f"^{field if np.ndim(array) < 2 else 'v'}: |^x: "):
        Batch(**arrays)


def test_memory_that_is_shared_or_fixed_is_refused():
    x, fixed = np.ones(4), np.ones(2)
    fixed.flags.writeable = False
    for omega2 in (None, "4"):
        with pytest.raises(TypeError, match=f"^omega2: a {type(omega2).__name__}, neither"):
            Batch(x, np.zeros(len(x)), omega2)
    with pytest.raises(ValueError, match="^v: shares memory with x"):
        Batch(x[:2], x[1:3], 1.0)
    with pytest.raises(TypeError, match="^v: not writeable"):
        Batch(np.ones(2), fixed, 1.0)
    Batch(np.ones(2), np.ones(2), fixed).advance(0.01)


def test_springs_that_fail_are_named_and_all_others_advance():
    batch = example()
    batch.x[[17, 900]] = np.nan, np.inf
    batch.omega2[500] = -1.5
    before = batch.snapshot()
    with pytest.raises(springstep.InvalidError, match=r"^x\[17\] = nan: ") as caught:
        batch.advance(0.01)
    assert caught.value.failed.tolist() == [17, 500, 900] and caught.value.index == 17
    changed = np.flatnonzero(batch.v != before[1])
    assert len(changed) == COUNT - 3 and not set(changed) & {17, 500, 900}
    with pytest.raises(springstep.InvalidError) as caught:
        batch.advance(np.nan)
    assert len(caught.value.failed) == 0
    batch.x[[17, 900]] = 0
    with pytest.raises(springstep.InvalidError, match=r"^omega2\[500\] = -1.5: "):
        batch.advance(0.01)
    with pytest.raises(springstep.InvalidError, match=r"^omega2\[500\] = -1.5: "):
        batch.stable_step()
    batch.omega2[500] = 1e9
    with pytest.raises(springstep.NonFiniteError, match=r"^x\[500\]") as caught:
        batch.advance(1.0, 100)
    assert caught.value.failed.tolist() == [500] and caught.value.status == lib.SPRING_ENONFINITE
    error = pickle.loads(pickle.dumps(caught.value))
    assert (error.dt, error.stable_step) == (1.0, pytest.approx(2 / math.sqrt(1e9))) and "(dt 1.0 s, stable step" in str(error)
    batch.x[900] = np.nan
    with pytest.raises(springstep.InvalidError, match=r"^x\[900\] = nan: ") as caught:
        batch.advance(1.0, 100)
    assert caught.value.failed.tolist() == [500, 900] and caught.value.status == lib.SPRING_EINVAL


def test_following_has_the_bits_of_single_springs():
    batch = example()
    target = np.random.default_rng(8).uniform(-5, 5, COUNT)
    springs = [Spring(w, 1, g, a, x=x, v=v)
               for x, v, w, g, a in zip(batch.x, batch.v, batch.omega2, batch.gamma, batch.accel)]
    for _ in range(7):
        assert batch.follow(target, 1 / 60) == COUNT
        for spring, goal in zip(springs, target):
            spring.follow(goal, 1 / 60)
    assert (batch.x == [spring.x for spring in springs]).all() and (batch.v == [spring.v for spring in springs]).all()
    assert batch.follow(target, 0) == COUNT and batch.follow(target, 0, np.inf, np.inf) == 0


def test_moving_targets_are_followed_without_lag():
    batch = example()
    batch.accel[:] = 0
    target, speed = np.zeros(COUNT), np.random.default_rng(9).uniform(-5, 5, COUNT)
    springs = [Spring(w, 1, g, x=x, v=v) for x, v, w, g in zip(batch.x, batch.v, batch.omega2, batch.gamma)]
    for _ in range(7):
        target += speed / 64
        assert batch.follow(target, 1 / 64, target_velocity=speed) == COUNT
        for spring, goal, velocity in zip(springs, target, speed):
            spring.follow(goal, 1 / 64, velocity)
    assert (batch.x == [spring.x for spring in springs]).all() and (batch.v == [spring.v for spring in springs]).all()
    assert batch.follow(target, 1 / 64, np.inf, np.inf, target_velocity=speed) == COUNT
    assert (batch.x == target).all() and (batch.v == speed).all()
    batch.follow(3.0, 1 / 64, target_velocity=2.0)  # one number for all
    speed[40] = np.nan
    with pytest.raises(springstep.InvalidError, match=r"^target_velocity\[40\] = nan: ") as caught:
        batch.follow(target, 1 / 64, target_velocity=speed)
    assert caught.value.failed.tolist() == [40]
    with pytest.raises(ValueError, match="^target_velocity: shares memory with x"):
        batch.follow(target, 1 / 64, target_velocity=batch.x)


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_springs_land_on_their_targets(dtype):
    batch = example(dtype)
    target = np.linspace(-5, 5, COUNT, dtype=dtype)
    frames = 0
    while batch.follow(target, 1 / 60):
        frames += 1
        assert frames < 60_000
    assert (batch.x == target + batch.accel / batch.omega2).all() and (batch.v == 0).all()
    assert batch.follow(7, 1 / 60) == COUNT  # one target for all
    assert batch.follow(7, 1 / 60, np.inf, np.inf) == 0 and (batch.v == 0).all()


def test_springs_that_cannot_follow_are_named_and_all_others_advance():
    batch, target = example(), np.full(COUNT, 3.0)
    batch.x[17], batch.omega2[500], target[900] = np.nan, -1.5, np.inf
    before = batch.snapshot()
    with pytest.raises(springstep.InvalidError, match=r"^x\[17\] = nan: ") as caught:
        batch.follow(target, 0.01)
    assert caught.value.failed.tolist() == [17, 500, 900]
    changed = np.flatnonzero(batch.v != before[1])
    assert len(changed) == COUNT - 3 and not set(changed) & {17, 500, 900}
    batch.x[17], batch.omega2[500] = 0, 1
    with pytest.raises(springstep.InvalidError, match=r"^target\[900\] = inf: "):
        batch.follow(target, 0.01)
    target[900], batch.gamma[300] = 1, 1e9
    with pytest.raises(springstep.NonFiniteError, match=r"^x\[300\]") as caught:
        batch.follow(target, -0.1)
    assert caught.value.failed.tolist() == [300] and caught.value.status == lib.SPRING_ENONFINITE


@pytest.mark.parametrize("target", [[1.0] * COUNT, np.ones(COUNT, np.float32), np.ones(3), np.ones(2 * COUNT)[::2]])
def test_targets_that_would_be_copied_are_refused(target):
    with pytest.raises((TypeError, ValueError), match="^target: "):
        example().follow(target, 0.1)


def test_targets_that_share_memory_are_refused():
    batch = example()
    with pytest.raises(ValueError, match="^target: shares memory with v"):
        batch.follow(batch.v, 0.1)


@pytest.mark.parametrize("call, field", [
    (lambda b: b.follow(1, np.nan), "dt"), (lambda b: b.follow(1, 0.1, -1), "x_tol"),
    (lambda b: b.follow(1, 0.1, 0, np.nan), "v_tol"), (lambda b: Batch(b.x, b.v, -1.0).follow(1, 0.1), "omega2"),
    (lambda b: b.advance(np.nan), "dt"), (lambda b: b.advance(0.1, 1, "verlet"), "method"),
    (lambda b: b.advance(0.1, 1, "rkn8"), "method"), (lambda b: b.stable_step("rkn8"), "method"),
    (lambda b: b.advance(0.1, -3), "steps"), (lambda b: Batch(b.x, b.v, -1.0).advance(0.1), "omega2"),
])
def test_what_concerns_all_is_named_and_nothing_changes(call, field):
    batch = example()
    before = batch.snapshot()
    with pytest.raises(springstep.SpringError) as caught:
        call(batch)
    assert caught.value.field == field and caught.value.index is None and len(caught.value.failed) == 0
    assert (batch.x == before[0]).all() and (batch.v == before[1]).all()


@pytest.mark.parametrize("field, value, call", [
    ("omega2", 1e300, lambda b, n: Batch(b.x, b.v, n)), ("omega2", 1e-60, lambda b, n: Batch(b.x, b.v, n)),
    ("accel", -1e-60, lambda b, n: Batch(b.x, b.v, 1.0, None, n)), ("dt", 1e300, lambda b, n: b.advance(n)),
    ("target", -1e300, lambda b, n: b.follow(n, 0.1)),
    ("target_velocity", 1e300, lambda b, n: b.follow(0, 0.1, target_velocity=n)),
])
def test_a_number_out_of_the_range_of_float32_is_named(field, value, call):
    batch = example(np.float32)
    with pytest.raises(springstep.InvalidError, match=re.escape(f"{field} = {value}: out of the range of float32")) as caught:
        call(batch, value)
    assert (caught.value.field, caught.value.value) == (field, value)
    batch.follow(1e-60, 0.1)  # the nearest number is 0


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda it: pickle.loads(pickle.dumps(it))])
def test_a_copy_is_a_batch_of_its_own(copied, dtype):
    one = example(dtype)
    for batch in (one, Batch(one.x.copy(), one.v.copy(), 1.7), Batch(one.x.copy(), one.v.copy(), one.omega2, 0.2)):
        before = batch.snapshot()
        twin = copied(batch)
        assert twin.dtype == dtype and not any(np.shares_memory(a, b) for a in (twin.x, twin.v, twin.omega2)
                                               for b in (batch.x, batch.v, batch.omega2))
        twin.advance(1 / 60, 7)
        assert (batch.x == before[0]).all() and (batch.v == before[1]).all() and (twin.x != before[0]).any()
        batch.advance(1 / 60, 7)
        assert (batch.x == twin.x).all() and (batch.v == twin.v).all()


def test_an_exception_can_be_pickled():
    batch = example()
    batch.x[17] = np.nan
    with pytest.raises(springstep.InvalidError) as caught:
        batch.advance(0.01)
    error = pickle.loads(pickle.dumps(caught.value))
    assert type(error) is springstep.InvalidError and str(error) == str(caught.value)
    assert (error.field, error.index, error.status, error.failed.tolist()) == ("x", 17, lib.SPRING_EINVAL, [17])


def test_many_steps_are_the_bits_of_single_steps():
    whole, parts = example(), example()
    whole.advance(1 / 60, 10)
    for _ in range(10):
        parts.advance(1 / 60)
    assert (whole.x == parts.x).all() and (whole.v == parts.v).all()


def test_calls_of_other_threads_are_refused_during_an_advance():
    batch, inside, leave = example(), threading.Event(), threading.Event()
    before, steps = batch.snapshot(), batch._steps

    def slow(*arguments):
        inside.set()
        leave.wait(60)
        return steps(*arguments)

    batch._steps = slow
    thread = threading.Thread(target=batch.advance, args=(0.01,))
    thread.start()
    assert inside.wait(60)
    for call in (lambda: batch.advance(0.01), batch.stable_step, batch.snapshot, lambda: batch.restore(before),
                 lambda: copy.copy(batch)):
        with pytest.raises(RuntimeError, match="being advanced"):
            call()
    leave.set()
    thread.join()
    assert (batch.v != before[1]).all()


def test_none():
    Batch(np.empty(0), np.empty(0), np.empty(0)).advance(0.1)
