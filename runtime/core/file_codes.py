"""Codes of TOML files: robots, cells, points, profiles. Registered at import."""

from runtime.core.faults import Code, register

register(
    Code(
        code="RBL311",
        name="points-not-a-file",
        meaning="The file of taught points is not a regular file that can be read.",
        remedy="Name an ordinary file inside the project.",
    ),
    Code(
        code="RBL600",
        name="file-not-readable",
        meaning="A robot or cell file is missing, is not a regular file, is too large or is not UTF-8 text.",
        remedy="Name an ordinary file, UTF-8 text of at most 1 MB.",
    ),
    Code(
        code="RBL601",
        name="file-syntax",
        meaning="A robot or cell file is not valid TOML.",
        remedy="Correct the line that is named.",
    ),
    Code(
        code="RBL602",
        name="path-outside-folder",
        meaning="A file refers to another file outside its own folder.",
        remedy="Put the file beside the one that names it and use a relative path without '..'.",
    ),
    Code(
        code="RBL604",
        name="value-not-finite",
        meaning="A number in a robot or cell file is NaN, infinite or beyond any physical size.",
        remedy="Give an ordinary number in the unit that ends the key's name.",
    ),
    Code(
        code="RBL605",
        name="value-out-of-range",
        meaning="A number in a robot or cell file is outside the range that makes sense for it.",
        remedy="Give a value in the range named in the message.",
    ),
    Code(
        code="RBL606",
        name="inertia-not-physical",
        meaning="An inertia is not physically possible: a principal moment is not positive, or exceeds the sum of the "
        "other two.",
        remedy="Each principal moment must be positive and at most the sum of the other two.",
    ),
    Code(
        code="RBL607",
        name="limits-inverted",
        meaning="The lower limit of a joint is not below its upper limit.",
        remedy="Write the range as [lower, upper].",
    ),
    Code(
        code="RBL608",
        name="key-missing",
        meaning="A key that a robot or cell file must have is missing; limits are never guessed.",
        remedy="Add the key that is named.",
    ),
    Code(
        code="RBL609",
        name="key-unknown",
        meaning="A robot or cell file has a key that nothing reads.",
        remedy="Correct the spelling or remove the key.",
    ),
    Code(
        code="RBL610",
        name="name-taken-or-unknown",
        meaning="A name in a robot or cell file is used twice, or names something that does not exist.",
        remedy="Give each thing a name of its own; for an unknown name, write one that is known.",
    ),
    Code(
        code="RBL613",
        name="value-wrong-type",
        meaning="A value in a robot or cell file has the wrong type or the wrong number of entries.",
        remedy="Give the type named in the message.",
    ),
    Code(
        code="RBL615",
        name="geometry-inconsistent",
        meaning="The closed-form geometry of a robot file does not describe the same arm as its axes.",
        remedy="Check the OPW parameters, offsets and signs against the axis table.",
    ),
    Code(
        code="RBL616",
        name="gains-unstable",
        meaning="The controller profile gives gains with which a servo loop cannot be stable.",
        remedy="Lower the velocity bandwidth or shorten the servo period, as the message says.",
    ),
    Code(
        code="RBL617",
        name="compensation-other-robot",
        meaning="A compensation file was identified on another robot.",
        remedy="Name the file of this robot, or write it with robolang identify.",
    ),
    Code(
        code="RBL618",
        name="compensation-schema",
        meaning="A compensation file was written by an older or newer version.",
        remedy="Update robolang, or write the file anew with robolang identify.",
    ),
    Code(
        code="RBL640",
        name="part-not-at-rest",
        meaning="A part of a cell overlaps another part, an obstacle or the floor, or has no support.",
        remedy="Correct its pose (the centre of the box, mm) or its size; a physical run would push it or let it fall.",
    ),
)
