from pathlib import Path

import pytest

from robolang.effects import MoveTo, SetHand, SetPayload, SetSeam, SetWrist
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
    assert (move.wrist, move.held) == (None, ())


def test_wrist_and_seam_are_effects_with_places():
    text = "' x\nwrist hold rotation, tilt\n20 WRIST KEEP\nWRIST AUTO\n40 SEAM ON, Torch\nSEAM OFF"
    effects = list(execute(parsed(text)))
    assert [type(effect) for effect in effects] == [SetWrist, SetWrist, SetWrist, SetSeam, SetSeam]
    hold, keep, auto, on, off = effects
    assert (hold.mode, hold.held) == ("auto", ("ROTATION", "TILT"))
    assert (keep.mode, keep.held, auto.mode, auto.held) == ("keep", (), "auto", ())
    assert (on.sensor, off.sensor) == ("TORCH", None)
    assert [(effect.line, effect.number) for effect in effects] == [(2, None), (3, 20), (4, None), (5, 40), (6, None)]
    assert [source(text).slice(effect.span) for effect in effects][:2] == ["wrist hold rotation, tilt", "WRIST KEEP"]
    assert [describe(effect.node) for effect in effects][3:] == ["SEAM ON, Torch", "SEAM OFF"]


def wrists(text):
    """Mode and held components of each move of a program."""
    return [(effect.wrist, effect.held) for effect in execute(parsed(text)) if isinstance(effect, MoveTo)]


def test_wrist_holds_for_the_moves_that_follow_until_changed():
    text = "MOVE A\nWRIST KEEP\nMOVE A\nHAND ON\nMOVE A\nWRIST HOLD TILT, ADVANCE\nMOVE A, SPEED 5\nWRIST AUTO\nMOVE A"
    held = ("auto", ("TILT", "ADVANCE"))
    assert wrists(text) == [(None, ()), ("keep", ()), ("keep", ()), held, ("auto", ())]


def test_the_option_wins_for_its_move_only():
    text = "MOVE A, WRIST KEEP\nMOVE A\nWRIST HOLD TILT\nMOVE A, WRIST KEEP\nMOVE A\n"
    text += "MOVE A, WRIST HOLD ROTATION, TIME 2"
    tilt = ("auto", ("TILT",))
    assert wrists(text) == [("keep", ()), (None, ()), ("keep", ()), tilt, ("auto", ("ROTATION",))]
    *_, last = execute(parsed(text))
    assert last.time_s == 2.0


def test_each_run_starts_without_a_wrist_setting():
    program = parsed("MOVE A\nWRIST KEEP")
    assert [move.wrist for move, _ in (execute(program), execute(program))] == [None, None]


def test_nothing_is_computed_ahead():
    steps = execute(parse(source("MOVE P1\nMOV P2")).program)
    assert next(steps).point == "P1"
    with pytest.raises(ValueError, match="line 2"):
        next(steps)


def test_a_name_without_a_value_is_misuse():
    with pytest.raises(ValueError, match="line 1"):
        next(execute(parsed("HAND ON, t")))
