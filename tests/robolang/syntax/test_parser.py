"""What the parser makes of the text of a program."""

import logging
from pathlib import Path

import lark
import pytest

from robolang.core.source import Span
from robolang.project.points import load_points
from robolang.syntax import grammar
from robolang.syntax.ast import (
    Accel,
    Call,
    Component,
    Hand,
    HandState,
    Load,
    Move,
    Name,
    Negate,
    Number,
    Seam,
    Setting,
    Speed,
    Time,
    Vector,
    Wrist,
    WristMode,
)
from robolang.syntax.grammar import line_parser
from robolang.syntax.keywords import FUNCTIONS, KEYWORDS, VALUES
from robolang.syntax.unparse import describe
from tests.messages import fields
from tests.robolang.helpers import only, parse_found, parsed, source
from tests.together import together


def statement(text):
    (line,) = parsed(text).lines
    return line.statement


def number(text):
    return Number(value=float(text), text=text)


def test_the_four_instructions():
    cog = Vector(items=(number("0"), Negate(operand=number("1.5")), number("60")))
    assert statement("LOAD (0, -1.5, +60), .8") == Load(cog=cog, mass=number(".8"))
    assert statement("MOVE P1") == Move(target=Name(text="P1"))
    assert statement("HAND ON") == Hand(state=HandState.ON)
    assert statement("HAND OFF, 2E-1") == Hand(state=HandState.OFF, dwell=number("0.2"))


def test_move_options():
    options = (Speed(value=number("200")), Accel(value=number("50")), Time(value=number("3")))
    assert statement("MOVE P1, SPEED 200, ACCEL 50, TIME 3") == Move(target=Name(text="P1"), options=options)


KEEP = Wrist(mode=WristMode.KEEP)
AUTO = Wrist(mode=WristMode.AUTO)


def hold(*components):
    return Wrist(mode=WristMode.HOLD, held=tuple(Component[word] for word in components))


def test_wrist_as_a_setting():
    assert statement("WRIST KEEP") == KEEP
    assert statement("WRIST AUTO") == AUTO
    assert statement("WRIST HOLD TILT") == hold("TILT")
    assert statement("WRIST HOLD ROTATION, ADVANCE") == hold("ROTATION", "ADVANCE")
    assert statement("WRIST HOLD TILT, TILT, ADVANCE, ROTATION") == hold("TILT", "TILT", "ADVANCE", "ROTATION")
    assert len({KEEP, AUTO, hold("TILT"), hold("ADVANCE"), hold("TILT", "ADVANCE"), hold("ADVANCE", "TILT")}) == 6


@pytest.mark.parametrize(
    ("text", "options"),
    [
        ("WRIST KEEP", (KEEP,)),
        ("WRIST AUTO", (AUTO,)),
        ("WRIST HOLD TILT", (hold("TILT"),)),
        ("SPEED 5, WRIST HOLD TILT, ADVANCE", (Speed(value=number("5")), hold("TILT", "ADVANCE"))),
        ("WRIST HOLD TILT, SPEED 5", (hold("TILT"), Speed(value=number("5")))),
        ("WRIST HOLD TILT, ADVANCE, ROTATION, TIME 5", (hold("TILT", "ADVANCE", "ROTATION"), Time(value=number("5")))),
        ("WRIST HOLD TILT, WRIST KEEP", (hold("TILT"), KEEP)),
        ("WRIST KEEP, WRIST HOLD TILT", (KEEP, hold("TILT"))),
        (
            "WRIST HOLD TILT, ADVANCE, WRIST HOLD ROTATION, ACCEL 5, WRIST HOLD TILT, ROTATION",
            (hold("TILT", "ADVANCE"), hold("ROTATION"), Accel(value=number("5")), hold("TILT", "ROTATION")),
        ),
    ],
)
def test_wrist_as_an_option_takes_all_components_that_follow(text, options):
    assert statement(f"MOVE P1, {text}") == Move(target=Name(text="P1"), options=options)


def test_seam():
    assert statement("SEAM ON, torch") == Seam(sensor=Name(text="Torch"))
    assert statement("SEAM OFF") == Seam(sensor=None)
    assert statement("SEAM ON, torch").sensor.text == "torch"
    assert len({statement("SEAM ON, torch"), statement("SEAM ON, arc"), statement("SEAM OFF")}) == 3


@pytest.mark.parametrize(
    "text",
    [
        "WRIST KEEP",
        "WRIST AUTO",
        "WRIST HOLD TILT, ADVANCE",
        "SEAM ON, torch",
        "SEAM OFF",
        "MOVE P1, WRIST KEEP",
        "MOVE P1, SPEED 100, WRIST HOLD TILT, ADVANCE, TIME 3",
    ],
)
def test_wrist_and_seam_have_one_canonical_text(text):
    assert describe(statement(text)) == text
    assert describe(statement(text.replace("torch", "TORCH").lower())).upper() == text.upper()
    assert statement(text.lower().replace(",", " ,").replace(" ", "\t ")) == statement(text)


def test_no_word_is_of_this_edition_and_of_a_later_one():
    assert {"WRIST", "SEAM", "KEEP", "AUTO", "HOLD", "TILT", "ADVANCE", "ROTATION"} <= KEYWORDS
    assert KEYWORDS & FUNCTIONS == {"MAX"}  # the function has its parentheses, the word of ACCEL has none
    assert not (KEYWORDS | FUNCTIONS) & VALUES


@together("text", ["ACCEL MAX", "accel max", "ACCEL MAX ' (of the joints)", "ACCEL Max REM (2)"])
def test_max_stands_for_the_value_of_accel(text):
    assert statement(text) == Setting(word="ACCEL")
    assert describe(statement(text)) == "ACCEL MAX"
    (option,) = statement(f"MOVE P1, {text}").options
    assert (option, describe(option)) == (Accel(), "ACCEL MAX")


@together("text", ["ACCEL MAX(1, 2)", "accel max (1, 2)", "ACCEL MAX\t(1, 2)"])
def test_max_with_arguments_is_the_function(text):
    assert describe(statement(text)) == "ACCEL MAX(1, 2)"
    assert isinstance(statement(text).value, Call)


def conflicts(grammar, caplog):
    """What Lark says on its log only: it settles a conflict of shift and reduce for one side."""
    with caplog.at_level(logging.DEBUG, logger="lark"):
        lark.Lark(grammar, parser="lalr", lexer="basic", start=["start"], debug=True)
    return [record.message for record in caplog.records if "conflict" in record.message]


def test_the_grammar_is_lalr_1_without_a_conflict(caplog):
    assert conflicts(Path(grammar.__file__).with_name("grammar.lark").read_text(encoding="utf-8"), caplog) == []
    assert conflicts('start: "m" ("," hold)*\nhold: "h" "c" ("," "c")*', caplog)


def test_case_and_space_do_not_matter():
    assert parsed("\t10   move\tp1 ,speed  5").lines == parsed("10 MOVE P1, SPEED 5").lines


def test_names_keep_their_spelling():
    target = statement("MOVE Pick_1").target
    assert (target.text, target.key) == ("Pick_1", "PICK_1")


@pytest.mark.parametrize("text", ["' MOVE P1", "REM MOVE P1", "rem", "  REM\tx", "'" * 5, "20 ' x", "20 REM x"])
def test_comments_alone(text):
    (line,) = parsed(text).lines
    assert line.statement is None
    assert line.comment.text == text.removeprefix("20").strip()
    assert line.number == (20 if text.startswith("20") else None)


def test_comment_behind_a_statement():
    program = parsed("MOVE P1 ' it's (here\nHAND ON REM x  ")
    assert [comment.text for comment in program.comments] == ["' it's (here", "REM x"]
    assert len(program.statements) == 2


def test_blank_lines_are_gaps_in_the_source_lines():
    program = parsed("\n  \nMOVE P1\n\t\n\n10\nMOVE P2\n")
    assert [line.source_line for line in program.lines] == [3, 6, 7]
    assert [line.number for line in program.lines] == [None, 10, None]


@pytest.mark.parametrize("text", ["", "\n", " \t\n\n", "\r\n\t"])
def test_empty_text(text):
    assert parsed(text).lines == ()


def test_spans_are_offsets_of_the_source():
    text = "\r\n10 MOVE P1, SPEED -200 ' x\r\nLOAD (1, 2, 3), 4\r\n"
    where = source(text)
    move, load = parsed(text).lines
    assert where.slice(move.span) == "10 MOVE P1, SPEED -200 ' x"
    assert where.slice(move.number_span) == "10"
    assert where.slice(move.statement.span) == "MOVE P1, SPEED -200"
    assert where.slice(move.statement.target.span) == "P1"
    assert where.slice(move.statement.options[0].span) == "SPEED -200"
    assert where.slice(move.statement.options[0].value.span) == "-200"
    assert where.slice(move.comment.span) == "' x"
    assert where.slice(load.statement.span) == "LOAD (1, 2, 3), 4"
    assert where.slice(load.statement.cog.span) == "(1, 2, 3)"


def test_spans_of_wrist_and_seam():
    text = "\n10 wrist hold tilt , rotation ' x\nMOVE P1, WRIST KEEP, wrist HOLD TILT,  ADVANCE, TIME 2\n"
    text += "SEAM ON, torch \n SEAM OFF ' x\nWRIST AUTO "
    where = source(text)
    hold, move, on, off, auto = (line.statement for line in parsed(text).lines)
    assert where.slice(hold.span) == "wrist hold tilt , rotation"
    assert [where.slice(span) for span in hold.held_spans] == ["tilt", "rotation"]
    assert where.slice(move.span) == "MOVE P1, WRIST KEEP, wrist HOLD TILT,  ADVANCE, TIME 2"
    keep, option, time = move.options
    assert [where.slice(part.span) for part in (keep, time)] == ["WRIST KEEP", "TIME 2"]
    assert where.slice(option.span) == "wrist HOLD TILT,  ADVANCE"
    assert [where.slice(span) for span in option.held_spans] == ["TILT", "ADVANCE"]
    assert (where.slice(on.span), where.slice(on.sensor.span)) == ("SEAM ON, torch", "torch")
    assert (where.slice(off.span), where.slice(auto.span)) == ("SEAM OFF", "WRIST AUTO")
    assert statement("MOVE P1, WRIST HOLD TILT, ADVANCE ' x").span == Span(0, 33)


@pytest.mark.parametrize("end", ["\n", "\r", "\r\n"])
def test_line_ends(end):
    program = parsed(end.join(["MOVE P1", "MOVE P2", ""]))
    assert [line.source_line for line in program.lines] == [1, 2]


def test_one_parser_for_the_process():
    assert line_parser() is line_parser()


def test_the_listing_of_1992():
    path = Path(__file__).parents[3] / "programs" / "pick_and_place.rbl"
    program = parsed(path.read_text(encoding="utf-8"))
    kinds = [type(line.statement) for line in program.statements]
    assert kinds == [Load, Hand, Move, Hand, Load, Move, Move, Hand, Load, Move, Move]
    assert [line.number for line in program.statements] == list(range(10, 111, 10))


# --- the whole language ----------------------------------------------------------------------------------------------

FORMS = [
    ("MOVE P1 + (0, 0, 5), ZONE 5, FINE", "Move"),
    ("MOVEJ HERE, SPEED 5", "MoveJ"),
    ("MOVEC P1, P2", "MoveC"),
    ("MOVEC P1, P2, TIME 5, WRIST HOLD TILT, ADVANCE", "MoveC"),
    ("SPLINE (P1, P2)", "Spline"),
    ("SPLINE (P1, P2 * (0, 0, 5), q(1)), TIME 5, WRIST HOLD TILT, ADVANCE", "Spline"),
    ("SPLINE ( (P1) )", "Spline"),
    ("APPROACH P1, 50", "Approach"),
    ("APPROACH P1, d * 2, SPEED 5", "Approach"),
    ("DEPART 50", "Depart"),
    ("DEPART 50, FINE", "Depart"),
    ("LOAD (0, 0, 0), 1, (1, 2, 3, 4, 5, 6)", "Load"),
    ("LOAD part", "LoadNamed"),
    ("SPEED 5", "Setting"),
    ("SPEEDJ 5", "Setting"),
    ("ACCEL 5", "Setting"),
    ("ACCEL MAX", "Setting"),
    ("MOVE P1, ACCEL MAX, ZONE 5", "Move"),
    ("OVERRIDE 5", "Setting"),
    ("ZONE 5", "Setting"),
    ("TOOL gun", "Setting"),
    ("FRAME POSE(1, 2, 3, 4, 5, 6)", "Setting"),
    ("OUT(1) = 1", "Out"),
    ("PULSE 1, 0.5", "Pulse"),
    ("DELAY 1", "Delay"),
    ("WAIT IN(1) = 1", "Wait"),
    ("WAIT IN(1) = 1, TIMEOUT 5", "Wait"),
    ("WAIT IN(1) = 1, TIMEOUT 5, GOTO *L", "Wait"),
    ("WAIT IN(1) = 1, TIMEOUT 5, GOTO 100", "Wait"),
    ("x = 1", "Assign"),
    ('s$ = "a"', "Assign"),
    ("a(i + 1) = 1", "Assign"),
    ("DIM a(10)", "Dim"),
    ("CONST k = 1", "Const"),
    ("IF x THEN END", "If"),
    ("IF x THEN GOTO 10 ELSE y = 1", "If"),
    ("IF x THEN", "Head"),
    ("IF x", "Head"),
    ("ELSEIF x THEN", "Head"),
    ("ELSEIF x", "Head"),
    ("WHILE x", "Head"),
    ("SELECT x", "Head"),
    ("SELECT CASE x", "Head"),
    ("ELSE", "Block"),
    ("ENDIF", "Block"),
    ("WEND", "Block"),
    ("CASE ELSE", "Block"),
    ("ENDSELECT", "Block"),
    ("ENDSUB", "Block"),
    ("CASE 1", "Case"),
    ("CASE 1, 2 + 3", "Case"),
    ("FOR i = 1 TO 5", "For"),
    ("FOR i = 1 TO 5 STEP -1", "For"),
    ("NEXT", "Next"),
    ("NEXT i", "Next"),
    ("GOTO 10", "Jump"),
    ("GOTO *L", "Jump"),
    ("GOSUB 10", "Jump"),
    ("SUB s", "Sub"),
    ("SUB s()", "Sub"),
    ("SUB s(a, b$)", "Sub"),
    ("CALL s", "CallSub"),
    ("CALL s()", "CallSub"),
    ("CALL s(1, x + 2)", "CallSub"),
    *((word, "Word") for word in ("RETURN", "END", "STOP", "PAUSE", "RESUME", "RESUME NEXT", "ON ERROR STOP")),
    ("ON ERROR GOTO *L", "OnError"),
    ("ON ERROR GOTO 10", "OnError"),
    ("PRINT", "Print"),
    ("PRINT 1", "Print"),
    ('PRINT "a"; x; P1.X;', "Print"),
]


@pytest.mark.parametrize(("text", "kind"), FORMS, ids=[text for text, _ in FORMS])
def test_every_form_of_a_statement(text, kind):
    found = statement(text)
    assert type(found).__name__ == kind
    assert source(text).slice(found.span) == text.removesuffix(";")
    assert statement(text.lower()) == found or '"' in text
    (line,) = parsed(f"10 *top {text} ' x").lines
    assert (line.number, line.label.key, line.statement, line.comment.text) == (10, "TOP", found, "' x")
    if kind in ("Block", "Case", "Head", "For", "Next", "Sub", "If"):
        assert parse_found(f"IF 1 THEN {text}")[0][0] == "RBL111"
    else:
        assert type(statement(f"IF 1 THEN {text} ELSE {text}").otherwise).__name__ == kind


def test_optional_parts_are_told_apart():
    assert len({statement(text) for text in ("WAIT x", "WAIT x, TIMEOUT 5", "WAIT x, TIMEOUT 5, GOTO 1")}) == 3
    assert len({statement(text) for text in ("IF x THEN END", "IF x THEN END ELSE END", "IF x")}) == 3
    assert len({statement(text) for text in ("FOR i = 1 TO 2", "FOR i = 1 TO 2 STEP 1", "FOR j = 1 TO 2")}) == 3
    assert len({statement(text) for text in ("RESUME", "RESUME NEXT", "NEXT", "NEXT i", "RETURN")}) == 5
    assert len({statement(text) for text in ("MOVE P1", "MOVE P1, FINE", "MOVE P1, ZONE 0", "MOVEJ P1")}) == 4
    assert len({statement(text) for text in ("GOTO 1", "GOTO 2", "GOSUB 1", "GOTO *L")}) == 4
    assert statement("SUB s") == statement("SUB s()")
    assert statement("IF x THEN") == statement("IF x")
    assert statement("SELECT CASE x") == statement("SELECT x")
    assert [name.key for name in statement("SUB s(a, b$)").parameters] == ["A", "B$"]
    assert statement("GOTO 0010").target.number == 10


@pytest.mark.parametrize(
    ("text", "label", "kind"),
    [("*A", "A", None), ("*a_1 MOVE P1", "A_1", Move), ("* A ' x", "A", None), ("10 *A HAND ON", "A", Hand)],
)
def test_labels(text, label, kind):
    (line,) = parsed(text).lines
    assert line.label.key == label
    assert (line.statement if kind is None else type(line.statement)) is kind


@pytest.mark.parametrize(
    "text",
    [
        "MOVE XOR",
        "MOVEC XOR, xor + (0, 0, 1)",
        "FRAME XOR",
        "TOOL XOR",
        "LOAD XOR",
        "SEAM ON, XOR",
        "x = XOR XOR XOR",
        "XOR = 1",
        "*XOR XOR = 1",
        "*XOR XOR(1) = XOR(2)",
        "GOTO *XOR",
        "CALL XOR(XOR)",
        "FOR XOR = 1 TO XOR",
        "PRINT XOR.X",
        "IF XOR THEN XOR = 2 ELSE MOVE XOR, SPEED XOR",
        "IF 1 THEN *XOR",
    ],
)
def test_a_new_word_is_a_name_where_no_sign_can_stand(text):
    plain = text.replace("XOR XOR XOR", "a + b").replace("XOR", "a")
    codes = [[item[0] for item in parse_found(each)] for each in (text, plain)]
    assert codes[0] == codes[1] == (["RBL111"] if text == "IF 1 THEN *XOR" else [])


def test_a_point_may_have_the_name_of_a_new_word(tmp_path):
    (tmp_path / "p.points.toml").write_text("schema = 1\n[points.XOR]\npose = [450, -150, 200, 180, 0, 90]\n")
    assert load_points(tmp_path / "p.points.toml").get("XOR") is not None


def test_a_new_instruction_clashes_with_a_variable_in_one_error_that_names_it(monkeypatch):
    for module in ("line_reader", "line_errors"):
        monkeypatch.setattr(f"robolang.syntax.{module}.NEW", frozenset({"PULSE"}))
    for text in ("MOVE PULSE, SPEED PULSE", "*PULSE PULSE 1, 0.5", "FRAME PULSE", "x = PULSE + PULSE", "CALL f(PULSE)"):
        assert parse_found(text) == []
    assert parse_found("PULSE = 5") == [("RBL111", 1, 7, 1)]
    assert "PULSE" in fields(only("PULSE = 5").hint)
