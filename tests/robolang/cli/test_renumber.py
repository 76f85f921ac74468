import pytest
from typer.testing import CliRunner

from robolang.cli.main import app
from tests.messages import fields, numbers
from tests.robolang.cli.commands import flat, places, robolang

OLD, NEW = "1 MOVE P1 'x\ngoto 1\n", "10 MOVE P1 'x\n20 goto 10\n"


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.rbl").write_text(OLD)
    return tmp_path


def counted(line):
    """The file that a line is of, and how many line numbers and jumps it counts."""
    name, _, rest = line.partition(": ")
    assert rest.endswith("\n")
    return name, numbers(rest)


def test_the_file_is_rewritten(folder):
    result = robolang("renumber", "a.rbl")
    assert (counted(result.stdout), result.stderr) == (("a.rbl", [2, 1]), "")
    assert (folder / "a.rbl").read_text() == NEW
    assert counted(robolang("renumber", "a.rbl").stdout) == ("a.rbl", [])


def test_start_and_step(folder):
    robolang("renumber", "a.rbl", "--start", 100, "--step", 5)
    assert (folder / "a.rbl").read_text() == "100 MOVE P1 'x\n105 goto 100\n"


def test_check_and_diff_write_nothing(folder):
    assert counted(robolang("renumber", "a.rbl", "--check", code=1).stdout) == ("a.rbl", [2, 1])
    result = robolang("renumber", "a.rbl", "--diff", code=1)
    assert result.stdout == (
        "--- a.rbl\n+++ a.rbl\n@@ -1,2 +1,2 @@\n-1 MOVE P1 'x\n-goto 1\n+10 MOVE P1 'x\n+20 goto 10\n"
    )
    assert counted(result.stderr) == ("a.rbl", [2, 1])
    assert (folder / "a.rbl").read_text() == OLD
    (folder / "a.rbl").write_text(NEW)
    assert counted(robolang("renumber", "a.rbl", "--check").stdout) == ("a.rbl", [])
    assert robolang("renumber", "a.rbl", "--diff").stdout == ""


def test_another_file_and_the_standard_streams(folder):
    robolang("renumber", "a.rbl", "-o", "b.rbl")
    assert ((folder / "a.rbl").read_text(), (folder / "b.rbl").read_text()) == (OLD, NEW)
    robolang("renumber", "b.rbl", "-o", "c.rbl")
    assert (folder / "c.rbl").read_text() == NEW
    assert robolang("renumber", "a.rbl", "-o", "-").stdout == NEW
    result = CliRunner().invoke(app, ["renumber", "-"], input="\ufeffend\r\n".encode())
    assert result.stdout_bytes == "\ufeff10 end\r\n".encode()
    assert counted(result.stderr) == ("<stdin>", [1])


def test_remove(folder):
    (folder / "a.rbl").write_text("10 MOVE P1\n20 GOTO 10\n30\n")
    assert counted(robolang("renumber", "a.rbl", "--remove").stdout) == ("a.rbl", [2])
    assert (folder / "a.rbl").read_text() == "10 MOVE P1\nGOTO 10\n\n"


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("10 GOTO 30\n", [(1, 9, "RBL202")]),
        ("10 END\n10 END\n", [(2, 1, "RBL113")]),
        ("MOVE P1\n  MOV P1\n", [(2, 3, "RBL112")]),
    ],
)
@pytest.mark.parametrize("words", [[], ["--check"], ["--diff"], ["--remove"], ["-o", "b.rbl"]])
def test_a_program_with_errors_is_left_alone(folder, text, found, words):
    (folder / "a.rbl").write_text(text)
    result = robolang("renumber", "a.rbl", *words, code=2)
    assert places(result.stderr) == found
    assert result.stdout == ""
    assert (folder / "a.rbl").read_text() == text
    assert not (folder / "b.rbl").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["a.rbl", "--start", "-1"], "-1"),
        (["a.rbl", "--step", "0"], "0"),
        (["a.rbl", "--remove", "--step", "5"], "RBL703 --remove --start --step"),
        (["a.rbl", "--check", "-o", "b.rbl"], "RBL703 --out --check --diff"),
        (["a.rbl", "--start", "999999990"], "RBL703 2 1000000000"),
        (["none.rbl"], "RBL701"),
        (["."], "RBL702"),
        ([], "FILE"),
    ],
)
def test_usage_errors(folder, words, said):
    assert set(said.split()) <= fields(flat(robolang("renumber", *words, code=2).stderr))
    assert (folder / "a.rbl").read_text() == OLD


def test_where_nothing_can_be_written_is_a_storage_fault(folder):
    (folder / "b.rbl").mkdir()
    assert "RBL706" in robolang("renumber", "a.rbl", "-o", "b.rbl", code=4).stderr
