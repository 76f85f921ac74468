"""Help at a word: form and meaning of a command, a statement, a function or a name, as a few lines."""

import re

from robolang.pendant.command import Commands
from robolang.pendant.known import Known
from robolang.syntax.keywords import MOTIONS
from robolang.syntax.word_help import of_function, of_other_languages, of_statement

_WORDS = re.compile(r"[A-Za-z_]\w*\$?")


def word_at(text: str, cursor: int) -> str:
    """Return the word that the cursor is in or right after; else the one before it; ``""`` where there is none."""
    before = [found for found in _WORDS.finditer(text) if found.start() <= cursor]
    return before[-1][0] if before else ""


def explained(word: str, text: str, known: Known, commands: Commands) -> str:
    """Return what a word means in a line ``text``; ``""`` for a word that means nothing."""
    key = word.upper()
    command = commands.get(word)
    of_command = "" if command is None else "\n  ".join(filter(None, (command.form, command.help, command.more)))
    if text.lstrip().lower().startswith(word.lower()) and of_command:
        return of_command
    own = _of_name(key, known) or of_function(key) or _of_statement(key, text) or of_command
    return own or of_other_languages(word)


def _of_name(key: str, known: Known) -> str:
    name = next((entry for entry in known.entries if entry.name.upper() == key), None)
    if name is None:
        return ""
    kind = "" if name.kind.value in name.meaning else f"{name.kind.value}: "
    return f"{name.name}\n  {kind}{name.meaning}"


def _of_statement(key: str, text: str) -> str:
    """Return forms and meanings of the statements that a keyword begins; of the option, where it is one of a move."""
    first = next(iter(_WORDS.findall(text)), "").upper()
    after = first if first in MOTIONS and key != first else ""
    # THEN, TO and the like are explained by their statement
    of_option = of_statement(key, after) if after else ""
    return of_option or of_statement(key) or of_statement(first)
