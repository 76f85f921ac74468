"""What a word or a sign of another language was meant to be, as hints give it.

A message names the statement of this language; nothing is ever read as if another one stood there. The words are in
``robolang.syntax.foreign``, which is imported for a text with an error only: most programs have nothing to guess at.
"""

import re

_COMMENT = "a comment begins with ' or REM"
_SIGNS = (
    ("==", "one = compares: IF x = 1 THEN"),
    (":=", "= assigns: x = 5"),
    ("!=", "<> is not equal: IF x <> 1 THEN"),
    ("&&", "AND joins conditions"),
    ("||", "OR joins conditions"),
    ("//", _COMMENT),
    ("/*", _COMMENT),
    ("--", _COMMENT),
    ("!", "NOT negates a condition; a comment begins with ' or REM"),
    ("&", "AND joins conditions, + joins texts"),
    ("|", "OR joins conditions"),
    ("%", "MOD is the remainder; a per cent value is a plain number"),
    ("[", "write ( ) around the number of an element, input or output, as in OUT(1)"),
    ("{", "write (x, y, z), or POSE(x, y, z, rx, ry, rz)"),
    ("#", _COMMENT),
    ("\\", "/ divides; INT(a / b) is the whole part"),
    ("~", "NOT negates a condition"),
    (":", "write one statement on each line"),
)
"""Signs of other languages by how they begin, the longer ones first."""
_FOLLOWING = {
    "IN": "IN(n) reads an input: IF IN(1) = 1 THEN",
    "OUT": "OUT(n) = 1 sets an output, OUT(n) = 0 resets it",
    "VEL": "SPEED mm/s sets the speed of straight moves, SPEEDJ % that of joint moves",
    "ACC": "ACCEL % sets the acceleration",
    "OV_PRO": "OVERRIDE % scales every speed",
    "TOOL": "TOOL name selects a tool of the cell",
    "BASE": "FRAME name selects a frame of the cell, FRAME WORLD the world",
    "LOAD": "LOAD (x, y, z), mass declares the payload",
    "APO": "ZONE mm blends a move into the next one",
    "POS_ACT": "HERE is where the tool is",
    "AXIS_ACT": "HERE is where the tool is; a point that is taught as joint angles keeps those",
    "VEL_AXIS": "SPEEDJ % sets the speed of joint moves",
    "ACC_AXIS": "ACCEL % sets the acceleration",
    "SPEED": "SPEED mm/s sets the speed of straight moves, SPEEDJ % that of joint moves",
    "MOTYPE": "the statement says it: MOVE moves straight, MOVEJ all joints together, MOVEC on an arc",
    "TERMTYPE": "FINE or ZONE mm is an option of a move; without ZONE it stops at its end",
    "ADVANCE": "remove it: computing runs ahead of motion here, and what reads or acts waits for it",
    "ORI_TYPE": "remove it: WRIST sets what the wrist may do in a straight move",
    "WAITTMOUT": "TIMEOUT s is an option of WAIT: WAIT IN(1) = 1, TIMEOUT 30",
    "TIMER": "TIMER are the seconds since the program began: t0 = TIMER, then TIMER - t0",
    "FLAG": "a flag is a name: x = 1",
    "UTOOL": "TOOL name selects a tool of the cell",
    "UFRAME": "FRAME name selects a frame of the cell, FRAME WORLD the world",
}
"""System variables of KRL and KAREL, which begin with $."""
_NO_VARIABLE = "there are no system variables of KRL or KAREL here; of the name of a text $ is the end, as in s$"
_ENDS = ("WEND", "NEXT", "ENDSELECT", "ENDSUB")


def instruction(word: str) -> str:
    """Return what stands for an instruction of another language, or ``""``."""
    from robolang.syntax.foreign import words
    from robolang.syntax.foreign.entry import sentence

    return sentence(word, words.instructions().get(word.upper(), ()))


def own(word: str) -> str:
    """Return what a word of this language means in other ones, for a place where it cannot stand here, or ``""``."""
    from robolang.syntax.foreign import words
    from robolang.syntax.foreign.entry import sentence

    return sentence(word, words.own().get(word.upper(), ()))


def as_input(expression: str) -> str:
    """Return an input of another language, as ``M_IN(2)``, as that of this one, or ``""``."""
    from robolang.syntax.foreign.readings import inputs

    written = inputs(expression)
    return "" if written == expression else written


def is_known(word: str) -> bool:
    """Return whether a word is one of another language: then what is meant is known, and nothing is guessed."""
    from robolang.syntax.foreign import words

    key = word.upper()
    # words of this language that mean something else elsewhere are not among them: they are no mistake
    return key in words.instructions() or key in words.functions() or key in words.values()


def end(word: str) -> str:
    """Return the word that ends a block here, for one that does in another language, or ``""``."""
    from robolang.syntax.foreign import words

    return next((entry.write for entry in words.instructions().get(word.upper(), ()) if entry.write in _ENDS), "")


def assigned(word: str, *, element: bool = False) -> str:
    """Return what stands for a name, or for an ``element``, that another language assigns values to, or ``""``."""
    from robolang.syntax.foreign.program_words import ASSIGNED, NAMES

    key = word.upper()
    return instruction(word) if key in NAMES or (element and key in ASSIGNED) else ""


def function(word: str) -> str:
    """Return what stands for a function of another language, or ``""``."""
    from robolang.syntax.foreign import words
    from robolang.syntax.foreign.entry import sentence

    return sentence(word, words.functions().get(word.upper(), ()))


def signal(name: str) -> str:
    """Return what stands for a signal by the name that RAPID and VAL3 programs give it, as ``diPart``, or ``""``."""
    found = re.match(r"(di|DI|gi|GI|do|DO|go|GO)(?:[A-Z_]|\d+\Z)", name)
    if found is None:
        return ""
    is_input = found[1].lower() in ("di", "gi")
    return f"signals have numbers: {'IN(n) reads input n' if is_input else 'OUT(n) = 1 sets output n'}"


def value(word: str) -> str:
    """Return what stands for a value of another language, or ``""``."""
    from robolang.syntax.foreign import words
    from robolang.syntax.foreign.entry import sentence

    return sentence(word, words.values().get(word.upper(), ()))


def sign(text: str) -> str:
    """Return what stands for the sign that a text begins with, or ``""``."""
    if text[:1] == "$":
        word = re.match(r"\w*", text[1:])
        name = word[0].upper() if word else ""
        return _FOLLOWING.get(name) or _NO_VARIABLE
    return next((hint for begin, hint in _SIGNS if text.startswith(begin)), "")


def setting(word: str) -> str:
    """Return what stands for a speed or zone of RAPID such as v100 or z10, or ``""``."""
    found = re.fullmatch(r"([vz])([0-9]{1,5})", word, re.IGNORECASE)
    if found is None:
        return "write FINE, or no option: without ZONE a move stops at its end" if word.upper() == "CNT0" else ""
    return f"write SPEED {found[2]}" if found[1] in "vV" else f"write ZONE {found[2]}"
