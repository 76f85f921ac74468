"""``log`` and ``report``: the files of ``robolang run``, of what was done at the prompt."""

import json
from pathlib import Path

import numpy as np
import pytest

from robolang.pendant.failure import Failure
from tests.campaign import some
from tests.programs.runs import some_programs
from tests.robolang.cli.commands import ROOT, robolang
from tests.robolang.pendant.prompting import Requests, played, prompt

PROGRAMS = some_programs("palletise", "recover", "seam")
PHYSICS = [ROOT / "programs" / "manutec_pick_and_place.rbl", ROOT / "programs" / "shop" / "tend.rbl"]
WALL = ("wall_time_s", "realtime_factor")


def _names(path: Path) -> str:
    return path.stem


def _of_run(program: Path, folder: Path, *words: str) -> tuple[bytes, dict]:
    """The log and the report that ``robolang run`` writes."""
    log, report = folder / "run.npz", folder / "run.json"
    robolang("run", *words, "--quiet", "--log", log, "--report", report, program)
    return log.read_bytes(), json.loads(report.read_text())


def _assert_same_files(program: Path, folder: Path, *, physics: bool) -> None:
    words = () if physics else ("--no-physics",)
    log, report = folder / "prompt.npz", folder / "prompt.json"
    # a move before ``again`` leaves no trace
    script = f"MOVEJ HERE * (0, 0, -5)\nagain\nrun\nlog {log}\nreport {report}\n"
    codes, _, problems = played(script, program, physics=physics)
    assert codes == (), problems
    expected, expected_report = _of_run(program, folder, *words)
    assert log.read_bytes() == expected
    found = json.loads(report.read_text())
    assert {key: found[key] for key in found if key not in WALL} == {
        key: expected_report[key] for key in expected_report if key not in WALL
    }


@pytest.mark.parametrize("program", PROGRAMS, ids=_names)
def test_run_at_the_prompt_is_that_of_the_command(program, tmp_path):
    _assert_same_files(program, tmp_path, physics=False)


@pytest.mark.physics
@pytest.mark.parametrize("program", some(PHYSICS, 1), ids=_names)
def test_run_with_physics_at_the_prompt_is_that_of_the_command(program, tmp_path):
    _assert_same_files(program, tmp_path, physics=True)


def test_writing_changes_nothing_of_what_follows(tmp_path):
    program = ROOT / "programs" / "pick_and_place.rbl"
    once, twice = tmp_path / "once.npz", tmp_path / "twice.npz"
    played(f"auto\nMOVE P1\nrun\nlog {once}\n", program)
    codes, _, problems = played(
        f"auto\nMOVE P1\nlog {twice}\nreport {tmp_path / 'r.json'}\nreport {tmp_path / 'r.json'}\nrun\nlog {twice}\n",
        program,
    )
    assert codes == (), problems
    assert once.read_bytes() == twice.read_bytes()


@pytest.mark.physics
def test_touches_are_reported_once_however_often(tmp_path):
    report = tmp_path / "r.json"
    prompted = prompt(ROOT / "programs" / "pick_and_place.rbl", physics=True)
    with pytest.raises(Failure):
        prompted.do("auto", "MOVE P1 + (0, 0, -25)")  # into the part, which is an alarm too
    prompted.do(f"report {report}")
    first = json.loads(report.read_text())["warnings"]
    prompted.do(f"report {report}")
    assert json.loads(report.read_text())["warnings"] == first
    assert [item["code"] for item in first].count("RBL535") == 1


def test_the_log_of_a_stop_within_a_move_is_whole(tmp_path):
    log, report = tmp_path / "h.npz", tmp_path / "h.json"
    prompted = prompt(ROOT / "programs" / "pick_and_place.rbl", interrupts=Requests(stop=70))
    prompted.do("run", f"log {log}", f"report {report}")
    found = json.loads(report.read_text())
    ticks = len(np.load(log)["t"])
    last = found["statements"][-1]
    assert last["text"] == "MOVE P1"
    assert last["start_s"] + last["duration_s"] == pytest.approx(ticks / 1000)
    assert found["sim_time_s"] == pytest.approx(ticks / 1000)


def test_mcap_is_written_by_its_name(tmp_path):
    log = tmp_path / "a.mcap"
    assert "ticks" in prompt(ROOT / "programs" / "pick_and_place.rbl").do("DELAY 0.1", f"log {log}")
    assert log.read_bytes().startswith(b"\x89MCAP")


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("log", "RBL802"),
        ("log a.csv", "RBL802"),
        ("report", "RBL802"),
        ("report a.rbl", "RBL802"),
        ("report a.cell.toml", "RBL802"),
        ("report a.RBL", "RBL802"),
        ("log nowhere/a.npz", "RBL706"),
        ("report nowhere/a.json", "RBL706"),
    ],
)
def test_files_that_are_refused(line, code, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(Failure) as caught:
        prompt().do(line)
    assert caught.value.codes == (code,)
    assert list(tmp_path.iterdir()) == []


def test_a_report_does_not_replace_what_is_open(tmp_path):
    program = tmp_path / "a.program"
    program.write_text("DELAY 1\n")
    (tmp_path / "link.json").symlink_to(program)
    with pytest.raises(Failure) as caught:
        prompt(program).do(f"report {tmp_path / 'link.json'}")
    assert caught.value.codes == ("RBL706",)
    assert program.read_text() == "DELAY 1\n"
