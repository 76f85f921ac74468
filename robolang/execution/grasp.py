"""What a hand holds once it has closed: a note of its statement, and a warning where it is nothing."""

from robolang.execution.result import StatementRun
from runtime.cell.cell import CellSpec
from runtime.control.controller import Controller


def note_grasp(run: StatementRun, controller: Controller, cell: CellSpec) -> None:
    """Note what the hand holds; nothing is a warning in a cell with parts (RBL441), as ``check --motion`` gives it."""
    holding = controller.plant.hand().holding
    run.notes.append(f"holds '{holding}'" if holding else "closed on nothing")
    if holding is None and cell.parts:
        controller.warn("RBL441", "the cup seals on nothing" if cell.hand.is_cup else "the hand closed on nothing")
