"""Codes of the language: text (1xx), meaning (2xx), points (3xx), command line (7xx), internal (9xx).

Importing this module fills the registry of ``runtime.core.faults`` completely, the runtime's own codes included, and
brings in no numerics, so ``robolang check``, ``explain`` and the documentation generator need only this import. A
code keeps its number and its meaning for ever; a message may be reworded. Called once, at import.
"""

import robolang.core.run_codes  # noqa: F401 - registers 2xx, 50x and 53x
import runtime.core.faults
import runtime.core.tomlfile  # registers RBL311 and RBL6xx
import runtime.motion.codes
import runtime.pulses.codes
import runtime.robot.files.codes
from runtime.core.faults import Code

_TEXT = (
    (
        "RBL103",
        "suspicious-character",
        "A character that hides or reorders text, or that is not plain ASCII outside a comment.",
        "Retype it with the plain Latin letter or sign; remove invisible and direction-changing characters.",
    ),
    ("RBL104", "not-text", "The program is not UTF-8 text.", "Save the file as UTF-8."),
    ("RBL105", "line-too-long", "A line has more than 10,000 characters.", "Split the line."),
    ("RBL106", "source-too-large", "The program is larger than 1 MB.", "Split the program."),
    (
        "RBL107",
        "too-many-problems",
        "More problems were found than are listed.",
        "Correct the first ones first.",
    ),
    (
        "RBL108",
        "nested-too-deeply",
        "Parentheses, signs or blocks are nested more than 100 deep.",
        "Write the expression in several steps, and inner blocks as a SUB.",
    ),
    (
        "RBL109",
        "expression-too-long",
        "A line has more than 1,000 operators.",
        "Write the expression in several steps.",
    ),
    (
        "RBL110",
        "mixed-line-ends",
        "The file mixes LF, CR and CR LF line ends.",
        "Save it with one kind of line end.",
    ),
    (
        "RBL111",
        "unexpected-token",
        "Something else was expected at this place of the statement.",
        "Write what is expected at this place, or remove what stands there.",
    ),
    (
        "RBL112",
        "unknown-instruction",
        "The line does not start with an instruction of the language.",
        "Start the line with an instruction such as MOVE, LOAD, HAND or IF, or with name = value.",
    ),
    ("RBL113", "line-number-duplicated", "Two lines have the same line number.", "Renumber one of them."),
    (
        "RBL114",
        "number-out-of-range",
        "A number is too large to be represented.",
        "Give a number of ordinary size; a line number has at most nine digits.",
    ),
    (
        "RBL115",
        "number-malformed",
        "A number is not written as a number.",
        "Write digits with at most one decimal point, as in 1000 or 0.25, and no unit.",
    ),
    (
        "RBL116",
        "line-number-order",
        "A line number is smaller than the one before it.",
        "Renumber the lines; they run in the order in which they are written.",
    ),
    (
        "RBL118",
        "option-given-twice",
        "A statement has the same option twice, or WRIST HOLD the same component.",
        "Remove one of them.",
    ),
    (
        "RBL119",
        "options-contradict",
        "SPEED and TIME are both given for one move.",
        "Give one: TIME fixes the duration, SPEED the speed along the path.",
    ),
    (
        "RBL120",
        "too-many-components",
        "WRIST HOLD names more than two components of the posture.",
        "Name one or two of TILT, ADVANCE and ROTATION.",
    ),
    (
        "RBL190",
        "unused-suppression",
        "A noqa comment suppresses nothing, or names a code that is not found on its line.",
        "Remove it; robolang check --fix does.",
    ),
    (
        "RBL191",
        "unknown-suppression",
        "A noqa comment names something that is not a code.",
        "Write noqa, or noqa: and whole codes as in noqa: RBL301.",
    ),
)

_MEANING = (
    (
        "RBL201",
        "empty-program",
        "The program has no statement; nothing will move.",
        "Write at least one instruction.",
    ),
)

_POINTS = (
    (
        "RBL301",
        "point-undefined",
        "A point is used that has not been taught.",
        "Correct the name, or write [points.NAME] with pose = [x, y, z, rx, ry, rz] into NAME.points.toml beside the "
        "program.",
    ),
    (
        "RBL302",
        "points-missing",
        "The file of taught points does not exist.",
        "Teach the points, or put NAME.points.toml beside the program.",
    ),
    (
        "RBL303",
        "points-damaged",
        "The file of taught points is empty, cut off or not what such a file contains.",
        "Correct the line that is named, or restore the file from a copy.",
    ),
    (
        "RBL304",
        "points-newer-schema",
        "The file of taught points was written by a newer version.",
        "Update robolang; the file was not changed.",
    ),
    (
        "RBL305",
        "point-frame-or-tool-unknown",
        "A program or a point names a frame, a tool or a load that the cell does not have.",
        "Correct the name, or add [frames.NAME], [tools.NAME] or [loads.NAME] to the cell file.",
    ),
    (
        "RBL306",
        "sensor-unknown",
        "SEAM ON names a sensor that the cell does not have.",
        "Add [sensors.NAME] to the cell file, or correct the name.",
    ),
    (
        "RBL307",
        "points-wrong-count",
        "A point has the wrong number of values.",
        "A pose has six values [x, y, z, rx, ry, rz]; joints has one angle for each axis.",
    ),
    (
        "RBL308",
        "points-unknown-key",
        "A point has a key or a configuration word that nothing reads.",
        "Correct the spelling or remove it.",
    ),
    (
        "RBL309",
        "points-value-out-of-range",
        "A value of a point is not finite or beyond any robot, or a joint angle is outside of the range of its joint.",
        "Positions are in mm, angles in degrees; teach the point within the ranges of the robot.",
    ),
    (
        "RBL310",
        "points-other-robot",
        "The points were taught on another robot.",
        "Run the program on that robot, or teach the points again.",
    ),
)

_IDENTIFICATION = (
    (
        "RBL420",
        "test-motion-refused",
        "A test motion of identification would leave the range, the speed, the acceleration or the torque of a joint.",
        "Identify the other axes with --axis, carry less, or take another robot; nothing has moved.",
    ),
)

_COMMAND = (
    ("RBL701", "file-missing", "The program file does not exist.", "Check the name and the folder."),
    (
        "RBL702",
        "not-a-file",
        "The program is a folder, a device or a file that cannot be read.",
        "Name an ordinary file that you may read.",
    ),
    (
        "RBL703",
        "option-value",
        "An option of the command line has a value that it cannot take.",
        "See the help of the command.",
    ),
    (
        "RBL706",
        "output-not-writable",
        "The log or the report cannot be written.",
        "Check the folder, its permissions and the free space.",
    ),
    (
        "RBL707",
        "configuration-key",
        "A key of the configuration is unknown or given twice.",
        "Correct the spelling or remove the key.",
    ),
    (
        "RBL708",
        "robot-unknown",
        "No built-in robot and no robot file has the given name.",
        "Name a built-in robot or the path of a robot file ending in .toml, .urdf or .xml.",
    ),
    (
        "RBL709",
        "robot-does-not-fit-cell",
        "The robot given on the command line has another number of axes than the cell's home position.",
        "Give a cell file made for that robot with --cell.",
    ),
    (
        "RBL710",
        "rule-unknown",
        "The configuration selects or ignores a rule that does not exist.",
        "Give a code such as RBL301, the beginning of one such as RBL2, or a name; robolang rules lists them.",
    ),
    (
        "RBL711",
        "golden-log-unusable",
        "A golden log is damaged, has a joint angle that is not finite, or was written on another robot.",
        "Write it again with robolang test --update, or restore it from a copy.",
    ),
    (
        "RBL712",
        "no-tests",
        "robolang test was given a path with no test file in it, so nothing was compared.",
        "Name a folder with NAME.test.toml files, or allow it with --allow-empty.",
    ),
    (
        "RBL900",
        "internal-error",
        "robolang itself failed; the program is not the cause.",
        "Report it with the program and the message.",
    ),
)

runtime.core.faults.register(
    *(
        Code(code=code, name=name, meaning=meaning, remedy=remedy)
        for code, name, meaning, remedy in (*_TEXT, *_MEANING, *_POINTS, *_IDENTIFICATION, *_COMMAND)
    )
)
