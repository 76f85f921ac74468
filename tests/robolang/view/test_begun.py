"""Statements as pages get them: each once, in their order, whatever was taken back meanwhile."""

import json
import random
from collections import deque

import pytest

from robolang.view import begun as module
from robolang.view.begun import Begun, Got
from tests.campaign import size


class Reader:
    """A page: what it shows by the messages that it has got."""

    def __init__(self, begun):
        self.begun, self.got, self.shown, self.messages = begun, Got(), [], 0

    def read(self):
        """Take what is new; what is shown then."""
        text = self.begun.news(self.got)
        if text is not None:
            message = json.loads(text)
            self.messages += 1
            self.shown = [*self.shown[: message["from"]], *message["rows"]]
        return self.shown


def told(rows):
    begun = Begun()
    for row in rows:
        begun.add(row)
    return begun


def test_each_statement_comes_once_and_a_late_page_gets_all():
    begun = told(["a", "b"])
    reader = Reader(begun)
    assert reader.read() == ["a", "b"]
    assert begun.news(reader.got) is None
    begun.add("c")
    assert json.loads(begun.news(reader.got)) == {"kind": "statements", "from": 2, "rows": ["c"]}
    assert Reader(begun).read() == ["a", "b", "c"]


def test_what_is_the_same_is_not_sent_again():
    begun = told("abcd")
    reader = Reader(begun)
    reader.read()
    begun.settle(told("abcd"))
    assert begun.news(reader.got) is None
    begun.settle(told("ab"))
    assert json.loads(begun.news(reader.got)) == {"kind": "statements", "from": 2, "rows": []}
    begun.settle(told("aXY"))
    assert json.loads(begun.news(reader.got)) == {"kind": "statements", "from": 1, "rows": ["X", "Y"]}
    begun.settle(told(""))
    assert json.loads(begun.news(reader.got)) == {"kind": "statements", "from": 0, "rows": []}


def test_a_statement_that_begins_while_a_page_is_sent_others_comes_once():
    begun = told("a")

    class Racing(deque):
        def copy(self):
            # the thread of the run comes first, once before and once after
            begun.add("b")
            found = deque(begun._entries)
            begun._entries = deque(begun._entries)
            begun.add("c")
            return found

    begun._entries = Racing(begun._entries)
    reader = Reader(begun)
    assert reader.read() == ["a", "b"]
    assert reader.read() == ["a", "b", "c"]
    assert begun.news(reader.got) is None


def test_pages_show_what_has_begun_whatever_was_taken_back():
    dice = random.Random(7)
    for _ in range(size(20_000, 200)):
        begun, rows = Begun(), []
        readers = [Reader(begun) for _ in range(2)]
        for at in range(20):
            if dice.random() < 0.4:
                rows = [*rows[: dice.randint(0, len(rows))], *("n" * dice.randint(0, 2))]
                begun.settle(told(rows))
            else:
                rows = [*rows, at]
                begun.add(at)
            for reader in readers:
                if dice.random() < 0.5:
                    assert reader.read() == rows
        assert Reader(begun).read() == rows


@pytest.mark.parametrize("first", [0, 3, 8])
def test_of_very_many_the_last_ones_are_kept(monkeypatch, first):
    monkeypatch.setattr(module, "MOST_STATEMENTS", 5)
    begun = told(range(first))
    begun.settle(told(range(9)))
    assert json.loads(begun.news(Got())) == {"kind": "statements", "from": 4, "rows": [4, 5, 6, 7, 8]}
    begun.settle(told(range(6)))
    assert json.loads(begun.news(Got()))["rows"][-2:] == [4, 5]
    begun.settle(told(range(2)))
    begun.add(7)
    assert json.loads(begun.news(Got()))["rows"][-1] == 7
