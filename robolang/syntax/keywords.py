"""The vocabulary of the language, and characters and words that are easily taken for it.

``KEYWORDS``, ``FUNCTIONS`` and ``VALUES`` cannot be names, but ``NEW`` can. ``look_alike`` follows the
idea of Unicode report 39, restricted to what can be mistaken for a character that the language reads.
"""

import re
import unicodedata
from collections.abc import Iterable

from robolang.syntax import other_languages, statements
from robolang.syntax.statements import STATEMENTS, forms
from robolang.values import functions

_CHOICES = frozenset(word for each in STATEMENTS for operand in each.operands for word in operand.words)
INSTRUCTIONS = frozenset(each.keyword for each in STATEMENTS if each.keyword) - _CHOICES
"""First words of statements; ON of ON ERROR is a word of HAND as well, and not one of them."""
MOTIONS = frozenset(each.keyword for each in STATEMENTS if each.options)
OPTIONS = tuple(dict.fromkeys(form.partition(" ")[0] for each in statements.OPTIONS for form in each.forms))
COMPONENTS = statements.COMPONENTS
COMPONENTS6 = ("X", "Y", "Z", "RX", "RY", "RZ")
"""Components of a pose, as in P1.X."""
_DECLARED = tuple(dict.fromkeys(word for each in STATEMENTS for word in each.inner_words))
# no form has CASE after its first word: SELECT CASE is read, too, and printed as SELECT
INNER_WORDS = (*_DECLARED, "CASE", "NOT", "AND", "OR", "XOR", "MOD")
"""Words that stand after an instruction, in the order in which messages list them."""
KEYWORDS = INSTRUCTIONS | frozenset(INNER_WORDS)
FUNCTIONS = frozenset(name for name, function in functions.FUNCTIONS.items() if function.parameters)
VALUES = frozenset(functions.FUNCTIONS) - FUNCTIONS
"""Functions without parameters: words that are a value by themselves."""
NEW = frozenset({"SPLINE", "XOR"})
"""Keywords that came after edition 1: they are read as keywords where the grammar has one, and are names elsewhere, so
that older points, cells and programs keep their names (docs/decisions/0029)."""
RESERVED = (KEYWORDS - NEW) | FUNCTIONS | VALUES | {"REM", "NAN", "INF"}

MAX_CHOICES = 300
"""Among more names than this nothing is suggested."""

_FAMILIAR = {
    **dict(zip("АВЕІЈКМНОРЅСТУХҮԌ", "ABEIJKMHOPSCTYXYG", strict=True)),  # Cyrillic
    **dict(zip("аеіјорѕсухԁԛԝ", "aeijopscyxdqw", strict=True)),
    **dict(zip("ΑΒΕΖΗΙΚΜΝΟΡΤΥΧον", "ABEZHIKMNOPTYXov", strict=True)),  # Greek
    **dict(zip("‐‑‒–—−‘’´′“”×", "------''''\"\"*", strict=True)),  # typographic signs
}


def kind_of(word: str) -> str | None:
    """Return the terminal of a word: itself for a keyword, FUNCTION or VALUE for what has a value, None for a name."""
    upper = word.upper()
    if upper in FUNCTIONS:  # first: MAX is a keyword only where the grammar has its own terminal for it
        return "FUNCTION"
    if upper in KEYWORDS:
        return upper
    return "VALUE" if upper in VALUES else None


def look_alike(character: str) -> str:
    """Return the ASCII character that ``character`` can be taken for, or ``""``."""
    # full-width letters and special blanks become ASCII by this; letters of other scripts need the table
    plain = unicodedata.normalize("NFKC", character)
    return plain if len(plain) == 1 and plain.isascii() else _FAMILIAR.get(character, "")


def code_point(character: str) -> str:
    """Return the code point with its name, as in ``U+041C CYRILLIC CAPITAL LETTER EM``."""
    return f"U+{ord(character):04X} {unicodedata.name(character, '')}".rstrip()


def near(word: str, choices: Iterable[str], cutoff: float = 0.6) -> str:
    """Return the choice that resembles the word most, ignoring case, or ``""``."""
    names = list(choices)
    if len(word) > 40 or len(names) > MAX_CHOICES:  # each comparison costs: a check must stay linear
        return ""
    import difflib  # most programs have nothing to guess at: a check starts sooner

    # sorted: a set has no order, and of p1 and P1 the same one has to be proposed in each run
    by_key = {choice.upper(): choice for choice in sorted(names)}
    found = difflib.get_close_matches(word.upper(), by_key, n=1, cutoff=cutoff)
    return by_key[found[0]] if found else ""


def instruction_hint(word: str) -> str:
    """Return what a word that is no instruction was probably meant to be, or ``""``."""
    if known := other_languages.instruction(word):
        return known
    if joined := re.fullmatch(r"(MOVE|LOAD|HAND)(\w*\d)", word.upper()):
        return f"leave a space: {joined[1]} {joined[2]}"
    guess = near(word, INSTRUCTIONS.union(*(each.starts for each in STATEMENTS)))
    return f"did you mean {guess}?" if guess else ""


def form_of(word: str) -> str:
    """Return how the statement that starts with an instruction is written, or ``""``."""
    form = forms(word.upper())
    return f"the form is {form}" if form else ""
