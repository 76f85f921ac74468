"""A record is a frozen data class to its users, without the import time of one."""

from typing import ClassVar

import pytest

from runtime.core.record import Record


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


def test_a_record_does_not_change():
    size = Size(width=1.0)
    with pytest.raises(AttributeError, match="does not change"):
        size.width = 2.0  # type: ignore[misc]
    with pytest.raises(AttributeError, match="does not change"):
        del size.width
    assert size.width == 1.0
