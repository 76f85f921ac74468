"""Products of matrices and vectors with one order of summation, whatever the processor.

numpy gives ``@``, ``np.dot`` and ``np.linalg`` to OpenBLAS, which picks a kernel for the processor that it finds.
Kernels add in different orders, so the last digits of a run would differ between processor families. ``np.einsum``
adds in numpy's own loops, in one order. Equations are solved in ``runtime.core.decompositions`` for the same reason.
``tests/arch/test_summation.py`` keeps the other functions out of a run;
``tests/robolang/execution/test_processors.py`` runs programs under three kernels of OpenBLAS and compares the bytes
of their logs.

Arrays are float64.
"""

import math
from functools import reduce

import numpy as np

# the loops themselves: the dispatch around them takes as long as a product of two rotations
from numpy._core.multiarray import c_einsum as einsum
from numpy.typing import NDArray

Array = NDArray[np.float64]


def matmul(*factors: Array) -> Array:
    """Return the matrix product of two or more factors, from the left, with the shapes of ``numpy.matmul``.

    Matrices (..., m, n) broadcast over leading dimensions. A vector (n,) stands for a row as the first factor and for a
    column as the last one.
    """
    return reduce(_matmul, factors)


def _matmul(a: Array, b: Array) -> Array:
    # without ``optimize``: einsum would then hand large products to BLAS, whose order of summation is the machine's
    if b.ndim == 1:
        return np.asarray(einsum("...j,j->...", a, b))
    if a.ndim == 1:
        return np.asarray(einsum("j,...jk->...k", a, b))
    return np.asarray(einsum("...ij,...jk->...ik", a, b))


def dot(a: Array, b: Array) -> float:
    """Return the scalar product of two vectors (n,)."""
    return float(einsum("i,i->", a, b))


def norm(v: Array) -> float:
    """Return the length of a vector (n,)."""
    return math.sqrt(dot(v, v))


def cross(a: Array, b: Array) -> Array:
    """Return the vector products a x b (..., 3), that broadcast; the bits of ``numpy.cross`` in a third of the time."""
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    x = ay * bz - az * by
    found = np.empty((*x.shape, 3))
    found[..., 0], found[..., 1], found[..., 2] = x, az * bx - ax * bz, ax * by - ay * bx
    return found
