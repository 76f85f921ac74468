"""The live picture beside the prompt: it follows what the prompt does, and commands nothing."""

import json

import pytest

from robolang.pendant.failure import Failure
from robolang.view.beside import LiveBeside
from tests.robolang.pendant.prompting import prompt
from tests.robolang.view.live_server import PAGE
from tests.robolang.view.test_live import as_page, is_status, texts

PROGRAM = "MOVEJ HERE + (0, 0, 20)\nMOVE HERE + (0, 0, 30)\nPRINT 7\n"


@pytest.fixture
def prompted(tmp_path, monkeypatch):
    opened = []
    monkeypatch.setattr("robolang.view.beside.open_page", opened.append)
    path = tmp_path / "p.rbl"
    path.write_text(PROGRAM)
    found = prompt(path, picture=lambda: LiveBeside(PAGE))
    found.opened = opened
    yield found
    found.pendant.pictures.close()


def url_of(shown: str) -> str:
    return shown.split()[-1]


def test_a_page_sees_what_the_prompt_does(prompted):
    url = url_of(prompted.do("view"))
    assert prompted.opened == [url]
    with as_page(url) as page:
        texts(page, is_status(state="paused", control="none", next=1))
        prompted.do("step")
        texts(page, is_status(next=2))
        prompted.do("jog J1 +1")
        texts(page, is_status(mode="MANUAL"))
        prompted.do("back")
        prompted.do("run")
        found = texts(page, is_status(over=True))
        assert "7" in [each["text"] for each in found if each["kind"] == "printed"]
        prompted.do("again")
        prompted.do("step")
        texts(page, is_status(next=2, over=False))


def shown(messages) -> list[str]:
    """The statements that a page shows after some messages."""
    found = []
    for each in messages:
        if each["kind"] == "statements":
            found = [*found[: each["from"]], *(row["text"] for row in each["rows"])]
    return found


def test_what_is_taken_back_is_taken_off_every_page(prompted):
    url = url_of(prompted.do("view"))
    with as_page(url) as page:
        found = texts(page, is_status(next=1))
        for word, after in (("step", 2), ("step", 3), ("back", 2), ("step", 3), ("back 2", 1), ("step", 2)):
            prompted.do(word)
            found += texts(page, is_status(next=after))
            with as_page(url) as late:
                story = texts(late, is_status(next=after))
            assert shown(found) == shown(story) == PROGRAM.splitlines()[: after - 1]
        prompted.do("again", "step")
        found += texts(page, is_status(next=2))
        assert shown(found) == PROGRAM.splitlines()[:1]
    assert [each["kind"] for each in found].count("hello") == 1


def test_a_page_that_is_opened_late_shows_what_was_done_before(prompted):
    prompted.do("step", "step")
    with as_page(url_of(prompted.do("view"))) as page:
        found = texts(page, is_status(next=3))
        prompted.do("back")
        found += texts(page, is_status(next=2))
    assert shown(found) == PROGRAM.splitlines()[:1]


def test_another_program_is_another_page(prompted):
    prompted.do("step")
    with as_page(url_of(prompted.do("view"))) as page:
        texts(page, is_status(next=2))
        prompted.do("edit 2: MOVE HERE + (0, 0, 5)", "again", "step")
        second = texts(page, lambda message: message["kind"] == "hello")[-1]
    assert "(0, 0, 5)" in second["header"]["meta"]["program"]["text"]


def test_a_page_commands_nothing(prompted):
    with as_page(url_of(prompted.do("view"))) as page:
        for number, word in enumerate(("start", "take", "stop")):
            page.send(json.dumps({"do": word, "id": number}))
            assert texts(page, lambda message: message["kind"] == "reply")[-1]["code"] == "RBL837"
    assert prompted.pendant.live.seconds == 0.0


def test_it_is_opened_once_and_closed(prompted):
    url = url_of(prompted.do("view"))
    assert url_of(prompted.do("view")) == url
    with as_page(url) as page:
        prompted.do("view off")
        texts(page, lambda message: message["kind"] == "over")
    prompted.do("step")
    assert url_of(prompted.do("view")) != url


def test_a_prompt_without_pages_refuses(tmp_path):
    with pytest.raises(Failure) as refused:
        prompt().do("view")
    assert refused.value.codes == ("RBL812",)
    with pytest.raises(Failure) as refused:
        prompt().do("view on")
    assert refused.value.codes == ("RBL802",)
