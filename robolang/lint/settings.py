"""Configuration of the linter: ``[lint]`` of ``robolang.toml``, or ``[tool.robolang.lint]`` of ``pyproject.toml``.

The nearest folder above a program that has either file counts, and of two in one folder ``robolang.toml``; files are
not merged. A ``pyproject.toml`` that does not speak of robolang is passed over. ::

    [lint]
    select = ["RBL1", "RBL2"]          # these only; without it all
    extend-select = ["point-undefined"]
    ignore = ["RBL116"]

An unknown key, or one given twice, is a ``FileFault`` RBL707 at its place, an unknown rule RBL710.
"""

import os
from pathlib import Path
from typing import NoReturn

from robolang.lint.selection import Layer, guess, selector
from runtime.tomlfile import FileFault, Source, Table, lines_of, load_table, read_source

FILE, PYPROJECT = "robolang.toml", "pyproject.toml"
_TWICE = ("Cannot overwrite a value", "Cannot declare")


class Settings:
    """The layer of every folder, each file read once."""

    def __init__(self) -> None:
        self._layers: dict[Path, Layer] = {}

    def layer(self, folder: Path) -> Layer:
        """Return what the nearest file says of programs in a folder; ``FileFault`` RBL600, RBL601, RBL61x, RBL7xx."""
        start = Path(os.path.abspath(folder))  # noqa: PTH100 - not resolved: the folder as the user sees it
        for place in (start, *start.parents):
            if place not in self._layers:
                found = _layer_of(place)
                if found is None:
                    continue
                self._layers[place] = found
            self._layers[start] = self._layers[place]
            return self._layers[place]
        self._layers[start] = Layer()
        return self._layers[start]


def files_above(folder: Path) -> list[Path]:
    """Return every place where the configuration of a folder could stand, there or not."""
    start = Path(os.path.abspath(folder))  # noqa: PTH100
    return [place / name for place in (start, *start.parents) for name in (FILE, PYPROJECT)]


def _layer_of(folder: Path) -> Layer | None:
    """Return the layer of a folder's own file; None when it has none that speaks of robolang."""
    own, shared = folder / FILE, folder / PYPROJECT
    if os.path.lexists(own):
        table = _table(read_source(own))
        table.integer("schema", 1, low=1, high=1)
        return _only_lint(table)
    if not os.path.lexists(shared):
        return None
    source = read_source(shared)
    if "robolang" not in source.text:
        return None
    tools = _table(source).table("tool", required=False)
    return _only_lint(tools.table("robolang")) if "robolang" in tools else None


def _only_lint(table: Table) -> Layer:
    layer = _layer(table.table("lint", required=False))
    _done(table)
    return layer


def _layer(table: Table) -> Layer:
    select = _selectors(table, "select") if "select" in table else None
    layer = Layer(select=select, extend=_selectors(table, "extend-select"), ignore=_selectors(table, "ignore"))
    table.ask("select")
    _done(table)
    return layer


def _selectors(table: Table, key: str) -> tuple[str, ...]:
    found = []
    for item in table.raw_list(key):
        if not isinstance(item, str):
            table.fail("RBL613", f"'{table.name(key)}' must be a list of texts", key=key)
        chosen = selector(item)
        if chosen is None:
            table.fail("RBL710", f"'{table.name(key)}' names '{item}', which is no rule", guess(item), key=key)
        found.append(chosen)
    return tuple(found)


def _table(source: Source) -> Table:
    """Parse TOML; a key that is given twice is RBL707."""
    try:
        return load_table(source)
    except FileFault as fault:
        if fault.message.startswith(_TWICE):
            _twice(source, fault)
        raise


def _twice(source: Source, fault: FileFault) -> NoReturn:
    line = lines_of(source.text)[fault.line - 1]
    column = len(line) - len(line.lstrip()) + 1
    name = line.partition("=")[0].strip() if not line.lstrip().startswith("[") else line.strip()
    raise FileFault("RBL707", f"{name} is given twice", "", path=fault.path, line=fault.line, column=column,
                    excerpt=line) from None  # fmt: skip


def _done(table: Table) -> None:
    """Reject keys that nothing reads with RBL707."""
    try:
        table.done()
    except FileFault as fault:
        raise FileFault("RBL707", fault.message, fault.hint, path=fault.path, line=fault.line, column=fault.column,
                        excerpt=fault.excerpt) from None  # fmt: skip
