"""``make bench``: how soon the prompt is there and answers, and how long completion takes over many points."""

import os
import pty
import select
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from robolang.analysis.analysis import Analysis
from robolang.analysis.cell_symbols import CellSymbols
from robolang.core.source import Source
from robolang.pendant.assembly import COMMANDS
from robolang.pendant.known import Known
from robolang.pendant.offers import offered
from robolang.project.points import Point
from robolang.syntax.parser import parse
from tests.bench import figures
from tests.bench.check import text
from tests.bench.figures import Row

COMMAND = Path(sys.executable).with_name("robolang")
PROGRAM = Path(__file__).parents[2] / "programs" / "pick_and_place.rbl"
HEAVY = "import numpy, mujoco, pinocchio"
TYPED = (
    "MOVE P17, SPEED 100, ZONE 5",
    "x = P120.Z + ABS(total)",
    "touchup P44",
    "GOTO *LABEL",
    "IF IN(3) = 1 THEN MOVEJ P499",
    "PRINT DIST(P1, P2)",
)


def known(points: int) -> Known:
    """Return what is known of a program of 300 lines with so many taught points."""
    taught = {
        f"P{number}": Point(name=f"P{number}", pose=(450.0, -150.0, 200.0, 180.0, 0.0, 90.0), comment="above the table")
        for number in range(1, points + 1)
    }
    cell = CellSymbols(points=frozenset(taught), tools=frozenset({"GRIP"}), frames=frozenset({"TABLE"}))
    return Known(analysis=Analysis(source=Source("job.rbl", text(304)), cell=cell), points=taught, inputs={3: 0.0})


def completions(points: int, rounds: int) -> tuple[float, float, float]:
    """Return the 95th percentile of a completion at each key, ms; that of the first after a change; the time of reading
    the lines typed, ms."""
    firsts, times, reading = [], [], []
    for _ in range(rounds):
        facts = known(points)
        began = time.perf_counter()
        list(offered("MOVE P", facts, COMMANDS))
        firsts.append(time.perf_counter() - began)
        for line in TYPED:
            for end in range(1, len(line) + 1):
                began = time.perf_counter()
                list(offered(line[:end], facts, COMMANDS))
                times.append(time.perf_counter() - began)
            began = time.perf_counter()
            parse(Source("prompt", line))
            reading.append(time.perf_counter() - began)
    p95 = sorted(times)[int(0.95 * len(times))]
    return 1e3 * p95, 1e3 * statistics.median(firsts), 1e3 * statistics.median(reading)


def until(master: int, wanted: bytes) -> float:
    """Read a terminal until it has sent something; return when that was, s. Where the cursor is is answered."""
    sent = b""
    while wanted not in sent:
        ready, _, _ = select.select([master], [], [], 60.0)
        assert ready, sent
        new = os.read(master, 65536)
        sent += new
        if b"\x1b[6n" in new:
            os.write(master, b"\x1b[1;1R")
    return time.perf_counter()


def prompt() -> tuple[float, float]:
    """Return the times from the start of a process to the prompt and to the first answer of the controller, s."""
    master, slave = pty.openpty()
    with tempfile.TemporaryDirectory() as state:
        # as a user has it, whose modules are compiled once and kept
        kept = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
        env = dict(kept, TERM="xterm", XDG_STATE_HOME=state)
        began = time.perf_counter()
        process = subprocess.Popen([COMMAND, "repl", PROGRAM], stdin=slave, stdout=slave, stderr=slave, env=env)
        shown = until(master, b"starting") - began
        os.write(master, b"HERE\r")
        answered = until(master, b"(480.000") - began
        process.kill()
        process.wait()
    os.close(master)
    os.close(slave)
    return shown, answered


def imports() -> float:
    """Return the time of a process that imports numerics and physics alone, s."""
    began = time.perf_counter()
    subprocess.run([sys.executable, "-c", HEAVY], check=True)
    return time.perf_counter() - began


def rows(smallest: bool) -> Iterator[Row]:
    """Measure completion and the start of the prompt."""
    p95, first, reading = completions(20 if smallest else 500, 1 if smallest else 20)
    yield Row(
        figure="completion at the prompt over 500 taught points, at each key",
        form="{:.1f} ms at the 95th percentile, {:.0f} times reading a line; {:.0f} ms at the first key after a change",
        values=(p95, p95 / reading, first),
    )
    if not smallest:
        prompt()  # compiles what has been edited since
    # in turn, so that both find the machine alike
    found = [(*prompt(), imports()) for _ in range(1 if smallest else 10)]
    shown, answered, alone = (min(times) for times in zip(*found, strict=True))
    yield Row(
        figure="`robolang repl` on a terminal, from its start to the prompt and to the first answer of the controller, "
        "against importing numpy, mujoco and pinocchio alone",
        form="{:.2f} and {:.2f} times",
        values=(shown / alone, answered / alone),
        details=(f"prompt {shown:.2f} s, answer {answered:.2f} s, imports {alone:.2f} s: the least of {len(found)}",),
    )


if __name__ == "__main__":
    figures.run(rows)
