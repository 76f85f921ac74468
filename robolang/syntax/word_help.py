"""What a word means, in this language and in others, as a few lines of text."""

import re

from robolang.syntax.completion import Completion, completions
from robolang.syntax.declaration import form
from robolang.syntax.foreign.entry import MAKERS, Entry, listed
from robolang.syntax.foreign.shapes import FIRST
from robolang.syntax.foreign.words import meanings
from robolang.syntax.foreign_calls import unknown
from robolang.syntax.foreign_lines import proposal
from robolang.syntax.other_languages import sign
from robolang.syntax.statements import STATEMENTS
from robolang.values.functions import FUNCTIONS


def explained(text: str) -> str:
    """Return what a word, or a line of another language, means; ``""`` for what means nothing."""
    word = text.strip()
    # a word first: T1 or a lone sign may have the shape of a line too
    of_word = "\n\n".join(filter(None, (of_function(word), of_statement(word), of_other_languages(word))))
    return of_word or _of_inner_word(word) or _of_line(word) or _of_sign(word) or _of_first_word(word) or _of_call(word)


def own_words() -> frozenset[str]:
    """Return the words of this language, in capitals."""
    return frozenset(FUNCTIONS).union(*(each.words.split() for each in completions()))


def of_function(word: str) -> str:
    """Return form and meaning of a function, or ``""``."""
    function = FUNCTIONS.get(word.upper())
    return "" if function is None else f"{function.form}\n  {function.help}"


def of_statement(word: str, after: str = "") -> str:
    """Return forms and meanings of what a keyword begins, or ``""``.

    ``after`` is the first word of the statement whose option it is; without it, statements come before options.
    """
    key = word.upper()
    if after:
        return _forms([each for each in completions() if key in each.words.split() and each.after == after])
    found = [each for each in completions() if key in each.words.split()]
    # FINE and TIME begin no statement: they are options of every move, and of all moves the same but for SPEED
    return _forms([each for each in found if not each.after] or found)


def _forms(found: list[Completion]) -> str:
    return "\n".join(dict.fromkeys(f"{each.form}\n  {each.help}" for each in found))


def _of_inner_word(word: str) -> str:
    """Return the statements that have a word in them, as THEN and TILT, or ``""``."""
    key = word.upper()
    found = [each for each in STATEMENTS if key in each.inner_words and not each.options]
    return "\n".join(dict.fromkeys(f"{form(each)}\n  {each.help}" for each in found))


def of_other_languages(word: str) -> str:
    """Return what a word means in other languages, and what to write here, or ``""``."""
    return "\n".join(f"{word.upper()} {_of(each)}\n  {each.advice}" for each in meanings(word))


def _of(entry: Entry) -> str:
    return f"of {_with_makers(entry.languages)} {entry.means}"


def _with_makers(languages: tuple[str, ...]) -> str:
    """Return languages with whose they are, as in ``KRL (KUKA)``."""
    return listed(tuple(f"{each} ({MAKERS[each]})" if each in MAKERS else each for each in languages))


def _of_sign(text: str) -> str:
    """Return what stands for a sign of other languages, or ``""``; of a text, only where it is nothing but a sign."""
    hint = sign(text) if re.fullmatch(r"[^\w\s$]{1,2}", text) else ""
    return f"{text}\n  {hint}" if hint else ""


def _of_call(text: str) -> str:
    """Return what a call as of ``pick()`` is here, or ``""``."""
    call = unknown(text)
    return f"{text}\n  {call.advice}" if call else ""


def _of_first_word(text: str) -> str:
    """Return what the word that a line begins with means, as a check says for a line that it knows no more of."""
    first = FIRST.match(text)
    # joint-limits is the misspelt name of a code
    if first is None or first.end() == len(text) or re.fullmatch(r"[\w-]+", text):
        return ""
    # $IN[1]: a system variable of KRL has its name after the sign
    if first[1].startswith("$") and first[1] != "$":
        return f"{text}\n  {sign(text)}"
    return "\n\n".join(filter(None, (of_function(first[1]), of_statement(first[1]), of_other_languages(first[1]))))


def _of_line(text: str) -> str:
    """Return what to write for a line of another language, or ``""``."""
    found = proposal(text)
    return f"{text}\n  is a line of {_with_makers(found.shape.languages)}\n  {found.advice}" if found else ""
