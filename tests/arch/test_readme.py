"""Every limit that README.md states is held against the product: a limit that falls must leave the page."""

import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

import robolang
from robolang.cli.main import app
from robolang.execution import run_bounds
from robolang.execution.session import Session
from robolang.syntax.keywords import INSTRUCTIONS
from runtime.robot.files.imported import FEWEST_AXES, MOST_AXES
from runtime.robot.files.loader import load_builtin
from runtime.robot.files.robot_file import library
from runtime.settings.profile import Profile
from tests.bench.gcode_campaign import CELL

ROOT = Path(__file__).parents[2]
SECTION = (ROOT / "README.md").read_text("utf-8").partition("Limits to know")[2].partition("\n## ")[0]
LIMITS = {
    lead: " ".join(text.split())
    for lead, text in re.findall(r"^- \*\*(.+?)\.\*\* (.+?)(?=^- |\Z)", SECTION, re.MULTILINE | re.DOTALL)
}


def run(folder, *lines):
    """Run a program on the ideal irb2400."""
    (folder / "p.cell.toml").write_text(CELL)
    (folder / "p.rbl").write_text("\n".join(lines))
    return robolang.run(folder / "p.rbl", physics=False)


def estimates(text, folder):
    shown = CliRunner().invoke(app, ["robot", "show", "puma560"]).output.lower()
    for named in ("torque constant", "encoder", "current loop", "bandwidth"):
        assert named in text and named.split()[0] in shown


def friction_is_known(text, folder):
    assert Profile().servo.friction_compensation == 1.0
    assert Profile().supervision.friction is None  # what the plant has


def rigid_links(text, folder):
    springs = {name: [axis.motor.elastic for axis in load_builtin(name).axes] for name in library()}
    assert {name for name in springs if any(springs[name])} == set(re.findall(r"`(\w+)`", text))
    assert springs["manutec_r3"] == [True] * 3 + [False] * 3


def robots(text, folder):
    assert set(re.findall(r"`(\w+)`", text)) == set(library())
    assert f"{FEWEST_AXES} to {MOST_AXES} revolute axes" in text


def configurations(text, folder):
    assert run(folder, "MOVE JOINT(10, 10, 0, 0, 80, 0)").ok
    with pytest.raises(robolang.ProgramError) as refused:
        run(folder, "MOVE JOINT(0, -80, 20, 0, 60, 0)")  # leaning back over axis 1: the other arm configuration
    assert [item.code for item in refused.value.diagnostics] == ["RBL412"]


def chains(text, folder):
    """A line of 200 mm in 20 pieces takes as long as one move, however few of them are planned ahead."""

    def line(*stations):
        poses = [f"POSE(900, {y}, 900, 180, 0, 180)" for y in (-100, *stations)]
        moves = [f"MOVE {each}, SPEED 50, ZONE 10" for each in poses[1:]]
        return sum(each["duration_s"] for each in run(folder, f"MOVEJ {poses[0]}", *moves).report["statements"][1:])

    pieces = range(-90, 101, 10)
    assert line(*pieces) == pytest.approx(line(100), rel=0.02)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(run_bounds, "MOST_AHEAD", 10)
        assert line(*pieces) == pytest.approx(line(100), rel=0.02)


def stops(text, folder):
    assert not hasattr(Session, "resume")


def language(text, folder):
    said = text.partition("run: ")[2].partition(". ")[0].split(", ")
    assert sorted(said) == sorted(INSTRUCTIONS | {"ON ERROR"})
    assert not INSTRUCTIONS & {"INTERRUPT", "TASK", "CYCLE"}


CHECKS = (estimates, friction_is_known, rigid_links, robots, configurations, chains, stops, language)
NOTHING_TO_HOLD_AGAINST = {"No safety function", "Seams"}
"""What the product is for, and what nobody can know before a move."""


@pytest.mark.parametrize("assert_limit", CHECKS, ids=lambda check: check.__name__)
def test_a_limit_that_the_readme_states_is_one(assert_limit, tmp_path):
    lead = assert_limit.__name__.replace("_", " ").capitalize()
    assert_limit(LIMITS[lead], tmp_path)


def test_every_limit_has_its_check():
    held = {check.__name__.replace("_", " ").capitalize() for check in CHECKS}
    assert set(LIMITS) == held | NOTHING_TO_HOLD_AGAINST
