from textwrap import dedent

import pytest

from robolang.core.source import MAX_BYTES
from robolang.syntax.formatter import MAX_INDENT, MAX_WIDTH, format_source
from robolang.syntax.parser import MAX_LINE
from tests.robolang.helpers import source


def formatted(text):
    """The formatted text of a program without errors; formatting it again changes nothing."""
    found = format_source(source(text))
    assert [item for item in found.diagnostics if item.code != "RBL110"] == []
    assert found.changed == (found.text != text)
    assert format_source(source(found.text)).text == found.text
    return found.text


BAD = """\
' Palletise: 3 x 4 parts from the feeder onto the pallet.
rem speeds in mm/s


load (0,0,60),.8 'hand only
const  rows=3'along x
const pitch = 60.0
speed 200


on error goto *Fault
for r=0 to rows-1
for c = 0 to 3
   ' wait for a part
wait in(1)=1 , timeout 10,goto *Empty
gosub *Take
target=pallet+(r*pitch,c*(pitch+10),0)
    select case (r+c) mod 2
case 0,2
approach target,80,wrist hold tilt , rotation
case else
approach target,80
endselect
move target,speed 50,fine 'slowly
hand off,.3
depart 80
if dist(here,target)<79.5 then print "moved only ";dist(here,target) else count=count+1
next c
next
*Done end

*Empty print "no more parts"
end

*Take if in(2) then
hand off
elseif not(in(3)=1)and in(4)=0 then
while in(3)
delay .1
wend
else
stop
endif
call Grip(0.5,P1)
return

*Fault print "error ";err
resume next
sub Grip(t,p)
move p+(0,0,20)
move p,speed 50
hand on,t
endsub
"""

GOOD = """\
' Palletise: 3 x 4 parts from the feeder onto the pallet.
REM speeds in mm/s


LOAD (0, 0, 60), .8  'hand only
CONST rows = 3       'along x
CONST pitch = 60.0
SPEED 200


ON ERROR GOTO *Fault
FOR r = 0 TO rows - 1
  FOR c = 0 TO 3
    ' wait for a part
    WAIT IN(1) = 1, TIMEOUT 10, GOTO *Empty
    GOSUB *Take
    target = pallet + (r * pitch, c * (pitch + 10), 0)
    SELECT (r + c) MOD 2
      CASE 0, 2
        APPROACH target, 80, WRIST HOLD TILT, ROTATION
      CASE ELSE
        APPROACH target, 80
    ENDSELECT
    MOVE target, SPEED 50, FINE  'slowly
    HAND OFF, .3
    DEPART 80
    IF DIST(HERE, target) < 79.5 THEN PRINT "moved only "; DIST(HERE, target) ELSE count = count + 1
  NEXT c
NEXT
*Done END

*Empty PRINT "no more parts"
END

*Take IF IN(2) THEN
  HAND OFF
ELSEIF NOT (IN(3) = 1) AND IN(4) = 0 THEN
  WHILE IN(3)
    DELAY .1
  WEND
ELSE
  STOP
ENDIF
CALL Grip(0.5, P1)
RETURN

*Fault PRINT "error "; ERR
RESUME NEXT
SUB Grip(t, p)
  MOVE p + (0, 0, 20)
  MOVE p, SPEED 50
  HAND ON, t
ENDSUB
"""


def test_a_page_of_a_real_program():
    assert formatted(BAD) == GOOD


def test_the_listing_of_1992():
    text = """\
        ' Pick and place.
        10 LOAD (0, 0, 60), 0.8        ' hand only
        20 HAND OFF                    ' open
        30 MOVE P1
        40 HAND ON                     ' close, grasp

        100 MOVE P4
        110 ' the end
        """
    assert formatted(dedent(text)) == dedent("""\
        ' Pick and place.
        10  LOAD (0, 0, 60), 0.8  ' hand only
        20  HAND OFF              ' open
        30  MOVE P1
        40  HAND ON               ' close, grasp

        100 MOVE P4
        110 ' the end
        """)


# --- the line number column and blocks -------------------------------------------------------------------------------


def test_lines_without_a_number_leave_the_column_blank():
    text = "' top\nFOR i = 1 TO 2\n' inside\n90 *L MOVE P1\n100\n*M\nNEXT\n' below\nGOTO 90\n"
    assert formatted(text) == dedent("""\
        ' top
            FOR i = 1 TO 2
              ' inside
        90    *L MOVE P1
        100
              *M
            NEXT
        ' below
            GOTO 90
        """)


def test_labels_stand_before_the_statement():
    assert formatted("10 *A   move p1\n*B\n*C 'x\n") == "10 *A MOVE p1\n   *B\n   *C  'x\n"


@pytest.mark.parametrize("words", ["NEXT", "ENDIF", "WEND", "ENDSELECT", "ENDSUB", "ELSE", "CASE 1", "CASE ELSE"])
def test_a_closing_word_without_its_head_moves_nothing(words):
    assert formatted(f"MOVE P1\n{words}\nMOVE P2\n") == f"MOVE P1\n{words}\nMOVE P2\n"
    inside = f"WHILE 1\n  {words}\n  MOVE P2\nWEND\n"
    assert formatted(inside) == (inside if words != "WEND" else "WHILE 1\nWEND\nMOVE P2\nWEND\n")


def test_a_closing_word_closes_what_is_open_inside_its_block():
    assert formatted("SUB f\nIF x\nFOR i = 1 TO 2\nMOVE P1\nENDSUB\nMOVE P2\n") == dedent("""\
        SUB f
          IF x THEN
            FOR i = 1 TO 2
              MOVE P1
        ENDSUB
        MOVE P2
        """)


def test_a_block_that_was_closed_from_outside_is_not_closed_again():
    text = "SUB f\n  IF x THEN\n    FOR i = 1 TO 2\nENDSUB\nWHILE 1\n  NEXT\n  ENDIF\nWEND\nNEXT\n"
    assert formatted(text) == text


def test_a_select_inside_a_case():
    text = (
        "SELECT a\n  CASE 1\n    SELECT b\n      CASE 2\n        MOVE P1\n    ENDSELECT\n  CASE ELSE\nENDSELECT\nEND\n"
    )
    assert formatted(text) == text


def test_a_one_line_if_is_no_block():
    assert formatted("IF x THEN MOVE P1\nMOVE P2\n") == "IF x THEN MOVE P1\nMOVE P2\n"


def test_indentation_ends_at_a_depth_nobody_reads():
    depth = MAX_INDENT + 5
    lines = formatted("WHILE 1\n" * depth + "MOVE P1\n" + "WEND\n" * depth).splitlines()
    assert [len(line) - len(line.lstrip()) for line in lines] == [
        2 * min(level, MAX_INDENT) for level in [*range(depth + 1), *reversed(range(depth))]
    ]


# --- comments --------------------------------------------------------------------------------------------------------


def test_comments_of_lines_that_follow_one_another_share_a_column():
    text = dedent("""\
        MOVE P1  ' a
        MOVE P1, SPEED 200
        HAND ON  ' b
        x = 1    ' c

        MOVE P1, SPEED 200  ' d
        ' alone
        HAND ON  ' e
        """)
    assert formatted(text.replace("    '", "'").replace("  '", "'")) == text


def test_a_comment_that_would_be_pushed_too_far_begins_a_column_of_its_own():
    short, long = "HAND ON", "MOVE P1" + ", SPEED 1" * 5
    exact = MAX_WIDTH - len(long) - 2
    assert formatted(f"{long}'x\n{short}'{'y' * (exact - 1)}\n") == (
        f"{long}  'x\n{short.ljust(len(long))}  '{'y' * (exact - 1)}\n"
    )
    assert formatted(f"{long}'x\n{short}'{'y' * exact}\n") == f"{long}  'x\n{short}  '{'y' * exact}\n"


def test_a_line_that_is_too_wide_by_itself_has_its_comment_behind_two_spaces():
    assert formatted("HAND ON'" + "y" * 200 + "\nMOVE P1'z\nHAND ON'w\n").splitlines()[1:] == [
        "MOVE P1  'z",
        "HAND ON  'w",
    ]


def test_rem_is_capitalised_and_stays():
    assert formatted("rem  as Written \nmove p1 rem x\n10 Rem\n") == ("REM  as Written\n   MOVE p1  REM x\n10 REM\n")


# --- blank lines and line ends ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", ""),
        ("\n", ""),
        (" \t\n\n", ""),
        ("MOVE P1", "MOVE P1\n"),
        ("MOVE P1\n\n \n", "MOVE P1\n"),
        ("MOVE P1\n \n\t\n\n\nMOVE P2", "MOVE P1\n\n\nMOVE P2\n"),
        ("\nMOVE P1\n", "\nMOVE P1\n"),
        ("MOVE P1\r\n\r\nMOVE P2", "MOVE P1\r\n\r\nMOVE P2\r\n"),
        ("MOVE P1\rMOVE P2\r", "MOVE P1\rMOVE P2\r"),
        ("MOVE P1\r\nMOVE P2\nMOVE P3\r", "MOVE P1\r\nMOVE P2\r\nMOVE P3\r\n"),
    ],
)
def test_blank_lines_and_line_ends(text, expected):
    assert formatted(text) == expected


# --- what stays as it is ---------------------------------------------------------------------------------------------


def test_a_line_that_does_not_parse_is_kept_and_the_others_are_formatted():
    found = format_source(source("move p1 'a\n  30 MOV  p1 ' b \n\thand on'c\n"))
    assert found.text == "MOVE p1  'a\n  30 MOV  p1 ' b \n   HAND ON  'c\n".replace("MOVE", "   MOVE")
    assert [item.code for item in found.diagnostics] == ["RBL112"]


def assert_left_alone(found, text):
    """Nothing has changed; said without a comparison of long texts, which takes for ever to explain."""
    assert not found.changed
    assert len(found.text) == len(text)
    assert found.text is text


def test_more_errors_than_are_listed_keep_the_rest():
    text = "MOV\n" * 1500 + "move p1\n"
    found = format_source(source(text))
    assert not found.changed
    assert found.text.endswith("MOV\nmove p1\n")


def test_a_target_that_is_no_line_is_kept_as_spelt():
    text = "  goto 1.5\nif x then gosub 1e3\n"
    assert format_source(source(text)).text == text


def test_between_off_and_on_lines_are_kept():
    text = dedent("""\
        move p1
          ' fmt: off
         table( 1)=5
         for i=1 to 3



         table(10)=7
          rem FMT:on
        move p2
        next
        move p3
        """)
    assert formatted(text) == dedent("""\
        MOVE p1
        ' fmt: off
         table( 1)=5
         for i=1 to 3



         table(10)=7
          REM FMT:on
          MOVE p2
        NEXT
        MOVE p3
        """)


@pytest.mark.parametrize("comment", ["' fmt: offline", "MOVE P1 ' fmt: off", "' not fmt: off", "*L ' fmt: off"])
def test_other_comments_switch_nothing_off(comment):
    assert formatted(f"{comment}\nmove p1\n").endswith("\nMOVE p1\n")


def test_off_to_the_end_keeps_blank_lines_and_gives_a_final_line_end():
    assert formatted("'fmt:off\nmove p1 \n\n\n\n") == "'fmt:off\nmove p1 \n\n\n\n"
    assert formatted("'fmt:off\nmove p1") == "'fmt:off\nmove p1\n"


def test_a_line_that_would_become_too_long_is_kept():
    long = "PRINT 1" + ";1" * ((MAX_LINE - 7) // 2)
    assert formatted(f"{long}\nmove p1\n") == f"{long}\nMOVE p1\n"
    assert formatted("print 1" + ";1" * 3000) == "PRINT 1" + "; 1" * 3000 + "\n"


def test_a_program_that_would_outgrow_the_language_is_left_alone():
    text = "WHILE 1\n" * MAX_INDENT + "'\n" * (MAX_BYTES // (2 * MAX_INDENT))  # each comment moves by 40 columns
    found = format_source(source(text))
    assert_left_alone(found, text)
    assert [item.code for item in found.diagnostics] == ["RBL106"]


def test_a_program_that_is_too_large_is_left_alone():
    text = "\n" * (MAX_BYTES + 1)
    found = format_source(source(text))
    assert_left_alone(found, text)
    assert {item.code for item in found.diagnostics} == {"RBL106"}


def test_mixed_line_ends_are_noted_and_put_right():
    found = format_source(source("MOVE P1\r\nMOVE P2\n"))
    assert found.text == "MOVE P1\r\nMOVE P2\r\n"
    assert [item.code for item in found.diagnostics] == ["RBL110"]
