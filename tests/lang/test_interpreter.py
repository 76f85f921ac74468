from pathlib import Path

import pytest

from robolang.effects import MoveTo, SetHand, SetPayload
from robolang.interpreter import execute
from robolang.parser import parse
from robolang.printer import describe
from tests.lang.helpers import parsed, source

LISTING = Path(__file__).parents[2] / "programs" / "pick_and_place.rbl"


def test_the_listing_in_order():
    program = parsed(LISTING.read_text(encoding="utf-8"))
    effects = list(execute(program))
    trace = [
        (e.mass_kg, e.cog_mm) if isinstance(e, SetPayload) else e.closed if isinstance(e, SetHand) else e.point
        for e in effects
    ]
    hand, part = (0.8, (0.0, 0.0, 60.0)), (2.3, (0.0, 0.0, 95.0))
    assert trace == [hand, False, "P1", True, part, "P2", "P3", False, hand, "P4", "P5"]
    assert [effect.number for effect in effects] == list(range(10, 111, 10))
    assert [effect.line for effect in effects] == list(range(4, 15))
    assert [describe(effect.node) for effect in effects][4] == "LOAD (0, 0, 95), 2.3"


def test_values_and_places():
    text = "' x\nMOVE pick, SPEED 200, ACCEL 5\n70 HAND ON, .5\nMOVE B, TIME --2"
    move, hand, timed = execute(parsed(text))
    assert isinstance(move, MoveTo)
    assert (move.point, move.speed_mm_s, move.accel_pct, move.time_s) == ("PICK", 200.0, 5.0, None)
    assert (move.line, move.number, source(text).slice(move.span)) == (2, None, "MOVE pick, SPEED 200, ACCEL 5")
    assert (hand.closed, hand.dwell_s, hand.line, hand.number) == (True, 0.5, 3, 70)
    assert timed.time_s == 2.0


def test_open_values_stay_open():
    move, hand = execute(parsed("MOVE P1\nHAND OFF"))
    assert (move.speed_mm_s, move.accel_pct, move.time_s, hand.dwell_s) == (None, None, None, None)


def test_nothing_is_computed_ahead():
    steps = execute(parse(source("MOVE P1\nMOV P2")).program)
    assert next(steps).point == "P1"
    with pytest.raises(ValueError, match="line 2"):
        next(steps)


def test_a_name_without_a_value_is_misuse():
    with pytest.raises(ValueError, match="line 1"):
        next(execute(parsed("HAND ON, t")))
