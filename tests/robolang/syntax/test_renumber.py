from textwrap import dedent

import pytest

from robolang.core.source import MAX_BYTES
from robolang.syntax.parser import MAX_LINE
from robolang.syntax.renumber import MAX_NUMBER, remove_numbers, renumber
from runtime.core.faults import Fault
from tests.messages import fields
from tests.robolang.helpers import places, source

TEXT = """\
' line 7 is where the work is
  7  *Start move  p1 ' goto 7
IF x=1 THEN goto 007 ELSE GOSUB 100
  \twait in(1)=1, timeout 5 ,goto 30

 *Only
30 ' here
on error goto 30
on error goto *Start
5'comment
5000
GOTO *Only

\tREM 7
100 RETURN
"""


def test_jumps_follow_their_lines_and_nothing_else_changes():
    found = renumber(source(TEXT))
    assert found.text == dedent("""\
        ' line 7 is where the work is
          10  *Start move  p1 ' goto 7
        20 IF x=1 THEN goto 10 ELSE GOSUB 110
        30   \twait in(1)=1, timeout 5 ,goto 50

        40  *Only
        50 ' here
        60 on error goto 50
        70 on error goto *Start
        80'comment
        90
        100 GOTO *Only

        \tREM 7
        110 RETURN
        """)
    assert (found.changed, found.lines, found.targets, found.diagnostics) == (True, 11, 4, ())


def test_start_and_step():
    assert renumber(source("MOVE P1\r\n10 GOTO 10\r\n"), start=1, step=1).text == "1 MOVE P1\r\n2 GOTO 2\r\n"
    assert renumber(source("MOVE P1\rEND"), start=0, step=100).text == "0 MOVE P1\r100 END"


@pytest.mark.parametrize("text", ["", "\n\n", "' x\n", "10 MOVE P1\n20 GOTO 10\n' x\n30", "10 *L\n"])
def test_what_is_numbered_already_stays(text):
    found = renumber(source(text))
    assert (found.text, found.changed, found.lines, found.targets) == (text, False, 0, 0)


def test_lines_out_of_order_are_put_in_order():
    text = "30 MOVE P1\n20 GOTO 30\n10 GOTO 20\n"
    assert renumber(source(text)).text == "10 MOVE P1\n20 GOTO 10\n30 GOTO 20\n"


def test_the_number_of_a_line_far_behind():
    text = "GOTO 999999999\n" * 3 + "999999999 END\n"
    assert renumber(source(text)).text == "10 GOTO 40\n20 GOTO 40\n30 GOTO 40\n40 END\n"


def refused(text, work=renumber):
    found = work(source(text))
    assert (found.changed, found.lines, found.targets) == (False, 0, 0)
    assert found.text is text
    return places(text, found.diagnostics)


@pytest.mark.parametrize("work", [renumber, remove_numbers])
def test_refusals(work):
    assert refused("10 MOVE P1\n20 GOTO 30\n", work) == [("RBL202", 2, 9, 2)]
    assert refused("IF x THEN GOTO 1.5 ELSE ON ERROR GOTO 2\n", work) == [("RBL202", 1, 16, 3), ("RBL202", 1, 39, 1)]
    assert refused("10 MOVE P1\n 010 MOVE P2\n10\n", work) == [("RBL113", 2, 2, 3), ("RBL113", 3, 1, 2)]
    assert refused("10 MOV P1\n20 GOTO 30\n", work) == [("RBL112", 1, 4, 3)]


def test_a_duplicate_shows_the_first_one_too():
    text = "10 MOVE P1\n10 MOVE P2\n"
    (item,) = renumber(source(text)).diagnostics
    assert source(text).place(item.related[0].span.start).line == 1


def test_a_target_that_is_missing_is_named_as_spelt():
    (item,) = renumber(source("GOTO 1.5")).diagnostics
    assert "1.5" in fields(item.message)


def test_a_number_has_at_most_nine_digits():
    text = source("MOVE P1\nMOVE P2\n")
    assert renumber(text, start=1, step=MAX_NUMBER - 1).text == f"1 MOVE P1\n{MAX_NUMBER} MOVE P2\n"
    with pytest.raises(Fault, match="RBL703"):
        renumber(text, start=2, step=MAX_NUMBER - 1)


def test_a_result_that_the_language_would_not_read_is_refused():
    text = "MOVE P1\nPRINT " + "1" * (MAX_LINE - 6)
    assert refused(text)[0][:2] in (("RBL105", 2), ("RBL114", 2))
    text = "MOVE P1\nMOVE P1 '" + "-" * (MAX_LINE - 9)
    assert refused(text) == [("RBL105", 2, 1, MAX_LINE)]
    text = "END\n" + ("'" * (MAX_LINE - 1) + "\n") * (MAX_BYTES // MAX_LINE)
    text = f"{text[: MAX_BYTES - 1]}\n"
    assert len(text) == MAX_BYTES
    assert refused(text) == [("RBL106", 1, 1, 0)]


def test_numbers_that_no_jump_leads_to_are_removed():
    text = " 10  MOVE P1\n20 GOTO 30\n25'x\n30 HAND ON\n40\n50 *L\n60\tEND\n"
    found = remove_numbers(source(text))
    assert found.text == "  MOVE P1\nGOTO 30\n'x\n30 HAND ON\n\n*L\nEND\n"
    assert (found.changed, found.lines, found.targets) == (True, 6, 0)
    assert not remove_numbers(source(found.text)).changed
