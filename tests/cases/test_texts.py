"""Cases about texts: places that lie outside of what is shown, and what an expression says."""

import json
from pathlib import Path

from tests.robolang.cli.commands import dry, places, robolang

HERE = Path(__file__).parent


def printed(program, folder, code=0):
    """What a program prints on the ideal arm."""
    report = folder / "r.json"
    dry(program, "--quiet", "--report", report, code=code)
    return [item["text"] for item in json.loads(report.read_text())["printed"]]


def test_reports_12_mod_and_product_are_worked_out_from_the_left(tmp_path):
    program = HERE / "reports_12_mod_binds_tighter" / "p.rbl"
    assert printed(program, tmp_path) == ["1", "2.5", "2"]
    found = places(robolang("check", program).stdout)
    assert found == [(row, 7, "RBL231") for row in (1, 2, 3)]


def test_reports_18_equality_of_rounded_numbers(tmp_path):
    program = HERE / "reports_18_float_equality" / "p.rbl"
    assert printed(program, tmp_path) == ["not equal", "0.3"]
    assert places(robolang("check", program).stdout) == [(2, 4, "RBL232")]


def test_attack_03_a_fault_far_along_a_line_of_xml():
    arm = HERE / "attack_03_xml_error_on_long_line_traceback" / "w2.urdf"
    assert places(robolang("robot", "show", arm, code=2).stderr) == [(1, 257, "RBL604")]
