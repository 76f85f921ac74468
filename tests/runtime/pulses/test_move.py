"""Whole moves in pulses: C3 and C4 of the specification on the cylindrical robot, random moves of four machines."""

import re
from dataclasses import replace

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.core.frames import pose
from runtime.core.units import MM
from runtime.motion.commands import MAX, MoveLinear
from runtime.pulses import emission
from runtime.pulses.channels import default_channels
from runtime.pulses.machine import Stand
from runtime.pulses.mechanism import load_builtin
from runtime.pulses.move import counted, off_line, plan_move
from tests.bench.pulse_campaign import campaign, machine_and_pulses
from tests.messages import fields

CYLINDRICAL = load_builtin("cylindrical")
A, B = np.array([300.0, -150.0, 700.0]) * MM, np.array([300.0, 150.0, 700.0]) * MM


def move(name="cylindrical", start=A, end=B, step_s=0.01, min_hz=1.0, max_hz=100_000.0, pulse=None, **options):
    """Plan a straight move of a built-in mechanism from one point to another."""
    machine, pulses = machine_and_pulses(name)
    machine = machine.placed(end)
    q = machine.home.q
    if np.abs(machine.points(q[None])[0] - start).max() > 1e-9:
        q = machine.curve(machine.home, MoveLinear(X_world_tool=pose(start))).joints(np.linspace(0.0, 1.0, 100))[-1]
    channels = default_channels(machine.joints, pulse or pulses, min_hz)
    channels = tuple(replace(channel, max_hz=max_hz) for channel in channels)
    stand = Stand(q=q)
    command = MoveLinear(X_world_tool=pose(end), **options)
    return plan_move(machine, stand, command, channels, counted(q, channels), step_s), channels


def test_c3_has_the_published_frequencies_and_pulses():
    """V = 100 mm/s, a = 500 mm/s2 (T0 = 0.2 s) and the pulse equivalents are those of the library's file."""
    found, _ = move()
    assert (found.steps.n, found.count) == (320, 320)
    theta, r, z = found.planned.T
    assert found.highest_hz(0.01) == [5300, 8500, 0]
    assert int((r == 0).sum()) == 2
    assert int((np.diff(np.sign(r[r != 0])) != 0).sum()) == 1
    assert (z == 0).all()
    polar = np.degrees(np.arctan2([-150.0, 150.0], 300.0)), np.hypot(300.0, [-150.0, 150.0])
    ends = [np.floor(value / pulse + 0.5) for value, pulse in zip(polar, (0.0036, 0.005), strict=True)]
    assert [int(theta.sum()), int(r.sum())] == [int(end - start) for start, end in ends]
    assert found.error.max() / MM == pytest.approx(0.0063, abs=5e-5)
    ratio = np.abs(theta[20:300]) / np.maximum(np.abs(r[20:300]), 1)
    assert ratio.max() > 10.0 * ratio.min()


def test_a_cartesian_machine_keeps_its_ratio_within_a_pulse():
    found, _ = move("xy", A, A + np.array([0.3, 0.15, 0.0]))
    x, y = found.planned.T
    assert np.abs(x - 2 * y).max() <= 2


@pytest.mark.parametrize(("min_hz", "raised", "debt"), [(191.0, [0, 2], [0, 3]), (500.0, [2, 10], [6, 19])])
def test_c4_compensates_as_published(min_hz, raised, debt):
    found, channels = move(step_s=0.02, min_hz=min_hz)
    assert [each.raised for each in found.emitted[:2]] == raised
    assert [each.debt for each in found.emitted[:2]] == debt
    assert found.error.max() / MM <= 0.095 + 1e-6  # 19 pulses of 5 um; the home of the file has nine decimals
    for k, each in enumerate(found.emitted):
        assert each.steps.sum() == found.planned[:, k].sum()
        assert not ((each.steps != 0) & (np.abs(each.steps) < min_hz * 0.02)).any()
    assert (found.end == counted(found.q[-1], channels)).all()


def test_a_frequency_too_high_names_a_speed_that_fits():
    with pytest.raises(Fault) as caught:
        move(max_hz=6000.0)
    assert caught.value.code == "RBL430"
    assert re.search(r"\br\b.* 8[45]00 Hz .*\d+\.\d %", caught.value.message)
    speed = float(re.search(r"SPEED ([\d.]+)", caught.value.hint)[1])
    assert 60.0 < speed < 71.0
    found, _ = move(max_hz=6000.0, speed=speed * MM)
    assert max(found.highest_hz(0.01)) <= 6000
    with pytest.raises(Fault):
        move(max_hz=6000.0, speed=1.1 * speed * MM)


def test_under_an_override_the_speed_and_time_that_fit_are_those_to_write():
    def refused(**options):
        with pytest.raises(Fault) as caught:
            move(override=0.5, max_hz=3000.0, **options)
        return caught.value.hint

    speed = float(re.search(r"SPEED ([\d.]+)", refused())[1])
    assert 60.0 < speed < 71.0
    found, _ = move(override=0.5, max_hz=3000.0, speed=speed * MM)
    assert max(found.highest_hz(0.01)) <= 3000
    with pytest.raises(Fault):
        move(override=0.5, max_hz=3000.0, speed=1.1 * speed * MM)
    assert move(override=0.5, duration=5.0)[0].count * 0.01 == pytest.approx(10.0, abs=0.011)


def test_time_is_the_whole_of_the_move():
    found, _ = move(duration=5.0)
    assert found.count * 0.01 == pytest.approx(5.0, abs=0.011)
    assert found.notes == ()
    found, _ = move(duration=0.5)
    assert {"TIME", "0.5", "s"} <= fields(found.notes[0])


def test_without_a_limit_along_the_line_the_ramps_are_those_of_the_machine():
    found, _ = move(acceleration=MAX)
    assert np.array_equal(found.planned, move()[0].planned)
    assert {"ACCEL", "MAX", "100"} <= fields(found.notes[0])
    assert len(move(acceleration=MAX, duration=0.5)[0].notes) == 2


def test_a_joint_that_would_be_too_fast_slows_the_move():
    machine, pulses = machine_and_pulses("cylindrical")
    slow = tuple(replace(joint, speed=0.1) if joint.name == "theta" else joint for joint in machine.joints)
    machine = replace(machine, joints=slow)
    channels = default_channels(slow, pulses, 1.0)
    found = plan_move(
        machine,
        Stand(q=machine.home.q),
        MoveLinear(X_world_tool=pose(B)),
        channels,
        counted(machine.home.q, channels),
        0.01,
    )
    assert found.slowed > 2.0
    assert "theta" in found.notes[0]
    fastest = np.abs(np.diff(found.q[:, 0])).max() / 0.01
    assert 0.098 < fastest <= 0.1


def test_a_target_beyond_counting_is_refused():
    with pytest.raises(Fault) as caught:
        move(pulse=(1e-17, 1e-17, 1e-17), max_hz=1e9)
    assert caught.value.code == "RBL432"


def test_a_move_to_nowhere_has_no_steps():
    found, _ = move(end=A)
    assert (found.count, len(found.notes)) == (0, 1)
    assert found.error.shape == (1,)
    assert found.error[0] < 0.5 * 0.005 * MM + 0.5 * 0.0036 * np.pi / 180.0 * 0.34


def test_distance_from_a_line_is_to_the_segment():
    points = np.array([[0.5, 1.0, 0.0], [-3.0, 4.0, 0.0], [2.0, 0.0, 0.0]])
    assert off_line(points, np.zeros(3), np.array([1.0, 0.0, 0.0])) == pytest.approx([1.0, 5.0, 1.0])
    assert off_line(points[:1], np.zeros(3), np.zeros(3)) == pytest.approx([np.hypot(0.5, 1.0)])


@pytest.mark.parametrize("min_hz", [None, 500.0])
def test_random_moves_of_four_machines_break_no_law(min_hz):
    """2,000 of them: ``make pulse-campaign``."""
    for name, count in campaign(10, min_hz=min_hz).items():
        assert sum(count.broken.values()) == 0, (name, count)
        assert count.moves == 10
        assert 0.5 < count.worst_share < 1.0


def test_the_campaign_sees_a_pulse_that_is_lost(monkeypatch):
    monkeypatch.setattr(emission, "settle", lambda steps, missing, least, most: steps)
    assert campaign(10, min_hz=500.0)["cylindrical"].broken["sum"] > 0


def test_the_campaign_sees_a_step_that_is_too_short(monkeypatch):
    monkeypatch.setattr(emission, "compensate", lambda planned, least: (planned, 0, 0))
    assert campaign(10, min_hz=500.0)["cylindrical"].broken["least"] > 0
