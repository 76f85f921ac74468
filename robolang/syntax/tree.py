"""What every part of the syntax tree has, and going through it: ``nodes`` has the classes, one for each rule.

The fields of a node are its children, in the order of the text; tuples of nodes, and of a sign and a node, are gone
through like fields.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, fields

from robolang.core.source import Span

NOWHERE = Span(0, 0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Node:
    """Anything with a place in the text."""

    span: Span = field(default=NOWHERE, compare=False, repr=False)


_OTHER = frozenset({"span", "text", "key", "parentheses"})
_NAMES: dict[type, tuple[str, ...]] = {}


def _names(kind: type[Node]) -> tuple[str, ...]:
    """Return the fields of a kind of node that may hold nodes."""
    if kind not in _NAMES:
        _NAMES[kind] = tuple(item.name for item in fields(kind) if item.name not in _OTHER)
    return _NAMES[kind]


def children(node: Node) -> Iterator[Node]:
    """Yield the nodes right below a node, in the order of the text."""
    for name in _names(type(node)):
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
