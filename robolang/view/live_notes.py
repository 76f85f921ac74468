"""The notes of a session while it goes on, made anew only where something of them is new."""

from collections import deque
from collections.abc import Iterator

from robolang.execution.result import StatementRun
from robolang.execution.session import Session
from robolang.view.notes import MOST_LIVE, Note, of_live


class LiveNotes:
    """The notes of one session; of its statements those that have ended are read once."""

    def __init__(self) -> None:
        self._seen: tuple[object, ...] | None = None
        self._notes: list[Note] | None = None
        self._ended: deque[Note] = deque(maxlen=MOST_LIVE)
        self._last: StatementRun | None = None
        self._count = 0

    def news(self, session: Session) -> list[Note] | None:
        """Return all notes of the session if some are new since the last call; None: they are the same."""
        tick_us, statements = session.project.profile.tick_us, session.record.statements
        self._read(statements, tick_us)
        stated = [*self._ended, *(note for run in statements[self._count :] for note in _of(run, tick_us))]
        alarms, warnings, touches = session.record.alarms, session.controller.warnings, session.controller.touches
        # the newest ones and not their numbers: the prompt takes some back, and then there are others
        seen = (
            alarms[-1:],
            warnings[-1:],
            None if touches is None else touches.latest,
            session.executor.status.state,
            stated,
        )
        if seen == self._seen:
            return None
        self._seen, before = seen, self._notes
        self._notes = of_live(session, stated)
        return None if self._notes == before else self._notes

    def _read(self, statements: list[StatementRun], tick_us: int) -> None:
        """Read what has ended since; all of it where statements were taken back."""
        at = self._count
        if at and not (at <= len(statements) and statements[at - 1] is self._last):
            self._ended.clear()
            self._count = 0
        # the last one may go on: a wait ends in each cycle
        while self._count < len(statements) - 1 and statements[self._count].ended:
            self._last = statements[self._count]
            self._ended.extend(_of(self._last, tick_us))
            self._count += 1


def _of(run: StatementRun, tick_us: int) -> Iterator[Note]:
    if run.begun:
        line, time_s = run.origin.line or None, run.first_tick * tick_us / 1_000_000
        yield from (Note(time_s=time_s, line=line, code=None, severity="note", text=text) for text in run.notes)
