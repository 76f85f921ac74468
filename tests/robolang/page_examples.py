"""The examples of docs/python.md, for the type checker; written by this test."""


def example_1() -> None:
    import robolang

    (found,) = robolang.check("programs/pick_and_place.rbl")
    assert not found.diagnostics
    assert [item.code for item in robolang.check_text("MOVE P1\nPRINT 1 +\n").diagnostics] == ["RBL111"]


def example_2() -> None:
    import robolang

    plan = robolang.plan("programs/pick_and_place.rbl")
    slowest = max(plan.lines, key=lambda line: line.seconds)
    print(f"{plan.seconds:.3f} s, most of it in line {slowest.line}: {slowest.seconds:.3f} s")
    assert plan.ok


def example_3() -> None:
    import robolang

    result = robolang.run("programs/pick_and_place.rbl", physics=False, settings={"servo.mode": "fixed"})
    assert result.ok
    print(result.report.sim_time_s, "s,", result.report.tool_error_mm, "mm")
    carrying = result.log.at_line(60)
    print(carrying.tool_error_mm.max(), "mm while the part is carried")
    print(result.log["q_cmd"].shape, "joint angles in rad")


def example_4() -> None:
    import robolang

    text = "LOAD (0, 0, 60), 0.8\nHAND OFF\nMOVE P1\nHAND ON\nLOAD (0, 0, 95), {mass}\nMOVE P2\n"
    for mass in (2.0, 2.3):
        result = robolang.run(robolang.Project.from_text(text.format(mass=mass)))
        print(mass, "kg declared:", round(result.report.tool_error_mm, 3), "mm")


def example_5() -> None:
    import robolang

    pose = robolang.forward("puma560", [0, 45, -180, 0, 45, 0])
    best = robolang.inverse("puma560", pose)[0]
    assert abs(best.joints[1] - 45) < 1e-6
    response = robolang.step("puma560", axis=2, payload=(2.5, 0, 0, 100))
    print("overshoot", response.overshoot, "of the step, droop", response.droop, "rad")


def example_6() -> None:
    import robolang

    project = robolang.load_project("programs/shop/palletise.rbl")
    session = robolang.Session(project, physics=False)
    executor = session.executor

    executor.advance(100)
    executor.pause()
    while executor.advance().state is not robolang.State.PAUSED:
        pass
    resting = executor.snapshot()

    executor.resume()
    later = executor.advance(50)

    executor.restore(resting)
    executor.resume()
    assert executor.advance(50) == later


def example_7() -> None:
    import robolang

    project = robolang.load_project("programs/pick_and_place.rbl")
    executor = robolang.Session(project, physics=False).executor
    timeline = robolang.Timeline(executor)

    executor.stops_before = lambda statement: True
    executor.advance(1000)
    assert executor.origin is not None
    first = executor.origin.line

    for _ in range(5):
        executor.resume()
        while executor.advance(100).state is not robolang.State.PAUSED:
            pass
    assert executor.origin.line > first

    timeline.back(5)
    assert executor.origin.line == first


def example_8() -> None:
    import numpy as np

    import robolang

    project = robolang.load_project("programs/pick_and_place.rbl")
    session = robolang.Session(project, physics=False)
    executor = session.executor
    executor.stops_before = lambda statement: True
    executor.advance(1000)

    x = np.linspace(0, 1, 61)[1:]
    rows = np.repeat(session.controller.areas.ina[None], 60, axis=0)
    rows[:, 0] += 0.02 * (10 * x**3 - 15 * x**4 + 6 * x**5)
    executor.play(rows, None, "jog J1")
    while executor.advance(100).state is not robolang.State.PAUSED:
        pass
    assert np.array_equal(session.controller.areas.ina, rows[-1])
