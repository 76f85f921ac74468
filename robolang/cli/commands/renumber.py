"""``robolang renumber FILE``: number the lines of a program anew, and lead its jumps to the new numbers.

Only the numbers change; ``robolang fmt`` puts the columns right. ``FILE`` or ``-o`` may be ``-``. A program that has
errors, the same number twice or a jump to no line is left alone and reported.

Exit codes: 0; 1 with ``--check`` or ``--diff``, something would change; 2 the program is left alone; 4 it cannot be
written. Imports no numpy, pinocchio or mujoco.
"""

from typing import TYPE_CHECKING, Annotated

import typer

from robolang.cli.errors import STORAGE, reader_may_leave, reported, say
from robolang.cli.rewrite import BROKEN, CHANGES, STDIO, broken, load, show, store
from robolang.cli.values import OptionValueError

if TYPE_CHECKING:
    from robolang.cli.rewrite import Loaded
    from robolang.syntax.renumber import RenumberResult

FIRST = STEP = 10


def renumber(
    program: Annotated[str, typer.Argument(metavar="FILE", help="Program file (.rbl), or -.")],
    start: Annotated[int | None, typer.Option("--start", min=0, help="First number; default 10.")] = None,
    step: Annotated[int | None, typer.Option("--step", min=1, help="From one number to the next; default 10.")] = None,
    remove: Annotated[bool, typer.Option("--remove", help="Remove the numbers that no jump leads to.")] = False,
    check: Annotated[bool, typer.Option("--check", help="Write nothing; exit code 1 when it would change.")] = False,
    diff: Annotated[bool, typer.Option("--diff", help="Write nothing; print what would change.")] = False,
    out: Annotated[str | None, typer.Option("--out", "-o", metavar="FILE", help="Write there instead.")] = None,
) -> None:
    """Number the lines of a program, and lead its jumps to the new numbers."""
    if remove and (start is not None or step is not None):
        raise OptionValueError("--remove", "takes neither --start nor --step")
    if out is not None and (check or diff):
        raise OptionValueError("--out", "nothing is written with --check or --diff")
    with reported():
        from runtime.core.faults import Fault

        try:
            loaded = load(program)
            found = _renumbered(loaded, FIRST if start is None else start, STEP if step is None else step, remove)
            if broken(loaded, found.diagnostics):
                raise typer.Exit(BROKEN)
            _deliver(loaded, found, check=check, diff=diff, out=program if out is None else out)
        except Fault as fault:
            raise typer.Exit(STORAGE if say(fault) == STORAGE else BROKEN) from None
    if found.changed and (check or diff):
        raise typer.Exit(CHANGES)


def _renumbered(loaded: "Loaded", start: int, step: int, remove: bool) -> "RenumberResult":
    from robolang.syntax.renumber import remove_numbers
    from robolang.syntax.renumber import renumber as number

    return remove_numbers(loaded.source) if remove else number(loaded.source, start=start, step=step)


def _deliver(loaded: "Loaded", found: "RenumberResult", *, check: bool, diff: bool, out: str) -> None:
    """Show or write the result, and say in a sentence what changed."""
    from robolang.core.diagnostics import safe

    if diff:
        with reader_may_leave():
            show(loaded, found.text)
    elif not check and (found.changed or out == STDIO or out != loaded.name):
        store(loaded, found.text, out)
    would = "would change" if check or diff else "changed"
    parts = [_count(found.lines, "line number"), *([_count(found.targets, "jump")] if found.targets else [])]
    said = f"{' and '.join(parts)} {would}" if found.changed else "nothing to change"
    with reader_may_leave():
        typer.echo(safe(f"{loaded.source.path}: {said}"), err=diff or out == STDIO)


def _count(count: int, what: str) -> str:
    return f"{count} {what}{'s' * (count != 1)}"
