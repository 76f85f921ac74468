"""The parser of one line, as Lark makes it from ``grammar.lark``: its table is shipped, not made in every process.

Making the LALR table takes a third of a check of a short program. ``grammar.json`` holds what Lark's own serializer
gives of it, as plain data; Lark reads it back in a tenth of the time. Nothing in it is run, unlike Lark's cache, which
is unpickled from a folder that others may write to. The form is that of one version of Lark: under another one the
table is made from the grammar, as if the file were not there.

``python -m robolang.syntax.grammar`` writes the file anew after a change of the grammar; a test says when that was
forgotten (docs/decisions/0022).
"""

import json
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import lark
from lark import Lark, Token
from lark.grammar import Rule
from lark.lexer import TerminalDef

from robolang.syntax.builder import builder
from robolang.syntax.line_reader import TABLE as LINE_TABLE
from robolang.syntax.tokens import CLASSIFIED, kind

TABLE = Path(__file__).with_name("grammar.json")
_GRAMMAR = Path(__file__).with_name("grammar.lark")


@cache
def line_parser() -> Lark:
    """Return the parser of what follows the line number; its values are the nodes that ``builder`` makes."""
    found = _shipped()
    return made() if found is None else found


def made() -> Lark:
    """Return the parser made from the grammar."""
    # basic: a token has one kind wherever it stands, since ``line_reader`` has one pattern for all places
    return Lark(
        _GRAMMAR.read_text(encoding="utf-8"), parser="lalr", lexer="basic", start=["start", "refused"], **_callbacks()
    )


def _shipped() -> Lark | None:
    """Return the parser from its shipped table; None where there is none for this version of Lark."""
    try:
        content = json.loads(TABLE.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    if content.get("lark") != lark.__version__:
        return None
    data, memo = content["data"], _by_number(content["memo"])
    table = data["parser"]["parser"]
    table["tokens"] = _by_number(table["tokens"])
    table["states"] = {state: _by_number(row) for state, row in _by_number(table["states"]).items()}
    # a private method: the public ``Lark.load`` reads a pickle only, which may run code
    parser: Lark = Lark._load_from_dict(data, memo, **_callbacks())  # type: ignore[no-untyped-call]
    return parser


def serialized() -> str:
    """Return the content of the shipped table."""
    data, memo = made().memo_serialize([TerminalDef, Rule])
    # functions cannot be written to JSON; they are passed anew when the table is read
    for name in _callbacks():
        del data["options"][name]
    data["parser"]["parser"] = _ordered(data["parser"]["parser"])
    content = {"lark": lark.__version__, "data": data, "memo": memo}
    return json.dumps(content, separators=(",", ":"), sort_keys=True) + "\n"


def _ordered(table: dict[str, Any]) -> dict[str, Any]:
    """Return a table with tokens numbered by name and states in the order in which they are reached from the starts.

    Lark numbers both in an order that differs from process to process. A step of a row is (0, state to go to) or
    (1, rule to reduce by).
    """
    tokens = sorted(table["tokens"].values())
    rows = {
        state: {table["tokens"][token]: step for token, step in row.items()} for state, row in table["states"].items()
    }
    starts = [table["start_states"][name] for name in sorted(table["start_states"])]
    number = {state: index for index, state in enumerate(_reached(starts, rows))}

    def renumbered(row: dict[str, Any]) -> dict[int, Any]:
        return {tokens.index(name): (step, to if step else number[to]) for name, (step, to) in row.items()}

    return {
        "tokens": dict(enumerate(tokens)),
        "states": {number[state]: renumbered(row) for state, row in rows.items()},
        "start_states": {name: number[state] for name, state in table["start_states"].items()},
        "end_states": {name: number[state] for name, state in table["end_states"].items()},
    }


def _reached(starts: list[int], rows: dict[int, dict[str, Any]]) -> list[int]:
    """Return the states in the order in which they are reached; the steps of a row are taken by the names of tokens."""
    order = list(starts)
    for state in order:  # grows while it is gone through
        for _, (step, to) in sorted(rows[state].items()):
            if step == 0 and to not in order:
                order.append(to)
    return order


def _by_number(table: dict[str, Any]) -> dict[int, Any]:
    """Return a table whose keys were numbers before JSON made them texts."""
    return {int(key): value for key, value in table.items()}


class _Called:
    """The builder as Lark calls it: with one list of children."""

    def __init__(self) -> None:
        self._builder = builder()

    def __getattr__(self, name: str) -> Callable[[list[Any]], Any]:
        method: Callable[..., Any] = getattr(self._builder, name)
        return lambda children: method(*children)


def _callbacks() -> dict[str, Any]:
    return {"transformer": _Called(), "lexer_callbacks": dict.fromkeys(CLASSIFIED, _classify)}


def _classify(token: Token) -> Token:
    """Give a word, a number or a stray character its final kind (callback of the lexer)."""
    token.type = kind(token.type, token)
    return token


# --- the table of line_reader ----------------------------------------------------------------------------------------


def line_table() -> str:
    """Return the content of the table of ``line_reader``: the same automaton without what only Lark needs."""
    content = json.loads(serialized())
    memo, table = content["memo"], content["data"]["parser"]["parser"]
    numbers = sorted((int(number) for number, each in memo.items() if each["__type__"] == "Rule"))
    place = {number: at for at, number in enumerate(numbers)}
    tokens, states = table["tokens"], table["states"]
    lexer: Any = made().parse_interactive("", start="start").lexer_thread.lexer  # its terminals are by priority
    plain = {
        "pattern": "|".join(f"(?P<{each.name}>{each.pattern.to_regexp()})" for each in lexer.terminals),
        "ignored": content["data"]["parser"]["lexer_conf"]["ignore"],
        "start": table["start_states"]["start"],
        "end": table["end_states"]["start"],
        "rows": [
            {tokens[token]: to if step == 0 else ~place[to["@"]] for token, (step, to) in states[str(at)].items()}
            for at in range(len(states))
        ],
        "rules": [_rule(memo[str(number)]) for number in numbers],
    }
    return json.dumps(plain, separators=(",", ":"), sort_keys=True) + "\n"


def _rule(rule: dict[str, Any]) -> list[Any]:
    """Return origin, length, method, single and parts of a rule, as ``line_reader`` has them.

    They follow Lark's ``ParseTreeBuilder``: a rule whose name begins with an underscore is taken apart in the rule
    above, a terminal whose name does is left out, and ``empty_indices`` mark optional parts that are not there.
    """
    origin, options, expansion = rule["origin"]["name"], rule["options"], rule["expansion"]
    parts, all_of_them = _kept_parts(options["empty_indices"], expansion), list(range(len(expansion)))
    method = rule["alias"] or origin
    return [
        origin,
        len(expansion),
        method if hasattr(builder(), method) else None,
        options["expand1"] and rule["alias"] is None,
        None if parts == all_of_them else parts,
    ]


def _kept_parts(empty_indices: Sequence[bool], expansion: list[dict[str, Any]]) -> list[int | None]:
    """Return which symbols of an expansion ``line_reader`` keeps, and in which form (see ``_reduced`` there)."""
    # "1" is an absent part and "0" a symbol, so between two symbols stand as many absent parts as "1"
    absent = [len(ones) for ones in "".join(str(int(bit)) for bit in empty_indices).split("0")]
    absent = absent if empty_indices else [0] * (len(expansion) + 1)
    parts: list[int | None] = [None] * absent[0]
    for at, symbol in enumerate(expansion):
        is_rule = symbol["__type__"] == "NonTerminal"
        if is_rule and symbol["name"].startswith("_"):
            parts.append(~at)
        elif is_rule or not symbol["filter_out"]:
            parts.append(at)
        parts += [None] * absent[at + 1]
    return parts


if __name__ == "__main__":
    TABLE.write_text(serialized(), encoding="utf-8")
    LINE_TABLE.write_text(line_table(), encoding="utf-8")
