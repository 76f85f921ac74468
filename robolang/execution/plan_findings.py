"""Where the planned motion of a move is not the one that the program states, with the reason and a remedy.

    RBL414   a zone without room for the blend: the blend is smaller than its zone, or the arm stops at the corner
    RBL419   a move that keeps the wrist and does not end as the point is taught
    RBL428   a path on which the tool leaves its posture to change the wrist, where the program does not say so
    RBL429   a TIME or a SPEED that is not kept, and which limit rules
    RBL434   a joint move to a pose that changes the arm configuration
    RBL435   a joint move to a pose that turns a joint by more than half a turn, since the nearer angle is out of range

and those of splines (``spline_findings``).

The plan that is checked is the plan that runs: ``robolang check --motion`` reports these as findings, a run as warnings
(docs/decisions/0030).
"""

import numpy as np

from robolang.execution.planned_move import Found, PlanFinding, PlannedMove
from robolang.execution.speed_findings import sentence, slowed, zone_remedy
from robolang.execution.spline_findings import spline_findings
from robolang.project.project import Project
from robolang.syntax.ast import Spline
from robolang.syntax.unparse import print_expression
from runtime.core.frames import Array
from runtime.core.rounding import down, up
from runtime.core.units import DEG, MM
from runtime.motion.cartesian_planner import MovePlan
from runtime.motion.chain.corner import Corner
from runtime.motion.commands import MoveJoint
from runtime.motion.joint_planner import changed
from runtime.motion.path import turn_between
from runtime.motion.spline_path import SplinePath
from runtime.motion.taught_end import as_taught
from runtime.robot.kinematics.kinematics import Kinematics

NOTICED = 0.1 * DEG
"""A tool or a joint that is turned less from where it should be keeps it, rad."""
SHARP = 10.0 * DEG
"""Paths that turn by less at a corner are pieces of one curve: smaller blends do not slow the tool, rad."""
REVERSES = 175.0 * DEG
"""Paths that turn by more at a corner go back the line that they have come on, rad."""
_KEPT = 0.95
"""A corner that reaches this share of its zone is as wide as programmed."""


class PlanFindings:
    """Finds what the plans of one project's moves do otherwise than its program says."""

    def __init__(self, project: Project, kinematics: Kinematics) -> None:
        self._spec = project.cell.robot
        self._kinematics = kinematics

    def of(self, move: PlannedMove) -> Found:
        """Yield the findings of a move, at most one of a code."""
        if len(move.plan.q) > 1:
            yield from self.configuration(move)
            yield from self.long_turn(move)
            yield from self.wrist_change(move)
            yield from slowed(move)
            yield from self.zone(move)
            yield from _of_spline(move)
        yield from self.end(move)

    def configuration(self, move: PlannedMove) -> Found:
        """Find a joint move that leaves the arm configuration, though its target does not say so."""
        command, q = move.command, move.plan.q
        words = changed(self._kinematics, q[0], q[-1], command) if isinstance(command, MoveJoint) else ()
        if words:
            change = " and ".join(f"{before} to {after}" for before, after in words)
            yield PlanFinding(
                code="RBL434",
                message=f"changes the arm configuration from {change}: "
                f"{_largest_turn(q[0], q[-1])}; the configuration of the start does not reach the target "
                "within the ranges of the joints",
            )

    def long_turn(self, move: PlannedMove) -> Found:
        """Find a joint move to a pose that turns a joint by the longer of two turns."""
        command, start, end = move.command, move.plan.q[0], move.plan.q[-1]
        if not isinstance(command, MoveJoint) or command.q_end is not None or command.turns:
            return
        # with taught joints or turns the point itself states the turn
        nearer = self._kinematics.nearest_turns(end, start)
        axis = int(np.argmax(np.abs(end - start) - np.abs(nearer - start)))
        if not np.abs(end - start)[axis] <= np.abs(nearer - start)[axis] + NOTICED:
            limits = self._spec.axes[axis].limits
            yield PlanFinding(
                code="RBL435",
                message=f"{_turn(start, end, axis)}: the nearer angle of "
                f"{nearer[axis] / DEG:.1f} deg is beyond the range {limits.lower / DEG:g} to "
                f"{limits.upper / DEG:g} deg",
            )

    def wrist_change(self, move: PlannedMove) -> Found:
        """Find that the tool leaves its posture, where neither the move nor a setting says WRIST."""
        change = move.plan.wrist
        if change is not None and move.effect.wrist is None and not change.deviation < NOTICED:
            begins, ends = 100.0 * change.share, 100.0 * change.share_end
            yield PlanFinding(
                code="RBL428",
                message=f"from {begins:.1f} % to {ends:.1f} % of the path the tool leaves "
                f"its posture by up to {change.deviation / DEG:.1f} deg, for the wrist to change "
                f"(condition {change.condition})",
            )

    def end(self, move: PlannedMove) -> Found:
        """Find a move that keeps the wrist and does not end as its point is taught."""
        command, end = move.command, move.plan.q[-1]
        if command.q_end is not None:
            if not np.abs(end - command.q_end).max() <= NOTICED:
                axis = int(np.argmax(np.abs(end - command.q_end)))
                yield PlanFinding(
                    code="RBL419",
                    message=f"the move ends with J{axis + 1} at {end[axis] / DEG:.1f} deg, not at "
                    f"the taught {command.q_end[axis] / DEG:.1f} deg: WRIST KEEP keeps the sign of J5",
                )
        elif (command.configuration or command.turns) and not as_taught(self._kinematics, end, command):
            turns = np.round(end / (2.0 * np.pi)).astype(int).tolist()
            taught = " ".join([*command.configuration, *([f"turns {list(command.turns)}"] if command.turns else [])])
            yield PlanFinding(
                code="RBL419",
                message=f"the move ends {self._kinematics.branch_of(end)} with turns {turns}, not "
                f"{taught} as taught: WRIST KEEP keeps the sign of J5",
            )

    def zone(self, move: PlannedMove) -> Found:
        """Find a zone that leaves no room for the blends at both ends of a move, or in which the arm stops."""
        corner, after = move.corner, move.after
        if after is None or corner is None or not corner.radius > 0.0:
            # under a sensor ``tracked`` has taken the zone of the program out of the command
            if move.effect.zone_mm > 0.0 and not move.command.zone > 0.0:
                yield PlanFinding(
                    code="RBL414",
                    message="the arm stops at the end of this move: moves under a seam sensor do not blend",
                    remedy="Write FINE, or SEAM OFF before the move.",
                )
        elif len(after.q) == 1:
            yield PlanFinding(
                code="RBL414",
                message="the arm stops at the end of this move: the next move ends where it begins, and has no length "
                "to blend into",
                remedy="Remove one of the two moves, or correct the point of the next one; write FINE where the stop "
                "is meant.",
            )
        elif not corner.reach > 0.0:
            yield PlanFinding(
                code="RBL414",
                message=f"{_zone(corner)} leaves no room for a blend that is faster than a stop: the arm stops there",
                remedy=lambda: _room_for(move),
            )
        else:
            yield from _turned_back(move.plan, corner, after) or self._short_path(move.plan, corner, after)

    def _short_path(self, before: MovePlan, corner: Corner, after: MovePlan) -> Found:
        """Find a zone that is more than half of a path at its corner: two blends would not fit on that.

        Where the paths go on nearly straight, as the pieces of a curve do, the tool is not kept from its speed by it.
        """
        first, second = before.path, after.path
        # for MOVEJ no length is known
        if first is None or second is None or corner.reach >= _KEPT * corner.radius:
            return
        short, which = sorted([(first.length, "to"), (second.length, "from")])[0]
        # a zone of half the path is not more than half, with the decimals of its points
        if short > 0.0 and not corner.radius <= 0.505 * short and not turn_between(first, second) < SHARP:
            yield PlanFinding(
                code="RBL414",
                message=f"{_zone(corner)} is more than half of the path {which} this corner, "
                f"{short / MM:.1f} mm: the blend begins and ends within "
                f"{corner.reach / MM:.1f} mm",
                remedy=f"Make the path {which} this corner {up(2.0 * corner.radius / MM):g} mm or longer; or write "
                f"ZONE {down(corner.reach / MM):g}, which is kept.",
            )


def _turned_back(before: MovePlan, corner: Corner, after: MovePlan) -> list[PlanFinding]:
    """Return that a tool which goes back the line that it has come on does not reach the point."""
    first, second = before.path, after.path
    if first is None or second is None or not turn_between(first, second) >= REVERSES:
        return []
    return [
        PlanFinding(
            code="RBL414",
            message=f"the next move goes back: in {_zone(corner)} the tool turns round {corner.deviation / MM:.1f} mm "
            "before the end of this move, and does not reach its point",
            remedy="Write FINE at this move where the tool is to reach its point, or a smaller ZONE to come nearer.",
        )
    ]


def _room_for(move: PlannedMove) -> str:
    """Return what lets the arm pass a corner at which it stops."""
    wider = move.speeds.wider_zone(move.number)
    zone = "make the moves at the corner longer" if wider is None else zone_remedy(wider)
    return sentence(zone, "write FINE where the stop is meant")


def _of_spline(move: PlannedMove) -> Found:
    """Find where the curve of a spline is not what its points look like."""
    path, node = move.plan.path, move.effect.node
    # what is left of a move that was interrupted has other points than its statement
    if isinstance(path, SplinePath) and isinstance(node, Spline) and len(node.points) == len(move.effect.via) + 1:
        yield from spline_findings(path, ["the start", *map(print_expression, node.points)])


def _zone(corner: Corner) -> str:
    return f"a zone of {corner.radius / MM:g} mm"


def _largest_turn(start: Array, end: Array) -> str:
    return _turn(start, end, int(np.argmax(np.abs(end - start))))


def _turn(start: Array, end: Array, axis: int) -> str:
    by = abs(float(end[axis] - start[axis])) / DEG
    return f"J{axis + 1} turns by {by:.1f} deg, from {start[axis] / DEG:.1f} to {end[axis] / DEG:.1f} deg"
