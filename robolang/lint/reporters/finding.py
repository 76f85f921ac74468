"""Findings of many programs as one list, with places resolved: what the forms for machines are made from.

A fault of a file becomes a finding of that file. The *fingerprint* of a finding stays the same when lines are added
above it and when lines are renumbered: it is made from the path below the root, the code and the text of the line
without its line number, and counts equal ones.
"""

import hashlib
import os
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from robolang.core.diagnostics import Diagnostic, Fix, Severity, safe
from robolang.core.source import Source, Span
from robolang.lint.engine import Checked
from robolang.lint.files import STANDARD_INPUT
from runtime.core.faults import Fault, lookup
from runtime.core.tomlfile import FileFault

_NUMBER = re.compile(r"\s*[0-9]*\s*")


@dataclass(frozen=True, slots=True, kw_only=True)
class Region:
    """A range of 1-based lines and columns; the end is exclusive."""

    line: int = 1
    column: int = 1
    end_line: int = 1
    end_column: int = 1


@dataclass(frozen=True, slots=True, kw_only=True)
class Note:
    """Another place that explains a finding."""

    region: Region
    message: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Correction:
    """A fix with its edits resolved to regions."""

    title: str
    safe: bool
    edits: tuple[tuple[Region, str], ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """One finding; ``path`` as the user gave it, ``line_text`` the text of its line."""

    path: str
    code: str
    severity: Severity
    message: str
    hint: str
    region: Region
    line_text: str = ""
    notes: tuple[Note, ...] = ()
    fix: Correction | None = None

    @property
    def name(self) -> str:
        """The name of the code."""
        return lookup(self.code).name


def findings(results: Iterable[Checked]) -> list[Finding]:
    """Return what was found, program by program, faults of files after the findings of the program."""
    found: list[Finding] = []
    for result in results:
        found += [_finding(item, result.source) for item in result.diagnostics]
        found += [_of_fault(fault, result.source.path) for fault in result.faults]
    return found


def relative(path: str, root: Path) -> str:
    """Return a path below the root, with ``/``; a file elsewhere is reached with ``..``."""
    if path == STANDARD_INPUT or "\0" in path:
        return path
    return Path(os.path.relpath(path, root)).as_posix()


def fingerprints(found: Sequence[Finding], root: Path) -> list[str]:
    """Return one fingerprint for each finding, all different."""
    seen: Counter[str] = Counter()
    marks = []
    for item in found:
        # spaces count as one: fmt must not make all findings of a file new ones
        text = " ".join(item.line_text[_end_of_number(item.line_text) :].split())
        key = "\0".join((relative(item.path, root), item.code, text))
        # surrogatepass: a file name that is not UTF-8 has lone surrogates, which plain UTF-8 refuses
        marks.append(hashlib.sha256(f"{key}\0{seen[key]}".encode("utf-8", "surrogatepass")).hexdigest()[:32])
        seen[key] += 1
    return marks


def _end_of_number(line: str) -> int:
    number = _NUMBER.match(line)
    return number.end() if number else 0


def _finding(item: Diagnostic, source: Source) -> Finding:
    return Finding(
        path=source.path,
        code=item.code,
        severity=item.severity,
        message=safe(item.message),
        hint=safe(item.hint),
        region=_region(item.span, source),
        line_text=source.line_text(source.place(item.span.start).line),
        notes=tuple(Note(region=_region(note.span, source), message=safe(note.message)) for note in item.related),
        fix=None if item.fix is None else _correction(item.fix, source),
    )


def _of_fault(fault: Fault, path: str) -> Finding:
    region = Region()
    if isinstance(fault, FileFault):
        path = fault.path
        region = Region(line=fault.line, column=fault.column, end_line=fault.line, end_column=fault.column)
    return Finding(
        path=path,
        code=fault.code,
        severity=Severity.ERROR,
        message=safe(fault.message),
        hint=safe(fault.hint),
        region=region,
    )


def _region(span: Span, source: Source) -> Region:
    start, end = source.place(span.start), source.place(span.end)
    return Region(line=start.line, column=start.column, end_line=end.line, end_column=end.column)


def _correction(fix: Fix, source: Source) -> Correction:
    edits = tuple((_region(edit.span, source), edit.text) for edit in fix.edits)
    return Correction(title=fix.title, safe=fix.safe, edits=edits)
