"""The command that records what is done as a program."""

from pathlib import Path
from typing import TYPE_CHECKING

from robolang.pendant.command import Command, Group, Offer

if TYPE_CHECKING:
    from robolang.pendant.pendant import Pendant


def _record(pendant: "Pendant", rest: str) -> None:
    recording = pendant.recording
    if rest:
        recording.begin(Path(rest), pendant)
        pendant.output.line(f"{recording.path}: what has been done since the start state is recorded, and what follows")
    elif recording.path is None:
        pendant.output.line("nothing is recorded; record FILE begins")
    else:
        recording.write(pendant)
        pendant.output.line(f"{recording.path}: {recording.statements} lines; nothing more is recorded")
        recording.stop()


COMMANDS = (
    Command(
        word="record",
        form="record [FILE]",
        help="Write what is done as a program that does it again; without FILE stop.",
        group=Group.SESSION,
        do=_record,
        offers=(Offer.FILE,),
        needs_arm=False,
        more="The program begins at the start state of the cell. It is written after every line, with its points and\n"
        "its cell beside it. What back takes back is taken out again; again begins anew, and record alone, before it,\n"
        "keeps what is there.",
    ),
)
