"""Programs of public reports that run as they should: arithmetic, moves of nothing, waits, arcs, blends, the wrist."""

import json
from pathlib import Path

import numpy as np
import pytest

from tests.robolang.cli.commands import dry, places, robolang

HERE = Path(__file__).parent
SPEEDS = np.array([151.0, 87.7, 176.0, 237.0, 250.0, 235.0])
"""Joint speeds that the arm of the cases may have, deg/s."""
ACCELERATIONS = np.array([600.0, 400.0, 900.0, 1800.0, 1800.0, 1800.0])
"""Its joint accelerations, deg/s2."""


@pytest.mark.parametrize(
    ("case", "lines"),
    [
        ("reports_30_unary_minus", ["-4 0.25 -0.25 256 -16 -8 -4 4 2"]),
        ("reports_34_nowhere", ["0.024"]),
        ("reports_51_bom_crlf_program", ["bom", "crlf"]),
        (
            "reports_53_wait_timeouts",
            [
                "t 0.504",
                "err 503 0.504",
                "resumed 0.504",
                "err 503 0.512",
                "res2 0.512",
                "err 503 0.616",
                "res3 0.616",
                "got2 1",
                "already 1",
            ],
        ),
    ],
)
def test_what_a_program_prints(case, lines, tmp_path):
    report = tmp_path / "r.json"
    dry(HERE / case / "p.rbl", "--quiet", "--report", report)
    assert [item["text"] for item in json.loads(report.read_text())["printed"]] == lines


def test_reports_32_an_arc_over_a_point_in_line():
    result = dry(HERE / "reports_32_arc_collinear" / "p.rbl", "--quiet", code=3)
    assert places(result.stderr) == [(5, 1, "RBL416")]


@pytest.mark.physics
def test_reports_35_tiny_moves(tmp_path):
    robolang("check", "--motion", HERE / "reports_35_tiny_moves" / "p.rbl", "--times", tmp_path / "t.json")
    (times,) = json.loads((tmp_path / "t.json").read_text())
    assert times["complete"]
    assert [line["seconds"] for line in times["lines"]] == [0.008, 0.040, 0.048, 2.032]


@pytest.mark.parametrize(
    "case", ["reports_37_small_arcs_in_zones", "reports_38_slow_after_fast_in_zone", "reports_40_line_through_wrist"]
)
def test_commands_within_speed_and_acceleration(case, tmp_path):
    dry(HERE / case / "p.rbl", "--quiet", "--log", tmp_path / "l.npz")
    with np.load(tmp_path / "l.npz") as log:
        speed = np.degrees(log["dq_cmd"])
    assert len(speed) > 100
    assert (np.abs(speed).max(axis=0) <= 1.001 * SPEEDS).all()
    assert (np.abs(np.diff(speed, axis=0)).max(axis=0) <= 1.001 * ACCELERATIONS * 1e-3).all()
    assert (np.abs(speed).max(axis=0) > 0.0).any()
