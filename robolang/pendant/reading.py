"""What a line typed at the prompt is: a command, a change of the program, statements, or an expression.

The order decides. A word of a command comes first, unless an assignment or an index follows it, since a program may use
it as a name: ``list = 3`` assigns. A line number at the start changes the program, as in BASIC; ``65 + 1`` is an
expression all the same. What the language reads is a statement; what it reads after PRINT is an expression.
"""

import re
from dataclasses import dataclass
from typing import TypeAlias

from robolang.core.source import Source
from robolang.pendant.command import Command, Commands
from robolang.syntax.blocks import structure_of
from robolang.syntax.parser import parse

NAME = "prompt"
"""Name of the text that is typed, in the places of messages."""

_WORD = re.compile(r"\s*([A-Za-z]\w*)(.*)\Z", re.DOTALL)
# as many digits as a line number may have
_NUMBERED = re.compile(r"\s*([0-9]{1,9})(?:\s+(\S.*))?\s*\Z", re.DOTALL)
_AS_NAME = re.compile(r"\s*=|\(|\.\w")
"""What follows a word that is a name: an assignment, an element or arguments, a component."""


@dataclass(frozen=True, slots=True)
class Blank:
    """Nothing, or a comment."""


@dataclass(frozen=True, slots=True)
class CommandLine:
    """A command and the text after its word."""

    command: Command
    rest: str


@dataclass(frozen=True, slots=True)
class LineEdit:
    """A line of the program by its line number; without ``text`` the line is deleted."""

    number: int
    text: str


@dataclass(frozen=True, slots=True)
class Statements:
    """One statement, or whole blocks of several lines."""

    text: str


@dataclass(frozen=True, slots=True)
class Value:
    """An expression whose value is shown."""

    text: str


Typed: TypeAlias = Blank | CommandLine | LineEdit | Statements | Value


def read(text: str, commands: Commands) -> Typed:
    """Return what a text is. A text that nothing can read is ``Statements``: its errors are found there."""
    if _is_blank(text):
        return Blank()
    # before the grammar is asked: ``run`` alone would be an expression, the value of a name
    word = _WORD.match(text)
    command = commands.get(word[1]) if word else None
    if word is not None and command is not None and not _AS_NAME.match(word[2]):
        return CommandLine(command, word[2].strip())
    numbered = _NUMBERED.match(text)
    # a number alone deletes its line, as in BASIC, and is no expression; before a comment it is a line too
    is_number = numbered is not None and _is_blank(numbered[2] or "")
    # PRINT reads what an expression may be at the prompt too: several values, texts, functions without arguments
    if not is_number and not _is_read(text) and _is_read(f"PRINT {text}"):
        return Value(text.strip())
    if numbered is not None:
        return LineEdit(int(numbered[1]), (numbered[2] or "").rstrip())
    return Statements(text)


def first_word(text: str) -> str:
    """Return the word at the start of a text, or ``""``."""
    word = _WORD.match(text)
    return word[1] if word else ""


def is_open(text: str, commands: Commands) -> bool:
    """Return whether more lines have to follow: a block has been opened and not been closed."""
    if not isinstance(read(text, commands), Statements):
        return False
    parsed = parse(Source(NAME, text))
    if parsed.diagnostics:
        return False  # an error is shown at once, and not after the block has been typed to its end
    return any(problem.code == "RBL211" for problem in structure_of(parsed.program).diagnostics)


def _is_blank(text: str) -> bool:
    parsed = parse(Source(NAME, text))
    return not parsed.diagnostics and all(
        line.statement is None and line.number is None and line.label is None for line in parsed.program.lines
    )


def _is_read(text: str) -> bool:
    """Return whether the language reads a text that has no line number."""
    parsed = parse(Source(NAME, text))
    return (
        not parsed.diagnostics
        and any(line.statement is not None for line in parsed.program.lines)
        and not any(line.number is not None for line in parsed.program.lines)
    )
