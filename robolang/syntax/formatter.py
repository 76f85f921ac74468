"""The formatter: one layout for all programs, which changes nothing that a program means or says.

Every line becomes ``number *LABEL statement  ' comment`` in the canonical text of ``printer``:

- Line numbers stand to the left in a column as wide as the widest of them. A line without one leaves the column blank;
  a comment outside of all blocks stands at the margin.
- The inside of IF, FOR, WHILE, SELECT, CASE and SUB is indented by two spaces, as far as ``MAX_INDENT``.
- A comment after a statement is two spaces away from it, and comments of lines that follow one another stand in one
  column. A blank line, a line of its own for a comment and a line that is kept end such a group, and so does a comment
  that the common column would move beyond ``MAX_WIDTH``.
- At most two blank lines in a row, none at the end; the line end is that of the first line.

Kept as it is: a line that does not parse, one that would become too long for the language, and what stands between
``' fmt: off`` and ``' fmt: on``, each on a line of its own. A text that would outgrow the language is not changed.

The result is a fixed point and has the same tree and the same comments (REM is capitalised). One pass over the lines
after parsing, so the time is linear in the text. Blocks are matched by their words alone and leniently: a closing word
without its head moves nothing, since ``structure`` says what is wrong with it.
"""

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

from robolang.core.diagnostics import Diagnostic
from robolang.core.source import MAX_BYTES, Source, Span
from robolang.syntax.ast import Comment, Line, Program, Unparsed
from robolang.syntax.blocks import targets, word_of
from robolang.syntax.parser import MAX_LINE, ParseResult, parse
from robolang.syntax.unparse import print_code

INDENT = "  "
MAX_INDENT = 20
"""Levels that are indented; a program in deeper blocks would be nothing but blanks."""
MAX_WIDTH = 100
MAX_BLANK = 2

_LINE_END = re.compile(r"\r\n?|\n")
_SWITCH = re.compile(r"(?:'|REM\b)[ \t]*fmt:[ \t]*(off|on)", re.IGNORECASE)
_CLOSES = {"ENDIF": "IF", "NEXT": "FOR", "WEND": "WHILE", "ENDSELECT": "SELECT", "ENDSUB": "SUB"}
_DIVIDES = {"ELSEIF": "IF", "ELSE": "IF", "CASE": "SELECT", "CASE ELSE": "SELECT"}
_HEADS = frozenset(_CLOSES.values())


@dataclass(frozen=True, slots=True, kw_only=True)
class FormatResult:
    """The formatted text, whether it differs, and the diagnostics of the parser: of the lines that were kept.

    With an error among them a command leaves the file alone.
    """

    text: str
    changed: bool
    diagnostics: tuple[Diagnostic, ...]


def format_source(source: Source, parsed: ParseResult | None = None) -> FormatResult:
    """Format a program; any text gives a result, nothing is raised. ``parsed``: of the source, where it is known."""
    parsed = parse(source) if parsed is None else parsed
    # a text that is too large has not been read: its tree is empty, and would format to nothing
    if any(item.code == "RBL106" for item in parsed.diagnostics):
        return FormatResult(text=source.text, changed=False, diagnostics=parsed.diagnostics)
    rows = _rows(source, parsed.program)
    _align(rows)
    end = line_end(source.text)
    text = "".join(f"{row.text}{end}" for row in rows)
    if (problem := outgrown(text)) is not None:
        return FormatResult(text=source.text, changed=False, diagnostics=(problem, *parsed.diagnostics))
    return FormatResult(text=text, changed=text != source.text, diagnostics=parsed.diagnostics)


def line_end(text: str) -> str:
    """Return how the first line of a text ends; LF when it has one line only."""
    found = _LINE_END.search(text)
    return found[0] if found else "\n"


def outgrown(text: str) -> Diagnostic | None:
    """Return RBL106 for a text that was made from a program and is too large to be one."""
    size = len(text.encode("utf-8", "surrogatepass"))
    if size <= MAX_BYTES:
        return None
    message = f"the rewritten program would have {size} bytes, more than {MAX_BYTES}"
    return Diagnostic(code="RBL106", message=message, span=Span(0, 0))


# --- lines -----------------------------------------------------------------------------------------------------------


@dataclass(slots=True)
class _Row:
    """A line of the result: what stands before its comment, and the comment.

    ``ends_group``: comments above and below it do not share a column.
    """

    code: str
    comment: str = ""
    ends_group: bool = False

    @property
    def text(self) -> str:
        return f"{self.code}{INDENT}{self.comment}" if self.comment else self.code


def _rows(source: Source, program: Program) -> list[_Row]:
    """Return the lines of the result, with comments two spaces after their statements."""
    width = _number_width(program)
    rows: list[_Row] = []
    blocks, blank = _Blocks(), 0
    for text, line, kept in _lines(source, program):
        # lines that are kept begin and end blocks as well
        depth = blocks.enter("" if line is None else word_of(line.statement))
        blank = 0 if kept or text.strip(" \t") else blank + 1
        if blank <= MAX_BLANK:
            row = _row(line, depth, width) if not (kept or blank) else None
            rows.append(row or _Row("" if blank else text, ends_group=True))
    del rows[len(rows) - min(blank, MAX_BLANK) :]  # not [-0:], which is all of them
    return rows


def _lines(source: Source, program: Program) -> Iterator[tuple[str, Line | None, bool]]:
    """Yield the text of every line, its tree, and whether the switches keep it as it is."""
    lines = {line.source_line: line for line in program.lines}
    on = True
    for number, span in enumerate(_line_spans(source), start=1):
        line = lines.get(number)
        switch = _switch(line)
        # a line that switches is formatted itself, on and off
        yield source.slice(span), line, not on and switch is None
        on = on if switch is None else switch


def _number_width(program: Program) -> int:
    return max((len(str(line.number)) for line in program.lines if line.number is not None), default=0)


def _line_spans(source: Source) -> tuple[Span, ...]:
    """Return the places of the lines; after the last line end there is none."""
    spans = source.line_spans
    return spans if spans[-1].start < spans[-1].end else spans[:-1]


def _switch(line: Line | None) -> bool | None:
    """Return whether a line of its own switches the formatter on or off; None when it does neither."""
    if line is None or line.comment is None or line.label is not None or line.statement is not None:
        return None
    found = _SWITCH.fullmatch(line.comment.text)
    return found[1].lower() == "on" if found else None


def _row(line: Line | None, depth: int, width: int) -> _Row | None:
    """Return a line in its layout; None when it has to stay as it is."""
    if line is None or isinstance(line.statement, Unparsed) or _names_no_line(line):
        return None
    code, comment = print_code(line), "" if line.comment is None else _comment(line.comment)
    # a comment outside of all blocks stands at the margin, also where the program has line numbers
    has_column = line.number is not None or code or depth
    margin = _margin(line.number, width if has_column else 0) + INDENT * min(depth, MAX_INDENT)
    row = _Row(f"{margin}{code}", comment) if code else _Row(f"{margin}{comment}".rstrip(), ends_group=True)
    return row if len(row.text) <= MAX_LINE else None


def _margin(number: int | None, width: int) -> str:
    """Return the column of line numbers at a line, with a blank after it; nothing where there is none."""
    return ("" if number is None else str(number)).ljust(width + 1 if width else 0)


def _names_no_line(line: Line) -> bool:
    """Return whether a target has a spelling that the tree does not keep, such as ``GOTO 1.5``."""
    return any(target.number is not None and target.number < 0 for target in targets(line.statement))


def _comment(comment: Comment) -> str:
    return comment.text if comment.text.startswith("'") else f"REM{comment.text[3:]}"


# --- blocks ----------------------------------------------------------------------------------------------------------


@dataclass(slots=True)
class _Blocks:
    """The blocks that are open, by the words of their heads; a CASE is one inside its SELECT.

    ``count`` says whether a head is among them without a search, so that any text takes linear time.
    """

    stack: list[str] = field(default_factory=list)
    count: Counter[str] = field(default_factory=Counter)

    def enter(self, word: str) -> int:
        """Return the depth of a line that takes part in a block with ``word``, and note what it opens and closes."""
        head = _DIVIDES.get(word)
        if head is not None and self._close(head):
            # what was closed is the SELECT with its last CASE; it goes on, with the next CASE in it
            if head == "SELECT":
                self._open(head)
            self._open("CASE" if head == "SELECT" else head)
            return len(self.stack) - 1
        self._close(_CLOSES.get(word, ""))
        if word not in _HEADS:
            return len(self.stack)
        self._open(word)
        return len(self.stack) - 1

    def _open(self, word: str) -> None:
        self.stack.append(word)
        self.count[word] += 1

    def _close(self, word: str) -> bool:
        """Close the innermost block of a head, and all inside it; False when there is none."""
        if not self.count[word]:
            return False
        while True:
            closed = self.stack.pop()
            self.count[closed] -= 1
            if closed == word:
                return True


# --- comments after statements --------------------------------------------------------------------------------------


def _align(rows: list[_Row]) -> None:
    """Put the comments of lines that follow one another into one column."""
    group: list[_Row] = []
    width = longest = 0
    for row in rows:
        if row.comment:
            both = max(width, len(row.code)), max(longest, len(row.comment))
            if group and sum(both) + len(INDENT) > MAX_WIDTH:
                _pad(group, width)
                group, both = [], (len(row.code), len(row.comment))
            group.append(row)
            width, longest = both
        # a statement without a comment does not end a group
        elif row.ends_group:
            _pad(group, width)
            group, width, longest = [], 0, 0
    _pad(group, width)


def _pad(group: list[_Row], width: int) -> None:
    for row in group:
        row.code = row.code.ljust(width)
