"""Every command that takes a file, with what is no such file: an error with a code, and nothing is waited for.

A folder is a file to nobody but those that take folders: with these it is empty, which is an error, too.
"""

import os
import re

import pytest

from tests.robolang.cli.commands import robolang
from tests.steps import guarded

AT = "@"
"""Where the file stands among the words of a command."""
OUT = ("-o", "made.png")
COMMANDS = (
    *("run @", "run - --cell @", "run - --robot @", "run - --profile @", "run - --compensation @"),
    *("check @", "check --motion @", "test @", "fmt --check @", "renumber @", "repl @"),
    *("view @", "report @", "report run.npz @", "render @ -o made.png", "render p.rbl --cell @ -o made.png"),
    *("render @", "plot @ q", "log show @", "log export @ --csv"),
    *(
        "robot show @",
        "robot import @",
        "robot import --estimate @",
        "kin fk --robot @ --joints 0",
        "kin ik --robot @ --pose 0,0,0,0,0,0",
    ),
    *("jog @ J1 1", "jog --robot @ J1 1", "teach @ P1 --pose 500,0,800,180,0,180", "teach p.rbl P1 --here-of @"),
    *("compare @", "compare p.rbl --cell @", "step --robot @ --axis 1", "inertia --robot @", "identify @", "weigh @"),
    *("weigh --cell @", "export pulses @ -o made", "export pulses p.rbl --channels @ -o made", "replay-pulses @"),
    *("replay-pulses @ --cell @", "config show @", "config show --robot @", "config show --profile @"),
    *("new made --robot @",),
)
FOLDERS = ("check @", "check --motion @", "test @", "fmt --check @")
"""What takes folders: ``.`` and the empty name have a program here, and below ``/`` is the whole disk."""
FILES = (".", "/", "", "dir", "missing", "missing.rbl", "pipe", "pipe.rbl", "noise", "noise.rbl", "noise.npz")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "dir").mkdir()
    (tmp_path / "p.rbl").write_text("MOVE P1\n")
    for name in ("pipe", "pipe.rbl"):
        os.mkfifo(tmp_path / name)
    for name in ("noise", "noise.rbl", "noise.npz"):
        (tmp_path / name).write_bytes(bytes(range(256)) * 4)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("command", COMMANDS)
def test_what_is_no_file_of_a_command_has_a_code(folder, command):
    wrong = []
    for file in FILES[4:] if command in FOLDERS else FILES:
        words = [file if word == AT else word for word in command.split()]
        with guarded():
            try:
                said = robolang(*words, code=None, typed="MOVE P1\n")
            except BaseException as error:
                wrong.append((file, repr(error)[:200]))
                continue
        if (file, command.split()[0]) == ("dir", "fmt"):
            continue  # where no program is, none has another layout
        if not said.exit_code or not re.search(r"RBL\d{3}", said.output + said.stderr):
            wrong.append((file, said.exit_code, (said.output + said.stderr)[:200]))
    assert not wrong, "\n" + "\n".join(map(str, wrong))
