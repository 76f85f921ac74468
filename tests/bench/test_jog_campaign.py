"""The campaign of jogs finds what it looks for: speeds over the cap, limits passed, and stops that come late."""

import math
from collections import Counter

import numpy as np
import pytest

from robolang.teaching.jogging import JogRequest, JogSettings, plan_jog
from runtime.core.units import DEG
from tests.bench import jog_campaign
from tests.bench.jog_campaign import KINDS, ROBOTS, check, controller_at, hold_key, leads_back, play, sequence
from tests.campaign import size
from tests.runtime.motion.motions import bench

FAST = JogSettings(speed=100.0)


def broken(counted: Counter) -> set[str]:
    return {each for each in KINDS if counted[each]}


DOWN = JogRequest(axis="Z", amount=100.0)


def jogged(request=DOWN, stop_s=None, late=0):
    """Return a controller that has carried out a jog, and the stops of its log."""
    robot = controller_at("puma560", bench("puma560").home())
    plan = plan_jog(robot, request, FAST)
    robot.speed_cap = None  # the controller itself would refuse rows over the cap
    stop = play(robot, plan, stop_s, late)
    return robot, [] if stop is None else [stop]


@pytest.mark.parametrize("name", ROBOTS)
def test_random_sequences_break_nothing(name):
    random, total, done = np.random.default_rng(6), Counter(), Counter()
    for _ in range(size(300, 6)):
        found, did = sequence(name, random)
        total += Counter({each: found[each] for each in KINDS})
        done += did
    assert broken(total) == set()
    assert done["step"] and done["stopped"] + done["expired"] + done["escape"] + done["lost"]


@pytest.mark.physics
@pytest.mark.parametrize("name", ROBOTS)
def test_the_links_keep_the_cap_as_well(name):
    random = np.random.default_rng(8)
    for _ in range(size(40, 2)):
        assert broken(sequence(name, random, physics=True)[0]) == set()


@pytest.mark.parametrize("name", ROBOTS)
def test_jogs_lead_back(name):
    random = np.random.default_rng(9)
    assert all(leads_back(name, random) for _ in range(size(167, 5)))


def test_a_jog_that_is_right_breaks_nothing():
    for stop_s in (None, 0.2, 0.5):
        robot, stops = jogged(stop_s=stop_s)
        assert broken(check(robot, stops, False)) == set()
        assert len(stops) == (stop_s is not None)


def test_a_jog_that_is_a_little_too_fast_is_found(monkeypatch):
    for share, found in ((0.99, set()), (1.01, {"speed"})):
        monkeypatch.setattr("runtime.motion.jog.PLANNED", share)
        robot, stops = jogged()
        assert broken(check(robot, stops, False)) == found


def test_one_tick_over_a_limit_is_found():
    robot, _ = jogged(JogRequest(axis="J4", amount=math.inf))
    assert broken(check(robot, [], False)) == set()
    out = np.array(robot.spec.upper[3] + 0.01 * DEG)
    robot.recorder._data.commands[robot.recorder.tick - robot.recorder._block.tick - 1, 3] = out
    assert "range" in broken(check(robot, [], False))


@pytest.mark.parametrize("stop_s", [0.1, 0.3])
def test_a_stop_that_begins_a_cycle_late_is_found(stop_s):
    robot, stops = jogged(stop_s=stop_s, late=1)
    assert broken(check(robot, stops, False)) == {"stop"}


def test_a_dead_man_that_expires_late_is_found(monkeypatch):
    home = bench("puma560").home()
    for alive_s, found in ((0.2, set()), (0.209, {"stop"})):
        monkeypatch.setattr("robolang.teaching.dead_man.ALIVE_S", alive_s)
        robot = controller_at("puma560", home)
        plan = plan_jog(robot, JogRequest(axis="Z", amount=math.inf), FAST)
        stop = hold_key(robot, plan, [0.0, 0.033, 0.066], "expired")
        assert stop is not None
        assert broken(check(robot, [stop], False)) == found


def test_a_stop_that_never_comes_is_found(monkeypatch):
    monkeypatch.setattr(jog_campaign, "REST_S", 0.01)
    robot, stops = jogged(stop_s=0.4)
    assert broken(check(robot, stops, False)) == {"rest"}
