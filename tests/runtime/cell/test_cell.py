"""The cell file: what it becomes, and the place and code of everything that can be wrong with it."""

import math
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

from robolang.project.builtin import cell_text
from runtime.cell.cell import CellSpec
from runtime.core.frames import pose_from_xyzrpy
from runtime.core.tomlfile import FileFault, Source
from tests.runtime.from_texts import load_cell, parse_cell

ROBOT = resources.files("runtime.robot.library").joinpath("puma560.toml").read_text("utf-8")


def parse(text: str, folder: Path | None = None) -> CellSpec:
    return parse_cell(Source("demo.cell.toml", text), folder)


def edited(old: str, new: str) -> str:
    text = cell_text()
    assert text.count(old) == 1, old
    return text.replace(old, new)


def refused(text: str, folder: Path | None = None) -> FileFault:
    with pytest.raises(FileFault) as caught:
        parse(text, folder)
    return caught.value


def line_of(text: str, fragment: str) -> int:
    """1-based line of the last occurrence of a fragment."""
    return text[: text.rindex(fragment)].count("\n") + 1


def test_builtin_cell_in_si() -> None:
    cell = parse(cell_text())
    part = cell.parts[0]
    assert cell.robot.name == "puma560"
    assert (cell.hand.mass, cell.hand.stroke, cell.hand.grip_force) == (0.8, pytest.approx(0.08), 120.0)
    np.testing.assert_allclose(cell.hand.X_flange_tool[:3, 3], [0.0, 0.0, 0.1137])
    np.testing.assert_allclose(part.X_world_part, pose_from_xyzrpy([0.48, -0.22, 0.64, 0.0, 0.0, 0.0]))
    np.testing.assert_allclose(part.size, [0.06, 0.04, 0.08])
    assert cell.loads["hand_and_part"].mass == pytest.approx(cell.hand.mass + part.mass)
    assert cell.controller == {}
    table = cell.obstacles[0]
    assert table.X_world_obstacle[2, 3] + table.size[2] / 2.0 == pytest.approx(0.6, abs=1e-12)


def test_builtin_load_is_the_hand_with_its_part() -> None:
    """(0.8 * 60 + 1.5 * 113.7) / 2.3 mm, the figure of the 1992 listing."""
    cell = parse(cell_text())
    m_hand, m_part = cell.hand.mass, cell.parts[0].mass
    cog = (m_hand * cell.hand.cog + m_part * cell.hand.X_flange_tool[:3, 3]) / (m_hand + m_part)
    np.testing.assert_allclose(cell.loads["hand_and_part"].cog, cog, atol=5e-5)


def test_a_cylinder_in_si() -> None:
    cell = parse(edited("size_mm = [60, 40, 80]", 'shape = "cylinder"\ndiameter_mm = 40\nheight_mm = 80'))
    assert cell.parts[0].shape == "cylinder"
    np.testing.assert_allclose(cell.parts[0].size, [0.04, 0.04, 0.08])


FINGERS = "stroke_mm = 80\ngrip_force_n = 120\n"
PADS = "pad_mm = [20, 8, 40]\nfinger_length_mm = 52\n"
CUP = 'kind = "suction"\nholding_force_n = {}\ncup_diameter_mm = {}\n'


def with_cup(force="40", diameter="30", more=""):
    text = cell_text()
    assert FINGERS in text and PADS in text
    return text.replace(FINGERS, CUP.format(force, diameter) + more).replace(PADS, "")


def test_a_cup_in_si() -> None:
    hand = parse(with_cup()).hand
    assert (hand.is_cup, hand.grip_force, hand.finger_length, hand.stroke) == (True, 40.0, 0.03, 0.0)
    np.testing.assert_allclose(hand.pad, [0.015, 0.015, 0.03])


@pytest.mark.parametrize(
    ("wrong", "code"),
    [
        ({"force": "nan"}, "RBL604"),
        ({"force": "0"}, "RBL605"),
        ({"diameter": "-30"}, "RBL605"),
        ({"diameter": '"30"'}, "RBL613"),
        ({"more": "stroke_mm = 80\n"}, "RBL609"),
    ],
)
def test_a_cup_that_is_none_is_refused(wrong, code) -> None:
    assert refused(with_cup(**wrong)).code == code


def test_arrays_are_read_only() -> None:
    cell = parse(cell_text())
    for array in (cell.home, cell.hand.cog, cell.hand.X_flange_tool, cell.parts[0].size, cell.tools["grip"]):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0.0


def test_frames_and_controller_are_handed_on() -> None:
    text = f"{cell_text()}\n[frames.bench]\npose_mm_deg = [1000, 0, 500, 0, 0, 90]\n"
    text += "[controller]\nservo_period_ms = 0.5\n"
    cell = parse(text)
    np.testing.assert_allclose(cell.frames["bench"], pose_from_xyzrpy([1.0, 0.0, 0.5, 0.0, 0.0, math.pi / 2]))
    assert {key: given.value for key, given in cell.controller.items()} == {"servo_period_ms": 0.5}


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("schema = 1", "schema = 2", "RBL605"),
        ('robot = "puma560"', 'robot = "puma56"', "RBL610"),
        ("mass_kg = 1.5", "mass_kg = nan", "RBL604"),
        ("mass_kg = 1.5", "mass_kg = -1.5", "RBL605"),
        ("mass_kg = 1.5", 'mass_kg = "1.5"', "RBL613"),
        ("grip_force_n = 120", "grip_force_n = inf", "RBL604"),
        ("stroke_mm = 80", "stroke_mm = 0", "RBL605"),
        ("friction = 0.6", "friction = 0", "RBL605"),
        ("size_mm = [60, 40, 80]", "size_mm = [60, -40, 80]", "RBL605"),
        ("size_mm = [60, 40, 80]", "size_mm = [60, 40]", "RBL613"),
        ("size_mm = [60, 40, 80]", 'shape = "sphere"\nsize_mm = [60, 40, 80]', "RBL610"),
        ("size_mm = [60, 40, 80]", 'diameter_mm = nan\nheight_mm = 80\nshape = "cylinder"', "RBL604"),
        ("size_mm = [60, 40, 80]", 'height_mm = 0\ndiameter_mm = 40\nshape = "cylinder"', "RBL605"),
        ("pose_mm_deg = [480, -220, 640, 0, 0, 0]", "pose_mm_deg = [480, -220, nan, 0, 0, 0]", "RBL604"),
        ("pose_mm_deg = [480, -220, 640, 0, 0, 0]", "pose_mm_deg = [480, -220, 640]", "RBL613"),
        ("dwell_s = 0.3", "dwell_s = 1e9", "RBL605"),
        ("stroke_mm = 80", 'kind = "magnet"\nstroke_mm = 80', "RBL610"),
        ('name = "part"', 'name = "table"', "RBL610"),
        ('name = "part"', 'name = "TABLE"', "RBL610"),
        ("[hand]", "[frames.World]\npose_mm_deg = [0, 0, 0, 0, 0, 0]\n[hand]", "RBL610"),
        ("[hand]", "[tools.FLANGE]\npose_mm_deg = [0, 0, 0, 0, 0, 0]\n[hand]", "RBL610"),
        ('name = "part"', 'name = "a part"', "RBL613"),
    ],
)
def test_a_bad_value_is_refused_at_its_line(old: str, new: str, code: str) -> None:
    text = edited(old, new)
    fault = refused(text)
    assert (fault.code, fault.line) == (code, line_of(text, new)), str(fault)
    assert fault.path == "demo.cell.toml"


def test_an_unknown_key_is_refused_with_a_suggestion() -> None:
    text = edited("friction = 0.6", "friktion = 0.6")
    fault = refused(text)
    assert (fault.code, fault.line) == ("RBL609", line_of(text, "friktion"))
    assert "friction" in fault.hint


@pytest.mark.parametrize("table", ["", "home", "hand", "loads.empty", "tools.grip"])
def test_every_table_rejects_keys_that_nobody_reads(table: str) -> None:
    text = cell_text()
    header = f"[{table}]\n" if table else "schema = 1\n"
    fault = refused(text.replace(header, f"{header}zzz = 1\n"))
    assert fault.code == "RBL609"
    assert "zzz" in fault.message


def test_a_missing_key_is_refused() -> None:
    fault = refused(edited("cog_mm = [0, 0, 60]\ntcp", "tcp"))
    assert (fault.code, "hand.cog_mm" in fault.message) == ("RBL608", True)


def test_home_needs_one_angle_per_axis() -> None:
    text = "\n".join("joints_deg = [0, 90, -90]" if "joints_deg" in row else row for row in cell_text().splitlines())
    fault = refused(text)
    assert (fault.code, fault.line) == ("RBL613", line_of(text, "joints_deg"))


def test_home_must_be_inside_the_ranges() -> None:
    row = "joints_deg = [0, 90, 60, 0, 45, 0]"
    text = "\n".join(row if "joints_deg" in old else old for old in cell_text().splitlines())
    fault = refused(text)
    assert (fault.code, fault.line) == ("RBL605", line_of(text, row))
    assert "J3" in fault.message


@pytest.mark.parametrize(
    "name", ["/etc/p.toml", "../p.toml", "a/../../p.toml", "C:\\\\p.toml", "..\\\\p.toml", "p\\u0000.toml"]
)
def test_a_robot_outside_the_folder_is_refused(name: str, tmp_path: Path) -> None:
    text = edited('robot = "puma560"', f'robot = "{name}"')
    fault = refused(text, tmp_path)
    assert (fault.code, fault.line) == ("RBL602", line_of(text, "robot ="))


def test_a_symlink_out_of_the_folder_is_refused(tmp_path: Path) -> None:
    inside = tmp_path / "inside"
    inside.mkdir()
    (tmp_path / "secret.toml").write_text(ROBOT)
    (inside / "p.toml").symlink_to(tmp_path / "secret.toml")
    text = edited('robot = "puma560"', 'robot = "p.toml"')
    assert refused(text, inside).code == "RBL602"
    (inside / "loop.toml").symlink_to(inside / "loop.toml")
    assert refused(text.replace("p.toml", "loop.toml"), inside).code in ("RBL600", "RBL602")


def test_a_robot_beside_the_cell_is_read(tmp_path: Path) -> None:
    (tmp_path / "robots").mkdir()
    (tmp_path / "robots" / "mine.toml").write_text(ROBOT.replace('name = "puma560"', 'name = "mine"'))
    path = tmp_path / "demo.cell.toml"
    path.write_text(edited('robot = "puma560"', 'robot = "robots/mine.toml"'))
    assert load_cell(path).robot.name == "mine"
    assert refused(path.read_text()).code == "RBL602"


def test_a_fault_in_the_robot_file_is_located_there(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(ROBOT.replace("mass_kg = 4.8", "mass_kg = nan"))
    fault = refused(edited('robot = "puma560"', 'robot = "mine.toml"'), tmp_path)
    assert (fault.code, Path(fault.path).name) == ("RBL604", "mine.toml")


def test_names_of_loads_do_not_tell_capitals_apart() -> None:
    text = cell_text() + "\n[loads.Empty]\nmass_kg = 1\ncog_mm = [0, 0, 0]\n"
    fault = refused(text)
    assert (fault.code, fault.line) == ("RBL610", line_of(text, "[loads.Empty]"))
