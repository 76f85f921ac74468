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
_TURN = rf"(?:[ ]*\\R[xyz][ ]*:=[ ]*{_NUMBER})?"
_SHIFTED = rf"(?:OFFS|RELTOOL)[ ]*\([ ]*[A-Za-z_]\w*[ ]*,[ ]*{_LIST}{_TURN}[ ]*\)"
# components of KRL in any order; those of a turn where the motion is in the tool
_PART = rf"[XYZ][ ]*{_NUMBER}"
_TURNED_PART = rf"[XYZABC][ ]*{_NUMBER}"
_AXES = rf"\{{[ ]*{_PART}(?:[ ]*,[ ]*{_PART})*[ ]*\}}"
_TURNED_AXES = rf"\{{[ ]*{_TURNED_PART}(?:[ ]*,[ ]*{_TURNED_PART})*[ ]*\}}"
_ZEROS = r"(?:[ ]*,[ ]*0(?:\.0*)?){3}[ ]*"
_POSED = rf"p[ ]*\[[ ]*{_LIST}[ ]*\]"
_HERE = r"(?:get_actual_tcp_pose|get_forward_kin)[ ]*\([ ]*\)"
_TRANS = rf"pose_trans[ ]*\([ ]*(?:{_HERE}|{_POINT})[ ]*,[ ]*p[ ]*\[[ ]*{_LIST}{_ZEROS}\][ ]*\)"
_APPRO = rf"appro[ ]*\([ ]*[A-Za-z_]\w*[ ]*,[ ]*\{{[ ]*{_LIST}{_ZEROS}\}}[ ]*\)"
_COMPONENTS = ("X", "Y", "Z", "RX", "RY", "RZ")
_IO = re.compile(
    r"(?i)(?:\$IN|\bS?DI|\bDIN|\bRI|\bGI|\bM_IN|\bIN#|\bIN|\bIO|\bget_(?:standard_|tool_)?digital_in)"
    r"[ ]*[\[(][ ]*(0*[1-9]\d*)[ ]*(?::[^\])]*)?[\])]"
)
# numbers begin at 1 here: input 0 of URScript is another one, and its number is not carried over
_INPUT_0 = re.compile(r"(?i)\bget_(?:standard_|tool_)?digital_in[ ]*\([ ]*0+[ ]*\)")
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
    offset, _, turn = found[3].partition("\\")
    numbers = list(map(number, offset.split(",")[:3]))
    if turn:
        axis, _, angle = turn.upper().partition(":=")
        numbers += [number(angle) if each == axis.strip() else "0" for each in ("RX", "RY", "RZ")]
    return f"{found[2]} {sign} ({', '.join(numbers)})"


def axes(text: str) -> str:
    """Return the offset that a structure of KRL is: ``(0, 0, 50)`` for ``{Z 50}``, with the turns where it has any."""
    found = {axis.upper(): number(value) for axis, value in re.findall(rf"(?i)([XYZABC])[ ]*({_NUMBER})", text)}
    # A turns about Z, B about Y and C about X
    names = "XYZCBA" if found.keys() & set("ABC") else "XYZ"
    return f"({', '.join(found.get(name, '0') for name in names)})"


def posed(text: str) -> str:
    """Return the pose that p[x, y, z, rx, ry, rz] of URScript is; only without a turn its last numbers are the same."""
    numbers = [float(each) for each in text[text.index("[") + 1 :].rstrip("] ").split(",")]
    turn = "0, 0, 0" if len(numbers) == 6 and not any(numbers[3:]) else "rx, ry, rz"
    return f"POSE({', '.join(plain(round(each * 1000, 6)) for each in numbers[:3])}, {turn})"


def moved(text: str, unit: float) -> str:
    """Return the point that ``pose_trans`` or ``appro`` gives, as an offset in the tool, ``unit`` mm."""
    found = re.search(rf"\([ ]*({_HERE}|{_POINT})[ ]*,\D*({_LIST})", text, re.IGNORECASE)
    if found is None:
        return ""
    numbers = [plain(round(float(each) * unit, 6)) for each in found[2].split(",")[:3]]
    return f"{from_here(found[1])} * ({', '.join(numbers)})"


def from_here(text: str) -> str:
    """Return a point, or HERE for the function that gives the pose of the tool."""
    return "HERE" if text.rstrip().endswith(")") else point(text)


def element(text: str) -> str:
    """Return the assignment to a component of a position register, as of ``PR[1,3]=PR[1,3]+100``."""
    found = re.fullmatch(r"(?i)PR\[(\d+),([1-6])\][ ]*=[ ]*(.+)", text.strip())
    return "" if found is None else component(f"PR{found[1]}", int(found[2]) - 1, registers(found[3]))


def component(pose: str, index: int, value: str) -> str:
    """Return what gives a component of a pose a value; a shift where the value is the component and a number."""
    name = _COMPONENTS[index]
    number_of = re.compile(r"(?i)PR[ ]*\[[ ]*(\d+)[ ]*,[ ]*([1-6])[ ]*\]")
    value = number_of.sub(lambda found: f"PR{found[1]}.{_COMPONENTS[int(found[2]) - 1]}", value)
    shift = re.fullmatch(rf"(?i){re.escape(pose)}\.{name}[ ]*([-+])[ ]*({_NUMBER})", value)
    if shift and index < 3:
        offset = ["0", "0", "0"]
        offset[index] = number(shift[2]) if shift[1] == "+" else number(f"-{shift[2]}")
        return f"{pose} = {pose} + ({', '.join(offset)})"
    values = ", ".join(value if each == name else f"{pose}.{each}" for each in _COMPONENTS)
    return f"{pose} = POSE({values})"


def trans(text: str) -> str:
    """Return the assignment to a component of a position of RAPID, as of ``p10.trans.z := p10.trans.z + 50``."""
    found = re.fullmatch(r"(?i)(\w+)\.trans\.([xyz])[ ]*:=[ ]*(.+)", text.strip())
    if found is None:
        return ""
    value = re.sub(r"(?i)\.trans\.", ".", found[3])
    return component(found[1], "xyz".index(found[2].lower()), value)


def inputs(text: str) -> str:
    """Return an expression with the inputs of this language in place of those of others."""
    text = _INPUT_0.sub("IN(n)", text)
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


def _noted(note: str) -> Callable[[str], str]:
    """Return what writes a note for a text that was found."""
    return lambda text: note.format(text=text)


def radius(text: str) -> str:
    """Return the option for a blend radius of URScript, in m; 0 is none."""
    return f", ZONE {plain(float(text) * 1000)}" if float(text) else ""


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


def joined(text: str) -> str:
    """Return what PRINT shows for texts that + joins, numbers as they are."""
    items = re.findall(r'"[^"]*"|NumToStr[ ]*\([ ]*(?:\w+)|\w+(?=[ ]*(?:\+|\Z))', text, re.IGNORECASE)
    return "; ".join(re.sub(r"(?i)NumToStr[ ]*\([ ]*", "", item) for item in items)


def last_words(text: str) -> str:
    """Return the names of parameters without their types: ``a, b`` for ``num a, num b``."""
    return ", ".join(each.split()[-1] for each in text.split(","))


def registers(text: str) -> str:
    """Return a value with names in place of registers: ``R1`` for ``R[1]`` and for ``R[1:count]``."""
    return re.sub(r"(?i)\b([RFID])[ ]*\[[ ]*(\d+)[^\]]*\]", r"\1\2", text).strip()


class Reading(NamedTuple):
    """An expression, what writes the text that it has found, and what is written where it has found none.

    ``with_word``: the first word of the line stands before the text that is written.
    """

    pattern: str
    write: Callable[[str], str] = str
    absent: str = ""
    with_word: bool = False


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
    "radius": Reading(_NUMBER, radius),
    "cmm": Reading(_NUMBER, _scaled(10 / 60, "SPEED")),
    "rate": Reading(r"R[ ]*\[[ ]*\d+[^\]]*\]", lambda text: f", SPEED {registers(text)}"),
    "time": Reading(rf"(?!0*\.?0*(?![\d.])){_NUMBER}", _scaled(1, "TIME")),
    "accel": Reading(r"(?:100|\d{1,2})\b", _scaled(1, "ACCEL")),
    "exact": Reading(r"PL[ ]*=[ ]*0\b", lambda _: ", FINE"),
    "shift": Reading(_AXES, axes),
    "moved": Reading(_TURNED_AXES, axes),
    "posed": Reading(_POSED, posed),
    "turned": Reading(_TRANS, lambda text: moved(text, 1000)),
    "appro": Reading(_APPRO, lambda text: moved(text, 1)),
    "pose": Reading(rf"(?:{_HERE}|{_POINT})", from_here),
    "joints": Reading(rf"\[[ ]*{_LIST}[ ]*\]", lambda text: f"JOINT({_list(180 / math.pi, 3, 20)(text.strip('[] '))})"),
    "shifted": Reading(_SHIFTED, place),
    "trans": Reading(r"\.trans\.[xyz][ ]*:=.+", trans, with_word=True),
    "typed": Reading(r"[A-Za-z]\w*[ ]+[A-Za-z]\w*(?:[ ]*,[ ]*[A-Za-z]\w*[ ]+[A-Za-z]\w*)*", last_words),
    "taken": Reading(
        r"[A-Za-z]\w*[ ]*:[ ]*IN(?:[ ]*,[ ]*[A-Za-z]\w*[ ]*:[ ]*IN)*",
        lambda text: re.sub(r"(?i)[ ]*:[ ]*IN\b", "", text),
    ),
    "names": Reading(r"[A-Za-z]\w*(?:[ ]*,[ ]*[A-Za-z]\w*)*"),
    "arguments": Reading(r"[^;'{}\\]+", lambda text: registers(inputs(text))),
    "target": Reading(r"\*?\w+", lambda text: text if text[0] in "*0123456789" else f"*{text}"),
    "rounds": Reading(r"[1-9]\d{0,8}", lambda text: str(int(text) - 1)),
    "bound": Reading(r"[A-Za-z_]\w*|" + _NUMBER),
    "joined": Reading(r'"[^"]*"(?:[ ]*\+[ ]*(?:"[^"]*"|NumToStr[ ]*\([ ]*\w+[ ]*,[ ]*\d+[ ]*\)|\w+))+', joined),
    "option": Reading(r"\w+[ ]*=.*"),
    "element": Reading(r"\[\d+,[1-6]\][ ]*=.+", element, with_word=True),
    # what stands in a note, and not in the statement
    "vector": Reading(
        rf"(?=p[ ]*\[)(?!p[ ]*\[[ ]*{_NUMBER}[ ]*,[ ]*{_NUMBER}[ ]*,[ ]*{_NUMBER}{_ZEROS}\])",
        _noted("rx, ry and rz are angles in degrees, not a rotation vector"),
    ),
    "cnt": Reading(r"CNT[ ]*\d+", _noted("{text} is a percentage: ZONE is a radius in mm")),
    "level": Reading(r"PL[ ]*=[ ]*\d+", _noted("{text} is a level, ZONE a radius in mm")),
    "condition": Reading(r"[^;'\"{}\\]+", condition),
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
    # what is not carried over, which the hint names: none of these is written
    "more": Reading(r"(?:[ \t,;\\].*)?"),
    "among": Reading(r".*?"),
    "lost": Reading(r"[^,;(){}\\]+?"),
    "item": Reading(r"[A-Za-z_]\w*(?:\[\w*\])?"),
    "digit": Reading(r"\d"),
    "quoted": Reading(r"'[^']*'"),
    "switch": Reading(r"(?:\\[ ]*\w+(?:[ ]*:=[ ]*[\w.]+)?[ ]*)+"),
    "with": Reading(r"(?:Wth|WthIf|Type)\b.*"),
    "acc": Reading(r"(?:a[ ]*=[ ]*)?[\w.]+"),
    "vel": Reading(r"(?:v[ ]*=[ ]*)?[\w.]+"),
    "word": Reading(r"[A-Za-z_]\w*"),
}
LOST = frozenset(("more", "among", "lost", "item", "option", "digit", "quoted", "switch", "with", "acc", "vel"))
"""Readings of what is not carried over."""
_MACRO = re.compile(r"<([a-z]+)(\d?)>")
_BLANK = re.compile(r"\\.|\[(?:\\.|[^\]])*\]| ")
_FIELD = re.compile(r"\{([a-z]+\d?)\}")
_NAMES = re.compile(r"[a-z]+\d?")


def expression(text: str) -> str:
    """Return the expression of a pattern: readings for their names, any blanks for a blank."""
    # not those of a set of characters, which a blank begins or is one of
    with_blanks = _BLANK.sub(lambda found: "[ \\t]*+" if found[0] == " " else found[0], text)
    return _MACRO.sub(lambda found: f"(?P<{found[1]}{found[2]}>{READINGS[found[1]].pattern})", with_blanks)


def filled(template: str, found: dict[str, str | None]) -> str:
    """Return a statement with what the groups of a pattern have found."""

    def write(field: "re.Match[str]") -> str:
        reading = READINGS[field[1].rstrip("0123456789")]
        text = found.get(field[1])
        if text is None:
            return reading.absent
        return reading.write(f"{found['word']}{text}" if reading.with_word else text)

    return _FIELD.sub(write, template)
