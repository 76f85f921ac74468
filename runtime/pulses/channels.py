"""Pulse channels: the joint that each positions, the turn or stroke of one pulse, and the frequencies of the channel.

::

    schema = 1
    mechanism = "cylindrical"        # built-in, or a mechanism file beside this one; without it: the cell's robot
    [[channels]]                     # one for each joint of the machine, in any order
    joint = "theta"
    pulse_deg = 0.0036               # or pulse_mm; default: the mechanism's, or a motor of 2000 pulses a turn
    min_hz = 191                     # optional: lowest frequency that is not standstill
    max_hz = 100000                  # optional
    output = "pulse-direction"       # or "cw-ccw", "pulse-direction-inverted": how a PLC puts out the direction

Positions are counted from joint value zero. Read once by the export (docs/pulses.md).
"""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

from runtime.core.rounding import beside
from runtime.core.tomlfile import Table, inside, load_table, read_source
from runtime.core.units import DEG, MM
from runtime.pulses.machine import Joint

SCHEMA = 1
MIN_HZ, MAX_HZ = 191.0, 100_000.0
"""Default frequencies of a channel, Hz: those of the PLC whose tables ``panasonic_f174`` writes."""
PULSES_PER_TURN = 2000
"""Default pulses of one turn of a motor: a stepper of 1.8 deg in tenths of a step."""
MOST_HZ = 1e7
"""No pulse output is faster, Hz."""

Output = Literal["pulse-direction", "pulse-direction-inverted", "cw-ccw"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Channel:
    """The channel of ``joint``: ``pulse`` rad or m per pulse, frequencies Hz."""

    joint: Joint
    pulse: float
    min_hz: float = MIN_HZ
    max_hz: float = MAX_HZ
    output: Output = "pulse-direction"

    @property
    def unit(self) -> tuple[str, float]:
        """Name of the unit of this joint in files and tables, and its size in SI."""
        return ("deg", DEG) if self.joint.rotary else ("mm", MM)


@dataclass(frozen=True, slots=True, kw_only=True)
class ChannelFile:
    """A channel file: ``mechanism`` as named ("": none), and its rows, to be matched with the joints of a machine."""

    table: Table
    mechanism: str
    rows: tuple[Table, ...]

    def mechanism_path(self) -> Path:
        """Return the mechanism file that is named, beside this one; ``FileFault`` RBL602."""
        return inside(self.table, self.mechanism, Path(self.table.source.path).parent, "mechanism")


def read_channel_file(path: Path) -> ChannelFile:
    """Read a channel file; ``FileFault`` RBL6xx."""
    table = load_table(read_source(path))
    if table.integer("schema", low=0, high=10**6) != SCHEMA:
        table.fail("RBL605", f"'schema' must be {SCHEMA}", key="schema")
    found = ChannelFile(table=table, mechanism=table.text("mechanism", ""), rows=tuple(table.tables("channels")))
    table.done()
    return found


def default_channels(joints: tuple[Joint, ...], pulses: tuple[float, ...], min_hz: float | None) -> tuple[Channel, ...]:
    """Return channels of a machine whose ``pulses`` are rad or m each; ``min_hz``: in place of the default."""
    low = MIN_HZ if min_hz is None else min_hz
    return tuple(Channel(joint=joint, pulse=pulse, min_hz=low) for joint, pulse in zip(joints, pulses, strict=True))


def channels_of(
    file: ChannelFile, joints: tuple[Joint, ...], pulses: tuple[float, ...], name: str, min_hz: float | None
) -> tuple[Channel, ...]:
    """Return the channels of machine ``name`` in the order of its ``joints``; ``FileFault`` RBL608 or RBL610.

    A ``min_hz`` from the command line replaces those of the file.
    """
    # by name, since a file may have the channels in the order of the wiring
    known = {joint.name: (joint, pulse) for joint, pulse in zip(joints, pulses, strict=True)}
    found: dict[str, Channel] = {}
    for row in file.rows:
        joint = row.text("joint", choices=tuple(known))
        if joint in found:
            row.fail("RBL610", f"joint '{joint}' has two channels", key="joint")
        found[joint] = _channel(row, *known[joint], min_hz)
    for joint in known:
        if joint not in found:
            last = file.rows[-1] if file.rows else file.table
            hint = f"add [[channels]] with joint = '{joint}'"
            last.fail("RBL608", f"joint '{joint}' of the {name} has no channel", hint)
    return tuple(found[joint] for joint in known)


def _channel(row: Table, joint: Joint, pulse: float, min_hz: float | None) -> Channel:
    unit, scale, other = ("deg", DEG, "mm") if joint.rotary else ("mm", MM, "deg")
    if f"pulse_{other}" in row:
        does = "turns" if joint.rotary else "slides"
        row.fail("RBL613", f"'{joint.name}' {does}: give pulse_{unit}", key=f"pulse_{other}")
    channel = Channel(
        joint=joint,
        pulse=row.number(f"pulse_{unit}", pulse / scale, low=1e-9, high=1e3) * scale,
        min_hz=row.number("min_hz", MIN_HZ, low=1.0, high=MOST_HZ) if min_hz is None else min_hz,
        max_hz=row.number("max_hz", MAX_HZ, low=1.0, high=MOST_HZ),
        output=row.text("output", "pulse-direction", choices=get_args(Output)),  # type: ignore[arg-type]
    )
    row.ask("min_hz")  # a known key also where the command line replaces it
    row.done()
    # S06 gives carried pulses back in steps of 2 dP_min: without one in the range of the channel it never could
    if not channel.max_hz >= 2.0 * channel.min_hz:
        most, least = beside(channel.max_hz, 2.0 * channel.min_hz)
        row.fail(
            "RBL605",
            f"'max_hz' of '{joint.name}' is {most} and must be at least {least}, twice min_hz",
            key="max_hz" if "max_hz" in row else "joint",
        )
    return channel


def motor_pulse(gear_ratio: float) -> float:
    """Return rad (m of a joint that slides) per pulse of its motor, by ``PULSES_PER_TURN`` and the gear ratio."""
    return 2.0 * math.pi / (PULSES_PER_TURN * abs(gear_ratio))
