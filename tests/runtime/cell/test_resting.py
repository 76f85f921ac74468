"""Parts that cannot lie where a cell puts them: RBL640 at their pose, and none where they can."""

import math
from pathlib import Path

import numpy as np
import pytest

from robolang.project.builtin import cell_text
from runtime.cell.cell_file import parse_cell_file, read_cell_file
from runtime.cell.resting import Box, overlap, unrest
from runtime.core.frames import pose_from_xyzrpy
from runtime.core.tomlfile import Source
from runtime.core.units import DEG

POSE = "pose_mm_deg = [{}]"


def cube(*pose, size=(100.0, 100.0, 100.0)):
    return Box.of("a box", size, pose)


def test_the_axes_of_a_box_are_those_of_its_pose():
    pose = (1.0, 2.0, 3.0, 20.0, -35.0, 110.0)
    rotation = pose_from_xyzrpy([0.0, 0.0, 0.0, *(np.array(pose[3:]) * DEG)])[:3, :3]
    assert np.allclose(np.array(cube(*pose).axes).T, rotation, atol=1e-12)


BAR = 20.0 * math.sqrt(2.0)
"""Height of a bar of 20 mm that stands on an edge, mm."""


@pytest.mark.parametrize(
    ("pose", "expected"),
    [
        ((0, 0, 90, 0, 0, 0), 10.0),
        ((0, 0, 100, 0, 0, 0), 0.0),
        ((95, 80, 0, 0, 0, 0), 5.0),
        ((50 + 50 * math.sqrt(2.0) - 3, 0, 0, 0, 0, 45), 3.0),
        ((50 + 50 * math.sqrt(2.0) + 3, 0, 0, 0, 0, 45), 0.0),
        ((0, 0, 500, 0, 0, 0), 0.0),
        ((10, 0, 0, 0, 0, 0), 90.0),
    ],
)
def test_the_overlap_of_two_boxes(pose, expected):
    assert overlap(cube(0, 0, 0, 0, 0, 0), cube(*pose)) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize(("gap", "expected"), [(-1.0, 1.0), (1.0, 0.0)])
def test_bars_that_cross_edge_over_edge(gap, expected):
    """No face of either is between them: only a product of edges shows the gap."""
    lower = cube(0, 0, 0, 45, 0, 0, size=(400.0, 20.0, 20.0))
    upper = cube(0, 0, BAR + gap, 0, 45, 0, size=(20.0, 400.0, 20.0))
    assert overlap(lower, upper) == pytest.approx(expected, abs=1e-9)


def can(*pose, size=(100.0, 100.0, 100.0)):
    return Box.of("a can", size, pose, is_round=True)


@pytest.mark.parametrize(
    ("pose", "other", "expected"),
    [
        ((0, 0, 90, 0, 0, 0), can, 10.0),
        ((70, 70, 0, 0, 0, 0), can, 100.0 - 70.0 * math.sqrt(2.0)),
        ((75, 75, 0, 0, 0, 0), can, 0.0),
        ((90, 90, 0, 0, 0, 0), cube, 0.0),
        ((80, 80, 0, 0, 0, 0), cube, 50.0 - 30.0 * math.sqrt(2.0)),
        ((0, 97, 0, 90, 0, 0), cube, 3.0),
        ((0, 0, 97, 90, 0, 0), can, 3.0),
        ((0, 0, 100 - 1, 0, 90, 0), cube, 1.0),
    ],
)
def test_the_overlap_with_a_cylinder(pose, other, expected):
    assert overlap(other(0, 0, 0, 0, 0, 0), can(*pose)) == pytest.approx(expected, abs=1e-9)
    assert overlap(can(*pose), other(0, 0, 0, 0, 0, 0)) == pytest.approx(expected, abs=1e-9)


def test_a_cylinder_rests_on_its_side_and_on_its_end():
    assert unrest(can(0, 0, 50, 0, 0, 0, size=(40.0, 40.0, 100.0)), [], []) == ""
    assert unrest(can(0, 0, 20, 30, 90, 0, size=(40.0, 40.0, 100.0)), [], []) == ""
    assert unrest(can(0, 0, 40, 0, 90, 0, size=(40.0, 40.0, 100.0)), [], [])


def test_a_box_that_is_nowhere_cannot_lie_there():
    assert unrest(cube(0, 0, math.nan, 0, 0, 0), [], [])


def found(pose, more=""):
    """What the built-in cell, whose table is 600 mm high, gives for a part of 60 x 40 x 80 mm at a pose."""
    text = cell_text()
    old = next(line for line in text[text.index("[[parts]]") :].splitlines() if line.startswith("pose_mm_deg"))
    cell = parse_cell_file(Source("cell.toml", text.replace(old, POSE.format(pose)) + more))
    return [(fault.code, fault.line - text.splitlines().index(old)) for fault in cell.warnings]


@pytest.mark.parametrize(
    ("pose", "wrong"),
    [
        ("480, -220, 640, 0, 0, 0", False),
        ("480, -220, 639.5, 0, 0, 30", False),
        ("480, -220, 630, 90, 0, 0", True),
        ("480, -220, 620, 90, 0, 0", False),
        ("480, -220, 600, 0, 0, 0", True),
        ("480, -220, 638.5, 0, 0, 0", True),
        ("480, -220, 644, 0, 0, 0", False),
        ("480, -220, 646, 0, 0, 0", True),
        ("1500, 0, 40, 0, 0, 0", False),
        ("1500, 0, 20, 0, 0, 0", True),
        ("1500, 0, 90, 0, 0, 0", True),
    ],
)
def test_a_part_in_the_table_in_the_floor_and_in_the_air(pose, wrong):
    assert found(pose) == ([("RBL640", 1)] if wrong else [])


SECOND = """
[[parts]]
name = "second"
size_mm = [60, 40, 80]
mass_kg = 1.5
pose_mm_deg = [{}]
"""


@pytest.mark.parametrize(
    ("second", "count"),
    [("480, -220, 720, 0, 0, 0", 0), ("490, -220, 640, 0, 0, 0", 1), ("540, -220, 640, 0, 0, 0", 0)],
)
def test_a_part_on_in_and_beside_another(second, count):
    assert len(found("480, -220, 640, 0, 0, 0", SECOND.format(second))) == count


def test_a_part_may_stand_on_one_that_the_file_names_later():
    assert found("480, -220, 720, 0, 0, 0", SECOND.format("480, -220, 640, 0, 0, 0")) == []


CELLS = sorted((Path(__file__).parents[3] / "programs").rglob("*cell.toml"))


@pytest.mark.parametrize("cell", CELLS, ids=[cell.name for cell in CELLS])
def test_the_parts_of_the_examples_lie_where_they_can(cell):
    assert read_cell_file(cell).warnings == ()
