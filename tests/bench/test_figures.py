"""Every bench and campaign works, at its smallest size, and prints the rows of docs/measured.md that name it."""

import json
import re
import sys
from functools import partial
from itertools import groupby
from pathlib import Path
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pytest

from tests.bench import (
    blend_campaign,
    check,
    corner_picture,
    figures,
    frames,
    gcode_campaign,
    inertia,
    jog_campaign,
    live,
    long_path,
    measure,
    mutants,
    pages,
    plots,
    prompt,
    pulse_campaign,
    run,
    short_moves,
    stop_campaign,
    wrist_campaign,
)
from tests.bench.figures import Row
from tests.faults import campaign
from tests.fuzz import large, targets

ROOT = Path(__file__).parents[2]
MAKEFILE = (ROOT / "Makefile").read_text("utf-8")
BENCHES = {
    "make bench": (run.rows, inertia.rows, check.rows, prompt.rows, long_path.rows),
    "make view-bench": (pages.rows, frames.rows, live.rows),
    "make measured": (measure.rows, short_moves.rows),
    "make fault-campaign": (campaign.fault_rows,),
    "make supervision-campaign": (campaign.payload_rows,),
    "make blend-campaign": (blend_campaign.rows,),
    "make stop-campaign": (stop_campaign.rows,),
    "make gcode-campaign": (gcode_campaign.rows,),
    "make jog-campaign": (jog_campaign.rows,),
    "make pulse-campaign": (pulse_campaign.rows,),
    "make wrist-campaign": (wrist_campaign.rows,),
    "make large": (large.rows,),
    "make mutants": (mutants.rows,),
}
"""What measures the rows that a command prints."""
IN_PROSE = {measure.HELD}
"""Figures that the page quotes in its text."""


def page_rows(page: str) -> list[tuple[str, set[str]]]:
    """Return the first cell of every row of every table, and the ``make`` commands that print it.

    They are in the column "command", where "same" is that of the row above; where there is no such column, in the text
    of the section.
    """
    found = []
    for section in re.split(r"(?m)^#+ .*$", page):
        lines = section.splitlines()
        prose = set(re.findall(r"`(make [a-z-]+)`", "\n".join(line for line in lines if not line.startswith("|"))))
        for is_table, table in groupby(lines, lambda line: line.startswith("|")):
            if not is_table:
                continue
            head, _, *body = [[cell.strip() for cell in line.strip("|").split("|")] for line in table]
            commands: set[str] = prose
            for cells in body:
                if "command" in head[-1] and cells[-1] != "same":
                    commands = set(re.findall(r"`(make [a-z-]+)`", cells[-1]))
                found.append((cells[0], commands))
    return found


PAGE = page_rows((ROOT / "docs" / "measured.md").read_text("utf-8"))


@pytest.fixture(autouse=True)
def at_the_root(monkeypatch):
    monkeypatch.chdir(ROOT)


@pytest.mark.physics
@pytest.mark.parametrize("command", BENCHES)
def test_a_command_prints_every_row_of_the_page_that_names_it_and_breaks_no_promise(command):
    rows = [row for bench in BENCHES[command] for row in bench(True)]
    for row in rows:
        assert row.finite, row
        assert "nan" not in row.measured.lower()
        assert row.good, row
    printed = {row.figure for row in rows}
    assert len(printed) == len(rows)
    named = {figure for figure, commands in PAGE if command in commands}
    assert named, "the page names the command nowhere"
    assert named <= printed
    assert printed - IN_PROSE <= {figure for figure, _ in PAGE}


def test_every_make_command_that_the_page_names_is_run_here_and_is_in_the_makefile():
    named = {command for _, commands in PAGE for command in commands}
    assert named == set(BENCHES)
    for command in named:
        assert re.search(rf"(?m)^{command.removeprefix('make ')}:", MAKEFILE)


def test_the_makefile_runs_modules_that_are_there():
    modules = re.findall(r"-m (tests[a-z_.]+)", MAKEFILE)
    assert len(modules) >= 10
    for module in modules:
        assert (ROOT / (module.replace(".", "/") + ".py")).is_file(), module


def test_the_page_is_read_as_it_is_meant():
    page = (
        "# a\n`make x`\n\n| f | m |\n|---|---|\n| one | 1 |\n\n"
        "# b\n| f | command |\n|---|---|\n| two | `make y` |\n| three | same |\n| four | `time` |\n"
    )
    assert page_rows(page) == [("one", {"make x"}), ("two", {"make y"}), ("three", {"make y"}), ("four", set())]


def printed(row, smallest):
    return iter([row])


def test_the_picture_of_corners_shows_paths_that_keep_their_zones():
    panels = corner_picture.panels()
    shown = ElementTree.fromstring(corner_picture.corners())
    assert len([each for each in shown.iter() if each.tag.endswith("polyline")]) == 2 * len(panels)
    for panel in panels:
        corners, tool = panel.places[1:-1], panel.tool()
        nearest = np.min(np.linalg.norm(tool[:, None] - corners, axis=2), axis=0)
        # it misses each corner, by less than the zone
        assert (nearest > 0.05).all() and (nearest < panel.zone).all(), panel.title


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_a_figure_that_is_no_number_ends_a_bench_with_an_error(value, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["bench"])
    for row, code in (
        (Row(figure="f", form="{:.1f} s", values=(1.0,)), 0),
        (Row(figure="f", form="{:.1f} s", values=(value,)), 1),
        (Row(figure="f", form="{:.1f} s", values=(1.0,), good=False), 1),
    ):
        with pytest.raises(SystemExit) as ended:
            figures.run(partial(printed, row))
        assert ended.value.code == code
    assert "NOT AS PROMISED" in capsys.readouterr().out


def test_what_no_test_finds_was_not_run_or_is_missing_is_no_mutant_found(tmp_path):
    """From results as mutmut leaves them: 1, 3 failed, 36 did not end, 0 passed, 33 had no tests, null was not run."""
    names = mutants.scope()
    assert "runtime/supervision/tick_monitor.py" in names
    for ends, good in (([1, 3, 36, *[1] * 16, 0], True), ([1] * 17 + [0, 33, None], False), ([], False)):
        for name in names:
            path = tmp_path / f"{name}.meta"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(json.dumps({"exit_code_by_key": {f"m{k}": end for k, end in enumerate(ends)}}), "utf-8")
        *_, every = mutants.rows(False, tmp_path)
        assert every.good is good
        assert every.values[1] == len(ends) * len(names)


def test_the_plots_are_drawn(tmp_path):
    for path in plots.draw(tmp_path, seconds=0.15, every_deg=90.0):
        assert ElementTree.parse(path).getroot().tag.endswith("svg")
        assert "nan" not in path.read_text("utf-8")


def test_fuzzing_starts_with_words_and_seeds_and_gives_bytes_to_its_target(monkeypatch, tmp_path):
    """With another fuzzer in the place of atheris, which the tests do not install."""
    seen = {}
    stub = SimpleNamespace(
        instrument_imports=lambda include: pytest.MonkeyPatch.context(),
        Setup=lambda options, target: seen.update(options=options, target=target),
        Fuzz=lambda: seen["target"](b"10 MOVE P1\n"),
    )
    monkeypatch.setitem(sys.modules, "atheris", stub)
    monkeypatch.delitem(sys.modules, "tests.fuzz.run", raising=False)
    from tests.fuzz import run as fuzz

    monkeypatch.setattr(fuzz, "OUT", tmp_path)
    listed = re.search(r"(?m)^FUZZ_TARGETS \?= (.*)$", MAKEFILE)[1].split()
    assert listed == list(targets.TARGETS)
    for target in targets.TARGETS:
        monkeypatch.setattr(sys, "argv", ["run", target, "1"])
        fuzz.main()
        *_, kept, seeds, programs = seen["options"]
        assert (Path(kept), Path(programs)) == (tmp_path / target, ROOT / "programs")
        assert any(Path(seeds).iterdir())
        assert (tmp_path / f"{target}.dict").read_text("utf-8").count("\n") > 10
