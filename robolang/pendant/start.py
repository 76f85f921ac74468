"""Starting the prompt: with a terminal the screen of ``prompt``, without one the script of ``script``."""

import sys
from pathlib import Path

from robolang.pendant.assembly import COMMANDS
from robolang.pendant.interrupts import Signals
from robolang.pendant.output import PlainOutput
from robolang.pendant.pendant import Choice, Pendant
from robolang.pendant.script import play
from robolang.teaching.desk import Desk
from robolang.teaching.documents import load_documents


def start(
    program: Path | None, choice: Choice, *, record: Path | None = None, keep_going: bool = False
) -> tuple[str, ...]:
    """Let somebody work with a program at a prompt, or play the script on standard input; return the codes of errors.

    ``program`` None: a new program without a name. ``Fault`` and ``FileFault`` for files that cannot be used.
    """
    # only the texts are read here: what is wrong in them is said at the first line that needs them
    desk = Desk(load_documents(program, choice.cell))
    pendant = Pendant(
        desk,
        choice,
        PlainOutput(sys.stdout, sys.stderr),
        commands=COMMANDS,
        interrupts=Signals(),
        scripted=True,
    )
    return play(sys.stdin, pendant, keep_going=keep_going).codes
