"""What a message says whatever its words are: its head, and the names, numbers and units that it gives.

Tests compare these and not the prose, so that wording stays free (docs/testing.md, "Tests of messages").
"""

import re

UNITS = frozenset(
    ["%", "mm", "deg", "kg", "g", "s", "ms", "m", "kHz", "Hz", "N", "Nm", "mm/s", "deg/s", "mm/s2", "deg/s2", "rad/s"]
)
"""Units of messages; a word is one right after a number only."""

_HEAD = re.compile(r"^(?:\S.*?:\d+:\d+: )?(?:error|warning|info) RBL\d{3}\b", re.M)
_QUOTED = re.compile(r"(?<!\w)'([^'\n]*)'(?!\w)")
_NUMBER = re.compile(r"[-+]?(?:\d+(?:\.\d+)?|\.\d+)(?:[eE][-+]?\d+)?")
_WORD = re.compile(r"[^\s'\"(),;:=<>\[\]│]+")


def numbers(message: str) -> list[float]:
    """Return the numbers of a message in their order: what it says whatever its words are."""
    return [float(each) for each in re.findall(r"(?<![\w.])[-+]?\d+(?:\.\d+)?|(?<=J)\d", message)]


def heads(text: str) -> list[str]:
    """Return ``file:line:column: severity CODE`` of every diagnostic that a command has printed."""
    return _HEAD.findall(text)


def fields(message: str) -> set[str]:
    """Return the names and numbers, as they are written, and the units of a message: what no other wording changes.

    A name stands between quotes, or its shape shows that it is no word of prose: keywords (``MOVE``), points and axes
    (``P9``, ``J2``), codes, keys (``mass_kg``), options (``--log``), files (``a.rbl``).
    """
    found, after_number = set(_QUOTED.findall(message)), False
    for each in _WORD.findall(message):
        word = each.rstrip(".?!")
        number = _NUMBER.fullmatch(word) is not None
        if number or _is_name(word) or (after_number and word in UNITS):
            found.add(word)
        after_number = number
    return found


def _is_name(word: str) -> bool:
    if word in ("A", "I") or not re.search(r"[A-Za-z]", word):
        return False
    return word.isupper() or bool(re.search(r"[\d_./$]|^--", word))
