"""The convex hull, against solids whose hull is known."""

import numpy as np
import pytest

from runtime.core.frames import pose_from_xyzrpy
from runtime.core.hull import hull_of
from runtime.core.solid import open_edges, solid_of
from tests.runtime.meshes import angle_bracket, box_mesh, prism


def turned(points, *angles):
    """Points turned, with the digits of an STL file."""
    return (points @ pose_from_xyzrpy([0.3, -0.1, 0.7, *angles])[:3, :3].T).astype(np.float32).astype(np.float64)


@pytest.mark.parametrize("sides", [3, 8, 100, 197])
@pytest.mark.parametrize("angles", [(0.0, 0.0, 0.0), (0.4, 1.1, -2.0)])
def test_every_corner_of_a_prism_is_kept_and_nothing_inside(sides, angles):
    """Its ends have many corners in one plane, off it by the rounding of the file when turned."""
    solid = prism(sides, 0.02, 0.033)
    inside = np.random.default_rng(1).normal(size=(50, 3)) * 1e-3 + [0.0, 0.0, 0.016]
    hull = hull_of(turned(np.vstack([inside, solid.vertices]), *angles))
    assert len(hull.vertices) == 2 * sides
    assert open_edges(hull) == 0
    assert solid_of(hull).volume == pytest.approx(solid_of(solid).volume, rel=1e-6)


def test_points_of_a_grid_leave_a_box():
    grid = np.stack(np.meshgrid(*[np.linspace(-1.0, 1.0, 7)] * 3), axis=-1).reshape(-1, 3)
    hull = hull_of(grid)
    assert (hull.vertices.shape, hull.faces.shape) == ((8, 3), (12, 3))
    assert solid_of(hull_of(turned(grid, 1.0, 0.2, 0.4))).volume == pytest.approx(8.0, rel=1e-6)


def test_no_point_is_outside():
    points = np.random.default_rng(2).normal(size=(500, 3))
    hull = hull_of(points)
    a, b, c = np.moveaxis(hull.vertices[hull.faces], 1, 0)
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    assert ((points[:, None] - a) * normals).sum(axis=2).max() < 1e-5
    assert solid_of(hull).volume > 0.0


def test_a_corner_that_goes_in_is_filled():
    """An L of 5 mm in a square of 40: the triangle across its inner corner is added."""
    bracket = angle_bracket(0.04, 0.005, 0.01)
    added = 0.035 * 0.035 / 2.0 * 0.01
    assert solid_of(hull_of(bracket.vertices)).volume == pytest.approx(solid_of(bracket).volume + added)


@pytest.mark.parametrize("points", [np.zeros((5, 3)), np.eye(3), box_mesh((1.0, 2.0, 0.0)).vertices, np.eye(3)[[0, 1]]])
def test_what_is_in_one_plane_has_none(points):
    assert hull_of(points) is None
