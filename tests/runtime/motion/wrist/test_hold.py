"""Suppression: the table of section 7.2, the weld-line frame, and the curve that is executed."""

import itertools

import numpy as np
import pytest

from runtime.core.frames import rotation_from_rpy
from runtime.motion.wrist.hold import (
    COMPONENTS,
    PathAhead,
    Suppression,
    held_angles,
    posture_components,
    smoothed_table,
    weld_line_frame,
)
from runtime.motion.wrist.switch import law_from
from tests.runtime.motion.wrist_moves import E2, E3, FROZEN, KINEMATICS, SECONDS, TOOL, conventional, path_of

SPEED = np.radians([180.0, 180.0, 225.0])
DT = 0.02


def suppressed(move, switch_s, held):
    """Return the largest deviation of tilt, advance and rotation, deg, and the joint angles after the switch."""
    path, s = path_of(move), np.linspace(0.0, 1.0, round(SECONDS / DT) + 1)
    q, q_end, k = conventional(move, s, path), np.radians(move[1]), round(switch_s / DT)
    X = path.poses(s[k + 1 :])
    if held:
        chooser = Suppression(KINEMATICS, TOOL, held, SPEED)
        wrist = chooser.choose(q[k], q_end[3:], PathAhead.of(path, s[k:], DT))
    else:
        wrist = law_from(q, s, k, q_end[3:], "linear").angles(s[k + 1 :])
    rows = FROZEN.solve(X[:, :3, 3], wrist, q[k], FROZEN.side_of(q[k]))
    frame = weld_line_frame(path.X_end[:3, 3] - path.X_start[:3, 3])
    taken = (KINEMATICS.forward(rows) @ TOOL)[:, :3, :3]
    off = posture_components(frame, taken) - posture_components(frame, X[:, :3, :3])
    off -= 2.0 * np.pi * np.round(off / (2.0 * np.pi))
    return np.degrees(np.abs(off)).max(axis=0), np.concatenate([q[k : k + 1], rows])


TABLE = [
    (E2, 2.2, (), ("3.0", "0.8", "7.7")),
    (E2, 2.2, ("TILT",), ("0.45", "27.8", "6.6")),
    (E2, 2.2, ("ADVANCE",), ("10.6", "0.14", "8.4")),
    (E2, 2.2, ("ROTATION",), ("6.2", "36.7", "0.15")),
    (E2, 2.2, ("TILT", "ADVANCE"), ("2.3", "0.39", "7.8")),
    (E3, 1.8, (), ("4.4", "2.2", "2.2")),
    (E3, 1.8, ("TILT",), ("0.14", "19.7", "9.4")),
    (E3, 1.8, ("ADVANCE",), ("5.6", "0.32", "14.3")),
    (E3, 1.8, ("ROTATION",), ("2.5", "20.7", "0.13")),
    (E3, 1.8, ("TILT", "ADVANCE"), ("0.73", "0.61", "10.5")),
]


@pytest.mark.parametrize(("move", "switch_s", "held", "printed"), TABLE)
def test_the_table_of_the_specification(move, switch_s, held, printed):
    off, q = suppressed(move, switch_s, held)
    for value, text in zip(off, printed, strict=True):
        assert value == pytest.approx(float(text), abs=10.0 ** -len(text.partition(".")[2]))
    assert np.abs(np.degrees(q[-1]) - move[1]).max() < 1e-6
    assert (np.abs(np.diff(q[:, 3:], axis=0)) <= SPEED * DT * (1 + 1e-9)).all()


@pytest.mark.parametrize(("move", "switch_s"), [(E2, 2.2), (E3, 1.8)])
@pytest.mark.parametrize("component", COMPONENTS)
def test_one_component_alone_improves_by_more_than_eighty_percent(move, switch_s, component):
    k = COMPONENTS.index(component)
    free, held = (suppressed(move, switch_s, chosen)[0][k] for chosen in ((), (component,)))
    assert held < 0.2 * free


def test_the_weld_line_frame_of_a_horizontal_a_slanted_and_a_vertical_travel():
    np.testing.assert_allclose(weld_line_frame(np.array([2.0, 0.0, 0.0])), np.eye(3), atol=1e-15)  # left and up
    slanted = weld_line_frame(np.array([1.0, 1.0, 1.0]))
    np.testing.assert_allclose(slanted.T @ slanted, np.eye(3), atol=1e-15)
    assert slanted[2, 1] == 0.0 and slanted[2, 2] > 0.0  # Y level, Z upwards
    np.testing.assert_allclose(weld_line_frame(np.array([0.0, 0.0, -1.0]))[:, 1], [0.0, 1.0, 0.0])


def test_components_are_the_angles_they_are_composed_of():
    frame = weld_line_frame(np.array([0.3, -0.4, 0.1]))
    for angles in itertools.product((-1.2, 0.4), (-0.7, 0.9), (-2.8, 0.1)):
        found = posture_components(frame, frame @ rotation_from_rpy(angles))
        np.testing.assert_allclose(found, angles, atol=1e-12)


@pytest.mark.parametrize("held", [("TILT",), ("ROTATION",)])
def test_the_curve_that_is_executed_starts_on_the_path_ends_as_taught_and_has_no_jumps(held):
    path, s = path_of(E2), np.linspace(0.0, 1.0, 401)
    q, end = conventional(E2, s, path), np.radians(E2[1][3:])
    law = law_from(q, s, 160, end, "linear")
    chosen = held_angles(Suppression(KINEMATICS, TOOL, held, SPEED), path, q[160], law, 1.0 / SECONDS)
    table = smoothed_table(chosen, law, 0.15)
    fine = np.linspace(law.s_switch, 1.0, 2001)
    angles = table.angles(fine)
    np.testing.assert_allclose(angles[[0, -1]], [q[160, 3:], end], atol=1e-12)
    rate = np.diff(angles, axis=0) / (fine[1] - fine[0]) / SECONDS
    assert np.abs(np.diff(rate, axis=0)).max() < 0.1  # rad/s between neighbours of 2000; the choice itself jumps by 3
