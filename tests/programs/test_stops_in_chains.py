"""A stop within moves that blend: which of them have begun, where it is placed, and what is reported of the rest."""

import pytest

from robolang.cli.run_table import print_result
from robolang.execution.session import Session
from robolang.execution.speed_keys import KEYS
from robolang.experiments.compare import measures
from robolang.project.project import load_project

TEXT = """\
2 LOAD (0, 0, 60), 0.8
3 ZONE 30
4 MOVE P1, SPEED 300
5 MOVE P1 + (0, 80, 0), SPEED 300
6 MOVE P1 + (0, 80, 80), SPEED 300
7 MOVE P1, SPEED 200, FINE
"""
FIRST = 3
"""Line of the first MOVE; numbers are those of the next lines."""
MEASURED = {
    "start_s",
    "duration_s",
    "planned_s",
    *KEYS,
    "joint_error_deg",
    "tool_error_mm",
    "path_deviation_mm",
    "peak_torque_pct",
    "wrist",
    "seam",
}


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    path = tmp_path_factory.mktemp("chain") / "p.rbl"
    path.write_text(TEXT)
    return load_project(path)


def stopped(project, cycle, warn=()):
    """A run that is stopped before a cycle; a warning is raised within those of ``warn``."""
    session = Session(project, physics=False)
    controller = session.controller
    run_cycle, tick = controller.cycle, controller.plant.step

    def step(tau):
        if controller.recorder.cycle - 1 in warn and controller.recorder.tick % 8 == 0:
            controller.warn("RBL517", "made up")
        return tick(tau)

    def one():
        if controller.recorder.cycle == cycle:
            session.request_stop()
        return run_cycle()

    controller.plant.step, controller.cycle = step, one
    return session, session.run()


@pytest.fixture(scope="module")
def whole(project):
    return stopped(project, None)[1]


def starts(result):
    return [round(entry["start_s"] / 0.008) for entry in result.report["statements"] if entry["planned_s"]]


@pytest.mark.parametrize("offset", [0, 1, 20])
@pytest.mark.parametrize("move", range(4))
def test_what_was_not_reached_has_not_begun(project, whole, move, offset, capsys):
    session, result = stopped(project, starts(whole)[move] + offset)
    moves = [entry for entry in result.report["statements"] if entry["text"].startswith("MOVE")]
    begun = [entry["begun"] for entry in moves]
    # the stop is asked for before a cycle and taken after it, in which the set-point of the next move may have come
    assert begun == [True] * sum(begun) + [False] * (4 - sum(begun))
    assert sum(begun) == move + 1
    for entry in moves:
        if not entry["begun"]:
            assert {key for key, value in entry.items() if value is None} == MEASURED
            assert entry["notes"] == []
    assert result.report["alarms"][0]["code"] == "RBL530"
    assert result.report["alarms"][0]["line"] in (FIRST + move, FIRST + move - (offset == 0))
    print_result(result.report)
    assert capsys.readouterr().out.count("not begun") == 4 - sum(begun)
    log = result.log
    found = measures(
        log, session.controller.tool_poses(log["q_cmd"]), session.record.statements, session.controller.spec
    )
    assert [row["line"] for row in found["moves"]] == [FIRST + k for k in range(move + 1)]


def test_a_stop_before_the_first_cycle_has_begun_no_move(tmp_path):
    path = tmp_path / "p.rbl"
    path.write_text(TEXT.partition("\n")[2])
    session = Session(load_project(path), physics=False)
    session.request_stop()
    report = session.run().report
    assert [entry["begun"] for entry in report["statements"]] == [False] * 4
    assert report["alarms"][0]["line"] == FIRST - 1


def test_a_warning_within_a_chain_is_at_the_move_that_ran(project, whole):
    """Also in the last cycle of a move, when the set-point of the next one has been computed already."""
    at = [cycle + k for cycle in starts(whole)[1:] for k in (-1, 0, 1)]
    _, result = stopped(project, None, at)
    found = [(item["line"], item["number"]) for item in result.report["warnings"]]
    logged = [(int(result.log["line"][8 * cycle]), int(result.log["number"][8 * cycle])) for cycle in at]
    assert found == logged
    assert [line for line, _ in found] == [3, 4, 4, 4, 5, 5, 5, 6, 6]
