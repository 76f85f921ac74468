"""Values of a JSON that anybody may have written: each is checked, with its place, before it is used."""

from collections.abc import Iterator, Sequence
from typing import Any, NoReturn

import numpy as np

import runtime.appearance.codes  # noqa: F401 - registers what is raised here
from runtime.core.faults import Fault
from runtime.core.frames import Array, frozen
from runtime.core.linear import dot, matmul

LONGEST_TEXT = 200
"""Most characters of a name."""
FARTHEST = 1e4
"""No place is further from the origin, m."""
_SQUARE = 1e-6
"""Rounding of a rotation matrix that is printed with nine digits."""


class Untrusted:
    """A value and its place in the JSON (``bodies[3].joint``). Every method raises ``Fault`` RBL833 for another kind of
    value than it returns."""

    def __init__(self, value: Any, place: str) -> None:
        self.value, self.place = value, place

    def fail(self, message: str) -> NoReturn:
        """Raise the fault of this place."""
        raise Fault("RBL833", f"{self.place} {message}")

    def __getitem__(self, key: str) -> "Untrusted":
        if not isinstance(self.value, dict) or key not in self.value:
            self.fail(f"has no '{key}'")
        return Untrusted(self.value[key], f"{self.place}.{key}")

    def items(self, most: int) -> "Iterator[Untrusted]":
        """Yield the values of a list of at most ``most``."""
        if not isinstance(self.value, list) or len(self.value) > most:
            self.fail(f"is not a list of at most {most}")
        for k, value in enumerate(self.value):
            yield Untrusted(value, f"{self.place}[{k}]")

    def pairs(self, most: int) -> "Iterator[tuple[str, Untrusted]]":
        """Yield names and values of an object of at most ``most``."""
        if not isinstance(self.value, dict) or len(self.value) > most:
            self.fail(f"is not an object of at most {most} names")
        for key, value in self.value.items():
            yield Untrusted(key, f"a name in {self.place}").text(), Untrusted(value, f"{self.place}.{key:.40}")

    def text(self, choices: Sequence[str] = ()) -> str:
        """Return a short text, one of ``choices`` where there are any."""
        if not isinstance(self.value, str) or len(self.value) > LONGEST_TEXT:
            self.fail(f"is not a text of at most {LONGEST_TEXT} characters")
        if choices and self.value not in choices:
            self.fail(f"is not one of: {', '.join(choices)}")
        return self.value

    def whole(self, high: int) -> int:
        """Return a whole number from 0 to ``high``."""
        if type(self.value) is not int or not 0 <= self.value <= high:
            self.fail(f"is not a whole number from 0 to {high}")
        return self.value

    def array(self, shape: tuple[int, ...], most: float = FARTHEST) -> Array:
        """Return numbers of a shape, m, each within ``most``; a -1 stands for any length."""
        if not isinstance(self.value, list):
            self.fail("is not a list of numbers")
        try:
            # an array of objects first: numpy would turn the text "1" or True into a number
            raw = np.array(self.value, dtype=object)
            right = all(type(value) in (int, float) for value in raw.flat)
            values = raw.astype(np.float64) if right else np.zeros(0)
        except (ValueError, OverflowError):
            right, values = False, np.zeros(0)
        fits = values.ndim == len(shape) and all(want in (-1, n) for want, n in zip(shape, values.shape, strict=True))
        if not right or not fits:
            self.fail(f"is not an array of {' x '.join('n' if n < 0 else str(n) for n in shape)} numbers")
        if not (np.abs(values) <= most).all():  # NaN too
            self.fail(f"has a number that is not within {most:g}")
        return frozen(values)

    def pose(self) -> Array:
        """Return a pose (4, 4): a rotation and a place."""
        X = self.array((4, 4))
        R = X[:3, :3]
        square = np.abs(matmul(R, R.T) - np.eye(3)).max() <= _SQUARE and dot(np.cross(R[0], R[1]), R[2]) > 0.0
        if not (square and X[3].tolist() == [0.0, 0.0, 0.0, 1.0]):
            self.fail("is not a pose: its rotation is none")
        return X
