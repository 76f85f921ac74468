"""``robolang test [PATHS]``: run programs that have a test file beside them, and compare with what it expects.

``NAME.test.toml`` beside ``NAME.rbl`` (docs/testing.md). A test whose files cannot be used fails, and the others run
all the same. ``--junit FILE`` writes the report, of one test suite for each program.
"""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from robolang.cli.errors import DIAGNOSTICS, USAGE, reported, say_all
from robolang.cli.options import AllowEmpty, Argument, Group, Option
from robolang.cli.output import echo
from robolang.core.defects import internal

if TYPE_CHECKING:
    from robolang.core.diagnostics import Diagnostic
    from robolang.project.project import Project
    from robolang.testing.expectation import Expectation
    from robolang.testing.verdict import Verdict
    from runtime.core.faults import Fault


@dataclass(frozen=True, slots=True, kw_only=True)
class _Outcome:
    """What became of one test: the program's name, the place of its test file, verdicts, and the time of the run, s."""

    name: str
    verdicts: "list[Verdict]"
    expected: "Expectation | None" = None
    seconds: float = 0.0

    @property
    def ok(self) -> bool:
        return all(verdict.ok for verdict in self.verdicts)

    def line(self, verdict: "Verdict") -> str:
        """Return a verdict with the place of the key that asks for it."""
        if self.expected is None:
            return verdict.detail
        line, column = self.expected.place(*verdict.key)
        return f"{self.expected.source.path}:{line}:{column}: {verdict.name}: {verdict.detail}"


_Paths = Annotated[list[str] | None, Argument("[PATHS]", "Programs, test files, or folders; default: this folder.")]


class _TestOptions(Group):
    """What is written, and what an empty folder means."""

    PANEL: ClassVar[str] = "Tests"
    update: Annotated[bool, Option("--update", help="Replace the golden logs by the logs of these runs.")] = False
    junit: Annotated[Path | None, Option("--junit", metavar="FILE", help="Write a JUnit report to this file.")] = None
    allow_empty: AllowEmpty = False
    as_json: Annotated[bool, Option("--json", help="Print one JSON object in place of the lines.")] = False


def test(paths: _Paths, options: _TestOptions) -> None:
    """Run programs and compare them with their test files (NAME.test.toml).

    Example: robolang test programs --junit tests.xml

    Exit codes: 0 all as expected; 1 one is not; 2 a file cannot be used, or a path has no test; 4 a file cannot be
    written.
    """
    with reported():
        from robolang.core.storage import check_writable, write_atomic

        junit = options.junit
        if junit is not None:
            check_writable(junit)
        outcomes, worst = [], 0
        for found in _files(paths or ["."], options.allow_empty):
            outcome = _run(found, options.update) if isinstance(found, Path) else found
            worst = max(worst, _tell(outcome, quiet=options.as_json))
            outcomes.append(outcome)
        if junit is not None:
            text = _as_junit(outcomes)
            write_atomic(junit, lambda stream: stream.write(text.encode("utf-8")))
        _sum_up(outcomes, as_json=options.as_json)
    if worst:
        raise SystemExit(worst)


def _files(paths: list[str], allow_empty: bool) -> Iterator[Path | _Outcome]:
    """Yield the test files that paths mean, each once; for a path that means none, the outcome that says so."""
    from robolang.lint.files import programs
    from robolang.lint.settings import Settings
    from robolang.testing.expectation import ENDING
    from runtime.core.faults import Fault

    seen: set[Path] = set()
    excludes = Settings().excludes
    for path in map(Path, paths):
        if path.is_dir():
            files = [Path(name) for name in programs([str(path)], ENDING, excludes)]
        else:
            files = [path if path.name.endswith(ENDING) else path.with_name(path.name.removesuffix(".rbl") + ENDING)]
            if not files[0].exists():
                yield _unusable(str(path), _missing(path, files[0]))
                continue
        if not files and not allow_empty:
            yield _unusable(str(path), Fault("RBL712", f"there is no test file (NAME{ENDING}) in {path}"))
        for file in files:
            if file.absolute() not in seen:  # a folder and a file in it may both be named
                seen.add(file.absolute())
                yield file


def _missing(path: Path, file: Path) -> "Fault":
    """Return the fault of a path that has no test file."""
    from runtime.core.faults import Fault

    if not path.suffix and not path.with_name(f"{path.name}.rbl").exists():
        return Fault("RBL701", f"there is no file or folder {path}", "Check the name and the folder.")
    missing = "What the program is expected to do is written into it (docs/testing.md)."
    return Fault("RBL701", f"there is no test file {file}", missing)


def _unusable(name: str, fault: "Fault", expected: "Expectation | None" = None) -> _Outcome:
    from robolang.testing.verdict import Verdict

    verdict = Verdict(name="files", ok=False, detail=f"{fault.code} {fault.message}", fault=fault)
    return _Outcome(name=name, verdicts=[verdict], expected=expected)


def _run(file: Path, update: bool) -> _Outcome:
    """Run one program; whatever goes wrong is the outcome of this test alone."""
    from robolang.testing.expectation import ENDING, load_expectation
    from runtime.core.faults import Fault

    program = file.with_name(file.name.removesuffix(ENDING) + ".rbl")
    expected = None
    try:
        expected = load_expectation(file)
        verdicts, seconds = _judged(program, expected, update)
    except Fault as fault:
        return _unusable(str(program), fault, expected)
    except Exception as error:  # a defect of robolang fails this test; those after it are run
        return _unusable(str(program), internal(error), expected)
    return _Outcome(name=str(program), verdicts=verdicts, expected=expected, seconds=seconds)


def _judged(program: Path, expected: "Expectation", update: bool) -> "tuple[list[Verdict], float]":
    """Return the verdicts on a program and the time of its run, s."""
    from robolang.core.diagnostics import Severity
    from robolang.execution.dry_run import motion_check
    from robolang.execution.plan_memory import PlanMemory
    from robolang.execution.session import Session
    from robolang.project.project import load_project
    from robolang.testing.verdict import judge, judge_refused

    project = load_project(program)
    plans = PlanMemory(project)
    # a text with errors has no motion to check
    refused = [item for item in project.diagnostics if item.severity is Severity.ERROR] or list(
        motion_check(project, plans)
    )
    if refused:
        why = "; ".join(_shown(project, item) for item in refused)
        # not yet a failure: a test may expect that its program is refused
        return judge_refused(expected, [item.code for item in refused], why), 0.0
    session = Session(project, physics=expected.physics, plans=plans)
    result = session.run()
    return judge(expected, session, result.report, result.log, update), session.controller.time_us / 1e6


def _shown(project: "Project", item: "Diagnostic") -> str:
    place = project.source.place(item.span.start)
    return f"{project.source.path}:{place.line}:{place.column}: {item.code} {item.message}"


def _as_json(outcome: _Outcome) -> dict[str, Any]:
    """Return an outcome in plain types: each verdict with its place where it has one."""
    verdicts = [{"name": each.name, "ok": each.ok, "detail": outcome.line(each)} for each in outcome.verdicts]
    return {"program": outcome.name, "ok": outcome.ok, "seconds": outcome.seconds, "verdicts": verdicts}


def _tell(outcome: _Outcome, *, quiet: bool) -> int:
    """Print an outcome unless ``quiet``, the faults of its files to stderr, and return its exit code."""
    if not quiet:
        _show(outcome)
    code = 0 if outcome.ok else DIAGNOSTICS
    for verdict in outcome.verdicts:
        if verdict.fault is not None:
            # 2 at least: a text with errors is 1, and this is a test that was not carried out
            code = max(code, USAGE, say_all(verdict.fault))
    return code


def _show(outcome: _Outcome) -> None:
    from robolang.core.diagnostics import safe

    echo(safe(f"{'ok  ' if outcome.ok else 'FAIL'} {outcome.name}, {outcome.seconds:.3f} s"))
    for verdict in outcome.verdicts:
        if verdict.fault is None and (not verdict.ok or verdict.noted):
            echo(safe(f"     {outcome.line(verdict)}"))


def _sum_up(outcomes: list[_Outcome], *, as_json: bool) -> None:
    good = sum(outcome.ok for outcome in outcomes)
    if as_json:
        echo(json.dumps({"ok": good == len(outcomes), "programs": [_as_json(each) for each in outcomes]}))
    else:
        echo(f"{good} of {len(outcomes)} programs as expected" if outcomes else "no test files (NAME.test.toml)")


def _as_junit(outcomes: list[_Outcome]) -> str:
    """Return the report; a test whose files cannot be used is an error, one that finds a difference a failure."""
    from robolang.lint.reporters.junit import quoted

    lines = ['<?xml version="1.0" encoding="UTF-8"?>', "<testsuites>"]
    for outcome in outcomes:
        bad = [verdict for verdict in outcome.verdicts if not verdict.ok]
        errors = sum(verdict.fault is not None for verdict in bad)
        counts = f'tests="{len(outcome.verdicts)}" failures="{len(bad) - errors}" errors="{errors}"'
        lines.append(f'  <testsuite name={quoted(outcome.name)} {counts} time="{outcome.seconds:.3f}">')
        for verdict in outcome.verdicts:
            head = f"    <testcase classname={quoted(outcome.name)} name={quoted(verdict.name)}"
            lines.append(head + ("/>" if verdict.ok else f">{_failure(outcome, verdict)}</testcase>"))
        lines.append("  </testsuite>")
    return "\n".join([*lines, "</testsuites>", ""])


def _failure(outcome: _Outcome, verdict: "Verdict") -> str:
    from robolang.lint.reporters.junit import quoted

    if verdict.fault is None:
        return f"<failure message={quoted(outcome.line(verdict))}/>"
    every = "; ".join(map(str, verdict.fault.all))
    return f"<error type={quoted(verdict.fault.code)} message={quoted(every)}/>"
