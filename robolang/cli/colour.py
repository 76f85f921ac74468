"""Colours of findings on a terminal. Imports the standard library only.

``NO_COLOR`` (no-color.org) and ``FORCE_COLOR`` say what the terminal does not; ``--color`` sets one of the two, so that
tables and help, which rich paints, follow it too.
"""

import os
import re
from typing import TextIO

CHOICES = ("auto", "always", "never")
OPTION = "--color"

_BOLD, _RED, _YELLOW, _CYAN, _GREEN, _DIM, _PLAIN = (f"\x1b[{n}m" for n in (1, 31, 33, 36, 32, 2, 0))
_SEVERITIES = {"error": _RED, "warning": _YELLOW, "note": _CYAN}
_LABELS = {"help": _CYAN, "fix": _GREEN}
_HEAD = re.compile(r"^( *)(.*?:\d+:\d+: |)(error|warning|note)( RBL\d{3}|:)", re.MULTILINE)
_LABEL = re.compile(r"^  (help|fix):", re.MULTILINE)
_GUTTER = re.compile(r"^( *(?:\d+)? \|)(.*)$", re.MULTILINE)
_CARETS = re.compile(r"^ *\^+$")


def take_option(words: list[str]) -> str | None:
    """Take ``--color WHEN`` out of the words of a command line, wherever it stands, and obey it.

    Return a value that is none of the choices, None where there is nothing wrong.
    """
    end = words.index("--") if "--" in words else len(words)
    for at in range(1, end):
        name, equals, value = words[at].partition("=")
        if name != OPTION:
            continue
        taken = 1 if equals else 2
        value = value if equals else next(iter(words[at + 1 : end]), "")
        if value not in CHOICES:
            return value
        del words[at : at + taken]
        _obey(value)
        return None
    return None


def _obey(when: str) -> None:
    # both may be set by a CI service: the option says more
    os.environ.pop("NO_COLOR", None)
    os.environ.pop("FORCE_COLOR", None)
    if when != "auto":
        os.environ["FORCE_COLOR" if when == "always" else "NO_COLOR"] = "1"


def colours(stream: TextIO) -> bool:
    """Return whether a stream shows colours."""
    if os.environ.get("NO_COLOR"):
        return False
    if os.environ.get("FORCE_COLOR"):
        return True
    return stream.isatty() and os.environ.get("TERM") not in ("dumb", "unknown")


def painted(text: str) -> str:
    """Return findings, as ``robolang.core.diagnostics.render`` writes them, in colours."""
    text = _GUTTER.sub(_excerpt, text)
    text = _LABEL.sub(lambda found: f"  {_LABELS[found[1]]}{found[1]}:{_PLAIN}", text)
    return _HEAD.sub(_head, text)


def _head(found: re.Match[str]) -> str:
    place = f"{_BOLD}{found[2]}{_PLAIN}" if found[2] else ""
    return f"{found[1]}{place}{_BOLD}{_SEVERITIES[found[3]]}{found[3]}{found[4]}{_PLAIN}"


def _excerpt(found: re.Match[str]) -> str:
    # the line of the program keeps the colour of the terminal
    shown = f"{_RED}{found[2]}{_PLAIN}" if _CARETS.match(found[2]) else found[2]
    return f"{_DIM}{found[1]}{_PLAIN}{shown}"
