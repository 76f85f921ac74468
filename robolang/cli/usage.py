"""The usage error that carries a code: exit code 2 and a message with RBL703 and the option. Imports typer only."""

import typer

OPTION_VALUE = "RBL703"


class OptionValueError(typer.BadParameter):
    """A usage error that carries a code; ``position`` is the number in a list, from 1, or None for all of it."""

    def __init__(self, option: str, message: str, position: int | None = None) -> None:
        self.code = OPTION_VALUE
        self.option = option
        self.position = position
        where = option if position is None else f"{option}, number {position}"
        super().__init__(f"{self.code} {where}: {message}")

    def format_message(self) -> str:
        """Return the message as it stands; it names its option already."""
        return self.message
