"""Volume, centre and inertia of meshes, against formulas of solids."""

import numpy as np
import pytest

from runtime.core.frames import pose_from_xyzrpy
from runtime.core.mesh import Mesh
from runtime.core.solid import NoSolidError, solid_of
from tests.runtime.meshes import angle_bracket, box_mesh, frame, prism


def moved(mesh, X):
    return Mesh(vertices=mesh.vertices @ X[:3, :3].T + X[:3, 3], faces=mesh.faces)


def together(*meshes):
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return Mesh(
        vertices=np.vstack([mesh.vertices for mesh in meshes]),
        faces=np.vstack([mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)]),
    )


def test_a_box_that_is_turned_and_far_away():
    X = pose_from_xyzrpy([5.0, -7.0, 3.0, 0.3, -0.8, 2.0])
    size = np.array([0.03, 0.05, 0.02])
    solid = solid_of(moved(box_mesh(tuple(size)), X))
    assert solid.volume == pytest.approx(np.prod(size), rel=1e-9)
    assert solid.cog == pytest.approx(X[:3, 3], abs=1e-12)
    own = np.diag(((size**2).sum() - size**2) / 12.0)
    np.testing.assert_allclose(solid.gyration, X[:3, :3] @ own @ X[:3, :3].T, atol=1e-12)


def test_a_tetrahedron_is_not_symmetric():
    """Of unit legs: centre at a quarter, about it 3/80 on each axis and 1/80 between two of them."""
    mesh = Mesh(
        vertices=np.vstack([np.zeros(3), np.eye(3)]), faces=np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    )
    solid = solid_of(mesh)
    assert solid.volume == pytest.approx(1.0 / 6.0)
    assert solid.cog == pytest.approx([0.25] * 3)
    spread = np.full((3, 3), -1.0 / 80.0) + np.eye(3) / 20.0
    np.testing.assert_allclose(solid.gyration, np.trace(spread) * np.eye(3) - spread, atol=1e-12)


def test_an_l_is_two_boxes_and_a_frame_is_one_without_another():
    leg, thick, width = 0.04, 0.005, 0.01
    one, other = leg * thick, (leg - thick) * thick
    solid = solid_of(angle_bracket(leg, thick, width))
    assert solid.volume == pytest.approx((one + other) * width)
    along = (one * leg / 2.0 + other * thick / 2.0) / (one + other)
    assert solid.cog == pytest.approx([along, along, width / 2.0])
    hollow = solid_of(frame(0.04, 0.02, 0.01))
    assert hollow.volume == pytest.approx((0.04**2 - 0.02**2) * 0.01)
    full, hole = 0.04**2, 0.02**2
    assert hollow.gyration[2, 2] == pytest.approx((full * full - hole * hole) / 6.0 / (full - hole))


def test_a_prism_of_many_sides_is_a_cylinder():
    solid = solid_of(prism(720, 0.02, 0.05))
    assert np.diag(solid.gyration) == pytest.approx([(3 * 0.02**2 + 0.05**2) / 12] * 2 + [0.02**2 / 2], rel=1e-4)


def test_two_solids_that_touch_in_an_edge_are_one():
    """Four triangles meet in that edge."""
    box = box_mesh((1.0, 1.0, 1.0))
    beside = moved(box, pose_from_xyzrpy([1.0, 1.0, 0.0, 0.0, 0.0, 0.0]))
    both = together(box, beside)
    vertices, which = np.unique(both.vertices, axis=0, return_inverse=True)
    assert solid_of(Mesh(vertices=vertices, faces=which.reshape(-1)[both.faces])).volume == pytest.approx(2.0)


BOX = box_mesh((1.0, 2.0, 3.0))


@pytest.mark.parametrize(
    "mesh",
    [
        Mesh(vertices=BOX.vertices, faces=BOX.faces[:-1]),
        Mesh(vertices=BOX.vertices, faces=np.vstack([BOX.faces[:-1], BOX.faces[-1:, ::-1]])),
        Mesh(vertices=BOX.vertices, faces=BOX.faces[:, ::-1]),
        Mesh(vertices=BOX.vertices * [1.0, 1.0, 0.0], faces=BOX.faces),
        Mesh(vertices=np.eye(3), faces=np.array([[0, 1, 2], [2, 1, 0]])),
        Mesh(vertices=BOX.vertices * np.nan, faces=BOX.faces),
    ],
    ids=["open", "one triangle turned", "inside out", "flat", "a sheet", "nan"],
)
def test_what_encloses_nothing_is_refused(mesh):
    with pytest.raises(NoSolidError):
        solid_of(mesh)
