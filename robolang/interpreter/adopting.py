"""A state of a machine moved to an edited program: it stands before the same statement, inside of the same calls.

What the program is inside of must still be there: a statement that is carried out, a FOR that runs, the lines of its
CALLs and GOSUBs, a handler of errors, the SUB that runs. A line that was removed or has become another kind is a
``Fault`` RBL543 that names it. Lines that the program is not inside of may change in any manner.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Protocol

from robolang.core.source import Span
from robolang.interpreter.branch_oracle import DecisionsSnapshot
from robolang.interpreter.positions import (
    BEGUN,
    DUE,
    Asking,
    Begun,
    Comparing,
    Cursor,
    Drained,
    Due,
    Given,
    Position,
    Suspended,
    WaitDue,
    Waiting,
)
from robolang.interpreter.scope import Loop, Scope
from robolang.interpreter.snapshot import MachineSnapshot
from robolang.syntax.ast import CallSub, For, If, Jump, Program, Statement
from robolang.syntax.blocks import Structure, structure_of, word_of
from robolang.syntax.tree import Node, walk
from runtime.core.faults import Fault
from runtime.core.program_line import named


class Lines(Protocol):
    """Where the lines of a program went in an edit, as indices of ``Program.lines``."""

    def of(self, index: int) -> int | None:
        """Return the new index of a line, None when it was deleted."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProgramEdit:
    """A program before and after an edit, and where its lines went."""

    old: Program
    new: Program
    lines: Lines

    def of(self, index: int) -> int | None:
        """Return the new index of a line; the place after the last line stays there."""
        if index < 0:  # in a text that was fed
            return index
        if index >= len(self.old.lines):
            return len(self.new.lines)
        to = self.lines.of(index)
        return None if to is None or to >= len(self.new.lines) else to

    def kept(self, index: int, what: str) -> int:
        """Return the new index of a line that the program is inside of; ``Fault`` RBL543 where it was removed."""
        to = self.of(index)
        if to is None:
            raise self.refusal(index, f"{what} was removed")
        return to

    def refusal(self, index: int, what: str) -> Fault:
        """Return the fault of a line of the program as it was."""
        line = self.old.lines[index]
        return Fault("RBL543", f"{named(line.source_line, line.number)}: {what}")


def moved(state: MachineSnapshot, edit: ProgramEdit) -> MachineSnapshot:
    """Return the state in the edited program; ``Fault`` RBL543 where the program is inside of what was removed."""
    return _Move(edit).state(state)


def moved_place(place: Suspended, edit: ProgramEdit) -> Suspended:
    """Return a place outside of a state, such as that of a statement that an alarm has interrupted."""
    return replace(place, cursor=_Move(edit).cursor(place.cursor))


class _Move:
    def __init__(self, edit: ProgramEdit) -> None:
        self._edit = edit
        self._before, self._after = structure_of(edit.old), structure_of(edit.new)

    def state(self, state: MachineSnapshot) -> MachineSnapshot:
        cursors = (*(each.cursor for each in state.suspended), state.cursor)
        # the innermost place of the program itself: what is fed is on none of its lines
        at = next((cursor.at for cursor in reversed(cursors) if cursor.at >= 0), 0)
        return replace(
            state,
            program=self._edit.new,
            cursor=self.cursor(state.cursor),
            suspended=tuple(replace(each, cursor=self.cursor(each.cursor)) for each in state.suspended),
            scopes=self._scopes(state.scopes, at),
            rounds=state.rounds.moved(self._edit.of),
            decisions=self._decisions(state.decisions),
        )

    # --- where it stands ---------------------------------------------------------------------------------------------

    def cursor(self, cursor: Cursor) -> Cursor:
        at, lines = cursor.at, self._edit.new.lines
        if at < 0:  # in the text of what was fed
            return cursor.copy()
        if isinstance(cursor.position, Due | Begun) or cursor.ended is not None or at >= len(self._edit.old.lines):
            return self._standing(cursor)
        # in the middle of it: what is left is of this very statement
        to = self._edit.kept(at, "the statement that is carried out")
        self._check_blocks(at, to)
        node = lines[to].statement
        if node is None:
            raise self._edit.refusal(at, "the statement that is carried out was removed")
        return replace(cursor, at=to, position=self._position(cursor, to), part=(to, node))

    def _standing(self, cursor: Cursor) -> Cursor:
        """Return a place before a statement, or after the last one; where the line was removed, before the next one."""
        at, lines, old = cursor.at, self._edit.new.lines, len(self._edit.old.lines)
        to = self._edit.of(at)
        while to is None:
            at += 1
            to = self._edit.of(at)
        if cursor.at < old:
            self._check_blocks(cursor.at, to)
        while to < len(lines) and lines[to].statement is None:
            to += 1
        if to >= len(lines):
            return Cursor(at=len(lines), ended=cursor.ended)
        if isinstance(cursor.position, Due):
            return replace(cursor, at=to, position=DUE, part=(to, None))
        return replace(cursor, at=to, position=BEGUN, part=(to, lines[to].statement))

    def _position(self, cursor: Cursor, to: int) -> Position:
        """Return what is left of a statement that is carried out."""
        position, at, edit = cursor.position, cursor.at, self._edit
        if isinstance(position, Given):
            return position if position.to is None else replace(position, to=edit.of(position.to))
        old, new = edit.old.lines[at].statement, edit.new.lines[to].statement
        if old != new or new is None or old is None:  # what is left of it would be of another statement
            raise edit.refusal(at, "the statement that is carried out was changed")
        # the head of the block is at the cursor; what is evaluated is another line of it
        if isinstance(position, Asking | Comparing):
            inner = edit.kept(position.at, "the branch that is evaluated")
            if edit.old.lines[position.at].statement != edit.new.lines[inner].statement:
                raise edit.refusal(position.at, "the branch that is evaluated was changed")
            return replace(position, at=inner)
        assert isinstance(position, Drained | WaitDue | Waiting)
        part: Any = _same_part(position.node, old, new)
        return replace(position, node=part)

    def _check_blocks(self, at: int, to: int) -> None:
        """Refuse where a block around a line has become another one; an IF, WHILE or SELECT may be taken away."""
        for head in _heads(self._before, at):
            word, now = word_of(self._edit.old.lines[head].statement), self._edit.of(head)
            around = now is not None and to < len(self._after.inside) and now in _heads(self._after, to)
            if around and now is not None:
                if word_of(self._edit.new.lines[now].statement) != word:
                    raise self._edit.refusal(head, f"this {word}, of which the program is inside, was changed")
            # these two have a state, a count of rounds and a scope; the others are no more than jumps
            elif word in ("FOR", "SUB") or now is not None:
                raise self._edit.refusal(head, f"this {word}, of which the program is inside, was removed")

    # --- calls, loops, handlers --------------------------------------------------------------------------------------

    def _scopes(self, scopes: tuple[Scope, ...], at: int) -> tuple[Scope, ...]:
        """Return the scopes; ``at``: the line where the innermost runs."""
        # where a scope stands: at the CALL that the next one inside it returns to
        places = [*(scope.back - 1 if scope.back > 0 else at for scope in scopes[1:]), at]
        return tuple(self._scope(scope, place) for scope, place in zip(scopes, places, strict=True))

    def _scope(self, scope: Scope, at: int) -> Scope:
        edit, failure = self._edit, scope.failure
        if failure is not None:
            line = edit.kept(failure.line, "the statement that RESUME goes back to")
            failure = replace(failure, line=line, returns=tuple(map(self._return, failure.returns)))
        handler = scope.handler
        if handler is not None and handler >= 0:  # below 0 it is STOPS
            handler = edit.kept(handler, "the handler of errors")
        return replace(
            scope.copy(),
            back=self._return(scope.back),
            loops=[loop for each in scope.loops if (loop := self._loop(each, at)) is not None],
            returns=[self._return(each) for each in scope.returns],
            handler=handler,
            failure=failure,
        )

    def _return(self, back: int) -> int:
        """Return the line at which a call goes on, one after its own."""
        if back <= 0:  # of the main program, and of what was fed
            return back
        at = back - 1
        to = self._edit.kept(at, "the call that has not come back")
        if not _calls(self._edit.new.lines[to].statement):
            raise self._edit.refusal(at, "the call that has not come back was changed")
        return to + 1

    def _loop(self, loop: Loop, at: int) -> Loop | None:
        """Return a FOR that runs, None for one that a jump has left and that is gone."""
        if loop.line < 0:
            return replace(loop)
        to = self._edit.of(loop.line)
        node = None if to is None else self._edit.new.lines[to].statement
        if to is not None and isinstance(node, For) and node.variable.key == loop.variable:
            return replace(loop, line=to)
        if loop.line in _heads(self._before, at):
            raise self._edit.refusal(loop.line, "the FOR that runs was removed or counts another name")
        return None

    # --- conditions --------------------------------------------------------------------------------------------------

    def _decisions(self, decisions: DecisionsSnapshot) -> DecisionsSnapshot:
        """Return the branches of conditions by their new places; those of changed lines are forgotten."""
        places = _shifts(self._edit)
        forced = {to: taken for span, taken in decisions.forced.items() if (to := places(span)) is not None}
        seen = {to: taken for span, taken in decisions.taken.items() if (to := places(span)) is not None}
        return DecisionsSnapshot(forced=forced, taken=seen)


def _heads(structure: Structure, at: int) -> tuple[int, ...]:
    """Return the heads of the blocks that a line is in; the last line of a block counts as in it."""
    inside = structure.inside[at] if at < len(structure.inside) else ()
    return (*inside, structure.after[at]) if structure.end.get(at) == at else inside


def _calls(node: Statement | None) -> bool:
    """Return whether a statement calls: CALL or GOSUB, or an IF on one line with one of them."""
    if isinstance(node, If):
        return _calls(node.then) or _calls(node.otherwise)
    return isinstance(node, CallSub) or (isinstance(node, Jump) and node.word == "GOSUB")


def _same_part(part: Node, old: Statement, new: Statement) -> Node:
    """Return the part of a statement that equals it which is at the place of a part of the other."""
    pairs = zip(walk(old), walk(new), strict=True)
    return next(there for here, there in pairs if here is part)


def _shifts(edit: ProgramEdit) -> Callable[[Span], Span | None]:
    """Return the function from a place in a line of the old text to the same place in the new one, None: it changed."""
    rows = []  # conditions are known by their places in the text
    for index, line in enumerate(edit.old.lines):
        to = edit.of(index)
        if to is not None and edit.new.lines[to].statement == line.statement:
            rows.append((line.span, edit.new.lines[to].span.start - line.span.start))

    def place(span: Span) -> Span | None:
        for row, by in rows:
            if row.start <= span.start < row.end:
                return Span(span.start + by, span.end + by)
        return None

    return place
