"""Values of a robot file that are estimates: ``key = { estimate = 105.0, rule = "motor at 315 rad/s" }``.

The value and its mark are one thing: whoever knows better writes the plain value in its place, and the mark is gone.
A reader gets the values as if they were plain, and beside them which ones are estimates, with their rules. A robot file
that is written by hand may name them together instead, ``*`` for any part of a name and ``[1-3]`` for some axes:

    estimated = ["path.*", "axes.[456].max_speed_deg_s"]
"""

from collections.abc import Iterator, Mapping
from fnmatch import fnmatchcase
from types import MappingProxyType
from typing import Any

from runtime.core.record import Record
from runtime.core.tomlfile import Source, Table, load_table
from runtime.robot.model.drives import texts

ESTIMATE, RULE = "estimate", "rule"


class Marked(Record):
    """A TOML file as if its estimates were plain values: ``content``, the ``rules`` of estimates by dotted name.

    Names are those of messages, axes counted from 1: ``axes.1.motor.gear_ratio``.
    """

    table: Table
    content: dict[str, Any]
    rules: dict[str, str]

    def estimated(self) -> dict[str, str]:
        """Return the rules of all estimates, those of the list without one; ``FileFault`` RBL613, RBL610.

        Asked for last: what else is wrong in a file is more useful to know than a name in its list.
        """
        names, found = list(_names(self.content, "")), dict[str, str]()
        for pattern in texts(self.table, "estimated"):
            matching = [name for name in names if fnmatchcase(name, pattern)]
            # a name that is misspelt would call an estimate a published value
            if not matching:
                self.table.fail("RBL610", f"'{pattern}' names no value of this file", key="estimated")
            found |= dict.fromkeys(matching, "")
        return {**found, **self.rules}


def load_marked(source: Source, estimates: Mapping[str, Any] = MappingProxyType({})) -> Marked:
    """Return a TOML file with its estimates; ``FileFault`` RBL601.

    ``estimates`` is the content of a file of the same form: what ``source`` lacks is taken from there.
    """
    rules: dict[str, str] = {}
    content: dict[str, Any] = {}

    def prepare(data: dict[str, Any]) -> dict[str, Any]:
        content.update(_plain(_filled(data, estimates), "", rules))
        return content

    return Marked(table=load_table(source, prepare=prepare), content=content, rules=rules)


def _names(value: Any, name: str) -> Iterator[str]:
    """Yield the dotted names of all values, axes counted from 1; a list of numbers is one value."""
    if isinstance(value, dict):
        for key, each in value.items():
            yield from _names(each, f"{name}.{key}" if name else key)
    elif isinstance(value, list) and value and all(isinstance(each, dict) for each in value):
        for k, each in enumerate(value, start=1):
            yield from _names(each, f"{name}.{k}")
    else:
        yield name


def _filled(data: Any, estimates: Any) -> Any:
    """Return content with what it lacks; lists of tables are filled table by table, other values are kept."""
    if isinstance(data, dict) and isinstance(estimates, Mapping) and ESTIMATE not in data:
        return {**estimates, **{key: _filled(each, estimates.get(key)) for key, each in data.items()}}
    tables = isinstance(data, list) and isinstance(estimates, list) and len(data) == len(estimates)
    if tables and all(isinstance(each, dict) for each in data):
        return [_filled(each, other) for each, other in zip(data, estimates, strict=True)]
    return data


def _plain(value: Any, name: str, rules: dict[str, str]) -> Any:
    # anything else in such a table is left as it is: the reader of the key then says that a table is no number
    if isinstance(value, dict) and ESTIMATE in value and set(value) <= {ESTIMATE, RULE}:
        rules[name] = str(value.get(RULE, ""))
        return value[ESTIMATE]
    if isinstance(value, dict):
        return {key: _plain(each, f"{name}.{key}" if name else key, rules) for key, each in value.items()}
    if isinstance(value, list):
        return [_plain(each, f"{name}.{k}", rules) for k, each in enumerate(value, start=1)]
    return value
