"""Sixty faults, each a small edit of a program that is good: every one is found, at its line, and the good have none.

What a text shows is found by checking it, what the motion shows by its rehearsal; nothing is run.
"""

from pathlib import Path

import pytest

from robolang.execution.dry_run import rehearse
from robolang.planning.motion_findings import findings
from robolang.project.project import load_project

pytestmark = pytest.mark.physics

ROOT = Path(__file__).parents[2] / "programs"
PALLET, TEND, DISPENSE, RECOVER, INSPECT, SORT, PICK = (
    "shop/palletise",
    "shop/tend",
    "shop/dispense",
    "shop/recover",
    "shop/inspect",
    "shop/sort",
    "pick_and_place",
)

DEFECTS = [
    # text
    (PALLET, "HAND OFF\nSPEED 250", "HAND OF\nSPEED 250", "RBL111"),
    (PALLET, "SPEED 250", "SPED 250", "RBL112"),
    (PALLET, "LOAD empty\nHAND OFF\nSPEED", "LOAD (0, 0, 60) 0.8\nHAND OFF\nSPEED", "RBL111"),
    (TEND, "OUT(1) = 1", "OUT(1 = 1", "RBL111"),
    (TEND, "30  SPEED 300", "30  SPEED 3OO", "RBL115"),
    (TEND, "60  APPROACH FEED, 100", "60  APPROACH FEED 100", "RBL111"),
    (TEND, "70  MOVE FEED", "60  MOVE FEED", "RBL113"),
    (DISPENSE, "MOVEC START + (R - R", "MOVEC START + R - R", "RBL111"),
    (INSPECT, 'PRINT TOTAL; "', "PRINT TOTAL; ", "RBL111"),
    (SORT, "90      CASE 1", "90      CASES 1", "RBL112"),
    (PICK, "10  LOAD (0, 0, 60), 0.8 ", "10  LOAD (0, 0, 60), 0.8kg ", "RBL115"),
    (PICK, "30  MOVE P1", "30  MOVE Р1", "RBL103"),
    # names
    (PALLET, "MOVE PICK, SPEED 100", "MOVE PICKK, SPEED 100", "RBL301"),
    (PALLET, "CALL FETCH(n)", "CALL FETSH(n)", "RBL213"),
    (PALLET, "CALL FETCH(n)", "CALL FETCH(n, 1)", "RBL214"),
    (PALLET, "FRAME pallet", "FRAME palette", "RBL305"),
    (PALLET, "LOAD part", "LOAD parts", "RBL305"),
    (PALLET, "place * PITCH", "palce * PITCH", "RBL215"),
    (TEND, "IN(2) = 1", "IN(7) = 1", "RBL534"),
    (TEND, "GOTO *NOT_DONE", "GOTO *NOT_DON", "RBL202"),
    (TEND, "40  MOVEJ WAITING", "40  MOVEJ WAITNG", "RBL301"),
    (DISPENSE, "TOOL nozzle", "TOOL nozle", "RBL305"),
    (INSPECT, "DONE(VIEWS) = DONE(VIEWS) + 1", "DONE(VIEWS) = DUNE(VIEWS) + 1", "RBL215"),
    (INSPECT, "GOSUB *LOOK\nMOVEJ B", "GOSUB *LOOKS\nMOVEJ B", "RBL202"),
    (SORT, "190   HAND ON", "190   LOAD part\n195   LOAD prat", "RBL305"),
    (PICK, "60  MOVE P2", "60  MOVE P22", "RBL301"),
    # kinds and values
    (PALLET, "CONST PITCH = 100", "CONST PITCH = 100\nPITCH = 90", "RBL216"),
    (PALLET, "PARTS = 2\n", 'PARTS = "2"\n', "RBL217"),
    (PALLET, "MOVE PICK, SPEED 100", "MOVE PICK, SPEED 0", "RBL404"),
    (PALLET, "APPROACH PICK, ABOVE, ZONE 30", "APPROACH PICK, ABOVE, ZONE -30", "RBL415"),
    (TEND, "20  HAND OFF", "20  HAND OFF, -1", "RBL405"),
    (TEND, "PULSE 2, 0.2", "PULSE 2000, 0.2", "RBL534"),
    (TEND, "SPEED 50", "SPEED 500", "RBL404"),
    (DISPENSE, "DELAY 0.1", "DELAY -0.1", "RBL405"),
    (DISPENSE, "LOAD (0, 0, 90), 0.8", "LOAD (0, 0, 90), 80", "RBL402"),
    (DISPENSE, "LOAD (0, 0, 90), 0.8", "LOAD (0, 90), 0.8", "RBL220"),
    (DISPENSE, "SPEED BEAD\n", "SPEED BEAD, 5\n", "RBL111"),
    (INSPECT, "30 * COS(ANGLE), 30", "30 * COS(ANGLE, 1), 30", "RBL214"),
    (INSPECT, "DIST(C, HOME)", "DIST(C)", "RBL214"),
    (INSPECT, "CENTRE = HERE", "CENTRE = HERE.Q", "RBL218"),
    (SORT, "30  OVERRIDE 80", "30  OVERRIDE 180", "RBL404"),
    (SORT, "100 / COUNT", "100 / COUNT", None),
    (RECOVER, "100 / COUNT", "100 / 0", "RBL209"),
    (PICK, "50  LOAD (0, 0, 95), 2.3", "50  LOAD (0, 0, 95), -2.3", "RBL401"),
    (PICK, "50  LOAD (0, 0, 95), 2.3", "50  LOAD (0, 0, 9500), 2.3", "RBL403"),
    # structure
    (PALLET, "NEXT n", "NEXT m", "RBL212"),
    (PALLET, "ENDSUB\n\nSUB PUT", "\nSUB PUT", "RBL219"),
    (PALLET, "FOR n = 0 TO PARTS - 1", "FOR n = 0 TO PARTS - 1 STEP 0", "RBL205"),
    (INSPECT, "WEND", "WENT", "RBL112"),
    (INSPECT, "WHILE ANGLE < 360", "IF ANGLE < 360 THEN", "RBL211"),
    (SORT, "160   ENDSELECT", "160   REM", "RBL211"),
    (SORT, "150       GOTO 300", "150       GOTO 310", None),
    (TEND, "240 END", "240 END\n245 MOVE WAITING", "RBL221"),
    (RECOVER, "*TROUBLE\nFAULTS", "*TROUBL\nFAULTS", "RBL202"),
    # order and use
    (PICK, "50  LOAD (0, 0, 95), 2.3", "50  REM", "RBL228"),
    (PALLET, "  HAND ON\n  LOAD part\n", "  HAND ON\n", "RBL228"),
    (PALLET, "  HAND OFF\n  LOAD empty\n", "  HAND OFF\n", "RBL228"),
    (SORT, "200   LOAD part", "200   REM", "RBL228"),
    (TEND, "90  LOAD part\n100 DEPART 100, ZONE 20", "90  DEPART 100\n100 LOAD part", "RBL228"),
    (PALLET, "MOVE PICK, SPEED 100\n  HAND ON\n  LOAD part", "HAND ON\n  LOAD part\n  MOVE PICK", "RBL413"),
    (TEND, "110 APPROACH CHUCK, 100, ZONE 20", "105 LOAD part\n110 APPROACH CHUCK, 100, ZONE 20", "RBL229"),
    (TEND, "70  MOVE FEED, SPEED 100", "70  MOVE FEED, SPEED 100, ZONE 5", "RBL413"),
    (TEND, "140 WAIT IN(2) = 1, TIMEOUT 10, GOTO *NOT_DONE", "140 WAIT IN(2) = 1", "RBL223"),
    (RECOVER, "COUNT = 0\nSPEED 300", "COUNT = 0\nCOUNTS = 1\nSPEED 300", "RBL225"),
    (INSPECT, "TOTAL = TOTAL + DONE(i)", "TOTL = TOTAL + DONE(i)", "RBL225"),
    (PALLET, "HAND OFF\nSPEED 250\n", "HAND OFF\n", "RBL226"),
    (INSPECT, "SPEEDJ 80\nVIEWS = 0\n\nMOVEJ A", "VIEWS = 0\nMOVEJ A, SPEED 80", "RBL226"),
    (
        DISPENSE,
        "TOOL nozzle\nSPEED BEAD\nZONE 2\n\nAPPROACH START + (R, 0, 0), 60, SPEED 250, FINE\n",
        "SPEED BEAD\nZONE 2\nAPPROACH START + (R, 0, 0), 60, SPEED 250, FINE\nTOOL nozzle\n",
        "RBL227",
    ),
    (PALLET, "  CALL PUT(INT(n / ROWS), n MOD ROWS)", "  REM", "RBL222"),
    (TEND, "10  LOAD empty", "10  REM", "RBL228"),
    (INSPECT, "MOVEJ A\n", "MOVEJ A, ZONE 60\n", "RBL413"),
    (RECOVER, "CASE 503", 'CASE "503"', "RBL217"),
    (PALLET, "PARTS = 2\n", "PARTS = 2\nCONST PITCH = 90\n", "RBL216"),
    # motion
    (PALLET, "PICK = FEED + (place * PITCH, 0, 0)", "PICK = FEED + (place * PITCH, 0, -60)", "RBL421"),
    (TEND, "120 MOVE CHUCK", "120 MOVE CHUCK + (900, 0, 0)", "RBL410"),
    (DISPENSE, "MOVE START + (R, LONG, 0)", "MOVE START + (R, LONG, -190)", "RBL421"),
    (PICK, "100 MOVE P4", "100 MOVE P4 + (0, 0, 600)", "RBL410"),
    (SORT, "100       TARGET = LEFT", "100       TARGET = LEFT + (0, 0, -80)", "RBL421"),
    (INSPECT, "MOVEJ HOME", "MOVEJ JOINT(0, 300, 0, 0, 0, 0)", "RBL309"),
    (PICK, "110 MOVE P5", "110 MOVE P5 * (0, 0, 0, 0, 180, 0)", None),
    (DISPENSE, "START + (WIDE - R + R * SIN(45), R - R * COS(45), 0)", "START + (WIDE - R, 0, 0)", "RBL416"),
    (TEND, "WAIT IN(1) = 1, TIMEOUT 5, GOTO *NOT_READY", "WAIT IN(4) = 1", "RBL509"),
    (INSPECT, "  ANGLE = ANGLE + 90\n", "", "RBL509"),
]
ELSEWHERE = {"RBL202", "RBL211", "RBL222", "RBL226", "RBL228", "RBL410", "RBL413", "RBL421", "RBL509"}
"""Named where it shows, not where it was written."""
DEFECTS = [row for row in DEFECTS if row[3] is not None]


def everything(path):
    """Return what checking and rehearsing a program finds, ``(code, line)``."""
    project = load_project(path)
    found = project.diagnostics
    if project.ok:
        found = (*found, *findings(project, rehearse(project)))
    return [(item.code, project.source.place(item.span.start).line) for item in found]


def copied(tmp_path, name):
    source = ROOT / f"{name}.rbl"
    cell = source.with_suffix(".cell.toml")
    (tmp_path / "job.cell.toml").write_text(
        (cell if cell.exists() else source.with_name("cell.toml")).read_text("utf-8"), "utf-8"
    )
    (tmp_path / "job.points.toml").write_text(source.with_suffix(".points.toml").read_text("utf-8"), "utf-8")
    return source.read_text("utf-8"), tmp_path / "job.rbl"


def test_there_are_sixty_of_them():
    assert len(DEFECTS) >= 60
    assert len({row[3] for row in DEFECTS}) > 25


@pytest.mark.parametrize("name", [PALLET, TEND, DISPENSE, RECOVER, INSPECT, SORT, PICK])
def test_the_good_programs_have_none(name):
    assert everything(ROOT / f"{name}.rbl") == []


@pytest.mark.parametrize(("name", "old", "new", "code"), DEFECTS, ids=lambda value: str(value)[:24].replace("\n", "/"))
def test_a_defect_is_found_at_its_line(tmp_path, monkeypatch, name, old, new, code):
    monkeypatch.setattr("robolang.execution.run_bounds.MAX_RUN_US", 20_000_000)  # two of them never end
    text, path = copied(tmp_path, name)
    assert old in text
    path.write_text(text.replace(old, new, 1), "utf-8")
    first = text[: text.index(old)].count("\n") + 1
    lines = range(first, first + max(old.count("\n"), new.count("\n")) + 1)
    found = everything(path)
    if code in ELSEWHERE:
        assert code in [each for each, _ in found], found
    else:
        assert code in [each for each, line in found if line in lines], found
    assert len(found) <= 6
