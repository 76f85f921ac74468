"""A line of G-code as its words: letters with numbers, which parameters and expressions may stand for."""

import math
import re
from collections.abc import Callable

NUMBER = re.compile(r"\d+\.?\d*|\.\d+")
NAME = re.compile(r"\d+|<[^>]+>")
FUNCTIONS: dict[str, Callable[[float], float]] = {
    "abs": abs,
    "acos": lambda x: math.degrees(math.acos(x)),
    "asin": lambda x: math.degrees(math.asin(x)),
    "cos": lambda x: math.cos(math.radians(x)),
    "exp": math.exp,
    "fix": math.floor,
    "fup": math.ceil,
    "ln": math.log,
    "round": round,
    "sin": lambda x: math.sin(math.radians(x)),
    "sqrt": math.sqrt,
    "tan": lambda x: math.tan(math.radians(x)),
}
LEVELS: tuple[dict[str, Callable[[float, float], float]], ...] = (
    {"+": lambda a, b: a + b, "-": lambda a, b: a - b},
    {"*": lambda a, b: a * b, "/": lambda a, b: a / b, "mod": lambda a, b: a % b},
    {"**": lambda a, b: a**b},
)
"""Operators from the weakest to the strongest."""


class UnsupportedError(Exception):
    """A program that asks for what these tools do not read."""


class Words:
    """The words of a line without blanks and comments; assignments to ``parameters`` take effect."""

    def __init__(self, text: str, parameters: dict[str, float]) -> None:
        self._text, self._at, self._parameters = text, 0, parameters
        self.g: list[float] = []
        self.m: list[float] = []
        self.values: dict[str, float] = {}
        assigned: list[tuple[str, float]] = []
        while self._at < len(text):
            letter = text[self._at]
            self._at += 1
            if letter == "#":
                name = self._name()
                self._take("=")
                assigned.append((name, self._sum(0)))
            elif letter == "o" or not letter.isalpha():
                raise UnsupportedError(text)
            else:
                self._word(letter)
        # a line reads the parameters as they were before it
        parameters.update(assigned)

    @property
    def other_axes(self) -> str:
        """The axes of the line that are not X, Y or Z."""
        return "".join(each for each in "abcuvw" if each in self.values).upper()

    def _word(self, letter: str) -> None:
        value = self._value()
        if letter in "gm":
            (self.g if letter == "g" else self.m).append(round(value, 1))
        else:
            self.values[letter] = value

    def _take(self, mark: str) -> bool:
        found = self._text.startswith(mark, self._at)
        self._at += len(mark) if found else 0
        return found

    def _match(self, pattern: re.Pattern[str]) -> str:
        found = pattern.match(self._text, self._at)
        if found is None:
            raise UnsupportedError(self._text)
        self._at = found.end()
        return found[0]

    def _name(self) -> str:
        # a parameter of a parameter: its number is computed
        return f"{self._value():g}" if self._text[self._at] in "#[" else self._match(NAME)

    def _value(self) -> float:
        if self._take("-"):
            return -self._value()
        if self._take("+"):
            return self._value()
        if self._take("#"):
            return self._parameters.get(self._name(), 0.0)
        if self._take("["):
            value = self._sum(0)
            if not self._take("]"):
                raise UnsupportedError(self._text)
            return value
        for name, function in FUNCTIONS.items():
            if self._take(f"{name}["):
                self._at -= 1
                return float(function(self._value()))
        return float(self._match(NUMBER))

    def _sum(self, level: int) -> float:
        if level == len(LEVELS):
            return self._value()
        value = self._sum(level + 1)
        while sign := self._operator(level):
            value = LEVELS[level][sign](value, self._sum(level + 1))
        return value

    def _operator(self, level: int) -> str:
        for sign in LEVELS[level]:
            if sign == "*" and self._text.startswith("**", self._at):
                continue
            if self._take(sign):
                return sign
        return ""
