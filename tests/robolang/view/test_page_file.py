"""The file of a page: its policy, its runs, and that nothing which a user has written is ever markup."""

import base64
import hashlib
import shutil
from pathlib import Path

import pytest

from robolang.view import page as page_module
from robolang.view.page import Bundle, write_page
from robolang.view.run_page import pack_run
from runtime.core.faults import Fault
from tests.robolang.view.decoding import Page
from tests.robolang.view.recorded import event, log, meta, statement

SKELETON = (
    '<!doctype html><html><head><meta http-equiv="Content-Security-Policy" content="{{CSP}}"><style>{{CSS}}</style>'
    "</head><body>{{RUNS}}<script>{{JS}}</script></body></html>"
)
STATIC = Path(page_module.__file__).parent / "static"
STUB = Bundle(skeleton=SKELETON, script='document.title = "é {{RUNS}}"', style="body { color: #000 }")
HOSTILE = "</script><img src=x onerror=alert(1)><!-- <script> \u2028\u2029 \udcff \0 {{JS}} ]]>"


def written(path, *runs, bundle=STUB):
    write_page(path / "page.html", runs, bundle)
    return Page(path / "page.html")


def sha256(text):
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def test_the_policy_names_the_hashes_of_what_is_in_the_file_and_allows_nothing_else(tmp_path):
    page = written(tmp_path, pack_run(log(20), "a"))
    ((_, style),) = page.of("style")
    ((_, script),) = [found for found in page.of("script") if "data-run" not in found[0]]
    assert page.policy == {
        "default-src": "'none'",
        "script-src": sha256(script),
        "style-src": sha256(style),
        "img-src": "data: blob:",
        "base-uri": "'none'",
        "form-action": "'none'",
    }
    assert (script, style) == (STUB.script, STUB.style)


def test_runs_are_numbered_in_their_order_and_only_text(tmp_path):
    page = written(tmp_path, pack_run(log(20), "a"), pack_run(log(24), "b"))
    runs = [attributes for attributes, _ in page.of("script") if "data-run" in attributes]
    assert runs == [{"type": "text/plain", "data-run": str(k)} for k in (0, 1)]
    assert [header["label"] for header, _ in page.runs] == ["a", "b"]


def test_hostile_texts_are_in_the_run_as_they_are_and_nowhere_in_the_html(tmp_path):
    plain = written(tmp_path, pack_run(log(20), "a"))
    hostile = meta(
        program={"name": HOSTILE, "text": HOSTILE * 1000},
        robot={**meta()["robot"], "name": HOSTILE},
        scene={"bodies": [{"name": f"part:{HOSTILE}"}]},
        events=[event("output", HOSTILE, 1, 0.0)],
        report={"statements": [statement(1, 0.0, text=HOSTILE, notes=[HOSTILE])]},
    )
    page = written(tmp_path, pack_run(log(20, hostile), HOSTILE))
    assert [name for name, _, _ in page.elements] == [name for name, _, _ in plain.elements]
    ((header, _),) = page.runs
    assert header["label"] == HOSTILE and header["meta"]["program"] == hostile["program"]
    assert header["meta"]["scene"] == hostile["scene"]


def test_a_line_of_a_megabyte_is_kept(tmp_path):
    text = "'" + "<" * 1_000_000
    ((header, _),) = written(tmp_path, pack_run(log(20, meta(program={"name": "a", "text": text})), "a")).runs
    assert header["meta"]["program"]["text"] == text


def test_the_same_run_is_the_same_file(tmp_path):
    first = written(tmp_path, pack_run(log(163), "a")).text
    assert written(tmp_path, pack_run(log(163), "a")).text == first


def test_nothing_in_script_and_style_ends_their_elements_or_is_changed_by_a_browser():
    """The hash in the policy is that of the text between the tags, as a browser reads it."""
    bundle = Bundle.installed()
    for text in (bundle.script, bundle.style):
        for ending in ("</script", "<script", "</style", "<!--", "\r", "\0"):
            assert ending not in text.lower()


@pytest.mark.parametrize("skeleton", [SKELETON.replace("{{CSP}}", ""), SKELETON + "{{JS}}", ""])
def test_a_skeleton_without_its_marks_is_refused(skeleton):
    with pytest.raises(Fault) as caught:
        Bundle(skeleton=skeleton, script="", style="")
    assert caught.value.code == "RBL825"


@pytest.mark.parametrize("name", ["viewer.js", "viewer.css", "page.html", "SHA256SUMS"])
@pytest.mark.parametrize("how", ["missing", "changed"])
def test_a_damaged_installation_is_found(tmp_path, monkeypatch, name, how):
    shutil.copytree(STATIC, tmp_path / "static")
    monkeypatch.setattr("importlib.resources.files", lambda package: tmp_path)
    Bundle.installed()
    path = tmp_path / "static" / name
    if how == "missing":
        path.unlink()
    else:
        path.write_bytes(b"\xff" + path.read_bytes())
    with pytest.raises(Fault) as caught:
        Bundle.installed()
    assert caught.value.code == "RBL825"


def test_a_folder_that_is_not_there_is_a_fault_and_nothing_is_written(tmp_path):
    with pytest.raises(Fault) as caught:
        written(tmp_path / "none", pack_run(log(20), "a"))
    assert caught.value.code == "RBL706" and not list(tmp_path.iterdir())
