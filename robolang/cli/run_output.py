"""What a running program prints; observers that also show its progress build on it."""

from robolang.cli.output import echo
from robolang.core.diagnostics import safe
from robolang.execution.observer import Observer
from runtime.control.controller import Controller


class RunOutput(Observer):
    """Shows what the program prints, and nothing else; ``err``: on stderr, where stdout is for a report."""

    err = False

    def follow(self, controller: Controller) -> None:
        """Take note of the controller of the run, before it begins."""

    def printed(self, text: str) -> None:
        """Show what the program prints, as it prints it."""
        echo(safe(text), err=self.err)
