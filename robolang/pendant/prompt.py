"""The prompt on a terminal: lines are edited with completion, colours and history, carried out, and answered above.

It is on the screen before numerics and physics are imported; a line that needs the controller waits for it.
"""

import asyncio
import signal
import termios
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from typing import Any

from prompt_toolkit import PromptSession
from prompt_toolkit.application import run_in_terminal
from prompt_toolkit.auto_suggest import AutoSuggestFromHistory
from prompt_toolkit.document import Document
from prompt_toolkit.formatted_text import StyleAndTextTuples
from prompt_toolkit.history import History
from prompt_toolkit.input import Input
from prompt_toolkit.key_binding import KeyBindings, KeyPressEvent
from prompt_toolkit.output import Output as Terminal

from robolang import __version__
from robolang.core.defects import internal
from robolang.core.source import Source
from robolang.pendant.colours import STYLE
from robolang.pendant.command import Commands, Group
from robolang.pendant.completer import PromptCompleter
from robolang.pendant.facts import Gathering, known
from robolang.pendant.failure import Failure, of_fault
from robolang.pendant.foreground import Foreground
from robolang.pendant.keys import KeyMode
from robolang.pendant.known import Known
from robolang.pendant.lexer import PromptLexer
from robolang.pendant.pendant import Pendant
from robolang.pendant.reading import NAME, CommandLine, first_word, is_open, read
from robolang.pendant.screen import TerminalOutput
from robolang.pendant.starting import Starting
from robolang.pendant.status import status_lines
from robolang.pendant.word_help import explained, word_at
from robolang.syntax.blocks import structure_of
from robolang.syntax.parser import parse
from robolang.syntax.statements import STATEMENTS
from runtime.core.faults import Fault

PROMPT = "> "
_QUIT = "quit"
_ESC_S = 0.05
"""How long what follows an Esc belongs to it, as in Alt-Enter, s."""
_INDENT = "  "


class Prompt:
    """A pendant on a terminal. ``source`` gives keys, ``terminal`` shows; ``history`` has the lines typed before."""

    def __init__(self, pendant: Pendant, source: Input, terminal: Terminal, history: History) -> None:
        self._pendant = pendant
        self._starting = Starting(pendant)
        self._known: Known | None = None
        self._gathering = Gathering(pendant)
        self._facts = self._gathering.facts("starting")
        self._output = TerminalOutput(terminal, lambda: self.known.names, self._answer)
        pendant.output = self._output
        self._interrupts.watch = self._watch
        pendant.key_mode = KeyMode(pendant, self._output, terminal, self._gathering).run
        self._source, self._terminal = source, terminal
        words = frozenset(command.word.upper() for command in pendant.commands)
        self._session: PromptSession[str] = PromptSession(
            PROMPT,
            multiline=True,
            prompt_continuation=lambda width, _line, _wrapped: "." * (width - 1) + " ",
            lexer=PromptLexer(lambda: self.known.names, words),
            completer=PromptCompleter(lambda: self.known, pendant.commands),
            complete_while_typing=True,
            history=history,
            auto_suggest=AutoSuggestFromHistory(),
            bottom_toolbar=self._status,
            style=STYLE,
            key_bindings=self._bindings(),
            input=source,
            output=terminal,
        )

    @property
    def known(self) -> Known:
        """What is known for completion and colours, gathered when it is first needed after a change."""
        if self._known is None:
            try:
                self._known = known(self._pendant)
            except Exception:  # it is read while painting: without colours one can still type and save
                self._known = Known()
        return self._known

    def run(self) -> int:
        """Let somebody work until the end; return the signal that ended it, 0 for ``quit``."""
        self._recover()
        self._output.line(f"robolang {__version__}  help lists the commands, F1 explains a word, Ctrl-D leaves")
        # between two lines as well: what is typed then is not echoed into the results
        with self._interrupts.keyboard.direct():
            while not self._pendant.ended and not self._interrupts.lost:
                self._round()
        return self._interrupts.signal

    def _round(self) -> None:
        """Read a line and carry it out."""
        try:
            text = self._read()
        except KeyboardInterrupt:
            return  # Ctrl-C clears the line
        except (EOFError, OSError, termios.error):  # no key gives EOFError, see _bindings: the terminal has gone
            self._interrupts.lose(signal.SIGHUP)
            return
        with self._interrupts.ending():
            self._carry_out(text)

    def _recover(self) -> None:
        try:
            self._pendant.offer_recovery()
        except Fault as fault:
            self._output.problem(of_fault(fault).text)
        self._refresh()

    @property
    def _interrupts(self) -> Foreground:
        found = self._pendant.interrupts
        assert isinstance(found, Foreground)
        return found

    # --- reading ------------------------------------------------------------------------------------------------------

    def _read(self) -> str:
        return self._session.prompt(pre_run=self._begin, handle_sigint=True)

    def _begin(self) -> None:
        """Let signals end the prompt, and the controller start once the prompt is on the screen."""
        app = self._session.app
        # Esc stops motion, so it is often pressed a moment late: it must not wait for the next letter and eat it
        app.ttimeoutlen, app.timeoutlen = _ESC_S, _ESC_S
        loop = asyncio.get_running_loop()
        for number in (signal.SIGTERM, signal.SIGHUP):
            loop.add_signal_handler(number, partial(self._ended, number))
        if not self._starting.is_over:
            then = partial(loop.call_soon_threadsafe, self._started)
            app.after_render += lambda _: self._starting.begin(lambda: _if_open(then))

    def _ended(self, number: int) -> None:
        self._interrupts.lose(number)
        if self._session.app.is_running:
            self._session.app.exit(exception=KeyboardInterrupt)

    def _started(self) -> None:
        """Show that the controller is there, or why it is not."""
        self._refresh()
        failure = self._starting.failure
        if failure is not None:
            run_in_terminal(partial(self._output.problem, failure.text))
        self._session.app.invalidate()

    def _bindings(self) -> KeyBindings:
        bindings = KeyBindings()

        @bindings.add("enter")
        def _(event: KeyPressEvent) -> None:
            buffer = event.current_buffer
            # inside of a text of several lines it parts a line
            if buffer.document.is_cursor_at_the_end and not self._is_open(buffer.text):
                buffer.validate_and_handle()
            else:
                buffer.insert_text("\n" + _INDENT * _depth(buffer.document.text_before_cursor))

        @bindings.add("escape", "enter")
        def _(event: KeyPressEvent) -> None:
            event.current_buffer.newline(copy_margin=True)

        @bindings.add("c-d")
        def _(event: KeyPressEvent) -> None:
            if event.current_buffer.text:
                event.current_buffer.delete()
            else:
                event.app.exit(result=_QUIT)

        @bindings.add("f1")
        def _(event: KeyPressEvent) -> None:
            run_in_terminal(partial(self._output.line, self._help(event.current_buffer.document)))

        return bindings

    def _help(self, document: Document) -> str:
        """Return form and meaning of the word at the cursor."""
        line = document.current_line
        word = word_at(line, document.cursor_position_col)
        text = explained(word, line, self.known, self._pendant.commands) if word else ""
        return text or "help lists the commands; F1 at a word explains it"

    def _status(self) -> StyleAndTextTuples:
        lines = status_lines(self._facts, self._output.columns)
        return [fragment for at, line in enumerate(lines) for fragment in ([("", "\n")] if at else []) + line]

    def _answer(self, question: str) -> bool:
        """Ask a question until the answer is yes or no; nobody there means no."""
        asking: PromptSession[str] = PromptSession(input=self._source, output=self._terminal, style=STYLE)
        with suppress(KeyboardInterrupt, EOFError):
            while True:
                answer = asking.prompt(f"{question} (y/n) ").strip().lower()
                if answer in ("y", "yes"):
                    return True
                if answer in ("n", "no"):
                    return False
        return False

    # --- carrying out -------------------------------------------------------------------------------------------------

    def _is_open(self, text: str) -> bool:
        *_, last = entries(text, self._pendant.commands)
        return is_open(last, self._pendant.commands)

    def _carry_out(self, text: str) -> None:
        """Carry out what was typed or pasted, up to the first line that fails."""
        typed = list(entries(text, self._pendant.commands))
        for entry in typed:
            if len(typed) > 1:
                self._output.echo(entry)
            if not self._done(entry):
                break
        self._output.over()
        self._refresh()

    def _done(self, entry: str) -> bool:
        try:
            if entry.rstrip().endswith("?"):
                self._output.line(self._help(Document(entry.rstrip().rstrip("?"))))
                return True
            self._wait_for(entry)
            self._interrupts.stopped = False
            self._pendant.do(entry)
            if self._interrupts.stopped:
                self._output.line("stopped")
        except Failure as failure:
            self._output.problem(failure.text)
        except KeyboardInterrupt:
            self._output.problem("stopped")
        except Exception as error:
            # a defect must not cost what is unsaved
            self._output.problem(of_fault(internal(error)).text)
        else:
            return not (self._interrupts.lost or self._interrupts.stopped)
        return False

    def _watch(self) -> None:
        """Show the simulated time while something runs."""
        live = self._pendant.built
        if live is not None:
            self._output.tick(live.seconds, "stopping" if self._interrupts.stopped else "")

    def _wait_for(self, entry: str) -> None:
        """Wait until the controller is there, unless a line can do without."""
        found = read(entry, self._pendant.commands)
        if isinstance(found, CommandLine) and not found.command.needs_arm and found.command.group in _WITHOUT:
            return
        self._starting.begin(lambda: None)
        while not self._starting.wait(0.1):
            self._output.progress("the controller starts ...")

    def _refresh(self) -> None:
        self._known = None
        self._facts = self._gathering.facts("no controller" if self._starting.is_over else "starting")


_WITHOUT = frozenset({Group.SESSION, Group.SHOW})
"""Commands that change nothing which the starting thread reads."""


_CLOSING = frozenset(each.keyword for each in STATEMENTS if each.closes)


def entries(text: str, commands: Commands) -> Iterator[str]:
    """Yield what is carried out at once of a text: a line, or the lines of a block."""
    gathered: list[str] = []
    for line in text.split("\n"):
        gathered.append(line)
        # only such a line ends a block: to read all of it at each line would take quadratic time
        if len(gathered) > 1 and first_word(line).upper() not in _CLOSING:
            continue
        entry = "\n".join(gathered)
        if not is_open(entry, commands):
            gathered.clear()
            yield entry
    if gathered:
        yield "\n".join(gathered)


def _depth(text: str) -> int:
    """Return in how many blocks the end of a text is."""
    problems = structure_of(parse(Source(NAME, text)).program).diagnostics
    return sum(problem.code == "RBL211" for problem in problems)


def _if_open(call: Callable[[], Any]) -> None:
    # the loop of the prompt may have ended meanwhile: the next prompt shows the state by itself
    with suppress(RuntimeError):
        call()
