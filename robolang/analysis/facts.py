"""What lint rules read of a program: its tree, blocks and control flow. Nothing of it depends on the cell.

Each part is computed when a rule asks for it, and kept for the others.
"""

from collections.abc import Iterator
from functools import cached_property

from robolang.analysis.dataflow import MAX_LINES, edges_of, facts_before
from robolang.analysis.tabulation import Edge, Edges
from robolang.syntax.ast import Head, If, Program, Statement, Word
from robolang.syntax.blocks import Structure, structure_of


class Facts:
    """A program with what is known of it without its cell."""

    def __init__(self, program: Program) -> None:
        self.program = program

    @cached_property
    def blocks(self) -> Structure:
        """Blocks and jumps: which lines belong together and where each jump leads."""
        return structure_of(self.program)

    @cached_property
    def flow(self) -> Edges:
        """Control flow: the lines to which each line may lead."""
        return edges_of(self.program, self.blocks)

    @cached_property
    def parts(self) -> tuple[tuple[int, Statement], ...]:
        """Every statement with the index of its line, those of a one-line IF one by one."""
        return tuple(
            (index, node) for index, line in enumerate(self.program.lines) for node in parts_of(line.statement)
        )

    @cached_property
    def statements(self) -> tuple[Statement, ...]:
        """Every statement, those of a one-line IF one by one."""
        return tuple(node for _, node in self.parts)

    @cached_property
    def reached(self) -> tuple[bool, ...] | None:
        """Whether each line can be reached, and at last whether the end below all lines can.

        None where the program is too long or too intricate to be followed: then no rule follows anything in it.
        """
        if len(self.program.lines) > MAX_LINES:
            return None
        before = facts_before(self._resumed(), True, lambda at, node, fact: (fact,))
        return None if before is None else tuple(map(bool, before))

    def _resumed(self) -> Edges:
        """Return the flow with that of RESUME NEXT, where a program has it: after a CALL and a block that failed."""
        if not any(isinstance(node, Word) and node.word == "RESUME NEXT" for node in self.statements):
            return self.flow
        after = {at: self.blocks.end.get(at, at) + 1 for at, node in self.parts if isinstance(node, Head)}
        return [
            [*each, Edge(None, "go", after.get(index, index + 1))]
            if index in after or any(edge.kind == "call" for edge in each)
            else each
            for index, each in enumerate(self.flow)
        ]


def parts_of(node: Statement | None) -> Iterator[Statement]:
    """Yield a statement and those inside it: both branches of a one-line IF."""
    todo = [node]
    while todo:  # no recursion: a line has room for a thousand IFs
        part = todo.pop()
        if part is not None:
            yield part
        if isinstance(part, If):
            todo += [part.otherwise, part.then]
