"""Statements that let time pass: DELAY and WAIT."""

import math

from robolang.interpreter.effects import Drain, Pass, origin
from robolang.interpreter.positions import WaitDue, Waiting
from robolang.interpreter.run_state import Result, RunState
from robolang.syntax.ast import Delay, Line, Wait
from robolang.values.functions import shown
from runtime.core import limits
from runtime.core.faults import Fault

ROUNDING = 1e-9
"""Seconds by which a timeout may be missed: the time is a sum of cycles, and 0.5 s must end at cycle 0.5 s."""


def delay(run: RunState, line: Line, node: Delay, at: int) -> Result:
    """Let a time pass."""
    seconds = limits.DELAY.checked(run.values.number(node.seconds))
    run.rounds.take_time()  # DELAY 0 as well: it passes one cycle
    return Pass(**origin(line, node), seconds=seconds)


def wait(run: RunState, line: Line, node: Wait, at: int) -> Result:
    """Let motion end, whatever the condition reads: the time of a WAIT begins when the arm stands."""
    run.cursor.position = WaitDue(node)
    return Drain(**origin(line, node))


def begin(run: RunState, due: WaitDue) -> Result:
    """Begin the time of a WAIT, and evaluate its condition a first time."""
    node = due.node
    forced = run.decisions.of_wait(node.condition.span, endless=node.timeout is None)
    if forced is True:  # also where there is no time to read, as in an export
        run.decisions.took(node.condition.span, True)
        return None
    timeout = math.inf if node.timeout is None else limits.TIMEOUT.checked(run.values.number(node.timeout))
    return go_on(run, Waiting(node, run.world.seconds(), timeout, forced))


def go_on(run: RunState, waiting: Waiting) -> Result:
    """Return the line to go on at when a WAIT is over, else one more cycle."""
    node, forced = waiting.node, waiting.forced
    if forced is None and run.values.true(node.condition):
        run.decisions.took(node.condition.span, True)
        return None
    # closed against NaN: a time that is no number ends the WAIT instead of keeping it for ever
    if forced is False or not run.world.seconds() - waiting.began < waiting.timeout - ROUNDING:
        return _time_out(run, waiting)
    run.rounds.take_time()
    run.cursor.position = waiting
    return Pass(**origin(run.line(run.cursor.at), node), seconds=0.0)


def _time_out(run: RunState, waiting: Waiting) -> int:
    node = waiting.node
    run.decisions.took(node.condition.span, False)
    if node.target is None:
        raise Fault("RBL503", f"WAIT has not come true within {shown(waiting.timeout)} s")
    return run.looped(run.cursor.at, run.line_of(node.target))
