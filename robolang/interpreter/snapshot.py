"""The state of a program at one moment, as a value: all that its future depends on, besides its world.

Values, effects, nodes of the tree and positions are immutable, so a snapshot shares them; what the interpreter changes
in place is copied. Large arrays are shared block by block (``arrays``), so the cost grows with the names and loops of
the open calls, not with the elements.
"""

from dataclasses import dataclass

from robolang.interpreter.actions import Settings
from robolang.interpreter.branch_oracle import DecisionsSnapshot
from robolang.interpreter.positions import Cursor, Suspended
from robolang.interpreter.rounds import Rounds
from robolang.interpreter.run_state import RunState
from robolang.interpreter.scope import Scope
from robolang.syntax.ast import Program
from robolang.values.poses import Frame


@dataclass(frozen=True, slots=True, kw_only=True)
class MachineSnapshot:
    """A state of a ``Machine``; its fields are copies that nothing changes."""

    program: Program
    cursor: Cursor
    suspended: tuple[Suspended, ...]
    scopes: tuple[Scope, ...]
    rounds: Rounds
    settings: Settings
    frame: Frame
    error: float
    steps: int
    shown: int
    decisions: DecisionsSnapshot


def take(run: RunState) -> MachineSnapshot:
    """Return the state of a run."""
    return MachineSnapshot(
        program=run.program,
        cursor=run.cursor.copy(),
        suspended=run.suspended,
        scopes=run.scopes.snapshot(),
        rounds=run.rounds.copy(),
        settings=run.actions.settings,
        frame=run.values.frame,
        error=run.values.error,
        steps=run.steps,
        shown=run.shown,
        decisions=run.decisions.snapshot(),
    )


def put_back(run: RunState, snapshot: MachineSnapshot) -> None:
    """Bring a run into the state of a snapshot; ``ValueError`` when it is one of another program."""
    # equal is enough: an editor parses a text anew, and positions hold nodes, which compare by meaning
    if snapshot.program is not run.program and snapshot.program != run.program:
        raise ValueError("the snapshot belongs to another program")
    run.cursor = snapshot.cursor.copy()
    run.suspended = snapshot.suspended
    # scopes and decisions in place, since the evaluator and the caller hold the objects; the rest is replaced
    run.scopes.restore(snapshot.scopes)
    run.rounds = snapshot.rounds.copy()
    run.actions.settings = snapshot.settings
    run.values.frame, run.values.error = snapshot.frame, snapshot.error
    run.steps, run.shown = snapshot.steps, snapshot.shown
    run.decisions.restore(snapshot.decisions)
