"""Rules RBL4xx: payloads, speeds, times and blends that no robot can follow."""

from robolang.core.diagnostics import Severity
from robolang.lint.rule import Rule

RULES = (
    Rule(
        code="RBL401",
        why="The controller computes gravity and inertia from LOAD. With a mass that no body has, its torques push the "
        "arm in the wrong direction.",
        bad="10 LOAD (0, 0, 60), -0.8\n",
        good="10 LOAD (0, 0, 60), 0.8\n",
    ),
    Rule(
        code="RBL402",
        why="Beyond the rated payload the drives run out of torque, the arm leaves its path and stops. Often the mass "
        "was given in grams.",
        bad="10 LOAD (0, 0, 60), 800\n",
        good="10 LOAD (0, 0, 60), 0.8\n",
    ),
    Rule(
        code="RBL403",
        why="A centre of gravity more than two metres from the flange is a length in another unit or frame. The "
        "torques that follow from it throw the arm about.",
        bad="10 LOAD (0, 0, 60000), 0.8\n",
        good="10 LOAD (0, 0, 60), 0.8\n",
    ),
    Rule(
        code="RBL404",
        why="A speed of nothing never arrives, and one beyond every robot is a slip of the unit: SPEED is in mm/s, "
        "ACCEL in per cent, TIME in seconds.",
        bad="10 MOVE P1, SPEED 0\n",
        good="10 MOVE P1, SPEED 250\n",
    ),
    Rule(
        code="RBL405",
        why="Nobody waits a negative time, and ten minutes in one line are a slip of the unit: times are in seconds.",
        bad="10 HAND ON, -1\n",
        good="10 HAND ON, 1\n",
    ),
    Rule(
        code="RBL415",
        why="A blend leaves the line at a distance from its corner, and a distance below nothing is no place to leave "
        "it.",
        bad="10 MOVE P1, ZONE -5\n20 MOVE P2\n",
        good="10 MOVE P1, ZONE 5\n20 MOVE P2\n",
    ),
    Rule(
        code="RBL440",
        severity=Severity.WARNING,
        why="What is pushed is no longer where the program will look for it, and a part that is pulled over the table "
        "before it is lifted shifts between the fingers. Parts are followed from where the cell puts them: gripped, "
        "carried, put down.",
        bad="10 MOVE P5 + (0, 80, 0)\n20 MOVE P1 + (0, 80, 0)\n30 MOVE P1 + (0, 50, 0)\n",
        good="10 MOVE P5 + (0, 80, 0)\n20 MOVE P1 + (0, 80, 0)\n30 MOVE P1 + (0, 70, 0)\n",
        line=3,
    ),
    Rule(
        code="RBL441",
        severity=Severity.WARNING,
        why="The program goes on as if the hand had a part. Parts are followed from where the cell puts them; a cell "
        "without parts, or one whose part was dropped, gives no such finding.",
        bad="10 MOVE P5\n20 HAND ON\n",
        good="10 MOVE P1\n20 HAND ON\n",
        line=2,
    ),
)
