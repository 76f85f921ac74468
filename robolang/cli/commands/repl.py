"""``robolang repl [PROG]``: the pendant at a prompt; without a terminal a script of its lines.

Nothing heavy is imported before the prompt is there: the controller is built while the first line is typed.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar

from robolang.cli.errors import exit_code, reported
from robolang.cli.options import Argument, CellOptions, Option, SimulationOptions

if TYPE_CHECKING:
    from robolang.pendant.choice import Picture

_Program = Annotated[str | None, Argument("[PROG]", "Program file (.rbl); without one, a new program.")]


class PromptOptions(SimulationOptions):
    """Which arm moves, and what becomes of the lines."""

    PANEL: ClassVar[str] = "Prompt"
    record: Annotated[
        Path | None, Option("--record", metavar="FILE", help="Write what is done as a program (.rbl) to this file.")
    ] = None
    keep_going: Annotated[
        bool, Option("--keep-going", help="In a script: go on after a line that failed; the exit code is that line's.")
    ] = False


def repl(program: _Program, files: CellOptions, options: PromptOptions) -> None:
    """Jog the arm, teach points, and step through a program, forward and backward.

    Lines that come from a pipe or a file are carried out one after the other, and the first that fails ends the script.

    Example: robolang repl pick_and_place.rbl

    Exit codes: 0 done; 1 a statement or the program has errors, or a script ended with unsaved points; 2 a command, a
    file or an option cannot be used; 3 a motion was refused or ended with an alarm; 4 a file cannot be written; 130 or
    143 stopped by a signal.
    """
    with reported():
        from robolang.pendant.choice import Choice
        from robolang.pendant.start import start

        choice = Choice(
            cell=None if files.cell is None else Path(files.cell),
            robot=files.robot,
            physics=not options.no_physics,
            realtime=options.realtime,
            picture=_picture,
        )
        path = None if program is None else Path(program)
        codes = start(path, choice, record=options.record, keep_going=options.keep_going)
    if codes:
        raise SystemExit(exit_code(codes[0]))


def _picture() -> "Picture":
    """Return a live picture for the prompt, whose folder knows no pages."""
    from robolang.view.beside import LiveBeside
    from robolang.view.live_page import live_page
    from robolang.view.page import Bundle

    return LiveBeside(live_page(Bundle.installed()))
