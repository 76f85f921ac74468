"""A prompt for tests: lines in, what it shows out."""

import io
from dataclasses import dataclass
from pathlib import Path

from robolang.pendant.assembly import COMMANDS
from robolang.pendant.choice import Choice
from robolang.pendant.interrupts import Interrupt
from robolang.pendant.output import PlainOutput
from robolang.pendant.pendant import Pendant
from robolang.pendant.script import play
from robolang.teaching.desk import Desk
from robolang.teaching.documents import load_documents


class Requests:
    """Interrupts that come at given cycles of a drive."""

    def __init__(self, **at: int) -> None:
        self.lost = False
        self._at = {at[name]: Interrupt[name.upper()] for name in at}
        self._cycle = 0

    def __enter__(self) -> None:
        pass

    def __exit__(self, *_: object) -> None:
        pass

    def watched(self) -> "Requests":
        return self

    def take(self) -> Interrupt | None:
        self._cycle += 1
        return self._at.get(self._cycle)


@dataclass
class Prompted:
    pendant: Pendant
    results: io.StringIO
    problems: io.StringIO
    opened: tuple[str, ...] | list[str] = ()

    def do(self, *lines: str) -> str:
        """Carry lines out and return what they show; the first that fails raises ``Failure``."""
        start = len(self.results.getvalue())
        for line in lines:
            self.pendant.do(line)
        return self.results.getvalue()[start:]


def prompt(
    program: Path | None = None, *, physics: bool = False, interrupts=None, cell: Path | None = None, picture=None
) -> Prompted:
    results, problems = io.StringIO(), io.StringIO()
    pendant = Pendant(
        Desk(load_documents(program, cell)),
        Choice(cell=cell, physics=physics, picture=picture),
        PlainOutput(results, problems),
        commands=COMMANDS,
        interrupts=interrupts or Requests(),
        scripted=True,
    )
    return Prompted(pendant, results, problems)


def played(
    text: str, program: Path | None = None, *, keep_going: bool = False, **how
) -> tuple[tuple[str, ...], str, str]:
    """Play a script; return the codes of its first failure, its results and its problems."""
    prompted = prompt(program, **how)
    codes = play(io.StringIO(text), prompted.pendant, keep_going=keep_going).codes
    return codes, prompted.results.getvalue(), prompted.problems.getvalue()
