"""Configuration: ``robolang.toml``, or ``[tool.robolang]`` of ``pyproject.toml``.

The nearest folder above a program that has either file counts, and of two in one folder ``robolang.toml``; files are
not merged. A ``pyproject.toml`` without a table of robolang does not count. ::

    exclude = ["tests/bad", "*/old"]   # from the file's folder; what is below is excluded, too

    [lint]
    select = ["RBL1", "RBL2"]          # these only; without it all
    extend-select = ["point-undefined"]
    ignore = ["RBL116"]

    [lint.near-joint-limit]            # bounds of a rule (``robolang.core.bounds``), for check --motion
    margin_deg = 5

An unknown key, or one given twice, is a ``FileFault`` RBL707 at its place, an unknown rule RBL710.
"""

import os
from collections.abc import Mapping
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING

from robolang.lint.selection import Layer, guess, selector
from runtime.core.record import Record, default
from runtime.core.tomlfile import TWICE, FileFault, Source, Table, load_table, read_source

if TYPE_CHECKING:
    from robolang.core.bounds import Bound, Bounds

FILE, PYPROJECT = "robolang.toml", "pyproject.toml"


class Configuration(Record):
    """The contents of a file: its selection of rules, and the paths below ``folder`` that a search leaves out.

    ``bounds`` are the tables ``[lint.NAME]`` as they were read, checked.
    """

    folder: Path
    layer: Layer = Layer()
    bounds: "Mapping[Bound, float]" = default(factory=dict)
    exclude: tuple[str, ...] = ()


class Settings:
    """The configuration of every folder, each file read once."""

    def __init__(self) -> None:
        self._found: dict[Path, Configuration] = {}

    def layer(self, folder: Path) -> Layer:
        """Return the selection of the nearest file for a folder; ``FileFault`` RBL600, RBL601, RBL61x, RBL7xx."""
        return self._nearest(Path(os.path.abspath(folder))).layer  # noqa: PTH100 - as the user sees it, not resolved

    def bounds(self, folder: Path) -> "Bounds":
        """Return the bounds of rules in a folder, the defaults where nothing sets them; ``FileFault`` as ``layer``."""
        from robolang.core.bounds import Bounds

        return Bounds(self._nearest(Path(os.path.abspath(folder))).bounds)  # noqa: PTH100

    def excludes(self, path: str) -> bool:
        """Return whether the nearest file above a file or folder excludes it; ``FileFault`` as ``layer``."""
        whole = Path(os.path.abspath(path))  # noqa: PTH100
        nearest = self._nearest(whole.parent)
        name = whole.relative_to(nearest.folder).as_posix()
        # fnmatch would ignore case on Windows, and a file would exclude other programs there
        return any(fnmatchcase(name, pattern.rstrip("/")) for pattern in nearest.exclude)

    def _nearest(self, start: Path) -> Configuration:
        for place in (start, *start.parents):
            found = self._found.get(place) or _read(place)
            if found is not None:
                # kept for the folder of the file as well: programs in many folders below one file read it once
                self._found[place] = self._found[start] = found
                return found
        # an empty one is kept too: nothing stands above, so a search from below may end here
        self._found[start] = Configuration(folder=start)
        return self._found[start]


def files_above(folder: Path) -> list[Path]:
    """Return every place where the configuration of a folder could stand, there or not."""
    start = Path(os.path.abspath(folder))  # noqa: PTH100
    return [place / name for place in (start, *start.parents) for name in (FILE, PYPROJECT)]


def _read(folder: Path) -> Configuration | None:
    """Return the configuration in a folder itself; None when no file in it has one."""
    own, shared = folder / FILE, folder / PYPROJECT
    # not exists: a link that leads nowhere is reported when it is read
    if os.path.lexists(own):
        table = _table(read_source(own))
        table.integer("schema", 1, low=1, high=1)
        return _configuration(folder, table)
    if not os.path.lexists(shared):
        return None
    source = read_source(shared)
    # the pyproject.toml of another tool is not judged, not even as TOML
    if "robolang" not in source.text:
        return None
    tools = _table(source).table("tool", required=False)
    return _configuration(folder, tools.table("robolang")) if "robolang" in tools else None


def _configuration(folder: Path, table: Table) -> Configuration:
    lint = table.table("lint", required=False)
    layer, bounds, exclude = _layer(lint), _bounds(lint), _texts(table, "exclude")
    _done(lint)
    _done(table)
    return Configuration(folder=folder, layer=layer, bounds=bounds, exclude=exclude)


def _layer(table: Table) -> Layer:
    select = _selectors(table, "select") if "select" in table else None
    return Layer(select=select, extend=_selectors(table, "extend-select"), ignore=_selectors(table, "ignore"))


def _bounds(table: Table) -> "dict[Bound, float]":
    """Read the tables of rules that have bounds."""
    if not any(table.holds(key, dict) for key in table.names()):
        return {}
    from robolang.core.bounds import BOUNDS  # here, since few files set one and every check comes by

    found = {}
    for rule in dict.fromkeys(bound.rule for bound in BOUNDS):
        group = table.table(rule, required=False)
        for bound in (bound for bound in BOUNDS if bound.rule == rule):
            if bound.key in group:
                found[bound] = group.number(bound.key, low=bound.low, high=bound.high)
        _done(group)
    return found


def _texts(table: Table, key: str) -> tuple[str, ...]:
    items = tuple(table.raw_list(key))
    if not all(isinstance(item, str) for item in items):
        table.fail("RBL613", f"'{table.name(key)}' must be a list of texts", key=key)
    return tuple(str(item) for item in items)


def _selectors(table: Table, key: str) -> tuple[str, ...]:
    found = []
    for item in _texts(table, key):
        chosen = selector(item)
        if chosen is None:
            table.fail("RBL710", f"'{table.name(key)}' names '{item}', which is not a rule", guess(item), key=key)
        found.append(chosen)
    return tuple(found)


def _table(source: Source) -> Table:
    """Parse TOML; a key that is given twice is RBL707."""
    try:
        return load_table(source)
    except FileFault as fault:
        # the reader has one code for every error of syntax, so this one is known by its words
        if TWICE not in fault.message:
            raise
        raise _as_configuration(fault) from None


def _done(table: Table) -> None:
    """Reject keys that nothing reads with RBL707."""
    try:
        table.done()
    except FileFault as fault:
        raise _as_configuration(fault) from None


def _as_configuration(fault: FileFault) -> FileFault:
    """Return a fault of the configuration at the place of one of the TOML reader."""
    return FileFault("RBL707", fault.message, fault.hint, fault.place)
