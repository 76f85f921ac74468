"""A template before a robot: the first place in which its rehearsal finds nothing.

The files are those that are written, checked as ``check`` and ``check --motion`` check them, on no disk.
"""

from collections.abc import Mapping
from itertools import islice
from pathlib import Path

import numpy as np

from robolang.analysis.analysis import Analysis
from robolang.core.diagnostics import Diagnostic
from robolang.core.source import Source
from robolang.lint.engine import findings as text_findings
from robolang.planning.motion_findings import findings as motion_findings
from robolang.planning.path_coverage import explore
from robolang.project.discovery import Typed
from robolang.project.points import Point
from robolang.project.project import Project, load_project
from robolang.templates.arm import Arm
from robolang.templates.placing import Job, placements
from robolang.templates.template import CELL, POINTS, PROGRAM, TEST, Template
from robolang.templates.trial import Outcome, tried
from runtime.appearance.own_meshes import mesh_files
from runtime.core.faults import Fault
from runtime.core.frames import Array, pose, pose_from_xyzrpy
from runtime.core.linear import matmul
from runtime.core.record import Record
from runtime.core.tomlfile import FileFault
from runtime.core.units import DEG, MM
from runtime.robot.files import importer
from runtime.robot.files.arm_file import read_arm_file
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics

TABLE = "table"
"""The obstacle of every template on which the job stands."""
LIFT = 0.08
"""How far over its points a job goes, m."""
MOST_REHEARSED = 12
"""Places whose rehearsal is made."""


class Fitted(Record):
    """The files of a template by ending, and what a user has to know about the arm.

    ``physics``: its drives do the job, or are not asked to. ``meshes``: files to copy with its model, by name.
    """

    texts: Mapping[str, str]
    physics: bool
    notes: tuple[str, ...]
    meshes: Mapping[str, bytes]


def fitted(template: Template, arm: Arm) -> Fitted:
    """Return a template for a robot; ``Fault`` RBL843 where it has no place.

    ``FileFault`` RBL6xx for a robot file that cannot be used.
    """
    # not load_any_robot: planning does without the drives that it asks for
    robot = load_builtin(arm.source) if arm.is_builtin else importer.build(read_arm_file(Path(arm.source)))
    here = _project(template.texts, Path())
    heaviest = max(load.mass for load in here.cell.loads.values())
    # before the search: a hand that is too heavy is so in every place
    if not heaviest <= robot.rated_payload:
        weight = f"hand and part weigh {heaviest:g} kg, its rated payload is {robot.rated_payload:g} kg"
        raise _unfit(template, arm, weight)
    why = "nowhere before it does it reach every point with room to the ends of its ranges"
    for placement in islice(placements(Kinematics(robot), _job(here)), MOST_REHEARSED):
        project = _project(placement.files(template.texts, arm.read_as, arm.name), arm.folder)
        worst, planned_s = _checked(project)
        if worst is None:
            texts = placement.files(template.texts, arm.reference, arm.name)
            return _tested(template, arm, project, texts, planned_s)
        why = f"{worst.code} in the place that was examined last: {worst.message}"
    raise _unfit(template, arm, why)


def _tested(template: Template, arm: Arm, project: Project, texts: Mapping[str, str], planned_s: float) -> Fitted:
    """Return files whose test states what a run of this arm does; ``Fault`` RBL843 where it does not do its job."""
    expected = Outcome()
    # the built-in arms are known to do all jobs; the drives of a file may be estimates
    if not arm.is_builtin:
        expected = tried(project, texts[TEST])
        if not expected.done:
            raise _unfit(template, arm, expected.why)
    stated = {**texts, TEST: expected.stated(texts[TEST], planned_s)}
    # as the model: what is in the folder of the project is there already
    meshes = mesh_files(project.cell.robot.meshes) if arm.files else {}
    return Fitted(texts=stated, physics=expected.physics, notes=expected.notes, meshes=meshes)


def _unfit(template: Template, arm: Arm, why: str) -> Fault:
    return Fault("RBL843", f"the template '{template.name}' does not fit {arm.name}: {why}")


def _project(texts: Mapping[str, str], folder: Path) -> Project:
    """Return the project of the files of a template, as if they stood in a folder."""
    # in the folder of the robot file, since a cell opens nothing outside of its own
    program = folder / f"job{PROGRAM}"
    beside = {program.with_suffix(ending): texts[ending] for ending in (CELL, POINTS)}
    return load_project(Typed(analysis=Analysis(source=Source(str(program), texts[PROGRAM])), texts=beside))


def _job(project: Project) -> Job:
    """Return the poses of a template: over its table, of its points, its parts and where these are put down."""
    cell = project.cell
    (table,) = (each for each in cell.obstacles if each.name == TABLE)
    top = table.X_world_obstacle[:3, 3] + (0.0, 0.0, 0.5 * table.size[2])
    taught = {name: _taught(point, cell.frames) for name, point in project.points.points.items()}
    home = taught.pop("HOME")
    p = np.array(
        [home[:3, 3], *(X[:3, 3] for X in taught.values()), *(each.X_world_part[:3, 3] for each in cell.parts)]
    )
    raised = np.concatenate([p, p[1:] + (0.0, 0.0, LIFT)]) - top
    x, y, z = (float(value / MM) for value in top)
    tool = cell.tools[project.points.points["HOME"].tool]
    poses = np.stack([pose(each, home[:3, :3]) for each in raised])
    return Job(X_table_tool=poses, from_mm=(x, y, z), depth_mm=float(table.size[0] / MM), X_flange_tool=tool)


def _taught(point: Point, frames: Mapping[str, Array]) -> Array:
    """Return the pose (4, 4) of a point in the world."""
    assert point.pose is not None, "the points of templates are poses"
    *p, rx, ry, rz = point.pose
    X_frame_tool = pose_from_xyzrpy([*(MM * each for each in p), rx * DEG, ry * DEG, rz * DEG])
    return np.asarray(matmul(frames[point.frame], X_frame_tool))


def _checked(project: Project) -> tuple[Diagnostic | FileFault | None, float]:
    """Return the first that ``check`` and ``check --motion`` report of a project, None without any, and its time, s."""
    # the text first: where it has errors nothing can be planned
    doubts: tuple[Diagnostic | FileFault, ...] = (*text_findings(project.analysis), *project.cell.doubts)
    if doubts:
        return doubts[0], 0.0
    explored = explore(project)
    motion = motion_findings(project, explored.rehearsal, detours=explored.detours)
    return next(iter(motion), None), explored.rehearsal.total_us / 1e6
