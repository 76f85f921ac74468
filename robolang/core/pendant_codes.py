"""Codes of the prompt: lines that cannot be carried out where it stands.

Registered at import, as those of ``robolang.core.codes``, which imports this module.
"""

from runtime.core.faults import Code, register

register(
    Code(
        code="RBL801",
        name="command-unknown",
        meaning="The prompt has no command, and the language no statement, of this name.",
        remedy="Type help for the list of commands.",
    ),
    Code(
        code="RBL802",
        name="command-misused",
        meaning="A command of the prompt was typed in another form than its own.",
        remedy="Type help and the word of the command for its form.",
    ),
    Code(
        code="RBL803",
        name="line-unknown",
        meaning="The program has no such line.",
        remedy="Type list for the lines of the program.",
    ),
    Code(
        code="RBL804",
        name="alarm-latched",
        meaning="An alarm is latched, and nothing moves before it is acknowledged.",
        remedy="Type reset to acknowledge it; back takes back the statement that raised it.",
    ),
    Code(
        code="RBL805",
        name="changes-unsaved",
        meaning="The prompt was to end with changes that are not saved.",
        remedy="Type save before quit, or undo the changes.",
    ),
    Code(
        code="RBL806",
        name="program-over",
        meaning="The program has ended, so there is no statement to go on with.",
        remedy="Type restart to begin the program anew, again for the start state of the cell, or back.",
    ),
    Code(
        code="RBL807",
        name="not-confirmed",
        meaning="A question of the prompt was answered with no, or a script, which cannot answer, came to it.",
        remedy="In a script add --yes to the line.",
    ),
    Code(
        code="RBL808",
        name="name-taken",
        meaning="The name is taken already.",
        remedy="Give another name.",
    ),
    Code(
        code="RBL809",
        name="motion-cut-short",
        meaning="A motion of the prompt was stopped before its end, so there is no result.",
        remedy="Start it again.",
    ),
)
register(
    Code(
        code="RBL810",
        name="recording-full",
        meaning="What is recorded would be a larger program than can be read.",
        remedy="Record the next part to another file, after again.",
    ),
    Code(
        code="RBL811",
        name="typed-statement-stopped",
        meaning="A statement that was typed was stopped before its end, and the program cannot go on before it.",
        remedy="Type continue to end it, or back to take it back.",
    ),
    Code(
        code="RBL812",
        name="no-live-picture",
        meaning="The prompt was started by a program that gave it no live picture.",
        remedy="Start it with robolang repl.",
    ),
)
