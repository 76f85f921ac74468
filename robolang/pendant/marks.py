"""What each part of a line is, for its colour: at the prompt, in listings of the program, and for Pygments.

The parts are those of the scanner that reads programs, so a word has the colour of what a run takes it for. Any text
has parts; nothing is raised.
"""

import re
from collections.abc import Iterator, Mapping
from enum import Enum
from typing import NamedTuple

from robolang.analysis.symbol_table import SymbolKind
from robolang.syntax.line_reader import line_reader
from robolang.syntax.parser import MAX_LINE
from robolang.syntax.tokens import Token

Names = Mapping[str, SymbolKind]
"""What names stand for, by their capitals."""

_NUMBER = re.compile(r"[ \t]*+([0-9]++)(?![\w.])")
_FIRST = re.compile(r"[ \t]*+([A-Za-z]\w*)(?![\w(]|[ \t]*=|\.)")
_TARGETS = frozenset({"GOTO", "GOSUB"})


class Mark(Enum):
    """What a part of a line is."""

    KEYWORD = "keyword"
    FUNCTION = "function"
    COMMAND = "command"
    NAME = "name"
    POINT = "point"
    OF_CELL = "cell"
    NUMBER = "number"
    TEXT = "text"
    COMMENT = "comment"
    LINE = "line"
    LABEL = "label"
    SIGN = "sign"
    WRONG = "wrong"


class Part(NamedTuple):
    """A part of a line: offsets ``[start, end)`` and what it is."""

    start: int
    end: int
    mark: Mark


_OF_KIND = {
    SymbolKind.POINT: Mark.POINT,
    SymbolKind.TOOL: Mark.OF_CELL,
    SymbolKind.FRAME: Mark.OF_CELL,
    SymbolKind.LOAD: Mark.OF_CELL,
    SymbolKind.SENSOR: Mark.OF_CELL,
}
_OF_TOKEN = {
    "NUMBER": Mark.NUMBER,
    "TEXT": Mark.TEXT,
    "COMMENT": Mark.COMMENT,
    "FUNCTION": Mark.FUNCTION,
    "VALUE": Mark.FUNCTION,
    **dict.fromkeys(("MALFORMED", "SUSPICIOUS", "OTHER", "HUGE"), Mark.WRONG),
}


def parts(line: str, names: Names, commands: frozenset[str] = frozenset()) -> Iterator[Part]:
    """Yield the parts of one line without blanks, in order; ``commands`` are words that a prompt takes, in capitals."""
    reader = line_reader()
    # such a line is an error as a whole; without the table of the scanner a text has no parts
    if reader is None or len(line) > MAX_LINE:
        return
    at = 0
    if number := _NUMBER.match(line):
        yield Part(number.start(1), number.end(1), Mark.LINE)
        at = number.end()
    elif (first := _FIRST.match(line)) and first[1].upper() in commands:
        yield Part(first.start(1), first.end(1), Mark.COMMAND)
        at = first.end()
    before = ""
    for token in reader.tokens(line[at:]):
        assert token.start_pos is not None and token.end_pos is not None
        yield Part(at + token.start_pos, at + token.end_pos, _mark(token, before, names))
        before = f"{before}*" if token.type == "STAR" and before in ("", *_TARGETS) else token.type


def _mark(token: Token, before: str, names: Names) -> Mark:
    """Return what a token is; ``before`` is the kind of token before it, with an asterisk where a label begins."""
    if before.endswith("*"):
        return Mark.LABEL
    if token.type == "STAR" and before in ("", *_TARGETS):
        return Mark.LABEL
    if token.type == "NUMBER" and before in _TARGETS:
        return Mark.LINE
    if token.type == "NAME":
        kind = names.get(token.upper())
        return Mark.NAME if kind is None else _OF_KIND.get(kind, Mark.NAME)
    found = _OF_TOKEN.get(token.type)
    if found is not None:
        return found
    return Mark.KEYWORD if token[:1].isalpha() else Mark.SIGN
