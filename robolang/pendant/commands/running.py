"""Commands that run the program: from where it stands, and back to the start."""

from typing import TYPE_CHECKING

from robolang.pendant.command import Command, Group
from robolang.pendant.standing import text_of
from robolang.pendant.words import misused, nothing, number, whole
from runtime.core.program_line import named

if TYPE_CHECKING:
    from robolang.pendant.pendant import Pendant

_RUN = "run [for SECONDS]"


def _run(pendant: "Pendant", rest: str) -> None:
    words = rest.split()
    if not words:
        pendant.run()
        return
    if len(words) != 2 or words[0].lower() != "for":
        raise misused(_RUN, f"found '{rest}'")
    seconds = number(words[1], _RUN, "the seconds")
    # a run that ends at once would hold a program in the middle of nothing
    if not seconds > 0.0:
        raise misused(_RUN, f"the seconds are {seconds:g} and must be positive")
    pendant.run(seconds=seconds)


def _continue(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "continue")
    pendant.take_up()


def _hold(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "hold")
    far = pendant.live.executor.displaced
    if far is None:
        pendant.output.line(_strayed(pendant) or "no motion is interrupted")
    elif far.is_away:
        pendant.output.line(f"a motion is held; the arm is {far} away from its path")
    else:
        pendant.output.line("a motion is held on its path")


def _back(pendant: "Pendant", rest: str) -> None:
    pendant.back(whole(rest, "back [N]", "the statements", 1, 100_000) if rest else 1)


def _where(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "where")
    live = pendant.live
    pendant.output.line(pendant.standing)
    # the innermost first: it is the one that step out leaves
    for call in reversed(live.executor.calls):
        pendant.output.line(f"called from {named(call.line, call.number)}: {text_of(live, call)}")
    far = live.executor.displaced
    if far is not None and far.is_away:
        pendant.output.line(f"a motion is held; the arm is {far} away from its path")
    elif far is None and (said := _strayed(pendant)):
        pendant.output.line(said)


def _strayed(pendant: "Pendant") -> str:
    """Return how far jogs have brought the arm from where the program stood between two statements, "": nowhere."""
    far = pendant.live.executor.strayed
    return "" if far is None or not far.is_away else f"the arm is {far} away from where the program stood"


def _again(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "again")
    # edits stay: it is the cell that begins anew, and not the work on the program
    pendant.start_again()
    pendant.output.line("the cell is in its start state, the program before its first statement")


def _restart(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "restart")
    pendant.refuse_errors()
    pendant.live.refuse_latched()
    pendant.live.restart()
    pendant.output.line(pendant.standing)


def _reset(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "reset")
    alarm = pendant.live.executor.status.alarm
    if alarm is None:
        pendant.output.line("no alarm is latched")
        return
    pendant.live.executor.acknowledge()
    pendant.output.line(f"{alarm.code} is acknowledged; the servos hold the arm")


def _home(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "home")
    # ten digits: three decimals would leave the arm beside its home, and the next run would begin there
    joints = ", ".join(f"{value:.10g}" for value in pendant.live.home)
    pendant.carry_out(f"MOVEJ JOINT({joints})")


COMMANDS = (
    Command(
        word="run",
        form=_RUN,
        help="Run the program from the statement where it stands.",
        group=Group.RUN,
        do=_run,
        more="It runs in AUTO, with its programmed speeds, to its end, a breakpoint or an alarm. Ctrl-C, Esc and\n"
        "Space stop it on its path; continue goes on. run for 2.5 stops it after 2.5 s of simulated time.",
        words=("for",),
    ),
    Command(
        word="continue",
        form="continue",
        help="Go on with what was interrupted: from its path, or with its statement.",
        group=Group.RUN,
        do=_continue,
        more="The arm first returns slowly to the path that it has left, or to where the program stood between two\n"
        "statements before a jog, from 50 mm and 10 deg (mm of a slide) in a joint at most.\n"
        "After an alarm and reset the interrupted statement begins again, from where the arm stands.",
    ),
    Command(
        word="hold",
        form="hold",
        help="Show whether a motion is held, and how far the arm is from its path.",
        group=Group.RUN,
        do=_hold,
        more="While the arm moves, Ctrl-C, Esc and Space hold it on its path.",
    ),
    Command(
        word="back",
        form="back [N]",
        help="Take back the last N statements, jogs or lines of the prompt.",
        group=Group.RUN,
        do=_back,
        more="Arm, physics, signals, names, time and log are as they were then.",
    ),
    Command(
        word="where",
        form="where",
        help="Show where the program stands, and the calls that led there.",
        group=Group.SHOW,
        do=_where,
    ),
    Command(
        word="again",
        form="again",
        help="Put cell, arm and program back into the start state.",
        group=Group.RUN,
        do=_again,
    ),
    Command(
        word="restart",
        form="restart",
        help="Put the program before its first statement; arm, cell and names stay.",
        group=Group.RUN,
        do=_restart,
    ),
    Command(
        word="reset",
        form="reset",
        help="Acknowledge an alarm; nothing moves before.",
        group=Group.RUN,
        do=_reset,
    ),
    Command(
        word="home",
        form="home",
        help="Move the joints to the home position of the cell.",
        group=Group.MOTION,
        do=_home,
    ),
)
