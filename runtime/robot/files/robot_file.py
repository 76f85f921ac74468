"""The robot file as it is written: every key known, every limit present, every value of its kind and in its range.

A file ``NAME.toml`` is read in the units of its keys, without numerics: ``robolang check`` and a run read the same
``RobotFile``. What needs vectors is judged by ``loader`` afterwards: whether bodies are possible, whether
the closed form describes the same arm. Nothing is guessed: a missing limit is an error that names the axis and the
key, and so is a key that nothing reads. The geometry comes as Denavit-Hartenberg rows or as joint lines in space
(``geometry`` has the meaning of both).
"""

import math
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Literal, cast

from runtime.core.record import Record
from runtime.core.tomlfile import FileFault, Source, Table
from runtime.robot.files.marks import load_marked
from runtime.robot.files.plausibility import doubt_axes
from runtime.robot.model import drives
from runtime.robot.model.drives import RISE_S, Bandwidths, Limits, Motor, PathLimits
from runtime.robot.model.estimated import axis_key

SCHEMA = 1
MOST_AXES = 7
"""One redundant axis; kinematics is for 2 to 7 axes."""
SHORTEST_DIRECTION = 1e-6
"""A direction shorter than this has lost its digits."""

# a path and no importlib.resources, which would import tempfile and zipfile: 6 ms of every check
_LIBRARY = Path(__file__).parents[1] / "library"
INERTIA_FORMS = "xx, yy, zz or xx, yy, zz, xy, xz, yz"
_LENGTHS = ("a1", "a2", "b", "c1", "c2", "c3", "c4")


class DhRow(Record):
    """A row of standard Denavit-Hartenberg: m and deg."""

    d_m: float
    a_m: float
    alpha_deg: float
    theta_offset_deg: float


class LineRow(Record):
    """A joint axis as a line in the base frame at the zero pose: a point on it, m, and its direction of any length."""

    origin_m: tuple[float, ...]
    direction: tuple[float, ...]


class FlangeRow(Record):
    """The flange in the base frame at the zero pose: m, and turns about the fixed x, y and z axes, deg."""

    position_m: tuple[float, ...]
    rotation_deg: tuple[float, ...]


class OpwRow(Record):
    """The closed form of ``[kinematics.opw]``: lengths m of a1, a2, b, c1 to c4; offsets deg; signs 1 or -1."""

    lengths_m: tuple[float, ...]
    offsets_deg: tuple[float, ...]
    signs: tuple[float, ...]


class CorrectionRow(Record):
    """A change to published body data, kg m2 and kg, with its reason; ``table`` is its place."""

    inertia_shift: float
    added_mass: float
    added_inertia: float
    reason: str
    table: Table


class AxisDrive(Record):
    """The drive of one ``[[axes]]``, in a robot file or in a sidecar; ``table`` is its place."""

    name: str
    motor: Motor
    limits: Limits
    bandwidths: Bandwidths
    correction: CorrectionRow | None
    table: Table


class AxisFile(Record):
    """One ``[[axes]]``: ``cog_m`` (3,) and ``inertia_kg_m2`` (3 or 6,) in the frame of the row."""

    row: DhRow | LineRow
    mass_kg: float
    cog_m: tuple[float, ...]
    inertia_kg_m2: tuple[float, ...]
    drive: AxisDrive


class RobotFile(Record):
    """A robot file; ``flange`` is given in the form of lines only. ``table`` is the whole file, for places.

    ``link_radii`` m are those of the capsules that stand for the links; empty: the file gives none. ``estimated`` has
    the rules of the values that are marked as estimates (``marks``), and of jerk limits that the file does not state.
    """

    name: str
    title: str
    sources: tuple[str, ...]
    notes: tuple[str, ...]
    rated_payload: float
    axes: tuple[AxisFile, ...]
    flange: FlangeRow | None
    path: PathLimits
    opw: OpwRow | None
    link_radii: tuple[float, ...]
    estimated: dict[str, str]
    table: Table

    @property
    def drives(self) -> tuple[AxisDrive, ...]:
        """Drive and limits of every axis."""
        return tuple(axis.drive for axis in self.axes)

    @property
    def limits(self) -> tuple[Limits, ...]:
        """Limits of every axis."""
        return tuple(drive.limits for drive in self.drives)

    @property
    def warnings(self) -> tuple[FileFault, ...]:
        """Doubts about ranges, speeds, jerks and gears (RBL627 to RBL629); those about bodies need numerics."""
        return doubt_axes(self.drives)


def library() -> list[str]:
    """Return the names of the built-in robots."""
    return sorted(path.stem for path in _LIBRARY.glob("*.toml"))


@cache
def builtin(name: str) -> RobotFile:
    """Return the file of a built-in robot; ``KeyError`` for another name."""
    if name not in library():
        raise KeyError(name)
    # read as any robot file, so that the library cannot hold what a user's file may not
    text = (_LIBRARY / f"{name}.toml").read_text("utf-8")
    return parse(Source(f"{name}.toml", text))


def parse(source: Source) -> RobotFile:
    """Return the content of a robot file; ``FileFault`` (RBL6xx) at the line that is wrong."""
    marked = load_marked(source)
    table = marked.table
    table.integer("schema", low=SCHEMA, high=SCHEMA)
    name, title = table.text("name"), table.text("title")
    kinematics = table.table("kinematics")
    # the form first: it decides which keys an axis has
    form = cast(Literal["dh", "lines"], kinematics.text("form", choices=("dh", "lines")))
    opw = _opw(kinematics.table("opw")) if "opw" in kinematics else None
    kinematics.done()
    path = drives.path_limits(table.table("path"))
    # by the number of axes before the axes themselves: a file of another kind is refused for what it is
    tables = table.tables("axes")
    if not 1 <= len(tables) <= MOST_AXES:
        table.fail("RBL605", f"a robot has 1 to {MOST_AXES} axes, not {len(tables)}", key="axes")
    names: set[str] = set()
    found = RobotFile(
        name=name,
        title=title,
        sources=drives.texts(table, "sources"),
        notes=drives.texts(table, "notes"),
        rated_payload=rated_payload(table),
        flange=_flange(table.table("flange")) if form == "lines" else None,
        link_radii=drives.link_radii(tables),
        axes=tuple(_axis(each, form, names) for each in tables),
        path=path,
        opw=opw,
        estimated={},
        table=table,
    )
    table.ask("estimated")
    table.done()
    # whether the parameters fit the axes needs numerics and is judged by ``loader``; their number does not
    if opw is not None and len(tables) != 6:
        table.fail("RBL615", f"the closed form is for 6 axes, not {len(tables)}", key="kinematics")
    if opw is not None and any(axis.drive.limits.kind.slides for axis in found.axes):
        table.fail("RBL615", "the closed form is for axes that turn", key="kinematics")
    return found.replaced(estimated={**marked.estimated(), **estimated_jerks(found.drives)})


def rated_payload(table: Table) -> float:
    """Return the heaviest load at the flange, kg; ``FileFault`` RBL60x."""
    return table.number("rated_payload_kg", low=0.0, high=5000.0)


def correction(table: Table) -> CorrectionRow | None:
    """Return the ``[axes.correction]`` of an axis, None without one; ``FileFault`` RBL60x."""
    if "correction" not in table:
        return None
    inner = table.table("correction")
    found = CorrectionRow(
        inertia_shift=inner.number("inertia_shift_kg_m2", low=0.0),
        added_mass=inner.number("added_mass_kg", low=0.0),
        added_inertia=inner.number("added_inertia_kg_m2", 0.0, low=0.0),
        reason=inner.text("reason"),
        table=inner,
    )
    inner.done()
    return found


def axis_drive(table: Table) -> AxisDrive:
    """Read the drive of an axis, the last that is read of its table; ``FileFault`` RBL60x, also for unknown keys."""
    kind = drives.axis_kind(table)
    found = AxisDrive(
        name=table.text("name"),
        motor=drives.motor(table.table("motor"), kind),
        limits=drives.limits(table, kind),
        bandwidths=drives.bandwidths(table.table("servo")),
        correction=correction(table),
        table=table,
    )
    table.done()
    return found


def estimated_jerks(axes: Iterable[AxisDrive]) -> dict[str, str]:
    """Return the rule of each jerk limit that a file does not state, by the name that it would have there."""
    rule = f"full acceleration after {RISE_S:g} s"
    keys = [(axis.limits.kind.jerk_key, axis.table) for axis in axes]
    return {axis_key(k, key): rule for k, (key, table) in enumerate(keys) if key not in table}


def _axis(table: Table, form: Literal["dh", "lines"], names: set[str]) -> AxisFile:
    # keys of the other form are not read, so ``done`` refuses them: two geometries of one axis could disagree
    row = _dh(table) if form == "dh" else _line(table)
    name = table.text("name")
    if name in names:
        table.fail("RBL610", f"two axes are named '{name}'", key="name")
    names.add(name)
    # bounds that hold for arms of any size, of a few kg to some tonnes; narrower ones are doubts (docs/decisions/0031)
    mass = table.number("mass_kg", low=0.0, high=10000.0)
    cog = table.numbers("cog_m", 3, low=-10.0, high=10.0)
    inertia = table.numbers("inertia_kg_m2", None, low=-1e5, high=1e5)
    if len(inertia) not in (3, 6):
        table.fail("RBL613", f"'{table.name('inertia_kg_m2')}' needs {INERTIA_FORMS}", key="inertia_kg_m2")
    return AxisFile(row=row, mass_kg=mass, cog_m=cog, inertia_kg_m2=inertia, drive=axis_drive(table))


def _dh(table: Table) -> DhRow:
    return DhRow(
        d_m=table.number("d_m", low=-10.0, high=10.0),
        a_m=table.number("a_m", low=-10.0, high=10.0),
        alpha_deg=table.number("alpha_deg", low=-360.0, high=360.0),
        theta_offset_deg=table.number("theta_offset_deg", 0.0, low=-360.0, high=360.0),
    )


def _line(table: Table) -> LineRow:
    row = LineRow(
        origin_m=table.numbers("origin_m", 3, low=-10.0, high=10.0),
        direction=table.numbers("direction", 3, low=-10.0, high=10.0),
    )
    # of any other length: only the direction counts, and it is made a unit vector by ``geometry``
    if not math.hypot(*row.direction) >= SHORTEST_DIRECTION:
        table.fail(
            "RBL605",
            f"'{table.name('direction')}' has no direction",
            "write a vector such as [0, 1, 0]",
            key="direction",
        )
    return row


def _flange(table: Table) -> FlangeRow:
    found = FlangeRow(
        position_m=table.numbers("position_m", 3, low=-10.0, high=10.0),
        rotation_deg=table.numbers("rotation_deg", 3, low=-360.0, high=360.0),
    )
    table.done()
    return found


def _opw(table: Table) -> OpwRow:
    lengths = tuple(table.number(f"{key}_m", low=-10.0, high=10.0) for key in _LENGTHS)
    offsets = table.numbers("offsets_deg", 6, low=-360.0, high=360.0)
    signs = table.numbers("signs", 6, low=-1.0, high=1.0)  # in [-1, 1] for the usual message, then exactly at an end
    if not all(abs(sign) == 1.0 for sign in signs):
        table.fail("RBL605", "'signs' must be 1 or -1", key="signs")
    table.done()
    return OpwRow(lengths_m=lengths, offsets_deg=offsets, signs=signs)
