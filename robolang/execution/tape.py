"""Lists of a record that only grow, kept by snapshots in blocks that they share.

A timeline takes a snapshot at every statement. Copying a list whole would cost the square of its length; a tape seals
what does not change any more in blocks, and a snapshot holds the blocks and a copy of the rest alone.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import chain
from typing import Generic, TypeVar

T = TypeVar("T")

BLOCK = 256
"""Elements of a block."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Taped(Generic[T]):
    """A list as it was; nothing changes it."""

    blocks: tuple[tuple[T, ...], ...]
    rest: tuple[T, ...]


class Tape(Generic[T]):
    """The blocks of a list that its owner changes; ``copied`` gives an element apart from one that still changes."""

    def __init__(self, items: list[T], copied: Callable[[T], T] = lambda item: item) -> None:
        self._items, self._copied = items, copied
        self._blocks: tuple[tuple[T, ...], ...] = ()

    def snapshot(self, stable: int) -> Taped[T]:
        """Return the list, of which the elements before number ``stable`` do not change any more."""
        while (at := len(self._blocks) * BLOCK) + BLOCK <= stable:
            self._blocks += (tuple(self._items[at : at + BLOCK]),)
        return Taped(blocks=self._blocks, rest=tuple(map(self._copied, self._items[len(self._blocks) * BLOCK :])))

    def restore(self, taped: Taped[T]) -> None:
        """Put a snapshot back."""
        self._blocks = taped.blocks
        # the same list: record and report hold it
        self._items[:] = [*chain.from_iterable(taped.blocks), *map(self._copied, taped.rest)]

    def change(self, index: int) -> None:
        """Let an element be changed once more, which snapshots may share."""
        self._items[index] = self._copied(self._items[index])
        self._blocks = self._blocks[: index // BLOCK]
