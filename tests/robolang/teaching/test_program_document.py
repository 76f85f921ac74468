from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolang.analysis.analysis import Analysis
from robolang.teaching.documents import Documents
from robolang.teaching.line_map import LineMap, lines_between, program_lines
from robolang.teaching.program_document import change_line, delete_line, insert_line, put_line
from tests.campaign import examples
from tests.robolang.teaching.desks import refused

NUMBERED = "' head\n10 DELAY 1\n20 DELAY 2\n\n' about 30\n*AGAIN\n30 DELAY 3"


def documents(program):
    return Documents(path=Path("P.rbl"), program=program, points=None, cell=None, cell_path=Path("P.cell.toml"))


@pytest.mark.parametrize(
    ("line", "expected", "moved"),
    [
        ("20 DELAY 9", NUMBERED.replace("DELAY 2", "DELAY 9"), (0, 1, 2, 3, 4, 5)),
        ("020 DELAY 9", NUMBERED.replace("20 DELAY 2", "020 DELAY 9"), (0, 1, 2, 3, 4, 5)),
        ("30 DELAY 9", NUMBERED.replace("DELAY 3", "DELAY 9"), (0, 1, 2, 3, 4, 5)),
        ("15 DELAY 9", NUMBERED.replace("20", "15 DELAY 9\n20"), (0, 1, 3, 4, 5, 6)),
        ("5 DELAY 9", NUMBERED.replace("10 D", "5 DELAY 9\n10 D"), (0, 2, 3, 4, 5, 6)),
        ("25 DELAY 9", NUMBERED.replace("' about", "25 DELAY 9\n' about"), (0, 1, 2, 4, 5, 6)),
        ("40 DELAY 9", NUMBERED + "\n40 DELAY 9\n", (0, 1, 2, 3, 4, 5)),
        ("10", NUMBERED.replace("10 DELAY 1\n", ""), (0, None, 1, 2, 3, 4)),
        ("  30  ", NUMBERED.replace("30 DELAY 3", ""), (0, 1, 2, 3, 4, None)),
        ("20 ' nothing", NUMBERED.replace("20 DELAY 2", "20 ' nothing"), (0, 1, 2, 3, 4, 5)),
        ("20 MOVE (", NUMBERED.replace("20 DELAY 2", "20 MOVE ("), (0, 1, 2, 3, 4, 5)),
    ],
)
def test_a_numbered_line_goes_where_its_number_belongs(line, expected, moved):
    for end in ("\n", "\r\n"):
        new, lines = put_line(documents(NUMBERED.replace("\n", end)), line)
        assert new.program == expected.replace("\n", end)
        assert tuple(lines.of(index) for index in range(6)) == moved


def test_the_first_line_of_a_program_and_lines_inside_blocks():
    assert put_line(documents(""), "10 DELAY 1")[0].program == "10 DELAY 1\n"
    assert put_line(documents("' a comment"), "10 DELAY 1")[0].program == "' a comment\n10 DELAY 1\n"
    block = "10 FOR i = 1 TO 2\n  DELAY 1\n  NEXT\n30 DELAY 3\n"
    assert put_line(documents(block), "20 DELAY 2")[0].program == block.replace("30", "20 DELAY 2\n30")
    mixed = "30 DELAY 3\n10 DELAY 1\n40 DELAY 4\n"
    assert put_line(documents(mixed), "20 DELAY 2")[0].program == mixed.replace("40", "20 DELAY 2\n40")


@pytest.mark.parametrize(
    ("code", "program", "call", "args"),
    [
        ("RBL717", NUMBERED, put_line, ["25"]),
        ("RBL717", NUMBERED, put_line, ["DELAY 1"]),
        ("RBL717", NUMBERED, put_line, ["20 DELAY 1\n30 DELAY 2"]),
        ("RBL717", NUMBERED, put_line, ["25 DELAY 1\r30 DELAY 2"]),
        ("RBL114", NUMBERED, put_line, ["1234567890 DELAY 1"]),
        ("RBL717", "DELAY 1\n", put_line, ["10 DELAY 1"]),
        ("RBL717", "*A\n", put_line, ["10 DELAY 1"]),
        ("RBL717", NUMBERED, insert_line, [9, "x = 1"]),
        ("RBL717", NUMBERED, insert_line, [0, "x = 1"]),
        ("RBL717", NUMBERED, change_line, [8, "x = 1"]),
        ("RBL717", NUMBERED, delete_line, [0]),
        ("RBL717", "", delete_line, [1]),
        ("RBL717", "DELAY 1\n", change_line, [2, "x = 1"]),
    ],
)
def test_a_line_that_is_not_there_is_refused(code, program, call, args):
    refused(code, call, documents(program), *args)


def test_lines_without_numbers_are_named_by_their_place():
    text = documents("DELAY 1\n\nDELAY 2\n")
    new, lines = insert_line(text, 2, "DELAY 9")
    assert new.program == "DELAY 1\nDELAY 9\n\nDELAY 2\n"
    assert (lines.of(0), lines.of(1)) == (0, 2)
    assert insert_line(text, 4, "DELAY 9")[0].program == "DELAY 1\n\nDELAY 2\nDELAY 9\n"
    assert change_line(text, 2, "DELAY 9") == (documents("DELAY 1\nDELAY 9\nDELAY 2\n"), LineMap(start=1, added=1))
    assert delete_line(text, 2) == (documents("DELAY 1\nDELAY 2\n"), LineMap(start=1))
    new, lines = change_line(text, 3, "")
    assert (new.program, lines.of(1)) == ("DELAY 1\n\n\n", None)


words = st.sampled_from(["", "  ", "DELAY 1", "' x", "20 DELAY 1", "10", "5 x = 1", "15 MOVE (", "*A", "999 NEXT"])
programs = st.lists(words, max_size=8).map("\n".join)


@examples(1000, 100)
@given(programs, words, st.integers(0, 9), st.sampled_from([change_line, insert_line, delete_line, put_line]))
def test_every_edit_says_where_the_lines_went(program, text, row, call):
    from runtime.core.faults import Fault

    args = {change_line: (row, text), insert_line: (row, text), delete_line: (row,), put_line: (text,)}[call]
    try:
        new, lines = call(documents(program), *args)
    except Fault as fault:
        assert fault.code == "RBL717"
        return
    before, after = (Analysis(source=each.source).program.lines for each in (documents(program), new))
    assert len(program_lines(program)) == len(before)
    moved = [lines.of(index) for index in range(len(before))]
    gone = sum(each is None for each in moved)
    assert len(after) - len(before) in (1 - gone, -gone)
    for index, there in enumerate(moved):
        if there is not None and not (lines.start <= index < lines.start + lines.removed):
            assert before[index] == after[there]
    there = [each for each in moved if each is not None]
    assert there == sorted(set(there))


@given(st.lists(st.sampled_from("abc")), st.lists(st.sampled_from("abc")))
def test_lines_between_two_texts_are_the_same_lines(old, new):
    lines = lines_between("\n".join(old), "\n\n".join(new))
    for index, line in enumerate(old):
        if (there := lines.of(index)) is not None and index not in range(lines.start, lines.start + lines.removed):
            assert new[there] == line
    assert len(new) == len(old) + lines.added - lines.removed
    assert min(lines.start, lines.added, lines.removed) >= 0
