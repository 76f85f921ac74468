"""The console that the tables are printed on: plain words, never markup.

File names, axis names and statements are other people's words: ``[bold]``, ``:smile:`` and control characters in
them are printed, not obeyed. A reader that has left raises ``BrokenPipeError`` for ``errors`` to answer, where rich
would end the process with exit code 1.
"""

from rich.console import Console as RichConsole


class Console(RichConsole):
    """Rich's console without markup, emoji codes and highlighting."""

    def __init__(self, *, stderr: bool = False) -> None:
        super().__init__(stderr=stderr, markup=False, emoji=False, highlight=False)

    def on_broken_pipe(self) -> None:
        """Say so, in place of leaving the process."""
        raise BrokenPipeError
