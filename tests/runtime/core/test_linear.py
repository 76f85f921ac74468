"""Products, lengths and solutions: numpy's values, in one order of summation for every size."""

import numpy as np
import pytest

from runtime.core.decompositions import inverse_of, least_squares, solve, symmetric_eigen
from runtime.core.linear import cross, dot, matmul, norm

RNG = np.random.default_rng(3)


@pytest.mark.parametrize(
    ("a", "b"),
    [
        ((4, 4), (4, 4)),
        ((3, 3), (3,)),
        ((3,), (3, 3)),
        ((6,), (6,)),
        ((5, 4, 4), (4, 4)),
        ((200, 4, 4), (4, 4)),
        ((200, 4, 4), (200, 4, 4)),
        ((400, 4), (4, 4)),
        ((100, 6, 4), (4, 16)),
        ((8, 3, 3), (3,)),
        ((24, 4), (300, 4, 6)),
    ],
)
def test_products_have_the_values_and_shapes_of_numpy(a, b):
    A, B = RNG.standard_normal(a), RNG.standard_normal(b)
    found = matmul(A, B)
    assert np.shape(found) == np.shape(A @ B)
    np.testing.assert_allclose(found, A @ B, atol=1e-13)


def test_a_product_has_the_same_bytes_alone_and_in_a_stack():
    A, B = RNG.standard_normal((500, 4, 4)), RNG.standard_normal((4, 4))
    alone = np.array([matmul(each, B) for each in A])
    assert matmul(A, B).tobytes() == alone.tobytes()


@pytest.mark.parametrize(("a", "b"), [((3,), (3,)), ((5, 3), (3,)), ((4, 5, 3), (4, 1, 3)), ((3,), (7, 3))])
def test_vector_products_are_those_of_numpy_to_the_bit(a, b):
    A, B = RNG.standard_normal(a), RNG.standard_normal(b)
    assert cross(A, B).tobytes() == np.cross(A, B).tobytes()


def test_several_factors_go_from_the_left():
    A, B, C = RNG.standard_normal((3, 3, 3))
    assert matmul(A, B, C).tobytes() == matmul(matmul(A, B), C).tobytes()


def test_lengths_and_solutions_are_those_of_numpy():
    A, b = RNG.standard_normal((6, 6)), RNG.standard_normal(6)
    assert dot(b, b) == pytest.approx(float(b @ b))
    assert norm(b) == pytest.approx(float(np.linalg.norm(b)))
    np.testing.assert_allclose(solve(A, b), np.linalg.solve(A, b), atol=1e-12)
    np.testing.assert_allclose(inverse_of(A) @ A, np.eye(6), atol=1e-12)
    short = np.hstack([A[:, :2], A[:, :1]])  # two columns alike: the shortest of many solutions
    np.testing.assert_allclose(least_squares(short, b, 1e-9), np.linalg.lstsq(short, b, rcond=1e-9)[0], atol=1e-12)
    values, vectors = symmetric_eigen(A + A.T)
    np.testing.assert_allclose(values, np.linalg.eigvalsh(A + A.T), atol=1e-12)
    np.testing.assert_allclose(vectors @ np.diag(values) @ vectors.T, A + A.T, atol=1e-12)
