"""What the test of a new project expects of an arm from a file: what its run does, with its drives or without."""

import re
import tomllib

import pytest

from robolang.execution.session import Session
from robolang.templates import trial
from robolang.templates.arm import choose
from robolang.templates.fitting import fitted
from robolang.templates.template import TEST, template
from robolang.templates.trial import Outcome
from robolang.templates.writing import new_project
from runtime.core.faults import Fault
from tests.robolang.cli.commands import PUMA, robolang

# a place is checked with the shapes of MuJoCo
pytestmark = pytest.mark.physics

TEXT = template("pick-place").texts[TEST]


def puma(path, **changed):
    """A file of a Puma, the value of a key of every axis changed by a function."""
    text = PUMA.read_text("utf-8").replace('name = "puma560"', 'name = "mine"', 1)
    for key, change in changed.items():
        head, *rest = re.split(rf"(?m)^{key} = ([-\d.e]+)", text)
        values = (
            f"{key} = {change(float(value)):g}{after}" for value, after in zip(rest[::2], rest[1::2], strict=True)
        )
        text = head + "".join(values)
    path.write_text(text, "utf-8")
    return str(path)


def test_an_arm_whose_drives_cannot_do_the_job_is_tested_as_an_ideal_one(tmp_path):
    robot = tmp_path / "mine.toml"
    puma(robot)
    # more friction in the drive of J1 than its torque
    robot.write_text(robot.read_text("utf-8").replace("[0.395, 0.435]", "[9, 9]", 1), "utf-8")
    written = new_project(tmp_path / "cell1", "pick-place", str(robot))
    expected = tomllib.loads((written.folder / "cell1.test.toml").read_text("utf-8"))
    assert expected["physics"] is False
    assert not written.physics
    assert "RBL515" in written.notes[0]
    robolang("test", written.folder)


def test_an_arm_that_settles_slowly_is_expected_to_warn_of_it(tmp_path):
    robot = puma(tmp_path / "mine.toml", position_bandwidth_rad_s=lambda value: 0.1 * value)
    written = new_project(tmp_path / "cell1", "pick-place", robot)
    expected = tomllib.loads((written.folder / "cell1.test.toml").read_text("utf-8"))
    assert expected["expect"]["warnings"] == ["RBL523"]
    assert "RBL523" in written.notes[0]
    robolang("test", written.folder)


def test_drives_that_cannot_be_simulated_leave_the_ideal_arm(tmp_path, monkeypatch):
    def session(project, *, physics):
        if physics:
            raise Fault("RBL608", "no drives")
        return Session(project, physics=False)

    monkeypatch.setattr(trial, "Session", session)
    found = fitted(template("pick-place"), choose(puma(tmp_path / "mine.toml"), tmp_path / "cell1"))
    assert tomllib.loads(found.texts[TEST])["physics"] is False
    assert "RBL608" in found.notes[0]


def test_an_arm_that_does_its_job_in_no_case_gets_no_project(tmp_path, monkeypatch):
    monkeypatch.setattr(trial, "_run", lambda *_, physics: Outcome(done=False, physics=physics, why=f"{physics}"))
    with pytest.raises(Fault, match="RBL843") as caught:
        fitted(template("pick-place"), choose(puma(tmp_path / "mine.toml"), tmp_path / "cell1"))
    assert "False" in caught.value.message


@pytest.mark.parametrize(
    ("outcome", "cycle"),
    [
        (Outcome(), [9.5, 11.5]),
        (Outcome(seconds=12.0), [9.5, 13.7]),
        (Outcome(seconds=9.0), [9.5, 11.5]),
    ],
)
def test_a_run_may_take_the_planned_time_or_that_of_the_trial(outcome, cycle):
    assert tomllib.loads(outcome.stated(TEXT, 10.0))["expect"]["cycle_s"] == pytest.approx(cycle)


def test_a_test_states_its_arm_and_its_warnings_and_keeps_the_rest():
    stated = tomllib.loads(Outcome(physics=False, warnings=("RBL523", "RBL535")).stated(TEXT, 10.0))
    assert (stated["physics"], stated["expect"]["warnings"]) == (False, ["RBL523", "RBL535"])
    assert "physics" not in tomllib.loads(Outcome().stated(TEXT, 10.0))
    assert stated["expect"]["parts"] == tomllib.loads(TEXT)["expect"]["parts"]


def test_a_robot_file_with_the_name_of_a_file_of_the_project_is_refused(tmp_path):
    robot = puma(tmp_path / "cell1.cell.toml")
    with pytest.raises(Fault, match="RBL842") as caught:
        new_project(tmp_path / "cell1", "pick-place", robot)
    assert "cell1.cell.toml" in caught.value.message
    assert not (tmp_path / "cell1").exists()
