"""The names of one scope, as a prompt or a debugger shows them."""

from collections.abc import Mapping
from dataclasses import dataclass

from robolang.interpreter.arrays import Array
from robolang.interpreter.scope import Scope
from robolang.values.poses import Value


@dataclass(frozen=True, slots=True, kw_only=True)
class Variables:
    """Names with a value, arrays, and which of the names are constants; copies, which the program does not change."""

    values: Mapping[str, Value]
    arrays: Mapping[str, Array]
    constants: frozenset[str]


def variables_of(scope: Scope) -> Variables:
    """Return the names of a scope as they are now."""
    return Variables(
        values=scope.values.copy(),
        arrays={key: array.copy() for key, array in scope.arrays.items()},
        constants=frozenset(scope.constants),
    )
