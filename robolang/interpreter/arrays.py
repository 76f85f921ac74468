"""Arrays of a program, in blocks that copies share until one of them writes.

A snapshot of the interpreter copies every array, and a debugger takes a snapshot at every statement. The cost of a
copy is one reference for ``BLOCK`` elements; the first write to a block after it copies that block alone.
"""

from collections.abc import Iterator
from itertools import chain, islice

from robolang.values.poses import Value

BLOCK = 256
"""Elements of a block: near the square root of the largest array, where a copy and a first write cost about the
same."""


class Array:
    """The elements of one array; an index is in its range, which ``Scopes`` checks."""

    __slots__ = ("_blocks", "_own", "_size")

    def __init__(self, size: int, value: Value) -> None:
        self._blocks = [[value] * min(size, BLOCK)] * -(-size // BLOCK)
        self._own: set[int] = set()  # blocks that no other array holds; at first one block stands for all
        self._size = size

    def __len__(self) -> int:
        return self._size

    def __iter__(self) -> Iterator[Value]:
        return islice(chain.from_iterable(self._blocks), self._size)

    def __getitem__(self, index: int) -> Value:
        return self._blocks[index // BLOCK][index % BLOCK]

    def __setitem__(self, index: int, value: Value) -> None:
        number = index // BLOCK
        if number not in self._own:
            self._blocks[number] = self._blocks[number].copy()
            self._own.add(number)
        self._blocks[number][index % BLOCK] = value

    def __eq__(self, other: object) -> bool:
        """Compare the elements; what two arrays share costs nothing."""
        return isinstance(other, Array) and self._size == other._size and self._blocks == other._blocks

    __hash__ = None  # type: ignore[assignment]

    def copy(self) -> "Array":
        """Return an array of the same elements; from now on neither owns a block."""
        # the old one gives up its blocks as well: the copy must not see what is written to the original
        other = Array(0, 0.0)
        other._blocks, other._size = self._blocks.copy(), self._size
        self._own.clear()
        return other
