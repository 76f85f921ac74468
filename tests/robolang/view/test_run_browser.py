"""Pages of real runs and plans in a browser: robot, part and program against the log, hostile texts, odd runs."""

import math
from contextlib import contextmanager

import numpy as np
import pytest

from robolang.api.running import run
from robolang.logs.log import Log
from robolang.project.project import load_project
from robolang.view import thinning
from robolang.view.page import Bundle, write_page
from robolang.view.plan_page import pack_plan
from robolang.view.replay import Replay
from robolang.view.run_page import pack_run
from runtime.core.units import MM
from tests.robolang.cli.commands import ROOT
from tests.robolang.view.browser import Tab, chromium
from tests.robolang.view.recorded import MadeLog, log, meta
from tests.robolang.view.test_page_browser import LINE, RUNNING, time_of

pytestmark = pytest.mark.physics

TURN = "(({w, x, y, z}) => [w, x, y, z])(robolang.viewer.stage.view.stages[0].model.bodies.get('part:part').quaternion)"
PICK = ROOT / "programs" / "pick_and_place.rbl"


@pytest.fixture(scope="module")
def browser():
    with chromium() as started:
        yield started


@pytest.fixture(scope="module")
def recorded():
    return run(PICK).log


@contextmanager
def pages(browser, folder):
    """Opens a page of packed runs, which has to be ready without a complaint and with one request."""
    tab = Tab(browser)

    def opened(*runs):
        write_page(folder / "page.html", runs, Bundle.installed())
        page = tab.open(folder / "page.html")
        assert tab.complaints == [] and len(tab.requests) == 1
        assert page.get_attribute("body", "data-state") == "ready"
        return page

    yield opened
    assert tab.complaints == [] and len(tab.requests) == 1
    tab.close()


@pytest.fixture
def shown(browser, tmp_path):
    with pages(browser, tmp_path) as opened:
        yield opened


@pytest.fixture(scope="module")
def page(browser, recorded, tmp_path_factory):
    """The page of the recorded run, opened once."""
    with pages(browser, tmp_path_factory.mktemp("run")) as opened:
        yield opened(pack_run(recorded, "a"))


PLACES = f"""(times) => times.map((t) => {{
  robolang.seek(t);
  return [robolang.bodyAt(0, 'tool'), robolang.bodyAt(0, 'part:part'), {TURN}];
}})"""


def places(page, ticks):
    """Tool point, part and its turn at some ticks."""
    return [[np.array(each) for each in found] for found in page.evaluate(PLACES, [tick * 0.001 for tick in ticks])]


def test_robot_and_part_of_the_page_are_where_the_log_has_them(page, recorded):
    ticks, X, parts = len(recorded["t"]), recorded["X_world_tool"], recorded["parts"]
    at = range(0, ticks, 16 * 13)
    for tick, (tool, part, _) in zip(at, places(page, at), strict=True):
        assert np.abs(tool - X[tick, :3, 3]).max() <= 0.01 * MM
        assert np.abs(part - parts[tick // 16, 0, :3]).max() <= 0.01 * MM
    # between two frames of the log: the part goes with the hand, as in a picture of `render`
    replay, most, at = Replay(recorded), 0.0, range(5, ticks - 16, 16 * 7 + 3)
    for tick, (_, part, turn) in zip(at, places(page, at), strict=True):
        pose = replay.at(tick * 0.001).parts[0]
        assert np.abs(part - pose[:3]).max() <= 0.01 * MM
        most = max(most, np.abs(parts[tick // 16, 0, :3] - pose[:3]).max())
        assert abs(np.dot(turn, pose[3:])) / np.linalg.norm(pose[3:]) == pytest.approx(1.0, abs=1e-8)
    assert most > 1.0 * MM  # where the frame before would be seen to be wrong
    carried = (parts[:, 0, :3].max(axis=0) - parts[:, 0, :3].min(axis=0)).max()
    assert carried > 0.1


def test_a_click_on_line_60_leads_to_its_start(page, recorded):
    (statement,) = [each for each in recorded.meta["report"]["statements"] if each["number"] == 60]
    page.click(LINE.format(statement["line"]))
    assert time_of(page) == pytest.approx(statement["start_s"], abs=1e-5)
    assert int(page.locator(RUNNING).get_attribute("data-line")) == statement["line"]
    assert "MOVE P2" in page.inner_text("[data-testid=now]")


def test_every_chart_of_the_run_is_in_the_page(page):
    ids = [each.get_attribute("data-signal") for each in page.locator("[data-testid=chart]").all()]
    assert {"tool_error", "joint_error", "torque_pct", "joints", "payload", "inertia", "age", "tool", "hand"} <= set(
        ids
    )


def test_two_runs_of_one_program_are_side_by_side(shown, recorded):
    page = shown(pack_run(recorded, "physics"), pack_run(run(PICK, physics=False).log, "ideal"))
    page.evaluate("robolang.seek(2)")
    one, two = (np.array(page.evaluate(f"robolang.bodyAt({k}, 'tool')")) for k in (0, 1))
    assert 0.0 < np.abs(one - two).max() < 5 * MM


def test_a_finding_of_a_plan_leads_to_its_place(shown, tmp_path):
    (tmp_path / "p.rbl").write_text("MOVE P2\nMOVE P1 + (0, 0, -30)\n")
    page = shown(planned(tmp_path / "p.rbl"))
    page.click("[data-testid=tab-notes]")
    note = page.locator("[data-testid=note]", has_text="RBL421")
    note.click()
    at = page.evaluate("robolang.runs[0].header.notes.find(n => n.code === 'RBL421').p")
    assert page.evaluate("robolang.bodyAt(0, 'tool')") == pytest.approx(at, abs=0.01 * MM)


def planned(path):
    from robolang.planning.motion_findings import findings
    from robolang.planning.path_coverage import explore

    project = load_project(path)
    explored = explore(project)
    found = findings(project, explored.rehearsal, None, explored.detours)
    return pack_plan(project, explored.rehearsal, found)


HOSTILE = "</script><img src=x onerror=window.hit=1><!--<script>"


def test_hostile_texts_of_a_run_do_nothing(shown, tmp_path):
    """In the program, in PRINT, in the name of the file and of a part."""
    name = "<img src=x onerror=window.hit=1>.rbl"
    (tmp_path / name).write_text(f'\' {HOSTILE}\nPRINT "<img src=x onerror=window.hit=1>"\nMOVE P1 + (0, 0, 120)\n')
    found = run(tmp_path / name, physics=False).log
    about = dict(found.meta)
    about["scene"] = renamed(about["scene"], "part:part", f"part:{HOSTILE}")
    page = shown(pack_run(Log(found.rows, about), f"{HOSTILE}\u2028\u202e\udcff\0"))
    page.click("[data-testid=tab-notes]")
    page.evaluate("robolang.seek(0.5)")
    assert page.evaluate("window.hit") is None
    assert page.evaluate("document.querySelectorAll('img, iframe, object').length") == 0


def renamed(value, old, new):
    if isinstance(value, dict):
        return {key: renamed(item, old, new) for key, item in value.items()}
    if isinstance(value, list):
        return [renamed(item, old, new) for item in value]
    return new if value == old else value


def test_a_value_over_a_chart_of_a_long_run_is_the_range_of_its_bin(shown, monkeypatch):
    monkeypatch.setattr(thinning, "MOST_ROWS", 100)
    made = log(1000, meta(scene=None))
    page = shown(pack_run(made, "a"))
    page.locator("[data-signal=tool_speed]").scroll_into_view_if_needed()
    page.locator("[data-signal=tool_speed] .u-over").wait_for()
    # bins of 20 ticks: the first and the second half of one say the same
    for tick in (301, 319):
        page.evaluate("t => robolang.seek(t)", tick * 0.001)
        speeds = made.arrays["tool_speed"][300:320] / MM
        least, most = (float(text) for text in page.inner_text("[data-signal=tool_speed] output").split(" .. "))
        assert (least, most) == pytest.approx((speeds.min(), speeds.max()), abs=1.0) and most > least


ODD = {
    "no tick": log(0, meta(scene=None)),
    "one tick": log(1, meta(scene=None)),
    "no angle": MadeLog(log(163).arrays | {"q_link": np.full((163, 3), math.nan)}, meta(scene=None)),
}


@pytest.mark.parametrize("name", ODD)
def test_odd_runs_are_shown(shown, name):
    page = shown(pack_run(ODD[name], "a"))
    page.keyboard.press("End")
    assert time_of(page) == pytest.approx(len(ODD[name]["t"]) * 0.001)


def test_a_run_that_ended_with_an_alarm_says_so(shown, tmp_path):
    (tmp_path / "p.rbl").write_text("MOVE P1 + (0, 0, 120)\nFOR k = 1 TO 3\n  x = 1 / (2 - k)\nNEXT k\n")
    found = run(tmp_path / "p.rbl", physics=False)
    page = shown(pack_run(found.log, "a"))
    assert found.alarms[0].code in page.inner_text("[data-testid=outcome]")
