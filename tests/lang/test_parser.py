import logging
from pathlib import Path

import lark
import pytest

import robolang.parser as parser_module
from robolang.diagnostics import MAX_DIAGNOSTICS, Severity
from robolang.nodes import (
    Accel,
    Component,
    Hand,
    HandState,
    Load,
    Move,
    Name,
    Negate,
    Number,
    Seam,
    Speed,
    Time,
    Unparsed,
    Vector,
    Wrist,
    WristMode,
)
from robolang.parser import MAX_DEPTH, MAX_LINE, parse
from robolang.printer import describe
from robolang.source import Span
from robolang.words import FUNCTIONS, KEYWORDS, VALUES
from tests.lang.helpers import only, parse_found, parsed, source

WRIST_FORM = "WRIST KEEP, WRIST AUTO or WRIST HOLD component [, component]"


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
    ["WRIST KEEP", "WRIST AUTO", "WRIST HOLD TILT, ADVANCE", "SEAM ON, torch", "SEAM OFF", "MOVE P1, WRIST KEEP",
     "MOVE P1, SPEED 100, WRIST HOLD TILT, ADVANCE, TIME 3"],
)  # fmt: skip
def test_wrist_and_seam_have_one_canonical_text(text):
    assert describe(statement(text)) == text
    assert describe(statement(text.replace("torch", "TORCH").lower())).upper() == text.upper()
    assert statement(text.lower().replace(",", " ,").replace(" ", "\t ")) == statement(text)


def test_no_word_is_of_this_edition_and_of_a_later_one():
    assert {"WRIST", "SEAM", "KEEP", "AUTO", "HOLD", "TILT", "ADVANCE", "ROTATION"} <= KEYWORDS
    assert not KEYWORDS & FUNCTIONS
    assert not (KEYWORDS | FUNCTIONS) & VALUES


def conflicts(grammar, caplog):
    """What Lark says on its log only: it settles a conflict of shift and reduce for one side."""
    with caplog.at_level(logging.DEBUG, logger="lark"):
        lark.Lark(grammar, parser="lalr", lexer="basic", start=["start"], debug=True)
    return [record.message for record in caplog.records if "conflict" in record.message]


def test_the_grammar_is_lalr_1_without_a_conflict(caplog):
    assert conflicts(Path(parser_module.__file__).with_name("grammar.lark").read_text(encoding="utf-8"), caplog) == []
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


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("MOVE", ("RBL111", 1, 5, 0)),
        ("MOVE  ' go", ("RBL111", 1, 5, 0)),
        ("MOVE P1 P2", ("RBL111", 1, 9, 2)),
        ("MOVE )", ("RBL111", 1, 6, 1)),
        ("MOVE P1,", ("RBL111", 1, 9, 0)),
        ("MOVE P1, SPED 3", ("RBL111", 1, 10, 4)),
        ("MOVE P1, SPEED", ("RBL111", 1, 15, 0)),
        ("MOVE P1 SPEED 3", ("RBL111", 1, 9, 5)),
        ("MOVE LOAD", ("RBL111", 1, 6, 4)),
        ("HAND", ("RBL111", 1, 5, 0)),
        ("HAND ON 3", ("RBL111", 1, 9, 1)),
        ("LOAD 1", ("RBL111", 1, 6, 1)),
        ("LOAD (0), 1", ("RBL111", 1, 8, 1)),
        ("LOAD (0, 0, 60)", ("RBL111", 1, 16, 0)),
        ("LOAD (0, 0, 60), ", ("RBL111", 1, 17, 0)),
        ("WRIST", ("RBL111", 1, 6, 0)),
        ("WRIST ' x", ("RBL111", 1, 6, 0)),
        ("WRIST FREE", ("RBL111", 1, 7, 4)),
        ("WRIST TILT", ("RBL111", 1, 7, 4)),
        ("WRIST KEEP AUTO", ("RBL111", 1, 12, 4)),
        ("WRIST KEEP, TILT", ("RBL111", 1, 11, 1)),
        ("WRIST HOLD", ("RBL111", 1, 11, 0)),
        ("WRIST HOLD SPEED", ("RBL111", 1, 12, 5)),
        ("WRIST HOLD TILT,", ("RBL111", 1, 17, 0)),
        ("WRIST HOLD TILT, SPEED 5", ("RBL111", 1, 18, 5)),
        ("WRIST HOLD TILT ADVANCE", ("RBL111", 1, 17, 7)),
        ("MOVE P1, WRIST", ("RBL111", 1, 15, 0)),
        ("MOVE P1, WRIST FREE", ("RBL111", 1, 16, 4)),
        ("MOVE P1, WRIST HOLD", ("RBL111", 1, 20, 0)),
        ("MOVE P1, WRIST HOLD SPEED 5", ("RBL111", 1, 21, 5)),
        ("MOVE P1, WRIST HOLD TILT,", ("RBL111", 1, 26, 0)),
        ("MOVE P1, WRIST HOLD TILT, SPEED 5, ADVANCE", ("RBL111", 1, 36, 7)),
        ("MOVE P1, WRIST KEEP, TILT", ("RBL111", 1, 22, 4)),
        ("MOVE P1, TILT", ("RBL111", 1, 10, 4)),
        ("MOVE TILT", ("RBL111", 1, 6, 4)),
        ("MOVE Advance", ("RBL111", 1, 6, 7)),
        ("MOVE rotation", ("RBL111", 1, 6, 8)),
        ("HOLD TILT", ("RBL111", 1, 1, 4)),
        ("SEAM", ("RBL111", 1, 5, 0)),
        ("SEAM torch", ("RBL111", 1, 6, 5)),
        ("SEAM ON", ("RBL111", 1, 8, 0)),
        ("SEAM ON torch", ("RBL111", 1, 9, 5)),
        ("SEAM ON,", ("RBL111", 1, 9, 0)),
        ("SEAM ON, 5", ("RBL111", 1, 10, 1)),
        ("SEAM ON, SEAM", ("RBL111", 1, 10, 4)),
        ("SEAM ON, HERE", ("RBL111", 1, 10, 4)),
        ("SEAM OFF, torch", ("RBL111", 1, 9, 1)),
        ("WRISTKEEP", ("RBL112", 1, 1, 9)),
        ("10.5 MOVE P1", ("RBL111", 1, 1, 4)),
        ("OFF", ("RBL111", 1, 1, 3)),
        ("/", ("RBL111", 1, 1, 1)),
        ("30 MOV P1", ("RBL112", 1, 4, 3)),
        ("MOVEP1", ("RBL112", 1, 1, 6)),
        ("__import__", ("RBL112", 1, 1, 10)),
        ("MOVE P1, SPEED 1E999", ("RBL114", 1, 16, 5)),
        ("HAND ON, " + "9" * 5000, ("RBL114", 1, 10, 5000)),
        ("1234567890 MOVE P1", ("RBL114", 1, 1, 10)),
        ("9" * 5000 + " MOVE P1", ("RBL114", 1, 1, 5000)),
        ("HAND ON, 1_000", ("RBL115", 1, 10, 5)),
        ("HAND ON, 1.2.3", ("RBL115", 1, 10, 5)),
        ("HAND ON, 1E", ("RBL115", 1, 10, 2)),
        ("HAND ON, 0x1F", ("RBL115", 1, 10, 4)),
        ("LOAD (0, 0, 60), 800g", ("RBL115", 1, 18, 4)),
        ("10MOVE P1", ("RBL115", 1, 1, 6)),
        ("МOVE P1", ("RBL103", 1, 1, 1)),
        ("MOVЕ P1", ("RBL103", 1, 4, 1)),
        ("MOVE Р1", ("RBL103", 1, 6, 1)),
        ("MOVE\u00a0P1", ("RBL103", 1, 5, 1)),
        ("MOVE P1 ’ x", ("RBL103", 1, 9, 1)),
        ("HAND ON, １", ("RBL103", 1, 10, 1)),
        ("HAND ON, 1é", ("RBL103", 1, 11, 1)),
        ("MOVE P1 ' a\u202eb", ("RBL103", 1, 12, 1)),
        ("' \x1b[2J", ("RBL103", 1, 3, 1)),
        ("\x0c", ("RBL103", 1, 1, 1)),
    ],
)
def test_bad_lines(text, found):
    assert parse_found(text) == [found]
    (line,) = parse(source(text)).program.lines
    assert isinstance(line.statement, Unparsed)


@pytest.mark.parametrize(
    ("text", "message", "hint"),
    [
        ("MOVE", "expected a point after MOVE", "the form is MOVE"),
        ("MOVE P1 P2", "expected ',' or the end of the line after P1, not P2", "one instruction on each line"),
        ("MOVE P1 SPEED 3", "expected ',' or the end of the line after P1, not SPEED", "a comma before SPEED"),
        (
            "MOVE P1, SPED 3",
            "expected SPEED, ACCEL, TIME, ZONE, FINE or WRIST after ',', not SPED",
            "did you mean SPEED?",
        ),
        ("MOVE P1, FREE", "expected SPEED, ACCEL, TIME, ZONE, FINE or WRIST after ',', not FREE", "[, WRIST mode]"),
        (
            "MOVE P1, WRST KEEP",
            "expected SPEED, ACCEL, TIME, ZONE, FINE or WRIST after ',', not WRST",
            "did you mean WRIST?",
        ),
        ("MOVE P1 WRIST KEEP", "expected ',' or the end of the line after P1, not WRIST", "a comma before WRIST"),
        ("HAND ON WRIST KEEP", "expected ',' or the end of the line after ON, not WRIST", "one instruction on each"),
        ("MOVE TILT", "expected a point after MOVE, not TILT", "TILT is a word of the language and cannot be a"),
        ("wrist", "expected KEEP, AUTO or HOLD after WRIST", f"the form is {WRIST_FORM}"),
        ("WRIST FREE", "expected KEEP, AUTO or HOLD after WRIST, not FREE", f"the form is {WRIST_FORM}"),
        ("WRIST KEPT", "expected KEEP, AUTO or HOLD after WRIST, not KEPT", "did you mean KEEP?"),
        ("WRIST HOLD", "expected TILT, ADVANCE or ROTATION after HOLD", f"the form is {WRIST_FORM}"),
        ("WRIST HOLD SPEED", "expected TILT, ADVANCE or ROTATION after HOLD, not SPEED", f"the form is {WRIST_FORM}"),
        ("WRIST HOLD TILTED", "expected TILT, ADVANCE or ROTATION after HOLD, not TILTED", "did you mean TILT?"),
        ("WRIST HOLD TILT, FREE", "expected TILT, ADVANCE or ROTATION after ',', not FREE", f"form is {WRIST_FORM}"),
        ("WRIST HOLD TILT ADVANCE", "expected ',' or the end of the line after TILT, not ADVANCE", "before ADVANCE"),
        ("WRIST KEEP TILT", "expected the end of the line after KEEP, not TILT", f"the form is {WRIST_FORM}"),
        ("WRIST KEEP MOVE P1", "expected the end of the line after KEEP, not MOVE", "one instruction on each line"),
        ("MOVE P1, WRIST", "expected KEEP, AUTO or HOLD after WRIST", f"the form is {WRIST_FORM}"),
        ("MOVE P1, WRIST HOLD 5", "expected TILT, ADVANCE or ROTATION after HOLD, not 5", f"the form is {WRIST_FORM}"),
        (
            "MOVE P1, WRIST HOLD TILT, ADVNCE",
            "expected SPEED, ACCEL, TIME, ZONE, FINE, WRIST, TILT, ADVANCE or ROTATION after ',', not ADVNCE",
            "did you mean ADVANCE?",
        ),
        ("MOVE P1, WRIST HOLD TILT SPEED 5", "expected ',' or the end of the line after TILT, not SPEED", "a comma"),
        ("MOVE P1, WRIST KEEP TILT", "expected ',' or the end of the line after KEEP, not TILT", "the form is MOVE"),
        ("seam", "expected ON or OFF after SEAM", "the form is SEAM ON, sensor or SEAM OFF"),
        ("SEAM CLOSE", "expected ON or OFF after SEAM, not CLOSE", "the form is SEAM ON, sensor or SEAM OFF"),
        ("SEAM ON", "expected ',' after ON", "the form is SEAM ON, sensor or SEAM OFF"),
        ("SEAM ON,", "expected a sensor name after ','", "the form is SEAM ON, sensor or SEAM OFF"),
        ("SEAM ON, 5", "expected a sensor name after ',', not 5", "the form is SEAM ON, sensor or SEAM OFF"),
        ("SEAM ON, HERE", "expected a sensor name after ',', not HERE", "HERE is a word of the language and cannot be"),
        ("SEAM ON, TILT", "expected a sensor name after ',', not TILT", "TILT is a word of the language and cannot be"),
        ("WRITS KEEP", "unknown instruction 'WRITS'", "did you mean WRIST?"),
        ("WRISTKEEP", "unknown instruction 'WRISTKEEP'", "did you mean WRIST KEEP?"),
        ("SEAMOFF", "unknown instruction 'SEAMOFF'", "did you mean SEAM OFF?"),
        ("MOVE P1, SPEED", "expected a value after SPEED", "the form is MOVE"),
        ("MOVE LOAD", "expected a point after MOVE, not LOAD", "cannot be a name"),
        ("hand", "expected ON or OFF after HAND", "the form is HAND"),
        ("HAND OPEN", "expected ON or OFF after HAND, not OPEN", "HAND OFF opens the hand"),
        ("HAND ONN", "expected ON or OFF after HAND, not ONN", "did you mean ON?"),
        ("LOAD 1", "expected a name or '(' after LOAD, not 1", "the form is LOAD (x, y, z), mass"),
        ("LOAD(0, 0 SPEED", "expected ')' or ',' after 0, not SPEED", "the form is LOAD (x, y, z), mass"),
        ("10.5 MOVE P1", "expected an instruction, not 10.5", "whole number"),
        ("MOV P1", "unknown instruction 'MOV'", "did you mean MOVE?"),
        ("HANDON", "unknown instruction 'HANDON'", "did you mean HAND ON?"),
        ("movep1", "unknown instruction 'movep1'", "leave a space: MOVE P1"),
        ("OPEN", "unknown instruction 'OPEN'", "HAND OFF opens the hand"),
        ("QQQQ", "unknown instruction 'QQQQ'", "such as MOVE, LOAD, HAND or IF, or with name = value"),
        ("X = ", "expected a value after '='", ""),
        ("X", "unknown instruction 'X'", "or with name = value"),
        ("abs = 5", "expected an instruction, not abs", "ABS is a word of the language and cannot be a name"),
        ("move = 5", "expected a point after MOVE, not '='", "MOVE is a word of the language and cannot be a name"),
        ("END IF", "expected the end of the line after END, not IF", "did you mean ENDIF?"),
        ("ELSE IF x", "expected the end of the line after ELSE, not IF", "did you mean ELSEIF?"),
        ("DEPART", "expected a value after DEPART", "the form is DEPART mm"),
        ("MOVEC P1 P2", "expected ',' after P1, not P2", "the form is MOVEC via, point"),
        ("WAIT x, 5", "expected TIMEOUT after ',', not 5", "the form is WAIT condition [, TIMEOUT s [, GOTO target]]"),
        ("GOTO L", "expected a line number or *LABEL after GOTO, not L", "the form is GOTO line or GOTO *LABEL"),
        ("FOR i = 1", "expected TO after 1", "the form is FOR v = a TO b [STEP s]"),
        ("WHILE", "expected a value after WHILE", "the form is WHILE condition"),
        ('x = "abc', "expected a value after '=', not '\"'", 'a text ends with "'),
        (
            "IF 1 THEN IF 2 THEN MOVE P1",
            "expected an instruction or the end of the line after THEN, not IF",
            "on a line",
        ),
        ("IF 1 THEN MOVE P1 ELSE", "expected an instruction after ELSE", "the form is IF condition THEN statement"),
        ("HAND ON, 1_000", "'1_000' is not a number", "write 1000"),
        ("LOAD (0, 0, 60), 800g", "'800g' is not a number", "masses in kg"),
        ("10MOVE P1", "'10MOVE' is not a number", "leave a space"),
        ("МOVE P1", "suspicious character U+041C CYRILLIC CAPITAL LETTER EM", "looks like 'M'"),
        ("' \u202e", "suspicious character U+202E RIGHT-TO-LEFT OVERRIDE", "direction"),
    ],
)
def test_messages_speak_of_the_language(text, message, hint):
    diagnostic = only(text)
    assert diagnostic.message == message
    assert hint in diagnostic.hint


def test_a_long_word_is_cut_in_the_message():
    assert len(only("M" * 9000).message) < 100


def test_comments_may_hold_any_script():
    parsed("MOVE P1 ' 点へ移動 é Привет 👩‍🏭\nREM ’ × −")


def test_several_errors_in_one_pass():
    text = "10 MOV P1\n20 MOVE P1\n30 MOVE\n40 HAND ON\n50 LOAD (1), 3\n"
    assert parse_found(text) == [("RBL112", 1, 4, 3), ("RBL111", 3, 8, 0), ("RBL111", 5, 11, 1)]
    program = parse(source(text)).program
    assert [line.number for line in program.lines] == [10, 20, 30, 40, 50]
    assert isinstance(program.lines[1].statement, Move)
    assert program.lines[0].statement == Unparsed(text="MOV P1")


def test_mixed_line_ends_are_an_information_at_the_first_other_one():
    result = parse(source("MOVE P1\nMOVE P2\r\nMOVE P3\r"))
    (item,) = result.diagnostics
    assert (item.code, item.severity, item.span) == ("RBL110", Severity.INFO, Span(15, 15))
    assert len(result.program.statements) == 3


def nested(depth):
    return "LOAD " + "(" * depth


def test_nesting_is_bounded_before_parsing():
    assert parse_found(nested(MAX_DEPTH))[0][0] == "RBL111"
    assert parse_found(nested(MAX_DEPTH + 1)) == [("RBL108", 1, 6 + MAX_DEPTH, 1)]
    assert parse_found(nested(100_000)) == [("RBL108", 1, 6 + MAX_DEPTH, 1)]


def test_signs_are_nesting():
    parsed("HAND ON, " + "-" * MAX_DEPTH + "1")
    assert parse_found("HAND ON, " + "- " * 100_000 + "1") == [("RBL108", 1, 10 + 2 * MAX_DEPTH, 1)]


def test_nesting_in_a_comment_does_not_count():
    parsed("MOVE P1 ' " + "(-" * 1000 + "\nREM " + "-" * 5000)


def test_long_expression():
    text = "HAND ON, " + "1+" * 100_000 + "1"
    assert [item[:3] for item in parse_found(text)] == [("RBL109", 1, 1)]


def test_line_length_limit_is_exact():
    parsed("'" * MAX_LINE)
    assert parse_found("'" * (MAX_LINE + 3)) == [("RBL105", 1, MAX_LINE + 1, 3)]


def test_source_size_limit_is_exact():
    parsed("\n" * 1_000_000)
    assert parse_found("\n" * 1_000_001) == [("RBL106", 1, 1, 0)]


def test_the_list_of_problems_is_bounded():
    result = parse(source("MOV\n" * 5000))
    assert len(result.diagnostics) == MAX_DIAGNOSTICS + 1
    assert result.diagnostics[-1].code == "RBL107"


def test_one_parser_for_the_process():
    assert parser_module._parser() is parser_module._parser()


def test_the_listing_of_1992():
    path = Path(__file__).parents[2] / "programs" / "pick_and_place.rbl"
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
    ("APPROACH P1, 50", "Approach"),
    ("APPROACH P1, d * 2, SPEED 5", "Approach"),
    ("DEPART 50", "Depart"),
    ("DEPART 50, FINE", "Depart"),
    ("LOAD (0, 0, 0), 1, (1, 2, 3, 4, 5, 6)", "Load"),
    ("LOAD part", "LoadNamed"),
    ("SPEED 5", "Setting"),
    ("SPEEDJ 5", "Setting"),
    ("ACCEL 5", "Setting"),
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
    ["*", "*5", "*MOVE", "*A *B", "IF x THEN IF y THEN END", "IF x THEN FOR i = 1 TO 2", "IF x THEN END ELSE",
     "x = 1 = 2 = 3", "x == 1", "x = 1 +", "x = (1", "x = ()", "x = ABS", "x = ABS()", "x = P1.", "x = P1.5", "x =",
     'x = "a', "1 = x", "HERE = 5", "FOR abs = 1 TO 2", "GOTO x", "GOTO", "CALL s(", "CALL s(1,)", "SUB s(1)",
     "SUB s(a,)", "WAIT x, GOTO 5", "WAIT x, TIMEOUT", "CASE", "CASE 1,", "PRINT 1, 2", "PRINT ;", "PRINT 1 2",
     "OUT 1 = 2", "OUT(1)", "DIM a", "DIM a(1, 2)", "CONST k", "RESUME 5", "ON ERROR", "ON x GOTO 5", "FINE",
     "END IF", "MOVE P1, ZONE", "MOVEC P1", "APPROACH P1", "DEPART", "TIME 5", "HOLD TILT", "NEXT 5", "x = NOT",
     "x = 1 MOD", "x = 2 ^", "x = (1, )", "x = a.b.c"],
)  # fmt: skip
def test_what_is_no_statement(text):
    ((code, line, column, length),) = parse_found(text)
    assert (code, line) == ("RBL111", 1)
    assert 1 <= column <= len(text) + 1
    assert column + length <= len(text) + 1
    assert only(text).hint
