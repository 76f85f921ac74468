"""Codes of making projects: folders that ``new`` and ``init`` write, and examples that are copied.

Registered at import, as those of ``robolang.core.codes``, which imports this module.
"""

from runtime.core.faults import Code, register

register(
    Code(
        code="RBL840",
        name="template-unknown",
        meaning="No template of a project has this name.",
        remedy="Name one of the templates: pick-place, palletise, tend, dispense or measure.",
    ),
    Code(
        code="RBL841",
        name="would-overwrite",
        meaning="A project or an example would be written over a folder or files that are there already.",
        remedy="Give another name or folder, or move the files that the message names. Nothing has been written.",
    ),
    Code(
        code="RBL842",
        name="project-name-invalid",
        meaning="The name of a project is not one: it names the folder and the files in it.",
        remedy="Give a name of letters, digits, '-' and '_' that begins with a letter; a path may stand before it.",
    ),
    Code(
        code="RBL843",
        name="template-does-not-fit",
        meaning="The job of a template has no place in front of a robot: everywhere a point is out of reach, a joint "
        "too near to the end of its range or the arm touches the table; or it may not carry the hand and the part.",
        remedy="Choose another template or a robot that is larger, and see with 'robolang robot show' that ranges and "
        "payload of the robot are right.",
    ),
    Code(
        code="RBL844",
        name="example-unknown",
        meaning="No example has this name.",
        remedy="'robolang examples' lists them all.",
    ),
)
