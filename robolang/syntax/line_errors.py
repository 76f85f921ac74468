"""Has Lark parse a line that ``line_reader`` cannot read, and says what is wrong with it.

Imported for the first line with an error: Lark takes longer to import than a short program to check.
"""

from typing import cast

import lark
from lark import UnexpectedToken

from robolang.core.diagnostics import Diagnostic
from robolang.core.source import Span
from robolang.syntax.builder import Parsed
from robolang.syntax.grammar import line_parser
from robolang.syntax.keywords import NEW
from robolang.syntax.syntax_errors import explain
from robolang.syntax.tokens import Token, span_of
from robolang.syntax.unexpected import Unexpected


def parsed_by_lark(code: str, base: int) -> Parsed | Diagnostic:
    """Return what the rules of a line make of it, or why they cannot; ``base`` is its offset in the source."""
    session = line_parser().parse_interactive(code, start="start")
    token = None
    try:
        # The lexer sees one line; shifting its tokens here makes every place one of the source.
        for token in session.iter_parse():
            token.start_pos = base + (token.start_pos or 0)
            token.end_pos = base + (token.end_pos or 0)
            if token.type in NEW and token.type not in session.choices():  # type: ignore[no-untyped-call]
                token.type = "NAME"
        result: Parsed = session.feed_eof(token)  # type: ignore[no-untyped-call]
    except UnexpectedToken as error:
        # not ``choices``: of an LALR table these include kinds that fail after the next reduction
        accepts: set[str] = session.accepts()  # type: ignore[no-untyped-call]
        return explain(_unexpected(error.token, accepts, code, base))
    return result


def _unexpected(found: lark.Token, accepts: set[str], code: str, base: int) -> Unexpected:
    token = cast("Token", found)
    if token.type in ("$END", "COMMENT"):
        start = len(code if token.type == "$END" else code[: span_of(token).start - base])
        end = start = len(code[:start].rstrip(" \t"))
    else:
        start, end = span_of(token).start - base, span_of(token).end - base
    span = Span(base + start, base + end)
    return Unexpected(
        kind=token.type, text=str(token), span=span, accepts=accepts, before=code[:start], after=code[end:]
    )
