"""Rules RBL5xx: what a run would stop at and can be seen before it."""

from robolang.lint.rule import Rule

RULES = (
    Rule(
        code="RBL507",
        why="A program that needs more memory than allowed stops at this line, wherever the arm is then. Usually a "
        "number has a zero or an exponent too many.",
        bad="10 DIM A(1E9)\n20 A(1) = 1\n30 PRINT A(1)\n",
        good="10 DIM A(10)\n20 A(1) = 1\n30 PRINT A(1)\n",
    ),
    Rule(
        code="RBL534",
        why="An output that does not exist switches nothing, and an input that does not exist never changes: the "
        "program would stop at this line with the part in the hand.",
        bad="10 OUT(0) = 1\n",
        good="10 OUT(1) = 1\n",
    ),
)
