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
    if command is not None and text.lstrip().lower().startswith(command.word):
        more = f"\n  {command.more}" if command.more else ""
        return f"{command.form}\n  {command.help}{more}"
    if name := next((entry for entry in known.entries if entry.name.upper() == key), None):
        kind = "" if name.kind.value in name.meaning else f"{name.kind.value}: "
        return f"{name.name}\n  {kind}{name.meaning}"
    if function := FUNCTIONS.get(key):
        return f"{function.form}\n  {function.help}"
    return "\n".join(_of_statement(key, text)) or (f"{command.form}\n  {command.help}" if command else "")


def _of_statement(key: str, text: str) -> list[str]:
    """Return forms and meanings of the statements that a keyword begins; of the option, where it is one of a move."""
    first = next(iter(_WORDS.findall(text)), "").upper()
    found = [each for each in completions() if key in each.words.split()]
    after = first if first in MOTIONS and key != first else ""
    found = [each for each in found if each.after == after] or [each for each in found if not each.after]
    forms = dict.fromkeys(f"{each.form}\n  {each.help}" for each in found)
    if not forms and first:
        # THEN, TO and the like are explained by their statement
        forms = dict.fromkeys(f"{each.form}\n  {each.help}" for each in completions() if each.words == first)
    return list(forms)
