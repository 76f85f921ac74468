"""A rehearsal ends where a loop repeats itself for ever, and goes on where it only seems to."""

from importlib import resources

from robolang.execution.dry_run import rehearse
from robolang.planning.path_coverage import explore
from robolang.project.project import load_project

A, B = "MOVEJ JOINT(0, 40, -50, 0, 60, 0)", "MOVEJ JOINT(2, 40, -50, 0, 60, 0)"
CELL = "\n[inputs.1]\nchanges = [[0, 0], [3, 1]]\n[inputs.2]\nfollows = 3\ndelay_s = 2\n"
BUILTIN = resources.files("robolang.project.builtin").joinpath("cell.toml").read_text("utf-8")
ENDLESS = {
    "moves that stop": f"*TOP\n{A}\n{B}\nGOTO *TOP",
    "moves that blend": f"*TOP\n{A}, ZONE 1\n{B}, ZONE 1\nGOTO *TOP",
    "a sub": "CALL S\nSUB S\nWHILE 1\nDELAY 1\nWEND\nENDSUB",
    "a count that nothing reads": f"N = 0\n*TOP\nN = N + 1\nPRINT N\n{A}\n{B}\nGOTO *TOP",
    "a loop inside, and an array": f"DIM X(3)\n*TOP\nFOR I = 1 TO 3\nX(I) = I\n{A}\nNEXT\nPRINT X(2)\n{B}\nGOTO *TOP",
    "an input that has come to stay": f"WAIT IN(1) = 1\n*TOP\n{A}\nIF IN(1) = 0 THEN END\n{B}\nGOTO *TOP",
    "errors that are caught": f"ON ERROR GOTO *H\n*TOP\n{A}\nMOVE HERE + (3000, 0, 0)\nGOTO *TOP\n*H RESUME NEXT",
    "outputs": f"*TOP\n{A}\nOUT(3) = 1\n{B}\nOUT(3) = 0\nGOTO *TOP",
}
NOT_SO = {
    "a count": f"N = 0\n*TOP\nN = N + 1\n{A}\n{B}\nIF N < 9 THEN GOTO *TOP",
    "a sub": f"N = 0\nWHILE N < 9\nN = N + 1\nCALL S(N)\nWEND\nSUB S(M)\n{A}\n{B}\nIF M > 9 THEN END\nENDSUB",
    "the time": f"*TOP\n{A}\n{B}\nIF TIMER < 4 THEN GOTO *TOP",
    "an input that changes": f"*TOP\n{A}\nDELAY 0.02\nIF IN(1) = 0 THEN GOTO *TOP",
    "an output": f"N = 0\n*TOP\n{A}\nOUT(3) = 1\nDELAY 0.1\nIF IN(2) = 0 THEN GOTO *TOP",
    "loads": f"N = 0\n*TOP\nLOAD (0, 0, 60), 0.1 * N\n{A}\nN = N + 1\nIF N < 5 THEN GOTO *TOP",
    "an array": f"DIM X(2)\n*TOP\nX(1) = X(1) + 1\n{A}\nIF X(1) < 8 THEN GOTO *TOP",
    "where the arm is": f"{A}\n*TOP\nMOVE HERE + (5, 0, 0)\nGOTO *TOP",
    "places": "X = 0\n*TOP\nX = X + 1\nMOVEJ JOINT(X, 40, -50, 0, 60, 0)\nIF X < 9 THEN GOTO *TOP",
}


def project(tmp_path, text):
    path = tmp_path / "p.rbl"
    path.write_text(f"{text}\n")
    path.with_suffix(".cell.toml").write_text(BUILTIN + CELL)
    found = load_project(path)
    assert found.ok, found.diagnostics
    return found


def test_a_loop_that_repeats_itself_is_planned_for_a_few_rounds(tmp_path):
    wrong = []
    for name, text in ENDLESS.items():
        found = rehearse(project(tmp_path, text))
        if [item.code for item in found.preventing] != ["RBL509"] or not 0 < found.total_us < 20_000_000:
            wrong.append((name, found.total_us, found.refused))
    assert not wrong


def test_loops_that_come_to_an_end_are_planned_to_it(tmp_path):
    wrong = []
    for name, text in NOT_SO.items():
        read = project(tmp_path, text)
        found, whole = rehearse(read), rehearse(read, every_round=True)
        if (found.refused, found.total_us) != (whole.refused, whole.total_us) or len(whole.moves) < 5:
            wrong.append((name, found.refused))
    assert not wrong


def test_every_round_is_planned_where_that_is_wanted(tmp_path):
    read = project(tmp_path, ENDLESS["a sub"])
    found = rehearse(read, every_round=True, most_us=9_000_000)
    assert (found.total_us, [item.code for item in found.refused]) == (9_000_000, ["RBL509"])


def test_the_time_that_is_planned_is_told(tmp_path):
    told = []
    found = explore(project(tmp_path, f"{A}\n{B}\nIF IN(1) = 0 THEN END\nDELAY 0.5"), told.append)
    # the branch that was forced begins anew
    assert len(found.detours) == 1
    assert told.count(0) == 2
    assert max(told) > 0
