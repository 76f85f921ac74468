"""What a rehearsal shows beyond refusals: every finding at its statement, with path fraction, joint, value and limit.

    RBL419   a move that ends in other joint angles than taught
    RBL414   a zone that takes more than half of a move at its corner: the blend is smaller than asked for
    RBL422   a joint near the end of its range
    RBL423   a program that takes longer than it may
    RBL424   the arm in itself
    RBL425, RBL426   moment or inertia of the payload about a wrist axis over what that may carry
    RBL427   a path that comes near a singular posture
    RBL428   a path on which the tool leaves its posture to change the wrist, where the program does not say so
    RBL429   a move that takes far longer than the program asked for, and what rules it

Checks the executed set-points, blends included, 8 ms apart. Obstacles and parts that they touch are in
``part_findings``. Of one code there is one finding for a statement, the worst or the first in time.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from robolang.diagnostics import Diagnostic, Severity
from robolang.exploration import Detour
from robolang.line_times import range_margin
from robolang.motion_check import Rehearsal, RehearsedMove
from robolang.part_findings import CellTouches
from robolang.project import Project
from robolang.source import Span
from runtime.motion.planner import FOLLOWS
from runtime.robot.kinematics import Kinematics
from runtime.robot.load import ratings, wrist_load
from runtime.robot.singularity import singularities
from runtime.units import DEG, MM, PERCENT

NEAR = 0.5 * DEG
"""A joint nearer than this to the end of its range is named, rad."""
NEAR_SINGULAR = 2.0 * DEG
"""A wrist or elbow nearer than this to a singular posture is named, rad."""
NEAR_SHOULDER = 20.0 * MM
"""The same for the wrist centre over axis 1, m."""
NOTICED = 0.1 * DEG
"""A tool that turns less from its posture keeps it, rad."""
OVERLOAD, NOTHING = 1e-3, 1e-6
"""A payload that is over its limit by less than this share and so many N m or kg m2 is within it."""
SLOWED = 1.5
"""A move that takes this many times as long as its programmed speed or time asks for is named."""

Found = Iterator[Diagnostic]


def findings(project: Project, rehearsal: Rehearsal, max_cycle_s: float | None = None,
             detours: Sequence[Detour] = ()) -> tuple[Diagnostic, ...]:  # fmt: skip
    """Return what is wrong with the motion of a program, one finding of a code for a statement.

    Of ``detours`` it is what the rehearsal has not shown: errors of planning and what the moves show, with the way to
    it. What stops a detour otherwise, such as a WAIT that times out, is what its program wants.
    """
    moves = _Moves(project)
    found: dict[tuple[str, Span], Diagnostic] = {}
    for item in (*rehearsal.refused, *moves.findings(rehearsal)):
        found.setdefault((item.code, item.span), item)
    for detour in detours:
        refused = (item for item in detour.rehearsal.refused if item.code.startswith(("RBL3", "RBL4")))
        for item in (*refused, *moves.findings(detour.rehearsal)):
            if item.code == "RBL441":  # where the program went another way, parts may be elsewhere as well
                continue
            told = replace(item, message=f"{item.message} ({_way(project, detour)})")
            found.setdefault((item.code, item.span), told)
    return (*found.values(), *_cycle(rehearsal, max_cycle_s))


def _way(project: Project, detour: Detour) -> str:
    """Return the way of a detour in words."""
    source = project.source
    said = (f"if '{source.slice(place)}' in line {source.place(place.start).line} is {'true' if way else 'not true'}"
            for place, way in detour.forced.items())  # fmt: skip
    return " and ".join(said)


def _cycle(rehearsal: Rehearsal, most_s: float | None) -> Found:
    total = rehearsal.total_us / 1e6
    if most_s is not None and not total <= most_s and not rehearsal.refused:
        message = f"the program takes {total:.3f} s, {total - most_s:.3f} s more than {most_s:g} s"
        yield Diagnostic(code="RBL423", message=message, span=Span(0, 0))


def _at(code: str, move: RehearsedMove, message: str, severity: Severity = Severity.WARNING) -> Diagnostic:
    return Diagnostic(code=code, severity=severity, message=message, span=move.effect.span)


class _Moves:
    """Checks of the moves of rehearsals; what was looked at before is not looked at again."""

    def __init__(self, project: Project) -> None:
        self._spec, self._period_s = project.cell.robot, project.profile.period_s
        self._kinematics = Kinematics(self._spec)
        self._cell = CellTouches(project)
        self._project = project
        self._seen: set[tuple[object, ...]] = set()

    def findings(self, rehearsal: Rehearsal) -> Found:
        """Yield what the moves of a rehearsal show, those of one check after those of another."""
        yield from self._cell.follow(rehearsal)
        new = [move for move in rehearsal.moves if self._is_new(move)]
        for check in (self.folds, self.near_range, self.near_singular, self.wrist_changes,
                      self.ends_otherwise, self.slowed):
            first: dict[Span, Diagnostic] = {}
            for move in new:
                if move.effect.span not in first:
                    first.update((item.span, item) for item in check(move))
            yield from first.values()
        yield from _zones(rehearsal.moves)
        yield from _loads(self._project, new)

    def _is_new(self, move: RehearsedMove) -> bool:
        load = move.payload
        key = (move.effect.span, move.q.tobytes(), load.mass, load.cog.tobytes(), load.inertia.tobytes())
        known = key in self._seen
        self._seen.add(key)
        return not known

    def folds(self, move: RehearsedMove) -> Found:
        """Report the first of its links that the arm would be in."""
        for row, q in enumerate(move.q):
            if (pair := self._cell.shapes.folded(q)) is not None:
                message = f"at {move.share(row):.1f} % of the way {pair[0]} would be in {pair[1]}"
                yield _at("RBL424", move, message, Severity.ERROR)
                return

    def near_range(self, move: RehearsedMove) -> Found:
        """Report the joint that comes nearest to the end of its range."""
        spec = self._spec
        margin, axis, row = range_margin(move, spec.lower, spec.upper)
        if not margin >= NEAR:
            ends = f"{spec.lower[axis] / DEG:g} to {spec.upper[axis] / DEG:g} deg"
            at = float(move.q[row, axis]) / DEG
            yield _at("RBL422", move, f"at {move.share(row):.1f} % of the way J{axis + 1} is at {at:.2f} deg, "
                      f"{margin / DEG:.2f} deg from an end of its range {ends}")  # fmt: skip

    def near_singular(self, move: RehearsedMove) -> Found:
        """Report a path that comes near a singular posture, where the wrist is not on a way of its own."""
        if move.plan.path is None or self._kinematics.opw is None:
            return
        follows = move.plan.modes == FOLLOWS
        near = singularities(self._kinematics.opw, move.plan.q)
        for name, values, least, unit, size in (
            ("wrist is straight", near.wrist, NEAR_SINGULAR, "deg", DEG),
            ("elbow is stretched or folded", near.elbow, NEAR_SINGULAR, "deg", DEG),
            ("wrist centre is over axis 1", near.shoulder, NEAR_SHOULDER, "mm", MM),
        ):
            row = int(np.argmin(np.where(follows, values, np.inf)))
            if not values[row] >= least:
                yield _at("RBL427", move, f"at {100.0 * float(move.plan.s[row]):.1f} % of the way the arm is "
                          f"{float(values[row]) / size:.2f} {unit} from where its {name}, which is singular; keep "
                          f"{least / size:g} {unit} away")  # fmt: skip
                return

    def wrist_changes(self, move: RehearsedMove) -> Found:
        """Report that the tool leaves its posture, where neither the move nor a setting says WRIST."""
        change = move.plan.wrist
        if change is not None and move.effect.wrist is None and not change.deviation < NOTICED:
            begins, ends = 100.0 * change.share, 100.0 * change.share_end
            yield _at("RBL428", move, f"from {begins:.1f} % to {ends:.1f} % of the way the tool leaves its posture by "
                      f"up to {change.deviation / DEG:.1f} deg, for the wrist to change (condition {change.condition})")

    def ends_otherwise(self, move: RehearsedMove) -> Found:
        """Report a move that keeps the wrist and so does not end in the taught joint angles."""
        taught = move.command.q_end
        if taught is None or np.abs(move.plan.q[-1] - taught).max() <= NOTICED:
            return
        axis = int(np.argmax(np.abs(move.plan.q[-1] - taught)))
        yield _at("RBL419", move, f"ends with J{axis + 1} at {float(move.plan.q[-1, axis]) / DEG:.1f} deg, not at the "
                  f"taught {float(taught[axis]) / DEG:.1f} deg: WRIST KEEP keeps the sign of J5")  # fmt: skip

    def slowed(self, move: RehearsedMove) -> Found:
        """Report a move that takes far longer than the program asked for, and what rules it."""
        slow, effect = move.plan.slowdown, move.effect
        asked_s = None if effect.time_s is None else effect.time_s / (effect.override_pct * PERCENT)
        takes_s = (len(move.plan.q) - 1) * self._period_s
        factor = takes_s / asked_s if asked_s else 1.0 if slow is None or effect.speed_mm_s is None else slow.factor
        if not factor <= SLOWED:
            ruled = "the path limits of the robot rule it"
            if slow is not None:
                limits = self._spec.axes[slow.axis].limits
                value, unit = (limits.speed, "deg/s") if slow.quantity == "speed" else (limits.acceleration, "deg/s2")
                ruled = f"J{slow.axis + 1} is at its {slow.quantity} limit of {value / DEG:g} {unit}"
            yield _at("RBL429", move, f"takes {takes_s:.3f} s, {factor:.2f} times as long as asked for: {ruled}")


def _zones(moves: Sequence[RehearsedMove]) -> Found:
    """Report zones that leave no room for the blends at both ends of a move."""
    for move, after in pairwise(moves):
        if move.corner is None or move.plan.path is None or after.plan.path is None:
            continue
        short, which = min((move.plan.path.length, "the way to"), (after.plan.path.length, "the way from"))
        if not short <= 0.0 and not move.corner.radius <= 0.5 * short + 1e-9:
            yield _at("RBL414", move, f"a zone of {move.corner.radius / MM:g} mm is more than half of {which} this "
                      f"corner, {short / MM:.1f} mm: the blend begins and ends within "
                      f"{move.corner.reach / MM:.1f} mm")  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadShare:
    """What a payload asks of an axis of the wrist (0-based) in its worst posture: its ``moment`` or ``inertia``.

    ``given``: the robot file says the limit, else it is an estimate. ``move`` and ``row`` are where it is.
    """

    axis: int
    what: str
    value: float
    limit: float
    given: bool
    move: RehearsedMove
    row: int

    @property
    def unit(self) -> str:
        """Unit of value and limit."""
        return "N m" if self.what == "moment" else "kg m2"


def worst_loads(project: Project, moves: Sequence[RehearsedMove]) -> list[LoadShare]:
    """Return moments, then inertias of the last axes, each at the move with the worst posture."""
    spec = project.cell.robot
    kinematics, limits = Kinematics(spec), dict(zip(("moment", "inertia"), ratings(spec), strict=True))
    worst: dict[tuple[str, int], LoadShare] = {}
    for move in moves:
        load = wrist_load(kinematics, move.q, move.payload)
        for what, values in (("moment", load.moment), ("inertia", load.inertia)):
            for k, row in enumerate(np.argmax(values, axis=0).tolist()):
                value, axis = float(values[row, k]), load.first + k
                if not value <= 0.0 and ((what, k) not in worst or not value <= worst[what, k].value):
                    given = getattr(spec.axes[axis].limits, f"rated_{what}") is not None
                    worst[what, k] = LoadShare(axis=axis, what=what, value=value, limit=float(limits[what][k]),
                                               given=given, move=move, row=row)  # fmt: skip
    return sorted(worst.values(), key=lambda share: (share.what != "moment", share.axis))


def _loads(project: Project, moves: Sequence[RehearsedMove]) -> Found:
    """Report each axis of the wrist that a payload overloads, at the move with the worst posture."""
    shares = worst_loads(project, moves)
    for share in sorted(shares, key=lambda share: (not share.given, share.limit / share.value)):  # worst first
        if not share.value <= share.limit * (1.0 + OVERLOAD) + NOTHING:
            code = "RBL425" if share.what == "moment" else "RBL426"
            yield _at(code, share.move, f"at {share.move.share(share.row):.1f} % of the way the {share.what} of the "
                      f"payload of {share.move.payload.mass:g} kg about J{share.axis + 1} is {share.value:.4g} "
                      f"{share.unit}, {share.value - share.limit:.3g} more than "
                      f"{'it is rated for' if share.given else 'its drive allows by estimate'}, {share.limit:.4g} "
                      f"{share.unit}", Severity.ERROR if share.given else Severity.WARNING)  # fmt: skip
