"""Robot files in XML, read without trust: URDF and MJCF pass here before any library sees them.

The text is parsed by expat with a handler for every start tag, so that each element keeps its line and column and
every error is a ``FileFault`` at its place. Refused while reading: a document type (RBL601: with it go entities,
the only means by which XML can name other files or to grow without bound), more than ``MAX_DEPTH`` levels or
``MAX_ELEMENTS`` elements (RBL612), a plugin of an MJCF (RBL614), a number that is not finite (RBL604) and a file name
that leads out of the folder (RBL602). Of a URDF only the elements that are read are judged (``urdf_elements``). Nothing
that a file names is ever opened. Standard library only.
"""

import math
import re
from collections.abc import Iterator
from typing import NoReturn
from xml.parsers import expat

import runtime.robot.files.codes  # noqa: F401 - registers what is raised here
from runtime.core.bounded_files import stays_inside
from runtime.core.numerals import number_in, why_none
from runtime.core.record import Record, default
from runtime.core.tomlfile import MAX_ABS, FileFault, FilePlace, Source
from runtime.robot.files.urdf_elements import MACROS, URDF

_LINE_END = re.compile(r"\r\n?|\n")  # XML 2.11: a CR alone ends a line, too
MAX_DEPTH = 100
MAX_ELEMENTS = 50_000
"""Far more than an arm with its shapes has, and little enough to be held in memory."""
HEAVIEST_LINK = 10_000.0
"""Heaviest link, kg."""
FARTHEST = 10.0
"""No part of an arm is further from the one before it, m, as in robot files in TOML."""

_TEXTS = frozenset(
    [
        "name",
        "class",
        "childclass",
        "joint",
        "joint1",
        "joint2",
        "link",
        "parent",
        "child",
        "body",
        "body1",
        "body2",
        "mesh",
        "material",
        "site",
        "target",
        "type",
        "version",
        "model",
        "xmlns",
        "group",
        "objname",
        "tendon",
        "key",
        "texture",
        "camera",
        "user",
    ]
)
"""Attributes whose text is a name even where it looks like a number."""

_SPACE = re.compile(r"[ \t\r\n]+")
"""What separates numbers in XML; Python's ``split`` also takes spaces of Unicode."""

_FILES = frozenset(["file", "filename", "meshdir", "texturedir", "assetdir"])


class Element(Record, kw_only=False):
    """One element: ``tag``, ``attributes``, ``children`` and its 1-based place in ``source``."""

    source: Source
    tag: str
    attributes: dict[str, str]
    line: int
    column: int
    children: "list[Element]" = default(factory=list)

    def fault(self, code: str, message: str, hint: str = "") -> FileFault:
        """Return a fault at this element."""
        return fault_at(self.source, self.line, self.column, code, message, hint)

    def fail(self, code: str, message: str, hint: str = "") -> NoReturn:
        """Raise ``FileFault`` at this element."""
        raise self.fault(code, message, hint)

    def all(self, tag: str) -> "list[Element]":
        """Return the children with a tag."""
        return [child for child in self.children if child.tag == tag]

    def one(self, tag: str) -> "Element | None":
        """Return the child with a tag, None without one; two are refused (RBL610)."""
        found = self.all(tag)
        if len(found) > 1:
            found[1].fail("RBL610", f"<{self.tag}> has two <{tag}>")
        return found[0] if found else None

    def walk(self) -> "Iterator[Element]":
        """Yield this element and everything in it, in file order."""
        todo = [self]
        while todo:
            element = todo.pop()
            yield element
            todo.extend(reversed(element.children))

    def walk_read(self) -> "Iterator[Element]":
        """Yield this element of a URDF and what is read of it, in file order; what is left out is left out."""
        todo = [self]
        while todo:
            element = todo.pop()
            yield element
            todo.extend(child for child in reversed(element.children) if child.tag in URDF[element.tag].children)

    def text(self, key: str, default: str | None = None) -> str:
        """Return an attribute; RBL608 when it is missing and has no default."""
        value = self.attributes.get(key, default)
        if value is None:
            self.fail("RBL608", f"<{self.tag}> has no '{key}'")
        return value

    def numbers(self, key: str, count: int, default: tuple[float, ...] | None = None) -> tuple[float, ...]:
        """Return ``count`` finite numbers of an attribute; RBL608, RBL613 or RBL604."""
        if key not in self.attributes and default is not None:
            return default
        return parse_numbers(self, key, self.text(key), count)

    def point(self, key: str) -> tuple[float, ...]:
        """Return a point (3,) m, the origin when it is left out; RBL605 for one further than ``FARTHEST``."""
        values = self.numbers(key, 3, (0.0,) * 3)
        for value in values:
            if not abs(value) <= FARTHEST:
                self.fail(
                    "RBL605",
                    f"'{key}' of <{self.tag}> has {value:g} m and must be within {FARTHEST:g} m: it looks like mm",
                    f"lengths are in m; write {value / 1e3:g} for {value:g} mm",
                )
        return values

    def number(self, key: str, default: float | None = None, *, low: float = -MAX_ABS, high: float = MAX_ABS) -> float:
        """Return one finite number in ``[low, high]``; RBL608, RBL613, RBL604 or RBL605."""
        value = self.numbers(key, 1, None if default is None else (default,))[0]
        if not value >= low:
            self.fail("RBL605", f"'{key}' of <{self.tag}> is {value:g} and must be {low:g} or more")
        if not value <= high:
            self.fail("RBL605", f"'{key}' of <{self.tag}> is {value:g} and must be {high:g} or less")
        return value


def parse_numbers(element: Element, key: str, text: str, count: int) -> tuple[float, ...]:
    """Return ``count`` finite numbers of ``text``; ``FileFault`` at the element."""
    parts = _parts(text)
    if len(parts) != count:
        form = "one number" if count == 1 else f"{count} numbers"
        element.fail("RBL613", f"'{key}' of <{element.tag}> must be {form}, not {_shown(text)}")
    values = []
    for part in parts:
        value = number_in(part)
        if value is None:
            element.fail("RBL613", f"'{key}' of <{element.tag}> is {_shown(text)}, not a number{why_none(part)}")
        if not abs(value) <= MAX_ABS:
            element.fail("RBL604", f"'{key}' of <{element.tag}> is {_shown(part)}, not a finite number")
        values.append(value)
    return tuple(values)


def fault_at(source: Source, line: int, column: int, code: str, message: str, hint: str = "") -> FileFault:
    """Return a ``FileFault`` at a place (1-based) of a source."""
    lines = _LINE_END.split(source.text)
    excerpt = lines[line - 1] if 0 < line <= len(lines) else ""
    return FileFault(code, message, hint, FilePlace(source.path, line, column, excerpt))


def parse_xml(source: Source) -> Element:
    """Return the root element of a bounded, inert XML text; ``FileFault`` RBL601, 602, 604, 612 or 614."""
    root = _parse(source)
    if root.tag == "robot":
        _check_expanded(root)
    for element in root.walk_read() if root.tag == "robot" else root.walk():
        _check(element)
    return root


def _check_expanded(robot: Element) -> None:
    """Refuse the macros of xacro, wherever they stand in a URDF: they may stand for links (RBL621)."""
    # other names with a colon belong to simulators and are left out
    old = [element for element in robot.children if element.tag in MACROS]
    for element in (*old, *(each for each in robot.walk() if each.tag.startswith("xacro:"))):
        element.fail(
            "RBL621",
            f"<{element.tag}> is a macro of xacro, which is not expanded here",
            "expand the file first, where its package is installed: xacro arm.urdf.xacro > arm.urdf",
        )


def _parse(source: Source) -> Element:
    parser = expat.ParserCreate("utf-8")  # whatever encoding the file declares: its text is decoded already
    stack: list[Element] = []
    roots: list[Element] = []
    count = 0

    def place() -> tuple[int, int]:
        return parser.CurrentLineNumber, parser.CurrentColumnNumber + 1

    def refuse(code: str, message: str, hint: str = "") -> NoReturn:
        raise fault_at(source, *place(), code, message, hint)

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal count
        count += 1
        # counted while reading, so that a hostile file is refused before its tree exists
        if len(stack) >= MAX_DEPTH:
            refuse("RBL612", f"elements are nested more than {MAX_DEPTH} deep")
        if count > MAX_ELEMENTS:
            refuse("RBL612", f"the file has more than {MAX_ELEMENTS} elements")
        line, column = place()
        element = Element(source, tag, attributes, line, column)
        (stack[-1].children if stack else roots).append(element)
        stack.append(element)

    def doctype(*_: object) -> None:
        refuse(
            "RBL601",
            "a document type (<!DOCTYPE) is not read: it can name other files and grow without bound",
            "remove the <!DOCTYPE ...> declaration and write its entities out",
        )

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda _: stack.pop()
    parser.StartDoctypeDeclHandler = doctype
    try:
        parser.Parse(source.text.encode("utf-8"), True)
    except expat.ExpatError as error:
        message = f"not well-formed XML: {expat.ErrorString(error.code)}"
        raise fault_at(source, error.lineno, error.offset + 1, "RBL601", message, "correct the place named") from None
    return roots[0]


def _check(element: Element) -> None:
    if element.tag in ("plugin", "extension"):
        element.fail("RBL614", f"<{element.tag}> asks for code to be loaded")
    if ":" in element.tag:
        element.fail("RBL621", f"<{element.tag}> is of another language than MJCF", "remove it")
    for key, value in element.attributes.items():
        if is_elsewhere(element):
            continue
        if key in _FILES:
            check_path(element, key, value)
        elif key not in _TEXTS:
            _check_finite(element, key, value)


def is_elsewhere(element: Element) -> bool:
    """Return whether an element is a mesh at an absolute place of another computer, which is left out.

    ROS writes ``file:///opt/ros/...`` when it expands macros. Such a mesh is never opened, and pictures do without it.
    """
    return element.tag == "mesh" and element.attributes.get("filename", "").startswith("file://")


def _check_finite(element: Element, key: str, text: str) -> None:
    values = [number_in(part) for part in _parts(text)]
    if None in values:
        return  # a text; a reader that needs a number there refuses it
    for value in values:
        if value is not None and not math.isfinite(value):
            element.fail("RBL604", f"'{key}' of <{element.tag}> is {_shown(text)}, not a finite number")


def check_path(element: Element, key: str, text: str) -> None:
    """Refuse a file name that leads out of the folder of the robot file (RBL602), on any system."""
    # schemes that name a folder by a package; what is left must be a relative path on every system, on which the file
    # may be opened later
    name = re.sub(r"^(package|model)://", "", text)
    if "://" in name or not stays_inside(name):
        element.fail("RBL602", f"'{key}' of <{element.tag}> is {_shown(text)}, not a path inside the folder")


def _parts(text: str) -> list[str]:
    return [part for part in _SPACE.split(text) if part]


def _shown(text: str) -> str:
    return repr(text if len(text) <= 40 else f"{text[:37]}...")
