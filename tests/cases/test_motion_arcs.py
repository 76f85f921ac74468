"""Cases about arcs that are none: a full circle, and three points in a line."""

from pathlib import Path

import pytest

from robolang.execution.dry_run import motion_check
from robolang.project.project import load_project
from tests.robolang.cli.commands import dry, places, robolang

HERE = Path(__file__).parent


@pytest.mark.physics
@pytest.mark.parametrize(
    ("case", "two_movecs"),
    [
        ("reports_19_full_circle_help", True),
        ("reports_32_arc_collinear", False),
    ],
)
def test_an_arc_that_is_none_says_what_would_be_one(case, two_movecs):
    program = HERE / case / "p.rbl"
    (found,) = motion_check(load_project(program))
    assert ("two MOVECs" in found.hint) is two_movecs
    assert places(robolang("check", "--motion", program, code=1).stdout) == [(5, 1, "RBL416")]
    assert places(dry(program, "--quiet", code=3).stderr) == [(5, 1, "RBL416")]


def test_a_full_circle_takes_two_movecs(tmp_path):
    case = HERE / "reports_19_full_circle_help"
    (tmp_path / "p.cell.toml").write_text((case / "p.cell.toml").read_text())
    text = (
        (case / "p.rbl")
        .read_text()
        .replace("MOVEC A + (100,0,0), A", "MOVEC A + (50,50,0), A + (100,0,0)\nMOVEC A + (50,-50,0), A")
    )
    (tmp_path / "p.rbl").write_text(text)
    assert motion_check(load_project(tmp_path / "p.rbl")) == ()
