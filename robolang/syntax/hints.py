"""The likeliest correction of a line with an error: what the user probably meant, and how that is written.

Questions are put to the unexpected token in a fixed order, since several may fit one line: usual slips first, then
words and signs of other languages, then what the accepted terminals suggest, and the form of the statement last.
"""

import re
from collections.abc import Callable, Sequence

from robolang.syntax import other_languages
from robolang.syntax.declaration import units
from robolang.syntax.keywords import (
    COMPONENTS,
    FUNCTIONS,
    INSTRUCTIONS,
    KEYWORDS,
    MOTIONS,
    NEW,
    OPTIONS,
    RESERVED,
    form_of,
    instruction_hint,
    near,
)
from robolang.syntax.statements import STATEMENTS
from robolang.syntax.unexpected import END, Unexpected, expected, last_word, quote
from robolang.values import functions
from runtime.core.faults import lookup

_Question = Callable[[Unexpected], str | None]
"""Returns a hint, None where the question does not fit the token, or ``""`` where no later one of its group can fit."""

_OPTIONS = frozenset(OPTIONS)
_HAND_WORDS = frozenset({"OPEN", "CLOSE", "GRASP", "GRIP", "RELEASE"})
ASSIGNS = re.compile(r":[ \t]*(?:\Z|'|=)|([-+*/])(?:=|\1[ \t]*\Z)")
"""What follows the name in an assignment or a label of another language: ``:=``, ``+=``, ``++``, ``:`` at the end."""
ASSIGNMENT = re.compile(r"\w+\$?[ \t]*(?:\([^=]*\)[ \t]*)?=")
_SETTINGS = frozenset(
    {"SPEED", "SPEEDJ", "ACCEL", "OVERRIDE", "ZONE", "TOOL", "FRAME", "DELAY", "LOAD", "TIME", "TIMEOUT"}
)
_DECLARED = (*STATEMENTS, *(option for each in STATEMENTS for option in each.options))
_UNIT_OF = {word: unit for each in reversed(_DECLARED) for word, unit in units(each)}
"""Units of the numbers that follow a word; of SPEED that of most moves, which is declared first."""
_SCALES = {
    "s": {"s": 1.0, "sec": 1.0, "ms": 1e-3, "msec": 1e-3, "min": 60.0},
    "%": {"%": 1.0},
    "mm": {"mm": 1.0, "cm": 10.0, "m": 1000.0},
    "kg": {"kg": 1.0, "g": 1e-3},
    "mm/s": {"mm": 1.0, "mm/s": 1.0, "mm/sec": 1.0, "m/s": 1000.0, "cm/s": 10.0},
}
"""How many of a unit of the language a unit of the user is."""
_UNIT = re.compile(r"(%|(?:mm|cm|m)(?:/s(?:ec)?)?|s|sec|ms|msec|min|kg|g|deg|rad)[ \t]*(?=[,)']|\Z)", re.IGNORECASE)
_NUMBER = re.compile(r"(?<![\w.])(?:[0-9]+(?:\.[0-9]+)?|\.[0-9]+)[ \t]*\Z")
_WHOLE = re.compile(r"(?<![\w.])([0-9]+)\Z")
_FRACTION = re.compile(r"[0-9]+(?![\w.])")
_OPTION_COMMA = re.compile(r"(?:(?:SPEED|ACCEL|TIME|ZONE|TIMEOUT)[ \t]+|\)[ \t]*,[ \t]*)([0-9]+),\Z", re.IGNORECASE)
_LISTS = frozenset({"FOR", "PRINT", "GOTO", "GOSUB", "CASE", "ON", "CALL"})
"""Instructions in which other languages have a comma between two numbers."""
_QUOTED = re.compile(r"'([^'\"]*)'")
_WAIT_TIME = re.compile(r"(?i)WAIT[ \t]+(?:SEC|TIME|[\d.]+)")
_JOINED = {
    ("END", "IF"): "ENDIF",
    ("END", "SELECT"): "ENDSELECT",
    ("END", "SUB"): "ENDSUB",
    ("ELSE", "IF"): "ELSEIF",
    ("END", "FOR"): "NEXT",
    ("END", "WHILE"): "WEND",
}
"""Two words that one word of the language stands for."""


def hint_of(found: Unexpected) -> str:
    """Return the likeliest correction, or ``""``."""
    for questions in (_SLIPS, _OTHER_LANGUAGES, _WORDS):
        if hint := _first_answer(questions, found):
            return hint
    return _form(found) or _completion(found)


def _first_answer(questions: Sequence[_Question], found: Unexpected) -> str:
    """Return the first answer that is not None."""
    return next((answer for question in questions if (answer := question(found)) is not None), "")


def _form(found: Unexpected) -> str:
    """Return the form of the statement, or of the option WRIST in it."""
    return form_of("WRIST" if last_word(found.before).upper() in ("WRIST", "HOLD") else found.instruction)


def _completion(found: Unexpected) -> str:
    """Return what makes a statement whole where nothing is known of what was meant."""
    if found.kind in END:
        return f"complete the statement: write {expected(found)} here"
    if not found.can_end:
        return f"write {expected(found)} in place of {quote(found.text)}"
    sign = ", or write the sign that is missing before it" if "PLUS" in found.accepts else ""
    return f"remove {quote(found.text)}{sign}"


# --- usual slips: a unit, a text in single quotes, a decimal comma, a parenthesis -------------------------------------


def _unit(found: Unexpected) -> str | None:
    # where a value can stand, or after WAIT 5, the word that follows a number is no unit of it
    if found.takes_value or _WAIT_TIME.match(found.head):
        return None
    number = _NUMBER.search(found.head)
    return None if number is None else unit_hint(found.head[: number.start()], number[0], found.rest) or None


def unit_hint(before: str, number: str, rest: str) -> str:
    """Return the remedy for a unit that ``rest`` begins with, after a number and the text ``before`` it, or ``""``."""
    unit = _UNIT.match(rest)
    if unit is None:
        return ""
    words = [each.upper() for each in re.findall(r"[A-Za-z]+", before)]
    word = next((each for each in reversed(words) if each in _UNIT_OF), "")
    # SPEED of a joint move is a share of the fastest one, there is no speed in mm/s to convert
    own = "%" if word == "SPEED" and words[0] == "MOVEJ" else _UNIT_OF.get(word, "")
    scale = _SCALES.get(own, {}).get(unit[1].lower())
    if scale is None:
        return "write no unit: lengths are in mm, angles in degrees, masses in kg, times in s"
    return f"write no unit, {word} is in {own}: {float(number) * scale:.10g}"


def _single_quotes(found: Unexpected) -> str | None:
    # s$ = 'a': the quote has begun a comment where a value is missing
    quoted = _QUOTED.match(found.text) if found.kind == "COMMENT" and found.takes_value else None
    return quoted and f'\' begins a comment; write a text in double quotes: "{quote(quoted[1])}"'


def _label_colon(found: Unexpected) -> str | None:
    is_label = found.text == ":" and re.fullmatch(r"\*[ \t]*\w+", found.head)
    return f"a label has no colon: {quote(found.head)}" if is_label else None


def _points(found: Unexpected) -> str | None:
    """Return how a SPLINE is written: its points in parentheses, which KRL does not have, its options after them."""
    if found.instruction != "SPLINE" or found.kind == "EQ":
        return None
    if found.head.strip().upper() == "SPLINE":
        return "the points stand in parentheses, as in SPLINE (P1, P2, P3), SPEED 200"
    among = found.takes_value and _open(found.before) and found.word in _OPTIONS
    return (
        f"write ) before {found.word}: options follow the points, as in SPLINE (P1, P2), SPEED 200" if among else None
    )


def _open(before: str) -> int:
    """Return how many parentheses are open at the end of a text."""
    # a parenthesis in a text opens nothing
    plain = re.sub(r'"[^"]*"', "", before)
    return plain.count("(") - plain.count(")")


def _decimal_comma(found: Unexpected) -> str | None:
    # MIN(1,5): within parentheses a comma parts two values
    if _open(found.before) or found.instruction in _LISTS:
        return None
    if found.kind == "_COMMA":
        whole, part = _WHOLE.search(found.before), _FRACTION.match(found.after)
    else:  # after an option the comma is accepted, and the digits after it are not
        whole, part = _OPTION_COMMA.search(found.before), _FRACTION.fullmatch(found.text)
    return f"a number has a decimal point: {quote(f'{whole[1]}.{part[0]}')}" if whole and part else None


def _parenthesis(found: Unexpected) -> str | None:
    if found.kind == "RPAR":
        # with a ( open, as in x = ABS(), a value is missing, and no ) is one too many
        return None if _open(found.before) else "remove this ): no ( is open"
    if "RPAR" not in found.accepts or found.takes_value:
        return None
    if found.kind in END:
        return "write ) at the end: a ( is still open"
    return f"write ) before {found.word}: a ( is still open" if found.word in KEYWORDS else None


def _bracket(found: Unexpected) -> str | None:
    """Return what is written in place of [ of another language, by the word that it follows."""
    if found.text != "[":
        return None
    word = last_word(found.head).upper()
    if found.instruction in MOTIONS and word in ("P", "PR"):
        number = re.match(r"[ \t]*([0-9]+)[ \t]*\]", found.after)
        return f"a taught point is a name, as in {found.instruction} P{number[1] if number else 1}"
    if found.instruction in MOTIONS and found.head.upper().rstrip(" \t(") == found.instruction:
        joints = found.instruction == "MOVEJ"
        return f"write {found.instruction} " + ("JOINT(j1, ..., j6)" if joints else "POSE(x, y, z, rx, ry, rz)")
    if found.takes_value and word == "=":
        return "write POSE(x, y, z, rx, ry, rz) for a pose; DIM makes an array, whose elements have a line each"
    if found.takes_value and word in ("+", "*"):
        return f"write ( ) around an offset, as in P1 {word} (0, 0, 50)"
    return other_languages.assigned(word, element=True)


_SLIPS: tuple[_Question, ...] = (_points, _unit, _single_quotes, _label_colon, _decimal_comma, _parenthesis, _bracket)


# --- words and signs of other languages -------------------------------------------------------------------------------


def _sign_of_setting(found: Unexpected) -> str | None:
    sign, setting = re.match(":?=", found.rest), last_word(found.head).upper()
    if sign is None or setting not in _SETTINGS:
        return None
    return f"leave {sign[0]} out: {form_of(found.head) or f'{setting} value'}"


def _equals(found: Unexpected) -> str | None:
    if found.text != "=":
        return None
    # of a single = no other language is the cause
    return other_languages.sign("==") if found.before.endswith("=") else ""


def _assigns(found: Unexpected) -> str | None:
    assigns, name = ASSIGNS.match(found.rest), last_word(found.head)
    if assigns is None:
        return None
    if assigns[1]:
        return f"write {name} = {name} {assigns[1]} {'value' if found.rest[1] == '=' else '1'}"
    return f"= assigns: {name} =" if "=" in assigns[0] else f"*{name} at the start of a line is a label"


def _semicolon(found: Unexpected) -> str | None:
    fits = found.kind == "_SEMICOLON" and (found.is_first or found.can_end)
    return "a comment begins with ' or REM, and no ; ends a line" if fits else None


def _other_sign(found: Unexpected) -> str | None:
    fits = found.kind == "OTHER" or (found.is_first and found.kind in ("SLASH", "MINUS"))
    return other_languages.sign(found.rest) if fits else None


def _slashes(found: Unexpected) -> str | None:
    """Return what // or /* after a statement is, or // between two numbers."""
    # of x = 5 // 2 the first sign divides, and the second cannot stand after it
    text = f"{found.head[-1:]}{found.rest}" if found.head.endswith("/") else found.rest
    if found.kind not in ("SLASH", "STAR") or not text.startswith(("//", "/*")):
        return None
    is_after_number = _NUMBER.search(found.head.rstrip("/ \t")) and re.match(r"/[ \t]*[\d(]", found.rest)
    return "INT(a / b) is the whole part of a quotient" if is_after_number else other_languages.sign(text)


def _value(found: Unexpected) -> str | None:
    return (other_languages.value(found.word) or None) if found.takes_value else None


def _first_word(found: Unexpected) -> str | None:
    if not found.is_first:
        return None
    # INT i declares a variable elsewhere; INT(x) is the function of this language
    is_call = found.after.lstrip().startswith(("=", "("))
    return "" if found.word == "INT" and is_call else other_languages.own(found.word)


def _empty_call(found: Unexpected) -> str | None:
    # get_actual_tcp_pose() of others is HERE, which has no parentheses
    call = re.search(r"(\w+)[ \t]*\(\Z", found.head[-100:]) if found.kind == "RPAR" else None
    return (other_languages.function(call[1]) or None) if call else None


def _wait(found: Unexpected) -> str | None:
    if found.instruction != "WAIT":
        return None
    if found.word == "FOR":
        return "WAIT waits for a condition: WAIT IN(1) = 1, TIMEOUT 5"
    return "DELAY s waits for a time: DELAY 0.5" if _WAIT_TIME.fullmatch(found.head) else None


def _print_comma(found: Unexpected) -> str | None:
    fits = found.kind == "_COMMA" and found.instruction == "PRINT"
    return "; stands between the values of PRINT" if fits else None


def _then(found: Unexpected) -> str | None:
    return f"write THEN before {found.word}" if "THEN" in found.accepts and found.word in INSTRUCTIONS else None


def _end_of_one_line(found: Unexpected) -> str | None:
    return "remove ENDIF: an IF on one line has none" if found.kind == "ENDIF" and found.instruction == "IF" else None


def _label_star(found: Unexpected) -> str | None:
    fits = found.kind == "NAME" and found.instruction in ("GOTO", "GOSUB")
    return f"a label is written with *: {found.instruction} *{found.text}" if fits else None


def _division(found: Unexpected) -> str | None:
    return "INT(a / b) is the whole part of a quotient" if found.kind == "NAME" and found.word == "DIV" else None


def _begin(found: Unexpected) -> str | None:
    fits = found.kind == "NAME" and found.word in ("DO", "BEGIN") and found.can_end
    return f"leave {found.text} out" if fits else None


def _speed_or_zone(found: Unexpected) -> str | None:
    fits = found.kind == "NAME" and found.instruction in MOTIONS
    return (other_languages.setting(found.text) or None) if fits else None


def _of_instruction(found: Unexpected) -> str:
    """Return what replaces the word that begins a statement; an ordinary name where a value is assigned to it."""
    return "" if ASSIGNMENT.match(found.before) else other_languages.instruction(found.instruction)


_OTHER_LANGUAGES: tuple[_Question, ...] = (
    _sign_of_setting,
    _equals,
    _assigns,
    _semicolon,
    _slashes,
    _other_sign,
    _value,
    _first_word,
    _empty_call,
    _wait,
    _print_comma,
    _then,
    _end_of_one_line,
    _label_star,
    _division,
    _begin,
    _speed_or_zone,
    _of_instruction,
)


# --- words of this language in the wrong place ------------------------------------------------------------------------


def _is_reserved(word: str) -> str:
    return f"{word} is a word of the language and cannot be a name"


def _not_an_instruction(found: Unexpected) -> str | None:
    if not found.is_first:
        return None
    if found.word in (RESERVED - KEYWORDS) | FUNCTIONS and found.after.lstrip().startswith("="):
        return _is_reserved(found.word)
    return "a line number is a whole number" if found.kind == "NUMBER" else lookup("RBL112").remedy


def _open_text(found: Unexpected) -> str | None:
    return 'end the text with " on the same line' if found.text == '"' else None


def _two_words(found: Unexpected) -> str | None:
    joined = _JOINED.get((found.instruction, found.word))
    return joined and f"did you mean {joined}?"


def _block_in_line(found: Unexpected) -> str | None:
    fits = "MOVE" in found.accepts and found.word in ("IF", "FOR", "WHILE", "SELECT")
    return f"write the {found.word} on a line of its own, and ENDIF below" if fits else None


def _hand(found: Unexpected) -> str | None:
    fits = found.instruction == "HAND" and "ON" in found.accepts and found.word in _HAND_WORDS
    return instruction_hint(found.word) if fits else None


def _misspelt(found: Unexpected) -> str | None:
    if found.kind != "NAME" or other_languages.is_known(found.word):
        return None
    guess = near(found.word, found.accepts & KEYWORDS)
    return f"did you mean {guess}?" if guess else None


def _missing_comma(found: Unexpected) -> str | None:
    """Return where a comma is missing: before the next option, or before the next component of a HOLD."""
    if "_COMMA" not in found.accepts:
        return None
    if found.word in COMPONENTS:
        lacks = last_word(found.before).upper() in COMPONENTS
    elif found.instruction == "WAIT":
        # GOTO begins an instruction too, but after a TIMEOUT it is the rest of the WAIT; without one it needs TIMEOUT
        lacks = found.word == "TIMEOUT" or (found.word == "GOTO" and _has_timeout(found))
    else:
        lacks = found.instruction in MOTIONS and found.word in _OPTIONS
    return f"write a comma before {found.word}" if lacks else None


def _has_timeout(found: Unexpected) -> bool:
    return re.search(r",[ \t]*TIMEOUT\b", found.before, re.IGNORECASE) is not None


def _no_value(found: Unexpected) -> str | None:
    # nothing but the end can follow: END 5, ENDIF x
    alone = found.accepts <= END and found.before.strip().upper() in INSTRUCTIONS
    fits = alone and found.word not in INSTRUCTIONS
    return f"{found.instruction} takes no value: remove {quote(found.text)}" if fits else None


def _second_instruction(found: Unexpected) -> str | None:
    begins = found.word in INSTRUCTIONS or found.kind == "NAME"
    fits = found.can_end and begins and (found.instruction, found.word) != ("WAIT", "GOTO")
    return "write one instruction on each line" if fits else None


def _reserved_target(found: Unexpected) -> str | None:
    # NEW too: an older program may have a variable of such a word
    fits = found.kind == "EQ" and found.instruction in RESERVED | NEW
    return _is_reserved(found.instruction) if fits else None


def _function_alone(found: Unexpected) -> str | None:
    return f"the form is {functions.FUNCTIONS[found.word].form}" if found.kind in FUNCTIONS else None


def _reserved_name(found: Unexpected) -> str | None:
    return _is_reserved(found.word) if "NAME" in found.accepts and found.word in RESERVED else None


_WORDS: tuple[_Question, ...] = (
    _not_an_instruction,
    _open_text,
    _two_words,
    _block_in_line,
    _hand,
    _misspelt,
    _missing_comma,
    _no_value,
    _second_instruction,
    _reserved_target,
    _function_alone,
    _reserved_name,
)
