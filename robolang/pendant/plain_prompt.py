"""The prompt on a terminal that can only show lines (TERM=dumb), or whose output is a file: no colours, no menus."""

import signal
from typing import TextIO

from robolang.pendant.failure import Failure, of_fault
from robolang.pendant.foreground import Foreground
from robolang.pendant.output import PlainOutput
from robolang.pendant.pendant import Pendant
from robolang.pendant.reading import is_open
from runtime.core.faults import Fault


class AskingOutput(PlainOutput):
    """Plain output that reads the answer to a question."""

    def __init__(self, source: TextIO, results: TextIO, problems: TextIO) -> None:
        super().__init__(results, problems)
        self._source, self._shown = source, results

    def ask(self, question: str) -> bool:
        """Print the question and read the answer; nothing but yes means yes."""
        self._shown.write(f"{question} (y/n) ")
        self._shown.flush()
        return self._source.readline().strip().lower() in ("y", "yes")


def converse(pendant: Pendant, source: TextIO, shown: TextIO) -> int:
    """Let somebody work until the end; return the signal that ended it, 0 for ``quit``."""
    interrupts = pendant.interrupts
    assert isinstance(interrupts, Foreground)
    try:
        pendant.offer_recovery()
    except Fault as fault:  # a file that is damaged keeps nobody from working
        pendant.output.problem(of_fault(fault).text)
    with interrupts.ending():
        while not pendant.ended and not interrupts.lost:
            try:
                text = _read(pendant, source, shown)
                pendant.do(text or "quit")
                if not text and not source.isatty():
                    interrupts.lose(signal.SIGHUP)
            except Failure as failure:
                pendant.output.problem(failure.text)
            except KeyboardInterrupt:
                shown.write("\n")
    return interrupts.signal


def _read(pendant: Pendant, source: TextIO, shown: TextIO) -> str:
    """Return a line, or the lines of a block; ``""`` at the end: Ctrl-D, or a terminal that was closed."""
    text = ""
    while not text or is_open(text, pendant.commands):
        shown.write(". " if text else "> ")
        shown.flush()
        line = source.readline()
        if not line:
            return ""
        text += line
    return text
