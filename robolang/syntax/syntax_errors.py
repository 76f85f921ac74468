"""From a token that no rule accepts to a diagnostic in the user's words.

The parser stops a line at the first token that cannot follow; what could have followed (``accepts``) comes
from the LALR table and is put into words here, never as names of terminals. Exactly one diagnostic for a
line. Called by the parser for lines with an error only.
"""

import re
from collections.abc import Set
from dataclasses import dataclass

from robolang.core.diagnostics import Diagnostic
from robolang.core.source import Span
from robolang.syntax import other_languages
from robolang.syntax.keywords import (
    COMPONENTS,
    COMPONENTS6,
    INNER_WORDS,
    INSTRUCTIONS,
    KEYWORDS,
    MOTIONS,
    NEW,
    OPTIONS,
    RESERVED,
    code_point,
    form_of,
    instruction_hint,
    look_alike,
    near,
)
from runtime.core.faults import lookup

_END = frozenset({"$END", "COMMENT"})
_OPTIONS = frozenset(OPTIONS)
_HAND_WORDS = frozenset({"OPEN", "CLOSE", "GRASP", "GRIP", "RELEASE"})
_SIGNS = {"RPAR": "')'", "EQ": "'='", "_COMMA": "','", "$END": "the end of the line"}
_VALUE = frozenset({"NUMBER", "FUNCTION"})
_OPERATORS = frozenset({"OR", "XOR", "AND", "NOT", "MOD", "PLUS", "MINUS", "STAR", "SLASH", "CARET"})
_LAST_WORD = re.compile(r"(?:[\w.$]+|[^\s\w])[ \t]*\Z")
_ASSIGNS = re.compile(r":[ \t]*(?:\Z|'|=)|([-+*/])(?:=|\1[ \t]*\Z)")
"""What follows the name in an assignment or a label of another language: ``:=``, ``+=``, ``++``, ``:`` at the end."""
_ASSIGNMENT = re.compile(r"\w+\$?[ \t]*(?:\([^=]*\)[ \t]*)?=")
_SETTINGS = frozenset(
    {"SPEED", "SPEEDJ", "ACCEL", "OVERRIDE", "ZONE", "TOOL", "FRAME", "DELAY", "LOAD", "TIME", "TIMEOUT"}
)
_UNIT_OF = {
    **dict.fromkeys(("DELAY", "TIME", "TIMEOUT", "PULSE", "HAND"), "s"),
    **dict.fromkeys(("SPEEDJ", "ACCEL", "OVERRIDE"), "%"),
    **dict.fromkeys(("ZONE", "APPROACH", "DEPART"), "mm"),
    "SPEED": "mm/s",
    "LOAD": "kg",
}
"""Units of the numbers that follow a word."""
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
_QUOTE = 30
_JOINED = {
    ("END", "IF"): "ENDIF",
    ("END", "SELECT"): "ENDSELECT",
    ("END", "SUB"): "ENDSUB",
    ("ELSE", "IF"): "ELSEIF",
    ("END", "FOR"): "NEXT",
    ("END", "WHILE"): "WEND",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Unexpected:
    """A token where none of its kind can stand.

    ``kind`` and ``accepts`` are terminals of ``grammar.lark``; ``before`` and ``after`` are the statement's
    text around the token.
    """

    kind: str
    text: str
    span: Span
    accepts: Set[str]
    before: str
    after: str

    @property
    def is_first(self) -> bool:
        """Whether the statement starts with the token."""
        return not self.before.strip()

    @property
    def instruction(self) -> str:
        """The instruction that the token stands behind, in capitals; ``""`` when it is first."""
        return re.split(r"\W", self.before, maxsplit=1)[0].upper()


def explain(found: Unexpected) -> Diagnostic:
    """Return the one diagnostic for an unexpected token."""
    if found.kind in ("SUSPICIOUS", "OTHER") and not found.text.isascii():
        return suspicious(found.text, found.span.start)
    if found.kind == "HUGE":
        message = f"the number {quote(found.text)} is too large"
        return Diagnostic(code="RBL114", message=message, span=found.span)
    if found.kind == "MALFORMED":
        return _malformed(found)
    return _component(found) or _unknown(found) or _unexpected(found)


def suspicious(text: str, start: int) -> Diagnostic:
    """Return RBL103 for the first character that is not printable ASCII; ``text`` stands at ``start``."""
    index = next(i for i, character in enumerate(text) if not (character.isascii() and character.isprintable()))
    character = text[index]
    twin = look_alike(character)
    hint = f"it looks like {'a space' if twin == ' ' else repr(twin)}; retype it" if twin else ""
    span = Span(start + index, start + index + 1)
    return Diagnostic(code="RBL103", message=f"suspicious character {code_point(character)}", span=span, hint=hint)


def quote(text: str) -> str:
    """Return text for a message, cut when it is long."""
    return text if len(text) <= _QUOTE else f"{text[:_QUOTE]}… ({len(text)} characters)"


def _malformed(found: Unexpected) -> Diagnostic:
    text, hint = found.text, ""
    if found.is_first and re.fullmatch(r"[0-9]+[A-Za-z]+", text):
        hint = "leave a space between the line number and the instruction"
    elif re.fullmatch(r"[0-9.]*[0-9][0-9_.]*", text) and "_" in text:
        hint = f"write {quote(text.replace('_', ''))}"
    elif unit := re.fullmatch(r"([0-9]+(?:\.[0-9]+)?|\.[0-9]+)([a-z]+)", text, re.IGNORECASE):
        hint = _unit(found.before, unit[1], unit[2] + found.after)
    return Diagnostic(code="RBL115", message=f"'{quote(text)}' is not a number", span=found.span, hint=hint)


def _is_after_first_name(found: Unexpected) -> bool:
    """Return whether a statement begins with a name and the token is what follows it."""
    return (
        {"EQ", "LPAR"} <= found.accepts
        and "LESS" not in found.accepts
        and re.fullmatch(r"[^\W\d]\w*\$?", _last_word(found.before)) is not None
    )


def _component(found: Unexpected) -> Diagnostic | None:
    """Return RBL111 for a component of a pose that a value is assigned to."""
    part = re.match(r"(?i)(x|y|z|rx|ry|rz)[ \t]*=", found.after)
    if found.kind != "_DOT" or part is None or not _is_after_first_name(found):
        return None
    pose, end = _last_word(found.before), found.span.end + len(part[1])
    values = ", ".join("value" if each == part[1].upper() else f"{pose}.{each}" for each in COMPONENTS6)
    return Diagnostic(
        code="RBL111",
        message=f"a component of a pose cannot be assigned: {pose}.{part[1].upper()}",
        span=Span(found.span.start, end),
        hint=f"write {pose} = POSE({values})",
    )


def _unknown(found: Unexpected) -> Diagnostic | None:
    """Return RBL112 for a name that begins a statement and is not assigned to."""
    word = _last_word(found.before)
    if not _is_after_first_name(found) or _ASSIGNS.match(found.text + found.after):
        return None
    start = found.span.start - len(found.before) + len(found.before.rstrip(" \t")) - len(word)
    message = f"unknown instruction '{quote(word)}'"
    return Diagnostic(code="RBL112", message=message, span=Span(start, start + len(word)), hint=instruction_hint(word))


def _unexpected(found: Unexpected) -> Diagnostic:
    message = f"expected {_expected(found)}{_after(found.before)}"
    if found.kind in _END:
        end = found.span.start
        return Diagnostic(code="RBL111", message=message, span=Span(end, end), hint=_hint(found))
    shown = quote(found.text) if re.match(r"\w", found.text) else f"'{found.text}'"
    return Diagnostic(code="RBL111", message=f"{message}, not {shown}", span=found.span, hint=_hint(found))


def _expected(found: Unexpected) -> str:
    """Return accepted terminals in words, as in ``',' or the end of the line``."""
    if found.is_first:
        return "an instruction"
    if "MOVE" in found.accepts:  # behind THEN and ELSE
        return "an instruction or the end of the line" if "$END" in found.accepts else "an instruction"
    accepts, words = found.accepts, []
    if accepts >= _VALUE:
        words.append("a point" if _last_word(found.before).upper() in MOTIONS - {"DEPART"} else "a value")
    elif "NUMBER" in accepts:
        words.append("a line number or *LABEL" if "STAR" in accepts else "a number")
    elif "NAME" in accepts:
        words.append("a sensor name" if found.instruction == "SEAM" else "a name")
    if "LPAR" in accepts and not accepts & {"$END", "LESS"} and not accepts >= _VALUE:
        words.append("'('")
    words += [word for word in INNER_WORDS if word in accepts and word not in _OPERATORS]
    # behind a value '=' compares; where it is the only sign it assigns
    signs = [sign for kind, sign in _SIGNS.items() if kind in accepts and not (kind == "EQ" and "LESS" in accepts)]
    words += signs
    return " or ".join([*([", ".join(words[:-1])] if words[:-1] else []), words[-1]]) if words else "something else"


def _last_word(before: str) -> str:
    last = _LAST_WORD.search(before[-200:])
    return last[0].rstrip() if last else ""


def _after(before: str) -> str:
    word = _last_word(before)
    if not word:
        return ""
    if not re.match(r"[\w.]", word):
        return f" after '{word}'"
    return f" after {word.upper() if word.upper() in KEYWORDS else quote(word)}"


def _hint(found: Unexpected) -> str:
    """Return the likeliest correction, or ``""``."""
    word = found.text.upper()
    if elsewhere := _slip(found, word) or _elsewhere(found, word):
        return elsewhere
    if found.is_first:
        whole = found.kind == "NUMBER"
        if word in RESERVED - KEYWORDS and found.after.lstrip().startswith("="):
            return f"{word} is a word of the language and cannot be a name"
        return "a line number is a whole number" if whole else lookup("RBL112").remedy
    if found.text == '"':
        return 'a text ends with " on its line'
    if joined := _JOINED.get((found.instruction, word)):
        return f"did you mean {joined}?"
    if "MOVE" in found.accepts and word in ("IF", "FOR", "WHILE", "SELECT"):
        return f"write the {word} on a line of its own, and ENDIF below"
    if found.instruction == "HAND" and "ON" in found.accepts and word in _HAND_WORDS:
        return instruction_hint(word)
    if found.kind == "NAME" and (guess := near(word, found.accepts & KEYWORDS)):
        return f"did you mean {guess}?"
    if "_COMMA" in found.accepts and _lacks_comma(found, word):
        return f"write a comma before {word}"
    if found.accepts <= _END and word not in INSTRUCTIONS and found.before.strip().upper() in INSTRUCTIONS:
        return f"{found.instruction} takes no value: remove {quote(found.text)}"
    if "$END" in found.accepts and (word in INSTRUCTIONS or found.kind == "NAME"):
        return "write one instruction on each line"
    if found.kind == "EQ" and found.instruction in RESERVED | NEW:  # of a new word: an older program's variable
        return f"{found.instruction} is a word of the language and cannot be a name"
    if "NAME" in found.accepts and word in RESERVED:
        return f"{word} is a word of the language and cannot be a name"
    form = form_of("WRIST" if _last_word(found.before).upper() in ("WRIST", "HOLD") else found.instruction)
    return form or _completion(found)


def _completion(found: Unexpected) -> str:
    """Return what makes a statement whole where nothing is known of what was meant."""
    if found.kind in _END:
        return f"complete the statement: write {_expected(found)} here"
    if "$END" not in found.accepts:
        return f"write {_expected(found)} in place of {quote(found.text)}"
    sign = ", or write the sign that is missing before it" if "PLUS" in found.accepts else ""
    return f"remove {quote(found.text)}{sign}"


def _slip(found: Unexpected, word: str) -> str:
    """Return the remedy of a usual slip: a unit, a decimal comma, a parenthesis, a text in single quotes; or ``""``."""
    before = found.before.rstrip(" \t")
    number = None if found.accepts >= _VALUE or _WAIT_TIME.match(before) else _NUMBER.search(before)
    if number is not None and (hint := _unit(before[: number.start()], number[0], found.text + found.after)):
        return hint
    if found.kind == "COMMENT" and found.accepts >= _VALUE and (quoted := _QUOTED.match(found.text)):
        return f'\' begins a comment; a text stands in double quotes: "{quote(quoted[1])}"'
    if found.text == ":" and re.fullmatch(r"\*[ \t]*\w+", before):
        return f"a label has no colon: {quote(before)}"
    return _decimal(found) or _parenthesis(found, word) or _bracket(found, before)


def _unit(before: str, number: str, rest: str) -> str:
    """Return the remedy for a unit that ``rest`` begins with, after a number and the text ``before`` it, or ``""``."""
    unit = _UNIT.match(rest)
    if unit is None:
        return ""
    words = [each.upper() for each in re.findall(r"[A-Za-z]+", before)]
    word = next((each for each in reversed(words) if each in _UNIT_OF), "")
    is_joint = word == "SPEED" and words[0] == "MOVEJ"
    scale = _SCALES["%" if is_joint else _UNIT_OF[word]].get(unit[1].lower()) if word else None
    if scale is None:
        return "write no unit: lengths are in mm, angles in degrees, masses in kg, times in s"
    return f"write no unit, {word} is in {'%' if is_joint else _UNIT_OF[word]}: {float(number) * scale:.10g}"


def _open(before: str) -> int:
    """Return how many parentheses are open at the end of a text."""
    plain = re.sub(r'"[^"]*"', "", before)
    return plain.count("(") - plain.count(")")


def _decimal(found: Unexpected) -> str:
    """Return the remedy for a decimal comma, or ``""``."""
    if _open(found.before) or found.instruction in _LISTS:
        return ""
    if found.kind == "_COMMA":
        whole, part = _WHOLE.search(found.before), _FRACTION.match(found.after)
    else:
        whole, part = _OPTION_COMMA.search(found.before), _FRACTION.fullmatch(found.text)
    return f"a number has a decimal point: {quote(f'{whole[1]}.{part[0]}')}" if whole and part else ""


def _parenthesis(found: Unexpected, word: str) -> str:
    """Return the remedy for a parenthesis that is missing or one too many, or ``""``."""
    if found.kind == "RPAR":
        return "" if _open(found.before) else "remove this ), no ( belongs to it"
    if "RPAR" not in found.accepts or found.accepts >= _VALUE:
        return ""
    if found.kind in _END:
        return "a ) is missing at the end"
    return f"a ) is missing before {word}" if word in KEYWORDS else ""


def _bracket(found: Unexpected, before: str) -> str:
    """Return what is written in place of [ of another language by the word that it follows, or ``""``."""
    if found.text != "[":
        return ""
    word = _last_word(before).upper()
    if found.instruction in MOTIONS and word in ("P", "PR"):
        number = re.match(r"[ \t]*([0-9]+)[ \t]*\]", found.after)
        return f"a taught point is a name, as in {found.instruction} P{number[1] if number else 1}"
    if found.instruction in MOTIONS and before.upper().rstrip(" \t(") == found.instruction:
        joints = found.instruction == "MOVEJ"
        return f"write {found.instruction} " + ("JOINT(j1, ..., j6)" if joints else "POSE(x, y, z, rx, ry, rz)")
    return other_languages.assigned(word, element=True)


def _elsewhere(found: Unexpected, word: str) -> str:
    """Return the remedy where a word or sign of another language stands, or ``""``."""
    before, rest = found.before.rstrip(" \t"), found.text + found.after
    if (sign := re.match(":?=", rest)) and (setting := _last_word(before).upper()) in _SETTINGS:
        return f"leave {sign[0]} out: {form_of(before) or f'{setting} value'}"
    if found.text == "=":
        return other_languages.sign("==") if found.before.endswith("=") else ""
    if assigns := _ASSIGNS.match(rest):
        name = _last_word(before)
        if assigns[1]:
            return f"write {name} = {name} {assigns[1]} {'value' if rest[1] == '=' else '1'}"
        return f"= assigns: {name} =" if "=" in assigns[0] else f"*{name} at the start of a line is a label"
    if found.kind == "_SEMICOLON" and (found.is_first or "$END" in found.accepts):
        return "a comment begins with ' or REM, and no ; ends a line"
    if found.kind == "OTHER" or (found.is_first and found.kind in ("SLASH", "MINUS")):
        return other_languages.sign(rest)
    if found.accepts >= _VALUE and word in other_languages.VALUES:
        return other_languages.VALUES[word]
    return _instead(found, word, before)


def _instead(found: Unexpected, word: str, before: str) -> str:
    """Return what is written in place of a word of another language, by the instruction that it follows."""
    if found.is_first:
        if word == "INT" and not found.after.lstrip().startswith(("=", "(")):
            return other_languages.instruction("VAR")
        return "IN reads an input: x = IN(1)" if word == "IN" else ""
    if found.instruction == "WAIT" and (word == "FOR" or _WAIT_TIME.fullmatch(before)):
        return other_languages.instruction("WAITUNTIL" if word == "FOR" else "SLEEP")
    if found.kind == "_COMMA" and found.instruction == "PRINT":
        return "; stands between the values of PRINT"
    if "THEN" in found.accepts and word in INSTRUCTIONS:
        return f"write THEN before {word}"
    if found.kind == "ENDIF" and found.instruction == "IF":
        return "an IF on one line has no ENDIF"
    if found.kind != "NAME":
        return _of_first_word(found)
    if found.instruction in ("GOTO", "GOSUB"):
        return f"a label is written with *: {found.instruction} *{found.text}"
    if word == "DIV":
        return "INT(a / b) is the whole part of a quotient"
    if word in ("DO", "BEGIN") and "$END" in found.accepts:
        return f"leave {found.text} out"
    instead = other_languages.setting(found.text) if found.instruction in MOTIONS else ""
    return instead or _of_first_word(found)


def _of_first_word(found: Unexpected) -> str:
    """Return what stands for the word that begins a statement; an ordinary name where a value is assigned to it."""
    return "" if _ASSIGNMENT.match(found.before) else other_languages.instruction(found.instruction)


def _lacks_comma(found: Unexpected, word: str) -> bool:
    """Return whether a word would be right behind a comma: the next option, or the next component of a HOLD."""
    if word in COMPONENTS:
        return _last_word(found.before).upper() in COMPONENTS
    return found.instruction in MOTIONS and word in _OPTIONS
