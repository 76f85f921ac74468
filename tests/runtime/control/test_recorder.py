"""What is recorded is the same wherever it lies: in memory, in a file without a name, or handed over and dropped."""

import errno
import os
from functools import cache, partial

import numpy as np
import pytest

from runtime.control.blocks import BLOCK_CYCLES
from runtime.control.recorder import Recorded, Recorder
from runtime.control.signals import Signals
from runtime.control.spill import Spill
from runtime.robot.kinematics.chain import Chain

NAN = float("nan")
NUMBERS = np.array([0.0, -0.0, 0.5, 1e-320, -1.25, NAN, 1 / 3])
COLUMNS = ("tau_cmd", "tau_sat", "q_fb", "dq_fb", "q_link", "q_cmd", "dq_cmd")
OF_CYCLES = ("q_plan", "D", "T", "read_us", "seam_deviation", "payload_mass", "line", "number", "wrist_mode", "tool")
LONG = 5 * BLOCK_CYCLES + 3
CHAIN = Chain(placements=(np.eye(4),) * 6, X_last_flange=np.eye(4))


class Full(Spill):
    """A full disk: nothing more can be written from some piece on."""

    def __init__(self, pieces: int) -> None:
        super().__init__()
        self.left = pieces

    def put(self, data: bytes) -> int:
        self.left -= 1
        if self.left < 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return super().put(data)


class Counted(Spill):
    """Counts the places that it has used."""

    def __init__(self) -> None:
        super().__init__()
        self.places: set[int] = set()

    def put(self, data: bytes) -> int:
        at = super().put(data)
        self.places.add(at)
        return at


def begun(spill: Spill | None = None) -> Recorder:
    made = Recorder(6, 8, 1000, parts=1)
    made.spill = spill or made.spill
    made.begin(np.full(6, 0.25), np.eye(4))
    return made


@cache
def rows(phase: int, salt: float):
    """Return the numbers of a cycle, and of them what is recorded of it and of its ticks."""
    row = np.roll(NUMBERS, phase) + salt
    ticks = [tuple(np.resize(np.roll(row, k + tick), 6) for k in range(5)) for tick in range(8)]
    return row, ticks[0], np.resize(row, (3, 8, 6)), ticks


def go(made: Recorder, cycles: int, salt: float = 0.0) -> Recorder:
    """Record cycles whose numbers depend on the time and the salt."""
    for _ in range(cycles):
        row, vectors, block, ticks = rows(made.cycle % len(NUMBERS), salt)
        tool = np.eye(4)
        tool[0, 3] = made.cycle // 200
        made.use_tool(tool)
        scalars = (float(row[0]), made.cycle % 50, made.cycle % 7, made.cycle % 3)
        made.begin_cycle(vectors, block, scalars, partial(np.resize, row, 9))
        for tick in ticks:
            made.record(tick)
    return made


def everything(rows: Recorded) -> dict[str, bytes]:
    counts = dict.fromkeys(COLUMNS, rows.ticks) | dict.fromkeys(OF_CYCLES, rows.cycles)
    counts |= dict.fromkeys(("parts", "fingers"), rows.frames)
    return {name: rows.read(name, 0, count).tobytes() for name, count in counts.items()}


@pytest.fixture(scope="module")
def held() -> dict[str, bytes]:
    """The rows of a run that stayed in memory."""
    return everything(go(begun(Full(0)), LONG).recorded())


def test_rows_in_a_file_are_those_in_memory(held):
    spill = Counted()
    made = go(begun(spill), LONG)
    assert len(spill.places) == 4  # the block that is written to and the one before stay in memory
    assert everything(made.recorded()) == held
    assert made.failed is None


def test_the_rows_up_to_a_time_stay_while_the_run_goes_on():
    spilt, kept = go(begun(), 2 * BLOCK_CYCLES + 5), go(begun(Full(0)), 2 * BLOCK_CYCLES + 5)
    rows, expected = spilt.recorded(), everything(kept.recorded())
    go(spilt, 3 * BLOCK_CYCLES)
    assert everything(rows) == expected


@pytest.mark.parametrize("pieces", [0, 1, 2])
def test_a_full_disk_loses_nothing(held, pieces):
    made = begun(Full(pieces))
    for _ in range(LONG):
        go(made, 1)
        if made.failed is not None:
            assert made.failed.errno == errno.ENOSPC
            assert made.cycle == (3 + pieces - 1) * BLOCK_CYCLES + 1
            break
    go(made, LONG - made.cycle)
    assert everything(made.recorded()) == held


def test_a_folder_that_is_gone_is_noticed_and_loses_nothing(held, tmp_path):
    made = go(begun(Spill(tmp_path / "gone")), LONG)
    assert isinstance(made.failed, FileNotFoundError)
    assert everything(made.recorded()) == held


def test_nothing_is_left_of_the_file(tmp_path):
    made = go(begun(Spill(tmp_path)), LONG)
    assert everything(made.recorded())
    assert os.listdir(tmp_path) == []


def test_a_file_that_was_cut_is_an_error_and_no_numbers(monkeypatch):
    made = go(begun(), LONG)
    pread = os.pread
    monkeypatch.setattr(os, "pread", lambda handle, size, at: pread(handle, size // 2, at) if at < 1000 else b"")
    with pytest.raises(OSError, match="shorter"):
        made.recorded().read("q_fb", 0, 8 * LONG)


def test_going_back_uses_the_places_of_what_is_no_longer_there():
    spill = Counted()
    made = go(begun(spill), 10)
    mark = made.snapshot()
    expected = everything(go(go(begun(Full(0)), 10), LONG, salt=3.0).recorded())
    for salt in (1.0, 2.0, 3.0):
        made.restore(mark)
        go(made, LONG, salt)
    assert everything(made.recorded()) == expected
    assert len(spill.places) <= 8  # not 3 x 4: those of the futures that were given up are used again
    first = everything(go(begun(Full(0)), 10).recorded())
    made.restore(mark)
    assert everything(made.recorded()) == first


def test_going_back_into_a_block_that_is_in_the_file():
    made = go(begun(), BLOCK_CYCLES + 7)
    mark = made.snapshot()
    go(made, 4 * BLOCK_CYCLES)
    made.restore(mark)
    expected = go(go(begun(Full(0)), BLOCK_CYCLES + 7), 2 * BLOCK_CYCLES, salt=1.0)
    assert everything(go(made, 2 * BLOCK_CYCLES, salt=1.0).recorded()) == everything(expected.recorded())


@pytest.mark.parametrize("ticks", [1, 8, 1500, 8 * LONG, 10**6])
def test_the_last_rows_reach_into_the_file(ticks):
    spilt, kept = go(begun(), LONG), go(begun(Full(0)), LONG)
    assert spilt.recent(ticks).shape == (min(ticks, 8 * LONG), 24)
    assert spilt.recent(ticks).tobytes() == kept.recent(ticks).tobytes()


def test_what_is_handed_over_is_each_tick_once_with_all_that_follows():
    whole = Signals(go(begun(Full(0)), LONG).recorded(), CHAIN)
    seen: list[tuple[int, int]] = []

    def take(rows: Recorded, first: int, last: int) -> None:
        seen.append((first, last))
        part = Signals(rows, CHAIN)
        for name in ("q_link", "tool_speed", "X_world_tool", "D_age", "line", "tau_sat"):
            assert part.span(name, first, last).tobytes() == whole.span(name, first, last).tobytes(), name

    made = begun(Full(0))
    made.fold = take
    go(made, LONG)
    block = 8 * BLOCK_CYCLES
    assert seen == [(k * block, (k + 1) * block) for k in range(4)]
    rest = made.recorded()
    assert rest.blocks[0].tick == 3 * block  # one more than was not handed over
    assert rest.read("q_link", 4 * block, 8 * LONG).tobytes() == whole.span("q_link", 4 * block, 8 * LONG).tobytes()
    with pytest.raises(RuntimeError):
        made.snapshot()
