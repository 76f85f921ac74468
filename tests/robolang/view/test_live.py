"""Live views as people have them: a command, a page that is connected to it, signals."""

import json
import re
import signal
import socket
import webbrowser
from contextlib import contextmanager
from typing import NamedTuple

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect
from websockets.typing import Origin

from robolang.execution.session import Session
from robolang.project.project import load_project
from robolang.view.driver import Driver
from robolang.view.live import Live, header_of, open_page
from tests.ready import Piped
from tests.robolang.cli.commands import dry, robolang
from tests.robolang.execution.standing import log_of
from tests.robolang.view.live_server import PAGE, upgrade
from tests.steps import HANG_S

MOVES = """FOR N = 1 TO 4
  MOVE HERE + (0, 0, 60), SPEED 400
  MOVE HERE + (0, 0, -60), SPEED 400
NEXT N
PRINT "</script>"; N
"""


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "p.rbl"
    path.write_text(MOVES)
    return path


def session_of(program, observer=None):
    return Session(load_project(program), physics=False, observer=observer)


@contextmanager
def live_of(program):
    """A session with its live view, served."""
    live = Live(PAGE)
    session = session_of(program, live.frames)
    with live.serve(session) as url:
        yield live, session, url


def as_page(url):
    """A page at an address that a command has printed."""
    base = url.partition("/?")[0]
    return connect(
        url.replace("http://", "ws://").replace("/?", "/live?"),
        origin=Origin(base),
        compression=None,
        max_size=None,
        max_queue=None,
    )


def texts(page, until):
    """The messages of a page up to the first for which ``until`` is true; frames are left out."""
    found = []
    while not (found and until(found[-1])):
        message = page.recv(timeout=HANG_S)
        if isinstance(message, str):
            found.append(json.loads(message))
    return found


def is_status(**fields):
    return lambda message: message["kind"] == "status" and all(message.get(key) == fields[key] for key in fields)


# --- what a page does to a run ---------------------------------------------------------------------------------------


@contextmanager
def stalled(url):
    """A page that has opened its socket and reads nothing."""
    host, _, token = url.removeprefix("http://").partition("/?")
    head = [f"GET /live?{token} HTTP/1.1", f"Host: {host}", f"Origin: http://{host}", *upgrade(), "", ""]
    with socket.create_connection(host.split(":"), timeout=HANG_S) as peer:
        peer.sendall("\r\n".join(head).encode())
        yield


def test_a_run_with_pages_that_do_not_read_gives_the_same_bytes(program, monkeypatch):
    plain = session_of(program)
    plain.run()
    # in every cycle one, and the first message is more than all buffers between the two take
    monkeypatch.setattr("robolang.view.frames.FRAME_S", 0.0)
    with live_of(program) as (live, session, url):
        live.exchange.hello = "x" * 50_000_000
        with stalled(url), stalled(url), stalled(url):
            while len(live.exchange.pages) < 3:
                live.exchange.wait(HANG_S)
            session.run(Driver(session, live.exchange, live.frames).run_through)
            assert len(live.exchange.pages) == 3
            assert live.exchange.frame[0] > 100
    assert log_of(session) == log_of(plain)


def test_a_page_that_reads_gets_all_that_is_text_and_frames_of_one_size(program):
    with live_of(program) as (live, session, url), as_page(url) as page:
        session.run(Driver(session, live.exchange, live.frames).run_through)
        live.exchange.notify()
        found, frames = [], []
        while not found or found[-1].get("state") != "done":
            message = page.recv(timeout=HANG_S)
            if isinstance(message, bytes):
                frames.append(message)
            else:
                found.append(json.loads(message))
        hello = found[0]
    assert hello["kind"] == "hello"
    size = 8 + 4 * sum(count for _, count in hello["layout"])
    assert {len(frame) for frame in frames} == {size}
    assert size < 300
    statements = [row for each in found if each["kind"] == "statements" for row in each["rows"]]
    assert [row["line"] for row in statements] == [2, 3] * 4 + [5]
    assert [each["text"] for each in found if each["kind"] == "printed"] == ["</script>4"]


def test_every_new_frame_reaches_a_page_that_reads_whatever_else_is_new(program):
    with live_of(program) as (live, _, url), as_page(url) as page:
        texts(page, is_status())
        size = 8 + 4 * sum(count for _, count in json.loads(live.exchange.hello)["layout"])
        for value in (1, 2, 3):
            sent = bytes([value]) * size
            live.exchange.show_frame(sent)
            while page.recv(timeout=HANG_S) != sent:
                pass


def test_a_page_that_comes_late_gets_the_whole_story(program):
    with live_of(program) as (live, session, url):
        session.run(Driver(session, live.exchange, live.frames).run_through)
        with as_page(url) as page:
            found = texts(page, is_status(state="done"))
    assert [each["kind"] for each in found] == ["hello", "statements", "notes", "status"]
    assert len(found[1]["rows"]) == 9


def test_the_header_is_plain_json_and_names_no_folder(program):
    header = header_of(session_of(program))
    text = json.dumps(header, allow_nan=False)
    assert str(program.parent) not in text
    assert header["meta"]["program"] == {"name": "p.rbl", "text": MOVES}
    assert {chart["id"] for chart in header["charts"]} >= {"tool_error", "tool_speed", "joints", "torque_pct"}
    names = {series["signal"] for chart in header["charts"] for series in chart["series"]}
    assert names <= {"q_cmd", "q_link", "tau_sat", "tool", "tool_error", "tool_speed"}


def test_the_end_of_a_run_is_the_end_of_its_pages(program):
    live = Live(PAGE)
    serving = live.serve(session_of(program, live.frames))
    with as_page(serving.__enter__()) as page:
        serving.__exit__(None, None, None)
        with pytest.raises(ConnectionClosed) as closed:
            texts(page, lambda message: False)
    assert closed.value.rcvd.code == 1000


# --- commands --------------------------------------------------------------------------------------------------------


class Started(NamedTuple):
    """A command that runs: its process, the address of its page, and what it has printed before."""

    process: Piped
    url: str
    said: list[str]


@contextmanager
def command(*words):
    """A command that runs, with what it has printed up to its address."""
    process = Piped(words)
    try:
        lines = []
        for line in process.stderr:
            lines.append(line)
            if "http://" in line:
                break
        url = next(iter(re.findall(r"http://\S+", lines[-1])), "") if lines else ""
        yield Started(process, url, lines)
    finally:
        if process.poll() is None:
            process.kill()
        process.communicate()


def test_view_stands_at_the_start_runs_by_its_page_and_ends_by_a_signal(program):
    with command("view", program, "--no-physics", "--no-browser", "--speed", 20) as started:
        with as_page(started.url) as page:
            found = texts(page, is_status(state="paused", control="yours"))
            assert found[-1]["next"] == 1
            page.send(json.dumps({"do": "start", "id": 1}))
            assert texts(page, lambda message: message["kind"] == "reply")[-1]["ok"]
            texts(page, is_status(state="done", doing="nothing"))
            started.process.send_signal(signal.SIGINT)
            assert texts(page, lambda message: message["kind"] == "over")
        assert started.process.wait(HANG_S) == 130


def test_a_signal_in_motion_brings_the_arm_to_rest(program):
    with command("view", program, "--no-physics", "--no-browser") as started, as_page(started.url) as page:
        page.send(json.dumps({"do": "start", "id": 1}))
        texts(page, is_status(doing="program"))
        started.process.send_signal(signal.SIGTERM)
        found = texts(page, lambda message: message["kind"] == "over")
        assert [each["state"] for each in found if each["kind"] == "status"][-1] == "paused"
        assert started.process.wait(HANG_S) == 143


def test_run_is_followed_and_ends_by_itself(program, tmp_path):
    log = tmp_path / "a.npz"
    with command("run", program, "--no-physics", "--view", "--no-browser", "--log", log) as started:
        # the page is there from the start, and after the end
        with as_page(started.url) as page:
            found = texts(page, is_status(finished=True))
            assert [row["line"] for each in found if each["kind"] == "statements" for row in each["rows"]] == [
                *[2, 3] * 4,
                5,
            ]
            assert log.exists()
            assert started.process.poll() is None
            page.send(json.dumps({"do": "start", "id": 1}))
            assert texts(page, lambda message: message["kind"] == "reply")[-1]["code"] == "RBL836"
        started.process.communicate()
        assert started.process.returncode == 0
    plain = tmp_path / "b.npz"
    dry(program, "--quiet", "--log", plain)
    assert log.read_bytes() == plain.read_bytes()


def test_a_page_may_pause_and_stop_a_run_that_it_follows(program):
    words = ("run", program, "--no-physics", "--realtime", "--view", "--no-browser", "--quiet")
    with command(*words) as started, as_page(started.url) as page:
        page.send(json.dumps({"do": "pause", "id": 1}))
        texts(page, is_status(state="paused"))
        page.send(json.dumps({"do": "stop", "id": 2}))
        texts(page, is_status(state="stopped", finished=True))
        # it is shown until the end is asked for
        started.process.send_signal(signal.SIGINT)
        assert started.process.wait(HANG_S) == 3


def test_a_signal_ends_the_wait_for_a_page(program):
    with command("run", program, "--no-physics", "--view", "--no-browser") as started:
        started.process.send_signal(signal.SIGTERM)
        assert started.process.wait(HANG_S) == 143


def test_a_run_begins_without_a_page_where_none_comes(program, monkeypatch):
    monkeypatch.setattr("robolang.view.live.FIRST_PAGE_S", 0.0)
    with live_of(program) as (live, _, url):
        assert not live.wait_for_page()
        with as_page(url) as page:
            texts(page, is_status(state="running"))
            assert live.wait_for_page()


def reply_to(number):
    return lambda message: message["kind"] == "reply" and message["id"] == number


@pytest.mark.parametrize("word", ["stop", "pause"])
def test_a_page_without_control_stops_an_arm_that_another_one_keeps_busy(program, word):
    with command("view", program, "--no-physics", "--no-browser") as started, as_page(started.url) as page:
        page.send(json.dumps({"do": "start", "id": 1}))
        texts(page, is_status(doing="program"))
        with as_page(started.url) as other:
            texts(other, is_status(control="other"))
            for number in range(2, 200):
                page.send(json.dumps({"do": "override", "id": number, "percent": 50}))
            other.send(json.dumps({"do": word, "id": 1}))
            assert texts(other, reply_to(1))[-1]["ok"]
            found = texts(other, is_status(doing="nothing"))[-1]
            assert found["state"] == {"stop": "stopped", "pause": "paused"}[word]


def test_a_stop_is_not_kept_by_the_commands_before_it(program):
    with command("view", program, "--no-physics", "--no-browser") as started, as_page(started.url) as page:
        page.send(json.dumps({"do": "start", "id": 1}))
        texts(page, is_status(doing="program"))
        for number in range(2, 200):
            page.send(json.dumps({"do": "override", "id": number, "percent": 50}))
        page.send(json.dumps({"do": "stop", "id": 200}))
        assert texts(page, reply_to(200))[-1]["ok"]
        texts(page, is_status(state="stopped", doing="nothing"))


def test_a_program_with_errors_and_a_port_that_is_taken_are_refused(program, tmp_path):
    wrong = tmp_path / "wrong.rbl"
    wrong.write_text("MOVE NOWHERE\n")
    assert "http" not in robolang("view", wrong, "--no-browser", code=1).stderr
    with live_of(program) as (_, _, url):
        port = re.search(r":(\d+)/", url)[1]
        for words in (("view", program, "--no-physics"), ("run", program, "--no-physics", "--view")):
            refused = robolang(*words, "--no-browser", "--port", port, code=2).stderr
            assert any("RBL834" in line and port in line for line in refused.splitlines())
            assert "http" not in refused


def test_a_browser_that_would_take_the_terminal_is_not_opened(monkeypatch):
    opened = []

    class Window(webbrowser.BackgroundBrowser):
        def open(self, url, new=0, autoraise=True):
            opened.append(url)
            return True

    def none():
        raise webbrowser.Error("could not locate runnable browser")

    for found, expected in (
        (lambda: webbrowser.GenericBrowser("lynx"), False),
        (none, False),
        (lambda: Window("firefox"), True),
    ):
        monkeypatch.setattr(webbrowser, "get", found)
        assert open_page("http://127.0.0.1:1/") == expected
    assert opened == ["http://127.0.0.1:1/"]
