"""The lines at the bottom of the screen: what somebody at a pendant has to know before the next key.

The facts are gathered once after each command (``facts``); painting them computes nothing. Each is a word or a number
with its unit, so that nothing is in a colour alone.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from prompt_toolkit.formatted_text import StyleAndTextTuples

MOST_LINES = 3
_GAP = "  "
_LEAST = 16
"""Columns that are enough for a part of a statement."""
_MARKED = {"alarm": "class:status.alarm", "armed": "class:status.armed", "mode": "class:status.mode"}


@dataclass(frozen=True, slots=True, kw_only=True)
class ArmFacts:
    """The arm: lengths mm, angles deg, masses kg. ``pose`` is of the tool in ``frame``; ``felt_kg`` None: not known.

    ``limit`` is the nearest end of a joint range, as ``J3 12.3 deg``, ``singular`` the nearest singular posture.
    """

    frame: str
    tool: str
    declared_kg: float
    felt_kg: float | None
    joints: tuple[float, ...]
    pose: tuple[float, ...]
    limit: str
    singular: str
    holding: str
    seconds: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Facts:
    """What is shown. ``arm`` None: the controller is not ready, and ``starting`` says why.

    ``place``: where the program stands; ``program``: the name of its file.
    """

    mode: str
    armed: bool
    program: str
    unsaved: bool
    place: str = ""
    alarm: str = ""
    starting: str = ""
    arm: ArmFacts | None = None


@dataclass(frozen=True, slots=True)
class _Item:
    """A fact: with its full name, and short for a narrow screen."""

    full: str
    short: str
    style: str = ""


def status_lines(facts: Facts, columns: int) -> list[StyleAndTextTuples]:
    """Return two or three lines, more only where a screen is so narrow that facts would be lost otherwise."""
    items = list(_items(facts))
    lines = joined([(item.style, item.full) for item in items], columns)
    if len(lines) > MOST_LINES:
        lines = joined([(item.style, item.short) for item in items], columns)
    return lines


def joined(items: list[tuple[str, str]], columns: int) -> list[StyleAndTextTuples]:
    """Return items, style and text, in as many lines as they need; only the last one is cut to what is left."""
    lines: list[StyleAndTextTuples] = [[]]
    used = 0
    items = [(style, text) for style, text in items if text]
    for at, (style, text) in enumerate(items):
        left = columns - used - len(_GAP) * bool(used)
        if at == len(items) - 1 and left >= _LEAST:
            text = text if len(text) <= left else f"{text[: left - 1]}…"
        if used and len(text) > left:
            lines.append([])
            used = 0
        if used:
            lines[-1].append(("", _GAP))
            used += len(_GAP)
        lines[-1].append((style, text[:columns]))
        used += len(text)
    return lines


def _items(facts: Facts) -> Iterator[_Item]:
    if facts.alarm:
        yield _Item(f"ALARM {facts.alarm}: reset acknowledges it", f"ALARM {facts.alarm}", _MARKED["alarm"])
    yield _Item(facts.mode, facts.mode, _MARKED["mode"])
    if facts.armed:
        yield _Item("ARMED", "ARMED", _MARKED["armed"])
    else:
        yield _Item("not armed", "not armed")
    if facts.starting:
        yield _Item(facts.starting, facts.starting)
    if facts.arm is not None:
        yield from _of_arm(facts.arm)
    if facts.unsaved:
        yield _Item("(unsaved)", "(unsaved)")
    # the last one may be cut
    place = f"{facts.program}: {facts.place}" if facts.place else facts.program
    yield _Item(place, place)


def _of_arm(arm: ArmFacts) -> Iterator[_Item]:
    yield _Item(f"frame {arm.frame}", f"frame {arm.frame}")
    yield _Item(f"tool {arm.tool}", f"tool {arm.tool}")
    felt = "" if arm.felt_kg is None else f", felt {arm.felt_kg:.2f}"
    yield _Item(f"load {arm.declared_kg:g} kg{felt}", f"load {arm.declared_kg:g}{felt} kg")
    if arm.holding:
        yield _Item(f"holding {arm.holding}", f"holds {arm.holding}")
    yield _Item(f"{arm.seconds:.3f} s", f"{arm.seconds:.3f} s")
    yield _Item(f"joints {row(arm.joints, 3)} deg", f"J {row(arm.joints, 1)}")
    x, y, z, rx, ry, rz = row(arm.pose, 2).split(" ")
    yield _Item(
        f"X {x} Y {y} Z {z} mm RX {rx} RY {ry} RZ {rz} deg",
        f"XYZ {row(arm.pose[:3], 1)} R {row(arm.pose[3:], 1)}",
    )
    yield _Item(f"limit {arm.limit}", f"limit {arm.limit}")
    if arm.singular:
        yield _Item(f"singular {arm.singular}", arm.singular)


def row(values: tuple[float, ...], digits: int) -> str:
    """Return numbers with blanks between them."""
    # + 0.0 makes 0 of -0, also where rounding makes it
    return " ".join(f"{round(value, digits) + 0.0:.{digits}f}" for value in values)
