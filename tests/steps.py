"""Counts of steps in the place of times: they do not depend on the machine or on what else it does.

No test compares a time with a constant (``tests/arch/test_clocks.py``). Work that must not grow faster than its input
is counted at two sizes; work that must not wait is guarded, so that a hang is a failed test and no more.
"""

import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

HANG_S = 120
"""A test that takes longer hangs. It is no measure of speed."""


def calls(work: Callable[..., object], *arguments: object) -> int:
    """Return how many calls, of Python and of C functions, some work takes."""
    count = 0

    def step(frame: FrameType, event: str, argument: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    before = sys.getprofile()
    sys.setprofile(step)
    try:
        work(*arguments)
    finally:
        sys.setprofile(before)
    return count


def assert_linear(work: Callable[[Any], object], small: Any, large: Any, times: float = 2.0) -> None:
    """Fail when ``large``, which is so many times ``small``, takes more than 5 % over so many times its calls."""
    few, many = calls(work, small), calls(work, large)
    assert many <= 1.05 * times * few + 100, f"{few} calls, {many} for {times:g} times the size"


@contextmanager
def guarded() -> Iterator[None]:
    """Fail when the block hangs."""

    def hangs(number: int, frame: FrameType | None) -> None:
        raise AssertionError(f"it still waits after {HANG_S} s")

    before = signal.signal(signal.SIGALRM, hangs)
    signal.alarm(HANG_S)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
