"""Corrections of findings of the parser and the checker that are certain.

Every fix here is safe: the text was refused, or one of two equal parts of it was, and there is one thing that it can
have meant. What looks certain and is not gets none: the nearest instruction to a misspelt one is another motion, and
``800mm`` is a length only if a length stands there. A fix is worked out from the code of a finding, its place and the
text, not from its message. Findings that bring their own fix keep it.
"""

import re
from collections.abc import Callable, Iterator

from robolang.core.diagnostics import Diagnostic, Edit, Fix
from robolang.core.source import Source, Span
from robolang.syntax.keywords import COMPONENTS, INSTRUCTIONS, OPTIONS, look_alike
from robolang.syntax.parser import parse

# zero width space, non-joiner and joiner, word joiner, byte order mark
_NO_WIDTH = "\u200b\u200c\u200d\u2060\ufeff"
_STARTS = INSTRUCTIONS | {"REM"}
_FOLLOWS_COMMA = frozenset({*OPTIONS, *COMPONENTS, "TIMEOUT", "GOTO"})
_LINE_END = re.compile(r"\r\n?|\n")
_REM = re.compile(r"(?<!\w)REM(?!\w)", re.IGNORECASE)


def with_fix(diagnostic: Diagnostic, source: Source) -> Diagnostic:
    """Return a finding with its fix, where there is one."""
    make = _FIXES.get(diagnostic.code)
    fix = diagnostic.fix if make is None or diagnostic.fix is not None else make(diagnostic, source)
    line = source.line_spans[source.place(diagnostic.span.start).line - 1]
    if fix is not None and _joins_line_ends(fix, line, source.text):
        fix = None
    return diagnostic if fix is diagnostic.fix else diagnostic.replaced(fix=fix)


def _joins_line_ends(fix: Fix, line: Span, text: str) -> bool:
    """Return whether a fix empties a line between a CR and a LF, which would become one line end, CR LF."""
    if text[line.start - 1 : line.start] != "\r" or text[line.end : line.end + 1] != "\n":
        return False
    removed = sum(edit.span.end - edit.span.start for edit in fix.edits if not edit.text)
    return removed == line.end - line.start


def _look_alikes(diagnostic: Diagnostic, source: Source) -> Fix | None:
    """Retype every look-alike from the place to the end of the statement; RBL103 names only the first of a line."""
    end = _line_end(source, diagnostic.span.start)
    edits = tuple(_twins(source.text, diagnostic.span.start, end))
    if not edits or edits[0].span.start != diagnostic.span.start:
        return None
    return Fix(
        title="replace it with the ASCII character" if edits[0].text else "remove the invisible character", edits=edits
    )


def _twins(text: str, start: int, end: int) -> Iterator[Edit]:
    """Yield the edits up to where a comment starts; what stands between double quotes is left alone."""
    quoted = False
    for at in range(start, end):
        character = text[at]
        twin = _twin(character)
        # in a text the character may be meant; a typographic quote ends the text as a plain one does
        if twin is not None and (not quoted or twin == '"'):
            yield Edit(span=Span(at, at + 1), text=twin)
        seen = character if twin is None else twin
        if seen == '"':
            quoted = not quoted
        # a comment may hold any letter
        elif not quoted and (seen == "'" or _REM.match(text, at)):
            return


def _twin(character: str) -> str | None:
    """Return the ASCII character that stands for another one, ``""`` for one that takes no room, else None."""
    if character.isascii():
        return None
    if character in _NO_WIDTH:
        return ""
    twin = look_alike(character)
    return twin if twin and twin.isprintable() else None


def _line_ends(diagnostic: Diagnostic, source: Source) -> Fix | None:
    ends = [(Span(*end.span()), end[0]) for end in _LINE_END.finditer(source.text)]
    # there are two at least, since RBL110 is about line ends that differ
    first = ends[0][1]
    name = {"\n": "LF", "\r\n": "CR LF", "\r": "CR"}[first]
    edits = tuple(Edit(span=span, text=first) for span, end in ends if end != first)
    return Fix(title=f"end every line with {name}, as the first one does", edits=edits)


def _comma(diagnostic: Diagnostic, source: Source) -> Fix | None:
    """Add a comma before an option or before TIMEOUT and GOTO of a WAIT, when the line can be read beyond it then."""
    at = diagnostic.span.start
    if source.slice(diagnostic.span).upper() not in _FOLLOWS_COMMA:
        return None
    line = source.line_spans[source.place(at).line - 1]
    before = source.text[line.start : at].rstrip(" \t")
    if before.endswith(",") or not _reads(f"{before}, {source.text[at : line.end]}", len(before) + 2):
        return None
    edit = Edit(span=Span(line.start + len(before), line.start + len(before)), text=",")
    return Fix(title="add the comma", edits=(edit,))


def _number(diagnostic: Diagnostic, source: Source) -> Fix | None:
    """Remove underscores between digits; part a line number from the instruction that is glued to it."""
    span, text = diagnostic.span, source.slice(diagnostic.span)
    if re.fullmatch(r"[0-9]+(?:_[0-9]+)+(?:\.[0-9]*)?", text):
        return Fix(title="remove the underscores", edits=(Edit(span=span, text=text.replace("_", "")),))
    # nine digits: the longest line number
    glued = re.fullmatch(r"([0-9]{1,9})([A-Za-z]+)", text)
    line = source.line_spans[source.place(span.start).line - 1]
    first = not source.text[line.start : span.start].strip()
    # 10MOVE is a number and an instruction, 800mm is not
    if glued is None or not first or glued[2].upper() not in _STARTS:
        return None
    edit = Edit(span=Span(span.start + len(glued[1]), span.start + len(glued[1])), text=" ")
    return Fix(title="add a space after the line number", edits=(edit,))


def _repeated(diagnostic: Diagnostic, source: Source) -> Fix | None:
    """Remove an option that repeats the first one."""
    if not diagnostic.related:
        return None
    first, second = (_words(source.slice(span)) for span in (diagnostic.related[0].span, diagnostic.span))
    line = source.line_spans[source.place(diagnostic.span.start).line - 1]
    before = source.text[line.start : diagnostic.span.start].rstrip(" \t")
    if first != second or not before.endswith(","):
        return None
    start = line.start + len(before[:-1].rstrip(" \t"))
    return Fix(title="remove the second option", edits=(Edit(span=Span(start, diagnostic.span.end), text=""),))


def _words(text: str) -> list[str]:
    return text.upper().split()


def _reads(line: str, at: int) -> bool:
    """Return whether a line can be read beyond the word that starts at an offset."""
    # an error at the word itself shows that a missing comma was not the reason
    return all(found.span.start > at for found in parse(Source("", line)).diagnostics)


def _line_end(source: Source, offset: int) -> int:
    return source.line_spans[source.place(offset).line - 1].end


_FIXES: dict[str, Callable[[Diagnostic, Source], Fix | None]] = {
    "RBL103": _look_alikes,
    "RBL110": _line_ends,
    "RBL111": _comma,
    "RBL115": _number,
    "RBL118": _repeated,
}
