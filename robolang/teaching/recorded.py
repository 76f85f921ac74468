"""What was done on a controller, as a program that does it again: no variables and no branches, values as numbers.

It is made from the record of a run and therefore follows it: what was taken back is not in it, and after a new start
nothing of the time before. A statement is written with the values that it had, so SPEED, ACCEL, TIME, ZONE and WRIST
are options of each move; OVERRIDE and FRAME are written where they change. A WAIT is the DELAY that it took, a move
that was stopped ends where the arm came to rest, and one that did not blend has no ZONE.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from robolang.execution import lowering
from robolang.execution.result import RunRecord, StatementRun
from robolang.interpreter.effects import (
    Effect,
    Halt,
    MoveTo,
    Pass,
    SetHand,
    SetOutput,
    SetPayload,
    SetSeam,
    SetTool,
    SetWrist,
    Show,
)
from robolang.project.points import Point
from robolang.syntax.ast import Approach, Delay
from robolang.values.poses import Frame, Place, Shift, Six
from runtime.core.frames import Array
from runtime.core.linear import matmul
from runtime.core.program_line import named

MOST_COMMENT = 80
"""Characters of a comment, so that a long expression does not hide the statement beside it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Recorded:
    """Lines of a program, each a statement with its comment, and the taught points that they name, as they were."""

    lines: tuple[str, ...]
    points: tuple[Point, ...]


def recorded(record: RunRecord, q_deg: Sequence[float]) -> Recorded:
    """Return what a record holds; ``q_deg`` (n,) is where the arm stands, for a move that has not ended."""
    writer = _Writer(record, tuple(q_deg))
    writer.write()
    return Recorded(lines=tuple(writer.lines), points=tuple(writer.points.values()))


class _Writer:
    """Writes statement after statement; ``frame``, ``override`` and ``wrist`` are in force at the end of the lines."""

    def __init__(self, record: RunRecord, q_deg: tuple[float, ...]) -> None:
        self._runs, self._q_deg = record.statements, q_deg
        self._cell, self._tick_us = record.project.cell, record.project.profile.tick_us
        self._period_s = record.project.profile.period_s
        self.lines: list[str] = []
        self.points: dict[str, Point] = {}
        self._frame: Frame = ""
        self._override = 100.0
        self._wrist = ""
        self._comment = ""

    def write(self) -> None:
        """Write all statements."""
        at = 0
        while at < len(self._runs):
            at = self._run(at)

    def _run(self, at: int) -> int:
        """Write a statement and those that were carried out within it; return the number of the next one."""
        run = self._runs[at]
        # a move of a chain that a stop has kept from beginning
        if not run.begun:
            return at + 1
        self._comment = _comment(run)
        match run.effect:
            case None | MoveTo():
                self._move(run)
            case Pass() | SetHand():
                return self._timed(at)
            case effect:
                statement = self._at_once(effect, run)
                if statement is not None:
                    self._add(statement)
        return at + 1

    def _add(self, statement: str) -> None:
        comment = self._comment.removesuffix(f": {statement}")
        self.lines.append(f"{statement}  ' {comment}".strip())

    # --- what takes time ----------------------------------------------------------------------------------------------

    def _timed(self, at: int) -> int:
        """Write a DELAY, a WAIT or a HAND in parts, between which statements were fed that interrupted it."""
        run = self._runs[at]
        end, now = max(run.first_tick, run.end_tick), run.first_tick
        follows, begun = at + 1, False
        while follows < len(self._runs) and self._runs[follows].first_tick < end:
            self._wait(run, self._runs[follows].first_tick - now, first=not begun)
            begun = True
            follows = self._run(follows)
            now = max(now, *(each.end_tick for each in self._runs[at + 1 : follows]))
            self._comment = _comment(run)
        self._wait(run, end - now, first=not begun)
        return follows

    def _wait(self, run: StatementRun, ticks: int, *, first: bool) -> None:
        seconds = ticks * self._tick_us / 1e6
        if first and isinstance(run.effect, SetHand):
            dwell = self._cell.hand.dwell if run.effect.dwell_s is None else run.effect.dwell_s
            self._add(f"HAND {'ON' if run.effect.closed else 'OFF'}, {self._seconds(dwell, seconds)}")
        elif ticks > 0:
            assert isinstance(run.effect, Pass | SetHand)
            given = run.effect.seconds if isinstance(run.effect, Pass) and isinstance(run.effect.node, Delay) else None
            self._add(f"DELAY {self._seconds(given, seconds)}")

    def _seconds(self, given: float | None, took: float) -> str:
        """Return the time that was given where it takes as many cycles, else the one that it took."""
        if given is not None and 0.0 <= took - given < self._period_s:
            return number(given)
        return number(took)

    # --- moves --------------------------------------------------------------------------------------------------------

    def _move(self, run: StatementRun) -> None:
        effect = run.effect
        rest = run.rest if run.ended else self._q_deg
        if effect is None:
            assert rest is not None
            self._given(run, rest)
            return
        assert isinstance(effect, MoveTo)
        if rest is not None:
            # neither the time nor the zone of the whole move is that of a part
            effect = replace(effect, target=Place(joints=rest), time_s=None, zone_mm=0.0)
            if not run.ended and effect.via:
                effect = replace(effect, path="line", via=())
        # effects have names in capitals
        names = {point.name.upper(): self._name(point) for point in run.points}
        # neither is an option of a move, and both end no blend
        self._scale(effect.override_pct)
        frame = next((frame for place in (*effect.via, effect.target) for frame in _frames(place)), self._frame)
        if frame != self._frame:
            self._frame = frame
            self._add(f"FRAME {self._of_cell(frame, self._cell.frames, 'WORLD')}")
        self._add(self._moving(effect, names) + self._options(effect))

    def _given(self, run: StatementRun, rest: tuple[float, ...]) -> None:
        """Write given set-points, such as a jog, as a move that takes their time."""
        self._scale(100.0)
        # one that was stopped took less than was planned
        took = (run.end_tick - run.first_tick) * self._tick_us / 1e6
        time = "" if run.planned_s is None or took <= 0.0 else f", TIME {number(min(run.planned_s, took))}"
        if run.path is None:
            self._add(f"MOVEJ {_call('JOINT', rest)}{time}")
        else:
            free = "" if self._wrist in ("", "WRIST AUTO") else ", WRIST AUTO"
            self._add(f"MOVE {_call('JOINT', rest)}{time}{free}")

    def _scale(self, override: float) -> None:
        if override != self._override:
            self._override = override
            self._add(f"OVERRIDE {number(override)}")

    def _moving(self, effect: MoveTo, names: Mapping[str, str]) -> str:
        """Return a move without its options."""
        target = effect.target
        if effect.path == "arc":
            return f"MOVEC {self._place(effect.via[0], names)}, {self._place(target, names)}"
        if effect.path == "spline":
            return f"SPLINE ({', '.join(self._place(place, names) for place in (*effect.via, target))})"
        # HERE in its place would end the motion before it, and with it a blend
        if target.last:
            return f"DEPART {number(-target.shifts[0].by[2])}"
        last = target.shifts[-1] if target.shifts else None
        if isinstance(effect.node, Approach) and last is not None and _backs(last):
            before = target.replaced(shifts=target.shifts[:-1])
            return f"APPROACH {self._place(before, names)}, {number(-last.by[2])}"
        return f"{'MOVEJ' if effect.path == 'joint' else 'MOVE'} {self._place(target, names)}"

    def _options(self, effect: MoveTo) -> str:
        joint = effect.path == "joint"
        values = {
            "SPEED": effect.speed_pct if joint else effect.speed_mm_s,
            "ACCEL": effect.accel_pct,
            "TIME": effect.time_s,
            "ZONE": effect.zone_mm or None,
        }
        text = "".join(f", {word} {_value(value)}" for word, value in values.items() if value is not None)
        wrist = "" if effect.wrist is None or joint else _wrist(effect.wrist, effect.held)
        return text if wrist in ("", self._wrist) else f"{text}, {wrist}"

    def _place(self, place: Place, names: Mapping[str, str]) -> str:
        if place.point:
            text = names.get(place.point, place.point)
        elif place.joints is not None:
            text = _call("JOINT", place.joints)
        else:
            assert place.pose is not None
            text = _call("POSE", place.pose)
        added = False
        for shift in place.shifts:
            if shift.kind == "tool":
                # of a sum the offset would be taken with its last operand
                by = shift.by if any(shift.by[3:]) else shift.by[:3]
                text, added = f"{f'({text})' if added else text} * {_vector(by)}", False
            else:
                text, added = f"{text} + {_vector(self._turned(shift))}", True
        return text

    def _turned(self, shift: Shift) -> Sequence[float]:
        """Return an offset along the axes of the frame in force."""
        if shift.frame == self._frame:
            return shift.by[:3]
        R_world_shift = lowering.frame_pose(shift.frame, self._cell)[:3, :3]
        R_world_frame = lowering.frame_pose(self._frame, self._cell)[:3, :3]
        by: Array = matmul(R_world_frame.T, matmul(R_world_shift, np.array(shift.by[:3])))
        return tuple(float(value) for value in by)

    def _name(self, point: Point) -> str:
        """Return the name of a taught point, a new one where it has been taught anew since it was first used."""
        name, count = point.name, 1
        while (known := self.points.get(name.upper())) is not None and not _same(known, point):
            count += 1
            name = f"{point.name}_{count}"
        self.points.setdefault(name.upper(), point.replaced(name=name))
        return self.points[name.upper()].name

    # --- what takes no time -------------------------------------------------------------------------------------------

    def _at_once(self, effect: Effect, run: StatementRun) -> str | None:
        """Return a statement that takes no time, "" for one that is a comment alone, None for one that is left out."""
        match effect:
            case SetPayload():
                return f"LOAD {self._load(effect)}"
            case SetTool():
                return f"TOOL {self._of_cell(effect.tool, self._cell.tools, 'FLANGE')}"
            case SetWrist():
                self._wrist = _wrist(effect.mode, effect.held)
                return self._wrist
            case SetSeam():
                sensor = effect.sensor
                return "SEAM OFF" if sensor is None else f"SEAM ON, {_spelled(sensor, self._cell.sensors)}"
            case SetOutput():
                return _output(effect)
            case Show():
                # what was shown at the prompt was for whoever was there
                return _print(effect.text) if run.origin.source is None else None
            case Halt():
                # a STOP would end the program, though more was done after it
                return "" if effect.word == "STOP" else effect.word
            case _:
                # what takes time has been written, and an end of motion is no statement
                return None

    def _load(self, effect: SetPayload) -> str:
        if effect.name:
            return _spelled(effect.name, self._cell.loads)
        inertia = f", {_vector(effect.inertia_kg_m2)}" if effect.inertia_kg_m2 else ""
        return f"{_vector(effect.cog_mm)}, {number(effect.mass_kg)}{inertia}"

    def _of_cell(self, frame: Frame, known: Mapping[str, object], nothing: str) -> str:
        if isinstance(frame, str):
            return _spelled(frame, known) if frame else nothing
        return _call("POSE", frame)


def number(value: float) -> str:
    """Return a number that reads back as the same."""
    # + 0.0 makes 0 of -0
    return repr(float(value) + 0.0).removesuffix(".0")


def _vector(values: Sequence[float]) -> str:
    return f"({', '.join(map(number, values))})"


def _call(word: str, values: Sequence[float] | Six) -> str:
    return word + _vector(values)


def _comment(run: StatementRun) -> str:
    where = named(run.origin.line, run.origin.number) if run.origin.source is None else run.origin.source.path
    text = run.text if len(run.text) <= MOST_COMMENT else f"{run.text[: MOST_COMMENT - 3]}..."
    return f"{where}: {text}"


def _frames(place: Place) -> Iterator[Frame]:
    """Yield the frames whose axes a place needs, the one in which its pose stands first."""
    if place.pose is not None:
        yield place.frame
    for shift in place.shifts:
        if shift.kind == "frame":
            yield shift.frame


def _backs(shift: Shift) -> bool:
    """Return whether a shift is that of APPROACH."""
    x, y, z, *turns = shift.by
    return shift.kind == "tool" and z <= 0.0 and not (x or y or any(turns))


def _same(one: Point, other: Point) -> bool:
    # its comment moves nothing
    return one.replaced(name="", comment="") == other.replaced(name="", comment="")


def _value(value: float) -> str:
    return "MAX" if math.isinf(value) else number(value)


def _wrist(mode: str, held: tuple[str, ...]) -> str:
    return f"WRIST HOLD {', '.join(held)}" if held else f"WRIST {mode.upper()}"


def _spelled(key: str, known: Mapping[str, object]) -> str:
    """Return a name of the cell as the cell file spells it."""
    return next((name for name in known if name.upper() == key), key)


def _output(effect: SetOutput) -> str:
    if effect.seconds is None:
        return f"OUT({effect.output}) = {number(effect.value)}"
    return f"PULSE {effect.output}, {number(effect.seconds)}"


def _print(text: str) -> str:
    return 'PRINT "' + text.replace('"', '""') + '"'
