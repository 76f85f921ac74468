"""Which shapes of line there are, by the word or the sign that a line begins with."""

import re
from functools import cache

from robolang.syntax.foreign.cell_shapes import CELL
from robolang.syntax.foreign.motion_shapes import MOTION
from robolang.syntax.foreign.program_shapes import PROGRAM
from robolang.syntax.foreign.readings import expression
from robolang.syntax.foreign.shape import ANY, Shape

SHAPES = (*MOTION, *CELL, *PROGRAM)
FIRST = re.compile(r"[ \t]*(\$?\w+|--|//|[^\s\w])")


def of(word: str) -> tuple[Shape, ...]:
    """Return the shapes of lines that begin with a word or a sign, the more exact ones first."""
    known = _by_word()
    return (*known.get(word.upper(), ()), *known[ANY])


@cache
def compiled(shape: Shape) -> re.Pattern[str]:
    """Return the pattern of what follows the first word of a line."""
    # one at a time: a check with an error needs few of them
    return re.compile(expression(shape.pattern), re.IGNORECASE)


@cache
def _by_word() -> dict[str, list[Shape]]:
    found: dict[str, list[Shape]] = {}
    # 200 patterns and a line with an error: those of other first words are not even compiled
    for shape in SHAPES:
        first = FIRST.match(shape.example)
        for word in (shape.words or (first[1].upper() if first else "")).split():
            found.setdefault(word, []).append(shape)
    return found
