"""Calls from Python: an argument that is unknown, missing or of another kind than the signature says is RBL703.

A signature is the one place that says what a function takes: editors and type checkers read it, and ``checked`` holds
callers to it. Kinds alone are judged here; whether a number is in its range is judged where the range is known.
"""

import functools
import numbers
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from types import NoneType, UnionType
from typing import (
    TYPE_CHECKING,
    Any,
    Literal,
    NoReturn,
    ParamSpec,
    TypeVar,
    Union,
    get_args,
    get_origin,
    get_type_hints,
)

import robolang.core.codes  # noqa: F401 - the codes raised here must be registered
from runtime.core.faults import Fault

if TYPE_CHECKING:
    from inspect import Signature

_P = ParamSpec("_P")
_R = TypeVar("_R")

_HINT = "docs/python.md has the arguments; help() of the function prints them with their units."
_SHOWN = 60
"""Characters of a value that a message shows."""


def refuse(argument: str, message: str, hint: str = _HINT) -> NoReturn:
    """Raise ``Fault`` RBL703 for an argument."""
    raise Fault("RBL703", f"{argument}: {message}", hint)


def checked(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """Return a function that refuses what its signature does not take; ``Fault`` RBL703 names the argument."""

    @functools.wraps(function)
    def called(*args: _P.args, **named: _P.kwargs) -> _R:
        _check(function, args, named)
        return function(*args, **named)

    return called


def _check(function: Callable[..., Any], args: tuple[Any, ...], named: Mapping[str, Any]) -> None:
    signature, name = _signature(function), function.__name__
    for word in named:
        if word not in signature.parameters:
            refuse(word, f"{name} has no such argument", _nearest(word, list(signature.parameters)))
    try:
        given = signature.bind(*args, **named).arguments
    except TypeError as error:
        raise Fault("RBL703", f"{name}: {error}", _HINT) from None
    for argument, value in given.items():
        parameter = signature.parameters[argument]
        values = value if parameter.kind is parameter.VAR_POSITIONAL else (value,)
        for each in values:
            # the class of a class method has no annotation
            if parameter.annotation is not parameter.empty and not _fits(each, parameter.annotation):
                refuse(argument, f"{_needed(parameter.annotation)} is needed, but {_shown(each)} is given")


@functools.cache
def _signature(function: Callable[..., Any]) -> "Signature":
    import inspect  # a check of a program imports this module, and calls nothing of it

    found = inspect.signature(function, eval_str=True)
    parameters: list[inspect.Parameter] = []
    for each in found.parameters.values():
        if each.kind is each.VAR_KEYWORD:  # annotated as what a TypedDict has
            (table,) = get_args(each.annotation)
            parameters += [
                inspect.Parameter(name, each.KEYWORD_ONLY, default=None, annotation=hint)
                for name, hint in get_type_hints(table).items()
            ]
        else:
            parameters.append(each)
    return found.replace(parameters=parameters)


def _nearest(word: str, choices: Sequence[str]) -> str:
    import difflib  # needed for a hint only

    found = difflib.get_close_matches(word, choices, n=1)
    return f"did you mean {found[0]}?" if found else f"these are known: {', '.join(choices)}"


def _shown(value: object) -> str:
    text = repr(value)
    return f"{text if len(text) <= _SHOWN else text[:_SHOWN] + '...'} ({type(value).__name__})"


def _fits(value: Any, hint: Any) -> bool:
    """Return whether a value is of the kind of an annotation."""
    origin, inner = get_origin(hint), get_args(hint)
    if origin in (UnionType, Union):
        return any(_fits(value, each) for each in inner)
    if origin is Literal:
        return isinstance(value, str) and value in inner
    if origin is not None and issubclass(origin, Mapping):
        return isinstance(value, Mapping) and all(_fits(each, inner[1]) for each in value.values())
    if origin is not None:
        return _is_list(value) and all(_fits(each, inner[0]) for each in value)
    return hint is Any or _is_one(value, hint)


def _is_one(value: object, hint: Any) -> bool:
    truth = type(value).__name__ in ("bool", "bool_")  # numpy has its own
    if hint is bool:
        return truth
    plain: Any = {float: numbers.Real, int: numbers.Integral}.get(hint)
    return isinstance(value, hint) if plain is None else isinstance(value, plain) and not truth


def _is_list(value: Any) -> bool:
    # an array of numpy is no Sequence, and one without dimensions is no list although it seems to be iterable
    listed = isinstance(value, Iterable) and hasattr(value, "__len__") and getattr(value, "shape", None) != ()
    return listed and not isinstance(value, str | bytes | Mapping)


_WORDS: Mapping[Any, str] = {
    bool: "True or False",
    float: "a number",
    int: "a whole number",
    str: "a text",
    os.PathLike: "a path",
    NoneType: "None",
}


def _needed(hint: Any) -> str:
    """Return what an annotation means, in words."""
    origin, inner = get_origin(hint), get_args(hint)
    if origin in (UnionType, Union):
        return " or ".join(dict.fromkeys(map(_needed, inner)))
    if origin is Literal:
        return f"one of {', '.join(map(repr, inner))}"
    if origin is not None and issubclass(origin, Mapping):
        return f"a dict of names with {_needed(inner[1])}" if inner[1] is not Any else "a dict"
    if origin is not None:
        return f"a list of {_needed(inner[0]).removeprefix('a ')}s"
    return _WORDS.get(hint) or ("a path" if issubclass(hint, os.PathLike) else f"a {hint.__name__}")
