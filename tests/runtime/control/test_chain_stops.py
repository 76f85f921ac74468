"""A sample of ``make stop-campaign``, and that its checks find what is wrong."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from tests.bench.stop_campaign import campaign, judge, random_stop, stopped
from tests.campaign import size
from tests.runtime.motion.chains import random_chain
from tests.runtime.motion.motions import bench

ROBOTS = ("puma560", "irb2400", "manutec_r3")


@pytest.mark.parametrize("name", ROBOTS)
def test_stops_of_random_chains_rest_on_their_curve_within_the_limits(name):
    found = campaign(name, size(30, 2))
    assert sum((each.broken for each in found), Counter()).total() == 0, found


def test_what_is_wrong_with_a_stop_is_found():
    robot, random = bench("irb2400"), np.random.default_rng(3)
    run, found = random_stop(robot, random)
    assert not judge(robot, run, found).broken.total()
    middle = (found.before + len(found.setpoints)) // 2
    aside, jerky = found.setpoints.copy(), found.setpoints.copy()
    aside[middle - 1 : middle + 2, 0] += 1e-5
    jerky[found.before + 2] += 0.02
    late = np.concatenate([found.setpoints, found.setpoints[-1] + np.linspace(1e-9, 1e-6, 300)[:, None]])
    for kind, rows in (("curve", aside), ("limits", jerky), ("rest", late)):
        assert judge(robot, run, replace(found, setpoints=rows)).broken[kind], kind


def test_a_motion_that_is_not_stopped_is_as_long_as_the_plan():
    robot, random = bench("irb2400"), np.random.default_rng(3)
    run = random_chain(robot, random, 1)
    assert len(stopped(robot, run, 3, pause=False).setpoints) < run.alone[0]
