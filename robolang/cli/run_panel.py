"""The panel that ``robolang run`` keeps up to date on a terminal: time left, statement, tool speed, joints.

It is painted in place at most ``_EACH_S`` apart in wall time, whatever the speed of the run, and removed before
anything else is printed and at the end. What a narrow or short terminal has no room for is left out: bars get shorter,
then joints are left out, and in fewer than four rows one line remains.
"""

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
from rich.console import Console as RichConsole
from rich.console import ConsoleOptions, RenderResult
from rich.live import Live
from rich.text import Text

from robolang.cli.console import Console
from robolang.cli.run_output import RunOutput
from robolang.core.diagnostics import safe
from robolang.execution.outlook import Outlook, PlannedStep, TimeLeft
from robolang.execution.result import StatementRun
from runtime.control.clock import wall_s
from runtime.control.controller import Controller
from runtime.core.faults import Alarm
from runtime.core.program_line import named
from runtime.core.units import MM
from runtime.robot.model.drives import Limits

_EACH_S = 0.1
_NEAR = 0.05
"""A joint nearer to an end of its range than this part of it stands out."""
_HIGH_PCT = 80.0
_WIDE = 72
"""Columns from which torques have bars too."""
_LONGEST = 40


@dataclass(frozen=True, slots=True, kw_only=True)
class JointShown:
    """A joint of the panel: its angle with the unit, torque, %, and ``share``, where in its range it is, from 0 to 1.

    ``share``: None where that is not known.
    """

    name: str
    value: float
    unit: str
    share: float | None
    torque_pct: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Panel:
    """What is painted: ``left`` is None where the time left is not known; ``speed_mm_s`` of the tool point."""

    time_s: float
    left: TimeLeft | None
    where: str
    text: str
    lamp: str
    alarm: str
    speed_mm_s: float
    joints: tuple[JointShown, ...]

    def __rich_console__(self, console: RichConsole, options: ConsoleOptions) -> RenderResult:
        """Yield the rows that there is room for; the last column stays free, since a full row would wrap."""
        width, rows = options.max_width - 1, options.size.height - 1
        marks = _ASCII if options.ascii_only else _DRAWN
        for row in self._rows(rows, width, marks):
            row.no_wrap, row.overflow = True, "ellipsis"
            row.truncate(max(1, width), overflow="crop" if options.ascii_only else "ellipsis")
            yield row

    def _rows(self, rows: int, width: int, marks: "_Marks") -> Iterator[Text]:
        if rows < 3:
            yield Text(f"{self.time_s:9.3f} s  ").append(self._statement())
            return
        yield self._progress(width, marks)
        yield self._statement()
        yield Text(f"{self.time_s:9.3f} s   tool {self.speed_mm_s:5.0f} mm/s")
        if rows >= 3 + len(self.joints):
            yield from (_joint_row(joint, width, marks) for joint in self.joints)

    def _progress(self, width: int, marks: "_Marks") -> Text:
        if self.left is None:
            # what was planned says nothing about the rest, and a bar would say something
            return Text("time left not known: not the planned course", style="yellow")
        about = f"about {self.left.seconds:.1f} s"
        label = f"waits, then {about}" if self.left.waiting else f"{about} left"
        share = self.time_s / max(1e-9, self.time_s + self.left.seconds)
        label = f" {100.0 * share:3.0f} %  {label}"
        length = max(4, min(_LONGEST, width - len(label)))
        done = round(share * length)
        return Text.assemble((marks.done * done, "green"), (marks.open * (length - done), "dim"), label)

    def _statement(self) -> Text:
        if self.alarm:
            return Text(f"stops: {self.alarm}", style="bold red")
        lamp = f"[{self.lamp}]  " if self.lamp else ""
        return Text.assemble((f"{self.where}  ", "bold"), (lamp, "bold yellow"), self.text)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Marks:
    """What bars are drawn with."""

    done: str
    open: str
    ends: str
    rail: str
    knob: str
    torque: str
    middle: str


_DRAWN = _Marks(done="━", open="─", ends="├┤", rail="─", knob="●", torque="■", middle="│")
_ASCII = _Marks(done="=", open="-", ends="||", rail="-", knob="O", torque="#", middle="|")


def _joint_row(joint: JointShown, width: int, marks: _Marks) -> Text:
    name, value = f"{joint.name:<3}", f"{round(joint.value, 1) + 0.0:8.1f} {joint.unit:<3} "
    torque = f" {round(joint.torque_pct, 0) + 0.0:5.0f} %"
    free = width - len(name) - len(value) - len(torque)
    wide = width >= _WIDE
    length = min(_LONGEST, free * 3 // 5 if wide else free)
    row = Text.assemble((name, "bold"), value, _range_bar(joint.share, length, marks))
    high = "yellow" if not abs(joint.torque_pct) < _HIGH_PCT else "none"
    if wide:
        row.append(" ").append(_torque_bar(joint.torque_pct, min(_LONGEST // 2, free - length - 1), marks), high)
    return row.append(torque, high)


def _range_bar(share: float | None, length: int, marks: _Marks) -> Text:
    """Return a rail between the ends of a range with a knob where the joint is."""
    inner = max(1, length - 2)
    if share is None:
        return Text(" " * (inner + 2))
    # a joint may be a little beyond its end, by its error
    at = min(inner - 1, max(0, int(share * inner)))
    knob = "none" if _NEAR <= share <= 1.0 - _NEAR else "yellow"
    left, right = marks.rail * at, marks.rail * (inner - 1 - at)
    return Text.assemble((marks.ends[0] + left, "dim"), (marks.knob, knob), (right + marks.ends[1], "dim"))


def _torque_bar(torque_pct: float, length: int, marks: _Marks) -> str:
    """Return a bar from the middle, to the left for a negative torque."""
    half = max(1, (length - 1) // 2)
    # of 100 and NaN ``min`` takes the first: a torque that is not a number fills the bar
    filled = marks.torque * round(min(100.0, abs(torque_pct)) / 100.0 * half)
    left, right = ("", filled) if torque_pct > 0.0 else (filled, "")
    return f"{left:>{half}}{marks.middle}{right:<{half}}"


class ArmReading:
    """Reads what the panel shows of an arm: the last tick of the log, and the tool speed over the last cycle."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller
        spec = controller.spec
        self._torque = spec.per_axis("limits", "torque")
        self._ticks = controller.profile.ticks_per_cycle

    def read(self) -> tuple[tuple[JointShown, ...], float]:
        """Return the joints and the speed of the tool point, mm/s; (), 0 before the first tick."""
        controller, n = self._controller, self._controller.spec.n
        # one more than a cycle has: a distance needs two ends
        rows = controller.recorder.recent(self._ticks + 1)
        if len(rows) < 2:
            return (), 0.0
        # the recorder has (tau_cmd, tau_sat, q_fb, dq_fb) in a row
        torque, q = 100.0 * rows[-1, n : 2 * n] / self._torque, rows[:, 2 * n : 3 * n]
        ends = controller.tool_poses(q[[0, -1]])[:, :3, 3]
        # over a cycle: the speed of one tick shows the steps of the encoders
        seconds = (len(rows) - 1) * controller.profile.tick_us / 1e6
        speed = float(np.sqrt(((ends[1] - ends[0]) ** 2).sum())) / seconds / MM
        joints = zip(controller.spec.axes, q[-1].tolist(), torque.tolist(), strict=True)
        return tuple(_joint(k, axis.limits, *values) for k, (axis, *values) in enumerate(joints, 1)), speed


def _joint(number: int, limits: Limits, angle: float, torque_pct: float) -> JointShown:
    share = (angle - limits.lower) / (limits.upper - limits.lower)
    return JointShown(
        name=f"J{number}",
        value=angle / limits.kind.size,
        unit=limits.kind.unit,
        # an arm whose state is no longer valid is shown as long as it stops
        share=share if np.isfinite(share) else None,
        torque_pct=torque_pct,
    )


class PanelProgress(RunOutput):
    """Shows a run by a panel on a terminal."""

    def __init__(self, console: Console, outlook: Outlook) -> None:
        self._console, self._outlook = console, outlook
        self._live: Live | None = None
        self._shown_s = float("-inf")
        self._run: StatementRun | None = None
        self._arm: ArmReading | None = None
        self._alarm = ""
        self._gone = False

    def follow(self, controller: Controller) -> None:
        """Take note of the controller whose joints are shown."""
        self._arm = ArmReading(controller)

    def run_began(self, run: StatementRun, time_us: int) -> None:
        """Show the statement that begins."""
        self._run = run
        self._outlook.began(run, time_us)
        self._show(time_us)

    def cycle_done(self, time_us: int) -> None:
        """Show how far the run is."""
        self._show(time_us)

    def alarm(self, alarm: Alarm) -> None:
        """Keep the alarm, which is shown while the arm stops."""
        self._alarm = f"{alarm.code} {safe(alarm.message)}"

    def printed(self, text: str) -> None:
        """Show what the program prints above the panel, which comes back at its next turn."""
        # to a file it is written without a sign on the screen
        if self.err or (sys.stdout is not None and sys.stdout.isatty()):
            self.clear()
        super().printed(text)

    def clear(self) -> None:
        """Remove the panel."""
        live, self._live = self._live, None
        if live is not None:
            self._paint(live.stop)

    def _show(self, time_us: int) -> None:
        now = wall_s()
        if self._gone or self._run is None or now - self._shown_s < _EACH_S:
            return
        self._shown_s = now
        panel = self._panel(self._run, time_us)
        self._paint(lambda: self._put(panel))

    def _put(self, panel: Panel) -> None:
        if self._live is None:
            self._live = Live(
                console=self._console,
                auto_refresh=False,
                transient=True,
                redirect_stdout=False,
                redirect_stderr=False,
                vertical_overflow="crop",
            )
            self._live.start()
        self._live.update(panel, refresh=True)

    def _panel(self, run: StatementRun, time_us: int) -> Panel:
        joints, speed = self._arm.read() if self._arm is not None else ((), 0.0)
        return Panel(
            time_s=time_us / 1e6,
            left=self._outlook.left(time_us),
            where=named(run.origin.line, run.origin.number),
            text=safe(run.text),
            lamp=run.lamp,
            alarm=self._alarm,
            speed_mm_s=speed,
            joints=joints,
        )

    def _paint(self, paint: Callable[[], None]) -> None:
        # a terminal that has gone must not end the run, whose files are still to be written
        try:
            paint()
        except OSError:
            self._gone, self._live = True, None


@contextmanager
def panel(steps: Sequence[PlannedStep]) -> Iterator[PanelProgress]:
    """Yield what shows a run by a panel on stderr; the panel is removed at the end."""
    progress = PanelProgress(Console(stderr=True), Outlook(steps))
    try:
        yield progress
    finally:
        progress.clear()
