"""Numbers given on the command line: lists such as ``--pose 600,0,400,0,180,0``, checked and located.

A value that an option cannot take is a usage error: exit code 2 and a message with RBL703, the option and, in a
list, which number it is (counted from 1). NaN and infinity are refused, and so is anything no robot can have.
Imports the standard library and typer only, so that ``robolang --help`` stays quick.
"""

import math
from typing import TYPE_CHECKING, NoReturn

from robolang.cli.errors import say_warning
from robolang.cli.output import echo
from robolang.cli.usage import OptionValueError
from runtime.core.numerals import number_in, why_none
from runtime.core.rounding import beside

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from runtime.core.frames import Array
    from runtime.robot.kinematics.opw import Geometry
    from runtime.robot.model.payload import Payload
    from runtime.robot.model.spec import RobotSpec

_OUTSIDE = "The result is calculated, but the arm cannot take this posture; give an angle in the range."
PAYLOAD = ("mass kg", "x mm", "y mm", "z mm")
MAX_ABS = 1e9
"""The largest number of an option: that of a number in a file (RBL604)."""


def numbers(text: str, *, option: str, names: tuple[str, ...]) -> tuple[float, ...]:
    """Return the comma-separated finite numbers of ``text``, one for each of ``names``; ``OptionValueError``."""
    parts = text.split(",")
    if len(parts) != len(names):
        given = "1 is" if len(parts) == 1 else f"{len(parts)} are"
        raise OptionValueError(option, f"{len(names)} numbers are needed ({', '.join(names)}), but {given} given")
    return tuple(
        _number(part.strip(), option, name, i) for i, (part, name) in enumerate(zip(parts, names, strict=True), start=1)
    )


def posture(text: str | None, spec: "RobotSpec") -> "Array":
    """Return joint angles (n,) rad of ``--joints``; without it zero, or the nearest angle in range."""
    import numpy as np

    if text is None:  # zero is outside the range of some joints, such as J4 of a Franka arm
        return np.clip(np.zeros(spec.n), spec.lower, spec.upper)
    names = tuple(f"J{i}" for i in range(1, spec.n + 1))
    return np.array(numbers(text, option="--joints", names=names)) * spec.units


def outside(q: "Array", arm: "Geometry") -> "Iterator[tuple[int, str]]":
    """Yield each joint (0-based) whose angle in q (n,) rad is outside its range, and a sentence about it, in deg."""
    from runtime.robot.model.drives import RANGE_ROUNDING

    for joint, (angle, low, high) in enumerate(zip(q, arm.lower, arm.upper, strict=True)):
        kind = arm.axes[joint].kind
        # the rounding that points and JOINT(...) are granted: an angle that check accepts is accepted here
        if not low - RANGE_ROUNDING <= angle <= high + RANGE_ROUNDING:
            shown, least, most = beside(angle / kind.size, low / kind.size, high / kind.size)
            unit = kind.unit
            yield joint, f"J{joint + 1} at {shown} {unit} is outside its range of {least} to {most} {unit}"


def warn_outside(q: "Array", arm: "Geometry") -> None:
    """Print a warning for each angle of ``--joints`` outside its range (RBL309).

    It is calculated all the same: ``kin ik`` lists such postures, and ``kin fk`` must lead back from each of them.
    """
    for joint, sentence in outside(q, arm):
        say_warning("RBL309", f"--joints, number {joint + 1}", sentence, _OUTSIDE)


def payload(text: str, option: str, spec: "RobotSpec", *, heavier: bool = True) -> "Payload":
    """Return a payload of mass, kg, and centre of gravity, mm; ``heavier``: it may be over the rated one."""
    import numpy as np

    from runtime.core.faults import Fault
    from runtime.core.units import MM
    from runtime.robot.model.payload import declared

    mass, *cog = numbers(text, option=option, names=PAYLOAD)
    # an experiment may ask what an overload does; a LOAD may not, and the rule is that of LOAD
    try:
        return declared(mass, np.array(cog) * MM, max(spec.rated_payload, mass) if heavier else spec.rated_payload)
    except Fault as fault:
        raise OptionValueError(option, fault.message) from None


def check_plot(path: "Path | None") -> None:
    """Refuse a plot that is neither a picture nor a page; ``OptionValueError``."""
    if path is not None and path.suffix not in (".svg", ".html"):
        raise OptionValueError("--plot", f"'{path}' must end in .svg or .html")


def note_overload(carried: "Payload", option: str, spec: "RobotSpec") -> None:
    """Say that a payload is over the rated one; it is taken all the same, for this is the bench."""
    mass, rated = carried.mass, spec.rated_payload
    if not mass <= rated:
        shown, most = beside(mass, rated)
        echo(f"note: {option} {shown} kg exceeds the rated payload of {spec.name}, {most} kg", err=True)


def _number(text: str, option: str, name: str, position: int) -> float:
    def refuse(message: str) -> NoReturn:
        raise OptionValueError(option, f"{name} {message}", position)

    shown = text if len(text) <= 40 else f"{text[:37]}..."
    value = number_in(text)
    if value is None:
        refuse(f"is {shown!r}, not a number{why_none(text)}")
    if not math.isfinite(value):
        refuse(f"is {shown!r}, not a finite number")
    if not abs(value) <= MAX_ABS:
        far, most = beside(value, MAX_ABS)
        refuse(f"is {far}; the largest number allowed is {most}")
    return value
