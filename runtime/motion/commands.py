"""Motion requests as the controller takes them: SI, frozen, complete."""

from dataclasses import dataclass

from runtime.frames import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class MoveLinear:
    """Move the tool point straight to ``X_world_tool`` (4, 4), orientation about one axis (JPH06190750A Fig 6).

    ``speed`` m/s of the tool point (None: the robot's default), ``acceleration`` fraction of the robot's in (0, 1],
    ``duration`` s from start to stop (None: as fast as speed and limits allow).
    """

    X_world_tool: Array
    speed: float | None = None
    acceleration: float = 1.0
    duration: float | None = None
