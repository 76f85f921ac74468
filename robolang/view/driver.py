"""Carries out what pages command, in the thread of the run, between two cycles.

One turn takes one command and runs one cycle, so a stop begins within 8 ms of the robot. Nothing waits for a page. A
jog is driven only while its button is held (``HeldButton``): in each cycle, not by a timer that could be late, and on
this thread, so that a server that hangs stops it as well.

Without a page a run that is driven here is the run of ``Session.run``, to the byte.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any

from robolang.execution import lowering
from robolang.execution.regain import displacement
from robolang.execution.session import Session
from robolang.execution.status import ENDED, State, Status
from robolang.execution.stepping import StopsAt, over
from robolang.teaching.held_button import Press
from robolang.teaching.jog_remarks import cut_short, remarks
from robolang.teaching.jogging import JogRequest, JogSettings, axes_of, plan_jog, read_jog, sliding_of
from robolang.view.exchange import Exchange, Order
from robolang.view.frames import Frames
from robolang.view.messages import Go, Input, Jog, Override, Pacing, Teach
from robolang.view.pace import Pace
from robolang.view.page_teaching import PageTeaching
from runtime.control.clock import wall_s
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.units import PERCENT
from runtime.motion.speed_cap import MANUAL_SPEED
from runtime.robot.model.spec import RobotSpec

IDLE_S = 0.25
"""How long a command is waited for at a time while nothing moves, s."""


class Doing(Enum):
    """Why the arm moves."""

    NOTHING = "nothing"
    PROGRAM = "program"
    JOG = "jog"
    REGAIN = "return"


@dataclass(slots=True, kw_only=True)
class Jogged:
    """A jog that goes on: what was ordered, joints ``q`` (n,) at its start, and whether its page was too slow."""

    request: JogRequest
    q: Array
    late: bool = False


_STANDING = ENDED | {State.PAUSED}
Notes = tuple[str, ...]


class Driver:
    """Drives a session by the commands of an exchange.

    ``teaching`` None: a run that pages follow; they may pause, step and stop it, and nothing moves by hand. ``pace``
    None: cycles are run as fast as they can. A jog is never faster than wall time.
    """

    def __init__(
        self,
        session: Session,
        exchange: Exchange,
        frames: Frames,
        *,
        pace: Pace | None = None,
        teaching: PageTeaching | None = None,
    ) -> None:
        self._session, self._executor, self._exchange = session, session.executor, exchange
        self._frames, self._pace, self._teaching = frames, pace, teaching
        # what was begun here, and not what the executor does: a run that is followed begins by itself
        self._doing = Doing.NOTHING
        self._press: Press | None = None
        self._jogged: Jogged | None = None
        self._remark: str | None = None
        self._steps = False
        self._left = False
        self._words: dict[str, Callable[[], None]] = {
            "start": lambda: self._start(steps=False),
            "step": lambda: self._start(steps=True),
            "pause": self._pause,
            "stop": self._executor.stop,
            "reset": self._reset,
            "restart": self._restart,
            "end": self._end,
        }
        # before the first status is shown, so that a page never sees one without them
        frames.extra = self._facts
        frames.follow(session)

    def leave(self) -> None:
        """End ``work`` after the arm has come to rest; safe to call from a signal handler."""
        self._left = True
        self._exchange.wake()

    def run_through(self) -> None:
        """Run the program to its end; where a page pauses it, it stands until a page goes on, or a stop."""
        self.begin()
        while self.turn().state not in ENDED:
            pass
        self._frames.show()

    def begin(self) -> None:
        """Count the program as running: its first turn begins it."""
        self._doing = Doing.PROGRAM

    def work(self) -> None:
        """Stand before the first statement, and do what pages command until ``leave``."""
        self.come_to_first()
        while not (self.turn().state in _STANDING and self._left):
            pass

    # --- turns -------------------------------------------------------------------------------------------------------

    def turn(self) -> Status:
        """Take a command, run a cycle; wait where nothing is to be done."""
        order = self._exchange.take()
        if order is not None:
            self._answer(order)
        self._judge_button()
        # here and not in the handler of a signal, which may come in the middle of a cycle
        if self._left and self._doing is not Doing.NOTHING:
            self._executor.pause()
        status = self._executor.advance()
        if status.state not in _STANDING:
            if self._pace is not None:
                # the dead-man counts wall time: in 200 ms of it a jog must not move for seconds
                fastest = 1.0 if self._doing is Doing.JOG else math.inf
                self._pace.wait(self._session.project.profile.period_s, fastest)
        elif self._doing is not Doing.NOTHING:
            self._stood()
        elif not self._left:
            self._exchange.wait(IDLE_S)
        return status

    def _judge_button(self) -> None:
        """Bring a jog to rest whose button is no longer held."""
        press = self._press
        now_s = wall_s()
        if press is not None and not self._exchange.button.holds(press, now_s):
            # once: a second pause would be one of what comes after this jog
            self._press = None
            if self._jogged is not None:
                self._jogged.late = self._exchange.button.lapsed(press, now_s)
            self._executor.pause()

    def _stood(self) -> None:
        """Note that the arm has come to rest, and go on after the return to a path."""
        doing, self._doing, self._press = self._doing, Doing.NOTHING, None
        # what is stepped by hand next must not stop at the stops of this run
        self._executor.stops_before = None
        # stopped before its end: nothing of a motion by hand follows once its button is released
        stopped = self._executor.plays
        if stopped:
            self._executor.abandon()
        jogged, self._jogged = self._jogged, None
        if stopped and jogged is not None:
            self._remark = cut_short(
                jogged.request,
                displacement(self._executor.world, jogged.q, self._session.controller.areas.ina),
                late=jogged.late,
            )
        if doing is Doing.REGAIN and not stopped and self._executor.status.state is State.PAUSED:
            self._go_on()
        self._frames.show()

    # --- commands ----------------------------------------------------------------------------------------------------

    def _answer(self, order: Order) -> None:
        """Carry a command out and answer it; a refusal has changed nothing."""
        self._remark = None
        try:
            notes = self._carry_out(order)
        except Fault as fault:
            self._exchange.reply(order.page, order.id, fault)
        # the executor refuses what its state does not allow, such as an acknowledgement while the arm stops
        except RuntimeError as error:
            self._exchange.reply(order.page, order.id, Fault("RBL836", str(error)))
        else:
            self._exchange.reply(order.page, order.id, notes=notes)
        self._frames.show()

    def _carry_out(self, order: Order) -> Notes:
        match order.command:
            case Go(word=word):
                self._words[word]()
            case Override(percent=percent):
                self._session.controller.override = percent * PERCENT
            case Pacing(factor=factor):
                if self._pace is None:
                    raise Fault("RBL836", "this run keeps a time of its own")
                self._pace.factor = factor
            case Input(number=number, state=state):
                self._session.world.signals.force(number, state, self._executor.time_us)
            case Jog() as jog if order.press is not None:
                return self._jog(jog, order.press)
            case Teach() as teach:
                self._refuse_moving()
                return self._by_hand.teach(self._session, teach)
        return ()

    def _start(self, *, steps: bool) -> None:
        """Go on with what the program stands in: on its path, or with the statement that was interrupted."""
        executor = self._executor
        self._refuse_moving()
        self._refuse_latched()
        if executor.is_over and not executor.interrupted:
            raise Fault("RBL806", "the program has ended", "Restart puts it before its first statement.")
        controller, self._steps = self._session.controller, steps
        # AUTO, with the programmed speeds; the return to a path is slow by itself
        cap, controller.speed_cap = controller.speed_cap, None
        try:
            if self._returns():
                self._doing = Doing.REGAIN
            else:
                self._go_on()
        except Fault:
            controller.speed_cap = cap
            raise

    def _returns(self) -> bool:
        """Bring the arm back to where the program was left, where jogs have moved it; return whether it moves."""
        executor = self._executor
        return (executor.displaced or executor.strayed) is not None and executor.regain()

    def _go_on(self) -> None:
        executor = self._executor
        if executor.interrupted:
            executor.begin_again()
        executor.stops_before = StopsAt(executor, [over(executor)]) if self._steps else None
        self._session.controller.restart_clock()
        executor.resume()
        self._doing = Doing.PROGRAM

    def _pause(self) -> None:
        # a pause of what stands would hold the next motion before it begins
        if self._doing is not Doing.NOTHING:
            self._press = None
            self._executor.pause()

    def _reset(self) -> None:
        if self._executor.status.alarm is not None:
            self._executor.acknowledge()

    def _end(self) -> None:
        _ = self._by_hand
        self.leave()

    def _restart(self) -> None:
        _ = self._by_hand
        self._refuse_moving()
        self._refuse_latched()
        self._executor.restart()
        self._executor.resume()
        self.come_to_first()

    def come_to_first(self) -> None:
        """Let the program come to its first statement, and stand before it."""
        self._executor.stops_before = lambda due: True
        self._executor.advance()
        self._executor.stops_before = None
        self._frames.show()

    # --- by hand -----------------------------------------------------------------------------------------------------

    @property
    def _by_hand(self) -> PageTeaching:
        """What teaches points; ``Fault`` RBL836 in a run that pages only follow."""
        if self._teaching is None:
            raise Fault("RBL836", "a run that is followed is not moved by hand", "robolang view PROG does that.")
        return self._teaching

    def _jog(self, jog: Jog, press: Press) -> Notes:
        """Begin a jog: planned as a whole, and driven while its button is held."""
        controller, executor = self._session.controller, self._executor
        _ = self._by_hand
        self._refuse_moving()
        self._refuse_latched()
        request = _request(jog, controller.spec)
        # MANUAL from here on, until the program is started again: somebody stands beside the arm
        controller.speed_cap = MANUAL_SPEED
        settings = JogSettings(frame=jog.frame, speed=jog.speed)
        X_world_frame = lowering.frame_pose(executor.frame, self._session.project.cell)
        plan = plan_jog(controller, request, settings, X_world_frame)
        # planning takes its time, in which buttons are released
        now_s = wall_s()
        if not self._exchange.button.holds(press, now_s):
            late = self._exchange.button.lapsed(press, now_s)
            raise Fault("RBL836", "the page was too slow" if late else "the button was released before the arm moved")
        jogged = Jogged(request=request, q=controller.areas.ina.copy())
        executor.play(plan.rows, None, _text(jog))
        self._doing, self._press, self._jogged = Doing.JOG, press, jogged
        return remarks(request, plan)

    # --- what is refused ---------------------------------------------------------------------------------------------

    def _refuse_moving(self) -> None:
        if self._doing is not Doing.NOTHING:
            raise Fault("RBL836", "the program runs" if self._doing is Doing.PROGRAM else "the arm moves")

    def _refuse_latched(self) -> None:
        alarm = self._executor.status.alarm
        if alarm is not None:
            raise Fault("RBL804", f"{alarm.code} is latched: {alarm.message}", "Reset acknowledges the alarm.")

    def _facts(self) -> dict[str, Any]:
        """What pages show beside the state of the program."""
        return {
            "doing": self._doing.value,
            "pace": None if self._pace is None else self._pace.factor,
            "by_hand": self._teaching is not None,
            "remark": self._remark,
        }


def _text(jog: Jog) -> str:
    """Return a jog as the record names it."""
    sign = "+" if jog.sign > 0 else "-"
    return f"jog {jog.axis} {sign}{'' if jog.step is None else f'{jog.step:g}'}"


def _request(jog: Jog, robot: RobotSpec) -> JogRequest:
    """Return the jog of a button; ``Fault`` RBL720 for an axis that the arm lacks, RBL404 for the amount."""
    # a typed jog has the same bounds, so it is read by the same code
    if jog.step is not None:
        return read_jog(f"{jog.axis} {jog.amount:.10g}", robot.n, sliding_of(robot))
    if jog.axis not in axes_of(robot.n):
        raise Fault("RBL720", f"'{jog.axis}' is no axis of this arm")
    return JogRequest(axis=jog.axis, amount=jog.amount, slides=jog.axis in sliding_of(robot))
