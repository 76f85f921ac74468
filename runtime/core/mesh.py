"""Triangles: what a mesh file holds, and what shows or collides."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from runtime.core.frames import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Mesh:
    """Triangles: ``vertices`` (v, 3) m and ``faces`` (f, 3), indices of vertices, counter-clockwise from outside."""

    vertices: Array
    faces: NDArray[np.int32]
