"""Commands that move the arm by hand: jogs by a typed amount, and how keys jog."""

from typing import TYPE_CHECKING

from robolang.pendant.command import Command, Group, Offer
from robolang.pendant.words import misused, number

if TYPE_CHECKING:
    from robolang.pendant.pendant import Pendant

_JOG, _FRAME, _SPEED = "jog [AXIS AMOUNT]", "jogframe joint|world|base|tool|user", "jogspeed PERCENT"


def _jog(pendant: "Pendant", rest: str) -> None:
    from robolang.teaching.jogging import read_jog, sliding_of

    if not rest:
        # a script has no keys, and a jog without an amount is none
        if pendant.key_mode is None:
            raise misused(_JOG, "an axis and an amount are expected; keys jog on a terminal only")
        pendant.key_mode()
        return
    robot = pendant.project.cell.robot
    pendant.jog_by(read_jog(rest, robot.n, sliding_of(robot)))


def _jogframe(pendant: "Pendant", rest: str) -> None:
    if not rest:
        pendant.output.line(f"jogs count in {pendant.jog.frame}")
        return
    pendant.jog = pendant.jog.with_frame(rest)
    pendant.output.line(f"jogs count in {pendant.jog.frame}")


def _jogspeed(pendant: "Pendant", rest: str) -> None:
    if rest:
        # the sign of percent is what the status line shows, so it is read as well
        pendant.jog = pendant.jog.with_speed(number(rest.removesuffix("%").strip(), _SPEED, "the speed, %"))
    pendant.output.line(f"jogs at {pendant.jog.speed:g} % of the speed of MANUAL")


COMMANDS = (
    Command(
        word="jog",
        form=_JOG,
        help="Move a joint (J3 +5, deg) or the tool (X -10, mm; RZ 2, deg); alone: by keys.",
        group=Group.MOTION,
        do=_jog,
        offers=(Offer.AXIS,),
        more="The frame of jogframe counts. A jog that a limit or the reach does not allow does not start, and\n"
        "says how far it could go. A joint jog always leads out of a limit or a singularity.",
    ),
    Command(
        word="jogframe",
        form=_FRAME,
        help="Choose the frame in which jogs of the tool count.",
        group=Group.MOTION,
        do=_jogframe,
        words=("joint", "world", "base", "tool", "user"),
        more="user is the FRAME in force.",
    ),
    Command(
        word="jogspeed",
        form=_SPEED,
        help="Choose the speed of jogs, % of 250 mm/s.",
        group=Group.MOTION,
        do=_jogspeed,
    ),
)
