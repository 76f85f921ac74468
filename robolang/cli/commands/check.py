"""``robolang check [PATHS|-]``: find what is wrong with programs without running them, and correct what is certain.

Text, cell and taught points; with ``--motion`` also the motion, planned as a run plans it (``check_motion``). A file
that cannot be read does not keep the others from being checked. Without ``--motion`` no numpy, pinocchio, mujoco, rich.

Exit codes (docs/decisions/0005): 0 no errors; 1 errors, with ``--strict`` also warnings, with ``--diff`` something to
correct; 2 a file, an option or the configuration cannot be used; 4 a file cannot be written. The worst one counts.
"""

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robolang.cli.errors import reported
from robolang.cli.usage import OptionValueError

if TYPE_CHECKING:
    from robolang.lint.selection import Layer

_Codes = list[str] | None


def check(
    paths: Annotated[
        list[str] | None,
        typer.Argument(metavar="[PATHS|-]", help="Programs, folders of them, or - for stdin; default: this folder."),
    ] = None,
    fix: Annotated[bool, typer.Option("--fix", help="Apply the fixes that are certain to the files.")] = False,
    diff: Annotated[bool, typer.Option("--diff", help="Print what --fix would change, change nothing.")] = False,
    select: Annotated[_Codes, typer.Option(help="Report these only: RBL2, RBL301, a name, ALL.")] = None,
    ignore: Annotated[_Codes, typer.Option(help="Do not report these.")] = None,
    extend_select: Annotated[_Codes, typer.Option(help="Report these as well.")] = None,
    output_format: Annotated[
        str,
        typer.Option(
            envvar="ROBOLANG_OUTPUT_FORMAT",
            help="full, concise, json, json-lines, github, gitlab, junit or sarif.",
        ),
    ] = "full",
    output_file: Annotated[str | None, typer.Option(help="Write the report to this file.")] = None,
    stdin_filename: Annotated[str | None, typer.Option(help="The name of the program that - reads.")] = None,
    statistics: Annotated[bool, typer.Option("--statistics", help="Count the findings of each code.")] = False,
    strict: Annotated[bool, typer.Option("--strict", help="Exit code 1 for warnings, too.")] = False,
    exit_zero: Annotated[bool, typer.Option("--exit-zero", help="Exit code 0 whatever is found.")] = False,
    motion: Annotated[
        bool, typer.Option("--motion", help="Plan every move as well: reach, limits, collisions, time of each line.")
    ] = False,
    max_cycle: Annotated[
        str | None, typer.Option("--max-cycle", metavar="TIME", help="With --motion: longest time, such as 12.5s.")
    ] = None,
    times: Annotated[
        str | None, typer.Option(metavar="FILE.json", help="With --motion: write the time of every line to this file.")
    ] = None,
    watch: Annotated[bool, typer.Option("--watch", help="Check again whenever a file changes, until Ctrl-C.")] = False,
) -> None:
    """Check programs; exit code 1 when one has an error, 2 when one, its cell or its points cannot be used."""
    with reported():
        from robolang.cli.check_job import Job, run_once, watched

        _refuse(paths or [], output_format, statistics, watch, times, motion)
        job = Job(
            paths=tuple(paths or ["."]),
            layer=_layer(select, ignore, extend_select),
            form=output_format,
            output=None if output_file is None else Path(output_file),
            stdin_name=stdin_filename or "<stdin>",
            fix=fix,
            diff=diff,
            statistics=statistics,
            strict=strict,
            exit_zero=exit_zero,
            motion=motion,
            max_cycle_s=_seconds(max_cycle, motion),
            times=None if times is None else Path(times),
        )
        worst = watched(job) if watch else run_once(job)
    if worst:
        raise typer.Exit(worst)


def _refuse(paths: list[str], form: str, statistics: bool, watch: bool, times: str | None, motion: bool) -> None:
    """Raise ``OptionValueError`` for options that cannot be, alone or together."""
    from robolang.lint.reporters import FORMS

    if form not in FORMS:
        raise OptionValueError("--output-format", f"there is no form '{form}'; known: {', '.join(FORMS)}")
    if statistics and form not in ("full", "concise", "json"):
        raise OptionValueError("--statistics", f"counts cannot be printed as {form}; full, concise and json can")
    if times is not None and not motion:
        raise OptionValueError("--times", "it needs --motion")
    if watch and "-" in paths:
        raise OptionValueError("--watch", "the standard input cannot be watched")


def _seconds(text: str | None, motion: bool) -> float | None:
    """Return the time of ``--max-cycle``, s."""
    if text is None:
        return None
    if not motion:
        raise OptionValueError("--max-cycle", "it needs --motion")
    found = re.fullmatch(r"([0-9]+(?:\.[0-9]*)?|\.[0-9]+) *(ms|s)?", text.strip().lower())
    if found is None:
        raise OptionValueError("--max-cycle", f"'{text[:20]}' is not a time such as 12.5s")
    return float(found[1]) * (1e-3 if found[2] == "ms" else 1.0)


def _layer(select: _Codes, ignore: _Codes, extend_select: _Codes) -> "Layer":
    from robolang.lint.selection import Layer

    return Layer(
        select=None if select is None else _selectors("--select", select),
        extend=_selectors("--extend-select", extend_select or []),
        ignore=_selectors("--ignore", ignore or []),
    )


def _selectors(option: str, given: list[str]) -> tuple[str, ...]:
    from robolang.lint.selection import guess, selector

    found = []
    for word in (word for text in given for word in text.split(",") if word.strip()):
        chosen = selector(word)
        if chosen is None:
            near = guess(word)
            raise OptionValueError(option, f"'{word}' is no rule" + (f"; {near}" if near else ""))
        found.append(chosen)
    return tuple(found)
