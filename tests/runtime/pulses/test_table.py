"""Rows and data tables of a channel, and the form of F174."""

import numpy as np
import pytest

from runtime.core.faults import Fault
from runtime.pulses import panasonic_f174
from runtime.pulses.table import Row, as_csv, data_tables, rows_of

STEPS = np.array([0, 0, 4, 5, 0, -6, -7, 8], dtype=np.int64)


def test_rows_wait_turn_round_and_end_together():
    rows = rows_of(STEPS, 100, 10, 50)
    assert rows == (
        Row("wait", 0, 100, 2),
        Row("up", 200, 104, 1),
        Row("up", 250, 109, 1),
        Row("wait", 0, 109, 1),
        Row("down", 300, 103, 1),
        Row("down", 350, 96, 1),
        Row("up", 400, 104, 1),
        Row("wait", 0, 104, 2),
        Row("end", 0, 104, 0),
    )
    assert sum(row.steps for row in rows) == 10


def test_c5_rows_last_one_step_each():
    rows = rows_of(STEPS, 100, 8, 50)
    position, seconds = 100, 0.0
    for row in rows:
        seconds += abs(row.target - position) / row.frequency if row.frequency else row.steps / 50.0
        position = row.target
    assert seconds == pytest.approx(8 / 50.0, abs=1e-12)


def test_a_data_table_has_one_direction_and_no_wait():
    tables = list(data_tables(rows_of(STEPS, 100, 8, 50), 100))
    assert [(table.first, table.start, table.up, len(table.rows)) for table in tables] == [
        (2, 100, True, 2),
        (5, 109, False, 2),
        (7, 96, True, 1),
    ]


def test_csv_says_what_the_columns_are():
    text = as_csv(rows_of(STEPS[2:4], 0, 2, 50), ["units"])
    assert text == "# units\ncontrol,frequency_hz,target_pulses,steps\nup,200,4,1\nup,250,9,1\nend,0,9,0\n"


def test_f174_words_stand_in_their_order():
    tables = list(data_tables(rows_of(STEPS, 100, 8, 100), 100))
    lines = panasonic_f174.as_csv(tables, "pulse-direction", ["x"]).splitlines()
    assert lines[:2] == ["# x", "table,start_step,word,value,meaning"]
    assert lines[2:8] == [
        "1,2,0,16#0212,control code",
        "1,2,2,400,frequency 1 Hz",
        "1,2,4,104,target 1 pulses",
        "1,2,6,500,frequency 2 Hz",
        "1,2,8,109,target 2 pulses",
        "1,2,10,0,end",
    ]
    assert lines[8].startswith("2,5,0,16#0213,")


@pytest.mark.parametrize(
    ("frequencies", "output", "code"),
    [
        ((191, 100_000), "pulse-direction", "16#1212"),
        ((190, 49_999), "cw-ccw", "16#0110"),
        ((10, 9_800), "pulse-direction-inverted", "16#0014"),
        ((50_000,), "cw-ccw", "16#1210"),
    ],
)
def test_the_control_code_has_duty_range_position_and_output(frequencies, output, code):
    rows = tuple(Row("up", f, k + 1, 1) for k, f in enumerate(frequencies))
    (table,) = data_tables(rows, 0)
    assert panasonic_f174.control_code(table, output) == code


def test_what_f174_cannot_hold_is_refused():
    for rows in ((Row("up", 40, 1, 1), Row("up", 20_000, 2, 1)), (Row("up", 200_000, 1, 1),)):
        with pytest.raises(Fault, match="range") as caught:
            panasonic_f174.as_csv(list(data_tables(rows, 0)), "cw-ccw", [])
        assert caught.value.code == "RBL433"
    with pytest.raises(Fault, match="word"):
        panasonic_f174.as_csv(list(data_tables((Row("up", 200, 2**31, 1),), 0)), "cw-ccw", [])
