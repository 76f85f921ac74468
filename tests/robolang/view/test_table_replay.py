"""The machine of exported pulse tables stands where the tables have it."""

from dataclasses import replace

import numpy as np
import pytest

from robolang.view.table_replay import TableReplay
from runtime.appearance.stance import world_poses
from runtime.core.faults import Fault
from runtime.core.units import MM
from runtime.pulses.folder import read_export
from runtime.pulses.replay import positions, tool_points
from tests.runtime.pulses import Handmade, staircase, turntable


def scara():
    found = Handmade(
        {"kind": "scara", "name": "scara", "axes": ["theta1", "theta2", "z"], "l1_mm": 300.0, "l2_mm": 200.0},
        [("A", "deg", 0.05, 0), ("B", "deg", 0.05, 1000), ("Z", "mm", 0.01, 20000)],
    )
    q1, q2 = np.deg2rad(10.0), np.deg2rad(60.0)
    start = (300.0 + 200.0 * np.cos(np.deg2rad(50.0)), 200.0 * np.sin(np.deg2rad(50.0)), 200.0)
    end = (
        300.0 * np.cos(q1) + 200.0 * np.cos(q1 + q2),
        300.0 * np.sin(q1) + 200.0 * np.sin(q1 + q2),
        190.0,
    )
    found.move(1, start, end, A=[100, 200], B=[1100, 1200], Z=[19500, 19000])
    return found


def played(machine, folder):
    return read_export(machine.write(folder))


@pytest.mark.parametrize("machine", [staircase, turntable, scara])
def test_the_tool_is_where_a_plc_that_counts_the_pulses_has_it(machine, tmp_path):
    export = played(machine(), tmp_path / "a")
    replay = TableReplay(export)
    began = 0.0
    for item in export.sequence:
        # a marker lasts as long as its hand waits
        lasts = item.steps * export.step_s if item in export.moves else item.dwell_s
        if item in export.moves:
            for share in (0.0, 0.3, 0.999):
                pulses = positions(item, np.array([share * lasts]))
                tool = world_poses(replay.scene, replay.at(began + share * lasts))["tool"][:3, 3]
                np.testing.assert_allclose(tool, tool_points(export, pulses)[0], atol=1e-9)
        began += lasts
    assert replay.end == pytest.approx(began)


def test_while_a_hand_waits_the_machine_stands(tmp_path):
    export = played(staircase(), tmp_path / "a")
    replay = TableReplay(export)
    assert export.sequence[1].dwell_s > 0.1
    for time in (0.0, 0.1):
        np.testing.assert_allclose(replay.at(time).axes, np.array([100 * 0.01, -50 * 0.02]) * MM, atol=1e-12)


def test_tables_of_an_arm_and_tables_without_a_move_are_refused(tmp_path):
    bare = Handmade(
        {"kind": "cartesian", "name": "xy", "axes": ["x", "y"], "z_mm": 0.0},
        [("X", "mm", 0.01, 0), ("Y", "mm", 0.01, 0)],
    )
    with pytest.raises(Fault) as refused:
        TableReplay(played(bare, tmp_path / "a"))
    assert refused.value.code == "RBL832"
    export = played(staircase(), tmp_path / "b")
    with pytest.raises(Fault) as refused:
        TableReplay(replace(export, mechanism=replace(export.mechanism, kind="arm")))
    assert refused.value.code == "RBL832"
