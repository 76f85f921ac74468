"""The lexer of the language for Pygments, so that editors, Sphinx and rich show programs in colours: ``robolang``."""

from collections.abc import Iterator
from typing import ClassVar

from pygments.lexer import Lexer
from pygments.token import Comment, Error, Keyword, Name, Number, Operator, String, Text, _TokenType

from robolang.core.source import Source
from robolang.pendant.marks import Mark, parts

_OF_MARKS = {
    Mark.KEYWORD: Keyword,
    Mark.FUNCTION: Name.Builtin,
    Mark.COMMAND: Keyword.Pseudo,
    Mark.NAME: Name,
    Mark.POINT: Name.Constant,
    Mark.OF_CELL: Name.Constant,
    Mark.NUMBER: Number,
    Mark.TEXT: String,
    Mark.COMMENT: Comment.Single,
    Mark.LINE: Name.Label,
    Mark.LABEL: Name.Label,
    Mark.SIGN: Operator,
    Mark.WRONG: Error,
}


class RobolangLexer(Lexer):  # type: ignore[misc] # Pygments has no types
    """Programs of robolang (.rbl)."""

    name = "Robolang"
    aliases: ClassVar = ["robolang", "rbl"]
    filenames: ClassVar = ["*.rbl"]
    mimetypes: ClassVar = ["text/x-robolang"]

    def get_tokens_unprocessed(self, text: str) -> Iterator[tuple[int, _TokenType, str]]:
        """Yield offset, kind and text of every part; together the parts are the text."""
        at = 0
        for span in Source("", text).line_spans:
            for part in parts(text[span.start : span.end], {}):
                start, end = span.start + part.start, span.start + part.end
                if start > at:
                    yield at, Text, text[at:start]
                yield start, _OF_MARKS[part.mark], text[start:end]
                at = end
        if at < len(text):
            yield at, Text, text[at:]
