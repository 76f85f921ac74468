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
thread from live arrays, between two cycles, so that they are of one instant; nothing of the run is changed.
"""

import json
import struct
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from robolang.execution.observer import Observer
from robolang.execution.result import StatementRun
from robolang.execution.session import Session
from robolang.view.exchange import Exchange
from runtime.control.clock import wall_s
from runtime.control.controller import Controller
from runtime.core.faults import Alarm
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
        self._due_s = float("-inf")
        self.extra: Callable[[], Mapping[str, Any]] = dict
        """What whoever drives the run adds to its status."""

    def follow(self, session: Session) -> None:
        """Show this session from now on."""
        # the tool of another session is elsewhere, and has not moved from there
        self._session = session
        self._tool, self._shown_us = np.zeros(3), session.controller.time_us
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

    def _frame(self, controller: Controller) -> bytes:
        n, plant, q_cmd = controller.spec.n, controller.plant, controller.servo.q_ref
        # one call for both postures: it is the larger part of the cost of a frame
        tool, command = controller.tool_poses(np.stack([plant.q_link, q_cmd]))[:, :3, 3]
        recent, statement, time_us = controller.recorder.recent(1), controller.statement, controller.time_us
        torque = recent[-1, n : 2 * n] if len(recent) else np.zeros(n)
        passed_s = (time_us - self._shown_us) * 1e-6
        # the arm stands, or the prompt has taken it back
        speed = norm(tool - self._tool) / passed_s if passed_s > 0.0 else 0.0
        self._tool, self._shown_us = tool, time_us
        line = 0 if statement is None else statement.line
        numbers = ([line], plant.q_link, q_cmd, torque, tool, [norm(command - tool), speed], plant.moved())
        return struct.pack("<d", time_us * 1e-6) + np.concatenate(numbers).astype("<f4").tobytes()


def status_of(session: Session) -> dict[str, Any]:
    """Return what pages show of a session in words: where it stands, what stopped it, its signals."""
    executor, controller = session.executor, session.controller
    status, world = executor.status, executor.world
    signals, now_us = world.signals, executor.time_us
    due = executor.origin
    return {
        "state": status.state.value,
        "over": executor.is_over,
        # a statement that was typed is in no line of the file
        "next": None if due is None or executor.is_over else due.line or None,
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
