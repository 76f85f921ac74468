"""From a function over groups of options to a command of typer.

Typer reads the parameters of a function from its signature. ``command`` gives it the flat one: the arguments of the
function, and each option of its groups in the panel of the group.
"""

import copy
import functools
import inspect
import re
from collections.abc import Callable, Iterator
from functools import partial
from typing import Annotated, Any, get_args

import typer
from typer.core import TyperArgument, TyperCommand, TyperGroup

from robolang.cli.options import Group, Offers
from robolang.cli.usage import OptionValueError

_BY_NAME = inspect.Parameter.KEYWORD_ONLY  # in any order, with a default or without


class RefusedValueError(typer.BadParameter):
    """A usage error as typer shows it: exit code 2. The message has its code and names its option already."""

    def __init__(self, error: OptionValueError) -> None:
        super().__init__(str(error))

    def format_message(self) -> str:
        """Return the message as it is."""
        # typer's own puts "Invalid value:" before a code that editors and scripts look for at the start
        return self.message


def command(function: Callable[..., None]) -> Callable[..., None]:
    """Return a command: ``function`` with the options of its groups as parameters of their own."""
    groups: dict[str, type[Group]] = {}
    parameters: list[inspect.Parameter] = []
    for parameter in inspect.signature(function).parameters.values():
        if isinstance(parameter.annotation, type) and issubclass(parameter.annotation, Group):
            groups[parameter.name] = parameter.annotation
            parameters += _parameters(parameter.annotation)
        else:
            parameters.append(_argument(parameter))

    @functools.wraps(function)
    def called(**given: Any) -> None:
        try:
            made = {name: made_of(group, given) for name, group in groups.items()}
            function(**given, **made)
        except OptionValueError as error:  # turned here, since `quick` calls the function without typer
            raise RefusedValueError(error) from None

    called.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    called.__annotations__ = {}  # typer would look for the groups otherwise
    text = "\n\n".join(map(_unwrapped, (inspect.getdoc(function) or "").split("\n\n")))
    # typer takes a word in brackets for a style, and shows nothing of it
    called.__doc__ = text.replace("[", r"\[")
    return called


def made_of(group: type[Group], given: dict[str, Any]) -> Group:
    """Return a group, its values taken out of ``given``; ``OptionValueError`` for a value that is not a choice."""
    values = {name: given.pop(name) for name in group.FIELDS if name in given}
    for name, _, option, _ in group.options():
        value = values.get(name)
        if option.choices is not None and value is not None and value not in option.choices:
            raise OptionValueError(option.names[0], f"'{value}' is not one of {', '.join(option.choices)}")
    return group(**values)


def _parameters(group: type[Group]) -> Iterator[inspect.Parameter]:
    for name, kind, option, panel in group.options():
        shown = typer.Option(
            *option.names,
            help=option.help,
            metavar=option.metavar or (None if option.choices is None else "|".join(option.choices)),
            envvar=option.envvar,
            min=option.low,
            max=option.high,
            rich_help_panel=panel,
            autocompletion=_completion(option.offers if option.choices is None else partial(tuple, option.choices)),
        )
        yield _parameter(name, Annotated[kind, shown], group.DEFAULTS.get(name, inspect.Parameter.empty))


def _completion(offers: Offers | None) -> Callable[[str], list[str]] | None:
    """Return what a shell asks for the values that a word begins; None: it completes names of files."""
    if offers is None:
        return None

    def beginning(incomplete: str) -> list[str]:
        return [value for value in offers() if value.startswith(incomplete)]

    return beginning


def _unwrapped(paragraph: str) -> str:
    """Return a paragraph as one line: typer keeps the line ends of the source where a terminal has its own."""
    return " ".join(paragraph.split("\n"))


def _argument(parameter: inspect.Parameter) -> inspect.Parameter:
    kind, argument = parameter.annotation.__origin__, parameter.annotation.__metadata__[0]
    shown = typer.Argument(metavar=argument.metavar, help=argument.help, autocompletion=_completion(argument.offers))
    default = None if type(None) in get_args(kind) else inspect.Parameter.empty
    return _parameter(parameter.name, Annotated[kind, shown], default)


def _parameter(name: str, hint: Any, default: Any) -> inspect.Parameter:
    return inspect.Parameter(name, _BY_NAME, annotation=hint, default=default)


class PlainCommand(TyperCommand):
    """A command whose help names an argument without braces, and without its type in Python."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        for each in self.params:
            if isinstance(each, TyperArgument):
                # a copy, since all texts share one type object; without a text of its own typer prints <str>, <path>
                each.type = copy.copy(each.type)
                each.type.get_metavar = lambda *_, **__: ""  # type: ignore[method-assign]

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """Return what follows the name of the command in its line of usage."""
        return [piece.strip("{}") for piece in super().collect_usage_pieces(ctx)]


class CodedGroup(TyperGroup):
    """The commands of ``robolang``: a value that the parser of the command line refuses has its code, too."""

    def invoke(self, ctx: Any) -> Any:
        """Carry the command out; a usage error with a code for a value that is no number or out of its range."""
        try:
            return super().invoke(ctx)
        except typer.BadParameter as error:
            # only what the parser itself refused: its subclasses (ours, a missing parameter) say more than a value
            if type(error) is not typer.BadParameter or error.param is None:
                raise
            raise _coded(error, OptionValueError(error.param.opts[0], error.message.rstrip("."))) from None
        except Exception as error:
            # typer does not export its NoSuchOption; a digit is the rest of a list with spaces: --joints 0 45 -180
            option = getattr(error, "option_name", "")
            if not re.fullmatch(r"-[0-9.]", option):
                raise
            message = "a number stands alone; numbers of one option are separated by commas, without spaces"
            raise _coded(error, OptionValueError(option, message)) from None


def _coded(error: Any, refused: OptionValueError) -> RefusedValueError:
    """Return a usage error with a code in place of one of typer, for the same command."""
    coded = RefusedValueError(refused)
    coded.ctx = error.ctx
    return coded
