"""Checking one program with everything that ``robolang check`` reports: parse, check, suppress, select, fixes.

The same list is what an editor shows. A cell or points file that cannot be used is a fault beside the findings: the
text is checked all the same, without the names that such a file has.
"""

import os
from dataclasses import dataclass
from pathlib import Path

from robolang.analysis.cell_symbols import NOTHING_KNOWN, CellSymbols
from robolang.analysis.checker import check
from robolang.analysis.usage_check import named
from robolang.core.diagnostics import Diagnostic, Severity, in_order
from robolang.core.source import Source, Span
from robolang.lint.fixes import with_fix
from robolang.lint.selection import Selection, is_syntax_error
from robolang.lint.suppress import suppress
from robolang.project.discovery import CellFiles, read_beside
from robolang.project.points import load_points
from robolang.syntax.parser import parse
from runtime.core.faults import Fault
from runtime.core.toml_places import locate
from runtime.core.tomlfile import FileFault, read_source


@dataclass(frozen=True, slots=True, kw_only=True)
class Checked:
    """What was found in one program, by place. A program that could not be read has an empty ``source``.

    ``warnings`` are about its cell and the files of its robot.
    """

    source: Source
    diagnostics: tuple[Diagnostic, ...] = ()
    faults: tuple[Fault, ...] = ()
    warnings: tuple[FileFault, ...] = ()


def lint(
    source: Source, symbols: CellSymbols = NOTHING_KNOWN, *, selection: Selection | None = None, complete: bool = True
) -> tuple[Diagnostic, ...]:
    """Return the findings of a text by place, with their fixes.

    Args:
        source: the text.
        symbols: what is known of the cell and the taught points.
        selection: which codes are reported; None: all.
        complete: False when what is known of the files beside it is not all there is; see ``suppress``.
    """
    parsed = parse(source)
    too_large = any(item.code == "RBL106" for item in parsed.diagnostics)  # nothing of it was read
    found = parsed.diagnostics if too_large else (*parsed.diagnostics, *check(parsed.program, symbols))
    kept = suppress(source, found, complete=complete)
    chosen = kept if selection is None else filter(selection.keeps, kept)
    return in_order(with_fix(item, source) for item in chosen)


def check_source(source: Source, selection: Selection | None = None, files: CellFiles | None = None) -> Checked:
    """Check a text with the cell and the points that a program of its name has; ``files`` keeps cells that were read.

    The faults of these files are those that keep a run from starting.
    """
    found = read_beside(Path(source.path), files)
    diagnostics = lint(source, found.symbols, selection=selection, complete=not found.faults)
    warnings = () if found.cell is None else found.cell.warnings
    return Checked(source=source, diagnostics=diagnostics, faults=found.faults, warnings=warnings)


def check_points(checked: Checked, selection: Selection | None = None) -> Checked | None:
    """Return what was found in the points file beside a checked program (RBL224); None: it has none, or is not read.

    A program that does not parse may name points where nothing can be read: then nothing is said.
    """
    where = Path(checked.source.path).with_suffix(".points.toml")
    if checked.faults or any(map(is_syntax_error, checked.diagnostics)) or not os.path.lexists(where):
        return None
    try:
        store, source = load_points(where), Source(str(where), read_source(where).text)
    except Fault:  # it has just been written to: the next check says what is wrong
        return None
    names = named(parse(checked.source).program)
    unused = (_unused(point.name, source) for key, point in store.points.items() if key not in names)
    found = in_order(item for item in unused if selection is None or selection.keeps(item))
    return Checked(source=source, diagnostics=found) if found else None


def _unused(name: str, source: Source) -> Diagnostic:
    line, column = locate(source.text, ("points", name))
    whole = source.line_spans[line - 1]
    return Diagnostic(
        code="RBL224",
        severity=Severity.WARNING,
        span=Span(whole.start + column - 1, whole.end),
        message=f"point {name} is taught and the program does not name it",
    )
