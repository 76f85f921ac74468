"""The rounds of a program's loops while it runs: those that take no time, and the loop that keeps a run from ending.

A loop is here what goes back in the program: NEXT, WEND, a GOTO or RESUME to a line above. It reaches from its head to
the farthest line that has gone back there. Lines are counted from 0, as in ``Program.lines``; time is counted in
statements, so that it is the same in a run, in its rehearsal and in an export.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace


@dataclass(slots=True)
class _Loop:
    """A loop: its last line, how often it went round, and the statements carried out by its first and latest round."""

    end: int
    first: int
    latest: int
    rounds: int = 0


class Rounds:
    """Counts the rounds of one run."""

    def __init__(self) -> None:
        self._idle: dict[int, int] = {}
        self._loops: dict[int, _Loop] = {}

    def copy(self) -> "Rounds":
        """Return the same counts, counted apart from now on."""
        other = Rounds()
        other._idle = self._idle.copy()
        other._loops = {head: replace(loop) for head, loop in self._loops.items()}
        return other

    def moved(self, line: Callable[[int], int | None]) -> "Rounds":
        """Return the same counts by the new places of lines; those of lines that have none are forgotten."""
        other = Rounds()
        other._idle = {to: count for head, count in self._idle.items() if (to := line(head)) is not None}
        for head, loop in self._loops.items():
            to, end = line(head), line(loop.end)
            if to is not None and end is not None:
                other._loops[to] = replace(loop, end=end)
        return other

    def forget_fed(self) -> None:
        """Forget the loops of what was fed before, whose lines are below 0 as those of the next text."""
        self._idle = {head: count for head, count in self._idle.items() if head >= 0}
        self._loops = {head: loop for head, loop in self._loops.items() if head >= 0}

    def idle(self, head: int) -> int:
        """Count a jump back to a line; return how many have come since something took time."""
        self._idle[head] = count = self._idle.get(head, 0) + 1
        return count

    def take_time(self) -> None:
        """Begin to count idle rounds anew, for something takes time."""
        self._idle.clear()

    def leave(self, head: int) -> None:
        """End a loop, so that its idle rounds begin anew when it is reached again."""
        self._idle.pop(head, None)

    def turn(self, head: int, at: int, steps: int) -> None:
        """Count a round that ends on a line, after so many statements of the run."""
        loop = self._loops.get(head)
        if loop is None:
            self._loops[head] = loop = _Loop(end=at, first=steps, latest=steps)
        # a GOTO back from further down makes the loop longer: its lines are all that it has come through
        loop.end, loop.latest, loop.rounds = max(loop.end, at), steps, loop.rounds + 1

    def endless(self, places: Sequence[int], steps: int) -> tuple[int, int] | None:
        """Return head and rounds of the loop that runs on, None where none does.

        ``places``: the lines of the calls that have not come back, the outermost first, then the line that runs. Of the
        loops around them it is the outermost one whose present round is not longer than all before it: a loop that has
        come to another one inside it, which does not end, is not to blame.
        """
        for place in places:
            going = [
                (loop.end - head, head, loop.rounds)
                for head, loop in self._loops.items()
                # a round that is already longer than all before it hangs in a loop inside
                if head <= place <= loop.end and steps - loop.latest <= loop.latest - loop.first
            ]
            if going:
                _, head, rounds = max(going)
                return head, rounds
        return None
