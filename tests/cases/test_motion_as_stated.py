"""Cases in which the arm made another motion than the program states, and nothing said so."""

import json
from pathlib import Path

import numpy as np
import pytest

from robolang.api.running import run
from tests.robolang.cli.commands import dry, places, robolang

HERE = Path(__file__).parent


def codes_at(program: Path) -> list[tuple[int, str]]:
    """Return line and code of what check --motion finds."""
    return [(line, code) for line, _, code in places(robolang("check", "--motion", program).stdout)]


@pytest.mark.physics
@pytest.mark.parametrize(
    ("case", "found"),
    [
        ("reports_09_speed_lost_to_rotation", [(4, "RBL429"), (5, "RBL429"), (6, "RBL429")]),
        ("reports_10_movej_changes_configuration", [(5, "RBL435")]),
    ],
)
def test_a_run_and_a_check_say_the_same(case, found, tmp_path):
    program, report = HERE / case / "p.rbl", tmp_path / "r.json"
    assert codes_at(program) == found
    said = dry(program, "--quiet", "--report", report).stderr
    assert [(line, code) for line, _, code in places(said)] in (found, [])  # a quiet run prints errors only
    warned = json.loads(report.read_text())["warnings"]
    assert [(row["line"], row["code"]) for row in warned] == found


def test_reports_10_a_joint_move_keeps_the_configuration_that_reaches_the_target():
    result = run(HERE / "reports_10_movej_changes_configuration" / "p.rbl", physics=False)
    q = np.degrees(result.log["q_cmd"])
    np.testing.assert_allclose(q[-1], [-8.0, 77.0, -183.0, 0.0, -74.0, -70.0], atol=0.1)
