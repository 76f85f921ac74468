"""The built script of the pages is the one of its sources, and nothing in it needs a network."""

import hashlib
import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

VIEW = Path(__file__).parents[3] / "robolang" / "view"
STATIC, SOURCES = VIEW / "static", VIEW / "page"
BUILT = ["THIRD_PARTY.txt", "page.html", "viewer.css", "viewer.js"]


def checksums() -> dict[str, str]:
    lines = (STATIC / "SHA256SUMS").read_text("ascii").splitlines()
    return {name: digest for digest, name in (line.split("  ") for line in lines)}


def test_the_built_files_are_those_of_their_checksums():
    assert sorted(checksums()) == BUILT
    for name, digest in checksums().items():
        assert hashlib.sha256((STATIC / name).read_bytes()).hexdigest() == digest


def test_nothing_else_lies_beside_them():
    assert sorted(path.name for path in STATIC.iterdir()) == sorted([*BUILT, "SHA256SUMS"])


def test_the_same_sources_give_the_same_bytes(tmp_path):
    if shutil.which("node") is None or not (SOURCES / "node_modules").is_dir():
        pytest.skip("no node, or `make viewer` was not run: the sources cannot be built here")
    subprocess.run(["node", "build.mjs", str(tmp_path)], cwd=SOURCES, check=True)
    for name in [*BUILT, "SHA256SUMS"]:
        assert (tmp_path / name).read_bytes() == (STATIC / name).read_bytes(), f"{name}: run `make viewer`"


def test_versions_are_exact_and_the_lock_holds_no_address():
    package = json.loads((SOURCES / "package.json").read_text("utf-8"))
    assert package["type"] == "module"
    assert all(re.fullmatch(r"\d+\.\d+\.\d+", version) for version in package["devDependencies"].values())
    assert "http" not in (SOURCES / "package-lock.json").read_text("utf-8").replace("https://opencollective", "")


def test_the_licences_of_the_bundled_libraries_are_there():
    text = (STATIC / "THIRD_PARTY.txt").read_text("utf-8")
    versions = json.loads((SOURCES / "package.json").read_text("utf-8"))["devDependencies"]
    for name in ("three", "uplot"):
        assert f"{name} {versions[name]}" in text
    assert text.count("Permission is hereby granted") == 2


def test_the_script_is_not_larger_than_its_budget():
    """A page of a run of 5 s may have 1.2 MB in all."""
    assert (STATIC / "viewer.js").stat().st_size < 760_000


@pytest.mark.parametrize("name", ["viewer.js", "viewer.css"])
def test_built_text_stands_inside_a_page_without_ending_it(name):
    assert not re.search(r"</script|</style|<script|<!--", (STATIC / name).read_text("utf-8"), re.IGNORECASE)


def test_no_source_puts_text_into_a_page_as_markup():
    for path in (SOURCES / "src").rglob("*.ts"):
        text = path.read_text("utf-8")
        assert not re.search(r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(|new Function", text), (
            path.name
        )
        assert not re.search(r"https?://|: any\b|as any\b", text), path.name
