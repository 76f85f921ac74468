"""The functions of the language, each said once: name, parameters with kinds, result and implementation.

The lexer, the checker, the evaluator, completion and the page of the language read this table; a row is all that a new
function needs. ``HERE``, ``TIMER`` and ``ERR`` are functions without parameters, written without parentheses.
"""

import math
from collections.abc import Callable
from types import MappingProxyType
from typing import Any, NamedTuple, Protocol

from robolang.values.kinds import Exactness, Kind
from robolang.values.poses import Frame, Place, Six, Value
from runtime.core.faults import Fault
from runtime.core.limits import INPUT
from runtime.core.numerals import number_in

MOST_DIGITS = 12
"""``ROUND`` rounds to at most so many digits: a float has 15 to 17, and further ones would be noise."""


class Robot(Protocol):
    """What a function can ask of the robot and its cell."""

    def input(self, number: int) -> float:
        """Return the state of an input; ``Fault`` RBL534 when the cell has no input of that number."""

    def seconds(self) -> float:
        """Return the time since the program began, s."""

    def here(self) -> Six:
        """Return the commanded pose of the tool, mm and deg in the world."""


class Context(Protocol):
    """What a function can ask of the program that calls it: ``frame`` is active, ``error`` is what ERR returns."""

    frame: Frame
    error: float

    @property
    def robot(self) -> Robot:
        """The robot that the program runs on."""

    def six(self, place: Place) -> Six:
        """Return the numbers of a place in the active frame."""


class Parameter(NamedTuple):
    """A parameter: up to ``times`` arguments of ``kind``; ``optional``: none is enough."""

    name: str
    kind: Kind = Kind.NUMBER
    optional: bool = False
    times: int = 1


class Function(NamedTuple):
    """A function of the language.

    ``apply`` computes the result from the arguments, whose kinds and number the evaluator has checked. ``exactness``
    gives that of the result from those of the arguments. ``changes``: the result may change while the robot moves, so
    motion ends before it is read. ``outside``: it depends on inputs, time or errors, so a check cannot know it.
    ``always``: it has a result whatever the arguments are.
    """

    name: str
    parameters: tuple[Parameter, ...]
    result: Kind
    help: str
    apply: Callable[..., Value]
    exactness: Callable[[list[Exactness]], Exactness]
    changes: bool = False
    outside: bool = False
    always: bool = False

    @property
    def least(self) -> int:
        """The fewest arguments that it takes."""
        return sum(not parameter.optional for parameter in self.parameters)

    @property
    def most(self) -> int:
        """The most arguments that it takes."""
        return sum(parameter.times for parameter in self.parameters)

    def kind(self, index: int) -> Kind:
        """Return the kind of an argument, counted from 0."""
        # the last parameter may be there several times: MIN(a, b, c, ...)
        return self.parameters[min(index, len(self.parameters) - 1)].kind

    @property
    def form(self) -> str:
        """How it is written, as in ``ROUND(x [, digits])``."""
        text = ""
        for parameter in self.parameters:
            shown = f"{', ' if text else ''}{parameter.name}{', ...' if parameter.times > 1 else ''}"
            text += f" [{shown}]" if parameter.optional else shown
        return f"{self.name}({text})" if self.parameters else self.name


# --- results ---------------------------------------------------------------------------------------------------------


def shown(value: float) -> str:
    """Return a number as PRINT and STR$ show it: up to ten digits, whole numbers without a point."""
    # + 0.0 makes 0 of -0
    return f"{value + 0.0:.10g}"


def finite(value: float, what: str) -> float:
    """Return a number; ``Fault`` RBL502 when it is not finite."""
    if not math.isfinite(value):
        raise Fault("RBL502", f"{what} has no finite result here")
    return value


def _sign(x: float) -> float:
    return float((x > 0.0) - (x < 0.0))


def _root(x: float) -> float:
    # negated, so that NaN is refused as well
    if not x >= 0.0:
        raise Fault("RBL502", f"SQR of {shown(x)} has no real result")
    return math.sqrt(x)


def _round(x: float, digits: float = 0.0) -> float:
    """Round half away from zero, as people do; ``round`` of Python rounds half to even."""
    # floor raises for NAN and INF, and the caller makes RBL502 of that
    scale = 10.0 ** max(-MOST_DIGITS, min(MOST_DIGITS, math.floor(digits)))
    return math.copysign(math.floor(abs(x) * scale + 0.5) / scale, x)


def _input(run: Context, number: float) -> float:
    return run.robot.input(int(INPUT.checked(number)))


def _pose(run: Context, *values: float) -> Place:
    x, y, z, rx, ry, rz = (finite(value, "POSE") for value in values)
    return Place(pose=(x, y, z, rx, ry, rz), frame=run.frame)


def _joint(run: Context, *values: float) -> Place:
    return Place(joints=tuple(finite(value, "JOINT") for value in values))


def _distance(run: Context, one: Place, other: Place) -> float:
    return math.dist(run.six(one)[:3], run.six(other)[:3])


def _number(run: Context, text: str) -> float:
    number = number_in(text.strip())
    if number is None:
        raise Fault("RBL502", f"VAL of '{text[:20]}': the text is not a number")
    return finite(number, "VAL")


# --- the table -------------------------------------------------------------------------------------------------------


def _exact(of: list[Exactness]) -> Exactness:
    return Exactness.EXACT


def _nearest(of: list[Exactness]) -> Exactness:
    return Exactness.NEAREST


def _rounded(of: list[Exactness]) -> Exactness:
    return Exactness.ROUNDED


def _as_arguments(of: list[Exactness]) -> Exactness:
    return max(of, default=Exactness.EXACT)


def _of_round(of: list[Exactness]) -> Exactness:
    # to whole numbers the result is exact; to digits it is a decimal fraction again
    return Exactness.EXACT if len(of) == 1 else Exactness.NEAREST


def _of_numbers(
    name: str,
    parameters: str,
    help: str,
    compute: Callable[..., float],
    exactness: Callable[[list[Exactness]], Exactness] = _rounded,
) -> Function:
    """Return a function of numbers alone; each of its parameters is needed."""

    def apply(run: Context, *arguments: float) -> float:
        try:
            result = float(compute(*arguments))
        # all of them become NaN, which is refused below: one code (RBL502) for whatever has no result
        except (ValueError, OverflowError):  # of NAN and INF, and beyond the largest float
            result = math.nan
        return finite(result, name)

    needed = tuple(map(Parameter, parameters.split()))
    return Function(name, needed, Kind.NUMBER, help, apply, exactness)


def _more(function: Function, name: str, times: int = 1) -> Function:
    """Return a function with one more parameter, which is optional."""
    return function._replace(parameters=(*function.parameters, Parameter(name, optional=True, times=times)))


def _special(name: str, takes: str, result: Kind, help: str, apply: Callable[..., Value], **more: Any) -> Function:
    """Return a function that takes other values than numbers, or reads something of the program or the robot.

    ``takes`` names the parameters; one that ends in $ is a text, one in capitals a pose.
    """
    kinds = {
        name: Kind.TEXT if name.endswith("$") else Kind.POSE if name.isupper() else Kind.NUMBER
        for name in takes.split()
    }
    return Function(
        name, tuple(map(Parameter, kinds, kinds.values())), result, help, apply, **{"exactness": _exact, **more}
    )


_TABLE = (
    _of_numbers("ABS", "x", "absolute value", abs, _as_arguments),
    _of_numbers("SGN", "x", "sign: -1, 0 or 1", _sign, _exact),
    _of_numbers("INT", "x", "largest whole number that is not above x", math.floor, _exact),
    _more(_of_numbers("ROUND", "x", "x rounded to digits, half away from zero", _round, _of_round), "digits"),
    _of_numbers("SQR", "x", "square root", _root),
    # not ``min`` itself, which takes a single argument for a sequence: MIN(3) is 3
    _more(_of_numbers("MIN", "x", "the smallest of the values", lambda *x: min(x), _as_arguments), "y", 99),
    _more(_of_numbers("MAX", "x", "the largest of the values", lambda *x: max(x), _as_arguments), "y", 99),
    _of_numbers("SIN", "x", "sine of an angle in degrees", lambda x: math.sin(math.radians(x))),
    _of_numbers("COS", "x", "cosine of an angle in degrees", lambda x: math.cos(math.radians(x))),
    _of_numbers("TAN", "x", "tangent of an angle in degrees", lambda x: math.tan(math.radians(x))),
    _of_numbers("ATN2", "y x", "angle of the point (x, y), degrees", lambda y, x: math.degrees(math.atan2(y, x))),
    _of_numbers("DEG", "x", "radians to degrees", math.degrees),
    _of_numbers("RAD", "x", "degrees to radians", math.radians),
    _special("STR$", "x", Kind.TEXT, "a number as text", lambda run, x: shown(x)),
    _special("VAL", "s$", Kind.NUMBER, "the number in a text", _number, exactness=_nearest),
    _special("LEN", "s$", Kind.NUMBER, "length of a text, characters", lambda run, text: float(len(text))),
    _special("IN", "n", Kind.NUMBER, "state of input n", _input, changes=True, outside=True, always=True),
    _special(
        "TIMER",
        "",
        Kind.NUMBER,
        "time since the program began, s",
        lambda run: run.robot.seconds(),
        exactness=_rounded,
        changes=True,
        outside=True,
        always=True,
    ),
    _special(
        "ERR", "", Kind.NUMBER, "number of the last caught error", lambda run: run.error, outside=True, always=True
    ),
    _special(
        "HERE",
        "",
        Kind.POSE,
        "commanded pose of the tool",
        lambda run: Place(pose=run.robot.here()),
        changes=True,
        always=True,
    ),
    _special("POSE", "x y z rx ry rz", Kind.POSE, "pose in the active frame, mm and degrees", _pose),
    _more(_special("JOINT", "j1 j2", Kind.POSE, "pose of these joint angles, degrees", _joint), "j3", 5),
    _special("DIST", "P Q", Kind.NUMBER, "distance of two poses, mm", _distance, exactness=_rounded, changes=True),
)

FUNCTIONS = MappingProxyType({function.name: function for function in _TABLE})
"""Every function of the language by its name."""
