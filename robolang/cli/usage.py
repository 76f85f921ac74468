"""The usage error that carries a code: exit code 2 and a message with RBL703 and the option. Imports nothing."""

OPTION_VALUE = "RBL703"


class OptionValueError(Exception):
    """A value that an option cannot take; ``position`` is its number in a list, from 1, or None for all of it."""

    def __init__(self, option: str, message: str, position: int | None = None) -> None:
        self.code = OPTION_VALUE
        self.option = option
        self.position = position
        where = option if position is None else f"{option}, number {position}"
        super().__init__(f"{self.code} {where}: {message}")
