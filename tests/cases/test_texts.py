"""Cases about texts: places that lie outside of what is shown, and what an expression says."""

from pathlib import Path

from tests.lang.cli.commands import places, robolang

HERE = Path(__file__).parent


def test_attack_03_a_fault_far_along_a_line_of_xml():
    arm = HERE / "attack_03_xml_error_on_long_line_traceback" / "w2.urdf"
    assert places(robolang("robot", "show", arm, code=2).stderr) == [(1, 257, "RBL604")]
