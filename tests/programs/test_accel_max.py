"""ACCEL MAX in programs on two ideal arms: lines and chains gain, joint moves stay, and the profile says the same."""

from pathlib import Path

import numpy as np
import pytest

from robolang.execution.dry_run import rehearse
from robolang.execution.session import Session
from robolang.project.project import load_project

CELLS = {"puma560": "", "ur5e": (Path(__file__).parents[2] / "programs/universal/lines.cell.toml").read_text()}
MOVES = """\
LOAD (0, 0, 50), 0.8
p = HERE
MOVE p + (0, 0, -100), SPEED 800
MOVE p + (0, 60, -100), SPEED 800, ZONE 20
MOVE p + (0, 120, -60), SPEED 800
MOVEJ p
"""


@pytest.fixture(params=CELLS)
def ran(request, tmp_path):
    def run(first, options=None):
        path = tmp_path / "p.rbl"
        path.write_text(f"{first}\n{MOVES}")
        if CELLS[request.param]:
            path.with_suffix(".cell.toml").write_text(CELLS[request.param])
        project = load_project(path, options=options)
        result = Session(project, physics=False).run()
        assert result.ok, result.report
        assert rehearse(project).total_us == pytest.approx(result.report["sim_time_s"] * 1e6, abs=8000.0)
        return result

    return run


def planned(result):
    """The planned times of the line, of the two moves of the chain, and of the joint move, s."""
    line, first, second, joints = (row["planned_s"] for row in result.report["statements"] if "MOVE" in row["text"])
    return line, first + second, joints


def test_lines_and_chains_gain_and_joint_moves_stay(ran):
    stated, most = ran("ACCEL 100"), ran("ACCEL MAX")
    gains = np.subtract(planned(stated), planned(most))
    assert (gains[:2] > 0.0).all()
    assert gains[2] == 0.0
    of_profile = ran("", {"acceleration": ("--set", "max")})
    assert np.array_equal(of_profile.log["q_cmd"], most.log["q_cmd"])
