"""A page says where a run or a plan is that of estimates."""

from robolang.view.notes import of_estimates


def test_a_page_notes_estimates_from_which_results_follow():
    assert of_estimates(["path.max_speed_mm_s", "axes.1.motor.encoder_counts"]) == []
    (note,) = of_estimates(["axes.1.motor.gear_ratio", "axes.1.max_torque_nm"])
    assert (note.time_s, note.line, note.code, note.severity) == (None, None, None, "note")
    assert all(word in note.text for word in ("2 values", "drives", "torques"))
