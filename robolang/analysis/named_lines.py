"""Lines of the program as people name them: by line number, by label, else by the line of the file."""

from robolang.analysis.analysis import Analysis
from robolang.syntax.ast import Line, Program
from robolang.syntax.keywords import near
from runtime.core.faults import Fault


def has_numbers(program: Program) -> bool:
    """Return whether lines of a program have line numbers, so that a number means one of them."""
    return any(line.number is not None for line in program.lines)


def name_of(program: Program, row: int) -> str:
    """Return how a line of the file is named: by its line number, in a program with line numbers."""
    numbers = (line.number for line in program.lines if line.source_line == row and line.number is not None)
    return str(next(numbers, row))


def line_of(analysis: Analysis, word: str) -> Line:
    """Return the line that a word names; ``Fault`` RBL803 where there is none."""
    program = analysis.program
    label = word.removeprefix("*").upper()
    numbered = has_numbers(program)
    for line in program.lines:
        # never both: in a numbered program 30 is line number 30, wherever that stands in the file
        place = line.number if numbered else line.source_line
        if (word.isascii() and word.isdigit() and place == int(word[:9])) or (
            line.label is not None and line.label.key == label
        ):
            return line
    raise Fault("RBL803", f"the program has no line {word}", _hint(program, word, numbered))


def _is_number(word: str) -> bool:
    # isdigit alone takes a superscript 2 for a digit, which int refuses
    return word.isascii() and word.isdigit()


def stop_of(analysis: Analysis, word: str) -> int:
    """Return the line of the file before which a program stops that shall come to a named one: it has a statement.

    A line with a comment or a label alone is no stop: the next one is. ``Fault`` RBL803 where none follows.
    """
    row = line_of(analysis, word).source_line
    for line in analysis.program.statements:
        if line.source_line >= row:
            return line.source_line
    raise Fault("RBL803", f"no statement follows line {word}", "Name a line that has a statement, or one before it.")


def _hint(program: Program, word: str, numbered: bool) -> str:
    if _is_number(word):
        rows = [line.number if numbered else line.source_line for line in program.lines]
        known = [row for row in rows if row is not None]
        if not known:
            return "The program has no lines."
        # the nearest one is the line that was meant more often than one of similar digits
        nearest = min(known, key=lambda row: abs(row - int(word[:9])))
        what = "line number" if numbered else "line of the file"
        return f"The nearest {what} is {nearest}."
    labels = [line.label.text for line in program.lines if line.label is not None]
    guess = near(word.removeprefix("*"), labels)
    return f"did you mean *{guess}?" if guess else "A line is named by its number or by a label, as *NAME."
