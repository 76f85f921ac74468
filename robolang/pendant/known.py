"""What is known for completion, colours and help: names of program, cell and points, with what each means.

It is made once after each change, not at each key. Before the cell has been read it is what the text alone tells.
"""

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType

from robolang.analysis.analysis import Analysis
from robolang.analysis.symbol_table import Symbol, SymbolKind
from robolang.core.source import Source
from robolang.pendant.marks import Names
from robolang.project.points import Point
from runtime.core.record import Record

_NOTHING = Analysis(source=Source("", ""))
_DIGITS = re.compile(r"([0-9]+)")


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """A name that can be typed: what it stands for, and its meaning in a few words."""

    name: str
    kind: SymbolKind
    meaning: str


class Known(Record):
    """The facts: ``values`` are those of variables as texts, by their capitals; states of inputs and outputs by number.

    ``axes``: number of joints.
    """

    __slots__ = ("__dict__",)  # for the cached properties

    analysis: Analysis = _NOTHING
    points: Mapping[str, Point] = MappingProxyType({})
    values: Mapping[str, str] = MappingProxyType({})
    inputs: Mapping[int, float] = MappingProxyType({})
    outputs: Mapping[int, float] = MappingProxyType({})
    axes: int = 6

    @cached_property
    def entries(self) -> tuple[Entry, ...]:
        """Every name that can be used at the prompt, in the order of people: P2 before P10."""
        # what is typed runs in the main program: names of a SUB are its own
        symbols = (each for each in self.analysis.symbols.visible(0) if each.scope is None)
        found = {(each.kind, each.name.upper()): self._entry(each) for each in symbols}
        taught = {key for _, key in found}
        for key in self.values:
            # a name that only the prompt has given a value
            if key not in taught:
                entry = Entry(name=key, kind=SymbolKind.VARIABLE, meaning=f"= {self.values[key]}")
                found[entry.kind, key] = entry
        return tuple(sorted(found.values(), key=lambda entry: natural(entry.name)))

    @cached_property
    def names(self) -> Names:
        """What each name stands for, by its capitals."""
        return {entry.name.upper(): entry.kind for entry in self.entries}

    def of(self, *kinds: SymbolKind) -> Iterator[Entry]:
        """Yield the names of some kinds."""
        return (entry for entry in self.entries if entry.kind in kinds)

    def _entry(self, symbol: Symbol) -> Entry:
        name = symbol.name
        if symbol.kind is SymbolKind.POINT and (point := self.points.get(name.upper())):
            return Entry(name=point.name, kind=symbol.kind, meaning=short(point))
        return Entry(name=name, kind=symbol.kind, meaning=self._meaning(symbol))

    def _meaning(self, symbol: Symbol) -> str:
        source = self.analysis.source
        if symbol.kind in (SymbolKind.LABEL, SymbolKind.LINE, SymbolKind.SUB) and symbol.definitions:
            return source.line_text(source.place(symbol.definitions[0].start).line).strip()
        if symbol.kind is SymbolKind.LOAD and (load := (self.analysis.cell.loads or {}).get(symbol.name.upper())):
            return f"load  {load.mass_kg:g} kg at {_row(load.cog_mm)} mm"
        value = self.values.get(symbol.name.upper())
        return symbol.kind.value if value is None else f"{symbol.kind.value} = {value}"


def short(point: Point) -> str:
    """Return a taught point in a few words: its numbers, frame, tool and comment."""
    if point.joints is not None:
        text = f"joints {_row(point.joints)}"
    else:
        pose = point.pose or ()
        text = f"{_row(pose[:3])} mm  {_row(pose[3:])} deg"
    more = (f"in {point.frame}" if point.frame else "", f"tool {point.tool}" if point.tool else "", point.comment)
    return "  ".join(filter(None, (text, *more)))


def _row(values: tuple[float, ...]) -> str:
    return " ".join(f"{value + 0.0:.6g}" for value in values)


def natural(name: str) -> tuple[tuple[str, int], ...]:
    """Return by what names are sorted: letters in any case, and numbers in them by their value."""
    pieces = _DIGITS.split(name.upper())
    numbers = [*pieces[1::2], ""]
    # of a file, a number may have thousands of digits, which int refuses: its length is enough there
    return tuple((text, int(digits[:18] or 0)) for text, digits in zip(pieces[::2], numbers, strict=True))


Knowing = Callable[[], Known]
