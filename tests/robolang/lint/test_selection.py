"""Which findings are reported."""

import pytest

from robolang.core.diagnostics import Diagnostic, Severity
from robolang.core.source import Span
from robolang.lint.selection import guess, is_syntax_error, selector, words
from tests.messages import fields
from tests.robolang.lint.helpers import layer, places, selection

WARNING, ERROR, INFO = Severity.WARNING, Severity.ERROR, Severity.INFO


def keeps(code, *layers, severity=ERROR):
    return selection(*layers).keeps(Diagnostic(code=code, severity=severity, message="", span=Span(0, 0)))


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("RBL301", "RBL301"),
        ("rbl301", "RBL301"),
        (" RBL301 ", "RBL301"),
        ("RBL3", "RBL3"),
        ("RBL30", "RBL30"),
        ("RBL", "RBL"),
        ("ALL", "RBL"),
        ("all", "RBL"),
        ("point-undefined", "RBL301"),
        ("Point-Undefined", "RBL301"),
        ("RBL399", None),
        ("RBL0", None),
        ("301", None),
        ("", None),
        ("point", None),
        ("RBL3011", None),
        ("RBL3*", None),
    ],
)
def test_a_selector_is_a_beginning_a_code_or_a_name(text, meant):
    assert selector(text) == meant


def test_words_are_codes_and_names():
    known = words()
    assert known["RBL301"] == known["POINT-UNDEFINED"] == "RBL301"
    assert "RBL3" not in known


def test_a_misspelt_selector_is_answered_with_the_nearest():
    assert "point-undefined" in guess("point-undefind")
    assert fields(guess("RBL30I")) == {"RBL301", "RBL302", "RBL303", "RBL304", "RBL305"}
    assert fields(guess("rbl19")) == {"RBL190", "RBL191"}
    assert guess("RBL999") == ""
    assert guess("zzz") == ""


def test_without_a_layer_everything_is_reported():
    assert keeps("RBL301")
    assert keeps("RBL201", layer(), severity=WARNING)


@pytest.mark.parametrize(
    ("layers", "on", "off"),
    [
        ([layer(select=["RBL3"])], ["RBL301"], ["RBL401"]),
        ([layer(select=["RBL3", "payload-not-a-mass"])], ["RBL301", "RBL401"], ["RBL402"]),
        ([layer(select=[])], [], ["RBL301", "RBL401"]),
        ([layer(ignore=["RBL4"])], ["RBL301"], ["RBL401", "RBL405"]),
        ([layer(ignore=["RBL4"], extend=["RBL401"])], ["RBL401"], ["RBL402"]),
        ([layer(select=["RBL40"], ignore=["RBL4"])], ["RBL401"], ["RBL301"]),
        ([layer(select=["RBL4"], ignore=["RBL4"])], [], ["RBL401"]),
        ([layer(select=["RBL401"], ignore=["RBL401"])], [], ["RBL401"]),
        ([layer(select=["ALL"], ignore=["RBL3"])], ["RBL401"], ["RBL301"]),
        ([layer(select=["RBL3"], extend=["RBL4"])], ["RBL301", "RBL401"], ["RBL201"]),
        ([layer(ignore=["RBL301"]), layer(select=["RBL3"])], ["RBL301"], ["RBL401"]),
        ([layer(ignore=["RBL301"]), layer(extend=["RBL401"])], ["RBL401"], ["RBL301"]),
        ([layer(ignore=["RBL301"]), layer(extend=["RBL301"])], ["RBL301"], []),
        ([layer(select=["RBL3"]), layer(ignore=["RBL301"])], ["RBL306"], ["RBL301", "RBL401"]),
        ([layer(select=["RBL3"]), layer(extend=["RBL4"])], ["RBL301", "RBL401"], ["RBL201"]),
        ([layer(select=["RBL301"]), layer(ignore=["RBL3"])], [], ["RBL301"]),
    ],
)
def test_layers_are_laid_over_one_another(layers, on, off):
    assert [code for code in (*on, *off) if keeps(code, *layers, severity=WARNING)] == on


@pytest.mark.parametrize(
    ("layers", "kept"),
    [
        ([layer(ignore=["RBL1"])], True),
        ([layer(ignore=["RBL11"])], True),
        ([layer(ignore=["ALL"])], True),
        ([layer(select=["RBL4"])], True),
        ([layer(select=[])], True),
        ([layer(ignore=["RBL112"])], False),
        ([layer(ignore=["unknown-instruction"])], False),
        ([layer(ignore=["RBL112"], extend=["RBL112"])], False),
        ([layer(ignore=["RBL112"]), layer(extend=["RBL112"])], True),
        ([layer(ignore=["RBL112"]), layer(select=["RBL112"])], True),
        ([layer(ignore=["RBL112"]), layer(select=["RBL4"])], True),
        ([layer(ignore=["RBL112"]), layer(ignore=["RBL4"])], False),
    ],
)
def test_an_error_of_syntax_is_hidden_by_its_whole_code_only(layers, kept):
    assert keeps("RBL112", *layers) is kept


def test_warnings_and_infos_of_the_text_are_selected_like_all_others():
    for code, severity in (("RBL116", WARNING), ("RBL110", INFO)):
        assert not keeps(code, layer(ignore=["RBL1"]), severity=severity)
        assert not keeps(code, layer(select=["RBL4"]), severity=severity)


def test_an_error_of_syntax_is_one_of_the_text():
    def of(code, severity):
        return is_syntax_error(Diagnostic(code=code, severity=severity, message="", span=Span(0, 0)))

    assert of("RBL112", ERROR)
    assert not of("RBL116", WARNING)
    assert not of("RBL301", ERROR)


def test_a_text_is_linted_with_a_selection():
    text = "20 MOVE P9\n10 MOV P1\n"
    assert [code for code, *_ in places(text)] == ["RBL301", "RBL116", "RBL112"]
    assert [code for code, *_ in places(text, selection=selection(layer(select=["RBL4"])))] == ["RBL112"]
