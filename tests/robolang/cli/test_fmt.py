import os
import shutil
import stat
import subprocess
import sys

import pytest
from typer.testing import CliRunner

from robolang.cli.main import app
from robolang.cli.rewrite import unified
from robolang.core.source import MAX_BYTES
from tests.messages import fields, numbers
from tests.robolang.cli.commands import ROOT, places, robolang, shell

BAD, GOOD = "move p1 'x\nhand  on'y\n", "MOVE p1  'x\nHAND ON  'y\n"


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.rbl").write_text(BAD)
    (tmp_path / "good.rbl").write_text(GOOD)
    return tmp_path


def piped(text, *words, code=0):
    """Call ``robolang fmt`` with a standard input."""
    raw = text if isinstance(text, bytes) else text.encode("utf-8")
    result = CliRunner(env={"COLUMNS": "80", "TERM": "dumb"}).invoke(app, ["fmt", *words], input=raw)
    assert result.exit_code == code, result.output
    assert not result.exception or isinstance(result.exception, SystemExit)
    return result


def test_files_are_rewritten_and_counted(folder):
    result = robolang("fmt", "bad.rbl", "good.rbl")
    assert (numbers(result.stdout), result.stderr) == ([1, 1], "")
    assert (folder / "bad.rbl").read_text() == GOOD
    assert numbers(robolang("fmt", "bad.rbl", "good.rbl").stdout) == [2]


def test_a_file_that_is_as_it_should_be_is_not_touched(folder):
    os.utime("good.rbl", (1, 1))
    robolang("fmt", "good.rbl")
    assert (folder / "good.rbl").stat().st_mtime == 1


def test_folders_are_searched_for_programs(folder):
    (folder / "a" / "b").mkdir(parents=True)
    (folder / ".git").mkdir()
    for name in ("a/c.rbl", "a/b/d.rbl", "a/e.txt", ".git/f.rbl"):
        (folder / name).write_text(BAD)
    assert numbers(robolang("fmt").stdout) == [3, 1]
    assert (folder / "a" / "b" / "d.rbl").read_text() == GOOD
    assert (folder / "a" / "e.txt").read_text() == (folder / ".git" / "f.rbl").read_text() == BAD
    assert numbers(robolang("fmt", "a/e.txt", "a", "a/b").stdout) == [1, 2]


def test_nothing_to_format_is_said(folder):
    (folder / "empty").mkdir()
    assert "*.rbl" in robolang("fmt", "empty").stdout


def test_check_writes_nothing(folder):
    result = robolang("fmt", "--check", code=1)
    named, counted = result.stdout.splitlines()
    assert (fields(named), numbers(counted)) == ({"bad.rbl"}, [1, 1])
    assert (folder / "bad.rbl").read_text() == BAD
    assert numbers(robolang("fmt", "--check", "good.rbl").stdout) == [1]


def test_diff_prints_what_would_change(folder):
    result = robolang("fmt", "--diff", code=1)
    assert result.stdout == (
        "--- bad.rbl\n+++ bad.rbl\n@@ -1,2 +1,2 @@\n-move p1 'x\n-hand  on'y\n+MOVE p1  'x\n+HAND ON  'y\n"
    )
    assert numbers(result.stderr) == [1, 1]
    assert (folder / "bad.rbl").read_text() == BAD
    assert robolang("fmt", "--diff", "good.rbl").stdout == ""


@pytest.mark.skipif(shutil.which("git") is None, reason="git applies the patch")
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_a_diff_is_what_patch_takes(folder, end):
    text = end.join(["x=1", *["' same"] * 9, "y=2", "", "", "", "", "z=3", *["' same"] * 20, "move p1"])
    (folder / "bad.rbl").write_bytes(text.encode())
    patch = robolang("fmt", "--diff", "bad.rbl", code=1).stdout_bytes
    assert patch.count(b"@@ -") == 3
    assert b"\\ No newline at end of file" in patch
    robolang("fmt", "bad.rbl")
    formatted = (folder / "bad.rbl").read_bytes()
    (folder / "bad.rbl").write_bytes(text.encode())
    subprocess.run(["git", "apply", "-p0", "-"], input=patch, check=True, cwd=folder)
    assert (folder / "bad.rbl").read_bytes() == formatted


def test_a_file_with_errors_is_left_alone_and_the_others_are_not(folder):
    (folder / "broken.rbl").write_text("move p1\n10 MOV p1\n")
    for words in ([], ["--check"], ["--diff"]):
        result = robolang("fmt", *words, code=2)
        assert places(result.stderr) == [(2, 4, "RBL112")]
        assert numbers((result.stderr if words == ["--diff"] else result.stdout).splitlines()[-1])[-1] == 1
    assert (folder / "broken.rbl").read_text() == "move p1\n10 MOV p1\n"
    assert (folder / "bad.rbl").read_text() == GOOD


@pytest.mark.parametrize(
    ("name", "raw", "said"),
    [
        ("none.rbl", None, "RBL701"),
        ("binary.rbl", b"\xff\xfe\x00", "RBL104"),
        ("big.rbl", b"'" * (MAX_BYTES + 1), "RBL106"),
    ],
)
def test_a_file_that_cannot_be_read_is_reported(folder, name, raw, said):
    if raw is not None:
        (folder / name).write_bytes(raw)
    result = robolang("fmt", name, "bad.rbl", code=2)
    assert f"{name}:1:1: error {said}" in result.stderr
    assert numbers(result.stdout) == [1, 1]


def test_a_pipe_is_refused_without_waiting(folder):
    os.mkfifo(folder / "pipe.rbl")
    assert "RBL702" in robolang("fmt", code=2).stderr


def test_what_formatting_would_make_too_large_is_left_alone(folder):
    text = "WHILE 1\n" * 20 + "'\n" * 30_000
    (folder / "bad.rbl").write_text(text)
    assert "RBL106" in robolang("fmt", "bad.rbl", code=2).stderr
    assert (folder / "bad.rbl").stat().st_size == len(text)


def test_the_byte_order_mark_the_line_end_and_the_permissions_stay(folder):
    (folder / "bad.rbl").write_bytes(b"\xef\xbb\xbfmove p1 '\xc3\xa9\r\n")
    (folder / "bad.rbl").chmod(0o640)
    robolang("fmt", "bad.rbl")
    assert (folder / "bad.rbl").read_bytes() == b"\xef\xbb\xbfMOVE p1  '\xc3\xa9\r\n"
    assert stat.S_IMODE((folder / "bad.rbl").stat().st_mode) == 0o640


def test_a_link_stays_a_link(folder):
    (folder / "link.rbl").symlink_to("bad.rbl")
    robolang("fmt", "link.rbl")
    assert (folder / "link.rbl").is_symlink()
    assert (folder / "bad.rbl").read_text() == GOOD


@pytest.mark.skipif(os.geteuid() == 0, reason="the superuser may write everywhere")
def test_a_read_only_file_is_a_storage_fault(folder):
    (folder / "bad.rbl").chmod(0o444)
    assert "RBL706" in robolang("fmt", code=4).stderr
    assert (folder / "bad.rbl").read_text() == BAD


def test_a_write_that_fails_leaves_the_old_file(folder, monkeypatch):
    def full(fd):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("robolang.core.storage.os.fsync", full)
    result = robolang("fmt", code=4)
    assert "RBL706" in result.stderr
    assert (folder / "bad.rbl").read_text() == BAD
    assert sorted(path.name for path in folder.iterdir()) == ["bad.rbl", "good.rbl"]


# --- the standard input ----------------------------------------------------------------------------------------------


def test_standard_input_to_standard_output():
    assert piped(BAD, "-").stdout == GOOD
    assert piped(GOOD, "-").stdout == GOOD
    assert piped("move p1 'é点\r\n", "-").stdout_bytes == "MOVE p1  'é点\r\n".encode()
    assert piped(b"\xef\xbb\xbfend", "-").stdout_bytes == b"\xef\xbb\xbfEND\n"


def test_standard_input_with_check_and_diff():
    assert piped(BAD, "-", "--check", code=1).stdout.endswith(" <stdin>\n")
    assert piped(GOOD, "-", "--check").stdout == ""
    assert piped(BAD, "-", "--diff", code=1).stdout.startswith("--- <stdin>\n+++ <stdin>\n@@ -1,2 +1,2 @@\n")


@pytest.mark.parametrize(
    ("raw", "said"), [(b"MOV", "RBL11"), (b"\xff", "RBL104"), (b"\0", "RBL104"), (b"\n" * (MAX_BYTES + 1), "RBL106")]
)
def test_standard_input_with_errors_gives_nothing(raw, said):
    result = piped(raw, "-", code=2)
    assert result.stdout == ""
    assert "<stdin>:1:" in result.stderr
    assert said in result.stderr


def test_standard_input_stands_alone():
    assert "-" in fields(robolang("fmt", "-", "good.rbl", code=2).stderr)


def test_the_bytes_do_not_depend_on_the_locale(folder):
    env = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONIOENCODING": "ascii"}
    result = shell("fmt", "-", env=env, input="move p1 'é\n".encode(), text=False)
    assert result.stdout == "MOVE p1  'é\n".encode()


def test_no_standard_input_at_all():
    code = "import sys; sys.stdin = None; from robolang.cli.main import app; app(['fmt', '-'])"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, cwd=ROOT)
    assert result.returncode == 2
    assert "RBL702" in result.stderr


def test_nothing_heavy_is_imported(folder):
    code = (
        "import sys; from robolang.cli.main import app\ntry: app(['fmt'])\nexcept SystemExit: pass\n"
        "print(sorted({'numpy', 'pinocchio', 'mujoco', 'ruckig', 'mcap', 'rich.table'} & set(sys.modules)))"
    )
    result = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        cwd=folder,
    )
    assert result.stdout.splitlines()[-1] == "[]"


# --- the diff --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("a\n", "a\n", ""),
        ("", "", ""),
        ("a\n\n\n\nb\n", "a\n\n\nb\n", "@@ -1,5 +1,4 @@\n a\n \n \n-\n b\n"),
        ("\n\n", "", "@@ -1,2 +0,0 @@\n-\n-\n"),
        ("a", "a\n", "@@ -1 +1 @@\n-a\n\\ No newline at end of file\n+a\n"),
        ("a\n\n", "b\n", "@@ -1,2 +1 @@\n-a\n-\n+b\n"),
        ("a\n10\nb\n", "a\n\nb\n", "@@ -1,3 +1,3 @@\n a\n-10\n+\n b\n"),
        (
            "a\n" + "x\n" * 7 + "b\n",
            "A\n" + "x\n" * 7 + "B\n",
            "@@ -1,4 +1,4 @@\n-a\n+A\n x\n x\n x\n@@ -6,4 +6,4 @@\n x\n x\n x\n-b\n+B\n",
        ),
        (
            "a\n\n\n\nb\n" + "x\n" * 9 + "c\n",
            "a\n\n\nb\n" + "x\n" * 9 + "C\n",
            "@@ -1,7 +1,6 @@\n a\n \n \n-\n b\n x\n x\n@@ -12,4 +11,4 @@\n x\n x\n x\n-c\n+C\n",
        ),
        (
            "a\n" + "x\n" * 6 + "b\n",
            "A\n" + "x\n" * 6 + "B\n",
            "@@ -1,8 +1,8 @@\n-a\n+A\n x\n x\n x\n x\n x\n x\n-b\n+B\n",
        ),
    ],
)
def test_unified_diff(old, new, expected):
    assert "".join(unified("p", old, new)) == (f"--- p\n+++ p\n{expected}" if expected else "")
