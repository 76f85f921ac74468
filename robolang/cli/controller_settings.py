"""From the options of the controller to its settings, as ``robolang.project.project.load_project`` takes them.

Each option is a key of ``[controller]`` (docs/language.md); ``--set`` gives those without an option of their own.
"""

import tomllib
from typing import Any

from robolang.cli.options import ControllerOptions, SettingsOptions
from robolang.cli.usage import OptionValueError

Settings = dict[str, tuple[str, Any]]
"""Dotted key to (name of the option, value)."""


def settings_of(group: SettingsOptions) -> Settings:
    """Return the settings that were given; ``OptionValueError`` for a value or a combination that makes no sense."""
    found: Settings = {}
    # --set first: where an option of its own gives the same key, that one is in force
    for text in group.settings or []:
        key, value = _setting(text)
        found[key] = ("--set", value)
    if isinstance(group, ControllerOptions):
        found.update(_gains(group))
    for name, _, option, _ in group.options():
        value = getattr(group, name)
        if option.key is not None and value is not None:
            if not value:
                raise OptionValueError(option.names[0], "is empty")
            # the choices of an option are texts, and the only number among them is this one
            found[option.key] = (option.names[0], float(value) if option.key == "servo_period_ms" else value)
    return found


def _gains(group: ControllerOptions) -> Settings:
    """Return what ``--fixed-at`` means beside its own key: fixed gains. Scheduled gains with it are refused."""
    if group.fixed_at is None:
        return {}
    if group.servo == "scheduled":
        raise OptionValueError("--fixed-at", "scheduled gains are not fixed; leave out --servo scheduled")
    return {"servo.mode": ("--fixed-at", "fixed")}


def _setting(text: str) -> tuple[str, Any]:
    """Split ``KEY=VALUE``; the value as TOML writes it, or a bare word."""
    key, equals, value = text.partition("=")
    key, value = key.strip().removeprefix("controller."), value.strip()
    # a second line would be a key of its own in the TOML below
    if not (key and equals and value) or "\n" in value:
        raise OptionValueError("--set", f"'{text[:60]}' is not KEY=VALUE")
    try:
        return key, tomllib.loads(f"value = {value}")["value"]
    # a word without quotes, such as scheduled; brackets 1000 deep; a whole number of more digits than int takes
    except (tomllib.TOMLDecodeError, RecursionError, ValueError):
        return key, value
