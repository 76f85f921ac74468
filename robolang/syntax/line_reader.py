"""Reads a line: an LALR automaton over the table that Lark makes of ``grammar.lark``.

Importing Lark and giving it its table takes as long as all the rest of a check of a short program. So lines are read
here, and of a line with an error the token is named where it stops, with what could follow there. Tests compare both
with Lark on every kind of text (docs/decisions/0041).

``line_table.json`` is written by ``python -m robolang.syntax.grammar``: ``pattern`` matches one token of any kind;
``rows`` has for each state a step for each kind of token and each rule: a state to go to, or the complement of the
number of a rule; ``rules`` are ``[origin, length, method, single, parts]``, see ``_reduced``.
"""

import json
import re
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

from robolang.syntax.builder import Parsed, builder
from robolang.syntax.keywords import NEW
from robolang.syntax.tokens import CLASSIFIED, Token, kind
from runtime.core.record import Record

TABLE = Path(__file__).with_name("line_table.json")
_END = "$END"

_Rule = tuple[str, int, Callable[..., Any] | None, bool, list[int | None] | None]


class Stopped(Record):
    """Where a line cannot be read on: the token, and the kinds of token of which any could follow in its place."""

    token: Token
    accepts: frozenset[str]


class LineReader:
    """The automaton with its table."""

    def __init__(self, table: dict[str, Any]) -> None:
        build = builder()
        self._match = re.compile(table["pattern"]).match
        self._ignored = frozenset(table["ignored"])
        self._start: int = table["start"]
        self._end: int = table["end"]
        self._rows: list[dict[str, int]] = table["rows"]
        self._rules: list[_Rule] = [
            (origin, length, method and getattr(build, method), single, parts)
            for origin, length, method, single, parts in table["rules"]
        ]

    def read(self, code: str, base: int) -> Parsed | Stopped:
        """Return what the rules of a line make of it; ``base`` is the offset of the code in the source."""
        states: list[int] = [self._start]
        values: list[Any] = []
        at = 0
        while at < len(code):
            found = self._match(code, at)
            assert found is not None and found.lastgroup is not None  # OTHER is every character but a blank
            name = found.lastgroup
            if name not in self._ignored:
                token = Token(found[0])
                if name in CLASSIFIED:
                    name = kind(name, token)
                    # a keyword later than edition 1 is a name wherever the grammar has no keyword (decision 0029)
                    if name in NEW and name not in self._rows[states[-1]]:
                        name = "NAME"
                token.type, token.start_pos, token.end_pos = name, base + at, base + found.end()
                if not self._shift(name, token, states, values):
                    return Stopped(token=token, accepts=self._accepts(states))
            at = found.end()
        if self._shift(_END, None, states, values):
            result: Parsed = values[-1]
            return result
        token = Token()
        token.type, token.start_pos, token.end_pos = _END, base + at, base + at
        return Stopped(token=token, accepts=self._accepts(states))

    def tokens(self, code: str) -> Iterator[Token]:
        """Yield the tokens of any text of one line, whether they make a statement or not, for colours."""
        at = 0
        while at < len(code):
            found = self._match(code, at)
            # the pattern takes every character, see read
            assert found is not None and found.lastgroup is not None
            name = found.lastgroup
            if name not in self._ignored:
                token = Token(found[0])
                token.type = kind(name, token) if name in CLASSIFIED else name
                token.start_pos, token.end_pos = at, found.end()
                yield token
            at = found.end()

    def following(self, code: str) -> frozenset[str]:
        """Return the kinds of token of which one can stand after a text; none where the text has an error."""
        probe = f"{code} ?"
        # no rule takes this sign, so reading stops at it, if not before
        read = self.read(probe, 0)
        if isinstance(read, Stopped) and read.token.end_pos == len(probe):
            return read.accepts
        return frozenset()

    def _accepts(self, states: list[int]) -> frozenset[str]:
        """Return the kinds of token that can follow."""
        # a row has a step for kinds that fail only after reductions too: each is gone through to its shift
        return frozenset(name for name in self._rows[states[-1]] if name.isupper() and self._can_follow(name, states))

    def _can_follow(self, name: str, states: list[int]) -> bool:
        states = states.copy()
        while (step := self._rows[states[-1]].get(name)) is not None and step < 0:
            origin, length, *_ = self._rules[~step]
            if length:
                del states[-length:]
            states.append(self._rows[states[-1]][origin])
            if name == _END and states[-1] == self._end:
                return True
        return step is not None

    def _shift(self, name: str, token: Token | None, states: list[int], values: list[Any]) -> bool:
        """Reduce until the token can follow, and go there; False where it cannot. The end stops in the end state."""
        rows = self._rows
        while True:
            step = rows[states[-1]].get(name)
            if step is None:
                return False
            if step >= 0:
                states.append(step)
                values.append(token)
                return True
            origin, length, method, single, parts = self._rules[~step]
            value: Any = []
            # a slice from -0 would be the whole list
            if length:
                value = values[-length:]
                del states[-length:], values[-length:]
            states.append(rows[states[-1]][origin])
            values.append(_reduced(value, method, single, parts))
            if token is None and states[-1] == self._end:
                return True


def _reduced(
    children: list[Any], method: Callable[..., Any] | None, single: bool, parts: list[int | None] | None
) -> Any:
    """Return what a rule makes of its children.

    ``parts``: which of them are kept, in order; None is an optional part that is not there, the complement of a number
    a list that is taken apart; all of them without it. ``single``: one child alone stands for itself. ``method`` builds
    the node; a rule without one only groups its children.
    """
    kept = children
    if parts is not None:
        kept = []
        for part in parts:
            if part is None:
                kept.append(None)
            elif part >= 0:
                kept.append(children[part])
            elif kept:
                kept += children[~part]
            else:
                kept = children[~part]  # grown in place: copied at each step, a long chain would take quadratic time
    if single and len(kept) == 1:
        return kept[0]
    return kept if method is None else method(*kept)


@cache
def line_reader() -> LineReader | None:
    """Return the reader; None without a table that can be read: Lark parses every line then."""
    try:
        return LineReader(json.loads(TABLE.read_text(encoding="utf-8")))
    except (OSError, ValueError, LookupError):
        return None
