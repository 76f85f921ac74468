"""What a rehearsal shows beyond refusals: every finding at its statement, with path fraction, joint, value and limit.

    RBL422   a joint near the end of its range
    RBL423   a program that takes longer than it may
    RBL424   the arm in itself
    RBL425, RBL426   moment or inertia of the payload about a wrist axis over what that may carry
    RBL427   a path that comes near a singular posture

and what ``plan_findings`` finds, where the motion is not the one that the program states.

Checks the executed set-points, blends included, 8 ms apart. Obstacles and parts that they touch are in
``part_findings``. Of one code there is one finding for a statement, the worst or the first in time.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from robolang.core.bounds import ELBOW, RANGE_MARGIN, SHOULDER, WRIST, Bounds
from robolang.core.diagnostics import Diagnostic, Severity
from robolang.core.source import Span
from robolang.execution.dry_run import Rehearsal, RehearsedMove
from robolang.execution.plan_findings import PlanFindings
from robolang.execution.planned_move import PlannedMove
from robolang.planning.line_times import range_margin
from robolang.planning.part_findings import CellTouches
from robolang.planning.path_coverage import Detour
from robolang.planning.placed import Placed, Places
from robolang.project.project import Project
from runtime.core.faults import Group, lookup
from runtime.core.rounding import beside
from runtime.core.units import DEG, MM
from runtime.motion.cartesian_planner import FOLLOWS
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.robot.kinematics.singularity import singularities
from runtime.robot.kinematics.wrist_load import ratings, wrist_load
from runtime.robot.model.axis_kind import AxisKind

DEFAULTS = Bounds()
OVERLOAD, NOTHING = 1e-3, 1e-6
"""A payload that is over its limit by less than this share and so many N m or kg m2 is within it."""

Found = Iterator[Placed]


def findings(
    project: Project,
    rehearsal: Rehearsal,
    max_cycle_s: float | None = None,
    detours: Sequence[Detour] = (),
    bounds: Bounds = DEFAULTS,
) -> tuple[Diagnostic, ...]:
    """Return what is wrong with the motion of a program, one finding of a code for a statement.

    ``detours`` add what the rehearsal has not shown, errors of planning and findings on moves, with the branches that
    lead there. Other faults that end a detour, such as a WAIT that times out, are the answer of its program.
    """
    moves = _Moves(project, rehearsal.kinematics, bounds)
    found: dict[tuple[str, Span], Placed] = {}
    for item in (*moves.refused(rehearsal), *moves.findings(rehearsal)):
        found.setdefault((item.code, item.span), item)
    for detour in detours:
        ended = moves.refused(detour.rehearsal)
        refused = (item for item in ended if lookup(item.code).group in (Group.POINTS, Group.MOTION))
        for item in (*refused, *moves.findings(detour.rehearsal)):
            if item.code == "RBL441":  # on another branch parts may lie elsewhere as well
                continue
            branched = item.replaced(message=f"{item.message} ({_branches(project, detour)})", time_us=None)
            found.setdefault((item.code, item.span), branched)
    return (*found.values(), *_cycle(rehearsal, max_cycle_s))


def _branches(project: Project, detour: Detour) -> str:
    """Return the branches that lead to a detour in words."""
    source = project.source
    return " and ".join(
        f"if '{source.slice(place)}' in line {source.place(place.start).line} is {'true' if holds else 'not true'}"
        for place, holds in detour.forced.items()
    )


def _cycle(rehearsal: Rehearsal, most_s: float | None) -> Iterator[Diagnostic]:
    total = rehearsal.total_us / 1e6
    if most_s is not None and not total <= most_s and not rehearsal.refused:
        takes, most = beside(total, most_s, form=".3f")
        message = f"the program takes {takes} s, {total - most_s:.3g} s more than {most} s"
        yield Diagnostic(code="RBL423", message=message, span=Span(0, 0))


class _Moves:
    """Checks of the moves of rehearsals; a move that was checked before is not checked again."""

    def __init__(self, project: Project, kinematics: Kinematics, bounds: Bounds) -> None:
        self._bounds = bounds
        self._spec, self._period_s = project.cell.robot, project.profile.period_s
        self._kinematics = kinematics
        self._cell = CellTouches(project, kinematics)
        self._plans = PlanFindings(project, kinematics)
        self._project = project
        self._places = Places(kinematics, project.profile.period_us)
        self._seen: set[tuple[object, ...]] = set()
        self._told: set[tuple[str, Span]] = set()

    def refused(self, rehearsal: Rehearsal) -> Found:
        """Yield what ended a rehearsal, where the arm then was."""
        cell, last = self._project.cell, rehearsal.moves[-1:]
        q, X_flange_tool = (last[0].q[-1], last[0].X_flange_tool) if last else (cell.home, cell.hand.X_flange_tool)
        for item in rehearsal.refused:
            p = self._places.tool_point(q, X_flange_tool)
            # not replaced(): a diagnostic of another class
            yield Placed(**{name: getattr(item, name) for name in item.FIELDS}, p=p, time_us=rehearsal.total_us)

    def findings(self, rehearsal: Rehearsal) -> Found:
        """Yield what the moves of a rehearsal show, those of one check after those of another."""
        # all moves, new or not: where the parts lie depends on every move and HAND before
        yield from self._cell.follow(rehearsal)
        new = [move for move in rehearsal.moves if self._is_new(move)]
        for check in (self.folds, self.near_range, self.near_singular):
            first: dict[Span, Placed] = {}
            for move in new:
                if move.effect.span not in first:
                    first.update((item.span, item) for item in check(move))
            yield from first.values()
        fresh = {id(move) for move in new}
        for move, after in zip(rehearsal.moves, (*rehearsal.moves[1:], None), strict=False):
            if id(move) in fresh:
                yield from self.otherwise(move, after)
        yield from _loads(self._project, self._kinematics, self._places, new)

    def _is_new(self, move: RehearsedMove) -> bool:
        # rounds of a loop and detours share most moves; the payload is part of the key, since LOAD changes the findings
        load = move.payload
        key = (move.effect.span, move.q.tobytes(), load.mass, load.cog.tobytes(), load.inertia.tobytes())
        known = key in self._seen
        self._seen.add(key)
        return not known

    def folds(self, move: RehearsedMove) -> Found:
        """Report the first of its links that the arm would be in."""
        for row, q in enumerate(move.q):
            if (pair := self._cell.shapes.folded(q)) is not None:
                message = f"at {move.share(row):.1f} % of the path {pair[0]} would be in {pair[1]}"
                yield self._places.at("RBL424", move, message, row=row, severity=Severity.ERROR)
                return

    def otherwise(self, move: RehearsedMove, after: RehearsedMove | None) -> Found:
        """Report where the motion is not the one that the program states."""
        planned = PlannedMove(
            effect=move.effect,
            command=move.command,
            plan=move.plan,
            s=move.s,
            speeds=move.speeds,
            number=move.number,
            corner=move.corner,
            after=None if move.corner is None or after is None else after.plan,
        )
        for found in self._plans.of(planned):
            # one of a code for a statement, of all rehearsals: what helps may be found by planning
            if (found.code, move.effect.span) not in self._told:
                self._told.add((found.code, move.effect.span))
                yield self._places.at(found.code, move, found.message).replaced(hint=found.hint)

    def near_range(self, move: RehearsedMove) -> Found:
        """Report the joint that comes nearest to the end of its range."""
        spec = self._spec
        margin, axis, row = range_margin(move, spec)
        kind = spec.axes[axis].kind
        if not margin >= self._bounds[RANGE_MARGIN] * kind.size:
            ends = f"{spec.lower[axis] / kind.size:g} to {kind.text(spec.upper[axis])}"
            at = kind.text(float(move.q[row, axis]), ".2f")
            yield self._places.at(
                "RBL422",
                move,
                f"at {move.share(row):.1f} % of the path J{axis + 1} is at {at}, "
                f"{kind.text(margin, '.2f')} from an end of its range {ends}",
                row=row,
            )

    def near_singular(self, move: RehearsedMove) -> Found:
        """Report a path that comes near a singular posture, where the wrist is not on a joint curve of its own."""
        if move.plan.path is None or self._kinematics.opw is None:
            return
        # rows of the plan, not those with blends: ``modes`` belongs to them
        follows = move.plan.modes == FOLLOWS
        near = singularities(self._kinematics.opw, move.plan.q)
        for name, values, bound, size in (
            ("wrist is straight", near.wrist, WRIST, DEG),
            ("elbow is stretched or folded", near.elbow, ELBOW, DEG),
            ("wrist centre is over axis 1", near.shoulder, SHOULDER, MM),
        ):
            row = int(np.argmin(np.where(follows, values, np.inf)))
            least = self._bounds[bound]
            if not values[row] >= least * size:
                away, keep = beside(float(values[row]) / size, least, form=".2f")
                yield self._places.at(
                    "RBL427",
                    move,
                    f"at {100.0 * float(move.plan.s[row]):.1f} % of the path the arm is {away} "
                    f"{bound.unit} from where its {name}, which is singular; keep {keep} {bound.unit} away",
                    row=int(np.searchsorted(move.s, move.plan.s[row])),
                )
                return


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadShare:
    """The ``moment`` or ``inertia`` of a payload about an axis of the wrist (0-based) in its worst posture; along one
    that slides its weight and its mass.

    ``given``: the limit is in the robot file, else it is an estimate. ``move`` and ``row`` are where the posture is.
    """

    axis: int
    what: str
    value: float
    limit: float
    given: bool
    move: RehearsedMove
    row: int
    kind: AxisKind

    @property
    def unit(self) -> str:
        """Unit of value and limit."""
        return self.kind.force if self.what == "moment" else self.kind.inertia

    @property
    def beside(self) -> str:
        """Where the load is: about an axis, or along one that slides."""
        return "along" if self.kind.slides else "about"

    @property
    def name(self) -> str:
        """What is loaded, in words."""
        if self.kind.slides:
            return "weight" if self.what == "moment" else "mass"
        return self.what


def worst_loads(project: Project, kinematics: Kinematics, moves: Sequence[RehearsedMove]) -> list[LoadShare]:
    """Return moments, then inertias of the last axes, each at the move with the worst posture."""
    spec = project.cell.robot
    limits = dict(zip(("moment", "inertia"), ratings(spec), strict=True))
    worst: dict[tuple[str, int], LoadShare] = {}
    for move in moves:
        load = wrist_load(kinematics, move.q, move.payload)
        for what, values in (("moment", load.moment), ("inertia", load.inertia)):
            for k, row in enumerate(np.argmax(values, axis=0).tolist()):
                value, axis = float(values[row, k]), load.first + k
                # an empty hand loads nothing, and ``_loads`` divides by the value
                if not value <= 0.0 and ((what, k) not in worst or not value <= worst[what, k].value):
                    given = getattr(spec.axes[axis].limits, f"rated_{what}") is not None
                    worst[what, k] = LoadShare(
                        axis=axis,
                        what=what,
                        value=value,
                        limit=float(limits[what][k]),
                        given=given,
                        move=move,
                        row=row,
                        kind=spec.axes[axis].kind,
                    )
    return sorted(worst.values(), key=lambda share: (share.what != "moment", share.axis))


def _loads(project: Project, kinematics: Kinematics, places: Places, moves: Sequence[RehearsedMove]) -> Found:
    """Report each axis of the wrist that a payload overloads, at the move with the worst posture."""
    shares = worst_loads(project, kinematics, moves)
    for share in sorted(shares, key=lambda share: (not share.given, share.limit / share.value)):  # worst first
        if not share.value <= share.limit * (1.0 + OVERLOAD) + NOTHING:
            value, limit = beside(share.value, share.limit, form=".3g")
            code = "RBL425" if share.what == "moment" else "RBL426"
            yield places.at(
                code,
                share.move,
                f"at {share.move.share(share.row):.1f} % of the path the {share.name} of the "
                f"payload of {share.move.payload.mass:g} kg {share.beside} J{share.axis + 1} is {value} "
                f"{share.unit}, {share.value - share.limit:.3g} {share.unit} above the limit of {limit} {share.unit}, "
                f"which is {'its rating' if share.given else 'estimated from its drive'}",
                row=share.row,
                severity=Severity.ERROR if share.given else Severity.WARNING,
            )
