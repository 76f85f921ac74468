"""Names of estimates in words."""

from runtime.robot.model.estimated import axis_key, decisive, groups, mark


def test_names_are_grouped_in_one_order():
    names = ["path.jerk_mm_s3", "axes.2.servo.position_bandwidth_rad_s", "axes.1.motor.gear_ratio", "axes.1.cog_m"]
    assert groups(names) == ["bodies", "drives", "loops", "path limits"]
    assert groups([]) == []


def test_what_results_follow_from_is_decisive():
    assert decisive(["path.jerk_mm_s3", "axes.2.max_torque_nm"])
    assert not decisive(["path.jerk_mm_s3", "axes.2.servo.position_bandwidth_rad_s"])


def test_a_mark_stands_before_an_estimate_alone():
    estimated = {axis_key(0, "max_torque_nm"): ""}
    assert mark(estimated, "axes.1.max_torque_nm") == "~"
    assert mark(estimated, "axes.2.max_torque_nm") == ""
