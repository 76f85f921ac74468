"""What a message says whatever its words are."""

import re


def numbers(message: str) -> list[float]:
    """Return the numbers of a message in their order: what it says whatever its words are."""
    return [float(each) for each in re.findall(r"(?<![\w.])[-+]?\d+(?:\.\d+)?|(?<=J)\d", message)]
