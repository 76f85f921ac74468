"""``robolang weigh``: what it prints, that its LOAD can be pasted, and what it does not take."""

import json
import re

import pytest

from robolang.experiments import weigh as module
from tests.messages import fields, heads
from tests.robolang.cli.commands import ROOT, flat, robolang
from tests.robolang.helpers import checked

BODY = "1.5,30,-20,113.7"


@pytest.mark.physics
def test_it_prints_the_estimate_the_truth_and_a_load_that_parses():
    result = robolang("weigh", "--payload", BODY)
    rows = dict(re.findall(r"^  (mass, kg|cog [xyz], mm) +(.*)$", result.stdout, re.M))
    for name, true, near in (
        ("mass, kg", 2.3, 0.01),
        ("cog x, mm", 19.57, 0.2),
        ("cog y, mm", -13.04, 0.2),
        ("cog z, mm", 95.02, 0.5),
    ):
        value, sd, shown = map(float, rows[name].split())
        assert (value, shown) == (pytest.approx(true, abs=near), pytest.approx(true, abs=0.005))
        assert 0.0 < sd <= near
    load = result.stdout.splitlines()[-1]
    assert checked(load, rated=2.5) == []
    x, y, z, mass = map(float, re.fullmatch(r"LOAD \((\S+), (\S+), (\S+)\), (\S+)", load).groups())
    assert (x, y, z) == pytest.approx((19.57, -13.04, 95.02), abs=0.5)
    assert mass == pytest.approx(2.3, abs=0.01)
    assert "J2 5, J3 5, J4 25, J5 25, J6 50 deg" in result.stderr


def test_json_holds_the_same_and_repeats():
    first, second = (robolang("weigh", "--json", "--plant", "rigid").stdout for _ in range(2))
    assert first == second
    found = json.loads(first)
    assert (found["robot"], found["plant"], found["seconds"]) == ("puma560", "rigid", pytest.approx(12.408))
    assert found["true"] == {"mass_kg": 0.8, "cog_mm": pytest.approx([0, 0, 60])}
    assert found["estimated"]["mass_kg"] == pytest.approx(0.8, abs=0.01)
    assert set(found["estimated"]) == {"mass_kg", "mass_sd_kg", "cog_mm", "cog_sd_mm"}
    assert found["load"].startswith("LOAD (")
    assert all(len(found[key]) == 6 for key in ("home_deg", "amplitudes_deg", "friction_off_pct", "left_rms_nm"))


def test_the_cell_beside_the_program_counts():
    found = json.loads(
        robolang(
            "weigh", ROOT / "programs" / "manutec_pick_and_place.rbl", "--plant", "rigid", "--json", "--amplitude", "15"
        ).stdout
    )
    assert (found["robot"], found["true"]["mass_kg"]) == ("manutec_r3", 2.5)
    assert found["amplitudes_deg"] == pytest.approx([0, 3, 3, 15, 15, 30])


def test_more_than_rated_is_weighed_and_has_no_load_to_paste():
    words = ("weigh", "--payload", "2.2,0,0,80", "--plant", "rigid")
    result = robolang(*words, code=1)
    assert {"--payload", "3", "kg", "2.5"} <= fields(result.stderr)
    assert heads(result.stderr) == ["error RBL402"]
    assert re.search(r"mass, .* (2\.99|3\.00)", result.stdout)
    assert "LOAD" not in result.stdout
    found = json.loads(robolang(*words, "--json", code=1).stdout)
    assert (found["load"], found["load_code"]) == (None, "RBL402")


BAD = [
    (["--plant", "gazebo"], "RBL703 --plant gazebo", 2),
    (["--amplitude", "0"], "RBL703 0 --amplitude", 2),
    (["--amplitude", "nan"], "RBL703 0 --amplitude", 2),
    (["--payload", "1,0,0"], "RBL703 --payload 4", 2),
    (["--payload", "1,0,x,0"], "RBL703 3 --payload x", 2),
    (["--payload=-1,0,0,0"], "RBL703 --payload -1 kg", 2),
    (["--payload", "1,0,0,5000"], "RBL703 --payload", 2),
    (["nothing.rbl"], "RBL701 nothing.rbl", 2),
    (["--cell", "nothing.toml"], "RBL600", 2),
    (["--robot", "manutec_r3"], "RBL709 J3", 2),
    (["--robot", "manutec"], "RBL708 manutec", 2),
    (["--amplitude", "60"], "RBL411 J5 -133.9 deg", 3),
]


@pytest.mark.parametrize(("words", "said", "code"), BAD, ids=[" ".join(words) for words, _, _ in BAD])
def test_what_it_does_not_take(monkeypatch, words, said, code):
    monkeypatch.setattr(module, "Controller", lambda *_: pytest.fail("something moved"))
    assert set(said.split()) <= fields(flat(robolang("weigh", *words, code=code).stderr))
