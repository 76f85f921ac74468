"""What a program may name and what its arm may do: the facts of the cell that need no numerics.

Only ``CellSymbols.of(cell, points)`` makes facts of files. One value of it is in the ``Analysis`` that check, a run,
the dry run and an editor share, so that they cannot disagree. A fact that is None is not known and not checked. Names
are in capitals.
"""

from collections.abc import Collection, Mapping

from runtime.cell.cell_file import CellFile, LoadFile
from runtime.core.record import Record
from runtime.core.units import MM
from runtime.robot.files.arm_file import ArmFile
from runtime.robot.model.drives import Limits


class CellSymbols(Record):
    """Names of a cell and of its taught points, what the arm may carry (kg), and the limits of its axes and its tool.

    ``loads`` have their numbers where these are known. ``cell_file`` and ``points_file`` are the paths that a remedy
    names; empty: not known. ``no_cell`` is the cell file that a program in the built-in cell could have.
    """

    robot: str | None = None
    limits: tuple[Limits, ...] | None = None
    rated_payload: float | None = None
    max_speed_mm_s: float | None = None
    sensors: frozenset[str] | None = None
    tools: frozenset[str] | None = None
    frames: frozenset[str] | None = None
    loads: Mapping[str, LoadFile | None] | None = None
    inputs: frozenset[int] | None = None
    points: frozenset[str] | None = None
    cell_file: str = ""
    points_file: str = ""
    no_cell: str = ""

    @staticmethod
    def of(
        cell: CellFile | ArmFile | None,
        points: Collection[str] | None = None,
        *,
        cell_file: str = "",
        points_file: str = "",
    ) -> "CellSymbols":
        """Return the facts of a cell and the names of its taught points; None is not known.

        An ``ArmFile`` alone stands for a cell whose file is damaged: nothing is known of it but its robot.
        ``cell_file`` and ``points_file`` are the files to which names can be added.
        """
        arm = cell.arm if isinstance(cell, CellFile) else cell
        found = CellSymbols(points=_keys(points), cell_file=cell_file, points_file=points_file)
        if arm is not None:
            found = found.replaced(
                robot=arm.name,
                limits=arm.limits,
                rated_payload=arm.rated_payload,
                # in mm/s as in the text: planners convert back to compare (``Limit.fault``)
                max_speed_mm_s=None if arm.path is None else arm.path.max_speed / MM,
            )
        if not isinstance(cell, CellFile):
            return found
        return found.replaced(
            sensors=_keys(cell.sensors),
            tools=_keys(cell.tools),
            frames=_keys(cell.frames),
            loads={name.upper(): load for name, load in cell.loads.items()},
            inputs=frozenset(cell.inputs),
        )

    @property
    def axes(self) -> int | None:
        """Number of axes of the arm."""
        return None if self.limits is None else len(self.limits)

    def where_to_add(self, kind: str, name: str) -> str:
        """Return what to do about the name of a tool, frame, load or sensor that the cell does not have."""
        known = {"tool": self.tools, "frame": self.frames, "load": self.loads, "sensor": self.sensors}[kind]
        there = f"{kind}s of the cell: {', '.join(sorted(known))}" if known else f"the cell has no {kind}s"
        if not self.cell_file:
            return f"{there}; a cell file beside the program, {self.no_cell or 'NAME.cell.toml'}, can define more"
        return f"{there}; to add it, write into {self.cell_file}: [{kind}s.{name}] {_KEYS[kind]}"

    def where_to_teach(self, name: str) -> str:
        """Return how to teach a point of a name; empty where nothing is known of the points."""
        if self.points is None or len(self.points) > _MANY:
            known = ""
        else:
            known = f"taught: {', '.join(sorted(self.points))}" if self.points else "no point is taught"
        if not self.points_file:
            return known
        first = "" if self.points else "schema = 1, then "
        return (
            f"{known}{'; ' * bool(known)}to teach it, write into {self.points_file}: {first}[points.{name}] "
            "pose = [x, y, z, rx, ry, rz] in mm and deg"
        )


_MANY = 10
_KEYS = {
    "tool": "pose_mm_deg = [x, y, z, rx, ry, rz]",
    "frame": "pose_mm_deg = [x, y, z, rx, ry, rz]",
    "load": "mass_kg = 1.0, cog_mm = [0, 0, 60]",
    "sensor": 'kind = "ramp", ...',
}
"""What an entry of each kind needs in the cell file."""

NOTHING_KNOWN = CellSymbols()


def _keys(names: Collection[str] | None) -> frozenset[str] | None:
    return None if names is None else frozenset(name.upper() for name in names)
