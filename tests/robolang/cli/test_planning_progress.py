"""What a terminal shows while programs are planned."""

from robolang.cli.planning_progress import PlanningProgress, planning


class Line:
    def __init__(self):
        self.texts = []

    def update(self, text):
        self.texts.append(text)


def test_it_shows_program_and_time_but_not_every_statement(monkeypatch):
    now = [10.0]
    monkeypatch.setattr("robolang.cli.planning_progress.time.monotonic", lambda: now[0])
    line = Line()
    progress = PlanningProgress(2, line)
    progress.begin(1, "a.rbl\x1b")
    progress.planned(1_000_000)
    assert len(line.texts) == 1
    now[0] += 1.0
    progress.planned(2_500_000)
    progress.planned(2_600_000)
    assert len(line.texts) == 2
    assert "2 of 2" in line.texts[0]
    assert "2.5 s" in line.texts[1]
    assert "\x1b" not in "".join(line.texts)


def test_nothing_is_shown_where_there_is_no_terminal(capfd):
    with planning() as progress:
        progress.begin(0, "a.rbl")
        progress.planned(1)
    assert capfd.readouterr() == ("", "")
