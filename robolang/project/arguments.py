"""Arguments of functions for Python: numbers and settings, and errors that name the argument. Imports nothing heavy."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypedDict

from robolang.core.calls import refuse
from runtime.settings.profile import ServoMode

PathLike = Path | str
Settings = Mapping[str, Any]
"""Dotted key of ``[controller]`` to value, such as ``{"servo.mode": "fixed"}``; docs/servo.md has the keys."""
POSE = ("x mm", "y mm", "z mm", "rx deg", "ry deg", "rz deg")
_MOST = 1e9
"""The largest number of an argument: that of a number in a file (RBL604)."""


class Files(TypedDict, total=False):
    """What replaces the files beside a program: paths of cell and profile, a built-in robot or the path of one, and
    settings of the controller."""

    cell: PathLike | None
    robot: PathLike | None
    profile: PathLike | None
    settings: Settings | None
    servo: ServoMode | None


def numbers(values: Sequence[float], argument: str, names: Sequence[str]) -> tuple[float, ...]:
    """Return finite numbers, one for each of ``names``; ``Fault`` RBL703."""
    found = tuple(float(value) for value in values)
    if len(found) != len(names):
        refuse(argument, f"{len(names)} numbers are needed ({', '.join(names)}), but {len(found)} given")
    for name, value in zip(names, found, strict=True):
        # written so that NaN is refused too
        if not abs(value) <= _MOST:
            refuse(argument, f"{name} is {value:g}")
    return found


def options_of(files: Files) -> dict[str, tuple[str, Any]]:
    """Return the settings among ``files`` as ``load_project`` takes them, each with the argument that it comes from."""
    # the second of each pair is what a message calls the setting
    found = {key: (f'settings["{key}"]', value) for key, value in (files.get("settings") or {}).items()}
    servo = files.get("servo")
    return found if servo is None else found | {"servo.mode": ("servo", servo)}


def points_text(points: Mapping[str, Sequence[float]]) -> str:
    """Return the text of a points file of poses, mm and deg; ``Fault`` RBL703."""
    lines = ["schema = 1"]
    for name, pose in points.items():
        # a name that is a word of the language is refused by the reader of the file
        if not (name.isascii() and name.isidentifier()):
            refuse("points", f"'{name}' is no name of a point")
        lines += [f"[points.{name}]", f"pose = {list(numbers(pose, f'points[{name!r}]', POSE))}"]
    return "\n".join([*lines, ""])
