"""Objects whose state can be taken and put back: what the snapshot of a running controller is made of.

A class names the attributes on which its future depends, in three groups:

    BUFFERS   arrays that are written in place; others hold views of them, so they stay the same objects
    VALUES    attributes that are replaced as a whole, and containers of values that nobody changes
    PARTS     objects that have a state of their own; None: there is no such part

All other attributes are constant, or are computed anew before they are read. A state is never changed once it is taken:
it can be put back any number of times, into the object that it came from or into another one that was built alike.
Rejected: copying whole objects (``copy.deepcopy``), which copies plans, models and the log, and breaks live views.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np


@dataclass(frozen=True, slots=True, kw_only=True)
class State:
    """State of an object of class ``owner``: buffers, values and parts in the order in which the class names them."""

    owner: type
    buffers: tuple[Any, ...] = ()
    values: tuple[Any, ...] = ()
    parts: tuple["State | None", ...] = ()

    def check(self, owner: object) -> None:
        """Refuse an object of another class than the one whose state this is, or without its parts; ``ValueError``."""
        if type(owner) is not self.owner:
            raise ValueError(f"the state of a {self.owner.__name__} does not fit a {type(owner).__name__}")
        for name, part in zip(getattr(owner, "PARTS", ()), self.parts, strict=True):
            if part is not None:
                part.check(getattr(owner, name))


class Stateful:
    """An object with a state; see the module for the three groups."""

    BUFFERS: ClassVar[tuple[str, ...]] = ()
    VALUES: ClassVar[tuple[str, ...]] = ()
    PARTS: ClassVar[tuple[str, ...]] = ()

    def snapshot(self) -> State:
        """Return the state of this object and its parts."""
        parts = (getattr(self, name) for name in self.PARTS)
        return State(
            owner=type(self),
            buffers=tuple([getattr(self, name).copy() for name in self.BUFFERS]),
            values=tuple([own(getattr(self, name)) for name in self.VALUES]),
            # None is kept: a state has a place for each part that its class names
            parts=tuple([None if part is None else part.snapshot() for part in parts]),
        )

    def restore(self, state: State) -> None:
        """Put a state back; ``ValueError`` when it is that of another class or of a robot with other axes."""
        state.check(self)
        for name, buffer in zip(self.BUFFERS, state.buffers, strict=True):
            getattr(self, name)[...] = buffer
        for name, value in zip(self.VALUES, state.values, strict=True):
            # copied again: the object changes it from now on, and the state may be put back once more
            setattr(self, name, own(value))
        for name, part in zip(self.PARTS, state.parts, strict=True):
            if part is not None:
                getattr(self, name).restore(part)


def own(value: Any) -> Any:
    """Return a value that no one else can change: a copy of an array or container that can be written, else itself."""
    if isinstance(value, np.ndarray):
        base = value.base
        # a view that cannot be written changes with the array that it is of
        shared = value.flags.writeable or (isinstance(base, np.ndarray) and base.flags.writeable)
        return value.copy() if shared else value
    return value.copy() if isinstance(value, list | dict | set) else value
