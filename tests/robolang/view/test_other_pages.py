"""Pages of other runs in a browser: two runs, hostile texts, none of what a page usually has, paper, small screens.

What shows no robot is opened in a browser without 3D, in which a page is there in a third of the time.
"""

import numpy as np
import pytest

from tests.robolang.view import made_up
from tests.robolang.view.browser import SOFTWARE_GL, WITHOUT_GL, Tab, browsers
from tests.robolang.view.reaching import assert_all_can_be_reached
from tests.robolang.view.test_page_browser import DURATION_S, LINE, PICTURE, running, time_of, until


@pytest.fixture(scope="module")
def started():
    with browsers(SOFTWARE_GL, WITHOUT_GL) as both:
        yield both


@pytest.fixture(scope="module")
def browser(started):
    return started[0]


@pytest.fixture(scope="module")
def plain(started):
    return started[1]


def test_the_view_of_the_cell_is_the_first_one(browser, tmp_path):
    tab = Tab(browser)
    header, signals = made_up.run(DURATION_S)
    header["meta"]["scene"]["camera"] = {"position": [3.0, 1.0, 2.0], "target": [0.2, 0.0, 0.5]}
    page = tab.open(made_up.page(tmp_path / "camera.html", (header, signals)))
    place = "robolang.viewer.stage.view.camera.position.toArray()"
    assert page.evaluate(place) == pytest.approx([3.0, 1.0, 2.0])
    page.keyboard.press("4")
    assert page.evaluate(place) != pytest.approx([3.0, 1.0, 2.0])
    tab.close()


def test_a_plan_with_findings_counts_them(plain, tmp_path):
    tab = Tab(plain)
    header, signals = made_up.run(DURATION_S)
    header["kind"] = "plan"
    header["notes"] = [{**note, "severity": "warning"} for note in made_up.notes(DURATION_S)]
    page = tab.open(made_up.page(tmp_path / "plan.html", (header, signals)))
    assert page.inner_text("[data-testid=outcome]") == "Planned, 3 warnings"
    tab.close()


def test_charts_out_of_sight_are_not_built(plain, tmp_path):
    tab = Tab(plain)
    page = tab.open(made_up.page(tmp_path / "sight.html", made_up.run(DURATION_S)))
    until(page, "document.querySelectorAll('[data-testid=chart] .u-over').length > 0")
    assert page.locator("[data-testid=chart]").count() == len(made_up.charts())
    assert page.locator("[data-testid=chart] .u-over").count() < len(made_up.charts())
    tab.close()


def test_the_theme_follows_the_system(plain, tmp_path):
    tab = Tab(plain, color_scheme="dark")
    other = tab.open(made_up.page(tmp_path / "dark.html", made_up.run(DURATION_S)))
    assert other.evaluate("document.documentElement.dataset.theme") == "dark"
    tab.close()


def test_two_runs_stand_side_by_side(browser, tmp_path):
    tab = Tab(browser)
    runs = made_up.run(DURATION_S, label="scheduled"), made_up.run(3.2, label="fixed", phase=1.0)
    page = tab.open(made_up.page(tmp_path / "two.html", *runs))
    assert tab.complaints == []
    assert page.evaluate("robolang.runs.length") == 2
    words = page.inner_text("body")
    assert "scheduled" in words
    assert "fixed" in words
    page.evaluate("robolang.seek(1.0)")
    assert page.evaluate("robolang.bodyAt(0, 'tool')") != page.evaluate("robolang.bodyAt(1, 'tool')")
    assert " | " in page.inner_text("[data-signal=tool_error] output")
    tab.close()


HOSTILE = "</script><img src=x onerror=\"window.hit=1\"><svg onload='window.hit=1'>{{JS}}"


def test_hostile_names_and_texts_do_nothing(browser, tmp_path):
    tab = Tab(browser)
    run = made_up.run(DURATION_S, program=f"' {HOSTILE}\n" + made_up.PROGRAM, name=HOSTILE, part=HOSTILE, label=HOSTILE)
    header = run[0]
    header["notes"].append({"time_s": 1.0, "line": 1, "code": HOSTILE, "severity": "note", "text": HOSTILE})
    header["charts"][0]["title"] = header["joints"][0]["name"] = HOSTILE
    page = tab.open(made_up.page(tmp_path / "hostile.html", run))
    assert page.get_attribute("body", "data-state") == "ready"
    assert page.evaluate("window.hit") is None
    assert page.evaluate("document.querySelectorAll('img, svg, iframe').length") == 0
    assert HOSTILE in page.inner_text(LINE.format(1))
    assert tab.complaints == []
    assert len(tab.requests) == 1
    tab.close()


def test_two_programs_are_said_to_differ(plain, tmp_path):
    tab = Tab(plain)
    runs = made_up.run(DURATION_S, label="old"), made_up.run(DURATION_S, label="new", program="MOVE P1\n")
    page = tab.open(made_up.page(tmp_path / "texts.html", *runs))
    assert "new executed another text" in page.inner_text("header .remark")
    tab.close()


def test_after_the_end_of_the_shorter_run_it_has_no_value(plain, tmp_path):
    tab = Tab(plain)
    page = tab.open(made_up.page(tmp_path / "short.html", made_up.run(DURATION_S), made_up.run(1.6, label="short")))
    page.evaluate("robolang.seek(1.5)")
    value = "document.querySelector('[data-signal=tool_error] output').textContent"
    until(page, f"/ \\| [0-9]/.test({value})")
    page.evaluate("robolang.seek(3)")
    until(page, f"/[0-9] \\| –/.test({value})")
    tab.close()


@pytest.mark.parametrize("scene", [None, {"bodies": 3}, {**made_up.scene("part"), "shapes": [{"body": None}]}])
def test_without_a_scene_words_stand_for_the_robot(browser, tmp_path, scene):
    tab = Tab(browser)
    header, signals = made_up.run(DURATION_S)
    header["meta"]["scene"] = scene
    page = tab.open(made_up.page(tmp_path / "bare.html", (header, signals)))
    assert page.get_attribute("body", "data-state") == "ready"
    assert page.is_visible("[data-testid=no3d]")
    page.click(LINE.format(5))
    assert running(page) == 5
    tab.close()


def test_a_run_with_nothing_but_a_program_is_shown(browser, tmp_path):
    tab = Tab(browser)
    header, _ = made_up.run(DURATION_S)
    header |= {"charts": [], "notes": [], "joints": []}
    header["meta"]["report"] = {"statements": []}
    page = tab.open(made_up.page(tmp_path / "empty.html", (header, {})))
    assert page.get_attribute("body", "data-state") == "ready"
    assert tab.complaints == []
    page.keyboard.press("Space")
    page.keyboard.press("PageDown")
    page.keyboard.press("End")
    assert time_of(page) == pytest.approx(DURATION_S)
    tab.close()


def test_findings_of_one_place_have_one_name_in_space(browser, tmp_path):
    tab = Tab(browser)
    header, signals = made_up.run(DURATION_S)
    header["notes"] = [
        {"time_s": 1.0, "line": 5, "code": "RBL523", "severity": "warning", "text": str(k)} for k in range(900)
    ]
    page = tab.open(made_up.page(tmp_path / "many.html", (header, signals)))
    assert page.locator(".labels .warning").count() == 1
    assert page.locator("[data-testid=note]").count() == 900
    tab.close()


def test_a_thinned_run_says_so(plain, tmp_path):
    tab = Tab(plain)
    text = "thinned to one pair every 20 ms"
    page = tab.open(
        made_up.page(tmp_path / "long.html", made_up.run(DURATION_S, thinned={"every_s": 0.02, "text": text}))
    )
    assert text in page.inner_text("[data-testid=thinned]")
    tab.close()


def test_a_second_run_that_is_thinned_says_so_too(plain, tmp_path):
    tab = Tab(plain)
    thin = {"every_s": 0.02, "text": "thinned to one pair every 20 ms"}
    runs = made_up.run(DURATION_S), made_up.run(DURATION_S, label="second", thinned=thin)
    page = tab.open(made_up.page(tmp_path / "two.html", *runs))
    assert page.inner_text("[data-testid=thinned]") == "second: thinned to one pair every 20 ms"
    page = tab.open(made_up.page(tmp_path / "none.html", runs[0]))
    assert not page.locator("[data-testid=thinned]").is_visible()
    tab.close()


COLOURS = """[...robolang.viewer.stage.view.stages[0].path.line.geometry.attributes.instanceColorEnd.data.array]"""


def test_no_peak_of_the_error_is_without_its_colour_on_the_path(browser, tmp_path):
    """The peak is of one tick, between two rows of the tool point and after the last one."""
    tab = Tab(browser)
    for tick in (2003, round(DURATION_S * 1000) - 1):
        header, signals = made_up.run(DURATION_S)
        signals["tool_error"][tick] = 0.01
        page = tab.open(made_up.page(tmp_path / "peak.html", (header, signals)))
        last = page.evaluate("getComputedStyle(document.documentElement).getPropertyValue('--ramp-4')").strip()
        shares = np.array([int(last[k : k + 2], 16) / 255 for k in (1, 3, 5)])
        linear = np.where(shares <= 0.04045, shares / 12.92, ((shares + 0.055) / 1.055) ** 2.4)
        away = np.abs(np.array(page.evaluate(COLOURS)).reshape(-1, 3) - linear).max(axis=1)
        assert away.min() == pytest.approx(0.0, abs=1e-3) and np.median(away) > 0.1
    tab.close()


def test_a_long_program_has_only_the_shown_lines_as_elements(plain, tmp_path):
    tab = Tab(plain)
    program = made_up.PROGRAM + "\n".join(f"' line {k}" for k in range(10, 20_010))
    page = tab.open(made_up.page(tmp_path / "text.html", made_up.run(DURATION_S, program=program)))
    assert page.locator("[data-testid=line]").count() < 200
    page.evaluate("document.querySelector('[data-testid=program]').scrollTop = 1e9")
    page.wait_for_selector(LINE.format(20_009))
    page.evaluate("robolang.seek(0.4)")
    assert running(page) == 4
    tab.close()


def test_data_that_cannot_be_read_are_said_to_be(plain, tmp_path):
    tab = Tab(plain)
    path = made_up.page(tmp_path / "torn.html", made_up.run(DURATION_S))
    text = path.read_text("utf-8")
    at = text.index('data-run="0">') + 4000
    path.write_text(text[:at] + "AAAA" + text[at + 4000 :], "utf-8")
    page = tab.open(path)
    assert page.get_attribute("body", "data-state") == "failed"
    assert page.is_visible("[role=alert]")
    tab.close()


def test_without_webgl_words_stand_for_the_robot_and_the_rest_works(plain, tmp_path):
    tab = Tab(plain)
    page = tab.open(made_up.page(tmp_path / "words.html", made_up.run(DURATION_S)))
    assert page.get_attribute("body", "data-state") == "ready"
    assert "WebGL" in page.inner_text("[data-testid=no3d]")
    page.click(LINE.format(5))
    assert running(page) == 5
    assert page.locator("[data-signal=tool_error] .u-over").count() == 1
    tab.close()


def test_paper_gets_every_chart_the_whole_text_and_a_picture(browser, tmp_path):
    tab = Tab(browser, color_scheme="dark")
    page = tab.open(made_up.page(tmp_path / "paper.html", made_up.run(DURATION_S)))
    page.emulate_media(media="print")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert page.evaluate("document.documentElement.dataset.theme") == "light"
    assert page.locator("[data-testid=chart] .u-over").count() == len(made_up.charts())
    assert page.locator("img.snapshot").get_attribute("src").startswith("data:image/png;base64,")
    assert all(
        page.is_visible(f"[data-testid={name}]") for name in ("program", "notes", "joints", "timeline", "outcome")
    )
    assert not page.is_visible("[data-testid=play]")
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"
    assert tab.complaints == []
    tab.close()


def test_every_button_can_be_reached_and_is_covered_by_nothing(browser, tmp_path):
    tab = Tab(browser)
    page = tab.open(made_up.page(tmp_path / "run.html", made_up.run(DURATION_S)))
    assert_all_can_be_reached(page, 15)
    # of a small picture as little as possible is covered
    page.set_viewport_size({"width": 800, "height": 500})
    page.evaluate("document.querySelector('.ramp small:last-child').textContent = '0.088 mm'")
    assert page.locator("[data-testid=legend]").bounding_box()["height"] < 40
    tab.close()


def test_a_page_begins_at_the_first_line_also_where_another_one_runs_first(plain, tmp_path):
    tab = Tab(plain)
    header, signals = made_up.run(DURATION_S)
    # longer than its panel
    header["meta"]["program"]["text"] += "\n" * 100
    page = tab.open(made_up.page(tmp_path / "first.html", (header, signals)))
    assert running(page) > 1
    assert page.evaluate("document.querySelector('.program').scrollTop") == 0
    tab.close()


def test_a_narrow_page_has_everything_one_under_another(browser, tmp_path):
    tab = Tab(browser, width=390, height=844)
    page = tab.open(made_up.page(tmp_path / "phone.html", made_up.run(DURATION_S)))
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    tops = [
        page.locator(f"[data-testid={name}]").bounding_box()["y"] for name in ("stage", "timeline", "program", "charts")
    ]
    assert tops == sorted(tops)
    page.click(LINE.format(4))
    assert running(page) == 4
    tab.close()


def test_a_view_with_less_work_still_shows_the_robot(browser, tmp_path):
    tab = Tab(browser, width=320, height=400)
    page = tab.open(made_up.page(tmp_path / "fine.html", made_up.run(DURATION_S)), mark="")
    before = page.evaluate(PICTURE)
    page.evaluate("robolang.viewer.stage.view.simplify()")
    after = page.evaluate(PICTURE)
    assert after != before
    page.evaluate("robolang.seek(3)")
    assert page.evaluate(PICTURE) != after
    assert tab.complaints == []
    tab.close()
