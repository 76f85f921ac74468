"""Settings of all tests: no deadlines, and in CI the same examples every time, so that a red run can be repeated.

At the end of a run its processor time is printed by folder (``tests/processor_time.py``).
"""

import os

import pytest
from hypothesis import HealthCheck, settings

from runtime.plant.cell_model import CellModel
from tests.processor_time import Meter

# A machine that is slow or busy makes no test fail: no deadline, and no check of how long it takes to make examples.
settings.register_profile("local", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("ci", settings.get_profile("local"), derandomize=True)
settings.load_profile("ci" if os.environ.get("CI") else "local")


SHARED = ("arch/test_", "experiments/test_identif", "programs/test_")
"""Beginnings of the names of files that share what they set up."""


def pytest_addoption(parser):
    parser.addoption(
        "--processor-files",
        type=int,
        default=0,
        metavar="N",
        help="print the processor time of the N test files that cost most, too",
    )


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """What a file sets up is set up once: its tests run in one process, and so do those of some files together."""
    from xdist.scheduler import LoadFileScheduling

    class Shared(LoadFileScheduling):
        def _split_scope(self, nodeid):
            return next((shared for shared in SHARED if shared in nodeid), super()._split_scope(nodeid))

    return Shared(config, log)


def unmarked(*_, **__):
    raise AssertionError("a test that runs MuJoCo needs the marker physics")


def pytest_configure(config):
    if config.option.markexpr == "not physics":
        CellModel.of = unmarked
    config.pluginmanager.register(Meter(config))
