"""The quick computation of the tool point against the poses of the tool."""

import numpy as np
import pytest

from robolang.logs.log import Log
from tests.robolang.logs.made import NAN, PLAIN, log, meta, recorder


@pytest.mark.parametrize("name", ["q_cmd", "q_link"])
@pytest.mark.parametrize("span", [(0, 0), (0, 1), (0, 203), (17, 130)])
def test_points_are_those_of_the_poses_with_the_tool_that_is_in_use(name, span):
    made = log(203, PLAIN)
    poses = {"q_cmd": "tool_cmd", "q_link": "X_world_tool"}
    expected = made.span(poses[name], *span)
    expected = expected if name == "q_cmd" else expected[:, :3, 3]
    found = made.tool_points(name, *span)
    assert found.shape == expected.shape and np.abs(found - expected).max(initial=0.0) <= 1e-14
    assert len(made.rows.tools) > 1


def test_points_of_single_ticks_have_the_tool_of_their_tick():
    made, ticks = log(203, PLAIN), np.arange(3, 203, 9)
    found = made.points_at(made["q_link"][ticks], ticks)
    assert np.abs(found - made["X_world_tool"][ticks, :3, 3]).max() <= 1e-14
    assert len(np.unique(made.rows.read("tool", 0, made.rows.cycles))) > 1
    assert made.points_at(made["q_link"][:0], ticks[:0]).shape == (0, 3)


def test_the_flange_counts():
    about = meta()
    about["robot"]["flange"] = [[0, -1, 0, 0.1], [1, 0, 0, 0.2], [0, 0, 1, 0.3], [0, 0, 0, 1]]
    made = Log(recorder(64, PLAIN).recorded(), about)
    assert np.abs(made.tool_points("q_cmd", 0, 64) - made["tool_cmd"]).max() <= 1e-14


def test_an_angle_that_is_no_number_spoils_its_own_row_alone():
    """One of 40 numbers that go through the axes is NaN."""
    made = log(64, np.append(np.linspace(-1.0, 1.0, 39), NAN))
    found, expected = made.tool_points("q_link", 0, 64), made["X_world_tool"][:, :3, 3]
    assert np.array_equal(np.isfinite(found), np.isfinite(expected)) and 0 < np.isnan(found[:, 0]).sum() < 64
