"""The site of the documentation: every page of docs/ is in its menu, and every page of its menu is there."""

import tomllib

from tests.programs.runs import ROOT

DOCS = ROOT.parent / "docs"
SITE = tomllib.loads((ROOT.parent / "zensical.toml").read_text("utf-8"))["project"]
PARTS = ["Start", "How to", "Reference", "Explanations"]


def pages(entry):
    """The pages of an entry of the menu."""
    if isinstance(entry, str):
        return [entry]
    inner = entry if isinstance(entry, list) else entry.values()
    return [page for each in inner for page in pages(each)]


def test_the_menu_has_four_parts():
    assert [name for part in SITE["nav"] for name in part] == PARTS


def test_every_page_is_in_the_menu_once():
    # rules and decisions have pages of their own, which their lists lead to
    there = {path.relative_to(DOCS).as_posix() for path in DOCS.rglob("*.md")}
    listed = pages(SITE["nav"])
    assert len(listed) == len(set(listed))
    assert set(listed) <= there
    folders = {page.partition("/")[0] for page in listed if "/" in page}
    assert {page for page in there if page.partition("/")[0] not in folders} <= set(listed)
