"""Commands that change the program, take changes back, and save.

A change is checked at once; the program may have errors meanwhile, but then it does not run.
"""

from pathlib import Path
from typing import TYPE_CHECKING

from robolang.pendant.command import Command, Group, Offer
from robolang.pendant.failure import failure
from robolang.pendant.words import misused, nothing, without_flag
from robolang.teaching.documents import load_documents
from robolang.teaching.program_document import change_line, delete_line, insert_line
from robolang.teaching.saving import ConflictFault

if TYPE_CHECKING:
    from robolang.pendant.pendant import Pendant

_SAVE = "save [as NAME] [--force]"
_INSERT, _EDIT = "insert LINE: TEXT", "edit LINE: TEXT"


def _insert(pendant: "Pendant", rest: str) -> None:
    row, text = _line_and_text(pendant, rest, _INSERT)
    edited, lines = insert_line(pendant.desk.documents, row, text)
    pendant.edit(edited, f"insert before line {row}", lines)


def _edit(pendant: "Pendant", rest: str) -> None:
    row, text = _line_and_text(pendant, rest, _EDIT)
    documents = pendant.desk.documents
    edited, lines = change_line(documents, row, text) if text else delete_line(documents, row)
    pendant.edit(edited, f"{'change' if text else 'delete'} line {row}", lines)


def _line_and_text(pendant: "Pendant", rest: str, form: str) -> tuple[int, str]:
    """Return the physical line, from 1, and the text after the colon."""
    where, colon, text = rest.partition(":")
    if not colon or not where.strip():
        raise misused(form, f"a line and a colon are expected, found '{rest}'")
    word = where.strip()
    # a program without lines has none to insert before
    if word.lower() == "end" and form is _INSERT:
        return pendant.rows + 1, text.rstrip()
    line = pendant.line_of(word)
    return line.source_line, _numbered(text.rstrip(), line.number) if form is _EDIT else text.rstrip()


def _numbered(text: str, number: int | None) -> str:
    """Return a text for a line, with the line number that the line has and the text leaves out."""
    # the number belongs to the line and not to its text: without it every jump to the line would be lost
    bare = number is None or not text.strip() or text.strip()[0].isdigit()
    return text.removeprefix(" ") if bare else f"{number} {text.strip()}"


def _undo(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "undo")
    pendant.output.line(f"taken back: {pendant.undo()}")


def _redo(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "redo")
    pendant.output.line(f"made again: {pendant.redo()}")


def _diff(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "diff")
    pendant.output.line(pendant.desk.diff().rstrip("\n") or "nothing is unsaved")


def _save(pendant: "Pendant", rest: str) -> None:
    rest, force = without_flag(rest, "--force")
    word, _, name = rest.partition(" ")
    path = Path(name.strip()) if word.lower() == "as" and name.strip() else None
    if rest and path is None:
        raise misused(_SAVE, f"found '{rest}'")
    try:
        files = pendant.save(path, force=force)
    except ConflictFault as fault:
        # both changes: whoever decides must see what would be lost
        pendant.output.line(f"changed on the disk:\n{fault.theirs}changed here:\n{fault.ours}".rstrip("\n"))
        raise
    pendant.output.line("saved: " + ", ".join(map(str, files)) if files else "nothing is unsaved")


def _open(pendant: "Pendant", rest: str) -> None:
    if not rest:
        raise misused("open FILE", "the name of a program is expected")
    # the question comes before the file is read: after a no nothing has happened
    if pendant.desk.unsaved and not pendant.output.ask("Unsaved changes: open another program without saving?"):
        raise failure("RBL805", f"these files have unsaved changes: {', '.join(map(str, pendant.desk.unsaved))}")
    pendant.open(load_documents(Path(rest), pendant.choice.cell, pendant.choice.robot))
    pendant.output.line(f"{rest}: the cell is in its start state, the program before its first statement")


def _check(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "check")
    pendant.check()
    pendant.output.line("no error was found in the program and its motion")


COMMANDS = (
    Command(
        word="insert",
        form=_INSERT,
        help="Insert a line before another one; insert end: TEXT adds one.",
        group=Group.EDIT,
        do=_insert,
        offers=(Offer.LINE,),
        needs_arm=False,
        more="In a program with line numbers type the new line with its number: 65 DELAY 1.",
    ),
    Command(
        word="edit",
        form=_EDIT,
        help="Put another text into a line; without a text delete it.",
        group=Group.EDIT,
        do=_edit,
        offers=(Offer.LINE,),
        needs_arm=False,
        more="In a program with line numbers a typed line with a number does the same: 60 MOVE P3, or 60 alone, which "
        "deletes the line.",
    ),
    Command(
        word="undo",
        form="undo",
        help="Take back the last change of program, points or cell.",
        group=Group.EDIT,
        do=_undo,
        needs_arm=False,
        more="back takes back what the arm and the program did.",
    ),
    Command(
        word="redo",
        form="redo",
        help="Make the change again that undo took back.",
        group=Group.EDIT,
        do=_redo,
        needs_arm=False,
    ),
    Command(
        word="diff",
        form="diff",
        help="Show what is not saved.",
        group=Group.EDIT,
        do=_diff,
        needs_arm=False,
    ),
    Command(
        word="save",
        form=_SAVE,
        help="Write program, points and cell; the program in its layout.",
        group=Group.EDIT,
        do=_save,
        words=("as", "--force"),
        offers=(Offer.FILE,),
        needs_arm=False,
    ),
    Command(
        word="open",
        form="open FILE",
        help="Open another program, in the start state of its cell.",
        group=Group.EDIT,
        do=_open,
        offers=(Offer.FILE,),
        needs_arm=False,
    ),
    Command(
        word="check",
        form="check",
        help="Check the program and the motion that it will make.",
        group=Group.EDIT,
        do=_check,
    ),
)
