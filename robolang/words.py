"""The vocabulary of the language, and characters and words that are easily taken for it.

``KEYWORDS`` are read by this edition; ``LATER`` are the other words of edition 1 (docs: the language
reference), reserved from the start so that no program breaks when they arrive. ``look_alike`` follows the
idea of Unicode report 39, restricted to what can be mistaken for a character that the language reads.
"""

import difflib
import re
import unicodedata
from collections.abc import Iterable

INSTRUCTIONS = frozenset({"MOVE", "LOAD", "HAND", "WRIST", "SEAM"})
OPTIONS = ("SPEED", "ACCEL", "TIME", "WRIST")
COMPONENTS = ("TILT", "ADVANCE", "ROTATION")
INNER_WORDS = ("ON", "OFF", *OPTIONS, "KEEP", "AUTO", "HOLD", *COMPONENTS)
"""Words that stand behind an instruction, in the order in which messages list them."""
KEYWORDS = INSTRUCTIONS | frozenset(INNER_WORDS)
_LATER_INSTRUCTIONS = """
    MOVEJ MOVEC APPROACH DEPART SPEEDJ OVERRIDE ZONE TOOL FRAME OUT WAIT DELAY PULSE DIM CONST
    IF ELSEIF ELSE ENDIF FOR NEXT WHILE WEND SELECT CASE ENDSELECT GOTO GOSUB RETURN SUB ENDSUB CALL END STOP
    PAUSE RESUME PRINT
"""
_LATER_WORDS = """
    FINE IN TIMEOUT THEN TO STEP ERROR ERR POSE JOINT HERE DIST AND OR NOT MOD
    ABS SGN INT ROUND SQR SIN COS TAN ATN2 MIN MAX DEG RAD STR$ VAL LEN TIMER
"""
_FORMS = {
    "MOVE": "MOVE point [, SPEED mm/s] [, ACCEL %] [, TIME s] [, WRIST mode]",
    "LOAD": "LOAD (x, y, z), mass",
    "HAND": "HAND ON [, s] or HAND OFF [, s]",
    "WRIST": "WRIST KEEP, WRIST AUTO or WRIST HOLD component [, component]",
    "SEAM": "SEAM ON, sensor or SEAM OFF",
}
LATER_INSTRUCTIONS = frozenset(_LATER_INSTRUCTIONS.split())
LATER = LATER_INSTRUCTIONS | frozenset(_LATER_WORDS.split())
RESERVED = KEYWORDS | LATER | {"REM", "NAN", "INF"}

_PHRASES = {"HAND ON", "HAND OFF", "WRIST KEEP", "WRIST AUTO", "WRIST HOLD", "SEAM ON", "SEAM OFF"}
_OTHER_LANGUAGES = {
    "CLOSE": "HAND ON closes the hand",
    "GRASP": "HAND ON closes the hand",
    "GRIP": "HAND ON closes the hand",
    "OPEN": "HAND OFF opens the hand",
    "RELEASE": "HAND OFF opens the hand",
    "LIN": "MOVE is a straight move",
    "MOVEL": "MOVE is a straight move",
    "MOVS": "MOVE is a straight move",
    "PAYLOAD": "LOAD (x, y, z), mass declares the payload",
}

_FAMILIAR = {
    **dict(zip("АВЕІЈКМНОРЅСТУХҮԌ", "ABEIJKMHOPSCTYXYG", strict=True)),  # Cyrillic
    **dict(zip("аеіјорѕсухԁԛԝ", "aeijopscyxdqw", strict=True)),
    **dict(zip("ΑΒΕΖΗΙΚΜΝΟΡΤΥΧον", "ABEZHIKMNOPTYXov", strict=True)),  # Greek
    **dict(zip("‐‑‒–—−‘’´′“”×", "------''''\"\"*", strict=True)),  # typographic signs
}


def kind_of(word: str) -> str | None:
    """Return the terminal of a word: itself for a keyword, ``LATER`` for a later one, None for a name."""
    upper = word.upper()
    if upper in KEYWORDS:
        return upper
    return "LATER" if upper in LATER else None


def look_alike(character: str) -> str:
    """Return the ASCII character that ``character`` can be taken for, or ``""``."""
    plain = unicodedata.normalize("NFKC", character)
    return plain if len(plain) == 1 and plain.isascii() else _FAMILIAR.get(character, "")


def code_point(character: str) -> str:
    """Return the code point with its name, as in ``U+041C CYRILLIC CAPITAL LETTER EM``."""
    return f"U+{ord(character):04X} {unicodedata.name(character, '')}".rstrip()


def near(word: str, choices: Iterable[str], cutoff: float = 0.6) -> str:
    """Return the choice that resembles the word most, ignoring case, or ``""``."""
    if len(word) > 40:
        return ""
    by_key = {choice.upper(): choice for choice in sorted(choices)}
    found = difflib.get_close_matches(word.upper(), by_key, n=1, cutoff=cutoff)
    return by_key[found[0]] if found else ""


def instruction_hint(word: str) -> str:
    """Return what a word that is no instruction was probably meant to be, or ``""``."""
    if known := _OTHER_LANGUAGES.get(word.upper()):
        return known
    if joined := re.fullmatch(r"(MOVE|LOAD|HAND)(\w*\d)", word.upper()):
        return f"leave a space: {joined[1]} {joined[2]}"
    guess = near(word, INSTRUCTIONS | LATER_INSTRUCTIONS | _PHRASES)
    return f"did you mean {guess}?" if guess else ""


def form_of(word: str) -> str:
    """Return how the statement that starts with an instruction is written, or ``""``."""
    form = _FORMS.get(word.upper())
    return f"the form is {form}" if form else ""
