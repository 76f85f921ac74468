"""Driving the real arm with exported pulse tables: the whole controller, with the tables in place of its planner.

What a PLC would send to the drives is integrated (``runtime.pulses.replay``) and written into INA, one set-point in
every interpolation cycle, between the rows of a table by its frequency. From there on everything is as in a run: fine
interpolation, servo, motors, plant, supervision. LOAD and HAND are carried out where the program has them, and after
each move the arm has to come into position before the next one starts.

The arm stands at the first angles of the export. Its command there is the one that holds it against its weight
(``Controller``), so it is led from that to the first set-point before the first move. Nothing is clipped and nothing
is planned: tables that ask too much of the arm end in an alarm of the supervision, and an alarm ends the drive.
"""

from collections.abc import Generator, Iterator
from dataclasses import dataclass, replace

import numpy as np

from robolang.execution.rig import Rig, fitted, plant_of
from robolang.execution.run_bounds import MAX_RUN_US
from robolang.experiments.excitation import quintic
from runtime.cell.cell import CellSpec
from runtime.core.faults import Alarm, Fault
from runtime.core.frames import Array, frozen
from runtime.core.linear import norm
from runtime.core.program_line import ProgramLine
from runtime.core.rounding import beside
from runtime.core.units import MM
from runtime.pulses.exported import Export, Load, Marker, Mechanism, Move
from runtime.pulses.replay import distances, joint_values, positions
from runtime.robot.model.payload import Payload, declared
from runtime.robot.model.spec import RobotSpec
from runtime.settings.profile import Profile

SAME = 1e-9
"""Largest difference in the poses of two arms that are the same, m and of a rotation."""
RAMP_S = 0.4
"""Time in which the command goes from the one that holds the arm to the first set-point, s."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DrivenMove(ProgramLine):
    """The result of a move: ``error_mm``, largest distance of the true tool point from the straight segment until the
    arm is in position; ``end_mm``, its distance from the end of it then; ``seconds`` until then.
    """

    text: str
    seconds: float
    error_mm: float
    end_mm: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Drive:
    """The result of an export: its ``moves`` until an alarm, the ``alarms`` that ended it, ``warnings`` that did not.

    ``seconds`` of simulated time; ``alarms`` and ``warnings`` have the tick at which they were raised (``tick_s``).
    """

    moves: tuple[DrivenMove, ...]
    alarms: tuple[Alarm, ...]
    warnings: tuple[Alarm, ...]
    seconds: float
    tick_s: float


@dataclass(slots=True, kw_only=True)
class _Run:
    """A move as it goes on."""

    move: Move
    first_tick: int
    end_tick: int = 0


def drive(export: Export, cell: CellSpec, profile: Profile, physics: bool = True) -> Drive:
    """Drive the arm of a cell through an export; without ``physics`` the ideal arm instead of MuJoCo.

    ``Fault`` before anything moves: RBL634 when the export is not for this robot and tool, RBL401 to RBL403 for a LOAD
    that it cannot carry, RBL509 when it would take too long. What goes wrong while moving is in ``Drive.alarms``.
    """
    start = start_angles(export, cell)
    if not export.seconds * 1e6 <= MAX_RUN_US:
        lasts, most = beside(export.seconds, MAX_RUN_US / 1e6, form=".0f")
        message = f"the tables last {lasts} s; {most} s are the longest run"
        raise Fault("RBL509", message, "Export the program in parts.")
    for item in export.sequence:
        if isinstance(item, Marker) and item.load is not None:
            _payload(item.load, cell)  # for its fault, which must come before anything moves
    return _Arm(export, replace(cell, home=start), profile, physics).run()


def start_angles(export: Export, cell: CellSpec) -> Array:
    """Return the joint angles (n,) rad at which an export starts; ``Fault`` RBL634 when it is not for this cell."""
    mechanism, robot = export.mechanism, cell.robot
    if mechanism.kind != "arm":
        raise Fault("RBL634", f"the tables are for a {mechanism.kind} mechanism; the cell has the arm {robot.name}")
    if len(mechanism.placements) != robot.n:
        raise Fault("RBL634", f"the tables are for {len(mechanism.placements)} axes; {robot.name} has {robot.n}")
    _check_kinds(mechanism, robot)
    pairs = [
        (f"the frame of J{k}", ours, axis.placement)
        for k, (ours, axis) in enumerate(zip(mechanism.placements, robot.axes, strict=True), start=1)
    ]
    pairs += [
        ("the flange", mechanism.X_last_flange, robot.X_last_flange),
        ("the tool", mechanism.X_flange_tool, cell.hand.X_flange_tool),
    ]
    for what, ours, theirs in pairs:
        off = float(np.abs(ours - theirs).max())
        if not off <= SAME:
            raise Fault(
                "RBL634", f"{what} differs from that of {robot.name} in this cell by {off:.3g} (m, or of a rotation)"
            )
    start = joint_values(export, np.array([channel.start_pulses for channel in export.channels]))
    for number, (q, axis) in enumerate(zip(start, robot.axes, strict=True), start=1):
        low, high, kind = axis.limits.lower, axis.limits.upper, axis.kind
        if not low <= q <= high:
            at, ends = kind.text(float(q), ".3f"), f"{low / kind.size:g} to {high / kind.size:g}"
            raise Fault("RBL634", f"J{number} starts at {at}; its range is {ends}")
    return frozen(start)


def _check_kinds(mechanism: Mechanism, robot: RobotSpec) -> None:
    """Refuse tables in which an axis turns that slides in the cell, or slides that turns there; ``Fault`` RBL634."""
    for k, axis in enumerate(robot.axes):
        if axis.kind.slides != (k in mechanism.sliding):
            does = "slides" if k in mechanism.sliding else "turns"
            raise Fault("RBL634", f"J{k + 1} of the tables {does}; J{k + 1} of {robot.name} {axis.kind.moves}")


def _payload(load: Load, cell: CellSpec) -> Payload:
    return declared(load.mass, load.cog, cell.robot.rated_payload)


class _Arm:
    """The controller over its plant, and the statement that it carries out."""

    def __init__(self, export: Export, cell: CellSpec, profile: Profile, physics: bool) -> None:
        profile = fitted(profile, physics)
        self._export, self._cell, self._profile = export, cell, profile
        self._controller = Rig.over(plant_of(cell, profile.tick_s, physics), cell, profile).controller
        self._runs: list[_Run] = []

    def run(self) -> Drive:
        """Carry out the whole sequence, until its end or an alarm."""
        controller = self._controller
        for item in self._export.sequence:
            controller.statement = ProgramLine(line=item.line, number=item.number)
            if isinstance(item, Move):
                # only before the first move: each of the others begins where the arm has come to rest
                if not self._runs and not self._cycles(self._approach(item)):
                    break
                done = self._cycles(self._move(item))
                self._runs[-1].end_tick = controller.recorder.tick
            elif item.load is not None:
                controller.load(_payload(item.load, self._cell))
                done = True
            else:
                done = self._cycles(self._hand(item))
            if not done:
                break
        return self._result()

    def _cycles(self, each: Iterator[None]) -> bool:
        """Run one cycle for every step of a statement; False once there is an alarm: nothing moves from then on."""
        return all(self._controller.cycle() and not self._controller.alarms for _ in each)

    def _approach(self, move: Move) -> Iterator[None]:
        """Lead the command from the one that holds the arm to the first set-point, and wait for the arm."""
        here, there = np.array(self._controller.areas.ina), joint_values(self._export, move.first)
        count = round(RAMP_S / self._profile.period_s)
        yield from self._send(here + quintic(np.arange(1, count + 1) / count)[:, None] * (there - here))
        yield from self._settle()

    def _move(self, move: Move) -> Iterator[None]:
        run = _Run(move=move, first_tick=self._controller.recorder.tick)
        self._runs.append(run)
        yield from self._send(set_points(self._export, move, self._profile.period_s))
        waited_s = yield from self._settle()
        if waited_s is not None:
            left = self._controller.spec.largest(self._controller.position_errors)
            self._controller.warn("RBL523", f"not in position: {left} left after {waited_s:g} s")

    def _hand(self, marker: Marker) -> Iterator[None]:
        self._controller.hand(marker.hand == "on")
        # as in a run: a dwell takes whole cycles, rounded up
        for _ in range(0, round(marker.dwell_s * 1e6), self._profile.period_us):
            yield

    def _send(self, rows: Array) -> Iterator[None]:
        # unchecked: tables that ask too much end in an alarm of the supervision, as on the real drives
        self._controller.play(rows, checked=False)
        for _ in rows:
            yield

    def _settle(self) -> Generator[None, None, float | None]:
        """Wait until the command rests and the arm is in position; returns the time, s, when it does not get there."""
        controller, profile = self._controller, self._profile
        while controller.moving:
            yield
        waited_us = 0
        while not controller.position_error <= profile.in_position:
            if waited_us >= profile.settle_timeout_us:
                return waited_us / 1e6
            waited_us += profile.period_us
            yield
        return None

    def _result(self) -> Drive:
        controller = self._controller
        log = controller.signals()
        tool = log["X_world_tool"][:, :3, 3]
        return Drive(
            moves=tuple(_driven(run, tool[run.first_tick : run.end_tick], self._profile.tick_s) for run in self._runs),
            alarms=tuple(controller.alarms),
            warnings=tuple(controller.warnings),
            seconds=controller.time_us / 1e6,
            tick_s=self._profile.tick_s,
        )


def set_points(export: Export, move: Move, period_s: float) -> Array:
    """Return the joint set-points (K, M) rad of a move, one for each interpolation cycle, the last one its end."""
    # less a share for rounding: tables of whole cycles must not get a set-point more
    count = int(np.ceil(move.steps * export.step_s / period_s - 1e-9))
    times = np.arange(1, count + 1, dtype=np.float64) * period_s
    return joint_values(export, positions(move, times))


def _driven(run: _Run, tool: Array, tick_s: float) -> DrivenMove:
    move = run.move
    return DrivenMove(
        line=move.line,
        number=move.number,
        text=move.text,
        seconds=len(tool) * tick_s,
        # an alarm before the first tick of a move leaves no row, and numpy refuses the largest of none
        error_mm=float(distances(tool, move.start, move.end).max(initial=0.0)) / MM,
        end_mm=norm(tool[-1] - move.end) / MM if len(tool) else 0.0,
    )
