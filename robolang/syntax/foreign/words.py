"""All words of other languages by name."""

from collections.abc import Iterable
from functools import cache

from robolang.syntax.foreign import motion_words, program_words
from robolang.syntax.foreign.entry import Entry

_Words = dict[str, tuple[Entry, ...]]


def _by_word(entries: Iterable[Entry]) -> _Words:
    found: _Words = {}
    for entry in entries:
        for word in entry.words.split():
            found[word] = (*found.get(word, ()), entry)
    return found


@cache
def instructions() -> _Words:
    """Return what can begin a statement of another language."""
    motion = (*motion_words.MOVES, *motion_words.SETTINGS, *motion_words.CELL)
    return _by_word((*motion, *program_words.SIGNALS, *program_words.CONTROL, *program_words.DATA))


@cache
def functions() -> _Words:
    """Return what stands for a function, or for an input that is read as one."""
    # an input is assigned to a variable here, and elsewhere read as a variable
    inputs = [entry for entry in program_words.SIGNALS if entry.write.startswith("x = IN")]
    return _by_word((*program_words.FUNCTIONS, *inputs))


@cache
def values() -> _Words:
    """Return what stands for a number."""
    return _by_word(program_words.VALUES)


@cache
def own() -> _Words:
    """Return the words of this language that mean something else in another one."""
    return _by_word(program_words.OWN)


def meanings(word: str) -> tuple[Entry, ...]:
    """Return everything that a word means in other languages."""
    key = word.upper()
    of = (own(), instructions(), functions(), values())
    return tuple(dict.fromkeys(entry for table in of for entry in table.get(key, ())))


def every() -> tuple[Entry, ...]:
    """Return all entries, each once."""
    of = (own(), instructions(), functions(), values())
    return tuple(dict.fromkeys(entry for table in of for entries in table.values() for entry in entries))
