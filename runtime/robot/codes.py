"""Codes of URDF and MJCF files, registered at import; the module imports nothing heavy."""

from runtime.faults import Code, register

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
        code="RBL621",
        name="import-unsupported",
        meaning="A URDF or MJCF file uses something that the import does not read; it is never guessed.",
        remedy="Rewrite the element as docs/robots-import.md says, or give a robot file in TOML.",
    ),
)
