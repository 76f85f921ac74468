"""Mistakes that have one cause and many places: reported at the first place, with the next ones as notes.

A mistyped definition makes every use of the name a mistake. Listing each would hide the others, so an undefined name,
subroutine or target of a jump is one diagnostic for a program.
"""

from collections.abc import Hashable, Iterable

from robolang.core.diagnostics import Diagnostic, Related
from robolang.core.source import Span

MAX_NOTES = 5
"""Other places that are named; a diagnostic stays readable, and small."""


class Repeats:
    """The places of each cause so far."""

    def __init__(self) -> None:
        self._places: dict[Hashable, list[Span]] = {}

    def is_first(self, cause: Hashable, place: Span) -> bool:
        """Return whether a place is the first of its cause, and note it when it is another one."""
        places = self._places.setdefault(cause, [place])
        # the first place is the diagnostic itself and no note
        if place not in places and len(places) <= MAX_NOTES:
            places.append(place)
        # by place, since two checks of one expression ask for the same one
        return place == places[0]

    def noted(self, found: Iterable[Diagnostic], code: str) -> list[Diagnostic]:
        """Return diagnostics with the other places of their causes as notes; ``code`` is that of such causes."""
        others = {places[0]: places[1:] for places in self._places.values() if len(places) > 1}
        return [_with_notes(item, others.get(item.span, [])) if item.code == code else item for item in found]


def _with_notes(item: Diagnostic, others: list[Span]) -> Diagnostic:
    notes = tuple(Related(span=place, message="and here") for place in others)
    return item.replaced(related=item.related + notes) if notes else item
