"""How a move through the wrist is chosen: what is kept, what is tried, what is refused and in which words."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.core.frames import inverse
from runtime.motion.cartesian_planner import EXCEPTION, FOLLOWS, HELD, CartesianPlanner, MovePlan
from runtime.motion.commands import MoveLinear
from runtime.motion.fine_interpolator import FineInterpolator
from runtime.motion.path import LinePath
from runtime.motion.path_ik import Arm, LineSolver
from runtime.motion.wrist.switch import PathTiming
from runtime.motion.wrist_remedies import HeldPosture, back_to_the_posture
from runtime.motion.wrist_request import SampledPath, WristRequest
from runtime.robot.files.loader import load_builtin
from runtime.robot.kinematics.kinematics import Kinematics
from runtime.settings.profile import Profile, WristOptions
from tests.bench.wrist_campaign import Bench
from tests.campaign import size
from tests.messages import fields
from tests.runtime.motion.wrist_moves import E1, E2, E3, KINEMATICS, SPEC, TOOL

SPEED = SPEC.per_axis("limits", "speed")
ACCELERATION = SPEC.per_axis("limits", "acceleration")


def plan(move, options: WristOptions | None = None, **command) -> MovePlan:
    start, end = (np.radians(q) for q in move)
    X = KINEMATICS.forward(end) @ TOOL
    length = np.linalg.norm((X - KINEMATICS.forward(start) @ TOOL)[:3, 3])
    given = {"q_end": end, "speed": length / 4.0, **command}
    planner = CartesianPlanner(SPEC, KINEMATICS, Profile(wrist=options or WristOptions()))
    return planner.plan(start, MoveLinear(X_world_tool=X, **given), TOOL)


def must_hold(found: MovePlan, end_deg) -> None:
    """Line, end angles, and every joint limit at every servo tick."""
    q, dq, ddq = FineInterpolator(8, 0.008, found.q[0]).expand(found.q)
    tool = (KINEMATICS.forward(found.q) @ TOOL)[:, :3, 3]
    assert np.abs(tool - found.path.points(found.s)).max() < 1e-9
    assert np.abs(np.degrees(found.q[-1]) - end_deg).max() < 1e-6
    assert ((q >= SPEC.lower - 1e-8) & (q <= SPEC.upper + 1e-8)).all()
    assert (np.abs(dq) <= SPEED * (1 + 1e-9)).all()
    assert (np.abs(ddq) <= ACCELERATION * (1 + 1e-9)).all()


@pytest.mark.parametrize("move", [E1, E2, E3], ids=["E1", "E2", "E3"])
@pytest.mark.parametrize(
    "options",
    [
        WristOptions(),
        WristOptions(posture="rpy"),
        WristOptions(shape="hermite"),
        WristOptions(shape="linear"),
        WristOptions(width=1.0),
    ],
    ids=["default", "rpy", "hermite", "linear", "soft"],
)
def test_the_moves_of_the_document_end_as_taught_within_every_limit(move, options):
    must_hold(plan(move, options), move[1])


@pytest.mark.parametrize(("move", "most"), [(E1, 44.0), (E2, 1.1), (E3, 0.5)], ids=["E1", "E2", "E3"])
def test_the_way_that_turns_the_tool_least_is_taken_at_the_programmed_speed(move, most):
    """The document's switches turn it by 43.5, 7.6 and 2.8 deg; they start with a step of speed."""
    found = plan(move)
    # the laws of the wrist have a jerk that is no concern of the document
    assert found.slowdown is None or (found.slowdown.quantity == "jerk" and found.slowdown.factor < 1.1)
    assert math.degrees(found.wrist.deviation) < most
    assert found.wrist.remedy


def test_the_document_alone_switches_where_its_condition_is_met():
    found = plan(E1, WristOptions(remedies=False, deviation_condition="off", look_ahead=0))
    must_hold(found, E1[1])
    assert (found.wrist.condition, found.wrist.axis, found.wrist.remedy) == ("C1", 3, "")
    assert found.wrist.share_end == 1.0
    assert found.modes[found.wrist.row] == FOLLOWS
    assert (found.modes[found.wrist.row + 1 :] == EXCEPTION).all()


def test_keep_ends_in_the_other_posture_and_says_so():
    found = plan(E1, wrist="keep")
    assert found.wrist is None
    assert np.degrees(found.q[-1, 3:]) == pytest.approx((125, 65, -95))
    assert re.fullmatch(r"keeps the wrist and ends with J[46] at \S+ deg, not at the taught \S+ deg", found.notes[0])
    assert plan(E1, WristOptions(mode="keep")).notes == found.notes
    with pytest.raises(Fault, match=r"RBL411: J4 .*-200 deg .*25 deg"):
        plan(E2, wrist="keep")


def test_a_move_without_a_change_of_the_wrist_is_that_of_keep():
    move = E2[0], (25, 15, 0, -70, -20, 35)
    kept, free = plan(move, wrist="keep"), plan(move)
    assert free.wrist is None
    np.testing.assert_array_equal(free.q, kept.q)


def test_a_path_that_arrives_is_slowed_before_its_posture_is_left():
    """J5 = 4 deg all the way, 0.5 m/s: joints would pass their limits 2.4 times; the profile says which gives in."""
    move, fast = ((0, 0, 0, 48.8, 4.1, 0), (20.3, -1.3, -1.3, -47.5, 3.2, 53.2)), {"speed": 0.5}
    ratio = plan(move, WristOptions(mode="keep"), **fast).slowdown.factor
    assert 1.2 < ratio < 2.0
    kept = plan(move, WristOptions(posture_first=3.0), **fast)
    assert kept.wrist is None
    assert kept.slowdown.factor == ratio
    left = plan(move, **fast)
    assert left.wrist is not None
    assert left.slowdown is None or left.slowdown.factor < 0.8 * ratio
    must_hold(left, move[1])


def test_held_components_change_less_than_the_free_ones():
    from runtime.motion.wrist.hold import component_deviation

    def off(found: MovePlan) -> np.ndarray:
        taken = (KINEMATICS.forward(found.q) @ TOOL)[:, :3, :3]
        planned = found.path.poses(found.s)[:, :3, :3]
        return np.degrees(component_deviation(found.path, found.s, planned, taken).max(axis=0))

    options = WristOptions(posture="rpy")
    free = off(plan(E2, options))
    for k, component in enumerate(("TILT", "ADVANCE", "ROTATION")):
        found = plan(E2, options, held=(component,))
        must_hold(found, E2[1])
        assert off(found)[k] <= free[k] + 1e-9
        assert not found.wrist.held or (found.modes == HELD).any()


def test_turns_of_the_taught_end_are_reached():
    """J6 one turn further than where the path would end."""
    move = E2[0], (25, 15, 0, -70, -20, 35 + 360)
    found = plan(move, speed=0.05)
    must_hold(found, move[1])
    assert found.wrist.condition in ("C1", "C4")


def test_a_move_of_the_wrist_alone_keeps_the_tool_point_where_it_is():
    move = (10, 20, 10, 30, 40, -50), None
    end = np.radians(move[0])
    X = KINEMATICS.forward(end) @ TOOL
    other = next(
        each.q
        for each in KINEMATICS.solutions(X @ inverse(TOOL))
        if str(each.branch) == str(KINEMATICS.branch_of(end)).replace("NOFLIP", "FLIP")
    )
    found = plan((move[0], np.degrees(other)), speed=0.1)
    must_hold(found, np.degrees(other))
    assert found.path.length < 1e-12
    assert len(found.q) > 50


def test_an_untaught_end_takes_the_solution_that_turns_the_tool_least():
    """Only the pose of E3's end is taught; beside J5 = 0 that is the other sign of J5, with J4 and J6 hardly turned."""
    found = plan(E3, q_end=None)
    must_hold(found, E3[1])
    assert math.degrees(found.wrist.deviation) < 1.0


def test_configuration_and_turns_choose_the_end_of_a_taught_pose():
    flip = plan(E1, q_end=None, configuration=("FLIP",))
    assert np.degrees(flip.q[-1, 3:]) == pytest.approx((-55, -65, 85))
    noflip = plan(E1, q_end=None, configuration=("NOFLIP",))
    assert np.degrees(noflip.q[-1, 3:]) == pytest.approx((125, 65, -95))
    turned = plan(
        E1,
        WristOptions(untaught_deviation=math.pi),
        q_end=None,
        configuration=("NOFLIP",),
        turns=(0, 0, 0, 0, 0, 1),
        speed=0.1,
    )
    assert np.degrees(turned.q[-1, 5]) == pytest.approx(-95 + 360)
    with pytest.raises(Fault, match=r"RBL412: .*\bFLIP\b"):
        plan(E1, q_end=None, configuration=("FLIP",), turns=(0, 0, 0, 5))


def test_another_arm_configuration_is_no_straight_move():
    elbow_down = next(
        each.q for each in KINEMATICS.solutions(KINEMATICS.forward(np.radians(E1[1]))) if "BELOW" in str(each.branch)
    )
    with pytest.raises(Fault, match=r"RBL412: .* BELOW "):
        plan((E1[0], np.degrees(elbow_down)))


def test_the_hazards_of_the_document_are_met_before_anything_moves():
    """(vi): one of the two moves of the specification has no solution at its switch, the other leaves the branch."""
    lost = (-20, -25, -30, 50, -30, 50), (-55, -50, -35, -30, 30, 45)
    astray = (-30, -20, -20, 5, -65, 60), (-15, -45, -20, 10, 65, 75)
    c4 = WristOptions(shape="linear", remedies=False, look_ahead=0).only()
    for move, document in (
        (lost, replace(c4, deviation_condition="moving")),
        (astray, replace(c4, speed_condition="any", speed=tuple(np.radians((119.0, 119.0, 148.0))))),
    ):
        with pytest.raises(Fault, match=r"RBL41[12]") as caught:
            plan(move, document)
        assert "configuration" in caught.value.message


REFUSED = (10, 26, 30, 33, 55)
"""Moves that are refused, of those that a generator with seed 1 draws; the others are not planned."""


def test_a_refusal_names_condition_axis_place_what_was_tried_and_what_would_help():
    refused = []
    bench, random = Bench("irb2400"), np.random.default_rng(1)
    drawn = [bench.draw(random) for _ in range(REFUSED[-1] + 1)]
    for start, end, speed in (drawn[k] for k in REFUSED):
        X = KINEMATICS.forward(end) @ TOOL
        with pytest.raises(Fault) as caught:
            bench.planner.plan(start, MoveLinear(X_world_tool=X, q_end=end, speed=speed), TOOL)
        refused.append(caught.value)
    assert any(len(re.findall(r"\d %", fault.message)) > 1 for fault in refused)
    for fault in refused:
        assert fault.code in ("RBL411", "RBL412")
        assert re.search(r"\bJ\d\b", fault.message)
        assert "%" in fields(fault.message)
        assert {"WRIST", "KEEP"} <= fields(fault.hint) or "SPEED" in fields(fault.hint)


def test_a_bound_on_the_posture_refuses_what_turns_the_tool_further():
    with pytest.raises(Fault, match=r" 4\d deg .* 20 deg"):
        plan(E1, WristOptions(most_deviation=math.radians(20.0)))
    assert plan(E3, WristOptions(most_deviation=math.radians(20.0))).wrist is not None


@pytest.mark.parametrize("robot", ["irb2400", "puma560"])
def test_random_moves_hold_every_limit_or_are_refused(robot):
    """``make wrist-campaign`` in small."""
    bench, random, executed = Bench(robot), np.random.default_rng(11), 0
    moves = size(30, 8)
    for _ in range(moves):
        start, end, speed = bench.draw(random)
        command = MoveLinear(X_world_tool=bench.kinematics.forward(end) @ TOOL, q_end=end, speed=speed)
        try:
            found = bench.planner.plan(start, command, TOOL)
        except Fault as fault:
            assert fault.code in ("RBL410", "RBL411", "RBL412")
            continue
        executed += 1
        assert bench.violations(found, end) == []
        assert bench.keep(start, command) != "ends as taught"
    assert executed >= 0.73 * moves


def test_an_arm_without_a_closed_form_goes_through_its_wrist_by_newton():
    spec = load_builtin("irb2400")
    kinematics = Kinematics(spec)
    kinematics._opw = None
    start, end = (np.radians(q) for q in E3)
    planner = CartesianPlanner(spec, kinematics, Profile(wrist=WristOptions(remedies=False)))
    command = MoveLinear(X_world_tool=kinematics.forward(end) @ TOOL, q_end=end, speed=0.1)
    found = planner.plan(start, command, TOOL)
    must_hold(found, E3[1])
    assert found.wrist is not None


def test_a_move_whose_slower_profiles_round_to_the_same_cycles_is_slowed_all_the_same():
    move = (
        (-90.6966, -21.1265, 20.5946, 94.6183, 0.9047, -24.6039),
        (-78.7505, -17.611, 4.8456, -79.761, 0.4655, 149.7754),
    )
    for options in ({"wrist": "keep"}, {}):
        found = plan(move, WristOptions(posture_first=20.0), speed=0.3, **options)
        assert found.slowdown.factor < 3.0
        if not options:
            must_hold(found, move[1])


def test_a_taught_pose_is_not_flipped_to_it_to_save_a_little_time():
    """The path itself needs 1.4 times; another end would be a few rows faster with the tool 40 deg off."""
    spec = load_builtin("manutec_r3")
    kinematics = Kinematics(spec)
    start, end = (
        np.radians(q)
        for q in ((-23.33, 39.95, -8.25, -11.66, -66.85, 137.2), (-45.03, 60.33, 12.57, -10.49, -83.68, 123.09))
    )
    X = kinematics.forward(end) @ TOOL
    found = CartesianPlanner(spec, kinematics, Profile()).plan(start, MoveLinear(X_world_tool=X), TOOL)
    assert found.wrist is None


def test_c2_by_time_is_that_of_the_time_on_a_move_that_only_turns():
    start = np.radians((10, 20, 10, 30, 40, -50))
    X = KINEMATICS.forward(start) @ TOOL
    other = next(
        each.q
        for each in KINEMATICS.solutions(X @ inverse(TOOL), start)
        if str(each.branch) == str(KINEMATICS.branch_of(start)).replace("NOFLIP", "FLIP")
    )
    end = np.degrees(other) + (0, 0, 0, 0, 0, 30)
    options = replace(WristOptions(remedies=False).only(), remaining_time=0.2)
    found = plan((np.degrees(start), end), options, speed=0.1)
    assert found.wrist.condition == "C2"
    assert 0.5 < found.wrist.share < 1.0  # 0.2 s before the end of a short move; not at its first sample


def test_turns_of_a_taught_pose_reach_an_end_that_is_not_the_nearest():
    move = (10, 5, 5, 20, 30, 0), (10, 5, 5, 20, 30, 320)
    found = plan(move, q_end=None, turns=(0, 0, 0, 0, 0, 1), speed=0.1)
    must_hold(found, move[1])
    seven = plan(move, q_end=None, turns=(0, 0, 0, 0, 0, 1, 0), speed=0.1)  # one too many says nothing
    np.testing.assert_array_equal(seven.q, found.q)


def test_long_moves_are_chosen_in_coarser_steps_and_checked_in_fine_ones():
    found = plan(E1, duration=120.0, speed=None)
    must_hold(found, E1[1])
    assert len(found.q) == 15001


def test_a_hold_is_said_with_what_it_came_to():
    found = plan(E2, WristOptions(posture="rpy"), held=("TILT",))
    assert re.search(r"\bTILT\b.* \d+\.\d deg$", found.notes[0])


def test_a_whole_turn_of_the_waist_is_not_left_out():
    move = (-180, 20, 10, 30, 40, 50), (180, 20, 10, 30, 40, 50)
    with pytest.raises(Fault, match="RBL412"):
        plan(move, speed=0.1)


def test_the_first_way_back_to_the_posture_is_about_the_place_where_j5_passes_zero():
    """On E3, with its posture about one axis, that is at 2.7 of 4 s; elsewhere J4 and J6 are half a turn apart."""
    arm = Arm(spec=SPEC, kinematics=KINEMATICS, fine=FineInterpolator(8, 0.008, np.zeros(6)), X_flange_tool=TOOL)
    start, end = (np.radians(q) for q in E3)
    path = LinePath.between(*(KINEMATICS.forward(q) @ TOOL for q in (start, end)))
    line, s = LineSolver(arm, path, start), np.linspace(0.0, 1.0, 501)
    sampled = SampledPath(
        line=line, timing=PathTiming(s=s, period_s=0.008), q=line.rows(s), excess=lambda q: (1.0, 0, "")
    )
    request = WristRequest(sampled=sampled, q_end=end, options=WristOptions(), trigger=None)
    first = next(back_to_the_posture(request, HeldPosture(request)))
    assert 0.5 * (first.switch + first.solver.law.s_return) == pytest.approx(0.68, abs=0.03)
