"""Touches on made-up contacts: what is allowed, what is measured, and numbers that are none."""

import re

import numpy as np
import pytest

from runtime.core.program_line import ProgramLine
from runtime.plant.touches import GAP, LOST_CYCLES, SETTLING, Bodies, Touches
from tests.messages import fields

PADS = {("pad_left", "part:a"), ("pad_right", "part:a")}
TABLE = {("obstacle:table", "part:a"), ("obstacle:table", "part:b")}


class Cell:
    """Two parts of 40 mm on a table and a tool, moved by hand, one cycle of 8 ticks after the other."""

    def __init__(self):
        self.bodies = Bodies(
            names=("a", "b"),
            size=np.full((2, 3), 0.04),
            p=np.zeros((2, 3)),
            R=np.tile(np.eye(3), (2, 1, 1)),
            p_tool=np.zeros(3),
            R_tool=np.eye(3),
            pad_length=0.04,
        )
        self.tick, self.line, self.pressed = 0, 10, ("a",)
        self.touches = Touches(self.bodies, lambda: self.pressed)
        self.run(())

    def run(self, pairs, cycles=1):
        lost = None
        for _ in range(cycles):
            found = frozenset(tuple(sorted(pair)) for pair in pairs)
            lost = self.touches.cycle(self.tick, ProgramLine(line=self.line), found) or lost
            self.tick += 8
        return lost

    def grip(self):
        self.touches.hand(True, None)
        assert self.run(PADS, SETTLING + 1) is None

    @property
    def found(self):
        return [(touch.place.line, touch.by[0], touch.what) for touch in self.touches.records if touch.noticed]


@pytest.mark.parametrize("away", [0.021, np.nan])
def test_a_part_that_has_moved_in_the_hand_is_lost(away):
    cell = Cell()
    cell.grip()
    cell.line = 20
    cell.bodies.p[0, 2] = away
    lost = cell.run(PADS)
    assert (lost.part, lost.place.line, lost.gripped.line) == ("a", 20, 10)
    assert cell.run(PADS, 50) is None  # once


def test_what_the_arm_carries_is_where_it_was_in_the_hand():
    cell = Cell()
    cell.grip()
    turned = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    cell.bodies.p_tool[:], cell.bodies.p[0] = (0.3, 0.0, 0.5), (0.3, 0.0, 0.5)
    cell.bodies.R_tool[:], cell.bodies.R[0] = turned, turned
    assert cell.run(PADS, 10) is None
    assert cell.found == []


def test_the_line_of_a_loss_is_that_in_which_the_pads_let_go():
    cell = Cell()
    cell.grip()
    cell.line, began = 20, cell.tick
    assert cell.run((), LOST_CYCLES - 1) is None
    cell.line = 30
    cell.bodies.p[0, 2] = -0.001
    lost = cell.run(())
    assert (lost.place.line, lost.tick) == (20, began)


def test_the_hand_aligns_a_part_as_long_as_its_statement_waits():
    cell = Cell()
    cell.touches.hand(True, ProgramLine(line=10))
    for _ in range(30):
        cell.bodies.p[0, 1] += 0.001
        assert cell.run(PADS | TABLE) is None
    assert cell.found == []
    cell.line = 20
    cell.run(PADS | TABLE)
    cell.bodies.p[0, 1] += 0.001
    assert cell.run(PADS | TABLE) is None
    assert cell.found == [(20, "part:a", "obstacle:table")]


def test_a_part_that_escapes_the_closing_hand_was_never_held():
    cell = Cell()
    cell.touches.hand(True, ProgramLine(line=10))
    cell.run(PADS, 10)
    cell.run((), 10)
    cell.line = 20
    cell.bodies.p_tool[2] += 0.3
    assert cell.run((), 10) is None


@pytest.mark.parametrize(("by", "blocked"), [("pad_left", True), ("part:a", False)])
def test_what_stops_the_drives_is_said_though_it_has_not_moved(by, blocked):
    cell = Cell()
    cell.grip()
    cell.run(PADS | {(by, "part:b")})
    assert cell.found == []
    cell.touches.blocked()
    assert cell.found == ([(10, by, "part:b")] if blocked else [])
    if blocked:
        assert re.search(r"left finger.*\bb\b", cell.touches.records[0].message)


def test_what_was_touched_before_did_not_stop_the_drives():
    cell = Cell()
    cell.run({("palm", "part:b")})
    cell.run((), 2)
    cell.touches.blocked()
    assert cell.found == []


def test_pads_that_jump_back_from_a_part_have_not_lost_it():
    cell = Cell()
    cell.grip()
    assert cell.run((), 20) is None
    assert cell.run(PADS) is None


def test_a_hand_that_has_let_go_loses_nothing():
    cell = Cell()
    cell.grip()
    cell.touches.hand(False, None)
    cell.bodies.p[0, 2] = -0.3
    assert cell.run(PADS) is None
    assert cell.found == []
    cell.run((), 2)  # it rests
    cell.run({("pad_left", "part:a")})
    cell.bodies.p[0, 1] += 0.002
    cell.run({("pad_left", "part:a")})
    assert cell.found == [(10, "pad_left", "part:a")]


@pytest.mark.parametrize("gripped", [True, False])
def test_what_a_closing_finger_pushes_is_its_grasp_only_where_it_ends_in_one(gripped):
    cell = Cell()
    cell.touches.hand(True, None)
    for _ in range(5):
        cell.bodies.p[0, 1] += 0.001
        cell.run({("pad_left", "part:a")})
    cell.run(PADS if gripped else (), 3)
    assert cell.found == ([] if gripped else [(10, "pad_left", "part:a")])


def test_a_part_on_which_pads_only_stand_is_not_held():
    cell = Cell()
    cell.pressed = ()
    cell.grip()
    cell.bodies.p_tool[2] = 0.3
    assert cell.run(PADS, 5) is None
    assert cell.found == []


@pytest.mark.parametrize(("moved", "noticed"), [(0.4e-3, False), (0.6e-3, True), (np.nan, True)])
@pytest.mark.parametrize("by", ["link4", "palm", "pad_left", "shank_right"])
def test_half_a_millimetre_is_the_bound_of_a_push(by, moved, noticed):
    cell = Cell()
    cell.bodies.p[1, 0] = moved
    cell.run({(by, "part:b")})
    assert cell.found == ([(10, by, "part:b")] if noticed else [])


@pytest.mark.parametrize(("slid", "noticed"), [(0.4e-3, False), (0.6e-3, True), (np.nan, True)])
def test_half_a_millimetre_is_the_bound_of_a_slide(slid, noticed):
    cell = Cell()
    cell.grip()
    cell.run(PADS | TABLE)
    if np.isnan(slid):
        cell.bodies.R[0] = slid
    else:
        cell.bodies.p[0, 0] += slid
        cell.bodies.p_tool[0] += slid
    cell.run(PADS | TABLE)
    assert cell.found == ([(10, "part:a", "obstacle:table")] if noticed else [])


def test_parts_on_the_table_and_on_one_another_are_no_touch():
    cell = Cell()
    cell.bodies.p[1, 0] = 0.01  # by itself
    cell.run(TABLE | {("part:a", "part:b")}, 5)
    assert cell.touches.records == []


def test_the_arm_strikes_what_is_fixed_once_for_a_statement():
    cell = Cell()
    cell.run({("link3", "floor"), ("palm", "floor")}, 3)
    cell.run(())
    cell.run({("link3", "floor")})
    cell.line = 20
    cell.run({("link3", "floor")})
    assert cell.found == [(10, "link3", "floor"), (20, "link3", "floor")]


def test_a_turn_about_its_centre_counts_by_its_corners():
    cell = Cell()
    angle = 0.02
    cell.bodies.R[1, :2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    cell.run({("link4", "part:b")})
    (touch,) = cell.touches.records
    assert (touch.moved, touch.turned) == (0.0, pytest.approx(angle))
    assert touch.reach == pytest.approx(2.0 * np.sin(angle / 2.0) * np.hypot(0.02, 0.02))
    assert {"4", "0.0", "mm", "1.1", "deg"} <= fields(touch.message)


def test_a_push_ends_when_the_part_rests():
    cell = Cell()
    cell.run({("palm", "part:b")})
    for _ in range(GAP + 5):  # it slides on by itself
        cell.bodies.p[1, 0] += 0.001
        cell.run(())
    cell.run((), 2)
    cell.bodies.p[1, 0] = 1.0
    cell.run(())
    (touch,) = cell.touches.records
    assert touch.moved == pytest.approx(0.001 * (GAP + 5))


def test_another_link_that_pushes_the_part_in_the_hand():
    cell = Cell()
    cell.grip()
    cell.bodies.p[0, 2] += 0.5
    cell.bodies.p_tool[2] += 0.5
    cell.run(PADS | {("link2", "part:a")})
    assert cell.found == []
    cell.bodies.p[0, 2] += 0.002
    cell.run(PADS | {("link2", "part:a")})
    assert cell.found == [(10, "link2", "part:a")]
