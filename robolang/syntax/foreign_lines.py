"""Whole lines of other languages as statements of this one, numbers carried over where that is sure.

A statement is proposed only where the reader of this language takes it, and as ``fmt`` would print it.
"""

import re
from dataclasses import replace

from robolang.syntax.foreign.readings import LOST, filled
from robolang.syntax.foreign.shape import Shape
from robolang.syntax.foreign.shapes import FIRST, compiled, of
from robolang.syntax.line_reader import Stopped, line_reader
from robolang.syntax.unparse import describe
from runtime.core.record import Record

_NUMBERED = "n is the number of the signal, from 1 on"
MOST = 160
"""Characters of a line that is still compared with the shapes: what is longer is no statement by hand."""
BEFORE = re.compile(r"[ \t]*(?:\*\w+(?=[ \t]+\S)|:)?")
"""What stands before a line: a label of this language, or the colon after the number of a line of TP."""
_REMARK = re.compile(
    r"(?<![ \t])[ \t]*+(?:;[ \t]*+(?!!|//)(?P<after>[^;]*)"
    r"|(?:;[ \t]*+!|(?<=[ \t])(?://|#|!|--)(?=[ \t]))(?P<text>.*))\Z"
)
"""A comment after a line: of RAPID after ; and !, of others after a sign with blanks; what stands after ; alone."""
_PRINT = re.compile(r"(?i)[ \t]*PRINT\b")


class Proposal(Record):
    """The statements to write for a line, and the kind of line that it is."""

    shape: Shape
    statements: tuple[str, ...]
    note: str

    @property
    def advice(self) -> str:
        """What to write here, as a hint."""
        write = f"write {' and '.join(self.statements)}" if self.statements else "remove the line"
        return f"{write}; {self.note}" if self.note else write


def proposal(code: str) -> Proposal | None:
    """Return what to write for a line of another language, without its line number; None for a line that is none."""
    # a hidden character is the error, wherever else the line comes from
    if len(code) > MOST or not code.replace("\t", " ").isprintable():
        return None
    # a label is of this language, and a line of another one may have been typed after it
    before = BEFORE.match(code)
    # JMP LBL[1]; of TP and RAPID: no sign ends a line here
    text = (code[before.end() :] if before else code).rstrip(" \t").removesuffix(";").rstrip(" \t")
    # of PRINT of this language ; stands between values
    remark = None if _PRINT.match(text) else _REMARK.search(text)
    # a quote that is open there: the sign stands in a text
    if remark and remark.start() and text[: remark.start()].count('"') % 2 == 0:
        found = _proposed(text[: remark.start()])
        # OUT(1) = 1; OUT(2) = 0 begins with a statement of this language: its mistake is the sign
        if found and found.statements != (canonical(text[: remark.start()]),):
            return _with_remark(found, remark)
    return _proposed(text)


def _proposed(text: str) -> Proposal | None:
    """Return what to write for a line without a sign at its end and without a comment."""
    first = FIRST.match(text)
    if first is None:
        return None
    for shape in of(first[1]):
        found = compiled(shape).fullmatch(text, first.end())
        if found is None:
            continue
        words = {**found.groupdict(), "word": first[1]}
        shown = tuple(map(canonical, filled(shape.write, words).splitlines()))
        if all(shown):
            note = _noted(shape, words, _lost(found))
            # input 0 of URScript has no number here
            numbered = "IN(n)" in "".join(shown) and "signal" not in note
            return Proposal(
                shape=shape, statements=shown, note=f"{_NUMBERED}; {note}".rstrip("; ") if numbered else note
            )
    return None


def _with_remark(found: Proposal, remark: "re.Match[str]") -> Proposal:
    """Return a proposal with the comment of the line, or with what stands after a ; as left out."""
    text = (remark["after"] or remark["text"] or "").strip()
    # after ; RAPID may have another statement, and KRL has a comment
    if text and remark["text"] is None:
        note = f"{found.note}, {text}" if "left out: " in found.note else f"{found.note}; left out: {text}".lstrip("; ")
        return replace(found, note=note)
    *some, last = found.statements or ("",)
    return replace(found, statements=(*some, f"{last} ' {text}")) if text and last else found


def _noted(shape: Shape, words: dict[str, str | None], lost: str) -> str:
    """Return what the hint adds: the note of the shape, and what of the line is not carried over."""
    # a reading of the note that has found nothing leaves its part empty
    notes = [filled(each, words) for each in shape.note.split("; ")] if "{" in shape.note else [shape.note]
    return "; ".join(filter(None, (*notes, lost and f"left out: {lost}")))


def _lost(found: "re.Match[str]") -> str:
    """Return what of a line is not carried over, in its order."""
    groups = [name for name, text in found.groupdict().items() if text and name.rstrip("0123456789") in LOST]
    texts = (found[name].strip(" \t,") for name in sorted(groups, key=found.start))
    return ", ".join(filter(None, texts))


def advice(code: str) -> str:
    """Return what to write for a line of another language as a hint; ``""`` for a line that is none."""
    found = proposal(code)
    return found.advice if found else ""


def canonical(statement: str) -> str:
    """Return a statement as this language prints it; ``""`` for what is none."""
    reader = line_reader()
    read = reader.read(statement, 0) if reader else None
    # what is not carried over whole is no advice: a part of a line would be proposed as the line
    if read is None or isinstance(read, Stopped):
        return ""
    label, parsed, comment = read
    parts = (label and f"*{label.text}", parsed and describe(parsed), comment and comment.text)
    return " ".join(part for part in parts if part)
