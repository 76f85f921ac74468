"""Colours of what is typed at the prompt, and of listings, as fragments of prompt_toolkit."""

from collections.abc import Callable

from prompt_toolkit.document import Document
from prompt_toolkit.formatted_text import StyleAndTextTuples
from prompt_toolkit.lexers import Lexer

from robolang.pendant.colours import style_of
from robolang.pendant.marks import Names, parts


def coloured(line: str, names: Names, commands: frozenset[str] = frozenset()) -> StyleAndTextTuples:
    """Return one line as fragments of style and text; together they are the line."""
    fragments: StyleAndTextTuples = []
    at = 0
    for part in parts(line, names, commands):
        if part.start > at:
            fragments.append(("", line[at : part.start]))
        fragments.append((style_of(part.mark), line[part.start : part.end]))
        at = part.end
    if at < len(line):
        fragments.append(("", line[at:]))
    return fragments


class PromptLexer(Lexer):
    """The colours of the prompt; ``names`` gives what the names of the program stand for, as far as they are known."""

    def __init__(self, names: Callable[[], Names], commands: frozenset[str]) -> None:
        self._names, self._commands = names, commands

    def lex_document(self, document: Document) -> Callable[[int], StyleAndTextTuples]:
        """Return the fragments of a line of the text by its number."""
        names, lines = self._names(), document.lines

        def line_of(number: int) -> StyleAndTextTuples:
            # the screen may still paint a line that has been deleted
            return coloured(lines[number], names, self._commands) if number < len(lines) else []

        return line_of
