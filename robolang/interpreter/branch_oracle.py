"""The branch that each condition of a running program takes, seen and changed from outside.

A dry run follows one path through a program, that of the simulated inputs. ``Decisions`` lets a caller of the
interpreter see which branch each condition took, and force the other one when the condition is met the first time
(``robolang.planning.branch_forcing`` has the conditions whose branch depends on inputs, time or errors).
"""

from collections.abc import Mapping
from dataclasses import dataclass

from robolang.core.source import Span


class Decisions:
    """The branches that conditions took in one run, by the place of the condition, and those that are to be forced.

    ``forced``: a condition takes this branch the first time. ``patient`` False: a WAIT without a TIMEOUT comes true at
    once, since on a forced branch its input may never change.
    """

    def __init__(self, forced: Mapping[Span, bool] | None = None, *, patient: bool = True) -> None:
        self._forced = dict(forced or {})
        self._patient = patient
        self.taken: dict[Span, set[bool]] = {}
        """Branches that each condition took."""

    def of(self, place: Span, value: bool) -> bool:
        """Return the branch that a condition of this value takes."""
        # forced once: a loop whose condition were forced each time would not end
        return self.took(place, self._forced.pop(place, value))

    def of_wait(self, place: Span, *, endless: bool) -> bool | None:
        """Return the branch that a WAIT is to take: True, it comes true; None, the inputs decide."""
        return self._forced.pop(place, True if endless and not self._patient else None)

    def took(self, place: Span, value: bool) -> bool:
        """Record the branch that a condition took, and return it."""
        self.taken.setdefault(place, set()).add(value)
        return value

    def snapshot(self) -> "DecisionsSnapshot":
        """Return what is left to force, and the branches taken so far."""
        taken = {place: frozenset(branches) for place, branches in self.taken.items()}
        return DecisionsSnapshot(forced=self._forced.copy(), taken=taken)

    def restore(self, snapshot: "DecisionsSnapshot") -> None:
        """Take back the state of a snapshot."""
        self._forced = dict(snapshot.forced)
        self.taken = {place: set(branches) for place, branches in snapshot.taken.items()}


@dataclass(frozen=True, slots=True, kw_only=True)
class DecisionsSnapshot:
    """State of ``Decisions``: the branches left to force, and those that conditions have taken."""

    forced: Mapping[Span, bool]
    taken: Mapping[Span, frozenset[bool]]
