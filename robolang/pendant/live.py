"""The live controller of a prompt: its session, and how long it is driven.

Simulated time passes only while something is carried out. Between two lines of the prompt the program is paused or
over, the arm is at rest, and statements can be fed.
"""

import math

import numpy as np

from robolang.core.diagnostics import Severity, render
from robolang.core.source import Source
from robolang.execution import lowering
from robolang.execution.alarms import as_diagnostic
from robolang.execution.alarms import failure as fault_of
from robolang.execution.engine import StopsBefore
from robolang.execution.executor import EDIT
from robolang.execution.lowering import Surroundings
from robolang.execution.observer import Observer, Observers
from robolang.execution.result import StatementRun
from robolang.execution.session import Session
from robolang.execution.status import State, Status
from robolang.execution.timeline import Mark, Timeline
from robolang.interpreter.adopting import Lines
from robolang.interpreter.effects import Origin
from robolang.pendant.arm import ArmView, view
from robolang.pendant.failure import failure, of_diagnostics
from robolang.pendant.interrupts import Interrupt, Interrupts
from robolang.pendant.output import Output
from robolang.pendant.reading import NAME
from robolang.project.project import Project
from robolang.syntax.ast import Line
from runtime.control.clock import wall_s
from runtime.control.controller import Controller
from runtime.core.faults import Fault
from runtime.core.frames import Array
from runtime.core.program_line import named
from runtime.motion.speed_cap import MANUAL_SPEED


class Watching(Observer):
    """Shows what a program prints and which statement runs."""

    def __init__(self, output: Output) -> None:
        self._output = output

    def run_began(self, run: StatementRun, time_us: int) -> None:
        """Show the statement that begins."""
        where = named(run.origin.line, run.origin.number) if run.origin.line else "prompt"
        self._output.progress(f"{time_us / 1e6:.3f} s  {where}  {run.text}")

    def printed(self, text: str) -> None:
        """Show a line of PRINT."""
        self._output.line(text)


_STANDING = frozenset({State.PAUSED, State.DONE, State.STOPPED, State.ALARM})


class Live:
    """A session at a prompt. ``drive`` is the only place where simulated time passes."""

    def __init__(
        self, project: Project, output: Output, interrupts: Interrupts, *, physics: bool, realtime: bool
    ) -> None:
        self.project = project
        self._output, self._interrupts = output, interrupts
        self.observers = Observers(Watching(output))
        """Who sees what happens; a picture of the arm may join them."""
        self.session = Session(project, physics=physics, realtime=realtime, observer=self.observers)
        self.executor = self.session.executor
        self._come_to_first()
        self.timeline = Timeline(self.executor)
        self._warned = 0
        self._named: set[str] = set()
        self.wall_s = 0.0
        """Wall time for which the arm was driven, s."""

    def _come_to_first(self) -> None:
        """Let the program come to its first statement, and stand before it."""
        self.executor.stops_before = lambda due: True
        self.executor.advance()
        self.executor.stops_before = None

    def restart(self) -> None:
        """Put the program before its first statement; the arm stays where it is."""
        # the names that were typed at the prompt stay: the first statements may read them
        self.executor.restart()
        self.executor.resume()
        self._come_to_first()

    def adopt(self, project: Project, lines: Lines) -> None:
        """Go on with an edited project; a program that had no statement begins with its first one."""
        # whoever types the first lines of a program wants to step it, and not to be shown that it is over
        had_none = not self.project.program.statements
        self.executor.adopt(project, lines)
        self.project = project
        if had_none and project.program.statements:
            self.restart()

    @property
    def controller(self) -> Controller:
        """The controller."""
        return self.session.controller

    @property
    def q(self) -> Array:
        """Commanded joint angles (n,) rad."""
        return np.array(self.controller.areas.ina)

    @property
    def around(self) -> Surroundings:
        """What a place depends on now."""
        return self.executor.world.around

    @property
    def arm(self) -> ArmView:
        """Where the arm is."""
        return view(self.project, self.controller, self.executor)

    @property
    def home(self) -> tuple[float, ...]:
        """The home position of the cell, deg, of an axis that slides mm."""
        cell = self.project.cell
        return tuple(float(value) for value in np.asarray(cell.home) / cell.robot.units)

    @property
    def seconds(self) -> float:
        """Simulated time, s."""
        return self.executor.status.time_us / 1e6

    @property
    def current(self) -> Line | None:
        """The line whose statement comes next or is held; None: the program is over, or what is held was typed."""
        if self.executor.is_over:
            return None
        # None before the first statement has begun
        origin = self.executor.origin
        lines = self.project.program.statements
        if origin is None:
            return next(iter(lines), None)
        # a typed statement has line 0, which is none of the program
        return next((line for line in lines if line.source_line == origin.line), None)

    def refuse_latched(self) -> None:
        """Raise ``Failure`` RBL804 while an alarm is latched: nothing moves before it is acknowledged."""
        alarm = self.executor.status.alarm
        if alarm is not None:
            raise failure("RBL804", f"{alarm.code} is latched: {alarm.message}")

    def feed(self, text: str) -> None:
        """Carry statements out where the program stands; ``Failure`` when one of them fails."""
        self.executor.feed(Source(NAME, text))
        self.drive()

    @property
    def X_world_frame(self) -> Array:
        """The FRAME in force (4, 4)."""
        frame, cell = self.executor.frame, self.project.cell
        return lowering.frame_pose(frame, cell)

    def play(self, rows: Array, text: str) -> None:
        """Send set-points (K, n) rad as a motion of its own; where it is stopped, its rest is dropped."""
        self.executor.play(rows, None, text)
        self.drive()
        self.drop()

    def weigh(self, rows: Array) -> Array | None:
        """Send the set-points of a weighing; return what the ticks recorded (N, 4 n), None when it was stopped."""
        # the LOAD in force may be wrong, which is why it is weighed: that must raise no alarm meanwhile
        controller = self.controller
        begun, controller.weighing = controller.recorder.tick, True
        try:
            self.executor.play(rows, None, "weigh")
            self.drive()
        finally:
            controller.weighing = False
        # stopped by a key: half of a motion weighs nothing
        if self.executor.plays:
            self.executor.abandon()
            return None
        return controller.recorder.recent(controller.recorder.tick - begun)

    def drop(self) -> None:
        """Forget what is left of a motion by hand that was stopped: nothing follows once a key is released."""
        if self.executor.plays:
            self.executor.abandon()

    def go_on(
        self, stops_before: StopsBefore | None = None, seconds: float = math.inf, *, typed: bool = False
    ) -> Status:
        """Let the program go on from where it stands until a statement that ``stops_before`` names, or its end.

        ``typed``: what was typed and stopped may go on. ``Failure`` RBL811 where it may not, RBL806 when all is over;
        ``Fault`` RBL540 where the arm has left the path of an interrupted motion.
        """
        if self.executor.interrupted:
            hint = "Type continue to begin the interrupted statement again, or back to go back by statements."
            raise failure("RBL806", "an alarm has ended the program", hint)
        if self.executor.is_over:
            raise failure("RBL806", "the program has ended")
        origin = self.executor.origin
        if not typed and origin is not None and origin.source is not None:
            text = origin.source.line_text(1).strip()
            raise failure("RBL811", f"a typed statement was stopped: {text}")
        self.executor.stops_before = stops_before
        try:
            self.executor.resume()
            return self.drive(seconds)
        finally:
            # what is fed at the prompt is not to be stopped by the breakpoints of a run
            self.executor.stops_before = None

    def take_up(self) -> bool:
        """Put the program back where it was interrupted: the arm where it was left, or before what an alarm has ended.

        Returns False where the arm was stopped on its return. ``Fault`` RBL541 where it is too far from the path.
        """
        executor = self.executor
        if (executor.displaced or executor.strayed) is not None:
            if executor.regain():
                self.drive()
            # whoever stops the return does not want the program to run
            stopped = executor.plays
            self.drop()
            if stopped:
                return False
        if executor.interrupted:
            executor.begin_again()
        return True

    def back(self, steps: int) -> Mark:
        """Take back so many statements, jogs and typed lines; ``Fault`` RBL545 where there are not as many.

        An edit is a place of its own for the executor; at the prompt it is no step, since it is not taken back.
        """
        at = [index for index, label in enumerate(self.timeline.labels, 1) if label != EDIT]
        if not steps <= len(at):
            raise Fault("RBL545", f"{steps} steps back are more than the {len(at)} that are known")
        return self.timeline.back(at[steps - 1])

    def limit_speed(self, limited: bool) -> None:
        """Keep tool and flange under 250 mm/s in all that is planned from now on, or not."""
        self.controller.speed_cap = MANUAL_SPEED if limited else None

    def drive(self, seconds: float = math.inf) -> Status:
        """Let the program, or what was fed, go on until it stands; ``Failure`` for what went wrong meanwhile.

        After ``seconds`` of simulated time it is paused on its path.
        """
        ends_us = self.executor.time_us + seconds * 1e6
        started = wall_s()
        with self._interrupts.watched():
            # cycle by cycle: a request to stop is seen within 8 ms of the robot (R06)
            while (status := self.executor.advance()).state not in _STANDING:
                self._obey(Interrupt.STOP if status.time_us >= ends_us else self._interrupts.take())
        self.wall_s += wall_s() - started
        self._show_warnings()
        self._judge(status)
        return status

    def _obey(self, request: Interrupt | None) -> None:
        if request is Interrupt.STOP:
            self.executor.pause()
        elif request is Interrupt.HALT:
            self.executor.halt()

    def _show_warnings(self) -> None:
        # the controller keeps all of them for the report; each is shown once
        new = self.controller.warnings[self._warned :]
        self._warned += len(new)
        for warning in new:
            # of what is typed each kind once: the same friction or missing LOAD would be named after every jog
            typed = isinstance(warning.statement, Origin) and warning.statement.source is not None
            if typed and warning.code in self._named:
                continue
            self._named |= {warning.code} if typed else set()
            self._output.problem(render(as_diagnostic(warning, Severity.WARNING), self.project.source))

    def _judge(self, status: Status) -> None:
        """Raise what a drive ended with, unless it is an end that was requested."""
        # the alarm first: a fault that the program does not catch is latched as one too
        if status.alarm is not None:
            at = f"at {status.alarm.tick * self.project.profile.tick_s:.3f} s: "
            item = as_diagnostic(status.alarm, Severity.ERROR)
            hint = f"{item.hint} At the prompt: reset acknowledges the alarm."
            raise of_diagnostics([item.replaced(message=at + item.message, hint=hint)], self.project.source)
        if status.fault is not None:
            raise of_diagnostics([fault_of(status.fault)], self.project.source)
