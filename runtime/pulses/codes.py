"""Codes of pulse tables, registered at import; the module imports nothing heavy."""

from runtime.core.faults import Code, register

register(
    Code(
        code="RBL430",
        name="pulse-frequency-too-high",
        meaning="A move needs a higher pulse frequency than its channel can give.",
        remedy="Write the SPEED that the message names, or give the channel larger pulses.",
    ),
    Code(
        code="RBL431",
        name="not-exportable",
        meaning="A statement cannot be exported to pulse tables: it depends on a sensor, or needs a joint that the "
        "mechanism does not have.",
        remedy="Change the statement as the message says, or export for another machine.",
    ),
    Code(
        code="RBL432",
        name="pulse-target-too-large",
        meaning="A position is too far from zero to be counted in pulses of this size.",
        remedy="Give the channel larger pulses.",
    ),
    Code(
        code="RBL433",
        name="plc-range",
        meaning="A frequency or a target is outside the range of the data table of this PLC.",
        remedy="Change the speed, the step time or the pulse equivalent, or export without the form of the PLC (--plc "
        "none).",
    ),
    Code(
        code="RBL630",
        name="pulse-export-unreadable",
        meaning="A folder of pulse tables, or a file in it, is missing or damaged, or one of its keys is missing or of "
        "the wrong type.",
        remedy="Name a folder that robolang export has written, or export again.",
    ),
    Code(
        code="RBL631",
        name="pulse-table-malformed",
        meaning="A pulse channel cannot execute a row of a pulse table, or the table has no proper end.",
        remedy="Export again with robolang export; do not edit the tables.",
    ),
    Code(
        code="RBL632",
        name="pulse-table-out-of-step",
        meaning="The channels of a move would not stay together: a row is not one time step long, a table does not "
        "begin at the position of its channel, or it has another number of steps than the move.",
        remedy="Export again with robolang export; the tables of a folder belong together.",
    ),
    Code(
        code="RBL633",
        name="pulse-export-schema",
        meaning="A folder of pulse tables was written by an older or newer version of robolang.",
        remedy="Update robolang, or export again with robolang export.",
    ),
    Code(
        code="RBL634",
        name="pulse-robot-mismatch",
        meaning="Pulse tables cannot drive the robot of the cell: they were written for another mechanism or tool, or "
        "start outside the joint ranges.",
        remedy="Give the cell with which the program was exported.",
    ),
    Code(
        code="RBL635",
        name="pulse-path-error",
        meaning="Pulse tables move the tool point farther from a straight line than allowed.",
        remedy="Export with a finer pulse equivalent, a lower minimum frequency or another time step.",
    ),
)
