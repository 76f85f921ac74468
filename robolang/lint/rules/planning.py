"""Rules RBL41x and RBL42x that ``robolang check --motion`` finds: what the planned motion of a program shows.

The examples run on the built-in cell.
"""

from robolang.core.diagnostics import Severity
from robolang.lint.rule import Rule

RULES = (
    Rule(
        code="RBL410",
        why="The arm is not long enough. Many robots start such a move and stop within its path; here the program does "
        "not start.",
        bad="10 MOVE P1 + (900, 0, 0)\n",
        good="10 MOVE P1 + (90, 0, 0)\n",
    ),
    Rule(
        code="RBL411",
        why="The place can be reached, but a joint would have to turn farther than it can, at the end of the move or "
        "on its path.",
        # 15 deg further J5 would be at nearly 110 deg, and its range ends at 100
        bad="10 MOVEJ JOINT(0, 60, -190, 0, 95, 0)\n20 MOVE HERE * (0, 0, 0, 0, -15, 0), WRIST KEEP\n",
        good="10 MOVEJ JOINT(0, 60, -190, 0, 95, 0)\n20 MOVE HERE * (0, 0, 0, 0, 15, 0), WRIST KEEP\n",
        line=2,
    ),
    Rule(
        code="RBL412",
        why="On the straight line J4 would have to turn by half a turn at once. Many robots notice this on the path "
        "only, and stop there with the part in the hand.",
        bad="10 MOVEJ JOINT(0, 60, -190, 20, -8, 0)\n20 MOVE JOINT(10, 60, -190, 20, 8, 0), WRIST KEEP\n",
        good="10 MOVEJ JOINT(0, 60, -190, 20, -8, 0)\n20 MOVE JOINT(10, 60, -190, 20, 8, 0), WRIST AUTO\n",
        line=2,
    ),
    Rule(
        code="RBL414",
        severity=Severity.WARNING,
        why="Two blends cannot share a piece of path. The zone becomes smaller, and the arm passes the corner closer "
        "and slower than the program states.",
        bad="10 MOVE P5 + (0, 0, 40), ZONE 30\n20 MOVE P5 + (100, 0, 40)\n",
        good="10 MOVE P5 + (0, 0, 40), ZONE 15\n20 MOVE P5 + (100, 0, 40)\n",
    ),
    Rule(
        code="RBL416",
        why="No circle passes through three points on a line, and many circles pass through two points.",
        bad="10 MOVEC P5 + (50, 0, 0), P5 + (100, 0, 0)\n",
        good="10 MOVEC P5 + (50, 20, 0), P5 + (100, 0, 0)\n",
    ),
    Rule(
        code="RBL417",
        why="A curve has a direction at each point, and a tool that turns at one place has none. A half turn has two "
        "directions, and the wrong one may take a joint out of its range.",
        bad="10 SPLINE (P5 + (50, 0, 0), P5 * (0, 50, 0, 0, 0, 90), P5 * (0, 50, 0))\n",
        good="10 SPLINE (P5 + (50, 0, 0), P5 * (0, 50, 0, 0, 0, 90))\n20 MOVE P5 * (0, 50, 0)\n",
    ),
    Rule(
        code="RBL419",
        severity=Severity.WARNING,
        why="The tool is where it was taught, but J4 and J6 are half a turn away from it. The next joint move starts "
        "from there, hoses wind up, and after some rounds an axis reaches the end of its range.",
        bad="10 MOVEJ JOINT(0, 60, -190, -30, -30, 0)\n20 MOVE JOINT(10, 60, -190, 150, 30, 180), WRIST KEEP\n",
        good="10 MOVEJ JOINT(0, 60, -190, -30, -30, 0)\n20 MOVE JOINT(10, 60, -190, -30, -30, 0), WRIST KEEP\n",
        line=2,
    ),
    Rule(
        code="RBL421",
        why="The joints can follow the path, but a table is in it. In the real cell the hand would break.",
        # P1 is 40 mm over the top of the table, and the fingers reach below the tool point
        bad="10 MOVE P1 + (0, 0, -30)\n",
        good="10 MOVE P1 + (0, 0, 30)\n",
    ),
    Rule(
        code="RBL422",
        severity=Severity.WARNING,
        why="If the point is taught slightly differently, or with another tool, the move is refused. Cables and hoses "
        "also suffer at the end of a range.",
        # J5 of the built-in robot ends at 100 deg
        bad="10 MOVEJ JOINT(0, 60, -190, 0, 99.8, 0)\n",
        good="10 MOVEJ JOINT(0, 60, -190, 0, 90, 0)\n",
    ),
    Rule(
        code="RBL423",
        why="The cycle time of a line is agreed. With --max-cycle a change that exceeds it fails when it is made. The "
        "limit of the example is 3 s.",
        bad="10 MOVE P2\n20 DELAY 5\n30 MOVE P5\n",
        good="10 MOVE P2\n20 MOVE P5\n",
    ),
    Rule(
        code="RBL424",
        why="The ranges of the single joints do not keep a folded arm from touching itself. The shapes are coarse: "
        "where this is reported, a hand, a hose or a cable touches the arm for certain, and the contact stops a run "
        "with physics. An arm whose file gives no link_radius_mm has no shapes: it is not checked, and the table "
        "states so.",
        bad="10 MOVEJ JOINT(-60, 210, 25, -70, 65, -75)\n",
        good="10 MOVEJ JOINT(-60, 180, 25, -70, 65, -75)\n",
    ),
    Rule(
        code="RBL425",
        severity=Severity.WARNING,
        why="Even a mass below the rated payload is too much for the wrist when it is far from the flange. The drive "
        "holds it for a while, heats up and stops. If the robot file has published ratings, this is an error.",
        bad="10 LOAD (450, 0, 60), 2.4\n20 MOVEJ JOINT(0, 60, -190, 0, 60, 0)\n",
        good="10 LOAD (0, 0, 60), 2.4\n20 MOVEJ JOINT(0, 60, -190, 0, 60, 0)\n",
        line=2,
    ),
    Rule(
        code="RBL426",
        severity=Severity.WARNING,
        why="Inertia grows with the square of the distance from the axis. The wrist swings beyond its end position, or "
        "its drive has not enough torque. If the robot file has published ratings, this is an error.",
        bad="10 LOAD (0, 0, 60), 2.4, (0.2, 0.2, 0.2, 0, 0, 0)\n20 MOVE P2\n",
        good="10 LOAD (0, 0, 60), 2.4, (0.02, 0.02, 0.02, 0, 0, 0)\n20 MOVE P2\n",
        line=2,
    ),
    Rule(
        code="RBL427",
        severity=Severity.WARNING,
        why="Near a singular posture the joints turn very fast for a small motion of the tool: the move is slow and "
        "rough, and with a work piece a few millimetres off it is refused.",
        bad="10 MOVEJ JOINT(0, 60, -190, 0, -1.5, 0)\n20 MOVE HERE + (20, 0, 0), WRIST KEEP\n",
        good="10 MOVEJ JOINT(0, 60, -190, 0, -15, 0)\n20 MOVE HERE + (20, 0, 0), WRIST KEEP\n",
        line=2,
    ),
    Rule(
        code="RBL428",
        severity=Severity.WARNING,
        why="The tool point stays on its line while the tool tilts, so that the move ends as taught. For a gripper in "
        "free air this is useful; for a torch, or in a bore, it is not.",
        bad="10 MOVEJ JOINT(0, 60, -190, 20, -8, 0)\n20 MOVE JOINT(10, 60, -190, 20, 8, 0)\n",
        good="10 MOVEJ JOINT(0, 60, -190, 20, -8, 0)\n20 MOVE JOINT(10, 60, -190, 20, 8, 0), WRIST AUTO\n",
        line=2,
    ),
    Rule(
        code="RBL429",
        severity=Severity.WARNING,
        why="The cycle time was calculated with the programmed speed, and the arm does not reach it. A bead or a weld "
        "at another speed has another size.",
        bad="10 MOVE P2, TIME 0.3\n",
        good="10 MOVE P2, TIME 1.5\n",
    ),
    Rule(
        code="RBL434",
        severity=Severity.WARNING,
        why="The arm swings round through places that nobody expects, although the target is close to the tool.",
        bad="10 MOVEJ JOINT(0, 80, -190, 0, 60, 0)\n20 MOVEJ P5\n",
        good="10 MOVEJ JOINT(0, 80, -190, 0, -60, 0)\n20 MOVEJ P5\n",
        line=2,
    ),
    Rule(
        code="RBL435",
        severity=Severity.WARNING,
        why="The tool turns almost once round for a small change of its angle, and hoses and cables turn with it.",
        # J6 ends at 266 deg: 290 is out of range, and -70 is the same angle
        bad="10 MOVEJ JOINT(0, 60, -190, 0, 60, 250)\n20 MOVEJ HERE * (0, 0, 0, 0, 0, 40)\n",
        good="10 MOVEJ JOINT(0, 60, -190, 0, 60, 200)\n20 MOVEJ HERE * (0, 0, 0, 0, 0, 40)\n",
        line=2,
    ),
    Rule(
        code="RBL436",
        severity=Severity.WARNING,
        why="Nothing but the points holds a spline. Where points near to one another follow a long piece, the curve is "
        "still turning when it leaves them, and swings out.",
        bad="10 SPLINE (P5 + (100, 0, 0), P5 + (100, 10, 0), P5 + (0, 10, 0))\n",
        good="10 SPLINE (P5 + (80, 0, 0), P5 + (100, 20, 0), P5 + (80, 40, 0), P5 + (0, 40, 0))\n",
    ),
    Rule(
        code="RBL437",
        severity=Severity.WARNING,
        why="A tool that reverses has to come to rest. A bead is thick there, and the programmed speed is not kept.",
        bad="10 SPLINE (P5 + (100, 0, 0), P5 + (50, 0, 0))\n",
        good="10 SPLINE (P5 + (60, 0, 0), P5 + (90, 25, 0), P5 + (60, 50, 0), P5 + (0, 50, 0))\n",
    ),
)
