"""``robolang repl`` as a process: exit codes of scripts, streams, what is written."""

import pytest

from tests.robolang.cli.commands import ROOT, shell

PICK = ROOT / "programs" / "pick_and_place.rbl"


def repl(lines, *words, cwd):
    return shell("repl", "--no-physics", *words, cwd=cwd, input="\n".join(lines) + "\n")


@pytest.mark.parametrize(
    "lines, code",
    [
        (["1 + 2", "quit"], 0),
        (["MOVE P99"], 1),
        (["teach P7"], 1),
        (["tech P7"], 1),
        (["pos 3"], 2),
        (["help nowhere"], 2),
        (["MOVE P1 + (0, 0, 9000)"], 3),
        (["x = 0", "y = 1 / x"], 3),
        (["run", "run"], 3),
        (["10 MOVE P1", "save as nowhere/mine"], 4),
    ],
)
def test_a_script_ends_with_the_exit_codes_of_run(tmp_path, lines, code):
    result = repl(lines, cwd=tmp_path)
    assert result.returncode == code, result.stdout + result.stderr
    assert "Traceback" not in result.stderr


def test_a_file_that_cannot_be_used_is_reported_at_the_start(tmp_path):
    assert repl(["pos"], "nowhere.rbl", cwd=tmp_path).returncode == 2
    assert repl(["pos"], "--robot", "nobody", cwd=tmp_path).returncode == 2
    (tmp_path / "bad.cell.toml").write_text("schema = 1\nrobot = 3\n")
    assert repl(["pos"], "--cell", "bad.cell.toml", cwd=tmp_path).returncode == 2


def test_results_go_to_stdout_and_problems_to_stderr(tmp_path):
    result = repl(["1 + 2", "MOVE P99", "3 + 4"], "--keep-going", str(PICK), cwd=tmp_path)
    assert result.stdout.splitlines() == ["> 1 + 2", "3", "> MOVE P99", "> 3 + 4", "7"]
    assert "RBL301" in result.stderr
    assert result.returncode == 1


def test_a_text_that_is_not_utf8_is_an_error_with_its_place(tmp_path):
    result = shell("repl", cwd=tmp_path, input=b'PRINT "\xff\xfe"\n', text=False)
    assert result.returncode in (1, 2)
    assert b"Traceback" not in result.stderr
