"""What is fuzzed: functions of bytes that raise ``AssertionError`` when a promise is broken, and nothing else ever.

The promises are R10 and R12 to R14: whatever the bytes are, what comes is a diagnostic or a located fault with a
registered code, in bounded time; places lie in the text; formatting is done once and keeps tree and comments.
"""

import json
import re
from contextlib import contextmanager
from pathlib import Path
from tempfile import mkdtemp

import mujoco
import numpy as np

from robolang.analysis import checker
from robolang.analysis.cell_symbols import CellSymbols
from robolang.core.diagnostics import Severity, render, render_fault, to_json
from robolang.core.source import Source, decode_program
from robolang.lint import engine
from robolang.logs.files import read_log
from robolang.project.discovery import builtin_cell_file
from robolang.project.points import load_points
from robolang.syntax import ast, formatter
from robolang.syntax.grammar import line_parser
from robolang.syntax.keywords import KEYWORDS
from robolang.syntax.parser import parse
from robolang.teaching.logged import joints_at
from robolang.testing.golden import read_golden
from runtime.appearance.scene import Scene
from runtime.appearance.stance import Stance
from runtime.appearance.views import named_view
from runtime.cell.body_mesh import read_body_mesh
from runtime.cell.flat_faces import flat_faces
from runtime.core.faults import Fault, lookup
from runtime.core.mesh_files import MeshError
from runtime.core.solid import NoSolidError
from runtime.core.tomlfile import FileFault
from runtime.plant.camera import picture_mjcf
from runtime.robot.files.importer import read_arm
from runtime.robot.model.axis_kind import REVOLUTE
from tests.robolang.helpers import cell_with
from tests.runtime.from_texts import load_cell

_NAME = "fuzz.rbl"
_POINTS = ("P1", "P2", "P3")
_LINE = re.compile(r"\r\n?|\n")
_KINDS = KEYWORDS | {"FUNCTION", "VALUE", "SUSPICIOUS", "HUGE"} | {each.name for each in line_parser().terminals}
_CYCLES = 20
_FOLDER = Path(mkdtemp(prefix="fuzz-"))


def lex(data):
    """Tokens are the text: nothing but blanks between them, each of a kind that the grammar knows."""
    source = _program(data)
    if source is None:
        return
    for span in source.line_spans:
        line, at = source.slice(span), 0
        for token in line_parser().parse_interactive(line, start="start").lexer_thread.lex(None):
            assert token.type in _KINDS
            assert at <= token.start_pos < token.end_pos
            assert token == line[token.start_pos : token.end_pos]
            assert not line[at : token.start_pos].strip(" \t")
            at = token.end_pos
        assert not line[at:].strip(" \t")


def read(data):
    """Parsing gives a tree in which each line with an error is one line with one error."""
    source = _program(data)
    if source is None:
        return
    found = parse(source)
    _assert_located(source, found.diagnostics)
    bad = [line for line in found.program.lines if isinstance(line.statement, ast.Unparsed)]
    errors = [item for item in found.diagnostics if item.severity is Severity.ERROR and item.code != "RBL107"]
    assert len(bad) >= len(errors)
    rows = [line.source_line for line in found.program.lines]
    assert rows == sorted(set(rows))
    for line in found.program.lines:
        whole = source.line_spans[line.source_line - 1]
        for part in (line, line.label, line.statement, line.comment):
            for node in () if part is None else ast.walk(part):
                assert whole.start <= node.span.start <= node.span.end <= whole.end


def check(data):
    """All findings have a place, and with and without knowledge of the cell there are no others but findings."""
    source = _program(data)
    if source is None:
        return
    _assert_located(source, engine.lint(source, cell_with(points=_POINTS)))
    program = parse(source).program
    _assert_located(source, checker.check(program))
    _assert_located(
        source,
        checker.check(
            program,
            cell_with(
                points=_POINTS,
                rated_payload_kg=2.5,
                sensors=["TORCH"],
                tools=["T1"],
                frames=["F1"],
                loads=["L1"],
                inputs=[1, 2],
            ),
        ),
    )


def format(data):
    """What is formatted has the tree and the comments of the text, and is a fixed point."""
    source = _program(data)
    if source is None:
        return
    before, found = parse(source), formatter.format_source(source)
    assert found.changed == (found.text != source.text)
    after = parse(Source(_NAME, found.text))
    assert _canonical(after.program) == _canonical(before.program)
    if found.changed:
        again = formatter.format_source(Source(_NAME, found.text))
        assert again.text == found.text
        assert not again.changed


def points(data):
    """A points file is read or refused at a place in it."""
    path = _FOLDER / "fuzz.points.toml"
    path.write_bytes(data)
    with _located(path, data):
        load_points(path, CellSymbols.of(builtin_cell_file()))


def cell(data):
    """A cell file is read or refused at a place in it."""
    path = _FOLDER / "fuzz.cell.toml"
    path.write_bytes(data)
    with _located(path, data):
        load_cell(path)


def model(data):
    """A URDF or MJCF file is read as an arm of finite numbers or refused at a place in it."""
    path = _FOLDER / "fuzz.urdf"
    path.write_bytes(data)
    with _located(path, data, _LINE):
        arm = read_arm(path)
        assert np.isfinite([arm.lower, arm.upper]).all()
        assert all(np.isfinite(axis.placement).all() for axis in arm.axes)


def mesh(data):
    """A file is a solid of finite numbers within its hull, or it is none."""
    for ending in (".stl", ".obj"):
        path = _FOLDER / f"fuzz{ending}"
        path.write_bytes(data)
        try:
            body = read_body_mesh(path, path.name, 1.0)
        except (MeshError, NoSolidError) as error:
            assert str(error)
            continue
        assert np.isfinite(body.solid.gyration).all()
        assert body.hull_volume >= body.solid.volume * 0.999
        normals = flat_faces(body).normals
        assert np.abs((normals**2).sum(axis=1) - 1.0).max(initial=0.0) < 1e-9


def golden(data):
    """A golden log is read, finite and no longer than the run, or refused."""
    path = _FOLDER / "fuzz.golden.npz"
    path.write_bytes(data)
    try:
        found = read_golden(path, axes=6, most_cycles=_CYCLES)
    except Fault as fault:
        assert fault.code in ("RBL600", "RBL711")
        assert fault.message
        return
    assert len(found.q) == len(found.line) == min(found.cycles, _CYCLES)
    assert np.isfinite(found.q).all()
    at, said = found.difference(found.q, found.line, [(REVOLUTE, 0.0)] * 6)
    assert (at is None) == (found.cycles <= _CYCLES)
    assert said


def log(data):
    """A log is read and gives all that it names, or is refused; what it gives is as large as its rows say."""
    path = _FOLDER / "fuzz.npz"
    path.write_bytes(data)
    with _refusing("RBL600", "RBL619", "RBL820", "RBL821"):
        found = read_log(path)
        for name in found:
            with _refusing("RBL619"):
                assert len(found[name]) == found.count(name) <= len(data)
        if found.meta is not None:
            found.each_cycle("line")
            json.dumps(found.meta, allow_nan=False)
            _scene(found.meta.get("scene"))
        joints_at(path, 6, 0.0)


def _scene(value):
    """A scene that is one can be drawn and framed."""
    with _refusing("RBL833"):
        scene = Scene.from_json(value)
        mujoco.MjModel.from_xml_string(picture_mjcf(scene, 64, 48))
        view = named_view("iso", scene, [Stance(axes=())], 4 / 3)
        assert np.isfinite([view.position, view.target]).all()


@contextmanager
def _refusing(*codes):
    try:
        yield
    except Fault as fault:
        assert fault.code in codes
        assert fault.message
        assert fault.hint or lookup(fault.code).remedy


TARGETS = {
    "lex": lex,
    "parse": read,
    "check": check,
    "format": format,
    "points": points,
    "cell": cell,
    "model": model,
    "mesh": mesh,
    "golden": golden,
    "log": log,
}
SEEDS = {each: each for each in ("points", "cell", "model", "mesh", "golden", "log")}
"""The folder of the corpus for each target; ``program`` for the others."""


def run(target, data):
    """Give bytes to a target; ``AssertionError`` when a promise is broken, whatever else breaks included."""
    TARGETS[target](data)


# --- oracles ---------------------------------------------------------------------------------------------------------


def _program(data):
    """The program that bytes are the text of; None when they are none, which must be said with a place."""
    try:
        return decode_program(_NAME, data)
    except FileFault as fault:
        assert fault.code in ("RBL104", "RBL106")
        lines = _LINE.split(data.removeprefix(b"\xef\xbb\xbf").decode("utf-8", "replace"))
        assert 1 <= fault.line <= len(lines)
        assert 1 <= fault.column <= len(lines[fault.line - 1]) + 1
        return None


def _assert_located(source, diagnostics):
    """Every diagnostic has a known code and places in the text, in each of its views."""
    for item in diagnostics:
        lookup(item.code)
        assert item.message
        assert item.hint
        for span in (item.span, *(other.span for other in item.related)):
            assert 0 <= span.start <= span.end <= len(source.text)
        shown = render(item, source)
        assert shown.startswith(f"{_NAME}:")
        assert not re.search(r"[\x00-\x09\x0b-\x1f\x7f]", shown)
        place = to_json(item, source)
        lines = source.line_spans
        assert 1 <= place["line"] <= place["end_line"] <= len(lines)
        assert 1 <= place["column"] <= lines[place["line"] - 1].end - lines[place["line"] - 1].start + 1
        assert place["code"] == item.code
    assert list(diagnostics) == sorted(diagnostics, key=lambda item: (item.code == "RBL107", item.span, item.code))


def _canonical(program):
    """The tree with REM in capitals, which is all of it that the formatter changes."""
    return [
        ast.replace(line, comment=None if line.comment is None else ast.Comment(text=_spelt(line.comment.text)))
        for line in program.lines
    ]


def _spelt(comment):
    return comment if comment.startswith("'") else f"REM{comment[3:]}"


@contextmanager
def _located(path, data, line_end=re.compile("\n")):
    try:
        yield
    except FileFault as fault:
        lookup(fault.code)
        assert fault.message
        assert fault.hint
        shown = render_fault(fault)
        assert not re.search(r"[\x00-\x09\x0b-\x1f\x7f]", shown)
        if fault.path == str(path):
            line_end = re.compile("\n") if fault.code == "RBL600" else line_end  # what is no text has no XML lines
            lines = line_end.split(data.decode("utf-8-sig", "replace"))
            assert 1 <= fault.line <= len(lines)
            assert 1 <= fault.column <= len(lines[fault.line - 1]) + 1
