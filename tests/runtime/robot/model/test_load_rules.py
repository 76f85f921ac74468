"""One rule for a LOAD: at its limits, beyond them, with NaN, and with an inertia that is nearly a body's."""

import math

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.robot.model.load_rules import (
    centre_fault,
    inertia_fault,
    load_fault,
    mass_fault,
    moments_defect,
    principal_moments,
)
from runtime.robot.model.payload import declared
from tests.messages import numbers


def code(fault):
    return None if fault is None else fault.code


@pytest.mark.parametrize(
    ("mass", "rated", "expected"),
    [
        (0.0, 2.5, None),
        (2.5, 2.5, None),
        (math.nextafter(2.5, 3), 2.5, "RBL402"),
        (-1e-9, 2.5, "RBL401"),
        (math.nan, 2.5, "RBL401"),
        (math.inf, 2.5, "RBL401"),
        (1.0, math.nan, "RBL402"),
        (1e6, None, None),
    ],
)
def test_a_mass(mass, rated, expected):
    assert code(mass_fault(mass, rated)) == expected


@pytest.mark.parametrize(
    ("cog", "expected"),
    [
        ((0, 0, 2.0), None),
        ((1.2, 1.6, 0), None),
        ((0, 0, math.nextafter(2.0, 3)), "RBL403"),
        ((0, math.nan, 0), "RBL403"),
        ((math.inf, 0, 0), "RBL403"),
    ],
)
def test_a_centre_of_gravity(cog, expected):
    assert code(centre_fault(cog)) == expected
    assert code(load_fault(0.0, cog, None, 2.5)) == expected  # whatever the mass


@pytest.mark.parametrize(
    ("inertia", "expected"),
    [
        ((0, 0, 0, 0, 0, 0), None),
        ((0.1, 0.2, 0.3, 0, 0, 0), None),
        ((0.1, 0.2, 0.3 * (1 + 0.9e-6), 0, 0, 0), None),
        ((0.1, 0.2, 0.3 * (1 + 1.1e-6), 0, 0, 0), "RBL403"),
        ((1.0, 1.0, 1.0, 0, 0, 0.5), None),  # 0.5, 1, 1.5
        ((1.0, 1.0, 1.0, 0, 0, 0.6), "RBL403"),
        ((1.0, 1.0, 1.0, 0, 0.6, 0), "RBL403"),
        ((1.0, 1.0, 1.0, 0.6, 0, 0), "RBL403"),
        ((-1e-9, 0, 0, 0, 0, 0), None),
        ((-1.001e-9, 0, 0, 0, 0, 0), "RBL403"),
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


@pytest.mark.parametrize(
    ("mass", "hint"),
    [(49.9, []), (50.0, [50.0, 0.05]), (300.0, [300.0, 0.3]), (2500.0, [2500.0, 2.5]), (2501.0, [])],
)
def test_a_mass_that_may_be_in_grams_is_said_in_kilograms(mass, hint):
    fault = mass_fault(mass, 2.5)
    assert fault.code == "RBL402"
    assert numbers(fault.message) == [mass, 2.5]
    assert fault.hint
    assert numbers(fault.hint) == hint


def test_a_mass_that_is_a_little_too_large_is_not_taken_for_grams():
    assert numbers(mass_fault(60.0, 49.0).hint) == []
    assert numbers(mass_fault(490.0, 49.0).hint) == [490.0, 0.49]


def test_what_cannot_be_declared_is_said_with_its_figures():
    assert numbers(mass_fault(-1.5, 2.5).message) == [-1.5]
    assert numbers(centre_fault((0.0, 1.5, 2.0)).message) == [2500.0, 2000.0]
    broken = centre_fault((0.1, math.nan, -0.05)).message
    assert numbers(broken) == [100.0, -50.0]
    assert "nan" in broken


@pytest.mark.parametrize(
    ("inertia", "why"),
    [
        ((1.0, math.inf, 1.0, 0, 0, 0), "finite"),
        ((-0.1, 1.0, 1.0, 0, 0, 0), "negative"),
        ((0.0, 1.0, 1.1, 0, 0, 0), "sum"),
        ((0.1, 0.2, 0.4, 0, 0, 0), "sum"),
    ],
)
def test_of_an_inertia_the_rule_that_it_breaks_is_named(inertia, why):
    message = inertia_fault(inertia).message
    assert [each for each in ("finite", "negative", "sum") if each in message] == [why]


@pytest.mark.parametrize(
    ("moments", "missing"),
    [
        ((1, 2, 3), 0.0),
        ((1, 2, 2), 0.0),
        ((1, 2, 3.5), 0.5),
        ((0, 1, 1), 0.0),
        ((-0.5, 1, 1), 0.5),
        ((-1, 0, 1), 2.0),
        ((0, 1, math.nan), math.inf),
    ],
)
def test_what_moments_lack_to_be_those_of_a_body(moments, missing):
    assert moments_defect(moments) == missing


@pytest.mark.parametrize("seed", range(4))
def test_an_inertia_in_turned_axes_is_judged_by_its_principal_moments(seed):
    turn = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    possible, impossible = (turn @ np.diag([0.1, 0.2, 0.3 * share]) @ turn.T for share in (0.9999, 1.0001))
    np.testing.assert_array_equal(declared(1.0, (0, 0, 0), 2.5, possible).inertia, possible)
    with pytest.raises(Fault, match="RBL403"):
        declared(1.0, (0, 0, 0), 2.5, impossible)


def six(matrix):
    return matrix[(0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)].tolist()


def test_principal_moments_are_the_eigenvalues():
    random = np.random.default_rng(5)
    for scale in (1e-9, 1.0, 1e6):
        root = random.normal(size=(3, 3)) * scale
        matrix = root @ root.T
        expected, rounding = np.linalg.eigvalsh(matrix), 1e-13 * np.abs(matrix).max()
        np.testing.assert_allclose(principal_moments(six(matrix)), expected, atol=rounding)
    assert principal_moments((3, 1, 2, 0, 0, 0)) == (1, 2, 3)
    assert all(map(math.isnan, principal_moments((1, 1, 1, 0, math.nan, 0))))


@pytest.mark.parametrize(
    "beside",
    [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, 0, 1), (0, 1, 1), (1, 1, 1), (-1, 1, 1), (1e-9, 0, 0)],
)
@pytest.mark.parametrize("moments", [(1, 1, 1), (2, 1, 3), (0, 0, 0), (1, 1, 1 + 1e-12)])
def test_principal_moments_of_bodies_that_are_nearly_alike_in_some_axes(moments, beside):
    matrix = np.diag(np.array(moments, dtype=float))
    matrix[(0, 0, 1), (1, 2, 2)] = matrix[(1, 2, 2), (0, 0, 1)] = beside
    found = principal_moments(six(matrix))
    np.testing.assert_allclose(found, np.linalg.eigvalsh(matrix), atol=4e-15 * np.abs(matrix).max())
