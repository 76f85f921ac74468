"""Lines at the end of the screen that are painted again and again in the same place."""

from contextlib import suppress

from prompt_toolkit.formatted_text import FormattedText, StyleAndTextTuples
from prompt_toolkit.output import Output as Terminal
from prompt_toolkit.shortcuts import print_formatted_text

from robolang.pendant.colours import STYLE


class Panel:
    """Lines on a terminal; each must be narrower than the screen."""

    def __init__(self, terminal: Terminal) -> None:
        self._terminal = terminal
        self._rows = 0

    def show(self, lines: list[StyleAndTextTuples]) -> None:
        """Paint lines in place of those painted before."""
        # as many as fit: what has scrolled out of the screen cannot be painted again
        lines = lines[: max(1, self._terminal.get_size().rows - 1)]
        fragments: StyleAndTextTuples = []
        for line in lines:
            fragments += [*line, ("", "\n")]
        # in one write, so that nothing flickers
        with suppress(OSError):
            self._back()
            print_formatted_text(
                FormattedText(fragments),
                output=self._terminal,
                style=STYLE,
                end="",
                include_default_pygments_style=False,
            )
        self._rows = len(lines)

    def clear(self) -> None:
        """Remove the lines."""
        with suppress(OSError):
            self._back()
            self._terminal.flush()
        self._rows = 0

    def _back(self) -> None:
        self._terminal.write_raw("\r")
        if self._rows:
            self._terminal.cursor_up(self._rows)
        self._terminal.erase_down()
