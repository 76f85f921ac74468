"""What LOAD may declare, at the border of each rule."""

import math

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.robot.model.payload import declared


def refusal(*args, **kwargs) -> str:
    with pytest.raises(Fault) as caught:
        declared(*args, **kwargs)
    return caught.value.code


@pytest.mark.parametrize("mass", [-1e-9, math.nan, math.inf, -math.inf])
def test_what_is_not_a_mass(mass):
    assert refusal(mass, (0, 0, 0.1), 2.5) == "RBL401"


def test_rated_is_allowed_and_a_gram_more_is_not():
    assert declared(2.5, (0, 0, 0.1), 2.5).mass == 2.5
    assert refusal(2.501, (0, 0, 0.1), 2.5) == "RBL402"


@pytest.mark.parametrize("cog", [(0, 0, 2.001), (math.nan, 0, 0), (0, math.inf, 0)])
def test_a_centre_of_gravity_off_the_arm(cog):
    assert refusal(1.0, cog, 2.5) == "RBL403"
    assert declared(1.0, (0, 0, 1.999), 2.5).cog[2] == 1.999


@pytest.mark.parametrize("moments", [(1.0, 1.0, 2.1), (-0.1, 1.0, 1.0), (math.nan, 1.0, 1.0)])
def test_an_inertia_that_no_body_has(moments):
    assert refusal(1.0, (0, 0, 0.1), 2.5, np.diag(moments)) == "RBL403"


def test_what_is_declared_is_kept_in_floating_point():
    """Whole numbers too: a payload in integers would be one of another kind to everything that computes with it."""
    bare, whole = declared(1, (0, 0, 1), 2.5), declared(2, (0, 1, 0), 2.5, np.diag([2, 3, 4]))
    np.testing.assert_array_equal(bare.inertia, np.zeros((3, 3)))
    np.testing.assert_array_equal(bare.cog, [0, 0, 1])
    np.testing.assert_array_equal(whole.inertia, np.diag([2, 3, 4]))
    assert {bare.cog.dtype, bare.inertia.dtype, whole.cog.dtype, whole.inertia.dtype} == {np.dtype(np.float64)}
