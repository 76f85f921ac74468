"""What is unlikely about a robot is a warning of every command that reads it, once."""

import pytest

from tests.robolang.cli.commands import BUILTIN, PUMA, places, robolang

LINE = next(n for n, line in enumerate(PUMA.read_text().splitlines(), start=1) if line.startswith("gear_ratio"))


@pytest.fixture
def shop(tmp_path):
    """Two programs in one cell with an unlikely robot."""
    (tmp_path / "odd.toml").write_text(PUMA.read_text().replace("gear_ratio = -62.6111", "gear_ratio = -0.9", 1))
    cell = (BUILTIN / "cell.toml").read_text()
    for name in ("a", "b"):
        (tmp_path / f"{name}.cell.toml").write_text(cell.replace('robot = "puma560"', 'robot = "odd.toml"'))
        (tmp_path / f"{name}.rbl").write_text("10 DELAY 0.1\n")
    return tmp_path


@pytest.mark.physics
@pytest.mark.parametrize(
    ("command", "code"),
    [
        ("robot show odd.toml", 0),
        ("kin fk --robot odd.toml --joints 0,0,0,0,0,0", 0),
        ("run --no-physics a.rbl", 0),
        ("config show a.rbl", 0),
        ("inertia --robot odd.toml", 0),
        ("check --motion a.rbl b.rbl", 0),
        ("check a.rbl b.rbl", 0),
        ("check --strict a.rbl", 1),
        ("check --motion --strict a.rbl", 1),
    ],
)
def test_it_is_printed_once(shop, monkeypatch, command, code):
    monkeypatch.chdir(shop)
    said = places(robolang(*command.split(), code=code).stderr)
    assert [place for place in said if place[2] == "RBL629"] == [(LINE, 1, "RBL629")]
