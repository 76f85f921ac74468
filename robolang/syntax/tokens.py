"""The tokens of a line: the text of each with its kind and its place in the source."""

import math

from robolang.core.source import Span
from robolang.syntax.keywords import kind_of


class Token(str):
    """A token: its text, with the name of its terminal and its offsets in the source. Lark's tokens have the same."""

    __slots__ = ("end_pos", "start_pos", "type")
    type: str
    start_pos: int | None
    end_pos: int | None


def span_of(token: Token) -> Span:
    """Return the place of a token."""
    assert token.start_pos is not None and token.end_pos is not None
    return Span(token.start_pos, token.end_pos)


def kind(terminal: str, text: str) -> str:
    """Return the kind of a word, a number or a stray character whose pattern is that of ``terminal``."""
    # the patterns take letters and digits of every script: a name in Cyrillic is one token, and one error
    if not text.isascii():
        return "SUSPICIOUS"
    if terminal == "NAME":
        return kind_of(text) or terminal
    return "HUGE" if terminal == "NUMBER" and not math.isfinite(float(text)) else terminal


CLASSIFIED = ("NAME", "NUMBER", "MALFORMED", "OTHER")
"""Terminals whose tokens get their kind by ``kind``."""
