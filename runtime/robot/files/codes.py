"""Codes of URDF and MJCF files, registered at import; the module imports nothing heavy."""

from runtime.core.faults import Code, register

register(
    Code(
        code="RBL603",
        name="includes-itself",
        meaning="A robot file includes itself.",
        remedy="Remove the include.",
    ),
    Code(
        code="RBL611",
        name="chain-not-serial",
        meaning="The joints of a URDF or MJCF file form a loop or a branch; only one serial chain can be driven.",
        remedy="Leave out grippers and closed linkages; the hand belongs in the cell file.",
    ),
    Code(
        code="RBL612",
        name="robot-file-too-deep",
        meaning="A robot file is nested more deeply, or has more elements, than any arm needs.",
        remedy="Give a file with the arm alone.",
    ),
    Code(
        code="RBL614",
        name="plugin-refused",
        meaning="A robot file asks for a plugin; code named by a data file is never loaded.",
        remedy="Remove the plugin element.",
    ),
    Code(
        code="RBL627",
        name="angle-unlikely",
        meaning="A joint range or speed in a robot file is one that no known arm has; it looks like another unit.",
        remedy="Check the unit: radians in a URDF, degrees in a robot file in TOML and, as a rule, in MJCF.",
    ),
    Code(
        code="RBL628",
        name="length-unlikely",
        meaning="A length or a direction in a robot file is one that no known arm has; it looks like another unit.",
        remedy="Check the unit: lengths of a robot file are in m.",
    ),
    Code(
        code="RBL629",
        name="mass-or-drive-unlikely",
        meaning="A mass, inertia, torque or gear ratio in a robot file is one that no known arm has; it looks like "
        "another unit.",
        remedy="Check the unit: kg, kg m2 and N m; a gear ratio is motor turns per joint turn.",
    ),
    Code(
        code="RBL621",
        name="import-unsupported",
        meaning="A URDF or MJCF file uses something that the import does not read; it is never guessed.",
        remedy="Rewrite the element as docs/robots-import.md says, or give a robot file in TOML.",
    ),
)
