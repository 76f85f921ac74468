"""Inputs and outputs of a cell, simulated: what an input does is written in the cell file.

::

    [inputs.1]
    changes = [[0, 0], [1.5, 1]]     # from 1.5 s after the program began on it is 1
    [inputs.2]
    follows = 3                      # output 3, half a second later
    delay_s = 0.5

An input that the file does not name does not exist. Outputs are numbered 1 to 1024 and are 0 until a program sets
them; one that PULSE set goes back to 0 by itself. Times are integers of microseconds on the controller's clock, so that
no sum of times rounds. Read by every WAIT and condition of a program, and by the dry run on its own clock.
"""

from bisect import bisect_right
from collections.abc import Collection, Iterable, Mapping
from typing import Any

from runtime.core.faults import Fault
from runtime.core.limits import DELAY, INPUT, OUTPUT
from runtime.core.record import Record
from runtime.core.tomlfile import Table

LONGEST_S = DELAY.high
"""The latest change of an input, s: no program can wait for a later one."""


_PAIRS = "write changes = [[seconds, state], ...], a state as a number: 1 for ON, 0 for OFF"


class InputSpec(Record):
    """An input: its ``changes`` (us, state) in order, or the output that it ``follows`` after ``delay_us``."""

    changes: tuple[tuple[int, float], ...] = ()
    follows: int | None = None
    delay_us: int = 0


def read_input(table: Table) -> InputSpec:
    """Read one ``[inputs.N]``; ``FileFault`` RBL605, RBL608 or RBL61x."""
    if "follows" in table:
        found = InputSpec(
            follows=table.integer("follows", low=1, high=int(OUTPUT.high)),
            delay_us=round(table.number("delay_s", 0.0, low=0.0, high=LONGEST_S) * 1e6),
        )
        table.done()
        return found
    # each pair as a table of its own, so that the usual getters check and name it
    changes: list[tuple[int, float]] = []
    for pair in table.raw_list("changes"):
        if not _is_pair(pair):
            table.fail("RBL613", f"'{table.name('changes')}' must be a list of pairs of numbers", _PAIRS, key="changes")
        row = Table(table.source, {"changes": pair}, table.keys)
        seconds, state = row.numbers("changes", 2)
        # compared in whole microseconds: two times that are one on the clock would leave the order of states open
        if not 0.0 <= seconds <= LONGEST_S or (changes and round(seconds * 1e6) <= changes[-1][0]):
            table.fail("RBL605", f"the times of '{table.name('changes')}' must rise from 0 on", key="changes")
        changes.append((round(seconds * 1e6), state))
    table.done()
    if not changes:
        table.fail(
            "RBL608",
            f"'{table.name()}' needs 'changes' or 'follows'",
            "write changes = [[seconds, state], ...] or follows = N, the number of an output",
        )
    return InputSpec(changes=tuple(changes))


def _is_pair(value: Any) -> bool:
    """Return whether a value is a list of two numbers, whatever their size."""
    numbers = isinstance(value, list) and all(isinstance(x, int | float) and not isinstance(x, bool) for x in value)
    return numbers and len(value) == 2


def read_inputs(tables: Mapping[str, Table]) -> dict[int, InputSpec]:
    """Read all inputs of a cell by number."""
    found: dict[int, InputSpec] = {}
    for name, table in tables.items():
        spec = table.gather(lambda table, name=name: _numbered(name, table))  # type: ignore[misc]
        if spec is not None:
            found[int(name)] = spec
    return found


def _numbered(name: str, table: Table) -> InputSpec:
    # only the first digits are read as a number, since a name may have thousands
    if not (name.isdecimal() and INPUT.fault(int(name[:9])) is None and str(int(name)) == name):
        table.fail("RBL605", f"an input is a number from {INPUT.low:g} to {INPUT.high:g}, not '{name[:20]}'")
    return read_input(table)


class SignalsSnapshot(Record):
    """Signals as they were: of each output that was set the times, us, from which it has its states; forced inputs."""

    outputs: Mapping[int, tuple[tuple[int, float], ...]]
    held: tuple[tuple[int, int, float | None], ...]


class Signals:
    """The signals of one run."""

    def __init__(self, inputs: Mapping[int, InputSpec]) -> None:
        self._inputs = inputs
        self._history: dict[int, list[tuple[int, float]]] = {}
        self._forced: dict[int, float] = {}
        self._held: list[tuple[int, int, float | None]] = []
        """Each time that an input was forced, us, its number, and the state, None: no longer."""

    def snapshot(self) -> SignalsSnapshot:
        """Return what the outputs have been so far and will be by themselves, and which inputs are forced."""
        outputs = {output: tuple(rows) for output, rows in self._history.items()}
        return SignalsSnapshot(outputs=outputs, held=tuple(self._held))

    def restore(self, snapshot: SignalsSnapshot) -> None:
        """Go back, or on, to a snapshot."""
        self._history = {output: list(rows) for output, rows in snapshot.outputs.items()}
        self._held = list(snapshot.held)
        self._forced = _forced(self._held)

    @property
    def forced(self) -> Mapping[int, float]:
        """The inputs that an operator holds in a state, whatever the cell file says."""
        return self._forced

    def force(self, number: int, state: float | None, now_us: int) -> None:
        """Hold an input in a state from now on; None: the cell file decides again. ``Fault`` RBL534."""
        if number not in self._inputs:
            raise unknown_input(number, self._inputs)
        self._held.append((now_us, number, state))
        # replaced and not changed: somebody may be reading it
        others = {key: value for key, value in self._forced.items() if key != number}
        self._forced = others if state is None else {**others, number: state}

    def set(self, output: int, value: float, now_us: int, off_us: int | None = None) -> None:
        """Set an output from ``now_us`` on, and back to 0 at ``off_us``."""
        rows = self._history.setdefault(output, [])
        while rows and rows[-1][0] >= now_us:  # the end of a pulse that is still to come: the new state replaces it
            rows.pop()
        rows.append((now_us, value))
        if off_us is not None:
            rows.append((off_us, 0.0))

    @property
    def outputs(self) -> tuple[int, ...]:
        """The outputs that the program has set so far, in order."""
        return tuple(sorted(self._history))

    def output(self, number: int, now_us: int) -> float:
        """Return the state of an output."""
        return _at(self._history.get(number, ()), now_us)

    def input(self, number: int, now_us: int) -> float:
        """Return the state of an input; ``Fault`` RBL534 for a number that the cell does not have."""
        spec = self._inputs.get(number)
        if spec is None:
            raise unknown_input(number, self._inputs)
        return self._forced[number] if number in self._forced else self._by_itself(spec, now_us)

    def is_settled(self, number: int, now_us: int) -> bool:
        """Return whether an input of the cell never changes by itself from now on."""
        spec = self._inputs[number]
        return spec.follows is None and spec.changes[-1][0] <= now_us

    def _by_itself(self, spec: InputSpec, now_us: int) -> float:
        if spec.follows is not None:
            # the whole history is kept: a delay may reach back further than the last change
            return _at(self._history.get(spec.follows, ()), now_us - spec.delay_us)
        return _at(spec.changes, now_us)

    def output_changes(self, until_us: int) -> dict[int, list[tuple[int, float]]]:
        """Return of each output that was set the times, us, and the states, from 0 to ``until_us``."""
        return {
            number: [(0, 0.0)] * (rows[0][0] > 0) + [row for row in rows if row[0] <= until_us]
            for number, rows in self._history.items()
        }

    def input_changes(self, until_us: int) -> dict[int, list[tuple[int, float]]]:
        """Return of each input of the cell the times, us, and the states, from 0 to ``until_us``."""
        found: dict[int, list[tuple[int, float]]] = {}
        for number, spec in self._inputs.items():
            delayed = [(us + spec.delay_us) for us, _ in self._history.get(spec.follows or 0, ())]
            held = [(us, state) for us, key, state in self._held if key == number]
            times = sorted({0, *delayed, *(us for us, _ in spec.changes), *(us for us, _ in held)})
            rows = found[number] = []
            for us in (each for each in times if each <= until_us):
                last = bisect_right(held, us, key=lambda row: row[0])
                forced = held[last - 1][1] if last else None
                state = self._by_itself(spec, us) if forced is None else forced
                if not rows or rows[-1][1] != state:
                    rows.append((us, state))
        return found


def _forced(held: Iterable[tuple[int, int, float | None]]) -> dict[int, float]:
    """Return the inputs that are held, by what was done to them so far."""
    last = {number: state for _, number, state in held}
    return {number: state for number, state in last.items() if state is not None}


def unknown_input(number: int, known: Collection[int], cell_file: str = "") -> Fault:
    """Return the fault of an input that a cell does not have; ``cell_file``: where it can be added, if known."""
    correct = f"give the number of an input of the cell ({', '.join(map(str, sorted(known)))}), or " if known else ""
    where = cell_file or "the cell file, NAME.cell.toml beside the program"
    return Fault(
        "RBL534",
        f"the cell has {f'no input {number}' if known else f'no inputs, so there is no input {number}'}",
        f"{correct}write into {where}: [inputs.{number}] changes = [[0, 0], [1, 1]], which is 0 from the start and "
        "1 from 1 s on",
    )


def _at(rows: tuple[tuple[int, float], ...] | list[tuple[int, float]], now_us: int) -> float:
    """Return the state of the last row that is not later than ``now_us``; 0 before the first."""
    state = 0.0
    for begins, value in rows:
        if begins > now_us:
            break
        state = value
    return state
