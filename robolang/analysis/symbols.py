"""Names: what the cell and the points file have, what a program defines, and what a wrong one was meant to be.

A line with an error may have been a definition. Every name that it seems to define counts as defined, so that one typo
in ``FOR i = 1 TO 4`` is not followed by a mistake for each use of i.
"""

import math
import re
from collections.abc import Collection, Iterator, Mapping

from robolang.analysis.cell_symbols import CellSymbols
from robolang.core.deduplicate import Repeats
from robolang.core.diagnostics import Diagnostic
from robolang.core.source import Span
from robolang.evaluation.constant_folding import fixed
from robolang.syntax.ast import (
    Assign,
    Call,
    Component6,
    Const,
    Dim,
    Expression,
    For,
    If,
    Name,
    Node,
    Program,
    Statement,
    Sub,
    Unparsed,
)
from robolang.syntax.keywords import KEYWORDS, RESERVED, near
from robolang.syntax.tree import walk
from runtime.core import limits

_DEFINING = ("CONST", "DIM", "FOR", "SUB")
_LABEL = re.compile(r"[ \t]*\*[ \t]*\w*")
_TEXTS = re.compile(r"\"[^\"]*\"?|'.*|(?<!\w)REM(?!\w).*", re.IGNORECASE)
_FIRST = re.compile(r"[ \t]*(\w+)")
_WORD = re.compile(r"(?<!\w)[A-Za-z]\w*+\$?")
_ASSIGNED = re.compile(r"(?<!\w)([A-Za-z]\w*+\$?)[ \t]*(?:\([^()=]*\)[ \t]*)?=")


class _Own:
    """What the lines of the main program, or of one SUB, define; ``arrays`` with their largest index."""

    def __init__(self) -> None:
        self.values: set[str] = set()
        self.arrays: dict[str, float] = {}
        self.constants: dict[str, Span] = {}

    def take(self, node: Statement) -> None:
        """Enter what a statement defines."""
        if isinstance(node, Assign) and isinstance(node.target, Name):
            if all(name.key != node.target.key for name in values_read(node.value)):  # n = n + 1 gives no first value
                self.values.add(node.target.key)
        elif isinstance(node, For):
            self.values.add(node.variable.key)
        elif isinstance(node, Const):
            self.values.add(node.name.key)
            self.constants.setdefault(node.name.key, node.name.span)
        elif isinstance(node, Dim):
            size = fixed(node.size)
            # an impossible size is an error by itself: no index is judged by it
            known = size if size is not None and limits.SIZE.fault(size) is None else math.inf
            self.arrays[node.name.key] = max(known, self.arrays.get(node.name.key, 0.0))


class Defined:
    """Names that a program gives values: variables, arrays, constants, and subroutines with their parameters.

    A SUB sees the names of the main program and its own; what it gives a value ends with it, so the main program and
    other SUBs do not see that (``scope``): the answers are those for the part that ``look_from`` was called with last.
    ``seeming`` are those that lines with an error seem to define, whatever they are used as;
    ``missing`` are the names that are used and not defined.
    """

    def __init__(self) -> None:
        self.subs: dict[str, Sub] = {}
        self.seeming: set[str] = set()
        self.missing = Repeats()
        self._own: dict[int | None, _Own] = {None: _Own()}
        self._here = _Own()

    @staticmethod
    def of(program: Program, owner: Mapping[int, int], lost_subs: Collection[int] = ()) -> "Defined":
        """Return what the statements of a program define; ``owner``: by line the line of the SUB that it is in.

        ``lost_subs`` are the lines with an error that must be the head of a SUB, whatever they look like.
        """
        found = Defined()
        subs = frozenset(owner.values())
        for index, line in enumerate(program.lines):
            if line.statement is not None:
                part = index if index in subs else owner.get(index)
                found._take(line.statement, found._own.setdefault(part, _Own()))
            if index in lost_subs and line.statement is not None:
                found.seeming |= _words(line.statement) - RESERVED
        found.look_from(None)
        return found

    @property
    def values(self) -> frozenset[str]:
        """Names with a value, all that are seen from here; of a line with an error nobody knows which it names."""
        return frozenset(self._own[None].values | self._here.values)

    def look_from(self, sub: int | None) -> None:
        """See the names as the SUB that begins on a line does; None: as the main program does."""
        self._here = self._own.get(sub) or _Own()

    def has_value(self, key: str) -> bool:
        """Return whether a variable, constant or parameter of a name is seen from here."""
        return key in self._here.values or key in self._own[None].values or key in self.seeming

    def has_array(self, key: str) -> bool:
        """Return whether an array of a name is seen from here."""
        return key in self._here.arrays or key in self._own[None].arrays or key in self.seeming

    def largest(self, key: str) -> float:
        """Return the largest index of the arrays of a name that are seen from here; infinite where a run decides it."""
        sizes = [own.arrays[key] for own in (self._own[None], self._here) if key in own.arrays]
        return math.inf if key in self.seeming else max(sizes, default=math.inf)

    def constant(self, key: str) -> Span | None:
        """Return where the constant of a name that is seen from here is fixed, None when there is none."""
        return self._own[None].constants.get(key) or self._here.constants.get(key)

    def is_of_a_sub(self, key: str) -> bool:
        """Return whether a name that is not seen from here has a value in some SUB."""
        return any(key in own.values or key in own.arrays for own in self._own.values())

    def is_missing(self, name: Name) -> bool:
        """Return whether a name that is not defined is to be said: at its first use."""
        return name.key not in self.seeming and self.missing.is_first(name.key, name.span)

    def _take(self, node: Statement, own: _Own) -> None:
        if isinstance(node, If):
            for part in (node.then, node.otherwise):
                if part is not None:
                    self._take(part, own)
        elif isinstance(node, Sub):
            self.subs.setdefault(node.name.key, node)
            own.values.update(parameter.key for parameter in node.parameters)
        elif isinstance(node, Unparsed):
            self.seeming |= seems_to_define(node.text)
        else:
            own.take(node)


def _words(node: Statement) -> frozenset[str]:
    """Return all words of a statement in capitals, where it has an error, and else its names."""
    if isinstance(node, Unparsed):
        return frozenset(word.upper() for word in _WORD.findall(node.text))
    return frozenset(name.key for name in names_in(node))


def names_in(node: Node) -> Iterator[Name]:
    """Yield the names in a node, of arrays and functions as well; ``X`` of ``P1.X`` is none, it names no value."""
    components: set[int] = set()
    for each in walk(node):
        if isinstance(each, Component6):
            components.add(id(each.name))
        elif isinstance(each, Name) and id(each) not in components:
            yield each


def values_read(node: Expression) -> Iterator[Name]:
    """Yield the names whose values an expression reads: an array or a function of the same name is another thing."""
    calls = {id(each.name) for each in walk(node) if isinstance(each, Call)}
    return (name for name in names_in(node) if id(name) not in calls)


def seems_to_define(text: str) -> frozenset[str]:
    """Return the names, in capitals, that a statement with an error seems to give a value."""
    is_labelled = text.lstrip().startswith("*")
    # words of texts, of comments and the name of the label define no value
    plain = _TEXTS.sub(" ", _LABEL.sub(" ", text, count=1) if is_labelled else text)
    words = frozenset(word.upper() for word in _WORD.findall(plain))
    begin = _FIRST.match(plain)
    first = begin[1].upper() if begin else ""
    if joined := _without_blank(first):
        return (words | {joined}) - RESERVED
    # FRO i = 1 TO n: all names, since the word is lost that says which of them is defined
    if first in _DEFINING or (first not in KEYWORDS and near(first, _DEFINING)):
        return words - RESERVED
    return frozenset(found[1].upper() for found in _ASSIGNED.finditer(plain)) - RESERVED


def _without_blank(first: str) -> str:
    """Return the name that stands right after a defining word, the blank missing: ``SUBf(x)``; or ``""``."""
    return next((first.removeprefix(word) for word in _DEFINING if first.startswith(word) and first != word), "")


def of_cell(
    name: Name, known: Collection[str] | None, kind: str, symbols: CellSymbols, code: str = "RBL305"
) -> Iterator[Diagnostic]:
    """Report a name of something that the cell does not have; ``known`` None: not known."""
    if known is not None and name.key not in known:
        hint = hint_for(name, frozenset(known)) or symbols.where_to_add(kind, name.text)
        what = "seam sensor" if kind == "sensor" else kind
        yield Diagnostic(code=code, message=f"the cell has no {what} {name.text}", span=name.span, hint=hint)


def hint_for(name: Name, names: frozenset[str]) -> str:
    """Return which of ``names`` was probably meant, or ``""``."""
    guess = near(name.key, names)
    return f"did you mean {guess}?" if guess else ""


def names_hint(name: Name, names: frozenset[str], *, known: str, none: str) -> str:
    """Return what a name that is not among ``names`` was probably meant to be, or which there are, or ``""``."""
    if guess := hint_for(name, names):
        return guess
    if not names:
        return none
    return f"{known}: {', '.join(sorted(names))}" if len(names) <= 10 else ""
