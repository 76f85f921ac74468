"""Pictures of scenes: what is on them and where."""

from pathlib import Path

import numpy as np
import pytest

from runtime.appearance.cell_scene import scene_of
from runtime.appearance.scene import Mark, Scene, SceneBody, Shape, View
from runtime.appearance.stance import Stance
from runtime.appearance.views import DIRECTIONS, named_view
from runtime.core.mesh import Mesh
from runtime.plant.camera import Camera
from runtime.plant.dressing import undrawable
from tests.runtime.from_texts import load_cell
from tests.runtime.plant.drawing import need_graphics

pytestmark = pytest.mark.physics

CELL = load_cell(Path("programs/pick_and_place.cell.toml"))
SCENE = scene_of(CELL)
HOME = Stance(axes=CELL.home, fingers=(0.03, 0.03))
WIDTH, HEIGHT = 200, 150
NAMES = ("world", "body0", "\ud800", "a\x01b", "", '<&"')
"""Names of bodies, shapes and meshes that a log may have, and that XML or MuJoCo does not take."""
LINE = Mesh(vertices=np.array([[k / 10.0, 0.0, 0.0] for k in range(4)]), faces=np.array([[0, 1, 2], [1, 3, 2]]))
POINT = Mesh(vertices=np.zeros((4, 3)), faces=np.array([[0, 1, 2]]))
TRIANGLE = Mesh(vertices=np.eye(3), faces=np.array([[0, 1, 2]]))


@pytest.fixture(scope="module")
def camera():
    need_graphics()
    with Camera(SCENE, width=WIDTH, height=HEIGHT) as opened:
        yield opened


@pytest.mark.parametrize("name", DIRECTIONS)
def test_a_named_view_takes_in_every_shape(camera, name):
    view = named_view(name, SCENE, [HOME], WIDTH / HEIGHT)
    seen = camera.segments(HOME, view) >= 0
    assert not seen[[0, -1]].any()
    assert not seen[:, [0, -1]].any()
    rows, columns = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
    # and is no further away than that needs: one of the two directions is filled
    assert max(np.ptp(rows) / HEIGHT, np.ptp(columns) / WIDTH) > 0.75


def test_a_part_is_drawn_where_its_pose_is(camera):
    part = next(k for k, shape in enumerate(SCENE.shapes) if shape.role == "part")
    view = View(position=np.array([0.5, -2.0, 1.2]), target=np.array([0.5, 0.0, 1.2]))
    moved = Stance(axes=CELL.home, parts=[[0.5, -1.0, 1.2, 1.0, 0.0, 0.0, 0.0]])
    rows, columns = np.nonzero(camera.segments(moved, view) == part)
    # straight ahead of the camera, so in the middle of the picture; 60 by 80 mm are seen from 0.98 m
    assert (rows.mean(), columns.mean()) == pytest.approx(((HEIGHT - 1) / 2.0, (WIDTH - 1) / 2.0), abs=0.6)
    assert np.ptp(rows) / np.ptp(columns) == pytest.approx(80.0 / 60.0, abs=0.15)
    away = Stance(axes=CELL.home, parts=[[0.5, -9.0, 1.2, 1.0, 0.0, 0.0, 0.0]])
    assert not (camera.segments(away, view) == part).any()


def test_pictures_have_colours_and_are_the_same_again(camera):
    view = named_view("iso", SCENE, [HOME], WIDTH / HEIGHT)
    first, again = camera.picture(HOME, view), camera.picture(HOME, view)
    assert first.shape == (HEIGHT, WIDTH, 3)
    assert np.array_equal(first, again)
    assert len(np.unique(first.reshape(-1, 3), axis=0)) > 300
    other = camera.picture(Stance(axes=(0.0,) * 6), view)
    assert not np.array_equal(first, other)


def test_a_scene_with_any_names_and_meshes_is_drawn():
    need_graphics()
    bodies = tuple(SceneBody(name=name, parent=None, X_parent_body=np.eye(4)) for name in NAMES)
    meshes = dict(zip(NAMES, (TRIANGLE, LINE, POINT, TRIANGLE, LINE, POINT), strict=True))
    shapes = tuple(
        Shape(body=name, kind="mesh", X_body_shape=np.eye(4), size=(), role="body", name=name, mesh=name)
        for name in NAMES
    )
    least = tuple(
        Shape(body="world", kind=kind, X_body_shape=np.eye(4), size=(1e-9,) * count, role="part")
        for kind, count in (("box", 3), ("cylinder", 3), ("limb", 3), ("sphere", 1))
    )
    made = Scene(
        robot="\ud800", reach=1.0, bodies=bodies, shapes=(*shapes, *least), colours=SCENE.colours, meshes=meshes
    )
    scene = Scene.from_json(made.as_json())
    assert undrawable(scene) == ("body0", "\ud800", "", '<&"')
    view = named_view("iso", scene, [Stance(axes=())], WIDTH / HEIGHT)
    with Camera(scene, width=WIDTH, height=HEIGHT) as opened:
        seen = set(np.unique(opened.segments(Stance(axes=()), view)).tolist())
    assert seen & {0, 3}
    assert seen <= {-1, 0, 3, *range(6, 10)}


@pytest.mark.parametrize("points", [(), (Mark(name="P", X_world_mark=np.eye(4)),)], ids=["nothing", "a-point"])
def test_a_scene_without_shapes_has_a_view(points):
    made = Scene(robot="", reach=0.5, bodies=(), shapes=(), colours=SCENE.colours, points=points)
    view = named_view("iso", made, [Stance(axes=())], WIDTH / HEIGHT)
    assert np.isfinite([view.position, view.target]).all()


def test_names_of_points_are_left_out_where_they_would_hide_the_picture():
    need_graphics()
    marked = scene_of(
        CELL, {"P1": np.block([[np.eye(3), np.array([[0.45], [-0.15], [0.8]])], [np.zeros((1, 3)), 1.0]])}
    )
    view = named_view("iso", marked, [HOME], 4.0 / 3.0)

    def taken(width, labels):
        with Camera(marked, width=width, height=3 * width // 4, labels=labels) as opened:
            return opened.picture(HOME, view)

    assert not np.array_equal(taken(480, True), taken(480, False))
    assert np.array_equal(taken(320, True), taken(320, False))
