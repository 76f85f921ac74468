"""Rules RBL4xx: payloads, speeds, times and blends that no robot can follow."""

from robolang.core.diagnostics import Severity
from robolang.lint.rule import Rule

RULES = (
    Rule(
        code="RBL401",
        why="The controller computes gravity and inertia from LOAD. With an impossible mass its torques push the arm "
        "in the wrong direction.",
        bad="10 LOAD (0, 0, 60), -0.8\n",
        good="10 LOAD (0, 0, 60), 0.8\n",
    ),
    Rule(
        code="RBL402",
        why="Above the rated payload the drives do not have enough torque: the arm leaves its path and stops. Often "
        "the mass was given in grams.",
        # the built-in robot is rated for 2.5 kg
        bad="10 LOAD (0, 0, 60), 800\n",
        good="10 LOAD (0, 0, 60), 0.8\n",
    ),
    Rule(
        code="RBL403",
        why="A centre of gravity more than two metres from the flange is given in another unit or frame. The torques "
        "computed from it would throw the arm about.",
        bad="10 LOAD (0, 0, 60000), 0.8\n",
        good="10 LOAD (0, 0, 60), 0.8\n",
    ),
    Rule(
        code="RBL404",
        why="A move at speed 0 never ends, and a speed above that of every robot is in the wrong unit: SPEED is in "
        "mm/s, ACCEL in per cent, TIME in seconds.",
        bad="10 MOVE P1, SPEED 0\n",
        good="10 MOVE P1, SPEED 250\n",
    ),
    Rule(
        code="RBL405",
        why="A waiting time cannot be negative, and a very long one is in the wrong unit: times are in seconds.",
        bad="10 HAND ON, -1\n",
        good="10 HAND ON, 1\n",
    ),
    Rule(
        code="RBL415",
        why="A blend leaves the line at this distance from its corner, and a distance below 0 has no meaning.",
        bad="10 MOVE P1, ZONE -5\n20 MOVE P2\n",
        good="10 MOVE P1, ZONE 5\n20 MOVE P2\n",
    ),
    Rule(
        code="RBL440",
        severity=Severity.WARNING,
        why="A part that is pushed is no longer where the program expects it, and a part that is pulled over the table "
        "before it is lifted shifts between the fingers. The check follows the parts from their places in the cell "
        "file: gripped, carried, put down.",
        bad="10 MOVE P5 + (0, 80, 0)\n20 MOVE P1 + (0, 80, 0)\n30 MOVE P1 + (0, 50, 0)\n",
        good="10 MOVE P5 + (0, 80, 0)\n20 MOVE P1 + (0, 80, 0)\n30 MOVE P1 + (0, 70, 0)\n",
        line=3,
    ),
    Rule(
        code="RBL441",
        severity=Severity.WARNING,
        why="The program continues as if the hand held a part. The check follows the parts from their places in the "
        "cell file; in a cell without parts, or after a part was dropped, it reports nothing.",
        bad="10 MOVE P5\n20 HAND ON\n",
        good="10 MOVE P1\n20 HAND ON\n",
        line=2,
    ),
)
