"""``robolang check PROG...``: find what is wrong with programs without running them.

This edition checks the text and the taught points; the motion is planned by ``robolang run`` before it moves.
Imports no numpy, pinocchio or mujoco.
"""

from pathlib import Path
from typing import Annotated

import typer

from robolang.cli.errors import DIAGNOSTICS, has_errors, render, reported


def check(
    programs: Annotated[list[str], typer.Argument(metavar="PROG...", help="Program files (.rbl).")],
) -> None:
    """Check programs; exit code 1 when one has an error."""
    from robolang.checker import check as check_program
    from robolang.diagnostics import in_order
    from robolang.parser import parse
    from robolang.points import load_points
    from robolang.source import read_program

    failed = False
    for name in programs:
        with reported():
            source = read_program(name)
            parsed = parse(source)
            points = Path(name).with_suffix(".points.toml")
            names = load_points(points).names if points.exists() or points.is_symlink() else None
            found = in_order((*parsed.diagnostics, *check_program(parsed.program, points=names)))
            for item in found:
                typer.echo(render(item, source))
            failed = failed or has_errors(found)
    if failed:
        raise typer.Exit(DIAGNOSTICS)
