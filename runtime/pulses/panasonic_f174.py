"""Tables in the form of a Panasonic FP-Sigma or FP-X: instruction F174, pulse output by data table.

Double words: control code, then frequency and target of each row, then 0. Digits of the control code, from the left
(infohub.industry.panasonic.eu, FPWIN Pro, topic t-0000014785):

    3  duty       0 half, 1 a quarter; a quarter from 50 kHz on
    2  range      0: 1.5 Hz to 9.8 kHz, 1: 48 Hz to 100 kHz, 2: 191 Hz to 100 kHz
    1  position   0 relative, 1 absolute
    0  output     counting up 0 CW, 2 and 4 pulse and direction (forward off, forward on); counting down 1, 3, 5

A later frequency out of range stops the output and a target against the direction counts without end, so neither is
written: each table counts in one direction, and a frequency out of range is ``Fault`` RBL433. An FP0R takes the two
digits on the right only, and has no range to choose. Called by the export.
"""

from collections.abc import Sequence

import runtime.pulses.codes  # noqa: F401 - registers what is raised here
from runtime.core.faults import Fault
from runtime.pulses.channels import Output
from runtime.pulses.table import DataTable

RANGES = ((2, 191, 100_000), (1, 48, 100_000), (0, 2, 9_800))
"""Digit, lowest and highest frequency, whole Hz (1.5 rounded up); the first that holds a table is written."""
QUARTER_DUTY_HZ = 50_000
LARGEST = 2**31 - 1
HEADER = "table,start_step,word,value,meaning"
_UP: dict[str, int] = {"cw-ccw": 0, "pulse-direction": 2, "pulse-direction-inverted": 4}


def control_code(table: DataTable, output: Output) -> str:
    """Return the control code of a table, as FPWIN writes it: ``16#1212``; ``Fault`` RBL433."""
    frequencies = [row.frequency for row in table.rows]
    # one code for a whole table: all of its frequencies have to be in one range
    lowest, highest = min(frequencies), max(frequencies)
    for code, low, high in RANGES:
        if low <= lowest and highest <= high:
            duty = 1 if highest >= QUARTER_DUTY_HZ else 0
            return f"16#{duty}{code}1{_UP[output] + (0 if table.up else 1)}"
    raise Fault(
        "RBL433", f"no frequency range of F174 holds {lowest} to {highest} Hz: 2 Hz to 9.8 kHz, 48 or 191 Hz to 100 kHz"
    )


def as_csv(tables: Sequence[DataTable], output: Output, comments: Sequence[str]) -> str:
    """Return the double words of the tables of a channel, each with its place in the table; ``Fault`` RBL433."""
    lines = [*(f"# {comment}" for comment in comments), HEADER]
    for number, table in enumerate(tables, start=1):
        words = [(control_code(table, output), "control code")]
        for index, row in enumerate(table.rows, start=1):
            if abs(row.target) > LARGEST:
                raise Fault("RBL433", f"target {row.target} does not fit a double word")
            words += [(str(row.frequency), f"frequency {index} Hz"), (str(row.target), f"target {index} pulses")]
        words.append(("0", "end"))
        lines += [f"{number},{table.first},{2 * k},{value},{meaning}" for k, (value, meaning) in enumerate(words)]
    return "\n".join(lines) + "\n"
