"""Files of makers as they are published: the package rtb-data, where it is installed. It is no dependency.

``pip install rtb-data`` brings URDF and xacro of KUKA, ABB, Unimation and others.
"""

from importlib.util import find_spec
from pathlib import Path

import pytest

from runtime.core.tomlfile import FileFault
from runtime.robot.files.importer import read_model
from tests.robolang.cli.commands import robolang

FOUND = find_spec("rtbdata")
FOLDER = None if FOUND is None or FOUND.origin is None else Path(FOUND.origin).parent
pytestmark = pytest.mark.skipif(FOLDER is None, reason="rtb-data is not installed")
ARMS = {
    "irb140": 6,
    "irb140QT": 6,
    "kr210l150": 6,
    "lbr_iiwa_14_r820": 7,
    "kr16_2": 6,
    "kr120r2500pro": 6,
    "puma560_robot": 6,
    "al5d_robot": 4,
}
"""Number of axes by file."""
CELL = """\
schema = 1
robot = "arm.urdf"
[home]
joints_deg = {home}
[hand]
mass_kg = 0.05
cog_mm = [0, 0, 60]
tcp_mm_deg = [0, 0, 113.7, 0, 0, 0]
stroke_mm = 80
grip_force_n = 20
dwell_s = 0.3
pad_mm = [20, 8, 40]
finger_length_mm = 52
"""


def files(ending):
    return sorted(FOLDER.rglob(f"*{ending}")) if FOLDER is not None else []


@pytest.mark.physics
@pytest.mark.parametrize("name", ARMS)
def test_a_published_arm_is_imported_and_moves(name, tmp_path):
    (path,) = (each for each in files(".urdf") if each.stem == name)
    arm, program = tmp_path / "arm.urdf", tmp_path / "a.rbl"
    arm.write_text(path.read_text())
    home = [0.0] * ARMS[name]
    (tmp_path / "a.cell.toml").write_text(CELL.format(home=home))
    # the KR 120 reaches down at zero: up, not through the floor
    turn = "-10" if name == "kr120r2500pro" else "10"
    program.write_text(f"MOVEJ JOINT({', '.join([turn] * ARMS[name])})\n")
    if name != "al5d_robot":  # bodies without inertia are refused without estimates
        robolang("check", "--motion", program)
        robolang("run", "--no-physics", program)
    said = robolang("robot", "import", arm, "--estimate").stdout
    assert "halved" in said or "doubled" in said
    robolang("run", program)


@pytest.mark.parametrize("path", files(".xacro"), ids=lambda path: path.name)
def test_a_xacro_is_refused_with_what_to_do(path):
    with pytest.raises(FileFault) as caught:
        read_model(path)
    assert caught.value.code in ("RBL601", "RBL621", "RBL608")
    if caught.value.code == "RBL621":
        assert "xacro" in caught.value.hint
