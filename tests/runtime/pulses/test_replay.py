"""Playing pulse tables: what is sent, where the tool goes, how far it is off."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.pulses.exported import Marker, Move
from runtime.pulses.folder import read_export
from runtime.pulses.replay import distances, positions, replay, tool_points
from tests.campaign import examples
from tests.runtime.pulses import ARM, Y_TABLE, Handmade, pose, staircase, turntable

DEGREE = math.pi / 180.0


def replayed(tmp_path, export, **options):
    return replay(read_export(export.write(tmp_path / "out")), **options)


# --- what is read ----------------------------------------------------------------------------------------------------


def test_an_export_comes_back_as_it_was_written(tmp_path):
    export = read_export(staircase().write(tmp_path / "out"))
    assert (export.program, export.step_s, export.mechanism.kind) == ("by_hand.rbl", 0.01, "cartesian")
    x, y = export.channels
    assert (x.name, x.unit, x.per_pulse, x.min_hz, x.max_hz, x.start_pulses) == ("X", "mm", 0.01, 1.5, 1e5, 100)
    assert y.si_per_pulse == -2e-5
    load, hand, first, second = export.sequence
    assert isinstance(load, Marker)
    assert (load.line, load.number, load.text, load.hand) == (1, 10, "LOAD (0, 0, 60), 0.8", None)
    assert (load.load.mass, load.load.cog.tolist()) == (0.8, [0.0, 0.0, 0.06])
    assert (hand.hand, hand.dwell_s, hand.load) == ("off", 0.3, None)
    assert isinstance(first, Move)
    assert export.moves == (first, second)
    assert first.start == pytest.approx([1e-3, -1e-3, 0.12])
    assert first.end == pytest.approx([0.01, 0.011, 0.12])
    assert (first.first.tolist(), first.last.tolist()) == ([100, 50], [1000, -550])
    assert (second.first.tolist(), second.last.tolist()) == ([1000, -550], [900, -550])
    assert second.tables[1] is None
    table = first.tables[1]
    assert table.file == Y_TABLE
    assert table.frequency.tolist() == [0, -20000, 0, -20000, 0, -20000]
    assert table.ends == pytest.approx([0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06])
    assert table.pulses.tolist() == [50, 50, -150, -150, -350, -350, -550]
    assert export.seconds == pytest.approx(0.3 + 0.06 + 0.04)


def test_lines_without_a_number_and_windows_line_ends_are_read(tmp_path):
    export = staircase()
    export.sequence[2]["number"] = None
    folder = export.write(tmp_path / "out")
    for path in folder.iterdir():
        path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert read_export(folder).moves[0].number is None


def test_a_move_of_no_steps_is_read_and_played(tmp_path):
    export = staircase()
    export.move(5, (9, 11, 120), (9, 11, 121))
    last = replayed(tmp_path, export)[-1]
    assert (last.duration_s, last.counts, last.fastest) == (0.0, (0, 0), (0.0, 0))
    assert (last.rows_mm, last.between_mm, last.end_mm) == (pytest.approx(0.0, abs=1e-9), 0.0, pytest.approx(1.0))


# --- playing ---------------------------------------------------------------------------------------------------------


def test_pulses_are_frequency_times_time_within_each_row(tmp_path):
    (move, _) = read_export(staircase().write(tmp_path / "out")).moves
    t = np.array([0.0, 0.004, 0.01, 0.013, 0.02, 0.055, 0.06, 0.07])
    found = positions(move, t)
    assert found[:, 0] == pytest.approx([100, 100 + 30000 * 0.004, 400, 400, 400, 1000, 1000, 1000])
    assert found[:, 1] == pytest.approx([50, 50, 50, 50 - 20000 * 0.003, -150, -450, -550, -550])


def test_the_path_error_of_a_staircase_is_the_height_of_its_triangles(tmp_path):
    first, second = replayed(tmp_path, staircase())
    assert first.rows_mm == pytest.approx(3.0 * 4.0 / 5.0, abs=1e-9)
    assert first.between_mm == pytest.approx(0.75 * 3.0 * 4.0 / 5.0, abs=1e-9)
    assert first.end_mm == pytest.approx(0.0, abs=1e-9)
    assert first.worst_mm == first.rows_mm
    # up the side of a triangle along x, down again along y
    assert first.error_mm[:9] == pytest.approx([0.0, 0.6, 1.2, 1.8, 2.4, 1.8, 1.2, 0.6, 0.0], abs=1e-9)
    assert first.counts == (900, 600)
    assert first.frequency[:2].tolist() == [[30000, 0], [0, -20000]]
    assert first.fastest == (30000.0, 0)
    assert (first.duration_s, len(first.times)) == (pytest.approx(0.06), 25)
    assert second.worst_mm == pytest.approx(0.0, abs=1e-9)
    assert second.counts == (100, 0)
    assert second.frequency[:, 1].tolist() == [0.0] * 4


def test_an_arc_is_off_its_chord_between_the_rows_too(tmp_path):
    """Points at -10, -6.67, -3.33, 0, ... deg: r cos(angle) - r cos(10 deg) outside the chord."""
    (found,) = replayed(tmp_path, turntable(), samples_per_step=3)
    off = [300.0 * (math.cos(k / 3.0 * 10.0 * DEGREE) - math.cos(10.0 * DEGREE)) for k in range(-3, 4)]
    assert found.error_mm == pytest.approx(off, abs=1e-9)
    assert found.rows_mm == pytest.approx(300.0 * (1.0 - math.cos(10.0 * DEGREE)), abs=1e-9)
    assert found.between_mm == pytest.approx(off[2], abs=1e-9)
    assert found.points[3] == pytest.approx([0.3, 0.0, 0.05])
    assert found.counts == (400, 0)


def test_the_error_at_the_end_and_beyond_it_is_the_distance_from_the_end(tmp_path):
    export = staircase()
    export.sequence[3]["end_mm"] = [9.5, 11, 120]
    found = replayed(tmp_path, export)[1]
    assert found.end_mm == pytest.approx(0.5)
    assert found.rows_mm == pytest.approx(0.5)  # the last half millimetre is beyond the segment


def test_what_happens_between_the_rows_needs_a_sample_there(tmp_path):
    with pytest.raises(ValueError, match="rows"):
        replayed(tmp_path, staircase(), samples_per_step=1)


def test_distances_are_those_from_a_segment():
    points = np.array([[0.0, 1.0, 0.0], [-3.0, 4.0, 0.0], [5.0, 0.0, 4.0], [1.0, 0.0, 0.0]])
    assert distances(points, np.zeros(3), np.array([2.0, 0.0, 0.0])) == pytest.approx([1.0, 5.0, 5.0, 0.0])
    assert distances(points, np.ones(3), np.ones(3))[0] == pytest.approx(math.sqrt(2.0))


# --- mechanisms ------------------------------------------------------------------------------------------------------

C, S = math.cos(0.5), math.sin(0.5)
C2, S2 = math.cos(-0.8), math.sin(-0.8)
C12, S12 = math.cos(-0.3), math.sin(-0.3)
ANGLES = {"q1": 0.5 / DEGREE, "q2": -0.8 / DEGREE}
REACH = 0.4 + 0.3 * C2
MECHANISMS = [
    ({"kind": "cartesian", "axes": ["y"], "x_mm": 7.0, "z_mm": 120.0}, {"y": 20.0}, (0.007, 0.02, 0.12)),
    ({"kind": "cartesian", "axes": ["z", "x", "y"]}, {"z": 1.0, "x": 2.0, "y": 3.0}, (0.002, 0.003, 0.001)),
    ({"kind": "cylindrical", "axes": ["theta", "r", "z"]}, {"theta": 90.0, "r": 250.0, "z": -5.0}, (0, 0.25, -0.005)),
    (
        {"kind": "scara", "axes": ["theta1", "theta2"], "l1_mm": 400.0, "l2_mm": 300.0, "z_mm": 10.0},
        {"theta1": 0.5 / DEGREE, "theta2": -0.8 / DEGREE},
        (0.4 * C + 0.3 * C12, 0.4 * S + 0.3 * S12, 0.01),
    ),
    (
        {"kind": "scara", "axes": ["theta1", "theta2", "z", "theta4"], "l1_mm": 400.0, "l2_mm": 300.0},
        {"theta1": 0.0, "theta2": 90.0, "z": 33.0, "theta4": 77.0},
        (0.4, 0.3, 0.033),
    ),
    # the second axis turns about -y of the first: in its plane 0.3 m out, the tool 0.1 m along the axis
    (ARM, ANGLES, (C * REACH + S * 0.1, S * REACH - C * 0.1, 0.3 * S2)),
]


@pytest.mark.parametrize(("mechanism", "joints", "tool"), MECHANISMS)
def test_forward_kinematics(tmp_path, mechanism, joints, tool):
    units = ["mm" if name in ("x", "y", "z", "r") else "deg" for name in joints]
    channels = [(name, unit, value / 1e6 or 1.0, 0) for (name, value), unit in zip(joints.items(), units, strict=True)]
    export = Handmade({"name": "m", **mechanism}, channels)
    read = read_export(export.write(tmp_path / "out"))
    (found,) = tool_points(read, np.full((1, len(joints)), 1e6) * [value != 0.0 for value in joints.values()])
    assert found == pytest.approx(tool, abs=1e-12)


def test_an_arm_of_two_axes_is_replayed(tmp_path):
    """Both joints of a flat arm turn at once; the tool point is known in closed form at every time."""
    arm = {**ARM, "placements": [pose(), pose(0.4)]}
    export = Handmade(arm, [("J1", "deg", 0.01, 3000), ("J2", "deg", 0.01, -6000)])
    export.move(1, (500, 0, 100), (600, 0, 100), J1=[3100, 3300], J2=[-6000, -6500])
    (found,) = replayed(tmp_path, export)
    q1 = np.array([30.0, 30.25, 30.5, 30.75, 31.0, 31.5, 32.0, 32.5, 33.0]) * DEGREE
    q2 = np.array([-60.0] * 5 + [-61.25, -62.5, -63.75, -65.0]) * DEGREE
    x, y = 0.4 * np.cos(q1) + 0.3 * np.cos(q1 + q2), 0.4 * np.sin(q1) + 0.3 * np.sin(q1 + q2)
    assert found.points == pytest.approx(np.stack([x, y, np.full(9, 0.1)], axis=1), abs=1e-12)
    assert found.error_mm == pytest.approx(np.hypot(np.maximum(0.0, x - 0.6), y) * 1e3, abs=1e-9)
    assert found.end_mm == pytest.approx(np.hypot(x[-1] - 0.6, y[-1]) * 1e3)


WALK = st.lists(st.integers(-300, 300), min_size=1, max_size=30)


@examples(100)
@given(walks=st.tuples(WALK, WALK))
def test_any_walk_is_played_through_its_targets(tmp_path_factory, walks):
    """Positions at the row ends are the targets, pulses sent are the sum of all changes, whatever the walk."""
    steps = min(map(len, walks))
    targets = [np.cumsum(walk[:steps]).tolist() for walk in walks]
    export = Handmade(
        {"kind": "cartesian", "name": "xy", "axes": ["x", "y"], "z_mm": 0}, [("X", "mm", 0.01, 0), ("Y", "mm", 0.01, 0)]
    )
    export.move(1, (0, 0, 0), (1, 0, 0), X=targets[0], Y=targets[1])
    (found,) = replay(read_export(export.write(tmp_path_factory.mktemp("walk") / "out")), samples_per_step=2)
    for k, walk in enumerate(targets):
        assert found.pulses[::2, k] == pytest.approx([0, *walk], abs=1e-6)
        assert found.frequency[:, k].tolist() == [100 * (b - a) for a, b in pairwise([0, *walk])]
        assert found.counts[k] == sum(abs(b - a) for a, b in pairwise([0, *walk]))
