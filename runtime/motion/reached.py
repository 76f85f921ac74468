"""What became of a programmed speed: how fast a move is at most, and the limit that keeps it from being faster."""

from dataclasses import dataclass
from typing import Literal

Kind = Literal["cap", "joint", "turning", "tool", "radius", "cusp", "corner", "length"]
"""What keeps a move slow: the cap of MANUAL, a joint, the turning of the tool, the acceleration of the tool point or
the radius of a curve that takes it, a place at which a curve doubles back, a corner between two moves, or a path that
is too short to gain the speed."""

WORDS: dict[Kind, str] = {
    "cap": "MANUAL",
    "joint": "J",
    "turning": "turning",
    "tool": "tool accel.",
    "radius": "radius",
    "cusp": "cusp",
    "corner": "corner",
    "length": "length",
}
SHORT = {"": "", "speed": "speed", "acceleration": "accel.", "jerk": "jerk"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Why:
    """The limit that keeps a move slow: of ``axis`` (0-based; None: no joint) the ``quantity``, else "".

    ``share`` of the limit that is taken there; ``at``: the share of the path at which that is, None: outside of the
    move. ``text`` says it in words, ``remedy`` what would help.
    """

    kind: Kind
    text: str
    remedy: str
    axis: int | None = None
    quantity: str = ""
    share: float = 1.0
    at: float | None = None

    @property
    def short(self) -> str:
        """The limit in two words at most, as a table shows it: ``J5 speed``, ``corner``."""
        if self.kind != "joint" or self.axis is None:
            return WORDS[self.kind]
        return f"J{self.axis + 1} {SHORT[self.quantity]}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Reached:
    """The speed of a planned move: m/s of the tool point along a path, of a joint move the share of the joints' speeds.

    ``programmed`` with OVERRIDE, None with TIME and where the tool turns in place; ``reached``: the highest, counted up
    to the programmed one, since in a corner the speed goes over from that of one move to that of the next. ``seconds``
    that the move takes of its chain, ``expected_s`` those that its speed and the acceleration of the path let expect, 0
    where no path is. ``why`` None: nothing keeps it from its speed. ``of_joints``: of a joint move.
    """

    programmed: float | None
    reached: float
    seconds: float
    expected_s: float
    why: Why | None
    of_joints: bool
