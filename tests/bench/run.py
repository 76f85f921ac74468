"""``make bench``: what the controller costs, as ratios taken in one run, and how long the commands take to start.

The run of the 1992 program is timed against a bare loop of ``mj_step`` over the same model, the same number of
steps and the same controls (replayed from the log), the two in turn, so that both do the same physics at the same
speed of the machine. Whole processes are timed from outside.
"""

import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

import mujoco
import numpy as np

from robolang.execution.log_meta import meta_of
from robolang.execution.plan_memory import PlanMemory
from robolang.execution.session import Session
from robolang.execution.status import ENDED
from robolang.execution.timeline import Timeline
from robolang.interpreter.effects import MoveTo
from robolang.logs.files import write_log
from robolang.project.project import Project, load_project
from runtime.plant.mujoco_plant import MujocoPlant
from tests.bench import figures
from tests.bench.figures import Row
from tests.runtime.motion.test_seam import SAME, tracked
from tests.runtime.motion.wrist_moves import E2, NOTHING

PROGRAM = "programs/pick_and_place.rbl"
WRIST = "programs/wrist/e1.rbl"
COMMANDS = {
    f"`robolang run {PROGRAM}`, whole process": ("run", PROGRAM),
    "`robolang --version`, whole process": ("--version",),
    "`robolang --help`, whole process": ("--help",),
    f"`robolang check {PROGRAM}`, whole process": ("check", PROGRAM),
}
WAYS = {"KEEP": {}, "document": {"remedies": False}, "all remedies": {}, "HOLD": {}}
"""Options of the profile by the name of the method; KEEP and HOLD are what the move itself says."""


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
    model, data, substeps = plant._model, plant._data, plant._substeps
    ctrl, step = data.ctrl, mujoco.mj_step
    started = time.perf_counter()
    for row in controls:
        ctrl[:] = row
        step(model, data, substeps)
    return time.perf_counter() - started, np.array(data.qpos[: project.cell.robot.n])


def run_seconds(session: Session) -> float:
    """Return the time of a whole run of a session (cycles, servo, dynamics task, physics, log, report), s."""
    started = time.perf_counter()
    session.run()
    return time.perf_counter() - started


def whole_run(rounds: int) -> Row:
    """Measure whole runs against bare loops, in turn."""
    project = load_project(PROGRAM)
    controls = controls_of(project)
    ratios, runs = [], []
    for _ in range(rounds):
        session = Session(project)
        whole = run_seconds(session)
        bare, q_bare = bare_seconds(project, controls)
        if not np.array_equal(session.controller.plant.q, q_bare):
            raise SystemExit("the bare loop did not repeat the physics of the run")
        ratios.append(whole / bare)
        runs.append(whole)
    simulated = len(controls) * project.profile.tick_s
    detail = f"{len(controls)} ticks, {simulated:.3f} s, real-time factor {simulated / statistics.median(runs):.1f}"
    return Row(
        figure="whole run against a bare `mj_step` loop over the same steps and controls",
        form=f"{{:.2f}} ({{:.2f}} to {{:.2f}} over {rounds} pairs)",
        values=(statistics.median(ratios), min(ratios), max(ratios)),
        details=(detail,),
    )


def wrist_seconds(rounds: int, physics: bool) -> dict[str, tuple[float, float]]:
    """Return by method the median time of a cycle, run and planning together, and of planning alone, of move E1, s."""
    base = load_project(WRIST)
    projects = {
        way: base.with_profile(replace(base.profile, wrist=replace(base.profile.wrist, **changes)))
        for way, changes in WAYS.items()
    }
    times: dict[str, list[tuple[float, float]]] = {way: [] for way in WAYS}
    for _ in range(rounds):
        for way, project in projects.items():
            times[way].append(wrist_run(project, way, physics))
    return {way: tuple(statistics.median(column) for column in zip(*rows, strict=True)) for way, rows in times.items()}


def wrist_run(project: Project, way: str, physics: bool) -> tuple[float, float]:
    """Return the time of a cycle, run and planning together, and of planning alone, s."""
    said = {"held": ("TILT",) if way == "HOLD" else (), "wrist": "keep" if way == "KEEP" else "auto"}
    session = Session(
        project,
        physics=physics,
        alter=lambda effect: replace(effect, **said) if isinstance(effect, MoveTo) else effect,
    )
    planner, spent = session.controller.requests.planner, 0.0
    plan = planner.plan

    def timed(*args):
        nonlocal spent
        began = time.perf_counter()
        try:
            return plan(*args)
        finally:
            spent += time.perf_counter() - began

    planner.plan = timed
    whole = run_seconds(session)
    return whole / session.controller.recorder.cycle, spent


def wrist(rounds: int, physics: bool) -> Iterator[Row]:
    """Measure a move through the wrist by each method."""
    found = wrist_seconds(rounds, physics)
    details = tuple(
        f"{way}: {1e6 * cycle:.0f} us a cycle, {cycle / found['KEEP'][0]:.2f} of KEEP"
        for way, (cycle, _) in found.items()
    )
    yield Row(
        figure="one cycle of E1, run and planning, document's method against KEEP",
        form="{:.2f}",
        values=(found["document"][0] / found["KEEP"][0],),
        details=details,
    )
    on_path, on_its_way = tracked_microseconds(rounds)
    yield Row(
        figure="set-point on a seam, wrist on its joint curve against on the path",
        form="{:.2f} ({:.0f} us on the path)",
        values=(on_its_way / on_path, on_path),
    )
    yield Row(
        figure="planning E1 before it moves: KEEP, document, all remedies, HOLD",
        form="{:.3g}, {:.3g}, {:.3g}, {:.3g} ms",
        values=tuple(1e3 * found[way][1] for way in WAYS),
    )


def tracked_microseconds(rounds: int) -> tuple[float, float]:
    """Return the median time of a set-point on a seam, on the path and with the wrist on its own way, us."""
    times: tuple[list[float], list[float]] = ([], [])
    for _ in range(rounds):
        for found, (move, options) in zip(
            times, ((SAME, NOTHING), (E2, replace(NOTHING, remaining_time=3.9))), strict=True
        ):
            going, _, planned = tracked(move, options)
            began = time.perf_counter()
            for n in range(1, len(planned)):
                going.next(n)
            found.append(1e6 * (time.perf_counter() - began) / len(planned))
    return statistics.median(times[0]), statistics.median(times[1])


def process_seconds(processes: int, *command: str) -> float:
    """Return the median wall time of a whole process, s; the first of several is not counted."""
    times = []
    for _ in range(processes):
        started = time.perf_counter()
        subprocess.run([sys.executable, "-m", "robolang", *command], check=True, capture_output=True)
        times.append(time.perf_counter() - started)
    return statistics.median(times[1:] or times)


STATEMENTS = "FOR I = 1 TO {rounds}\nX = 1 + I\nDELAY 0.016\nIF X > 0 THEN Y = X\nNEXT\n"
"""Four statements a round, one of which takes two cycles."""


def back_ratio(stops: bool, rounds: int) -> float:
    """Return the time of going back over all but two statements as a share of running them, with physics."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "long.rbl")
        path.write_text(STATEMENTS.format(rounds=rounds))
        session = Session(load_project(path))
    executor, timeline = session.executor, Timeline(session.executor)
    executor.stops_before = lambda begun: stops
    started = time.perf_counter()
    while executor.advance(100).state not in ENDED:
        executor.resume()
    ran = time.perf_counter() - started
    started = time.perf_counter()
    timeline.back(4 * rounds)
    return (time.perf_counter() - started) / ran


def logged(rounds: int) -> Row:
    """Measure a run and the writing of its log, with parts, fingers and ``meta`` and without, in turn."""
    project = load_project(PROGRAM)
    pairs = [[logged_seconds(project, whole=each) for each in (True, False)] for _ in range(rounds)]
    # the least of each: the difference is a hundredth, and what disturbs a run only adds to it
    whole, bare = map(min, zip(*pairs, strict=True))
    return Row(
        figure="run and log with parts and meta against without, processor time",
        form="{:.3f} (at most 1.03)",
        values=(whole / bare,),
    )


def logged_seconds(project: Project, *, whole: bool) -> float:
    """Return the processor time of a run and its log, s; not ``whole``: without parts, fingers and ``meta``."""
    session = Session(project, plans=PlanMemory(project))
    nothing = session.controller.plant.moved()
    changes = {} if whole else {"moved": lambda: nothing}
    vars(session.controller.plant).update(changes)
    empty = {**meta_of(session.record, session.world.signals, {}), "scene": None, "points": {}, "program": {}}
    made = meta_of if whole else lambda *_: empty
    with tempfile.TemporaryDirectory() as folder, patch("robolang.execution.session.meta_of", made):
        started = time.process_time()
        write_log(Path(folder, "l.npz"), session.run().log)
        return time.process_time() - started


def rows(smallest: bool) -> Iterator[Row]:
    """Measure everything; small machines differ, so nothing is promised here."""
    yield whole_run(1 if smallest else 11)
    for stops in (False, True):
        ratios = [back_ratio(stops, 25 if smallest else 250) for _ in range(1 if smallest else 5)]
        yield Row(
            figure=f"back over 1,000 statements against running them, {'with' if stops else 'without'} stops",
            form="{:.4f} (at most 0.1)",
            values=(statistics.median(ratios),),
        )
    yield logged(1 if smallest else 15)
    yield from wrist(1 if smallest else 7, not smallest)
    for figure, command in COMMANDS.items():
        words = [*command, *(["--no-physics"] if smallest and command[0] == "run" else [])]
        yield Row(figure=figure, form="{:.0f} ms", values=(1e3 * process_seconds(1 if smallest else 8, *words),))


if __name__ == "__main__":
    figures.run(rows)
