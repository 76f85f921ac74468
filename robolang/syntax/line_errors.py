"""Has Lark parse a line, and says what is wrong with it.

Imported where the table of ``line_reader`` cannot be read, and by the tests that compare the two: Lark takes longer to
import than a short program to check.
"""

from typing import cast

from lark import UnexpectedToken

from robolang.core.diagnostics import Diagnostic
from robolang.syntax.builder import Parsed
from robolang.syntax.grammar import line_parser
from robolang.syntax.keywords import NEW
from robolang.syntax.syntax_errors import explain
from robolang.syntax.tokens import Token
from robolang.syntax.unexpected import unexpected


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
        return explain(unexpected(cast("Token", error.token), accepts, code, base))
    return result
