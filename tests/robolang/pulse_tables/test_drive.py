"""The real arm driven by pulse tables that are written here by hand: it follows them; the wrong ones are refused."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from robolang.project.project import load_cell_and_settings
from robolang.pulse_tables.drive import RAMP_S, drive, set_points, start_angles
from runtime.control.controller import Controller
from runtime.core.faults import Fault
from runtime.core.program_line import ProgramLine
from runtime.core.units import DEG
from runtime.pulses.folder import read_export
from runtime.pulses.replay import replay
from runtime.robot.kinematics.kinematics import Kinematics
from tests.messages import fields
from tests.runtime.pulses import Handmade

CELL_FILE = Path(__file__).parents[3] / "programs" / "pick_and_place.cell.toml"
CELL, SETTINGS = load_cell_and_settings(None, CELL_FILE, None, None, {})
PROFILE = SETTINGS.profile
PER_PULSE = 0.001  # deg
STEPS, STEP_S = 100, 0.01
HOME = [round(float(angle) / DEG / PER_PULSE) for angle in CELL.home]


def puma():
    """An export that stands at the home of the cell, with the geometry of its robot and hand."""
    arm = {
        "kind": "arm",
        "name": "puma560",
        "placements": [axis.placement.tolist() for axis in CELL.robot.axes],
        "X_last_flange": CELL.robot.X_last_flange.tolist(),
        "X_flange_tool": CELL.hand.X_flange_tool.tolist(),
    }
    return Handmade(arm, [(f"J{k}", "deg", PER_PULSE, at) for k, at in enumerate(HOME, start=1)])


def way(k):
    """The share of a move after step k of 100: a fifth of the time to speed up, a fifth to slow down."""
    if k <= 20:
        return k * k / 3200
    return (k - 10) / 80 if k <= 80 else 1 - (100 - k) ** 2 / 3200


def tool_mm(*turned_deg):
    q = np.array(HOME) * PER_PULSE + np.concatenate([turned_deg, np.zeros(6 - len(turned_deg))])
    return ((Kinematics(CELL.robot).forward(q * DEG) @ CELL.hand.X_flange_tool)[:3, 3] * 1e3).tolist()


def swing(line, export, by_deg):
    """J1 turns by so many degrees in a second: an arc over the straight line that the move claims to be."""
    turned = (export.at["J1"] - HOME[0]) * PER_PULSE
    export.move(
        line,
        tool_mm(turned),
        tool_mm(turned + by_deg),
        J1=[export.at["J1"] + round(by_deg / PER_PULSE * way(k)) for k in range(1, STEPS + 1)],
    )


def read(tmp_path, export):
    return read_export(export.write(tmp_path / "out"))


def sagitta_mm(by_deg):
    x, y, _ = tool_mm()
    return math.hypot(x, y) * (1.0 - math.cos(by_deg / 2.0 * DEG))


@pytest.mark.physics
@pytest.mark.parametrize("physics", [True, False], ids=["mujoco", "rigid"])
def test_the_arm_follows_the_tables(tmp_path, physics):
    """The tool point is off the chord by the height of the arc, as the tables are, and comes to its end."""
    export = puma()
    export.load(1)
    export.hand(2, "off")
    swing(3, export, 10.0)
    swing(4, export, -10.0)
    found = read(tmp_path, export)
    result = drive(found, CELL, PROFILE, physics)
    assert (result.alarms, result.warnings) == ((), ())
    assert [(move.line, move.number, move.text) for move in result.moves] == [(3, 30, "MOVE P1"), (4, 40, "MOVE P1")]
    for driven, played in zip(result.moves, replay(found), strict=True):
        assert played.rows_mm == pytest.approx(sagitta_mm(10.0), abs=0.02)
        assert driven.error_mm == pytest.approx(sagitta_mm(10.0), abs=0.2)
        assert driven.end_mm < 0.1
        assert STEPS * STEP_S < driven.seconds < STEPS * STEP_S + 0.2
    assert result.seconds > 0.3 + 2 * STEPS * STEP_S


@pytest.mark.physics
def test_a_straight_line_is_driven_straight(tmp_path):
    """Tables of the inverse kinematics along 80 mm: what is left is the arm's own error, not that of an arc."""
    export = puma()
    export.load(1)
    kinematics, q = Kinematics(CELL.robot), np.array(HOME) * PER_PULSE * DEG
    X = np.tile(kinematics.forward(q), (STEPS, 1, 1))
    X[:, 1, 3] += [0.08 * way(k) for k in range(1, STEPS + 1)]
    targets = np.rint(kinematics.newton.follow(X, q) / DEG / PER_PULSE).astype(int)
    begin = tool_mm()
    export.move(
        2,
        begin,
        [begin[0], begin[1] + 80.0, begin[2]],
        **{f"J{axis}": column for axis, column in enumerate(targets.T.tolist(), start=1)},
    )
    found = read(tmp_path, export)
    (played,) = replay(found)
    assert played.worst_mm < 0.05  # pulses of 0.001 deg, and arcs between the rows
    (driven,) = drive(found, CELL, PROFILE).moves
    assert driven.error_mm < 0.5
    assert driven.end_mm < 0.1


def test_set_points_are_the_tables_every_eight_milliseconds(tmp_path):
    export = puma()
    export.move(1, (0, 0, 0), (1, 0, 0), J1=[HOME[0] + 100, HOME[0] + 300], J3=[HOME[2], HOME[2] - 50])
    found = read(tmp_path, export)
    rows = set_points(found, found.moves[0], 0.008) / DEG / PER_PULSE
    assert rows[:, 0] - HOME[0] == pytest.approx([80.0, 100.0 + 0.6 * 200.0, 300.0])  # 8, 16 and 20 ms
    assert rows[:, 2] - HOME[2] == pytest.approx([0.0, -30.0, -50.0])
    assert rows[:, 1] == pytest.approx([HOME[1]] * 3)


@pytest.mark.physics
def test_load_and_hand_are_carried_out_in_their_places(tmp_path, monkeypatch):
    done = []

    class Watched(Controller):
        def load(self, payload):
            done.append((self.time_us, self.statement.number, payload.mass, payload.cog.tolist()))
            super().load(payload)

        def hand(self, closed):
            done.append((self.time_us, self.statement.number, closed))
            super().hand(closed)

    monkeypatch.setattr("robolang.execution.rig.Controller", Watched)
    export = puma()
    export.load(1)
    export.hand(2, "off", dwell=0.1)
    swing(3, export, 5.0)
    export.hand(4, "on", dwell=0.2)
    export.load(5, mass=1.0, cog=(0, 0, 70))
    result = drive(read(tmp_path, export), CELL, PROFILE)
    closed_at = done[2][0]
    assert done == [
        (0, 10, 0.8, [0, 0, 0.06]),
        (0, 20, False),
        (closed_at, 40, True),
        (closed_at + 200_000, 50, 1.0, [0, 0, 0.07]),
    ]
    assert result.seconds == pytest.approx((closed_at + 200_000) / 1e6)
    # 0.1 s in whole cycles, the way to the first set-point, the move until it is in position
    assert closed_at / 1e6 == pytest.approx(0.104 + RAMP_S + result.moves[0].seconds, abs=0.1)


@pytest.mark.physics
def test_an_arm_with_the_wrong_load_does_not_come_into_position(tmp_path):
    export = puma()
    export.load(1, mass=2.5, cog=(200, 0, 200))
    swing(2, export, 5.0)
    result = drive(read(tmp_path, export), CELL, PROFILE)
    (move,) = result.moves
    assert move.seconds == pytest.approx(STEPS * STEP_S + 0.4, abs=0.1)
    (warning,) = result.warnings
    assert (warning.code, warning.statement) == ("RBL523", ProgramLine(line=2, number=20))
    assert move.end_mm > 0.3


@pytest.mark.physics
def test_an_alarm_ends_the_drive_at_its_move(tmp_path):
    """3 deg in a hundredth of a second: 300 deg/s at once, more than any axis of the arm can do."""
    export = puma()
    export.load(1)
    swing(2, export, 2.0)
    export.max_hz = 1e6
    there = export.at["J1"]
    export.move(3, tool_mm(2.0), tool_mm(50.0), J1=[there + 3000 * k for k in range(1, 17)])
    swing(4, export, 2.0)
    result = drive(read(tmp_path, export), CELL, PROFILE)
    assert [alarm.statement for alarm in result.alarms] == [ProgramLine(line=3, number=30)]
    assert result.alarms[0].code in ("RBL511", "RBL512", "RBL513", "RBL516")
    assert [move.line for move in result.moves] == [2, 3]
    assert result.moves[1].seconds < 0.3
    assert result.seconds == pytest.approx(result.alarms[0].tick * result.tick_s, abs=0.02)


# --- what is refused -------------------------------------------------------------------------------------------------


def turned(X, by=1e-6):
    c, s = math.cos(by), math.sin(by)
    return (np.array(X) @ np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])).tolist()


def other_kind(export):
    export.mechanism = {"kind": "scara", "name": "s", "axes": ["theta1", "theta2"], "l1_mm": 1, "l2_mm": 1, "z_mm": 1}
    export.channels = export.channels[:2]
    export.at = dict(list(export.at.items())[:2])


def fewer_axes(export):
    export.mechanism["placements"].pop()
    export.channels.pop()


def other_arm(export):
    export.mechanism["placements"][3] = turned(export.mechanism["placements"][3])


def other_flange(export):
    export.mechanism["X_last_flange"][2][3] += 1e-6


def other_tool(export):
    export.mechanism["X_flange_tool"] = turned(export.mechanism["X_flange_tool"])


def out_of_range(export):
    export.channels[0] = ("J1", "deg", PER_PULSE, 400_000)


MISMATCHES = [
    (other_kind, "puma560"),
    (fewer_axes, "5 puma560 6"),
    (other_arm, "J4 puma560 1e-06"),
    (other_flange, "puma560"),
    (other_tool, "puma560"),
    (out_of_range, "J1 400.000 deg -160 160"),
]


@pytest.mark.parametrize(("change", "said"), MISMATCHES, ids=[said for _, said in MISMATCHES])
def test_tables_of_another_robot_are_refused(tmp_path, monkeypatch, change, said):
    monkeypatch.setattr("robolang.execution.rig.Controller", lambda *_: pytest.fail("something moved"))
    export = puma()
    change(export)
    with pytest.raises(Fault) as caught:
        drive(read(tmp_path, export), CELL, PROFILE)
    assert caught.value.code == "RBL634"
    assert set(said.split()) <= fields(caught.value.message)


def test_a_difference_of_rounding_is_none(tmp_path):
    export = puma()
    export.mechanism["placements"][3] = turned(export.mechanism["placements"][3], 1e-10)
    assert start_angles(read(tmp_path, export), CELL) == pytest.approx(np.array(HOME) * PER_PULSE * DEG)


def test_a_load_that_no_arm_carries_and_a_run_without_end_are_refused_before_anything_moves(tmp_path, monkeypatch):
    monkeypatch.setattr("robolang.execution.rig.Controller", lambda *_: pytest.fail("something moved"))
    export = puma()
    export.load(1, mass=2.6)
    with pytest.raises(Fault) as caught:
        drive(read(tmp_path, export), CELL, PROFILE)
    assert caught.value.code == "RBL402"
    export = puma()
    for line in range(1, 5):
        export.hand(line, "on", dwell=500.0)
    with pytest.raises(Fault) as caught:
        drive(read(tmp_path, export), CELL, PROFILE)
    assert caught.value.code == "RBL509"


@pytest.mark.physics
def test_another_home_of_the_cell_does_not_matter(tmp_path):
    """The arm stands where the tables start, not at the home of the cell."""
    export = puma()
    export.load(1)
    swing(2, export, 1.0)
    other = replace(CELL, home=CELL.home + 0.3)
    first, second = (drive(read(tmp_path, export), cell, PROFILE).moves[0] for cell in (CELL, other))
    assert first == second
