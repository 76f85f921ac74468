"""What a command of the prompt is: its word, its form, what it does; and the set of all of them.

A command is the first word of a line and is never the first word of a statement, so neither hides the other. Commands
are declared once, in ``commands/``: help, completion and the page of commands are made from the declarations.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum
from typing import Any

from robolang.syntax.keywords import INSTRUCTIONS, near


class Group(Enum):
    """A heading of ``help``, in its order."""

    MOTION = "Move"
    TEACH = "Teach"
    RUN = "Run"
    EDIT = "Edit"
    SHOW = "Show"
    SESSION = "Session"


class Offer(Enum):
    """What may follow the word of a command, for completion."""

    POINT = "point"
    FRAME = "frame"
    TOOL = "tool"
    LOAD = "load"
    LINE = "line number or label"
    FILE = "file"
    COMMAND = "command"
    AXIS = "axis or direction"
    INPUT = "input"
    VALUE = "expression"


@dataclass(frozen=True, slots=True, kw_only=True)
class Command:
    """A command: ``form`` shows how it is typed, ``help`` is one line, ``more`` further lines of ``help WORD``.

    ``do`` gets the ``Pendant`` and the text after the word. ``offers`` say what can be completed after it, ``words``
    are fixed words that may follow. ``needs_arm`` False: it works before the controller is ready.
    """

    word: str
    form: str
    help: str
    group: Group
    # Any: a ``Pendant`` has the commands, so this module cannot know it
    do: Callable[[Any, str], None]
    more: str = ""
    offers: tuple[Offer, ...] = ()
    words: tuple[str, ...] = ()
    needs_arm: bool = True


_ELSEWHERE = {
    "exit": "quit",
    "bye": "quit",
    "q": "quit",
    "delete": "del",
    "remove": "del",
    "ls": "list",
    "abort": "reset",
    "stop": "hold",
    "start": "run",
    "load": "open",
    "next": "step",
    "print": "help",
}
"""Words that other prompts have, and the command that is meant."""


class Commands:
    """The commands of a prompt, by word."""

    def __init__(self, commands: tuple[Command, ...]) -> None:
        """``ValueError`` for two of one word, and for a word that begins a statement."""
        self._by_word = {command.word: command for command in commands}
        if len(self._by_word) != len(commands):
            raise ValueError("two commands have the same word")
        # checked when the prompt starts: a new statement of the language must not vanish beneath an old command
        hidden = [word for word in self._by_word if word.upper() in INSTRUCTIONS]
        if hidden:
            raise ValueError(f"these words begin statements: {', '.join(hidden)}")

    def __iter__(self) -> Iterator[Command]:
        return iter(sorted(self._by_word.values(), key=lambda each: each.word))

    def get(self, word: str) -> Command | None:
        """Return the command of a word, in any case; None for another word."""
        return self._by_word.get(word.lower())

    def of(self, group: Group) -> list[Command]:
        """Return the commands of a heading, by word."""
        return [command for command in self if command.group is group]

    def near(self, word: str) -> str:
        """Return the word of the command that resembles a word most, or ``""``."""
        if word.lower() in _ELSEWHERE:
            return _ELSEWHERE[word.lower()]
        # stricter than for keywords: many a name of a program resembles one of the short words
        return near(word, self._by_word, cutoff=0.7)
