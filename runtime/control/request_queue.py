"""The requests for motion of one controller: moves in a row, given set-points, and moves that wait for a seam tracker.

The queue puts one joint set-point into INA in every cycle until nothing is left (``next_row``, ``given_row``) and names
the statement that it belongs to. A set-point that is *computed* reaches INA after the 8 ms interrupt and is sent by the
next one; one that is *given* (``play``) is there already, costs nothing, and is sent by the interrupt of its own cycle.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from runtime.control.memory_areas import Areas
from runtime.core.faults import Fault
from runtime.core.frames import Array, frozen
from runtime.core.program_line import ProgramLine
from runtime.core.state import State, Stateful
from runtime.motion.cartesian_planner import FOLLOWS, MovePlan
from runtime.motion.commands import Command, MoveLinear
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.given_rows import as_rows, check_motion, check_range
from runtime.motion.interpolator import Interpolator
from runtime.motion.motion_planner import ChainPlan, MotionPlanner, tracked_row
from runtime.motion.seam import SeamMove, SeamTracker
from runtime.motion.speed_cap import SpeedCap
from runtime.motion.speeds import Speeds
from runtime.motion.stop import pause_course, resume_course, stopping_rows
from runtime.robot.model.spec import RobotSpec


@dataclass(frozen=True, slots=True, kw_only=True)
class SetAside:
    """A motion that rests on its path while the arm does something else; ``ended``: no set-point of it is left."""

    ended: bool
    interpolator: State
    before: int
    statements: tuple[ProgramLine, ...]
    given: bool
    wrist_mode: int
    chain: ChainPlan | None


class RequestQueue(Stateful):
    """Moves of one robot, from the request to INA. Joint vectors are (n,), rad."""

    VALUES = (
        "statement",
        "override",
        "speed_cap",
        "X_flange_tool",
        "wrist_mode",
        "_waiting",
        "_before",
        "_statements",
        "_given",
        "_chain",
    )
    PARTS = ("interpolator",)

    def __init__(
        self,
        spec: RobotSpec,
        planner: MotionPlanner,
        areas: Areas,
        fine: FineInterpolator,
        X_flange_tool: Array,
    ) -> None:
        self.planner = planner
        self.interpolator = Interpolator()
        self.statement: ProgramLine | None = None
        """Statement that runs; None: none does."""
        self.override = 1.0
        """Share in (0, 1] of every speed."""
        self.speed_cap: float | None = None
        """Cap on the speed of tool point and flange, m/s; None: there is none."""
        self.X_flange_tool = X_flange_tool
        """Tool whose point moves (4, 4)."""
        self.wrist_mode = FOLLOWS
        """Whether the wrist follows the path at the set-point in INA (``runtime.motion.cartesian_planner``)."""
        self.tracker: SeamTracker | None = None
        """Tracker that moves follow; None without SEAM ON."""
        self._spec, self._areas, self._fine = spec, areas, fine
        self._limits = spec.per_axis("limits", "speed"), spec.per_axis("limits", "acceleration")
        self._waiting: list[tuple[MovePlan, MoveLinear]] = []  # under the tracker a move begins where the last one led
        self._before = 0  # moves of a row before those that the interpolator has
        self._statements: tuple[ProgramLine, ...] = ()
        self._given = False
        self._chain: ChainPlan | None = None  # which may be extended while it runs

    # requests -------------------------------------------------------------------------------------------------------

    def chain(self, commands: Sequence[Command], statements: Sequence[ProgramLine], *, more: bool = False) -> ChainPlan:
        """Plan moves in a row from INA and start them; see ``Controller.move_chain``."""
        if statements and len(statements) != len(commands):
            raise ValueError(f"{len(commands)} moves have {len(statements)} statements")
        tracker = self.tracker
        if tracker is None:
            here = np.array(self._areas.ina)
            chain = self.planner.chain(here, commands, self.X_flange_tool, self.override, self.speed_cap, more=more)
            self.interpolator.start(chain)
        else:
            tracked = tracked_row(commands)
            start = self._calculated(tracker)
            chain = self.planner.chain(start, tracked, self.X_flange_tool, self.override, self.speed_cap)
            if self.interpolator.busy:
                raise RuntimeError("a move is running")
            self._waiting = [(part.plan, command) for part, command in zip(chain.parts, tracked, strict=True)]
        # -1: under a tracker ``start_waiting`` counts the first move too
        self._begin(tuple(statements), before=0 if tracker is None else -1)
        self._chain = chain if more else None
        self.start_waiting()
        self.name_statement()
        return chain

    @property
    def more_due(self) -> bool:
        """Whether more moves are to follow now, so that those that run go on without a stop."""
        chain, row = self._chain, self.interpolator.row
        if chain is None or chain.tail is None or chain.tail.more_at is None or row is None:
            return False
        return row >= chain.tail.more_at

    def extend(self, commands: Sequence[Command], statements: Sequence[ProgramLine]) -> tuple[ChainPlan, int]:
        """Let more moves follow those that run; return the plan from now on, and how many moves it leaves out.

        These are over: the moves that it begins with run. ``Fault`` RBL4xx where the motion cannot go on; it stops at
        its end then, and another one may follow.
        """
        chain, row = self._chain, self.interpolator.row
        if chain is None or row is None:
            raise Fault("RBL404", "nothing follows the motion without a stop")
        # where it is refused it is not due again
        self._chain = None
        grown, left_out = self.planner.extend(chain, row, commands, self.X_flange_tool, self.override, self.speed_cap)
        self.interpolator.extend(grown, chain.parts[left_out - 1].last if left_out else 0)
        self._chain = grown
        self._statements = (*self._statements[left_out:], *statements)
        return grown, left_out

    def play(self, rows: Array, checked: bool) -> None:
        """Send given set-points (K, n), one in each cycle; see ``Controller.play``."""
        rows = as_rows(self._spec, rows)
        self._refuse_while_busy()
        if checked:
            check_motion(self._spec, self._fine, rows, np.array(self._areas.ina))
        if self.speed_cap is not None:  # whatever the caller answers for: in MANUAL it is a person who stands there
            self._cap(self.speed_cap).check(self._fine.after(rows))
        # row 0 of a plan is where the arm is, and is not sent
        q = frozen(np.concatenate([self._areas.ina[None], rows]))
        self.interpolator.start(MovePlan(path=None, s=np.ones(len(q)), q=q, slowdown=None, notes=()))
        self._begin((), before=0)
        self._given = True

    def jump(self, q: Array) -> None:
        """Set the reference to q at once; see ``Controller.jump``."""
        rows = as_rows(self._spec, np.array([q]))
        self._refuse_while_busy()
        check_range(self._spec, rows)
        # not even a small one: the servo follows a step as fast as its motors can
        if self.speed_cap is not None:
            raise Fault("RBL404", "a step of the reference has no bounded speed", "Switch to AUTO for a step response.")
        self._areas.ina = rows[0]
        self._fine.jump(rows[0])

    def _cap(self, most: float) -> SpeedCap:
        kinematics = self.planner.kinematics
        return SpeedCap(most=most, kinematics=kinematics, fine=self._fine, X_flange_tool=self.X_flange_tool)

    def _refuse_while_busy(self) -> None:
        if self.busy:
            raise RuntimeError("a move is running")
        if self.tracker is not None:
            raise RuntimeError("a seam is followed, which given set-points cannot do")

    def rehearse(self, q_start: Array, command: Command) -> MovePlan:
        """Return the plan of a move from q_start, without starting it."""
        if isinstance(command, MoveLinear) and self.tracker is not None:
            command = replace(command, tracked=True)
        return self.planner.plan(q_start, command, self.X_flange_tool, self.override, self.speed_cap)

    def speeds(self, chain: ChainPlan, commands: Sequence[Command]) -> Speeds:
        """Return how fast the moves of a chain are that has been planned now, judged when it is read."""
        return Speeds(self.planner, chain, commands, self.X_flange_tool, self.override, self.speed_cap)

    def seam(self, tracker: SeamTracker | None) -> None:
        """Let the moves that follow go under a tracker; None ends that."""
        self.tracker, self._waiting = tracker, []

    def _begin(self, statements: tuple[ProgramLine, ...], before: int) -> None:
        self._before, self._statements, self._given, self._chain = before, statements, False, None

    def _calculated(self, tracker: SeamTracker) -> Array:
        """Return the joint angles at which the next move under a tracker begins, without deviation."""
        return np.array(self._areas.ina) if tracker.q_calculated is None else tracker.q_calculated

    # one cycle ------------------------------------------------------------------------------------------------------

    def given_row(self) -> None:
        """Put the next given set-point, if any, into INA: before the interrupt sends it."""
        if self._given and self.interpolator.busy:
            self._areas.ina = self.interpolator.next()

    def next_row(self) -> bool:
        """Compute the next set-point into INA (steps 204 to 210); False when there is none to compute."""
        self.start_waiting()
        if self._given or not self.interpolator.busy:
            return False
        self._areas.ina = self.interpolator.next()
        self.wrist_mode = self.interpolator.mode
        return True

    def start_waiting(self) -> None:
        """Start the next move under the tracker, if one waits and none runs: from where the seam has led the arm."""
        tracker, lines = self.tracker, self.planner.lines
        while tracker is not None and self._waiting and not self.interpolator.busy:
            plan, command = self._waiting.pop(0)
            here = np.array(self._areas.ina)
            move = lines.tracked(plan, command, self._calculated(tracker), here, tracker, self.X_flange_tool)
            self.interpolator.start(plan, move)
            self._before += 1

    def name_statement(self) -> None:
        """Take the statement of the set-point in INA for the one that runs."""
        if self._statements:
            self.statement = self._statements[self.index]

    @property
    def index(self) -> int:
        """Which move of the row the set-point in INA belongs to, from 0."""
        return self._before + self.interpolator.command

    @property
    def busy(self) -> bool:
        """Whether set-points are left to send."""
        return self.interpolator.busy or bool(self._waiting)

    def rename(self, name: Callable[[ProgramLine], ProgramLine]) -> None:
        """Name the statements of the moves anew."""
        self._statements = tuple(map(name, self._statements))
        self.statement = None if self.statement is None else name(self.statement)

    # the end --------------------------------------------------------------------------------------------------------

    def stop(self) -> None:
        """Replace what is left by a stop on its path, within the limits of the joints."""
        self._waiting = []
        self.interpolator.stop(lambda rows, at, whole: stopping_rows(rows, at, self._fine, *self._limits, whole))

    def hold(self) -> None:
        """Bring the motion to rest on its path, to be resumed by ``go_on``; under a seam sensor at its end."""
        self.interpolator.hold(lambda rows, at: pause_course(rows, at, self._fine, *self._limits))

    def go_on(self) -> None:
        """Resume the motion that ``hold`` has brought to rest."""
        self.interpolator.go_on(lambda rows, at: resume_course(rows, at, self._fine, *self._limits))

    def wait_no_more(self) -> None:
        """Forget the moves that wait; the one that runs goes on."""
        self._waiting = []

    def drop(self) -> None:
        """Forget everything that is left to send."""
        self.interpolator.drop()
        self._waiting, self._chain = [], None
        self.wrist_mode = FOLLOWS

    def set_aside(self) -> SetAside:
        """Return the motion that rests, for ``take_up``, and forget it; ``RuntimeError`` while it moves."""
        if self.busy:
            raise RuntimeError("a move is running")
        left = SetAside(
            ended=not self.interpolator.is_held,
            interpolator=self.interpolator.snapshot(),
            before=self._before,
            statements=self._statements,
            given=self._given,
            wrist_mode=self.wrist_mode,
            chain=self._chain,
        )
        self.drop()
        return left

    def take_up(self, left: SetAside) -> None:
        """Put a motion back that was set aside; it rests, until ``go_on``. ``RuntimeError`` while another one moves."""
        if self.busy:
            raise RuntimeError("a move is running")
        self.interpolator.restore(left.interpolator)
        # which move of which row: log and record name statements by these
        self._before, self._statements, self._given = left.before, left.statements, left.given
        self.wrist_mode, self._chain = left.wrist_mode, left.chain

    # state ----------------------------------------------------------------------------------------------------------

    def snapshot(self) -> State:
        """Return the state of the queue, with copies of the tracker and of the move under it."""
        state = super().snapshot()
        return replace(state, values=(*state.values, *_apart(self.tracker, self.interpolator.seam)))

    def restore(self, state: State) -> None:
        """Put a state back; the tracker is another object then."""
        *values, tracker, move = state.values
        super().restore(replace(state, values=tuple(values)))
        self.tracker, self.interpolator.seam = _apart(tracker, move)


def _apart(tracker: SeamTracker | None, move: SeamMove | None) -> tuple[SeamTracker | None, SeamMove | None]:
    """Return copies of a tracker and of the move that runs under it, or under another one."""
    copied = None if tracker is None else tracker.copy()
    if move is None:
        return copied, None
    own = copied if copied is not None and move.tracker is tracker else move.tracker.copy()
    return copied, move.copy(own)
