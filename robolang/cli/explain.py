"""``robolang explain CODE``: what a code means and what to do about it."""

from typing import Annotated

import typer

from robolang.cli.values import OptionValueError


def explain(
    code: Annotated[str | None, typer.Argument(help="A code such as RBL412; without one, all are listed.")] = None,
) -> None:
    """Explain a code of a diagnostic, a fault or an alarm."""
    import difflib

    import robolang.codes
    import robolang.project  # noqa: F401 - and those of the files, with the runtime's
    from runtime.faults import all_codes

    codes = {entry.code: entry for entry in all_codes()}
    if code is None:
        for entry in codes.values():
            typer.echo(f"{entry.code}  {entry.name}")
        return
    wanted = code.upper()
    if wanted not in codes:
        near = difflib.get_close_matches(wanted, codes, n=1)
        raise OptionValueError("CODE", f"there is no code '{code}'" + (f"; did you mean {near[0]}?" if near else ""))
    entry = codes[wanted]
    typer.echo(f"{entry.code} {entry.name}\n\n{entry.meaning}\n\nWhat to do: {entry.remedy}")
