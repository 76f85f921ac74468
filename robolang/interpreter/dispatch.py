"""The statement that is carried out, by its class; and what is left of one, by its position.

Fig 4 of the 1992 controller tests the instruction in the order MOVE (100), LOAD (104), HAND OFF (108), HAND ON (112)
and then takes the next one. The instructions exclude one another, so a table by class is the same program.
"""

from collections.abc import Callable
from typing import Any, assert_never, get_args

from robolang.analysis.state_reads import reads_state
from robolang.interpreter import control_flow, value_statements, waiting
from robolang.interpreter.actions import ACTIONS, Action
from robolang.interpreter.effects import Drain, origin
from robolang.interpreter.positions import (
    MOVED,
    Asking,
    Begun,
    Comparing,
    Drained,
    Due,
    Given,
    Position,
    WaitDue,
    Waiting,
)
from robolang.interpreter.run_state import Result, RunState
from robolang.syntax.ast import (
    Assign,
    Block,
    CallSub,
    Case,
    Const,
    Delay,
    Dim,
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
    Statement,
    Sub,
    Wait,
    Word,
)

_TAKES_TIME = (*get_args(Moving), Hand)


def act(run: RunState, line: Line, node: Action, at: int) -> Result:
    """Ask the robot for something."""
    if isinstance(node, _TAKES_TIME):
        run.cursor.position = MOVED  # time is taken when the move is done, so that a refused one takes none
    return run.actions.effect(line, node)


def choose(run: RunState, line: Line, node: If, at: int) -> Result:
    """Carry out a branch of an IF on one line."""
    run.cursor.part = at, node.condition
    chosen = node.then if run.is_true(node.condition) else node.otherwise
    if chosen is None:
        return None
    # the branch drains by itself: the condition may have read nothing, and the other branch may read nothing
    run.cursor.part = at, chosen
    if reads_state(chosen):
        run.cursor.position = Drained(chosen)
        return Drain(**origin(line, chosen))
    return STATEMENTS[type(chosen)](run, line, chosen, at)


STATEMENTS: dict[type, Callable[[RunState, Line, Any, int], Result]] = {
    **dict.fromkeys(ACTIONS, act),
    Assign: value_statements.assign,
    Dim: value_statements.dim,
    Const: value_statements.const,
    Print: value_statements.show,
    Delay: waiting.delay,
    Wait: waiting.wait,
    If: choose,
    Head: control_flow.head,
    Block: control_flow.block,
    Case: control_flow.block,
    For: control_flow.begin_for,
    Next: control_flow.end_for,
    Jump: control_flow.jump,
    Sub: control_flow.pass_sub,
    CallSub: control_flow.call_sub,
    Word: control_flow.word,
    OnError: control_flow.on_error,
}


def needs_rest(node: Statement) -> bool:
    """Return whether motion ends before a statement is carried out, since it reads what changes during motion.

    A WAIT lets motion end itself. CASE and ELSEIF are evaluated when their head is, and are reached when a branch of
    their block is done.
    """
    if isinstance(node, Wait | Case) or (isinstance(node, Head) and node.word == "ELSEIF"):
        return False
    return reads_state(node.condition if isinstance(node, If) else node)


def go_on(run: RunState, position: Position) -> Result:
    """Carry out what is left of a statement after its last effect."""
    match position:
        case Given():
            if position.takes_time:
                run.rounds.take_time()
            return position.to
        case Drained():
            at = run.cursor.at
            return STATEMENTS[type(position.node)](run, run.line(at), position.node, at)
        case Waiting():
            return waiting.go_on(run, position)
        case WaitDue():
            return waiting.begin(run, position)
        case Asking():
            return control_flow.ask(run, position)
        case Comparing():
            return control_flow.compare(run, position)
        case Due():
            return run.cursor.at
        case Begun():
            raise AssertionError("a statement is begun by the machine")
        case _:
            assert_never(position)
