"""Small immutable records whose definition costs nothing at import.

``dataclasses`` writes and compiles the source of every class anew in each process, and imports ``inspect`` to do so:
0.3 to 1 ms a class, which is more than reading a program of 50 lines takes. A ``Record`` shares its methods instead.
Making one takes some microseconds longer, so what is made thousands of times a run is a data class or plain source.
"""

from typing import Any, ClassVar, Self, dataclass_transform


@dataclass_transform(kw_only_default=True, frozen_default=True)
class Record:
    """Base of records: each annotated name is a field, given by keyword; the value in the class is its default.

    Type checkers see a frozen data class. A default is shared by all records, so it must not be mutable.
    """

    FIELDS: ClassVar[tuple[str, ...]] = ()
    _needed: ClassVar[frozenset[str]] = frozenset()

    def __init_subclass__(cls) -> None:
        own = (name for name, hint in cls.__annotations__.items() if not _is_of_the_class(hint))
        cls.FIELDS = tuple(dict.fromkeys((*cls.FIELDS, *own)))  # a field that is declared again keeps its place
        cls._needed = frozenset(name for name in cls.FIELDS if not hasattr(cls, name))

    def __init__(self, **given: Any) -> None:
        if not self._needed <= given.keys() <= frozenset(self.FIELDS):
            wrong = sorted((self._needed - given.keys()) | (given.keys() - frozenset(self.FIELDS)))
            raise TypeError(f"{type(self).__name__} needs {', '.join(self.FIELDS)}; missing or unknown: {wrong}")
        self.__dict__.update(given)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"{type(self).__name__}.{name} cannot be set: a record does not change")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"{type(self).__name__}.{name} cannot be deleted: a record does not change")

    def replaced(self, **changes: Any) -> Self:
        """Return a copy with other values in some fields."""
        return type(self)(**{**self.__dict__, **changes})

    def _values(self) -> tuple[Any, ...]:
        return tuple(getattr(self, name) for name in self.FIELDS)

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self._values() == other._values()

    def __hash__(self) -> int:
        return hash((type(self), self._values()))

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={getattr(self, name)!r}" for name in self.FIELDS)
        return f"{type(self).__name__}({shown})"


def _is_of_the_class(hint: Any) -> bool:
    """Return whether an annotation is a ``ClassVar``, written out or as text."""
    return getattr(hint, "__origin__", None) is ClassVar or str(hint).startswith(("ClassVar", "typing.ClassVar"))
