import math
from pathlib import Path

import pytest

from robolang.core.source import Span
from robolang.interpreter import run_limits
from robolang.interpreter.effects import Drain, MoveTo, Origin, Pass, SetHand, SetPayload, SetSeam, SetWrist
from robolang.interpreter.program_fault import ProgramFault
from robolang.interpreter.run_limits import MAX_CALLS
from robolang.syntax.parser import parse
from robolang.syntax.unparse import describe
from robolang.values.poses import Place, Shift
from runtime.core.program_line import named
from tests.robolang.helpers import parsed, source
from tests.robolang.running import POINTS, World, execute, fault, ran, shows

LISTING = Path(__file__).parents[3] / "programs" / "pick_and_place.rbl"


def test_the_listing_in_order():
    program = parsed(LISTING.read_text(encoding="utf-8"))
    effects = list(execute(program, points=POINTS))
    trace = [
        (e.mass_kg, e.cog_mm) if isinstance(e, SetPayload) else e.closed if isinstance(e, SetHand) else e.target.point
        for e in effects
    ]
    hand, part = (0.8, (0.0, 0.0, 60.0)), (2.3, (0.0, 0.0, 95.0))
    assert trace == [hand, False, "P1", True, part, "P2", "P3", False, hand, "P4", "P5"]
    assert [effect.number for effect in effects] == list(range(10, 111, 10))
    assert [effect.line for effect in effects] == list(range(4, 15))
    assert [describe(effect.node) for effect in effects][4] == "LOAD (0, 0, 95), 2.3"


def test_values_and_places():
    text = "' x\nMOVE pick, SPEED 200, ACCEL 5\n70 HAND ON, .5\nMOVE B, TIME --2"
    move, hand, timed = execute(parsed(text), points=("pick", "B"))
    assert isinstance(move, MoveTo)
    assert (move.target, move.speed_mm_s, move.accel_pct, move.time_s) == (Place(point="PICK"), 200.0, 5.0, None)
    assert (move.line, move.number, source(text).slice(move.span)) == (2, None, "MOVE pick, SPEED 200, ACCEL 5")
    assert (hand.closed, hand.dwell_s, hand.line, hand.number) == (True, 0.5, 3, 70)
    assert timed.time_s == 2.0


def test_open_values_stay_open():
    move, hand = execute(parsed("MOVE P1\nHAND OFF"), points=POINTS)
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
    return [
        (effect.wrist, effect.held) for effect in execute(parsed(text), points=POINTS) if isinstance(effect, MoveTo)
    ]


def test_wrist_holds_for_the_moves_that_follow_until_changed():
    text = "MOVE A\nWRIST KEEP\nMOVE A\nHAND ON\nMOVE A\nWRIST HOLD TILT, ADVANCE\nMOVE A, SPEED 5\nWRIST AUTO\nMOVE A"
    held = ("auto", ("TILT", "ADVANCE"))
    assert wrists(text) == [(None, ()), ("keep", ()), ("keep", ()), held, ("auto", ())]


def test_the_option_wins_for_its_move_only():
    text = "MOVE A, WRIST KEEP\nMOVE A\nWRIST HOLD TILT\nMOVE A, WRIST KEEP\nMOVE A\n"
    text += "MOVE A, WRIST HOLD ROTATION, TIME 2"
    tilt = ("auto", ("TILT",))
    assert wrists(text) == [("keep", ()), (None, ()), ("keep", ()), tilt, ("auto", ("ROTATION",))]
    *_, last = execute(parsed(text), points=POINTS)
    assert last.time_s == 2.0


def test_each_run_starts_without_a_wrist_setting():
    program = parsed("MOVE A\nWRIST KEEP")
    assert [move.wrist for move, _ in (execute(program, points=POINTS), execute(program, points=POINTS))] == [
        None,
        None,
    ]


def test_nothing_is_computed_ahead():
    steps = execute(parse(source("MOVE P1\nMOV P2")).program, points=POINTS)
    assert next(steps).target == Place(point="P1")
    with pytest.raises(ValueError, match="line 2"):
        next(steps)


def test_a_name_without_a_value_is_a_fault_at_its_statement():
    with pytest.raises(ProgramFault, match=r"RBL532|t ") as caught:
        list(execute(parsed("' x\n20 HAND ON, t")))
    assert (caught.value.code, caught.value.origin) == ("RBL532", Origin(line=2, number=20, span=Span(7, 17)))


# --- the whole language ----------------------------------------------------------------------------------------------


def without_origin(effect):
    skip = {"line", "number", "span", "node"}
    values = {key: getattr(effect, key) for key in effect.__dataclass_fields__ if key not in skip}
    return type(effect).__name__, {key: value for key, value in values.items() if value not in (None, (), 0.0, "")}


P1 = Place(point="P1")
BACK = Shift(kind="tool", by=(0.0, 0.0, -50.0, 0.0, 0.0, 0.0))


def to(path="line", **values):
    return ("MoveTo", {"path": path, "target": P1, "override_pct": 100.0, **values})


@pytest.mark.parametrize(
    ("text", "effect"),
    [
        ("MOVE P1", to()),
        ("MOVE P1, FINE", to()),
        ("MOVE P1, ZONE 5, WRIST KEEP, TIME 2", to(zone_mm=5.0, wrist="keep", time_s=2.0)),
        ("MOVEJ P1, SPEED 5, ACCEL 6", to("joint", speed_pct=5.0, accel_pct=6.0)),
        ("MOVEJ P1, ACCEL MAX", to("joint", accel_pct=math.inf)),
        ("MOVEC A, P1, SPEED 5", to("arc", via=(Place(point="A"),), speed_mm_s=5.0)),
        ("SPLINE (A, B, P1), ZONE 5", to("spline", via=(Place(point="A"), Place(point="B")), zone_mm=5.0)),
        ("APPROACH P1, 50", to(target=P1.shifted(BACK))),
        ("DEPART 25 * 2, SPEED 5", to(target=Place(last=True, shifts=(BACK,)), speed_mm_s=5.0)),
        ("LOAD (1, 2, 3), 4", ("SetPayload", {"cog_mm": (1.0, 2.0, 3.0), "mass_kg": 4.0})),
        (
            "LOAD (0, 0, 0), 1, (1, 2, 3, 4, 5, 6)",
            ("SetPayload", {"cog_mm": (0.0,) * 3, "mass_kg": 1.0, "inertia_kg_m2": (1.0, 2.0, 3.0, 4.0, 5.0, 6.0)}),
        ),
        ("LOAD Part", ("SetPayload", {"cog_mm": (0.0,) * 3, "name": "PART"})),
        ("HAND ON, 1 / 2", ("SetHand", {"closed": True, "dwell_s": 0.5})),
        ("TOOL gun", ("SetTool", {"tool": "GUN"})),
        ("TOOL POSE(1, 2, 3, 0, 0, 0)", ("SetTool", {"tool": (1.0, 2.0, 3.0, 0.0, 0.0, 0.0)})),
        ("OUT(1 + 1) = 3 > 2", ("SetOutput", {"output": 2, "value": 1.0})),
        ("PULSE 1024, 0.5", ("SetOutput", {"output": 1024, "value": 1.0, "seconds": 0.5})),
        ("DELAY 1", ("Pass", {"seconds": 1.0})),
        ("PRINT", ("Show", {})),
        ('PRINT 1.50; " "; STR$(2);', ("Show", {"text": "1.5 2"})),
        ('PRINT "{0.__class__}"', ("Show", {"text": "{0.__class__}"})),
        ("PRINT P1", ("Show", {"text": "(10.000, 20.000, 30.000, 0.000, 0.000, 0.000)"})),
        ("STOP", ("Halt", {"word": "STOP"})),
        ("PAUSE", ("Halt", {"word": "PAUSE"})),
    ],
)
def test_each_statement_is_one_effect(text, effect):
    assert [without_origin(each) for each in ran(text)] == [effect]


@pytest.mark.parametrize(
    ("lead", "effect"),
    [
        ("SPEED 5", to(speed_mm_s=5.0)),
        ("SPEEDJ 5", to()),
        ("ACCEL 5", to(accel_pct=5.0)),
        ("ACCEL MAX", to(accel_pct=math.inf)),
        ("ACCEL MAX\nACCEL MAX(5, 6)", to(accel_pct=6.0)),
        ("OVERRIDE 50", to(override_pct=50.0)),
        ("ZONE 5", to(zone_mm=5.0)),
        ("ZONE 5\nZONE 0", to()),
        ("FRAME bench", to()),
        ("SPEED 5\nSPEED 6", to(speed_mm_s=6.0)),
    ],
)
def test_settings_hold_for_the_moves_that_follow(lead, effect):
    assert [without_origin(each) for each in ran(f"{lead}\nMOVE P1\nMOVE P1")] == [effect] * 2


def test_options_win_over_settings_and_time_over_a_set_speed():
    set_ = "SPEED 5\nSPEEDJ 6\nACCEL 7\nZONE 8\n"
    assert without_origin(ran(set_ + "MOVEJ P1")[0]) == to("joint", speed_pct=6.0, accel_pct=7.0, zone_mm=8.0)
    assert without_origin(ran(set_ + "MOVE P1, SPEED 50, ACCEL 70, FINE")[0]) == to(speed_mm_s=50.0, accel_pct=70.0)
    assert without_origin(ran(set_ + "MOVE P1, TIME 2")[0]) == to(time_s=2.0, accel_pct=7.0, zone_mm=8.0)


def test_the_frame_is_that_of_the_place_in_the_program():
    before, after = ran("MOVE P1 + (1, 0, 0)\nFRAME bench\nMOVE P1 + (1, 0, 0)")
    assert [move.target.shifts[0].frame for move in (before, after)] == ["", "BENCH"]
    (move,) = ran("FRAME bench\nf = POSE(1, 2, 3, 0, 0, 0)\nFRAME f\nMOVE POSE(1, 1, 1, 0, 0, 0)")
    assert move.target.frame == (1.0, 2.0, 3.0, 0.0, 0.0, 0.0)


BENCH = "FRAME POSE(100, 50, 0, 0, 0, 90)\n"


@pytest.mark.parametrize(
    ("text", "frame"),
    [
        ("", ""),
        (BENCH, (100.0, 50.0, 0.0, 0.0, 0.0, 90.0)),
        (BENCH + BENCH, (100.0, 50.0, 0.0, 0.0, 0.0, 90.0)),
        (BENCH + "FRAME POSE(0, 0, 0, 0, 0, 0)\n", (0.0,) * 6),
        (BENCH + "FRAME WORLD\n", ""),
        (BENCH + "FRAME bench\n", "BENCH"),
        ("FRAME bench\nx = 100\n" + BENCH.replace("100", "x"), (100.0, 50.0, 0.0, 0.0, 0.0, 90.0)),
    ],
)
def test_a_frame_is_given_in_the_world_whatever_is_active(text, frame):
    (*_, move) = ran(text + "MOVE POSE(1, 2, 3, 0, 0, 0)")
    assert move.target.frame == frame


@pytest.mark.parametrize(
    ("text", "tool"),
    [
        ("TOOL FLANGE", "FLANGE"),
        (BENCH + "TOOL POSE(1, 2, 3, 0, 0, 0)", (1.0, 2.0, 3.0, 0.0, 0.0, 0.0)),
        (BENCH + "t = POSE(1, 2, 3, 0, 0, 0)\nTOOL t\nTOOL t", (1.0, 2.0, 3.0, 0.0, 0.0, 0.0)),
        (BENCH + "FLANGE = POSE(1, 2, 3, 0, 0, 0)\nTOOL FLANGE", (1.0, 2.0, 3.0, 0.0, 0.0, 0.0)),
    ],
)
def test_a_tool_is_given_in_the_flange_whatever_is_active(text, tool):
    assert ran(text)[-1].tool == tool


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("v = 0\nMOVE P1, ZONE v - 1", "RBL415"),
        ("v = 0\nZONE v - 1", "RBL415"),
        *((f"v = 0\n{word} v", "RBL404") for word in ("SPEED", "SPEEDJ", "ACCEL", "OVERRIDE")),
        ("v = 10001\nSPEED v", "RBL404"),
        ("v = 101\nOVERRIDE v", "RBL404"),
        ("v = -1\nDEPART v", "RBL404"),
        ("v = -1\nDELAY v", "RBL405"),
        ("v = 86401\nPULSE 1, v", "RBL405"),
        ("v = 0\nOUT(v) = 1", "RBL534"),
        ("v = 1025\nPULSE v, 1", "RBL534"),
        ("PRINT IN(7)", "RBL534"),
        ("v = 0\nFOR i = 1 TO 2 STEP v\nNEXT", "RBL205"),
        ("FOR i = 1 TO 1E300\nNEXT", "RBL502"),
        ('x = "a"', "RBL531"),
        ("s$ = 1", "RBL531"),
        ("CONST k = 1\nk = 2", "RBL531"),
        ("CALL s(1)\nSUB s(a$)\nENDSUB", "RBL531"),
        ("MOVE 5", "RBL531"),
        ('IF "a" THEN END', "RBL531"),
        ("RETURN", "RBL533"),
        ("RESUME", "RBL533"),
        ("RESUME NEXT", "RBL533"),
        ("CALL nothing", "RBL533"),
        ("DIM a(2)\na(3) = 1", "RBL507"),
        ("DIM a(100000)", "RBL507"),
    ],
)
def test_what_only_a_run_can_find(text, code):
    assert fault(text).code == code


# --- control ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "printed"),
    [
        ("IF 1 THEN PRINT 1 ELSE PRINT 2\nIF 0 THEN PRINT 3 ELSE PRINT 4\nIF 0 THEN PRINT 5", "14"),
        (
            'FOR i = 1 TO 4\nIF i = 1 THEN\nPRINT "a"\nELSEIF i = 2 THEN\nPRINT "b"\nELSEIF i < 4\nPRINT "c"\nELSE\n'
            'PRINT "d"\nENDIF\nNEXT',
            "abcd",
        ),
        ("IF 0 THEN\nPRINT 1\nENDIF\nPRINT 2", "2"),
        ("IF 0\nELSE\nIF 1\nPRINT 1\nELSE\nPRINT 2\nENDIF\nENDIF", "1"),
        (
            'FOR i = 1 TO 5\nSELECT i\nCASE 1\nPRINT "a"\nCASE 2, 1 + 2\nPRINT "b"\nCASE 4\nCASE ELSE\nPRINT "e"\n'
            "ENDSELECT\nNEXT",
            "abbe",
        ),
        ('s$ = "x"\nSELECT CASE s$\nCASE "y"\nPRINT 1\nCASE "x"\nPRINT 2\nENDSELECT', "2"),
        ("SELECT 1\nENDSELECT\nPRINT 1", "1"),
        ("FOR i = 1 TO 3\nPRINT i\nNEXT", "123"),
        ("FOR i = 3 TO 1 STEP -1\nPRINT i\nNEXT i", "321"),
        ('FOR i = 1 TO 0\nPRINT i\nNEXT\nPRINT "n"; i', "n1"),
        ("FOR i = 1 TO 1 STEP -5\nPRINT i\nNEXT", "1"),
        ('FOR i = 0 TO 1 STEP 0.25\nPRINT i; " "\nNEXT', "0 0.25 0.5 0.75 1 "),
        ("n = 3\nFOR i = 1 TO n STEP n - 2\nn = 9\nPRINT i\nNEXT", "123"),
        ("FOR i = 1 TO 3\nPRINT i\ni = i + 1\nNEXT", "135"),
        ("FOR i = 1 TO 2\nFOR j = 1 TO 2\nPRINT i * 10 + j\nNEXT\nNEXT", "11122122"),
        ("10 FOR i = 1 TO 3\nPRINT i\nIF i = 2 THEN GOTO 40\nNEXT\n40 IF x = 1 THEN END\nx = 1\nGOTO 10", "1212"),
        ("FOR i = 1 TO 2\nFOR j = 1 TO 9\nIF j = 2 THEN GOTO 50\nPRINT i * 10 + j\nNEXT\n50 NEXT", "1121"),
        ('WHILE n < 3\nPRINT n\nn = n + 1\nWEND\nPRINT "e"', "012e"),
        ("WHILE 0\nPRINT 1\nWEND", ""),
        ("GOTO *A\nPRINT 1\n*A PRINT 2\nEND\nPRINT 3", "2"),
        ("GOSUB 10\nPRINT 2\nEND\n10 GOSUB 20\nPRINT 1\nRETURN\n20 PRINT 0\nRETURN", "012"),
        ('CALL a(1, 2)\nPRINT x\nSUB a(x, y)\nx = x + y\nPRINT x\nENDSUB\nPRINT "e"', "30e"),
        ("x = 5\nCALL a\nPRINT x\nSUB a()\nPRINT x\nx = 6\nPRINT x\nRETURN\nPRINT 9\nENDSUB", "565"),
        ("CALL f(4)\nSUB f(n)\nPRINT n\nIF n > 1 THEN CALL f(n - 1)\nPRINT n\nENDSUB", "43211234"),
        ("DIM a(3)\nFOR i = 0 TO 3\na(i) = i * i\nNEXT\nPRINT a(0) + a(1) + a(2) + a(3)", "14"),
        ('DIM n$(1)\nn$(1) = "b"\nPRINT n$(0) + n$(1)', "b"),
        ("CONST k = 2 * 3\nPRINT k", "6"),
        ("P9 = P1 + (1, 2, 3)\nPRINT P9.X", "10"),
    ],
)
def test_control(text, printed):
    text = "n = 0\nx = 0\n" + text if "WHILE n" in text or "x = 1 THEN" in text or "PRINT x\nSUB a(" in text else text
    assert "".join(shows(text)) == printed


def test_a_loop_of_a_million_fractions_is_counted_exactly(monkeypatch):
    monkeypatch.setattr(run_limits, "MAX_IDLE", 10**9)
    (last,) = shows("FOR x = 0 TO 99999.9 STEP 0.1\nNEXT\nPRINT ROUND(x * 10)")
    assert last == "999999"


@pytest.mark.parametrize(
    "call",
    [
        "10 CALL f(n)\nSUB f(n)\nIF n > 1 THEN CALL f(n - 1)\nENDSUB",
        "*S n = n - 1\nIF n > 0 THEN GOSUB *S\nIF n = -9 THEN GOTO *S\nEND",
    ],
)
def test_calls_within_one_another_are_bounded(call):
    more = "*S" in call  # the main program is there already
    ran(f"n = {MAX_CALLS + more}\n{call}")
    assert fault(f"n = {MAX_CALLS + more + 1}\n{call}").code == "RBL504"


@pytest.mark.parametrize(
    ("text", "number", "place"),
    [
        ("10 WHILE 1\n20 WEND", 10, (1, 4)),
        ("' x\nWHILE 1\nx = 1\nWEND", None, (2, 1)),
        ("10 DELAY 1\n20 GOTO 40\n30 END\n40 GOTO 20", 20, (2, 4)),
        ("10 *A\n20 GOTO *A", 10, (1, 1)),
        ("5 x = 1\n10 FOR i = 1 TO 1E9\n20 NEXT", 10, (2, 4)),
        ("10 ON ERROR GOTO 30\n20 x = 1 / 0\n30 RESUME", 20, (2, 4)),
        ("10 ON ERROR GOTO 40\n20 WHILE 1\n30 WEND\n40 RESUME NEXT", 20, (2, 4)),
        ("10 WAIT 0, TIMEOUT 0, GOTO 10", 10, (1, 4)),
    ],
)
def test_a_loop_that_takes_no_time_is_named_at_its_head(text, number, place, monkeypatch):
    monkeypatch.setattr(run_limits, "MAX_IDLE", 1000)
    found = fault(text)
    assert (found.code, found.origin.line, found.origin.number) == ("RBL508", place[0], number)
    where = source(text).place(found.origin.span.start)
    assert (where.line, where.column) == place
    assert f"{named(place[0], number)} " in found.message


@pytest.mark.parametrize("work", ["DELAY 0.01", "MOVE P1", "HAND ON, 0", "WAIT TIMER > 0.008 * n"])
def test_a_loop_that_takes_time_is_none(work, monkeypatch):
    monkeypatch.setattr(run_limits, "MAX_IDLE", 20)
    assert len(ran(f"FOR n = 1 TO 1000\nx = n\n{work}\nNEXT")) >= 1000  # no RBL508


def test_idle_statements_are_counted_exactly(monkeypatch):
    monkeypatch.setattr(run_limits, "MAX_IDLE", 10)
    assert shows("FOR i = 1 TO 11\nNEXT\nPRINT i") == ["11"]
    assert fault("FOR i = 1 TO 12\nNEXT\nPRINT i").code == "RBL508"


@pytest.mark.parametrize(
    "text",
    [
        "FOR i = 1 TO 11\nNEXT\nFOR i = 1 TO 11\nNEXT\nPRINT 1",  # each is bounded
        "FOR i = 1 TO 9\nFOR j = 1 TO 9\nNEXT\nNEXT\nPRINT 1",
        "i = 0\nWHILE i < 9\nj = 0\nWHILE j < 9\nj = j + 1\nWEND\ni = i + 1\nWEND\nPRINT 1",
        "FOR i = 1 TO 30\nDELAY 0\nNEXT\nPRINT 1",  # a cycle of 8 ms
    ],
)
def test_rounds_are_those_of_one_loop(text, monkeypatch):
    monkeypatch.setattr(run_limits, "MAX_IDLE", 10)
    assert shows(text) == ["1"]


@pytest.mark.parametrize(
    ("head", "end", "shown"),
    [
        ("IF 1 / x > 5 THEN", "ELSE\nPRINT 2\nENDIF", ["9"]),
        ("WHILE 1 / x", "WEND", ["9"]),
        ("FOR i = 1 TO 1 / x", "NEXT", ["9"]),
        ("SELECT 1 / x\nCASE 1", "ENDSELECT", ["9"]),
    ],
)
def test_resume_next_goes_behind_a_block_whose_head_failed(head, end, shown):
    text = f"x = 0\nON ERROR GOTO *H\n{head}\nPRINT 1\n{end}\nPRINT 9\nEND\n*H RESUME NEXT"
    assert shows(text) == shown


def test_statements_are_counted(monkeypatch):
    monkeypatch.setattr(run_limits, "MAX_STEPS", 10)
    ran("DELAY 1\n" * 10)
    assert fault("DELAY 1\n" * 11).code == "RBL505"
    assert fault("ON ERROR GOTO *H\n*H DELAY 1\nGOTO *H").code == "RBL505"


def test_what_is_printed_is_bounded(monkeypatch):
    monkeypatch.setattr(run_limits, "MAX_SHOWN", 10)
    assert shows('PRINT "1234"\nPRINT "1234"') == ["1234", "1234"]
    assert fault('PRINT "1234"\nPRINT "12345"').code == "RBL506"


# --- inputs and time -------------------------------------------------------------------------------------------------


def test_wait():
    world = World()
    steps = execute(parsed("WAIT IN(1) = 1\nPRINT 1"), world, POINTS)
    assert [type(next(steps)) for _ in range(3)] == [Drain, Pass, Pass]
    world.inputs[1] = 1.0
    assert next(steps).text == "1"


def test_wait_with_a_timeout():
    world = World()
    found = fault("20 WAIT IN(1), TIMEOUT 0.5", world)
    assert (found.code, found.origin.number) == ("RBL503", 20)
    assert world.time == pytest.approx(0.5, abs=0.009)
    assert shows("WAIT IN(1), TIMEOUT 0.5, GOTO *L\nPRINT 1\n*L PRINT 2") == ["2"]
    assert shows("WAIT NOT IN(1), TIMEOUT 0.5, GOTO *L\nPRINT 1\n*L PRINT 2") == ["1", "2"]
    assert shows("ON ERROR GOTO *H\nWAIT IN(1), TIMEOUT 0.5\nPRINT 1\nEND\n*H PRINT ERR\nRESUME NEXT") == ["503", "1"]
    assert shows("WAIT 1, TIMEOUT 0\nPRINT 1") == ["1"]


@pytest.mark.parametrize(
    "text",
    [
        "x = IN(1)",
        "x = TIMER",
        "P9 = HERE",
        "MOVE HERE",
        "PRINT P1.X",
        "IF IN(1) THEN END",
        "OUT(1) = IN(1)",
        "x = DIST(P1, P1)",
        "IF 1 THEN PRINT TIMER",
        "WAIT 1",
        "WHILE IN(1)\nWEND",
        "SELECT IN(1)\nENDSELECT",
        "SELECT 0\nCASE IN(1)\nENDSELECT",
        "IF 0\nELSEIF IN(1)\nENDIF",
        "FOR i = 0 TO IN(1)\nNEXT",
        "HAND ON, TIMER",
        "CALL s(IN(1))\nSUB s(a)\nENDSUB",
        "DIM a(1)\na(IN(1)) = 1",
    ],
)
def test_motion_ends_before_what_changes_is_read(text):
    assert isinstance(ran(text)[0], Drain)


@pytest.mark.parametrize(
    "text",
    [
        "MOVE P1 + (0, 0, 5)",
        "OUT(1) = 1",
        "DELAY 1",
        "PRINT 1",
        "IF 0 THEN PRINT TIMER",
        "HAND ON",
        "SPEED 5",
        "SELECT 0\nCASE 0\nCASE IN(1)\nENDSELECT",
        "x = ERR",
        "LOAD (0, 0, 0), 1",
        "IF 1\nELSEIF IN(1)\nENDIF",
    ],
)
def test_motion_goes_on_where_nothing_is_read(text):
    assert not any(isinstance(effect, Drain) for effect in ran(text))
