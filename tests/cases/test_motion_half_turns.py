"""Cases about exact half turns: the direction that keeps the range, on the ideal arm."""

from pathlib import Path

import numpy as np
import pytest

from robolang.api.running import run

HERE = Path(__file__).parent


def j6_after_each_move(program: Path) -> list[float]:
    """Run a program and return J6 in deg at the end of each of its moves."""
    result = run(program, physics=False)
    assert result.ok
    ends = [
        round(row["start_s"] * 1000.0) + round(row["duration_s"] * 1000.0)
        for row in result.report["statements"]
        if row["planned_s"] is not None
    ]
    return np.degrees(result.log["q_cmd"][np.array(ends) - 1, 5]).tolist()


@pytest.mark.parametrize(
    ("case", "j6"),
    [
        ("reports_05_turn180_pose", [108.2, -71.8]),
        ("reports_07_turn180_sign_of_zero", [150.0, -30.0]),
        ("reports_55_joint_end_half_a_turn_away", [150.0, -30.0, 150.0]),
    ],
)
def test_a_half_turn_stays_in_the_range(case, j6):
    assert j6_after_each_move(HERE / case / "p.rbl") == pytest.approx(j6, abs=0.1)


@pytest.mark.parametrize("turn", ["180", "-180", "179.99999999", "-179.99999999", "540"])
def test_one_pose_written_in_several_ways_is_one_move(tmp_path, turn):
    case = HERE / "reports_07_turn180_sign_of_zero"
    (tmp_path / "p.cell.toml").write_text((case / "p.cell.toml").read_text())
    text = (case / "p.rbl").read_text()
    (tmp_path / "p.rbl").write_text(text.replace("0,180)", f"0,{turn})"))
    assert j6_after_each_move(tmp_path / "p.rbl")[-1] == pytest.approx(-30.0, abs=1e-3)


ROWS = """LOAD (0,0,60),0.8
SPEED 500
SPEEDJ 100
FOR n = 0 TO 4
  MOVEJ POSE(400 + 20 * n, 60, 700, 180, 0, 90)
  MOVE HERE * (0, 0, 0, 0, 0, 180)
  MOVE POSE(400 + 20 * n, 60, 700, 180, 0, 90)
NEXT n
"""


def test_every_row_of_a_pallet_turns_the_same(tmp_path):
    (tmp_path / "p.cell.toml").write_text((HERE / "reports_05_turn180_pose" / "p.cell.toml").read_text())
    (tmp_path / "p.rbl").write_text(ROWS)
    ends = np.array(j6_after_each_move(tmp_path / "p.rbl")).reshape(5, 3)
    np.testing.assert_allclose(ends[:, 1] - ends[:, 0], -180.0, atol=1e-3)
    np.testing.assert_allclose(ends[:, 2] - ends[:, 1], 180.0, atol=1e-3)
