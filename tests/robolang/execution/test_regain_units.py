"""How far an arm is from its path, in the unit of the joint that is furthest away."""

import numpy as np
import pytest

from robolang.execution.regain import DEFAULT_LIMITS, displacement, refuse_beyond
from robolang.execution.session import Session
from robolang.project.project import load_project
from runtime.core.faults import Fault
from runtime.core.units import DEG, MM
from tests.messages import fields, numbers
from tests.programs.test_scara import CELL

HOME = np.array([-30.0 * DEG, 60.0 * DEG, 20.0 * MM, 0.0])


@pytest.fixture(scope="module")
def world(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scara")
    (folder / "p.rbl").write_text("MOVEJ HERE\n")
    (folder / "p.cell.toml").write_text(CELL.read_text())
    return Session(load_project(folder / "p.rbl"), physics=False).world


@pytest.mark.parametrize(("axis", "by", "unit"), [(2, 30.0 * MM, "mm"), (3, 30.0 * DEG, "deg")])
def test_a_distance_has_the_unit_of_the_joint(world, axis, by, unit):
    far = displacement(world, HOME, HOME + by * np.eye(4)[axis])
    assert (far.joint_deg, far.unit) == (pytest.approx(30.0), unit)
    with pytest.raises(Fault) as caught:
        refuse_beyond(DEFAULT_LIMITS, far, "it was left")
    assert caught.value.code == "RBL541"
    assert numbers(caught.value.message)[-1] == DEFAULT_LIMITS.joint_deg
    assert caught.value.message.endswith(f"{DEFAULT_LIMITS.joint_deg:g} {unit} in a joint")


def test_a_joint_that_is_lost_is_away(world):
    far = displacement(world, HOME, HOME + np.nan * np.eye(4)[2])
    assert far.is_away
    assert fields(str(far)) is not None
