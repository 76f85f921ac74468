"""Every file that the product writes is written by ``robolang.core.storage``: the old or the new one, at any moment."""

import ast
from pathlib import Path

import pytest

from tests.arch.parsed import nodes, nodes_of

ROOT = Path(__file__).parents[2]
FILES = [path for folder in ("robolang", "runtime") for path in sorted((ROOT / folder).rglob("*.py"))]
WRITING = {
    "write_text",
    "write_bytes",
    "chmod",
    "fchmod",
    "mkstemp",
    "NamedTemporaryFile",
    "savez",
    "savez_compressed",
    "savetxt",
    "tofile",
    "copyfile",
    "copytree",
}
OF_MODULES = {"save", "copy", "move", "rename", "replace"}
"""Names that write where they are of one of these modules; of others, they may be of a text or a list."""
MODULES = {"os", "shutil", "np", "Path"}
KNOWN = {
    "robolang/syntax/grammar.py: TABLE.write_text": "run by hand, makes a file of the source",
    "robolang/syntax/grammar.py: LINE_TABLE.write_text": "run by hand, makes a file of the source",
    "robolang/syntax/generate.py: NODES.write_text": "run by hand, makes a file of the source",
    "robolang/lint/pages.py: folder / name.write_text": "run by hand, makes the pages of the rules",
    "robolang/logs/npz_file.py: file.open": "to a stream of write_atomic",
    "robolang/view/film_files.py: av.open": "to a stream of write_atomic",
    "robolang/testing/golden.py: np.savez_compressed": "to a stream of write_atomic",
}


def writers(path, found):
    """Yield the calls that write, make or rename a file, as ``owner.name``."""
    for node in found:
        if not isinstance(node, ast.Call):
            continue
        name = node.func.id if isinstance(node.func, ast.Name) else getattr(node.func, "attr", "")
        owner = ast.unparse(node.func.value) if isinstance(node.func, ast.Attribute) else ""
        modes = [
            each.value
            for each in [*node.args, *(item.value for item in node.keywords)]
            if isinstance(each, ast.Constant) and isinstance(each.value, str)
        ]
        opens = name in ("open", "fdopen") and any(set(mode) & set("wxa+") and len(mode) <= 3 for mode in modes)
        if opens or name in WRITING or (name in OF_MODULES and owner in MODULES):
            yield f"{path.relative_to(ROOT)}: {owner}{'.' if owner else ''}{name}"


def test_files_are_written_in_one_place():
    found = {each for path in FILES for each in writers(path, nodes_of(path))}
    assert {each for each in found if not each.startswith("robolang/core/storage.py: ")} == set(KNOWN)


@pytest.mark.parametrize(
    "text", ["path.write_text(x)", "open(name, 'w')", "path.open('wb')", "os.replace(a, b)", "np.savez(name, q=q)"]
)
def test_a_file_that_is_written_elsewhere_is_noticed(text):
    assert list(writers(FILES[0], nodes(text)))


@pytest.mark.parametrize("text", ["open(name)", "text.replace('a', 'b')", "replace(item, x=1)", "path.open('rb')"])
def test_what_writes_no_file_is_left_out(text):
    assert not list(writers(FILES[0], nodes(text)))
