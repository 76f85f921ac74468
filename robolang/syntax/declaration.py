"""What the declaration of a statement consists of, and how its form is read.

A form is the text of a statement with its operands in braces, as in ``HAND {state}[, {dwell}]``. Text in brackets is
printed where its operands have a value. Of several forms, the first is printed whose operands outside of brackets all
have a value.
"""

import re
from collections.abc import Iterator
from enum import Enum, auto
from functools import cache
from typing import NamedTuple, TypeAlias

from robolang.values.kinds import Kind
from runtime.core.limits import Limit

_WORDS = re.compile(r"[A-Z]+\d*(?: [A-Z]+)*")
_KEYWORD = re.compile(r"\b[A-Z]+\d*\b")
"""A keyword of a form; names of operands are in small letters."""
_KEYWORD_OR_OPERAND = re.compile(r"\{(\w+)\}|[A-Z]+\d*")
_START = re.compile(r"([A-Z]+\d*(?: [A-Z]+)*)(?: \{(\w+)\})?")
_PIECE = re.compile(r"\{(\w+)\}|([\[\]])|([^\[\]{}]+)")


class Role(Enum):
    """What an operand is; decides the type of its field and how it is checked and printed."""

    VALUE = auto()
    """An expression that is evaluated."""
    PLACE = auto()
    """An expression for a pose, or the name of a taught point."""
    OF_CELL = auto()
    """The name of something in the cell, or an expression for a pose in its place."""
    VECTOR = auto()
    """Expressions in parentheses."""
    NAME = auto()
    """A name that is not evaluated."""
    ASSIGNED = auto()
    """A name, or an element of an array, that gets a value."""
    TARGET = auto()
    """A line number or a label."""
    STATEMENT = auto()
    """A statement within a statement."""
    OPTIONS = auto()
    """Options of a move, each after a comma."""
    WORD = auto()
    """One of ``Operand.words``."""
    WRITTEN = auto()
    """Not an operand but a note on how the statement is written, which takes no part in comparisons."""


class Fails(Enum):
    """When a statement ends in an error that ON ERROR catches."""

    NEVER = auto()
    OPERANDS = auto()
    """Where one of its expressions does."""
    ALWAYS = auto()
    """It may, whatever its expressions are: a move that cannot be planned."""


# tuples and not data classes: all of them are built at each start of ``robolang check``
class Operand(NamedTuple):
    """An operand of a statement or of an option; ``name`` is the field of its node, ``shown`` stands for it in forms.

    ``kind`` and ``limit`` are what its value must be. ``of`` is what a name names in the cell, as ``"sensor"``, and
    ``code`` the error where the cell has none. ``size``: the number of values of a vector. ``separator``: the operand
    is a list. ``words``: the choices of a WORD, whose field has the enum ``type``. ``defines``: the statement makes the
    name. ``finite``: NAN and INF are errors.
    """

    name: str
    shown: str
    role: Role = Role.VALUE
    kind: Kind | None = None
    limit: Limit | None = None
    unit: str = ""
    optional: bool = False
    separator: str = ""
    of: str = ""
    code: str = ""
    size: int = 0
    words: tuple[str, ...] = ()
    type: str = ""
    defines: bool = False
    finite: bool = False


class Declaration(NamedTuple):
    """A statement, or an option of a move.

    ``node`` is its class in ``robolang.syntax.ast``; several statements may share one, which then has their first
    words in ``word``. ``effect`` is the class of ``robolang.interpreter.effects`` that it requests, empty where it has
    none of its own; ``closes`` and ``divides`` the word of the block that it ends or divides.
    """

    node: str
    forms: tuple[str, ...]
    help: str
    operands: tuple[Operand, ...] = ()
    options: "tuple[Declaration, ...]" = ()
    effect: str = ""
    fails: Fails = Fails.NEVER
    closes: str = ""
    divides: str = ""

    @property
    def word(self) -> str:
        """The words that it begins with, as in ``ON ERROR GOTO``; empty for an assignment."""
        found = _WORDS.match(self.forms[0])
        return found[0] if found else ""

    @property
    def keyword(self) -> str:
        """The first word; empty for an assignment."""
        return self.word.partition(" ")[0]

    @property
    def inner_words(self) -> tuple[str, ...]:
        """The keywords after the first one: of its options, its operands and its forms; some may be twice."""
        # the first word of each: those that follow, as HOLD after WRIST, are choices of its operands
        of_options = [word for each in self.options for text in each.forms for word in _KEYWORD.findall(text)[:1]]
        choices = [word for each in (self, *self.options) for operand in each.operands for word in operand.words]
        of_forms = [word for text in self.forms for word in _KEYWORD.findall(text)[bool(self.keyword) :]]
        return (*of_options, *choices, *of_forms)

    @property
    def in_place(self) -> frozenset[str]:
        """The words that may stand in the place of its operand, as MAX after ACCEL."""
        return frozenset(word for text in self.forms[1:] for word in _KEYWORD.findall(text)[1:])

    @property
    def starts(self) -> tuple[str, ...]:
        """The words that it may begin with, as ``ZONE`` and ``FINE``, or ``SEAM ON`` and ``SEAM OFF``."""
        choices = {operand.name: operand.words for operand in self.operands}
        found: dict[str, None] = {}
        for text in self.forms:
            if start := _START.match(text):
                words, first = start[1], choices.get(start[2], ())
                # a word that is chosen right after the keyword belongs to it, as ON to HAND
                found.update(
                    dict.fromkeys([f"{words} {word}" for word in first] if first and " " not in words else [words])
                )
        return tuple(found)

    @property
    def drains(self) -> bool:
        """Whether all motion ends before it: it requests something of the robot or the cell, and is no move.

        A statement that reads an input, the time or a pose lets motion end as well (``state_reads``).
        """
        # moves blend into one another, and each carries the WRIST that holds for it
        return self.effect not in ("", "MoveTo", "SetWrist")


# --- forms -----------------------------------------------------------------------------------------------------------


class Field(NamedTuple):
    """The place of an operand in a form."""

    name: str


Piece: TypeAlias = "str | Field | tuple[Piece, ...]"
"""Text, an operand, or what stands in brackets."""


@cache
def pieces(text: str) -> tuple[Piece, ...]:
    """Return what a form consists of, in order."""
    stack: list[list[Piece]] = [[]]
    for found in _PIECE.finditer(text):
        name, bracket, plain = found.groups()
        if bracket == "[":
            stack.append([])
        elif bracket == "]":
            group = tuple(stack.pop())
            stack[-1].append(group)
        else:
            stack[-1].append(Field(name) if name else plain)
    return tuple(stack[0])


def units(declared: Declaration) -> Iterator[tuple[str, str]]:
    """Yield the keywords of a statement or an option with the unit of the number after each, as TIMEOUT with s."""
    unit = {operand.name: operand.unit for operand in declared.operands if operand.unit}
    for text in declared.forms:
        word = ""
        for found in _KEYWORD_OR_OPERAND.finditer(text):
            if found[1] is None:
                word = found[0]
            elif found[1] in unit:
                yield word, unit[found[1]]


def form(declared: Declaration) -> str:
    """Return how a statement or an option is written, as in ``DELAY s`` or ``HAND ON|OFF [, s]``."""
    shown = {operand.name: operand.shown for operand in declared.operands}
    shown["options"] = "".join(f" [, {form(option)}]" for option in declared.options)
    return " or ".join(_shown(pieces(text), shown) for text in declared.forms)


def _shown(parts: tuple[Piece, ...], shown: dict[str, str]) -> str:
    text = ""
    for part in parts:
        if isinstance(part, str):
            text += part
        elif isinstance(part, Field):
            text += shown[part.name]
        else:
            # the blank or comma that a bracket begins with belongs to the form, the blank before the bracket to this
            text += f" [{_shown(part, shown).lstrip(' ')}]"
    return text
