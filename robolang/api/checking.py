"""Findings of programs for Python, without running them."""

from collections.abc import Sequence
from pathlib import Path

from robolang.core.calls import checked, refuse
from robolang.core.source import Source, check_path, read_program
from robolang.lint.engine import Checked, check_source
from robolang.lint.files import SUFFIX, programs
from robolang.lint.selection import Layer, Selection, selector
from robolang.lint.settings import Settings
from robolang.project.arguments import PathLike
from robolang.project.discovery import CellFiles
from runtime.core.faults import Fault


@checked
def check(*paths: PathLike, select: Sequence[str] | None = None, ignore: Sequence[str] = ()) -> list[Checked]:
    """Return what is found in programs and in the programs of folders; without a path in those of this folder.

    Each has its ``source``, its ``diagnostics`` by place with their fixes, and the ``faults`` of files that cannot be
    used, its own among them. ``select`` and ``ignore``: codes, beginnings of codes or names, over those of
    ``robolang.toml``. Nothing is planned: ``plan`` does that. ``Fault`` RBL701 for a path that is not there, RBL703
    for an unknown code.
    """
    layer = Layer(select=None if select is None else _selectors(select, "select"), ignore=_selectors(ignore, "ignore"))
    for path in paths:
        check_path(str(path))
    # read once: many programs of a folder have one cell and one robolang.toml
    settings, files = Settings(), CellFiles()
    names = programs([str(path) for path in paths or (".",)], SUFFIX, settings.excludes)
    return [_checked(name, Selection(layers=(settings.layer(Path(name).parent), layer)), files) for name in names]


@checked
def check_text(text: str, *, name: str = "program.rbl") -> Checked:
    """Return what is found in a text, with the cell and the points that a program of this name has."""
    return check_source(Source(name, text))


def _checked(name: str, selection: Selection, files: CellFiles) -> Checked:
    try:
        return check_source(read_program(name), selection, files)
    except Fault as fault:
        return Checked(source=Source(name, ""), faults=(fault,))


def _selectors(words: Sequence[str], argument: str) -> tuple[str, ...]:
    found = []
    for word in words:
        known = selector(word)
        if known is None:
            refuse(argument, f"'{word}' is no code, no beginning of one and no name of one")
        found.append(known)
    return tuple(found)
