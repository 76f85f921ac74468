"""``robolang test [PATHS]``: run programs that have a test file beside them, and compare with what it expects.

``NAME.test.toml`` beside ``NAME.rbl`` (docs/testing.md). Exit codes: 0 all as expected; 1 one is not; 2 a file cannot
be used. ``--junit FILE`` writes the report of one test suite for each program.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robolang.cli.errors import DIAGNOSTICS, USAGE, reported, say

if TYPE_CHECKING:
    from robolang.diagnostics import Diagnostic
    from robolang.expectation import Expectation, Verdict
    from robolang.project import Project


def test(
    paths: Annotated[
        list[str] | None,
        typer.Argument(metavar="[PATHS]", help="Programs, test files, or folders of them; default: this folder."),
    ] = None,
    update: Annotated[bool, typer.Option("--update", help="Write the golden logs anew.")] = False,
    junit: Annotated[Path | None, typer.Option("--junit", metavar="FILE", help="Write a JUnit report.")] = None,
) -> None:
    """Run programs and compare with what their test files expect."""
    with reported():
        from robolang.storage import check_writable, write_atomic

        if junit is not None:
            check_writable(junit)
        files = _files(paths or ["."])
        if not files:
            typer.echo("no test files (NAME.test.toml)", err=True)
        suites, worst = [], 0
        for file in files:
            code, name, verdicts, seconds = _run(file, update)
            worst = max(worst, code)
            suites.append((name, verdicts, seconds))
        if junit is not None:
            text = _as_junit(suites)
            write_atomic(junit, lambda stream: stream.write(text.encode("utf-8")))
        bad = sum(not all(verdict.ok for verdict in verdicts) for _, verdicts, _ in suites)
        typer.echo(f"{len(suites) - bad} of {len(suites)} programs as expected")
    if worst:
        raise typer.Exit(worst)


def _files(paths: list[str]) -> list[Path]:
    """Return the test files that paths name, each once, folders searched through."""
    from robolang.expectation import ENDING
    from runtime.faults import Fault

    found: list[Path] = []
    for path in map(Path, paths):
        if path.is_dir():
            found += sorted(path.rglob(f"*{ENDING}"))
        elif path.name.endswith(ENDING):
            found.append(path)
        else:
            beside = path.with_name(path.name.removesuffix(".rbl") + ENDING)
            if not beside.exists():
                hint = "write what the program is expected to do into it"
                raise Fault("RBL701", f"there is no test file {beside}", hint)
            found.append(beside)
    return list(dict.fromkeys(found))


def _run(file: Path, update: bool) -> "tuple[int, str, list[Verdict], float]":
    """Run one program; return exit code, name, verdicts and the time of the run, s."""
    from robolang.diagnostics import Severity, safe
    from robolang.expectation import ENDING, Verdict, judge, load_expectation
    from robolang.motion_check import motion_check
    from robolang.project import load_project
    from robolang.session import Session
    from runtime.faults import Fault

    program = file.with_name(file.name.removesuffix(ENDING) + ".rbl")
    try:
        expected = load_expectation(file)
        project = load_project(program)
        refused = [item for item in project.diagnostics if item.severity is Severity.ERROR]
        refused = refused or list(motion_check(project))
        if refused:
            verdicts, seconds = _refused(project, refused, expected), 0.0
        else:
            session = Session(project, physics=expected.physics)
            result = session.run()
            verdicts = judge(expected, session, result.report, result.log, update)
            seconds = session.controller.time_us / 1e6
    except Fault as fault:
        return max(USAGE, say(fault)), str(program), [Verdict(name="files", ok=False, said=fault.message)], 0.0
    ok = all(verdict.ok for verdict in verdicts)
    typer.echo(safe(f"{'ok  ' if ok else 'FAIL'} {program}, {seconds:.3f} s"))
    for verdict in verdicts:
        if not verdict.ok:
            typer.echo(safe(f"     {verdict.name}: {verdict.said}"))
    return (0 if ok else DIAGNOSTICS), str(program), verdicts, seconds


def _refused(project: "Project", refused: "list[Diagnostic]", expected: "Expectation") -> "list[Verdict]":
    """Return what is to be said of a program that does not start: its codes are what it ends with."""
    from robolang.expectation import Verdict

    said = []
    for item in refused:
        place = project.source.place(item.span.start)
        said.append(f"{project.source.path}:{place.line}:{place.column}: {item.code} {item.message}")
    codes = [item.code for item in refused]
    return [Verdict(name="alarms", ok=codes == list(expected.alarms), said=f"it does not start: {'; '.join(said)}")]


def _as_junit(suites: "list[tuple[str, list[Verdict], float]]") -> str:
    from robolang.output.junit import quoted

    lines = ['<?xml version="1.0" encoding="UTF-8"?>', "<testsuites>"]
    for name, verdicts, seconds in suites:
        failures = sum(not verdict.ok for verdict in verdicts)
        counts = f'tests="{len(verdicts)}" failures="{failures}" errors="0" time="{seconds:.3f}"'
        lines.append(f"  <testsuite name={quoted(name)} {counts}>")
        for verdict in verdicts:
            head = f"    <testcase classname={quoted(name)} name={quoted(verdict.name)}"
            failure = f"><failure message={quoted(verdict.said)}/></testcase>"
            lines.append(f"{head}{'/>' if verdict.ok else failure}")
        lines.append("  </testsuite>")
    return "\n".join([*lines, "</testsuites>", ""])
