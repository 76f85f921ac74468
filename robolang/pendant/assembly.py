"""All commands of the prompt."""

from robolang.pendant.command import Commands
from robolang.pendant.commands import (
    editing,
    jogging,
    logs,
    measuring,
    recording,
    running,
    session,
    showing,
    stepping,
    teaching,
)

# in any order: help sorts them under their headings
COMMANDS = Commands(
    (
        *editing.COMMANDS,
        *session.COMMANDS,
        *showing.COMMANDS,
        *teaching.COMMANDS,
        *measuring.COMMANDS,
        *jogging.COMMANDS,
        *running.COMMANDS,
        *stepping.COMMANDS,
        *logs.COMMANDS,
        *recording.COMMANDS,
    )
)
