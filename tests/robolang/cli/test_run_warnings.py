"""Warnings of a run: where they are placed, ``--strict`` and ``--quiet``, and what Python is given."""

import json

import pytest

from robolang.execution.session import Session
from robolang.project.project import load_project
from tests.messages import numbers
from tests.robolang.cli.commands import dry, places

NEVER = ("--set", "in_position_deg=1e-9", "--set", "settle_timeout_s=0")
"""No arm comes so near to its command: every move that stops is RBL523."""


TEXT = """\
2 LOAD (0, 0, 60), 0.8
3 MOVE P1 + (0, 40, 0), ZONE 10
4 FOR I = 1 TO 5
5 MOVE P1 + (0, 0, 20 * I)
6 NEXT
"""


@pytest.fixture
def program(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "p.rbl"
    path.write_text(TEXT)
    return path


def test_a_warning_has_the_place_of_its_move_and_leaves_the_run_ok(program):
    result = dry("p.rbl", "--report", "r.json", *NEVER)
    assert places(result.stderr) == [(4, 3, "RBL523")] * 3  # of five
    (first,) = (line for line in result.stderr.splitlines() if "2 more" in line)
    assert numbers(first)[3] == 2
    report = json.loads((program.parent / "r.json").read_text())
    assert report["ok"] is True
    assert report["alarms"] == []
    assert [(item["code"], item["line"], item["column"], item["number"]) for item in report["warnings"]] == [
        ("RBL523", 4, 3, 5)
    ] * 5
    assert all(item["message"] and item["hint"] and item["severity"] == "warning" for item in report["warnings"])
    times = [item["time_s"] for item in report["warnings"]]
    assert times == sorted(set(times))
    assert [entry["notes"] for entry in report["statements"]] == [[]] * 7


def test_strict_makes_warnings_exit_1_and_an_alarm_stays_3(program):
    dry("p.rbl", "--strict")
    assert places(dry("p.rbl", "--strict", *NEVER, code=1).stderr) == [(4, 3, "RBL523")] * 3
    program.write_text(program.read_text() + "7 PRINT 1 / (I - 5)\n")
    assert places(dry("p.rbl", "--strict", *NEVER, code=3).stderr) == [(4, 3, "RBL523")] * 3 + [(6, 3, "RBL501")]


def test_strict_counts_the_warnings_of_the_text(program):
    program.write_text("20 LOAD (0, 0, 60), 0.8\n10 MOVE P1\n")
    assert places(dry("p.rbl").stderr) == [(2, 1, "RBL116")]
    assert places(dry("p.rbl", "--strict", code=1).stderr) == [(2, 1, "RBL116")]
    program.write_bytes(b"10 LOAD (0, 0, 60), 0.8\r\n20 MOVE P1\n")  # a remark is no warning
    dry("p.rbl", "--strict")


def test_quiet_prints_errors_alone_and_with_strict_what_it_fails_for(program):
    quiet = dry("p.rbl", "--quiet", *NEVER)
    assert (quiet.stdout, quiet.stderr) == ("", "")
    assert places(dry("p.rbl", "--quiet", "--strict", *NEVER, code=1).stderr) == [(4, 3, "RBL523")] * 3
    program.write_text(program.read_text() + "1 PRINT 1 / (I - 5)\n")
    assert places(dry("p.rbl", "--quiet", *NEVER, code=3).stderr) == [(6, 3, "RBL501")]  # and no RBL116 of the text


def test_python_is_given_warnings_apart_from_ok(program):
    options = {"in_position_deg": ("test", 1e-9), "settle_timeout_s": ("test", 0.0)}
    result = Session(load_project(program, options=options), physics=False).run()
    assert result.ok
    assert result.alarms == ()
    assert [item.code for item in result.warnings] == ["RBL523"] * 5
