"""Every template on every built-in robot: a new project passes all checks as it is, and its test."""

from functools import cache
from itertools import product

import numpy as np
import pytest

from robolang.execution.session import Session
from robolang.project.project import load_project
from robolang.templates.arm import choose
from robolang.templates.fitting import fitted
from robolang.templates.template import NAMES, template
from robolang.templates.writing import new_project
from robolang.testing.expectation import load_expectation
from robolang.testing.verdict import judge
from runtime.core.faults import Fault
from runtime.robot.files import robot_file
from tests.campaign import some
from tests.robolang.cli.commands import PUMA, robolang

# a place is checked with the shapes of MuJoCo
pytestmark = pytest.mark.physics

PAIRS = list(product(NAMES, robot_file.library()))
SEARCHED = ("ur10e", "ur5e")
"""Arms without a closed form whose places take seconds to find: one job of each is enough of a sample."""
SAMPLE = [at for at, (kind, robot) in enumerate(PAIRS) if robot not in SEARCHED or (kind, robot) == ("tend", "ur5e")]


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Make a project, once for each template and robot; the tests only read it."""

    @cache
    def made_once(kind, robot):
        return new_project(tmp_path_factory.mktemp("made") / "cell1", kind, robot).folder / "cell1.rbl"

    return made_once


def judged(program, physics):
    project, expected = load_project(program), load_expectation(program.with_suffix(".test.toml"))
    session = Session(project, physics=physics)
    result = session.run()
    return [verdict for verdict in judge(expected, session, result.report, result.log, False) if not verdict.ok]


@pytest.mark.parametrize(("kind", "robot"), some(PAIRS, *SAMPLE))
def test_a_new_project_has_no_finding_and_the_layout_of_fmt(made, kind, robot):
    program = made(kind, robot)
    robolang("check", "--strict", "--motion", program.parent)
    robolang("fmt", "--check", program.parent)


@pytest.mark.parametrize(("kind", "robot"), some(PAIRS, 0, 4, 8))
def test_a_run_of_a_new_project_is_as_its_test_expects(made, kind, robot):
    assert judged(made(kind, robot), True) == []


@pytest.mark.parametrize("kind", NAMES)
def test_a_template_runs_as_it_is_in_the_library(kind):
    found = template(kind)
    assert found.title.endswith(".")
    assert 20 <= len(found.texts[".rbl"].splitlines()) <= 56


def arm(tmp_path, *changes):
    """A file of a Puma with other numbers, and no closed form."""
    text = PUMA.read_text("utf-8").replace('name = "puma560"', 'name = "mine"', 1)
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path = tmp_path / "mine.toml"
    path.write_text(text, "utf-8")
    return choose(str(path), tmp_path / "elsewhere")


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ([("rated_payload_kg = 2.5", "rated_payload_kg = 1")], ["1.1 kg", "1 kg"]),
        ([("range_deg = [-100, 100]", "range_deg = [-5, 5]")], ["mine"]),
    ],
    ids=["weak", "bent"],
)
def test_a_robot_that_a_template_does_not_fit_is_refused_with_the_reason(tmp_path, changes, says):
    with pytest.raises(Fault) as caught:
        fitted(template("pick-place"), arm(tmp_path, *changes))
    assert caught.value.code == "RBL843"
    assert all(each in caught.value.message for each in says)
    # no finding of a rehearsal: none was made
    assert "RBL" not in caught.value.message
    assert list(tmp_path.iterdir()) == [tmp_path / "mine.toml"]


def test_a_table_may_stand_on_any_side_of_an_arm(tmp_path):
    # J1 looks to the left only
    turned = fitted(template("tend"), arm(tmp_path, ("range_deg = [-160, 160]", "range_deg = [20, 160]")))
    path = tmp_path / "job.rbl"
    for ending, text in turned.texts.items():
        path.with_suffix(ending).write_text(text, "utf-8")
    cell = load_project(path).cell
    (table,) = (each.X_world_obstacle for each in cell.obstacles if each.name == "table")
    assert table[1, 3] > 0.3
    assert abs(table[0, 3]) < 1e-9
    assert 20 <= np.degrees(cell.home[0]) <= 160
    assert judged(path, False) == []
