"""Rules RBL1xx: the text of a program."""

from robolang.core.diagnostics import Severity
from robolang.lint.rule import Rule

_LONG = 10_000

RULES = (
    Rule(
        code="RBL103",
        why="A letter of another alphabet that looks like a Latin one is another letter: the name it stands in is not "
        "the name that was taught. A mark that changes the direction of writing shows the reader another program than "
        "the one that runs.",
        bad="10 MOVE P1\n20 MOVE \N{CYRILLIC CAPITAL LETTER ER}2\n",
        good="10 MOVE P1\n20 MOVE P2\n",
        shown="10 MOVE P1\n20 MOVE \N{CYRILLIC CAPITAL LETTER ER}2      ' this \N{CYRILLIC CAPITAL LETTER ER} is "
        "U+0420, a Cyrillic letter\n",
        line=2,
        fix="A character with one plain twin, such as a typographic quote, a full-width digit or a letter that looks "
        "Latin, is retyped; an invisible one of no width is removed. Other characters are left alone.",
    ),
    Rule(
        code="RBL104",
        why="A byte that is not UTF-8 has no fixed meaning: one editor shows a degree sign, the next another letter. "
        "No place in such a file can be named for certain, so nothing of it is read.",
        bad="10 MOVE P1 ' turned by 90\udcb0\n",
        good="10 MOVE P1 ' turned by 90 deg\n",
        shown="10 MOVE P1 ' turned by 90\N{DEGREE SIGN}      (the degree sign saved as Latin-1)\n",
    ),
    Rule(
        code="RBL105",
        why="A line that long was not written by hand: line ends were lost, or this is not a program. The bound keeps "
        "checking quick whatever the file holds.",
        bad=f"10 MOVE P1 '{'-' * _LONG}\n",
        good="10 MOVE P1 '----\n",
        shown="10 MOVE P1 '-----      (and so on, 10,000 characters)\n",
    ),
    Rule(
        code="RBL106",
        why="A program of more than 1 MB is not read, so that a wrong file name costs no time and no memory.",
        bad=f"'{'-' * 98}\n" * 10_001,
        good="'----\n10 MOVE P1\n",
        shown="'----      (and so on, 1,000,001 bytes)\n",
    ),
    Rule(
        code="RBL107",
        why="After a thousand problems the rest of the text is not read: this is probably not a program, or one "
        "mistake made everywhere. Nothing is known of what follows.",
        bad="MOV P1\n" * 1001,
        good="MOVE P1\n" * 1001,
        line=1001,
        shown="MOV P1\nMOV P1      (and so on, 1,001 lines)\n",
    ),
    Rule(
        code="RBL108",
        why="Nobody can read a hundred signs or parentheses inside one another, and a bound is what lets every text be "
        "checked in time and memory known beforehand.",
        bad=f"10 LOAD (0, 0, {'-' * 102}60), 0.8\n",
        good="10 LOAD (0, 0, 60), 0.8\n",
        shown="10 LOAD (0, 0, ----60), 0.8      (102 signs)\n",
    ),
    Rule(
        code="RBL109",
        why="A line of a thousand operators was made by a program, and its value is better computed there.",
        bad=f"10 LOAD (0, 0, 60), 0{' + 0' * 1001}\n",
        good="10 LOAD (0, 0, 60), 0\n",
        shown="10 LOAD (0, 0, 60), 0 + 0 + 0      (1,001 signs)\n",
    ),
    Rule(
        code="RBL110",
        severity=Severity.INFO,
        why="Tools that know one kind of line end only count the lines of such a file differently, so that the line in "
        "a message is not the line in the editor.",
        bad="10 MOVE P1\r\n20 MOVE P2\n30 MOVE P3\r\n",
        good="10 MOVE P1\r\n20 MOVE P2\r\n30 MOVE P3\r\n",
        line=2,
        shown="10 MOVE P1      (CR LF)\n20 MOVE P2      (LF)\n30 MOVE P3      (CR LF)\n",
        fix="Every line ends as the first one does.",
    ),
    Rule(
        code="RBL111",
        why="The line does not say what the arm shall do, and guessing is not for a machine that moves. The program "
        "does not run.",
        bad="10 MOVE P1 SPEED 200\n",
        good="10 MOVE P1, SPEED 200\n",
        fix="A comma that is missing before an option of a move is added, where the line can be read further then. "
        "Everything else is left alone.",
    ),
    Rule(
        code="RBL112",
        why="An instruction that does not exist cannot be carried out. The program does not run; nothing is guessed, "
        "since the nearest word may be another motion.",
        bad="10 MOV P1\n",
        good="10 MOVE P1\n",
    ),
    Rule(
        code="RBL113",
        why="A line number that stands twice names no line: a jump to it could lead to either.",
        bad="10 MOVE P1\n10 MOVE P2\n",
        good="10 MOVE P1\n20 MOVE P2\n",
        line=2,
    ),
    Rule(
        code="RBL114",
        why="A number beyond what can be represented would become infinite, and every check of a limit after it "
        "meaningless.",
        bad="10 LOAD (0, 0, 60), 1E999\n",
        good="10 LOAD (0, 0, 60), 0.8\n",
    ),
    Rule(
        code="RBL115",
        why="A number with a unit, a separator or a second point has several meanings, and an arm would follow "
        "one of them.",
        bad="10 MOVE P1, SPEED 1_000\n",
        good="10 MOVE P1, SPEED 1000\n",
        fix="Underscores between digits are removed, and a space is put between a line number and the instruction that "
        "is glued to it. A unit is not removed: 0.8m is not 0.8.",
    ),
    Rule(
        code="RBL116",
        severity=Severity.WARNING,
        why="Lines run in the order in which they are written, not in the order of their numbers. Whoever expects the "
        "other order sees the arm go somewhere else.",
        bad="20 MOVE P1\n10 MOVE P2\n",
        good="10 MOVE P1\n20 MOVE P2\n",
        line=2,
    ),
    Rule(
        code="RBL118",
        why="Of two values for one option only one can hold. Which one was meant is not in the program.",
        bad="10 MOVE P1, SPEED 200, SPEED 200\n",
        good="10 MOVE P1, SPEED 200\n",
        fix="The second one is removed when it says the same as the first.",
    ),
    Rule(
        code="RBL119",
        why="A path has one length, so its duration and its speed cannot both be given.",
        bad="10 MOVE P1, SPEED 200, TIME 2\n",
        good="10 MOVE P1, TIME 2\n",
    ),
    Rule(
        code="RBL120",
        why="The tool's orientation has three components. With all three held nothing is left to turn, and the wrist "
        "cannot pass.",
        bad="10 WRIST HOLD TILT, ADVANCE, ROTATION\n",
        good="10 WRIST HOLD TILT, ADVANCE\n",
    ),
    Rule(
        code="RBL190",
        severity=Severity.WARNING,
        why="A suppression that suppresses nothing hides the next finding of that line, which nobody has seen yet.",
        bad="10 MOVE P1 ' noqa: RBL301\n",
        good="10 MOVE P1\n",
        fix="The codes that are not found are removed, and the whole noqa when none is left. In a program with errors "
        "of syntax, or beside a points file that cannot be read, none is removed: not everything was checked. "
        "Codes that need the cell or the motion are left alone.",
    ),
    Rule(
        code="RBL191",
        severity=Severity.WARNING,
        why="A misspelt code suppresses nothing, while the line looks as if somebody had read its finding and "
        "accepted it.",
        bad="10 MOVE P1 ' noqa: RBL30\n",
        good="10 MOVE P1\n",
    ),
)
