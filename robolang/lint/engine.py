"""Checking one program with everything that ``robolang check`` reports: parse, check, suppress, select, fixes.

The same list is what an editor shows. A file that cannot be used is a fault beside the findings: with a points file
that cannot be read the text is checked all the same, without the names of its points.
"""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

from robolang.beside import cell_beside, taught_points
from robolang.checker import check
from robolang.diagnostics import Diagnostic, in_order
from robolang.lint.fixes import with_fix
from robolang.lint.selection import Selection
from robolang.lint.suppress import suppress
from robolang.parser import parse
from robolang.source import Source
from runtime.faults import Fault


@dataclass(frozen=True, slots=True, kw_only=True)
class Checked:
    """What was found in one program, by place. A program that could not be read has an empty ``source``."""

    source: Source
    diagnostics: tuple[Diagnostic, ...] = ()
    faults: tuple[Fault, ...] = ()


def lint(source: Source, *, points: Collection[str] | None, selection: Selection | None = None,
         complete: bool = True) -> tuple[Diagnostic, ...]:  # fmt: skip
    """Return the findings of a text by place, with their fixes.

    Args:
        source: the text.
        points: names of the taught points; None when they are not known.
        selection: which codes are reported; None: all.
        complete: False when what is known of the files beside it is not all there is; see ``suppress``.
    """
    parsed = parse(source)
    too_large = any(item.code == "RBL106" for item in parsed.diagnostics)  # nothing of it was read
    found = parsed.diagnostics if too_large else (*parsed.diagnostics, *check(parsed.program, points=points))
    kept = suppress(source, found, complete=complete)
    chosen = kept if selection is None else filter(selection.keeps, kept)
    return in_order(with_fix(item, source) for item in chosen)


def check_source(source: Source, selection: Selection | None = None) -> Checked:
    """Check a text with the points that a program of its name has."""
    where = Path(source.path)
    try:
        points = taught_points(where, builtin=cell_beside(where) is None).names
    except Fault as fault:
        found = lint(source, points=None, selection=selection, complete=False)
        return Checked(source=source, diagnostics=found, faults=(fault,))
    return Checked(source=source, diagnostics=lint(source, points=points, selection=selection))

