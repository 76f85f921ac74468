import json
import math

import pytest

from robolang.view.exchange import HALTS, MOST_WAITING, Exchange
from robolang.view.messages import Go, Held, Jog, Message, Override

JOG = Jog(axis="X", sign=-1, frame="tool", speed=25.0, step=None)


class Timed(Exchange):
    """An exchange with a clock of its own, s."""

    now = 100.0


@pytest.fixture
def exchange(monkeypatch):
    exchange = Timed()
    monkeypatch.setattr("robolang.view.exchange.wall_s", lambda: exchange.now)
    return exchange


def replies(page):
    found = [json.loads(text) for text in page.said]
    page.said.clear()
    return [(each["id"], each.get("code")) for each in found]


def test_the_first_page_has_control_and_others_watch(exchange):
    first, second = exchange.join(), exchange.join()
    assert exchange.control_for(first) == "yours"
    assert exchange.control_for(second) != "yours"
    exchange.receive(second, Message(id=5, command=Go(word="start")))
    assert replies(second) == [(5, "RBL837")]
    assert exchange.take() is None


def test_control_changes_by_give_and_take_alone(exchange):
    first, second = exchange.join(), exchange.join()
    exchange.receive(second, Message(id=1, command=Go(word="take")))
    exchange.receive(second, Message(id=2, command=Go(word="give")))
    assert replies(second) == [(1, "RBL837"), (2, "RBL837")]
    assert exchange.control_for(first) == "yours"
    exchange.receive(first, Message(id=1, command=Go(word="give")))
    assert exchange.control_for(first) == exchange.control_for(second) == "free"
    exchange.receive(first, Message(id=2, command=Go(word="start")))
    exchange.receive(second, Message(id=3, command=Go(word="take")))
    assert replies(first) == [(1, None), (2, "RBL837")]
    assert replies(second) == [(3, None)]
    assert exchange.control_for(second) == "yours"


def test_control_of_a_page_that_goes_is_free_and_is_nobodys_unasked(exchange):
    first, second = exchange.join(), exchange.join()
    exchange.leave(first)
    assert exchange.control_for(second) == "free"
    assert exchange.control_for(exchange.join()) != "yours"
    exchange.leave(second)


def test_a_page_that_comes_alone_has_control(exchange):
    exchange.leave(exchange.join())
    assert exchange.control_for(exchange.join()) == "yours"


def test_commands_come_in_their_order_and_are_bounded(exchange):
    page = exchange.join()
    for at in range(MOST_WAITING + 1):
        exchange.receive(page, Message(id=at, command=Override(percent=50.0)))
    assert replies(page) == [(MOST_WAITING, "RBL836")]
    assert [exchange.take().id for _ in range(MOST_WAITING)] == list(range(MOST_WAITING))
    assert exchange.take() is None


def test_a_stop_and_a_pause_wait_for_nothing_and_end_what_waits(exchange):
    page = exchange.join()
    for at in range(MOST_WAITING):
        exchange.receive(page, Message(id=at, command=Go(word="start")))
    exchange.receive(page, Message(id=20, command=Go(word="pause")))
    exchange.receive(page, Message(id=21, command=Go(word="stop")))
    exchange.receive(page, Message(id=22, command=Go(word="reset")))
    assert replies(page) == [(at, "RBL836") for at in range(MOST_WAITING)]
    assert [exchange.take().id for _ in range(3)] == [21, 20, 22]
    assert exchange.take() is None


@pytest.mark.parametrize("word", HALTS)
def test_every_page_may_stop_and_one_of_each_is_enough(exchange, word):
    first, second = exchange.join(), exchange.join()
    for _ in range(2):
        for at in range(MOST_WAITING + 1):
            exchange.receive(second, Message(id=at, command=Go(word=word)))
        # all but the first are answered at once
        assert replies(second) == [(at, None) for at in range(1, MOST_WAITING + 1)]
        assert (exchange.take().page, exchange.take()) == (second.number, None)
        # again, while nobody has control
        if first.number in exchange.pages:
            exchange.leave(first)
    assert exchange.control_for(second) == "free"


def test_a_wait_ends_with_a_stop(exchange):
    page = exchange.join()
    exchange.receive(page, Message(id=1, command=Go(word="stop")))
    exchange.wait(math.inf)
    assert exchange.take().id == 1


@pytest.fixture
def jog(exchange):
    page = exchange.join()
    exchange.receive(page, Message(id=7, command=JOG))
    return page, exchange.take()


def holds(exchange, order) -> bool:
    return exchange.button.holds(order.press, exchange.now)


def test_a_jog_is_held_by_its_own_signs(exchange, jog):
    page, order = jog
    for _ in range(20):
        exchange.now += 0.15
        assert holds(exchange, order)
        exchange.receive(page, Message(id=8, command=Held(jog=7, released=False)))
    exchange.now += 0.25
    assert not holds(exchange, order)
    exchange.receive(page, Message(id=8, command=Held(jog=7, released=False)))
    assert not holds(exchange, order)


def test_a_jog_ends_with_its_release(exchange, jog):
    page, order = jog
    exchange.receive(page, Message(id=8, command=Held(jog=7, released=True)))
    assert not holds(exchange, order)


@pytest.mark.parametrize("word", HALTS)
def test_a_jog_ends_when_another_page_stops(exchange, jog, word):
    _, order = jog
    # a button of its own: that of the jog is released by the page that comes, too
    other = exchange.join()
    press = exchange.button.press(order.page, 9, exchange.now)
    exchange.receive(other, Message(id=1, command=Go(word=word)))
    assert not exchange.button.holds(press, exchange.now)


def test_a_jog_ends_when_its_page_goes(exchange, jog):
    page, order = jog
    exchange.leave(page)
    assert not holds(exchange, order)


def test_a_jog_ends_when_a_second_page_comes(exchange, jog):
    _, order = jog
    exchange.join()
    assert not holds(exchange, order)


def test_a_jog_ends_when_control_is_given(exchange, jog):
    page, order = jog
    exchange.receive(page, Message(id=8, command=Go(word="give")))
    assert not holds(exchange, order)


def test_another_page_can_neither_hold_nor_release_a_jog(exchange):
    page, other = exchange.join(), exchange.join()
    exchange.receive(page, Message(id=7, command=JOG))
    order = exchange.take()
    exchange.receive(other, Message(id=1, command=Held(jog=7, released=True)))
    assert holds(exchange, order)
    exchange.now += 0.19
    exchange.receive(other, Message(id=1, command=Held(jog=7, released=False)))
    exchange.now += 0.19
    assert not holds(exchange, order)


def test_a_clock_that_gives_no_time_holds_nothing(exchange, jog):
    page, order = jog
    exchange.now = math.nan
    exchange.receive(page, Message(id=8, command=Held(jog=7, released=False)))
    assert not holds(exchange, order)


def test_lines_and_replies_of_a_page_that_does_not_read_are_bounded(exchange):
    page = exchange.join()
    for at in range(10_000):
        exchange.say(str(at))
        exchange.reply(page.number, at)
        exchange.show_frame(b"f")
        exchange.show_status(f'{{"at":{at}}}')
    assert len(page.said) <= 200
    assert exchange.frame == (10_000, b"f")


def test_a_reply_to_a_page_that_has_gone_is_dropped(exchange):
    page = exchange.join()
    exchange.leave(page)
    exchange.reply(page.number, 1)


def test_pages_that_only_watch_command_nothing():
    exchange = Exchange(watched_only=True)
    page = exchange.join()
    for command in (Go(word="start"), Go(word="take"), JOG, Held(jog=1, released=True)):
        exchange.receive(page, Message(id=1, command=command))
        assert replies(page) == [(1, "RBL837")]
    assert exchange.control_for(page) == "none"
    assert exchange.take() is None
