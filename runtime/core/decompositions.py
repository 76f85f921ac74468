"""Solutions of linear equations and eigenvalues, the same bytes on every processor (see ``runtime.core.linear``).

Eigen computes them: ``eigenpy`` comes with Pinocchio and is compiled for one instruction set. The LAPACK of numpy was
rejected, since it calls the BLAS of the machine (docs/decisions/0033). Arrays are float64.
"""

import eigenpy
import numpy as np

from runtime.core.linear import Array


def solve(A: Array, b: Array) -> Array:
    """Return x (n,) of A x = b for a regular A (n, n); not finite where A is singular."""
    return np.array(eigenpy.PartialPivLU(A).solve(b))


def inverse_of(A: Array) -> Array:
    """Return the inverse (n, n) of a regular matrix."""
    return np.array(eigenpy.PartialPivLU(A).inverse())


def least_squares(A: Array, b: Array, rcond: float) -> Array:
    """Return the shortest x (n,) with the least \\|A x - b\\|, A (m, n).

    Pivots below ``rcond`` times the largest count as zero (complete orthogonal decomposition).
    """
    # complete, not only with column pivoting: where A lacks rank, the shortest of all solutions is needed
    found = eigenpy.CompleteOrthogonalDecomposition(A)
    found.setThreshold(rcond)
    return np.array(found.solve(b))


def symmetric_eigen(A: Array) -> tuple[Array, Array]:
    """Return the eigenvalues (n,), ascending, and the eigenvectors (n, n), as columns, of a symmetric matrix."""
    found = eigenpy.SelfAdjointEigenSolver(A)
    return np.array(found.eigenvalues()), np.array(found.eigenvectors())
