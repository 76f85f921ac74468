"""A robot in its cell as a MuJoCo model: which shape, joint and part is where in it.

``MujocoPlant`` moves this model by physics, ``Shapes`` only puts it into postures: both have the same shapes, so that
``check --motion`` reports a contact exactly where a run would have it.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import mujoco
import numpy as np

from runtime.cell.cell import CellSpec
from runtime.cell.gripper import fingers_of
from runtime.plant.gears import elastic_axes
from runtime.plant.mjcf import build_mjcf, gear_joint, joint_name, own_pairs, without_pairs
from runtime.robot.model.spec import RobotSpec

CLEARANCE = 1e-4
"""Shapes that meet by less than this touch, m."""
POSTURES = 200
"""Random postures in which pairs of shapes that overlap anyway are searched."""
OFTEN = 0.5
"""Share of them from which on the contact of a pair is no information."""

_Pair = tuple[str, str]


@dataclass(frozen=True, slots=True, kw_only=True)
class CellModel:
    """A robot in its cell: MuJoCo's mjModel, and the places of joints and parts in its state.

    ``motors`` (n,) and ``gears`` of the elastic axes are indices of positions and of speeds, as ``fingers`` are.
    ``parts`` gives the first of the seven numbers (centre, quaternion) of each part in the positions. ``shapes`` are
    the names of the geoms, ``own_pairs`` the geoms of arm and hand that may meet one another.
    """

    model: Any
    motors: Any
    gears: Any
    fingers: slice
    parts: Mapping[str, int]
    shapes: tuple[str, ...]
    own_pairs: tuple[tuple[int, int], ...]

    @classmethod
    def of(cls, spec: RobotSpec, cell: CellSpec, timestep: float = 1e-3) -> "CellModel":
        """Return the model of a robot in its cell, for physics steps of ``timestep`` s."""
        _keep_off_the_disk()
        xml = build_mjcf(spec, cell, timestep=timestep)
        pairs, idle = _keep_off_itself(xml, spec, cell)
        model: Any = mujoco.MjModel.from_xml_string(without_pairs(xml, idle) if idle else xml)
        elastic = elastic_axes(spec)
        fingers = len(fingers_of(cell.hand))
        hand = spec.n + len(elastic)  # joints come in the order of build_mjcf: axes and gears, fingers, parts
        return cls(
            model=model,
            motors=_addresses(model, [joint_name(axis) for axis in range(spec.n)]),
            gears=_addresses(model, [gear_joint(axis) for axis in elastic]),
            fingers=slice(hand, hand + fingers),
            parts={part.name: hand + fingers + 7 * k for k, part in enumerate(cell.parts)},
            shapes=tuple(str(model.geom(index).name) for index in range(model.ngeom)),
            own_pairs=tuple(_geoms(model, pair) for pair in pairs),
        )


def _keep_off_itself(xml: str, spec: RobotSpec, cell: CellSpec) -> tuple[list[_Pair], list[_Pair]]:
    """Return the shapes of the arm and the hand that may meet one another, and the pairs that are left out.

    The shapes are coarse: pairs that overlap at home or in more than ``OFTEN`` of some postures are left out.
    """
    pairs = tuple(own_pairs(spec, cell.hand))
    if not pairs:
        return [], []
    # a fixed seed: check and run must leave out the same pairs
    rows = np.random.default_rng(0).uniform(spec.lower, spec.upper, (POSTURES, spec.n))
    keep = _informative(xml, pairs, np.vstack([cell.home, rows]).tobytes(), spec.n)
    # not by a margin that no distance reaches: MuJoCo compares squares of it, and capsules would always meet
    return [pair for pair, kept in zip(pairs, keep, strict=True) if kept], [
        pair for pair, kept in zip(pairs, keep, strict=True) if not kept
    ]


@lru_cache(maxsize=32)
def _informative(xml: str, pairs: tuple[tuple[str, str], ...], postures: bytes, n: int) -> tuple[bool, ...]:
    """Return for each pair whether its contact is information: apart at home and in enough of the other postures.

    ``postures``: home and others, rows of n angles, rad. Remembered, since it takes longer than all the rest.
    """
    model: Any = mujoco.MjModel.from_xml_string(xml)
    data: Any = mujoco.MjData(model)
    joints = _addresses(model, [joint_name(axis) for axis in range(n)])
    geoms = [_geoms(model, pair) for pair in pairs]
    met = []
    for q in np.frombuffer(postures).reshape(-1, n):
        data.qpos[joints] = q
        mujoco.mj_kinematics(model, data)
        met.append([mujoco.mj_geomDistance(model, data, a, b, CLEARANCE, None) < -CLEARANCE for a, b in geoms])
    return tuple((~np.array(met[0]) & (np.mean(met[1:], axis=0) <= OFTEN)).tolist())


def _geoms(model: Any, names: tuple[str, str]) -> tuple[int, int]:
    return int(model.geom(names[0]).id), int(model.geom(names[1]).id)


def _addresses(model: Any, joints: Iterable[str]) -> Any:
    """Return where these hinges stand in the state (m,): the same place in positions and speeds, before any part."""
    return np.array([int(model.joint(name).qposadr[0]) for name in joints], dtype=np.intp)


def _keep_off_the_disk() -> None:
    """Stop MuJoCo from writing MUJOCO_LOG.TXT to the working folder and warnings to the console.

    The setting holds for the process: MuJoCo has one log. ``MujocoPlant.why_invalid`` gives the warnings.
    """
    config = mujoco.MjLogConfig.get()
    config.logto_file = False
    config.logto_console = False
    mujoco.MjLogConfig.set(config)
