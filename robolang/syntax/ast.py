"""The syntax tree: values, one class for each rule of ``grammar.lark``.

Two trees are equal when they mean the same; places (``span``, ``source_line``) and parentheses that change nothing take
no part. A line that could not be parsed is kept as ``Unparsed``, so that line numbers and the formatter see every line;
blank lines are not kept, they are the gaps between the ``source_line`` of neighbours.

The classes of statements are generated from their declarations (``robolang.syntax.generate``).
"""

from typing import Final

from robolang.core.source import Span
from robolang.syntax.expressions import Call as Call
from robolang.syntax.expressions import Chain as Chain
from robolang.syntax.expressions import Component as Component
from robolang.syntax.expressions import Component6 as Component6
from robolang.syntax.expressions import Expression as Expression
from robolang.syntax.expressions import HandState as HandState
from robolang.syntax.expressions import Name as Name
from robolang.syntax.expressions import Negate as Negate
from robolang.syntax.expressions import Not as Not
from robolang.syntax.expressions import Number as Number
from robolang.syntax.expressions import Operand as Operand
from robolang.syntax.expressions import Target as Target
from robolang.syntax.expressions import Text as Text
from robolang.syntax.expressions import Unparsed as Unparsed
from robolang.syntax.expressions import Vector as Vector
from robolang.syntax.expressions import Wrist as Wrist
from robolang.syntax.expressions import WristMode as WristMode
from robolang.syntax.statement_nodes import *  # noqa: F403 - every class of it, also those that will be added
from robolang.syntax.statement_nodes import Statement
from robolang.syntax.tree import NOWHERE as NOWHERE
from robolang.syntax.tree import Node as Node
from robolang.syntax.tree import replace as replace
from robolang.syntax.tree import walk as walk

MAX_NUMBER_DIGITS = 9
"""Digits of the longest line number."""


class Comment(Node):
    """A comment as written, from ``'`` or ``REM`` to the end of its line."""

    __slots__ = ("text",)

    def __init__(self, *, text: str, span: Span = NOWHERE) -> None:
        self.text: Final = text
        self.span = span


class Line(Node):
    """``[number] [*label] [statement] [comment]``; ``source_line`` is 1-based."""

    __slots__ = ("number", "label", "statement", "comment", "source_line", "number_span")
    compared = ("number", "label", "statement", "comment")

    def __init__(
        self,
        *,
        number: int | None = None,
        label: Name | None = None,
        statement: Statement | None = None,
        comment: Comment | None = None,
        source_line: int = 1,
        span: Span = NOWHERE,
        number_span: Span = NOWHERE,
    ) -> None:
        self.number: Final = number
        self.label: Final = label
        self.statement: Final = statement
        self.comment: Final = comment
        self.source_line: Final = source_line
        self.number_span: Final = number_span
        self.span = span


class Program(Node):
    """All lines that are not blank, in order."""

    __slots__ = ("lines", "source_path")
    compared = ("lines",)

    def __init__(self, *, source_path: str, lines: tuple[Line, ...], span: Span = NOWHERE) -> None:
        self.source_path: Final = source_path
        self.lines: Final = lines
        self.span = span

    @property
    def comments(self) -> tuple[Comment, ...]:
        """The comments in order."""
        return tuple(line.comment for line in self.lines if line.comment is not None)

    @property
    def statements(self) -> tuple[Line, ...]:
        """The lines that have a statement, in order."""
        return tuple(line for line in self.lines if line.statement is not None)
