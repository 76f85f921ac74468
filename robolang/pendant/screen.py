"""Results on a terminal: in colours, tables that fit the width, and one line that shows where motion is.

Everything is printed above the prompt, between two of its lines, so nothing has to be painted again. A line of progress
is replaced by the next one and removed before anything else is printed.
"""

import re
import textwrap
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from prompt_toolkit.formatted_text import FormattedText, StyleAndTextTuples
from prompt_toolkit.output import Output as Terminal
from prompt_toolkit.shortcuts import print_formatted_text

from robolang.core.diagnostics import safe
from robolang.pendant.colours import STYLE
from robolang.pendant.lexer import coloured
from robolang.pendant.marks import Names
from robolang.pendant.output import Listing, Table, as_text, listing_lines
from runtime.control.clock import wall_s

_HEAD = re.compile(r"(.*?)\b(error|warning|info) (RBL\d+)\b(.*)")
_EXCERPT = re.compile(r"( *\d+ \| )(.*)")
_CARETS = re.compile(r" *\| *\^+")
_HELP = re.compile(r" *(?:help|fix|note|command): ")
_LISTED = re.compile(r"(->|  )([* ])(.*)", re.DOTALL)

_SHOWN_EACH_S = 0.1
"""A line of progress is written so often at most: a program may run a thousand statements in a second of wall time."""
_FEWEST = 3
"""Columns that no table loses, however narrow the screen is."""
_NARROWEST = 16
"""Columns that the last column of a table keeps at least."""


class TerminalOutput:
    """Output on a terminal; ``names`` gives what names stand for, for colours, ``answer`` asks a question."""

    def __init__(self, terminal: Terminal, names: Callable[[], Names], answer: Callable[[str], bool]) -> None:
        self._terminal, self._names, self._answer = terminal, names, answer
        self._shown = self._running = self._note = ""
        self._shown_s = float("-inf")
        self._take: Callable[[str], None] | None = None

    @contextmanager
    def diverted(self, take: Callable[[str], None]) -> Iterator[None]:
        """Give results and problems to somebody else, who has the screen, and show no progress."""
        self._take = take
        try:
            yield
        finally:
            self._take = None

    @property
    def columns(self) -> int:
        """How many columns the terminal has."""
        return self._terminal.get_size().columns

    def line(self, text: str) -> None:
        """Print a result."""
        if self._take is not None:
            self._take(text)
            return
        for line in text.split("\n"):
            for row in self._wrapped(safe(line)):
                self._print([("", row)])

    def echo(self, text: str) -> None:
        """Print a line that is carried out, as if it had been typed."""
        for line in safe_lines(text):
            self._print([("class:prompt", "> "), *coloured(line, self._names())])

    def table(self, table: Table) -> None:
        """Print a table; its last column is broken into several lines where the terminal is narrow."""
        lines = as_text(_fitted(table, self.columns)).split("\n")
        head = 1 + any(column.unit for column in table.columns)
        for row, line in enumerate(map(safe, lines)):
            style = "class:heading" if row == 0 else "class:unit" if row <= head else ""
            strong = row - head - 1 in table.marks and len(lines) == head + 1 + len(table.rows)
            self._print([("class:strong" if strong else style, line)])

    def program(self, listing: Listing) -> None:
        """Print lines of a program in their colours, an arrow before the next statement."""
        for line in listing_lines(listing):
            found = _LISTED.match(safe(line))
            arrow, mark, rest = found.groups() if found else ("  ", " ", safe(line))
            self._print([("class:arrow", arrow), ("class:breakpoint", mark), *coloured(rest, self._names())])

    def problem(self, text: str) -> None:
        """Print an error or a warning with the colours of its parts."""
        if self._take is not None:
            self._take(text)
            return
        for line in text.split("\n"):
            # an excerpt keeps its columns, since the carets below point into it
            is_excerpt = _EXCERPT.fullmatch(safe(line)) or _CARETS.fullmatch(safe(line))
            for row in [safe(line)] if is_excerpt else self._wrapped(safe(line)):
                self._print(self._problem(row))

    def progress(self, text: str) -> None:
        """Print where motion is, in place of what this printed last."""
        self._running = text
        self._show(text)

    def tick(self, seconds: float, note: str) -> None:
        """Print again what runs, at the simulated time that it is now, s; a new ``note`` is shown at once."""
        if note != self._note:
            self._note, self._shown_s = note, float("-inf")
        # in place of the time at which it began
        begun = self._running.partition("  ")[2]
        if begun:
            self._show("  ".join(filter(None, (f"{seconds:.3f} s", note, begun))))

    def _show(self, text: str) -> None:
        now = wall_s()
        if self._take is not None:
            return
        if not text or now - self._shown_s < _SHOWN_EACH_S:
            return
        self._shown_s = now
        self._clear()
        # one column is left free: a full line would wrap
        self._shown = safe(text.split("\n")[0])[: max(0, self.columns - 1)]
        self._write([("class:progress", self._shown)], end="")

    def over(self) -> None:
        """Remove the line of progress."""
        self._running = self._note = ""
        self._clear()

    def ask(self, question: str) -> bool:
        """Ask on the terminal and return the answer."""
        self._clear()
        return self._answer(" ".join(safe_lines(question)))

    def _clear(self) -> None:
        if self._shown:
            with suppress(OSError):
                self._terminal.write_raw("\r")
                self._terminal.erase_end_of_line()
                self._terminal.flush()
            self._shown = ""

    def _print(self, fragments: StyleAndTextTuples) -> None:
        self._clear()
        self._write(fragments, end="\n")

    def _write(self, fragments: StyleAndTextTuples, end: str) -> None:
        # a terminal that has gone is found where keys are read, and the arm is stopped there
        with suppress(OSError):
            print_formatted_text(FormattedText(fragments), output=self._terminal, style=STYLE, end=end, flush=True)

    def _problem(self, line: str) -> StyleAndTextTuples:
        if found := _HEAD.match(line):
            place, severity, code, message = found.groups()
            style = "class:error" if severity == "error" else "class:warning"
            return [("", place), (style, f"{severity} {code}"), ("class:strong", message)]
        if found := _EXCERPT.fullmatch(line):
            return [("class:unit", found[1]), *coloured(found[2], self._names())]
        if _CARETS.fullmatch(line):
            return [("class:caret", line)]
        if found := _HELP.match(line):
            return [("class:help", found[0]), ("", line[found.end() :])]
        return [("", line)]

    def _wrapped(self, line: str) -> list[str]:
        """Return a line in pieces that fit, broken at blanks; those after the first are set in further."""
        if len(line) < self.columns:
            return [line]
        indent = " " * (len(line) - len(line.lstrip()))
        return textwrap.wrap(
            line.lstrip(),
            max(_NARROWEST, self.columns - 1),
            initial_indent=indent,
            subsequent_indent=f"{indent}  ",
            drop_whitespace=True,
        )


def safe_lines(text: str) -> list[str]:
    """Return the lines of a text, each safe in a terminal."""
    return list(map(safe, text.split("\n")))


def _fitted(table: Table, width: int) -> Table:
    """Return a table that fits into a width: without empty columns where it is too wide, then without its last ones.

    Of the columns that are left the last one, where it is text, is broken into several lines. A table of up to
    ``_FEWEST`` columns keeps them all.
    """
    if _width(table) >= width:
        filled = [any(row[at] for row in table.rows) for at in range(len(table.columns))]
        table = _only(table, [at for at, some in enumerate(filled) if some]) if any(filled) else table
    while len(table.columns) > _FEWEST and _width(table) - _widths(table)[-1] + _NARROWEST > width:
        table = _only(table, list(range(len(table.columns) - 1)))
    return _broken(table, width)


def _broken(table: Table, width: int) -> Table:
    """Return a table whose last column, where it is text, is broken so that its lines fit into a width."""
    if not table.rows or table.columns[-1].number or _width(table) < width:
        return table
    room = max(_NARROWEST, width - 1 - (_width(table) - _widths(table)[-1]))
    rows: list[tuple[str, ...]] = []
    for row in table.rows:
        first, *more = textwrap.wrap(row[-1], room) or [""]
        rows.append((*row[:-1], first))
        rows += [(*("" for _ in row[:-1]), line) for line in more]
    return Table(columns=table.columns, rows=tuple(rows))


def _only(table: Table, at: list[int]) -> Table:
    """Return a table with some of its columns."""
    rows = tuple(tuple(row[index] for index in at) for row in table.rows)
    return Table(columns=tuple(table.columns[index] for index in at), rows=rows, marks=table.marks)


def _widths(table: Table) -> list[int]:
    """Return the width of each column."""
    cells = [[column.heading, column.unit] for column in table.columns]
    return [max(map(len, [*own, *(row[at] for row in table.rows)])) for at, own in enumerate(cells)]


def _width(table: Table) -> int:
    """Return the width of a table, with two blanks between its columns."""
    return sum(_widths(table)) + 2 * (len(table.columns) - 1)
