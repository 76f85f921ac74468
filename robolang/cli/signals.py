"""Handlers of the signals that end a command, for as long as it needs them."""

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def handled(handle: Callable[[int, object], None]) -> Iterator[None]:
    """Have SIGINT and SIGTERM handled."""
    before = {number: signal.signal(number, handle) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
