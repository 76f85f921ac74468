"""Values of a robot file that are estimates: ``key = { estimate = 105.0, rule = "motor at 315 rad/s" }``.

The value and its mark are one thing: whoever knows better writes the plain value in its place, and the mark is gone.
A reader gets the values as if they were plain, and beside them which ones are estimates, with their rules.
"""

from typing import Any

from runtime.core.tomlfile import Source, Table, load_table

ESTIMATE, RULE = "estimate", "rule"


def load_marked(source: Source) -> tuple[Table, dict[str, str]]:
    """Return a TOML file as if its estimates were plain values, and the rules of these by dotted name.

    Names are those of messages, axes counted from 1: ``axes.1.motor.gear_ratio``. ``FileFault`` RBL601.
    """
    rules: dict[str, str] = {}
    return load_table(source, prepare=lambda data: _plain(data, "", rules)), rules


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
