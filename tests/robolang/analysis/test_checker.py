import numpy as np
import pytest

from robolang.analysis.checker import check
from robolang.core.diagnostics import MAX_DIAGNOSTICS, Severity
from robolang.core.source import Span
from robolang.syntax.parser import parse
from tests.messages import fields
from tests.robolang.helpers import cell_with, checked, parsed, places, source


def first(text, **facts):
    (diagnostic,) = check(parsed(text), cell_with(**facts))
    return diagnostic


def test_a_good_program_has_nothing():
    text = "10 LOAD (0, 0, 60), 0.8\n20 MOVE p1, SPEED 200, ACCEL 100\n30 HAND ON, 0\n35 LOAD PART"
    text += "\n40 MOVE P2, TIME 600\n50 WRIST HOLD TILT, ADVANCE\n60 SEAM ON, torch"
    text += "\n70 MOVE P1, WRIST HOLD ROTATION, TILT, SPEED 9\n80 SEAM OFF"
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
    assert {"LOAD", "kg", "g", "800", "0.8"} <= fields(first("LOAD (0, 0, 60), 800", rated_payload_kg=2.5).hint)


@pytest.mark.parametrize("cog", ["(0, 0, 2001)", "(0, NAN, 0)", "(INF, 0, 0)", "(1E308, 1E308, 0)", "(-1500, 1500, 0)"])
def test_centre_of_gravity(cog):
    assert checked(f"LOAD {cog}, 1") == [("RBL403", 1, 6, len(cog))]


def test_centre_of_gravity_at_the_limit():
    assert checked("LOAD (0, 0, 2000), 1") == []
    assert checked("LOAD (0, 0, 9000), 0") == [("RBL403", 1, 6, 12)]  # one rule, whatever the mass
    assert checked("LOAD (0, 0, NAN), 0") == [("RBL403", 1, 6, 11)]


@pytest.mark.parametrize(
    "option",
    [
        "SPEED 0",
        "SPEED -5",
        "SPEED NAN",
        "SPEED INF",
        "SPEED 10000.1",
        "ACCEL 0",
        "ACCEL 100.1",
        "ACCEL NAN",
        "TIME 0",
        "TIME -1",
        "TIME 600.1",
        "TIME NAN",
    ],
)
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
    assert "SPEED" in fields(diagnostic.message)
    assert diagnostic.related[0].span.start == 9


def test_wrist_twice_in_a_move():
    assert checked("MOVE P1, WRIST KEEP, SPEED 1, WRIST AUTO") == [("RBL118", 1, 31, 10)]
    assert checked("MOVE P1, WRIST HOLD TILT, WRIST HOLD TILT") == [("RBL118", 1, 27, 15)]
    diagnostic = first("MOVE P1, WRIST KEEP, WRIST KEEP")
    assert "WRIST" in fields(diagnostic.message)
    assert diagnostic.related[0].span == Span(9, 19)


@pytest.mark.parametrize("lead", ["", "MOVE P1, ", "MOVE P1, SPEED 5, "])
def test_components_twice_and_too_many(lead):
    at = len(lead) + 12
    assert checked(f"{lead}WRIST HOLD TILT, TILT") == [("RBL118", 1, at + 6, 4)]
    assert checked(f"{lead}WRIST HOLD TILT, ADVANCE, TILT") == [("RBL118", 1, at + 15, 4)]
    assert checked(f"{lead}WRIST HOLD TILT, TILT, ADVANCE") == [("RBL118", 1, at + 6, 4)]
    assert checked(f"{lead}WRIST HOLD TILT, ADVANCE, ROTATION") == [("RBL120", 1, at + 15, 8)]
    assert checked(f"{lead}WRIST HOLD TILT, ADVANCE, ROTATION, ROTATION") == [
        ("RBL120", 1, at + 15, 8),
        ("RBL118", 1, at + 25, 8),
    ]


def test_messages_about_components():
    twice = first("WRIST HOLD tilt, Tilt")
    assert "TILT" in fields(twice.message)
    assert twice.related[0].span == Span(11, 15)
    again = check(parsed("WRIST HOLD TILT, TILT, TILT"))
    assert [item.related[0].span.start for item in again] == [11, 11]
    many = first("WRIST HOLD ROTATION, ADVANCE, tilt")
    assert "TILT" in fields(many.message)
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
        (("torch", "arc"), "TORCH"),
        (("B", "A"), "B NAME.cell.toml"),
        ((), "NAME.cell.toml"),
    ],
)
def test_near_sensors_are_suggested(sensors, hint):
    diagnostic = first("SEAM ON, Trch", sensors=sensors)
    assert "Trch" in diagnostic.message
    assert set(hint.split()) <= fields(diagnostic.hint)


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("LOAD (0, 0, 0), -w", ("RBL215", 1, 18, 1)),
        ("LOAD (0, d, 0), 1", ("RBL215", 1, 10, 1)),
        ("MOVE P1, SPEED v", ("RBL215", 1, 16, 1)),
        ("MOVE P1, WRIST HOLD TILT, SPEED v", ("RBL215", 1, 33, 1)),
        ("HAND ON, t", ("RBL215", 1, 10, 1)),
    ],
)
def test_a_name_without_a_value_is_found_where_the_points_are_known(text, place):
    assert checked(text, points=("P1",)) == [place]
    assert checked(text) == []
    name = text[place[2] - 1]
    assert checked(f"{name} = 1\n{text}", points=("P1",)) == []


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
        ("RBL301", 1),
        ("RBL404", 1),
        ("RBL403", 2),
        ("RBL401", 2),
        ("RBL405", 3),
    ]


def test_the_list_is_bounded():
    found = check(parsed("1\n" * 5000 + "MOVE P1"))
    assert len(found) == MAX_DIAGNOSTICS + 1
    assert found[-1].code == "RBL107"


ALL = {
    "points": ("P1", "P2"),
    "sensors": (),
    "tools": ("gun",),
    "frames": ("bench",),
    "loads": ("part",),
    "inputs": (1, 2),
}


def found(text):
    return places(text, check(parsed(text), cell_with(**ALL)))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("FOR i = 1 TO 2 STEP 0\nNEXT", [("RBL205", 1, 21, 1)]),
        ("FOR i = 1 TO 2 STEP 1 - 1\nNEXT", [("RBL205", 1, 21, 5)]),
        ("FOR i = 1 TO 2 STEP .1\nNEXT", [("RBL206", 1, 21, 2)]),
        ("x = 1 / 0", [("RBL209", 1, 5, 5)]),
        ("PRINT 2; SQR(0 - 1)", [("RBL209", 1, 10, 10)]),
        ("IF 1E308 * 10 THEN END", [("RBL209", 1, 4, 10)]),
        ("WAIT 1 MOD 0", [("RBL209", 1, 6, 7)]),
        ("MOVE P1, SPEED 1 / 0", [("RBL209", 1, 16, 5)]),
        ("CALL a", [("RBL213", 1, 6, 1)]),
        ("IF 1 THEN CALL b ELSE CALL c(1)", [("RBL213", 1, 16, 1), ("RBL213", 1, 28, 1)]),
        ("CALL a(1)\nSUB a(b, c)\nENDSUB", [("RBL214", 1, 1, 9)]),
        ("CALL a(1)\nSUB a\nENDSUB", [("RBL214", 1, 1, 9)]),
        ("x = ABS(1, 2)", [("RBL214", 1, 5, 9)]),
        ("x = ATN2(1)", [("RBL214", 1, 5, 7)]),
        ("P9 = POSE(1, 2)", [("RBL214", 1, 6, 10)]),
        ("P9 = JOINT(1)", [("RBL214", 1, 6, 8)]),
        ("DIM a(2)\na(1) = a(1, 2)", [("RBL214", 2, 8, 7)]),
        ("x = y", [("RBL215", 1, 5, 1)]),
        ("x = x1 + q(1)", [("RBL215", 1, 5, 2), ("RBL215", 1, 10, 1)]),
        ("q(1) = 1", [("RBL215", 1, 1, 1)]),
        ("x = P3.X", [("RBL215", 1, 5, 2)]),
        ("MOVE P3 + (0, 0, 1)", [("RBL215", 1, 6, 2)]),
        ("X = P1.X + 10\nPRINT X", []),
        ("DIM a(2)\na = a(1) + P1.RX\nPRINT a", []),
        ("n = n + P1.X", [("RBL215", 1, 5, 1)]),
        ("X = 1\nPRINT P1.X", [("RBL225", 1, 1, 1)]),
        ("x = 7 * 3 MOD 2\nPRINT x", [("RBL231", 1, 5, 11)]),
        ("PRINT 7 MOD 3 MOD 2; (7 * 3) MOD 2; 7 * (3 MOD 2); -7 MOD 2; 7 MOD 2 + 3 * 2", []),
        ("CONST k = 1\nk = 2\nIF 1 THEN k = 3", [("RBL216", 2, 1, 1), ("RBL216", 3, 11, 1)]),
        ("CONST k = 1\nFOR k = 1 TO 2\nNEXT", [("RBL216", 2, 5, 1)]),
        ("MOVE 5", [("RBL217", 1, 6, 1)]),
        ("MOVE (1, 2, 3)", [("RBL217", 1, 6, 9)]),
        ('MOVE "P1"', [("RBL217", 1, 6, 4)]),
        ("MOVEC 1, P1", [("RBL217", 1, 7, 1)]),
        ("SPLINE (P1, 1)", [("RBL217", 1, 13, 1)]),
        ("SPLINE (P1)", [("RBL220", 1, 9, 2)]),
        ("SPLINE (P1, p1, P2, P1)", [("RBL236", 1, 13, 2)]),
        ("SPLINE (P1, P2), SPEED 5, TIME 2", [("RBL119", 1, 18, 7)]),
        ("APPROACH P1, P2", [("RBL217", 1, 14, 2)]),
        ('MOVE P1, SPEED "a"', [("RBL217", 1, 16, 3)]),
        ("SPEED P1", [("RBL217", 1, 7, 2)]),
        ('x = "a"', [("RBL217", 1, 5, 3)]),
        ("s$ = 5", [("RBL217", 1, 6, 1)]),
        ("s$ = P1", [("RBL217", 1, 6, 2)]),
        ("CONST k$ = 5", [("RBL217", 1, 12, 1)]),
        ("FOR s$ = 1 TO 2\nNEXT", [("RBL217", 1, 10, 1)]),
        ('FOR i = 1 TO "a"\nNEXT', [("RBL217", 1, 14, 3)]),
        ('x = 1 + "a"', [("RBL217", 1, 9, 3)]),
        ("x = P1 + P2", [("RBL217", 1, 5, 2)]),
        ("x = -P1", [("RBL217", 1, 6, 2)]),
        ('x = NOT "a"', [("RBL217", 1, 9, 3)]),
        ("x = 5 + (1, 2, 3)", [("RBL217", 1, 9, 9)]),
        ("P9 = P1 - (1, 2, 3)", [("RBL217", 1, 11, 9)]),
        ("x = (1, 2, 3)", [("RBL217", 1, 5, 9)]),
        ("PRINT (1, 2); ABS((1, 2))", [("RBL217", 1, 7, 6), ("RBL217", 1, 19, 6)]),
        ("x = LEN(5) + VAL(5)", [("RBL217", 1, 9, 1), ("RBL217", 1, 18, 1)]),
        ('x = DIST(P1, 2) + ABS("a")', [("RBL217", 1, 14, 1), ("RBL217", 1, 23, 3)]),
        ("IF P1 THEN END", [("RBL217", 1, 4, 2)]),
        ('IF "a" THEN\nENDIF', [("RBL217", 1, 4, 3)]),
        ("WHILE P1\nWEND", [("RBL217", 1, 7, 2)]),
        ('WAIT "a"', [("RBL217", 1, 6, 3)]),
        ('OUT(P1) = "a"', [("RBL217", 1, 5, 2), ("RBL217", 1, 11, 3)]),
        ("DIM a(P1)", [("RBL217", 1, 7, 2)]),
        ('TOOL 5\nFRAME "a"', [("RBL217", 1, 6, 1), ("RBL217", 2, 7, 3)]),
        ("x = P1.Q + HERE.RW", [("RBL218", 1, 8, 1), ("RBL218", 1, 17, 2)]),
        ("MOVE P1 + (1, 2)", [("RBL220", 1, 11, 6)]),
        ("MOVE P1 + (1, 2, 3, 4, 5, 6)", [("RBL220", 1, 11, 18)]),
        ("MOVE P1 * (1, 2, 3, 4)", [("RBL220", 1, 11, 12)]),
        ("LOAD (1, 2), 3", [("RBL220", 1, 6, 6)]),
        ("LOAD (1, 2, 3), 3, (1, 2, 3)", [("RBL220", 1, 20, 9)]),
        ("TOOL torch", [("RBL305", 1, 6, 5)]),
        ("FRAME gun", [("RBL305", 1, 7, 3)]),
        ("LOAD prt", [("RBL305", 1, 6, 3)]),
        ("SEAM ON, arc", [("RBL306", 1, 10, 3)]),
        ("MOVEC P8, P9", [("RBL301", 1, 7, 2), ("RBL301", 1, 11, 2)]),
        ("SPLINE (P8, P1 + (0, 0, 1), P9)", [("RBL301", 1, 9, 2), ("RBL301", 1, 29, 2)]),
        ("END\nPRINT 1\n*L\nPRINT 2\nGOTO *L", [("RBL221", 2, 1, 7)]),
        ("GOTO *L\n\n*L\n' x\nPRINT 2", []),
        ("SPEED 2 * 5000.5", [("RBL404", 1, 7, 10)]),
        ("SPEED 0\nSPEEDJ 101", [("RBL404", 1, 7, 1), ("RBL404", 2, 8, 3)]),
        ("ACCEL -1\nOVERRIDE 100.5", [("RBL404", 1, 7, 2), ("RBL404", 2, 10, 5)]),
        ("MOVEJ P1, SPEED 101", [("RBL404", 1, 17, 3)]),
        ("MOVE P1, SPEED NAN + 1", [("RBL209", 1, 16, 7)]),
        ("DEPART -1", [("RBL404", 1, 8, 2)]),
        ("DELAY -1", [("RBL405", 1, 7, 2)]),
        ("DELAY 1E12", [("RBL405", 1, 7, 4)]),
        ("PULSE 1, 0 - 1", [("RBL405", 1, 10, 5)]),
        ("WAIT 1, TIMEOUT 86401", [("RBL405", 1, 17, 5)]),
        ("ZONE -1", [("RBL415", 1, 6, 2)]),
        ("MOVE P1, ZONE 1 - 2", [("RBL415", 1, 15, 5)]),
        ("x = IN(3)", [("RBL534", 1, 8, 1)]),
        ("OUT(0) = 1", [("RBL534", 1, 5, 1)]),
        ("OUT(1025) = 1", [("RBL534", 1, 5, 4)]),
        ("PULSE 1.5, 1", [("RBL534", 1, 7, 3)]),
    ],
)
def test_what_is_wrong_with_what_it_means(text, expected):
    assert found(text) == expected


@pytest.mark.parametrize(
    "text",
    [
        'x = 1\ny = x + P1.X + IN(2) + TIMER + ERR\nPRINT y; "a" + STR$(y)',
        "P9 = P1 + (0, 0, x)\nx = 2\nMOVE P9\nMOVE (P9 + (0, 0, 1)) * (0, 0, 0, 90, 0, 0)",
        "DIM a(3)\nDIM b$(2)\na(1) = 2\nb$(0) = STR$(a(1))\nPRINT b$(1)\nMOVE a(2)",
        'CALL s(1, "a")\nSUB s(n, t$)\nPRINT n; t$\nENDSUB',
        "TOOL GUN\nTOOL POSE(0, 0, 1, 0, 0, 0)\nFRAME Bench\nFRAME P1\nLOAD PART",
        "ZONE 0\nSPEED 10000\nSPEEDJ 100\nACCEL 100\nOVERRIDE 100\nDELAY 86400\nPULSE 1024, 0\nOUT(1) = 5",
        "FOR i = 1 TO 2 STEP -2\nNEXT",
        "x = 0\nPRINT 1 / x",
        "IF P1 = P2 THEN END",
        "MOVE JOINT(1, 2, 3, 4, 5, 6), FINE\nDEPART 5\nAPPROACH HERE, 0",
    ],
)
def test_good_programs_of_the_whole_language(text):
    expected = [("RBL217", 1, 4, 2)] if "P1 = P2" in text else []  # poses are not compared
    assert found(text) == expected


def test_what_is_not_known_is_not_checked():
    text = "TOOL t\nMOVE P9\nx = y + P9.X + IN(77)\nFRAME f\nLOAD l\nSEAM ON, s\nMOVE x"
    assert checked(text) == []


def test_hints_of_names():
    assert "SQR" in fields(first("x = SQRT(4)", points=()).hint)
    assert "X" in fields(first("x = 1\ny = xx", points=()).hint)
    assert "PICK" in fields(first("CALL pikc\nSUB pick\nENDSUB").hint)
    assert "GUN" in fields(first("TOOL gum", tools=("gun",)).hint)
    assert "DIM" in fields(first("q(1) = 1").hint)


def test_severity_and_the_other_place():
    assert first("FOR i = 1 TO 2 STEP .1\nNEXT").severity is Severity.WARNING
    text = "CONST k = 1\nk = 2"
    assert source(text).slice(first(text).related[0].span) == "k"
    text = "CALL s(1)\nSUB s\nENDSUB"
    assert source(text).slice(first(text).related[0].span) == "SUB s"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("FOR i = 1 TO 3\nn = n + 1\nNEXT\nPRINT n", [("RBL215", 2, 5, 1)]),
        ("n = 0\nn = n + 1\nPRINT n", []),
        ("P1 = P1 + (0, 0, 9)\nMOVE P1", []),
    ],
)
def test_a_value_that_only_goes_into_itself_has_no_first_one(text, expected):
    assert checked(text, points=("P1",)) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("ON ERROR GOTO *H\nMOVE P1\nEND\n*H PRINT 1 / ERR; 7 MOD ERR; SQR(ERR - 100)\nRESUME NEXT", []),
        ("CONST k = 3\nPRINT k\nCONST k = 5", [("RBL216", 3, 7, 1)]),
        ('SELECT ERR\nCASE "410"\nENDSELECT', [("RBL217", 2, 6, 5)]),
        (
            'SELECT "a"\nCASE "b", 3\nSELECT 1\nCASE 2\nENDSELECT\nCASE 4\nENDSELECT',
            [("RBL217", 2, 11, 1), ("RBL217", 6, 6, 1)],
        ),
    ],
)
def test_values_that_only_a_run_has_and_values_that_never_fit(text, expected):
    assert checked(text) == expected


def test_an_inertia_is_a_body_s_or_not_as_its_principal_moments_say():
    """Against the eigenvalues, for tensors of random bodies and such as are a little off."""
    random = np.random.default_rng(18)
    wrong = 0
    for _ in range(400):
        moments = random.uniform(0.0, 1.0, 3)
        turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
        tensor = turn @ np.diag(moments) @ turn.T
        largest, rest = moments.max(), moments.sum() - moments.max()
        if abs(largest - rest) < 1e-3:
            continue
        values = [tensor[i] for i in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
        text = f"LOAD (0, 0, 0), 1, ({', '.join(f'{value:.12f}' for value in values)})"
        found = [code for code, *_ in checked(text)]
        assert found == (["RBL403"] if largest > rest else []), text
        wrong += largest > rest
    assert 50 < wrong < 350


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("DIM b(3)\nb(5) = 1\nPRINT b(1)", [(2, 1)]),
        ("DIM b(3)\nPRINT b(2 + 2); b(3)", [(2, 7)]),
        ("DIM b(3)\nb(-1) = b(4)", [(2, 1), (2, 9)]),
        ("n = 2\nDIM b(n)\nb(-1) = 1\nb(9) = b(0)", [(3, 1)]),
        ("DIM b(3)\nDIM b(9)\nb(9) = b(0)", []),
        ("DIM b(3)\nCALL s\nb(3) = 1\nSUB s\nDIM b(9)\nb(9) = b(0)\nENDSUB", []),
        ("DIM b(9)\nCALL s\nSUB s\nb(9) = b(10)\nENDSUB", [(4, 8)]),
        ("DIM b(NAN)\nb(5) = b(1)", [(1, 7)]),
    ],
)
def test_elements_that_no_array_has(text, found):
    assert [item[1:3] for item in checked(text) if item[0] == "RBL507"] == found


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("FOR i = 1 TO 3\nFOR i = 1 TO 2\nPRINT i\nNEXT i\nNEXT i", [(2, 5)]),
        ("FOR i = 1 TO 3\nWHILE i < 2\nFOR I = 1 TO 2\nNEXT\nWEND\nNEXT", [(3, 5)]),
        ("FOR i = 1 TO 3\nFOR k = 1 TO 2\nNEXT\nFOR k = 1 TO i\nNEXT\nNEXT\nFOR i = 1 TO 2\nNEXT", []),
    ],
)
def test_a_loop_with_the_variable_of_the_loop_around_it(text, found):
    assert [item[1:3] for item in checked(text) if item[0] == "RBL235"] == found
