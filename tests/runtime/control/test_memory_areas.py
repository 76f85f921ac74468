"""What the areas count: versions of what is declared, and the times between refreshes."""

import numpy as np

from runtime.control.memory_areas import Areas, AxisLoad
from runtime.robot.model.payload import NO_PAYLOAD, Payload


def test_every_load_is_a_version():
    areas = Areas(2, np.zeros(2))
    assert (areas.sda, areas.sda_version) == (NO_PAYLOAD, 0)
    for version in (1, 2, 3):
        payload = Payload(mass=float(version), cog=np.zeros(3))
        areas.declare(payload)
        assert areas.sda is payload
        assert areas.sda_version == version


def test_refreshes_are_counted_and_timed_by_axis():
    areas = Areas(2, np.array([0.1, 0.2]))
    assert areas.ita == [AxisLoad(D=0.0, T=0.0, read_us=0, version=0, payload_version=0)] * 2
    assert (areas.mean_refresh_us, areas.longest_refresh_us) == (0.0, 0)
    for axis, now_us in ((0, 100), (1, 150), (0, 1100), (0, 1600), (1, 3150)):
        load = AxisLoad(D=1.0, T=2.0, read_us=now_us - 10, version=1, payload_version=0)
        areas.publish(axis, load, now_us)
        assert areas.ita[axis] is load
    assert areas.refreshes == [3, 2]
    assert areas.longest_refresh_us == 3000
    assert areas.mean_refresh_us == (1500 + 3000) / (2 + 1)


def test_the_areas_of_set_points_and_angles_are_their_own():
    q = np.array([0.1, 0.2])
    areas = Areas(2, q)
    q[0] = 9.0
    assert areas.ina.tolist() == areas.ang.tolist() == [0.1, 0.2]
    areas.ang[0] = 5.0
    assert areas.ina.tolist() == [0.1, 0.2]
