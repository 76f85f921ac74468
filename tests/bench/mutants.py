"""``make mutants``: how many mutants of the code the tests find, from the results that mutmut leaves in a folder.

A mutant is the code with one small change: another operator, bound, number, argument or text. It is found when a test
fails with it, or when the tests do not end with it.
"""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path

from tests.bench import figures
from tests.bench.figures import Row

ROOT = Path(__file__).parents[2]
RESULTS = ROOT / "mutants"
PROMISED = 0.9
"""Share of all mutants that the tests find."""
FOUND = {1, 3, -24, 24, 36, 152, 255}
"""How the tests of a mutant ended, as mutmut writes it, where they failed or did not end."""


def scope() -> list[str]:
    """Return the modules that are mutated; those of data alone have no mutants."""
    patterns = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["mutmut"]["only_mutate"]
    paths = sorted(path for pattern in patterns for path in ROOT.glob(pattern) if path.suffix == ".py")
    return [path.relative_to(ROOT).as_posix() for path in paths if "def " in path.read_text("utf-8")]


def rows(smallest: bool, results: Path = RESULTS) -> Iterator[Row]:
    """Count the mutants of each module and of all; at the smallest size none is made and each module has one, found."""
    found = mutants = 0
    for module in scope():
        ends = [1] if smallest else _ends(results / f"{module}.meta")
        yield _row(f"mutants of `{module}` that a test finds", sum(end in FOUND for end in ends), len(ends), 0.0)
        found, mutants = found + sum(end in FOUND for end in ends), mutants + len(ends)
    yield _row("mutants that a test finds", found, mutants, PROMISED)


def _ends(path: Path) -> list[int | None]:
    return list(json.loads(path.read_text("utf-8"))["exit_code_by_key"].values())


def _row(figure: str, found: int, mutants: int, promised: float) -> Row:
    share = found / mutants if mutants else float("nan")
    return Row(
        figure=figure, form="{:.0f} of {:.0f}: {:.1f} %", values=(found, mutants, 100.0 * share), good=share >= promised
    )


if __name__ == "__main__":
    figures.run(rows)
