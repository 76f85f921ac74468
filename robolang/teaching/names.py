"""Names that may be given to what is taught: words of the language that mean nothing else.

A program looks a name up as a variable first, then as a taught point, then, after TOOL and FRAME, as one of the cell.
"""

import re

import robolang.core.codes  # noqa: F401 - RBL718 must be registered
from robolang.analysis.analysis import Analysis
from robolang.analysis.symbol_table import SymbolKind
from robolang.project.builtin import cell_text, points_text
from robolang.syntax.keywords import RESERVED
from robolang.teaching.documents import Documents
from robolang.teaching.toml_text import spelling
from runtime.core.faults import Fault

POINTS, FRAMES, TOOLS, LOADS = "points", "frames", "tools", "loads"
_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,62}")
_VALUES = (SymbolKind.VARIABLE, SymbolKind.CONSTANT, SymbolKind.PARAMETER)
_OTHERS = {POINTS: (FRAMES, TOOLS), FRAMES: (POINTS,), TOOLS: (POINTS,), LOADS: ()}
"""Groups in which a name must not be too: it would hide, or be hidden."""


def check_free(documents: Documents, group: str, name: str) -> None:
    """Raise ``Fault`` RBL718 for what is no name, and for a name that the program or another group has."""
    if not _WORD.fullmatch(name):
        raise Fault("RBL718", f"{name!r} is no name", "Start with a letter or _; use at most 63 letters, digits and _.")
    if name.upper() in RESERVED:
        raise Fault("RBL718", f"{name} is a word of the language", "Choose another name.")
    if group == LOADS:  # LOAD names nothing else
        return
    _check_program(documents, name)
    for other in _OTHERS[group]:
        if spelling(_text(documents, other), other, name) is not None:
            raise Fault("RBL718", f"{name} is one of the {other}", "Choose another name.")


def check_not_taken(there: object | None, name: str) -> None:
    """Raise ``Fault`` RBL718 where something of that name is there."""
    if there is not None:
        raise Fault("RBL718", f"{name} is there already", "Choose another name, or remove the other one first.")


def _check_program(documents: Documents, name: str) -> None:
    for symbol in Analysis(source=documents.source).symbols.symbols:
        if symbol.kind in _VALUES and symbol.name.upper() == name.upper():
            line = documents.source.place(symbol.definitions[0].start).line
            message = f"{name} is a {symbol.kind.value} of the program, in line {line} of the text, which would hide it"
            raise Fault("RBL718", message, "Choose another name.")


def _text(documents: Documents, group: str) -> str:
    if group != POINTS:
        return cell_text() if documents.cell is None else documents.cell
    return documents.points or (points_text() if documents.cell is None else "")
