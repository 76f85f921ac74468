"""Run-time errors are shown at the statement that failed, also one that had never run before."""

import json
from pathlib import Path

import pytest

from robolang.api.running import run
from robolang.core.diagnostics import to_json
from robolang.core.source import read_program
from tests.robolang.cli.commands import dry

CASES = Path(__file__).parent
ATTACK = "attack_01_runtime_error_wrong_place"


@pytest.mark.parametrize(
    ("program", "code", "place"),
    [
        (f"{ATTACK}/p.rbl", "RBL501", (4, 5)),  # the value that is assigned
        (f"{ATTACK}/gs.rbl", "RBL501", (5, 5)),
        (f"{ATTACK}/sub.rbl", "RBL501", (5, 5)),
        (f"{ATTACK}/rec.rbl", "RBL504", (4, 1)),
        ("reports_01_error_place_never_ran/p.rbl", "RBL501", (6, 3)),
        ("reports_03_error_place_array/p.rbl", "RBL507", (5, 3)),
        ("reports_04_error_place_recursion/p.rbl", "RBL504", (10, 2)),  # the CALL that was one too many
    ],
)
def test_the_place_is_that_of_the_statement(program, code, place, tmp_path):
    path = CASES / program
    result = dry(path, "--quiet", "--report", tmp_path / "r.json", code=3)
    line, column = place
    assert f"{path}:{line}:{column}: error {code} " in result.stderr
    (alarm,) = json.loads((tmp_path / "r.json").read_text())["alarms"]
    assert (alarm["code"], alarm["file"], alarm["line"], alarm["column"]) == (code, str(path), line, column)


def test_python_is_given_the_same_place_and_the_calls_that_led_there():
    path = CASES / ATTACK / "rec.rbl"
    result = run(path, physics=False)
    (alarm,), (row,) = result.alarms, result.report["alarms"]
    found = to_json(alarm, read_program(path))
    assert found.items() <= row.items()
    assert [(each["line"], each["column"]) for each in found["related"]] == [(1, 1), (4, 1)]
    assert "99 times" in found["related"][1]["message"]
