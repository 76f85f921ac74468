"""A run with NaN in it meets no expectation that compares a number, wherever the NaN stands."""

import math
from itertools import permutations
from types import SimpleNamespace

import numpy as np
import pytest

from robolang.testing.expectation import Expectation
from robolang.testing.golden import write_golden
from robolang.testing.verdict import judge
from runtime.core.tomlfile import Source
from runtime.robot.model.axis_kind import PRISMATIC, REVOLUTE

NAN = math.nan
MEASURES = ("path_deviation_mm", "tool_error_mm", "peak_torque_pct")
ROBOT = SimpleNamespace(axes=[SimpleNamespace(kind=REVOLUTE)] * 6)
SESSION = SimpleNamespace(
    project=SimpleNamespace(profile=SimpleNamespace(ticks_per_cycle=2, tick_s=1e-3), cell=SimpleNamespace(robot=ROBOT))
)
EXPECTED = {
    "warnings": (),
    "cycle_s": (0.0, 9.0),
    "printed": (),
    "path_error_mm": 9.0,
    "tool_error_mm": 9.0,
    "torque_pct": 99.0,
    "end_pose": (0.0,) * 6,
    "golden_deg": 1.0,
    "parts": {"box": (0.0, 0.0, 0.0)},
}
ALL = {
    "alarms",
    "warnings",
    "cycle",
    "printed",
    "path deviation",
    "tool error",
    "peak torque",
    "end",
    "end turn",
    "part box",
    "golden",
}


def judged(tmp_path, values=(1.0, 2.0, 3.0), seconds=1.0, box=0.0, q=0.0, X=()):
    """Return the names of the verdicts that are not met, of a run with these numbers."""
    rows = [dict.fromkeys(MEASURES, value) | {"line": k, "number": None} for k, value in enumerate(values, 1)]
    report = {
        "alarms": [],
        "warnings": [],
        "printed": [],
        "sim_time_s": seconds,
        "statements": rows,
        "objects": {"box": {"pose_mm_deg": [box] * 6}},
    }
    log = {
        "q_fb": np.zeros((8, 6)),
        "X_world_tool": np.tile(np.eye(4), (8, 1, 1)),
        "line": np.ones(8, dtype=int),
        "number": np.zeros(8, dtype=int),
    }
    log["q_fb"][5:, 2] = q
    for place in X:
        log["X_world_tool"][-1][place] = NAN
    expected = Expectation(source=Source(str(tmp_path / "a.test.toml"), "schema = 1\n[expect]\n"), **EXPECTED)
    write_golden(expected.golden, np.zeros((4, 6)), np.ones(4))
    found = judge(expected, SESSION, report, log)
    assert {verdict.name for verdict in found} == ALL
    return {verdict.name for verdict in found if not verdict.ok}


def test_a_run_of_numbers_meets_all(tmp_path):
    assert judged(tmp_path) == set()


@pytest.mark.parametrize("values", list(permutations((NAN, 1.0, 8.0))))
def test_a_statement_of_nan_is_over_every_limit(values, tmp_path):
    assert judged(tmp_path, values=values) == {"path deviation", "tool error", "peak torque"}


def test_a_time_a_place_and_angles_of_nan_are_not_as_expected(tmp_path):
    assert judged(tmp_path, seconds=NAN) == {"cycle"}
    assert judged(tmp_path, box=NAN) == {"part box"}
    assert judged(tmp_path, q=NAN) == {"golden"}


@pytest.mark.parametrize(("place", "bad"), [((0, 3), "end"), ((0, 0), "end turn"), ((2, 1), "end turn")])
def test_a_pose_of_nan_is_not_the_end(tmp_path, place, bad):
    assert judged(tmp_path, X=[place]) == {bad}


@pytest.mark.parametrize(
    ("given", "key", "turns", "slides"),
    [
        ({"golden_deg": 0.5}, "golden_deg", 0.5, 0.5),
        ({"golden_mm": 0.2}, "golden_mm", 0.2, 0.2),
        ({"golden_deg": 0.5, "golden_mm": 0.2}, "golden_deg", 0.5, 0.2),
        ({"golden_deg": 0.0, "golden_mm": 0.2}, "golden_deg", 0.0, 0.2),
        ({}, None, 0.0, 0.0),
    ],
)
def test_a_bound_that_is_left_out_has_the_number_of_the_other_unit(given, key, turns, slides):
    expected = Expectation(source=Source("a.test.toml", ""), **given)
    assert expected.golden_key == key
    assert (expected.golden_most(REVOLUTE), expected.golden_most(PRISMATIC)) == (turns, slides)
