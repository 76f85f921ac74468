"""From a token that no rule accepts to a diagnostic in the user's words.

The parser stops a line at the first token that cannot follow. The message says what could stand there
(``unexpected``), the hint what was probably meant (``hints``). Exactly one diagnostic for a line. Called by the parser
for lines with an error only.
"""

import re

from robolang.core.diagnostics import Diagnostic
from robolang.core.source import Span
from robolang.syntax import foreign_calls, foreign_lines, other_languages
from robolang.syntax.hints import ASSIGNMENT, ASSIGNS, hint_of, unit_hint
from robolang.syntax.keywords import COMPONENTS6, KEYWORDS, code_point, instruction_hint, look_alike, near
from robolang.syntax.unexpected import END, Unexpected, expected, last_word, quote

_LIKENESS = 0.8
"""How alike a word and SPLINE are where that is meant, and not a call."""


def explain(found: Unexpected) -> Diagnostic:
    """Return the one diagnostic for an unexpected token."""
    if found.kind in ("SUSPICIOUS", "OTHER") and not found.text.isascii():
        return suspicious(found.text, found.span.start)
    if found.kind == "HUGE":
        message = f"the number {quote(found.text)} is too large"
        return Diagnostic(code="RBL114", message=message, span=found.span)
    # the component first: P1 of P1.X = 5 would be called an unknown instruction
    return _component(found) or _call(found) or _malformed(found) or _unknown(found) or _unexpected(found)


def suspicious(text: str, start: int) -> Diagnostic:
    """Return RBL103 for the first character that is not printable ASCII; ``text`` stands at ``start``."""
    index = next(i for i, character in enumerate(text) if not (character.isascii() and character.isprintable()))
    character = text[index]
    twin = look_alike(character)
    hint = f"it looks like {'a space' if twin == ' ' else repr(twin)}; retype it" if twin else ""
    span = Span(start + index, start + index + 1)
    return Diagnostic(code="RBL103", message=f"suspicious character {code_point(character)}", span=span, hint=hint)


def _malformed(found: Unexpected) -> Diagnostic | None:
    """Return RBL115 for what begins as a number and is none."""
    if found.kind != "MALFORMED":
        return None
    text, hint = found.text, foreign_lines.advice(found.line)
    if hint:
        pass  # 250mm/sec of a line that is known as a whole
    elif found.is_first and re.fullmatch(r"[0-9]+[A-Za-z]+", text):
        hint = "leave a space between the line number and the instruction"
    elif re.fullmatch(r"[0-9.]*[0-9][0-9_.]*", text) and "_" in text:
        hint = f"write {quote(text.replace('_', ''))}"
    elif unit := re.fullmatch(r"([0-9]+(?:\.[0-9]+)?|\.[0-9]+)([a-z]+)", text, re.IGNORECASE):
        hint = unit_hint(found.before, unit[1], unit[2] + found.after)
    return Diagnostic(code="RBL115", message=f"'{quote(text)}' is not a number", span=found.span, hint=hint)


def _is_after_first_name(found: Unexpected) -> bool:
    """Return whether a statement begins with a name and the token is what follows it."""
    return (
        # = that assigns is accepted without <, = that compares with it
        {"EQ", "LPAR"} <= found.accepts
        and "LESS" not in found.accepts
        and re.fullmatch(r"[^\W\d]\w*\$?", last_word(found.before)) is not None
    )


def _component(found: Unexpected) -> Diagnostic | None:
    """Return RBL111 for a component of a pose that a value is assigned to."""
    part = re.match(r"(?i)(x|y|z|rx|ry|rz)[ \t]*=", found.after)
    if found.kind != "_DOT" or part is None or not _is_after_first_name(found):
        return None
    pose, end = last_word(found.before), found.span.end + len(part[1])
    values = ", ".join("value" if each == part[1].upper() else f"{pose}.{each}" for each in COMPONENTS6)
    return Diagnostic(
        code="RBL111",
        message=f"a component of a pose cannot be assigned: {pose}.{part[1].upper()}",
        span=Span(found.span.start, end),
        hint=f"write {pose} = POSE({values})",
    )


def _call(found: Unexpected) -> Diagnostic | None:
    """Return RBL112 for a line as ``sleep(0.5)`` of other languages: up to its end it could be one of this language."""
    call = re.match(r"[A-Za-z]\w*(?=[ \t]*\()", found.before)
    known = call and (other_languages.instruction(call[0]) or _misspelt(call[0]))
    if call and known and not ASSIGNMENT.match(found.line):
        return _unknown_word(found, call[0], found.span.start - len(found.before))
    # pick(1, 2) of a subroutine: its name is the mistake, not the sign at which an element of an array ends
    sub = foreign_calls.unknown(found.line) if "(" in found.before else None
    return _unknown_word(found, sub.name, found.span.start - len(found.before) + sub.start) if sub else None


def _unknown(found: Unexpected) -> Diagnostic | None:
    """Return RBL112 for a name that begins a statement and is not assigned to."""
    word = last_word(found.before)
    if not _is_after_first_name(found) or ASSIGNS.match(found.text + found.after):
        return None
    # the word is the mistake, not the token that follows it and stopped the parser
    return _unknown_word(found, word, found.span.start - len(found.before) + len(found.head) - len(word))


def _unknown_word(found: Unexpected, word: str, start: int) -> Diagnostic:
    message = f"unknown instruction '{quote(word)}'"
    sub = foreign_calls.unknown(found.line)
    hint = foreign_lines.advice(found.line) or _misspelt(word) or (sub.advice if sub else instruction_hint(word))
    return Diagnostic(code="RBL112", message=message, span=Span(start, start + len(word)), hint=hint)


def _misspelt(word: str) -> str:
    """Return what is meant by a word like SPLINE, whose parentheses look like those of a call, or ``""``."""
    fits = word.upper() != "SPLINE" and near(word, ("SPLINE",), cutoff=_LIKENESS)
    return "did you mean SPLINE?" if fits else ""


def _unexpected(found: Unexpected) -> Diagnostic:
    message = f"expected {expected(found)}{_after(found.before)}"
    hint = foreign_lines.advice(found.line) or hint_of(found)
    if found.kind in END:
        # nothing stands there, so the place has no width
        end = found.span.start
        return Diagnostic(code="RBL111", message=message, span=Span(end, end), hint=hint)
    shown = quote(found.text) if re.match(r"\w", found.text) else f"'{found.text}'"
    return Diagnostic(code="RBL111", message=f"{message}, not {shown}", span=found.span, hint=hint)


def _after(before: str) -> str:
    word = last_word(before)
    if not word:
        return ""
    if not re.match(r"[\w.]", word):
        return f" after '{word}'"
    return f" after {word.upper() if word.upper() in KEYWORDS else quote(word)}"
