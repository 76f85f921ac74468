"""Where arm, fingers and parts of a log are at a time."""

import copy
from pathlib import Path

import numpy as np
import pytest

from robolang.logs.log import Log
from robolang.view.replay import Replay
from runtime.appearance.cell_scene import scene_of
from runtime.appearance.stance import world_poses
from runtime.core.faults import Fault
from tests.robolang.logs import made
from tests.runtime.from_texts import load_cell

CELL = load_cell(Path("programs/pick_and_place.cell.toml"))
SCENE = scene_of(CELL).as_json()


def log(ticks=400, numbers=made.PLAIN, parts=1, **changes):
    meta = made.meta() | {"scene": copy.deepcopy(SCENE)} | changes
    return Log(made.recorder(ticks, numbers, parts).recorded(), meta, "run.npz")


def test_the_arm_stands_at_its_tick():
    recorded = log()
    replay = Replay(recorded)
    assert replay.end == pytest.approx(0.399)
    for time, tick in ((0.0, 0), (0.1234, 123), (0.399, 399)):
        np.testing.assert_array_equal(replay.at(time).axes, recorded["q_link"][tick])


def test_between_two_frames_parts_and_fingers_are_between():
    recorded = log()
    replay, parts, fingers = Replay(recorded), recorded["parts"], recorded["fingers"]
    exact, between = replay.at(0.032), replay.at(0.036)
    np.testing.assert_allclose(exact.parts[0], parts[2].ravel(), atol=1e-6)
    np.testing.assert_allclose(exact.fingers, fingers[2].ravel(), atol=1e-6)
    before, after = parts[2].ravel(), parts[3].ravel()
    np.testing.assert_allclose(between.parts[0][:3], 0.75 * before[:3] + 0.25 * after[:3], atol=1e-6)
    # beyond the last frame all is where that has it
    np.testing.assert_allclose(replay.at(0.399).parts[0], parts[-1].ravel(), atol=1e-6)


def test_a_cell_without_parts_has_none():
    bare = copy.deepcopy(SCENE) | {"bodies": [body for body in SCENE["bodies"] if not body["name"].startswith("part:")]}
    bare["shapes"] = [shape for shape in SCENE["shapes"] if not shape["body"].startswith("part:")]
    replay = Replay(Log(made.recorder(400, made.PLAIN, parts=0).recorded(), made.meta() | {"scene": bare}, "run.npz"))
    assert replay.at(0.1).parts.shape == (0, 7)


@pytest.mark.parametrize("parts", [0, 1, 3])
def test_every_part_has_its_pose(parts):
    recorded = log(parts=parts)
    found = Replay(recorded).at(0.016)
    assert found.parts.shape == (parts, 7)
    np.testing.assert_allclose(found.parts.ravel(), recorded["parts"][1].ravel(), atol=1e-6)


def test_a_part_whose_quaternion_changes_sign_does_not_turn():
    class Rows:
        ticks, cycles, frames, ticks_per_cycle, tick_us, tools = 33, 5, 3, 8, 1000, (np.eye(4),)

        def read(self, name, first, last):
            half = [0.0, 0.0, 0.0, 0.6, 0.8, 0.0, 0.0]
            whole = {
                "parts": np.array([half, np.multiply(half, [1, 1, 1, -1, -1, -1, -1]), half]),
                "fingers": np.zeros((3, 2)),
                "q_link": np.zeros((33, 6)),
            }[name]
            return whole[first:last]

    replay = Replay(Log(Rows(), made.meta() | {"scene": SCENE}))
    turned = [world_poses(replay.scene, replay.at(time))["part:part"][:3, :3] for time in (0.0, 0.008, 0.016)]
    np.testing.assert_allclose(turned[1], turned[0], atol=1e-12)
    np.testing.assert_allclose(turned[2], turned[0], atol=1e-12)


def test_a_log_of_nan_is_refused_at_its_time():
    replay = Replay(log(numbers=np.array([np.nan, 1.0, 2.0])))
    with pytest.raises(Fault) as refused:
        replay.at(0.1)
    assert (refused.value.code, "0.100 s" in refused.value.message) == ("RBL832", True)


def test_a_log_without_a_scene_or_without_motion_is_refused():
    with pytest.raises(Fault) as refused:
        Replay(log(scene=None))
    assert refused.value.code == "RBL833"
    with pytest.raises(Fault) as refused:
        Replay(log(ticks=0))
    assert refused.value.code == "RBL832"
    with pytest.raises(Fault) as refused:
        Replay(Log(made.recorder(8).recorded(), None))
    assert refused.value.code == "RBL820"
