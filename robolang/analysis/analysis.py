"""What is known of a program without running it, as one value that everybody shares.

Lint, ``check --motion``, a run and an editor hold the same ``Analysis``. Each part is computed when it is first needed,
and kept. Nothing of it changes afterwards: an edit gives a new ``Analysis`` (``updated``). The formatter and renumber
need the tree alone: they take ``parsed`` from one; the commands, which have none, parse the text and import no checker.
"""

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING

from robolang.analysis.cell_symbols import NOTHING_KNOWN, CellSymbols
from robolang.analysis.checker import check
from robolang.analysis.facts import Facts
from robolang.analysis.tabulation import Edges
from robolang.core.diagnostics import Diagnostic, Edit, in_order
from robolang.core.source import Source
from robolang.syntax.ast import Program
from robolang.syntax.blocks import Structure
from robolang.syntax.parser import ParseResult, parse
from runtime.core.record import Record

if TYPE_CHECKING:
    from robolang.analysis.symbol_table import SymbolTable


class Analysis(Record):
    """A text in a cell: tree, blocks, names, control flow, diagnostics. Equal when text and cell are.

    ``cell`` are the names and facts of the cell and of the taught points; what is not known is not checked.
    """

    __slots__ = ("__dict__",)  # for the cached properties

    source: Source
    cell: CellSymbols = NOTHING_KNOWN

    @cached_property
    def parsed(self) -> ParseResult:
        """The result of the parser: the tree and the errors of the text."""
        return parse(self.source)

    @property
    def program(self) -> Program:
        """The tree; a line that cannot be parsed is in it as ``Unparsed``."""
        return self.parsed.program

    @cached_property
    def facts(self) -> Facts:
        """What lint rules read: blocks, control flow and statements, whatever the cell."""
        return Facts(self.program)

    @property
    def blocks(self) -> Structure:
        """Blocks and jumps: which lines belong together and where each jump leads."""
        return self.facts.blocks

    @cached_property
    def symbols(self) -> "SymbolTable":
        """Names, with the place of every definition and every use."""
        from robolang.analysis.symbol_table import SymbolTable  # only an editor needs it: check starts sooner

        return SymbolTable(self.program, self.blocks, self.cell)

    @property
    def flow(self) -> Edges:
        """Control flow: the lines to which each line may lead."""
        return self.facts.flow

    @cached_property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Everything that is wrong, by place: errors of the text, then of its meaning in the cell."""
        found = self.parsed.diagnostics
        if found:
            from robolang.analysis.sub_calls import with_calls  # most programs have no error of text

            found = with_calls(found, self.program)
        # the tree is empty then, and would be called a program without statements (RBL201)
        if self.is_unread:
            return found
        return in_order((*found, *check(self.program, self.cell, self.facts)))

    @property
    def is_unread(self) -> bool:
        """Whether the text is too large to be read (RBL106), so that nothing is known of it."""
        return any(item.code == "RBL106" for item in self.parsed.diagnostics)

    def within(self, cell: CellSymbols) -> "Analysis":
        """Return the analysis of the same text in another cell; it is parsed once for both."""
        if cell == self.cell:
            return self
        kept: dict[str, object] = {name: self.__dict__[name] for name in ("parsed", "facts") if name in self.__dict__}
        return _with(Analysis(source=self.source, cell=cell), kept)

    def updated(self, edit: Edit) -> "Analysis":
        """Return the analysis of the text after an edit; only the lines that it changes are parsed."""
        # late: only an editor needs it, and a check starts sooner without it
        from robolang.syntax.reparse import reparse

        text = self.source.text
        source = Source(self.source.path, f"{text[: edit.span.start]}{edit.text}{text[edit.span.end :]}")
        kept = {"parsed": reparse(self.parsed, self.source, source, edit)}
        return _with(Analysis(source=source, cell=self.cell), kept)


def _with(analysis: Analysis, kept: Mapping[str, object]) -> Analysis:
    """Return a new analysis with parts taken over from another one, by the names of their properties."""
    analysis.__dict__.update(kept)
    return analysis
