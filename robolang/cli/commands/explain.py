"""``robolang explain CODE``: what a code means and what to do about it."""

import difflib
from typing import TYPE_CHECKING, Annotated

from robolang.cli.errors import reported
from robolang.cli.options import Argument
from robolang.cli.usage import OptionValueError

if TYPE_CHECKING:
    from robolang.cli.console import Console
    from runtime.core.faults import Code


_Code = Annotated[str | None, Argument("CODE", "Code such as RBL412, or its name; default: list all codes.")]


def explain(code: _Code) -> None:
    """Explain the code of an error, a warning or an alarm, and what to do.

    Example: robolang explain RBL412

    Exit codes: 0 done; 2 there is no such code.
    """
    import robolang.lint.registry  # noqa: F401 - every code there is
    from runtime.core.faults import all_codes

    with reported():
        entries = all_codes()
        if code is None:
            _print_all(entries)
        else:
            _print(_find(code, entries))


def _find(text: str, entries: "list[Code]") -> "Code":
    """Return the entry of a code, its number or its name, in any case; a usage error with the nearest otherwise."""
    word = text.strip().upper()
    # robolang explain 412
    word = f"RBL{word}" if word.isdecimal() else word
    for entry in entries:
        if word in (entry.code, entry.name.upper()):
            return entry
    near = _near(word, entries)
    hint = f"did you mean {near}?" if near else "robolang explain lists them"
    raise OptionValueError("CODE", f"there is no code '{text}'; {hint}")


def _near(word: str, entries: "list[Code]") -> str:
    """Return the code or the name that a misspelt word resembles most; empty without one."""
    digits = word.removeprefix("RBL")
    if digits.isascii() and digits.isdecimal() and len(digits) == 3:
        return ""  # a whole code: those with near numbers mean other things
    known = [form for entry in entries for form in (entry.code, entry.name.upper())]
    found = difflib.get_close_matches(word, known, n=1, cutoff=0.7)
    return found[0] if found and found[0].startswith("RBL") else "".join(found).lower()


def _print(entry: "Code") -> None:
    from robolang.cli.console import Console

    console = Console()
    for text in (f"{entry.code} {entry.name}", "", entry.meaning, "", f"What to do: {entry.remedy}"):
        console.print(text)
    _print_page(entry.code, console)


def _print_page(code: str, console: "Console") -> None:
    """Print what the page of a rule adds, for a code that has one."""
    from robolang.core.bounds import of_rule, shown
    from robolang.lint.registry import rule

    known = rule(code)
    if known is None:
        return
    console.print(f"\nWhy it matters: {known.why}")
    for heading, program in (("Example", known.example), ("Instead", known.instead)):
        console.print(f"\n{heading}:\n")
        for line in program.splitlines():
            console.print(f"    {line}", soft_wrap=True)  # a program that is wrapped is not the one to copy
    if bounds := of_rule(code):
        console.print(f"\nBounds, in [lint.{known.entry.name}] of robolang.toml:\n")
        for bound in bounds:
            console.print(f"    {shown(bound)}")
    if known.fix:
        console.print(f"\nrobolang check --fix: {known.fix}")


def _print_all(entries: "list[Code]") -> None:
    from rich import box
    from rich.table import Table

    from robolang.cli.console import Console

    table = Table(box=box.SIMPLE_HEAD, padding=(0, 2, 0, 0), pad_edge=False)
    table.add_column("code", no_wrap=True)
    table.add_column("name", no_wrap=True)
    table.add_column("meaning", overflow="fold")
    for entry in entries:
        table.add_row(entry.code, entry.name, entry.meaning)
    Console().print(table)
