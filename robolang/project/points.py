"""Taught points: the file ``NAME.points.toml`` beside a program, read as a whole and never half.

::

    schema = 1
    robot = "puma560"                       # optional: the robot they were taught on
    [points.P1]
    pose = [450, -150, 200, 180, 0, 90]     # mm and deg, or: joints = [...] in deg
    frame = "TABLE"                         # optional, as are tool and comment
    configuration = "LEFTY ABOVE NOFLIP"    # optional
    turns = [0, 0, 0]                       # optional

Orientation is RX RY RZ about the fixed axes. Names ignore case. Every error is a ``FileFault`` with its place and a
code RBL30x or RBL311; the codes of the TOML reader are translated, since those are about robot and cell files. All
errors of a file are found at once; with the facts of the cell also joints that the robot cannot have, and frames and
tools that do not exist.
Teaching, which writes this file, is not here.
"""

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import NoReturn

import robolang.core.codes  # noqa: F401 - the codes raised here must be registered
from robolang.analysis.cell_symbols import NOTHING_KNOWN, CellSymbols
from robolang.syntax.keywords import RESERVED, near
from runtime.core.bounded_files import resolved_inside
from runtime.core.faults import lookup
from runtime.core.record import Record
from runtime.core.tomlfile import FileFault, Source, Table, load_table, read_source
from runtime.robot.model.drives import beyond_range

SCHEMA = 1
# 100 m, more than any robot reaches: such a value is in another unit
MAX_MM = 1e5
MAX_DEG = 1e4
MAX_TURNS = 100
NAME_HINT = "start the name with a letter or _, use letters, digits and _ only, and no keyword"

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_CHOICES = (("LEFTY", "RIGHTY"), ("ABOVE", "BELOW"), ("FLIP", "NOFLIP"))
_TRANSLATED = {
    "RBL600": "RBL311",
    "RBL601": "RBL303",
    "RBL604": "RBL309",
    "RBL605": "RBL309",
    "RBL608": "RBL303",
    "RBL609": "RBL308",
    "RBL613": "RBL303",
}


class Point(Record):
    """A taught point: exactly one of ``pose`` (mm, mm, mm, deg, deg, deg) and ``joints`` (deg) is given."""

    name: str
    pose: tuple[float, float, float, float, float, float] | None = None
    joints: tuple[float, ...] | None = None
    frame: str = ""
    tool: str = ""
    configuration: tuple[str, ...] = ()
    turns: tuple[int, ...] = ()
    comment: str = ""


class PointStore(Record):
    """The points of one file by upper-case name, in file order."""

    path: str
    robot: str = ""
    points: Mapping[str, Point] = MappingProxyType({})

    @property
    def names(self) -> frozenset[str]:
        """The names in capitals, as ``checker.check`` takes them."""
        return frozenset(self.points)

    def get(self, name: str) -> Point | None:
        """Return a point by its name in any case; None when it is not taught."""
        return self.points.get(name.upper())


def can_be_name(name: str) -> bool:
    """Return whether a program can name a point so."""
    return _NAME.fullmatch(name) is not None and name.upper() not in RESERVED


def load_points(path: Path | str, symbols: CellSymbols = NOTHING_KNOWN) -> PointStore:
    """Read a file of taught points; ``symbols`` are the facts of the cell in which they shall be used.

    Raises ``FileFault``, the first with all others: RBL302 missing, RBL303 damaged, RBL304 newer schema, RBL305 frame
    or tool unknown, RBL307 wrong count, RBL308 unknown key or word, RBL309 value out of range, RBL310 other robot,
    RBL311 not a regular file of this folder.
    """
    return read_points(points_source(Path(path)), symbols)


def read_points(source: Source, symbols: CellSymbols = NOTHING_KNOWN) -> PointStore:
    """Read the text of a points file; ``FileFault`` as ``load_points`` for what is wrong in the text."""
    with _translated(Path(source.path)):
        if not source.text.strip():
            source.fail("RBL303", f"{source.path} is empty")
        table = load_table(source, gather=True)
        _schema(table)
        store = _store(table, symbols)
        table.finish()
    return store


def points_source(path: Path) -> Source:
    """Return the text of a points file, whatever is in it; ``FileFault`` RBL302, RBL311."""
    nowhere = Source(str(path), "")
    try:
        target = resolved_inside(path, path.parent, strict=True)
    except (FileNotFoundError, NotADirectoryError):
        nowhere.fail("RBL302", f"there is no file {path}")
    except (OSError, RuntimeError, ValueError) as error:
        nowhere.fail("RBL311", f"cannot open {path}: {getattr(error, 'strerror', None) or error}")
    if target is None:
        nowhere.fail("RBL311", f"{path} is a link to a file outside its folder")
    return read_source(path, "RBL311")


@contextmanager
def _translated(path: Path) -> Iterator[None]:
    """Give the faults of the TOML reader the codes of a points file, at the same place."""
    try:
        yield
    except FileFault as fault:
        first, *others = (_as_point_fault(each, path) for each in fault.all if isinstance(each, FileFault))
        first.others = tuple(others)
        raise first from None
    except ValueError as error:  # tomllib lets int() refuse a literal of thousands of digits
        Source(str(path), "").fail("RBL303", f"{path} is not a points file: {error}")


def _as_point_fault(fault: FileFault, path: Path) -> FileFault:
    code = _TRANSLATED.get(fault.code, fault.code)
    copy = path.with_name(f"{path.name}.bak")
    hint = f"{copy.name} may hold an intact copy" if code == "RBL303" and copy.is_file() else ""
    if code == fault.code and not hint:
        return fault
    kept = "" if fault.hint == lookup(fault.code).remedy else fault.hint  # the remedy of the new code is better
    return FileFault(code, fault.message, hint or kept, fault.place)


def _schema(table: Table) -> None:
    # the upper end is far: a newer schema is reported as one (RBL304), and not as out of range
    schema = table.integer("schema", low=1, high=10**6)
    if schema > SCHEMA:
        table.fail("RBL304", f"the file has schema {schema}; this version reads {SCHEMA}", key="schema")


def _store(table: Table, symbols: CellSymbols) -> PointStore:
    taught_on = table.text("robot", "")
    if symbols.robot is not None and taught_on and taught_on.casefold() != symbols.robot.casefold():
        table.fail("RBL310", f"the points were taught on '{taught_on}', the robot is '{symbols.robot}'", key="robot")
    points: dict[str, Point] = {}
    for name, entry in table.named_tables("points").items():
        point = entry.gather(lambda entry, name=name: _point(name, entry, symbols, points))  # type: ignore[misc]
        if point is not None:
            points[name.upper()] = point
    return PointStore(path=table.source.path, robot=taught_on, points=MappingProxyType(points))


def _point(name: str, entry: Table, symbols: CellSymbols, others: Mapping[str, Point]) -> Point:
    _check_name(name, entry, others)
    _check_one_place(name, entry)
    point = Point(
        name=name,
        pose=entry.attempt(lambda: _pose(entry)) if "pose" in entry else None,
        joints=entry.attempt(lambda: _joints(entry, symbols)) if "joints" in entry else None,
        frame=entry.attempt(lambda: _named(entry, "frame", symbols.frames, symbols)) or "",
        tool=entry.attempt(lambda: _named(entry, "tool", symbols.tools, symbols)) or "",
        configuration=entry.attempt(lambda: _configuration(entry)) or (),
        turns=entry.attempt(lambda: _turns(entry, symbols.axes)) or (),
        comment=entry.text("comment", ""),
    )
    entry.done()
    return point


def _check_name(name: str, entry: Table, others: Mapping[str, Point]) -> None:
    if not can_be_name(name):
        entry.fail("RBL303", f"'{name}' cannot be the name of a point", NAME_HINT)
    # TOML keeps P1 and p1 apart, the language does not
    if name.upper() in others:
        entry.fail("RBL303", f"point '{name}' is defined twice: names ignore case")


def _check_one_place(name: str, entry: Table) -> None:
    """Refuse a point with both 'pose' and 'joints', which might contradict each other, and one with neither."""
    if "pose" in entry and "joints" in entry:
        entry.fail("RBL303", f"point '{name}' has both 'pose' and 'joints'", "remove one of the two", key="joints")
    if "pose" not in entry and "joints" not in entry:
        _without_place(name, entry)


def _without_place(name: str, entry: Table) -> NoReturn:
    """Refuse a point that lies nowhere: at a key that may be a misspelt 'pose' or 'joints', else at its header."""
    entry.ask("frame", "tool", "configuration", "turns", "comment")
    entry.done()
    entry.fail(
        "RBL303",
        f"point '{name}' has neither 'pose' nor 'joints'",
        "write pose = [x, y, z, rx, ry, rz] in mm and deg, or joints = [...] in deg",
    )


def _named(entry: Table, key: str, known: frozenset[str] | None, symbols: CellSymbols) -> str:
    """Read the name of a frame or a tool of the cell."""
    name = entry.text(key, "")
    if name and known is not None and name.upper() not in known:
        entry.fail("RBL305", f"the cell has no {key} '{name}'", symbols.where_to_add(key, name), key=key)
    return name


def _pose(entry: Table) -> tuple[float, float, float, float, float, float]:
    values = entry.numbers("pose", None, low=-MAX_MM, high=MAX_MM)
    if len(values) != 6:
        entry.fail("RBL307", f"'pose' has {len(values)} values; it needs 6: x, y, z, rx, ry, rz", key="pose")
    if not all(abs(angle) <= MAX_DEG for angle in values[3:]):
        entry.fail("RBL309", f"an angle of 'pose' is more than {MAX_DEG:g} deg", key="pose")
    x, y, z, rx, ry, rz = values
    return x, y, z, rx, ry, rz


def _joints(entry: Table, symbols: CellSymbols) -> tuple[float, ...]:
    values, axes = entry.numbers("joints", None, low=-MAX_DEG, high=MAX_DEG), symbols.axes
    # without a cell: the numbers of axes that the kinematics has
    fits = 2 <= len(values) <= 7 if axes is None else len(values) == axes
    if not fits:
        needed = "2 to 7" if axes is None else str(axes)
        entry.fail("RBL307", f"'joints' has {len(values)} values; it needs {needed}", key="joints")
    # without a cell no limits are known, and nothing is compared
    beyond = beyond_range(values, symbols.limits or ())
    if beyond:
        entry.fail("RBL309", beyond, "teach the point within the range of the joint", key="joints")
    return values


def _configuration(entry: Table) -> tuple[str, ...]:
    words = entry.text("configuration", "").upper().split()
    for word in words:
        pair = next((pair for pair in _CHOICES if word in pair), None)
        if pair is None:
            guess = near(word, [choice for pair in _CHOICES for choice in pair])
            hint = f"did you mean {guess}?" if guess else "write LEFTY or RIGHTY, ABOVE or BELOW, FLIP or NOFLIP"
            entry.fail("RBL308", f"'{word}' is not a configuration word", hint, key="configuration")
        if sum(words.count(choice) for choice in pair) > 1:
            message = f"'configuration' may have only one of {pair[0]} and {pair[1]}, once"
            entry.fail("RBL303", message, key="configuration")
    return tuple(words)


def _turns(entry: Table, axes: int | None) -> tuple[int, ...]:
    values = entry.numbers("turns", None, (), low=-MAX_TURNS, high=MAX_TURNS)
    most = 7 if axes is None else axes
    if len(values) > most or any(value != int(value) for value in values):
        entry.fail("RBL307", f"'turns' must be at most {most} whole numbers, one for each joint", key="turns")
    return tuple(int(value) for value in values)
