"""``make measured``: prints the figures of docs/measured.md that repeat exactly (times are ``make bench``)."""

import hashlib
import math
import re
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from robolang.execution.lowering import pose_si
from robolang.execution.session import RunResult, Session
from robolang.experiments.step import StepResult, step
from robolang.logs.files import write_log
from robolang.project.project import load_project
from runtime.core.frames import inverse, pose, principal_axis, rotation_about, rotation_angle, rotation_from_rpy
from runtime.core.units import badness
from runtime.motion.path import LinePath
from runtime.plant.mjcf import build_mjcf
from runtime.robot.model.arm_model import spec_rotors
from tests.bench import figures
from tests.bench.figures import Row
from tests.robolang.experiments import test_step as bench
from tests.runtime.control.test_scheduling import Bench
from tests.runtime.dynamics import lagrangian
from tests.runtime.dynamics import test_equations as a2
from tests.runtime.plant import test_plant_grasp as grasp
from tests.runtime.plant import test_plant_model as agreement

PROGRAM = Path("programs/pick_and_place.rbl")


def equations(postures: int) -> Iterator[Row]:
    """A2, and Pinocchio against MuJoCo."""
    model = a2.model_with()
    M, gravity = model.mass_matrix(a2.Q_PUBLISHED), model.gravity(a2.Q_PUBLISHED)
    yield Row(
        figure="A2: diagonal of D + N^2 J at q = (1, 2, 3, 4, 5, 6) rad",
        form=" ".join(["{:.4f}"] * 6),
        values=tuple(np.diag(M) + spec_rotors(a2.SPEC)),
    )
    yield Row(
        figure="A2: M12 and gravity there", form="{:.4f}; " + " ".join(["{:.4f}"] * 6), values=(M[0, 1], *gravity)
    )
    worst = 0.0
    for payload in (None, (2.3, (0.0, 0.0, 0.095))):
        model = a2.model_with(payload)
        for q in a2.POSTURES[:postures]:
            D, T = np.diag(model.mass_matrix(q)), model.gravity(q)
            D_geo, T_geo = lagrangian.geometric(a2.ROWS, q, payload)
            D_lag = np.diag(lagrangian.mass_matrix(a2.ROWS, q, payload))
            T_lag = lagrangian.gravity(a2.ROWS, q, payload)
            D_unit = np.array([model.inertia_column(q, i)[i] for i in range(6)])
            pairs = (D_unit, D_geo), (D_unit, D_lag), (D_unit, D), (T, T_geo), (T, T_lag)
            worst = max(worst, *(np.abs(a - b).max() for a, b in pairs), key=badness)
    yield Row(figure="A2: unit acceleration, geometric form and Lagrangian agree", form="{:.1e}", values=(worst,))
    for figure, load in (
        ("Pinocchio and MuJoCo, 200 poses, bare: mass matrix, gravity, flange", None),
        ("the same with 2.3 kg and its inertia", agreement.LOAD),
    ):
        text = build_mjcf(agreement.SPEC, timestep=1e-3, payload=load)
        errors = (
            agreement.worst(text, load, compare, poses=agreement.POSES[:postures])
            for compare in (agreement.mass_matrix_error, agreement.gravity_error, agreement.flange_error)
        )
        yield Row(figure=figure, form="{:.1e}, {:.1e}, {:.1e}", values=tuple(errors))


def scheduling(cycles: int) -> Iterator[Row]:
    """A3."""
    for Ci, Cd in ((5, 2.5), (5, 4), (3, 1), (7, 3)):
        rig = Bench(int(Ci * 1000), int(Cd * 1000))
        rig.run(cycles=cycles)
        refreshes = np.diff([t for axis, t, _ in rig.refreshes if axis == 2]) / 1000.0
        periods = np.diff(rig.interrupts) / 1000.0
        yield Row(
            figure=f"{Ci}, {Cd:g} ms",
            form="{:.2f} ms, {:.3f} ms, one loop would need {:g} ms",
            values=(refreshes.mean(), periods.mean(), Ci + 6 * Cd),
            good=float(np.ptp(periods)) == 0.0,
        )


def principal_axes(pairs: int) -> Iterator[Row]:
    """A6: random pairs of poses, and half turns."""
    rng = np.random.default_rng(6)
    s = np.linspace(0.0, 1.0, 51)
    end, linear, line, half = 0.0, 0.0, 0.0, 0.0
    for _ in range(pairs):
        R_a, R_b = rotation_from_rpy(rng.uniform(-math.pi, math.pi, (2, 3)))
        path = LinePath.between(pose(rng.uniform(-1, 1, 3), R_a), pose(rng.uniform(-1, 1, 3), R_b))
        X = path.poses(s)
        end = max(end, np.abs(X[-1] - path.X_end).max(), key=badness)
        grown = [rotation_angle(R_a, R) for R in X[1:-1:10, :3, :3]]
        linear = max(linear, np.abs(grown - s[1:-1:10] * path.angle).max(), key=badness)
        line = max(line, path.deviation(X[:, :3, 3]).max(), key=badness)
    for _ in range(pairs):
        k = rng.normal(size=3)
        R_a = rotation_from_rpy(rng.uniform(-math.pi, math.pi, 3))
        R_b = rotation_about(k / np.linalg.norm(k), math.pi) @ R_a
        axis, theta = principal_axis(R_a, R_b)
        half = max(half, np.abs(rotation_about(axis, theta) @ R_a - R_b).max(), key=badness)
    yield Row(figure="A6: end pose; half turns", form="{:.1e}; {:.1e}", values=(end, half))
    yield Row(figure="A6: angle from linear; off the line", form="{:.1e} rad; {:.1e} m", values=(linear, line))


def run_text(text: str, servo: str | None = None, physics: bool = True) -> tuple[Session, RunResult]:
    """Run a program text on the built-in cell; a wrong payload is a warning, so that the whole program is measured."""
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "program.rbl"
        program.write_text(text)
        project = load_project(program, servo=servo)
        warn = replace(project.profile.supervision, payload_mismatch="warn")
        session = Session(project.with_profile(replace(project.profile, supervision=warn)), physics=physics)
        return session, session.run()


def program(physics: bool) -> Iterator[Row]:
    """The 1992 program on MuJoCo; its variants on the ideal arm instead where only the bench is tested."""
    text = PROGRAM.read_text()
    session, result = run_text(text)
    order = ", ".join(f"{run.origin.number} {run.text.split(' (')[0]}" for run in session.record.statements)
    yield Row(
        figure="A1: order of the statements",
        form="{} statements",
        values=(len(session.record.statements),),
        details=(order,),
    )
    payloads = [(entry["mass_kg"], entry["line"]) for entry in result.report["payload_history"]]
    yield Row(
        figure="A1: payload in use",
        form=", ".join(["{:g} kg from line {}"] * len(payloads)),
        values=tuple(value for payload in payloads for value in payload),
    )
    yield placed(session)
    yield planned(session, result)
    dynamics = result.report["dynamics"]
    yield Row(
        figure="one refresh of an axis by the dynamics task, mean and longest",
        form="{:.2f} ms, {:g} ms",
        values=(dynamics["refresh_mean_ms"], dynamics["refresh_max_ms"]),
    )
    first = int(np.flatnonzero(result.log["number"] == 60)[0])
    D = result.log["D"][first : first + 60]
    yield Row(
        figure="from LOAD to the last axis using it",
        form="{} ms",
        values=(int((np.abs(D - D[-1]) > 0.02 * D[-1]).any(1).sum()),),
    )
    again = run_text(text)[1] if physics else result
    same = log_hash(result) == log_hash(again), kept(result) == kept(again)
    yield Row(figure="two runs, same bytes", form="log {}, report {}", values=same, good=all(same))
    variants = [
        result,
        *(
            run_text(changed, servo, physics)[1]
            for changed, servo in (
                (without(r"(?m)^ *50 .*$", text), None),
                (without(r"(?m)^ *\d+ +LOAD.*$", text, 3), None),
                (text, "fixed"),
            )
        ),
    ]
    yield from moves(variants)


def without(pattern: str, text: str, count: int = 1) -> str:
    """Return a text less what a pattern finds; it must find it ``count`` times, or the variant would be none."""
    changed, found = re.subn(pattern, "", text)
    if found != count:
        raise ValueError(f"{pattern} is there {found} times, not {count}")
    return changed


def placed(session: Session) -> Row:
    """Return how far the part is from where the program has put it."""
    project = session.project
    X_p1, X_p3 = (pose_si(project.points.get(name).pose) for name in ("P1", "P3"))
    X_expected = X_p3 @ inverse(X_p1) @ project.cell.parts[0].X_world_part
    X_part = session.controller.plant.parts()["part"]
    return Row(
        figure="part from where P3 put it",
        form="{:.3f} mm, {:.4f} deg",
        values=(
            1000 * float(np.linalg.norm(X_part[:3, 3] - X_expected[:3, 3])),
            math.degrees(rotation_angle(X_part[:3, :3], X_expected[:3, :3])),
        ),
    )


def planned(session: Session, result: RunResult) -> Row:
    """Return how far all moves are off their lines where the command passes the plan, every 8 ms."""
    worst = 0.0
    for run in session.record.statements:
        if run.path is not None:
            # the command passes the plan two cycles after its set-points are sent
            sent = np.flatnonzero(result.log["line"] == run.origin.line)
            q = result.log["q_cmd"][np.minimum(sent + 16, len(result.log["t"]) - 1)][::8]
            worst = max(worst, run.path.deviation(session.controller.tool_poses(q)[:, :3, 3]).max(), key=badness)
    return Row(
        figure="planned path of every MOVE off its line, at the 8 ms set-points",
        form="{:.1e} mm",
        values=(worst * 1000,),
    )


def moves(variants: list[RunResult]) -> Iterator[Row]:
    """Return per MOVE what the arm does in each variant of the program."""
    found = [{entry["number"]: entry for entry in result.report["statements"]} for result in variants]
    for number, entry in found[0].items():
        if entry["path_deviation_mm"] is not None:
            errors = [
                (
                    each[number]["joint_error_deg"],
                    each[number]["tool_error_mm"],
                    each[number]["path_deviation_mm"],
                    each[number]["peak_torque_pct"],
                )
                for each in found
            ]
            yield Row(
                figure=f"{number} {entry['text']}",
                form="; ".join(["{:.3f} deg, {:.3f}, {:.3f} mm, {:.0f} %"] * 4),
                values=tuple(value for each in errors for value in each),
            )


def log_hash(result: RunResult) -> str:
    """Return the hash of the file of a log."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log.npz"
        write_log(path, result.log)
        return hashlib.sha256(path.read_bytes()).hexdigest()


def kept(result: RunResult) -> dict:
    """Return a report without what no two runs have in common: wall times, and the place of the program."""
    return {
        key: value for key, value in result.report.items() if key not in ("wall_time_s", "realtime_factor", "program")
    }


HELD = "part held by friction, all joints swinging for 5 s: slip, turn, acceleration of the tool"


def held(seconds: float) -> Row:
    """Swing a part that friction holds."""
    rig = grasp.Rig()
    rig.pick()
    rig.carries(True)
    rig.go(480.0, -220.0, 850.0)
    slip, turn, acceleration = grasp.shake(rig, seconds)
    return Row(
        figure=HELD, form="{:.3f} mm, {:.4f} deg, {:.1f} m/s2", values=(slip * 1000, math.degrees(turn), acceleration)
    )


def settling(result: StepResult) -> tuple[str, tuple[float, ...]]:
    return "{:.4f} s", (result.settling,)


def overshoot(result: StepResult) -> tuple[str, tuple[float, ...]]:
    return "{:.2f} %, ends {:.2f} deg short", (100 * result.overshoot, math.degrees(result.droop))


MODES = (
    ("scheduled, D' 2.341 kg m2: settling", bench.NEAR, {}, settling),
    ("scheduled, D' 9.680 kg m2: settling", bench.FAR, {}, settling),
    ("fixed at smallest, 9.680: overshoot", bench.FAR, {"mode": "fixed", "fixed_at": "min"}, overshoot),
    ("fixed at middle, 9.680: overshoot", bench.FAR, {"mode": "fixed", "fixed_at": "mid"}, overshoot),
    ("fixed at largest, 2.341: settling", bench.NEAR, {"mode": "fixed", "fixed_at": "max"}, settling),
)


def servo(seconds: float) -> Iterator[Row]:
    """A4 and A5, on the ideal arm with the others locked and on MuJoCo with the drives of the robot."""
    for figure, (q, carried), options, shown in MODES:
        ideal = bench.experiment(0, q, 0.1, carried, robot=bench.REPLACED, **options)
        real = bench.experiment(0, q, 0.01, carried, robot=bench.STRONG, **options)
        yield side_by_side(
            figure,
            shown,
            step(replace(ideal, plant="rigid", locked=True, ideal=True, seconds=seconds)),
            step(replace(real, plant="mujoco", locked=False, ideal=False, seconds=seconds)),
        )
    for name, robot, carried, said, gravity, _ in bench.DROOPS:
        ideal, real = (
            bench.experiment(1, bench.STRETCHED, 0.0, carried, said, used, gravity_compensation=gravity)
            for used in (robot, bench.STRONG)
        )
        yield side_by_side(
            f"droop, {name}",
            lambda result: ("{:.4f} deg", (math.degrees(result.droop),)),
            step(replace(ideal, plant="rigid", ideal=True, seconds=seconds)),
            step(replace(real, plant="mujoco", ideal=False, seconds=seconds)),
        )


def side_by_side(figure, shown, ideal: StepResult, real: StepResult) -> Row:
    """Return the row of an experiment: what is shown of it, on the ideal arm and on MuJoCo."""
    (form, first), (_, second) = shown(ideal), shown(real)
    return Row(figure=figure, form=f"{form}; MuJoCo {form}", values=(*first, *second))


def alike(axes: int, whole: bool) -> Row:
    """Measure the step responses of all axes over the joint ranges."""
    details, spread, most = [], {"diagonal": [], "full": []}, 0.0
    for coupling, found in spread.items():
        for axis in range(axes):
            times, overshoots = bench.over_the_range(axis, False, coupling, whole)
            found.append(100.0 * (max(times) / min(times) - 1.0))
            most = max(most, 100.0 * max(overshoots, key=badness), key=badness) if coupling == "full" else most
            details.append(
                f"J{axis + 1}, {coupling}: settling {min(times):.4f} to {max(times):.4f} s, overshoot at most "
                f"{100 * max(overshoots):.3f} %"
            )
    return Row(
        figure="identical step responses over the joint ranges, bare and rated payload, all axes free: spread of "
        "the 2 % settling time, overshoot",
        form="at most {:.1f} %, {:.2f} %; {:.1f} % with the diagonal alone",
        values=(max(spread["full"]), most, max(spread["diagonal"])),
        details=tuple(details),
        good=max(spread["full"]) <= 3.0 and most <= 1.0,
    )


def rows(smallest: bool) -> Iterator[Row]:
    """Measure everything."""
    yield from equations(2 if smallest else 200)
    yield from scheduling(60 if smallest else 1800)
    yield from principal_axes(10 if smallest else 2000)
    yield from program(physics=not smallest)
    yield held(1.0 if smallest else 5.0)
    yield from servo(0.6 if smallest else 1.5)
    yield alike(1 if smallest else 6, not smallest)


if __name__ == "__main__":
    figures.run(rows)
