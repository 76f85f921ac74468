"""The tip of a tool from touches: against the truth, another formula, and the error that statistics predicts."""

import numpy as np
import pinocchio as pin
import pytest

from robolang.teaching.tools import tool_tip
from robolang.teaching.touches import Touch
from runtime.core.faults import Fault

TIP = np.array([30.0, -20.0, 180.0])


def tilted(count, rng):
    """Orientations of a flange that looks down, tilted by 35 deg to every side, each turned about itself at random."""
    side = 2.0 * np.pi * (np.arange(count) + rng.uniform()) / count
    tilts = 35.0 * np.stack([np.cos(side), np.sin(side), rng.uniform(-1.0, 1.0, count)], axis=1)
    return turned(tilts + [180.0, 0.0, 0.0])


def turned(rpy_deg):
    """Orientations (N, 3, 3) of angles about the fixed axes."""
    return np.array([pin.rpy.rpyToMatrix(*row) for row in np.radians(rpy_deg)])


def touches(R, rng, error_mm=0.0, tip=TIP, place=(600.0, 100.0, 50.0)):
    found = []
    for index, turn in enumerate(R):
        X = np.eye(4)
        X[:3, :3] = turn
        X[:3, 3] = (np.array(place) - turn @ tip + rng.normal(0.0, 1.0, 3) * error_mm) * 1e-3
        found.append(Touch(name=f"T{index + 1}", X=X))
    return found


@pytest.mark.parametrize("count", [3, 4, 8])
def test_exact_touches(count):
    rng = np.random.default_rng(count)
    found = tool_tip(touches(tilted(count, rng), rng))
    assert found.tip == pytest.approx(TIP, abs=1e-8)
    assert (found.worst, found.rms, found.uncertainty) == pytest.approx((0.0, 0.0, 0.0), abs=1e-8)
    assert len(found.residuals) == count


def test_the_tip_is_that_of_a_general_solver():
    rng = np.random.default_rng(5)
    for count in (3, 4, 6):
        given = touches(tilted(count, rng), rng, error_mm=0.3)

        # tool tip and fixed tip, mm, without eliminating either
        A = np.concatenate([np.hstack([each.X[:3, :3], -np.eye(3)]) for each in given])
        b = np.concatenate([-each.X[:3, 3] * 1e3 for each in given])
        solved = np.linalg.lstsq(A, b, rcond=None)[0]
        found = tool_tip(given)
        assert found.tip == pytest.approx(solved[:3], abs=1e-6)
        distances = np.linalg.norm((A @ solved - b).reshape(-1, 3), axis=1)
        assert found.residuals == pytest.approx(distances, abs=1e-6)
        assert found.rms == pytest.approx(np.sqrt(np.mean(distances**2)), abs=1e-6)
        covariance = np.linalg.inv(A.T @ A)[:3, :3]
        assert found.amplification == pytest.approx(np.sqrt(np.linalg.eigvalsh(covariance)[-1]), rel=1e-6)


@pytest.mark.parametrize("error_mm", [0.05, 0.5])
def test_the_error_is_what_the_amplification_says(error_mm):
    rng = np.random.default_rng(7)
    off, said = [], []
    R = tilted(5, rng)
    for _ in range(400):
        found = tool_tip(touches(R, rng, error_mm), most_apart=100.0)
        off.append(np.array(found.tip) - TIP)
        said.append(found.uncertainty)
    worst = np.sqrt(np.linalg.eigvalsh(np.cov(np.array(off).T))[-1])
    assert worst == pytest.approx(found.amplification * error_mm, rel=0.15)
    assert np.sqrt(np.mean(np.square(said))) == pytest.approx(worst, rel=0.15)


def test_turns_about_one_axis_leave_the_tip_open():
    rng = np.random.default_rng(1)
    R = turned([[0, 0, turn] for turn in (0, 40, 80, 160)])
    with pytest.raises(Fault) as caught:
        tool_tip(touches(R, rng))
    assert caught.value.code == "RBL314"


@pytest.mark.parametrize(("tilt", "refused"), [(8.0, True), (30.0, False)])
def test_orientations_that_are_too_alike(tilt, refused):
    rng = np.random.default_rng(1)
    R = turned([[0, 0, 0], [tilt, 0, 0], [0, tilt, 0], [-tilt, -tilt, 0]])
    if not refused:
        assert tool_tip(touches(R, rng)).tip == pytest.approx(TIP, abs=1e-6)
        return
    with pytest.raises(Fault) as caught:
        tool_tip(touches(R, rng))
    assert caught.value.code == "RBL314"


@pytest.mark.parametrize("count", [0, 1, 2])
def test_too_few_touches(count):
    rng = np.random.default_rng(1)
    with pytest.raises(Fault) as caught:
        tool_tip(touches(tilted(max(count, 1), rng), rng)[:count])
    assert caught.value.code == "RBL314"


@pytest.mark.parametrize("bad", range(5))
def test_the_touch_that_does_not_fit_is_named(bad):
    rng = np.random.default_rng(11)
    given = touches(tilted(5, rng), rng, error_mm=0.2)
    X = np.array(given[bad].X)
    X[:3, 3] += np.array([8.0, -6.0, 0.0]) * 1e-3
    given[bad] = Touch(name=given[bad].name, X=X)
    with pytest.raises(Fault) as caught:
        tool_tip(given)
    assert caught.value.code == "RBL315"
    assert f"T{bad + 1} " in caught.value.message
    # without it the rest agrees
    assert tool_tip([each for each in given if each is not given[bad]]).tip == pytest.approx(TIP, abs=1.5)


def test_an_outlier_that_pulls_the_tip_towards_itself_is_named():
    rng = np.random.default_rng(2)
    # one touch is tilted far more than the others, so the tip follows it: T4 is left farther away
    R = turned([[18, 0, 19], [-17, 4, -5], [12, -13, 15], [2, 16, -1], [-18, 66, 60]])
    given = touches(R, rng)
    X = np.array(given[4].X)
    X[:3, 3] += np.array([2.0, -5.0, 9.0]) * 1e-3
    given[4] = Touch(name="T5", X=X)
    with pytest.raises(Fault) as caught:
        tool_tip(given, most_apart=1.0)
    assert caught.value.code == "RBL315"
    assert "T5 " in caught.value.message


def test_of_three_touches_that_do_not_meet_one_is_named():
    rng = np.random.default_rng(11)
    with pytest.raises(Fault) as caught:
        tool_tip(touches(tilted(3, rng), rng, error_mm=15.0))
    assert caught.value.code == "RBL315"


@pytest.mark.parametrize("value", [np.nan, np.inf, 500.0])
def test_a_touch_that_is_nowhere(value):
    rng = np.random.default_rng(1)
    given = touches(tilted(4, rng), rng)
    given[2].X[0, 3] = value
    with pytest.raises(Fault) as caught:
        tool_tip(given)
    assert caught.value.code == "RBL309"
    assert "T3 " in caught.value.message
