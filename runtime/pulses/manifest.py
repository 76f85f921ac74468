"""A file read without trust, and the strict JSON of a manifest with typed getters that name the key at fault.

Reading is bounded: regular files of the folder itself, up to a number of bytes (``MAX_MANIFEST_BYTES`` of a manifest),
no links, no pipes. A folder may come from anywhere, so it is read as one from a stranger. JSON is taken strictly: no
NaN, no Infinity, no number beyond any float, no key twice. Every error is a ``FileFault`` RBL630: of the text at its
line and column; of a value by its key, as in ``channels.2.min_hz``, since the manifest has no lines worth naming.
"""

import errno
import json
import math
import re
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from runtime.core.bounded_files import RefusedError, read_bounded
from runtime.core.frames import Array, frozen
from runtime.core.linear import matmul
from runtime.core.tomlfile import MAX_ABS, FileFault, FilePlace

MAX_MANIFEST_BYTES = 16_000_000
POSE_TOLERANCE = 1e-6
"""A matrix of the manifest is a rotation when R R' is the unit matrix within this."""


# --- a file ----------------------------------------------------------------------------------------------------------


def fail(path: Path, code: str, message: str, hint: str = "", place: FilePlace | None = None) -> NoReturn:
    """Raise ``FileFault`` at a place of a file; without one at its start, for the file as a whole or a key of it."""
    raise FileFault(code, message, hint, place or FilePlace(str(path))) from None


def reason(error: Exception) -> str:
    """Return the reason for which a file cannot be used, without the path that an ``OSError`` adds."""
    return str(getattr(error, "strerror", None) or error)


def read_text(path: Path, most: int) -> str:
    """Return the text of a small regular UTF-8 file, never of one that a link leads to; ``FileFault`` RBL630."""
    try:
        raw = read_bounded(path, most, links=False)  # a link could lead out of the folder
    except RefusedError as refused:
        if isinstance(refused.error, OSError) and refused.error.errno in (errno.ELOOP, errno.EMLINK):
            fail(path, "RBL630", f"{path} is a link", "put the file itself into the folder")
        if refused.error is not None:
            fail(path, "RBL630", f"cannot {'read' if refused.opened else 'open'} {path}: {refused.reason}")
        if refused.mode is not None:
            fail(path, "RBL630", f"{path} is not a regular file")
        fail(path, "RBL630", f"{path} has {refused.size} bytes, more than {most}")
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        fail(path, "RBL630", f"{path} is not UTF-8 text (byte {error.start})", place=FilePlace(str(path), line))


# --- words of a message ----------------------------------------------------------------------------------------------


def type_name(value: object) -> str:
    """Return the kind of a JSON value as messages name it, such as 'a number'."""
    names = {bool: "a boolean", str: "a text", int: "a number", float: "a number", list: "a list", dict: "an object"}
    return names.get(type(value), "null")


def quoted(text: str) -> str:
    """Return a text in quotes, cut off when it is long."""
    return f"'{text}'" if len(text) <= 40 else f"'{text[:37]}...'"


def digits(value: int) -> str:
    """Return an integer for a message; Python refuses to print one of more than 4300 digits."""
    return str(value) if abs(value) < 10**20 else f"a whole number of {value.bit_length()} bits"


# --- strict JSON -----------------------------------------------------------------------------------------------------

_TOKENS = re.compile(r'"(?:[^"\\]|\\.)*"|(-?(?:NaN|Infinity))', re.DOTALL)


def read_json(path: Path) -> dict[str, Any]:
    """Return the object of a strict JSON file; ``FileFault`` RBL630 at the line of an error."""
    text = read_text(path, MAX_MANIFEST_BYTES)
    try:
        found = json.loads(text, parse_constant=_constant, parse_float=_finite, object_pairs_hook=_once)
    except json.JSONDecodeError as error:
        _fail_in(path, text, error.pos, f"{path.name} is not JSON: {error.msg}")
    except _ConstantError as error:
        # json gives no position of a constant: the first one outside of texts is it
        at = next((match.start() for match in _TOKENS.finditer(text) if match[1]), 0)
        _fail_in(path, text, at, f"{path.name} is not strict JSON: {error} is not a number")
    except RecursionError:
        fail(path, "RBL630", f"{path.name} is nested too deeply")
    except ValueError as error:  # int() refuses a literal of thousands of digits
        fail(path, "RBL630", f"{path.name} is not strict JSON: {error}")
    if not isinstance(found, dict):
        fail(path, "RBL630", f"{path.name} must hold an object, not {type_name(found)}")
    return found


class _ConstantError(ValueError):
    """NaN or Infinity in a JSON text."""


def _constant(word: str) -> NoReturn:
    raise _ConstantError(word)


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{quoted(text)} is too large")
    return value


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    # json keeps the last of two keys silently, and two readers may then see two different files
    found = dict(pairs)
    if len(found) < len(pairs):
        twice, _ = Counter(key for key, _ in pairs).most_common(1)[0]
        raise ValueError(f"an object has the key {quoted(twice)} twice")
    return found


def _fail_in(path: Path, text: str, at: int, message: str) -> NoReturn:
    """Raise ``FileFault`` RBL630 at a character (0-based) of the text."""
    start = text.rfind("\n", 0, at) + 1
    excerpt = text[start:].partition("\n")[0].removesuffix("\r")
    fail(path, "RBL630", message, place=FilePlace(str(path), text.count("\n", 0, at) + 1, at - start + 1, excerpt))


# --- typed getters ---------------------------------------------------------------------------------------------------


class Object:
    """An object of the manifest being read: typed getters that name the key, as in ``channels.2.min_hz``."""

    def __init__(self, path: Path, data: dict[str, Any], name: str) -> None:
        self._path, self._data, self._name = path, data, name

    def __contains__(self, key: str) -> bool:
        return key in self._data

    def name(self, key: str) -> str:
        """Return the dotted name of a key, list entries counted from 1."""
        return f"{self._name}.{key}" if self._name else key

    def fail(self, key: str, message: str, code: str = "RBL630", hint: str = "") -> NoReturn:
        """Raise ``FileFault`` for a key: ``'channels.2.min_hz' MESSAGE``."""
        fail(self._path, code, f"'{self.name(key)}' {message}", hint)

    def value(self, key: str) -> Any:
        """Return the value of a key, of any kind; ``FileFault`` RBL630 when it is missing."""
        if key not in self._data:
            self.fail(key, "is missing")
        return self._data[key]

    def keys(self) -> list[str]:
        """Return the keys of the object."""
        return list(self._data)

    def number(self, key: str, low: float = -MAX_ABS, high: float = MAX_ABS) -> float:
        """Return a number from ``low`` to ``high``."""
        return self._checked(key, self.value(key), low, high)

    def _checked(self, key: str, value: object, low: float, high: float) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.fail(key, f"must be a number, not {type_name(value)}")
        if not low <= value <= high:  # before float(), which raises for an integer beyond any float
            shown = f"{value:g}" if isinstance(value, float) else digits(value)
            self.fail(key, f"is {shown} and must be between {low:g} and {high:g}")
        return float(value)

    def whole(self, key: str, low: int, high: int) -> int:
        """Return a whole number from ``low`` to ``high``, written as one."""
        value = self.value(key)
        if isinstance(value, bool) or not isinstance(value, int):
            self.fail(key, "must be a whole number" + ("" if isinstance(value, float) else f", not {type_name(value)}"))
        self._checked(key, value, low, high)
        return value

    def numbers(self, key: str, count: int, low: float = -MAX_ABS, high: float = MAX_ABS) -> list[float]:
        """Return a list of ``count`` numbers."""
        return self._numbers(key, self.value(key), count, low, high)

    def _numbers(self, key: str, value: object, count: int, low: float, high: float) -> list[float]:
        if not isinstance(value, list) or len(value) != count:
            got = f"{len(value)} entries" if isinstance(value, list) else type_name(value)
            self.fail(key, f"must be a list of {count} numbers, not {got}")
        return [self._checked(key, item, low, high) for item in value]

    def text(self, key: str, choices: Sequence[str] = ()) -> str:
        """Return a text, one of ``choices`` when given."""
        value = self.value(key)
        if not isinstance(value, str):
            self.fail(key, f"must be a text, not {type_name(value)}")
        if choices and value not in choices:
            self.fail(key, f"is {quoted(value)} and must be one of {', '.join(choices)}")
        return value

    def entries(self, key: str) -> list[Any]:
        """Return a list."""
        value = self.value(key)
        if not isinstance(value, list):
            self.fail(key, f"must be a list, not {type_name(value)}")
        return value

    def child(self, key: str) -> "Object":
        """Return the object that a key holds."""
        return self._child(key, self.value(key))

    def _child(self, key: str, value: object) -> "Object":
        if not isinstance(value, dict):
            self.fail(key, f"must be an object, not {type_name(value)}")
        return Object(self._path, value, self.name(key))

    def children(self, key: str) -> "list[Object]":
        """Return the objects of a list."""
        return [self._child(f"{key}.{count}", value) for count, value in enumerate(self.entries(key), start=1)]

    def pose(self, key: str) -> Array:
        """Return a pose (4, 4), m."""
        return self._pose(key, self.value(key))

    def poses(self, key: str) -> tuple[Array, ...]:
        """Return a list of poses (4, 4), m."""
        return tuple(self._pose(f"{key}.{count}", value) for count, value in enumerate(self.entries(key), start=1))

    def _pose(self, key: str, value: object) -> Array:
        if not isinstance(value, list) or len(value) != 4:
            self.fail(key, "must be a pose of 4 rows of 4 numbers")
        X = np.array([self._numbers(f"{key}.{row}", each, 4, -MAX_ABS, MAX_ABS) for row, each in enumerate(value, 1)])
        R = X[:3, :3]
        # orthogonal and right-handed: a mirrored frame has det -1 and would pass the first test
        off = np.maximum(np.abs(matmul(R, R.T) - np.eye(3)).max(), np.abs(X[3] - (0.0, 0.0, 0.0, 1.0)).max())
        if not (off <= POSE_TOLERANCE and np.linalg.det(R) > 0.0):
            self.fail(key, "is not a pose: three rows of a rotation with a position in m, then 0, 0, 0, 1")
        return frozen(X)
