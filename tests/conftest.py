"""Settings of all tests: no deadlines, and in CI the same examples every time, so that a red run can be repeated.

At the end of a run its processor time is printed by folder (``tests/processor_time.py``).
"""

import os

import pytest
from hypothesis import HealthCheck, settings

from tests.processor_time import Meter

# A machine that is slow or busy makes no test fail: no deadline, and no check of how long it takes to make examples.
settings.register_profile("local", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("ci", settings.get_profile("local"), derandomize=True)
settings.load_profile("ci" if os.environ.get("CI") else "local")


SHARED = ("sim/test_identif", "programs/test_")
"""Beginnings of the names of files that share what they set up."""


def pytest_addoption(parser):
    parser.addoption(
        "--processor-files",
        type=int,
        default=0,
        metavar="N",
        help="print the processor time of the N test files that cost most, too",
    )


def pytest_collection_modifyitems(items):
    """What a file sets up is set up once: its tests run in one process, and so do some files (``--dist loadgroup``)."""
    for item in items:
        group = next((shared for shared in SHARED if shared in item.nodeid), item.path.name)
        item.add_marker(pytest.mark.xdist_group(group))


def pytest_configure(config):
    config.pluginmanager.register(Meter(config))
