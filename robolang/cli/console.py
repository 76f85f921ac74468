"""The console that the tables are printed on: plain words, never markup.

File names, axis names and statements are other people's words: ``[bold]``, ``:smile:`` and control characters in
them are printed, not obeyed. What is meant for a reader that has left is dropped, where rich would end the process
with exit code 1.
"""

from typing import TextIO, cast

from rich.console import Console as RichConsole

from robolang.cli.output import drop


class Console(RichConsole):
    """Rich's console without markup, emoji codes and highlighting."""

    def __init__(self, *, stderr: bool = False) -> None:
        super().__init__(stderr=stderr, markup=False, emoji=False, highlight=False)

    def on_broken_pipe(self) -> None:
        """Print nothing more, in place of leaving the process."""
        drop(cast("TextIO", self.file))
