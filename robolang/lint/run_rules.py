"""Rules RBL5xx: what a run would stop at and can be seen before it."""

from robolang.lint.registry import Rule

RULES = (
    Rule(
        code="RBL534",
        why="A signal that is not there switches nothing and never comes: the program would stop at this line with the "
        "part in its hand.",
        bad="10 OUT(0) = 1\n",
        good="10 OUT(1) = 1\n",
    ),
)
