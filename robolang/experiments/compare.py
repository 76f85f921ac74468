"""``compare``: one program, carried out again and again with something about the controller changed each time.

The program text is never touched: LOAD is left out or made wrong where its effect is carried out, so every statement
keeps its line. Each run is a run like any other, in its own process when there are several, and the result does not
depend on how many there are. The measures compare the true links with the command that the servo received at the
same tick:

- overshoot: how far an axis goes past the farthest place of its command, in percent of its last approach, from where
  its command last turned round; axes that approach over less than ``LEAST`` are left out;
- settling: time after the command has ended until every axis stays within 2 % of its last approach;
- joint and tool error, largest and root of the mean square; deviation from the straight line;
- droop: joint error that is left when a MOVE is done. There is no integrator that would take it away.
"""

import hashlib
import multiprocessing
from collections.abc import Callable, Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robolang.execution.lowering import payload
from robolang.execution.result import StatementRun
from robolang.execution.session import Session
from robolang.interpreter.effects import Effect, SetPayload
from robolang.project.project import Project, load_project
from runtime.cell.cell import CellSpec
from runtime.core.frames import Array
from runtime.core.linear import norm
from runtime.core.units import DEG, MM, badness
from runtime.robot.model.payload import NO_PAYLOAD, Payload
from runtime.robot.model.spec import RobotSpec

BAND = 0.02
LEAST = 1.0 * DEG
"""Shortest approach whose overshoot is given in percent, rad; as many mm of an axis that slides as this has deg."""
WRONG_SHARE = 0.3
"""By how much of the rated payload the wrong LOAD is wrong."""
STARVED_COST_MS = 50.0
"""Declared cost of one axis of a starved dynamics task, ms."""

_OF_ALARM = ("code", "message", "file", "line", "column", "number", "time_s")

_OF_SLIDES = ("joint_error_mm", "joint_rms_mm", "droop_mm")
FIGURES = (
    "overshoot_pct",
    "settling_s",
    "joint_error_deg",
    "joint_rms_deg",
    *_OF_SLIDES[:2],
    "tool_error_mm",
    "tool_rms_mm",
    "path_deviation_mm",
    "droop_deg",
    _OF_SLIDES[2],
    "per_axis",
    "moves",
)
"""What is measured of a variant, ``_OF_SLIDES`` on an arm with an axis that slides."""

Options = dict[str, tuple[str, Any]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Variant:
    """One variant of the run: its settings over those in force, and what becomes of LOAD."""

    name: str
    title: str
    settings: dict[str, Any] = field(default_factory=dict)
    load: str = "as written"


VARIANTS = (
    Variant(name="scheduled", title="scheduled gains", settings={"servo.mode": "scheduled"}),
    *(
        Variant(
            name=f"fixed-{at}",
            title=f"gains fixed at {at}",
            # fixed gains refuse the coupling "full", which the profile in force may have
            settings={"servo.mode": "fixed", "servo.fixed_at": at, "servo.coupling": "diagonal"},
        )
        for at in ("min", "mid", "max")
    ),
    Variant(
        name="diagonal", title="scheduled, diagonal", settings={"servo.mode": "scheduled", "servo.coupling": "diagonal"}
    ),
    Variant(name="load-omitted", title="LOAD omitted", settings={"servo.mode": "scheduled"}, load="omitted"),
    Variant(name="load-wrong", title="LOAD wrong by 30 %", settings={"servo.mode": "scheduled"}, load="wrong"),
    Variant(
        name="fixed-mid-load-omitted",
        title="fixed at mid, LOAD omitted",
        load="omitted",
        settings={"servo.mode": "fixed", "servo.fixed_at": "mid", "servo.coupling": "diagonal"},
    ),
    Variant(
        name="no-lead",
        title="no spring lead",
        settings={"servo.mode": "scheduled", "servo.spring_compensation": 0.0, "servo.gravity_lead": 0.0},
    ),
    Variant(
        name="conventional",
        title="conventional",
        load="omitted",
        settings={
            "servo.mode": "fixed",
            "servo.fixed_at": "mid",
            "servo.coupling": "diagonal",
            "servo.spring_compensation": 0.0,
            "servo.gravity_lead": 0.0,
        },
    ),
    Variant(
        name="starved",
        title="dynamics starved",
        settings={"servo.mode": "scheduled", "dynamics_cost_per_axis_ms": STARVED_COST_MS},
    ),
    Variant(
        name="no-gravity",
        title="no gravity compensation",
        settings={"servo.mode": "scheduled", "servo.gravity_compensation": 0.0},
    ),
)

BASE = VARIANTS[0]
"""What the others are compared with."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """What all variants share: the files, as given, the options in force and whether MuJoCo is the robot."""

    program: str
    cell: str | None = None
    robot: str | None = None
    profile: str | None = None
    options: Options = field(default_factory=dict)
    physics: bool = True

    def project(self, variant: Variant) -> Project:
        """Read the project with the settings of a variant over all others."""
        # the name stands where that of an option would, for the place of a fault
        changed = {key: (f"variant {variant.name}", value) for key, value in variant.settings.items()}
        project = load_project(
            self.program, self.cell, self.robot, profile=self.profile, options={**self.options, **changed}
        )
        # most variants are wrong on purpose: what supervision would stop is what is to be seen; the command says so
        watched = project.profile.supervision
        return project.with_profile(replace(project.profile, supervision=replace(watched, enabled=False)))


def compare(
    request: Request,
    variants: tuple[Variant, ...] = VARIANTS,
    jobs: int = 1,
    done: Callable[[str], None] = lambda name: None,
) -> list[dict[str, Any]]:
    """Return one row for each variant, in their order; ``done`` is called with the title of each that is finished."""
    if jobs <= 1 or len(variants) == 1:
        rows = []
        for variant in variants:
            rows.append(run_variant(request, variant))
            done(variant.title)
        return _without_equals(rows)
    # spawn: a forked child would share the locks of whatever threads the libraries have started
    with ProcessPoolExecutor(min(jobs, len(variants)), mp_context=multiprocessing.get_context("spawn")) as pool:
        futures = [pool.submit(run_variant, request, variant) for variant in variants]
        for variant, future in zip(variants, futures, strict=True):
            # in the order of the variants and not as they end: the progress shown is the same in every run
            future.result()
            done(variant.title)
        return _without_equals([future.result() for future in futures])


def run_variant(request: Request, variant: Variant) -> dict[str, Any]:
    """Run one variant and measure it; ``motion`` is a digest of how the arm moved, ``idle`` what changed nothing."""
    project = request.project(variant)
    loads = _Loads(variant.load, project.cell)
    session = Session(project, physics=request.physics, alter=loads.alter)
    result = session.run()
    alarms: Any = result.report["alarms"]
    return {
        "variant": variant.name,
        "title": variant.title,
        "ok": result.ok,
        "alarms": [{key: alarm[key] for key in _OF_ALARM} for alarm in alarms],
        "sim_time_s": result.report["sim_time_s"],
        "motion": _digest(result.log),
        "idle": _idle(variant, project.profile == request.project(BASE).profile, loads),
        **measures(
            result.log,
            session.controller.tool_poses(result.log["q_cmd"]),
            session.record.statements,
            project.cell.robot,
        ),
    }


def _idle(variant: Variant, same_settings: bool, loads: "_Loads") -> list[str]:
    """Return in words which changes of a variant make no difference to ``BASE``."""
    found = []
    if same_settings and variant.settings != BASE.settings:
        found.append("these settings are in force already")
    if variant.load != "as written" and not loads.changed:
        found.append("no LOAD of the program becomes another one" if loads.seen else "the program has no LOAD")
    return found


def _without_equals(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the rows with a ``note`` in each; one whose variant changes nothing has no figures beside it.

    A variant changes nothing when its settings and every LOAD are those of ``BASE``, or when the arm moves as in the
    row of ``BASE`` to the last bit.
    """
    motions = {row["variant"]: row["motion"] for row in rows}
    by_name = {variant.name: variant for variant in VARIANTS}
    found = []
    for row in rows:
        motion, idle = row.pop("motion"), row.pop("idle")
        # a variant that is not in VARIANTS keeps its figures, as BASE does
        variant = by_name.get(row["variant"], BASE)
        parts = (variant.settings != BASE.settings) + (variant.load != "as written")
        reason = "; ".join(idle)
        # settings that differ may still change nothing for this program: the motion decides
        if variant != BASE and len(idle) < parts and motion == motions.get(BASE.name):
            idle, reason = [""] * parts, f"the arm moves exactly as with {BASE.title}"
        nothing = variant != BASE and len(idle) == parts
        note = f"changes nothing: {reason}" if nothing else reason
        none = dict.fromkeys(row.keys() & set(FIGURES)) if nothing else {}
        found.append({**row, **none, "changes": not nothing, "note": note})
    return found


def _digest(log: Mapping[str, Array]) -> str:
    digest = hashlib.sha256()
    for name in ("q_cmd", "q_link", "X_world_tool"):
        digest.update(np.ascontiguousarray(log[name]).tobytes())
    return digest.hexdigest()


class _Loads:
    """What becomes of the LOADs of a run, and whether any payload was another one than the program declares."""

    def __init__(self, load: str, cell: CellSpec) -> None:
        self._load, self._cell = load, cell
        self._declared = self._carried = NO_PAYLOAD
        self.seen = self.changed = False

    def alter(self, effect: Effect) -> Effect | None:
        """Return the LOAD to carry out in place of another, None for none; other effects stay."""
        if not isinstance(effect, SetPayload):
            return effect
        self.seen = True
        self._declared = payload(effect, self._cell)
        altered = self._altered(effect)
        if altered is not None:
            self._carried = payload(altered, self._cell)
        self.changed = self.changed or not _same(self._declared, self._carried)
        return altered

    def _altered(self, effect: SetPayload) -> SetPayload | None:
        if self._load == "omitted":
            return None
        if self._load != "wrong":
            return effect
        declared, rated = self._declared, self._cell.robot.rated_payload
        x, y, z = (declared.cog / MM).tolist()
        # by its values, since a load of the cell that is named could not be changed
        return replace(effect, name="", cog_mm=(x, y, z), mass_kg=wrong_mass(declared.mass, rated))


def _same(one: Payload, other: Payload) -> bool:
    return one.mass == other.mass and np.array_equal(one.cog, other.cog) and np.array_equal(one.inertia, other.inertia)


def wrong_mass(mass: float, rated: float) -> float:
    """Return a mass that is wrong by 30 % of the rated one: too much, or too little where that is over the rated."""
    step = WRONG_SHARE * rated
    return mass + step if mass + step <= rated else max(0.0, mass - step)


# --- measures --------------------------------------------------------------------------------------------------------


def measures(
    log: Mapping[str, Array], X_cmd: Array, statements: list[StatementRun], robot: RobotSpec
) -> dict[str, Any]:
    """Return the figures of a run, in deg, mm, s and %, over all its MOVEs; None where there is none.

    ``per_axis`` and ``moves`` of an arm with an axis that slides have the unit of each axis, ``units``, and no deg in
    their keys.
    """
    slides = robot.slides
    keys = [key for key in FIGURES if key not in (() if slides.any() else _OF_SLIDES)]
    moves = _moves(statements)
    if not moves:
        return dict.fromkeys(keys)
    ticks = np.concatenate([np.arange(run.first_tick, run.end_tick) for run in moves])
    joint = np.abs(log["q_cmd"][ticks] - log["q_link"][ticks]) / robot.units
    p_tool = log["X_world_tool"][:, :3, 3]
    # a sensor takes the tool off the programmed line on purpose; that is no deviation
    p_line = p_tool - log["seam_deviation"][:, :3]
    tool = np.linalg.norm(X_cmd[ticks, :3, 3] - p_tool[ticks], axis=1) / MM
    droop_key = "droop" if slides.any() else "droop_deg"
    rows = [_move(run, log, p_line, robot, droop_key) for run in moves]
    per_axis = {
        "joint_error": joint.max(axis=0),
        "joint_rms": np.sqrt((joint**2).mean(axis=0)),
        "droop": np.abs(np.array([row[droop_key] for row in rows])).max(axis=0),
    }
    found = {
        "overshoot_pct": _worst_overshoot(rows),
        "settling_s": _longest_settling(rows),
        **_by_unit(per_axis, slides),
        "tool_error_mm": float(tool.max()),
        "tool_rms_mm": float(np.sqrt((tool**2).mean())),
        "path_deviation_mm": max((row["path_deviation_mm"] for row in rows), key=badness),
        "per_axis": _axes(per_axis, robot),
        "moves": rows,
    }
    return {key: found[key] for key in keys}


def _moves(statements: list[StatementRun]) -> list[StatementRun]:
    """Return the statements that moved the arm along a path."""
    return [run for run in statements if run.begun and run.path is not None and run.end_tick > run.first_tick]


def _by_unit(per_axis: dict[str, Array], slides: NDArray[np.bool_]) -> dict[str, float | None]:
    """Return the largest values of the axes that turn, and of those that slide, by key; None where there are none."""
    found: dict[str, float | None] = {}
    for name, of in per_axis.items():
        found[f"{name}_deg"] = None if slides.all() else float(of[~slides].max())
        found[f"{name}_mm"] = float(of[slides].max()) if slides.any() else None
    return found


def _axes(per_axis: dict[str, Array], robot: RobotSpec) -> dict[str, Any]:
    if not robot.slides.any():
        return {f"{name}_deg": of.tolist() for name, of in per_axis.items()}
    return {"units": [axis.kind.unit for axis in robot.axes], **{name: of.tolist() for name, of in per_axis.items()}}


def _worst_overshoot(moves: list[dict[str, Any]]) -> float | None:
    """Return the largest overshoot of moves, %; None when no move has one."""
    overshoots = [move["overshoot_pct"] for move in moves if move["overshoot_pct"] is not None]
    return max(overshoots, key=badness, default=None)


def _longest_settling(moves: list[dict[str, Any]]) -> float | None:
    """Return the longest settling time of moves, s; None when one of them does not settle."""
    settled = [move["settling_s"] for move in moves]
    return None if None in settled else max(settled)  # a largest time beside a move that never settles would mislead


def _move(
    run: StatementRun, log: Mapping[str, Array], p_tool: Array, robot: RobotSpec, droop_key: str
) -> dict[str, Any]:
    span = slice(run.first_tick, run.end_tick)
    assert run.path is not None  # only moves get here
    q_cmd, q_link, t = log["q_cmd"][span], log["q_link"][span], log["t"][span]
    scale = robot.bound(1.0)
    overshoot, settling = last_approach(q_cmd / scale, q_link / scale, t)
    return {
        "line": run.origin.line,
        "number": run.origin.number,
        "overshoot_pct": overshoot,
        "settling_s": settling,
        "path_deviation_mm": float(run.path.deviation(p_tool[span]).max()) / MM,
        droop_key: ((q_cmd[-1] - q_link[-1]) / robot.units).tolist(),
        "left_mm": norm(run.path.X_end[:3, 3] - p_tool[span][-1]) / MM,
    }


def last_approach(q_cmd: Array, q_link: Array, t: Array) -> tuple[float | None, float | None]:
    """Return overshoot of the worst axis, %, and the time from the end of the command to within 2 %, s.

    q_cmd, q_link (N, n) rad (a mm counts as a deg), t (N,) s of one move. Overshoot is None when no axis approaches far
    enough, settling None when an axis is still outside at the end of the statement.
    """
    end = q_cmd[-1]
    # not one row is at the end where it is NaN; where all are, argmin gives 0 and the modulus row 0
    standing = (np.abs(q_cmd - end) <= 1e-12).all(axis=1)
    stop = len(q_cmd) - 1 if not standing.any() else int(len(standing) - np.argmin(standing[::-1])) % len(standing)
    worst, settled = None, 0.0
    for axis in range(q_cmd.shape[1]):
        begin = _turn(q_cmd[:, axis])
        stroke = end[axis] - q_cmd[begin, axis]
        if not abs(stroke) >= LEAST:
            continue
        ahead = np.copysign(1.0, stroke)
        # a wrist change or a blend may itself pass the end by less than ``LEAST``: that is no overshoot of the servo
        farthest = float((ahead * q_cmd[begin:, axis]).max())
        past = (float((ahead * q_link[begin:, axis]).max()) - farthest) / abs(stroke) * 100.0
        worst = max(worst or 0.0, past, key=badness)
        outside = np.flatnonzero(~(np.abs(q_link[stop:, axis] - end[axis]) <= BAND * abs(stroke)))
        if len(outside):
            if outside[-1] == len(q_link) - stop - 1:  # still outside at the last tick
                return worst, None
            settled = max(settled, float(t[stop + outside[-1] + 1] - t[stop]))
    return worst, settled


def _turn(q: Array) -> int:
    """Return the row from which a command (N,) goes to its end without turning round by more than ``LEAST``."""
    to_go = q - q[-1]
    far = np.flatnonzero(np.abs(to_go) >= LEAST)
    if not len(far):
        return len(q) - 1
    back = np.flatnonzero(np.diff(q[: far[-1] + 1]) * to_go[far[-1]] > 0.0)  # moving away from the end
    return int(back[-1]) + 1 if len(back) else 0
