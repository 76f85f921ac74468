"""Where a program stands, in words: what comes next, what is held, or that it is over."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robolang.interpreter.effects import Origin
    from robolang.pendant.live import Live

ENDED = "ended"
"""The place of a program that is over."""


def place(live: "Live") -> str:
    """Return what comes next, or is held, or ``ENDED``."""
    executor = live.executor
    if executor.is_over:
        return ENDED
    # a motion that is held has begun, and what is typed meanwhile comes before its rest
    if executor.displaced is None:
        return f"next: {text_of(live, executor.origin)}"
    # not what the program has come to: of moves that blend that is the last one
    return f"held in: {text_of(live, executor.status.statement or executor.origin)}"


def text_of(live: "Live", origin: "Origin | None") -> str:
    """Return the line of the program that an origin is in, or what was typed."""
    if origin is None:
        return "the first statement"
    # of the program that the controller has: the edited one may have errors, and other lines
    source = origin.source or live.project.source
    return source.line_text(origin.line or 1).strip()
