"""Codes of URDF and MJCF files, registered at import; the module imports nothing heavy."""

from runtime.core.faults import Code, register

register(
    Code(
        code="RBL603",
        name="includes-itself",
        meaning="A robot file includes itself.",
        remedy="Remove the include that leads back to the file.",
    ),
    Code(
        code="RBL611",
        name="chain-not-serial",
        meaning="The joints of a URDF or MJCF file form a loop or a branch; the import takes one serial chain only.",
        remedy="Remove grippers and closed linkages from the file; describe the hand in the cell file.",
    ),
    Code(
        code="RBL612",
        name="robot-file-too-deep",
        meaning="A robot file is nested too deeply or has too many elements for an arm.",
        remedy="Give a file with the arm only.",
    ),
    Code(
        code="RBL614",
        name="plugin-refused",
        meaning="An MJCF file asks for a plugin. Code that a data file names is never loaded. Plugins of a URDF are "
        "left out.",
        remedy="Remove the plugin element.",
    ),
    Code(
        code="RBL641",
        name="element-left-out",
        meaning="A URDF holds elements or attributes that the import does not read, of a simulator or another program. "
        "They change nothing of the arm.",
        remedy="Nothing; without them there is no note.",
    ),
    Code(
        code="RBL642",
        name="values-alike",
        meaning="All links of an arm have the same mass and inertia, or all joints the same torque. No arm is built "
        "like that: the file has placeholders.",
        remedy="State the real values in the sidecar; 'robolang robot import --estimate' estimates them.",
    ),
    Code(
        code="RBL627",
        name="angle-unlikely",
        meaning="A joint range, speed or jerk in a robot file is one that no known arm has; probably its unit is "
        "wrong.",
        remedy="Check the unit: radians in a URDF, degrees in a robot file in TOML and usually in MJCF.",
    ),
    Code(
        code="RBL628",
        name="length-unlikely",
        meaning="A length, a direction, or the speed or jerk of an axis that slides is one that no known arm has; "
        "probably its unit is wrong.",
        remedy="Check the unit: lengths of a robot file are in m.",
    ),
    Code(
        code="RBL629",
        name="mass-or-drive-unlikely",
        meaning="A mass, inertia, torque or gear ratio in a robot file is one that no known arm has; probably its unit "
        "is wrong.",
        remedy="Check the unit: kg, kg m2 and N m; a gear ratio is motor turns per joint turn.",
    ),
    Code(
        code="RBL621",
        name="import-unsupported",
        meaning="A URDF or MJCF file uses something that the import does not read. It is never guessed.",
        remedy="Rewrite the element as docs/robots-import.md describes, or give a robot file in TOML.",
    ),
)
