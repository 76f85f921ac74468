"""The dead-man: events of keys at given times, and what each is to do."""

import math

import pytest

from robolang.teaching.dead_man import Act, DeadMan


def acts(dead_man: DeadMan, *events: tuple[str, float, bool]) -> list[Act]:
    return [dead_man.press(key, at, moving=moving) for key, at, moving in events]


def held(dead_man: DeadMan, until: float = 0.56) -> float:
    """Hold a key as a terminal shows it, its first step short; return the time of the last event."""
    dead_man.press("X+", 0.0, moving=False)
    dead_man.press("X+", 0.5, moving=False)
    dead_man.press("X+", until - 0.03, moving=True)
    assert dead_man.press("X+", until, moving=False) is Act.GO_ON
    return until


def test_one_press_is_one_step():
    assert acts(DeadMan(), ("X+", 0.0, False), ("X+", 2.0, False), ("Y-", 2.1, False)) == [Act.STEP] * 3


def test_presses_while_a_step_runs_are_dropped():
    dead_man = DeadMan()
    assert acts(dead_man, ("X+", 0.0, False), ("X+", 0.3, True), ("X+", 1.2, True)) == [
        Act.STEP,
        Act.NOTHING,
        Act.NOTHING,
    ]
    assert not dead_man.expired(9.0)  # a step ends by itself


def test_a_held_key_goes_on_from_its_second_repeat():
    events = [("X+", 0.0, False), ("X+", 0.5, False), ("X+", 0.53, False)]
    assert acts(DeadMan(), *events) == [Act.STEP, Act.STEP, Act.GO_ON]
    busy = [("X+", 0.0, False), ("X+", 0.5, True), ("X+", 0.53, True), ("X+", 0.56, True), ("X+", 0.59, False)]
    assert acts(DeadMan(), *busy) == [Act.STEP, Act.NOTHING, Act.NOTHING, Act.NOTHING, Act.GO_ON]


def test_slow_presses_of_one_key_are_no_repeats():
    events = [("X+", 0.0, False), ("X+", 0.5, False), ("X+", 1.0, False), ("X+", 1.5, False)]
    assert acts(DeadMan(), *events) == [Act.STEP] * 4


def test_it_expires_200_ms_after_the_last_repeat_and_repeats_keep_it_alive():
    dead_man = DeadMan()
    last = held(dead_man)
    for k in range(1, 40):
        assert not dead_man.expired(last + 0.03 * k)
        assert dead_man.press("X+", last + 0.03 * k, moving=True) is Act.NOTHING
    last += 0.03 * 39
    assert not dead_man.expired(last + 0.199)
    assert dead_man.expired(last + 0.201)


@pytest.mark.parametrize("now_s", [math.nan, math.inf, -1.0])
def test_a_time_that_cannot_be_expires(now_s):
    dead_man = DeadMan()
    held(dead_man)
    assert dead_man.expired(now_s)


@pytest.mark.parametrize("key", ["escape", " ", "Y+", "X-"])
def test_other_keys_stop_a_held_key_and_a_step_and_start_nothing(key):
    dead_man = DeadMan()
    last = held(dead_man)
    assert dead_man.press(key, last + 0.05, moving=True) is Act.STOP
    assert dead_man.press(key, last + 0.08, moving=True) is Act.NOTHING  # it brakes already
    assert dead_man.press("X+", last + 0.10, moving=True) is Act.NOTHING
    assert not dead_man.expired(last + 9.0)
    assert dead_man.press("X+", last + 1.0, moving=False) is Act.STEP
    step = DeadMan()
    assert acts(step, ("X+", 0.0, False), (key, 0.1, True)) == [Act.STEP, Act.STOP]


@pytest.mark.parametrize("key", ["escape", " "])
def test_a_stop_at_rest_moves_nothing(key):
    assert DeadMan().press(key, 0.0, moving=False) is Act.NOTHING


def test_a_late_repeat_does_not_revive_an_expired_jog():
    dead_man = DeadMan()
    last = held(dead_man)
    assert dead_man.press("X+", last + 0.3, moving=True) is Act.STOP
    assert dead_man.press("X+", last + 0.33, moving=True) is Act.NOTHING
    assert dead_man.press("X+", last + 0.36, moving=False) is Act.STEP


def test_a_lost_terminal_stops_and_no_repeat_revives_the_jog():
    dead_man = DeadMan()
    last = held(dead_man)
    dead_man.stop()
    assert dead_man.press("X+", last + 0.03, moving=True) is Act.NOTHING
    assert not dead_man.expired(last + 9.0)
