"""A program that runs: what it is made of, and all that changes while it does."""

from collections.abc import Collection
from typing import TypeAlias

from robolang.evaluation.evaluator import Evaluator, World
from robolang.interpreter import run_limits
from robolang.interpreter.actions import Actions
from robolang.interpreter.branch_oracle import Decisions
from robolang.interpreter.effects import Effect, Origin, origin_of
from robolang.interpreter.fed_line import Fed
from robolang.interpreter.positions import Cursor, Suspended
from robolang.interpreter.program_fault import ProgramFault
from robolang.interpreter.rounds import Rounds
from robolang.interpreter.scope import Scopes
from robolang.syntax.ast import CallSub, Expression, If, Jump, Line, Program, Target
from robolang.syntax.blocks import structure_of
from robolang.syntax.tree import Node
from runtime.core.faults import Fault
from runtime.core.program_line import named

Result: TypeAlias = Effect | int | None
"""What a statement comes to: an effect, the index of the line to go to, or None: the next line.

After an effect, the position of the cursor says what is left of the statement.
"""


_FED_LINES = 1_000_000
"""More lines than a text can have."""


class RunState:
    """The program, its world, and the state that the statements of the program read and change."""

    def __init__(self, program: Program, world: World, points: Collection[str], decisions: Decisions) -> None:
        self.program, self.world, self.decisions = program, world, decisions
        self.lines = program.lines
        self.structure = structure_of(program)
        self.scopes = Scopes(frozenset(point.upper() for point in points))
        self.values = Evaluator(self.scopes, world)
        self.actions = Actions(self.values, self.scopes)
        self.rounds = Rounds()
        self.cursor = Cursor()
        self.suspended: tuple[Suspended, ...] = ()
        """Places suspended by statements that were fed, the outermost first."""
        self.steps = self.shown = 0
        """Statements begun and characters of PRINT so far."""

    # --- lines -------------------------------------------------------------------------------------------------------

    def line(self, at: int) -> Line:
        """Return the line of an index, below 0 of what was fed."""
        return self.lines[at] if at >= 0 else self._fed.line(at)

    @property
    def _fed(self) -> Fed:
        assert self.cursor.fed is not None
        return self.cursor.fed

    def end(self, at: int) -> int:
        """Return the line that closes the block of a line."""
        return self.structure.end[at] if at >= 0 else self._fed.end(at)

    def after(self, at: int) -> int:
        """Return the next line of the block of a line, of its last line the first."""
        return self.structure.after[at] if at >= 0 else self._fed.after(at)

    def loop_key(self, at: int) -> int:
        """Return the number under which a FOR counts: what is fed within what was fed has the same lines."""
        return at if at >= 0 else at - _FED_LINES * len(self.suspended)

    def line_of(self, target: Target) -> int:
        """Return the line that a jump leads to; ``Fault`` RBL533 where there is none."""
        found = self.structure.line_of(target)
        if found is None:
            raise Fault("RBL533", "there is no such line")
        return found

    def looped(self, at: int, to: int, *, calls: bool = False) -> int:
        """Return where a jump leads; ``Fault`` RBL508 when the program goes round and round without taking time."""
        if to > at:
            return to
        if not calls:  # a call goes back in the text but is no loop: it returns
            self.rounds.turn(to, at, self.steps)
        if self.rounds.idle(to) > run_limits.MAX_IDLE:
            line = self.line(to)
            where, most = named(line.source_line, line.number), run_limits.MAX_IDLE
            message = f"the loop that begins at {where} has gone round {most} times without a statement that takes time"
            # located at the head of the loop here, since the statement that runs is its end
            raise ProgramFault(Fault("RBL508", message), origin_of(line, line.statement or line), self.calls())
        return to

    def is_true(self, condition: Expression) -> bool:
        """Return the branch that a condition takes."""
        return self.decisions.of(condition.span, self.values.true(condition))

    # --- faults ------------------------------------------------------------------------------------------------------

    def caught(self, fault: Fault, outermost: int) -> int | None:
        """Return the line of the handler that answers a fault, None where none does.

        Handlers of scopes outside of number ``outermost`` have no part in it. ``Fault`` RBL508 where the handler and
        the statement that fails make a loop without an end.
        """
        at = self.cursor.at
        # what is fed has no line that RESUME could go back to
        if fault.code in run_limits.UNCAUGHT or at < 0:
            return None
        handler = self.scopes.catch(at, outermost)
        if handler is None:
            return None
        self.values.error = float(fault.code.removeprefix("RBL"))
        return self.looped(at, handler)

    def located(self, fault: Fault) -> ProgramFault:
        """Return a fault that nothing caught at the part of the statement that failed."""
        return fault if isinstance(fault, ProgramFault) else ProgramFault(fault, self.origin(), self.calls())

    def origin(self) -> Origin:
        """Return the part of a statement that is carried out."""
        at, part = self.cursor.part
        line = self.line(at)
        return origin_of(line, part or line)

    def calls(self) -> tuple[Origin, ...]:
        """Return the CALLs and GOSUBs that have not come back, the outermost first; not one that was fed."""
        return tuple(origin_of(line, _calling(line)) for line in map(self.lines.__getitem__, self._calls()))

    def _calls(self) -> list[int]:
        return [back - 1 for scope in self.scopes.stack for back in (scope.back, *scope.returns) if back > 0]

    def endless_loop(self) -> tuple[Origin, int] | None:
        """Return the head of the loop that keeps the run from ending and its rounds, None where none does."""
        loop = self.rounds.endless((*self._calls(), self.cursor.part[0]), self.steps)
        if loop is None:
            return None
        line = self.line(loop[0])
        return origin_of(line, line.statement or line), loop[1]


def _calling(line: Line) -> Node:
    """Return what calls on a line: of an IF on one line its branch, where only one of the two can."""
    node = line.statement
    if isinstance(node, If):
        branches = [each for each in (node.then, node.otherwise) if isinstance(each, CallSub | Jump)]
        node = branches[0] if len(branches) == 1 else node
    return node or line
