"""Colours of findings: where they are, what they leave as it is, and what decides on them."""

import os
import pty
import re
import subprocess
import sys

import pytest

from robolang.cli.colour import painted, take_option

PAINT = re.compile(r"\x1b\[\d+m")
SHOWN = """p.rbl:2:3: error RBL111 found 'X'
   2 | 10 MOVE ^^^ P1 | 2
     |    ^^^^
  help: write it out
  fix: error RBL999 in a text
/a b/c:d.rbl:10:1: warning RBL201 nothing
  p.rbl:3:1: note: here
error RBL703 --x: no
"""


def test_colours_change_no_word():
    assert PAINT.sub("", painted(SHOWN)) == SHOWN


def test_each_line_is_painted_by_what_it_is():
    lines = painted(SHOWN).splitlines()
    assert lines[0].startswith("\x1b[1mp.rbl:2:3: \x1b[0m\x1b[1m\x1b[31merror RBL111\x1b[0m ")
    # carets of the program itself are no mark
    assert lines[1].endswith(" 10 MOVE ^^^ P1 | 2")
    assert "\x1b[31m    ^^^^\x1b[0m" in lines[2]
    assert lines[4] == "  \x1b[32mfix:\x1b[0m error RBL999 in a text"
    assert "\x1b[33mwarning RBL201" in lines[5]
    assert "\x1b[36mnote:" in lines[6]
    assert "\x1b[31merror RBL703" in lines[7]


def shown(tmp_path, *words, terminal=False, **environment):
    """What ``robolang check`` prints to stdout of a program with an error."""
    (tmp_path / "p.rbl").write_text("MOVV P1\n")
    master, slave = pty.openpty()
    plain = {name: value for name, value in os.environ.items() if name not in ("NO_COLOR", "FORCE_COLOR", "TERM")}
    process = subprocess.Popen(
        [sys.executable, "-m", "robolang", "check", "p.rbl", *words],
        cwd=tmp_path,
        env={**plain, "TERM": "xterm", **environment},
        stdout=slave if terminal else subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    )
    os.close(slave)
    text = os.read(master, 100_000) if terminal else process.stdout.read()
    process.wait()
    if process.stdout is not None:
        process.stdout.close()
    os.close(master)
    return text.decode()


@pytest.mark.parametrize(
    ("words", "terminal", "environment", "coloured"),
    [
        ([], False, {}, False),
        ([], True, {}, True),
        ([], True, {"NO_COLOR": "1"}, False),
        ([], True, {"TERM": "dumb"}, False),
        ([], False, {"FORCE_COLOR": "1"}, True),
        (["--color", "always"], False, {"NO_COLOR": "1"}, True),
        (["--color=never"], True, {"FORCE_COLOR": "1"}, False),
        (["--color", "auto"], False, {"FORCE_COLOR": "1"}, False),
        (["--color=always", "--output-format", "concise"], False, {}, True),
        (["--color=always", "--output-format", "json"], False, {}, False),
    ],
    ids=str,
)
def test_who_decides_on_colours(tmp_path, words, terminal, environment, coloured):
    text = shown(tmp_path, *words, terminal=terminal, **environment)
    assert "RBL112" in text
    assert bool(PAINT.search(text)) == coloured


@pytest.mark.parametrize(
    ("words", "left", "wrong"),
    [
        (["robolang", "check", "--", "--color", "x"], ["robolang", "check", "--", "--color", "x"], None),
        (["robolang", "--color", "never", "check"], ["robolang", "check"], None),
        (["robolang", "check", "--color"], None, ""),
        (["robolang", "check", "--color=red"], None, "red"),
        (["robolang", "check", "--colour", "x"], ["robolang", "check", "--colour", "x"], None),
    ],
)
def test_the_option_is_taken_wherever_it_stands(monkeypatch, words, left, wrong):
    monkeypatch.setenv("NO_COLOR", "")
    assert take_option(words) == wrong
    assert left is None or words == left


def test_a_choice_that_is_none_is_a_usage_error():
    done = subprocess.run(
        [sys.executable, "-m", "robolang", "rules", "--color", "pink"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert done.stderr.startswith("error RBL703 --color:")


def test_help_without_colours_is_not_bold_either():
    for none, painted_too in (({"NO_COLOR": "1"}, False), ({}, True)):
        environment = {key: value for key, value in os.environ.items() if key != "NO_COLOR"}
        done = subprocess.run(
            [sys.executable, "-m", "robolang", "-h"],
            env={**environment, "FORCE_COLOR": "1", **none},
            capture_output=True,
            text=True,
            check=True,
        )
        assert ("\x1b[1m" in done.stdout) is painted_too
