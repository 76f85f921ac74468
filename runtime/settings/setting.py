"""A key of ``[controller]``, declared at the field that holds its value.

The declaration gives the key, its unit, range and default as people write them, and how they become SI. Readers,
``--set``, ``config show`` and the profile come from it, so that a new setting is one field of one record.
"""

from collections.abc import Callable, Iterator
from typing import Any

from runtime.core import record
from runtime.core.record import Record
from runtime.core.tomlfile import Table
from runtime.core.units import DEG, MM

_SI = {"ms": 1e-3, "deg": DEG, "deg/s": DEG, "mm": MM}
"""Factor from a unit to SI; numbers of other units are SI already."""


class _Group(Record, kw_only=False):
    """A table of settings: its key, and the record that holds them."""

    key: str
    kind: type[Record]


class Setting(Record):
    """One key: how it is read, its unit and default in a file, and how a value of a file becomes the field's."""

    key: str
    unit: str
    default: Any
    read: Callable[[Table, str], Any]
    si: Callable[[Any], Any]


def number(key: str, default: float, unit: str = "", *, si: Callable[[float], Any] | None = None, **limits: Any) -> Any:
    """Declare a number; ``limits`` as of ``Table.number``."""
    return _declared(key, unit, default, lambda table, name: table.number(name, **limits), si or _scaled(unit))


def whole(key: str, default: int, unit: str = "", *, low: int, high: int) -> Any:
    """Declare a whole number."""
    return _declared(key, unit, default, lambda table, name: table.integer(name, low=low, high=high))


def choice(key: str, default: str, *others: str) -> Any:
    """Declare one of some words."""
    return _declared(key, "", default, lambda table, name: table.text(name, choices=(default, *others)))


def text(key: str) -> Any:
    """Declare a text, by default an empty one."""
    return _declared(key, "", "", lambda table, name: table.text(name))


def flag(key: str, default: bool) -> Any:
    """Declare a truth value."""
    return _declared(key, "", default, lambda table, name: table.flag(name, default))


def three(key: str, default: tuple[float, ...], unit: str) -> Any:
    """Declare three positive numbers, for J4, J5 and J6 or whatever the wrist axes are."""
    scaled = _scaled(unit)
    read: Callable[[Table, str], Any] = lambda table, name: table.numbers(name, 3, positive=True, high=1e5)  # noqa: E731
    return _declared(key, unit, default, read, lambda values: tuple(scaled(value) for value in values))


def each_axis(key: str, unit: str) -> Any:
    """Declare a positive number for all axes, or a list with one for each; by default none."""
    return _declared(key, unit, (), _one_or_each)


def custom(key: str, default: Any, unit: str, read: Callable[[Table, str], Any], si: Callable[[Any], Any]) -> Any:
    """Declare a key with a reader and a conversion of its own."""
    return _declared(key, unit, default, read, si)


def group(key: str, kind: type[Record]) -> Any:
    """Declare a table of settings, which are the fields of a record."""
    return record.default(factory=kind, note=_Group(key, kind))


def settings_of(kind: type[Record]) -> dict[str, Setting]:
    """Return the settings of a record by the names of its fields."""
    return {name: note for name, note in kind.NOTES.items() if isinstance(note, Setting)}


def groups_of(kind: type[Record]) -> Iterator[tuple[str, str, type[Record]]]:
    """Yield the tables of a record: name of the field, key, and the record of the table."""
    for name, note in kind.NOTES.items():
        if isinstance(note, _Group):
            yield name, note.key, note.kind


def _declared(
    key: str,
    unit: str,
    default: Any,
    read: Callable[[Table, str], Any],
    si: Callable[[Any], Any] = lambda value: value,
) -> Any:
    setting = Setting(key=key, unit=unit, default=default, read=read, si=si)
    return record.default(si(default), note=setting)


def _scaled(unit: str) -> Callable[[float], float]:
    scale = _SI.get(unit)
    # untouched without a scale: times 1.0 a whole number would become a float
    return (lambda value: value) if scale is None else (lambda value: value * scale)


def _one_or_each(table: Table, name: str) -> tuple[float, ...]:
    limits: dict[str, Any] = {"positive": True, "high": 1e5}
    return table.numbers(name, None, **limits) if table.holds(name, list) else (table.number(name, **limits),)
