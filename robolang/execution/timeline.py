"""The course of a program as places to which it can be taken back: one before each statement, and those of the face.

Simulated time is virtual and a run repeats bit for bit, so an earlier place is a snapshot, or an earlier snapshot and
the cycles after it, run once more without an observer and without a pace. A snapshot is kept wherever time has passed
since the last one, and in loops without time every ``STRIDE`` statements; of older ones every second is given up again
and again, so they become rarer with their age, and memory stays bounded. What is done from outside does not repeat: a
statement that is fed, a jog, a pause within a move. The first place after it always has its snapshot.

Places before the one to which the program goes back stay, and those after it are given up: there is one course.
"""

from dataclasses import dataclass

from robolang.execution.adopting import Edit
from robolang.execution.executor import Executor, ExecutorSnapshot
from robolang.execution.status import ENDED
from robolang.interpreter.effects import Origin
from robolang.interpreter.events import LineBegun
from runtime.core.faults import Fault

STRIDE = 64
"""Statements without time from one snapshot to the next."""
MOST_PLACES = 5000
"""Places that can be returned to, at least; twice as many are kept at most."""
MOST_SNAPSHOTS = 600
"""Snapshots that are kept; each has 10 to 30 kB of its own."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Mark:
    """A place: ``label`` of what was done from there, "" for the program itself, and the statement that was due.

    ``skipped``: later places that were to be reached, and lie inside of lines which an edit has removed since.
    """

    label: str
    origin: Origin | None
    time_us: int
    snapshot: ExecutorSnapshot
    skipped: int = 0


@dataclass(slots=True, kw_only=True)
class _Place:
    """A place of the course; ``begins``: a statement is due there, and counts where cycles are run once more.

    ``repeats``: the place before it leads here by itself. ``edition``: how many edits the program had then.
    ``snapshot`` None: it is given up, or was never taken.
    """

    time_us: int
    begins: bool
    repeats: bool
    edition: int
    label: str = ""
    snapshot: ExecutorSnapshot | None = None


class Timeline:
    """Follows an executor, from where it stands now."""

    def __init__(self, executor: Executor) -> None:
        self._executor = executor
        self._places: list[_Place] = []
        self._snapshots = 0
        self._last = 0  # index of the last place with a snapshot
        self._repeats = False  # the next place follows from the last one by itself
        self._edits: list[Edit] = []
        self._here = False  # the program stands at the last place
        self._to_pass = 0  # places that are still to be passed while cycles are run once more
        executor.follow(self)

    def __len__(self) -> int:
        """Return how many places ``back`` can reach."""
        return len(self._places) - self._here

    @property
    def labels(self) -> tuple[str, ...]:
        """The labels of the places that ``back`` can reach, the nearest first."""
        return tuple(place.label for place in reversed(self._places[: len(self)]))

    def mark(self, label: str) -> None:
        """Keep the place where the program stands, before something is done from outside that ``label`` names.

        ``feed``, ``play`` and the like mark it by themselves; what the executor does not see, such as an input that is
        forced, needs this call.
        """
        if self._here:
            self._places[-1].label = label
        else:
            self._add(
                _Place(
                    time_us=self._executor.time_us,
                    begins=False,
                    repeats=False,
                    edition=len(self._edits),
                    label=label,
                    snapshot=self._executor.snapshot(),
                )
            )
        # the program itself goes on from a place as it would go on from its snapshot
        self._here, self._repeats = False, not label

    def back(self, steps: int = 1) -> Mark:
        """Take the program back by so many places, and pause it there; ``Fault`` RBL545 where there are not as many.

        The place where it stands does not count. Alarms, their latch and the log after the place are taken back too.
        """
        if not 1 <= steps <= len(self):
            raise Fault("RBL545", f"{steps} places back are more than the {len(self)} that are known")
        wanted = index = len(self._places) - steps - self._here
        project, present = self._executor.project, self._executor.snapshot()
        while (start := self._reached(index)) is None:
            index -= 1
            if index < 0:  # the present was left for the search
                self._executor.become(project)
                self._executor.restore(present)
                raise Fault("RBL545", "each of these places lies inside of lines that an edit has removed")
        place = self._places[index]
        # what came later did not happen: another course begins here
        del self._places[index + 1 :]
        self._last, self._here, self._repeats = start, True, place.edition == len(self._edits)
        self._snapshots = sum(each.snapshot is not None for each in self._places)
        return Mark(
            label=place.label,
            origin=self._executor.origin,
            time_us=place.time_us,
            snapshot=self._executor.snapshot(),
            skipped=wanted - index,
        )

    def _reached(self, index: int) -> int | None:
        """Bring the program to a place and return which snapshot led there; None where an edit has removed it."""
        executor, place, start = self._executor, self._places[index], index
        while self._places[start].snapshot is None:
            start -= 1
        later = self._edits[place.edition :]
        # the cycles of a place are those of the program as it was then
        project = later[0].old if later else self._edits[-1].new if self._edits else executor.project
        if executor.project is not project:
            executor.become(project)
        self._restore(start, index)
        try:
            for edit in later:
                executor.move_to(edit)
        except Fault:
            return None
        return start

    def _restore(self, start: int, index: int) -> None:
        """Bring the program to a place by the snapshot of one before it, or of its own."""
        executor, snapshot = self._executor, self._places[start].snapshot
        assert snapshot is not None
        executor.restore(snapshot)
        if start == index:
            if self._places[index].begins:
                executor.stand()
            return
        # a stop would let moves end that have gone on when the place was made
        hook, executor.stops_before, executor.silent = executor.stops_before, None, True
        self._to_pass = index - start
        try:
            executor.resume()
            while self._to_pass:
                if executor.advance(100).state in ENDED and self._to_pass:
                    raise RuntimeError("the course of the program did not repeat")
        finally:
            self._to_pass, executor.stops_before, executor.silent = 0, hook, False

    # --- what the executor lets it see -------------------------------------------------------------------------------

    def begins(self, statement: LineBegun, *, stops: bool) -> None:
        """See a statement of the program that is due."""
        if self._to_pass:
            self._to_pass -= 1
            if not self._to_pass:
                self._executor.stand()
            return
        time_us, places = self._executor.time_us, self._places
        place = _Place(time_us=time_us, begins=True, repeats=self._repeats, edition=len(self._edits))
        # where time has passed, cycles would have to be run; where it has not, statements are cheap to repeat
        if not self._repeats or places[self._last].time_us != time_us or len(places) - self._last >= STRIDE:
            place.snapshot = self._executor.snapshot()
        self._add(place)
        self._here, self._repeats = stops, True

    def leaves(self, label: str) -> None:
        """See that a program which stands goes on, or is acted on."""
        if not self._to_pass:
            self.mark(label)

    def adopts(self, edit: Edit) -> None:
        """See that the program is another one from here on."""
        self._edits.append(edit)
        self._repeats = False

    def disturbed(self) -> None:
        """See that what follows does not repeat by itself."""
        if not self._to_pass:
            self._here = self._repeats = False

    # --- memory ------------------------------------------------------------------------------------------------------

    def _add(self, place: _Place) -> None:
        places = self._places
        places.append(place)
        if place.snapshot is not None:
            self._last = len(places) - 1
            self._snapshots += 1
            if self._snapshots > MOST_SNAPSHOTS:
                self._thin()
        if len(places) > 2 * MOST_PLACES:
            self._forget(MOST_PLACES)

    def _thin(self) -> None:
        """Give up every second of the older half of the snapshots, of places to which an earlier one leads."""
        # each time the older half: what is kept becomes rarer with its age, and stays dense near the present
        kept = [index for index, place in enumerate(self._places) if place.snapshot is not None]
        for index in kept[1 : len(kept) // 2 : 2]:
            if self._places[index].repeats:
                self._places[index].snapshot = None
                self._snapshots -= 1
        if self._snapshots > MOST_SNAPSHOTS:  # all of them are stops from outside: the oldest are forgotten
            self._forget(len(self._places) - kept[len(kept) // 4])

    def _forget(self, most: int) -> None:
        """Forget the oldest places, all but so many and those that lead to them."""
        places = self._places
        first = max(0, len(places) - most)
        while places[first].snapshot is None:  # the first place must not depend on one that is gone
            first -= 1
        self._snapshots -= sum(place.snapshot is not None for place in places[:first])
        del places[:first]
        self._last -= first
