"""How much memory a long run takes, in a process of its own; and how much a log takes on the disk."""

import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from tests.campaign import WHOLE
from tests.programs.runs import ROOT

LOOP = "10 LOAD (0, 0, 60), 0.8\n20 HAND OFF\nFOR I = 1 TO {}\nMOVE P2\nMOVE P4\nMOVE P5\nNEXT I\n"
ROUND_S = 2.672
"""Simulated time of a round."""
MOST_MB = 400.0
CODE = """
import sys
from robolang.cli.main import app
try:
    app(sys.argv[1:])
finally:
    print(open("/proc/self/status").read())
"""


def peak_mb(folder: Path, rounds: int, *words: str) -> float:
    """Return the largest memory, MB, of a run of so many rounds."""
    (folder / "p.rbl").write_text(LOOP.format(rounds))
    command = [sys.executable, "-c", CODE, "run", "p.rbl", "--quiet", *words]
    shown = subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stdout
    (peak,) = re.findall(r"^VmHWM:\s+(\d+) kB$", shown, re.MULTILINE)  # of this process alone, unlike getrusage
    return int(peak) / 1000.0


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
@pytest.mark.parametrize("words", [(), ("--log", "l.npz")], ids=["report", "log"])
def test_memory_does_not_grow_with_time(tmp_path, words):
    short, long = (peak_mb(tmp_path, rounds, "--no-physics", *words) for rounds in (5, 25))
    # 53 s more of the log are 20 MB
    assert long - short < 5.0, (short, long)


@pytest.mark.physics
@pytest.mark.skipif(not WHOLE, reason="half an hour of simulated time; the test above is its sample")
@pytest.mark.parametrize("words", [(), ("--log", "l.npz"), ("--log", "l.mcap")], ids=["report", "npz", "mcap"])
def test_half_an_hour_stays_within_the_memory(tmp_path, words):
    # a run ends after 1800 s (RBL509)
    rounds = round(1790.0 / ROUND_S)
    assert peak_mb(tmp_path, rounds, *words) < MOST_MB


@pytest.mark.physics
def test_the_log_of_the_demo_is_small(tmp_path):
    path = tmp_path / "l.npz"
    program = ROOT / "pick_and_place.rbl"
    command = [sys.executable, "-m", "robolang", "run", str(program), "--quiet", "--log", str(path)]
    subprocess.run(command, check=True)
    assert path.stat().st_size <= 2_400_000
    with zipfile.ZipFile(path) as file:
        sizes = {entry.filename: entry.compress_size for entry in file.infolist()}
    added = sum(taken for name, taken in sizes.items() if name == "meta.npy" or name.startswith("frame/"))
    assert added <= 0.02 * (path.stat().st_size - added)
