"""Completion at the prompt: the offers as completions of prompt_toolkit, each with its meaning beside it."""

from collections.abc import Iterable

from prompt_toolkit.completion import CompleteEvent, Completer, Completion
from prompt_toolkit.document import Document

from robolang.core.diagnostics import safe
from robolang.pendant.command import Commands
from robolang.pendant.known import Knowing
from robolang.pendant.offers import offered

_LONGEST = 70
"""Columns of a meaning: a longer one is cut, so that the menu keeps its place."""


class PromptCompleter(Completer):
    """Completes what is typed; ``knowing`` gives what is known now."""

    def __init__(self, knowing: Knowing, commands: Commands) -> None:
        self._knowing, self._commands = knowing, commands

    def get_completions(self, document: Document, complete_event: CompleteEvent) -> Iterable[Completion]:
        """Yield the completions at the cursor."""
        # while typing, a menu of everything would only cover what is there
        if not complete_event.completion_requested and not document.current_line_before_cursor.strip():
            return
        for text, meaning, replaces in offered(document.text_before_cursor, self._knowing(), self._commands):
            yield Completion(text, start_position=-replaces, display_meta=_cut(safe(meaning)))


def _cut(text: str) -> str:
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"
