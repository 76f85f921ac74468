"""The live page in a browser: what it sends when buttons are pressed and released, and what the arm does then."""

import json
import math
from contextlib import contextmanager, suppress

import pytest
from playwright.sync_api import TimeoutError

from robolang.project.project import load_project
from robolang.view.beside import LiveBeside
from robolang.view.live_page import live_page
from robolang.view.page import Bundle
from tests.programs.test_scara import CELL as SLIDING
from tests.ready import Piped
from tests.robolang.pendant.prompting import prompt
from tests.robolang.view.browser import PATIENCE_MS, WITHOUT_GL, chromium
from tests.robolang.view.reaching import assert_all_can_be_reached
from tests.steps import HANG_S

TRIALS = 10
A_WHILE_MS = 4000
POLL_MS = 50
A_MOMENT_MS = 300
"""Enough for what a page sends by itself."""
PROGRAM = """MOVEJ HERE + (0, 0, 20)
MOVE HERE + (0, 0, 60), SPEED 400
MOVE HERE + (0, 0, -60), SPEED 400
PRINT "<img src=x onerror=alert(1)>"
"""


class LivePage:
    """A page of ``robolang view``, with all that it asks for and complains about."""

    def __init__(self, browser, url, mark="#plain"):
        self.page = browser.new_page(viewport={"width": 1400, "height": 900})
        self.requests, self.complaints = [], []
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.sent = []
        """The words and fields of the commands that the page has sent."""
        self.page.on("websocket", lambda it: it.on("framesent", lambda text: self.sent.append(json.loads(text))))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("console", lambda message: self.complaints.append(f"{message.type}: {message.text}"))
        self.page.goto(url + mark)
        self.page.wait_for_selector("body:not([data-state=loading])", timeout=PATIENCE_MS)

    def __getitem__(self, name):
        return self.page.get_by_test_id(name)

    def waits_for(self, state):
        """Wait until the strip shows a state."""
        self.page.wait_for_selector(f"[data-testid=state]:has-text('{state}')", timeout=PATIENCE_MS)

    def run_is(self, state):
        self.page.wait_for_selector(f"body[data-run={state}]", timeout=PATIENCE_MS)

    def q(self):
        return self.page.evaluate(
            "(() => { const s = window.robolang.runs[0].signals.get('q_link'); "
            "return s.columns.map((column) => column[s.rows - 1]); })()"
        )

    def rests(self):
        """Joint angles once they no longer change."""
        self.waits_for("Paused")
        return self.q()


@pytest.fixture(scope="module")
def browser():
    # text and buttons alone: a page that draws the arm with this computer's processor stalls by itself
    with chromium(WITHOUT_GL) as found:
        yield found


@contextmanager
def viewed(program, *words):
    process = Piped(["view", program, "--no-physics", "--no-browser", *words])
    try:
        yield process.stderr.readline().split()[-1], process
    finally:
        process.kill()
        process.communicate()


def written(folder):
    path = folder / "p.rbl"
    path.write_text(PROGRAM)
    return path


@pytest.fixture
def program(tmp_path):
    return written(tmp_path)


@pytest.fixture(scope="module")
def served(browser, tmp_path_factory):
    """One process for all tests that leave its program paused; its address and its program."""
    program = written(tmp_path_factory.mktemp("served"))
    with viewed(program) as (url, _):
        yield url, program


@pytest.fixture
def live(browser, served):
    """A page of its own, which is alone and therefore has control."""
    page = LivePage(browser, served[0])
    page.waits_for("Paused")
    page.page.wait_for_selector("[data-testid=start]:enabled", timeout=PATIENCE_MS)
    yield page
    for each in (each for context in browser.contexts for each in context.pages):
        each.close()


def test_a_program_is_run_from_the_page(browser, program):
    with viewed(program, "--speed", "5") as (url, process):
        live = LivePage(browser, url)
        live.waits_for("Paused")
        assert live.page.evaluate("document.body.dataset.state") == "ready"
        # the token is neither in the address bar nor in what the page asks for besides itself and its socket
        assert "token" not in live.page.url
        assert len(live.requests) == 1
        live["start"].click()
        live.run_is("done")
        assert live["printed"].inner_text() == "<img src=x onerror=alert(1)>"
        lines = live.page.evaluate("window.robolang.runs[0].statements.all.map((one) => one.line)")
        assert lines == [1, 2, 3, 4]
        rows = live.page.evaluate("window.robolang.runs[0].signals.get('q_link').rows")
        assert rows > 50
        assert live.page.evaluate("document.querySelector('.line[data-line=\"2\"]').classList.contains('ran')")
        live["end"].click()
        live.run_is("over")
        assert process.wait(HANG_S) == 0
        # it keeps what it has shown
        assert live.page.evaluate("window.robolang.runs[0].signals.get('q_link').rows") >= rows
        assert [each for each in live.complaints if "WebGL" not in each] == []


def test_a_live_page_says_that_its_charts_are_sampled_and_how_few_rows_it_keeps(live):
    assert live["thinned"].is_hidden()
    assert live["sampled"].count() == 1
    units = live.page.locator("[data-testid=chart] .unit").all_inner_texts()
    assert units and all("sampled" in unit for unit in units)
    live.page.evaluate("robolang.runs[0].halve(); robolang.viewer.grew()")
    assert live["thinned"].is_visible() and "32 ms" in live["thinned"].inner_text()


def test_every_button_can_be_reached_and_is_covered_by_nothing(live):
    assert_all_can_be_reached(live.page, 40, ["pause", "stop"])


SAY = """([long, longer]) => {
  document.querySelector("[data-testid=problem]").textContent = long;
  document.querySelector("[data-testid=pendant-said]").textContent = longer;
}"""


def test_long_messages_cover_no_button_and_do_not_move_the_one_that_is_held(live):
    live.page.set_viewport_size({"width": 1000, "height": 700})
    before = live["jog-Z+"].bounding_box()
    live.page.evaluate(SAY, ["", "a message of two lines " * 8])
    assert live["jog-Z+"].bounding_box() == before
    live.page.evaluate(SAY, ["an alarm of two lines " * 9, "a message of two lines " * 8])
    assert_all_can_be_reached(live.page, 40, ["pause", "stop"])


def test_an_alarm_is_shown_until_it_is_acknowledged_and_stays_in_the_notes(browser, program):
    program.write_text("MOVEJ HERE + (0, 0, 20)\nMOVE HERE + (5000, 0, 0)\n")
    with viewed(program, "--speed", "5") as (url, _):
        live = LivePage(browser, url)
        live.waits_for("Paused")
        live["start"].click()
        live.run_is("alarm")
        said = live["problem"].inner_text()
        code = said.split()[0]
        assert code.startswith("RBL")
        live["override"].fill("40")
        live["override"].dispatch_event("change")
        live.page.wait_for_selector("output:has-text('40 %')", timeout=PATIENCE_MS)
        assert live["problem"].inner_text() == said
        flag = f".line[data-line='2'] .flag.error:has-text('{code}')"
        assert live.page.locator(flag).count() == 1
        live["tab-notes"].click()
        assert code in live["note"].inner_text()
        live["reset"].click()
        live.page.wait_for_selector("[data-testid=problem]:empty", state="attached", timeout=PATIENCE_MS)
        assert live.page.locator(flag).count() == 1


SQUEEZED = """() => [...document.querySelectorAll(".chip")].filter(
  (chip) => chip.scrollWidth > chip.clientWidth + 1 || chip.querySelector(".name").scrollWidth > 110
).map((chip) => chip.innerText)"""


def test_a_page_that_comes_late_shows_nothing_for_the_time_before(browser, program):
    with viewed(program, "--speed", "5") as (url, _):
        live = LivePage(browser, url)
        live.waits_for("Paused")
        live["start"].click()
        live.run_is("done")
        # before the charts have grown once more
        live.page.wait_for_timeout(500)
        assert live.page.evaluate(SQUEEZED) == []
        assert live["unknown"].is_hidden()
        late = LivePage(browser, url)
        late.page.wait_for_selector("[data-testid=chart] output:not(:has-text('–'))", timeout=PATIENCE_MS)
        slider = late.page.evaluate("(({ value, max }) => [value, max])(document.querySelector('[data-testid=scrub]'))")
        assert float(slider[0]) > 0 and slider[0] == slider[1]
        assert "following" in late.page.get_attribute("#app", "class")
        late.page.evaluate("robolang.seek(0.01)")
        assert late["unknown"].is_visible()
        assert "following" not in late.page.get_attribute("#app", "class")
        late.page.wait_for_selector("[data-testid=chart] output:has-text('–')", timeout=PATIENCE_MS)
        late["tab-joints"].click()
        assert set(late.page.locator(".joint .value").all_inner_texts()) == {"–"}
        late.page.evaluate("robolang.seek(1e9)")
        assert late["unknown"].is_hidden()
        late.page.wait_for_selector(".joint .value:has-text('–')", state="detached", timeout=PATIENCE_MS)


ADD = """(times) => {
  const [run] = robolang.runs;
  const filled = (t) => new Map([...run.signals].map(([name, { columns }]) => [name, columns.map(() => t)]));
  for (const t of times) run.add({ t, values: filled(t) });
}"""


def test_frames_far_apart_are_not_joined(live):
    live.page.evaluate(ADD, [1.0, 1.05, 2.0, 2.05, 2.1])
    times = [0.5, 1.02, 1.5, 1.9, 2.03]
    q = live.page.evaluate("(times) => times.map((t) => robolang.runs[0].signals.get('q_link').at(0, t))", times)
    assert q == pytest.approx([math.nan, 1.02, math.nan, math.nan, 2.03], abs=0.02, nan_ok=True)
    known = live.page.evaluate("(times) => times.map((t) => robolang.runs[0].recorded(t))", times)
    # the last frame before each
    assert known == pytest.approx([0.0, 1.02, 1.05, 1.05, 2.03], abs=0.02)


def test_a_step_goes_to_the_next_line(live):
    for line in (2, 3):
        live["step"].click()
        live.page.wait_for_selector(f".line.due[data-line='{line}']", timeout=PATIENCE_MS)


def press(page, name):
    """Press a button with the mouse and wait until the arm moves; it would go on for more than a minute."""
    page["jog-speed"].select_option("1")
    page[name].hover()
    held(page, page.page.mouse.down, page.page.mouse.up)


def held(page, down, up):
    """Hold something until the arm moves: on a busy machine the page may stall for the dead-man, so that it has ended
    before it is seen; then once more."""
    for _ in range(TRIALS):
        down()
        with suppress(TimeoutError):
            page.page.wait_for_selector("[data-testid=state]:has-text('Jog')", timeout=A_WHILE_MS)
            return
        up()
    raise AssertionError("the arm does not move")


def test_a_jog_lasts_while_its_button_is_pressed(live):
    before = live.q()
    # on a busy machine the page may stall for the dead-man before the first cycle of the jog; then once more
    for _ in range(TRIALS):
        press(live, "jog-Z+")
        # at 1 % of the speed the first cycles move less than a frame can show
        live.page.wait_for_timeout(500)
        live.page.mouse.up()
        if live.rests() != before:
            return
    raise AssertionError("the arm has not moved")


RELEASES = {
    "blur": "window.dispatchEvent(new Event('blur'))",
    "hidden": "Object.defineProperty(document, 'hidden', { value: true, configurable: true });"
    "document.dispatchEvent(new Event('visibilitychange'))",
    "pointercancel": "document.querySelector('[data-testid=\"jog-Z+\"]').dispatchEvent(new Event('pointercancel'))",
    "lost capture": "document.querySelector('[data-testid=\"jog-Z+\"]').dispatchEvent(new Event('lostpointercapture'))",
    "page left": "window.dispatchEvent(new Event('pagehide'))",
    "stalled": "(() => { const end = performance.now() + 1500; while (performance.now() < end); })()",
}


def test_a_jog_ends_however_its_button_is_lost(live):
    for how in RELEASES.values():
        press(live, "jog-Z+")
        live.page.evaluate(how)
        # the mouse button stays down: nothing else ends the jog
        live.waits_for("Paused")
        live.page.mouse.up()


def test_a_jog_by_the_keyboard_lasts_while_the_key_is_down(live):
    live["jog-speed"].select_option("1")
    live["jog-Z+"].focus()
    held(live, lambda: live.page.keyboard.down("Enter"), lambda: live.page.keyboard.up("Enter"))
    live.page.keyboard.up("Enter")
    live.waits_for("Paused")
    held(live, lambda: live.page.keyboard.down(" "), lambda: live.page.keyboard.up(" "))
    live.page.keyboard.press("Escape")
    live.waits_for("Paused")


def test_a_second_button_is_held_by_its_first_press(live):
    press(live, "jog-Z+")
    live.page.mouse.up()
    live.waits_for("Paused")
    # the button that was pressed before loses the focus to this one
    for name in ("jog-Y+", "jog-X-"):
        live.sent.clear()
        live[name].hover()
        live.page.mouse.down()
        live.page.wait_for_timeout(A_MOMENT_MS)
        begun = [each["id"] for each in live.sent if each["do"] == "jog"]
        released = [each for each in live.sent if each["do"] == "release"]
        live.page.mouse.up()
        assert (len(begun), released) == (1, [])
        # by its release, or where this computer is too busy by the dead-man
        live.waits_for("Paused")


def test_keys_move_the_override_while_it_has_the_focus(live):
    live["override"].fill("50")
    live["override"].focus()
    live.page.evaluate("robolang.seek(0)")
    live.sent.clear()
    for key in ("ArrowLeft", "PageUp", "ArrowRight", "Home", "End"):
        live.page.keyboard.press(key)
    live.page.wait_for_timeout(A_MOMENT_MS)
    overrides = [each["percent"] for each in live.sent if each["do"] == "override"]
    assert overrides == [49, 59, 60, 1, 100]
    assert live["override"].input_value() == "100"
    assert "following" not in live.page.get_attribute("#app", "class")


def test_a_speed_of_the_command_line_is_one_of_those_of_the_page(browser, program):
    with viewed(program, "--speed", "0.2") as (url, _):
        live = LivePage(browser, url)
        live.waits_for("Paused")
        assert live["pace"].input_value() == "0.2"
        live["pace"].select_option("0.25")
        live.page.wait_for_timeout(A_MOMENT_MS)
        assert live.sent[-1]["factor"] == 0.25
        assert live["pace"].input_value() == "0.25"


def test_a_step_jog_is_of_its_size(live, served):
    live["jog-frame"].select_option("joint")
    live["jog-angular"].select_option("5")
    for _ in range(TRIALS):
        before = live.q()
        with suppress(TimeoutError):
            live["jog-J1+"].click()
            live.page.wait_for_selector("[data-testid=state]:has-text('Jog')", timeout=A_WHILE_MS)
        moved = live.rests()[0] - before[0]
        if moved == pytest.approx(0.0872665, abs=1e-4):
            break
    assert moved == pytest.approx(0.0872665, abs=1e-4)
    live["teach-name"].fill("P77")
    live["teach"].click()
    live.page.wait_for_selector("[data-testid=pendant-said]:has-text('P77')", timeout=PATIENCE_MS)
    assert load_project(served[1]).points.get("P77") is not None
    live["teach"].click()
    live["replace"].click(timeout=PATIENCE_MS)
    live.page.wait_for_selector("[data-testid=pendant-said]:not(.refused):has-text('P77')", timeout=PATIENCE_MS)


def test_a_joint_that_slides_goes_by_the_steps_of_mm(browser, tmp_path):
    (tmp_path / "p.rbl").write_text("MOVEJ HERE\n")
    (tmp_path / "p.cell.toml").write_text(SLIDING.read_text())
    with viewed(tmp_path / "p.rbl") as (url, _):
        live = LivePage(browser, url)
        live.waits_for("Paused")
        assert "slide" in live["jog-linear"].get_attribute("aria-label")
        live["jog-frame"].select_option("joint")
        live["jog-linear"].select_option("10")
        live["jog-angular"].select_option("5")
        for axis in ("J3", "J4"):
            live.page.wait_for_selector(f"[data-testid='jog-{axis}+']:enabled", timeout=PATIENCE_MS)
            live[f"jog-{axis}+"].click()
            live.waits_for("Paused")
        steps = {each["axis"]: each["step"] for each in live.sent if each["do"] == "jog"}
        assert steps == {"J3": 10, "J4": 5}


STALLS = "(() => { const end = performance.now() + 1000; while (performance.now() < end); })()"


def test_what_was_said_of_a_jog_goes_with_the_next_command(live):
    live["jog-linear"].select_option("100")
    press(live, "jog-Z+")
    live.page.evaluate(STALLS)
    live.page.mouse.up()
    said = live["pendant-said"]
    live.page.wait_for_selector("[data-testid=pendant-said].refused:has-text('of 100 mm')", timeout=A_WHILE_MS)
    live["override"].press("Home")
    assert said.inner_text() == ""
    live["override"].press("End")
    live["teach-name"].fill("1P")
    live["teach"].click()
    live.page.wait_for_selector("[data-testid=pendant-said].refused:has-text('RBL')", timeout=A_WHILE_MS)
    live["teach-name"].fill("P1")
    live["teach"].click()
    live["replace"].wait_for(state="visible", timeout=A_WHILE_MS)
    live.page.keyboard.press("Escape")
    assert (said.inner_text(), live["replace"].is_visible()) == ("", False)


def test_a_stop_in_a_jog_is_of_no_line_and_the_page_says_where_the_program_goes_on(browser, program):
    with viewed(program) as (url, _):
        live = LivePage(browser, url)
        live.waits_for("Paused")
        for line in (2, 3):
            live["step"].click()
            live.page.wait_for_selector(f".line.due[data-line='{line}']", timeout=A_WHILE_MS)
        flags = live.page.locator(".line .flag")
        before = flags.all_inner_texts()
        press(live, "jog-Z+")
        live["stop"].dispatch_event("click")
        live.page.mouse.up()
        live.run_is("stopped")
        live["reset"].click()
        live.waits_for("Stopped at line 3")
        assert live.page.locator(".line.due").get_attribute("data-line") == "3"
        assert live["start"].is_enabled()
        assert flags.all_inner_texts() == before
        live["tab-notes"].click()
        note = live["note"].filter(has_text="RBL530").inner_text()
        assert "jog Z +" in note and "line" not in note
        live["restart"].click()
        live.waits_for("Paused")


def test_a_second_page_stops_a_jog_watches_and_takes_over_by_hand(live, served, browser):
    url, _ = served
    press(live, "jog-Z+")
    second = LivePage(browser, url)
    live.waits_for("Paused")
    live.page.mouse.up()
    second.waits_for("Paused")
    assert second["start"].is_disabled()
    assert second["jog-Z+"].is_disabled()
    live["give"].click()
    second["take"].click(timeout=PATIENCE_MS)
    second["jog-Z+"].click(timeout=PATIENCE_MS)
    live.page.wait_for_selector("[data-testid=jog-Z\\+]:disabled", timeout=PATIENCE_MS)


def test_a_page_that_is_closed_stops_its_jog_and_frees_control(live, served, browser):
    press(live, "jog-Z+")
    live.page.close()
    second = LivePage(browser, served[0])
    second.waits_for("Paused")
    # alone again: it has control
    assert second.page.evaluate("document.querySelector('[data-testid=give]') !== null") is True


def test_beside_the_prompt_a_page_takes_back_and_opens_anew_for_another_program(browser, program, monkeypatch):
    monkeypatch.setattr("robolang.view.beside.open_page", lambda url: True)
    prompted = prompt(program, picture=lambda: LiveBeside(live_page(Bundle.installed())))
    try:
        page = LivePage(browser, prompted.do("view").split()[-1]).page

        def shows(expected):
            lines = "window.robolang?.runs[0].statements.all.map((one) => one.line).join()"
            # asked again and again: the policy of the page lets no function wait inside it
            for _ in range(PATIENCE_MS // POLL_MS):
                if (found := page.evaluate(lines)) == expected:
                    return
                page.wait_for_timeout(POLL_MS)
            assert found == expected

        for word, expected in (("step", "1"), ("step", "1,2"), ("back", "1"), ("step", "1,2")):
            prompted.do(word)
            shows(expected)
        prompted.do("edit 2: MOVE HERE + (0, 0, 5)", "again", "step")
        page.wait_for_selector("text=(0, 0, 5)", timeout=PATIENCE_MS)
        shows("1")
        assert "token" not in page.url
    finally:
        prompted.pendant.pictures.close()


def test_an_address_without_its_token_shows_no_page(served, browser):
    url, _ = served
    page = browser.new_page()
    refused = page.goto(url.partition("?")[0])
    assert refused.status == 401
    assert "?token=" in refused.text() and url.partition("=")[2] not in refused.text()
    assert page.goto(url.replace("127.0.0.1", "localhost")).status == 200
