"""Commands of the session itself: help, MANUAL and AUTO, the end."""

from typing import TYPE_CHECKING

from robolang.pendant.choice import Mode
from robolang.pendant.command import Command, Group, Offer
from robolang.pendant.failure import failure
from robolang.pendant.output import Column, Table
from robolang.pendant.words import nothing
from robolang.syntax.declaration import form
from robolang.syntax.keywords import near
from robolang.syntax.statements import STATEMENTS

if TYPE_CHECKING:
    from robolang.pendant.pendant import Pendant


def _help(pendant: "Pendant", rest: str) -> None:
    if rest:
        _explain(pendant, rest)
        return
    # under headings in the order of work, and not of the alphabet: a newcomer reads from the top
    rows = [
        (group.value if at == 0 else "", command.form, command.help)
        for group in Group
        for at, command in enumerate(pendant.commands.of(group))
    ]
    columns = (Column(heading=""), Column(heading="command"), Column(heading="meaning"))
    pendant.output.table(Table(columns=columns, rows=tuple(rows)))
    pendant.output.line(
        "Every statement of the language works too, and an expression shows its value. A line with a line number "
        "changes the program.\nhelp WORD explains a command or a statement."
    )


def _explain(pendant: "Pendant", word: str) -> None:
    command = pendant.commands.get(word)
    if command is not None:
        pendant.output.line("\n".join(filter(None, (command.form, f"  {command.help}", _indented(command.more)))))
        return
    found = [each for each in STATEMENTS if word.upper() in (each.keyword, *each.starts)]
    # help is where people look up words that they know from elsewhere, so the nearest one is named
    if not found:
        words = [each.word for each in pendant.commands] + [each.keyword for each in STATEMENTS if each.keyword]
        guess = near(word, words)
        hint = f"did you mean {guess}?" if guess else "help lists the commands."
        raise failure("RBL801", f"there is no command and no statement '{word}'", hint)
    for each in found:
        pendant.output.line(f"{form(each)}\n  {each.help}")


def _indented(text: str) -> str:
    return "\n".join(f"  {line}" for line in text.split("\n")) if text else ""


def _manual(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "manual")
    pendant.switch(Mode.MANUAL)
    pendant.output.line("MANUAL: the tool and the flange stay under 250 mm/s")


def _auto(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "auto")
    pendant.switch(Mode.AUTO)
    pendant.output.line("AUTO: moves have their programmed speeds")


def _arm(pendant: "Pendant", rest: str) -> None:
    if rest.lower() not in ("", "on", "off"):
        raise failure("RBL802", f"arm takes on or off, found '{rest}'", "The form is: arm [on|off]")
    # no question: to disarm must be as quick as a key
    pendant.armed = rest.lower() != "off"
    pendant.output.line("armed: keys move the arm" if pendant.armed else "not armed: keys do not move the arm")


def _quit(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "quit")
    pendant.leave()


COMMANDS = (
    Command(
        word="help",
        form="help [WORD]",
        help="List the commands, or explain a command or a statement.",
        group=Group.SESSION,
        do=_help,
        offers=(Offer.COMMAND,),
        needs_arm=False,
    ),
    Command(
        word="manual",
        form="manual",
        help="Keep tool and flange under 250 mm/s.",
        group=Group.SESSION,
        do=_manual,
        more="Statements at the prompt and jogs move slowly then. run, step and back switch to AUTO by themselves.",
    ),
    Command(
        word="auto",
        form="auto",
        help="Let moves have their programmed speeds.",
        group=Group.SESSION,
        do=_auto,
    ),
    Command(
        word="arm",
        form="arm [on|off]",
        help="Let keys move the arm.",
        group=Group.SESSION,
        do=_arm,
        words=("on", "off"),
        needs_arm=False,
        more="Only the key mode of jog needs it; commands and scripts are always armed.",
    ),
    Command(
        word="quit",
        form="quit",
        help="Leave the prompt; with unsaved changes it asks, a script ends with exit code 1.",
        group=Group.SESSION,
        do=_quit,
        needs_arm=False,
    ),
)
