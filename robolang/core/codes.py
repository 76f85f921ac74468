"""Codes of the language: text (1xx), meaning (2xx), points (3xx), command line (7xx), internal (9xx).

Importing this module fills the registry of ``runtime.core.faults`` completely, the runtime's own codes included, and
brings in no numerics, so ``robolang check``, ``explain`` and the documentation generator need only this import. A
code keeps its number and its meaning for ever; a message may be reworded. Called once, at import.
"""

import robolang.core.pendant_codes
import robolang.core.project_codes
import robolang.core.run_codes
import robolang.core.view_codes  # noqa: F401
import runtime.appearance.codes
import runtime.core.tomlfile
import runtime.motion.codes
import runtime.pulses.codes
import runtime.robot.files.codes  # noqa: F401
from runtime.core.faults import Code, Stage, register

register(
    Code(
        code="RBL103",
        name="suspicious-character",
        meaning="The text has a character that is invisible or changes the direction of writing, or, outside a "
        "comment, one that is not plain ASCII.",
        remedy="Retype the character with a plain letter or sign of the keyboard; delete invisible characters and "
        "those that change the direction of writing.",
    ),
    Code(
        code="RBL104",
        name="not-text",
        meaning="The program file is not UTF-8 text.",
        remedy="Save the file with the encoding UTF-8.",
    ),
    Code(
        code="RBL105",
        name="line-too-long",
        meaning="A line has more than 10,000 characters.",
        remedy="Shorten the comment, or compute parts of the expression on lines above.",
    ),
    Code(
        code="RBL106",
        name="source-too-large",
        meaning="The program file is larger than 1 MB.",
        remedy="Check that the file is a program; divide a program of this size into several.",
    ),
    Code(
        code="RBL107",
        name="too-many-problems",
        meaning="The program has more than 1000 problems; the rest is not listed.",
        remedy="Correct the first problems and check again.",
    ),
    Code(
        code="RBL108",
        name="nested-too-deeply",
        meaning="Parentheses, signs, NOTs or blocks are nested more than 100 deep.",
        remedy="Compute the expression in several steps, and move inner blocks into a SUB.",
    ),
    Code(
        code="RBL109",
        name="expression-too-long",
        meaning="A line has more than 1,000 operators.",
        remedy="Compute the expression in several steps.",
    ),
    Code(
        code="RBL110",
        name="mixed-line-ends",
        meaning="The file has different line ends: LF, CR or CR LF.",
        remedy="Save the file with one kind of line end.",
    ),
    Code(
        code="RBL111",
        name="unexpected-token",
        meaning="A word, number or sign stands where the statement needs something else.",
        remedy="Write what the message names, or remove the text at this place.",
    ),
    Code(
        code="RBL112",
        name="unknown-instruction",
        meaning="The line does not start with an instruction of the language.",
        remedy="Start the line with an instruction such as MOVE, LOAD, HAND, IF or CALL name, or with name = value.",
    ),
    Code(
        code="RBL113",
        name="line-number-duplicated",
        meaning="Two lines have the same line number.",
        remedy="Give one of the two lines another number.",
    ),
    Code(
        code="RBL114",
        name="number-out-of-range",
        meaning="A number is too large, or a line number has more than nine digits.",
        remedy="Write a smaller number.",
    ),
    Code(
        code="RBL115",
        name="number-malformed",
        meaning="A number is not written correctly.",
        remedy="Write digits with at most one decimal point, as in 1000 or 0.25, and no unit.",
    ),
    Code(
        code="RBL116",
        name="line-number-order",
        meaning="A line number is smaller than the number before it.",
        remedy="Correct the number, or number the lines again with robolang renumber.",
    ),
    Code(
        code="RBL118",
        name="option-given-twice",
        meaning="A statement has the same option twice, or WRIST HOLD has the same component twice.",
        remedy="Remove one of the two.",
    ),
    Code(
        code="RBL119",
        name="options-contradict",
        meaning="One move has both SPEED and TIME.",
        remedy="Keep one of them: TIME sets the duration of the move, SPEED its speed.",
    ),
    Code(
        code="RBL120",
        name="too-many-components",
        meaning="WRIST HOLD names more than two components of the tool orientation.",
        remedy="Name one or two of TILT, ADVANCE and ROTATION.",
    ),
    Code(
        code="RBL190",
        name="unused-suppression",
        meaning="A noqa comment suppresses nothing, or names a code without a finding on its line.",
        remedy="Remove the code or the comment; robolang check --fix does this.",
    ),
    Code(
        code="RBL191",
        name="unknown-suppression",
        meaning="A noqa comment names something that is neither a code nor the name of a rule.",
        remedy="Write noqa alone, or noqa: with whole codes, as in noqa: RBL301.",
    ),
    Code(
        code="RBL201",
        name="empty-program",
        meaning="The program has no statement, so the robot does nothing.",
        remedy="Write at least one statement.",
    ),
    Code(
        code="RBL301",
        name="point-undefined",
        meaning="A point is used that is not taught.",
        remedy="Correct the name, or add a table such as [points.P1] with pose = [x, y, z, rx, ry, rz] to the points "
        "file of the program, PROGRAM.points.toml.",
    ),
    Code(
        code="RBL302",
        name="points-missing",
        meaning="The points file does not exist, or a link to it leads nowhere.",
        remedy="Correct the link, or put the points file of the program, PROGRAM.points.toml, beside the program.",
    ),
    Code(
        code="RBL303",
        name="points-damaged",
        meaning="The points file is empty, incomplete, or has content that a points file cannot have.",
        remedy="Correct the line that the message names, or restore the file from a copy.",
    ),
    Code(
        code="RBL304",
        name="points-newer-schema",
        meaning="The points file was written by a newer version of robolang.",
        remedy="Update robolang; the file was not changed.",
    ),
    Code(
        code="RBL305",
        name="point-frame-or-tool-unknown",
        meaning="A program or a point names a frame, a tool or a load that the cell file does not define.",
        remedy="Correct the name, or add [frames.NAME], [tools.NAME] or [loads.NAME] to the cell file.",
    ),
    Code(
        code="RBL306",
        name="sensor-unknown",
        meaning="SEAM ON names a sensor that the cell file does not define.",
        remedy="Correct the name, or add [sensors.NAME] to the cell file.",
    ),
    Code(
        code="RBL307",
        name="points-wrong-count",
        meaning="A point or a JOINT has the wrong number of values.",
        remedy="Give a pose six values [x, y, z, rx, ry, rz], and joints one angle for each axis.",
        computed=True,
    ),
    Code(
        code="RBL308",
        name="points-unknown-key",
        meaning="A point has an unknown key or an unknown configuration word.",
        remedy="Correct the spelling, or remove it.",
    ),
    Code(
        code="RBL309",
        name="points-value-out-of-range",
        meaning="A value of a point is not finite or larger than any robot, or a joint angle is outside the range of "
        "its joint.",
        remedy="Give positions in mm and angles in degrees, within the ranges of the robot.",
        computed=True,
    ),
    Code(
        code="RBL310",
        name="points-other-robot",
        meaning="The points were taught on another robot.",
        remedy="Use the robot that the points file names, or teach the points again on this one.",
    ),
    Code(
        code="RBL312",
        name="not-saved",
        meaning="A program, its points file or its cell file could not be saved; on the disk it is as it was before.",
        remedy="Free space on the disk or correct the permissions, and save again, or save it under another name.",
        found=Stage.RUN,
    ),
    Code(
        code="RBL313",
        name="frame-not-determined",
        meaning="Two of the three points of a frame are too near to each other, or the points lie nearly on one line.",
        remedy="Teach the points further apart: the origin, a point on the X axis, and one on the side of the Y axis.",
        found=Stage.RUN,
    ),
    Code(
        code="RBL314",
        name="tool-not-determined",
        meaning="The touches do not determine the tip of a tool: there are too few, or the flange has nearly the same "
        "orientation in all of them.",
        remedy="Touch one fixed tip 4 times or more, from directions that differ by 30 deg or more, tilted to more "
        "than one side.",
        found=Stage.RUN,
    ),
    Code(
        code="RBL315",
        name="touches-apart",
        meaning="The touches of a tool do not meet in one tip.",
        remedy="Teach the touch that the message names again, and see that the fixed tip does not move.",
        found=Stage.RUN,
    ),
    Code(
        code="RBL420",
        name="test-motion-refused",
        meaning="A test motion of identification would exceed the range, the speed, the acceleration or the torque of "
        "a joint.",
        remedy="Identify the other axes with --axis, carry less, or use another robot. Nothing has moved.",
    ),
    Code(
        code="RBL701",
        name="file-missing",
        meaning="The program file does not exist.",
        remedy="Check the file name and the folder.",
    ),
    Code(
        code="RBL702",
        name="not-a-file",
        meaning="The program is a folder, a device or a file that cannot be read.",
        remedy="Name an ordinary file that you are allowed to read.",
    ),
    Code(
        code="RBL703",
        name="option-value",
        meaning="An option of the command line, or an argument of a function of Python, is unknown or has a value "
        "that is not allowed.",
        remedy="See the help of the command, robolang COMMAND --help; docs/python.md has the functions of Python.",
    ),
    Code(
        code="RBL706",
        name="output-not-writable",
        meaning="An output file, such as the log or the report, cannot be written.",
        remedy="Check the folder, its permissions and the free space.",
    ),
    Code(
        code="RBL707",
        name="configuration-key",
        meaning="A key of the configuration file is unknown or given twice.",
        remedy="Correct the spelling, or remove the key.",
    ),
    Code(
        code="RBL708",
        name="robot-unknown",
        meaning="No built-in robot and no robot file has this name.",
        remedy="Name a built-in robot, which robolang robot list prints, or the path of a robot file ending in .toml, "
        ".urdf or .xml.",
    ),
    Code(
        code="RBL709",
        name="robot-does-not-fit-cell",
        meaning="The robot of the command line does not fit the home position of the cell: it has another number of "
        "axes, or the position is outside its joint ranges.",
        remedy="Name a cell file made for that robot.",
    ),
    Code(
        code="RBL710",
        name="rule-unknown",
        meaning="The configuration selects or ignores a rule that does not exist.",
        remedy="Give a code such as RBL301, the beginning of one such as RBL2, or a name; robolang rules prints them "
        "all.",
    ),
    Code(
        code="RBL711",
        name="golden-log-unusable",
        meaning="A golden log is damaged, has a joint angle that is not finite, or was recorded on another robot.",
        remedy="Record it again with robolang test --update, or restore it from a copy.",
    ),
    Code(
        code="RBL712",
        name="no-tests",
        meaning="The path given to robolang test has no test file in it, so nothing was compared.",
        remedy="Name a folder with NAME.test.toml files, or allow this with --allow-empty.",
    ),
    Code(
        code="RBL713",
        name="no-programs",
        meaning="The folders given to robolang check have no program (*.rbl), so nothing was checked.",
        remedy="Name a folder with programs, or allow this with --allow-empty.",
    ),
    Code(
        code="RBL714",
        name="changed-on-disk",
        meaning="A file that is edited has been changed on the disk by somebody else since it was read.",
        remedy="Compare both changes; then save under another name, or force the save, which replaces theirs.",
    ),
    Code(
        code="RBL715",
        name="nothing-to-undo",
        meaning="There is no change that could be taken back or made again.",
        remedy="Continue; what was saved can be changed again.",
    ),
    Code(
        code="RBL716",
        name="program-unnamed",
        meaning="The program has no name yet, so there is no file to save it in.",
        remedy="Save it under a name.",
    ),
    Code(
        code="RBL717",
        name="no-such-line",
        meaning="A line is to be changed or deleted that the program does not have, or a text is not one line.",
        remedy="List the program, and name a line of it.",
    ),
    Code(
        code="RBL718",
        name="name-not-free",
        meaning="A name for a point, frame, tool or load is taken, reserved or no name, or it is one of the program.",
        remedy="Choose another name of letters, digits and _.",
    ),
    Code(
        code="RBL719",
        name="recovery-damaged",
        meaning="A recovery file, which has the unsaved changes of a prompt, is damaged or of a newer version.",
        remedy="Keep a copy of it if its content matters; then discard it.",
    ),
    Code(
        code="RBL720",
        name="jog-unclear",
        meaning="A jog names no axis of the arm, no frame or no number, or comes while the arm moves.",
        remedy="Give J1 to J7, X, Y, Z, RX, RY or RZ and a number of mm or deg, when the arm stands.",
    ),
    Code(
        code="RBL845",
        name="library-missing",
        meaning="A library that the command needs is not installed: an install that only checks text has none of them.",
        remedy="Install robolang with its dependencies: pip install robolang.",
    ),
    Code(
        code="RBL900",
        name="internal-error",
        meaning="robolang has an internal error; the program is not the cause.",
        remedy="Report the error with the program and the message.",
    ),
)
