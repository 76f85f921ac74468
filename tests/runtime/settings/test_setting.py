"""A setting is declared once, at its field: readers, options, units and the documentation come from there."""

import re
from dataclasses import fields
from pathlib import Path

import pytest

from runtime.core.faults import Fault
from runtime.core.tomlfile import Source, load_table
from runtime.core.units import DEG
from runtime.settings import layers
from runtime.settings.layers import read_layer, read_options, settings, settle
from runtime.settings.profile import Profile
from runtime.settings.setting import number

DOCS = (Path(__file__).parents[3] / "docs" / "language.md").read_text("utf-8")


def test_a_new_field_is_a_setting_everywhere(monkeypatch):
    """Nothing but the field is written; the profile that has it is made here."""

    class More(Profile):
        hover: float = number("hover_deg", 3.0, "deg", low=1.0, high=5.0)

    def hover(found):
        assert isinstance(found.profile, More)
        return found.profile.hover

    monkeypatch.setattr(layers, "Profile", More)
    assert (settings()["hover_deg"].unit, settings()["hover_deg"].default) == ("deg", 3.0)
    assert hover(settle()) == 3.0 * DEG
    table = load_table(Source("cell.toml", "[controller]\nhover_deg = 4\n")).table("controller")
    found = settle(read_layer(table))
    assert (hover(found), found["hover_deg"].origin) == (4.0 * DEG, "cell.toml:2")
    assert hover(settle(read_options({"hover_deg": ("--set", 2.0)}))) == 2.0 * DEG
    for value, code in ((6.0, "RBL605"), (float("nan"), "RBL604"), ("x", "RBL613")):
        with pytest.raises(Fault) as caught:
            read_options({"hover_deg": ("--set", value)})
        assert caught.value.code == code


def test_the_defaults_of_the_layers_are_those_of_the_profile():
    assert settle().profile == Profile()


def test_every_setting_is_in_the_documentation_with_its_default():
    for key, item in settings().items():
        rows = re.findall(rf"^\| `{item.key}` \| ([^|]*) \|", DOCS, re.MULTILINE)
        assert rows, key
        shown = str(item.default).lower() if isinstance(item.default, bool) else item.default
        if isinstance(item.default, bool | int | float) or (isinstance(item.default, str) and item.default):
            written = f"{shown:g}" if isinstance(shown, float) else str(shown)
            assert any(written in row for row in rows), (key, written, rows)


def test_a_field_of_a_group_is_not_a_key_of_the_controller():
    assert "mode" not in settings()
    assert {"servo.mode", "wrist.mode"} <= settings().keys()
    assert len(settings()) == len(set(settings()))
    assert len(fields(Profile)) < len(settings())
