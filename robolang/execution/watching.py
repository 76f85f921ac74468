"""Values of expressions where a program stands, for a prompt, watches and the conditions of breakpoints.

They are evaluated in the scope that runs, in the active frame. Nothing is drained and nothing changes: HERE is where
the arm is commanded to be now, in the middle of a wait or of a move that rests too. Moves that are kept for a blend
have not been made then.
"""

from robolang.core.source import Source
from robolang.execution.executor import Executor
from robolang.interpreter.fed_line import fed_line
from robolang.syntax.ast import Expression, Print
from robolang.values.functions import shown
from robolang.values.poses import Place, Value
from runtime.core.tomlfile import FileFault, FilePlace

_BEFORE = "PRINT "


def evaluate(executor: Executor, text: str | Source) -> Value:
    """Return the value of one expression; ``FileFault`` with its place for a text that is none, ``Fault`` RBL5xx."""
    return executor.evaluator.value(expression(text))


def expression(text: str | Source) -> Expression:
    """Return the expression of a text; ``FileFault`` RBL1xx."""
    source = text if isinstance(text, Source) else Source("expression", text)
    try:
        # what can be printed is what has a value: the one parser of the language reads it
        node = fed_line(Source(source.path, _BEFORE + source.text)).statement
    except FileFault as fault:
        place = FilePlace(source.path, fault.line, max(1, (fault.column or 1) - len(_BEFORE)), source.text)
        raise FileFault(fault.code, fault.message, fault.hint, place) from None
    if not isinstance(node, Print) or len(node.items) != 1:
        column = node.items[1].span.start - len(_BEFORE) + 1 if isinstance(node, Print) and len(node.items) > 1 else 1
        place = FilePlace(source.path, 1, column, source.text)
        raise FileFault("RBL111", "one expression is expected", "Write one value, such as X + 1 or P1.Z.", place)
    return node.items[0]


def printed(executor: Executor, value: Value) -> str:
    """Return a value as PRINT shows it: a pose by its numbers in the active frame, mm and deg."""
    if isinstance(value, float):
        return shown(value)
    if isinstance(value, Place):
        return f"({', '.join(f'{number:.3f}' for number in executor.evaluator.six(value))})"
    return value
