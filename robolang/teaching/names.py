"""Names that may be given to what is taught: words of the language that nothing else has."""

import re

import robolang.core.codes  # noqa: F401 - RBL718 must be registered
from robolang.analysis.analysis import Analysis
from robolang.analysis.symbol_table import SymbolKind
from robolang.syntax.keywords import RESERVED
from robolang.teaching.documents import Documents
from runtime.core.faults import Fault

_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,62}")
_VALUES = (SymbolKind.VARIABLE, SymbolKind.CONSTANT, SymbolKind.PARAMETER)


def check_word(name: str) -> None:
    """Raise ``Fault`` RBL718 for what a program cannot write as a name."""
    if not _WORD.fullmatch(name):
        raise Fault("RBL718", f"{name!r} is no name", "Start with a letter or _; use at most 63 letters, digits and _.")
    if name.upper() in RESERVED:
        raise Fault("RBL718", f"{name} is a word of the language", "Choose another name.")


def check_free(documents: Documents, name: str) -> None:
    """Raise ``Fault`` RBL718 for what is no name, and for the name of a variable, which would hide the point."""
    check_word(name)
    for symbol in Analysis(source=documents.source).symbols.symbols:
        if symbol.kind in _VALUES and symbol.definitions and symbol.name.upper() == name.upper():
            line = documents.source.place(symbol.definitions[0].start).line
            message = f"{name} is a {symbol.kind.value} of the program, in line {line} of the text, and would hide it"
            raise Fault("RBL718", message, "Choose another name.")


def check_not_taken(there: object | None, name: str) -> None:
    """Raise ``Fault`` RBL718 where something of that name is there."""
    if there is not None:
        raise Fault("RBL718", f"{name} is there already", "Choose another name, or remove the other one first.")
