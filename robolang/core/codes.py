"""Codes of the language: text (1xx), meaning (2xx), points (3xx), command line (7xx), internal (9xx).

Importing this module fills the registry of ``runtime.core.faults`` completely, the runtime's own codes included, and
brings in no numerics, so ``robolang check``, ``explain`` and the documentation generator need only this import. A
code keeps its number and its meaning for ever; a message may be reworded. Called once, at import.
"""

import robolang.core.run_codes  # noqa: F401 - registers 2xx, 50x and 53x
import runtime.core.tomlfile
import runtime.motion.codes
import runtime.pulses.codes
import runtime.robot.files.codes  # noqa: F401
from runtime.core.faults import Code, register

register(
    Code(
        code="RBL103",
        name="suspicious-character",
        meaning="A character that hides or reorders text, or that is not plain ASCII outside a comment.",
        remedy="Retype it with the plain Latin letter or sign; remove invisible and direction-changing characters.",
    ),
    Code(
        code="RBL104",
        name="not-text",
        meaning="The program is not UTF-8 text.",
        remedy="Save the file as UTF-8.",
    ),
    Code(
        code="RBL105",
        name="line-too-long",
        meaning="A line has more than 10,000 characters.",
        remedy="Split the line.",
    ),
    Code(
        code="RBL106",
        name="source-too-large",
        meaning="The program is larger than 1 MB.",
        remedy="Split the program.",
    ),
    Code(
        code="RBL107",
        name="too-many-problems",
        meaning="More problems were found than are listed.",
        remedy="Correct the first ones first.",
    ),
    Code(
        code="RBL108",
        name="nested-too-deeply",
        meaning="Parentheses, signs or blocks are nested more than 100 deep.",
        remedy="Write the expression in several steps, and inner blocks as a SUB.",
    ),
    Code(
        code="RBL109",
        name="expression-too-long",
        meaning="A line has more than 1,000 operators.",
        remedy="Write the expression in several steps.",
    ),
    Code(
        code="RBL110",
        name="mixed-line-ends",
        meaning="The file mixes LF, CR and CR LF line ends.",
        remedy="Save it with one kind of line end.",
    ),
    Code(
        code="RBL111",
        name="unexpected-token",
        meaning="Something else was expected at this place of the statement.",
        remedy="Write what is expected at this place, or remove what stands there.",
    ),
    Code(
        code="RBL112",
        name="unknown-instruction",
        meaning="The line does not start with an instruction of the language.",
        remedy="Start the line with an instruction such as MOVE, LOAD, HAND or IF, or with name = value.",
    ),
    Code(
        code="RBL113",
        name="line-number-duplicated",
        meaning="Two lines have the same line number.",
        remedy="Renumber one of them.",
    ),
    Code(
        code="RBL114",
        name="number-out-of-range",
        meaning="A number is too large to be represented.",
        remedy="Give a number of ordinary size; a line number has at most nine digits.",
    ),
    Code(
        code="RBL115",
        name="number-malformed",
        meaning="A number is not written as a number.",
        remedy="Write digits with at most one decimal point, as in 1000 or 0.25, and no unit.",
    ),
    Code(
        code="RBL116",
        name="line-number-order",
        meaning="A line number is smaller than the one before it.",
        remedy="Renumber the lines; they run in the order in which they are written.",
    ),
    Code(
        code="RBL118",
        name="option-given-twice",
        meaning="A statement has the same option twice, or WRIST HOLD the same component.",
        remedy="Remove one of them.",
    ),
    Code(
        code="RBL119",
        name="options-contradict",
        meaning="SPEED and TIME are both given for one move.",
        remedy="Give one: TIME fixes the duration, SPEED the speed along the path.",
    ),
    Code(
        code="RBL120",
        name="too-many-components",
        meaning="WRIST HOLD names more than two components of the posture.",
        remedy="Name one or two of TILT, ADVANCE and ROTATION.",
    ),
    Code(
        code="RBL190",
        name="unused-suppression",
        meaning="A noqa comment suppresses nothing, or names a code that is not found on its line.",
        remedy="Remove it; robolang check --fix does.",
    ),
    Code(
        code="RBL191",
        name="unknown-suppression",
        meaning="A noqa comment names something that is not a code.",
        remedy="Write noqa, or noqa: and whole codes as in noqa: RBL301.",
    ),
    Code(
        code="RBL201",
        name="empty-program",
        meaning="The program has no statement; nothing will move.",
        remedy="Write at least one instruction.",
    ),
    Code(
        code="RBL301",
        name="point-undefined",
        meaning="A point is used that has not been taught.",
        remedy="Correct the name, or write [points.NAME] with pose = [x, y, z, rx, ry, rz] into NAME.points.toml "
        "beside the program.",
    ),
    Code(
        code="RBL302",
        name="points-missing",
        meaning="The file of taught points does not exist.",
        remedy="Teach the points, or put NAME.points.toml beside the program.",
    ),
    Code(
        code="RBL303",
        name="points-damaged",
        meaning="The file of taught points is empty, cut off or not what such a file contains.",
        remedy="Correct the line that is named, or restore the file from a copy.",
    ),
    Code(
        code="RBL304",
        name="points-newer-schema",
        meaning="The file of taught points was written by a newer version.",
        remedy="Update robolang; the file was not changed.",
    ),
    Code(
        code="RBL305",
        name="point-frame-or-tool-unknown",
        meaning="A program or a point names a frame, a tool or a load that the cell does not have.",
        remedy="Correct the name, or add [frames.NAME], [tools.NAME] or [loads.NAME] to the cell file.",
    ),
    Code(
        code="RBL306",
        name="sensor-unknown",
        meaning="SEAM ON names a sensor that the cell does not have.",
        remedy="Add [sensors.NAME] to the cell file, or correct the name.",
    ),
    Code(
        code="RBL307",
        name="points-wrong-count",
        meaning="A point has the wrong number of values.",
        remedy="A pose has six values [x, y, z, rx, ry, rz]; joints has one angle for each axis.",
        computed=True,
    ),
    Code(
        code="RBL308",
        name="points-unknown-key",
        meaning="A point has a key or a configuration word that nothing reads.",
        remedy="Correct the spelling or remove it.",
    ),
    Code(
        code="RBL309",
        name="points-value-out-of-range",
        meaning="A value of a point is not finite or beyond any robot, or a joint angle is outside of the range of "
        "its joint.",
        remedy="Positions are in mm, angles in degrees; teach the point within the ranges of the robot.",
        computed=True,
    ),
    Code(
        code="RBL310",
        name="points-other-robot",
        meaning="The points were taught on another robot.",
        remedy="Run the program on that robot, or teach the points again.",
    ),
    Code(
        code="RBL420",
        name="test-motion-refused",
        meaning="A test motion of identification would leave the range, the speed, the acceleration or the torque "
        "of a joint.",
        remedy="Identify the other axes with --axis, carry less, or take another robot; nothing has moved.",
    ),
    Code(
        code="RBL701",
        name="file-missing",
        meaning="The program file does not exist.",
        remedy="Check the name and the folder.",
    ),
    Code(
        code="RBL702",
        name="not-a-file",
        meaning="The program is a folder, a device or a file that cannot be read.",
        remedy="Name an ordinary file that you may read.",
    ),
    Code(
        code="RBL703",
        name="option-value",
        meaning="An option of the command line has a value that it cannot take.",
        remedy="See the help of the command.",
    ),
    Code(
        code="RBL706",
        name="output-not-writable",
        meaning="The log or the report cannot be written.",
        remedy="Check the folder, its permissions and the free space.",
    ),
    Code(
        code="RBL707",
        name="configuration-key",
        meaning="A key of the configuration is unknown or given twice.",
        remedy="Correct the spelling or remove the key.",
    ),
    Code(
        code="RBL708",
        name="robot-unknown",
        meaning="No built-in robot and no robot file has the given name.",
        remedy="Name a built-in robot or the path of a robot file ending in .toml, .urdf or .xml.",
    ),
    Code(
        code="RBL709",
        name="robot-does-not-fit-cell",
        meaning="The robot given on the command line has another number of axes than the cell's home position.",
        remedy="Give a cell file made for that robot with --cell.",
    ),
    Code(
        code="RBL710",
        name="rule-unknown",
        meaning="The configuration selects or ignores a rule that does not exist.",
        remedy="Give a code such as RBL301, the beginning of one such as RBL2, or a name; robolang rules lists them.",
    ),
    Code(
        code="RBL711",
        name="golden-log-unusable",
        meaning="A golden log is damaged, has a joint angle that is not finite, or was written on another robot.",
        remedy="Write it again with robolang test --update, or restore it from a copy.",
    ),
    Code(
        code="RBL712",
        name="no-tests",
        meaning="robolang test was given a path with no test file in it, so nothing was compared.",
        remedy="Name a folder with NAME.test.toml files, or allow it with --allow-empty.",
    ),
    Code(
        code="RBL713",
        name="no-programs",
        meaning="robolang check was given folders without a program (*.rbl), so nothing was checked.",
        remedy="Name a folder with programs, or allow it with --allow-empty.",
    ),
    Code(
        code="RBL900",
        name="internal-error",
        meaning="robolang itself failed; the program is not the cause.",
        remedy="Report it with the program and the message.",
    ),
)
