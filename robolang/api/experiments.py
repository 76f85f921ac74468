"""The experiments of the bench for Python: step responses, comparison of servos, identification, weighing."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Unpack

import numpy as np

from robolang.api.arguments import PayloadLike, joints_of, payload_of, robot_of
from robolang.core import tables
from robolang.core.calls import checked, refuse
from robolang.core.source import read_program
from robolang.execution.dry_run import motion_check
from robolang.execution.session import ProgramError
from robolang.experiments.compare import VARIANTS, Request, Variant
from robolang.experiments.compare import compare as compare_all
from robolang.experiments.excitation import Request as Identification
from robolang.experiments.identify import AxisResult
from robolang.experiments.identify import identify as identify_all
from robolang.experiments.step import PlantName, StepRequest, StepResult
from robolang.experiments.step import step as step_once
from robolang.experiments.weigh import WeighRequest, WeighResult
from robolang.experiments.weigh import weigh as weigh_once
from robolang.project.arguments import Files, PathLike, Settings, numbers, options_of
from robolang.project.project import load_cell_and_settings, load_settings
from runtime.core.frames import pose
from runtime.core.units import DEG, MM
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import ServoMode


@checked
def step(
    robot: str | Path | RobotSpec,
    axis: int | str,
    *,
    size_deg: float = 0.5,
    size_mm: float = 0.5,
    joints: Sequence[float] | None = None,
    payload: PayloadLike | None = None,
    load: PayloadLike | None = None,
    tool: Sequence[float] = (0.0, 0.0, 0.0),
    seconds: float = 1.5,
    plant: PlantName = "rigid",
    ideal_drives: bool = False,
    lock_others: bool = False,
    profile: PathLike | None = None,
    settings: Settings | None = None,
    servo: ServoMode | None = None,
) -> StepResult:
    """Measure the step response of an axis, 2 or ``"J2"``, at a posture in deg; angles of the result are in rad.

    ``size_mm`` is the step of an axis that slides, with mm in the posture, and m, N and kg in the result.
    ``payload`` is carried and ``load`` declared: a mass, kg, or mass and centre of gravity x, y, z mm; None: what is
    carried.
    ``tool``: the tool point in the flange, mm. ``Fault`` RBL703 for an argument, RBL516 where the arm touched
    something.
    """
    spec = robot_of(robot)
    index = _axis_of(axis, spec)
    # the tool decides where the rated payload sits, and with it whether gains are stable
    point = np.array(numbers(tool, "tool", ("x mm", "y mm", "z mm"))) * MM
    options = options_of({"settings": settings, "servo": servo})
    in_force = load_settings(spec, pose(point, np.eye(3)), profile, options)
    carried = payload_of(payload, spec, "payload")
    request = StepRequest(
        robot=spec,
        axis=index,
        q=joints_of(joints, spec),
        size=size_mm * MM if spec.axes[index].kind.slides else size_deg * DEG,
        carried=carried,
        declared=carried if load is None else payload_of(load, spec, "load"),
        profile=in_force.profile,
        plant=plant,
        ideal=ideal_drives,
        locked=lock_others,
        seconds=seconds,
        tool=point,
    )
    # an axis and a posture are judged together, where the range of the joint is known
    try:
        return step_once(request)
    except ValueError as error:
        refuse("axis, joints or size", str(error))


def _axis_of(axis: int | str, robot: RobotSpec) -> int:
    """Return the index of an axis, from 0; ``Fault`` RBL703."""
    names = {f"J{number}": number for number in range(1, robot.n + 1)}
    number = names.get(axis.upper()) if isinstance(axis, str) else int(axis)
    if number is None or number not in names.values():
        refuse("axis", f"{axis!r} is not one of 1 to {robot.n} or J1 to J{robot.n}")
    return number - 1


class Comparison(list[dict[str, Any]]):
    """One row for each variant of ``compare``, in their order; the keys are those of ``robolang compare --json``."""

    def to_pandas(self) -> Any:
        """Return a ``pandas.DataFrame`` with a row for each variant; ``ImportError`` without pandas."""
        return tables.to_pandas(self._columns())

    def to_polars(self) -> Any:
        """Return a ``polars.DataFrame`` with a row for each variant; ``ImportError`` without polars."""
        return tables.to_polars(self._columns())

    def _columns(self) -> dict[str, list[Any]]:
        # what is nested is in the rows themselves
        names = [name for name, value in self[0].items() if not isinstance(value, list | dict)] if self else []
        return {name: [row[name] for row in self] for name in names}


@checked
def compare(
    program: PathLike,
    *,
    only: Sequence[str] | None = None,
    physics: bool = True,
    jobs: int = 1,
    **files: Unpack[Files],
) -> Comparison:
    """Run a program with scheduled and fixed gains, right and wrong LOADs, and return a row for each variant.

    ``only``: names of variants, None: all. ``jobs``: how many run at the same time, each in a process of its own; a
    script that uses more than one needs ``if __name__ == "__main__":``. Supervision is off in every row. Raises as
    ``run``.
    """
    variants = _variants(only)
    cell, robot, profile = map(_text, map(files.get, _PATHS))
    request = Request(
        program=str(program), cell=cell, robot=robot, profile=profile, options=options_of(files), physics=physics
    )
    first = request.project(variants[0] if variants else VARIANTS[0])
    # before twelve runs, each of which would end in the same refusal
    if not first.ok:
        raise ProgramError(first, first.diagnostics)
    if refused := motion_check(first):
        raise ProgramError(first, refused, planned=True)
    return Comparison(compare_all(request, variants, jobs))


def _variants(only: Sequence[str] | None) -> tuple[Variant, ...]:
    known = [variant.name for variant in VARIANTS]
    for name in only or ():
        if name not in known:
            refuse("only", f"'{name}' is not one of {', '.join(known)}")
    return tuple(variant for variant in VARIANTS if only is None or variant.name in only)


_PATHS = ("cell", "robot", "profile")


def _text(path: object) -> str | None:
    return None if path is None else str(path)


@checked
def identify(
    robot: str | Path | RobotSpec,
    *,
    axes: Sequence[int] | None = None,
    positions: int = 5,
    payload: PayloadLike | None = None,
    plant: PlantName = "mujoco",
    table: int = 0,
) -> list[AxisResult]:
    """Move each axis and identify its inertia at the motor and its weight; ``axes`` from 1, None: all.

    ``payload`` as of ``step``, carried and declared. ``table``: angles of J2 and of J3 of a table; 0: none.
    """
    spec = robot_of(robot)
    chosen = range(1, spec.n + 1) if axes is None else axes
    wrong = next((axis for axis in chosen if not 1 <= axis <= spec.n), None)
    if wrong is not None:
        refuse("axes", f"{wrong} is not one of 1 to {spec.n}")
    request = Identification(
        robot=spec,
        axes=tuple(sorted({axis - 1 for axis in chosen})),
        positions=positions,
        plant=plant,
        payload=payload_of(payload, spec, "payload", heavier=False),
        table=table,
    )
    return identify_all(request)


@checked
def weigh(
    program: PathLike | None = None,
    *,
    payload: PayloadLike | None = None,
    amplitude_deg: float | None = None,
    plant: PlantName = "mujoco",
    **files: Unpack[Files],
) -> WeighResult:
    """Move the arm in the cell of a program and weigh what it carries; without a program in the built-in cell.

    ``payload``: a body beside the hand, as of ``step``. ``Fault`` where the motion is refused or an alarm ends it.
    """
    if program is not None:
        read_program(program)  # for its cell: the text alone shows that it is a program
    spec, in_force = load_cell_and_settings(
        None if program is None else Path(program),
        files.get("cell"),
        _text(files.get("robot")),
        files.get("profile"),
        options_of(files),
    )
    request = WeighRequest(
        cell=spec,
        added=None if payload is None else payload_of(payload, spec.robot, "payload"),
        profile=in_force.profile,
        plant=plant,
        amplitude=None if amplitude_deg is None else amplitude_deg * DEG,
    )
    return weigh_once(request)
