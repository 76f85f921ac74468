"""Words that are not used in messages, help and pages: they have several meanings, or none that is plain.

Texts of the product (strings of the code that are no docstrings) and all pages are free of them. In docstrings and
comments the first of them are counted: the number of a package may only become less.
"""

import ast
import io
import re
import tokenize
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

from tests.arch.parsed import nodes_of
from tests.together import together

ROOT = Path(__file__).parents[2]
WORDS = {
    "way (branch, path, joint curve, offset, stroke)": r"\bways?\b",
    "behind (after)": r"\bbehind\b",
    "look at (check, read)": r"\blook(?:s|ed|ing)? at\b",
    "none of that": r"\bnone of that\b",
    "told (given, set)": r"\btold\b",
    "what is said, asked, wanted, tried": r"\bwhat (?:is|was) (?:said|asked|wanted|tried)\b",
    "of X it is what": r"\b[Oo]f an? \w+ it is\b",
}
"""What to write instead, in parentheses, and what finds the word."""
READ = {
    **WORDS,
    "said, asked, wanted (declared, demanded, programmed)": r"\b(?:said|asked|wanted)\b",
    "tried (tested, attempted)": r"\btried\b",
    "likewise (the same, also)": r"\blikewise\b",
    "goes by (uses)": r"\bgo(?:es)? by\b",
    "goes over (overrides)": r"\bgo(?:es)? over (?:it|them)\b",
    "left out (skipped, left out)": r"\bpass(?:es|ed)? over\b",
    "believes (computes with)": r"\bbeliev\w+",
    "in itself (touches itself)": r"\barm (?:is |would be )?(?:in|out of) itself\b",
    "no body has (is physically impossible)": r"\bno body (?:has|can have)\b",
}
"""The words that a user does not read either: held at zero in pages and in the texts of the product."""
MEANT = re.compile(
    r"turns-the-long-way|slower-than-asked|half way|wrist's way of|or behind it|behind (?:these gears|a gear)"
    r"|`[^`]*`|\*\w+\*"
)
"""Where a word has its plain meaning: places in space, names of the code, and a word that is itself the subject."""
LEFT = {"robolang": 0, "runtime": 0}
"""How often they are left in docstrings and comments; lower the number when you have reworded some."""
PAGES = [
    *(ROOT / page for page in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md")),
    *sorted((ROOT / ".github").rglob("*.md")),
    *sorted((ROOT / "docs").rglob("*.md")),
]


def found(text: str, words: dict[str, str] = READ) -> Counter[str]:
    plain = MEANT.sub("", text)
    return Counter({word: len(hits) for word, pattern in words.items() if (hits := re.findall(pattern, plain))})


@cache
def code(package: str) -> tuple[Path, ...]:
    return tuple(sorted((ROOT / package).rglob("*.py")))


def notes(nodes: list[ast.AST]) -> set[int]:
    """Return the ids of the strings that stand as statements: docstrings of modules, classes, functions and names."""
    return {id(node.value) for node in nodes if isinstance(node, ast.Expr)}


def texts(path: Path) -> str:
    """Return the strings of a module that a user can see: all but docstrings."""
    nodes = nodes_of(path)
    skipped = notes(nodes)
    strings = (node for node in nodes if isinstance(node, ast.Constant) and id(node) not in skipped)
    return "\n".join(node.value for node in strings if isinstance(node.value, str) and " " in node.value)


def prose(path: Path) -> str:
    """Return the docstrings and comments of a module."""
    nodes = nodes_of(path)
    skipped = notes(nodes)
    docs = [node.value for node in nodes if isinstance(node, ast.Constant) and id(node) in skipped]
    tokens = tokenize.generate_tokens(io.StringIO(path.read_text("utf-8")).readline)
    return "\n".join([*map(str, docs), *(token.string for token in tokens if token.type == tokenize.COMMENT)])


@pytest.mark.parametrize("package", LEFT)
def test_messages_and_help_are_plain(package):
    assert {path: dict(words) for path in code(package) if (words := found(texts(path)))} == {}


@together("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_pages_are_plain(page):
    assert found(re.sub(r"^```.*?^```", "", page.read_text("utf-8"), flags=re.MULTILINE | re.DOTALL)) == {}


@pytest.mark.parametrize("package", LEFT)
def test_docstrings_become_plainer(package):
    words = sum((found(prose(path), WORDS) for path in code(package)), Counter())
    assert words.total() <= LEFT[package], words


def test_words_are_found_and_plain_meanings_are_not():
    assert found("the way behind it, looked at as told: none of that").total() == 5
    assert found("longer than asked; the wanted angle was tried; the option goes over it, likewise here").total() == 5
    assert found("in front of the waist (r >= 0) or behind it, half way, RBL435 turns-the-long-way") == {}
