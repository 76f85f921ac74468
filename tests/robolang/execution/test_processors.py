"""The log of a run is the same bytes whichever kernel OpenBLAS picks for the processor."""

import os
import subprocess
import sys

import pytest

from tests.campaign import some

PROGRAMS = some(("programs/wrist/e3.rbl", "programs/manutec_pick_and_place.rbl"), 0)
KERNELS = some(("Nehalem", "Haswell", "SkylakeX"), 0, 1)
SCRIPT = """
import hashlib, sys
import numpy as np
import robolang
from runtime.motion.spline import Spline

rows = np.random.default_rng(1).standard_normal((2, 1000))
print(hashlib.sha256(np.dot(*rows).tobytes()).hexdigest())
cubics = Spline.through(np.arange(200.0) ** 1.1, rows[:, :700].reshape(200, 7)).cubics
print(hashlib.sha256(cubics.tobytes()).hexdigest())
for program in sys.argv[1:]:
    result = robolang.run(program)
    assert result.ok
    signals = hashlib.sha256()
    for name in sorted(result.log):
        signals.update(name.encode() + np.ascontiguousarray(result.log[name]).tobytes())
    print(signals.hexdigest())
"""


@pytest.fixture(scope="module")
def hashes():
    """By kernel: the hash of a plain scalar product of numpy, of a spline, and of the log of every program."""
    started = {
        kernel: subprocess.Popen(
            [sys.executable, "-c", SCRIPT, *PROGRAMS],
            stdout=subprocess.PIPE,
            text=True,
            env=os.environ | {"OPENBLAS_CORETYPE": kernel},
        )
        for kernel in KERNELS
    }
    return {kernel: process.communicate()[0].split() for kernel, process in started.items()}


def test_logs_do_not_depend_on_the_kernel(hashes):
    plain = {found[0] for found in hashes.values()}
    if len(plain) == 1:
        pytest.skip("this OpenBLAS has one kernel for all processors")
    assert all(len(found) == 2 + len(PROGRAMS) for found in hashes.values())
    for index, program in enumerate(("a spline", *PROGRAMS), start=1):
        assert len({found[index] for found in hashes.values()}) == 1, program
