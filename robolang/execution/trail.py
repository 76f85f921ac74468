"""What keeps the course of a program, so that it can be taken back: a Protocol, which ``timeline.Timeline`` fills."""

from typing import Any, Protocol

from robolang.interpreter.events import LineBegun


class Trail(Protocol):
    """Sees where a program can be returned to; it may take snapshots, and changes nothing."""

    def begins(self, statement: LineBegun, *, stops: bool) -> None:
        """See a statement of the program that is due; it is paused there (``stops``), or goes on."""

    def leaves(self, label: str) -> None:
        """See that a program which stands goes on or is acted on; ``label`` names what is done, "" for ``resume``."""

    def adopts(self, edit: Any) -> None:
        """See that the program is another one from here on: an ``adopting.Edit``."""

    def disturbed(self) -> None:
        """See that the program is acted on while it runs: what follows does not repeat by itself."""
