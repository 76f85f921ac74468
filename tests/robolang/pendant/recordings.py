"""Recordings of a prompt, done again and compared with what was done."""

from pathlib import Path

import numpy as np

from robolang.execution.session import Session
from robolang.logs.log import Log
from robolang.project.discovery import own_cell, points_file
from robolang.project.project import load_project
from tests.robolang.cli.commands import ROOT, robolang
from tests.robolang.pendant.prompting import Prompted

PICK = ROOT / "programs" / "pick_and_place.rbl"
OF_THE_TEXT = ("line", "number")
"""Signals that name lines of the file."""


def statements(path: Path | str) -> list[str]:
    """The statements of a recording without comments."""
    lines = [line.split("  '")[0].strip() for line in Path(path).read_text().splitlines()]
    return [line for line in lines if line and not line.startswith("'")]


def _ends(session: Session, log: dict) -> list[np.ndarray]:
    """Where each motion of a session ended, in the order of their ends, rad; moves that blend have no end."""
    moved = [run for run in session.record.statements if run.begun and run.ended and _stops(run)]
    return [log["q_plan"][run.end_tick - 1] for run in moved]


def _stops(run) -> bool:
    return run.effect is None or (hasattr(run.effect, "zone_mm") and run.effect.zone_mm == 0.0)


def done_again(prompted: Prompted, path: str, *, physics: bool = False) -> tuple[Log, Log]:
    """Check a recording and run it; the log of the prompt and of the run, whose motions end at the same joints."""
    robolang("check", path)
    project = load_project(path)
    again = Session(project, physics=physics)
    result = again.run()
    assert result.ok, result.alarms
    session = prompted.pendant.live.session
    log = session.result(0.0).log
    found, expected = _ends(again, result.log), _ends(session, log)
    assert len(found) == len(expected)
    for one, other in zip(found, expected, strict=True):
        assert np.abs(one - other).max() < 1e-9
    return log, result.log


def assert_same_log(logs: tuple[Log, Log]) -> None:
    one, other = logs
    differs = [name for name in one if name not in OF_THE_TEXT and one[name].tobytes() != other[name].tobytes()]
    assert differs == []


def tolerant(program: Path, folder: Path) -> Path:
    """A copy of a program in a cell whose controller does not compare the payload: moves out of turn are no alarm."""
    copy = folder / "source" / program.name
    copy.parent.mkdir()
    cell = own_cell(program) if own_cell(program).exists() else program.with_name("cell.toml")
    copy.write_text(program.read_text())
    points_file(copy).write_text(points_file(program).read_text())
    own_cell(copy).write_text(f'{cell.read_text()}\n[controller.supervision]\npayload_mismatch = "off"\n')
    return copy
