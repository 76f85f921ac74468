"""What the pages of a live view are shown of a run: small frames, and a status when it changes.

A frame is binary and little-endian: simulated time in s as float64, then float32, in this order:

==============  ======  ===================================================
``line``        1       line of the file that is carried out, 0: none
``q_link``      n       joints, rad or m
``q_cmd``       n       their command
``tau_sat``     n       torque of the motors at the joints, N m
``tool``        3       tool point in the world, m, from the true joints
``tool_error``  1       distance of the tool point from its command, m
``tool_speed``  1       mean speed of the tool point since the frame before, m/s
``moved``       7 m + 2 parts (x y z, quaternion w x y z) and pads, as ``Plant.moved``
==============  ======  ===================================================

About 180 bytes for six joints and two parts. Everything that is text is in the status, JSON. Both are made in the run's
thread between two cycles; nothing of the run is changed. The time is the start of the last tick, and the numbers are
those of its row in the log: a command is compared with the angles at the start of its tick, not with those a tick
later, by which the tool has gone on. Parts and pads are of the end of that tick.
"""

import json
import struct
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from robolang.execution.observer import Observer
from robolang.execution.result import StatementRun
from robolang.execution.session import Session
from robolang.view.exchange import Exchange
from robolang.view.live_notes import LiveNotes
from runtime.control.clock import wall_s
from runtime.control.controller import Controller
from runtime.core.faults import Alarm
from runtime.core.frames import Array
from runtime.core.linear import norm
from runtime.core.units import PERCENT

FRAME_S = 1.0 / 40.0
"""Wall time between two frames, s: less than between two that are sent, so that a new one is there in time."""


def layout(controller: Controller) -> list[tuple[str, int]]:
    """Return the names of a frame after its time, and how many numbers each has."""
    n = controller.spec.n
    counts = {"line": 1, "q_link": n, "q_cmd": n, "tau_sat": n, "tool": 3, "tool_error": 1, "tool_speed": 1}
    return [*counts.items(), ("moved", len(controller.plant.moved()))]


class Frames(Observer):
    """Makes frames and statuses of a session; ``follow`` says of which."""

    def __init__(self, exchange: Exchange) -> None:
        self._exchange = exchange
        self._session: Session | None = None
        self._notes = LiveNotes()
        self._due_s = float("-inf")
        self.extra: Callable[[], Mapping[str, Any]] = dict
        """What whoever drives the run adds to its status."""

    def follow(self, session: Session) -> None:
        """Show this session from now on."""
        self._session, self._notes = session, LiveNotes()
        # of another session: no time has passed since, so nothing has moved
        start = _Tick.last(session.controller)
        self._shown = _Shown(time_us=start.time_us, q=start.q_link, X=np.eye(4), p=np.zeros(3))
        self.show()

    def stop(self) -> None:
        """Show nothing more: the session goes on without pages."""
        self._session = None

    def run_began(self, run: StatementRun, time_us: int) -> None:
        """Show the statement that begins."""
        origin = run.origin
        row = {"line": origin.line or None, "number": origin.number, "text": run.text, "start_s": time_us * 1e-6}
        self._exchange.begin(row)

    def cycle_done(self, time_us: int) -> None:
        """Show the cycle that has been run, if the last one that was shown is old enough."""
        now = wall_s()
        if now >= self._due_s:
            # from now on, and not from when it was due: what was missed is not caught up with
            self._due_s = now + FRAME_S
            self.show()

    def printed(self, text: str) -> None:
        """Show a line of PRINT."""
        self._exchange.say(text)

    def show(self) -> None:
        """Show where the run stands now."""
        session = self._session
        if session is not None:
            self._exchange.show_frame(self._frame(session.controller))
            self._exchange.show_status(json.dumps({**status_of(session), **self.extra()}, separators=(",", ":")))
            notes = self._notes.news(session)
            if notes is not None:
                self._exchange.show_notes([asdict(note) for note in notes])

    def _frame(self, controller: Controller) -> bytes:
        tick = _Tick.last(controller)
        # one call for both postures: it is the larger part of the cost of a frame
        tool, command = controller.tool_poses(np.stack([tick.q_link, tick.q_cmd]))[:, :3, 3]
        speed = self._speed(controller, tick, tool)
        line = 0 if controller.statement is None else controller.statement.line
        moved = controller.plant.moved()
        numbers = ([line], tick.q_link, tick.q_cmd, tick.torque, tool, [norm(command - tool), speed], moved)
        return struct.pack("<d", tick.time_us * 1e-6) + np.concatenate(numbers).astype("<f4").tobytes()

    def _speed(self, controller: Controller, tick: "_Tick", tool: Array) -> float:
        """Return the mean speed of the tool point (3,) since the frame before, m/s."""
        before, self._shown = (
            self._shown,
            _Shown(time_us=tick.time_us, q=tick.q_link, X=controller.X_flange_tool, p=tool),
        )
        passed_s = (tick.time_us - before.time_us) * 1e-6
        # the arm stands, or the prompt has taken it back
        if not passed_s > 0.0:
            return 0.0
        same = np.array_equal(before.X, controller.X_flange_tool)
        # another tool is elsewhere, and has not moved from where the one before was
        place = before.p if same else controller.tool_poses(before.q[None])[0, :3, 3]
        return norm(tool - place) / passed_s


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Shown:
    """What was shown last: the time us, joints ``q`` (n,), tool ``X`` (4, 4) and where its point was, ``p`` (3,) m."""

    time_us: int
    q: Array
    X: Array
    p: Array


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Tick:
    """The last tick of a run: its start us, and (n,) true joints, command and torque of it."""

    time_us: int
    q_link: Array
    q_cmd: Array
    torque: Array

    @classmethod
    def last(cls, controller: Controller) -> "_Tick":
        rows = controller.recorder.latest()
        if not rows.ticks:
            q, n = np.array(controller.plant.q_link), controller.spec.n
            return cls(time_us=0, q_link=q, q_cmd=np.array(controller.servo.q_ref), torque=np.zeros(n))
        at = rows.ticks - 1
        q, command, torque = (rows.read(name, at, at + 1)[0] for name in ("q_link", "q_cmd", "tau_sat"))
        return cls(time_us=at * rows.tick_us, q_link=q, q_cmd=command, torque=torque)


def status_of(session: Session) -> dict[str, Any]:
    """Return what pages show of a session in words: where it stands, what stopped it, its signals."""
    executor, controller = session.executor, session.controller
    status, world = executor.status, executor.world
    signals, now_us = world.signals, executor.time_us
    due, ended = executor.origin, executor.is_over
    return {
        "state": status.state.value,
        "over": ended,
        # a statement that was typed is in no line of the file
        "next": executor.interrupted_line if ended else None if due is None else due.line or None,
        "alarm": None if status.alarm is None else _alarm(status.alarm),
        "fault": None if status.fault is None else f"{status.fault.code} {status.fault.message}",
        "can_continue": executor.interrupted,
        "mode": "AUTO" if controller.speed_cap is None else "MANUAL",
        "override": controller.override / PERCENT,
        "holding": controller.plant.hand().holding,
        "inputs": [
            [number, signals.input(number, now_us), number in signals.forced]
            for number in sorted(session.project.cell.inputs)
        ],
        "outputs": [[number, signals.output(number, now_us)] for number in signals.outputs],
    }


def _alarm(alarm: Alarm) -> dict[str, Any]:
    return {
        "code": alarm.code,
        "message": alarm.message,
        "hint": alarm.hint,
        "line": None if alarm.statement is None else alarm.statement.line or None,
    }
