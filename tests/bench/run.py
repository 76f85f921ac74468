"""``make bench``: what the controller costs, as ratios taken in one run, and how long the commands take to start.

The run of the 1992 program is timed against a bare loop of ``mj_step`` over the same model, the same number of
steps and the same controls (replayed from the log), the two in turn, so that both do the same physics at the same
speed of the machine. Whole processes are timed from outside.
"""

import statistics
import subprocess
import sys
import time
from dataclasses import replace

import mujoco
import numpy as np

from robolang.effects import MoveTo
from robolang.interpreter import execute
from robolang.project import Project, load_project
from robolang.session import RunResult, Session
from runtime.plant.mujoco_plant import MujocoPlant
from tests.runtime.motion.test_seam import SAME, tracked
from tests.runtime.motion.wrist_moves import E2, NOTHING

PROGRAM = "programs/pick_and_place.rbl"
WRIST = "programs/wrist/e1.rbl"
ROUNDS = 11
WRIST_ROUNDS = 7
PROCESSES = 7


class ControlTape(MujocoPlant):
    """The plant, keeping the controls it was given at every tick."""

    def record_to(self, tape: list[np.ndarray]) -> None:
        self._tape = tape

    def step(self, tau: np.ndarray) -> bool:
        ok = super().step(tau)
        self._tape.append(np.array(self._data.ctrl))
        return ok


def controls_of(project: Project) -> list[np.ndarray]:
    """Return the MuJoCo controls of every tick of a run."""
    session = Session(project)
    tape: list[np.ndarray] = []
    plant = ControlTape(project.cell.robot, project.cell, project.profile.tick_s)
    plant.record_to(tape)
    session.controller.plant = plant
    session.run()
    return tape


def bare_seconds(project: Project, controls: list[np.ndarray]) -> tuple[float, np.ndarray]:
    """Return the time of the bare loop and the joint angles (n,) it ends with."""
    plant = MujocoPlant(project.cell.robot, project.cell, project.profile.tick_s)
    model, data, substeps = plant._model, plant._data, plant.substeps
    ctrl, step = data.ctrl, mujoco.mj_step
    started = time.perf_counter()
    for row in controls:
        ctrl[:] = row
        step(model, data, substeps)
    return time.perf_counter() - started, np.array(data.qpos[: project.cell.robot.n])


def run_seconds(project: Project) -> tuple[float, RunResult, np.ndarray]:
    """Return the time of a whole run (cycles, servo, dynamics task, physics, log, report), its result and end."""
    session = Session(project)
    started = time.perf_counter()
    result = session.run()
    return time.perf_counter() - started, result, np.array(session.controller.plant.q)


def wrist_seconds() -> dict[str, tuple[float, float]]:
    """Return by way the median time of a cycle, run and planning together, and of planning alone, of move E1, s."""
    base = load_project(WRIST)
    ways = {"KEEP": {"mode": "keep"}, "document": {"remedies": False}, "all remedies": {}, "HOLD": {}}
    projects = {way: base.with_profile(replace(base.profile, wrist=replace(base.profile.wrist, **changes)))
                for way, changes in ways.items()}  # fmt: skip
    times: dict[str, list[tuple[float, float]]] = {way: [] for way in ways}
    for _ in range(WRIST_ROUNDS):
        for way, project in projects.items():
            held = ("TILT",) if way == "HOLD" else ()
            session = Session(project, effects=lambda program, h=held: (
                replace(effect, held=h) if isinstance(effect, MoveTo) else effect for effect in execute(program)
            ))  # fmt: skip
            planner, spent = session.controller._planner, [0.0]

            def timed(*args, plan=planner.plan, spent=spent):
                began = time.perf_counter()
                try:
                    return plan(*args)
                finally:
                    spent[0] += time.perf_counter() - began

            planner.plan = timed
            whole = run_seconds_of(session)
            times[way].append((whole / session.controller.recorder.cycle, spent[0]))
    return {way: tuple(statistics.median(column) for column in zip(*rows, strict=True)) for way, rows in times.items()}


def tracked_microseconds() -> tuple[float, float]:
    """Return the median time of a set-point on a seam, on the path and with the wrist on its own way, us."""
    times = []
    for move, options in ((SAME, NOTHING), (E2, replace(NOTHING, remaining_time=3.9))):
        going, _, planned = tracked(move, options)
        began = time.perf_counter()
        for n in range(1, len(planned)):
            going.next(n)
        times.append(1e6 * (time.perf_counter() - began) / len(planned))
    return times[0], times[1]


def run_seconds_of(session: Session) -> float:
    """Return the time of a whole run of a session, s."""
    started = time.perf_counter()
    session.run()
    return time.perf_counter() - started


def process_seconds(*command: str) -> float:
    """Return the median wall time of a whole process."""
    times = []
    for _ in range(PROCESSES + 1):
        started = time.perf_counter()
        subprocess.run([sys.executable, "-m", "robolang", *command], check=True, capture_output=True)
        times.append(time.perf_counter() - started)
    return statistics.median(times[1:])


def main() -> None:
    """Print the figures."""
    project = load_project(PROGRAM)
    controls = controls_of(project)
    ratios, runs = [], []
    for _ in range(ROUNDS):
        whole, result, q_run = run_seconds(project)
        bare, q_bare = bare_seconds(project, controls)
        if not np.array_equal(q_run, q_bare):
            raise SystemExit("the bare loop did not repeat the physics of the run")
        ratios.append(whole / bare)
        runs.append(whole)
    sim_s = float(result.report["sim_time_s"])
    print(f"whole run / bare mj_step loop, same steps and controls: median {statistics.median(ratios):.2f} "
          f"(min {min(ratios):.2f}, max {max(ratios):.2f}; goal <= 6, aim 3)")  # fmt: skip
    print(f"steps {len(controls)}, simulated {sim_s:.3f} s, real-time factor {sim_s / statistics.median(runs):.1f}")
    wrist = wrist_seconds()
    for way, (cycle, planning) in wrist.items():
        print(f"{WRIST}, {way}: {1e6 * cycle:.0f} us a cycle with planning, {cycle / wrist['KEEP'][0]:.2f} of KEEP; "
              f"planning {1e3 * planning:.1f} ms before the move")  # fmt: skip
    on_path, on_its_way = tracked_microseconds()
    print(f"set-point on a seam: {on_path:.0f} us on the path, {on_its_way / on_path:.2f} of that with the wrist on "
          "its way")  # fmt: skip
    print(f"robolang run {PROGRAM}, whole process: {process_seconds('run', PROGRAM):.2f} s (goal <= 2 s)")
    print(f"robolang --version, whole process: {1000 * process_seconds('--version'):.0f} ms (goal <= 150 ms)")
    print(f"robolang --help, whole process: {1000 * process_seconds('--help'):.0f} ms")
    print(f"robolang check {PROGRAM}, whole process: {1000 * process_seconds('check', PROGRAM):.0f} ms")


if __name__ == "__main__":
    main()
