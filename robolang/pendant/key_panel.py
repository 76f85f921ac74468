"""What the key mode shows, as lines: armed or not, what the next press does, where the arm is, and the keys."""

import textwrap
from dataclasses import dataclass

from prompt_toolkit.formatted_text import StyleAndTextTuples

from robolang.pendant.status import ArmFacts, joined, row

KEYS = (
    "1 to 7 joint",
    "x y z direction",
    "a b c turn about X Y Z",
    "Left Right jog",
    "+ - step",
    "j w t u frame, f next frame",
    "< > speed",
    "e arm",
    "Esc Space stop",
    "q Enter leave",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class KeyFacts:
    """What keys do now: ``axis`` as ``J3`` or ``X``, ``step`` with its unit, ``frame``, ``speed`` in %.

    ``held``: a key is held. ``message``: what ended or limits the last jog.
    """

    armed: bool
    axis: str
    step: str
    frame: str
    speed: float
    held: bool = False
    message: str = ""


def panel(keys: KeyFacts, arm: ArmFacts | None, columns: int) -> list[StyleAndTextTuples]:
    """Return the lines of the key mode; none is wider than the screen."""
    armed = ("class:status.armed", " ARMED ") if keys.armed else ("class:status.alarm", " NOT ARMED: e arms ")
    head = [("class:heading", "KEYS"), armed, ("class:heading", f"{keys.axis} by {keys.step}")]
    head += [("", f"frame {keys.frame}"), ("", f"speed {keys.speed:g} %"), ("", "going on" if keys.held else "")]
    lines = joined(head, columns)
    if arm is not None:
        lines += joined(
            [
                ("", f"joints {row(arm.joints, 2)} deg"),
                ("", f"XYZ {row(arm.pose[:3], 2)} mm  R {row(arm.pose[3:], 2)} deg"),
                ("", f"limit {arm.limit}"),
                ("", f"singular {arm.singular}" if arm.singular else ""),
                ("", f"{arm.seconds:.3f} s"),
            ],
            columns,
        )
    for text in keys.message.split("\n") if keys.message else ():
        lines += [[("class:warning", piece)] for piece in textwrap.wrap(text, columns - 1)]
    return lines + joined([("class:unit", each) for each in KEYS], columns)
