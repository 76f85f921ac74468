"""Some ticks of a log, such as those of one line of its program."""

from collections.abc import Iterator, Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from robolang.core import tables
from robolang.logs.human_units import HumanUnits
from robolang.logs.quantities import SignalSource
from robolang.logs.selection import selected
from runtime.core.frames import Array


class WholeLog(SignalSource, Protocol):
    """The log that an excerpt is of."""

    @property
    def joint_units(self) -> Array:
        """Unit of each axis in SI (n,)."""

    def __iter__(self) -> Iterator[str]:
        """Yield the names."""

    def __getitem__(self, name: str, /) -> Array:
        """Return a whole signal."""

    def base(self, name: str) -> str:
        """Return what a row of a signal is."""


class Excerpt(HumanUnits, Mapping[str, Array]):
    """Signals of ticks of a log by name, SI; ``ticks`` (M,) are the rows that it has. Signals of frames are none."""

    def __init__(self, log: WholeLog, ticks: NDArray[np.int64]) -> None:
        self.log, self.ticks = log, ticks

    @property
    def joint_units(self) -> Array:
        """Unit of each axis in SI (n,)."""
        return self.log.joint_units

    def __getitem__(self, name: str) -> Array:
        """Return rows of a signal; ``KeyError``."""
        if name not in self:
            raise KeyError(f"there is no signal of ticks {name!r}; these are known: {', '.join(self)}")
        # once for each name of a long log: what is kept of it is kept there
        return np.asarray(self.log[name][self.ticks])

    def __iter__(self) -> Iterator[str]:
        """Yield the names of signals of ticks."""
        return (name for name in self.log if self.log.base(name) == "tick")

    def __len__(self) -> int:
        """Return how many signals there are."""
        return sum(1 for _ in self)

    def __contains__(self, name: object) -> bool:
        """Return whether there is such a signal of ticks, without computing it."""
        return isinstance(name, str) and name in self.log and self.log.base(name) == "tick"

    def to_pandas(self, *signals: str) -> Any:
        """Return a ``pandas.DataFrame`` of signals as ``robolang log export`` names them, by the time; all without any.

        ``ImportError`` without pandas, ``Fault`` RBL838 for an unknown signal.
        """
        return tables.to_pandas(self._columns(signals))

    def to_polars(self, *signals: str) -> Any:
        """Return a ``polars.DataFrame`` in the same form; ``ImportError`` without polars."""
        return tables.to_polars(self._columns(signals))

    def _columns(self, signals: tuple[str, ...]) -> dict[str, Array]:
        chosen = [column for text in signals or ("t", *self) for column in selected(self.log, self, text)]
        # the time first, whatever is chosen: rows of a line may lie far apart
        made: dict[str, Array] = {"t": self["t"]}
        for column in chosen:
            values = self[column.signal]
            made[column.name] = values.reshape(len(values), -1)[:, column.index]
        return made

    def __repr__(self) -> str:
        """Return one line."""
        return f"<Excerpt of {len(self.ticks)} ticks of {self.log!r}>"
