"""The main program: one statement after another, each yielded as an effect.

Fig 4 of the 1992 controller tests the instruction in the order MOVE (100), LOAD (104), HAND OFF (108), HAND ON
(112) and then takes the next one. The instructions exclude one another, so a table by the type of the statement is the
same program. Nothing is computed ahead: the generator stands at the statement whose effect it yielded until the
session asks for the next. A statement that reads where the robot is, an input or the time yields ``Drain`` first, so
that what it reads is of this place in the program.

Errors. A ``Fault`` of an expression, or one that the session throws into the generator where a request cannot be
carried out (planning, timeouts), goes to the line that ON ERROR GOTO named (``scope``), unless that handler runs
already; ERR is then the number of its code. RESUME takes the statement again, RESUME NEXT the one after it. A latched
alarm of the robot never comes here: it ends the run.

Limits (counts, not wall clock): ``MAX_IDLE`` rounds of a loop without a statement that takes time are RBL508, at its
head; ``MAX_STEPS`` statements are RBL505; ``MAX_CALLS`` CALLs or GOSUBs within one another RBL504, as are
``MAX_LOOPS`` FORs that were begun and left in one scope; ``MAX_SHOWN`` characters of PRINT RBL506. Memory is counted by
``scope``, the length of one text and the size of one array by ``evaluator``.
"""

import math
from collections.abc import Callable, Collection, Generator

from robolang.analysis.state_reads import reads_state
from robolang.core import limits
from robolang.evaluation.evaluator import Evaluator, Nowhere, World
from robolang.interpreter.actions import ACTIONS, Action, Actions
from robolang.interpreter.branch_oracle import Decisions
from robolang.interpreter.effects import Drain, Effect, Halt, Origin, Pass, Show, origin
from robolang.interpreter.rounds import Rounds
from robolang.interpreter.scope import STOPS, Loop, Scopes
from robolang.syntax.ast import (
    Assign,
    Block,
    Call,
    CallSub,
    Case,
    Const,
    Delay,
    Dim,
    Expression,
    For,
    Hand,
    Head,
    If,
    Jump,
    Line,
    Moving,
    Next,
    OnError,
    Print,
    Program,
    Statement,
    Sub,
    Target,
    Unparsed,
    Wait,
    Word,
)
from robolang.syntax.blocks import Structure, structure_of
from robolang.syntax.tree import Node
from robolang.values.functions import finite, shown
from robolang.values.poses import Place
from runtime.core.faults import Fault
from runtime.core.program_line import named

MAX_IDLE = 100_000
MAX_STEPS = 10_000_000
MAX_CALLS = 100
MAX_LOOPS = 10_000
MAX_SHOWN = 1_000_000
MAX_ROUNDS = 1e15
UNCAUGHT = frozenset({"RBL505", "RBL506", "RBL508", "RBL509"})
"""Limits of a run: no ON ERROR catches them, a program that breaks one would go on for ever."""

Run = Generator[Effect, None, int | None]
"""What carries a statement out: yields its effects, returns the line to go to, None for the next."""


def _carried_out(found: Run | int | None) -> Run:
    """Carry out a statement; one without effects has its next line at once."""
    return (yield from found) if isinstance(found, Generator) else found


class ProgramFault(Fault):
    """A fault that no ON ERROR caught: the statement it comes from, and the calls that led there, outermost first."""

    def __init__(self, fault: Fault, origin: Origin, calls: tuple[Origin, ...] = ()) -> None:
        super().__init__(fault.code, fault.message, fault.hint)
        self.origin = origin
        self.calls = calls


def _at(line: Line, part: Node) -> Origin:
    return Origin(line=line.source_line, number=line.number, span=part.span)


def _calling(line: Line) -> Node:
    """Return what calls on a line: of an IF on one line its branch, where only one of the two can."""
    node = line.statement
    if isinstance(node, If):
        branches = [each for each in (node.then, node.otherwise) if isinstance(each, CallSub | Jump)]
        node = branches[0] if len(branches) == 1 else node
    return node or line


def execute(
    program: Program,
    world: World | None = None,
    points: Collection[str] = (),
    decisions: Decisions | None = None,
) -> Generator[Effect, None, None]:
    """Yield the effects of a checked program in order; ``points`` are the names of the taught ones.

    ``decisions`` is told which way each condition takes, and may change it.

    What a WRIST statement or a setting says holds for the moves that follow, and each of them carries it.

    Raises ``ValueError`` at a statement with an error: such a program must not be run. ``Fault`` where a statement has
    no value, and where one was thrown in that no ON ERROR catches.
    """
    return Machine(program, world or Nowhere(), points, decisions).run()


class Machine:
    """A program that runs; see ``execute``."""

    def __init__(
        self, program: Program, world: World, points: Collection[str], decisions: Decisions | None = None
    ) -> None:
        self._decisions = decisions or Decisions()
        self._lines = program.lines
        self._structure: Structure = structure_of(program)
        self._scopes = Scopes(frozenset(point.upper() for point in points))
        self._values = Evaluator(self._scopes, world)
        self._actions = Actions(self._values, self._scopes)
        self._steps = self._shown = self._loop = 0
        self._rounds = Rounds()
        self._waits_since = 0.0
        self._world = world
        self._reads: dict[int, bool] = {}
        self._now: tuple[int, Node]
        """The line that runs, from 0, and the part of it that is carried out, as the branch of an IF on one line."""

    def run(self) -> Generator[Effect, None, None]:
        """Yield the effects to the end of the program."""
        at = 0
        while 0 <= at < len(self._lines):
            line = self._lines[at]
            if line.statement is None:
                at += 1
                continue
            self._now = at, line.statement
            try:
                self._count(at)
                jump = yield from self._statement(line, line.statement, at)
            except Fault as fault:
                try:
                    jump = self._caught(fault, at)
                except Fault as uncaught:
                    raise self._located(uncaught) from None
            at = at + 1 if jump is None else jump

    def _caught(self, fault: Fault, at: int) -> int:
        """Return the line of the handler that deals with a fault; ``Fault``, the same one, where none does."""
        if fault.code in UNCAUGHT:
            raise fault
        handler = self._scopes.catch(at)
        if handler is None:
            raise fault
        self._values.error = float(fault.code.removeprefix("RBL"))
        return self._looped(at, handler)

    def _located(self, fault: Fault) -> ProgramFault:
        """Return a fault that nothing caught at the part of the statement that failed, an idle loop at its head."""
        if isinstance(fault, ProgramFault):
            return fault
        at, part = self._now
        line = self._lines[at]
        if fault.code == "RBL508":
            line = self._lines[self._loop]
            part = line.statement or line
        calls = tuple(_at(each, _calling(each)) for each in (self._lines[at] for at in self._calls()))
        return ProgramFault(fault, _at(line, part), calls)

    def _calls(self) -> list[int]:
        """Return the lines of the CALLs and GOSUBs that have not come back, the outermost first."""
        return [back - 1 for scope in self._scopes.stack for back in (scope.back, *scope.returns) if back > 0]

    def too_long(self, running: Origin, seconds: float) -> ProgramFault:
        """Return the fault of a run that has not ended after so long, s: at its endless loop, else at what runs."""
        at, node = self._now
        calls, since = self._calls(), self._waits_since
        message = f"the run is not over after {seconds:g} s of simulated time"
        loop = self._rounds.endless((*calls, at), self._steps)
        if isinstance(node, Wait) and node.span == running.span and seconds - since >= seconds / 2.0:
            message += f": this WAIT has not come true since {since:.3f} s"
            hint = "Let an input of the cell change so that the condition comes true, or give the WAIT a TIMEOUT."
        elif loop is not None:
            head, rounds = loop
            message += f": this loop has gone round {rounds} times"
            hint = "Give the loop an end that a simulation reaches: a count of rounds, TIMER, or an input of the cell."
            running = _at(self._lines[head], self._lines[head].statement or self._lines[head])
        else:
            hint = "Split the program, or shorten its DELAYs; the log and the report end here."
        return ProgramFault(Fault("RBL509", message, hint), running)

    def _count(self, at: int) -> None:
        self._steps += 1
        if self._steps > MAX_STEPS:
            raise Fault("RBL505", f"more than {MAX_STEPS} statements")

    def _looped(self, at: int, to: int, *, calls: bool = False) -> int:
        """Return where a jump leads; ``Fault`` RBL508 when the program goes round and round without taking time."""
        if to > at:
            return to
        if not calls:
            self._rounds.turn(to, at, self._steps)
        if self._rounds.idle(to) > MAX_IDLE:
            self._loop = to
            where = named(self._lines[to].source_line, self._lines[to].number)
            raise Fault(
                "RBL508",
                f"the loop that begins at {where} has gone round {MAX_IDLE} times without a statement that takes time",
            )
        return to

    def _statement(self, line: Line, node: Statement, at: int) -> Run:
        if isinstance(node, Unparsed):
            raise ValueError(f"line {line.source_line} has an error and cannot be run")
        if at not in self._reads:
            reached = isinstance(node, Wait | Case) or (isinstance(node, Head) and node.word == "ELSEIF")
            # WAIT always lets motion end; CASE and ELSEIF are asked by their head, and reached when the block is done
            self._reads[at] = not reached and reads_state(node if not isinstance(node, If) else node.condition)
        if self._reads[at]:
            yield Drain(**origin(line, node))
        return (yield from _carried_out(_DO[type(node)](self, line, node, at)))

    def _taking_time(self) -> None:
        self._rounds.take_time()

    def _act(self, line: Line, node: Action, at: int) -> Run:
        effect = self._actions.effect(line, node)
        if effect is not None:
            yield effect
        if isinstance(node, Moving | Hand):  # one that is refused takes no time
            self._taking_time()
        return None

    # --- values, inputs and time -------------------------------------------------------------------------------------

    def _assign(self, line: Line, node: Assign, at: int) -> int | None:
        self._now = at, node.value
        value = self._values.value(node.value)
        self._now = at, node
        name = node.target.name if isinstance(node.target, Call) else node.target
        if isinstance(node.target, Call):
            self._scopes.put(name.key, self._values.whole(node.target.arguments[0], "the number of an element"), value)
        else:
            self._scopes.assign(name.key, value)
        return None

    def _dim(self, line: Line, node: Dim, at: int) -> int | None:
        self._scopes.make(node.name.key, int(limits.SIZE.checked(self._values.number(node.size))))
        return None

    def _const(self, line: Line, node: Const, at: int) -> int | None:
        self._scopes.fix(node.name.key, self._values.value(node.value))
        return None

    def _delay(self, line: Line, node: Delay, at: int) -> Run:
        time = limits.DELAY.checked(self._values.number(node.seconds))
        self._taking_time()
        yield Pass(**origin(line, node), seconds=time)
        return None

    def _wait(self, line: Line, node: Wait, at: int) -> Run:
        yield Drain(**origin(line, node))
        timeout = math.inf if node.timeout is None else limits.TIMEOUT.checked(self._values.number(node.timeout))
        began, place = self._world.seconds(), node.condition.span
        self._waits_since = began
        forced = self._decisions.of_wait(place, endless=node.timeout is None)
        while forced is not True and not (forced is None and self._values.true(node.condition)):
            if forced is False or not self._world.seconds() - began < timeout - 1e-9:
                self._decisions.took(place, False)
                if node.target is not None:
                    return self._looped(at, self._line_of(node.target))
                raise Fault("RBL503", f"WAIT has not come true within {shown(timeout)} s")
            self._taking_time()
            yield Pass(**origin(line, node), seconds=0.0)
        self._decisions.took(place, True)
        return None

    def _print(self, line: Line, node: Print, at: int) -> Run:
        values = [self._values.value(item) for item in node.items]
        text = "".join(self._shown_value(value) for value in values)
        self._shown += len(text) + 1
        if self._shown > MAX_SHOWN:
            raise Fault("RBL506", f"more than {MAX_SHOWN} characters of PRINT")
        yield Show(**origin(line, node), text=text)
        return None

    def _shown_value(self, value: object) -> str:
        if isinstance(value, float):
            return shown(value)
        if isinstance(value, Place):
            return f"({', '.join(f'{number:.3f}' for number in self._values.six(value))})"
        return str(value)

    # --- control -----------------------------------------------------------------------------------------------------

    def _line_of(self, target: Target) -> int:
        found = self._structure.line_of(target)
        if found is None:
            raise Fault("RBL533", "there is no such line")
        return found

    def _if(self, line: Line, node: If, at: int) -> Run:
        self._now = at, node.condition
        chosen = node.then if self._is_true(node.condition) else node.otherwise
        if chosen is None:
            return None
        self._now = at, chosen
        if reads_state(chosen):
            yield Drain(**origin(line, chosen))
        return (yield from _carried_out(_DO[type(chosen)](self, line, chosen, at)))

    def _is_true(self, condition: Expression) -> bool:
        return self._decisions.of(condition.span, self._values.true(condition))

    def _head(self, line: Line, node: Head, at: int) -> Run:
        structure = self._structure
        if node.word == "ELSEIF":  # reached from above: the branch before it is done
            return structure.end[at] + 1
        if node.word == "WHILE":
            if self._is_true(node.value):
                return None
            self._rounds.leave(at)
            return structure.end[at] + 1
        if node.word == "SELECT":
            return (yield from self._case_of(line, node, at))
        while not self._is_true(node.value):
            at = structure.after[at]
            line, following = self._lines[at], self._lines[at].statement
            if not isinstance(following, Head):  # ELSE, or ENDIF
                break
            node = following
            self._now = at, node
            if reads_state(node.value):
                yield Drain(**origin(line, node))
        return at + 1

    def _case_of(self, line: Line, node: Head, at: int) -> Generator[Effect, None, int]:
        chosen = self._values.value(node.value)
        end = self._structure.end[at]
        while at != end:
            at = self._structure.after[at]
            line, statement = self._lines[at], self._lines[at].statement
            if not isinstance(statement, Case):
                break
            self._now = at, statement
            if reads_state(statement):
                yield Drain(**origin(line, statement))
            if self._decisions.of(statement.span, any(self._values.value(each) == chosen for each in statement.values)):
                break
        return at + 1

    def _block(self, line: Line, node: Block | Case, at: int) -> int | None:
        """Reach a line of a block from above: what was chosen is done."""
        word = node.word if isinstance(node, Block) else "CASE"
        if word == "WEND":
            return self._looped(at, self._structure.after[at])
        if word == "ENDSUB":
            return self._leave()
        return None if word in ("ENDIF", "ENDSELECT") else self._structure.end[at] + 1

    def _for(self, line: Line, node: For, at: int) -> int | None:
        first, last = self._values.number(node.first), self._values.number(node.last)
        step = 1.0 if node.step is None else self._values.number(node.step)
        if step == 0.0:
            raise Fault("RBL205", "STEP is 0: the loop would never end")
        rounds = math.floor(finite((last - first) / step, "FOR") + 1e-9) + 1
        if rounds > MAX_ROUNDS:
            raise Fault("RBL502", f"FOR would go round {rounds:g} times")
        self._scopes.assign(node.variable.key, finite(first, "FOR"))
        if rounds <= 0:
            return self._structure.end[at] + 1
        loops = self._scopes.here.loops
        while any(loop.line == at for loop in loops):  # left by a GOTO before
            loops.pop()
        if len(loops) >= MAX_LOOPS:
            raise Fault("RBL504", f"more than {MAX_LOOPS} FORs have been begun and not ended")
        self._rounds.leave(at)
        loops.append(Loop(line=at, variable=node.variable.key, rounds=rounds - 1, step=step))
        return None

    def _next(self, line: Line, node: Next, at: int) -> int | None:
        head, loops = self._structure.after[at], self._scopes.here.loops
        while loops and loops[-1].line != head:
            loops.pop()
        if not loops:
            raise Fault("RBL533", "NEXT has no FOR that runs")
        loop = loops[-1]
        if loop.rounds == 0:
            loops.pop()
            return None
        value = self._scopes.value(loop.variable)
        if not isinstance(value, float):
            raise Fault("RBL531", f"{loop.variable} counts a loop and is no number any more")
        loop.rounds -= 1
        self._scopes.assign(loop.variable, value + loop.step)
        self._looped(at, head)
        return head + 1

    def _jump(self, line: Line, node: Jump, at: int) -> int | None:
        to = self._line_of(node.target)
        if node.word == "GOSUB":
            returns = self._scopes.here.returns
            self._check_depth(sum(len(scope.returns) for scope in self._scopes.stack))
            returns.append(at + 1)
        return self._looped(at, to, calls=node.word == "GOSUB")

    def _check_depth(self, depth: int) -> None:
        if depth >= MAX_CALLS:
            raise Fault("RBL504", f"more than {MAX_CALLS} calls within one another")

    def _sub(self, line: Line, node: Sub, at: int) -> int | None:
        """Pass by a SUB: it runs when it is called."""
        return self._structure.end[at] + 1

    def _call_sub(self, line: Line, node: CallSub, at: int) -> int | None:
        to = self._structure.subs.get(node.name.key)
        sub = None if to is None else self._lines[to].statement
        if to is None or not isinstance(sub, Sub) or len(sub.parameters) != len(node.arguments):
            raise Fault("RBL533", f"there is no SUB {node.name.text} of {len(node.arguments)} parameters")
        self._check_depth(len(self._scopes.stack) - 1)
        values = [self._values.value(argument) for argument in node.arguments]
        self._looped(at, to, calls=True)
        given = zip((parameter.key for parameter in sub.parameters), values, strict=True)
        self._scopes.enter(at + 1, dict(given))
        return to + 1

    def _leave(self) -> int:
        """Return from a SUB."""
        back = self._scopes.leave()
        if back is None:
            raise Fault("RBL533", "ENDSUB is reached without a CALL")
        return back

    def _word(self, line: Line, node: Word, at: int) -> Run:
        word = node.word
        if word == "RETURN":
            back = self._scopes.go_back()
            if back is not None:
                return back
            if len(self._scopes.stack) > 1:
                return self._leave()
            raise Fault("RBL533", "RETURN without GOSUB")
        if word == "ON ERROR STOP":
            self._scopes.on_error(STOPS)
        elif word.startswith("RESUME"):
            failed = self._scopes.resume()
            if failed is None:
                raise Fault("RBL533", "RESUME without an error that was caught")
            return self._looped(at, failed if word == "RESUME" else self._behind(failed))
        elif word == "END":
            return len(self._lines)
        else:
            self._taking_time()
            yield Halt(**origin(line, node), word=word)
            return len(self._lines) if word == "STOP" else None
        return None

    def _behind(self, failed: int) -> int:
        """Return the line behind a statement that failed: of the head of a block the one behind the block."""
        is_head = isinstance(self._lines[failed].statement, Head | For)
        return (self._structure.end[failed] if is_head else failed) + 1

    def _on_error(self, line: Line, node: OnError, at: int) -> int | None:
        self._scopes.on_error(self._line_of(node.target))
        return None


_DO: dict[type, Callable[..., Run | int | None]] = {
    **dict.fromkeys(ACTIONS, Machine._act),
    Assign: Machine._assign,
    Dim: Machine._dim,
    Const: Machine._const,
    Delay: Machine._delay,
    Wait: Machine._wait,
    Print: Machine._print,
    If: Machine._if,
    Head: Machine._head,
    Block: Machine._block,
    Case: Machine._block,
    For: Machine._for,
    Next: Machine._next,
    Jump: Machine._jump,
    Sub: Machine._sub,
    CallSub: Machine._call_sub,
    Word: Machine._word,
    OnError: Machine._on_error,
}
