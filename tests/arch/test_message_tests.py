"""Tests of messages compare codes, places and fields, not prose, so that wording stays free (docs/testing.md).

An assertion or a ``match=`` that holds two words of prose side by side is found here; what is no message is listed with
what it is. Misuse from Python, ``ValueError`` and the like, is told to programmers and may be matched by its words.
"""

import ast
import builtins
import re
from functools import cache
from pathlib import Path

import pytest

from tests.arch import parsed
from tests.together import together

TESTS = Path(__file__).parents[1]
CHECKED = [path for path in sorted(TESTS.rglob("test_*.py")) if path.parent.name not in ("arch", "bench")]
PROSE = re.compile(r"(?<![\w'*<])[a-z]{2,},? [a-z]{2,}\b(?!\()")
"""Two words of lower case one after the other."""
TERMS = re.compile(r"in line \d|left finger|right finger|closed form|^[\w ]*, \w+ ?\d")
"""Fields of more than one word: places, things with a name, and headings of columns."""
SAID = re.compile(r"message|hint|stderr|stdout|output|notes?\b|said|says|fault|refused|err\b")
"""In what a message is compared."""
NO_MESSAGE = {
    "programs/test_shapes.py: not checked: ": "the beginning of a list",
    "programs/test_shop.py: cannot go there (RBL410)": "printed by the program",
    "programs/test_shop.py: no signal": "printed by the program",
    "programs/test_shop.py: 3 faults answered": "printed by the program",
    "programs/test_stops_in_chains.py: not begun": "a state in a column of the table",
    "robolang/cli/test_isolation.py: it ran": "printed by planted code",
}


def prose(text: str) -> bool:
    return PROSE.search(TERMS.sub("", text)) is not None


def compared(nodes: list[ast.AST]) -> list[tuple[int, str]]:
    """Return the texts with prose that are compared with a message, with their lines."""
    found = []
    for node in nodes:
        if isinstance(node, ast.Call) and ast.unparse(node.func) == "pytest.raises":
            of_python = ast.unparse(node.args[0]) in vars(builtins)
            sides = [word.value for word in node.keywords if word.arg == "match" and not of_python]
        elif isinstance(node, ast.Compare) and SAID.search(ast.unparse(node)):
            sides = [node.left, *node.comparators]
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith((".startswith", ".endswith", "re.search")):
            sides = node.args[:1] if SAID.search(ast.unparse(node)) else []
        else:
            continue
        texts = [item for side in sides for item in ast.walk(side) if isinstance(item, ast.Constant)]
        found += [(item.lineno, item.value) for item in texts if isinstance(item.value, str) and prose(item.value)]
    return found


@cache
def compared_in(path: Path) -> list[tuple[int, str]]:
    return compared(parsed.nodes_of(path))


@together("path", CHECKED, ids=lambda path: path.relative_to(TESTS).as_posix())
def test_no_prose_of_a_message_is_compared(path):
    name = path.relative_to(TESTS).as_posix()
    found = compared_in(path)
    assert [(line, text) for line, text in found if f"{name}: {text}" not in NO_MESSAGE] == []


def test_what_is_listed_is_compared_somewhere():
    found = {f"{path.relative_to(TESTS).as_posix()}: {text}" for path in CHECKED for _, text in compared_in(path)}
    assert set(NO_MESSAGE) <= found


@pytest.mark.parametrize(
    "text",
    [
        "assert 'is not taught' in result.stderr",
        "assert item.message == 'SPEED is given twice'",
        "assert found.hint.startswith('write it as one')",
        "with pytest.raises(Fault, match='out of reach'): pass",
        "assert lines[-1] == '1 file left alone' or result.stdout == 'two words'",
    ],
)
def test_prose_is_found(text):
    assert compared(parsed.nodes(text))


@pytest.mark.parametrize(
    "text",
    [
        "assert 'RBL301' in result.stderr",
        "assert {'J1', '160', 'deg'} <= fields(fault.message)",
        "assert result.stdout.startswith('p.rbl:1:6: error RBL301 ')",
        "with pytest.raises(Fault, match='RBL410'): pass",
        "assert text == 'two words'",
        "with pytest.raises(ValueError, match='two words'): pass",
    ],
)
def test_codes_places_and_fields_are_no_prose(text):
    assert compared(parsed.nodes(text)) == []
