"""What a prompt is started with, and the modes it can be in."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from robolang.execution.observer import Observers
    from robolang.execution.session import Session


class Mode(Enum):
    """MANUAL: tool and flange stay under 250 mm/s. AUTO: moves have their programmed speeds."""

    MANUAL = "MANUAL"
    AUTO = "AUTO"


class Picture(Protocol):
    """A live picture of the arm beside the prompt."""

    def follow(self, session: "Session", observers: "Observers") -> None:
        """Show this session from now on; ``observers`` are those of the session."""

    def open(self) -> str:
        """Open it in a browser, if there is one, and return its address."""

    def show(self) -> None:
        """Show where the session stands now."""

    def close(self) -> None:
        """End it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Choice:
    """What the command line chooses: cell file, robot, physics or the ideal arm, wall time or as fast as it goes.

    ``picture`` makes a live picture; None: there is none. The prompt knows no page: the command line hands it in.
    """

    cell: Path | None = None
    robot: str | None = None
    physics: bool = True
    realtime: bool = False
    picture: Callable[[], Picture] | None = None
