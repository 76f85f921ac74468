"""Statements that choose the next line: blocks, loops, jumps, calls and ON ERROR.

IF on one line is not here: it carries out another statement (``dispatch``).
"""

import math

from robolang.analysis.state_reads import reads_state
from robolang.interpreter import run_limits
from robolang.interpreter.effects import Drain, Halt, origin
from robolang.interpreter.positions import Asking, Comparing, Given
from robolang.interpreter.run_state import Result, RunState
from robolang.interpreter.scope import STOPS, Loop
from robolang.syntax.ast import Block, CallSub, Case, For, Head, Jump, Line, Next, OnError, Sub, Word
from robolang.values.functions import finite
from robolang.values.poses import Value
from runtime.core.faults import Fault

# --- IF, WHILE and SELECT --------------------------------------------------------------------------------------------


def head(run: RunState, line: Line, node: Head, at: int) -> Result:
    """Choose a branch of a block."""
    if node.word == "ELSEIF":  # reached from above: the branch before it is done
        return run.end(at) + 1
    if node.word == "SELECT":
        return _next_case(run, at, run.values.value(node.value))
    if node.word == "IF":
        return ask(run, Asking(at))
    if run.is_true(node.value):
        return None
    run.rounds.leave(at)  # reached again, the loop has its rounds anew
    return run.end(at) + 1


def ask(run: RunState, asking: Asking) -> Result:
    """Evaluate the condition of an IF or ELSEIF, and those after it until one is true."""
    at = asking.at
    node = run.line(at).statement
    while isinstance(node, Head) and not run.is_true(node.value):
        at = run.after(at)
        node = run.line(at).statement
        if isinstance(node, Head):
            run.cursor.part = at, node
            if reads_state(node.value):
                run.cursor.position = Asking(at)
                return Drain(**origin(run.line(at), node))
    return at + 1


def _next_case(run: RunState, at: int, chosen: Value) -> Result:
    """Compare the CASE after a line of a SELECT, and those after it until one has the value of the SELECT."""
    while at != run.end(at):
        at = run.after(at)
        node = run.line(at).statement
        if not isinstance(node, Case):
            break
        run.cursor.part = at, node  # a fault in a CASE is located there; RESUME takes the SELECT again
        if reads_state(node):
            run.cursor.position = Comparing(at, chosen)
            return Drain(**origin(run.line(at), node))
        if _is_chosen(run, node, chosen):
            break
    return at + 1


def compare(run: RunState, comparing: Comparing) -> Result:
    """Compare a CASE for which motion has ended, then those after it."""
    at, chosen = comparing.at, comparing.chosen
    node = run.line(at).statement
    assert isinstance(node, Case)
    return at + 1 if _is_chosen(run, node, chosen) else _next_case(run, at, chosen)


def _is_chosen(run: RunState, node: Case, chosen: Value) -> bool:
    return run.decisions.of(node.span, any(run.values.value(each) == chosen for each in node.values))


def block(run: RunState, line: Line, node: Block | Case, at: int) -> Result:
    """Reach a line of a block from above: what was chosen is done."""
    word = node.word if isinstance(node, Block) else "CASE"
    if word == "WEND":
        return run.looped(at, run.after(at))
    if word == "ENDSUB":
        return _leave(run)
    return None if word in ("ENDIF", "ENDSELECT") else run.end(at) + 1


# --- FOR -------------------------------------------------------------------------------------------------------------


def begin_for(run: RunState, line: Line, node: For, at: int) -> Result:
    """Begin to count, or pass by a loop that has no round."""
    first, last = run.values.number(node.first), run.values.number(node.last)
    step = 1.0 if node.step is None else run.values.number(node.step)
    rounds = _rounds(first, last, step)
    run.scopes.assign(node.variable.key, finite(first, "FOR"))
    if rounds <= 0:
        return run.end(at) + 1
    loops = run.scopes.here.loops
    key = run.loop_key(at)
    while any(loop.line == key for loop in loops):  # left by a GOTO before
        loops.pop()
    if len(loops) >= run_limits.MAX_LOOPS:
        raise Fault("RBL504", f"more than {run_limits.MAX_LOOPS} FORs have been begun and not ended")
    run.rounds.leave(at)
    loops.append(Loop(line=key, variable=node.variable.key, rounds=rounds - 1, step=step))
    return None


def _rounds(first: float, last: float, step: float) -> int:
    """Return the rounds of a FOR, which are counted when it begins: its variable may be assigned inside."""
    if step == 0.0:
        raise Fault("RBL205", "STEP is 0: the loop would never end")
    rounds = math.floor(finite((last - first) / step, "FOR") + 1e-9) + 1  # 0 TO 1 STEP 0.1 has its eleventh round
    if rounds > run_limits.MAX_ROUNDS:
        raise Fault("RBL502", f"FOR would go round {rounds:g} times")
    return rounds


def end_for(run: RunState, line: Line, node: Next, at: int) -> Result:
    """Go round again, or leave the loop."""
    to, loops = run.after(at), run.scopes.here.loops
    key = run.loop_key(to)
    while loops and loops[-1].line != key:
        loops.pop()
    if not loops:
        raise Fault("RBL533", "NEXT has no FOR that runs")
    loop = loops[-1]
    if loop.rounds == 0:
        loops.pop()
        return None
    value = run.scopes.value(loop.variable)
    if not isinstance(value, float):
        raise Fault("RBL531", f"{loop.variable} counts a loop and is no number any more")
    loop.rounds -= 1
    # the variable is added to as the program has left it: assigning it inside of the loop skips values, not rounds
    run.scopes.assign(loop.variable, value + loop.step)
    run.looped(at, to)
    return to + 1


# --- jumps and calls -------------------------------------------------------------------------------------------------


def jump(run: RunState, line: Line, node: Jump, at: int) -> Result:
    """Go to a line, to return from there after a GOSUB."""
    to, calls = run.line_of(node.target), node.word == "GOSUB"
    if calls:  # counted before the jump, so that the fault is located at the GOSUB
        _check_depth(sum(len(scope.returns) for scope in run.scopes.stack))
        run.scopes.here.returns.append(at + 1)
    return run.looped(at, to, calls=calls)


def _check_depth(depth: int) -> None:
    if depth >= run_limits.MAX_CALLS:
        raise Fault("RBL504", f"more than {run_limits.MAX_CALLS} calls within one another")


def pass_sub(run: RunState, line: Line, node: Sub, at: int) -> Result:
    """Pass by a SUB: it runs when it is called."""
    return run.end(at) + 1


def call_sub(run: RunState, line: Line, node: CallSub, at: int) -> Result:
    """Enter a SUB with its parameters."""
    to = run.structure.subs.get(node.name.key)
    sub = None if to is None else run.line(to).statement
    if to is None or not isinstance(sub, Sub) or len(sub.parameters) != len(node.arguments):
        raise Fault("RBL533", f"there is no SUB {node.name.text} of {len(node.arguments)} parameters")
    _check_depth(len(run.scopes.stack) - 1)
    values = [run.values.value(argument) for argument in node.arguments]
    run.looped(at, to, calls=True)  # recursion takes no time either
    given = zip((parameter.key for parameter in sub.parameters), values, strict=True)
    run.scopes.enter(at + 1, dict(given))
    return to + 1


def _leave(run: RunState) -> int:
    """Return from a SUB."""
    back = run.scopes.leave()
    if back is None:
        raise Fault("RBL533", "ENDSUB is reached without a CALL")
    return back


# --- words alone, and ON ERROR ---------------------------------------------------------------------------------------


def word(run: RunState, line: Line, node: Word, at: int) -> Result:
    """Carry out a statement that is its words alone."""
    end = len(run.lines)
    if node.word == "RETURN":
        return _return(run)
    if node.word in ("RESUME", "RESUME NEXT"):
        return _resume(run, at, after=node.word == "RESUME NEXT")
    if node.word == "ON ERROR STOP":
        run.scopes.on_error(STOPS)
        return None
    if node.word == "END":
        return end
    run.rounds.take_time()
    run.cursor.position = Given(to=end if node.word == "STOP" else None)
    return Halt(**origin(line, node), word=node.word)


def _return(run: RunState) -> int:
    back = run.scopes.go_back()
    if back is not None:
        return back
    if len(run.scopes.stack) > 1:
        return _leave(run)
    raise Fault("RBL533", "RETURN without GOSUB")


def _resume(run: RunState, at: int, *, after: bool) -> int:
    failed = run.scopes.resume()
    if failed is None:
        raise Fault("RBL533", "RESUME without an error that was caught")
    return run.looped(at, _after(run, failed) if after else failed)


def _after(run: RunState, failed: int) -> int:
    """Return the line after a statement that failed; for the head of a block the one after the block."""
    # the branches of a head that failed were not chosen: to enter one of them would be a guess
    is_head = isinstance(run.line(failed).statement, Head | For)
    return (run.end(failed) if is_head else failed) + 1


def on_error(run: RunState, line: Line, node: OnError, at: int) -> Result:
    """Let a line deal with the errors of the scope that runs."""
    run.scopes.on_error(run.line_of(node.target))
    return None
