"""One rule for a LOAD: at its limits, beyond them, with NaN, and with an inertia that is nearly a body's."""

import math

import numpy as np
import pytest

from runtime.faults import Fault
from runtime.robot.load_rules import ROUNDING, centre_fault, inertia_fault, load_fault, mass_fault, principal_moments
from runtime.robot.payload import declared


def code(fault):
    return None if fault is None else fault.code


@pytest.mark.parametrize(
    ("mass", "rated", "expected"),
    [(0.0, 2.5, None), (2.5, 2.5, None), (math.nextafter(2.5, 3), 2.5, "RBL402"), (-1e-9, 2.5, "RBL401"),
     (math.nan, 2.5, "RBL401"), (math.inf, 2.5, "RBL401"), (1.0, math.nan, "RBL402"), (1e6, None, None)],
)  # fmt: skip
def test_a_mass(mass, rated, expected):
    assert code(mass_fault(mass, rated)) == expected


@pytest.mark.parametrize(
    ("cog", "expected"),
    [((0, 0, 2.0), None), ((1.2, 1.6, 0), None), ((0, 0, math.nextafter(2.0, 3)), "RBL403"),
     ((0, math.nan, 0), "RBL403"), ((math.inf, 0, 0), "RBL403")],
)  # fmt: skip
def test_a_centre_of_gravity(cog, expected):
    assert code(centre_fault(cog)) == expected
    assert code(load_fault(0.0, cog, None, 2.5)) == expected  # whatever the mass


@pytest.mark.parametrize(
    ("inertia", "expected"),
    [
        ((0, 0, 0, 0, 0, 0), None),
        ((0.1, 0.2, 0.3, 0, 0, 0), None),
        ((0.1, 0.2, 0.3 * (1 + 0.9 * ROUNDING), 0, 0, 0), None),
        ((0.1, 0.2, 0.3 * (1 + 1.1 * ROUNDING), 0, 0, 0), "RBL403"),
        ((1.0, 1.0, 1.0, 0, 0, 0.5), None),  # 0.5, 1, 1.5
        ((1.0, 1.0, 1.0, 0, 0, 0.6), "RBL403"),
        ((-0.1, 1.0, 1.0, 0, 0, 0), "RBL403"),
        ((1.0, 1.0, 1.0, math.nan, 0, 0), "RBL403"),
        ((math.inf, 1.0, 1.0, 0, 0, 0), "RBL403"),
    ],
)
def test_an_inertia_is_judged_alike_by_check_and_by_the_controller(inertia, expected):
    assert code(inertia_fault(inertia)) == expected
    xx, yy, zz, xy, xz, yz = inertia
    matrix = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    if expected is None:
        assert declared(1.0, (0, 0, 0), 2.5, matrix).mass == 1.0
    else:
        with pytest.raises(Fault, match=expected):
            declared(1.0, (0, 0, 0), 2.5, matrix)


def test_principal_moments_are_the_eigenvalues():
    random = np.random.default_rng(5)
    for scale in (1e-9, 1.0, 1e6):
        root = random.normal(size=(3, 3)) * scale
        matrix = root @ root.T
        six = matrix[(0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)].tolist()
        expected, rounding = np.linalg.eigvalsh(matrix), 1e-13 * np.abs(matrix).max()
        np.testing.assert_allclose(principal_moments(six), expected, atol=rounding)
    assert principal_moments((3, 1, 2, 0, 0, 0)) == (1, 2, 3)
    assert all(map(math.isnan, principal_moments((1, 1, 1, 0, math.nan, 0))))
