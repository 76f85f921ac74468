"""Rules RBL5xx: what a run would stop at and can be seen before it."""

from robolang.lint.rule import Rule

RULES = (
    Rule(
        code="RBL507",
        why="A program that asks for more memory than there is stops at this line, wherever the arm is then. Mostly a "
        "zero or an exponent is too much.",
        bad="10 DIM A(1E9)\n20 A(1) = 1\n30 PRINT A(1)\n",
        good="10 DIM A(10)\n20 A(1) = 1\n30 PRINT A(1)\n",
    ),
    Rule(
        code="RBL534",
        why="A signal that is not there switches nothing and never comes: the program would stop at this line with the "
        "part in its hand.",
        bad="10 OUT(0) = 1\n",
        good="10 OUT(1) = 1\n",
    ),
)
