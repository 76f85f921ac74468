"""Numbers and names in a line of another language, read by what they are and written as this language has them.

``<point>`` in the pattern of a shape stands for the expression of its reading; the text that it has found is written in
place of ``{point}``. A number after the name tells two of one kind apart: ``<n1>``.
"""

import math
import re
from collections.abc import Callable
from typing import NamedTuple

# digits in one place of the pattern only: two that could share them take quadratic time
_NUMBER = r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d{1,2})?"
_LIST = rf"{_NUMBER}(?:[ ]*,[ ]*{_NUMBER})*"
_POINT = r"#?[A-Za-z_]\w*(?:[ ]*\[[ ]*\d+[ ]*(?::[^\]]*)?\])?"
_SHIFTED = rf"(?:OFFS|RELTOOL)[ ]*\([ ]*[A-Za-z_]\w*[ ]*,[ ]*{_LIST}[ ]*\)"
_IO = re.compile(
    r"(?i)(?:\$IN|\bS?DI|\bDIN|\bRI|\bGI|\bM_IN|\bIN#|\bIN|\bIO|\bget_(?:standard_|tool_)?digital_in)"
    r"[ ]*[\[(][ ]*(0*[1-9]\d*)[ ]*(?::[^\])]*)?[\])]"
)
# numbers begin at 1 here: input 0 of URScript is another one, and is not carried over
_SIG = re.compile(r"(?i)\bSIG[ ]*\([ ]*1(\d{3})[ ]*\)")
# an output of a robot is read nowhere in this language, so IO of PacScript in a condition is an input
_STATES = {**dict.fromkeys(("ON", "TRUE", "HIGH", "1"), "1"), **dict.fromkeys(("OFF", "FALSE", "LOW", "0"), "0")}
_STATE_WORD = re.compile(r"(?i)\b(TRUE|FALSE|ON|OFF|HIGH|LOW)\b")
_SIGNS = (("==", "="), ("<>", "<>"), ("!=", "<>"), ("&&", " AND "), ("||", " OR "), ("!", "NOT "))
_SIGN = re.compile("|".join(re.escape(sign) for sign, _ in _SIGNS))


def plain(number: float) -> str:
    """Return a number of this language, without noise of binary fractions."""
    return f"{round(number, 9):.10g}"


def number(text: str) -> str:
    """Return a number as short as it can be written."""
    return plain(float(text))


def point(text: str) -> str:
    """Return the name of a point: ``P1`` for ``P[1]`` and for ``P[1:home]``, ``p1`` for ``#p1``."""
    found = re.fullmatch(r"#?(\w+)(?:[ ]*\[[ ]*(\d+).*)?", text)
    return f"{found[1]}{found[2] or ''}" if found else text


def place(text: str) -> str:
    """Return a point, or the point with the offset that RAPID's Offs and RelTool have."""
    found = re.fullmatch(r"(?i)(OFFS|RELTOOL)[ ]*\([ ]*(\w+)[ ]*,(.*)\)", text)
    if found is None:
        return point(text)
    # Offs shifts along the axes of the frame, RelTool along those of the tool
    sign = "+" if found[1].upper() == "OFFS" else "*"
    return f"{found[2]} {sign} ({', '.join(map(number, found[3].split(',')[:3]))})"


def inputs(text: str) -> str:
    """Return an expression with the inputs of this language in place of those of others."""
    return _SIG.sub(lambda found: f"IN({int(found[1])})", _IO.sub(lambda found: f"IN({int(found[1])})", text))


def condition(text: str) -> str:
    """Return a condition with the inputs, signs and values of this language."""
    text = registers(inputs(text))
    text = _STATE_WORD.sub(lambda found: _STATES[found[1].upper()], text)
    text = _SIGN.sub(lambda found: dict(_SIGNS)[found[0]], text)
    # IN(1) alone would do; with = 1 the line shows how 0 is compared
    if re.fullmatch(r"IN\(\d+\)", text.strip()):
        text = f"{text.strip()} = 1"
    # blanks around signs and none twice, as fmt writes them
    return " ".join(re.sub(r"(<>|<=|>=|=|<|>)", r" \1 ", text).split())


def zone(text: str) -> str:
    """Return the option for a zone of RAPID: ``z50`` is about 50 mm, ``z0`` 0.3 mm."""
    if text.upper() == "FINE":
        return ", FINE"
    return f", ZONE {'0.3' if text[1:] == '0' else number(text[1:])}"


def _scaled(unit: float, word: str = "") -> Callable[[str], str]:
    """Return what writes a number in another unit, after an option's ``word``."""
    return lambda text: f"{f', {word} ' if word else ''}{plain(float(text) * unit)}"


def _list(unit: float, digits: int, least: int) -> Callable[[str], str]:
    def write(text: str) -> str:
        numbers = [round(float(each) * unit, digits) for each in text.split(",")]
        return ", ".join(map(plain, numbers[:least]))

    return write


def passing(text: str) -> str:
    """Return the note on how a move of PacScript ends: @P and a distance blend, @E and @0 do not."""
    return "" if text.upper() in ("@0", "@E") else f"{text} blends: write ZONE mm for it"


def texts(text: str) -> str:
    """Return what PRINT shows, for texts and values between commas."""
    items = [item.strip() for item in re.findall(r"""(?:"[^"]*"|'[^']*'|[^,"'])+""", text)]
    kept = [item for item in items if item and item.upper() not in ("CR", "/S", "\\NEWLINE")]
    return "; ".join(f'"{item[1:-1]}"' if item[:1] in "\"'" else item for item in kept)


def signal(text: str) -> str:
    """Return what sets an output, or resets it where its number is negative, as in AS and V+."""
    return f"OUT({abs(int(text))}) = {0 if text.startswith('-') else 1}"


def awaited(text: str) -> str:
    """Return the condition for an input of AS and V+, where 1001 is the first one."""
    return f"IN({abs(int(text)) - 1000}) = {0 if text.startswith('-') else 1}"


def registers(text: str) -> str:
    """Return a value with names in place of registers: ``R1`` for ``R[1]`` and for ``R[1:count]``."""
    return re.sub(r"(?i)\bR[ ]*\[[ ]*(\d+)[^\]]*\]", r"R\1", text).strip()


class Reading(NamedTuple):
    """An expression, what writes the text that it has found, and what is written where it has found none."""

    pattern: str
    write: Callable[[str], str] = str
    absent: str = ""


READINGS = {
    "point": Reading(_POINT, point),
    "place": Reading(rf"(?:{_SHIFTED}|{_POINT})", place),
    "name": Reading(r"[A-Za-z_]\w*"),
    "n": Reading(r"0*[1-9]\d{0,5}", lambda text: str(int(text))),
    "num": Reading(_NUMBER, number),
    "away": Reading(rf"-[ ]*{_NUMBER}", lambda text: number(text.lstrip("- "))),
    "s": Reading(_NUMBER, number),
    "ms": Reading(_NUMBER, _scaled(1e-3)),
    "state": Reading(r"(?:ON|OFF|TRUE|FALSE|HIGH|LOW|1|0)\b", lambda text: _STATES[text.upper()], "1"),
    "pct": Reading(_NUMBER, _scaled(1, "SPEED")),
    "mms": Reading(_NUMBER, _scaled(1, "SPEED")),
    "mps": Reading(_NUMBER, _scaled(1000, "SPEED")),
    "speed": Reading(_NUMBER, _scaled(1000)),
    "zone": Reading(r"(?:FINE|z\d{1,3})\b", zone),
    "fine": Reading(r"FINE\b", lambda _: ", FINE"),
    "radius": Reading(_NUMBER, _scaled(1000, "ZONE")),
    "condition": Reading(r"[^;'\"{}]+", condition),
    "in": Reading(r"IN#[ ]*\([ ]*0*[1-9]\d*[ ]*\)", inputs),
    "rest": Reading(r".+", str.strip),
    "texts": Reading(r".+?", texts),
    "values": Reading(_LIST, _list(1, 9, 6)),
    "mm": Reading(_LIST, _list(1, 9, 3)),
    "m": Reading(_LIST, _list(1000, 6, 3)),
    "signal": Reading(r"[+-]?\d{1,4}", signal),
    "input": Reading(r"[+-]?1\d{3}", awaited),
    "registers": Reading(r"[^'\";]+", registers),
    "rad": Reading(_LIST, _list(180 / math.pi, 3, 20)),
    "pass": Reading(r"@\w+", passing),
    "more": Reading(r"(?:[ \t,;\\].*)?"),
    "word": Reading(r"[A-Za-z_]\w*"),
}
_MACRO = re.compile(r"<([a-z]+)(\d?)>")
_BLANK = re.compile(r"\\.|\[(?:\\.|[^\]])*\]| ")
_FIELD = re.compile(r"\{([a-z]+\d?)\}")
_NAMES = re.compile(r"[a-z]+\d?")


def expression(text: str) -> str:
    """Return the expression of a pattern: readings for their names, any blanks for a blank."""
    # not those of a set of characters, which a blank begins or is one of
    with_blanks = _BLANK.sub(lambda found: "[ \\t]*" if found[0] == " " else found[0], text)
    return _MACRO.sub(lambda found: f"(?P<{found[1]}{found[2]}>{READINGS[found[1]].pattern})", with_blanks)


def filled(template: str, found: dict[str, str | None]) -> str:
    """Return a statement with what the groups of a pattern have found."""

    def write(field: "re.Match[str]") -> str:
        reading = READINGS[field[1].rstrip("0123456789")]
        text = found.get(field[1])
        return reading.absent if text is None else reading.write(text)

    return _FIELD.sub(write, template)
