"""Structure: which lines belong together, and where every jump leads.

The parser reads lines one by one; here blocks are matched (IF to ENDIF, FOR to NEXT, WHILE to WEND, SELECT to
ENDSELECT, SUB to ENDSUB), line numbers and labels are looked up, and jumps that cannot be are found. The interpreter
goes by the tables, so nothing is searched while a program runs. One pass over the lines with a stack of open blocks:
linear in the text. Places are indices into ``Program.lines``.

A line with an error takes part as what it seems to be, so that what it began or ended is not missed. That is a guess,
and no error follows from it: not of the line itself, nor of one that belongs to another block without it.

A block is left by GOTO freely and entered by its head only: a jump to a line inside a block that the jump is not in
itself is RBL204, since a NEXT without its FOR has nothing to count.
"""

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

from robolang.core.deduplicate import Repeats
from robolang.core.diagnostics import MAX_DIAGNOSTICS, Diagnostic, Related
from robolang.core.source import Span
from robolang.syntax import other_languages
from robolang.syntax.ast import (
    Assign,
    Block,
    Call,
    Case,
    For,
    Head,
    If,
    Jump,
    Line,
    Name,
    Next,
    OnError,
    Program,
    Statement,
    Sub,
    Target,
    Unparsed,
    Wait,
)
from robolang.syntax.keywords import INSTRUCTIONS, KEYWORDS, near

_CLOSES = {"ENDIF": "IF", "WEND": "WHILE", "ENDSELECT": "SELECT", "ENDSUB": "SUB", "NEXT": "FOR"}
_CLOSED_BY = {head: word for word, head in _CLOSES.items()}
MAX_BLOCKS = 100
"""Deepest nesting of blocks."""
_DIVIDES = {"ELSEIF": "IF", "ELSE": "IF", "CASE": "SELECT", "CASE ELSE": "SELECT"}


_LAST = frozenset({"ELSE", "CASE ELSE"})
_WORDS = frozenset(_CLOSES) | frozenset(_CLOSED_BY) | {"ELSEIF", "ELSE", "CASE"}
_FIRST = re.compile(r"[ \t]*(?:\*\w+[ \t]+)?([A-Za-z]+)")
_SPLIT_END = re.compile(r"\bEND[ \t]+(?=(?:IF|SELECT|SUB)\b)", re.IGNORECASE)
_LABEL = re.compile(r"[ \t]*\*[ \t]*([A-Za-z]\w*)")
_RANGE = re.compile(r"\w[ \t]*=[^=]*\bTO\b", re.IGNORECASE)
_ONE_LINE = re.compile(r"\bTHEN\b[ \t]*[^ \t']", re.IGNORECASE)


@dataclass(slots=True)
class Structure:
    """The tables of a program; places are indices into its lines.

    ``after``: of a line of a block the next one of the same block, and of its last one the first (IF -> ELSEIF -> ELSE
    -> ENDIF -> IF). ``end``: of every line of a block the closing one. ``numbers`` and ``labels`` give the line of a
    target; ``subs`` that of SUB by name; ``lost_subs`` are lines that an ENDSUB makes the head of a SUB, whatever they
    look like. ``owner``: line of the SUB that a line is in. ``inside``: heads of the blocks that a line is in,
    outermost first.
    """

    after: dict[int, int] = field(default_factory=dict)
    end: dict[int, int] = field(default_factory=dict)
    numbers: dict[int, int] = field(default_factory=dict)
    labels: dict[str, int] = field(default_factory=dict)
    lost_subs: set[int] = field(default_factory=set)
    subs: dict[str, int] = field(default_factory=dict)
    owner: dict[int, int] = field(default_factory=dict)
    inside: list[tuple[int, ...]] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    missing: Repeats = field(default_factory=Repeats)
    _counts: Counter[str] = field(default_factory=Counter)

    def report(self, diagnostic: Diagnostic) -> None:
        """Keep a diagnostic, unless there are more of its code than are ever listed."""
        self._counts[diagnostic.code] += 1
        if self._counts[diagnostic.code] <= MAX_DIAGNOSTICS + 1:
            self.diagnostics.append(diagnostic)

    def line_of(self, target: Target) -> int | None:
        """Return the line that a target names; None where there is none."""
        if target.label is not None:
            return self.labels.get(target.label.key)
        return self.numbers.get(target.number if target.number is not None else -1)


def word_of(statement: Statement | None) -> str:
    """Return the word by which a statement takes part in a block, or ``""``."""
    if isinstance(statement, Head | Block):
        return statement.word
    for kind, word in ((For, "FOR"), (Next, "NEXT"), (Sub, "SUB"), (Case, "CASE")):
        if isinstance(statement, kind):
            return word
    return ""


def structure_of(program: Program) -> Structure:
    """Return the tables of a program, with what is wrong in ``diagnostics``."""
    found = Structure()
    _names(program, found)
    _blocks(program, found)
    for index, line in enumerate(program.lines):
        for target in targets(line.statement):
            _check_jump(program, found, index, target)
    found.diagnostics = found.missing.noted(found.diagnostics, "RBL202")
    return found


def targets(statement: Statement | None) -> Iterator[Target]:
    """Yield the places that a statement may jump to."""
    if isinstance(statement, Jump | OnError | Wait):
        if statement.target is not None:
            yield statement.target
    elif isinstance(statement, If):
        yield from targets(statement.then)
        yield from targets(statement.otherwise)


def _names(program: Program, found: Structure) -> None:
    """Look up line numbers, labels and subroutines; of equal ones the first counts."""
    for index, line in enumerate(program.lines):
        if line.number is not None:
            found.numbers.setdefault(line.number, index)
        if line.label is not None:
            _define(found, found.labels, line.label.key, index, line.label.span, f"label *{line.label.text}", program)
        if isinstance(line.statement, Sub):
            name = line.statement.name
            _define(found, found.subs, name.key, index, name.span, f"SUB {name.text}", program)
    for index, line in enumerate(program.lines):
        if isinstance(line.statement, Unparsed) and (label := _LABEL.match(line.statement.text)):
            found.labels.setdefault(label[1].upper(), index)


def _define(
    found: Structure, table: dict[str, int], key: str, index: int, span: Span, what: str, program: Program
) -> None:
    if key in table:
        first = _span_of(program.lines[table[key]], is_label=table is found.labels)
        related = (Related(span=first, message="first defined here"),)
        found.report(Diagnostic(code="RBL203", message=f"{what} is defined twice", span=span, related=related))
    table.setdefault(key, index)


def _span_of(line: Line, *, is_label: bool) -> Span:
    if is_label and line.label is not None:
        return line.label.span
    assert isinstance(line.statement, Sub)
    return line.statement.name.span


@dataclass(slots=True)
class _Open:
    """A block that is not closed yet: its head's word, and the lines of it so far.

    ``guessed``: its head is missing, which is said, or has an error; what goes with it is no mistake of its own.
    ``unknown`` is its last line with an error that may be anything, such as the head or end that another line lacks.
    """

    word: str
    lines: list[int]
    last: bool = False
    guessed: bool = False
    unknown: int | None = None


def _blocks(program: Program, found: Structure) -> None:
    """Match heads with what divides and closes them."""
    stack: list[_Open] = []
    outside = _Open(word="", lines=[])
    doubtful: Counter[str] = Counter()
    for index, line in enumerate(program.lines):
        word = _block_word(line.statement)
        closes = word in _CLOSES or word in _DIVIDES
        found.inside.append(tuple(block.lines[0] for block in (stack[:-1] if closes else stack)))
        owner = next((block.lines[0] for block in stack if block.word == "SUB"), None)
        if owner is not None:
            found.owner[index] = owner
        if not word or line.statement is None:
            if _may_be_anything(line.statement):
                (stack[-1] if stack else outside).unknown = index
            continue
        if word in _CLOSED_BY:
            if len(stack) >= MAX_BLOCKS:
                _too_deep(found, program, index, word)
                return
            guessed = isinstance(line.statement, Unparsed)
            if word == "SUB" and stack and not guessed:
                while stack and _may_be_end(program, stack[-1]):
                    stack.pop()
            if word == "SUB" and stack and not guessed:
                _wrong(found, "RBL219", "a SUB stands outside of every block", line, program, stack[-1])
            stack.append(_Open(word=word, lines=[index], guessed=guessed))
        else:
            _continue(program, found, stack, outside, index, word, doubtful)
    for block in stack:
        _not_closed(program, found, block)


def _block_word(statement: Statement | None) -> str:
    """Return the word by which a line takes part in a block; of one with an error, the one that it seems to be."""
    if not isinstance(statement, Unparsed):
        return word_of(statement)
    text = _SPLIT_END.sub("END", statement.text)
    first = _FIRST.match(text)
    upper = first[1].upper() if first else ""
    if upper in other_languages.WORDS or upper in KEYWORDS - _WORDS:
        return other_languages.ENDS.get(upper, "")
    word = near(upper, _WORDS, cutoff=0.75)
    if not word and _RANGE.search(text):
        return "FOR"
    if word == "IF" and (_ONE_LINE.search(statement.text) or upper != "IF"):
        return ""
    return "CASE ELSE" if word == "CASE" and "ELSE" in statement.text.upper() else word


def _may_be_anything(statement: Statement | None) -> bool:
    """Return whether a line has an error that leaves open which instruction it is: S(B, not MOV; or is SU= f(n)."""
    if isinstance(statement, Assign) and isinstance(statement.target, Name):
        return isinstance(statement.value, Call) and bool(near(statement.target.key, ("SUB",), cutoff=0.75))
    first = _FIRST.match(statement.text) if isinstance(statement, Unparsed) else None
    if first is None:
        return isinstance(statement, Unparsed)
    upper = first[1].upper()
    if upper in other_languages.WORDS or upper in KEYWORDS:
        return False
    meant = near(upper, INSTRUCTIONS)
    return not meant or meant in _WORDS


def _too_deep(found: Structure, program: Program, index: int, word: str) -> None:
    """Report a block that is nested too deeply; the lines from it on belong to none, so tables stay linear."""
    statement = program.lines[index].statement
    assert statement is not None
    message = f"this {word} is inside of {MAX_BLOCKS} blocks; no more are possible"
    found.report(Diagnostic(code="RBL108", message=message, span=statement.span))
    found.inside.extend(() for _ in range(len(program.lines) - len(found.inside)))


def _continue(
    program: Program,
    found: Structure,
    stack: list[_Open],
    outside: _Open,
    index: int,
    word: str,
    doubtful: Counter[str],
) -> None:
    """Take a line that divides or closes a block; ``doubtful`` are the words whose block a guess has closed."""
    line = program.lines[index]
    guessed = isinstance(line.statement, Unparsed)
    head = _CLOSES.get(word) or _DIVIDES[word]
    if guessed and not (stack and stack[-1].word == head):
        return
    if guessed and word in _CLOSES:
        doubtful[word] += 1
    _give_up_inner(program, found, stack, head)
    if not stack or stack[-1].word != head:
        if doubtful[word]:
            doubtful[word] -= 1
            return
        around = stack[-1] if stack else outside
        unknown, around.unknown = around.unknown, None
        if unknown is not None:
            _take_as_head(found, unknown, index, head)
        if unknown is None or not isinstance(program.lines[unknown].statement, Unparsed):
            _wrong(found, "RBL212", f"{word} has no {head} above it", line, program, stack[-1] if stack else None)
        if word in _DIVIDES:
            stack.append(_Open(word=head, lines=[index], last=word in _LAST, guessed=True))
        return
    block = stack[-1]
    if word in _DIVIDES:
        if block.last and not guessed:
            _wrong(found, "RBL212", f"{word} comes after the ELSE of its block", line, program, block)
        block.last = block.last or word in _LAST
        block.lines.append(index)
        return
    statement, opener = line.statement, program.lines[block.lines[0]].statement
    named = statement.variable if isinstance(statement, Next) else None
    if named is not None and isinstance(opener, For) and named.key != opener.variable.key:
        _wrong(found, "RBL212", f"NEXT {named.text} closes FOR {opener.variable.text}", line, program, block)
    block.lines.append(index)
    stack.pop()
    for here, there in zip(block.lines, [*block.lines[1:], block.lines[0]], strict=True):
        found.after[here], found.end[here] = there, index


def _give_up_inner(program: Program, found: Structure, stack: list[_Open], head: str) -> None:
    """Report the open blocks above the one that a line belongs to, so that one missing end is one mistake."""
    bounds = [index for index, block in enumerate(stack) if block.word == "SUB" and not block.guessed]
    inner = [block.word for block in (stack[bounds[-1] + 1 :] if bounds and head != "SUB" else stack)]
    if head in inner:
        while stack[-1].word != head:
            _not_closed(program, found, stack.pop())


def _take_as_head(found: Structure, head: int, index: int, word: str) -> None:
    """Take a line that may be anything as the head that line ``index`` lacks."""
    if word == "SUB":
        found.lost_subs.add(head)
        found.owner.update((line, head) for line in range(head + 1, index + 1))


def _may_be_end(program: Program, block: _Open) -> bool:
    """Return whether the end that a block lacks may be a line with an error in it."""
    return block.unknown is not None and isinstance(program.lines[block.unknown].statement, Unparsed)


def _not_closed(program: Program, found: Structure, block: _Open) -> None:
    if block.guessed or _may_be_end(program, block):
        return
    head = program.lines[block.lines[0]]
    assert head.statement is not None
    message = f"{block.word} has no {_CLOSED_BY[block.word]}"
    found.report(Diagnostic(code="RBL211", message=message, span=head.statement.span))


def _wrong(found: Structure, code: str, message: str, line: Line, program: Program, block: _Open | None) -> None:
    assert line.statement is not None
    related: tuple[Related, ...] = ()
    if block is not None:
        head = program.lines[block.lines[0]].statement
        assert head is not None
        related = (Related(span=head.span, message=f"{block.word} begins here"),)
    found.report(Diagnostic(code=code, message=message, span=line.statement.span, related=related))


def _check_jump(program: Program, found: Structure, index: int, target: Target) -> None:
    where = found.line_of(target)
    if where is None:
        name = f"*{target.label.text}" if target.label is not None else f"line number {target.number}"
        name = name if target.number != -1 else "a line number that is not whole"
        cause = target.span if target.number == -1 else name.upper()
        if found.missing.is_first(cause, target.span):
            found.report(Diagnostic(code="RBL202", message=f"there is no {name} to go to", span=target.span))
        return
    owners = found.owner.get(where), found.owner.get(index)
    if owners[0] != owners[1]:
        if any(owner is not None and isinstance(program.lines[owner].statement, Unparsed) for owner in owners):
            return
        inside = where in found.owner
        message = f"the target is {'in a' if inside else 'outside of the'} SUB that the jump is {'not ' * inside}in"
        found.report(Diagnostic(code="RBL204", message=message, span=target.span))
        return
    here = set(found.inside[index]) | {index}
    for head in found.inside[where]:
        statement = program.lines[head].statement
        if head not in here and head in found.end and isinstance(statement, For | Head):
            word = word_of(statement)
            related = (Related(span=statement.span, message=f"{word} begins here"),)
            message = f"the target is inside a {word} that the jump is not in"
            found.report(Diagnostic(code="RBL204", message=message, span=target.span, related=related))
            return
