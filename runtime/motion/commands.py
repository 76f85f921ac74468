"""Motion requests as the controller takes them: SI, frozen, complete."""

from dataclasses import dataclass
from typing import Literal

from runtime.frames import Array
from runtime.robot.opw import Branch

Component = Literal["TILT", "ADVANCE", "ROTATION"]
"""Components of the tool's posture, about the direction of travel, across it and upright (``runtime.motion.hold``)."""

Wrist = Literal["auto", "keep"]


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveLinear:
    """Move the tool point straight to ``X_world_tool`` (4, 4), orientation about one axis (JPH06190750A Fig 6).

    ``speed`` m/s of the tool point (None: the robot's default), ``acceleration`` fraction of the robot's in (0, 1],
    ``duration`` s from start to stop (None: as fast as speed and limits allow).

    ``q_end`` (n,) rad: the taught joint angles of the end, turns and all; None where only its pose is taught, with the
    words of ``configuration`` and the ``turns`` of the joints as far as they are. ``wrist`` (None: as the profile
    says): ``auto`` may leave the posture of the path to end as taught, ``keep`` never does, and keeps the sign of J5.
    ``held`` components of the posture change as little as they can while it is left. ``tracked``: a seam sensor will
    shift the path as it goes, so once the wrist has left its posture it does not return to it before the end.
    """

    X_world_tool: Array
    speed: float | None = None
    acceleration: float = 1.0
    duration: float | None = None
    q_end: Array | None = None
    configuration: tuple[str, ...] = ()
    turns: tuple[int, ...] = ()
    wrist: Wrist | None = None
    held: tuple[Component, ...] = ()
    tracked: bool = False


def in_configuration(branch: Branch, words: tuple[str, ...]) -> bool:
    """Return whether a branch is what the words of a taught point ask for; no words ask for nothing."""
    return set(words) <= set(str(branch).split())
