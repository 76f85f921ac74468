"""Commands that run the program: from where it stands, and back to the start."""

from typing import TYPE_CHECKING

from robolang.pendant.command import Command, Group
from robolang.pendant.words import nothing

if TYPE_CHECKING:
    from robolang.pendant.pendant import Pendant


def _run(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "run")
    pendant.to_auto()
    pendant.run()


def _again(pendant: "Pendant", rest: str) -> None:
    nothing(rest, "again")
    pendant.start_again()
    pendant.output.line("the cell is in its start state, the program before its first statement")


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
    degrees = ", ".join(f"{angle:.10g}" for angle in pendant.live.home_deg)
    pendant.carry_out(f"MOVEJ JOINT({degrees})")


COMMANDS = (
    Command(
        word="run",
        form="run",
        help="Run the program from the statement where it stands.",
        group=Group.RUN,
        do=_run,
        more="It runs in AUTO, with its programmed speeds, to its end, a breakpoint or an alarm. Ctrl-C, Esc and Space "
        "stop it on its path; continue goes on.",
    ),
    Command(
        word="again",
        form="again",
        help="Put cell, arm and program back into the start state.",
        group=Group.RUN,
        do=_again,
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
