"""Robots look like robots: every link, hand and table is to be seen, nothing floats and nothing pokes through.

Pictures are compared by structure: how much of the picture each of them covers. After a change of the shapes that was
looked over, ``python -m tests.runtime.plant.test_looks`` writes the areas anew.
"""

import json
import tempfile
from itertools import product
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from runtime.appearance.scene import Scene, Shape
from runtime.appearance.stance import Stance, world_poses
from runtime.appearance.views import named_view
from runtime.core.frames import Array
from runtime.plant.camera import Camera, picture_mjcf
from tests.campaign import size
from tests.runtime.appearance.robots import ARMS, MACHINES, Sitter, sitter
from tests.runtime.plant.drawing import need_graphics

pytestmark = pytest.mark.physics

AREAS = Path(__file__).parent / "data" / "areas.json"
WIDTH, HEIGHT = 400, 300
WITHIN, PIXELS = 0.05, 12
"""Areas may differ by this part and this many pixels: an edge may fall on either side of a pixel."""
APART = 0.003
"""Shapes that belong together are no further apart, m."""


@pytest.fixture(scope="module", params=[*ARMS, *MACHINES])
def one(request, tmp_path_factory) -> Sitter:
    return sitter(request.param, tmp_path_factory.mktemp(request.param))


def areas(one: Sitter) -> list[dict[str, int]]:
    """Return how many pixels the shapes of each body cover, in two views of each posture."""
    found = []
    with Camera(one.scene, width=WIDTH, height=HEIGHT) as camera:
        for stance, name in product(one.stances, ("iso", "side")):
            seen = camera.segments(stance, named_view(name, one.scene, [stance], WIDTH / HEIGHT))
            counts = np.bincount(seen[seen >= 0], minlength=len(one.scene.shapes))
            total: dict[str, int] = {body.name: 0 for body in one.scene.bodies}
            for shape, count in zip(one.scene.shapes, counts.tolist(), strict=True):
                total[shape.body] += count
            found.append({name: count for name, count in total.items() if count})
    return found


def test_every_body_covers_as_much_of_the_picture_as_before(one):
    need_graphics()
    for stored, now in zip(json.loads(AREAS.read_text())[one.name], areas(one), strict=True):
        wrong = {
            name: (stored.get(name, 0), now.get(name, 0))
            for name in stored.keys() | now.keys()
            if not abs(stored.get(name, 0) - now.get(name, 0)) <= WITHIN * stored.get(name, 0) + PIXELS
        }
        assert not wrong, "pixels of bodies, stored and now"


def test_links_hand_and_table_are_seen(one):
    stored = json.loads(AREAS.read_text())[one.name]
    moved = {body.name for body in one.scene.bodies if body.joint is not None and body.joint.source == "axis"}
    drawn = {shape.body for shape in one.scene.shapes}
    hand = {"tool", "finger_left", "finger_right", "obstacle:table"} if one.name in ARMS else set()
    for name in {"base", *moved, *hand} & drawn:
        assert sum(picture.get(name, 0) > PIXELS for picture in stored) >= 3, name
    # only a coordinate that carries no shape of its own may have none: the hand of a Puma sits on its wrist
    assert len(moved - drawn) <= 1


class Solids:
    """The shapes of a scene as convex bodies of MuJoCo, which measures their distances."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.model: Any = mujoco.MjModel.from_xml_string(picture_mjcf(scene, 64, 64))
        self.data: Any = mujoco.MjData(self.model)
        self.geoms = [int(self.model.geom(f"shape{k}").id) for k in range(len(scene.shapes))]

    def stand(self, stance: Stance) -> None:
        poses = world_poses(self.scene, stance)
        # numbered in the model: names of a scene are free
        for k, body in enumerate(self.scene.bodies):
            X = poses[body.name]
            mocap = int(self.model.body(f"body{k}").mocapid[0])
            self.data.mocap_pos[mocap] = X[:3, 3]
            mujoco.mju_mat2Quat(self.data.mocap_quat[mocap], X[:3, :3].ravel())
        mujoco.mj_kinematics(self.model, self.data)

    def distance(self, one: int, other: int) -> float:
        return float(mujoco.mj_geomDistance(self.model, self.data, self.geoms[one], self.geoms[other], 1.0, None))


def postures(one: Sitter, count: int) -> list[Stance]:
    rows = np.random.default_rng(16).uniform(one.lower, one.upper, (count, len(one.lower)))
    return [*one.stances, *(Stance(axes=row, fingers=(0.03, 0.03)) for row in rows)]


def groups(scene: Scene) -> dict[str, str]:
    """Return the nearest body with shapes that each body with shapes is carried by."""
    parents = {body.name: body.parent for body in scene.bodies}
    drawn = {shape.body for shape in scene.shapes}
    found = {}
    for name in drawn:
        above = parents[name]
        while above is not None and above not in drawn:
            above = parents[above]
        if above is not None:
            found[name] = above
    return found


def test_nothing_floats(one):
    solids, scene = Solids(one.scene), one.scene
    shapes: dict[str, list[int]] = {}
    for k, shape in enumerate(scene.shapes):
        shapes.setdefault(shape.body, []).append(k)
    for stance in postures(one, size(60, 6)):
        solids.stand(stance)
        for name, above in groups(scene).items():
            gap = min(solids.distance(a, b) for a in shapes[name] for b in shapes[above])
            assert gap <= APART, (name, above, gap, stance)
    for name, own in shapes.items():
        # and the shapes of one body hang together
        joined, todo = {own[0]}, [own[0]]
        while todo:
            here = todo.pop()
            near = [k for k in own if k not in joined and solids.distance(here, k) <= APART]
            joined.update(near)
            todo += near
        assert len(joined) == len(own), name


def test_what_stands_on_the_floor_reaches_it(one):
    lowest: dict[str, float] = {}
    poses = world_poses(one.scene, one.stances[0])
    for shape in one.scene.shapes:
        X = poses[shape.body] @ shape.X_body_shape
        low = X[2, 3] - abs(X[2, :3]) @ np.array([*shape.size, 0.0, 0.0, 0.0][:3]) / 2.0
        if shape.role == "leg" or shape.name == "foot":
            lowest[shape.body] = min(lowest.get(shape.body, 1.0), low)
    standing = [low for name, low in lowest.items() if name in ("base", "obstacle:table")]
    assert standing
    np.testing.assert_allclose(standing, 0.0, atol=0.05)


def covers(scene: Scene) -> list[tuple[int, Shape]]:
    return [(k, shape) for k, shape in enumerate(scene.shapes) if shape.name in ("cover", "lid")]


def faces(shape: Shape, X: Array) -> Array:
    """Return points (k, 3) just outside of the ends of a cover, in the world; a lid has one."""
    first, last, length = shape.size
    points: list[list[float]] = []
    turn = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
    for side, radius in ((-1.0, first), (1.0, last))[shape.name == "lid" :]:
        points.append([0.0, 0.0, side * (length / 2.0 + 5e-4)])
        z = np.full(12, side * (length / 2.0 + 5e-4))
        points += np.stack([0.8 * radius * np.cos(turn), 0.8 * radius * np.sin(turn), z], axis=1).tolist()
    return np.array(points) @ X[:3, :3].T + X[:3, 3]


def inside(shape: Shape, points: Array, X: Array) -> Any:
    """Return which points (k, 3) of the world are in a cylinder, limb or sphere at X."""
    local = (points - X[:3, 3]) @ X[:3, :3]
    across, z = np.linalg.norm(local[:, :2], axis=1), local[:, 2]
    if shape.kind == "sphere":
        return np.linalg.norm(local, axis=1) < shape.size[0]
    first, last, length = shape.size
    if shape.kind == "cylinder":
        part = z / length + 0.5
        return (part > 0.0) & (part < 1.0) & (across < first + part * (last - first))
    # a limb: the nearest of the balls that it is made of
    parts = np.linspace(0.0, 1.0, 101)
    radii = first + parts * (last - first)
    return (np.hypot(across[:, None], z[:, None] - parts * length) < radii).any(axis=1)


@pytest.mark.parametrize("name", [name for name in ARMS if name != "seven_meshes"])
def test_nothing_pokes_through_the_covers_of_a_housing(name, tmp_path):
    one = sitter(name, tmp_path)
    scene = one.scene
    assert len(covers(scene)) >= 2
    parents = {body.name: body.parent for body in scene.bodies}
    for stance in postures(one, size(200, 20)):
        poses = world_poses(scene, stance)
        for index, cover in covers(scene):
            points = faces(cover, poses[cover.body] @ cover.X_body_shape)
            # a housing belongs to its link and holds the ends of both that meet there
            for k, shape in enumerate(scene.shapes):
                if k != index and shape.body in (cover.body, parents[cover.body]) and shape.kind != "box":
                    hit = inside(shape, points, poses[shape.body] @ shape.X_body_shape)
                    assert not hit.any(), (cover.body, shape.body, shape.name)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        stored = {name: areas(sitter(name, Path(folder))) for name in (*ARMS, *MACHINES)}
    AREAS.parent.mkdir(exist_ok=True)
    lines = [
        f"{json.dumps(name)}: [\n  " + ",\n  ".join(map(json.dumps, each)) + "\n]" for name, each in stored.items()
    ]
    AREAS.write_text("{\n" + ",\n".join(lines) + "\n}\n", "utf-8")
