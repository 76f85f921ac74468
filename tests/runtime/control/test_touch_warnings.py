"""Warnings of touches: each of them, but the arm that meets itself once for a pair of links."""

import pytest

from runtime.control.touch_warnings import touch_warnings
from runtime.core.faults import lookup
from runtime.plant.touches import Touch


def touch(by, what, tick, **more):
    return Touch(by=[by], what=what, tick=tick, place=None, statement=tick, **more)


@pytest.mark.parametrize(("count", "says"), [(1, ""), (2, "once more"), (4, "3 more")])
def test_an_arm_that_meets_itself_is_one_warning_for_a_pair(count, says):
    touches = [touch("link6", "link3", tick) for tick in range(count)]
    ((found, _, hint),) = touch_warnings(touches)
    assert (found.code, found.tick) == ("RBL537", 0)
    assert found.message.startswith(touches[0].message)
    assert says in found.message
    # nothing of a part or an obstacle
    assert hint not in ("", lookup("RBL537").remedy)


def test_other_touches_are_a_warning_each():
    touches = [
        touch("link6", "obstacle:table", 1),
        touch("link6", "link3", 2),
        touch("pad_left", "part:part", 3, reach=0.01, moved=0.01),
        touch("link6", "obstacle:table", 4),
        touch("palm", "link3", 5),
        touch("link3", "link6", 6),
        touch("pad_left", "part:part", 7),
    ]
    found = [(each.code, each.tick, bool(hint)) for each, _, hint in touch_warnings(touches)]
    table, own = [("RBL537", 1, False), ("RBL537", 4, False)], [("RBL537", 2, True), ("RBL537", 5, True)]
    assert sorted(found) == sorted([*table, *own, ("RBL535", 3, False)])
