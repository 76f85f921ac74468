import pytest

from robolang.pendant.assembly import COMMANDS
from robolang.pendant.command import Command, Commands, Group
from robolang.pendant.reading import Blank, CommandLine, LineEdit, Statements, Value, is_open, read
from robolang.syntax.keywords import INSTRUCTIONS
from robolang.syntax.statements import STATEMENTS


@pytest.mark.parametrize(
    "text, kind",
    [
        ("", Blank),
        ("   ", Blank),
        ("' a comment", Blank),
        ("pos", CommandLine),
        ("POS", CommandLine),
        ("  list 60", CommandLine),
        ("in 3 on", CommandLine),
        ("run", CommandLine),
        ("list = 3", Statements),
        ("run = run + 1", Statements),
        ("save(3) = 4", Statements),
        ("MOVE P1", Statements),
        ("x = 5", Statements),
        ("FRAME PALLET", Statements),
        ("SPEED 100", Statements),
        ("PAUSE", Statements),
        ("OUT(3) = 1", Statements),
        ("MOVE", Statements),
        ("tech P7", Statements),
        ("x", Value),
        ("P1.X + 3", Value),
        ("1 + 2", Value),
        ("65 + 1", Value),
        ("IN(3)", Value),
        ("DIST(P1, P2)", Value),
        ("HERE", Value),
        ('"a" ; 3', Value),
        ("65", LineEdit),
        ("65 DELAY 1", LineEdit),
        ("65 MOV P1", LineEdit),
        ("65 ' comment", LineEdit),
    ],
)
def test_what_a_line_is(text, kind):
    assert type(read(text, COMMANDS)) is kind


def test_the_parts_of_a_line():
    found = read("  List  60 70 ", COMMANDS)
    assert isinstance(found, CommandLine)
    assert (found.command.word, found.rest) == ("list", "60 70")
    assert read("65 DELAY 1 ' rest", COMMANDS) == LineEdit(65, "DELAY 1 ' rest")
    assert read("65", COMMANDS) == LineEdit(65, "")


@pytest.mark.parametrize(
    "text, more",
    [
        ("FOR i = 1 TO 3", True),
        ("FOR i = 1 TO 3\nMOVE P1", True),
        ("FOR i = 1 TO 3\nMOVE P1\nNEXT", False),
        ("IF 1 THEN", True),
        ("IF 1 THEN MOVE P1", False),
        ("FOR i = 1 TO 3\nMOV P1", False),
        ("MOVE P1", False),
        ("pos", False),
        ("60 FOR i = 1 TO 3", False),
    ],
)
def test_a_block_waits_for_its_end(text, more):
    assert is_open(text, COMMANDS) is more


def test_no_command_begins_a_statement():
    starts = {words.split()[0] for each in STATEMENTS for words in each.starts} | INSTRUCTIONS
    assert {command.word.upper() for command in COMMANDS} & starts == set()


def test_two_commands_of_one_word_and_a_hidden_statement_are_refused():
    def command(word):
        return Command(word=word, form=word, help="", group=Group.SHOW, do=lambda pendant, rest: None)

    with pytest.raises(ValueError):
        Commands((command("pos"), command("pos")))
    with pytest.raises(ValueError):
        Commands((command("move"),))
