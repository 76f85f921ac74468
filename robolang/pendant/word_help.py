"""Help at a word: form and meaning of a command, a statement, a function or a name, as a few lines."""

import re

from robolang.pendant.command import Commands
from robolang.pendant.known import Known
from robolang.syntax.completion import completions
from robolang.syntax.keywords import MOTIONS
from robolang.values.functions import FUNCTIONS

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
    return _of_name(key, known) or _of_function(key) or _of_statement(key, text) or of_command


def _of_name(key: str, known: Known) -> str:
    name = next((entry for entry in known.entries if entry.name.upper() == key), None)
    if name is None:
        return ""
    kind = "" if name.kind.value in name.meaning else f"{name.kind.value}: "
    return f"{name.name}\n  {kind}{name.meaning}"


def _of_function(key: str) -> str:
    function = FUNCTIONS.get(key)
    return "" if function is None else f"{function.form}\n  {function.help}"


def _of_statement(key: str, text: str) -> str:
    """Return forms and meanings of the statements that a keyword begins; of the option, where it is one of a move."""
    first = next(iter(_WORDS.findall(text)), "").upper()
    after = first if first in MOTIONS and key != first else ""
    # THEN, TO and the like are explained by their statement
    return _forms(key, after) or _forms(key, "") or _forms(first, "")


def _forms(word: str, after: str) -> str:
    found = (each for each in completions() if word in each.words.split() and each.after == after)
    return "\n".join(dict.fromkeys(f"{each.form}\n  {each.help}" for each in found))
