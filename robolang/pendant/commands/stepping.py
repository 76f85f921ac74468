"""Commands that run the program in steps: step, runto, breakpoints, and expressions that are watched."""

from typing import TYPE_CHECKING

from robolang.analysis.named_lines import name_of, stop_of
from robolang.pendant.command import Command, Group, Offer
from robolang.pendant.output import Column, Table
from robolang.pendant.words import misused, values

if TYPE_CHECKING:
    from robolang.execution.stepping import Stop
    from robolang.pendant.pendant import Pendant

_STEP, _RUNTO, _BREAK, _BREAKS = "step [into|out]", "runto LINE", "break LINE [if CONDITION | off]", "breaks [off]"
_WATCH = "watch [VALUE, ... | off]"


def _step(pendant: "Pendant", rest: str) -> None:
    from robolang.execution.stepping import Into, out, over

    executor = pendant.live.executor
    stop: Stop
    match rest.lower():
        case "":
            stop = over(executor)
        case "into":
            stop = Into()
        case "out":
            stop = out(executor)
        case _:
            raise misused(_STEP, f"found '{rest}'")
    pendant.run(stop)


def _runto(pendant: "Pendant", rest: str) -> None:
    from robolang.execution.stepping import To

    if len(rest.split()) != 1:
        raise misused(_RUNTO, f"a line is expected, found '{rest}'")
    # breakpoints before that line stop it too
    pendant.run(To(line=stop_of(pendant.desk.analysis, rest)))


def _break(pendant: "Pendant", rest: str) -> None:
    word, _, more = rest.partition(" ")
    if not word:
        raise misused(_BREAK, "a line is expected")
    row, (keyword, _, condition) = stop_of(pendant.desk.analysis, word), more.strip().partition(" ")
    match keyword.lower():
        case "":
            pendant.set_break(row)
        case "if" if condition.strip():
            pendant.set_break(row, condition.strip())
        # off with more after it may be the start of a condition: refused below
        case "off" if not condition:
            pendant.clear_break(row)
            pendant.output.line(f"no breakpoint at {word}")
            return
        case _:
            raise misused(_BREAK, f"found '{rest}'")
    pendant.output.line(f"breakpoint at {word}: {pendant.row_text(row)}")


def _breaks(pendant: "Pendant", rest: str) -> None:
    if rest.lower() == "off":
        # all at once, since a forgotten breakpoint is found only by running into it
        pendant.breaks.clear()
    elif rest:
        raise misused(_BREAKS, f"found '{rest}'")
    # after off too, so that the answer shows what is left
    if not pendant.breaks:
        pendant.output.line("no breakpoints")
        return
    program, stops = pendant.desk.analysis.program, sorted(pendant.breaks.items())
    rows = tuple((name_of(program, row), pendant.row_text(row), stop.condition) for row, stop in stops)
    columns = (Column(heading="line", number=True), Column(heading="statement"), Column(heading="if"))
    pendant.output.table(Table(columns=columns, rows=rows))


def _watch(pendant: "Pendant", rest: str) -> None:
    from robolang.execution.watching import expression

    if rest.lower() == "off":
        pendant.watches = ()
        pendant.output.line("nothing is watched")
        return
    if rest:
        texts = values(rest, ",")
        # an error is found here, and not at each stop
        for text in texts:
            expression(text)
        pendant.watches = texts
    pendant.show_watches()


COMMANDS = (
    Command(
        word="step",
        form=_STEP,
        help="Run one statement; a CALL or GOSUB counts as one.",
        group=Group.RUN,
        do=_step,
        words=("into", "out"),
        more="step into stops in the SUB that is called, step out when the present call has come back.\n"
        "Each step ends at rest: moves that would blend stop at their points.",
    ),
    Command(
        word="runto",
        form=_RUNTO,
        help="Run to a line, and stop before it.",
        group=Group.RUN,
        do=_runto,
        offers=(Offer.LINE,),
    ),
    Command(
        word="break",
        form=_BREAK,
        help="Stop before a line whenever it is reached, or where a condition is true.",
        group=Group.RUN,
        do=_break,
        offers=(Offer.LINE,),
        words=("if", "off"),
    ),
    Command(
        word="breaks",
        form=_BREAKS,
        help="Show the breakpoints, or remove them all.",
        group=Group.RUN,
        do=_breaks,
        words=("off",),
    ),
    Command(
        word="watch",
        form=_WATCH,
        help="Show values after each stop.",
        group=Group.SHOW,
        do=_watch,
        offers=(Offer.VALUE,),
        words=("off",),
        more="watch X, P1.Z, TORQUE(2) shows these; TORQUE, ANGLE, RATE and LAG read an axis.",
    ),
)
