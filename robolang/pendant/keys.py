"""Jogging by keys: one press is one step, a key that is held goes on, and the arm stops soon after its last repeat.

A jog is planned as a whole and driven cycle by cycle at the pace of wall time, since a person holds the key. The keys
are read in every cycle, so a stop begins within 8 ms. Nothing is queued. Keys move nothing until they are armed.
"""

import math
from contextlib import AbstractContextManager, contextmanager, suppress
from typing import TYPE_CHECKING

from prompt_toolkit.output import Output as Terminal

from robolang.pendant.facts import Gathering
from robolang.pendant.failure import Failure
from robolang.pendant.foreground import Foreground
from robolang.pendant.key_panel import KeyFacts, panel
from robolang.pendant.painting import Panel
from robolang.pendant.pendant import Pendant
from robolang.pendant.screen import TerminalOutput, safe_lines
from runtime.control.clock import wall_s
from runtime.core.faults import Fault

if TYPE_CHECKING:
    from collections.abc import Iterator

    from robolang.teaching.jogging import JogSettings

_DIRECTIONS = {"x": "X", "y": "Y", "z": "Z", "a": "RX", "b": "RY", "c": "RZ"}
_FRAMES = {"j": "joint", "w": "world", "t": "tool", "u": "user"}
_SIGNS = {"right": 1, "left": -1}
_SPEEDS = (1.0, 5.0, 10.0, 25.0, 50.0, 75.0, 100.0)
_LEAVING = frozenset({"q", "enter", "c-c", "c-d"})
_PAINTED_EACH_S = 0.1
_WAITS_S = 0.5
"""How long a key is waited for before the screen is painted again."""


class KeyMode:
    """The keys of a pendant. ``run`` returns when they are left; the settings stay, and the keys are disarmed."""

    def __init__(self, pendant: Pendant, output: TerminalOutput, terminal: Terminal, gathering: Gathering) -> None:
        self._pendant, self._output, self._gathering = pendant, output, gathering
        self._panel = Panel(terminal)
        self._axis = "J1"
        self._message = ""
        self._left = False
        self._painted_s = self._cycle_s = float("-inf")

    def run(self) -> None:
        """Let keys jog the arm until they are left, or the terminal has gone."""
        from robolang.teaching.dead_man import DeadMan

        self._dead_man, self._left = DeadMan(), False
        self._pendant.to_manual()
        interrupts = self._interrupts
        with interrupts.keyboard.direct(), self._output.diverted(self._show), self._watching(), _left_by_ctrl_c():
            while not interrupts.lost and not self._is_left():
                self._paint()
                interrupts.keyboard.wait(_WAITS_S)
        # a key that is pressed after a break must not find the arm armed
        self._pendant.armed = False
        self._panel.clear()

    def _is_left(self) -> bool:
        """Do what the keys pressed meanwhile mean; return whether one of them leaves."""
        pressed = self._interrupts.keyboard.pressed()
        if self._interrupts.keyboard.closed:
            self._interrupts.hang_up()
        self._left |= not _LEAVING.isdisjoint(pressed)
        if not self._left:
            self._press(pressed)
        return self._left

    @property
    def _interrupts(self) -> Foreground:
        found = self._pendant.interrupts
        assert isinstance(found, Foreground)
        return found

    # --- keys while the arm stands ------------------------------------------------------------------------------------

    def _press(self, pressed: list[str]) -> None:
        """Do what keys mean. Of several that came together, one that moves comes last and only once."""
        moving = ""
        for key in pressed:
            if key in _SIGNS:
                moving = key
            elif key in ("escape", "space"):
                # pressed before, it forbids what was pressed with it
                moving = ""
                self._dead_man.stop()
                return
            else:
                self._choose(key)
        if moving:
            self._jog(moving)

    def _choose(self, key: str) -> None:
        joints = self._pendant.project.cell.robot.n
        if key in _DIRECTIONS:
            self._axis = _DIRECTIONS[key]
        elif key.isdigit() and 1 <= int(key) <= joints:
            self._axis = f"J{key}"
        elif key == "e":
            self._pendant.armed = not self._pendant.armed
            self._message = ""
        else:
            self._pendant.jog = self._set(self._pendant.jog, key)

    def _sliding(self) -> "frozenset[str]":
        from robolang.teaching.jogging import sliding_of

        return sliding_of(self._pendant.project.cell.robot)

    def _set(self, settings: "JogSettings", key: str) -> "JogSettings":
        """Return the settings after a key that changes them."""
        from robolang.teaching.jogging import is_linear

        if key in ("+", "-"):
            return settings.stepped(1 if key == "+" else -1, angular=not is_linear(self._axis, self._sliding()))
        if key in _FRAMES:
            return settings.with_frame(_FRAMES[key])
        if key == "f":
            return settings.next_frame()
        if key in ("<", ">"):
            return settings.with_speed(_beside(settings.speed, faster=key == ">"))
        return settings

    # --- jogs ---------------------------------------------------------------------------------------------------------

    def _jog(self, key: str) -> None:
        """Jog by a step, or as far as it goes while the key is held."""
        from robolang.teaching.dead_man import Act

        if not self._pendant.armed:
            self._message = "not armed: nothing moves; e arms the keys"
            return
        act = self._dead_man.press(key, wall_s(), moving=False)
        if act is Act.NOTHING:
            return
        self._message = ""
        try:
            self._move(_SIGNS[key], as_far=act is Act.GO_ON)
        except Failure as failure:
            self._show(failure.text)
        except Fault as fault:
            self._message = f"{fault.code} {fault.message}"
        finally:
            self._interrupts.stopped = False

    def _move(self, sign: int, *, as_far: bool) -> None:
        from robolang.teaching.jog_remarks import remarks
        from robolang.teaching.jogging import JogRequest

        pendant = self._pendant
        pendant.live.refuse_latched()
        amount = math.inf if as_far else pendant.jog.step(self._axis, self._sliding())
        request = JogRequest(axis=self._axis, amount=sign * amount, slides=self._axis in self._sliding())
        plan = pendant.plan_jog(request)
        if not self._is_still_meant(sign, as_far=as_far):
            return
        self._message = "\n".join(remarks(request, plan))
        self._cycle_s = wall_s()
        pendant.live.play(plan.rows, f"jog {request.axis} {request.amount:+g}")

    def _is_still_meant(self, sign: int, *, as_far: bool) -> bool:
        """Return whether a jog that has been planned is to begin: planning takes time, in which keys are released."""
        pressed = self._interrupts.keyboard.pressed()
        if any(_SIGNS.get(key) != sign for key in pressed):
            self._dead_man.stop()
            return False
        if pressed:
            self._dead_man.seen_s = wall_s()
        return not (as_far and self._dead_man.expired(wall_s()))

    @contextmanager
    def _watching(self) -> "Iterator[None]":
        """Judge the keys of the foreground by the dead-man while a jog runs."""
        interrupts = self._interrupts
        before = interrupts.watch, interrupts.judge
        interrupts.watch, interrupts.judge = self._wait_for_cycle, self._stops
        try:
            yield
        finally:
            interrupts.watch, interrupts.judge = before

    def _wait_for_cycle(self) -> None:
        """Wait until the next cycle is due by wall time, or a key is pressed."""
        self._cycle_s += self._pendant.live.project.profile.period_s
        now = wall_s()
        if self._cycle_s > now:
            self._interrupts.keyboard.wait(self._cycle_s - now)
        elif now - self._cycle_s > _PAINTED_EACH_S:
            self._cycle_s = now  # late: what is lost is not caught up with at speed
        if now - self._painted_s >= _PAINTED_EACH_S:
            self._paint()

    def _stops(self, pressed: list[str]) -> bool:
        """Return whether a jog that runs has to stop: by a key, or since its key is held no longer."""
        from robolang.teaching.dead_man import Act

        now = wall_s()
        # such a key stops as any other does, and then leaves
        self._left |= not _LEAVING.isdisjoint(pressed)
        acts = [self._dead_man.press(" " if key == "space" else key, now, moving=True) for key in pressed]
        if self._dead_man.expired(now):
            self._dead_man.stop()
            return True
        return Act.STOP in acts

    # --- the screen ---------------------------------------------------------------------------------------------------

    def _show(self, text: str) -> None:
        """Show a message of what was carried out, without its excerpts: nobody has typed what they are of."""
        self._message = "\n".join(line.strip() for line in safe_lines(text) if " | " not in line)

    def _paint(self) -> None:
        self._painted_s = wall_s()
        settings, axis = self._pendant.jog, self._axis
        sliding = self._sliding()
        unit = "mm" if axis in ("X", "Y", "Z") or axis in sliding else "deg"
        keys = KeyFacts(
            armed=self._pendant.armed,
            axis=axis,
            step=f"{settings.step(axis, sliding):g} {unit}",
            frame=settings.frame,
            speed=settings.speed,
            held=self._dead_man.continuous,
            message=self._message,
        )
        self._panel.show(panel(keys, self._gathering.facts().arm, self._output.columns))


def _left_by_ctrl_c() -> AbstractContextManager[None]:
    """Leave at Ctrl-C while nothing moves, as q does."""
    return suppress(KeyboardInterrupt)


def _beside(speed: float, *, faster: bool) -> float:
    """Return the next speed of the list."""
    others = [each for each in _SPEEDS if (each > speed if faster else each < speed)]
    return (min(others) if faster else max(others)) if others else speed
