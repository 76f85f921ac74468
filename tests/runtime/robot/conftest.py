from dataclasses import replace

import numpy as np
import pytest

from runtime.core.frames import frozen, inverse, pose, rotation_about
from runtime.robot.files.loader import load_builtin
from runtime.robot.model.spec import OpwParameters, RobotSpec
from tests.runtime.robot.arms import DEG, Irb2400, X, Z, opw_parameters


@pytest.fixture(scope="session")
def puma() -> RobotSpec:
    return load_builtin("puma560")


@pytest.fixture(scope="session")
def irb2400(puma) -> RobotSpec:
    """The Puma's drives on the geometry of an IRB 2400 (only geometry and ranges matter here)."""
    frames = [
        pose(point, rotation_about(np.cross(Z, d) if abs(d[2]) < 1 else X, np.pi / 2 * (abs(d[2]) < 1)))
        for point, d in zip(Irb2400.points, Irb2400.directions, strict=True)
    ]
    before = [np.eye(4), *frames[:-1]]
    axes = tuple(
        replace(
            axis,
            placement=frozen(inverse(outer) @ inner),
            limits=replace(axis.limits, lower=low * DEG, upper=high * DEG),
        )
        for axis, outer, inner, (low, high) in zip(puma.axes, before, frames, Irb2400.range_deg, strict=True)
    )
    return replace(
        puma,
        name="irb2400",
        axes=axes,
        X_last_flange=frozen(inverse(frames[-1]) @ Irb2400.X_base_flange_zero),
        opw=opw_parameters((0.1, -0.135, 0.0, 0.615, 0.705, 0.755, 0.085), (0, 0, 90, 0, 0, 0)),
    )


@pytest.fixture(scope="session", params=["puma560", "irb2400", "kr6", "tx2_60"])
def params(request, puma, irb2400) -> OpwParameters:
    """Arms that differ in what matters: b < 0, = 0, > 0; a1, a2 zero or not; signs; offsets."""
    return {
        "puma560": puma.opw,
        "irb2400": irb2400.opw,
        "kr6": opw_parameters(
            (0.025, -0.035, 0.0, 0.4, 0.315, 0.365, 0.08), (0, 90, 0, 0, 0, 0), (-1, 1, 1, -1, 1, -1)
        ),
        "tx2_60": opw_parameters((0.0, 0.0, 0.02, 0.375, 0.29, 0.31, 0.07)),
    }[request.param]
