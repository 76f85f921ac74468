"""Tables over joint angles: exact at the points, straight between, flat outside."""

import numpy as np
import pytest

from runtime.robot.model.joint_table import JointTable

GRID = ((-1.0, 0.1, 2.0), (-0.3, 0.7))
ONE = JointTable(joints=(2,), grid=GRID[:1], values=(0.1, -0.7, 3.3))
TWO = JointTable(joints=(1, 2), grid=GRID, values=(0.1, 0.2, -0.7, 1.3, 3.3, 0.9))


def posture(*angles):
    return np.array([9.0, *angles, 9.0])


def test_the_points_of_the_grid_have_their_values_to_the_last_bit():
    values = [TWO.at(posture(x, y)) for x in GRID[0] for y in GRID[1]]
    assert tuple(values) == TWO.values
    assert tuple(ONE.at(posture(9.0, x)) for x in GRID[0]) == ONE.values


def test_it_is_straight_along_each_joint_between_the_points():
    assert ONE.at(posture(9.0, 1.05)) == pytest.approx(0.5 * (-0.7 + 3.3))
    for share in (0.25, 0.5, 0.9):
        y = -0.3 + share
        assert TWO.at(posture(-1.0, y)) == pytest.approx(0.1 + share * 0.1)
        assert TWO.at(posture(1.05, y)) == pytest.approx(0.5 * (TWO.at(posture(0.1, y)) + TWO.at(posture(2.0, y))))


def test_a_table_of_what_is_linear_is_that_everywhere_within():
    grid = (tuple(np.linspace(-2.0, 1.0, 4)), (-1.0, 0.5, 0.6))
    table = JointTable(joints=(0, 3), grid=grid, values=tuple(2.0 * x - 3.0 * y for x in grid[0] for y in grid[1]))
    for x, y in np.random.default_rng(1).uniform((-2.0, -1.0), (1.0, 0.6), (50, 2)):
        assert table.at(np.array([x, 7.0, 7.0, y])) == pytest.approx(2.0 * x - 3.0 * y)


def test_an_angle_off_the_grid_counts_as_its_end():
    assert ONE.at(posture(9.0, -5.0)) == 0.1
    assert ONE.at(posture(9.0, 2.1)) == 3.3
    assert TWO.at(posture(50.0, -50.0)) == 3.3
    assert TWO.at(posture(-50.0, 0.2)) == TWO.at(posture(-1.0, 0.2))


def test_an_angle_that_is_none_gives_none():
    assert np.isnan(TWO.at(posture(np.nan, 0.0)))


def test_the_mean_is_over_the_points():
    assert TWO.mean == pytest.approx(np.mean(TWO.values))


@pytest.mark.parametrize(
    ("joints", "grid", "values"),
    [((1,), ((0.0, 1.0),), (1.0,)), ((1, 2), ((0.0, 1.0),), (1.0, 2.0)), ((1,), ((0.0,),), (1.0,)), ((), (), (1.0,))],
)
def test_sizes_that_do_not_fit_are_refused(joints, grid, values):
    with pytest.raises(ValueError, match="fit"):
        JointTable(joints=joints, grid=grid, values=values)
