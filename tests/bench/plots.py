"""``make plots``: draws the plots of docs/servo.md into docs/plots/, from experiments run on the spot."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from robolang.execution.plot import Curve, Labels, as_svg
from robolang.experiments.step import step
from runtime.core.units import DEG
from runtime.robot.model.payload import NO_PAYLOAD
from tests.robolang.experiments.test_step import FAR, FIVE, HALF, NEAR, PUMA, REPLACED, STRETCHED, experiment

FOLDER = Path(__file__).parents[2] / "docs" / "plots"


def response(name, end, seconds, dashed=False, **servo):
    """Return the curve of a step of 0.1 rad on the waist at one end of its inertia range."""
    q, carried = end
    result = step(replace(experiment(0, q, 0.1, carried, robot=REPLACED, **servo), locked=True, seconds=seconds))
    shown = result.t <= seconds - 0.1
    return Curve(name=name, x=result.t[shown], y=result.response[shown], dashed=dashed)


def steps(seconds: float) -> str:
    """Draw the step responses of A4."""
    return as_svg(
        Labels(title="Step of 0.1 rad, waist of the Puma 560, D' 2.341 or 9.680 kg m2", x="time, s", y="angle, rad"),
        [
            response("scheduled, largest inertia", FAR, seconds),
            response("scheduled, smallest inertia", NEAR, seconds, dashed=True),
            response("fixed at smallest, largest inertia", FAR, seconds, mode="fixed", fixed_at="min"),
            response("fixed at middle, largest inertia", FAR, seconds, mode="fixed", fixed_at="mid"),
            response("fixed at largest, smallest inertia", NEAR, seconds, mode="fixed", fixed_at="max"),
        ],
        level=0.1,
    )


def droops(every_deg: float) -> str:
    """Draw the droop of A5 over the angle of the shoulder."""
    angles = np.arange(0.0, 91.0, every_deg)
    curves = []
    for name, carried, said, gravity in (
        ("5 kg, no compensation", FIVE, FIVE, 0.0),
        ("bare, no compensation", NO_PAYLOAD, NO_PAYLOAD, 0.0),
        ("5 kg, LOAD says 0.5 kg", FIVE, HALF, 1.0),
        ("5 kg, LOAD right", FIVE, FIVE, 1.0),
    ):
        found = []
        for angle in angles:
            q = STRETCHED + angle * DEG * np.eye(6)[1]
            robot = PUMA if carried is NO_PAYLOAD else REPLACED
            request = experiment(1, q, 0.0, carried, said, robot, gravity_compensation=gravity)
            found.append(step(replace(request, seconds=0.2)).droop / DEG)
        curves.append(Curve(name=name, x=angles, y=np.array(found)))
    title = "Droop of the shoulder of the Puma 560, arm stretched, Kp 20, Kv 80 1/s"
    labels = Labels(title=title, x="angle of J2 above level, deg", y="droop, deg")
    return as_svg(labels, curves, corner="top")


def draw(folder: Path, seconds: float = 0.6, every_deg: float = 7.5) -> list[Path]:
    """Write both plots, steps of so many seconds and the droop at every so many degrees; return their paths."""
    folder.mkdir(exist_ok=True)
    plots = {folder / "steps.svg": steps(seconds), folder / "droop.svg": droops(every_deg)}
    for path, text in plots.items():
        path.write_text(text, "utf-8")
    return list(plots)


if __name__ == "__main__":
    print(*draw(FOLDER), sep="\n")
