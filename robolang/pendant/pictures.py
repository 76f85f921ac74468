"""The live picture beside a prompt: none until it is opened, then of whatever session the prompt has."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from robolang.pendant.choice import Picture
from robolang.pendant.failure import failure

if TYPE_CHECKING:
    from robolang.pendant.live import Live


class Pictures:
    """The picture of a prompt; ``make`` None: there is none."""

    def __init__(self, make: Callable[[], Picture] | None) -> None:
        self._make = make
        self._picture: Picture | None = None

    def open(self, live: "Live") -> str:
        """Show a session in a browser and return the address of the page; ``Failure`` RBL812 without pictures."""
        if self._make is None:
            raise failure("RBL812", "this prompt has no live picture")
        if self._picture is None:
            picture = self._make()
            picture.follow(live.session, live.observers)
            # only now: one whose port cannot be used is none
            self._picture = picture
        return self._picture.open()

    def follow(self, live: "Live") -> None:
        """Show another session, if a picture is open."""
        if self._picture is not None:
            self._picture.follow(live.session, live.observers)

    def show(self) -> None:
        """Show where the session stands: what is done while nothing moves is seen by no observer."""
        if self._picture is not None:
            self._picture.show()

    def close(self) -> None:
        """End the picture, if one is open."""
        if self._picture is not None:
            self._picture.close()
            self._picture = None
