"""A token that no rule accepts, the words of what could stand in its place, and the words before it.

What could follow (``accepts``) comes from the LALR table; messages never show the names of terminals.
"""

import re
from collections.abc import Iterator, Set
from dataclasses import dataclass

from robolang.core.source import Span
from robolang.syntax.keywords import INNER_WORDS, MOTIONS
from robolang.syntax.tokens import Token, span_of

END = frozenset({"$END", "COMMENT"})
VALUE = frozenset({"NUMBER", "FUNCTION"})
"""Terminals that are all accepted where a value can stand, and nowhere else."""
_SIGNS = {"RPAR": "')'", "EQ": "'='", "_COMMA": "','", "$END": "the end of the line"}
_OPERATORS = frozenset({"OR", "XOR", "AND", "NOT", "MOD", "PLUS", "MINUS", "STAR", "SLASH", "CARET"})
_LAST_WORD = re.compile(r"(?:[\w.$]+|[^\s\w])[ \t]*\Z")
_TAIL = 200
_QUOTE = 30


@dataclass(frozen=True, slots=True, kw_only=True)
class Unexpected:
    """A token where none of its kind can stand.

    ``kind`` and ``accepts`` are terminals of ``grammar.lark``; ``before`` and ``after`` are the statement's
    text around the token.
    """

    kind: str
    text: str
    span: Span
    accepts: Set[str]
    before: str
    after: str

    @property
    def is_first(self) -> bool:
        """Whether the statement starts with the token."""
        return not self.before.strip()

    @property
    def instruction(self) -> str:
        """The instruction that the token follows, in capitals; ``""`` when it is first."""
        return re.split(r"\W", self.before, maxsplit=1)[0].upper()

    @property
    def word(self) -> str:
        """The text of the token in capitals."""
        return self.text.upper()

    @property
    def head(self) -> str:
        """The text before the token without the blanks at its end."""
        return self.before.rstrip(" \t")

    @property
    def rest(self) -> str:
        """The statement from the token on."""
        return self.text + self.after

    @property
    def line(self) -> str:
        """The statement as it was typed."""
        # the place of an end is before the comment, which is in the text after it
        return self.before + ("" if self.kind in END else self.text) + self.after

    @property
    def takes_value(self) -> bool:
        """Whether a value can stand in place of the token."""
        return self.accepts >= VALUE

    @property
    def can_end(self) -> bool:
        """Whether the statement is whole before the token."""
        return "$END" in self.accepts


def unexpected(token: Token, accepts: Set[str], code: str, base: int) -> Unexpected:
    """Return a token of a line with its surroundings; ``base`` is the offset of the line's ``code`` in the source."""
    if token.type in END:
        # the place is after the last word: blanks before a comment or the end of the line are nothing to point at
        start = len(code if token.type == "$END" else code[: span_of(token).start - base])
        end = start = len(code[:start].rstrip(" \t"))
    else:
        start, end = span_of(token).start - base, span_of(token).end - base
    span = Span(base + start, base + end)
    return Unexpected(
        kind=token.type, text=str(token), span=span, accepts=accepts, before=code[:start], after=code[end:]
    )


def quote(text: str) -> str:
    """Return text for a message, cut when it is long."""
    return text if len(text) <= _QUOTE else f"{text[:_QUOTE]}… ({len(text)} characters)"


def last_word(before: str) -> str:
    """Return the word or sign at the end of a text, or ``""``."""
    # a name may have thousands of characters, and the pattern tries each of them as its start
    last = _LAST_WORD.search(before[-_TAIL:])
    return last[0].rstrip() if last else ""


def expected(found: Unexpected) -> str:
    """Return accepted terminals in words, as in ``',' or the end of the line``."""
    if found.is_first:
        return "an instruction"
    if "MOVE" in found.accepts:  # after THEN and ELSE
        return "an instruction or the end of the line" if found.can_end else "an instruction"
    *words, last = [*_operands(found), *_inner_words(found), *_signs(found)] or ["something else"]
    return f"{', '.join(words)} or {last}" if words else last


def _operands(found: Unexpected) -> Iterator[str]:
    """Yield the words for the operand that is expected, and for the parenthesis that it may begin with."""
    accepts = found.accepts
    if found.takes_value:
        yield "a point" if last_word(found.before).upper() in MOTIONS - {"DEPART"} else "a value"
        return
    if "NUMBER" in accepts:
        yield "a line number or *LABEL" if "STAR" in accepts else "a number"
    elif "NAME" in accepts:
        yield "a sensor name" if found.instruction == "SEAM" else "a name"
    if "LPAR" in accepts and not accepts & {"$END", "LESS"}:
        yield "'('"


def _inner_words(found: Unexpected) -> Iterator[str]:
    # operators can follow every value: listing them would hide the words that matter
    return (word for word in INNER_WORDS if word in found.accepts and word not in _OPERATORS)


def _signs(found: Unexpected) -> Iterator[str]:
    for kind, sign in _SIGNS.items():
        # after a value '=' compares; where it is the only sign it assigns
        if kind in found.accepts and not (kind == "EQ" and "LESS" in found.accepts):
            yield sign
