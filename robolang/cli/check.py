"""``robolang check PROG...``: find what is wrong with programs without running them.

This edition checks the text and the taught points; the motion is planned by ``robolang run`` before it moves.
A file that cannot be read does not keep the others from being checked. Imports no numpy, pinocchio or mujoco.
"""

from pathlib import Path
from typing import Annotated

import typer

from robolang.cli.errors import DIAGNOSTICS, reader_may_leave, reported, say


def check(
    programs: Annotated[list[str], typer.Argument(metavar="PROG...", help="Program files (.rbl).")],
) -> None:
    """Check programs; exit code 1 when one has an error, 2 when one or its points cannot be read."""
    from runtime.faults import Fault

    worst = 0
    with reported():
        for name in programs:
            try:
                code = _check(name)
            except Fault as fault:
                code = say(fault)
            worst = max(worst, code)
    if worst:
        raise typer.Exit(worst)


def _check(name: str) -> int:
    from robolang.beside import cell_beside, taught_points
    from robolang.checker import check as check_program
    from robolang.diagnostics import has_errors, in_order, render
    from robolang.parser import parse
    from robolang.source import read_program

    source = read_program(name)
    parsed = parse(source)
    where = Path(name)
    points = taught_points(where, builtin=cell_beside(where) is None).names
    found = in_order((*parsed.diagnostics, *check_program(parsed.program, points=points)))
    with reader_may_leave():
        for item in found:
            typer.echo(render(item, source))
    return DIAGNOSTICS if has_errors(found) else 0
