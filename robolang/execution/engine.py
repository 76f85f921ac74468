"""What carries the effects of a program out on a target, cycle by cycle: the inside of ``Executor``.

What is the same for the controller, a dry run and pulse tables is here: moves that are kept since they blend into the
next one, when motion has to end, the longest run, the end at STOP, and requests that are refused: these go back to the
program (ON ERROR). What is done from outside, a pause or a statement that is fed, is in ``executor``.
"""

from collections.abc import Callable
from typing import TypeAlias, assert_never

from robolang.core.source import Span
from robolang.execution import lowering, run_bounds
from robolang.execution.observer import Observer
from robolang.execution.progress import Aside, End, Phase, PlayEnded, Progress
from robolang.execution.target import Requested, Target
from robolang.execution.trail import Trail
from robolang.interpreter.effects import (
    Drain,
    Effect,
    Halt,
    MoveTo,
    Origin,
    Pass,
    SetHand,
    SetOutput,
    SetPayload,
    SetSeam,
    SetTool,
    SetWrist,
    Show,
    origin_of,
)
from robolang.interpreter.events import Done, Event, Failed, FedEnded, LineBegun
from robolang.interpreter.machine import Machine
from robolang.interpreter.snapshot import MachineSnapshot
from robolang.project.project import Project
from runtime.core.faults import Fault
from runtime.motion.motion_planner import tracked

Alter: TypeAlias = Callable[[Effect], Effect | None]
"""Changes an effect before it is carried out, None: leaves it out (``compare``)."""

StopsBefore: TypeAlias = Callable[[LineBegun], bool]
"""Whether the program is to be paused before a statement that is due."""

Lasting: TypeAlias = SetPayload | SetWrist | SetSeam | SetTool | SetOutput
"""Effects that last; mypy refuses a new one that is carried out neither as one of these nor by ``_carry_out``."""


_NOBODY = Observer()


class Engine:
    """Machine, world and target of a program, and how far it has come (``now``)."""

    def __init__(
        self, project: Project, target: Target, machine: Machine, *, alter: Alter | None, observer: Observer
    ) -> None:
        self.project, self.target, self.machine = project, target, machine
        self.world = target.world
        self.now = Progress(ends_us=run_bounds.MAX_RUN_US)
        self.stops_before: StopsBefore | None = None
        self.trail: Trail | None = None
        self._alter = alter or (lambda effect: effect)
        self._observer = observer

    @property
    def _seen(self) -> Observer:
        return _NOBODY if self.target.silent else self._observer

    # --- cycles ------------------------------------------------------------------------------------------------------

    def ready(self) -> bool:
        """Carry out what takes no time; return whether there is a cycle to run."""
        now = self.now
        while True:
            if now.pausing and not self._interrupted():
                return not now.resting
            if not self._went_on():
                return now.phase is not Phase.OVER

    def _went_on(self) -> bool:
        """Do one thing that takes no time, if there is one; else a cycle is due, or the program is over."""
        target, now = self.target, self.now
        match now.phase:
            case Phase.READY:
                self._go_on()
            case Phase.BUSY:
                return self._busy_went_on()
            case Phase.STOPPING:
                if not target.at_rest:
                    return False
                now.again = self.interrupted_at()
                self._finish()
                now.phase = Phase.OVER
            case Phase.OVER:
                return False
            case _:
                assert_never(now.phase)
        return True

    def _busy_went_on(self) -> bool:
        """Go on with what has been started: request more moves, end it, or return False for a cycle of it."""
        target, now = self.target, self.now
        # ``goes_on`` first: it notes what the last cycle did, also where a stop ends the effect
        goes_on = target.goes_on()
        ends = now.stop_requested or target.time_us >= now.ends_us
        if now.grows and target.more_due and not ends:
            now.phase, now.growing = Phase.READY, True
        elif goes_on and not now.stop_requested:
            return False
        else:
            self._end_effects()
        return True

    def _interrupted(self) -> bool:
        """Pause or go on; return whether the program goes on, else the arm comes to rest or rests (``resting``)."""
        now = self.now
        if now.phase not in (Phase.READY, Phase.BUSY) or now.stop_requested:
            now.pausing = now.resting = False
            if now.phase is Phase.READY:
                self._end_effects()
            return True
        if now.due is not None and now.phase is Phase.READY:  # in the middle of a statement
            return True
        now.resting = self.target.hold()
        if now.resting and now.resumed:
            self.target.go_on()
            now.pausing = now.resting = now.resumed = False
        return not now.pausing

    def cycle(self) -> None:
        """Run one interpolation cycle."""
        target, now = self.target, self.now
        if now.phase is Phase.STOPPING:
            target.brake(at_once=now.halt_requested)  # read in each cycle: a second Ctrl-C comes during the stop
        elif not target.cycle() or target.alarms:
            self._end_effects()
        elif target.time_us >= now.ends_us:
            now.fault = self._too_long()
            target.fail(now.fault)
        self._seen.cycle_done(target.time_us)

    def _end_effects(self) -> None:
        """End the effects whose cycles are over, or that an alarm or a stop has ended."""
        now, target = self.now, self.target
        if now.stop_requested and not target.alarms:
            if target.statement is None:  # before the first statement: an alarm has a place
                target.statement = self._first
            target.stop()
            now.phase = Phase.STOPPING  # also where no cycle runs: the arm rests
        if target.alarms:
            self._seen.alarm(target.alarms[0])
            now.phase = Phase.STOPPING
        elif target.time_us >= now.ends_us:
            self._fail(self._too_long())
        elif now.phase is Phase.BUSY:
            self._finish()
            now.phase = Phase.READY

    def _finish(self) -> None:
        now = self.now
        self.target.finish()
        if (now.moves or now.playing) and not now.chain:  # moves that are kept end elsewhere
            self.world.q_last = self.target.q
        for each in now.doing:
            self._seen.effect_done(each)
        now.doing, now.playing = (), False
        # moves that are over hold no line that an edit must keep
        now.places = now.places[len(now.places) - len(now.chain) :]

    def interrupted_at(self) -> MachineSnapshot | None:
        """Return the machine at the statement that is interrupted now, None: it has not gone on since."""
        now = self.now
        # the outermost: what was fed or played within it is no statement of the program
        if now.aside and now.aside[0].again is not None:
            return now.aside[0].again
        if not now.moves or not now.places:
            return now.again
        place = now.places[min(self.target.move_reached, len(now.places) - 1)]
        # what was fed since then stays where the machine has not gone on, since moves do not blend
        return None if self.machine.stands_at(place) else place

    @property
    def _first(self) -> Origin:
        """The first statement of the program, or the start of a text without one."""
        for line in self.project.program.statements:
            return origin_of(line, line.statement or line)
        return Origin(line=1, span=Span(0, 0))

    def _too_long(self) -> Failed:
        statement = self.target.statement
        assert statement is not None  # something has been started
        fault = self.machine.too_long(statement, self.now.ends_us / 1e6)
        return _failed(fault, fault.origin)

    def _fail(self, fault: Failed) -> None:
        """End with a fault that the program does not catch."""
        self.now.fault, self.now.phase = fault, Phase.STOPPING
        self.target.fail(fault)
        # a target without a controller (``Untimed``) has none
        for alarm in self.target.alarms[:1]:
            self._seen.alarm(alarm)

    # --- the program -------------------------------------------------------------------------------------------------

    def _go_on(self) -> None:
        """Take what the program requests next, or what was due after the motion that has ended."""
        now = self.now
        try:
            if not now.grows:
                self._end_motion()
            else:
                self._take(self.machine.step())
        except Fault as fault:
            if now.growing:
                self._end_growth(late=fault)
            else:
                self._refuse(fault)

    def _end_motion(self) -> None:
        """Take what was due after the motion that has ended."""
        now = self.now
        if now.chain:  # these moves could not follow those that ran
            self._start_chain()
        elif now.late is not None:
            late, now.late = now.late, None
            raise late
        elif now.due is not None:
            self._arrive(now.due)

    def _take(self, event: Event) -> None:
        now = self.now
        match event:
            case LineBegun():
                self._seen.statement_began(event)
                self._line(event)
            case Done() | Failed() | FedEnded():
                self._after_motion(event)
            case _:
                now.begun = now.begun or self.machine.depth == 0
                now.request = effect = self._alter(event)
                if effect is not None:
                    self.target.begin(effect)
                    # WRIST does not wait for the moves before it: each move carries the setting that holds for it
                    if isinstance(effect, SetWrist) and now.growing:
                        return
                    if isinstance(effect, MoveTo | SetWrist):
                        self._carry_out(effect)
                    else:
                        self._after_motion(effect)

    def _line(self, due: LineBegun) -> None:
        """Pause before a statement of the program where that is desired; moves that were kept come to their end."""
        now = self.now
        if due.source is None:  # what is fed has been typed by the person who waits for it
            if self.stops_before is not None and self.stops_before(due):
                if now.chain and self.trail is not None:
                    self.trail.disturbed()  # without the pause these moves would blend into the next one
                self._after_motion(due)
            elif self.trail is not None:
                self.trail.begins(due, stops=False)

    def _after_motion(self, due: Effect | End) -> None:
        """Let the moves that are kept run first, if there are any."""
        self.now.due = due
        if self.now.growing:
            self._end_growth()
        elif self.now.chain:
            self._start_chain()
        else:
            self._arrive(due)

    def _end_growth(self, late: Fault | None = None) -> None:
        """Let the moves that run come to a stop, after those that are kept; then comes what is due, or ``late``."""
        now = self.now
        now.late = late
        if now.chain:
            self._start_chain()
        else:
            now.phase, now.growing = Phase.BUSY, False

    def _arrive(self, due: Effect | End) -> None:
        now = self.now
        now.due = None
        match due:
            case Done():
                now.phase = Phase.OVER
                now.stop_requested = now.halt_requested = False  # a signal that came in the meantime is too late
            case LineBegun():
                if self.trail is not None:
                    self.trail.begins(due, stops=True)
                now.pausing = True
            case FedEnded():
                now.pausing = True
                self._take_up(led=due.led)
            case PlayEnded():
                now.pausing = True
                self._take_up()
            case Failed():
                self._failed(due)
            case _:
                self._carry_out(due)

    def _failed(self, fault: Failed) -> None:
        now = self.now
        if fault.fed:
            now.fault, now.pausing = fault, True
            self._take_up()
        else:
            self.target.statement = fault.origin
            self._fail(fault)

    # --- what is interrupted -----------------------------------------------------------------------------------------

    def set_aside(self, depth: int, again: MachineSnapshot | None) -> None:
        """Interrupt the wait, or the motion that rests, so that something else can be carried out.

        It is taken up at a ``depth`` of the machine; ``again`` is what ``interrupted_at`` gives.
        """
        now, target = self.now, self.target
        statement = target.statement
        now.aside += (
            Aside(
                depth=depth,
                doing=now.doing,
                request=now.request,
                due=now.due,
                statement=statement,
                left=target.set_aside(),
                q=target.q,
                places=now.places,
                again=again,
            ),
        )
        if now.moves:
            self.world.q_last = target.q  # where the path was left: what is fed begins there
        # nothing of it may be taken for what is started next
        now.doing, now.due, now.places = (), None, ()

    @property
    def held(self) -> Aside | None:
        """The motion that was interrupted where the program stands, None: it can go on."""
        now = self.now
        aside = now.aside[-1] if now.aside else None
        stands = now.phase is Phase.READY or now.playing
        here = stands and aside is not None and aside.depth == self.machine.depth
        return aside if here else None

    @property
    def stands_between(self) -> bool:
        """Whether the program has begun and stands between two statements, or in a wait: no motion is interrupted."""
        now, held = self.now, self.held
        begun = now.begun and not self.machine.over and self.machine.depth == 0
        return begun and not now.moves and (held is None or not held.is_motion)

    def _take_up(self, *, led: bool = False) -> None:
        """Go on with the wait that was interrupted, if there is one; where a jump has ``led`` elsewhere it is left."""
        now, depth = self.now, self.machine.depth
        now.aside = tuple(each for each in now.aside if each.depth < depth or (each.depth == depth and not led))
        # a motion is taken up by ``resume`` alone: the arm may stand elsewhere
        if (aside := self.held) is not None and not aside.is_motion:
            self.take_up(aside)

    def take_up(self, aside: Aside) -> None:
        """Go on with what was interrupted last."""
        now = self.now
        now.aside, now.phase, now.doing = now.aside[:-1], Phase.BUSY, aside.doing
        now.request, now.due, now.places = aside.request, aside.due, aside.places
        self.target.statement = aside.statement
        self.target.take_up(aside.left)

    def _refuse(self, fault: Fault) -> None:
        """Give a request that cannot be carried out back to the program, which may catch the fault (ON ERROR)."""
        now = self.now
        due, now.due, now.doing = now.due, None, ()
        now.phase = Phase.READY
        # the moves that were kept to the end: no statement is left that could answer
        if now.request is None or isinstance(due, End):
            # none of these moves was made, so it is begun again with the first of them
            now.again = now.places[0] if now.places else None
            self._fail(_failed(fault, self.target.statement))
        else:
            self.target.refuse(now.request, fault)
            self.machine.refuse(fault)

    def abandon(self) -> None:
        """Forget what is left of set-points that rest; the program stands where it stood."""
        self.target.abandon()
        self._finish()
        self.now.phase = Phase.READY
        self._arrive(PlayEnded())

    # --- effects -----------------------------------------------------------------------------------------------------

    def _carry_out(self, effect: Effect) -> None:
        """Start an effect on the target, in SI."""
        target, now = self.target, self.now
        if now.stop_requested and not isinstance(effect, MoveTo):  # a move is planned, and stopped before it begins
            target.statement = target.statement or effect.origin
            self._end_effects()
            return
        if isinstance(effect, MoveTo):
            self._move(effect)
            return
        now.phase, now.doing = Phase.BUSY, (effect,)
        match effect:
            case SetHand():
                target.hand(effect, self._cycles(lowering.dwell_s(effect, self.project.cell)))
            case Pass():
                # a cycle at least: a WAIT that reads the time would never end if its clock stood still
                target.wait(effect, max(1, self._cycles(effect.seconds)))
            case Drain():
                target.drain(effect)
                now.phase, now.doing = Phase.READY, ()
            case Show():
                target.show(effect)
            case Halt():
                target.halt(effect)
            case _:
                self._set(effect)

    def _set(self, effect: Lasting) -> None:
        """Change what holds for the statements that follow, from now on."""
        target, cell = self.target, self.project.cell
        match effect:
            case SetPayload():
                target.load(effect, lowering.payload(effect, cell))
            case SetWrist():
                target.wrist(effect)
            case SetSeam():
                target.seam(effect)
                self.now.tracked = effect.sensor is not None
            case SetTool():
                self.world.tool, self.world.X_flange_tool = effect.tool, lowering.tool(effect.tool, cell)
                target.tool(effect, self.world.X_flange_tool)
            case SetOutput():
                self.world.set_output(effect.output, effect.value, effect.seconds)
                target.output(effect)
            case _:
                assert_never(effect)

    def _cycles(self, seconds: float) -> int:
        # rounded up, from whole us: a rounding error of calculated seconds must not cost a cycle
        return -(-round(seconds * 1e6) // self.project.profile.period_us)

    def _move(self, effect: MoveTo) -> None:
        """Start a move, or keep it where the next one may blend into it; it begins where the one before ends."""
        now, world = self.now, self.world
        now.stood = None
        command = lowering.move(effect, world.around, self.project.profile.acceleration)
        if now.tracked:
            command = tracked(command)
        blends, long = command.zone > 0.0, False
        # planned here, where the program can answer a refusal, and not when the chain runs
        if blends or now.chain or now.growing:
            plan = self.target.rehearse(world.q_last, command)
            world.q_last = plan.q[-1]
            now.chain_s = (now.chain_s if now.chain else 0.0) + plan.programmed_s
            # a move that goes nowhere has one row and no room for a blend
            blends = blends and len(plan.q) > 1
            long = self._is_long(len(now.chain) + 1)
        now.keep(Requested(effect=effect, command=command), self.machine.snapshot())
        if blends and not long:
            now.phase = Phase.READY
        else:
            self._start_chain(more=blends)

    def _is_long(self, moves: int) -> bool:
        """Return whether so many moves are enough to be planned ahead."""
        many, seconds = run_bounds.LONG_AHEAD
        return moves >= run_bounds.MOST_AHEAD or (moves >= many and self.now.chain_s >= seconds)

    def _start_chain(self, *, more: bool = False) -> None:
        """Start the moves that are kept, or let them follow those that run; ``more``: others may follow them."""
        now = self.now
        chain, now.chain = now.chain, ()
        effects = tuple(each.effect for each in chain)
        now.phase = Phase.BUSY
        if not now.growing:
            now.doing = effects
            self.target.move(chain, more=more)
            return
        now.growing = False
        try:
            over = self.target.extend(chain, more=more)
        except Fault:
            now.chain = chain  # they start when those that run have stopped
            return
        # a motion without end would keep all that it ever did
        for each in now.doing[:over]:
            self._seen.effect_done(each)
        now.doing, now.places = (*now.doing[over:], *effects), now.places[over:]


def _failed(fault: Fault, origin: Origin | None) -> Failed:
    assert origin is not None  # something has been started
    return Failed(code=fault.code, message=fault.message, hint=fault.hint, origin=origin)
