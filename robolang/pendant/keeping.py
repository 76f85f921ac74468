"""Unsaved changes at a prompt: kept in the recovery file while somebody works, and offered to the next prompt."""

from robolang.pendant.failure import of_fault
from robolang.pendant.output import Output
from robolang.teaching.desk import Desk
from robolang.teaching.recovery import Recovery, discard, pending_recovery, recover
from runtime.core.faults import Fault


class Keeping:
    """The recovery file of one prompt; ``scripted``: a script can be played again, and needs none."""

    def __init__(self, *, scripted: bool) -> None:
        self._scripted = scripted
        self._recovery = Recovery()

    def keep(self, desk: Desk, output: Output) -> None:
        """Write what is unsaved; where that fails, the reason is shown, and work goes on without the file."""
        if self._scripted:
            return
        try:
            self._recovery.keep(desk)
        except Fault as fault:
            # the change itself has been made
            output.problem(of_fault(fault).text)

    def offered(self, desk: Desk, output: Output) -> Desk | None:
        """Ask what becomes of changes that an earlier prompt left; return them where they are taken."""
        documents = desk.documents
        pending = pending_recovery(documents.path if documents.named else None)
        if pending is None:
            return None
        output.line(pending.diff().rstrip("\n"))
        if output.ask(f"Unsaved changes of {pending.when:%Y-%m-%d %H:%M} UTC were left: take them?"):
            self._recovery = Recovery(pending)
            return recover(pending)
        if output.ask("Delete them?"):
            discard(pending.file)
        return None

    def close(self) -> None:
        """Remove the recovery file: the changes are saved, or given up."""
        self._recovery.close()
