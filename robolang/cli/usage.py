"""The usage error that carries a code: exit code 2 and a message with RBL703 and the option. Imports typer only."""

from typing import Any

import typer
from typer.core import TyperGroup

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


class CodedGroup(TyperGroup):
    """The commands of ``robolang``: a value that the parser of the command line refuses has its code, too."""

    def invoke(self, ctx: Any) -> Any:
        """Carry the command out; ``OptionValueError`` for a value that is no number or out of the option's range."""
        try:
            return super().invoke(ctx)
        except typer.BadParameter as error:
            if type(error) is not typer.BadParameter or error.param is None:
                raise
            coded = OptionValueError(error.param.opts[0], error.message.rstrip("."))
            coded.ctx = error.ctx
            raise coded from None
