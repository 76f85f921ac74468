"""What check and a run show of a suction cup: nothing under its rim, a part too heavy, a cup pressed too deep."""

import pytest

from robolang.execution.dry_run import rehearse
from robolang.execution.session import Session
from robolang.planning.motion_findings import findings
from robolang.project.project import load_project
from tests.programs.runs import ROOT
from tests.runtime.meshes import binary_stl, prism

pytestmark = pytest.mark.physics

LIFT = "LOAD empty\nMOVE FEED{}\nHAND ON\nLOAD can\nMOVE FEED + (0, 0, 60)\nHAND OFF\nLOAD empty\n"


def project(folder, text, old="", new=""):
    for kind in ("cell", "points"):
        source = (ROOT / f"shop/cans.{kind}.toml").read_text()
        assert kind == "points" or old in source
        (folder / f"p.{kind}.toml").write_text(source.replace(old, new, 1) if old and kind == "cell" else source)
    (folder / "p.rbl").write_text(text)
    return load_project(folder / "p.rbl")


def checked(job):
    rows = [(item.code, job.source.place(item.span.start).line) for item in findings(job, rehearse(job))]
    return [row for row in rows if row[0] in ("RBL421", "RBL440", "RBL441")]


@pytest.mark.parametrize(
    ("offset", "expected"),
    [
        ("", []),
        (" + (0, 7, 0)", []),
        (" + (0, 8, 0)", [("RBL441", 3)]),
        (" + (0, 0, 1.2)", [("RBL441", 3)]),
        (" + (0, 0, -1)", [("RBL440", 2)]),
        (" + (0, 0, -30)", [("RBL440", 2)]),
    ],
)
def test_the_rim_must_be_on_the_can(tmp_path, offset, expected):
    assert checked(project(tmp_path, LIFT.format(offset))) == expected


@pytest.mark.parametrize(("offset", "codes"), [("", []), (" + (0, 7, 0)", []), (" + (0, 8, 0)", ["RBL441"])])
def test_a_can_that_is_a_mesh_is_sealed_on_by_check_and_run_alike(tmp_path, offset, codes):
    (tmp_path / "can.stl").write_bytes(binary_stl(prism(60, 22.5, 60.0)))
    old = 'shape = "cylinder"\ndiameter_mm = 45\nheight_mm = 60\n'
    job = project(tmp_path, LIFT.format(offset), old, 'shape = "mesh"\nfile = "can.stl"\n')
    assert [code for code, _ in checked(job)] == codes
    (line,) = (entry for entry in Session(job).run().report["statements"] if entry["line"] == 3)
    assert ("holds 'can_1'" in line["notes"]) == (not codes)


def test_a_can_that_is_pulled_harder_than_the_cup_holds_is_lost(tmp_path):
    """4.5 N lift the weight of 3.9 N, but not what the start of a fast move adds to it."""
    job = project(tmp_path, LIFT.format(""), "holding_force_n = 40", "holding_force_n = 4.5")
    report = Session(job).run().report
    assert [(item["code"], item["line"]) for item in report["alarms"]] == [("RBL536", 5)]
    (line,) = (entry for entry in report["statements"] if entry["line"] == 3)
    assert line["notes"] == ["holds 'can_1'"]
    assert Session(project(tmp_path, LIFT.format(""))).run().report["alarms"] == []
