"""Settings of all tests: no deadlines, and in CI the same examples every time, so that a red run can be repeated.

At the end of a run its processor time is printed by folder (``tests/processor_time.py``).
"""

import gc
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


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """Nothing of what is collected is garbage until the end, so that looking for it again and again finds nothing.

    Garbage of the tests is looked for after a hundred times more objects than usual: a fifth of the time of those that
    read all sources went into it.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.set_threshold(100_000, 20, 20)
        gc.enable()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """What a file sets up is set up once: its tests run in one process, and so do those of some files together.

    Files begin in the order of their folders: the last ones, of ``runtime``, are short, so that
    both processes end at about the same time.
    """
    from xdist.scheduler import LoadFileScheduling

    class Shared(LoadFileScheduling):
        def _split_scope(self, nodeid):
            return next((shared for shared in SHARED if shared in nodeid), super()._split_scope(nodeid))

    config.option.loadscopereorder = False
    return Shared(config, log)


def unmarked(*_, **__):
    raise AssertionError("a test that runs MuJoCo needs the marker physics")


def pytest_configure(config):
    if config.option.markexpr == "not physics":
        CellModel.of = unmarked
    config.pluginmanager.register(Meter(config))
