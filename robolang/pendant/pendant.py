"""The prompt as an object: what is edited, what runs, and what a typed line does. Faces give it lines and show results.

A ``Pendant`` is light to make: the controller, and with it numerics and physics, is built when a line first needs it.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import robolang.core.codes  # noqa: F401 - the codes raised here must be registered
from robolang.analysis.analysis import Analysis
from robolang.analysis.named_lines import has_numbers, line_of
from robolang.core.diagnostics import Diagnostic, has_errors
from robolang.core.source import Source
from robolang.pendant.checking import errors_of
from robolang.pendant.choice import Choice, Mode
from robolang.pendant.command import Commands
from robolang.pendant.failure import Failure, failure, of_diagnostics, of_fault
from robolang.pendant.interrupts import Interrupts
from robolang.pendant.keeping import Keeping
from robolang.pendant.line_moves import LineMoves, moved_breaks
from robolang.pendant.numbers import pose_text
from robolang.pendant.output import Output
from robolang.pendant.pictures import Pictures
from robolang.pendant.reading import NAME, Blank, CommandLine, LineEdit, Statements, Value, first_word, read
from robolang.pendant.recording import Recording
from robolang.pendant.standing import ENDED, place, text_of
from robolang.pendant.words import values
from robolang.syntax.keywords import near
from robolang.teaching.desk import Desk
from robolang.teaching.documents import Documents
from robolang.teaching.line_map import LineMap
from robolang.teaching.program_document import put_line
from runtime.core.faults import Fault
from runtime.core.tomlfile import FileFault, FilePlace

if TYPE_CHECKING:
    from robolang.execution.stepping import Breakpoint, Hit, Stop
    from robolang.pendant.live import Live
    from robolang.project.points import Point
    from robolang.project.project import Project
    from robolang.syntax.ast import Line
    from robolang.teaching.jogging import JogRequest, JogSettings
    from runtime.motion.jog import JogPlan


T = TypeVar("T")


def _key(item: Diagnostic) -> tuple[str, str]:
    # not by place: an edit above moves it
    return item.code, item.message


class Pendant:
    """A session of the prompt. ``do`` carries out one line, or the lines of one block."""

    def __init__(
        self, desk: Desk, choice: Choice, output: Output, *, commands: Commands, interrupts: Interrupts, scripted: bool
    ) -> None:
        self.desk, self.choice, self.output = desk, choice, output
        self.commands, self.interrupts, self.scripted = commands, interrupts, scripted
        self.mode = Mode.MANUAL
        # in a script nobody's hand can come near the keys
        self.armed = scripted
        """Whether keys move the arm; commands do in any case."""
        self.ended = False
        """Whether ``quit`` has been carried out."""
        self.breaks: dict[int, Breakpoint] = {}
        """Breakpoints by their line of the file, from 1."""
        self.watches: tuple[str, ...] = ()
        """Expressions that are shown after each stop."""
        self.key_mode: Callable[[], None] | None = None
        """Lets keys jog the arm, where a face has keys."""
        self._jog: JogSettings | None = None
        self._keeping = Keeping(scripted=scripted)
        # where the lines of the program that the controller has are in the one that is edited
        self._moved = LineMoves()
        self._project: Project | None = None
        self._live: Live | None = None
        self.recording = Recording()
        self.pictures = Pictures(choice.picture)

    def do(self, text: str) -> None:
        """Carry out what was typed; ``Failure`` for what cannot be done, with everything to show."""
        try:
            with self.recording.kept(self):
                self._do(text)
        except Fault as fault:
            raise of_fault(fault) from None
        finally:
            self.pictures.show()

    def _do(self, text: str) -> None:
        match read(text, self.commands):
            case Blank():
                pass
            case CommandLine(command, rest):
                command.do(self, rest)
            case LineEdit(number, line):
                self.put_line(number, line)
            case Value(expression):
                self.show_value(expression)
            case Statements(statements):
                self.carry_out(statements)

    # --- statements ---------------------------------------------------------------------------------------------------

    def carry_out(self, text: str) -> None:
        """Check statements and carry them out on the live controller."""
        live = self.live
        found = errors_of(text, self.project.analysis, live.executor.variables)
        if has_errors(found):
            raise self._with_command(text, of_diagnostics(found, self.desk.documents.source))
        live.refuse_latched()
        # a statement that moves nothing, such as LOAD, is answered by silence, as in any shell
        before = live.q
        live.feed(text)
        if (live.q != before).any():
            self.output.line(f"{live.seconds:.3f} s  {pose_text(live.arm.tool_in_frame)}")

    def _with_command(self, text: str, error: Failure) -> Failure:
        """Add the command that was probably meant to the errors of a text."""
        # the language answers first, since far more is typed wrong in a statement than in a command
        guess = self.commands.near(first_word(text))
        return Failure(error.codes, f"{error.text}\n  command: did you mean {guess}?") if guess else error

    def show_value(self, text: str) -> None:
        """Show the value of an expression where the program stands; nothing moves and nothing changes."""
        from robolang.execution.watching import evaluate, printed

        executor = self.live.executor
        for part in values(text, ";"):
            try:
                self.output.line(printed(executor, evaluate(executor, Source(NAME, part))))
            except FileFault:
                raise
            except Fault as fault:
                located = FileFault(fault.code, fault.message, fault.hint, FilePlace(NAME, 1, 1, part))
                raise self._with_command(text, of_fault(located)) from None

    # --- by hand ------------------------------------------------------------------------------------------------------

    @property
    def jog(self) -> "JogSettings":
        """How jogs move the arm."""
        if self._jog is None:
            from robolang.teaching.jogging import JogSettings

            self._jog = JogSettings()
        return self._jog

    @jog.setter
    def jog(self, settings: "JogSettings") -> None:
        self._jog = settings

    def plan_jog(self, request: "JogRequest") -> "JogPlan":
        """Return the plan of a jog from where the arm stands; ``Fault`` for one that cannot be carried out."""
        from robolang.teaching.jogging import plan_jog

        live = self.live
        return plan_jog(live.controller, request, self.jog, live.X_world_frame)

    def jog_by(self, request: "JogRequest") -> None:
        """Jog the arm by an amount, in MANUAL."""
        from robolang.teaching.jog_remarks import remarks

        self.live.refuse_latched()
        self.to_manual()
        plan = self.plan_jog(request)
        self.live.play(plan.rows, f"jog {request.axis} {request.amount:+g}")
        for remark in remarks(request, plan):
            self.output.line(remark)
        self.output.line(f"{self.live.seconds:.3f} s  {pose_text(self.live.arm.tool_in_frame)}")

    # --- the program --------------------------------------------------------------------------------------------------

    def run(self, stop: "Stop | None" = None, seconds: float = math.inf, *, typed: bool = False) -> None:
        """Let the program go on from where it stands, to a stop or a breakpoint, or to its end."""
        from robolang.execution.stepping import StopsAt, To

        live = self.live
        self.refuse_errors()
        live.refuse_latched()
        self.to_auto()
        stops = [stop] if stop is not None else []
        hook = StopsAt(live.executor, [*stops, *self.breaks.values()])
        try:
            live.go_on(hook, seconds, typed=typed)
        finally:
            self.show_watches()
        if hook.last is not None:
            self._show_hit(hook.last)
        elif isinstance(stop, To) and live.executor.is_over:
            self.output.line(f"line {stop.line} was not reached")
        self.output.line(self.standing)

    def _show_hit(self, hit: "Hit") -> None:
        """Show that a breakpoint has stopped the program; a step says nothing."""
        from robolang.execution.stepping import Breakpoint

        if isinstance(hit.stop, Breakpoint):
            condition = f" if {hit.stop.condition}" if hit.stop.condition else ""
            self.output.line(f"breakpoint{condition}")
        if hit.fault is not None:
            self.output.problem(of_fault(hit.fault).text)

    def set_break(self, row: int, condition: str = "") -> None:
        """Stop before a line of the file from now on; ``FileFault`` for a condition that is no expression."""
        from robolang.execution.stepping import Breakpoint
        from robolang.execution.watching import expression

        if condition:
            expression(Source("condition", condition))
        self.breaks[row] = Breakpoint(line=row, condition=condition)

    def clear_break(self, row: int) -> None:
        """Stop there no more; ``Failure`` RBL803 where no breakpoint is."""
        if self.breaks.pop(row, None) is None:
            raise failure("RBL803", f"there is no breakpoint at line {row}", "breaks lists them.")

    def show_watches(self) -> None:
        """Show the values that are watched; one that has no value now says why."""
        from robolang.execution.watching import evaluate, printed

        for text in self.watches:
            try:
                value = printed(self.live.executor, evaluate(self.live.executor, text))
            except Fault as fault:
                value = f"{fault.code} {fault.message}"
            self.output.line(f"  {text} = {value}")

    def take_up(self) -> None:
        """Bring the arm back to its interrupted path, or the program before the interrupted statement, and go on."""
        self.refuse_errors()
        self.live.refuse_latched()
        self.to_auto()
        if self.live.take_up():
            self.run(typed=True)
        else:
            self.output.line(self.standing)

    def back(self, steps: int) -> None:
        """Take back so many statements, jogs and lines of the prompt."""
        live = self.live
        # documents are not taken back with it: undo does that
        self.to_auto()
        mark = live.back(steps)
        # the cap is part of the state, and went back too
        live.limit_speed(self.mode is Mode.MANUAL)
        self.output.line(f"back before: {mark.label or text_of(live, mark.origin)}")
        self.output.line(self.standing)

    def row_text(self, row: int) -> str:
        """Return the text of a line of the file, from 1."""
        return self.desk.analysis.source.line_text(row).strip()

    def refuse_errors(self) -> None:
        """Raise ``Failure`` with the errors of the program, if it has any."""
        if not self.project.ok:
            raise of_diagnostics(self.project.diagnostics, self.project.source)

    @property
    def standing(self) -> str:
        """Where the program stands, as a line of text."""
        if not self.desk.analysis.program.statements:
            return "the program has no statements"
        at = f"at {self.live.seconds:.3f} s"
        where = place(self.live)
        return f"the program has ended {at}" if where == ENDED else f"{at}, {where}"

    @property
    def current(self) -> "Line | None":
        """The line of the edited program whose statement comes next or is held; None: none of its lines is."""
        lines = self.desk.analysis.program.lines
        if self._live is None:
            return next(iter(self.desk.analysis.program.statements), None)
        line = self._live.current
        index = None if line is None else self._moved.of(self._live.project.program.lines.index(line))
        return None if index is None or index >= len(lines) else lines[index]

    @property
    def rows(self) -> int:
        """How many lines the text of the program has."""
        spans = self.desk.analysis.source.line_spans
        return len(spans) - (spans[-1].start == spans[-1].end)

    @property
    def has_numbers(self) -> bool:
        """Whether lines of the program have line numbers."""
        return has_numbers(self.desk.analysis.program)

    def line_of(self, word: str) -> "Line":
        """Return the line of the program that a word names; ``Failure`` RBL803."""
        return line_of(self.desk.analysis, word)

    def point(self, name: str) -> "Point":
        """Return a taught point; ``Failure`` RBL301 for a name that none has."""
        points = self.project.points
        found = points.get(name)
        if found is None:
            guess = near(name, points.points)
            hint = f"did you mean {points.points[guess].name}?" if guess else "points lists them; teach makes one."
            raise failure("RBL301", f"point {name} is not taught", hint)
        return found

    # --- the end ------------------------------------------------------------------------------------------------------

    def leave(self) -> None:
        """End the prompt; with unsaved changes after a question, and a script fails (RBL805)."""
        # not the question of a script, which nobody answers: a job in CI must not lose points silently
        unsaved = ", ".join(str(path) for path in self.desk.unsaved)
        if unsaved and self.scripted:
            raise failure("RBL805", f"these files have unsaved changes: {unsaved}")
        if not unsaved or self.output.ask(f"{unsaved}: leave without saving?"):
            self.ended = True
            self._keeping.close()

    def confirm(self, question: str, yes: bool) -> None:
        """Ask whether to go on; ``Failure`` RBL807 after a no, and in a script without ``yes``."""
        if not (yes or self.output.ask(question)):
            hint = "Add --yes to the line." if self.scripted else "Nothing has changed."
            raise failure("RBL807", f"not confirmed: {question}", hint)

    def offer_recovery(self) -> None:
        """Ask what becomes of unsaved changes that an earlier prompt left, if there are any."""
        taken = self._keeping.offered(self.desk, self.output)
        if taken is not None:
            self.desk = taken
            self.start_again()

    # --- documents ----------------------------------------------------------------------------------------------------

    def put_line(self, number: int, text: str) -> None:
        """Put a line into the program by its number; without a text delete it."""
        edited, lines = put_line(self.desk.documents, f"{number} {text}".rstrip(), self.desk.analysis)
        self.edit(edited, f"line {number}" if text else f"delete line {number}", lines)

    def edit(self, new: Documents, what: str, lines: LineMap | None = None) -> None:
        """Change the program, and show the errors that it then has; ``lines``: where its lines went."""
        # only what is new: an error that is known already need not be shown after every line
        before = {_key(item) for item in self.desk.analysis.diagnostics}
        self.change(new, what, lines)
        found = [item for item in self.project.diagnostics if _key(item) not in before]
        if found:
            self.output.problem(of_diagnostics(found, self.project.source).text)

    def change(self, new: Documents, what: str, lines: LineMap | None = None) -> None:
        """Put changed documents in place of the present ones, and let the controller go on with them."""
        # documents that cannot be used are not kept: the next line would fail for the same reason
        self._changed(lambda: self.desk.change(new, what, lines), self.desk.refuse)

    def undo(self) -> str:
        """Take the last change of the documents back; return what it was."""
        return self._changed(self.desk.undo, self.desk.redo)

    def redo(self) -> str:
        """Make the change that was taken back last again; return what it was."""
        return self._changed(self.desk.redo, self.desk.undo)

    def save(self, path: Path | None = None, *, force: bool = False) -> tuple[Path, ...]:
        """Write what is unsaved, under another name where one is given; return the files.

        ``force``: also over what somebody else has changed on the disk meanwhile.
        """
        desk = self.desk
        # in its layout a program has the same lines, so nothing is there to take back
        return self._changed(
            lambda: desk.save(force=force) if path is None else desk.save_as(path, force=force), lambda: None
        )

    def _changed(self, step: Callable[[], T], take_back: Callable[[], object]) -> T:
        """Let controller and breakpoints follow a step; where they cannot, take it back and raise the reason."""
        before = self.desk.analysis.program
        result = step()
        try:
            self.follow()
        except (Fault, Failure):
            take_back()
            self._project = None
            raise
        self.breaks = moved_breaks(self.breaks, before, self.desk.analysis.program, self.desk.lines)
        return result

    def open(self, documents: Documents) -> None:
        """Work on other documents, in the start state of their cell."""
        # what was unsaved has been given up; what an earlier prompt left of the other program is offered
        self._keeping.close()
        self.desk = Desk(documents)
        # lines and names of the program before mean nothing in this one
        self.breaks.clear()
        self.watches = ()
        self.start_again()
        if not self.scripted:
            self.offer_recovery()

    def check(self) -> None:
        """Raise ``Failure`` with the errors of the program and of the motion that it will make from the start state."""
        # late, as all that imports numerics: the prompt is there before it
        from robolang.execution.dry_run import motion_check

        self.refuse_errors()
        refused = motion_check(self.project)
        if refused:
            raise of_diagnostics(refused, self.project.source)

    def follow(self) -> None:
        """Let the controller go on with the documents as they are now; ``Fault`` where it cannot.

        While the program has errors the controller keeps the last one without, and has the new points and frames.
        """
        self._project = None
        # read in any case: files that cannot be used are found by the change that makes them so
        project, lines = self.project, self._moved.then(self.desk.lines)
        if self._live is not None:
            if project.ok:
                self._live.adopt(project, lines)
            else:
                kept = self._live.project.analysis
                self._live.adopt(replace(project, analysis=kept, diagnostics=()), LineMoves())
        # only now: a change that is refused moves no line
        self._moved = LineMoves() if self._live is None or project.ok else lines
        self._keeping.keep(self.desk, self.output)

    # --- the controller -----------------------------------------------------------------------------------------------

    @property
    def project(self) -> "Project":
        """The documents, read as a program with its points and its cell; ``Fault`` for one that cannot be used."""
        if self._project is None:
            from robolang.project.project import load_project

            self._project = load_project(self.desk.typed, robot=self.choice.robot)
        return self._project

    @property
    def built(self) -> "Live | None":
        """The controller if it has been built; a screen paints without building one."""
        return self._live

    @property
    def loaded(self) -> "Project | None":
        """The documents if they have been read as a project."""
        return self._project

    @property
    def live(self) -> "Live":
        """The controller with the program, in the start state of the cell when it is first used."""
        # built when a line first needs it: numerics and physics take their time to import
        if self._live is None:
            from robolang.pendant.live import Live

            project, choice = self.project, self.choice
            if not project.ok:  # the arm can be jogged and points be taught all the same, with no program to run
                project = replace(project, analysis=Analysis(source=Source(project.source.path, "")), diagnostics=())
            self._live = Live(project, self.output, self.interrupts, physics=choice.physics, realtime=choice.realtime)
            self._apply_mode(self._live)
            self.pictures.follow(self._live)
        return self._live

    def start_again(self) -> None:
        """Forget the controller: the next use finds the cell in its start state."""
        self._live = self._project = None
        self._moved = LineMoves()

    def to_auto(self) -> None:
        """Choose AUTO, and say so where it was not chosen."""
        if self.mode is not Mode.AUTO:
            self.switch(Mode.AUTO)
            self.output.line("AUTO")

    def to_manual(self) -> None:
        """Choose MANUAL, and say so where it was not chosen."""
        if self.mode is not Mode.MANUAL:
            self.switch(Mode.MANUAL)
            self.output.line("MANUAL")

    def switch(self, mode: Mode) -> None:
        """Choose MANUAL or AUTO."""
        self.mode = mode
        if self._live is not None:
            self._apply_mode(self._live)

    def _apply_mode(self, live: "Live") -> None:
        # set at once, since the controller keeps it for everything that is planned from then on
        live.limit_speed(self.mode is Mode.MANUAL)
