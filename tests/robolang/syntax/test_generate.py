"""The generated classes of statements are those of the declarations, and nodes are values."""

import copy
import pickle
import subprocess
import sys
from typing import get_args

import pytest

from robolang.core.source import Span
from robolang.syntax import ast
from robolang.syntax.generate import NODES, nodes
from robolang.syntax.statements import OPTIONS, STATEMENTS, declaration
from robolang.syntax.tree import fields
from tests.robolang import generator
from tests.robolang.helpers import parsed
from tests.together import together

KINDS = [*get_args(ast.Expression), *get_args(ast.Option), *get_args(ast.Statement), ast.Target, ast.Line, ast.Comment]


def test_the_classes_are_those_of_the_declarations():
    assert NODES.read_text("utf-8") == nodes(), "run: python -m robolang.syntax.generate"


def test_every_declared_statement_and_option_has_a_class():
    assert {each.node for each in STATEMENTS} == {kind.__name__ for kind in get_args(ast.Statement)} - {"Unparsed"}
    assert {each.node for each in OPTIONS} == {kind.__name__ for kind in get_args(ast.Option)}
    for each in STATEMENTS:
        assert {operand.name for operand in each.operands} <= set(fields(getattr(ast, each.node)))


@pytest.mark.parametrize("word", generator.SETTINGS)
def test_statements_of_one_class_are_told_apart_by_their_word(word):
    assert declaration(parsed(f"{word} 5").lines[0].statement).word == word


def name(text, **more):
    return ast.Name(text=text, **more)


def test_nodes_are_equal_when_they_mean_the_same():
    there = Span(3, 5)
    assert name("p1", span=there, parentheses=2) == name("P1")
    assert hash(name("p1", span=there)) == hash(name("P1"))
    assert ast.Number(value=1.0, text="1") == ast.Number(value=1.0, text="1.0")
    assert ast.Sub(name=name("a"), parentheses=1) == ast.Sub(name=name("a"))
    assert name("P1") != name("P2")
    assert name("P1") != ast.Text(value="P1")
    assert ast.Move(target=name("P1")) != ast.MoveJ(target=name("P1"))
    assert ast.Delay(seconds=name("a")) != ast.Delay(seconds=name("b"))
    assert ast.Comment(text="'a") != ast.Comment(text="'b")


def test_a_copy_has_what_was_changed_and_all_else():
    there = Span(3, 5)
    node = ast.Pulse(index=name("a"), seconds=name("b"), span=there)
    changed = ast.replace(node, seconds=name("c"))
    assert changed == ast.Pulse(index=name("a"), seconds=name("c"))
    assert (changed.span, node.seconds.key) == (there, "B")
    assert ast.replace(name("a"), text="b").key == "B"
    with pytest.raises(TypeError):
        ast.replace(node, other=1)


@together("kind", KINDS)
def test_nodes_take_their_fields_by_keyword_only(kind):
    with pytest.raises(TypeError):
        kind(1)
    with pytest.raises(AttributeError):
        kind.__new__(kind).other = 1


def test_nodes_are_copied_whole():
    program = parsed("10 *A MOVE P1 + (0, 0, 5), SPEED 2, WRIST HOLD TILT " + '\' c\nPRINT -1; "t"\n')
    for twin in (copy.deepcopy(program), pickle.loads(pickle.dumps(program))):
        assert twin == program
        assert twin.lines[0].span == program.lines[0].span
        assert repr(twin) == repr(program)


def test_the_tree_needs_no_decorated_classes():
    """Building them when they are imported took a third of the start of ``robolang check``."""
    script = """
import dataclasses, sys
built = []
real = dataclasses._process_class
dataclasses._process_class = lambda kind, *more: built.append(kind.__module__) or real(kind, *more)
import robolang.syntax.ast
print([name for name in built if name.startswith("robolang.syntax")])
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
