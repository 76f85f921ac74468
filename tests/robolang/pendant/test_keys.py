"""Jogging by keys, with a clock and keys of the test: what moves, and when it begins to stop."""

from contextlib import nullcontext

import numpy as np
import pytest
from prompt_toolkit.output import DummyOutput

from robolang.pendant import keys as module
from robolang.pendant.facts import Gathering
from robolang.pendant.foreground import Foreground
from robolang.pendant.interrupts import Interrupt
from robolang.pendant.keys import KeyMode
from robolang.pendant.screen import TerminalOutput
from robolang.teaching.dead_man import ALIVE_S
from tests.robolang.pendant.prompting import prompt

CYCLE_S = 0.008


class Keys:
    """A keyboard whose keys come at given times; waiting lets its time pass."""

    def __init__(self, *events, ends_s=60.0):
        self.events = sorted([*events, (ends_s, "q")], key=lambda event: event[0])
        self.now = 0.0
        self.closed = False

    def direct(self):
        return nullcontext()

    def pressed(self):
        found = [key for at, key in self.events if at <= self.now]
        self.events = self.events[len(found) :]
        return found

    def wait(self, seconds):
        ahead = [at - self.now for at, _ in self.events if at > self.now]
        self.now += min([seconds, *ahead])


class Watched(Foreground):
    """A foreground that notes the time of every cycle and of every request."""

    def __init__(self, keyboard):
        super().__init__(keyboard)
        self.clock = keyboard
        self.cycles, self.stops = [], []

    def take(self):
        request = super().take()
        self.cycles.append(self.clock.now)
        if request is Interrupt.STOP:
            self.stops.append(self.clock.now)
        return request


def held(key, begin, end, pause=0.5, every=0.05):
    """Return the events of a key that is held: a pause before the first repeat, then one after the other."""
    return [(begin, key), *((float(at), key) for at in np.arange(begin + pause, end, every))]


@pytest.fixture
def jogged(monkeypatch):
    """Let keys jog; return where the tool moved (mm), the foreground and the key mode."""

    def jog(*events, armed=True, ends_s=60.0):
        keyboard = Keys(*events, ends_s=ends_s)
        monkeypatch.setattr(module, "wall_s", lambda: keyboard.now)
        foreground = Watched(keyboard)
        pendant = prompt(interrupts=foreground).pendant
        pendant.armed = armed
        terminal = DummyOutput()
        mode = KeyMode(pendant, TerminalOutput(terminal, dict, lambda question: False), terminal, Gathering(pendant))
        begin = np.array(pendant.live.arm.tool_in_world)
        mode.run()
        return np.array(pendant.live.arm.tool_in_world) - begin, foreground, mode

    return jog


def test_nothing_moves_before_it_is_armed(jogged):
    moved, foreground, mode = jogged((1.0, "z"), *held("right", 2.0, 5.0), armed=False)
    assert not moved.any()
    assert not foreground.cycles
    assert mode._message


def test_e_arms_and_disarms(jogged):
    moved, _, mode = jogged((1.0, "e"), (1.5, "z"), (2.0, "right"), (9.0, "e"), (10.0, "right"), armed=False)
    assert moved[2] == pytest.approx(10.0, abs=1e-6)
    assert not mode._pendant.armed


@pytest.mark.parametrize(("key", "sign"), [("right", 1), ("left", -1)])
@pytest.mark.parametrize(("axis", "at"), [("x", 0), ("y", 1), ("z", 2)])
def test_one_press_is_one_step(jogged, key, sign, axis, at):
    moved, foreground, _ = jogged((1.0, axis), (2.0, key))
    expected = np.zeros(3)
    expected[at] = 10.0 * sign
    assert moved[:3] == pytest.approx(expected, abs=1e-6)
    assert not foreground.stops


@pytest.mark.parametrize(
    ("presses", "step"), [("-", 1.0), ("--", 0.1), ("-----", 0.1), ("+", 50.0), ("++++", 100.0), ("+-", 10.0)]
)
def test_plus_and_minus_go_through_the_steps(jogged, presses, step):
    moved, _, _ = jogged((1.0, "z"), *((1.1, key) for key in presses), (2.0, "left"))
    assert moved[2] == pytest.approx(-step, abs=1e-6)


def test_a_joint_moves_by_the_angular_step(jogged):
    moved, _, mode = jogged((1.0, "1"), (1.2, "-"), (2.0, "right"))
    live = mode._pendant.live
    assert live.arm.joints[0] - live.home[0] == pytest.approx(1.0, abs=1e-9)
    assert moved[5] != 0.0


def test_keys_choose_frame_and_speed(jogged):
    _, _, mode = jogged(*((1.0, key) for key in "t>>"))
    assert mode._pendant.jog.frame == "tool"
    assert mode._pendant.jog.speed == 75.0
    _, _, mode = jogged(*((1.0, key) for key in ("u", "f", *"<<<<<<<<")))
    assert mode._pendant.jog.frame == "joint"
    assert mode._pendant.jog.speed == 1.0


def test_a_held_key_goes_on_and_stops_within_a_cycle_of_the_dead_mans_expiry(jogged):
    events = held("left", 2.0, 5.0)
    last = events[-1][0]
    moved, foreground, _ = jogged((1.0, "z"), *events)
    assert moved[2] < -100.0
    assert len(foreground.stops) == 1
    assert last + ALIVE_S < foreground.stops[0] <= last + ALIVE_S + CYCLE_S + 1e-9
    # it came to rest soon, and nothing moved any more
    assert foreground.cycles[-1] < last + ALIVE_S + 1.0


@pytest.mark.parametrize("key", ["escape", "space", "right", "x", "q", "enter"])
def test_another_key_stops_within_a_cycle(jogged, key):
    events = held("left", 2.0, 3.5)
    at = events[-1][0] + 0.06
    moved, foreground, _ = jogged((1.0, "z"), *events, (at, key))
    assert -150.0 < moved[2] < 0.0
    assert len(foreground.stops) == 1
    assert at <= foreground.stops[0] <= at + CYCLE_S + 1e-9


@pytest.mark.parametrize("key", ["escape", "space"])
def test_esc_and_space_stop_a_step(jogged, key):
    moved, foreground, _ = jogged((1.0, "z"), (1.1, "+"), (1.2, "+"), (2.0, "left"), (2.6, key))
    assert -99.0 < moved[2] < -1.0
    assert 2.6 <= foreground.stops[0] <= 2.6 + CYCLE_S + 1e-9


def test_nothing_is_queued(jogged):
    # three presses within one step: a step, and none after it
    moved, _, _ = jogged((1.0, "z"), (2.0, "left"), (2.2, "left"))
    assert moved[2] == pytest.approx(-10.0, abs=1e-6)


def test_a_stop_that_comes_with_a_press_wins(jogged):
    moved, foreground, _ = jogged((1.0, "z"), (2.0, "left"), (2.0, "space"))
    assert not moved.any()
    assert not foreground.cycles


def test_a_jog_keeps_the_pace_of_wall_time(jogged):
    _, foreground, _ = jogged((1.0, "z"), (2.0, "left"))
    assert np.diff(foreground.cycles) == pytest.approx(CYCLE_S)


def test_a_jog_beyond_a_limit_is_refused_with_its_code(jogged):
    moved, _, mode = jogged((1.0, "5"), *((1.1, "+") for _ in range(3)), (2.0, "left"), (20.0, "left"))
    assert "RBL411" in mode._message
    assert not moved.any()


def test_a_terminal_that_goes_away_stops_and_leaves(jogged, monkeypatch):
    monkeypatch.setattr(Keys, "pressed", gone_at(2.6, Keys.pressed))
    moved, foreground, _ = jogged((1.0, "z"), (1.1, "+"), (1.2, "+"), (2.0, "left"))
    assert -99.0 < moved[2] < -1.0
    assert 2.6 <= foreground.stops[0] <= 2.6 + CYCLE_S + 1e-9
    assert foreground.lost


def gone_at(seconds, pressed):
    def found(self):
        self.closed = self.now >= seconds
        return [] if self.closed else pressed(self)

    return found


def test_what_was_watched_before_is_watched_again(jogged):
    _, foreground, _ = jogged((1.0, "z"))
    assert foreground.judge(["space"])
    assert not foreground.judge(["x"])
