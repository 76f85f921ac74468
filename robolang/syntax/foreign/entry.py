"""One word of other languages: who has it, what it means there, and what to write here."""

import re
from typing import NamedTuple

KRL = "KRL"
RAPID = "RAPID"
MELFA = "MELFA"
INFORM = "INFORM"
TP = "TP"
KAREL = "KAREL"
UR = "URScript"
AS = "AS"
PAC = "PacScript"
VAL3 = "VAL3"
VPLUS = "V+"
C = "C"
PYTHON = "Python"
G_CODE = "G code"
OTHERS = "other languages"
MAKERS = {
    KRL: "KUKA",
    RAPID: "ABB",
    MELFA: "Mitsubishi",
    INFORM: "Yaskawa",
    TP: "FANUC",
    KAREL: "FANUC",
    UR: "Universal Robots",
    AS: "Kawasaki",
    PAC: "Denso",
    VAL3: "Staubli",
    VPLUS: "Staubli, Adept",
}
"""Whose language each of the robot languages is."""

# what many words mean; the tests know by these which node of the tree the statement to write has to be
JOINTS = "moves all joints together"
LINE = "moves straight"
ARC = "moves on an arc"
BEFORE = "moves straight to a distance before a point"
BACK = "moves straight back along the tool"
OUTPUT = "sets an output"
RESET = "resets an output"
INPUT = "reads an input"
TIME = "waits for a time"
CONDITION = "waits for a condition"
CLOSES = "closes the hand"
OPENS = "opens the hand"
PAYLOAD = "declares the payload"
TOOL = "selects a tool"
FRAME = "selects a frame"
SHOWS = "shows a text"
LABEL = "is a label"
GOTO = "goes to a label"
BEGINS = "begins a subroutine"
ENDS = "ends a subroutine"
CALLS = "runs a subroutine"


class Entry(NamedTuple):
    """What ``words`` (parted by blanks, in capitals) mean in ``languages``, and what to write here.

    ``means`` continues a sentence that begins with the word. ``write`` is a statement, or several, one a line; empty
    where nothing has to be written. ``note`` continues the sentence. ``missing``: this language has no such statement,
    and ``write`` is what comes nearest.
    """

    words: str
    languages: tuple[str, ...]
    means: str
    write: str = ""
    note: str = ""
    missing: bool = False

    @property
    def meaning(self) -> str:
        """The languages and the meaning there, as in ``of KRL moves straight``."""
        return f"of {listed(self.languages)} {self.means}"

    @property
    def advice(self) -> str:
        """What to write here."""
        statements = " and ".join(self.write.splitlines())
        # a number of an entry is one of many: the line that has the word has its own
        if re.search(r"\d", statements):
            statements = f"for example {statements}"
        if self.missing:
            write = f"there is none here; write {statements}" if statements else "there is none here"
        else:
            write = f"write {statements}" if statements else "remove it"
        return f"{write}; {self.note}" if self.note else write


def listed(words: tuple[str, ...]) -> str:
    """Return words as a list of a sentence."""
    *some, last = words
    return f"{', '.join(some)} and {last}" if some else last


def sentence(word: str, entries: tuple[Entry, ...]) -> str:
    """Return the hint for a word: each of its meanings, with what to write; ``""`` without a meaning."""
    # a word may stand for different things: each is named, since no program says which one its writer knows
    if not entries:
        return ""
    return f"{word.upper()} {', '.join(f'{entry.meaning}: {entry.advice}' for entry in entries)}"
