import json
import random
from typing import Any

import pytest

from robolang.view.messages import WORDS, Command, Go, Held, Input, Jog, Message, Override, Pacing, Teach, read_message
from runtime.core.faults import Fault
from tests.campaign import size

GOOD: dict[str, tuple[dict[str, Any], Command]] = {
    "override": ({"percent": 50}, Override(percent=50)),
    "pace": ({"factor": 0.5}, Pacing(factor=0.5)),
    "input": ({"number": 3, "state": 1}, Input(number=3, state=1)),
    "jog": (
        {"axis": "X", "sign": -1, "frame": "tool", "speed": 25, "step": None},
        Jog(axis="X", sign=-1, frame="tool", speed=25, step=None),
    ),
    "alive": ({"jog": 4}, Held(jog=4, released=False)),
    "release": ({"jog": 4}, Held(jog=4, released=True)),
    "teach": ({"name": "P1", "kind": None, "replace": False}, Teach(name="P1", kind=None, replace=False)),
    **{word: ({}, Go(word=word)) for word in WORDS},
}


def sent(word, **fields):
    return json.dumps({"do": word, "id": 1, **fields})


def refused(text) -> str:
    with pytest.raises(Fault) as fault:
        read_message(text)
    assert fault.value.code == "RBL835"
    return fault.value.message


@pytest.mark.parametrize("word", GOOD)
def test_each_command_is_read(word):
    fields, command = GOOD[word]
    assert read_message(sent(word, **fields)) == Message(id=1, command=command)


@pytest.mark.parametrize("word", GOOD)
def test_a_key_more_or_less_is_refused(word):
    fields, _ = GOOD[word]
    refused(sent(word, **fields, extra=1))
    for key in fields:
        refused(sent(word, **{name: value for name, value in fields.items() if name != key}))


WRONG = (None, True, False, "", "x" * 65, "50", [], {}, [1], float("nan"), float("inf"), -1e300, 1e300, 2**60, -7, 0.5)
MEANT = {
    "percent": (),
    "factor": (0.5,),
    "number": (),
    "state": (None, 0.5, -7),
    "axis": (),
    "sign": (),
    "frame": (),
    "speed": (),
    "step": (None, 0.5),
    "jog": (),
    "name": ("50",),
    "kind": (None,),
    "replace": (True, False),
}
FIELDS = [(word, key) for word, (fields, _) in GOOD.items() for key in fields]


@pytest.mark.parametrize(("word", "key"), FIELDS)
def test_a_value_of_another_type_or_out_of_its_range_is_refused(word, key):
    fields, _ = GOOD[word]
    for value in WRONG:
        # ==, since True equals 1 and NaN nothing: what is meant is compared with its type
        if any(type(each) is type(value) and each == value for each in MEANT[key]):
            continue
        assert f"'{key}'" in refused(sent(word, **{**fields, key: value}))


@pytest.mark.parametrize("id", [None, -1, 1.5, True, "1", 2**60, float("nan")])
def test_an_id_that_is_none_is_refused(id):
    refused(json.dumps({"do": "start", "id": id}))


@pytest.mark.parametrize("word", [None, 1, "", "START", "eval", "__class__", ["start"], {"start": 1}])
def test_a_word_that_names_no_command_is_refused(word):
    refused(json.dumps({"do": word, "id": 1}))


@pytest.mark.parametrize(
    "text", ["", "start", "[]", "1", "null", "[" * 4000, '{"do":' * 800, "{'do': 'start'}", "\ud800", "9" * 4000, b"{}"]
)
def test_what_is_no_object_is_refused(text):
    refused(text)


def test_random_changes_of_good_messages_are_read_or_refused():
    random_ = random.Random(16)
    for _ in range(size(20_000, 1000)):
        word = random_.choice(list(GOOD))
        text = list(sent(word, **GOOD[word][0]))
        for _ in range(random_.randint(1, 4)):
            text[random_.randrange(len(text))] = random_.choice('{}[]",:0179.eE-+ nulltrue\\\x00é')
        try:
            read_message("".join(text))
        except Fault as fault:
            assert fault.code == "RBL835"
