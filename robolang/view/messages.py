"""What a page may send: one JSON object, checked for its kind, its keys, and the type and range of every value.

::

    {"do": "jog", "id": 7, "axis": "X", "sign": -1, "frame": "tool", "speed": 25, "step": null}

``id`` counts up in a page and is repeated in the reply. Nothing of a message is evaluated, and nothing is taken over
that is not named here: a message with one more key is refused (RBL835).
"""

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias, cast

import robolang.core.codes  # noqa: F401 - the codes raised here must be registered
from robolang.teaching.jogging import DIRECTIONS, FARTHEST, FASTEST, FRAMES, LEAST, SLOWEST, JogFrame
from runtime.core.faults import Fault
from runtime.core.limits import INPUT

LARGEST = 4096
"""Longest message of a page, bytes."""

WORDS = ("start", "pause", "step", "stop", "reset", "restart", "end", "take", "give")
"""Commands without values. ``take`` and ``give``: control over the arm; ``end``: of ``robolang view``."""

MOST_AXES = 7
LONGEST_NAME = 64
SLOWEST_OVERRIDE = 1.0
SLOWEST_PACE, FASTEST_PACE = 0.05, 20.0
"""Simulated seconds in one of wall time."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Go:
    """A command without values, one of ``WORDS``."""

    word: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Override:
    """The share of all speeds, %, of moves that begin from now on."""

    percent: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Pacing:
    """How many simulated seconds pass in one of wall time."""

    factor: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Input:
    """An input that is held in a state; None: the cell file decides again."""

    number: int
    state: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class Jog:
    """A jog button that is pressed: as far as it goes, or by one ``step``, mm or deg, while it is held."""

    axis: str
    sign: int
    frame: JogFrame
    speed: float
    step: float | None

    @property
    def amount(self) -> float:
        """The amount, mm or deg, with its sign; infinite without a step."""
        return self.sign * (math.inf if self.step is None else self.step)


@dataclass(frozen=True, slots=True, kw_only=True)
class Held:
    """A sign of the button of a jog: still held, or released."""

    jog: int
    released: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Teach:
    """A point to teach where the arm stands; ``kind`` None: as the prompt chooses it."""

    name: str
    kind: str | None
    replace: bool


Command: TypeAlias = Go | Override | Pacing | Input | Jog | Held | Teach


@dataclass(frozen=True, slots=True, kw_only=True)
class Message:
    """A command with its number in the page."""

    id: int
    command: Command


Check: TypeAlias = Callable[[Any], bool]


def _number(low: float, high: float) -> Check:
    # bool is an int in Python; NaN fails the comparison
    return lambda value: isinstance(value, int | float) and not isinstance(value, bool) and low <= value <= high


def _whole(low: int, high: int) -> Check:
    return lambda value: isinstance(value, int) and not isinstance(value, bool) and low <= value <= high


def _one_of(*values: object) -> Check:
    # type first: a list is not hashable, and True equals 1
    return lambda value: isinstance(value, str | int | None) and not isinstance(value, bool) and value in values


def _or_none(check: Check) -> Check:
    return lambda value: value is None or check(value)


def _text(longest: int) -> Check:
    return lambda value: isinstance(value, str) and 0 < len(value) <= longest


_ID = _whole(0, 2**53)
_AXES = (*(f"J{number}" for number in range(1, MOST_AXES + 1)), *DIRECTIONS)
_FIELDS: Mapping[str, Mapping[str, Check]] = {
    **{word: {} for word in WORDS},
    "override": {"percent": _number(SLOWEST_OVERRIDE, 100.0)},
    "pace": {"factor": _number(SLOWEST_PACE, FASTEST_PACE)},
    "input": {"number": _whole(int(INPUT.low), int(INPUT.high)), "state": _or_none(_number(-1e6, 1e6))},
    "jog": {
        "axis": _one_of(*_AXES),
        "sign": _one_of(-1, 1),
        "frame": _one_of(*FRAMES),
        "speed": _number(SLOWEST, FASTEST),
        "step": _or_none(_number(LEAST, FARTHEST)),
    },
    "alive": {"jog": _ID},
    "release": {"jog": _ID},
    "teach": {
        "name": _text(LONGEST_NAME),
        "kind": _one_of(None, "joints", "pose"),
        "replace": lambda value: isinstance(value, bool),
    },
}


def read_message(text: str | bytes) -> Message:
    """Return the command of a message; ``Fault`` RBL835."""
    # pages send text frames alone
    if isinstance(text, bytes):
        raise Fault("RBL835", "a message of bytes is no command")
    found = _object(text)
    word, number = found.pop("do", None), found.pop("id", None)
    if not isinstance(word, str) or word not in _FIELDS:
        raise Fault("RBL835", f"'do' is {_shown(word)} and names no command")
    if not _ID(number):
        raise Fault("RBL835", f"'id' is {_shown(number)} and no whole number from 0")
    checks = _FIELDS[word]
    # a key more is refused too: it would be a value that nobody has checked
    if found.keys() != checks.keys():
        raise Fault("RBL835", f"{word} has the keys {', '.join(checks) or '(none)'}, and no others")
    for key, check in checks.items():
        if not check(found[key]):
            raise Fault("RBL835", f"'{key}' of {word} is {_shown(found[key])}: another type, or out of range")
    return Message(id=cast(int, number), command=_command(word, found))


def _object(text: str) -> dict[str, Any]:
    try:
        found = json.loads(text)
    except (ValueError, RecursionError):  # thousands of brackets are within the longest message
        found = None
    if not isinstance(found, dict):
        raise Fault("RBL835", "the message is no JSON object")
    return found


def _command(word: str, values: Mapping[str, Any]) -> Command:
    match word:
        case "override":
            return Override(**values)
        case "pace":
            return Pacing(**values)
        case "input":
            return Input(**values)
        case "jog":
            return Jog(**values)
        case "alive" | "release":
            return Held(jog=values["jog"], released=word == "release")
        case "teach":
            return Teach(**values)
        case _:
            return Go(word=word)


def _shown(value: object) -> str:
    """Return a value of a page for a message: short, whatever it is."""
    # by repr: what a page sends may hold line ends and control characters
    text = repr(value)
    return text if len(text) <= 40 else f"{text[:40]}..."
