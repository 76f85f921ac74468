"""Pulse tables of an arm with an axis that slides: mm a pulse, read and played by kinematics of their own."""

import json
import math

import numpy as np
import pytest

from robolang.project.project import load_project
from robolang.pulse_tables.drive import drive, start_angles
from robolang.pulse_tables.export import MANIFEST, ExportRequest, export
from runtime.core.faults import Fault
from runtime.core.tomlfile import FileFault
from runtime.core.units import MM
from runtime.pulses.channels import PULSES_PER_TURN
from runtime.pulses.folder import read_export
from runtime.pulses.replay import joint_values, positions, replay, tool_points
from runtime.robot.kinematics.kinematics import Kinematics
from tests.programs.test_scara import CELL

PROGRAM = """LOAD (0, 0, 40), 0.5
MOVE POSE(440, -160, 167, 180, 0, 180), SPEED 200, FINE
MOVE POSE(460, -100, 207, 180, 0, 150), SPEED 200, FINE
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    home = tmp_path_factory.mktemp("scara")
    (home / "p.rbl").write_text(PROGRAM)
    (home / "p.cell.toml").write_text(CELL.read_text())
    out = home / "out"
    out.mkdir()
    for name, text in export(load_project(home / "p.rbl"), ExportRequest()).files.items():
        (out / name).write_text(text)
    return out


@pytest.fixture(scope="module")
def project(folder):
    return load_project(folder.parent / "p.rbl")


def test_a_channel_of_a_slide_is_in_mm(folder):
    manifest = json.loads((folder / MANIFEST).read_text())
    assert manifest["mechanism"]["slides"] == ["J3"]
    channels = {each["name"]: each for each in manifest["channels"]}
    assert [channels[f"J{k}"]["unit"] for k in (1, 2, 3, 4)] == ["deg", "deg", "mm", "deg"]
    assert channels["J3"]["per_pulse"] == pytest.approx(20.0 / PULSES_PER_TURN)


def test_the_reader_finds_the_tool_where_the_arm_has_it(folder, project):
    read = read_export(folder)
    arm, cell = Kinematics(project.cell.robot), project.cell
    for move in read.moves:
        pulses = positions(move, np.linspace(0.0, move.steps * read.step_s, 9))
        expected = arm.forward(joint_values(read, pulses)) @ cell.hand.X_flange_tool
        np.testing.assert_allclose(tool_points(read, pulses), expected[:, :3, 3], rtol=0, atol=1e-12)
    assert max(found.worst_mm for found in replay(read)) < 0.1


@pytest.mark.physics
def test_the_arm_follows_the_tables(folder, project):
    driven = drive(read_export(folder), project.cell, project.profile)
    assert driven.alarms == ()
    assert max(move.error_mm for move in driven.moves) < 0.2
    first = start_angles(read_export(folder), project.cell)
    assert first[2] == pytest.approx(20.0 * MM, abs=0.01 * MM)


@pytest.mark.parametrize("slides", [["J5"], ["J3", "J3"], [3], [None], "J3", ["J2"], []])
def test_axes_that_slide_otherwise_than_their_channels_are_refused(folder, tmp_path, slides):
    out = tmp_path / "out"
    out.mkdir()
    for path in folder.iterdir():
        (out / path.name).write_bytes(path.read_bytes())
    manifest = json.loads((folder / MANIFEST).read_text())
    manifest["mechanism"]["slides"] = slides
    (out / MANIFEST).write_text(json.dumps(manifest))
    with pytest.raises(FileFault) as caught:
        read_export(out)
    assert caught.value.code == "RBL630"


def test_tables_of_an_arm_that_slides_elsewhere_are_not_played(folder, project, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    for path in folder.iterdir():
        (out / path.name).write_bytes(path.read_bytes())
    manifest = json.loads((folder / MANIFEST).read_text())
    del manifest["mechanism"]["slides"]
    channel = next(each for each in manifest["channels"] if each["name"] == "J3")
    channel |= {"unit": "deg", "per_pulse": math.degrees(channel["per_pulse"] * MM)}
    (out / MANIFEST).write_text(json.dumps(manifest))
    with pytest.raises(Fault) as caught:
        start_angles(read_export(out), project.cell)
    assert caught.value.code == "RBL634"
    assert "J3" in caught.value.message
