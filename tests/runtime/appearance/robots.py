"""Scenes of every kind of robot, and postures of each, for tests of what they look like."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from runtime.appearance.cell_scene import scene_of
from runtime.appearance.mechanisms import machine_scene
from runtime.appearance.scene import Scene
from runtime.appearance.stance import Stance
from runtime.cell.cell import CellSpec
from runtime.core.frames import Array
from runtime.pulses.mechanism import library, load_builtin
from runtime.robot.files import loader
from runtime.robot.files.importer import load_file, read_model
from runtime.robot.files.sidecar import template
from tests.runtime.from_texts import load_cell
from tests.runtime.meshes import binary_stl, box_mesh
from tests.runtime.robot.models import SEVEN, fill

ARMS = ("puma560", "manutec_r3", "irb2400", "seven", "seven_meshes")
MACHINES = library()
MESHED = (1, 2, 4)
"""Links of ``seven_meshes`` that have meshes."""


@dataclass(frozen=True, kw_only=True)
class Sitter:
    """A scene, and three postures of it."""

    name: str
    scene: Scene
    lower: Array
    upper: Array
    home: Array

    @property
    def stances(self) -> list[Stance]:
        """Home, and two postures inside of the ranges."""
        span = self.upper - self.lower
        low, high = (self.lower + part * span for part in (0.35, 0.6))
        return [Stance(axes=q, fingers=(0.02, 0.02)) for q in (self.home, low, high)]


def sitter(name: str, folder: Path) -> Sitter:
    """Return a robot; ``folder`` is for the files of those that are imported."""
    if name in MACHINES:
        machine = load_builtin(name)
        lower, upper = (np.array([getattr(joint, end) for joint in machine.joints]) for end in ("lower", "upper"))
        return Sitter(name=name, scene=machine_scene(machine), lower=lower, upper=upper, home=machine.home.q)
    cell = cell_with(name, folder)
    return Sitter(name=name, scene=scene_of(cell), lower=cell.robot.lower, upper=cell.robot.upper, home=cell.home)


def cell_with(name: str, folder: Path) -> CellSpec:
    puma = load_cell(Path("programs/pick_and_place.cell.toml"))
    if name == "puma560":
        return puma
    manutec = load_cell(Path("programs/manutec_pick_and_place.cell.toml"))
    if name == "manutec_r3":
        return manutec
    if name == "irb2400":
        spec = loader.load_builtin(name)
        return replace(manutec, robot=spec, home=np.array([0.0, 0.2, 0.1, 0.0, 1.0, 0.0]))
    path = folder / f"{name}.urdf"
    path.write_text(SEVEN.read_text())
    if name == "seven_meshes":
        path.write_text(with_meshes(SEVEN.read_text(), folder))
    (folder / f"{name}.robot.toml").write_text(fill(template(read_model(path))))
    return replace(puma, robot=load_file(path), home=np.array([0.3, 0.5, 0.2, -1.2, 0.1, 0.8, 0.0]))


def with_meshes(text: str, folder: Path) -> str:
    """Return the URDF with a box of 0.1 x 0.1 x 0.5 m, in mm, as the mesh of some links."""
    (folder / "meshes").mkdir(exist_ok=True)
    (folder / "meshes" / "box.stl").write_bytes(binary_stl(box_mesh((100.0, 100.0, 500.0))))
    visual = (
        '<visual><origin xyz="0 0 0.02"/><geometry>'
        '<mesh filename="package://made_up/meshes/box.stl" scale="0.001 0.001 0.001"/></geometry></visual>'
    )
    for link in MESHED:
        mark = f'<link name="link_{link}">'
        assert mark in text
        text = text.replace(mark, mark + visual)
    return text
