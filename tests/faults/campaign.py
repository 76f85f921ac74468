"""``make fault-campaign``, ``make supervision-campaign``: every fault, 200 clean runs and wrong payloads, counted."""

import dataclasses
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from robolang.execution.session import RunResult, Session
from robolang.project.project import Project, load_project
from runtime.settings.profile import Profile
from tests.bench import figures
from tests.bench.figures import Row
from tests.faults.devices import break_drive, break_encoder, break_hand_over, break_plant

PROGRAM = Path("programs/pick_and_place.rbl")
Break = Callable[[Session, int, int], None]

WITHIN_MS: dict[str, float] = {
    "encoder stuck": 60.0,
    "encoder jump": 1.0,
    "encoder sign": 150.0,
    "encoder lost": 16.0,
    "encoder nan": 1.0,
    "drive dead": 250.0,
    "drive half": 500.0,
    "brake": 150.0,
    "nan torque": 1.0,
    "nan state": 1.0,
    "plan row": 32.0,
    "INA": 8.0,
    "D": 8.0,
    "T": 8.0,
}
"""Longest time from the fault to the tick that the alarm names, ms (docs/supervision.md)."""


@dataclass(slots=True)
class Tally:
    """What became of faults: how many there were, which were not named rightly, alarms and times to them, ms."""

    tries: int = 0
    wrong: list[str] = field(default_factory=list)
    codes: Counter[str] = field(default_factory=Counter)
    times: list[float] = field(default_factory=list)

    def add(self, other: "Tally") -> None:
        self.tries += other.tries
        self.wrong += other.wrong
        self.codes += other.codes
        self.times += other.times


def inject(fault: str) -> Break:
    """Return the function (session, axis, tick) that puts the fault in."""
    kind = fault.removeprefix("encoder ").removeprefix("drive ")
    if fault.startswith("encoder"):
        return lambda session, axis, at: break_encoder(session, kind, axis, at)
    if fault in ("plan row", "INA", "D", "T"):
        return lambda session, axis, at: break_hand_over(session, kind, axis, at)
    if fault == "nan torque":
        return lambda session, axis, at: break_drive(session, kind, axis, at)
    return lambda session, axis, at: break_plant(session, kind, axis, at)


def project_of(
    text: str,
    points: dict[str, list[float]] | None = None,
    profile: Profile | None = None,
    part_kg: float | None = None,
) -> Project:
    """Return the project of a program text on the cell of the 1992 program, with other points, profile or part."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "p.rbl"
        place.write_text(text)
        if points is not None:
            rows = "".join(f"[points.{name}]\npose = {pose}\n" for name, pose in points.items())
            place.with_name("p.points.toml").write_text(f'schema = 1\nrobot = "puma560"\n{rows}')
        cell = PROGRAM.with_name("pick_and_place.cell.toml").read_text()
        if part_kg is not None:
            cell = cell.replace("mass_kg = 1.5", f"mass_kg = {part_kg!r}")
        place.with_name("p.cell.toml").write_text(cell)
        project = load_project(place)
    return project.with_profile(profile) if profile is not None else project


def moving_axes(result: RunResult, line: int, at_share: float) -> tuple[int, list[int]]:
    """Return (tick, axes that turn briskly there) at a share of a line of a clean run."""
    ticks = np.flatnonzero(result.log["number"] == line)
    tick = int(ticks[0] + at_share * len(ticks))
    return tick, [int(axis) for axis in np.flatnonzero(np.abs(result.log["dq_cmd"][tick]) > 0.1)]


def run_fault(project: Project, fault: str, axis: int, at: int, physics: bool) -> tuple[RunResult, dict | None]:
    """Run with one fault; return the result and its first alarm."""
    session = Session(project, physics=physics)
    inject(fault)(session, axis, at)
    result = session.run()
    alarms = result.report["alarms"]
    return result, alarms[0] if alarms else None


def verdict(alarm: dict | None, fault: str, axis: int, at: int, line: int) -> str:
    """Return "" when the alarm names line and axis in time, else what is wrong."""
    if alarm is None:
        return "not found"
    late = alarm["time_s"] * 1000.0 - at
    if alarm["number"] != line:
        return f"line {alarm['line']} instead of {line} ({alarm['code']})"
    if alarm["axis"] != axis + 1:
        return f"J{alarm['axis']} instead of J{axis + 1} ({alarm['code']})"
    if not -1.0 <= late <= WITHIN_MS[fault]:
        return f"after {late:.0f} ms ({alarm['code']})"
    return ""


def fault_campaign(project: Project, physics: bool, fault: str, at: int, axes: list[int], line: int) -> Tally:
    """Put one fault into each axis at one tick of a line, and return what became of it."""
    tally = Tally()
    for axis in axes:
        tally.tries += 1
        _, alarm = run_fault(project, fault, axis, at, physics)
        if alarm is not None:
            tally.codes[alarm["code"]] += 1
            tally.times.append(alarm["time_s"] * 1000.0 - at)
        why = verdict(alarm, fault, axis, at, line)
        if why:
            tally.wrong.append(f"line {line} J{axis + 1}: {why}")
    return tally


PLACES = ((30, 0.4), (60, 0.5), (70, 0.3))
"""Lines of the program, and where in their moves."""


def fault_tallies(
    physics: bool, faults: Iterable[str], places: Iterable[tuple[int, float]], axes: int
) -> dict[str, Tally]:
    """Return by fault what became of it on the axes that move (at most so many), at several places."""
    project = load_project(PROGRAM)
    clean = Session(project, physics=physics).run()
    torque = np.abs(clean.log["tau_sat"]) / project.cell.robot.per_axis("limits", "torque")
    tallies: dict[str, Tally] = {fault: Tally() for fault in faults}
    for fault, tally in tallies.items():
        for line, share in places:
            at, moving = moving_axes(clean, line, share)
            if fault == "drive half":  # else what is missing is less than what a payload could explain
                moving = [axis for axis in moving if axis <= 2 and torque[at, axis] >= 0.1]
            tally.add(fault_campaign(project, physics, fault, at, moving[:axes], line))
    return tallies


def random_program(rng: np.random.Generator) -> tuple[str, dict[str, list[float]]]:
    """Return a pick-up and four moves over the table at random postures, speeds and heights."""
    points = {"P1": [480.0, -220.0, 640.0, 180.0, 0.0, 180.0], "A": [480.0, -220.0, 840.0, 180.0, 0.0, 180.0]}
    angle = 180.0
    for name in ("B", "C", "D"):
        angle -= float(rng.uniform(0.0, 60.0))
        tilt = 180.0 + float(rng.uniform(-15.0, 15.0))
        points[name] = [
            float(rng.uniform(380, 560)),
            float(rng.uniform(-250, 250)),
            float(rng.uniform(760, 900)),
            tilt,
            0.0,
            angle,
        ]
    moves = "".join(f"{60 + 10 * k} MOVE {name}, SPEED {rng.uniform(80, 500):.0f}\n" for k, name in enumerate("ABCD"))
    text = f"10 LOAD (0, 0, 60), 0.8\n20 HAND OFF\n30 MOVE P1\n40 HAND ON\n50 LOAD (0, 0, {{cog}}), {{mass}}\n{moves}"
    return text, points


def variant(rng: np.random.Generator, error_share: float, profile: Profile | None = None) -> Project:
    """Return a random project whose last LOAD is off by a share of the rated 2.5 kg (sign at random where it fits)."""
    from robolang.execution.dry_run import motion_check

    while True:
        text, points = random_program(rng)
        part = float(rng.uniform(0.3, 1.7))
        true, error = 0.8 + part, error_share * 2.5
        signs = [s for s in rng.permutation([-1.0, 1.0]) if 0.0 <= true + s * error <= 2.5]
        if not signs:
            continue
        declared = true + signs[0] * error
        cog = (0.8 * 60.0 + part * 113.7) / true
        project = project_of(text.format(cog=round(cog, 2), mass=round(declared, 4)), points, profile, part)
        if project.ok and not motion_check(project):
            return project


def payload_campaign(rounds: int, mujoco: int, error_share: float, seed: int = 8) -> tuple[int, int]:
    """Return (runs that reported a payload mismatch after the last LOAD, runs); prints other alarms."""
    rng = np.random.default_rng(seed)
    found = 0
    for k in range(rounds + mujoco):
        project = variant(rng, error_share)
        result = Session(project, physics=k >= rounds).run()
        codes = [alarm["code"] for alarm in result.report["alarms"]]
        found += codes == ["RBL517"]
        if codes not in ([], ["RBL517"]):
            print("    another alarm:", result.report["alarms"])
    return found, rounds + mujoco


def clean_profile(rng: np.random.Generator) -> Profile:
    """Return a controller profile with a random servo period, mode and feed-forward."""
    base = Profile()
    measured = rng.random() < 0.25
    servo = dataclasses.replace(
        base.servo,
        mode="fixed" if rng.random() < 0.3 else "scheduled",
        source="measured" if measured else "command",
        velocity_feedforward=0.0 if measured else 1.0,
        acceleration_feedforward=0.0 if measured else 1.0,
    )
    return dataclasses.replace(
        base,
        servo=servo,
        tick_us=int(rng.choice([500, 1000])),
        load_mode="add",
        speed_shape="jerk" if rng.random() < 0.7 else "trapezoid",
    )


def clean_campaign(runs: int, mujoco_share: float = 0.5, seed: int = 3) -> int:
    """Return how many clean runs raised an alarm or a warning of the supervision, after printing each.

    RBL523 is none: some of these profiles leave more than the in-position window between arm and command. What a plan
    says of its motion (RBL4xx), such as that a speed is not reached, is none either.
    """
    rng = np.random.default_rng(seed)
    tripped = 0
    for k in range(runs):
        profile = clean_profile(rng)
        project = variant(rng, 0.0, profile)
        result = Session(project, physics=k < mujoco_share * runs).run()
        found = result.report["alarms"] + result.report["warnings"]
        raised = [item for item in found if item["code"] != "RBL523" and not item["code"].startswith("RBL4")]
        tripped += bool(raised)
        if raised:
            print(f"    run {k}, {profile.servo.mode} {profile.servo.source} {profile.tick_us} us:", raised)
    return tripped


def fault_rows(smallest: bool) -> Iterator[Row]:
    """Every fault on every axis, and clean runs."""
    details, tries, wrong = [], 0, 0
    for physics in (False,) if smallest else (False, True):
        chosen = ("encoder jump", "plan row") if smallest else tuple(WITHIN_MS)
        for fault, tally in fault_tallies(
            physics, chosen, PLACES[:1] if smallest else PLACES, 1 if smallest else 6
        ).items():
            tries, wrong = tries + tally.tries, wrong + len(tally.wrong)
            details += [
                f"{'MuJoCo' if physics else 'rigid':6} {fault:14} {tally.tries - len(tally.wrong):3} of "
                f"{tally.tries:3}, at most {max(tally.times, default=-1):4.0f} ms, {dict(tally.codes)}",
                *tally.wrong,
            ]
    yield Row(
        figure="injected faults named with line and axis in time",
        form="{} of {}",
        values=(tries - wrong, tries),
        good=not wrong,
        details=tuple(details),
    )
    runs = 2 if smallest else 200
    tripped = clean_campaign(runs, 0.0 if smallest else 0.5)
    yield Row(figure="false trips in clean runs", form="{} in {}", values=(tripped, runs), good=not tripped)


def payload_rows(smallest: bool) -> Iterator[Row]:
    """Wrong payloads in random programs, far off and little off."""
    rigid, mujoco = (2, 0) if smallest else (160, 40)
    (far, runs), (little, _) = (payload_campaign(rigid, mujoco, share) for share in (0.3, 0.05))
    yield Row(
        figure="payload 30 % of rated off: reported; 5 % off: reported",
        form="{} of {}; {} of {}",
        values=(far, runs, little, runs),
        good=far >= 0.99 * runs and not little,
    )


if __name__ == "__main__":
    figures.run({"faults": fault_rows, "payload": payload_rows}[sys.argv.pop(1)])
