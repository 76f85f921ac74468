"""Desks for tests: a program in a folder of its own, and what a pendant does with it."""

import pytest

from robolang.project.points import Point
from robolang.teaching.desk import Desk
from robolang.teaching.documents import load_documents
from robolang.teaching.points_document import remove_point, set_point
from robolang.teaching.program_document import put_line
from runtime.core.faults import Fault

POSE = (450.0, -150.0, 840.0, 180.0, 0.0, 180.0)
PROGRAM = "10 LOAD (0, 0, 60), 0.8\n20 MOVE P1\n"
POINTS = """\
# Taught by hand.
schema = 1

# over the part
[points.P1]   # first
pose = [480, -220, 640.000, 180, 0, 180]   # mm
comment = "around the part"

[points.P2]
joints = [0, 45, 90, 0, 45, 0]


# The end.
"""


def desk(program):
    return Desk(load_documents(program))


def refused(code, call, *args, **options):
    with pytest.raises(Fault) as caught:
        call(*args, **options)
    assert caught.value.code == code
    return caught.value


def teach(one, name, pose=POSE):
    one.change(set_point(one.documents, Point(name=name, pose=pose)), f"teach {name}")


def remove(one, name):
    one.change(remove_point(one.documents, name), f"del {name}")


def put(one, line):
    one.change(put_line(one.documents, line)[0], line)
