"""A part of 0.2 kg that slips out of the hand ends the run at the statement, as the mass is too small to be weighed."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from robolang.api.running import run
from robolang.cli.main import app

pytestmark = pytest.mark.physics

LIGHT = Path(__file__).parent / "attack_13_light_part_lost_silently" / "p.rbl"


def test_a_light_part_that_slips_out_is_lost():
    result = run(LIGHT)
    (alarm,) = result.report["alarms"]
    assert (alarm["code"], alarm["line"], alarm["category"]) == ("RBL536", 5, 1)
    assert alarm["time_s"] == pytest.approx(1.184, abs=0.1)
    assert not result.ok


def test_the_command_ends_with_a_motion_fault_at_its_place():
    result = CliRunner().invoke(app, ["run", str(LIGHT), "--quiet"])
    assert result.exit_code == 3
    assert f"{LIGHT}:5:1: error RBL536 " in result.stderr


def test_no_loss_stops_a_run_without_supervision(tmp_path):
    for path in LIGHT.parent.iterdir():
        (tmp_path / path.name).write_text(path.read_text("utf-8"), "utf-8")
    with (tmp_path / "p.cell.toml").open("a", encoding="utf-8") as cell:
        cell.write("\n[controller.supervision]\nenabled = false\n")
    assert run(tmp_path / "p.rbl").report["alarms"] == []
