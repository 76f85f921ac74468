"""Broken devices: encoders, drives, brakes and plants that go wrong at a given tick. The controller is not touched."""

import numpy as np

from robolang.execution.session import Session
from runtime.core.frames import Array


class Clocked:
    """Counts ticks of one device; ``on`` from tick ``at`` on, ``since`` ticks since then."""

    def __init__(self, axis: int, at: int) -> None:
        self.axis, self.at, self.tick = axis, at, -1

    @property
    def on(self) -> bool:
        return self.tick >= self.at


class BadEncoder(Clocked):
    """stuck: keeps a reading; jump: 2 deg off; sign: counts backwards; lost: every second sample; nan."""

    def __init__(self, good, kind: str, axis: int, at: int) -> None:
        super().__init__(axis, at)
        self.good, self.kind, self.kept = good, kind, 0.0
        self.resolution = good.resolution

    def read(self, q: Array, out: Array) -> None:
        self.good.read(q, out)
        self.tick += 1
        if self.tick < self.at:
            self.kept = out[self.axis]
            return
        if self.kind == "lost":
            if (self.tick - self.at) % 2:
                self.kept = out[self.axis]
            out[self.axis] = self.kept
            return
        true = out[self.axis]
        out[self.axis] = {
            "stuck": self.kept,
            "jump": true + np.radians(2.0),
            "sign": 2.0 * self.kept - true,
            "nan": np.nan,
        }[self.kind]


class BadPlant(Clocked):
    """The robot behind its drives: dead or half a drive, a brake that stays on, NaN as state."""

    def __init__(self, good, kind: str, axis: int, at: int) -> None:
        super().__init__(axis, at)
        self.good, self.kind, self.held = good, kind, 0.0

    def __getattr__(self, name: str):
        return getattr(self.good, name)

    def step(self, tau: Array) -> bool:
        self.tick += 1
        if not self.on:
            self.held = float(self.good.q[self.axis])
            return self.good.step(tau)
        tau, axis = np.array(tau), self.axis
        if self.kind in ("dead", "half"):
            tau[axis] *= {"dead": 0.0, "half": 0.5}[self.kind]
        elif self.kind == "brake":
            tau[axis] = -2e4 * (self.good.q[axis] - self.held) - 200.0 * self.good.dq[axis]
        elif self.kind == "nan state":
            self.poison()
        return self.good.step(tau)

    def poison(self) -> None:
        dq = self.good._qvel if hasattr(self.good, "_qvel") else self.good.dq
        dq[self.axis] = np.nan


class BadDrive(Clocked):
    """A drive whose torque becomes NaN."""

    def __init__(self, good, axis: int, at: int) -> None:
        super().__init__(axis, at)
        self.good, self.Ktn, self.i = good, good.Ktn, good.i

    def torque(self, command: Array, out: Array) -> None:
        self.tick += 1
        self.good.torque(command, out)
        if self.on:
            out[self.axis] = np.nan


def break_drive(session: Session, kind: str, axis: int, at: int) -> None:
    servo = session.controller.servo
    servo.motors = BadDrive(servo.motors, axis, at)


def break_encoder(session: Session, kind: str, axis: int, at: int) -> None:
    servo = session.controller.servo
    servo.encoders = BadEncoder(servo.encoders, kind, axis, at)


def break_plant(session: Session, kind: str, axis: int, at: int) -> None:
    session.controller.plant = BadPlant(session.controller.plant, kind, axis, at)


def break_hand_over(session: Session, what: str, axis: int, at: int) -> None:
    """Put NaN where one task hands a number to another, at the first interrupt from tick ``at`` on."""
    import dataclasses

    controller = session.controller
    send, moving = controller.drives.send, controller.requests.interpolator

    def poisoned(*recorded):
        if controller.recorder.tick >= at:
            areas = controller.areas
            if what == "plan row" and moving.busy:
                rows = np.array(moving._rows)
                rows[moving._n + 1 :, axis] = np.nan
                moving._rows = rows
            elif what == "INA":
                areas.ina = np.array(areas.ina)
                areas.ina[axis] = np.nan
            elif what in ("D", "T"):
                areas.ita[axis] = dataclasses.replace(areas.ita[axis], **{what: np.nan})
        return send(*recorded)

    controller.drives.send = poisoned
