"""The shape of the code: short branches, few arguments, short files, comments where a reader would stop.

The complexity of a function is counted as radon counts it (cyclomatic: decisions, loops, handlers, operands of and/or).
Copied code is found by pylint in ``make gates``.
"""

import ast
import io
import tokenize
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from tests.arch.parsed import children, nodes, nodes_of

ROOT = Path(__file__).parents[2]
FILES = [path for folder in ("robolang", "runtime") for path in sorted((ROOT / folder).rglob("*.py"))]
COMPLEX = 10
"""More decisions than this, plus one, are hard to test one by one."""
MANY = 6
"""More arguments than this are hard to call rightly; ``self`` and ``cls`` do not count."""
LONG = 500
MOST_COMPLEX_PCT, MOST_MANY_PCT, MOST_LONG = 0.5, 0.1, 0
LEAST_COMMENTS = 3.0
"""Lines of 100, in robolang and runtime together."""

Function = ast.FunctionDef | ast.AsyncFunctionDef


def functions(found: list[ast.AST]) -> Iterator[Function]:
    return (item for item in found if isinstance(item, Function))


def own(function: Function) -> Iterator[ast.AST]:
    """Yield the nodes of a body without functions and classes inside it, and without what an assertion says."""
    todo: list[ast.AST] = list(function.body)
    while todo:
        node = todo.pop()
        if isinstance(node, Function | ast.ClassDef):
            continue
        yield node
        if not isinstance(node, ast.Assert):
            todo += children(node)


def complexity(function: Function) -> int:
    return 1 + sum(map(decisions, own(function)))


def decisions(node: ast.AST) -> int:
    """Return by how much one node makes its function more complex."""
    match node:
        case ast.If() | ast.IfExp() | ast.Assert():
            return 1
        case ast.For() | ast.AsyncFor() | ast.While():
            return 1 + bool(node.orelse)
        case ast.Try() | ast.TryStar():
            return len(node.handlers) + bool(node.orelse)
        case ast.BoolOp():
            return len(node.values) - 1
        case ast.comprehension():
            return 1 + len(node.ifs)
        case ast.Match():
            return len(node.cases) - any(is_wildcard(case.pattern) for case in node.cases)
    return 0


def is_wildcard(pattern: ast.pattern) -> bool:
    return isinstance(pattern, ast.MatchAs) and pattern.pattern is None


def arguments(function: Function) -> int:
    found = function.args
    named = [*found.posonlyargs, *found.args]
    count = len(named) + len(found.kwonlyargs) + bool(found.vararg) + bool(found.kwarg)
    return count - bool(named and named[0].arg in ("self", "cls"))


def comments(text: str) -> int:
    return sum(token.type == tokenize.COMMENT for token in tokenize.generate_tokens(io.StringIO(text).readline))


@cache
def every() -> list[tuple[str, Function]]:
    return [(path.relative_to(ROOT).as_posix(), item) for path in FILES for item in functions(nodes_of(path))]


def named(path: str, function: Function, size: int) -> str:
    return f"{path}:{function.lineno} {function.name}: {size}"


def test_few_functions_are_complex():
    found = every()
    wrong = [named(path, item, complexity(item)) for path, item in found if complexity(item) > COMPLEX]
    assert 100.0 * len(wrong) / len(found) <= MOST_COMPLEX_PCT, wrong


def test_few_functions_take_many_arguments():
    found = every()
    wrong = [named(path, item, arguments(item)) for path, item in found if arguments(item) > MANY]
    assert 100.0 * len(wrong) / len(found) <= MOST_MANY_PCT, wrong


def test_no_file_is_long():
    lines = {path.relative_to(ROOT).as_posix(): len(path.read_text("utf-8").splitlines()) for path in FILES}
    wrong = {path: count for path, count in lines.items() if count > LONG}
    assert len(wrong) <= MOST_LONG, wrong


def test_comments_say_why_where_a_reader_would_stop():
    texts = [path.read_text("utf-8") for path in FILES]
    share = 100.0 * sum(map(comments, texts)) / sum(len(text.splitlines()) for text in texts)
    assert share >= LEAST_COMMENTS


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("pass", 1),
        ("if a and b or c: pass", 4),
        ("for x in y:\n  pass\n else: pass", 3),
        ("try: pass\n except A: pass\n except B: pass\n else: pass", 4),
        ("return [x for x in y if x if z]", 4),
        ("match x:\n  case 1: pass\n  case 2: pass\n  case _: pass", 3),
        ("assert a and b", 2),
        ("def g():\n  if a: pass", 1),
        ("return a if b else c", 2),
    ],
)
def test_decisions_are_counted(body, expected):
    (function,) = (item for item in functions(nodes(f"def f():\n {body}")) if item.name == "f")
    assert complexity(function) == expected


def test_arguments_are_counted():
    (function,) = functions(nodes("def f(self, a, /, b, *c, d, **e): pass"))
    assert arguments(function) == 5
