"""What kinds of values there are, and how exact a number is."""

from enum import Enum, IntEnum


class Kind(Enum):
    """The kind of a value; ``str`` gives it with its article, as messages need it."""

    NUMBER = "a number"
    TEXT = "a text"
    POSE = "a pose"
    OFFSET = "an offset"
    """``(x, y, z)`` or six values: it has no value of its own and may only follow a pose."""

    def __str__(self) -> str:
        return self.value


class Exactness(IntEnum):
    """How near a number is to the value that the text means: whole numbers and binary fractions are exact, a decimal
    fraction is the float nearest to it, and what is computed further may differ in the last digits."""

    EXACT = 0
    NEAREST = 1
    ROUNDED = 2
