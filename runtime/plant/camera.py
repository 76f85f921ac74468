"""Pictures of a scene, drawn by MuJoCo without a window.

The model of a picture has no joints and no physics: every body of the scene is put where ``world_poses`` says, so that
a log with a scene is enough, and the page of the run shows the same.
"""

import math
import xml.etree.ElementTree as ET
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from runtime.appearance.scene import Scene, View
from runtime.appearance.stance import Stance, world_poses
from runtime.appearance.views import FIELD
from runtime.core.linear import norm
from runtime.core.units import DEG
from runtime.plant.dressing import GROUP, dress, rgba
from runtime.plant.graphics import open_graphics
from runtime.plant.mjcf import quaternion

Image = NDArray[np.uint8]

SKY = ("0.91 0.935 0.96", "0.76 0.83 0.91")
"""Colour of the sky at the horizon and above."""
MARKS_BEYOND = 200
"""Geoms that a picture may have beside those of the model."""
POINT = 0.007
"""Radius of the ball that shows a point, m."""
LONGEST_LABEL = 40
"""Characters of the name of a point that are shown."""
NARROWEST = 480
"""Least width, px, of a picture with names: they have one size, and would hide what a smaller one shows."""
INK = (0.1, 0.12, 0.15, 1.0)
"""Colour of points."""


class Camera:
    """A camera on a scene, which draws pictures of one size until it is closed; a context manager."""

    def __init__(self, scene: Scene, *, width: int, height: int, labels: bool = True) -> None:
        """Open it; ``Fault`` RBL830 where nothing can draw.

        ``labels``: points have their names, where there is room for them.
        """
        self._scene = scene
        self._labels = labels and width >= NARROWEST
        self._model: Any = mujoco.MjModel.from_xml_string(picture_mjcf(scene, width, height))
        self._data: Any = mujoco.MjData(self._model)
        self._mocap = {body.name: int(self._model.body(_named(k)).mocapid[0]) for k, body in enumerate(scene.bodies)}
        self._image: Image = np.empty((height, width, 3), np.uint8)
        self._rect = mujoco.MjrRect(0, 0, width, height)
        self._drawn: Any = mujoco.MjvScene(self._model, self._model.ngeom + MARKS_BEYOND)
        self._option: Any = mujoco.MjvOption()
        # the floor is in group 0, all shapes are in theirs
        self._option.geomgroup[:] = 0
        self._option.geomgroup[[0, GROUP]] = 1
        self._graphics = open_graphics()
        self._context: Any = mujoco.MjrContext(self._model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)

    @property
    def graphics(self) -> str:
        """The name of the library that draws."""
        return self._graphics.title

    def __enter__(self) -> "Camera":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Give the graphics back."""
        self._context.free()
        self._graphics.close()

    def picture(self, stance: Stance, view: View) -> Image:
        """Return the picture (height, width, 3) of a stance; the array is its own."""
        self._stand(stance, view)
        return self._drawn_image()

    def segments(self, stance: Stance, view: View) -> NDArray[np.int32]:
        """Return which shape of the scene each pixel (height, width) shows; -1: none, or the floor."""
        self._stand(stance, view)
        flags = self._drawn.flags
        flags[mujoco.mjtRndFlag.mjRND_SEGMENT], flags[mujoco.mjtRndFlag.mjRND_IDCOLOR] = True, True
        try:
            colours = self._drawn_image().astype(np.int32)
        finally:
            flags[mujoco.mjtRndFlag.mjRND_SEGMENT], flags[mujoco.mjtRndFlag.mjRND_IDCOLOR] = False, False
        drawn = colours[..., 0] + (colours[..., 1] << 8) + (colours[..., 2] << 16)
        # number of a geom in the drawn scene, from 1, to that of its shape
        shapes = np.full(self._drawn.ngeom + 1, -1, np.int32)
        for k, geom in enumerate(self._drawn.geoms[: self._drawn.ngeom]):
            if geom.objtype == mujoco.mjtObj.mjOBJ_GEOM:
                shapes[k + 1] = _shape_number(str(self._model.geom(geom.objid).name))
        return np.asarray(shapes[drawn])

    def _stand(self, stance: Stance, view: View) -> None:
        for name, X in world_poses(self._scene, stance).items():
            self._data.mocap_pos[self._mocap[name]] = X[:3, 3]
            self._data.mocap_quat[self._mocap[name]] = quaternion(X[:3, :3])
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_camlight(self._model, self._data)
        mujoco.mjv_updateScene(
            self._model,
            self._data,
            self._option,
            None,
            _camera(view),
            mujoco.mjtCatBit.mjCAT_ALL.value,
            self._drawn,
        )
        self._mark()

    def _mark(self) -> None:
        """Draw the points of the scene, with their names."""
        for mark in self._scene.points[:MARKS_BEYOND]:
            geom = self._drawn.geoms[self._drawn.ngeom]
            mujoco.mjv_initGeom(
                geom,
                mujoco.mjtGeom.mjGEOM_SPHERE,
                np.full(3, POINT),
                mark.X_world_mark[:3, 3],
                np.eye(3).ravel(),
                np.array(INK, np.float32),
            )
            # its font has no other characters, and its field 100 of them
            name = mark.name.encode("ascii", "replace").decode()[:LONGEST_LABEL].replace("\0", " ")
            geom.label = name if self._labels else ""
            geom.objtype, geom.objid = mujoco.mjtObj.mjOBJ_UNKNOWN, -1
            self._drawn.ngeom += 1

    def _drawn_image(self) -> Image:
        mujoco.mjr_render(self._rect, self._drawn, self._context)
        mujoco.mjr_readPixels(self._image, None, self._rect, self._context)
        return self._image[::-1].copy()  # OpenGL begins below


def picture_mjcf(scene: Scene, width: int, height: int) -> str:
    """Return the MJCF text of a scene for pictures of a size: bodies that are put, light, floor and sky."""
    root = ET.Element("mujoco", model="picture")
    ET.SubElement(root, "compiler", angle="radian", autolimits="true")
    _visual(root, scene, width, height)
    world = ET.SubElement(root, "worldbody")
    _light(world, scene)
    ET.SubElement(world, "geom", name="floor", type="plane", size="0 0 0.1", material="grid")
    bodies = {
        body.name: (ET.SubElement(world, "body", name=_named(k), mocap="true"), np.eye(4))
        for k, body in enumerate(scene.bodies)
    }
    dress(root, scene, bodies)
    return ET.tostring(root, encoding="unicode")


def _named(k: int) -> str:
    """Return the name of a body in the model: in a log it may be any text, also one that MuJoCo has for its own."""
    return f"body{k}"


def _visual(root: ET.Element, scene: Scene, width: int, height: int) -> None:
    visual = ET.SubElement(root, "visual")
    ET.SubElement(
        visual, "global", offwidth=str(width), offheight=str(height), fovy=repr(FIELD / DEG), orthographic="false"
    )
    ET.SubElement(visual, "headlight", ambient="0.42 0.42 0.42", diffuse="0.16 0.16 0.16", specular="0 0 0")
    # large: a millimetre of shadow for each of its pixels, or round housings get spots
    ET.SubElement(visual, "quality", shadowsize="4096", offsamples="8")
    # the far end of the world in parts of its extent: the floor reaches to the horizon
    ET.SubElement(visual, "map", znear="0.01", zfar="40", haze="0.35", shadowclip="0.9", shadowscale="0.6")
    ET.SubElement(visual, "rgba", haze="0.905 0.93 0.955 1")
    ET.SubElement(root, "statistic", extent=repr(2.0 * scene.reach), center=f"0 0 {scene.reach / 2.0!r}")
    assets = ET.SubElement(root, "asset")
    ET.SubElement(
        assets, "texture", type="skybox", builtin="gradient", rgb1=SKY[0], rgb2=SKY[1], width="256", height="256"
    )
    floor = rgba(scene.colours["floor"]).rsplit(" ", 1)[0]
    ET.SubElement(
        assets,
        "texture",
        name="grid",
        type="2d",
        builtin="flat",
        rgb1=floor,
        rgb2=floor,
        mark="edge",
        markrgb="0.80 0.83 0.86",
        width="512",
        height="512",
    )
    # one square is half a metre
    ET.SubElement(
        assets, "material", name="grid", texture="grid", texrepeat="2 2", texuniform="true", specular="0", shininess="0"
    )


def _light(world: ET.Element, scene: Scene) -> None:
    """Light as in a hall: a lamp above that throws shadows, and two that only take the black out of them."""
    high = 3.0 * scene.reach
    ET.SubElement(
        world,
        "light",
        directional="true",
        pos=f"{0.3 * high!r} {-0.5 * high!r} {high!r}",
        dir="-0.3 0.5 -1",
        diffuse="0.5 0.49 0.47",
        specular="0.25 0.25 0.25",
    )
    for direction, strength in (("1 -0.6 -0.5", "0.16 0.17 0.19"), ("-0.4 -1 -0.3", "0.1 0.1 0.11")):
        ET.SubElement(
            world, "light", directional="true", castshadow="false", dir=direction, diffuse=strength, specular="0 0 0"
        )


def _camera(view: View) -> Any:
    """Return MuJoCo's free camera for a view: a point to look to, the distance and two angles in deg."""
    forward = view.target - view.position
    camera: Any = mujoco.MjvCamera()
    camera.type = mujoco.mjtCamera.mjCAMERA_FREE
    camera.lookat, camera.distance = view.target, norm(forward)
    camera.azimuth = math.atan2(forward[1], forward[0]) / DEG
    camera.elevation = math.asin(float(np.clip(forward[2] / norm(forward), -1.0, 1.0))) / DEG
    return camera


def _shape_number(name: str) -> int:
    """Return the number of the shape that a geom belongs to (``dressing``); -1 for the floor."""
    return int(name.split("_")[0].removeprefix("shape")) if name.startswith("shape") else -1
