"""Codes of TOML files: robots, cells, points, profiles. Registered at import."""

from runtime.core.faults import Code, register

register(
    Code(
        code="RBL311",
        name="points-not-a-file",
        meaning="The points file is not a regular file that can be read, is not text, or is a link out of its folder.",
        remedy="Put the points file beside the program, as ordinary UTF-8 text.",
    ),
    Code(
        code="RBL600",
        name="file-not-readable",
        meaning="A robot file, a cell file or a file that belongs to it is missing, is not a regular file, is too "
        "large or is not UTF-8 text.",
        remedy="Name an ordinary file, UTF-8 text of at most 1 MB.",
    ),
    Code(
        code="RBL601",
        name="file-syntax",
        meaning="A robot or cell file is not valid TOML, or a URDF or MJCF file is not valid XML.",
        remedy="Correct the line that the message names.",
    ),
    Code(
        code="RBL602",
        name="path-outside-folder",
        meaning="A file names another file outside its own folder.",
        remedy="Put the other file into the same folder, and name it by a relative path without '..'.",
    ),
    Code(
        code="RBL604",
        name="value-not-finite",
        meaning="A number in a robot or cell file is NaN, infinite or larger than any physical size.",
        remedy="Give an ordinary number in the unit at the end of the key name, as in mass_kg.",
    ),
    Code(
        code="RBL605",
        name="value-out-of-range",
        meaning="A number in a robot or cell file is outside its allowed range.",
        remedy="Give a value in the range that the message states.",
    ),
    Code(
        code="RBL606",
        name="inertia-not-physical",
        meaning="An inertia is not physically possible: a principal moment is not positive, or exceeds the sum of the "
        "other two.",
        remedy="Correct the inertia: each principal moment must be positive and at most the sum of the other two.",
    ),
    Code(
        code="RBL607",
        name="limits-inverted",
        meaning="The lower limit of a range is not below its upper limit.",
        remedy="Write the range as [lower, upper].",
    ),
    Code(
        code="RBL608",
        name="key-missing",
        meaning="A required key of a robot or cell file is missing. Limits are never guessed.",
        remedy="Add the key that the message names.",
    ),
    Code(
        code="RBL609",
        name="key-unknown",
        meaning="A robot file, a cell file or a controller profile has an unknown key.",
        remedy="Correct the spelling, or remove the key.",
    ),
    Code(
        code="RBL610",
        name="name-taken-or-unknown",
        meaning="A name in a robot or cell file is used twice, or refers to something that does not exist.",
        remedy="Give each thing its own name, and correct a name that does not exist.",
    ),
    Code(
        code="RBL613",
        name="value-wrong-type",
        meaning="A value in a robot or cell file has the wrong type or the wrong number of entries.",
        remedy="Give the type that the message states.",
    ),
    Code(
        code="RBL615",
        name="geometry-inconsistent",
        meaning="The closed-form geometry of a robot file describes another arm than its axes.",
        remedy="Compare the OPW parameters, offsets and signs with the axis table.",
    ),
    Code(
        code="RBL616",
        name="gains-unstable",
        meaning="The settings of the controller profile make a servo loop unstable.",
        remedy="Lower the velocity bandwidth or shorten the servo period, as the message states.",
    ),
    Code(
        code="RBL617",
        name="compensation-other-robot",
        meaning="A compensation file was identified on another robot.",
        remedy="Name the compensation file of this robot, or write one with robolang identify.",
    ),
    Code(
        code="RBL618",
        name="compensation-schema",
        meaning="A compensation file was written by an older or newer version of robolang.",
        remedy="Update robolang, or write the file again with robolang identify.",
    ),
    Code(
        code="RBL619",
        name="run-log-unusable",
        meaning="A log of a run is damaged, is of an arm with another number of axes, or has no such line or time.",
        remedy="Name a log that robolang run --log FILE.npz (or FILE.mcap) has written.",
    ),
    Code(
        code="RBL640",
        name="part-not-at-rest",
        meaning="A part of the cell overlaps another part, an obstacle or the floor, or nothing supports it.",
        remedy="Correct its pose (its centre, mm) or its size; in a run with physics it would be pushed away or fall.",
    ),
    Code(
        code="RBL643",
        name="mesh-unusable",
        meaning="The mesh file of a part or an obstacle is missing, is no STL or OBJ file, is damaged or is too large.",
        remedy="Export the mesh anew as STL or OBJ with at most 20000 triangles, into the folder of the cell file.",
    ),
    Code(
        code="RBL644",
        name="mesh-not-solid",
        meaning="The mesh of a part or an obstacle is no solid: it is open, inside out, flat or overlaps itself.",
        remedy="Repair it where it was made: a closed surface, every triangle counter-clockwise from outside.",
    ),
    Code(
        code="RBL645",
        name="mesh-filled",
        meaning="A mesh is hollow or has corners that go in; contacts are those of its convex hull, which fills them.",
        remedy="Put it together from several parts or obstacles that are convex, or, where the hull will do, state "
        "filled = true.",
    ),
    Code(
        code="RBL646",
        name="grip-without-reserve",
        meaning="The hand holds a part with less than twice its weight: a fast move or a grip at its end may lose it.",
        remedy="Give the hand more force (grip_force_n, holding_force_n), or move with less ACCEL; what the hand never "
        "lifts can be an obstacle.",
    ),
    Code(
        code="RBL647",
        name="grip-too-weak",
        meaning="The hand cannot hold a part of the cell: its force is less than the weight of the part.",
        remedy="Correct mass_kg, friction and the force of the hand (grip_force_n, holding_force_n); what the hand "
        "never lifts can be an obstacle.",
    ),
)
