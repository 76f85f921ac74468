"""A frame from three points: against an independent formula, with errors that scale as geometry says."""

import numpy as np
import pinocchio as pin
import pytest

from robolang.execution import lowering
from robolang.teaching.frames import frame_of
from robolang.teaching.touches import Touch
from runtime.core.faults import Fault


def touch(name, *mm):
    X = np.eye(4)
    X[:3, 3] = np.array(mm) * 1e-3
    return Touch(name=name, X=X)


def touches(X, *places_mm, error_mm=0.0, rng=None):
    """Touches at places of a frame X (4, 4), each with an error of its own."""
    found = []
    for index, place in enumerate(places_mm):
        p = X[:3, 3] + X[:3, :3] @ np.array(place) * 1e-3
        if error_mm:
            p = p + rng.normal(0.0, error_mm * 1e-3, 3)
        found.append(touch(f"P{index + 1}", *(p * 1e3)))
    return found


def random_frames(count, seed):
    rng = np.random.default_rng(seed)
    for quaternion in rng.normal(size=(count, 4)):
        X = np.eye(4)
        X[:3, :3] = pin.Quaternion(quaternion / np.linalg.norm(quaternion)).toRotationMatrix()
        X[:3, 3] = rng.uniform(-1.0, 1.0, 3)
        yield X, rng


def test_the_frame_of_exact_touches():
    for X, rng in random_frames(50, 1):
        on_x, x, y = rng.uniform(20, 500), rng.uniform(-300, 300), rng.uniform(20, 500)
        found = frame_of(*touches(X, (0, 0, 0), (on_x, 0, 0), (x, y, 0)))
        assert lowering.pose_si(found) == pytest.approx(X, abs=1e-9)


def test_angles_are_those_of_another_library():
    for X, _ in random_frames(20, 2):
        *_, rx, ry, rz = frame_of(*touches(X, (0, 0, 0), (100, 0, 0), (0, 100, 0)))
        assert pin.rpy.rpyToMatrix(*np.radians([rx, ry, rz])) == pytest.approx(X[:3, :3], abs=1e-9)


def test_errors_of_touches_turn_the_frame_by_their_size_over_the_distance():
    angles = {}
    for distance in (50.0, 500.0):
        turned = []
        for X, rng in random_frames(400, 3):
            found = lowering.pose_si(
                frame_of(*touches(X, (0, 0, 0), (distance, 0, 0), (0, distance, 0), error_mm=0.1, rng=rng))
            )
            turned.append(np.linalg.norm(pin.log3(X[:3, :3].T @ found[:3, :3])))
        angles[distance] = np.sqrt(np.mean(np.square(turned)))
    # two touches of each of three directions: sqrt(6) times the error over the distance
    for distance, angle in angles.items():
        assert angle == pytest.approx(np.sqrt(6) * 0.1 / distance, rel=0.15)


@pytest.mark.parametrize(
    ("places", "code", "numbers"),
    [
        # too near on the X axis
        (((0, 0, 0), (9.5, 0, 0), (0, 100, 0)), "RBL313", ["P2", "9.5", "10"]),
        (((0, 0, 0), (0, 0, 0), (0, 100, 0)), "RBL313", ["P2", "0", "10"]),
        # on one line, on either side of the origin
        (((0, 0, 0), (200, 0, 0), (150, 4, 0)), "RBL313", ["P3", "4", "10"]),
        (((0, 0, 0), (200, 0, 0), (-150, 0, 4)), "RBL313", ["P3", "4", "10"]),
        (((0, 0, 0), (200, 0, 0), (0, 0, 0)), "RBL313", ["P3", "0", "10"]),
        (((0, 0, 0), (200, 0, 0), (0, np.nan, 0)), "RBL309", ["P3"]),
        (((0, 0, 0), (2e6, 0, 0), (0, 100, 0)), "RBL309", ["P2"]),
        (((np.inf, 0, 0), (200, 0, 0), (0, 100, 0)), "RBL309", ["P1"]),
    ],
)
def test_touches_that_determine_no_frame(places, code, numbers):
    with pytest.raises(Fault) as caught:
        frame_of(*(touch(f"P{index + 1}", *place) for index, place in enumerate(places)))
    assert caught.value.code == code
    assert all(number in caught.value.message for number in numbers)


def test_just_far_enough():
    assert frame_of(touch("A", 0, 0, 0), touch("B", 10.001, 0, 0), touch("C", 300, 10.001, 0)) == pytest.approx(
        (0.0,) * 6
    )
