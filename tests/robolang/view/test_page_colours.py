"""Colours of the page: readable in both themes, and apart for eyes that do not see red, green or blue."""

import re
from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
import pytest

SHEET = Path(__file__).parents[3] / "robolang" / "view" / "page" / "src" / "style.css"
READABLE, VISIBLE = 4.5, 3.0
"""Contrasts of WCAG 2.2: text (1.4.3), and shapes that carry a meaning (1.4.11)."""
APART = 9.0
"""Least distance of two curves, CIE 1976 (76 is red against green, 2 the least that is seen)."""
SIGHT = {
    "all colours": np.eye(3),
    # Machado, Oliveira, Fernandes 2009, severity 1.0, on linear light
    "no red": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "no green": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "no blue": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
}
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


def theme(name):
    """The custom properties of a theme that are colours, as linear light."""
    text = SHEET.read_text("utf-8")
    blocks = re.findall(r":root(?:\[data-theme=\"dark\"\])? \{(.*?)\n\}", text, re.DOTALL)
    assert len(blocks) == 2
    found = re.findall(r"--([a-z0-9-]+): (#[0-9a-f]{6});", blocks[name == "dark"])
    return {key: linear(value) for key, value in found}


def linear(code):
    part = np.array([int(code[k : k + 2], 16) for k in (1, 3, 5)]) / 255
    return np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)


def contrast(a, b):
    high, low = sorted((float(XYZ[1] @ a), float(XYZ[1] @ b)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def lab(colour):
    ratio = XYZ @ np.clip(colour, 0, 1) / XYZ.sum(axis=1)
    x, y, z = np.where(ratio > 216 / 24389, np.cbrt(ratio), (24389 / 27 * ratio + 16) / 116)
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


@pytest.mark.parametrize("name", ["light", "dark"])
def test_text_is_readable(name):
    colours = theme(name)
    pairs = [(ink, ground) for ink in ("ink", "muted") for ground in ("panel", "raised", "bg", "now")]
    pairs += [(kind, f"{kind}-soft") for kind in ("error", "warning", "note", "print", "ok")]
    pairs += [(kind, "panel") for kind in ("error", "warning", "note", "accent", "ok")]
    pairs += [("ink", ground) for ground in ("move", "hand", "load", "wait", "other", "note-soft")]
    pairs += [("panel", "accent"), ("accent", "accent-soft")]
    low = {pair: round(contrast(*(colours[key] for key in pair)), 2) for pair in pairs}
    assert {pair: value for pair, value in low.items() if value < READABLE} == {}


@pytest.mark.parametrize("name", ["light", "dark"])
def test_curves_and_signs_are_visible(name):
    colours = theme(name)
    signs = [key for key in colours if re.fullmatch(r"curve-\d|\w+-edge|playhead|limit", key)]
    assert len(signs) >= 14
    low = {key: round(contrast(colours[key], colours["panel"]), 2) for key in signs}
    assert {key: value for key, value in low.items() if value < VISIBLE} == {}


@pytest.mark.parametrize("name", ["light", "dark"])
@pytest.mark.parametrize("sight", SIGHT)
def test_six_curves_are_apart_for_every_sight(name, sight):
    colours = theme(name)
    seen = [lab(np.array(SIGHT[sight]) @ colours[f"curve-{k}"]) for k in range(6)]
    near = {(i, j): round(float(np.linalg.norm(seen[i] - seen[j])), 1) for i, j in combinations(range(6), 2)}
    assert {pair: value for pair, value in near.items() if value < APART} == {}


@pytest.mark.parametrize("name", ["light", "dark"])
@pytest.mark.parametrize("sight", SIGHT)
def test_the_ramp_of_the_error_becomes_lighter_from_end_to_end(name, sight):
    colours = theme(name)
    light = [lab(np.array(SIGHT[sight]) @ colours[f"ramp-{k}"])[0] for k in range(5)]
    assert all(after > before + 3 for before, after in pairwise(light)), light
