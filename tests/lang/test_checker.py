import pytest

from robolang.checker import check
from robolang.diagnostics import MAX_DIAGNOSTICS, Severity
from robolang.parser import parse
from robolang.source import Span
from tests.lang.helpers import checked, parsed, source


def first(text, **facts):
    (diagnostic,) = check(parsed(text), **facts)
    return diagnostic


def test_a_good_program_has_nothing():
    text = "10 LOAD (0, 0, 60), 0.8\n20 MOVE p1, SPEED 200, ACCEL 100\n30 HAND ON, 0\n40 MOVE P2, TIME 600"
    text += "\n50 WRIST HOLD TILT, ADVANCE\n60 SEAM ON, torch\n70 MOVE P1, WRIST HOLD ROTATION, TILT\n80 SEAM OFF"
    assert checked(text, points=("P1", "p2"), rated=2.5, sensors=("Torch",)) == []


@pytest.mark.parametrize("text", ["", "' nothing\n\n", "10\n"])
def test_an_empty_program_is_a_warning(text):
    diagnostic = first(text)
    assert (diagnostic.code, diagnostic.severity) == ("RBL201", Severity.WARNING)


def test_a_program_with_a_bad_line_is_not_empty():
    assert check(parse(source("MOV P1")).program) == ()


def test_points():
    assert checked("MOVE P9", points=("P1",)) == [("RBL301", 1, 6, 2)]
    assert checked("MOVE P9", points=()) == [("RBL301", 1, 6, 2)]
    assert checked("MOVE P9") == []


@pytest.mark.parametrize(
    ("points", "hint"),
    [(("PICK_1", "A"), "did you mean PICK_1?"), (("A", "B"), "taught: A, B"), ((), "no point is taught")],
)
def test_near_points_are_suggested(points, hint):
    assert first("MOVE PICK1", points=points).hint == hint


@pytest.mark.parametrize("mass", ["-1", "NAN", "inf", "-INF", "--NAN"])
def test_mass_must_be_a_mass(mass):
    assert checked(f"LOAD (0, 0, 0), {mass}", rated=5.0) == [("RBL401", 1, 17, len(mass))]


def test_rated_payload():
    assert checked("LOAD (0, 0, 60), 2.5", rated=2.5) == []
    assert checked("LOAD (0, 0, 60), 9999") == []
    diagnostic = first("LOAD (0, 0, 60), 2.6", rated_payload_kg=2.5)
    assert diagnostic.code == "RBL402"
    assert "2.6 kg" in diagnostic.message
    assert "2.5 kg" in diagnostic.message
    assert first("LOAD (0, 0, 60), 800", rated_payload_kg=2.5).hint == "LOAD takes kg: 800 g is 0.8 kg"


@pytest.mark.parametrize("cog", ["(0, 0, 2001)", "(0, NAN, 0)", "(INF, 0, 0)", "(1E308, 1E308, 0)", "(-1500, 1500, 0)"])
def test_centre_of_gravity(cog):
    assert checked(f"LOAD {cog}, 1") == [("RBL403", 1, 6, len(cog))]


def test_centre_of_gravity_at_the_limit():
    assert checked("LOAD (0, 0, 2000), 1") == []
    assert checked("LOAD (0, 0, 9000), 0") == []
    assert checked("LOAD (0, 0, NAN), 0") == [("RBL403", 1, 6, 11)]


@pytest.mark.parametrize(
    "option",
    ["SPEED 0", "SPEED -5", "SPEED NAN", "SPEED INF", "SPEED 10000.1", "ACCEL 0", "ACCEL 100.1", "ACCEL NAN",
     "TIME 0", "TIME -1", "TIME 600.1", "TIME NAN"],
)  # fmt: skip
def test_option_out_of_range(option):
    value = option.split()[1]
    assert checked(f"MOVE P1, {option}") == [("RBL404", 1, 16 - (option[0] == "T"), len(value))]


@pytest.mark.parametrize("option", ["SPEED 10000", "SPEED 0.001", "ACCEL 100", "TIME 600"])
def test_option_at_the_limit(option):
    assert checked(f"MOVE P1, {option}") == []


@pytest.mark.parametrize("dwell", ["-1", "600.1", "1E12", "NAN", "INF"])
def test_dwell_out_of_range(dwell):
    assert checked(f"HAND OFF, {dwell}") == [("RBL405", 1, 11, len(dwell))]


def test_dwell_at_the_limit():
    assert checked("HAND OFF, 0\nHAND ON, 600") == []


def test_options_twice_and_against_each_other():
    assert checked("MOVE P1, SPEED 1, SPEED 2") == [("RBL118", 1, 19, 7)]
    assert checked("MOVE P1, TIME 1, SPEED 2") == [("RBL119", 1, 18, 7)]
    (diagnostic,) = check(parsed("MOVE P1, SPEED 1, speed 2"))
    assert diagnostic.message == "SPEED is given twice"
    assert diagnostic.related[0].span.start == 9


def test_wrist_twice_in_a_move():
    assert checked("MOVE P1, WRIST KEEP, SPEED 1, WRIST AUTO") == [("RBL118", 1, 31, 10)]
    assert checked("MOVE P1, WRIST HOLD TILT, WRIST HOLD TILT") == [("RBL118", 1, 27, 15)]
    diagnostic = first("MOVE P1, WRIST KEEP, WRIST KEEP")
    assert diagnostic.message == "WRIST is given twice"
    assert diagnostic.related[0].span == Span(9, 19)


@pytest.mark.parametrize("lead", ["", "MOVE P1, ", "MOVE P1, SPEED 5, "])
def test_components_twice_and_too_many(lead):
    at = len(lead) + 12
    assert checked(f"{lead}WRIST HOLD TILT, TILT") == [("RBL118", 1, at + 6, 4)]
    assert checked(f"{lead}WRIST HOLD TILT, ADVANCE, TILT") == [("RBL118", 1, at + 15, 4)]
    assert checked(f"{lead}WRIST HOLD TILT, TILT, ADVANCE") == [("RBL118", 1, at + 6, 4)]
    assert checked(f"{lead}WRIST HOLD TILT, ADVANCE, ROTATION") == [("RBL120", 1, at + 15, 8)]
    assert checked(f"{lead}WRIST HOLD TILT, ADVANCE, ROTATION, ROTATION") == [
        ("RBL120", 1, at + 15, 8), ("RBL118", 1, at + 25, 8),
    ]  # fmt: skip


def test_messages_about_components():
    twice = first("WRIST HOLD tilt, Tilt")
    assert twice.message == "TILT is given twice"
    assert twice.related[0].span == Span(11, 15)
    again = check(parsed("WRIST HOLD TILT, TILT, TILT"))
    assert [item.related[0].span.start for item in again] == [11, 11]
    many = first("WRIST HOLD ROTATION, ADVANCE, tilt")
    assert many.message == "TILT is one too many: the wrist can hold at most two components"
    assert many.severity is Severity.ERROR


def test_the_same_component_in_two_statements_is_no_repetition():
    assert checked("WRIST HOLD TILT, ADVANCE\nWRIST HOLD TILT\nMOVE P1, WRIST HOLD TILT, ROTATION") == []


def test_sensors():
    assert checked("SEAM ON, arc", sensors=("TORCH",)) == [("RBL306", 1, 10, 3)]
    assert checked("SEAM ON, arc", sensors=()) == [("RBL306", 1, 10, 3)]
    assert checked("SEAM ON, ARC\nSEAM on, arc", sensors=("Arc",)) == []
    assert checked("SEAM OFF", sensors=()) == []
    assert checked("SEAM ON, arc") == []


@pytest.mark.parametrize(
    ("sensors", "hint"),
    [
        (("torch", "arc"), "did you mean TORCH?"),
        (("B", "A"), "seam sensors: A, B"),
        ((), "the cell has no seam sensor"),
        (tuple("ABDEFGIJKLM"), "Add [sensors.NAME] to the cell file, or correct the name."),
    ],
)
def test_near_sensors_are_suggested(sensors, hint):
    diagnostic = first("SEAM ON, Trch", sensors=sensors)
    assert (diagnostic.message, diagnostic.hint) == ("the cell has no seam sensor Trch", hint)


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("LOAD (0, 0, 0), -w", ("RBL117", 1, 18, 1)),
        ("LOAD (0, d, 0), 1", ("RBL117", 1, 10, 1)),
        ("MOVE P1, SPEED v", ("RBL117", 1, 16, 1)),
        ("MOVE P1, WRIST HOLD TILT, SPEED v", ("RBL117", 1, 33, 1)),
        ("HAND ON, t", ("RBL117", 1, 10, 1)),
    ],
)
def test_variables_are_not_there_yet(text, place):
    assert checked(text) == [place]


def test_line_numbers():
    text = "10 MOVE P1\n30 MOVE P1\n20 MOVE P1\n25 MOVE P1\n30 MOVE P1\n"
    assert checked(text) == [("RBL116", 3, 1, 2), ("RBL113", 5, 1, 2)]
    order, twice = check(parsed(text))
    assert order.severity is Severity.WARNING
    assert twice.severity is Severity.ERROR
    assert source(text).place(twice.related[0].span.start).line == 2


def test_the_number_of_a_bad_line_counts():
    program = parse(source("10 MOV\n10 MOVE P1")).program
    assert [item.code for item in check(program)] == ["RBL113"]


def test_everything_is_found_at_once_and_in_order():
    text = "MOVE X, SPEED 0\nLOAD (0, 0, 9999), -1\nHAND ON, -1"
    assert [item[:2] for item in checked(text, points=())] == [
        ("RBL301", 1), ("RBL404", 1), ("RBL403", 2), ("RBL401", 2), ("RBL405", 3),
    ]  # fmt: skip


def test_the_list_is_bounded():
    found = check(parsed("1\n" * 5000 + "MOVE P1"))
    assert len(found) == MAX_DIAGNOSTICS + 1
    assert found[-1].code == "RBL107"
