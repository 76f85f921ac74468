"""Everything that ``robolang check`` reports of one program: its analysis, then suppression, selection, fixes.

An editor shows the same list. A cell or points file that cannot be used is a fault beside the findings: the text is
checked without the names that such a file has.
"""

from collections.abc import Collection, Iterator
from pathlib import Path

from robolang.analysis.analysis import Analysis
from robolang.analysis.cell_symbols import NOTHING_KNOWN, CellSymbols
from robolang.analysis.reads import named
from robolang.core.diagnostics import Diagnostic, Severity, in_order
from robolang.core.source import Source, Span
from robolang.lint.fixes import with_fix
from robolang.lint.selection import Selection, is_syntax_error
from robolang.lint.suppress import suppress
from robolang.project.discovery import CellFiles, points_file, read_beside
from robolang.project.points import PointStore, read_points
from runtime.core.faults import Fault
from runtime.core.record import Record
from runtime.core.toml_places import locate
from runtime.core.tomlfile import FileFault, read_source
from runtime.core.tomlfile import Source as TomlSource


class Checked(Record):
    """What was found in one program, by place. A program that could not be read has an empty ``source``.

    ``warnings`` are about its cell and the files of its robot. ``analysis`` is None for another file.
    """

    source: Source
    analysis: Analysis | None = None
    diagnostics: tuple[Diagnostic, ...] = ()
    faults: tuple[Fault, ...] = ()
    warnings: tuple[FileFault, ...] = ()


def lint(
    source: Source, symbols: CellSymbols = NOTHING_KNOWN, *, selection: Selection | None = None, complete: bool = True
) -> tuple[Diagnostic, ...]:
    """Return the findings of a text by place, with their fixes; arguments as of ``findings``."""
    return findings(Analysis(source=source, cell=symbols), selection, complete=complete)


def findings(
    analysis: Analysis, selection: Selection | None = None, *, complete: bool = True
) -> tuple[Diagnostic, ...]:
    """Return what is reported of a program by place, with its fixes.

    Args:
        analysis: the program in its cell.
        selection: which codes are reported; None: all.
        complete: False when what is known of the files beside it is not all there is; see ``suppress``.
    """
    kept = suppress(analysis.source, analysis.diagnostics, complete=complete)
    chosen = kept if selection is None else filter(selection.keeps, kept)
    return in_order(with_fix(item, analysis.source) for item in chosen)


def check_source(source: Source, selection: Selection | None = None, files: CellFiles | None = None) -> Checked:
    """Check a text with the cell and the points that a program of its name has; ``files`` keeps cells that were read.

    The faults of these files are those that keep a run from starting.
    """
    found = read_beside(Path(source.path), files)
    analysis = Analysis(source=source, cell=found.symbols)
    # without its points or cell a finding may be missing, and the noqa that covers it is still needed
    diagnostics = findings(analysis, selection, complete=not found.faults)
    warnings = () if found.cell is None else found.cell.warnings
    return Checked(source=source, analysis=analysis, diagnostics=diagnostics, faults=found.faults, warnings=warnings)


def check_points(
    checked: Checked, selection: Selection | None = None, files: CellFiles | None = None
) -> Checked | None:
    """Return what was found in the points file beside a checked program (RBL224); None: it has none, or is not read.

    ``files`` may have the points file as it is typed. Nothing is reported for a program that does not parse: it may use
    points where nothing can be read.
    """
    analysis, where, files = checked.analysis, points_file(Path(checked.source.path)), files or CellFiles()
    if analysis is None or not _is_whole(checked) or not files.has(where):
        return None
    try:
        # only the names count here: values were checked with the program, in its cell
        text = (files.typed(where) or read_source(where)).text
        store, source = read_points(TomlSource(str(where), text)), Source(str(where), text)
    except Fault:  # another process has just changed it: the next check reports what is wrong
        return None
    unused = _unused_points(store, named(analysis.program), source)
    found = in_order(item for item in unused if selection is None or selection.keeps(item))
    return Checked(source=source, diagnostics=found) if found else None


def _is_whole(checked: Checked) -> bool:
    """Return whether the program and the files beside it could be read from end to end."""
    return not checked.faults and not any(map(is_syntax_error, checked.diagnostics))


def _unused_points(store: PointStore, names: Collection[str], source: Source) -> Iterator[Diagnostic]:
    return (_unused(point.name, source) for key, point in store.points.items() if key not in names)


def _unused(name: str, source: Source) -> Diagnostic:
    line, column = locate(source.text, ("points", name))
    whole = source.line_spans[line - 1]
    return Diagnostic(
        code="RBL224",
        severity=Severity.WARNING,
        span=Span(whole.start + column - 1, whole.end),
        message=f"point {name} is taught, but the program does not use it",
    )
