"""What is not a number is noticed in its own tick, and nothing jumps."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

from robolang.project.builtin import cell_text
from runtime.core.tomlfile import Source
from runtime.plant.mujoco_plant import MujocoPlant
from runtime.robot.model.arm_model import ArmModel
from tests.runtime.from_texts import parse_cell

pytestmark = pytest.mark.physics

CELL = parse_cell(Source("cell.toml", cell_text()))
SPEC = CELL.robot
GRAVITY = ArmModel(SPEC).gravity(np.array(CELL.home))


def moving_plant() -> MujocoPlant:
    plant = MujocoPlant(SPEC, CELL)
    for _ in range(20):
        assert plant.step(GRAVITY + 30.0)
    return plant


def assert_stopped_where_it_was(plant: MujocoPlant, tau: np.ndarray, word: str) -> None:
    """The next step fails, keeps the last valid state for good and says why."""
    q, dq, parts = plant.q.copy(), plant.dq.copy(), plant.parts()
    assert plant.step(tau) is False
    for torque in (tau, GRAVITY):  # a good torque afterwards does not bring it back
        assert plant.step(torque) is False
        np.testing.assert_array_equal(plant.q, q)
        np.testing.assert_array_equal(plant.dq, dq)
    assert word in plant.why_invalid()
    assert np.isfinite(plant.X_world_tool()).all()
    np.testing.assert_array_equal(plant.parts()["part"], parts["part"])


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e11])
@pytest.mark.parametrize("axis", [0, 5])
def test_a_bad_torque(bad: float, axis: int) -> None:
    tau = GRAVITY.copy()
    tau[axis] = bad
    assert_stopped_where_it_was(moving_plant(), tau, "CTRL")


@pytest.mark.parametrize("bad", [np.nan, np.inf])
@pytest.mark.parametrize(
    ("field", "index", "word"),
    [
        ("qpos", 2, "QPOS"),
        ("qpos", 7, "QPOS"),
        ("qpos", 9, "QPOS"),
        ("qpos", 12, "QPOS"),
        ("qvel", 0, "QVEL"),
        ("qvel", 13, "QVEL"),
        ("qfrc_applied", 3, "QACC"),
        ("qfrc_applied", 9, "QACC"),
    ],
)
def test_a_bad_number_anywhere_in_the_state(field: str, index: int, word: str, bad: float) -> None:
    """Arm, finger and part: MuJoCo's own copy is spoilt between two ticks."""
    plant = moving_plant()
    kept = plant.q.copy()
    getattr(plant._data, field)[index] = bad
    np.testing.assert_array_equal(plant.q, kept)  # what the controller reads is not MuJoCo's array
    assert_stopped_where_it_was(plant, GRAVITY, word)


def test_a_healthy_run_raises_no_alarm() -> None:
    plant = MujocoPlant(SPEC, CELL)
    assert all(plant.step(GRAVITY) for _ in range(500))
    assert plant.why_invalid() == ""


def test_a_full_contact_buffer_is_not_left_out() -> None:
    plant = moving_plant()
    plant._data.warning[int(mujoco.mjtWarning.mjWARN_CONTACTFULL)].number += 1
    assert plant.step(GRAVITY) is False


def test_joint_arrays_are_live_and_read_only() -> None:
    plant = MujocoPlant(SPEC, CELL)
    q, dq = plant.q, plant.dq
    before = q.copy()
    for _ in range(50):
        plant.step(GRAVITY + 40.0)
    assert q is plant.q
    assert dq is plant.dq
    assert np.abs(q - before).max() > 1e-5
    for array in (q, dq):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0


def test_mujoco_leaves_no_log_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    plant = MujocoPlant(SPEC, CELL)
    assert plant.step(np.full(SPEC.n, np.nan)) is False
    assert list(tmp_path.iterdir()) == []


def test_mujoco_would_have_left_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The proof that the test above can fail."""
    monkeypatch.chdir(tmp_path)
    plant = MujocoPlant(SPEC, CELL)
    config = mujoco.MjLogConfig.get()
    config.logto_file = True
    mujoco.MjLogConfig.set(config)
    try:
        plant.step(np.full(SPEC.n, np.nan))
    finally:
        config.logto_file = False
        mujoco.MjLogConfig.set(config)
    assert [path.name for path in tmp_path.iterdir()] == ["MUJOCO_LOG.TXT"]


@pytest.mark.parametrize("tick_s", [0.0, -1e-3, float("nan"), float("inf"), 1.0])
def test_a_tick_that_is_none_is_refused(tick_s: float) -> None:
    with pytest.raises(ValueError, match="tick"):
        MujocoPlant(SPEC, CELL, tick_s)
