"""How much memory a long run takes, in a process of its own; and how much a log takes on the disk."""

import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from tests.campaign import WHOLE, size
from tests.programs.runs import ROOT
from tests.robolang.cli.commands import robolang

LOOP = "10 LOAD (0, 0, 60), 0.8\n20 HAND OFF\nFOR I = 1 TO {}\nMOVE P2\nMOVE P4\nMOVE P5\nNEXT I\n"
ROUND_S = 2.672
"""Simulated time of a round."""
MOST_MB = 400.0
CODE = """
import gc
import sys
from robolang.cli.main import app
programs, words = sys.argv[1].split(","), sys.argv[2:]
for program in programs:
    gc.collect()
    if app(["run", program, "--quiet", *words], standalone_mode=False):
        sys.exit("the run failed")
    print(open("/proc/self/status").read())
"""


def peaks_mb(folder: Path, rounds: tuple[int, ...], *words: str) -> list[float]:
    """Return the largest memory, MB, of one process after each of its runs of so many rounds."""
    for count in rounds:
        (folder / f"p{count}.rbl").write_text(LOOP.format(count))
    command = [sys.executable, "-c", CODE, ",".join(f"p{count}.rbl" for count in rounds), *words]
    shown = subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stdout
    peaks = re.findall(r"^VmHWM:\s+(\d+) kB$", shown, re.MULTILINE)  # of this process alone, unlike getrusage
    assert len(peaks) == len(rounds)
    return [int(peak) / 1000.0 for peak in peaks]


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
@pytest.mark.parametrize("words", [(), ("--log", "l.npz")], ids=["report", "log"])
def test_memory_does_not_grow_with_time(tmp_path, words):
    short, long = peaks_mb(tmp_path, (5, size(25, 15)), "--no-physics", *words)
    # 27 s more of the log are 10 MB
    assert long - short < 5.0, (short, long)


@pytest.mark.physics
@pytest.mark.skipif(not WHOLE, reason="half an hour of simulated time; the test above is its sample")
@pytest.mark.parametrize("words", [(), ("--log", "l.npz"), ("--log", "l.mcap")], ids=["report", "npz", "mcap"])
def test_half_an_hour_stays_within_the_memory(tmp_path, words):
    # a run ends after 1800 s (RBL509)
    rounds = round(1790.0 / ROUND_S)
    assert peaks_mb(tmp_path, (rounds,), *words)[0] < MOST_MB


@pytest.mark.physics
def test_the_log_of_the_demo_is_small(tmp_path):
    path = tmp_path / "l.npz"
    robolang("run", ROOT / "pick_and_place.rbl", "--quiet", "--log", path)
    assert path.stat().st_size <= 2_400_000
    with zipfile.ZipFile(path) as file:
        sizes = {entry.filename: entry.compress_size for entry in file.infolist()}
    added = sum(taken for name, taken in sizes.items() if name == "meta.npy" or name.startswith("frame/"))
    assert added <= 0.02 * (path.stat().st_size - added)
