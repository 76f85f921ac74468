"""The table of ``robolang check --motion``: 80 columns, whatever stands in the program."""

import re

import pytest

from tests.messages import numbers
from tests.robolang.cli.commands import BUILTIN, robolang

pytestmark = pytest.mark.physics


def table(text):
    """The rows of the table: those that begin with a line of the file."""
    return [line for line in text.splitlines() if re.match(r" +\d", line)]


@pytest.mark.parametrize("number", ["", "99990 "])
def test_only_statements_are_cut_and_every_line_fits_80_columns(tmp_path, number):
    far = "HERE + (" + "0 + " * 20 + "0, 0, 20)"
    (tmp_path / "p.rbl").write_text(f"SPEED 200\n{number}MOVE {far}\nDELAY 1000\n")
    (tmp_path / "p.cell.toml").write_text((BUILTIN / "cell.toml").read_text())
    lines = robolang("check", "--motion", tmp_path / "p.rbl").stdout.splitlines()
    shown = [line for line in lines if "p.rbl" not in line]
    assert max(map(len, shown)) <= 80
    move, delay = table("\n".join(shown))
    assert move.count("…") == 1
    assert numbers(move.partition("…")[2])[:3] == [1, pytest.approx(0.4, abs=0.3), 20.0]
    assert "1000.000" in delay
    assert numbers(move)[0] == 2
    assert (99990 in numbers(move)) is bool(number)
