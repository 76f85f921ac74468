"""The cell file ``NAME.cell.toml``: which robot, which hand, what lies around it, and what is really true of it.

Masses here are the *true* ones: the plant is built from them. What the controller believes comes from ``LOAD`` in
the program, and the difference between the two is what payload supervision has to notice. Lengths are mm and
angles degrees in the file, SI in ``CellSpec``; a pose is ``[x, y, z, rx, ry, rz]`` with ``R = Rz @ Ry @ Rx``
(docs/language.md). The robot is a built-in name or a TOML file inside the cell file's own folder: nothing outside that
folder is ever opened, whatever the file says. Read once, before anything moves.
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np

from runtime.frames import Array, frozen, pose_from_xyzrpy
from runtime.plant.seam_sensor import SensorSpec, read_sensor
from runtime.plant.signals import InputSpec, read_inputs
from runtime.robot.importer import ROBOT_ENDINGS, load_file
from runtime.robot.loader import library, load_builtin
from runtime.robot.spec import RobotSpec
from runtime.tomlfile import Source, Table, inside, load_table, read_source
from runtime.units import DEG, MM

SCHEMA = 1
REACH_MM = 20_000.0
"""No coordinate of a cell is further away than this, mm."""

HEAVIEST_KG = 5000.0
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,62}")


@dataclass(frozen=True, slots=True, kw_only=True)
class HandSpec:
    """A hand with two parallel fingers, as it really is; frames: flange and tool (the grip point).

    ``mass`` kg and ``cog`` (3,) m in the flange frame; ``X_flange_tool`` (4, 4): z points to the work piece, the
    fingers close along y; ``stroke`` m between the pads when open; ``grip_force`` N of each finger; ``dwell`` s
    that HAND waits; ``pad`` (3,) m: width along x, thickness, length along z of a finger pad, centred on the tool
    point; ``finger_length`` m from the palm to the tool point.
    """

    mass: float
    cog: Array
    X_flange_tool: Array
    stroke: float
    grip_force: float
    dwell: float
    pad: Array
    finger_length: float


@dataclass(frozen=True, slots=True, kw_only=True)
class PartSpec:
    """A loose box: ``size`` (3,) m, true ``mass`` kg, ``X_world_part`` (4, 4) of its centre, sliding ``friction``."""

    name: str
    size: Array
    mass: float
    X_world_part: Array
    friction: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ObstacleSpec:
    """A fixed box: ``size`` (3,) m and ``X_world_obstacle`` (4, 4) of its centre."""

    name: str
    size: Array
    X_world_obstacle: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadSpec:
    """A load a program may declare by name: ``mass`` kg, ``cog`` (3,) m in the flange frame."""

    mass: float
    cog: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class CellSpec:
    """A cell in SI: robot, home joints (n,) rad, hand, parts, obstacles and the names a program may use.

    ``tools`` are poses X_flange_tool, ``frames`` poses X_world_frame (4, 4), ``sensors`` seam sensors, ``inputs`` what
    each input does. ``controller`` is the unread table of the controller profile (None: the file has none).
    """

    robot: RobotSpec
    home: Array
    hand: HandSpec
    parts: tuple[PartSpec, ...]
    obstacles: tuple[ObstacleSpec, ...]
    loads: Mapping[str, LoadSpec]
    tools: Mapping[str, Array]
    frames: Mapping[str, Array]
    sensors: Mapping[str, SensorSpec]
    inputs: Mapping[int, InputSpec]
    controller: Table | None


def load_cell(path: Path) -> CellSpec:
    """Read a cell file; ``FileFault`` (RBL6xx) at the line that is wrong."""
    return parse_cell(read_source(path), path.parent)


def parse_cell(source: Source, folder: Path | None = None) -> CellSpec:
    """Build a ``CellSpec`` from the text of a cell file; ``FileFault`` at the line that is wrong.

    ``folder`` is where the file stands; without one (a cell held as text) only built-in robots can be named.
    """
    table = load_table(source)
    table.integer("schema", low=SCHEMA, high=SCHEMA)
    robot = _robot(table, folder)
    home = _home(table.table("home"), robot)
    hand = _hand(table.table("hand"))
    part_tables, obstacle_tables = (table.tables(key, required=False) for key in ("parts", "obstacles"))
    _unique([*obstacle_tables, *part_tables])
    cell = CellSpec(
        robot=robot,
        home=home,
        hand=hand,
        parts=tuple(_part(item) for item in part_tables),
        obstacles=tuple(_obstacle(item) for item in obstacle_tables),
        loads=MappingProxyType({name: _load(item) for name, item in _named(table, "loads").items()}),
        tools=MappingProxyType({name: _only_pose(item) for name, item in _named(table, "tools").items()}),
        frames=MappingProxyType({name: _only_pose(item) for name, item in _named(table, "frames").items()}),
        sensors=MappingProxyType({name: read_sensor(item, folder) for name, item in _named(table, "sensors").items()}),
        inputs=MappingProxyType(read_inputs(table.named_tables("inputs"))),
        controller=table.table("controller") if "controller" in table else None,
    )
    table.done()
    return cell


def _robot(table: Table, folder: Path | None) -> RobotSpec:
    name = table.text("robot")
    if not name.lower().endswith(ROBOT_ENDINGS):
        return load_builtin(table.text("robot", choices=library()))
    return load_file(inside(table, name, folder, "robot"))


def _home(table: Table, robot: RobotSpec) -> Array:
    q = np.array(table.numbers("joints_deg", robot.n, low=-3600.0, high=3600.0)) * DEG
    table.done()
    for index, (value, axis) in enumerate(zip(q, robot.axes, strict=True)):
        low, high = axis.limits.lower, axis.limits.upper
        if not low <= value <= high:
            table.fail(
                "RBL605",
                f"J{index + 1} at home is {value / DEG:g} deg and must be between {low / DEG:g} and {high / DEG:g}",
                key="joints_deg",
            )
    return frozen(q)


def _hand(table: Table) -> HandSpec:
    hand = HandSpec(
        mass=table.number("mass_kg", positive=True, high=HEAVIEST_KG),
        cog=_point(table, "cog_mm"),
        X_flange_tool=_pose(table, "tcp_mm_deg"),
        stroke=table.number("stroke_mm", positive=True, high=1000.0) * MM,
        grip_force=table.number("grip_force_n", positive=True, high=20_000.0),
        dwell=table.number("dwell_s", low=0.0, high=60.0),
        pad=_size(table, "pad_mm", (20.0, 8.0, 40.0)),
        finger_length=table.number("finger_length_mm", 52.0, positive=True, high=1000.0) * MM,
    )
    table.done()
    return hand


def _part(table: Table) -> PartSpec:
    part = PartSpec(
        name=table.text("name"),
        size=_size(table, "size_mm"),
        mass=table.number("mass_kg", low=1e-4, high=HEAVIEST_KG),
        X_world_part=_pose(table, "pose_mm_deg"),
        friction=table.number("friction", 0.5, positive=True, high=5.0),
    )
    table.done()
    return part


def _obstacle(table: Table) -> ObstacleSpec:
    obstacle = ObstacleSpec(
        name=table.text("name"),
        size=_size(table, "size_mm"),
        X_world_obstacle=_pose(table, "pose_mm_deg"),
    )
    table.done()
    return obstacle


def _load(table: Table) -> LoadSpec:
    load = LoadSpec(mass=table.number("mass_kg", low=0.0, high=HEAVIEST_KG), cog=_point(table, "cog_mm"))
    table.done()
    return load


def _only_pose(table: Table) -> Array:
    X = _pose(table, "pose_mm_deg")
    table.done()
    return X


def _pose(table: Table, key: str) -> Array:
    values = np.array(table.numbers(key, 6, low=-REACH_MM, high=REACH_MM))
    return frozen(pose_from_xyzrpy([*(values[:3] * MM), *(values[3:] * DEG)]))


def _point(table: Table, key: str) -> Array:
    return frozen(np.array(table.numbers(key, 3, low=-REACH_MM, high=REACH_MM)) * MM)


def _size(table: Table, key: str, default: tuple[float, ...] | None = None) -> Array:
    return frozen(np.array(table.numbers(key, 3, default, low=0.1, high=REACH_MM)) * MM)


def _named(table: Table, key: str) -> dict[str, Table]:
    """Return the tables ``[key.NAME]``; names are words of the language, which does not tell capitals apart."""
    tables = table.named_tables(key)
    _words(((name, item) for name, item in tables.items()), f"of [{key}]")
    return tables


def _unique(tables: list[Table]) -> None:
    _words(((item.text("name"), item) for item in tables), "of a part or obstacle")


def _words(names: Iterable[tuple[str, Table]], where: str) -> None:
    seen: set[str] = set()
    for name, item in names:
        key = "name" if "name" in item else None
        if not _NAME.fullmatch(name):
            item.fail("RBL613", f"the name '{name}' {where} must be letters, digits and '_'", key=key)
        if name.upper() in seen:
            item.fail("RBL610", f"the name '{name}' {where} is used twice", key=key)
        seen.add(name.upper())
