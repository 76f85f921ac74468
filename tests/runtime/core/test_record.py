"""A record is a frozen data class to its users, without the import time of one."""

import copy
import dataclasses
import pickle
import subprocess
import sys
from functools import cached_property
from typing import ClassVar

import pytest

from runtime.core.record import Record, default


class Size(Record):
    UNIT: ClassVar[str] = "mm"
    width: float
    height: float = 2.0


class Box(Size):
    depth: float
    height: float = 3.0


def test_fields_are_those_of_the_base_and_its_own():
    assert Size.FIELDS == ("width", "height")
    assert Box.FIELDS == ("width", "height", "depth")
    box = Box(width=1.0, depth=4.0)
    assert (box.width, box.height, box.depth, box.UNIT) == (1.0, 3.0, 4.0, "mm")
    assert repr(Size(width=1.0)) == "Size(width=1.0, height=2.0)"


def test_equal_values_are_equal_records_of_one_class():
    assert Size(width=1.0) == Size(width=1.0, height=2.0)
    assert Size(width=1.0) != Size(width=2.0)
    assert len({Size(width=1.0), Size(width=1.0)}) == 1

    class Other(Size):
        pass

    assert Size(width=1.0) != Other(width=1.0)


def test_a_copy_differs_in_what_was_changed():
    size = Size(width=1.0)
    assert size.replaced(height=5.0) == Size(width=1.0, height=5.0)
    assert size.height == 2.0


@pytest.mark.parametrize("given", [{}, {"height": 1.0}, {"width": 1.0, "depth": 1.0}])
def test_missing_and_unknown_fields_are_refused(given):
    with pytest.raises(TypeError, match="Size"):
        Size(**given)


def test_the_functions_of_data_classes_take_it():
    box = Box(width=1.0, depth=4.0)
    assert [each.name for each in dataclasses.fields(box)] == ["width", "height", "depth"]
    assert dataclasses.asdict(box) == {"width": 1.0, "height": 3.0, "depth": 4.0}
    assert dataclasses.replace(box, height=9.0) == Box(width=1.0, height=9.0, depth=4.0)
    assert pickle.loads(pickle.dumps(box)) == copy.deepcopy(box) == box


def test_defining_one_imports_no_dataclasses():
    code = (
        "import sys\nfrom runtime.core.record import Record\nclass A(Record):\n    x: int = 0\n"
        "assert repr(A()) == 'A(x=0)'; assert A().replaced(x=1) != A(); print('dataclasses' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-S", "-c", code], capture_output=True, text=True).stdout == "False\n"


class Named(Record, kw_only=False):
    name: str
    tags: list[str] = default(factory=list, note="words")


class Counted(Record):
    __slots__ = ("__dict__",)

    start: int
    end: int = 0

    def __post_init__(self) -> None:
        if not self.start <= self.end:
            raise ValueError(f"{self.start} is after {self.end}")

    @cached_property
    def length(self) -> int:
        return self.end - self.start


def test_values_are_given_by_position_only_where_the_class_allows_it():
    assert Named("a", ["b"]) == Named(name="a", tags=["b"])
    for kind, values, given in ((Named, ("a",), {"name": "a"}), (Named, ("a", [], 3), {}), (Size, (1.0,), {})):
        with pytest.raises(TypeError, match=kind.__name__):
            kind(*values, **given)


def test_a_factory_makes_a_default_for_each_record_and_notes_stay_with_the_class():
    one, other = Named(name="a"), Named(name="b")
    one.tags.append("x")
    assert (other.tags, Named.NOTES, Size.DEFAULTS) == ([], {"tags": "words"}, {"height": 2.0})


def test_cached_properties_are_no_part_of_the_value():
    counted = Counted(start=1, end=4)
    assert counted.length == 3
    assert counted == Counted(start=1, end=4)
    assert "length" not in vars(copy.copy(counted))


@pytest.mark.parametrize("start", [2, float("nan")])
def test_a_new_record_is_checked_whatever_makes_it(start):
    for make in (lambda: Counted(start=start, end=1), lambda: Counted(start=0, end=1).replaced(start=start)):
        with pytest.raises(ValueError, match="is after 1"):
            make()


def test_a_record_has_slots_and_takes_no_other_attribute():
    assert not hasattr(Box(width=1.0, depth=4.0), "__dict__")
    with pytest.raises(AttributeError):
        object.__setattr__(Size(width=1.0), "depth", 3.0)


def test_a_record_with_nan_equals_itself_as_a_data_class_does():
    nan = float("nan")
    assert Size(width=nan) == Size(width=nan)
    assert Size(width=nan) != Size(width=float("nan"))


def test_a_record_does_not_change():
    size = Size(width=1.0)
    with pytest.raises(AttributeError, match="does not change"):
        size.width = 2.0  # type: ignore[misc]
    with pytest.raises(AttributeError, match="does not change"):
        del size.width
    assert size.width == 1.0
