"""attack_04, attack_06: a golden log that nothing differs from, and one that is no file."""

import os
import shutil
from pathlib import Path

import numpy as np
import pytest

from tests.robolang.cli.commands import places, robolang

CASES = Path(__file__).parent


def copied(case, tmp_path):
    shutil.copytree(CASES / case, tmp_path / "case")
    return tmp_path / "case"


def test_a_golden_log_of_nan_fails(tmp_path):
    folder = copied("attack_04_golden_nan_passes", tmp_path)
    result = robolang("test", folder / "g.rbl", code=2)
    assert result.stdout.startswith("FAIL")
    assert places(result.stderr) == [(4, 1, "RBL711")]


@pytest.mark.filterwarnings("error")
def test_a_golden_log_of_complex_numbers_fails(tmp_path):
    folder = copied("attack_04_golden_nan_passes", tmp_path)
    robolang("test", folder / "g.rbl", "--update")
    with np.load(folder / "g.golden.npz") as stored:
        q, line = stored["q"], stored["line"]
    np.savez(folder / "g.golden.npz", q=q + 1j, line=line)
    assert places(robolang("test", folder / "g.rbl", code=2).stderr) == [(4, 1, "RBL711")]


def test_a_golden_log_that_is_a_pipe_is_refused_at_once(tmp_path):
    folder = copied("attack_06_golden_fifo_hangs", tmp_path)
    os.mkfifo(folder / "g.golden.npz")
    assert places(robolang("test", folder / "g.rbl", code=2).stderr) == [(4, 1, "RBL600")]
