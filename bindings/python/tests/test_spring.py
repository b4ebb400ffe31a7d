# SPDX-License-Identifier: MIT
"""One spring, and the clock."""
import copy
import math
import pickle
import subprocess

import numpy as np
import pytest

import springstep
from springstep import Clock, Spring, lib

OF_SPRINGS = [method.name for method in springstep.methods() if method.springs]


def example():
    return Spring(2.7, 1.3, 0.6, 0.4, x=0.9, v=-0.35)


def last_row(*arguments):
    text = subprocess.run(["spring-run", *arguments], capture_output=True, text=True, check=True).stdout
    rows = [line.split("\t") for line in text.splitlines() if not line.startswith("#")]
    return dict(zip(rows[0], rows[-1]))


@pytest.mark.parametrize("method", OF_SPRINGS)
def test_bits_are_those_of_spring_run(method):
    row = last_row("--method", method, "--duration", "12", "--steps", "768", "--stiffness", "2.7", "--mass", "1.3",
                   "--damping", "0.6", "--load", "0.4", "--x0", "0.9", "--v0", "-0.35")
    spring = example()
    spring.advance(12 / 768, 768, method)
    assert (spring.x, spring.v) == (float(row["x_m"]), float(row["v_m_per_s"]))
    assert spring.energy() == float(row["energy_J"])


@pytest.mark.parametrize("method", OF_SPRINGS)
def test_steps_backwards_come_back(method):
    spring = example()
    before = spring.snapshot()
    spring.advance(1e-3, 10, method)
    moved = spring.snapshot()
    spring.advance(-1e-3, 10, method)
    # Euler's error of ten steps there and back is ten times dt^2 |a|, a about 3 m/s^2
    assert moved != before and spring.snapshot() == pytest.approx(before, abs=1e-4)
    spring.restore(moved)
    assert spring.snapshot() == moved


def test_questions():
    spring = example()
    assert spring.stable_step("leapfrog") == pytest.approx(2 / math.sqrt(2.7 / 1.3), rel=1e-14)  # 2/omega, to 8 ulp
    assert Spring(2.7).stable_step("euler") == 0 and spring.stable_step("exact") == math.inf
    dt = spring.accurate_step(10, 1e-3, "rk4")
    assert 0.9e-3 < spring.step_error(10, dt, "rk4") <= 1.001e-3  # what the header says
    spring.advance(spring.settling_time(1e-3), 1, "exact")
    assert abs(spring.x - 0.4 / 2.7) <= 1.0001e-3 and not spring.at_rest(1e-2, 0) and spring.at_rest(1e-2, 1e-2)


@pytest.mark.parametrize("times", [0.3, [0, 0.1, 2.5, -0.7], np.linspace(-1, 1, 6).reshape(2, 3), []])
def test_at_is_the_exact_solution(times):
    spring = example()
    x, v = spring.at(times)
    assert x.shape == v.shape == np.shape(times) and repr(spring) == repr(example())
    for time, *state in zip(np.ravel(times), x.ravel(), v.ravel()):
        spring = example()
        spring.advance(time, 1, "exact")
        assert [spring.x, spring.v] == state
    with pytest.raises(springstep.InvalidError, match=r"^times\[2\] = nan: ") as caught:
        spring.at([0, 1, math.nan])
    assert caught.value.index == 2


def test_how_it_should_feel():
    assert Spring.hertz(2, 0.1).stiffness == pytest.approx((4 * math.pi) ** 2, rel=1e-15)
    spring = Spring.half_life(0.7, 0.3)
    assert math.exp(-spring.damping * 0.7 / 2) == pytest.approx(0.5, rel=1e-14)
    assert Spring.response(0.3, 0.7).stiffness == pytest.approx(438.649084492860, rel=1e-12)
    assert Spring.bounce(0.5, 0.25).damping == pytest.approx(18.8495559215388, rel=1e-12)
    assert Spring.settling(0.4, 0.3, x=1).settling_time(1e-3) == pytest.approx(0.4, rel=1e-9)
    slow = Spring(4, 1, 1, x=1)
    time = slow.settling_time(0.1, 1e-3)
    assert time > slow.settling_time(0.1)
    slow.advance(time, 1, "exact")
    assert abs(slow.v) == pytest.approx(1e-3)


def test_a_spring_lands_on_its_target():
    spring, frames = Spring.bounce(0.5, 0.3, x=100), 0
    while (spring.x, spring.v) != (7.3, 0):
        spring.follow(7.3, 1 / 60)
        frames += 1
    assert frames < 400
    spring.restore((0, 2.0))
    for frame in range(1, 100):
        spring.follow(2 * frame / 60, 1 / 60, 2.0)
        assert spring.snapshot() == pytest.approx((2 * frame / 60, 2.0), abs=1e-12)  # no lag


@pytest.mark.parametrize("field, value", [("mass", 0.0), ("mass", math.nan), ("stiffness", -2.7), ("damping", -0.6),
                                          ("load", math.inf), ("x", math.nan), ("v", math.inf)])
def test_a_wrong_field_is_named(field, value):
    spring = example()
    setattr(spring, field, value)
    with pytest.raises(springstep.InvalidError, match=f"^{field} = {value}: ") as caught:
        spring.advance(1e-3)
    assert caught.value.field == field and caught.value.status == lib.SPRING_EINVAL
    assert caught.value.value == value or math.isnan(value)
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize("call, field", [
    (lambda s: Spring(-1.0), "stiffness"), (lambda s: s.advance(math.nan), "dt"), (lambda s: s.advance(1.0, -1), "steps"),
    (lambda s: s.advance(1.0, 2**64), "steps"), (lambda s: s.advance(1.0, 1, "verlet"), "method"),
    (lambda s: s.stable_step("verlet"), "method"), (lambda s: s.accurate_step(0, 1e-3), "duration"),
    (lambda s: s.accurate_step(1, -1e-3), "tolerance"), (lambda s: s.step_error(1, 0), "dt"),
    (lambda s: s.step_error(math.nan, 1e-3), "duration"), (lambda s: s.settling_time(-1), "x_tol"), (lambda s: s.settling_time(1, -1), "v_tol"),
    (lambda s: Spring.hertz(-1, 0.5), "hertz"), (lambda s: Spring.hertz(1, -0.5), "damping_ratio"),
    (lambda s: Spring.half_life(0, 0.5), "half_life"), (lambda s: Spring.half_life(1, 0), "damping_ratio"),
    (lambda s: Spring.response(0, 1), "response"), (lambda s: Spring.response(1, -1), "damping_fraction"),
    (lambda s: Spring.bounce(0, 0), "duration"), (lambda s: Spring.bounce(1, -1), "bounce"),
    (lambda s: Spring.settling(0, 1), "time"), (lambda s: Spring.settling(1, 0), "damping_ratio"),
    (lambda s: Spring.settling(1, 1, 1), "tolerance"), (lambda s: Spring.settling(1, 1e-300), "damping_ratio, tolerance, time"),
    (lambda s: Spring.hertz(1e200, 1), "damping_ratio, hertz"), (lambda s: s.at(math.inf), "times"),
    (lambda s: s.at_rest(-1, 0), "x_tol"), (lambda s: s.at_rest(0, math.nan), "v_tol"),
    (lambda s: setattr(s, "mass", -1) or s.at_rest(1, 1), "mass"), (lambda s: setattr(s, "x", math.nan) or s.at_rest(1, 1), "x"),
    (lambda s: s.follow(math.nan, 0.1), "target"),
    (lambda s: s.follow(1, math.inf), "dt"), (lambda s: s.follow(1, 0.1, math.nan), "target_velocity"),
    (lambda s: Clock(0), "dt"), (lambda s: Clock(1e-3).tick(-1), "frame_dt"), (lambda s: Clock(1e-3, -1), "max_steps"),
])
def test_a_wrong_argument_is_named(call, field):
    with pytest.raises(springstep.InvalidError) as caught:
        call(example())
    assert caught.value.field == field


def test_what_fails_changes_nothing():
    spring = example()
    before = spring.snapshot()
    with pytest.raises(springstep.NonFiniteError, match=r"^dt = 1000.0: .*\(dt 1000.0 s, stable step of leapfrog 1.38") as caught:
        spring.advance(1e3, 1000)
    assert (caught.value.dt, caught.value.stable_step) == (1e3, spring.stable_step())
    with pytest.raises(springstep.InvalidError, match="^method = 'verlet': not one of euler, symplectic-euler, leapfrog, "):
        spring.advance(1e-3, 1, "verlet")
    with pytest.raises(springstep.UnsupportedError, match="rkn8"):
        spring.advance(1e-3, 1, "rkn8")
    with pytest.raises(TypeError):
        spring.restore((1, "a"))
    assert spring.snapshot() == before


def test_a_clock():
    clock = Clock(1 / 128, 4)
    assert clock.tick(2.5 / 128) == (2, 0.5) and clock.pending == 0.5 / 128
    before = clock.snapshot()
    assert clock.tick(10 / 128) == (4, 0.5) and clock.dropped == 6 / 128 == clock.skipped
    clock.restore(before)
    assert (clock.pending, clock.dropped, clock.skipped) == (0.5 / 128, 0, 0)
    with pytest.raises(TypeError):
        clock.restore((0, "a"))
    assert clock.snapshot() == before
    clock.dt = 0
    with pytest.raises(springstep.InvalidError, match="^dt, pending = "):
        clock.tick(1 / 128)


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda it: pickle.loads(pickle.dumps(it))])
def test_a_copy_is_a_thing_of_its_own(copied):
    spring, clock = example(), Clock(1 / 128, 4)
    assert clock.tick(5.5 / 128) and clock.skipped == 1 / 128
    twins = copied(spring), copied(clock)
    assert (repr(twins[0]), repr(twins[1])) == (repr(spring), repr(clock))
    assert twins[1].snapshot() == clock.snapshot() == (0.5 / 128, 1 / 128) and twins[1].skipped == clock.skipped
    spring.advance(0.1)
    clock.tick(0.25 / 128)
    assert repr(twins[0]) == repr(example()) and twins[1].pending == 0.5 / 128
