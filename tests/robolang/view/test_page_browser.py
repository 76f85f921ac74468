"""The page of a run in a browser, without network and with software rendering: what a person does with it."""

import numpy as np
import pytest

from tests.robolang.view import made_up
from tests.robolang.view.browser import Tab, chromium

DURATION_S = 4.8
LINE = "[data-testid=line][data-line='{}']"
RUNNING = "[data-testid=line][aria-current=true]"


@pytest.fixture(scope="module")
def browser():
    with chromium() as started:
        yield started


@pytest.fixture(scope="module")
def first(browser, tmp_path_factory):
    """The page of one run, opened once."""
    tab = Tab(browser)
    tab.open(made_up.page(tmp_path_factory.mktemp("page") / "run.html", made_up.run(DURATION_S)))
    yield tab
    tab.close()


@pytest.fixture
def page(first):
    """The page at its start, showing the whole run."""
    first.page.evaluate("robolang.pause(); robolang.viewer.player.zoom(); robolang.seek(0)")
    return first.page


def time_of(page):
    return page.evaluate("robolang.t")


def running(page):
    return int(page.locator(RUNNING).get_attribute("data-line"))


def until(page, condition, *values):
    """Wait until a condition holds. The policy of the page refuses the text that Playwright's own waiting evaluates."""
    for _ in range(200):
        if page.evaluate(condition, *values):
            return
        page.wait_for_timeout(25)
    pytest.fail(f"not within five seconds: {condition}")


def centre(page, selector, x=0.5, y=0.5):
    box = page.locator(selector).bounding_box()
    return box["x"] + box["width"] * x, box["y"] + box["height"] * y


def test_the_page_loads_nothing_and_complains_about_nothing(first, page):
    assert page.get_attribute("body", "data-state") == "ready"
    assert len(first.requests) == 1
    assert first.complaints == []


def test_a_line_leads_to_its_start_and_a_loop_to_its_next_execution(page):
    begins = [one["start_s"] for one in made_up.statements(DURATION_S) if one["line"] == 5]
    for expected in [*begins, begins[0]]:
        page.click(LINE.format(5))
        assert time_of(page) == pytest.approx(expected, abs=1e-6)
        assert running(page) == 5
    assert "MOVE P2" in page.inner_text("[data-testid=now]")


def test_a_line_without_duration_is_named_although_the_next_one_starts_with_it(page):
    page.click(LINE.format(2))
    assert time_of(page) == pytest.approx(1.6)
    assert running(page) == 2
    assert "LOAD" in page.inner_text("[data-testid=now]")


def test_a_line_of_a_loop_shows_count_and_total(page):
    text = page.inner_text(LINE.format(3))
    assert "3 ×" in text
    assert "0.96 s" in text


def test_a_click_in_the_timeline_names_the_running_line(page):
    page.mouse.click(*centre(page, "[data-testid=timeline]", 0.55, 0.3))
    assert time_of(page) == pytest.approx(0.55 * DURATION_S, abs=0.01)
    assert running(page) == 6
    x = centre(page, "[data-testid=timeline]", 1.6 / DURATION_S, 0.3)
    page.mouse.click(*x)
    assert running(page) == 2


def test_a_click_in_a_chart_leads_to_its_time(page):
    page.mouse.click(*centre(page, "[data-signal=tool_error] .u-over", 0.9))
    assert time_of(page) == pytest.approx(0.9 * DURATION_S, abs=0.02)


def test_dragging_zooms_all_charts_once_and_a_double_click_shows_the_whole_run(page):
    page.evaluate("robolang.seek(1)")
    plot = "[data-signal=tool_error] .u-over"
    page.mouse.move(*centre(page, plot, 0.2))
    page.mouse.down()
    page.mouse.move(*centre(page, plot, 0.4), steps=4)
    page.mouse.up()
    low, high = page.evaluate("robolang.range")
    assert (low, high) == pytest.approx((0.2 * DURATION_S, 0.4 * DURATION_S), abs=0.03)
    assert time_of(page) == pytest.approx(1.0)
    page.mouse.dblclick(*centre(page, plot))
    assert page.evaluate("robolang.range") == [0, DURATION_S]


def test_playing_advances_the_time_and_space_pauses(page):
    page.click("[data-testid=play]")
    until(page, "robolang.t > 0.3")
    page.keyboard.press("Space")
    assert page.evaluate("robolang.playing") is False
    stood = time_of(page)
    page.wait_for_timeout(60)
    assert time_of(page) == stood


def test_keys_step_by_cycles_and_statements(page):
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("ArrowRight")
    assert time_of(page) == pytest.approx(0.008)
    page.keyboard.press("Shift+ArrowRight")
    assert time_of(page) == pytest.approx(0.108)
    page.keyboard.press("PageDown")
    assert running(page) == 4
    page.keyboard.press("End")
    assert time_of(page) == pytest.approx(DURATION_S)
    page.keyboard.press("Home")
    assert time_of(page) == 0.0


def test_lines_are_walked_and_entered_by_keys(page):
    page.click(LINE.format(3))
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    assert running(page) == 4
    assert page.locator("[data-testid=line][tabindex='0']").count() == 1


def test_the_name_of_a_button_contains_what_it_shows(page):
    named = page.evaluate(
        """() => [...document.querySelectorAll("button, [role=button], [role=tab], select, input")].map((one) =>
            [one.getAttribute("aria-label") ?? "",
             one.matches("select, input") ? (one.closest("label")?.textContent ?? "") : one.textContent,
             one.title])"""
    )
    assert len(named) > 30
    for label, shown, title in named:
        assert not label or shown.strip().lower() in label.lower()
        assert label or shown.strip() or title


def test_steps_between_whole_numbers_have_no_digits(page):
    assert "." in page.inner_text("[data-signal=tool_error] output")
    page.evaluate("document.querySelector('[data-signal=io]').scrollIntoView()")
    until(page, "document.querySelector('[data-signal=io] .u-over') !== null")
    assert page.inner_text("[data-signal=io] output") in ("0", "1")
    page.evaluate("document.querySelector('[data-signal=tool_error]').scrollIntoView()")


def test_help_opens_and_closes_by_key(page):
    page.keyboard.press("?")
    assert page.is_visible("[data-testid=help]")
    page.keyboard.press("Escape")
    assert not page.is_visible("[data-testid=help]")


def test_the_scene_moves_as_the_signals_say(page):
    """The nesting of bodies against the kinematics of the made-up arm, m."""
    signals = made_up.run(DURATION_S)[1]
    for k in range(0, len(signals["q_link"]), 397):
        page.evaluate("t => robolang.seek(t)", k * made_up.TICK_S)
        found = page.evaluate("robolang.bodyAt(0, 'tool')")
        assert found == pytest.approx(made_up.tool_point(signals["q_link"][[k]])[0], abs=1e-6)


def test_the_part_moves_with_its_recorded_pose(page):
    page.evaluate("robolang.seek(1.6)")
    expected = made_up.run(DURATION_S)[1]["parts"][100, :3]
    assert page.evaluate("robolang.bodyAt(0, 'part:part')") == pytest.approx(expected, abs=1e-6)


PICTURE = "robolang.viewer.stage.view.picture()"
"""The drawn robot alone, without the names and the panels above it."""


def test_the_picture_changes_with_the_time_and_only_with_it(page):
    shots = []
    for t in (0.5, 3.0, 0.5):
        page.evaluate("t => robolang.seek(t)", t)
        shots.append(page.evaluate(PICTURE))
    assert shots[0] != shots[1]
    assert shots[0] == shots[2]


@pytest.mark.parametrize("name", ["tool_error", "gap", "constant", "nothing", "levels", "q_cmd"])
def test_columns_are_decoded_to_a_step_of_their_range(page, name):
    expected = made_up.run(DURATION_S)[1][name]
    found = page.evaluate(
        "name => robolang.runs[0].signals.get(name).columns.map(c => Array.from(c, v => isNaN(v) ? null : v))", name
    )
    found = np.array(found, dtype=float).T
    assert np.array_equal(np.isnan(found), np.isnan(expected))
    span = np.nanmax(expected) - np.nanmin(expected) if not np.isnan(expected).all() else 0.0
    assert np.allclose(found, expected, rtol=1e-6, atol=1e-6 * span, equal_nan=True)


def test_a_bin_keeps_its_least_and_largest_value_and_a_gap(page):
    rows, bins = 4000, 100
    values = np.random.default_rng(7).standard_normal(rows).astype(np.float32)
    values[1000:2000] = np.nan
    t, y = page.evaluate(
        """([values, bins]) => {
            const all = Float32Array.from(values, (value) => value ?? NaN);
            const made = robolang.thin(all, 0, all.length, bins, (row) => row);
            return [Array.from(made.t), made.y];
        }""",
        [[None if np.isnan(value) else float(value) for value in values], bins],
    )
    assert t == sorted(t)
    found = np.array(y, dtype=np.float32).reshape(bins, 2)
    for bin_, pair in zip(values.reshape(bins, -1), found, strict=True):
        if np.isnan(bin_).all():
            assert np.isnan(pair).all()
        else:
            first, second = sorted((np.argmin(bin_), np.argmax(bin_)))
            assert list(pair) == [bin_[first], bin_[second]]


def test_a_name_over_a_chart_hides_its_curve(page):
    chip = page.locator("[data-signal=joint_error] .chip").first
    chip.click()
    assert chip.get_attribute("aria-pressed") == "false"
    chip.click()
    assert chip.get_attribute("aria-pressed") == "true"


def test_notes_stand_in_text_and_list_and_lead_to_their_place(page):
    assert "RBL501" in page.inner_text(LINE.format(5))
    page.click("[data-testid=tab-notes]")
    assert page.locator("[data-testid=note]").count() == len(made_up.notes(DURATION_S))
    page.locator("[data-testid=note]").last.click()
    assert time_of(page) == pytest.approx(0.6 * DURATION_S)
    page.click("[data-testid=tab-program]")


def test_joints_show_their_value_and_lead_to_their_least_margin(page):
    page.click("[data-testid=tab-joints]")
    page.locator("[data-testid=joints] button.margin").first.click()
    assert time_of(page) == pytest.approx(1.5)
    angle = np.degrees(made_up.run(DURATION_S)[1]["q_link"][1500, 0])
    until(page, "text => document.querySelector('.joint .value').textContent === text", f"{angle:.2f} deg")
    page.click("[data-testid=tab-program]")


def test_the_error_of_the_path_can_be_drawn_larger(page):
    before = page.evaluate(PICTURE)
    for _ in range(3):
        page.keyboard.press("e")
    assert "500" in page.evaluate("document.querySelector('.legend select').selectedOptions[0].textContent")
    assert page.evaluate(PICTURE) != before
    page.keyboard.press("e")
    assert page.evaluate(PICTURE) == before


@pytest.mark.parametrize("key,view", [("2", "front"), ("3", "side"), ("4", "top"), ("1", "iso")])
def test_views_have_keys_and_say_which_is_shown(page, key, view):
    page.keyboard.press(key)
    assert page.locator("[data-view][aria-pressed=true]").get_attribute("data-view") == view


def test_the_theme_switches(page):
    page.click("button.theme")
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"
    page.click("button.theme")
    assert page.evaluate("document.documentElement.dataset.theme") == "light"
