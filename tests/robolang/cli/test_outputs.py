"""Outputs that would replace what a command reads, under any name: refused before anything is done."""

import pytest

from tests.robolang.cli.commands import dry, robolang

TEXT = "MOVE P1 + (0, 0, 20)\n"


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    folder = tmp_path_factory.mktemp("log")
    (folder / "p.rbl").write_text(TEXT)
    dry(folder / "p.rbl", "--quiet", "--log", folder / "a.npz")
    return (folder / "a.npz").read_bytes()


@pytest.mark.parametrize(
    "words",
    [
        ("plot", "a.npz", "q_fb", "-o", "link.svg"),
        ("log", "export", "a.npz", "--csv", "-o", "link.csv"),
        ("log", "export", "link.csv", "--csv"),
        ("report", "a.npz", "-o", "link.html"),
        ("report", "link.npz", "a.npz", "-o", "link.html"),
        ("render", "a.npz", "-o", "link.png"),
        ("run", "p.rbl", "--log", "p.npz"),
        ("run", "p.rbl", "--cell", "c.toml", "--report", "c.json"),
        ("run", "p.rbl", "--log", "o.npz", "--report", "o.npz"),
        ("check", "p.rbl", "--output-file", "p.npz"),
        ("check", ".", "--output-file", "p.npz"),
        ("check", "p.rbl", "--motion", "--times", "p.rbl"),
        ("check", "p.rbl", "--motion", "--times", "o.json", "--output-file", "./o.json"),
    ],
    ids=" ".join,
)
def test_no_output_replaces_what_is_read(log, tmp_path, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.npz").write_bytes(log)
    (tmp_path / "p.rbl").write_text(TEXT)
    (tmp_path / "c.toml").write_text("# a cell\n")
    for ending in ("svg", "csv", "html", "png", "npz"):
        (tmp_path / f"link.{ending}").symlink_to("a.npz")
    (tmp_path / "p.npz").symlink_to("p.rbl")
    (tmp_path / "c.json").symlink_to("c.toml")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    assert "RBL703" in robolang(*words, code=2).stderr
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
