"""The table of points: what the planner would do with each of them, and where the program uses it."""

from dataclasses import replace

import numpy as np
import pytest

from robolang.analysis.analysis import Analysis
from robolang.core.source import Source
from robolang.execution import lowering
from robolang.project.points import Point, PointStore
from robolang.teaching.point_table import point_table, uses
from robolang.teaching.posture import posture
from robolang.teaching.postures import reached_point, taught_place, tool_place
from robolang.teaching.taught import taught_point
from runtime.core.faults import Fault
from runtime.core.units import DEG
from tests.campaign import size
from tests.robolang.helpers import cell_with
from tests.robolang.teaching.surroundings import surroundings, torch, without_closed_form

Q = np.array([20.0, 60.0, 10.0, 30.0, 40.0, 50.0]) * DEG
PROGRAM = """10 MOVE P1
20 MOVEJ P2 + (0, 0, P1.Z)
30 P9 = P1
40 MOVE p9
50 IF IN(1) THEN MOVE P1 ELSE MOVE P3
"""


def analysis(points):
    return Analysis(source=Source("p.rbl", PROGRAM), cell=cell_with(points=points))


def one(point, around, q=Q):
    (row,) = point_table(surroundings(point) if around is None else around, q)
    return row


def test_where_points_are_used():
    expected = {"P1": (1, 2, 3, 5), "P2": (2,), "P3": (5,)}
    assert uses(analysis(["P1", "P2", "P3"])) == expected
    # the text was checked before the points were taught; a name that the program gives a value is no point
    assert uses(analysis(["P9"])) == expected
    rows = point_table(
        surroundings(*(Point(name=name, joints=(0.0,) * 6) for name in ("p1", "P4"))), Q, analysis(["P1"])
    )
    assert [(row.point.name, row.lines) for row in rows] == [("p1", (1, 2, 3, 5)), ("P4", ())]


def test_a_row_holds_what_a_move_would_do():
    around = surroundings()
    points = [
        taught_point("J", "joints", Q, around).point,
        taught_point("W", "pose", Q, around).point,
        taught_point("F", "pose", Q, torch(around), frame="PALLET").point.replaced(comment="edge"),
    ]
    around = surroundings(*points)
    rows = point_table(around, around.q_last)
    assert [row.point for row in rows] == points
    assert [(row.kind, row.point.frame, row.point.tool) for row in rows] == [
        ("joints", "", ""),
        ("pose", "", ""),
        ("pose", "pallet", "torch"),
    ]
    for row in rows:
        q = reached_point(row.point, around, around.q_last)
        assert row.joints == pytest.approx(q / DEG, abs=1e-9)
        assert row.posture.limit.joint == posture(q, around.kinematics).limit.joint
        assert row.posture.singular.distance == pytest.approx(posture(q, around.kinematics).singular.distance)
        assert row.configuration == str(around.kinematics.branch_of(Q))
        assert (row.reachable, row.fault) == (True, None)


@pytest.mark.parametrize(
    ("point", "code"),
    [
        (Point(name="P", pose=(9000.0, 0.0, 0.0, 0.0, 0.0, 0.0)), "RBL410"),
        (Point(name="P", pose=(0.0,) * 6, frame="shelf"), "RBL305"),
        (Point(name="P", pose=(0.0,) * 6, tool="laser"), "RBL305"),
        (Point(name="P", joints=(0.0,) * 5), "RBL307"),
        (Point(name="P", joints=(170.0, *[0.0] * 5)), "RBL411"),
    ],
)
def test_a_point_that_is_not_reached_has_a_reason(point, code):
    row = one(point, None)
    assert (row.reachable, row.fault.code, row.joints, row.posture) == (False, code, None, None)


def test_turns_that_no_solution_has():
    pose = lowering.six_of(tool_place(Q, surroundings()))
    assert one(Point(name="P", pose=pose, turns=(2,)), None).fault.code == "RBL411"


def test_what_is_reached_depends_on_the_tool():
    around = surroundings()
    point = taught_point("P", "pose", Q, around).point
    far = lowering.pose_si((0.0, 0.0, 2000.0, 0.0, 0.0, 0.0))
    assert one(point, surroundings(point)).reachable
    assert one(point, surroundings(point, X_flange_tool=far)).fault.code == "RBL410"


@pytest.mark.parametrize("robot", ["puma560", "irb2400", "manutec_r3"])
def test_every_row_is_that_of_a_move(robot):
    around = surroundings(robot=robot)
    spec, rng = around.cell.robot, np.random.default_rng(3)
    points = []
    for index, q in enumerate(rng.uniform(spec.lower, spec.upper, (size(1000, 60), spec.n))):
        point = taught_point(
            f"P{index}", rng.choice(["joints", "pose"]), q, around, frame=rng.choice(["", "PALLET"])
        ).point
        # by hand: parts of the configuration, or nothing of it
        points.append(point if index % 3 else point.replaced(configuration=point.configuration[: index % 2], turns=()))
    around = surroundings(*points, robot=robot)
    for row in point_table(around, around.q_last):
        try:
            expected = reached_point(row.point, around, around.q_last)
        except Fault as fault:
            assert (row.fault.code, row.fault.message) == (fault.code, fault.message)
        else:
            assert row.joints == pytest.approx(expected / DEG, abs=1e-9)


def test_an_arm_without_a_closed_form():
    around = without_closed_form(surroundings())
    spec = around.cell.robot
    rows = np.random.default_rng(0).uniform(spec.lower, spec.upper, (6, spec.n))
    points = [taught_point(f"P{index}", "pose", q, around).point for index, q in enumerate(rows)]
    points.append(points[0].replaced(name="FAR", pose=(9000.0, *[0.0] * 5)))
    store = PointStore(path="", points={point.name: point for point in points})
    *found, far = point_table(replace(around, points=store), around.q_last)
    for row in found:
        assert row.fault is None
        q = np.array(row.joints) * DEG
        assert tool_place(q, around) == pytest.approx(taught_place(row.point, around), abs=1e-8)
        assert row.posture.limit.margin >= 0.0
    assert far.fault.code == "RBL410"


def test_no_points():
    assert point_table(surroundings(), Q) == []
