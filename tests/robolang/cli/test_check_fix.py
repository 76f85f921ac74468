"""``robolang check --fix``, ``--diff`` and ``--watch``."""

import json
import os
import re
import shutil
import signal
import stat
import subprocess
import sys

import pytest
from typer.testing import CliRunner

from robolang.cli import check_job
from robolang.cli.main import app
from runtime.core.faults import Fault
from tests.messages import fields, heads
from tests.robolang.cli.commands import ROOT, counted, places, robolang
from tests.steps import HANG_S

BAD = "10MOVE P1, SPEED 1_000 ' noqa\n20 MOVE P2 SPEED 20\n30 MOVE P9\n"
GOOD = "10 MOVE P1, SPEED 1000 ' noqa\n20 MOVE P2, SPEED 20\n30 MOVE P9\n"
BETTER = GOOD.replace(" ' noqa", "")


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.rbl").write_text(BAD)
    (tmp_path / "good.rbl").write_text("MOVE P1\n")
    return tmp_path


def test_what_is_certain_is_corrected_in_the_file(folder):
    result = robolang("check", "--fix", code=1)
    assert (folder / "bad.rbl").read_text() == BETTER
    assert places(result.stdout) == [(3, 9, "RBL301")]
    counts = re.findall(r"(\d) x (RBL\d+) ([a-z-]+)", result.stderr)
    assert counts == [
        ("1", "RBL111", "unexpected-token"),
        ("2", "RBL115", "number-malformed"),
        ("1", "RBL190", "unused-suppression"),
    ]
    assert result.stderr.startswith("bad.rbl: ")
    assert counted(result.stderr) == 2
    assert (folder / "good.rbl").read_text() == "MOVE P1\n"


def test_a_second_time_there_is_nothing_to_do(folder):
    robolang("check", "--fix", code=1)
    stamp = (folder / "bad.rbl").stat().st_mtime_ns, (folder / "bad.rbl").stat().st_ino
    assert counted(robolang("check", "--fix", code=1).stderr) == 2
    assert ((folder / "bad.rbl").stat().st_mtime_ns, (folder / "bad.rbl").stat().st_ino) == stamp


def test_when_everything_is_corrected_the_exit_code_is_0(folder):
    (folder / "bad.rbl").write_text("10MOVE P1\n")
    assert robolang("check", "--fix").stdout == ""


def test_only_what_is_selected_is_corrected(folder):
    (folder / "bad.rbl").write_text("MOVE P1 ' noqa\r\nMOVE P2\n")
    robolang("check", "--fix", "--ignore", "RBL110")
    assert (folder / "bad.rbl").read_bytes() == b"MOVE P1\r\nMOVE P2\n"


def test_encoding_mark_and_line_ends_are_kept(folder):
    (folder / "bad.rbl").write_bytes(b"\xef\xbb\xbf10MOVE P1 ' \xc3\xa9\r\n20 MOVE P2\r\n")
    robolang("check", "--fix")
    assert (folder / "bad.rbl").read_bytes() == b"\xef\xbb\xbf10 MOVE P1 ' \xc3\xa9\r\n20 MOVE P2\r\n"


@pytest.mark.parametrize("words", [("--diff",), ("--diff", "--fix")])
def test_a_diff_changes_nothing(words, folder):
    result = robolang("check", *words, code=1)
    assert (folder / "bad.rbl").read_text() == BAD
    assert result.stdout.splitlines()[:2] == ["--- bad.rbl", "+++ bad.rbl"]
    assert [line for line in result.stdout.splitlines() if line[0] in "+-"][2:] == [
        "-10MOVE P1, SPEED 1_000 ' noqa",
        "-20 MOVE P2 SPEED 20",
        "+10 MOVE P1, SPEED 1000",
        "+20 MOVE P2, SPEED 20",
    ]
    assert counted(result.stderr) == 2


def test_a_diff_of_nothing_is_exit_code_0_whatever_is_found(folder):
    (folder / "bad.rbl").write_text("MOVE P9\n")
    assert robolang("check", "--diff").stdout == ""
    assert robolang("check", "--diff", "none.rbl", code=2).stdout == ""


def test_exit_zero_covers_a_diff():
    assert robolang("check", "--diff", "--exit-zero").stdout.startswith("--- bad.rbl")


def test_permissions_and_links_are_kept(folder):
    (folder / "bad.rbl").chmod(0o755)
    (folder / "link.rbl").symlink_to("bad.rbl")
    robolang("check", "--fix", "link.rbl", code=1)
    assert (folder / "link.rbl").is_symlink()
    assert (folder / "bad.rbl").read_text() == BETTER
    assert stat.S_IMODE((folder / "bad.rbl").stat().st_mode) == 0o755
    assert sorted(path.name for path in folder.iterdir()) == ["bad.rbl", "good.rbl", "link.rbl"]


def test_a_file_that_cannot_be_written_is_exit_code_4(folder, monkeypatch):
    def refuse(loaded, text):
        raise Fault("RBL706", f"cannot write {loaded.name}")

    monkeypatch.setattr(check_job, "store", refuse)
    result = robolang("check", "--fix", code=4)
    assert {"RBL706", "bad.rbl"} <= fields(result.stderr)
    assert "fixed" not in result.stderr
    assert (folder / "bad.rbl").read_text() == BAD


@pytest.mark.parametrize("gone", [False, True], ids=["changed", "gone"])
def test_a_file_that_changed_meanwhile_is_left_alone(gone, folder, monkeypatch):
    real = vars(check_job)["fix_all"]

    def fix_all(source, find):
        (folder / "bad.rbl").unlink() if gone else (folder / "bad.rbl").write_text("MOVE P2\n")
        return real(source, find)

    monkeypatch.setattr(check_job, "fix_all", fix_all)
    assert {"RBL706", "bad.rbl"} <= fields(robolang("check", "--fix", code=4).stderr)
    assert gone or (folder / "bad.rbl").read_text() == "MOVE P2\n"


@pytest.mark.skipif(shutil.which("patch") is None, reason="there is no patch command here")
@pytest.mark.parametrize(
    "text", [BAD, BAD.replace("\n", "\r\n"), BAD.removesuffix("\n"), "MOVE P1\r\nMOVE P2\nMOVE P3"]
)
def test_a_diff_is_one_that_patch_takes(text, folder):
    (folder / "bad.rbl").write_bytes(text.encode())
    diff = CliRunner().invoke(app, ["check", "--diff"]).stdout_bytes
    subprocess.run(["patch", "--binary", "-s", "-p0"], input=diff, cwd=folder, check=True, timeout=HANG_S)
    patched = (folder / "bad.rbl").read_bytes()
    (folder / "bad.rbl").write_bytes(text.encode())
    CliRunner().invoke(app, ["check", "--fix"])
    assert (folder / "bad.rbl").read_bytes() == patched
    assert patched != text.encode()


def test_a_program_from_the_standard_input_goes_to_the_standard_output():
    result = CliRunner().invoke(app, ["check", "--fix", "-"], input=BAD.replace("\n", "\r\n").encode())
    assert result.exit_code == 1
    assert result.stdout_bytes == BETTER.replace("\n", "\r\n").encode()
    assert "<stdin>:3:9: error RBL301" in result.stderr
    assert "1 x RBL111" in result.stderr


def test_a_program_without_fixes_goes_to_the_standard_output_as_it_is():
    for text in (b"MOVE P1", b"\xef\xbb\xbfMOVE P1\r\n", b""):
        result = CliRunner().invoke(app, ["check", "--fix", "-"], input=text)
        assert (result.exit_code, result.stdout_bytes) == (0, text)


def test_a_program_that_cannot_be_read_gives_no_output():
    result = CliRunner().invoke(app, ["check", "--fix", "-"], input=b"MOVE \xff")
    assert (result.exit_code, result.stdout_bytes) == (1, b"")


def test_a_diff_of_the_standard_input_goes_to_the_standard_output():
    result = CliRunner().invoke(app, ["check", "--diff", "--stdin-filename", "x.rbl", "-"], input=b"10MOVE P1\n")
    assert result.exit_code == 1
    assert result.stdout == "--- x.rbl\n+++ x.rbl\n@@ -1 +1 @@\n-10MOVE P1\n+10 MOVE P1\n"


def test_forms_say_what_is_left_after_the_fixes():
    found = json.loads(robolang("check", "--fix", "--output-format", "json", code=1).stdout)
    assert [(item["code"], item["fix"]) for item in found] == [("RBL301", None)]


# --- watch -----------------------------------------------------------------------------------------------------------


def watched(monkeypatch, *changes):
    """Let ``--watch`` look once for each change, without waiting."""
    steps = iter(changes)

    def sleep(seconds):
        change = next(steps, None)
        if change is None:
            raise KeyboardInterrupt
        change()

    real = vars(check_job)["watch"]
    monkeypatch.setattr(check_job, "watch", lambda paths, check: real(paths, check, sleep=sleep))


def test_watch_checks_again_after_a_change(folder, monkeypatch):
    watched(monkeypatch, lambda: (folder / "bad.rbl").write_text("MOVE P8\n"), lambda: (folder / "bad.rbl").unlink())
    result = robolang("check", "--watch", "--output-format", "concise")
    assert heads(result.stdout)[-1] == "bad.rbl:1:6: error RBL301"
    assert "P8" in result.stdout.splitlines()[-1]
    assert result.stderr.count("watching; Ctrl-C ends") == 3


def test_watch_leaves_with_the_last_state(folder, monkeypatch):
    watched(monkeypatch)
    assert robolang("check", "--watch", code=1).stderr.count("watching; Ctrl-C ends") == 1


def test_watch_goes_on_after_a_wrong_configuration(folder, monkeypatch):
    config = folder / "robolang.toml"
    wrong, right = "[lint]\nx = 1\n", "[lint]\nselect = []\n"
    watched(monkeypatch, lambda: config.write_text(wrong), lambda: config.write_text(right))
    (folder / "bad.rbl").write_text("MOVE P9\n")
    result = robolang("check", "--watch")
    assert "RBL707" in result.stderr
    assert places(result.stdout) == [(1, 6, "RBL301")]


def test_ctrl_c_ends_a_watch(folder):
    command = [sys.executable, "-m", "robolang", "check", "--watch", "good.rbl"]
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    # a shell starts what runs in the background with SIGINT ignored, and a child inherits that
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        started = subprocess.Popen(command, cwd=folder, env=env, stderr=subprocess.PIPE, stdout=subprocess.PIPE)
    finally:
        signal.signal(signal.SIGINT, before)
    with started as process:
        assert process.stderr.readline() == b"watching; Ctrl-C ends\n"
        process.send_signal(signal.SIGINT)
        out, said = process.communicate(timeout=HANG_S)
    assert (process.returncode, out, said) == (0, b"", b"")
