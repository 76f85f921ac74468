"""Structure: which lines belong together, and where every jump leads.

The parser reads lines one by one; here blocks are matched (IF to ENDIF, FOR to NEXT, WHILE to WEND, SELECT to
ENDSELECT, SUB to ENDSUB), line numbers and labels are looked up, and impossible jumps are reported. The interpreter
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

from robolang.core.deduplicate import Repeats
from robolang.core.diagnostics import MAX_DIAGNOSTICS, Diagnostic, Related
from robolang.syntax import other_languages
from robolang.syntax.ast import (
    MAX_NUMBER_DIGITS,
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
_LIKENESS = 0.75
"""Least likeness (``difflib``) of a word to one of a block; a hint, which decides nothing, takes 0.6."""
_ONE_LINE = re.compile(r"\bTHEN\b[ \t]*[^ \t']", re.IGNORECASE)


class Structure:
    """The tables of a program; places are indices into its lines.

    ``after``: of a line of a block the next one of the same block, and of its last one the first (IF -> ELSEIF -> ELSE
    -> ENDIF -> IF). ``end``: of every line of a block the closing one. ``numbers`` and ``labels`` give the line of a
    target; ``subs`` that of SUB by name; ``lost_subs`` are lines that an ENDSUB makes the head of a SUB, whatever they
    look like. ``first_names``: the name that first defines a label or a SUB. ``owner``: line of the SUB that a line is
    in. ``inside``: heads of the blocks that a line is in, outermost first.
    """

    def __init__(self) -> None:
        self.after: dict[int, int] = {}
        self.end: dict[int, int] = {}
        self.numbers: dict[int, int] = {}
        self.labels: dict[str, int] = {}
        self.lost_subs: set[int] = set()
        self.subs: dict[str, int] = {}
        self.owner: dict[int, int] = {}
        self.inside: list[tuple[int, ...]] = []
        self.diagnostics: list[Diagnostic] = []
        self.missing = Repeats()
        self.first_names: dict[tuple[str, str], Name] = {}
        self._counts: Counter[str] = Counter()

    def report(self, diagnostic: Diagnostic) -> None:
        """Keep a diagnostic, unless there are more of its code than are ever listed."""
        self._counts[diagnostic.code] += 1
        # one more than are listed, so that ``in_order`` can say that there are more
        if self._counts[diagnostic.code] <= MAX_DIAGNOSTICS + 1:
            self.diagnostics.append(diagnostic)

    def line_of(self, target: Target) -> int | None:
        """Return the line that a target names; None where there is none."""
        if target.label is not None:
            return self.labels.get(target.label.key)
        # -1 is the number of no line
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
    # before the jumps, which are judged by the blocks that it enters
    _Matcher(program, found).match()
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
            _define(found, found.labels, index, line.label, "label *")
        if isinstance(line.statement, Sub):
            _define(found, found.subs, index, line.statement.name, "SUB ")
    # last, so that a label of a line without an error counts first
    for index, line in enumerate(program.lines):
        if isinstance(line.statement, Unparsed) and (label := _LABEL.match(line.statement.text)):
            found.labels.setdefault(label[1].upper(), index)


def _define(found: Structure, table: dict[str, int], index: int, name: Name, what: str) -> None:
    """Enter a label or a subroutine of a line into its table; ``what`` precedes its name in a message."""
    first = found.first_names.setdefault((what, name.key), name)
    if first is not name:
        message = f"{what}{name.text} is defined twice"
        related = (Related(span=first.span, message="first defined here"),)
        found.report(Diagnostic(code="RBL203", message=message, span=name.span, related=related))
    table.setdefault(name.key, index)


class _Open:
    """A block that is not closed yet: its head's word, and the lines of it so far.

    ``guessed``: its head is missing, which is reported, or has an error; what goes with it is no mistake of its own.
    ``unknown`` is its last line with an error that may be anything, such as the head or end that another line lacks.
    """

    def __init__(self, *, word: str, lines: list[int], last: bool = False, guessed: bool = False) -> None:
        self.word = word
        self.lines = lines
        self.last = last
        self.guessed = guessed
        self.unknown: int | None = None


class _Matcher:
    """Matches heads with what divides and closes them, line by line, and enters what it finds into a ``Structure``.

    ``_stack`` holds the open blocks; ``_outside`` stands for the lines outside of all blocks.
    """

    def __init__(self, program: Program, found: Structure) -> None:
        self._program, self._found = program, found
        self._stack: list[_Open] = []
        self._outside = _Open(word="", lines=[])
        # words whose block a guess has closed: the true one that follows is no mistake
        self._doubtful: Counter[str] = Counter()

    def match(self) -> None:
        """Match all lines."""
        for index, line in enumerate(self._program.lines):
            word = _block_word(line.statement)
            self._place(index, word)
            if not word or line.statement is None:
                if _may_be_anything(line.statement):
                    self._around.unknown = index
            elif word not in _CLOSED_BY:
                self._continue(index, line, word)
            elif len(self._stack) >= MAX_BLOCKS:
                self._too_deep(line.statement, word)
                return
            else:
                self._begin(index, line, word)
        for block in self._stack:
            self._not_closed(block)

    @property
    def _around(self) -> _Open:
        """The innermost open block."""
        return self._stack[-1] if self._stack else self._outside

    def _place(self, index: int, word: str) -> None:
        """Enter which blocks and which SUB a line is in; a line that divides or closes a block is not inside it."""
        around = self._stack[:-1] if word in _CLOSES or word in _DIVIDES else self._stack
        self._found.inside.append(tuple(block.lines[0] for block in around))
        owner = next((block.lines[0] for block in self._stack if block.word == "SUB"), None)
        if owner is not None:
            self._found.owner[index] = owner

    def _begin(self, index: int, line: Line, word: str) -> None:
        guessed = isinstance(line.statement, Unparsed)
        if word == "SUB" and not guessed:
            # a SUB stands outside of every block, so it ends those whose end may be a line with an error
            while self._stack and self._may_be_end(self._stack[-1]):
                self._stack.pop()
            if self._stack:
                self._wrong("RBL219", "a SUB must not be inside another block", line, self._stack[-1])
        self._stack.append(_Open(word=word, lines=[index], guessed=guessed))

    def _too_deep(self, statement: Statement, word: str) -> None:
        """Report a block that is nested too deeply; the lines from it on belong to none, so tables stay linear."""
        message = f"this {word} is nested too deeply: it is inside {MAX_BLOCKS} blocks, the most that are allowed"
        self._found.report(Diagnostic(code="RBL108", message=message, span=statement.span))
        self._found.inside.extend(() for _ in range(len(self._program.lines) - len(self._found.inside)))

    def _continue(self, index: int, line: Line, word: str) -> None:
        """Take a line that divides or closes a block."""
        head = _CLOSES.get(word) or _DIVIDES[word]
        if isinstance(line.statement, Unparsed):
            # a guess ends the innermost block at most: no other block is given up for it
            if self._around.word != head:
                return
            if word in _CLOSES:
                self._doubtful[word] += 1
        self._give_up_inner(head)
        if self._around.word != head:
            self._without_head(index, line, word, head)
        elif word in _DIVIDES:
            self._divide(index, line, word)
        else:
            self._close(index, line)

    def _without_head(self, index: int, line: Line, word: str, head: str) -> None:
        """Take a line that divides or closes a block which no line begins."""
        if self._doubtful[word]:
            self._doubtful[word] -= 1
            return
        around = self._around
        # taken away: such a line can be the head that one ENDSUB lacks, not two
        unknown, around.unknown = around.unknown, None
        if unknown is not None and head == "SUB":
            self._take_as_sub(unknown, index)
        # SU= f(n) may be the lost head, yet has no error of its own: one must be reported here
        if unknown is None or not isinstance(self._program.lines[unknown].statement, Unparsed):
            block = self._stack[-1] if self._stack else None
            self._wrong("RBL212", f"{word} has no {head} above it", line, block)
        if word in _DIVIDES:
            # goes on as a block with a guessed head, so that its end is not reported as well
            self._stack.append(_Open(word=head, lines=[index], last=word in _LAST, guessed=True))

    def _divide(self, index: int, line: Line, word: str) -> None:
        block = self._stack[-1]
        if block.last and not isinstance(line.statement, Unparsed):
            self._wrong("RBL212", f"{word} comes after the ELSE of its block", line, block)
        block.last = block.last or word in _LAST
        block.lines.append(index)

    def _close(self, index: int, line: Line) -> None:
        block = self._stack.pop()
        statement, opener = line.statement, self._program.lines[block.lines[0]].statement
        named = statement.variable if isinstance(statement, Next) else None
        # the FOR is closed all the same, or one wrong name would be two mistakes
        if named is not None and isinstance(opener, For) and named.key != opener.variable.key:
            self._wrong("RBL212", f"NEXT {named.text} does not match FOR {opener.variable.text}", line, block)
        block.lines.append(index)
        for here, there in zip(block.lines, [*block.lines[1:], block.lines[0]], strict=True):
            self._found.after[here], self._found.end[here] = there, index

    def _give_up_inner(self, head: str) -> None:
        """Report the open blocks above the one that a line belongs to, so that one missing end is one mistake."""
        # no line of a SUB belongs to a block outside of it
        bounds = [index for index, block in enumerate(self._stack) if block.word == "SUB" and not block.guessed]
        inner = self._stack[bounds[-1] + 1 :] if bounds and head != "SUB" else self._stack
        if any(block.word == head for block in inner):
            while self._stack[-1].word != head:
                self._not_closed(self._stack.pop())

    def _take_as_sub(self, head: int, index: int) -> None:
        """Take a line that may be anything as the SUB that the ENDSUB of line ``index`` lacks."""
        self._found.lost_subs.add(head)
        self._found.owner.update((line, head) for line in range(head + 1, index + 1))

    def _may_be_end(self, block: _Open) -> bool:
        """Return whether the end that a block lacks may be a line with an error in it."""
        return block.unknown is not None and isinstance(self._program.lines[block.unknown].statement, Unparsed)

    def _not_closed(self, block: _Open) -> None:
        if block.guessed or self._may_be_end(block):
            return
        head = self._program.lines[block.lines[0]]
        assert head.statement is not None
        message = f"{block.word} has no {_CLOSED_BY[block.word]}"
        self._found.report(Diagnostic(code="RBL211", message=message, span=head.statement.span))

    def _wrong(self, code: str, message: str, line: Line, block: _Open | None) -> None:
        """Report a line, with the head of the block that it is in or belongs to."""
        assert line.statement is not None
        head = None if block is None else self._program.lines[block.lines[0]].statement
        related = () if block is None or head is None else (_begins(block.word, head),)
        self._found.report(Diagnostic(code=code, message=message, span=line.statement.span, related=related))


def _begins(word: str, head: Statement) -> Related:
    return Related(span=head.span, message=f"{word} begins here")


def _block_word(statement: Statement | None) -> str:
    """Return the word by which a line takes part in a block; of one with an error, the one that it seems to be."""
    if not isinstance(statement, Unparsed):
        return word_of(statement)
    return _seeming_word(_SPLIT_END.sub("END", statement.text))


def _seeming_word(text: str) -> str:
    """Return the word by which a line with an error seems to take part in a block, or ``""``."""
    first = _FIRST.match(text)
    upper = first[1].upper() if first else ""
    # a word that is known is not a misspelt one: END resembles WEND, EXIT resembles NEXT
    if upper in KEYWORDS - _WORDS or other_languages.is_known(upper):
        return other_languages.end(upper)
    word = near(upper, _WORDS, cutoff=_LIKENESS)
    if word == "IF":
        return _seeming_if(upper, text)
    if word == "CASE" and "ELSE" in text.upper():
        return "CASE ELSE"
    # COUNT i = 1 TO 3: only a FOR has = and TO
    return "FOR" if not word and _RANGE.search(text) else word


def _seeming_if(word: str, text: str) -> str:
    """Return ``"IF"`` where a line begins a block: an IF on one line and a word that resembles IF begin none."""
    return "" if word != "IF" or _ONE_LINE.search(text) else "IF"


def _may_be_anything(statement: Statement | None) -> bool:
    """Return whether a line has an error that leaves open which instruction it is: S(B, not MOV; or is SU= f(n)."""
    if isinstance(statement, Assign) and isinstance(statement.target, Name):
        return isinstance(statement.value, Call) and bool(near(statement.target.key, ("SUB",), cutoff=_LIKENESS))
    first = _FIRST.match(statement.text) if isinstance(statement, Unparsed) else None
    if first is None:
        return isinstance(statement, Unparsed)
    upper = first[1].upper()
    if upper in KEYWORDS or other_languages.is_known(upper):
        return False
    meant = near(upper, INSTRUCTIONS)
    return not meant or meant in _WORDS


# --- jumps -----------------------------------------------------------------------------------------------------------


def _check_jump(program: Program, found: Structure, index: int, target: Target) -> None:
    where = found.line_of(target)
    if where is None:
        _no_target(found, target)
    # before the blocks: a jump into a block of another SUB is one mistake
    elif found.owner.get(where) != found.owner.get(index):
        _check_sub(program, found, index, target)
    else:
        _check_entry(program, found, index, target)


def _no_target(found: Structure, target: Target) -> None:
    """Report a target that is nowhere, each once however many jumps name it."""
    if target.number == -1:
        # each by itself: GOTO 1.5 and GOTO 2.5 are two mistakes, though both have -1
        message = f"no line has this number: a line number is a whole number of at most {MAX_NUMBER_DIGITS} digits"
        found.report(Diagnostic(code="RBL202", message=message, span=target.span))
        return
    name = f"*{target.label.text}" if target.label is not None else f"line number {target.number}"
    if found.missing.is_first(name.upper(), target.span):
        found.report(Diagnostic(code="RBL202", message=f"there is no {name} to go to", span=target.span))


def _check_sub(program: Program, found: Structure, index: int, target: Target) -> None:
    """Report a jump into a SUB or out of one, unless the SUB is a guess."""
    where = found.line_of(target)
    owners = (found.owner.get(line) for line in (where, index) if line is not None)
    if any(owner is not None and isinstance(program.lines[owner].statement, Unparsed) for owner in owners):
        return
    inside = where in found.owner
    message = f"the target is {'in a' if inside else 'outside of the'} SUB that the jump is {'not ' * inside}in"
    found.report(Diagnostic(code="RBL204", message=message, span=target.span))


def _check_entry(program: Program, found: Structure, index: int, target: Target) -> None:
    """Report a jump into a block that it is not in; its innermost block may begin with the jump itself."""
    where = found.line_of(target)
    assert where is not None
    here = set(found.inside[index]) | {index}
    for head in found.inside[where]:
        statement = program.lines[head].statement
        # a block without an end is reported already, and one whose head is a guess may be none
        if head not in here and head in found.end and isinstance(statement, For | Head):
            word = word_of(statement)
            message = f"the target is inside a {word} that the jump is not in"
            related = (_begins(word, statement),)
            found.report(Diagnostic(code="RBL204", message=message, span=target.span, related=related))
            return
