"""The reason for which a move is slow in words: where, which limit, how much of it, and what would help."""

from dataclasses import dataclass

import numpy as np

from runtime.core.frames import Array
from runtime.core.units import DEG, MM
from runtime.motion.chain.corner import Corner
from runtime.motion.commands import Command
from runtime.motion.motion_planner import Part
from runtime.motion.path import LinePath
from runtime.motion.reached import Kind, Why
from runtime.robot.model.spec import RobotSpec

_LEAST_TURN = 0.01 * DEG
"""A tool that turns less, rad, does not turn: where the path has no turn the wrist alone moves."""
_MOVES = 1e-4
"""A tool point that moves less, m, stays in place."""
_LITTLE = 0.2
"""Share of a limit below which it is none of the reason."""
_NEAR = 0.8
"""Share of a limit below which it is hardly what bounds a move."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """A limit and the ``share`` of it that is taken: of a joint (``axis``, ``quantity``), else by its kind."""

    kind: Kind
    share: float
    axis: int | None = None
    quantity: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Reasons:
    """Names reasons of one move: ``jerk`` (n,) limits of the joints, ``speed`` m/s at the place in question.

    ``at`` is the share of the path at that place, None outside of the move.
    """

    part: Part
    command: Command
    spec: RobotSpec
    jerk: Array
    speed: float
    at: float | None

    def of(self, limit: Limit, corner: int | None = None) -> Why:
        """Return the reason for a limit that is taken within the move, on the ramp of a corner that is after another
        move, counted from this one; None: of none."""
        text, remedy = {
            "cap": self._cap,
            "joint": self._joint,
            "turning": self._turning,
            "tool": self._tool,
            "radius": self._radius,
        }[limit.kind](limit)
        return Why(
            kind=limit.kind,
            text=text if corner is None else f"{text}, on the ramp of the corner {_which(corner)}",
            remedy=remedy,
            axis=limit.axis if limit.kind == "joint" else None,
            quantity=limit.quantity,
            share=limit.share,
            at=self.at,
        )

    def of_corner(self, after: int, corner: Corner, passed: float, limit: Limit) -> Why:
        """Return the reason for a corner that is passed at a speed, m/s; ``after``: at which move, from this one."""
        where, zone = _which(after), corner.radius / MM
        if not corner.reach > 0.0:
            text = f"the arm stops at the corner {where}, whose zone of {zone:g} mm has no room"
            remedy = "make the moves at the corner longer"
        else:
            text = f"the corner {where} is passed at {passed / MM:.1f} mm/s, where {self._taken(limit)}"
            # a wider ZONE that helps is found by planning (``wider_zones``)
            remedy = "make the moves at that corner longer"
            if limit.kind == "tool" and self.command.acceleration < 1.0:
                remedy += ", or ACCEL higher"
        return Why(kind="corner", text=text, remedy=remedy, share=limit.share, at=self.at)

    def of_cusp(self) -> Why:
        """Return that the curve doubles back at the place."""
        where = self._place.removeprefix(",")
        text = f"the curve doubles back{where}, and the tool is nearly at rest there (RBL437)"
        return Why(
            kind="cusp", text=text, remedy="teach points that lead round the turn, or write two moves", at=self.at
        )

    def of_length(self, between: bool) -> Why:
        """Return the reason for a move that is too short to gain its speed; ``between`` its own two stops."""
        path, share = self.part.path, self.command.acceleration
        where = "between two stops" if between else "in a ramp of the speed"
        if path is None:
            axis = int(np.argmax(np.abs(self._turns) / self.spec.per_axis("limits", "speed")))
            limits = self.spec.axes[axis].limits
            turn, gains = limits.kind.text(abs(self._turns[axis]), ".1f"), limits.kind.text(limits.acceleration * share)
            text = f"J{axis + 1} {limits.kind.moves} by {turn} {where}, accelerated by at most {gains}/s2"
            return Why(kind="length", text=text, remedy=f"{limits.kind.moves.removesuffix('s')} J{axis + 1} less")
        most = self.spec.path.acceleration * share
        by = f", accelerated by at most {most / MM:g} mm/s2" if np.isfinite(most) else ""
        text = f"the path is {path.length / MM:.1f} mm long {where}{by}"
        return Why(kind="length", text=text, remedy="make the path longer, or go over into the next move in a ZONE")

    @property
    def _turns(self) -> Array:
        q = self.part.plan.q
        return np.asarray(q[-1] - q[0])

    def _cap(self, _: Limit) -> tuple[str, str]:
        return "tool point and flange keep below the speed of MANUAL", "run it in AUTO"

    def _joint(self, limit: Limit) -> tuple[str, str]:
        assert limit.axis is not None
        axis = f"J{limit.axis + 1}"
        if self.part.path is None:
            remedy = f"turn {axis} less"
        elif limit.quantity == "speed":
            remedy = f"move the path away from where {axis} has to turn fast, or go there with MOVEJ"
        else:
            remedy = f"choose a posture or a path on which {axis} changes its speed less"
        return f"{self._taken(limit)}{self._place}", remedy

    def _turning(self, _: Limit) -> tuple[str, str]:
        path, most = self.part.path, self.spec.path
        turn = path.angle if path is not None and path.angle >= _LEAST_TURN else float(np.abs(self._turns).max())
        gains = most.rotation_acceleration * self.command.acceleration
        rate = f"{most.rotation_speed / DEG:g} deg/s"
        # without a limit of its acceleration the speed alone rules
        rate += f" and {gains / DEG:g} deg/s2" if np.isfinite(gains) else ""
        on = f" on {path.length / MM:.1f} mm" if path is not None and path.length >= _MOVES else ""
        return (
            f"the tool turns by {turn / DEG:.1f} deg{on}, at {rate} at most",
            f"turn the tool {'on a longer path or in its own move' if on else 'less'}",
        )

    def _tool(self, limit: Limit) -> tuple[str, str]:
        return f"{self._of_path(limit)}{self._place}", "give a higher ACCEL"

    def _radius(self, limit: Limit) -> tuple[str, str]:
        path = self.part.path
        assert path is not None and not isinstance(path, LinePath)
        radius = path.radius / MM
        on = f"on a radius of {radius:{'.1f' if radius >= 1.0 else '.2g'}} mm"
        # a curve is slowed about its tightest place as well, where it takes next to nothing
        taken = f", {self._of_path(limit)} at {self.speed / MM:.1f} mm/s" if limit.share >= _LITTLE else ""
        return (f"{on}{taken}" if taken else f"the path bends {on}"), "make the radius larger"

    def _taken(self, limit: Limit) -> str:
        """Return in words what takes how much of its limit."""
        if limit.axis is None:
            return self._of_path(limit)
        limits = self.spec.axes[limit.axis].limits
        value, per = {
            "speed": (limits.speed, "/s"),
            "acceleration": (limits.acceleration, "/s2"),
            "jerk": (float(self.jerk[limit.axis]), "/s3"),
        }[limit.quantity]
        # the override of a move lowers the speeds and no acceleration
        override = self.part.plan.override if limit.quantity == "speed" else 1.0
        under = f" under OVERRIDE {100.0 * override:g}" if override < 1.0 else ""
        return (
            f"J{limit.axis + 1} {_share(limit)} of its {limit.quantity} limit of {limits.kind.text(value)}{per}{under}"
        )

    def _of_path(self, limit: Limit) -> str:
        most = self.spec.path.acceleration * self.command.acceleration
        return f"the tool point {_share(limit)} of its acceleration of {most / MM:g} mm/s2"

    @property
    def _place(self) -> str:
        """Where the limit is taken, in words."""
        if self.at is None:
            return ""
        path = self.part.path
        if path is None or path.length < _MOVES:
            return f", at {100.0 * self.at:.0f} % of the move"
        return f", {self.at * path.length / MM:.1f} mm from the start"


def _share(limit: Limit) -> str:
    """Return how much of a limit is taken; where that is little, that nothing else is nearer to its limit."""
    taken = f"{100.0 * min(limit.share, 1.0):.0f} %"
    return f"takes {taken}" if limit.share >= _NEAR else f"is the nearest to a limit, at {taken}"


def _which(after: int) -> str:
    """Return which corner that is after move number ``after``, counted from this one."""
    if after == 0:
        return "at its end"
    if after == -1:
        return "at its start"
    return f"{after} moves after it" if after > 0 else f"{-after - 1} moves before it"
