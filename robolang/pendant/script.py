"""The prompt without a terminal: lines are read, carried out and answered, one after the other.

So a session is a script, and a script is a test: it stops at the first line that fails, or goes on with
``--keep-going``; either is known by the exit code.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from robolang.pendant.failure import Failure
from robolang.pendant.pendant import Pendant
from robolang.pendant.reading import is_open


@dataclass(frozen=True, slots=True)
class Played:
    """What has become of a script: the codes of the errors of the first line that failed, () where none did."""

    codes: tuple[str, ...] = ()


def play(lines: Iterable[str], pendant: Pendant, *, keep_going: bool = False) -> Played:
    """Carry out the lines of a script, each shown before its result."""
    played = Played()
    for text in _entries(lines, pendant):
        pendant.output.echo(text)
        try:
            pendant.do(text)
        except Failure as error:
            pendant.output.problem(error.text)
            # the first failure decides the exit code: those after it may follow from it
            played = played if played.codes else Played(error.codes)
            if not keep_going:
                break
        if pendant.ended or pendant.interrupts.lost:
            return played
    if keep_going or not played.codes:
        played = _left(pendant, played)
    return played


def _left(pendant: Pendant, played: Played) -> Played:
    """End a script that has no quit at its end: it fails all the same where something is unsaved."""
    try:
        pendant.leave()
    except Failure as error:
        pendant.output.problem(error.text)
        return played if played.codes else Played(error.codes)
    return played


def _entries(lines: Iterable[str], pendant: Pendant) -> Iterator[str]:
    """Yield what is carried out at once: a line, or the lines of a block."""
    # lazily: a line that ends the script leaves the rest of the input unread
    gathered: list[str] = []
    for line in lines:
        # a byte order mark, which some editors write before the first line
        gathered.append(line.removeprefix("\ufeff").rstrip("\r\n"))
        text = "\n".join(gathered)
        if not is_open(text, pendant.commands):
            gathered.clear()
            yield text
    if gathered:  # a block that is not closed: its error is shown
        yield "\n".join(gathered)
