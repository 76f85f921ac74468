"""Starting the prompt: with a terminal the screen of ``prompt``, without one the script of ``script``."""

import gc
import os
import sys
from pathlib import Path

from robolang.pendant.assembly import COMMANDS
from robolang.pendant.choice import Choice
from robolang.pendant.foreground import Foreground
from robolang.pendant.interrupts import ScriptSignals, Signals
from robolang.pendant.keyboard import Keyboard
from robolang.pendant.output import PlainOutput
from robolang.pendant.pendant import Pendant
from robolang.pendant.plain_prompt import AskingOutput, converse
from robolang.pendant.script import play
from robolang.teaching.desk import Desk
from robolang.teaching.documents import Documents, load_documents
from runtime.core.tomlfile import FileFault

_BY_SIGNAL = 128
"""Added to the number of a signal in the exit code."""


def start(
    program: Path | None, choice: Choice, *, record: Path | None = None, keep_going: bool = False
) -> tuple[str, ...]:
    """Let somebody work with a program at a prompt, or play the script on standard input; return the codes of errors.

    ``program`` None: a new program without a name. ``Fault`` and ``FileFault`` for files that cannot be used.
    """
    # only the texts are read here: what is wrong in them is said at the first line that needs them
    desk = Desk(_documents(program, choice))
    somebody_types = sys.stdin.isatty()
    interrupts = Foreground(Keyboard(sys.stdin.fileno())) if somebody_types else ScriptSignals()
    pendant = Pendant(
        desk,
        choice,
        PlainOutput(sys.stdout, sys.stderr),
        commands=COMMANDS,
        interrupts=interrupts,
        scripted=not somebody_types,
    )
    if record is not None:
        pendant.recording.begin(record, pendant)
    try:
        if not somebody_types:
            return _played(pendant, interrupts, keep_going=keep_going)
        ended_by = _at_terminal(pendant)
    finally:
        pendant.pictures.close()
    if ended_by:
        # what is buffered for a terminal that has gone would be an error at the very end
        nowhere = os.open(os.devnull, os.O_WRONLY)
        for stream in (sys.stdout, sys.stderr):
            os.dup2(nowhere, stream.fileno())
        raise SystemExit(_BY_SIGNAL + ended_by)
    return ()


def _documents(program: Path | None, choice: Choice) -> Documents:
    """Read what is edited; ``FileFault`` for files that cannot be used."""
    try:
        return load_documents(program, choice.cell, choice.robot)
    except FileFault as fault:
        if fault.code != "RBL701":
            raise
        hint = f"{fault.hint} robolang repl without a name begins a new program, and save as NAME names it."
        raise FileFault(fault.code, fault.message, hint, fault.place) from None


def _played(pendant: Pendant, interrupts: Signals, *, keep_going: bool) -> tuple[str, ...]:
    """Play the script on standard input; a signal that ends it decides the exit code."""
    codes: tuple[str, ...] = ()
    with interrupts.ending():
        try:
            codes = play(sys.stdin, pendant, keep_going=keep_going).codes
        except KeyboardInterrupt:
            if not interrupts.signal:  # Ctrl-C between two lines
                raise
    if interrupts.signal:
        raise SystemExit(_BY_SIGNAL + interrupts.signal)
    return codes


def _at_terminal(pendant: Pendant) -> int:
    """Let somebody work at a terminal; return the signal that ended it, 0 for ``quit``."""
    if not sys.stdout.isatty() or os.environ.get("TERM", "dumb").lower() in ("dumb", "unknown"):
        pendant.output = AskingOutput(sys.stdin, sys.stdout, sys.stderr)
        return converse(pendant, sys.stdin, sys.stdout)
    # what imports leave is no garbage: looking for some takes a tenth of the start; on again in ``starting``
    gc.disable()
    # a script does not need what edits lines and paints
    from prompt_toolkit.input import create_input
    from prompt_toolkit.output import create_output

    from robolang.pendant.history import KeptHistory, history_file
    from robolang.pendant.prompt import Prompt

    return Prompt(pendant, create_input(), create_output(), KeptHistory(history_file())).run()
