"""What every part of the syntax tree has, and going through it; ``robolang.syntax.ast`` has the classes.

Nodes are plain classes whose ``__slots__`` are their fields in the order of the text, and take them by keyword. They
are values: nothing changes a field (type checkers see ``Final``), ``replace`` makes a changed copy. They are not
dataclasses, because building 48 of those took a third of the start of ``robolang check``.
"""

from collections.abc import Iterator
from typing import Any, ClassVar, TypeVar

from robolang.core.source import Span

NOWHERE = Span(0, 0)


class Node:
    """Anything with a place in the text.

    Two nodes are equal when their ``compared`` fields are: all of their own, unless a class says otherwise. Places and
    parentheses that change nothing take no part. ``computed`` fields follow from others and are no arguments.
    """

    __slots__ = ("span",)
    compared: ClassVar[tuple[str, ...]] = ()
    computed: ClassVar[tuple[str, ...]] = ()
    span: Span

    def __init_subclass__(cls) -> None:
        """Take the fields of a class as those that are compared, where it does not name any."""
        if "compared" not in cls.__dict__:
            cls.compared = tuple(cls.__dict__["__slots__"])

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self is other or all(getattr(self, name) == getattr(other, name) for name in self.compared)

    def __hash__(self) -> int:
        return hash((type(self), *(getattr(self, name) for name in self.compared)))

    def __repr__(self) -> str:
        fields = ", ".join(f"{name}={getattr(self, name)!r}" for name in self.compared)
        return f"{type(self).__name__}({fields})"


AnyNode = TypeVar("AnyNode", bound=Node)


def fields(kind: type[Node]) -> tuple[str, ...]:
    """Return the names of all fields of a class of nodes."""
    return tuple(name for each in kind.__mro__ for name in getattr(each, "__slots__", ()))


def replace(node: AnyNode, **changes: Any) -> AnyNode:
    """Return a copy of a node with some fields changed."""
    given = (name for name in fields(type(node)) if name not in changes and name not in node.computed)
    kept = {name: getattr(node, name) for name in given}
    return type(node)(**kept, **changes)


def children(node: Node) -> Iterator[Node]:
    """Yield the nodes right below a node, in the order of the text."""
    # those of the class alone: what it inherits, place and parentheses, is no node
    for name in node.__slots__:
        value = getattr(node, name)
        if isinstance(value, Node):
            yield value
        elif isinstance(value, tuple):
            for each in value:
                parts = each if isinstance(each, tuple) else (each,)
                yield from (part for part in parts if isinstance(part, Node))


def is_deeper(node: Node, most: int) -> bool:
    """Return whether a node has parts more than ``most`` levels below it."""
    if node.span.end - node.span.start <= most:  # a level is a character at least
        return False
    stack = [(node, 0)]
    while stack:
        found, level = stack.pop()
        if level > most:
            return True
        stack.extend((child, level + 1) for child in children(found))
    return False


def walk(node: Node) -> Iterator[Node]:
    """Yield a node and everything below it; without recursion, however deep the tree is."""
    stack = [node]
    while stack:
        found = stack.pop()
        yield found
        stack.extend(reversed(list(children(found))))
