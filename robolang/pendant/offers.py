"""What can be typed next at the prompt, with its meaning: words of the language, names, commands and their operands.

What may follow in a statement is what the automaton of the parser can take there, so completion and parser agree.
"""

import os
import re
from collections.abc import Iterable, Iterator
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from robolang.analysis.symbol_table import SymbolKind
from robolang.pendant.command import Command, Commands, Offer
from robolang.pendant.known import Entry, Known, natural
from robolang.pendant.reading import CommandLine, read
from robolang.syntax.completion import Completion, completions
from robolang.syntax.keywords import COMPONENTS6, INSTRUCTIONS, KEYWORDS, MOTIONS
from robolang.syntax.line_reader import line_reader
from robolang.syntax.parser import MAX_LINE
from robolang.syntax.tokens import Token
from robolang.values.functions import FUNCTIONS
from robolang.values.kinds import Kind

_WORD = re.compile(r"\*?[A-Za-z_]?\w*\$?\Z")
_SIGNAL = re.compile(r"(?<!\w)(IN|OUT)\s*\(\s*(\d*)\Z", re.IGNORECASE)
_COMPONENT = re.compile(r"(?<!\w)[A-Za-z_]\w*\.([A-Za-z]*)\Z")
_JUMP = re.compile(r"(?<!\w)(?:GOTO|GOSUB)\s*\Z", re.IGNORECASE)
_NUMBERED = re.compile(r"\A[ \t]*[0-9]+[ \t]+")
_LABELLED = re.compile(r"\A[ \t]*\*[ \t]*\w+[ \t]+")
_QUOTED = re.compile(r'"[^"]*"')
_HIDDEN = re.compile(r"\"[^\"]*\Z|'|(?<!\w)REM(?!\w)", re.IGNORECASE)
"""Where nothing is offered: in a text that is not closed, and in a comment."""

_VALUES = (SymbolKind.VARIABLE, SymbolKind.CONSTANT, SymbolKind.PARAMETER, SymbolKind.ARRAY)
_AFTER = {
    "CALL": (SymbolKind.SUB,),
    "LOAD": (SymbolKind.LOAD,),
    "TOOL": (SymbolKind.TOOL, *_VALUES, SymbolKind.POINT),
    "FRAME": (SymbolKind.FRAME, *_VALUES, SymbolKind.POINT),
    "SEAM": (SymbolKind.SENSOR,),
    "NEXT": (SymbolKind.VARIABLE,),
}
"""What a name stands for in a statement, by the word that decides it; anywhere else it has a value."""
_POSES = MOTIONS | {"TOOL", "FRAME"}
_OPERATORS = frozenset({"AND", "OR", "XOR", "NOT", "MOD"})
_TARGETS = (SymbolKind.LABEL, SymbolKind.LINE)
_OFFERED = {
    Offer.POINT: (SymbolKind.POINT,),
    Offer.FRAME: (SymbolKind.FRAME,),
    Offer.TOOL: (SymbolKind.TOOL,),
    Offer.LOAD: (SymbolKind.LOAD,),
    Offer.LINE: _TARGETS,
}
_DIRECTIONS = (("X", "mm"), ("Y", "mm"), ("Z", "mm"), ("RX", "deg"), ("RY", "deg"), ("RZ", "deg"))


class Offered(NamedTuple):
    """A text to put in place of the last ``replaces`` characters, and its meaning."""

    text: str
    meaning: str
    replaces: int


class Choice(NamedTuple):
    """A text that may stand at a place, and its meaning."""

    text: str
    meaning: str


def offered(typed: str, known: Known, commands: Commands) -> Iterator[Offered]:
    """Yield what can follow what is typed up to the cursor, the likeliest first."""
    line = typed.rpartition("\n")[2]
    if len(line) > MAX_LINE or _HIDDEN.search(_QUOTED.sub(lambda text: " " * len(text[0]), line)):
        return
    if found := _SIGNAL.search(line):
        yield from _beginning(found[2], _signals(known, found[1].upper()))
    elif found := _COMPONENT.search(line):
        yield from _beginning(found[1], (Choice(name, unit) for name, unit in _components()))
    elif (command := _command(line, commands)) is not None:
        yield from _operands(command, line, known, commands)
    else:
        is_first = "\n" not in typed
        yield from _statement(line, known, commands if is_first else None)


def _command(line: str, commands: Commands) -> Command | None:
    """Return the command whose operands are being typed: its word is complete."""
    word, blank, _ = line.lstrip().partition(" ")
    if not blank or commands.get(word) is None:
        return None
    found = read(line, commands)
    return found.command if isinstance(found, CommandLine) else None


# --- statements -------------------------------------------------------------------------------------------------------


def _statement(line: str, known: Known, commands: Commands | None) -> Iterator[Offered]:
    reader = line_reader()
    if reader is None:
        return
    prefix = _prefix(line)
    before = line[: len(line) - len(prefix)]
    code = _LABELLED.sub("", _NUMBERED.sub("", before))
    accepts = reader.following(code)
    tokens = list(reader.tokens(code))
    yield from _beginning(prefix, chain(_names(tokens, accepts, known), _words(tokens, accepts)))
    if not tokens and code == before and commands is not None:
        yield from _beginning(prefix, (Choice(each.word, each.help) for each in commands))
        if prefix:  # an expression shows its value
            yield from _beginning(prefix, chain(_entries(known.of(SymbolKind.POINT)), _functions()))


def _prefix(line: str) -> str:
    """Return the beginning of a word at the end of a line; a label has its asterisk."""
    found = _WORD.search(line)
    prefix = found[0] if found else ""
    # the asterisk of a product is no part of the name after it
    return prefix if _JUMP.search(line[: len(line) - len(prefix)]) else prefix.removeprefix("*")


def _names(tokens: list[Token], accepts: frozenset[str], known: Known) -> Iterator[Choice]:
    """Yield the names that can stand after some tokens, and the functions."""
    if accepts >= {"STAR", "NUMBER"}:
        yield from _targets(known)
        return
    word = next((token.type for token in reversed(tokens) if token.type in INSTRUCTIONS), "")
    takes_pose = word in _POSES and not _is_in_option(tokens)
    if "NAME" in accepts:
        kinds = _AFTER.get(word) or _ordered(takes_pose, begins=not tokens)
        yield from _entries(each for kind in kinds for each in known.of(kind))
    if "FUNCTION" in accepts:
        yield from _functions(poses_first=takes_pose)


def _ordered(takes_pose: bool, *, begins: bool) -> tuple[SymbolKind, ...]:
    """Return the kinds of name in an expression, the likeliest first; a statement that begins with one assigns."""
    if begins:
        return _VALUES
    return (SymbolKind.POINT, *_VALUES) if takes_pose else (*_VALUES, SymbolKind.POINT)


def _is_in_option(tokens: list[Token]) -> bool:
    """Return whether the last word of a move is that of an option, which takes a number."""
    last = [token.type for token in tokens if token.type in KEYWORDS][-1]
    return last not in _POSES


def _targets(known: Known) -> Iterator[Choice]:
    """Yield labels with their asterisk, then line numbers."""
    for entry in known.of(SymbolKind.LABEL):
        yield Choice(f"*{entry.name}", entry.meaning)
    yield from _entries(known.of(SymbolKind.LINE))


def _words(tokens: list[Token], accepts: frozenset[str]) -> Iterator[Choice]:
    """Yield the keywords that can stand after some tokens."""
    first = tokens[0].type if tokens else ""
    begins = not tokens or tokens[-1].type in ("THEN", "ELSE")
    # LOAD and IF have two forms: the first is shown
    found: dict[str, Choice] = {}
    if begins or first in MOTIONS:
        for each in completions():
            if each.after == ("" if begins else first) and _first(each) in accepts:
                found.setdefault(each.words, Choice(each.words, each.help))
    yield from found.values()
    # THEN and TO are what is needed; operators go on with the expression
    rest = (accepts & KEYWORDS) - {words.partition(" ")[0] for words in found}
    form = _form(first)
    yield from (Choice(word, form) for word in sorted(rest, key=lambda word: (word in _OPERATORS, word)))


def _first(completion: Completion) -> str:
    return completion.words.partition(" ")[0]


def _form(word: str) -> str:
    """Return how the statement is written that begins with a word."""
    return next((each.form for each in completions() if _first(each) == word), "")


def _functions(*, poses_first: bool = False) -> Iterator[Choice]:
    """Yield the functions: with an opening parenthesis where they take arguments."""
    functions = sorted(FUNCTIONS.values(), key=lambda each: (each.result is not Kind.POSE) if poses_first else False)
    for each in functions:
        text = f"{each.name}(" if each.parameters else each.name
        yield Choice(text, f"{each.form}: {each.help}" if each.parameters else each.help)


def _components() -> Iterator[tuple[str, str]]:
    return ((name, unit) for name, unit in _DIRECTIONS if name in COMPONENTS6)


def _signals(known: Known, function: str) -> Iterator[Choice]:
    states = known.inputs if function == "IN" else known.outputs
    yield from (Choice(str(number), f"is {state:g}") for number, state in sorted(states.items()))


# --- operands of commands ---------------------------------------------------------------------------------------------


def _operands(command: Command, line: str, known: Known, commands: Commands) -> Iterator[Offered]:
    _, _, rest = line.lstrip().partition(" ")
    last = rest.rpartition(" ")[2]
    choices: Iterator[Choice] = chain.from_iterable(
        _of_offer(offer, last, known, commands) for offer in command.offers if offer is not Offer.VALUE
    )
    words = (Choice(word, command.form) for word in command.words)
    yield from _beginning(last, chain(choices, words))
    if Offer.VALUE in command.offers:
        yield from _statement(f"PRINT {rest}", known, None)


def _of_offer(offer: Offer, last: str, known: Known, commands: Commands) -> Iterable[Choice]:
    if kinds := _OFFERED.get(offer):
        return _targets(known) if last.startswith("*") else _entries(known.of(*kinds))
    match offer:
        case Offer.FILE:
            return _files(last)
        case Offer.INPUT:
            return _signals(known, "IN")
        case Offer.AXIS:
            return _axes(known)
        case Offer.COMMAND:
            statements = (Choice(each.words, each.help) for each in completions() if not each.after)
            return chain((Choice(each.word, each.help) for each in commands), statements, _functions())
    return ()


def _axes(known: Known) -> Iterator[Choice]:
    """Yield the joints and the directions of a jog."""
    yield from (Choice(f"J{axis + 1}", "joint, deg") for axis in range(known.axes))
    yield from (Choice(name, f"direction, {unit}") for name, unit in _DIRECTIONS)


def _files(typed: str) -> Iterator[Choice]:
    """Yield programs and folders; nothing where a folder cannot be read."""
    folder, _, name = typed.rpartition("/")
    try:
        with os.scandir(Path(folder or ("/" if typed.startswith("/") else ".")).expanduser()) as found:
            entries = [(entry.name, entry.is_dir()) for entry in found]
    except (OSError, ValueError, RuntimeError):  # no such folder, a name with NUL, no such user after ~
        return
    start = typed[: len(typed) - len(name)]
    for entry, is_folder in sorted(entries, key=lambda each: (each[1], natural(each[0]))):
        if entry.startswith(".") and not name.startswith("."):
            continue
        if is_folder:
            yield Choice(f"{start}{entry}/", "folder")
        elif entry.endswith(".rbl"):
            yield Choice(f"{start}{entry}", "program")


def _entries(entries: Iterable[Entry]) -> Iterator[Choice]:
    return (Choice(entry.name, entry.meaning) for entry in entries)


def _beginning(prefix: str, choices: Iterable[Choice]) -> Iterator[Offered]:
    """Yield the choices that begin with a prefix in any case, each text once."""
    shown: set[str] = set()
    start = prefix.upper()
    for text, meaning in choices:
        if text.upper().startswith(start) and text not in shown:
            shown.add(text)
            yield Offered(text, meaning, len(prefix))
