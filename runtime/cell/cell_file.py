"""The cell file as it is written: every key known, every value of its kind and in its range, in the units of its keys.

``cell`` has the meaning and makes arrays of it. Imports no numerics: ``robolang check`` reads the same ``CellFile`` as
a run, so both find the same errors, all of them at once (docs/decisions/0028). The robot is a built-in name or a file
inside the cell file's own folder: nothing outside that folder is ever opened, whatever the file names.
"""

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar

from runtime.cell.holding import weakness
from runtime.cell.mesh_keys import MeshFile, MeshKeys
from runtime.cell.resting import Box, unrest
from runtime.cell.sensor_file import SensorFile, read_sensor_file
from runtime.cell.signals import InputSpec, read_inputs
from runtime.core.record import Record
from runtime.core.tomlfile import FileFault, Source, Table, inside, load_table, read_source
from runtime.robot.files import robot_file
from runtime.robot.files.arm_file import ROBOT_ENDINGS, ArmFile, read_arm_file
from runtime.settings.layers import Layer, read_layer

SCHEMA = 1
REACH_MM = 20_000.0
"""No coordinate of a cell is further away than this, mm."""

HEAVIEST_KG = 5000.0
"""Heaviest hand, part or load, as heavy as the heaviest rated payload of a robot file."""
SHAPES = ("box", "cylinder", "mesh")
"""Shapes of parts and obstacles."""
HANDS = ("fingers", "suction")
"""Kinds of hands."""
NEAREST_MM = 50.0
"""A camera is no nearer to what it looks to, mm."""
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,62}")

T = TypeVar("T")
Numbers = tuple[float, ...]


class HandFile(Record):
    """``[hand]``: see ``runtime.cell.cell.HandSpec``, also for what the values of a suction cup are."""

    kind: str
    mass_kg: float
    cog_mm: Numbers
    tcp_mm_deg: Numbers
    stroke_mm: float
    grip_force_n: float
    dwell_s: float
    pad_mm: Numbers
    finger_length_mm: float


class PartFile(Record):
    """One ``[[parts]]``: a loose body; ``size_mm`` are the edges of the box, or of the one that encloses another shape.

    ``mesh`` is that of the shape ``mesh``, else None.
    """

    name: str
    shape: str
    size_mm: Numbers
    pose_mm_deg: Numbers
    mass_kg: float
    friction: float
    mesh: MeshFile | None


class ObstacleFile(Record):
    """One ``[[obstacles]]``: a fixed body, ``size_mm`` and ``mesh`` as of a part."""

    name: str
    shape: str
    size_mm: Numbers
    pose_mm_deg: Numbers
    mesh: MeshFile | None


class LoadFile(Record):
    """``[loads.NAME]``: a load that a program may declare by name, in the flange frame."""

    mass_kg: float
    cog_mm: Numbers


class CameraFile(Record):
    """``[camera]``: from where pictures of the cell are taken, and what is in their middle."""

    position_mm: Numbers
    target_mm: Numbers


class CellFile(Record):
    """A cell file and its ``text``. ``home`` is deg, of a sliding axis mm. ``tools``, ``frames``: poses (6,) mm and
    deg by name, FLANGE and WORLD among them; ``controller``: the settings of ``[controller]``; ``doubts``: parts that
    cannot rest where they are (RBL640) or are heavy for the hand (RBL646, RBL647), and meshes that contacts fill
    (RBL645); ``meshes``: the files of meshes."""

    path: str
    text: str
    arm: ArmFile
    home: Numbers
    hand: HandFile
    parts: tuple[PartFile, ...]
    obstacles: tuple[ObstacleFile, ...]
    loads: Mapping[str, LoadFile]
    tools: Mapping[str, Numbers]
    frames: Mapping[str, Numbers]
    sensors: Mapping[str, SensorFile]
    inputs: Mapping[int, InputSpec]
    controller: Layer
    camera: CameraFile | None
    meshes: tuple[str, ...]
    doubts: tuple[FileFault, ...]

    @property
    def warnings(self) -> tuple[FileFault, ...]:
        """Doubts about the cell and its arm, those about bodies excepted, which need numerics."""
        return (*self.arm.warnings, *self.doubts)


def read_cell_file(path: Path) -> CellFile:
    """Read a cell file; ``FileFault`` (RBL6xx) at the first line that is wrong, with all others."""
    return parse_cell_file(read_source(path), path.parent)


def read_arm_alone(path: Path, source: Source | None = None) -> ArmFile | None:
    """Return the arm of a cell file that has errors elsewhere, None where the arm cannot be read either.

    ``source``: the text, where it is known.
    """
    try:
        return _arm(load_table(source or read_source(path)), path.parent)
    except FileFault:
        return None


def parse_cell_file(source: Source, folder: Path | None = None) -> CellFile:
    """Return the content of a cell file; ``FileFault`` at the first line that is wrong, with all others.

    ``folder`` is that of the file; without one (a cell held as text) only built-in robots can be named.
    """
    table = load_table(source, gather=True)  # gather: a user corrects all errors of a file at once
    table.integer("schema", low=SCHEMA, high=SCHEMA)
    # every part is read whatever is wrong with another one; None stands for a part with errors until ``finish``
    arm = table.attempt(lambda: _arm(table, folder))
    home = table.table("home").gather(lambda home: _home(home, arm))
    hand = table.table("hand").gather(_hand)
    parts, obstacles = (table.tables(key, required=False) for key in ("parts", "obstacles"))
    _words(((item.text("name"), item) for item in (*obstacles, *parts)), "of a part or obstacle")
    meshes = MeshKeys(folder)
    lying = _all(parts, lambda item: _part(item, meshes))
    fixed = _all(obstacles, lambda item: _obstacle(item, meshes))
    loads = _named(table, "loads", _load)
    tools, frames = _poses(table, "tools", "FLANGE"), _poses(table, "frames", "WORLD")
    sensors = _named(table, "sensors", lambda item: read_sensor_file(item, folder))
    inputs = table.attempt(lambda: read_inputs(table.named_tables("inputs")))
    controller = table.table("controller").gather(read_layer) if "controller" in table else {}
    camera = table.table("camera").gather(_camera) if "camera" in table else None
    table.finish()
    assert arm is not None and home is not None and hand is not None and inputs is not None and controller is not None
    return CellFile(
        text=source.text,
        path=source.path,
        arm=arm,
        home=home,
        hand=hand,
        parts=lying,
        obstacles=fixed,
        loads=loads,
        tools=tools,
        frames=frames,
        sensors=sensors,
        inputs=MappingProxyType(inputs),
        controller=controller,
        camera=camera,
        meshes=meshes.names,
        doubts=(
            *_hollow(fixed, obstacles, "obstacle"),
            *_hollow(lying, parts, "part"),
            *_doubts(lying, fixed, parts),
            *_heavy(hand, lying, parts),
        ),
    )


def _all(tables: Iterable[Table], read: Callable[[Table], T]) -> tuple[T, ...]:
    """Return the results of reading tables, without those in which something is wrong."""
    return tuple(each for each in (table.gather(read) for table in tables) if each is not None)


def _doubts(
    parts: tuple[PartFile, ...],
    obstacles: tuple[ObstacleFile, ...],
    items: list[Table],
) -> Iterator[FileFault]:
    """Yield RBL640 for every part that cannot rest where it is; of two that overlap, at the later one."""
    # obstacles and earlier parts may not be overlapped; any part may support, also one that comes later in the file
    fixed, loose = [_box("obstacle", each) for each in obstacles], [_box("part", each) for each in parts]
    for index, (part, item) in enumerate(zip(loose, items, strict=True)):
        others = [*fixed, *loose[:index]]
        if why := unrest(part, others, [*others, *loose[index + 1 :]]):
            yield item.fault("RBL640", why, key="pose_mm_deg")


def _hollow(bodies: Sequence[PartFile | ObstacleFile], items: list[Table], kind: str) -> list[FileFault]:
    """Return RBL645 for every mesh that is not what contacts take it for."""
    doubts = [
        body.mesh.doubt(f"{kind} '{body.name}'", item)
        for body, item in zip(bodies, items, strict=True)
        if body.mesh is not None
    ]
    return [each for each in doubts if each is not None]


def _heavy(hand: HandFile, parts: tuple[PartFile, ...], items: list[Table]) -> Iterator[FileFault]:
    """Yield RBL646 or RBL647 for every part that the hand holds without a reserve, or not at all."""
    for part, item in zip(parts, items, strict=True):
        if found := weakness(hand.kind, hand.grip_force_n, part.mass_kg, part.friction):
            code, why = found
            yield item.fault(code, f"part '{part.name}' {why}", key="mass_kg")


def _box(kind: str, body: PartFile | ObstacleFile) -> Box:
    box = Box.of(f"{kind} '{body.name}'", body.size_mm, body.pose_mm_deg, body.shape == "cylinder")
    return box if body.mesh is None else box.replaced(outline=body.mesh.mesh)


def _arm(table: Table, folder: Path | None) -> ArmFile:
    """Return the arm that ``robot`` names: a built-in one, or a file by its ending; ``FileFault`` RBL6xx."""
    name = table.text("robot")
    # by its ending: a name without one is a robot of the library, and a misspelt one gets the list of these
    if not name.lower().endswith(ROBOT_ENDINGS):
        return robot_file.builtin(table.text("robot", choices=robot_file.library()))
    return read_arm_file(inside(table, name, folder, "robot"))


def _home(table: Table, arm: ArmFile | None) -> Numbers:
    # without an arm, whose file may be what is wrong, any number of joints is accepted
    # mm are not written under deg: an arm with an axis that slides has a key of its own
    slides = "joints" in table if arm is None else any(limits.kind.slides for limits in arm.limits)
    key = "joints" if slides else "joints_deg"
    home = table.numbers(key, None if arm is None else len(arm.limits), low=-20000.0, high=20000.0)
    table.done()
    # not strict: without an arm there is no limit to compare with, and the error of the arm is reported instead
    for index, (value, limits) in enumerate(zip(home, arm.limits if arm else (), strict=False)):
        kind = limits.kind
        if not limits.lower <= value * kind.size <= limits.upper:
            table.fail(
                "RBL605",
                f"J{index + 1} at home is {value:g} {kind.unit} and must be between {limits.lower / kind.size:g} "
                f"and {limits.upper / kind.size:g}",
                key=key,
            )
    return home


def _hand(table: Table) -> HandFile:
    kind = table.text("kind", "fingers", choices=HANDS)
    hand = HandFile(
        kind=kind,
        mass_kg=table.number("mass_kg", positive=True, high=HEAVIEST_KG),
        cog_mm=_point(table, "cog_mm"),
        tcp_mm_deg=_pose(table, "tcp_mm_deg"),
        dwell_s=table.number("dwell_s", low=0.0, high=60.0),
        **(_cup(table) if kind == "suction" else _fingers(table)),
    )
    table.done()
    return hand


def _fingers(table: Table) -> Mapping[str, Any]:
    return {
        "stroke_mm": table.number("stroke_mm", positive=True, high=1000.0),
        "grip_force_n": table.number("grip_force_n", positive=True, high=20_000.0),
        "pad_mm": _size(table, "pad_mm", (20.0, 8.0, 40.0)),
        "finger_length_mm": table.number("finger_length_mm", 52.0, positive=True, high=1000.0),
    }


def _cup(table: Table) -> Mapping[str, Any]:
    # the keys of fingers hold it from here on: what reads a hand has one record for both kinds
    diameter = table.number("cup_diameter_mm", low=1.0, high=1000.0)
    return {
        "stroke_mm": 0.0,
        "grip_force_n": table.number("holding_force_n", positive=True, high=20_000.0),
        "pad_mm": (diameter / 2.0, diameter / 2.0, diameter),
        "finger_length_mm": table.number("cup_length_mm", 30.0, low=1.0, high=1000.0),
    }


def _part(table: Table, meshes: MeshKeys) -> PartFile:
    shape, size_mm, mesh = _solid(table, meshes)
    part = PartFile(
        name=table.text("name"),
        shape=shape,
        size_mm=size_mm,
        mesh=mesh,
        # above 0: the physics cannot move a body without mass
        mass_kg=table.number("mass_kg", low=1e-4, high=HEAVIEST_KG),
        pose_mm_deg=_pose(table, "pose_mm_deg"),
        friction=table.number("friction", 0.5, positive=True, high=5.0),
    )
    table.done()
    return part


def _obstacle(table: Table, meshes: MeshKeys) -> ObstacleFile:
    shape, size_mm, mesh = _solid(table, meshes)
    obstacle = ObstacleFile(
        name=table.text("name"), shape=shape, size_mm=size_mm, mesh=mesh, pose_mm_deg=_pose(table, "pose_mm_deg")
    )
    table.done()
    return obstacle


def _solid(table: Table, meshes: MeshKeys) -> tuple[str, Numbers, MeshFile | None]:
    """Return the shape of a body, the edges of the box around it, mm, and its mesh, if it is one."""
    shape = table.text("shape", "box", choices=SHAPES)
    if shape == "cylinder":
        diameter = table.number("diameter_mm", low=0.1, high=REACH_MM)
        return shape, (diameter, diameter, table.number("height_mm", low=0.1, high=REACH_MM)), None
    if shape == "mesh":
        mesh = meshes.read(table)
        return shape, mesh.size_mm, mesh
    return shape, _size(table, "size_mm"), None


def _load(table: Table) -> LoadFile:
    load = LoadFile(mass_kg=table.number("mass_kg", low=0.0, high=HEAVIEST_KG), cog_mm=_point(table, "cog_mm"))
    table.done()
    return load


def _camera(table: Table) -> CameraFile:
    camera = CameraFile(position_mm=_point(table, "position_mm"), target_mm=_point(table, "target_mm"))
    table.done()
    if not math.dist(camera.position_mm, camera.target_mm) >= NEAREST_MM:
        table.fail("RBL605", f"the camera is less than {NEAREST_MM:g} mm from its target", key="target_mm")
    return camera


def _only_pose(table: Table) -> Numbers:
    pose = _pose(table, "pose_mm_deg")
    table.done()
    return pose


def _pose(table: Table, key: str) -> Numbers:
    return table.numbers(key, 6, low=-REACH_MM, high=REACH_MM)


def _point(table: Table, key: str) -> Numbers:
    return table.numbers(key, 3, low=-REACH_MM, high=REACH_MM)


def _size(table: Table, key: str, default: Numbers | None = None) -> Numbers:
    return table.numbers(key, 3, default, low=0.1, high=REACH_MM)


def _named(table: Table, key: str, read: Callable[[Table], T]) -> Mapping[str, T]:
    """Read the tables ``[key.NAME]``; names are words of the language, which ignores case."""
    # names are checked apart from contents: an error of the one does not hide those of the other
    tables = table.named_tables(key)
    _words(tables.items(), f"of [{key}]")
    found = {name: item.gather(read) for name, item in tables.items()}
    return MappingProxyType({name: each for name, each in found.items() if each is not None})


def _poses(table: Table, key: str, origin: str) -> Mapping[str, Numbers]:
    """Read the poses of the tables ``[key.NAME]``, and add ``origin``, which every cell has and none may define."""

    def read(item: Table) -> Numbers:
        if (name := str(item.keys[-1])).upper() == origin:
            item.fail(
                "RBL610",
                f"the name '{name}' of [{key}] is that of the {origin.lower()} itself",
                f"give it another name; every cell has {origin} without a table",
            )
        return _only_pose(item)

    return MappingProxyType({origin: (0.0,) * 6, **_named(table, key, read)})


def _words(names: Iterable[tuple[str, Table]], where: str) -> None:
    """Refuse names that a program could not write, and names that are used twice."""
    seen: set[str] = set()
    for name, item in names:
        item.gather(lambda item, name=name: _word(name, item, where, seen))  # type: ignore[misc]


def _word(name: str, item: Table, where: str, seen: set[str]) -> None:
    key = "name" if "name" in item else None
    if not _NAME.fullmatch(name):
        item.fail("RBL613", f"the name '{name}' {where} must be letters, digits and '_'", key=key)
    if name.upper() in seen:
        item.fail(
            "RBL610",
            f"the name '{name}' {where} is used twice",
            "give each a name of its own; names ignore case",
            key=key,
        )
    seen.add(name.upper())
