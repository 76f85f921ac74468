"""``make measured``: prints every figure of docs/measured.md that is not a time (those are ``make bench``)."""

import hashlib
import math
import re
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from robolang.lowering import pose_si
from robolang.project import load_project
from robolang.runlog import write_log
from robolang.session import RunResult, Session
from robolang.step import step
from runtime.frames import inverse, pose, principal_axis, rotation_about, rotation_angle, rotation_from_rpy
from runtime.motion.path import LinePath
from runtime.plant.mjcf import build_mjcf
from runtime.robot.model import spec_rotors
from tests.experiments import test_step as bench
from tests.loop.test_scheduling import Bench
from tests.runtime.dynamics import lagrangian
from tests.runtime.dynamics import test_equations as a2
from tests.sim import test_plant_grasp as grasp
from tests.sim import test_plant_model as agreement

PROGRAM = Path("programs/pick_and_place.rbl")


def heading(text: str) -> None:
    print(f"\n## {text}")


def measure_dynamics() -> None:
    heading("A2 dynamics")
    model = a2.model_with()
    M = model.mass_matrix(a2.Q_PUBLISHED)
    print("diagonal of D + N^2 J at q = (1..6) rad:", np.round(np.diag(M) + spec_rotors(a2.SPEC), 4))
    print(f"M12 {M[0, 1]:.4f}, gravity {np.round(model.gravity(a2.Q_PUBLISHED), 4)}")
    worst = 0.0
    for payload in (None, (2.3, (0.0, 0.0, 0.095))):
        model = a2.model_with(payload)
        for q in a2.POSTURES:
            D, T = np.diag(model.mass_matrix(q)), model.gravity(q)
            D_geo, T_geo = lagrangian.geometric(a2.ROWS, q, payload)
            D_lag = np.diag(lagrangian.mass_matrix(a2.ROWS, q, payload))
            T_lag = lagrangian.gravity(a2.ROWS, q, payload)
            D_unit = np.array([model.inertia_column(q, i)[i] for i in range(6)])
            worst = max(worst, *(np.abs(a - b).max() for a, b in
                                 ((D_unit, D_geo), (D_unit, D_lag), (D_unit, D), (T, T_geo), (T, T_lag))))  # fmt: skip
    print(f"unit acceleration, geometric form and Lagrangian, 200 postures, with and without payload: {worst:.1e}")


def measure_agreement() -> None:
    heading("Pinocchio against MuJoCo, 200 poses (kg m2, N m, m and rotation entries)")
    for name, load in (("bare", None), ("2.3 kg with inertia", agreement.LOAD)):
        text = build_mjcf(agreement.SPEC, timestep=1e-3, payload=load)
        errors = [agreement.worst(text, load, compare) for compare in
                  (agreement.mass_matrix_error, agreement.gravity_error, agreement.flange_error)]  # fmt: skip
        print(f"{name}: mass matrix {errors[0]:.1e}, gravity {errors[1]:.1e}, flange {errors[2]:.1e}")


def measure_scheduling() -> None:
    heading("A3 scheduling")
    for Ci, Cd in ((5, 2.5), (5, 4), (3, 1), (7, 3)):
        rig = Bench(int(Ci * 1000), int(Cd * 1000))
        rig.run(cycles=1800)
        times = [t for axis, t, _ in rig.refreshes if axis == 2]
        periods = set(np.diff(rig.interrupts).tolist())
        print(f"(Ci, Cd) = ({Ci}, {Cd}) ms: refresh {np.mean(np.diff(times)) / 1000:.2f} ms, "
              f"interpolation period {periods} us, monolithic {Ci + 6 * Cd:g} ms")  # fmt: skip


def measure_axis() -> None:
    heading("A6 rotation-principal-axis, 2000 random pairs and 2000 half turns")
    rng = np.random.default_rng(6)
    s = np.linspace(0.0, 1.0, 51)
    end, linear, line = 0.0, 0.0, 0.0
    for _ in range(2000):
        R_a, R_b = rotation_from_rpy(rng.uniform(-math.pi, math.pi, (2, 3)))
        path = LinePath.between(pose(rng.uniform(-1, 1, 3), R_a), pose(rng.uniform(-1, 1, 3), R_b))
        X = path.poses(s)
        end = max(end, np.abs(X[-1] - path.X_end).max())
        grown = [rotation_angle(R_a, R) for R in X[1:-1:10, :3, :3]]
        linear = max(linear, np.abs(grown - s[1:-1:10] * path.angle).max())
        line = max(line, path.deviation(X[:, :3, 3]).max())
    half = 0.0
    for _ in range(2000):
        k = rng.normal(size=3)
        R_a = rotation_from_rpy(rng.uniform(-math.pi, math.pi, 3))
        R_b = rotation_about(k / np.linalg.norm(k), math.pi) @ R_a
        axis, theta = principal_axis(R_a, R_b)
        half = max(half, np.abs(rotation_about(axis, theta) @ R_a - R_b).max())
    print(f"end pose {end:.1e}, half turns {half:.1e}, angle from linear {linear:.1e} rad, off the line {line:.1e} m")


def print_moves(title: str, result: RunResult) -> None:
    print(title)
    for entry in result.report["statements"]:
        if entry["path_deviation_mm"] is not None:
            print(f"  line {entry['number']:3}: joint {entry['joint_error_deg']:.4f} deg, tool "
                  f"{entry['tool_error_mm']:.3f} mm, off path {entry['path_deviation_mm']:.3f} mm, "
                  f"torque {entry['peak_torque_pct']:.0f} %")  # fmt: skip


def run_text(text: str, servo: str | None = None) -> tuple[Session, RunResult]:
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "program.rbl"
        program.write_text(text)
        project = load_project(program, servo=servo)
        warn = replace(project.profile.supervision, payload_mismatch="warn")  # so that the whole program is measured
        session = Session(project.with_profile(replace(project.profile, supervision=warn)))
        return session, session.run()


def measure_program() -> None:
    heading("The 1992 program on MuJoCo")
    text = PROGRAM.read_text()
    session, result = run_text(text)
    project = session.project
    print("A1 order:", ", ".join(f"{run.number} {run.text.split(' (')[0]}" for run in session.record.statements))
    print("A1 payload area:", ", ".join(f"{entry['mass_kg']} kg from line {entry['line']}"
                                        for entry in result.report["payload_history"]))  # fmt: skip
    X_p1, X_p3 = (pose_si(project.points.get(name).pose) for name in ("P1", "P3"))
    X_expected = X_p3 @ inverse(X_p1) @ project.cell.parts[0].X_world_part
    X_part = session.controller.plant.parts()["part"]
    print(f"part from where P3 put it: {1000 * np.linalg.norm(X_part[:3, 3] - X_expected[:3, 3]):.3f} mm, "
          f"{math.degrees(rotation_angle(X_part[:3, :3], X_expected[:3, :3])):.4f} deg")  # fmt: skip
    planned = 0.0
    for run in session.record.statements:
        if run.path is not None:
            q = result.log["q_plan"][result.log["line"] == run.number]
            planned = max(planned, run.path.deviation(session.controller.tool_poses(q)[:, :3, 3]).max())
    print(f"planned path of every MOVE off the line: {planned * 1000:.1e} mm")
    dynamics = result.report["dynamics"]
    print(f"dynamics task: refresh {dynamics['refresh_mean_ms']:.2f} ms, at most {dynamics['refresh_max_ms']:g} ms")
    first = int(np.flatnonzero(result.log["line"] == 60)[0])
    D = result.log["D"][first : first + 60]
    print("line 50 LOAD is in use on all axes after", int((np.abs(D - D[-1]) > 0.02 * D[-1]).any(1).sum()), "ms")
    print_moves("LOAD right:", result)
    print_moves("LOAD of the part forgotten (line 50 left out):", run_text(re.sub(r"(?m)^50 .*$", "", text))[1])
    print_moves("no LOAD at all:", run_text(re.sub(r"(?m)^\d+ LOAD.*$", "", text))[1])
    print_moves("gains fixed in the middle of the inertia range:", run_text(text, "fixed")[1])
    print("two runs, same bytes in the log, same report but for wall times:", repeats(text))


def repeats(text: str) -> tuple[bool, bool]:
    """Run a program twice; return whether the bytes of the log and the rest of the report are equal."""
    hashes, reports = [], []
    with tempfile.TemporaryDirectory() as folder:
        for name in ("one.npz", "two.npz"):
            result = run_text(text)[1]
            write_log(Path(folder) / name, result.log)
            hashes.append(hashlib.sha256((Path(folder) / name).read_bytes()).hexdigest())
            walls = ("wall_time_s", "realtime_factor", "program")
            reports.append({key: value for key, value in result.report.items() if key not in walls})
    return hashes[0] == hashes[1], reports[0] == reports[1]


def measure_grasp() -> None:
    heading("Grasp by friction")
    rig = grasp.Rig()
    rig.pick()
    rig.carries(True)
    rig.go(480.0, -220.0, 850.0)
    slip, turn, acceleration = grasp.shake(rig, 5.0)
    print(f"5 s at up to {acceleration:.1f} m/s2: slip {slip * 1000:.3f} mm, turn {math.degrees(turn):.4f} deg")


def measure_servo() -> None:
    heading("A4 step of the waist and A5 droop of the shoulder, ideal arm and MuJoCo")
    q_near, q_far = bench.NEAR[0], bench.FAR[0]
    fixed = [{"mode": "fixed", "fixed_at": at} for at in ("min", "mid", "max")]
    for plant, locked, ideal, size in (("rigid", True, True, 0.1), ("rigid", False, False, 0.01),
                                       ("mujoco", False, False, 0.01)):  # fmt: skip
        print(f"{plant}, others {'locked' if locked else 'free'}, drives {'ideal' if ideal else 'real'}, {size} rad")
        for q, carried, servo in ((q_near, bench.NO_PAYLOAD, {}), (q_far, bench.FIVE, {}),
                                  (q_far, bench.FIVE, fixed[0]), (q_far, bench.FIVE, fixed[1]),
                                  (q_near, bench.NO_PAYLOAD, fixed[2])):  # fmt: skip
            robot = bench.STRONG if plant == "mujoco" else bench.REPLACED
            request = bench.experiment(0, q, size, carried, robot=robot, **servo)
            found = step(replace(request, plant=plant, locked=locked, ideal=ideal))
            print(f"  D' {found.inertia:.3f}, gain for {found.gain_inertia:.3f} kg m2: overshoot "
                  f"{100 * found.overshoot:.2f} %, settling {found.settling:.4f} s, short by "
                  f"{math.degrees(found.droop):.4f} deg")  # fmt: skip
        for name, robot, carried, said, gravity, published in bench.DROOPS:
            used = bench.STRONG if plant == "mujoco" else robot
            request = bench.experiment(1, bench.STRETCHED, 0.0, carried, said, used, gravity_compensation=gravity)
            found = step(replace(request, plant=plant, ideal=ideal))
            print(f"  {name}: droop {math.degrees(found.droop):.4f} deg (published {published})")
    for coupling in ("diagonal", "full"):
        for axis in range(6):
            settling, overshoot = bench.over_the_range(axis, False, coupling)
            print(f"  J{axis + 1} over the range, {coupling}: settling {min(settling):.4f} to {max(settling):.4f} s, "
                  f"overshoot at most {100 * max(overshoot):.3f} %")  # fmt: skip


def main() -> None:
    """Print all figures."""
    measure_dynamics()
    measure_agreement()
    measure_scheduling()
    measure_axis()
    measure_program()
    measure_grasp()
    measure_servo()


if __name__ == "__main__":
    main()
