"""Rules RBL2xx: the meaning of a program."""

from robolang.core.diagnostics import Severity
from robolang.lint.rule import Rule

RULES = (
    Rule(
        code="RBL201",
        severity=Severity.WARNING,
        why="A program without a statement starts and ends at once. On a production line that looks like success.",
        bad="' the second shift writes this one\n",
        good="' the second shift writes this one\n10 MOVE P1\n",
    ),
    Rule(
        code="RBL202",
        why="The jump has no target. The check reports it now, not in the night when the condition is true for the "
        "first time.",
        bad="10 IF IN(1) THEN GOTO *DONE\n20 MOVE P1\n30 *DON MOVE P2\n",
        good="10 IF IN(1) THEN GOTO *DONE\n20 MOVE P1\n30 *DONE MOVE P2\n",
    ),
    Rule(
        code="RBL203",
        why="A name for two places is ambiguous: a jump or a call could mean either place.",
        bad="10 *PICK MOVE P1\n20 *PICK MOVE P2\n30 IF IN(1) THEN GOTO *PICK\n",
        good="10 *PICK MOVE P1\n20 *PLACE MOVE P2\n30 IF IN(1) THEN GOTO *PICK\n",
        line=2,
    ),
    Rule(
        code="RBL204",
        why="A loop that is entered in its middle has no count, so its NEXT cannot continue. A SUB is entered by CALL "
        "only, which gives its parameters their values, and continues after the CALL when it ends.",
        bad="10 IF IN(1) THEN GOTO 30\n20 FOR I = 1 TO 3\n30 MOVE P1\n40 NEXT\n",
        good="10 IF IN(1) THEN GOTO 20\n20 FOR I = 1 TO 3\n30 MOVE P1\n40 NEXT\n",
    ),
    Rule(
        code="RBL205",
        why="The variable would not change, and the arm would repeat its moves until somebody stops it.",
        bad="10 FOR I = 1 TO 3 STEP 0\n20 MOVE P1\n30 MOVE P2\n40 NEXT\n",
        good="10 FOR I = 1 TO 3\n20 MOVE P1\n30 MOVE P2\n40 NEXT\n",
    ),
    Rule(
        code="RBL206",
        severity=Severity.WARNING,
        why="A tenth has no exact binary value. The number of rounds is computed once, at the start; the variable is a "
        "sum, and its last value differs a little from the end value.",
        bad="10 FOR X = 0 TO 1 STEP 0.1\n20 MOVE P1 + (0, 0, X)\n30 NEXT\n",
        good="10 FOR I = 0 TO 10\n20 MOVE P1 + (0, 0, I / 10)\n30 NEXT\n",
    ),
    Rule(
        code="RBL209",
        why="The calculation fails in every run, whatever the variables hold.",
        bad="10 DELAY 1 / 0\n",
        good="10 DELAY 1 / 2\n",
    ),
    Rule(
        code="RBL211",
        why="The end of a block decides which lines are repeated or skipped. It is not guessed.",
        bad="10 FOR I = 1 TO 3\n20 MOVE P1\n30 MOVE P2\n",
        good="10 FOR I = 1 TO 3\n20 MOVE P1\n30 MOVE P2\n40 NEXT\n",
    ),
    Rule(
        code="RBL212",
        why="The first line of the block is missing or misspelt, so the lines of the block run once, without a "
        "condition.",
        bad="10 MOVE P1\n20 MOVE P2\n30 NEXT\n",
        good="10 FOR I = 1 TO 3\n20 MOVE P1\n25 MOVE P2\n30 NEXT\n",
        line=3,
    ),
    Rule(
        code="RBL213",
        why="There is no SUB to call. The check reports it before the arm moves, not in the middle of the work.",
        bad="10 CALL PICK\n20 END\n30 SUB PICKUP\n40 MOVE P1\n50 HAND ON\n60 ENDSUB\n",
        good="10 CALL PICKUP\n20 END\n30 SUB PICKUP\n40 MOVE P1\n50 HAND ON\n60 ENDSUB\n",
    ),
    Rule(
        code="RBL214",
        why="No value can be assumed for a missing argument, and an additional one had a purpose that the SUB does not "
        "know.",
        bad="10 CALL LIFT(50)\n20 END\n30 SUB LIFT(H, T)\n40 DEPART H, TIME T\n50 ENDSUB\n",
        good="10 CALL LIFT(50, 2)\n20 END\n30 SUB LIFT(H, T)\n40 DEPART H, TIME T\n50 ENDSUB\n",
    ),
    Rule(
        code="RBL215",
        why="A misspelt name would otherwise be a new variable without a value.",
        bad="10 DWELL = 0.5\n20 DELAY DWEL\n",
        good="10 DWELL = 0.5\n20 DELAY DWELL\n",
        line=2,
    ),
    Rule(
        code="RBL216",
        why="The lines below rely on the value of CONST. A second value would hold for some of them only.",
        bad="10 CONST HEIGHT = 50\n20 HEIGHT = 60\n30 DEPART HEIGHT\n",
        good="10 CONST HEIGHT = 60\n30 DEPART HEIGHT\n",
        line=2,
    ),
    Rule(
        code="RBL217",
        why="A text is not converted to the number that it shows, and a pose is six numbers. The line would fail in "
        "every run.",
        bad='10 DELAY "2"\n',
        good="10 DELAY 2\n",
    ),
    Rule(
        code="RBL218",
        why="A pose consists of X, Y, Z in mm and RX, RY, RZ in degrees. Other letters mean other angles on other "
        "controllers.",
        bad="10 PRINT P1.W\n",
        good="10 PRINT P1.RX\n",
    ),
    Rule(
        code="RBL219",
        why="A SUB exists whether or not the program passes its line. Inside a block it looks as if the block decided "
        "about it.",
        bad="10 IF IN(1) THEN\n20 SUB LIFT\n30 DEPART 50\n40 ENDSUB\n50 ENDIF\n60 CALL LIFT\n",
        good="10 IF IN(1) THEN\n20 CALL LIFT\n30 ENDIF\n40 END\n50 SUB LIFT\n60 DEPART 50\n70 ENDSUB\n",
        line=2,
    ),
    Rule(
        code="RBL220",
        why="Two values where three are needed are ambiguous. The missing value is not filled in.",
        bad="10 LOAD (0, 60), 0.8\n",
        good="10 LOAD (0, 0, 60), 0.8\n",
    ),
    Rule(
        code="RBL224",
        severity=Severity.WARNING,
        why="The point is left over from another version, or a line that should use it names another point. Whoever "
        "teaches the cell again teaches it for nothing. The finding has its place in the points file.",
        bad="schema = 1\n[points.P1]\npose = [450, -150, 200, 180, 0, 90]\n"
        "[points.OLD]\njoints = [0, 45, -180, 0, 45, 0]\n",
        good="schema = 1\n[points.P1]\npose = [450, -150, 200, 180, 0, 90]\n",
        line=4,
        points=True,
    ),
    Rule(
        code="RBL231",
        severity=Severity.WARNING,
        why="MOD, * and / are evaluated from the left, as in RAPID, KAREL and C. In other languages MOD binds less "
        "tightly, and in earlier versions of this one it bound more tightly. With parentheses every reader sees "
        "the order.",
        bad="10 N = 4\n20 PRINT 2 * N MOD 3\n",
        good="10 N = 4\n20 PRINT (2 * N) MOD 3\n",
        line=2,
    ),
    Rule(
        code="RBL232",
        severity=Severity.WARNING,
        why="A decimal fraction such as 0.1 has no exact binary value: 0.1 + 0.2 prints as 0.3 but is not equal to "
        "0.3. A branch that needs equality is not taken, or a loop does not end.",
        bad='10 X = 0.1 + 0.2\n20 IF X = 0.3 THEN PRINT "equal"\n',
        good='10 X = 0.1 + 0.2\n20 IF ABS(X - 0.3) < 1E-6 THEN PRINT "equal"\n',
        line=2,
    ),
    Rule(
        code="RBL236",
        severity=Severity.WARNING,
        why="The curve passes the point once, and the second one changes nothing. Often another point was meant, and "
        "the curve misses it.",
        bad="10 SPLINE (P1, P2, P2, P3)\n",
        good="10 SPLINE (P1, P2, P3)\n",
    ),
)
