"""Rules RBL3xx: taught points and the names of the cell."""

from robolang.lint.rule import Rule

RULES = (
    Rule(
        code="RBL301",
        why="The arm has no target: the name is misspelt, or nobody has taught the point yet. The program does not "
        "run, because it would leave the arm in the middle of its work.",
        bad="10 MOVE P1\n20 MOVE P12\n",
        good="10 MOVE P1\n20 MOVE P2\n",
        line=2,
    ),
    Rule(
        code="RBL302",
        why="A link that leads nowhere shows that there were points: the drive is not mounted, or the file has another "
        "name now. Without the link the program would have no points, or those of the built-in cell.",
        bad="pick.points.toml -> /mnt/taught/pick.points.toml      (nothing is there)\npick.rbl\n",
        good="schema = 1\n[points.P1]\npose = [450, -150, 200, 180, 0, 90]\n",
        line=0,
        points=True,
    ),
    Rule(
        code="RBL303",
        why="Half a points file would send the arm to half of the points. Nothing of a damaged file is used.",
        bad="schema = 1\n[points.P1]\npose = [450, -150, 200, 180, 0\n",
        good="schema = 1\n[points.P1]\npose = [450, -150, 200, 180, 0, 90]\n",
        line=3,
        points=True,
    ),
    Rule(
        code="RBL304",
        why="A newer version may have written something that this version would leave out or read differently, such as "
        "a frame. The file is neither used nor changed.",
        bad="schema = 2\n[points.P1]\npose = [450, -150, 200, 180, 0, 90]\n",
        good="schema = 1\n[points.P1]\npose = [450, -150, 200, 180, 0, 90]\n",
        points=True,
    ),
    Rule(
        code="RBL305",
        why="Every target after it depends on the tool or the frame. With one that does not exist, the arm would go to "
        "a place that nobody has taught.",
        bad="10 TOOL GRIPER\n20 MOVE P1\n",
        good="10 TOOL GRIPPER\n20 MOVE P1\n",
    ),
    Rule(
        code="RBL306",
        why="A seam cannot be followed with a sensor that does not exist; the arm would weld beside the seam.",
        bad="10 SEAM ON, LASR\n20 MOVE P1\n30 SEAM OFF\n",
        good="10 SEAM ON, LASER\n20 MOVE P1\n30 SEAM OFF\n",
    ),
    Rule(
        code="RBL307",
        why="With three values the tool could arrive in any orientation, and with five angles one joint could stand "
        "anywhere.",
        bad="schema = 1\n[points.P1]\npose = [450, -150, 200]\n",
        good="schema = 1\n[points.P1]\npose = [450, -150, 200, 180, 0, 90]\n",
        line=3,
        points=True,
    ),
    Rule(
        code="RBL308",
        why="A misspelt key is not read, and the point would be another one without any message: here one of another "
        "tool than it was taught with.",
        bad='schema = 1\n[points.P1]\npose = [450, -150, 200, 180, 0, 90]\ntooll = "GRIP"\n',
        good='schema = 1\n[points.P1]\npose = [450, -150, 200, 180, 0, 90]\ntool = "GRIP"\n',
        line=4,
        points=True,
    ),
    Rule(
        code="RBL309",
        why="A point half a kilometre away has a wrong unit or a wrong decimal point. Joint angles outside the ranges "
        "of the robot belong to another robot or are typing errors: the arm can never stand there.",
        bad="schema = 1\n[points.P1]\npose = [450000, -150, 200, 180, 0, 90]\n",
        good="schema = 1\n[points.P1]\npose = [450, -150, 200, 180, 0, 90]\n",
        line=3,
        points=True,
    ),
    Rule(
        code="RBL310",
        why="On another arm the same joint angles are another place, and the same place may be out of reach.",
        bad='schema = 1\nrobot = "irb2400"\n[points.P1]\njoints = [0, 45, -180, 0, 45, 0]\n',
        good='schema = 1\nrobot = "puma560"\n[points.P1]\njoints = [0, 45, -180, 0, 45, 0]\n',
        line=2,
        points=True,
    ),
    Rule(
        code="RBL311",
        why="A folder, a device, a link out of the project or bytes that are not text are not taught points. They are "
        "refused before they are read, so that a check neither waits for a pipe nor reads a file of somebody else.",
        bad='schema = 1\n[points.P1]\npose = [450, -150, 200, 180, 0, 90]\ncomment = "turned by 90\udcb0"\n',
        good='schema = 1\n[points.P1]\npose = [450, -150, 200, 180, 0, 90]\ncomment = "turned by 90 deg"\n',
        shown="schema = 1\n[points.P1]\npose = [450, -150, 200, 180, 0, 90]\n"
        'comment = "turned by 90\N{DEGREE SIGN}"      (the degree sign saved as Latin-1)\n',
        line=4,
        points=True,
    ),
)
