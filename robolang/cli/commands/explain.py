"""``robolang explain CODE``: what a code means and what to do about it, or what a word means and what to write.

``--json`` prints one object for a code, as ``robolang rules --json`` has them, and {"word", "text"} for a word or a
line; without CODE an array of all codes.
"""

import difflib
import json
from typing import TYPE_CHECKING, Annotated, Any

from robolang.cli.errors import reported
from robolang.cli.options import Argument, JsonOptions
from robolang.cli.output import echo
from robolang.cli.usage import OptionValueError

if TYPE_CHECKING:
    from robolang.cli.console import Console
    from runtime.core.faults import Code


def codes() -> list[str]:
    """Return all codes, for a shell that completes one."""
    import robolang.lint.registry  # noqa: F401 - every code there is
    from runtime.core.faults import all_codes

    return [entry.code for entry in all_codes()]


_Code = Annotated[str | None, Argument("CODE", "Code such as RBL412, or a word as PTP; default: list codes.", codes)]


def explain(code: _Code, output: JsonOptions) -> None:
    """Explain a code and what to do, or a word of this language or another one.

    A line of another language in quotes is translated.

    Example: robolang explain RBL412

    Exit codes: 0 done; 2 there is no such code and no such word.
    """
    import robolang.lint.registry  # noqa: F401 - every code there is
    from runtime.core.faults import all_codes

    with reported():
        entries = all_codes()
        found = entries if code is None else _find(code, entries) or _meaning(code, entries)
        if output.as_json:
            echo(json.dumps(_data(code, found), indent=2))
        else:
            _print(found)


def _meaning(text: str, entries: "list[Code]") -> str:
    """Return what a word or a line means; a usage error with the nearest code for what means nothing."""
    from robolang.syntax.word_help import explained

    of_word = explained(text)
    if not of_word:
        near = _near(_as_code(text), entries)
        hint = f"did you mean {near}?" if near else "robolang explain lists the codes"
        raise OptionValueError("CODE", f"there is no code and no word '{text}'; {hint}")
    return of_word


def means(text: str) -> bool:
    """Return whether there is something to explain of a text."""
    import robolang.lint.registry  # noqa: F401 - every code there is
    from robolang.syntax.word_help import explained
    from runtime.core.faults import all_codes

    return _find(text, all_codes()) is not None or bool(explained(text))


def _data(text: str | None, found: "list[Code] | Code | str") -> Any:
    from robolang.cli.code_data import code_data

    if isinstance(found, list):
        return [code_data(entry) for entry in found]
    return {"word": text, "text": found} if isinstance(found, str) else code_data(found)


def _print(found: "list[Code] | Code | str") -> None:
    if isinstance(found, list):
        _print_all(found)
    elif isinstance(found, str):
        _print_lines(found)
    else:
        _print_code(found)


def _find(text: str, entries: "list[Code]") -> "Code | None":
    """Return the entry of a code, its number or its name, in any case."""
    word = _as_code(text)
    return next((entry for entry in entries if word in (entry.code, entry.name.upper())), None)


def _as_code(text: str) -> str:
    word = text.strip().upper()
    # robolang explain 412
    return f"RBL{word}" if word.isdecimal() else word


def _near(word: str, entries: "list[Code]") -> str:
    """Return the code or the name that a misspelt word resembles most; empty without one."""
    digits = word.removeprefix("RBL")
    if digits.isascii() and digits.isdecimal() and len(digits) == 3:
        return ""  # a whole code: those with near numbers mean other things
    from robolang.syntax.word_help import own_words

    words = own_words()
    known = [*words, *(form for entry in entries for form in (entry.code, entry.name.upper()))]
    found = difflib.get_close_matches(word, known, n=1, cutoff=0.7)
    # names of codes are in small letters
    return found[0] if found and (found[0].startswith("RBL") or found[0] in words) else "".join(found).lower()


def _print_lines(text: str) -> None:
    from robolang.cli.console import Console

    console = Console()
    for line in text.splitlines():
        # a statement that is wrapped is not the one to copy
        console.print(line, soft_wrap=True)


def _print_code(entry: "Code") -> None:
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
