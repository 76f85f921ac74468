"""Where the results of commands go: a terminal, the standard output of a script, or a list in a test."""

from dataclasses import dataclass, field
from typing import Protocol, TextIO

from robolang.core.diagnostics import safe


@dataclass(frozen=True, slots=True, kw_only=True)
class Column:
    """A column of a table: heading, unit below it, whether its cells are numbers."""

    heading: str
    unit: str = ""
    number: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Rows of text under columns; ``marks`` are rows to show in a strong colour."""

    columns: tuple[Column, ...]
    rows: tuple[tuple[str, ...], ...]
    marks: frozenset[int] = field(default_factory=frozenset)


@dataclass(frozen=True, slots=True, kw_only=True)
class Listing:
    """Rows of a program: ``first`` is the line of the file of the first one, ``current`` that of the statement that is
    next. ``numbered``: the program has line numbers of its own, so that those of the file are not shown. ``marks``:
    rows with a breakpoint."""

    rows: tuple[str, ...]
    first: int
    current: int | None = None
    numbered: bool = False
    marks: frozenset[int] = frozenset()


class Output(Protocol):
    """What commands show their results by. Texts are made safe for a terminal here."""

    def line(self, text: str) -> None:
        """Show a result: one line, or several."""

    def echo(self, text: str) -> None:
        """Show what is carried out next, where nobody has typed it on this screen."""

    def table(self, table: Table) -> None:
        """Show a table."""

    def program(self, listing: Listing) -> None:
        """Show lines of a program."""

    def problem(self, text: str) -> None:
        """Show an error or a warning, as ``core.diagnostics`` renders it."""

    def progress(self, text: str) -> None:
        """Show where motion is; the next text replaces this one."""

    def ask(self, question: str) -> bool:
        """Return the answer to a question; a script has none and gets False."""


class PlainOutput:
    """Output as plain text, for scripts: results to one stream, problems to another; nobody answers a question."""

    def __init__(self, results: TextIO, problems: TextIO) -> None:
        self._results, self._problems = results, problems

    def line(self, text: str) -> None:
        """Print a result."""
        self._print(self._results, text)

    def echo(self, text: str) -> None:
        """Print a line of the script after a prompt."""
        self._print(self._results, "\n".join(f"> {line}" for line in text.split("\n")))

    def table(self, table: Table) -> None:
        """Print a table with aligned columns."""
        self._print(self._results, as_text(table))

    def program(self, listing: Listing) -> None:
        """Print lines of a program: an arrow before the next statement, an asterisk before a breakpoint."""
        self._print(self._results, "\n".join(listing_lines(listing)))

    def problem(self, text: str) -> None:
        """Print an error or a warning."""
        self._print(self._problems, text)

    def progress(self, text: str) -> None:
        """Print nothing: a file has no line that could be replaced."""

    def ask(self, question: str) -> bool:
        """Print the question; a script cannot answer."""
        self._print(self._results, question)
        # no: an answer that nobody gave must not change anything
        return False

    @staticmethod
    def _print(stream: TextIO, text: str) -> None:
        # names and comments are other people's words and may hold what steers a terminal
        stream.write("\n".join(map(safe, text.split("\n"))) + "\n")
        stream.flush()


def listing_lines(listing: Listing) -> list[str]:
    """Return a listing as lines of text."""
    last = listing.first + len(listing.rows) - 1
    lines = []
    for row, text in enumerate(listing.rows, listing.first):
        # two characters: a script shows what is typed after one of them
        arrow = "->" if row == listing.current else "  "
        mark = "*" if row in listing.marks else " "
        # two columns of numbers would be taken for one another
        number = "" if listing.numbered else f"{row:>{len(str(last))}} "
        lines.append(f"{arrow}{mark}{number}{text}".rstrip())
    return lines


def as_text(table: Table) -> str:
    """Return a table as lines of text: headings, units where there are any, rows."""
    head = [[column.heading for column in table.columns]]
    if any(column.unit for column in table.columns):
        # a row of its own, as in the tables of ``run``: a unit beside each number would be read again and again
        head.append([column.unit for column in table.columns])
    rows = [*head, *(list(row) for row in table.rows)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(table.columns))]
    lines = [
        "  ".join(
            cell.rjust(width) if column.number else cell.ljust(width)
            for cell, width, column in zip(row, widths, table.columns, strict=True)
        ).rstrip()
        for row in rows
    ]
    rule = "  ".join("-" * width for width in widths)
    return "\n".join([*lines[: len(head)], rule, *lines[len(head) :]])
