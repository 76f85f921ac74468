"""A run of a new project before it is written, for an arm from a file: what its test can expect.

A file may have drives that are estimates, or none. Where the simulated arm does the job, with warnings or without, the
test expects just that. Where it does not and the ideal arm does, the test runs on the ideal arm and the user gets to
know why.
"""

from typing import Any, cast

import tomlkit

from robolang.execution.session import Session
from robolang.project.project import Project
from robolang.templates.template import TEST
from robolang.testing.expectation import read_expectation
from robolang.testing.verdict import judge
from runtime.core.faults import Fault
from runtime.core.record import Record
from runtime.core.tomlfile import Source

SHORTER, LONGER, SETTLING_S = 0.95, 1.1, 0.5
"""A run may take so much of the planned time, and so many seconds longer."""


class Outcome(Record):
    """How an arm does its job: ``done`` or not at all, ``physics`` with its drives, with these ``warnings``.

    ``seconds``: how long, 0 where it was not measured. ``why`` it does not do it with its drives, or not at all.
    """

    done: bool = True
    physics: bool = True
    warnings: tuple[str, ...] = ()
    seconds: float = 0.0
    why: str = ""

    @property
    def notes(self) -> tuple[str, ...]:
        """What a user has to know."""
        if not self.physics:
            return (f"the test runs on the ideal arm (physics = false), since with drives: {self.why}",)
        if self.warnings:
            return (f"a run has the warnings {', '.join(self.warnings)}, which the test expects",)
        return ()

    def stated(self, text: str, planned_s: float) -> str:
        """Return the text of a test file that expects this."""
        table = cast(dict[str, Any], tomlkit.parse(text))
        table["expect"]["warnings"] = list(self.warnings)
        slowest = max(planned_s, self.seconds)
        table["expect"]["cycle_s"] = [round(SHORTER * planned_s, 1), round(LONGER * slowest + SETTLING_S, 1)]
        if self.physics:
            return tomlkit.dumps(table)
        # a key of the top must stand before the first table
        return tomlkit.dumps(table).replace("schema = 1\n", "schema = 1\nphysics = false # the ideal arm\n", 1)


def tried(project: Project, test: str) -> Outcome:
    """Return how the arm of a project does its job, with its drives or else without; ``test``: its test file."""
    with_drives = _run(project, test, physics=True)
    if with_drives.done:
        return with_drives
    ideal = _run(project, test, physics=False)
    return Outcome(done=ideal.done, physics=False, why=with_drives.why if ideal.done else ideal.why)


def _run(project: Project, test: str, *, physics: bool) -> Outcome:
    try:
        session = Session(project, physics=physics)
    except Fault as fault:
        return Outcome(done=False, why=f"{fault.code} {fault.message}")
    result = session.run()
    verdicts = judge(read_expectation(Source(f"job{TEST}", test)), session, result.report, result.log)
    # times and warnings are what is to be found out
    failed = [each for each in verdicts if not each.ok and each.key not in (("warnings",), ("cycle_s",))]
    return Outcome(
        done=not failed,
        warnings=tuple(sorted({row["code"] for row in result.report["warnings"]})),
        seconds=result.report["sim_time_s"],
        # the program has no file yet, and its name here would be looked for
        why=failed[0].detail.replace(project.source.path, "the program") if failed else "",
    )
