"""Numbers as text outside of programs: the forms of XML Schema's ``double`` and no others.

Python's ``float`` also reads 1_000, the digits of every script and spaces of Unicode, which no other reader of robot
files takes for a number; a file would be another arm elsewhere. Used by the readers of XML files, by VAL and by the
command line. Standard library only.
"""

import re

_DOUBLE = re.compile(r"[+-]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|(?i:inf|infinity|nan))")


def number_in(text: str) -> float | None:
    """Return the number of a text, NaN and infinity included; None for a text that is not a number."""
    return float(text) if _DOUBLE.fullmatch(text) else None


def why_none(text: str) -> str:
    """Return why a text that resembles a number is none, to follow its mention; empty for any other text."""
    # the three that other tools and languages accept; each gets its own reason
    if any(character.isdigit() and not "0" <= character <= "9" for character in text):
        return ": the digits of a number are 0 to 9"
    if re.fullmatch(r"[0-9][0-9_.]*", text) and "_" in text:
        return ": a number has no '_'"
    if re.fullmatch(r"[+-]?[0-9]+,[0-9]+", text):
        return ": the decimal sign is a point"
    return ""
