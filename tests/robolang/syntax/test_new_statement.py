"""A statement without a new effect is added by editing three files: the rest of the product knows of it by itself."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.steps import HANG_S

ROOT = Path(__file__).parents[3]

STATEMENTS, GRAMMAR, ACTIONS = WRITTEN = (
    "robolang/syntax/statements.py",
    "robolang/syntax/grammar.lark",
    "robolang/interpreter/actions.py",
)
"""What is edited by hand, and all of it."""
GENERATED = (
    "robolang/syntax/grammar.json",
    "robolang/syntax/line_table.json",
    "robolang/syntax/statement_nodes.py",
)
GENERATORS = ("robolang.syntax.generate", "robolang.syntax.grammar")

DECLARED = """\
PITCH = Limit(name="the pitch of BEEP", unit="Hz", low=20.0, high=20_000.0, code="RBL404")
TIMES = Limit(name="TIMES", unit="", low=1.0, high=10.0, code="RBL404", whole=True)
_SIGNALS = (
    Declaration(
        "Beep",
        ("BEEP {pitch}[, TIMES {times}]",),
        "shows a signal",
        (_number("pitch", "Hz", PITCH), _number("times", "n", TIMES, optional=True)),
        effect="Show",
        fails=Fails.OPERANDS,
    ),
)
STATEMENTS = (*_SIGNALS, """
ACTION = """
    def _beep(self, line: Line, node: Beep) -> Effect:
        times = 1.0 if node.times is None else TIMES.checked(self._values.number(node.times))
        text = f"beep {PITCH.checked(self._values.number(node.pitch)):g} x {times:g}"
        return effects.Show(**origin(line, node), text=text)


_EFFECT: dict"""

EDITS = (
    (STATEMENTS, "STATEMENTS = (", DECLARED),
    (GRAMMAR, "?simple: ", "?simple: beep | "),
    (GRAMMAR, "pulse: ", "beep: BEEP expression [_COMMA TIMES expression]\npulse: "),
    (GRAMMAR, "%declare MOVE ", "%declare BEEP TIMES MOVE "),
    (ACTIONS, "    Approach,\n", "    Approach,\n    Beep,\n"),
    (
        ACTIONS,
        "from robolang.values.functions",
        "from robolang.syntax.statements import PITCH, TIMES\nfrom robolang.values.functions",
    ),
    (ACTIONS, "\n\n_EFFECT: dict", ACTION),
    (ACTIONS, "    Pulse: Actions._pulse,\n", "    Pulse: Actions._pulse,\n    Beep: Actions._beep,\n"),
)


def ran(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Run a module of the copy in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", *words],
        cwd=folder,
        env={"PYTHONPATH": str(folder), "COLUMNS": "200"},
        capture_output=True,
        text=True,
        timeout=HANG_S,
        check=False,
    )


def sources(folder: Path) -> dict[str, bytes]:
    """Everything in the package but bytecode, by path."""
    files = (path for path in (folder / "robolang").rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def edit(folder: Path, name: str, old: str, new: str) -> None:
    text = (folder / name).read_text("utf-8")
    assert old in text, f"{name} has no {old!r}: the test edits what is no longer there"
    (folder / name).write_text(text.replace(old, new, 1), "utf-8")


@pytest.fixture(scope="module")
def product(tmp_path_factory):
    """A copy of the package that has the statement BEEP."""
    folder = tmp_path_factory.mktemp("product")
    shutil.copytree(ROOT / "robolang", folder / "robolang", ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "runtime").symlink_to(ROOT / "runtime")
    for name, old, new in EDITS:
        edit(folder, name, old, new)
    for module in GENERATORS:
        done = ran(folder, module)
        assert (done.returncode, done.stderr) == (0, "")
    return folder


def robolang(product: Path, text: str, *words: str) -> subprocess.CompletedProcess[str]:
    (product / "p.rbl").write_text(text, "utf-8")
    return ran(product, "robolang", *words, "p.rbl")


def found(done: subprocess.CompletedProcess[str]) -> list[list[str]]:
    """Place, severity and code of each diagnostic, as ``p.rbl:1:6:``."""
    return [line.split(" ")[:3] for line in done.stdout.splitlines() if line.startswith("p.rbl:")]


def test_three_files_are_edited_and_three_generated(product):
    before, after = sources(ROOT), sources(product)
    changed = {name for name in before.keys() | after.keys() if before.get(name) != after.get(name)}
    assert changed == {*WRITTEN, *GENERATED}


def test_check_accepts_it(product):
    done = robolang(product, "10 BEEP 440\n20 PITCH = 880\n30 BEEP PITCH / 2, TIMES 3\n", "check")
    assert (done.returncode, found(done)) == (0, [])


@pytest.mark.parametrize(
    ("text", "place", "code"),
    [
        ("BEEP 19.5", "1:6", "RBL404"),
        ("BEEP 20000.5", "1:6", "RBL404"),
        ("BEEP 440, TIMES 1.5", "1:17", "RBL404"),
        ("BEEP 440, TIMES 0", "1:17", "RBL404"),
        ('BEEP "high"', "1:6", "RBL217"),
        ("BEEP PITCH", "1:6", "RBL215"),
        ("BEEP", "1:5", "RBL111"),
        ("BEEP 440 TIMES 2", "1:10", "RBL111"),
        ("BEEP = 5", "1:6", "RBL111"),
    ],
)
def test_check_refuses_what_the_declaration_does_not_allow(product, text, place, code):
    done = robolang(product, f"{text}\n", "check")
    assert (done.returncode, found(done)) == (1, [[f"p.rbl:{place}:", "error", code]])


@pytest.mark.parametrize(
    ("text", "place", "code", "keyword"),
    [
        ("BEP 440", "1:1", "RBL112", "BEEP"),
        ("BEEP 440, TIMS 2", "1:11", "RBL111", "TIMES"),
    ],
)
def test_a_misspelt_keyword_is_hinted(product, text, place, code, keyword):
    done = robolang(product, f"{text}\n", "check")
    assert found(done) == [[f"p.rbl:{place}:", "error", code]]
    (hint,) = (line for line in done.stdout.splitlines() if line.strip().startswith("help:"))
    assert keyword in re.findall(r"\w+", hint)


def test_the_formatter_writes_it(product):
    done = robolang(product, "beep  440 ,times 2\nif 1 = 1 then\nbeep 5*100\nendif\n", "fmt")
    assert done.returncode == 0, done.stderr
    assert (product / "p.rbl").read_text("utf-8") == "BEEP 440, TIMES 2\nIF 1 = 1 THEN\n  BEEP 5 * 100\nENDIF\n"


def test_a_run_carries_it_out(product):
    done = robolang(product, "BEEP 440\nIF 1 = 1 THEN BEEP 400 + 480, TIMES 2\n", "run", "--no-physics")
    assert (done.returncode, done.stdout.splitlines()[:2]) == (0, ["beep 440 x 1", "beep 880 x 2"])


def test_a_dry_run_carries_it_out(product):
    done = robolang(product, "N = 0\nFOR I = 1 TO 3\nN = N + I\nNEXT\nBEEP N\n", "check", "--motion")
    assert (done.returncode, found(done)) == (1, [["p.rbl:5:1:", "error", "RBL404"]])


def test_a_move_does_not_blend_into_it(product):
    done = robolang(product, "MOVE POSE(400, 0, 300, 0, 180, 0), ZONE 20\nBEEP 440\n", "check")
    assert found(done) == [["p.rbl:1:36:", "warning", "RBL413"]]


def test_it_is_among_the_completions(product):
    script = (
        "from robolang.syntax.completion import completions\nprint(*(each.form for each in completions()), sep='\\n')"
    )
    (product / "show.py").write_text(script)
    assert "BEEP Hz [, TIMES n]" in ran(product, "show").stdout.splitlines()
