"""A new name for a point, frame, tool or load, in program, points file and cell file together."""

from dataclasses import replace

from robolang.analysis.analysis import Analysis
from robolang.analysis.cell_symbols import CellSymbols
from robolang.analysis.symbol_table import SymbolKind
from robolang.teaching.cell_document import cell_of, rename_in_cell
from robolang.teaching.documents import Documents
from robolang.teaching.names import FRAMES, LOADS, POINTS, TOOLS, check_free, check_not_taken
from robolang.teaching.points_document import rename_in_points, set_point, taught
from runtime.core.faults import Fault

_KINDS = {FRAMES: SymbolKind.FRAME, TOOLS: SymbolKind.TOOL, LOADS: SymbolKind.LOAD}


def rename_point(documents: Documents, name: str, new: str) -> Documents:
    """Rename a point and every use that means it; a variable that hides it somewhere keeps its name.

    A line with an error in its text is left as it is. ``Fault`` RBL301: no such point; RBL718: the new name is no name,
    taken, or that of a variable, a frame or a tool.
    """
    points = taught(documents)
    if points.get(name) is None:
        raise Fault("RBL301", f"there is no point {name}", "Name a point that is taught.")
    check_free(documents, POINTS, new)
    if new.upper() != name.upper():  # its spelling alone may change
        check_not_taken(points.get(new), new)
    renamed = rename_in_points(documents, name, new)
    return _in_program(renamed, CellSymbols(points=points.names), SymbolKind.POINT, name, new)


def rename_of_cell(documents: Documents, group: str, name: str, new: str) -> Documents:
    """Rename a frame, tool or load (``FRAMES``, ``TOOLS``, ``LOADS``), and every use in the program and the points.

    ``Fault`` RBL305: it is not there; RBL718 as ``rename_point``.
    """
    check_free(documents, group, new)
    cell, points = cell_of(documents), taught(documents)
    there = {each.upper() for each in getattr(cell, group)}
    if new.upper() != name.upper():
        check_not_taken(new if new.upper() in there else None, new)
    renamed = rename_in_cell(documents, group, name, new)
    for point in points.points.values():
        if group == FRAMES and point.frame.upper() == name.upper():
            renamed = set_point(renamed, point.replaced(frame=new))
        elif group == TOOLS and point.tool.upper() == name.upper():
            renamed = set_point(renamed, point.replaced(tool=new))
    return _in_program(renamed, CellSymbols.of(cell, points.names), _KINDS[group], name, new)


def _in_program(documents: Documents, cell: CellSymbols, kind: SymbolKind, name: str, new: str) -> Documents:
    text, key = documents.program, name.upper()
    for symbol in Analysis(source=documents.source, cell=cell).symbols.symbols:
        if symbol.kind is kind and symbol.name.upper() == key:
            for span in sorted(symbol.uses, reverse=True):  # from the end, so that earlier places stay
                text = f"{text[: span.start]}{new}{text[span.end :]}"
    return replace(documents, program=text)
