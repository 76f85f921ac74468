"""Small immutable records whose definition costs little at import.

``dataclasses`` writes and compiles the source of every class anew in each process, and imports ``inspect`` to do so:
0.3 to 1 ms a class, which is more than reading a program of 50 lines takes. Records share their methods instead.
Making one takes some tenths of a microsecond longer, so what is made per character or per cycle has an ``__init__`` of
its own or is a data class.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ClassVar, Self, TypeVar, dataclass_transform

if TYPE_CHECKING:
    from dataclasses import Field

T = TypeVar("T")


class _Default:
    """The default of a field that is more than a value: made for each record, or with a note that readers of the class
    find in ``NOTES``."""

    __slots__ = ("factory", "note", "value")

    def __init__(self, value: Any, factory: Callable[[], Any] | None, note: object) -> None:
        self.value = value
        self.factory = factory
        self.note = note


def default(value: Any = None, *, factory: Callable[[], Any] | None = None, note: object = None) -> Any:
    """Declare a field with a default value, or with one that ``factory`` makes for each record."""
    return _Default(value, factory, note)


class _Described:
    """What ``dataclasses`` keeps with a class, for its functions; made when one of them reads it."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, record: "Record | None", kind: "type[Record]") -> Any:
        from dataclasses import make_dataclass

        if "_described" not in vars(kind):
            kind._described = make_dataclass(kind.__name__, kind.FIELDS, frozen=True, kw_only=True)
        return getattr(kind._described, self._name)


class _Nothing:
    """What ``Record`` itself inherits: no field."""

    FIELDS: ClassVar[tuple[str, ...]] = ()
    _declared: ClassVar[dict[str, _Default]] = {}


class _RecordType(type):
    """Turns annotated names into slots. ``kw_only=False`` lets the values be given by position too."""

    def __new__(
        cls, name: str, bases: tuple[type, ...], namespace: dict[str, Any], *, kw_only: bool | None = None
    ) -> "_RecordType":
        base: Any = bases[0] if bases else _Nothing
        # the annotations of Record itself are about every record, and no fields
        own = _field_names(namespace) if bases else []
        declared = {**base._declared, **_take_defaults(namespace, own)}
        new = [field for field in own if field not in base.FIELDS]  # a slot that is made again would hide the first
        namespace["__slots__"] = (*namespace.get("__slots__", ()), *new)
        if kw_only is not None:
            namespace["_kw_only"] = kw_only
        made: Any = super().__new__(cls, name, bases, namespace)
        made.FIELDS = (*base.FIELDS, *new)  # a field that is declared again keeps its place
        made._declared = declared
        _tabulate(made)
        return made  # type: ignore[no-any-return]


def _field_names(namespace: dict[str, Any]) -> list[str]:
    hints = namespace.get("__annotations__", {})
    return [field for field, hint in hints.items() if not _is_of_the_class(hint)]


def _take_defaults(namespace: dict[str, Any], fields: list[str]) -> dict[str, _Default]:
    """Take the values of fields out of a class body: a slot and a value of one name exclude each other."""
    values = {field: namespace.pop(field) for field in fields if field in namespace}
    return {field: value if type(value) is _Default else _Default(value, None, None) for field, value in values.items()}


def _tabulate(kind: Any) -> None:
    """Give a class the tables from which its records are made, so that making one asks nothing about the class."""
    declared = kind._declared.items()
    kind.DEFAULTS = {field: each.value for field, each in declared if each.factory is None}
    kind._factories = {field: each.factory for field, each in declared if each.factory is not None}
    kind.NOTES = {field: each.note for field, each in declared if each.note is not None}
    kind._known = frozenset(kind.FIELDS)
    # the setters of the slots themselves: __setattr__ refuses every change, also the first
    kind._put = tuple((field, getattr(kind, field).__set__) for field in kind.FIELDS)


@dataclass_transform(kw_only_default=True, frozen_default=True, field_specifiers=(default,))
class Record(metaclass=_RecordType):
    """Base of records: each annotated name is a field, given by keyword; the value in the class is its default.

    Type checkers see a frozen data class with slots, and so do the functions of ``dataclasses``. A plain default is
    shared by all records, so it must not be mutable. A class with cached properties has ``__slots__ = ("__dict__",)``;
    they are no part of its value. ``__post_init__`` runs when all fields are set.
    """

    FIELDS: ClassVar[tuple[str, ...]]
    DEFAULTS: ClassVar[dict[str, Any]]
    """Plain defaults of the fields that have one."""
    NOTES: ClassVar[dict[str, Any]]
    """Notes of the fields that have one."""

    _declared: ClassVar[dict[str, _Default]]
    _factories: ClassVar[dict[str, Callable[[], Any]]]
    _known: ClassVar[frozenset[str]]
    _put: ClassVar[tuple[tuple[str, Callable[[Any, Any], None]], ...]]
    _described: ClassVar[Any]
    _kw_only: ClassVar[bool] = True
    if TYPE_CHECKING:
        __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    else:
        __dataclass_fields__ = _Described()
        __dataclass_params__ = _Described()

    def __init__(self, *values: Any, **given: Any) -> None:
        kind = type(self)
        if values:
            given = kind._by_name(values, given)
        if given.keys() != kind._known:
            given = {**kind.DEFAULTS, **{name: make() for name, make in kind._factories.items()}, **given}
            if given.keys() != kind._known:
                wrong = ", ".join(sorted(kind._known ^ given.keys()))
                raise TypeError(f"{kind.__name__} needs {', '.join(kind.FIELDS)}; missing or unknown: {wrong}")
        for name, put in kind._put:
            put(self, given[name])
        self.__post_init__()

    def __post_init__(self) -> None:
        """Check or complete a new record; nothing by default."""

    @classmethod
    def _by_name(cls, values: tuple[Any, ...], given: dict[str, Any]) -> dict[str, Any]:
        """Return the values that were given by position with the others."""
        placed = dict(zip(cls.FIELDS, values, strict=False))
        if cls._kw_only or len(values) > len(cls.FIELDS) or placed.keys() & given.keys():
            raise TypeError(f"{cls.__name__} takes {', '.join(cls.FIELDS)}, each once" + " by name" * cls._kw_only)
        return {**placed, **given}

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"{type(self).__name__}.{name} cannot be set: a record does not change")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"{type(self).__name__}.{name} cannot be deleted: a record does not change")

    def replaced(self, **changes: Any) -> Self:
        """Return a copy with other values in some fields."""
        return _restored(type(self), {**self._values(), **changes})

    def __reduce__(self) -> tuple[Any, ...]:
        # Without this, pickle and copy would set the fields of an empty record, which does not change.
        return _restored, (type(self), self._values())

    def _values(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in self.FIELDS}

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        # as tuples, which count a value as equal to itself: a record with NaN is then equal to itself, as a data class
        return tuple(self._values().values()) == tuple(other._values().values())

    def __hash__(self) -> int:
        return hash(tuple(self._values().values()))

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={value!r}" for name, value in self._values().items())
        return f"{type(self).__name__}({shown})"


def _restored(kind: type[T], values: dict[str, Any]) -> T:
    return kind(**values)


def _is_of_the_class(hint: Any) -> bool:
    """Return whether an annotation is a ``ClassVar``, written out or as text."""
    return getattr(hint, "__origin__", None) is ClassVar or str(hint).startswith(("ClassVar", "typing.ClassVar"))
