"""The interpreter: a program that can be stepped, fed, kept and taken back.

``Machine.step`` carries a program to its next event: a statement begins, an effect is requested, a fault was not
caught, the program is over. Nothing is computed ahead: the state of the machine is that of the event it has yielded,
until the next step. A statement that reads where the robot is, an input or the time requests ``Drain``
first, so that what it reads is of this place in the program.

Errors. A ``Fault`` of an expression, or one that the executor reports with ``refuse`` since an effect could not be
carried out (planning, timeouts), goes to the line that ON ERROR GOTO named (``scope``), unless that handler runs
already; ERR is then the number of its code. RESUME takes the statement again, RESUME NEXT the one after it. A latched
alarm of the robot never comes here: it ends the run.

Bounds are counts, not wall clock: ``run_limits``, ``scope`` for memory, ``evaluator`` for one text.
"""

from collections.abc import Callable, Collection
from dataclasses import replace
from typing import TypeAlias

from robolang.evaluation.evaluator import Evaluator, World
from robolang.interpreter import dispatch, run_limits, snapshot
from robolang.interpreter.branch_oracle import Decisions
from robolang.interpreter.effects import Drain, Origin, origin
from robolang.interpreter.events import DONE, FED_ENDED, Event, Failed, FedEnded, LineBegun
from robolang.interpreter.fed_line import AFTER_FED, Fed
from robolang.interpreter.positions import BEGUN, DUE, GIVEN, Cursor, Drained, Suspended, Waiting
from robolang.interpreter.program_fault import ProgramFault
from robolang.interpreter.rounds import Rounds
from robolang.interpreter.run_state import Result, RunState
from robolang.interpreter.scope import Scopes
from robolang.interpreter.snapshot import MachineSnapshot
from robolang.interpreter.variables import Variables, variables_of
from robolang.syntax.ast import Case, For, Line, Next, Program, Statement, Sub, Unparsed
from robolang.syntax.blocks import word_of
from robolang.values.poses import Frame, Value
from runtime.core.faults import Fault

_Ready: TypeAlias = tuple[Statement, Callable[..., Result], bool, LineBegun]
"""What is known of a statement before it runs: node, function, whether motion ends first, event of its beginning."""


class Machine:
    """A checked program that runs.

    ``world`` is what it reads of the robot; it is no part of the state. ``points`` are the names of the taught ones.
    ``decisions`` records the branch that each condition takes, and may change it.
    """

    def __init__(
        self, program: Program, world: World, points: Collection[str], decisions: Decisions | None = None
    ) -> None:
        self._run = RunState(program, world, points, decisions or Decisions())
        self._ready: list[_Ready | None] = [None] * len(program.lines)

    # --- going on ----------------------------------------------------------------------------------------------------

    def step(self) -> Event:
        """Go on to the next event and return it; ``Done``, or ``Failed`` of the program, again when it is over.

        Raises ``ValueError`` at a statement with an error: such a program must not be run.
        """
        cursor = self._run.cursor
        if cursor.ended is not None:
            return cursor.ended
        result: Result | Failed
        try:
            result = self._carry_out(cursor)
        except Fault as fault:
            result = self._answer(fault)
        if result is None:
            to = cursor.at + 1
        elif isinstance(result, int):
            to = result
        else:
            return result
        if to < 0 or cursor.at < 0:  # no lines of the program
            return self._go_on_fed(to, jumps=result is not None)
        return self._begin(to)

    def _carry_out(self, cursor: Cursor) -> Result:
        run, position = self._run, cursor.position
        if cursor.refused is not None:
            fault, cursor.refused = cursor.refused, None
            raise fault
        cursor.position = GIVEN  # unless the statement has more to do after its effect
        if position is not BEGUN:
            return dispatch.go_on(run, position)
        run.steps += 1
        if run.steps > run_limits.MAX_STEPS:
            raise Fault("RBL505", f"more than {run_limits.MAX_STEPS} statements")
        at = cursor.at
        node, do, drains, _ = self._ready_of(at)
        if drains:
            cursor.position = Drained(node)
            return Drain(**origin(run.line(at), node))
        return do(run, run.line(at), node, at)

    def _begin(self, at: int) -> Event:
        """Begin the first statement from a line on."""
        run, cursor = self._run, self._run.cursor
        lines = run.lines
        # lines of labels and comments alone are passed here: they are no events, and are not counted
        while 0 <= at < len(lines) and lines[at].statement is None:
            at += 1
        cursor.at = at
        if at >= len(lines):
            run.cursor = Cursor(at=len(lines), ended=DONE)
            run.suspended = ()  # END inside of what was fed ends the program, so nothing is taken up again
            return DONE
        node, _, _, begun = self._ready_of(at)
        cursor.position, cursor.part = BEGUN, (at, node)
        return begun

    def _ready_of(self, at: int) -> _Ready:
        if at < 0:
            return _ready(self._run.line(at))
        # one entry a line, made when it is first reached: most lines of a loop run often, some lines never
        ready = self._ready[at]
        if ready is None:
            ready = self._ready[at] = _ready(self._run.lines[at])
        return ready

    def refuse(self, fault: Fault) -> None:
        """Report that the effect of the last event could not be carried out: the next step answers with ON ERROR.

        ``ProgramFault`` keeps the place that it names. ``ValueError`` when the last event was not an effect.
        """
        cursor = self._run.cursor
        if cursor.ended is not None or cursor.position in (DUE, BEGUN):
            raise ValueError("there is no effect that could be refused")
        cursor.refused = fault

    def _answer(self, fault: Fault) -> int | Failed:
        """Return the line of the handler of a fault, or the event of one that nothing catches."""
        run = self._run
        self._forget_left()
        try:
            handler = run.caught(fault, run.suspended[-1].depth if run.suspended else 0)
            if handler is not None:
                return handler
        except Fault as endless:  # RBL508: the handler and the statement that fails go round in circles
            fault = endless
        located = run.located(fault)
        failed = Failed(
            code=located.code,
            message=located.message,
            hint=located.hint,
            origin=located.origin,
            calls=located.calls,
            fed=bool(run.suspended),
        )
        if run.suspended:
            top = run.suspended[-1]
            run.scopes.unwind(top.depth, top.returns)
            self._take_up()
        else:
            run.cursor.ended = failed
        return failed

    # --- statements that are fed -------------------------------------------------------------------------------------

    def feed(self, text: Line | Fed) -> None:
        """Carry out one more statement, or several lines, at the present place; then the program goes on.

        ``LineBegun`` of each comes and ``FedEnded`` last, or ``Failed`` with ``fed``; until then the place of the
        program is kept, the inside of a statement such as a WAIT too. A GOTO, RETURN, RESUME or END that is fed leads
        the program elsewhere; a CALL or GOSUB that is fed comes back, and only an ON ERROR of what it calls catches
        its faults. A machine that is over can be fed as well, and goes on when a jump is.

        Raises ``Fault`` RBL211 or RBL212 for one statement that begins, divides or ends a block, and ``ValueError`` for
        a line without a statement or with an error.
        """
        fed = self.check_fed(text)
        run = self._run
        self._forget_left()
        scopes = run.scopes
        run.suspended += (Suspended(run.cursor, len(scopes.stack), len(scopes.here.returns)),)
        run.rounds.forget_fed()
        # the old cursor is never written again: snapshots share it with the entry above
        run.cursor = Cursor(at=fed.first, fed=fed, part=(fed.first, fed.lines[0].statement))

    def check_fed(self, text: Line | Fed) -> Fed:
        """Return what can be fed; raises as ``feed`` does."""
        fed = text if isinstance(text, Fed) else Fed([text])
        for line in fed.lines:
            if line.statement is None:
                raise ValueError("a line without a statement cannot be fed")
            _ready(line)  # refuses a statement with an error
        node = fed.lines[0].statement
        if len(fed.lines) == 1:
            if isinstance(node, For | Sub) or word_of(node) in ("IF", "WHILE", "SELECT"):
                raise Fault("RBL211", f"{word_of(node)} begins a block, which a single statement cannot")
            if isinstance(node, Next | Case) or word_of(node):
                raise Fault("RBL212", f"{word_of(node)} belongs to a block, of which a single statement is not a part")
        return fed

    def _go_on_fed(self, to: int, *, jumps: bool) -> Event:
        """Go on in what was fed, or end it; ``jumps``: its statement has led to line ``to`` itself."""
        run, cursor = self._run, self._run.cursor
        if cursor.at < 0 and jumps:
            if to >= 0 and run.suspended[-1].is_awaited(run.scopes.stack):
                return self._begin(to)
            # a loop or a branch of the text itself leads below 0 as well, and stays in it
            if to >= 0 or self._has_left():
                return self._leave_fed(to)
        if to != AFTER_FED:
            return self._begin(to)
        return FED_ENDED if self._take_up() else FedEnded(led=True)

    def _has_left(self) -> bool:
        """Return whether RETURN has left the place that was suspended last, so that nothing comes back to it."""
        run = self._run
        top = run.suspended[-1]
        return (len(run.scopes.stack), len(run.scopes.here.returns)) < (top.depth, top.returns)

    def _leave_fed(self, to: int) -> Event:
        """Go on elsewhere: on a line of the program, or of the text whose call has come back."""
        run = self._run
        *others, top = run.suspended
        run.suspended = tuple(others)
        if to != AFTER_FED:
            run.cursor = Cursor(at=to, fed=top.cursor.fed if to < 0 else None)
            return FedEnded(led=True)
        return FED_ENDED if self._take_up() else FedEnded(led=True)

    def _take_up(self) -> bool:
        """Return to the place that was suspended with as many scopes and GOSUBs as there are now, if there is one."""
        run = self._run
        now = len(run.scopes.stack), len(run.scopes.here.returns)
        while run.suspended:
            *others, top = run.suspended
            run.suspended = tuple(others)
            if (top.depth, top.returns) == now:
                run.cursor = top.cursor.copy()
                return True
        run.cursor = Cursor(at=len(run.lines))  # END inside of a SUB that was fed has left nothing to return to
        return False

    def _forget_left(self) -> None:
        """Forget places to which nothing returns, since a jump or a handler has left the call that was fed."""
        run = self._run
        if run.suspended:
            *others, top = run.suspended
            kept = [each for each in others if each.is_awaited(run.scopes.stack)]
            if run.cursor.at < 0 or top.is_awaited(run.scopes.stack):
                kept.append(top)
            run.suspended = tuple(kept)

    def end(self) -> Suspended:
        """End the program where it stands: of its own nothing comes any more; what is fed is carried out.

        Returns the place of its statement that was carried out, for ``begin_again``; what was fed there is given up.
        """
        run = self._run
        place = Suspended(run.cursor, len(run.scopes.stack), len(run.scopes.here.returns))
        if run.suspended:
            place = run.suspended[0]
            run.scopes.unwind(place.depth, place.returns)
        run.cursor, run.suspended = Cursor(at=len(run.lines), ended=DONE), ()
        return replace(place, cursor=self._before(place.cursor))

    @property
    def over(self) -> bool:
        """Whether nothing of the program comes any more, unless it is restarted or a jump is fed."""
        return self._run.cursor.ended is not None and not self._run.suspended

    def restart(self) -> None:
        """Put the program before its first statement: names keep their values, its calls, loops and handlers end."""
        run = self._run
        run.scopes.unwind(1, 0)
        main = run.scopes.here
        main.loops.clear()
        main.handler = main.failure = None
        run.rounds = Rounds()
        run.cursor, run.suspended = Cursor(), ()

    def _before(self, cursor: Cursor) -> Cursor:
        """Return the place before the statement of a cursor, of which nothing has been carried out."""
        at = cursor.at
        if cursor.position is DUE or not 0 <= at < len(self._run.lines):
            return Cursor(at=at)
        return Cursor(at=at, position=BEGUN, part=(at, self._ready_of(at)[0]))

    def begin_again(self, place: Suspended) -> bool:
        """Go back to a place that ``end`` has returned, before its statement; False where its call has been left."""
        run = self._run
        if (len(run.scopes.stack), len(run.scopes.here.returns)) != (place.depth, place.returns):
            return False
        run.cursor = place.cursor.copy()
        return True

    def line_of(self, place: Suspended) -> int | None:
        """Return the line of the file of a place that ``end`` has returned; None after the last one."""
        at = place.cursor.at
        return self._run.lines[at].source_line if 0 <= at < len(self._run.lines) else None

    def successor(self, program: Program, points: Collection[str]) -> "Machine":
        """Return a machine of another program in the same world, at its beginning."""
        return Machine(program, self._run.world, points, self._run.decisions)

    def stands_at(self, state: MachineSnapshot) -> bool:
        """Return whether nothing has been carried out since a state."""
        run = self._run
        return state.steps == run.steps and state.cursor.at == run.cursor.at

    # --- state -------------------------------------------------------------------------------------------------------

    def snapshot(self) -> MachineSnapshot:
        """Return the state as a value: all that the events to come depend on, besides the world."""
        return snapshot.take(self._run)

    def restore(self, state: MachineSnapshot) -> None:
        """Go back, or on, to a state, which may come from another machine of the same program.

        Raises ``ValueError`` for a snapshot of another program.
        """
        snapshot.put_back(self._run, state)

    @property
    def origin(self) -> Origin | None:
        """The statement, or part of one, that is due or runs; None when no line has begun, and when all is over."""
        cursor = self._run.cursor
        return None if cursor.part[1] is None else self._run.origin()

    @property
    def depth(self) -> int:
        """How many statements have been fed, one within the other, and are not over."""
        return len(self._run.suspended)

    @property
    def level(self) -> int:
        """How many CALLs and GOSUBs have not come back."""
        return len(self._run.scopes.stack) - 1 + sum(len(scope.returns) for scope in self._run.scopes.stack)

    def evaluator(self, world: World, more: Callable[[str, int], Value | None]) -> Evaluator:
        """Return an evaluator of the scope that runs: it reads the program and another world, and changes nothing.

        ``more`` gives elements of arrays that the program does not have, None: of none.
        """
        values = self._run.values
        found = Evaluator(_Names(self._run.scopes, more), world)
        found.frame, found.error = values.frame, values.error
        return found

    @property
    def frame(self) -> Frame:
        """The frame in force."""
        return self._run.values.frame

    @property
    def calls(self) -> tuple[Origin, ...]:
        """The CALLs and GOSUBs that have not come back, the outermost first."""
        return self._run.calls()

    @property
    def variables(self) -> tuple[Variables, ...]:
        """The names of the main program, then of each CALL that has not come back, the innermost last."""
        return tuple(map(variables_of, self._run.scopes.stack))

    @property
    def loop(self) -> tuple[Origin, int] | None:
        """The loop that goes on, and how often it has gone round; None: none does."""
        return self._run.endless_loop()

    def too_long(self, running: Origin, seconds: float) -> ProgramFault:
        """Return the fault of a run that has not ended after so long, s: at its endless loop, else at what runs."""
        run = self._run
        message = f"the run is not over after {seconds:g} s of simulated time"
        position, loop = run.cursor.position, self.loop
        waits = isinstance(position, Waiting) and position.node.span == running.span
        if isinstance(position, Waiting) and waits and seconds - position.began >= seconds / 2.0:
            message += f": this WAIT has not come true since {position.began:.3f} s"
            hint = "Let an input of the cell change so that the condition comes true, or give the WAIT a TIMEOUT."
        elif loop is not None:
            running, rounds = loop
            message += f": this loop has gone round {rounds} times"
            hint = "Give the loop an end that a simulation reaches: a count of rounds, TIMER, or an input of the cell."
        else:
            hint = "Give the run more time, split the program, or shorten its DELAYs; log and report end here."
        return ProgramFault(Fault("RBL509", message, hint), running)


class _Names:
    """The names of a program, and more elements than its arrays have."""

    def __init__(self, scopes: Scopes, more: Callable[[str, int], Value | None]) -> None:
        self._scopes, self._more = scopes, more

    def value(self, key: str) -> Value | None:
        """Return the value of a name, None when it has none."""
        return self._scopes.value(key)

    def element(self, key: str, index: int) -> Value | None:
        """Return an element, None when there is no such array; ``Fault`` RBL507."""
        found = self._scopes.element(key, index)
        return self._more(key, index) if found is None else found


def _ready(line: Line) -> _Ready:
    """Return what is known of a statement before it runs; ``ValueError`` for one with an error."""
    node = line.statement
    if node is None or isinstance(node, Unparsed):
        raise ValueError(f"line {line.source_line} has an error and cannot be run")
    begun = LineBegun(**origin(line, node))
    return node, dispatch.STATEMENTS[type(node)], dispatch.needs_rest(node), begun
