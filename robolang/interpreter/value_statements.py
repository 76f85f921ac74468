"""Statements on values: assignment, DIM, CONST and PRINT.

A statement is a function of the run, its line, the statement itself (which is a branch where the line holds an IF) and
the index of the line.
"""

from robolang.interpreter import run_limits
from robolang.interpreter.effects import Show, origin
from robolang.interpreter.run_state import Result, RunState
from robolang.syntax.ast import Assign, Call, Const, Dim, Line, Print
from robolang.values.functions import shown
from robolang.values.poses import Place
from runtime.core import limits
from runtime.core.faults import Fault


def assign(run: RunState, line: Line, node: Assign, at: int) -> Result:
    """Give a name or an element a value."""
    run.cursor.part = at, node.value  # a fault of the value is located there, one of the target at the statement
    value = run.values.value(node.value)
    run.cursor.part = at, node
    if isinstance(node.target, Call):
        # the index after the value: where both have a fault, that of the value is reported
        index = run.values.whole(node.target.arguments[0], "the number of an element")
        run.scopes.put(node.target.name.key, index, value)
    else:
        run.scopes.assign(node.target.key, value)
    return None


def dim(run: RunState, line: Line, node: Dim, at: int) -> Result:
    """Make an array."""
    run.scopes.make(node.name.key, int(limits.SIZE.checked(run.values.number(node.size))))
    return None


def const(run: RunState, line: Line, node: Const, at: int) -> Result:
    """Give a name a value that stays."""
    run.scopes.fix(node.name.key, run.values.value(node.value))
    return None


def show(run: RunState, line: Line, node: Print, at: int) -> Result:
    """Show values in one line."""
    text = "".join([_text(run, run.values.value(item)) for item in node.items])
    run.shown += len(text) + 1  # the end of the line counts, so that empty lines are bounded as well
    if run.shown > run_limits.MAX_SHOWN:
        raise Fault("RBL506", f"more than {run_limits.MAX_SHOWN} characters of PRINT")
    return Show(**origin(line, node), text=text)


def _text(run: RunState, value: object) -> str:
    if isinstance(value, float):
        return shown(value)
    if isinstance(value, Place):
        return f"({', '.join(f'{number:.3f}' for number in run.values.six(value))})"
    return str(value)
