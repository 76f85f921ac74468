"""Names of a program with the places of every definition and every use: what an editor shows.

A name means one of several things: a value, an array, a SUB, a label, a line number, or something of the cell. Values
and arrays are looked up as a run does it (``interpreter.scope``): in the SUB that the line is in, then in the main
program; a value that neither has is a taught point. TOOL and FRAME take a pose or a name of the cell.

A line with an error takes no part: it has no tree.
"""

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

from robolang.analysis.cell_symbols import CellSymbols
from robolang.core.source import Span
from robolang.syntax.ast import (
    Assign,
    Call,
    CallSub,
    Component6,
    Const,
    Dim,
    For,
    Line,
    LoadNamed,
    Name,
    Next,
    Node,
    Program,
    Seam,
    Setting,
    Sub,
    Target,
)
from robolang.syntax.blocks import Structure
from robolang.syntax.keywords import RESERVED
from robolang.syntax.tree import walk


class SymbolKind(Enum):
    """What a name stands for."""

    VARIABLE = "variable"
    CONSTANT = "constant"
    PARAMETER = "parameter"
    ARRAY = "array"
    SUB = "subroutine"
    LABEL = "label"
    LINE = "line number"
    POINT = "taught point"
    TOOL = "tool"
    FRAME = "frame"
    LOAD = "load"
    SENSOR = "seam sensor"
    UNKNOWN = "unknown name"


_VALUES = (SymbolKind.VARIABLE, SymbolKind.CONSTANT, SymbolKind.PARAMETER)
_SETTINGS = (SymbolKind.TOOL, SymbolKind.FRAME)
_SCOPED = (*_VALUES, SymbolKind.ARRAY, *_SETTINGS)
"""Kinds that are looked up in a SUB first; TOOL and FRAME may name a value."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Symbol:
    """A name, what it stands for, and where.

    ``scope``: index in ``Program.lines`` of the SUB that it belongs to; None: the whole program sees it. What the cell
    or the points file defines has no ``definitions``; what nothing names has no ``uses``.
    """

    name: str
    kind: SymbolKind
    scope: int | None = None
    definitions: tuple[Span, ...] = ()
    uses: tuple[Span, ...] = ()


class _Role(NamedTuple):
    """What a name at some place of the grammar stands for; None: not a name of the program."""

    kind: SymbolKind | None
    defines: bool = False


_ROLES: dict[type, dict[str, _Role]] = {
    Assign: {"target": _Role(SymbolKind.VARIABLE, defines=True)},
    For: {"variable": _Role(SymbolKind.VARIABLE, defines=True)},
    Next: {"variable": _Role(SymbolKind.VARIABLE)},
    Const: {"name": _Role(SymbolKind.CONSTANT, defines=True)},
    Dim: {"name": _Role(SymbolKind.ARRAY, defines=True)},
    Sub: {
        "name": _Role(SymbolKind.SUB, defines=True),
        "parameters": _Role(SymbolKind.PARAMETER, defines=True),
    },
    CallSub: {"name": _Role(SymbolKind.SUB)},
    Target: {"label": _Role(SymbolKind.LABEL)},
    LoadNamed: {"name": _Role(SymbolKind.LOAD)},
    Seam: {"sensor": _Role(SymbolKind.SENSOR)},
    Call: {"name": _Role(SymbolKind.ARRAY)},
    Component6: {"name": _Role(None)},
}
"""Roles of names by node and field; a name anywhere else is a value that is read."""
_OF_WORD = dict(zip(("TOOL", "FRAME"), _SETTINGS, strict=True))
_READ = _Role(SymbolKind.VARIABLE)


class _Place(NamedTuple):
    """One name of the text: its spelling, its role and the SUB that it is in."""

    text: str
    span: Span
    role: _Role
    scope: int | None


_Key = tuple[SymbolKind, int | None, str]


class SymbolTable:
    """The names of one program in one cell."""

    def __init__(self, program: Program, structure: Structure, cell: CellSymbols) -> None:
        self._cell = cell
        self._scopes = [
            (line.span.start, _scope_of(line, index, structure)) for index, line in enumerate(program.lines)
        ]
        places = [place for index, line in enumerate(program.lines) for place in _places(line, index, structure)]
        self._defined = {_key(place) for place in places if place.role.defines}
        found: dict[_Key, list[_Place]] = {}
        for place in places:
            found.setdefault(self._meaning(place), []).append(place)
        self.symbols = tuple(self._symbol(key, each) for key, each in found.items())
        spans = ((span, symbol) for symbol in self.symbols for span in (*symbol.definitions, *symbol.uses))
        # names do not overlap, so the last that begins before an offset is the only one that can hold it
        self._by_place = sorted(spans, key=lambda entry: entry[0])

    def at(self, offset: int) -> Symbol | None:
        """Return the symbol whose name stands at an offset, or ends there; None where no name is."""
        index = bisect_right(self._by_place, offset, key=lambda entry: entry[0].start) - 1
        if index < 0 or self._by_place[index][0].end < offset:
            return None
        return self._by_place[index][1]

    def definition(self, offset: int) -> Span | None:
        """Return where the name at an offset is defined first; None for a name of the cell, and where no name is."""
        found = self.at(offset)
        return None if found is None else next(iter(found.definitions), None)

    def references(self, offset: int) -> tuple[Span, ...]:
        """Return every place of the name at an offset, definitions included, in the order of the text."""
        found = self.at(offset)
        return () if found is None else tuple(sorted((*found.definitions, *found.uses)))

    def visible(self, offset: int) -> tuple[Symbol, ...]:
        """Return what may be named at an offset: names of its SUB, of the main program and of the cell, by name.

        A name of the SUB hides a value or an array of the main program with the same name.
        """
        index = bisect_right(self._scopes, offset, key=lambda entry: entry[0]) - 1
        here = self._scopes[index][1] if index >= 0 else None
        seen = {(_space(symbol.kind), symbol.name.upper()): symbol for symbol in self._of_cell()}
        for scope in (None, here):  # the SUB last: its names replace those of the main program
            own = (symbol for symbol in self.symbols if symbol.definitions and symbol.scope == scope)
            seen.update({(_space(symbol.kind), symbol.name.upper()): symbol for symbol in own})
        return tuple(sorted(seen.values(), key=lambda symbol: (symbol.name.upper(), symbol.kind.value)))

    def _of_cell(self) -> Iterator[Symbol]:
        """Yield the names of the cell and of its points, with their uses in the program."""
        used = {(symbol.kind, symbol.name.upper()): symbol for symbol in self.symbols if not symbol.definitions}
        for kind, names in (
            (SymbolKind.POINT, self._cell.points),
            (SymbolKind.TOOL, self._cell.tools),
            (SymbolKind.FRAME, self._cell.frames),
            (SymbolKind.LOAD, self._cell.loads),
            (SymbolKind.SENSOR, self._cell.sensors),
        ):
            yield from (used.get((kind, name)) or Symbol(name=name, kind=kind) for name in names or ())

    def _meaning(self, place: _Place) -> _Key:
        """Return which symbol a place is of."""
        kind, scope, key = _key(place)
        if kind not in _SCOPED:
            return kind, None, key
        space = SymbolKind.ARRAY if kind is SymbolKind.ARRAY else SymbolKind.VARIABLE
        for where in (scope, None):
            if (space, where, key) in self._defined:
                return space, where, key
        return self._undefined(kind, space, key), None, key

    def _undefined(self, kind: SymbolKind, space: SymbolKind, key: str) -> SymbolKind:
        """Return what a name is of that the program itself does not define."""
        points = self._cell.points
        if space is SymbolKind.VARIABLE and key in (points or ()):
            return SymbolKind.POINT
        if kind in _SETTINGS:
            return kind
        # without a list of points any free name may be one
        return SymbolKind.POINT if points is None and space is not SymbolKind.ARRAY else SymbolKind.UNKNOWN

    @staticmethod
    def _symbol(key: _Key, places: list[_Place]) -> Symbol:
        definitions = [place for place in places if place.role.defines]
        kind = definitions[0].role.kind if definitions else key[0]
        return Symbol(
            # uses may be spelt in other capitals
            name=(definitions or places)[0].text,
            kind=kind or key[0],
            scope=key[1],
            definitions=tuple(place.span for place in definitions),
            uses=tuple(place.span for place in places if not place.role.defines),
        )


def _space(kind: SymbolKind) -> SymbolKind:
    """Return the kind that stands for all that compete for one name: a value hides a taught point."""
    return SymbolKind.VARIABLE if kind in (*_VALUES, SymbolKind.POINT) else kind


def _key(place: _Place) -> _Key:
    assert place.role.kind is not None
    kind = SymbolKind.VARIABLE if place.role.kind in _VALUES else place.role.kind
    return kind, place.scope if kind in _SCOPED else None, place.text.upper()


def _scope_of(line: Line, index: int, structure: Structure) -> int | None:
    """Return the SUB of a line; the parameters in its head belong to it."""
    return index if isinstance(line.statement, Sub) else structure.owner.get(index)


def _places(line: Line, index: int, structure: Structure) -> Iterator[_Place]:
    """Yield the names of a line."""
    scope = _scope_of(line, index, structure)
    if line.number is not None:
        yield _Place(str(line.number), line.number_span, _Role(SymbolKind.LINE, defines=True), None)
    if line.label is not None:
        name = Span(line.label.span.end - len(line.label.text), line.label.span.end)  # without the asterisk
        yield _Place(line.label.text, name, _Role(SymbolKind.LABEL, defines=True), None)
    if line.statement is None:
        return
    # by identity: in a(n) = n equal names have different roles
    roles: dict[int, _Role] = {}
    for node in walk(line.statement):
        roles.update(_roles(node))
        if isinstance(node, Target) and node.number is not None:
            yield _Place(str(node.number), node.span, _Role(SymbolKind.LINE), None)
        elif isinstance(node, Name) and node.key not in RESERVED:
            role = roles.get(id(node), _READ)
            if role.kind is not None:
                yield _Place(node.text, node.span, role, scope)


def _roles(node: Node) -> Iterator[tuple[int, _Role]]:
    """Yield the roles that a node gives to names right below it."""
    if isinstance(node, Setting) and node.word in _OF_WORD:
        yield id(node.value), _Role(_OF_WORD[node.word])
    for name, role in _ROLES.get(type(node), {}).items():
        value = getattr(node, name)
        yield from ((id(each), role) for each in (value if isinstance(value, tuple) else (value,)))
