"""G-code as moves of this language, the look-ahead that they are compared with, and what the campaign finds."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tests.bench import gcode_campaign
from tests.bench.gcode import INCH, NOTHING_MM, read
from tests.bench.gcode_campaign import FOLDER, MOST_MOVES, examine, named_folder, off_path, programs, task
from tests.bench.gcode_words import UnsupportedError, Words
from tests.bench.lookahead import Stretch, seconds
from tests.campaign import WHOLE
from tests.together import together

MM_PROGRAM = "G21\nF600\n"
ENDS: dict[str, list[tuple[float, ...]]] = {
    "G1 X10 Y-2.5 z1.": [(10, -2.5, 1)],
    "G1 X10\nY5\nG91 X1\nY-1": [(10, 0, 0), (10, 5, 0), (11, 5, 0), (11, 4, 0)],
    "G20\nG1 X1": [(INCH, 0, 0)],
    "#1=2\n#<far side>=[#1+3**2*2]\nG0 X#<far side> Y[-#1] Z[sin[30]/2-1.5MOD1]": [(20, -2, -0.25)],
    "#1=5 \nG0 X#1 (not X9)\n/G0 X1\n%\nG0 X7 ; nor X8\nM2\nG0 X1": [(5, 0, 0), (7, 0, 0)],
    "#1=1\n#1=2 #2=#1\nG0 X#1 Y#2": [(2, 1, 0)],
    "G90.1\nG1 X10\nG3 X0 Y10 I0 J0": [(10, 0, 0), (0, 10, 0)],
}
"""Texts, and where their moves end, mm."""
ARCS = {
    "X10\nG3 X0 Y10 I-10 J0": (math.sqrt(50), math.sqrt(50), 0),
    "X10\nG3 X0 Y10 R10": (math.sqrt(50), math.sqrt(50), 0),
    "X10\nG2 X0 Y10 R10": (10 - math.sqrt(50), 10 - math.sqrt(50), 0),
    "X10\nG18 G2 X0 Z10 I-10 K0": (math.sqrt(50), 0, math.sqrt(50)),
    "Y10\nG19 G3 Y0 Z10 J-10 K0": (0, math.sqrt(50), math.sqrt(50)),
}
"""Arcs of a quarter, and the middle of each, mm."""
REFUSED = ("G33 Z1 K1", "G1 A5", "o100 sub", "X5", "G1 F0 X1", "G81 Z1", "G2 X0 Y0 R5", "G1 X[1+")
A, V = 2.0, 0.3


@together("text", ENDS)
def test_moves_end_where_the_program_says(text):
    np.testing.assert_allclose([cut.end for cut in read(MM_PROGRAM + text)], ENDS[text], atol=1e-9)


@together("text", ARCS)
def test_an_arc_passes_its_middle(text):
    _, arc = read(MM_PROGRAM + "G1 " + text)
    np.testing.assert_allclose(arc.via, ARCS[text], atol=1e-9)


@together("text", REFUSED)
def test_what_has_no_counterpart_is_refused(text):
    with pytest.raises(UnsupportedError):
        read(MM_PROGRAM + text)


def test_feeds_and_tolerances_hold_until_they_are_changed():
    text = "G21 F600\nG0 X1\nG1 X2\nG64 P0.2 X3\nG61 X4\nG64 X5\nG4 P1\nX6 F60"
    found = [(cut.feed, cut.tolerance) for cut in read(text)]
    assert found == [(None, None), (10, None), (10, 0.2), (10, 0), (10, 0), (1, None)]


def test_a_helix_and_a_whole_circle_become_pieces_that_stay_on_it():
    helix = read("G21 F600\nG1 X10\nG3 X10 Y0 Z6 I-10 J0 P2")[1:]
    assert len(helix) == 144
    assert all(cut.via is None for cut in helix)
    points = np.array([cut.end for cut in helix])
    np.testing.assert_allclose(np.hypot(points[:, 0], points[:, 1]), 10.0)
    np.testing.assert_allclose(points[:, 2], np.linspace(0, 6, 145)[1:])
    circle = read("G21 F600\nG1 X10\nG2 I-10")[1:]
    third = 2 * math.pi / 3
    at = [(10 * math.cos(turn), -10 * math.sin(turn), 0) for turn in np.arange(0.5, 3.5, 0.5) * third]
    np.testing.assert_allclose([each for cut in circle for each in (cut.via, cut.end)], at, atol=1e-9)


def test_words_of_a_line_are_read_in_any_order():
    words = Words("x1g1y-2f3g90.1m30", {})
    assert (words.g, words.m) == ([1.0, 90.1], [30.0])
    assert words.values == {"x": 1.0, "y": -2.0, "f": 3.0}


def line(*points, speed=V, zone=0.0):
    return Stretch(points=np.array(points, dtype=float), speed=speed, zone=zone)


def test_the_look_ahead_takes_the_times_that_can_be_worked_out_by_hand():
    one = line((0, 0, 0), (0.5, 0, 0))
    assert seconds([one], A) == pytest.approx(0.5 / V + V / A)
    # two pieces of one line are that line, with a zone; two lines with a stop between them without
    halves = line((0, 0, 0), (0.25, 0, 0), zone=0.01), line((0.25, 0, 0), (0.5, 0, 0))
    assert seconds(halves, A) == pytest.approx(seconds([one], A))
    stop = line((0, 0, 0), (0.25, 0, 0)), halves[1]
    assert seconds(stop, A) == pytest.approx(2 * (0.25 / V + V / A))
    # a square corner: down to the speed of its parabola, along the chord, and up again
    corner = line((0, 0, 0), (0.25, 0, 0), zone=0.01), line((0.25, 0, 0), (0.25, 0.25, 0))
    for c in (1.0, 2.0):
        slow = math.sqrt(c * A * 0.01 / math.sin(math.pi / 4))
        leg = (2 * V - slow) / A + (0.24 - (2 * V**2 - slow**2) / (2 * A)) / V
        chord = 0.02 * math.cos(math.pi / 4)
        peak = min(V, math.sqrt(slow**2 + A * chord))
        within = 2 * (peak - slow) / A + (chord - (peak**2 - slow**2) / A) / peak
        assert seconds(corner, A, c) == pytest.approx(2 * leg + within)


def test_an_arc_of_the_look_ahead_is_as_long_and_as_fast_as_it_can_be():
    arc = Stretch(points=np.array([(1, 0, 0), (math.sqrt(0.5), math.sqrt(0.5), 0), (0, 1, 0)]), speed=9.0, zone=0.0)
    assert arc.radius == pytest.approx(1.0)
    assert arc.length == pytest.approx(math.pi / 2)
    np.testing.assert_allclose(arc.direction(at_end=False), (0, 1, 0), atol=1e-12)
    np.testing.assert_allclose(arc.direction(at_end=True), (-1, 0, 0), atol=1e-12)
    slow = math.sqrt(A * 1.0)
    assert seconds([arc], A) == pytest.approx(math.pi / 2 / slow + slow / A)


def test_a_program_is_placed_into_the_box_and_keeps_its_shape():
    cuts = read("G21 F600\nG1 X1000\nX1000.0005\nG3 X0 Y0 I-500 J0\nG1 Z10")
    found = task(cuts)
    assert [len(each.points) for each in found.stretches] == [2, 3, 3, 2]  # a move of less than a micrometre is none
    points = 1000 * np.concatenate([each.points for each in found.stretches])
    assert (np.ptp(points, axis=0) <= gcode_campaign.BOX_MM + 1e-6).all()
    assert found.stretches[0].length == pytest.approx(0.24, abs=NOTHING_MM)
    assert found.text.count("\n") == 5


def test_own_programs_are_planned_within_their_zones_and_a_smaller_zone_is_noticed(monkeypatch):
    smaller = []

    def also_smaller(rehearsal, stretches):
        smaller.append(off_path(rehearsal, [replace(each, zone=0.1 * each.zone) for each in stretches]))
        return off_path(rehearsal, stretches)

    monkeypatch.setattr(gcode_campaign, "off_path", also_smaller)
    for name, cuts in programs(None):
        found = examine(name, cuts)
        assert (found.refused, found.off_mm <= 1e-6) == ("", True), found
        assert found.bound_s <= found.ideal_s <= found.seconds
    assert len(smaller) == 2
    assert max(smaller) > 1e-6  # in one of the two the tool hardly leaves its path


@pytest.mark.skipif(named_folder() is None, reason=f"{FOLDER} names no folder of programs")
def test_programs_at_hand_are_planned_within_their_zones():
    wrong = []
    for name, cuts in programs(named_folder()):
        if len(cuts) <= (MOST_MOVES if WHOLE else 30):
            found = examine(name, cuts)
            if found.refused or not found.off_mm <= 1e-6:
                wrong.append(str(found))
    assert not wrong, "\n".join(wrong)
