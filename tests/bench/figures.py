"""What every bench and campaign prints: one row for each figure, named as in docs/measured.md.

``tests/bench/test_figures.py`` runs each of them at its smallest size and compares the names with the page.
"""

import argparse
import math
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """One figure."""

    figure: str
    """Its name: the first cell of its row in docs/measured.md."""
    form: str
    """What was measured, with a replacement field for each value."""
    values: tuple[float, ...]
    good: bool = True
    """Whether what is promised holds; a row that promises nothing is good."""
    details: tuple[str, ...] = ()
    """Lines for a reader who wants to know more."""

    def __post_init__(self) -> None:
        assert self.form.count("{") == len(self.values) > 0, self.figure

    @property
    def measured(self) -> str:
        """Return the text of what was measured."""
        return self.form.format(*self.values)

    @property
    def finite(self) -> bool:
        """Return whether every value is a finite number."""
        return all(math.isfinite(value) for value in self.values)

    def __str__(self) -> str:
        head = f"{self.figure}: {self.measured}{'' if self.good else '  NOT AS PROMISED'}"
        return "\n".join([head, *(f"    {line}" for line in self.details)])


Rows = Callable[[bool], Iterator[Row]]
"""Measures and gives the rows of a bench; True: at the smallest size, which shows that it works and no figure."""


def run(rows: Rows) -> None:
    """Print the rows; exit code 1 when one is not as promised."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--smallest", action="store_true", help="least work: shows that the bench works, no figures")
    good = True
    for row in rows(parser.parse_args().smallest):
        print(row, flush=True)
        good &= row.good and row.finite
    sys.exit(not good)
