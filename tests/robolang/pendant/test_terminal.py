"""What somebody sees and does at the prompt, through a pseudo-terminal and a model of its screen."""

import re
import shutil
import signal
from pathlib import Path

import pytest

from tests.robolang.pendant.terminal import Terminal

PROGRAMS = Path(__file__).parents[3] / "programs"
NAME = "pick_and_place"
READY = "limit J"
LONG = "DELAY 3600"
COLOURS = re.compile(rb"\x1b\[[0-9;]*(?:3[0-7]|9[0-7])[0-9;]*m")


@pytest.fixture
def folder(tmp_path):
    for ending in (".rbl", ".points.toml", ".cell.toml"):
        shutil.copy(PROGRAMS / f"{NAME}{ending}", tmp_path)
    return tmp_path


@pytest.fixture
def opened(folder):
    """Open a terminal; it is closed when the test is over."""
    terminals = []

    def open_one(*arguments, program=f"{NAME}.rbl", **how):
        terminals.append(Terminal(folder, *([program] if program else []), *arguments, **how))
        return terminals[-1]

    yield open_one
    for terminal in terminals:
        terminal.close()


@pytest.fixture
def terminal(opened):
    found = opened()
    found.until(READY)
    return found


def test_the_prompt_is_there_before_the_controller_and_becomes_ready(opened):
    terminal = opened(fresh=True)
    terminal.until("help lists the commands", READY)
    assert terminal.shows("MANUAL  not armed  frame WORLD", f"{NAME}.rbl")
    assert 0 <= terminal.raw.find(b"starting") < terminal.raw.find(READY.encode())


@pytest.mark.parametrize(
    ("columns", "rows", "kept"), [(150, 40, "comment"), (80, 24, "used in lines"), (60, 20, "configuration")]
)
def test_facts_errors_tables_and_the_panel_fit_screens_of_any_width(opened, columns, rows, kept):
    terminal = opened(columns=columns, rows=rows)
    lines = terminal.until(READY)
    for fact in ("MANUAL", "not armed", "frame WORLD", "tool hand", "load 0", "0.000 s", "77.0", "840.0", "overhead"):
        assert terminal.shows(fact), lines
    terminal.send("MOV P4\r")
    terminal.until("error RBL112", "1 | MOV P4", "    | ^^^", "MOVEJ P4")
    terminal.enter("points", "P1", "P5")
    found = [at for at, line in enumerate(terminal.lines) if re.match(r"P\d ", line)]
    assert found == list(range(found[0], found[0] + 5))  # one line a point
    assert terminal.shows(kept)
    terminal.send("jog\r")
    terminal.until(
        "KEYS", "NOT ARMED", "J1 by 5 deg", "frame world", "speed 25 %", "limit J5", "0.000 s", "q Enter leave"
    )
    terminal.send("ez+t")
    terminal.until("Z by 50 mm", "frame tool")
    assert sum("KEYS" in line for line in terminal.lines) == 1


def test_completion_shows_points_with_their_meaning_and_enter_carries_out(terminal):
    terminal.send("MOVE ")
    terminal.until("P1", "480 -220 640 mm", "P5", "POSE(")
    terminal.send("P4, ")
    terminal.until("SPEED", "speed of the tool point, mm/s")
    terminal.send("sp")
    terminal.until_gone("ACCEL")
    terminal.send("\t 250\r")
    terminal.until("> MOVE P4, SPEED 250", "XYZ 480.0 220.0 840.0")
    assert terminal.shows("XYZ 480.0 220.0 840.0")


def test_ctrl_c_clears_the_line_and_keeps_the_prompt(terminal):
    terminal.send("MOVE P")
    terminal.until("> MOVE P")
    terminal.send("\x03")
    terminal.send("\x03")
    terminal.send("1 + 41\r")
    terminal.until("42")
    assert terminal.process.poll() is None


def test_a_block_is_typed_over_several_lines(terminal):
    terminal.send("IF 1 = 1 THEN\r")
    terminal.send("x = 7")
    terminal.until(".   x = 7")
    terminal.send("\r")
    terminal.send("x = 8")
    terminal.until(".   x = 8")
    terminal.send("\x03")
    terminal.send("1 + 41\r")
    terminal.until("42")
    assert terminal.shows("42")


def test_a_paste_is_carried_out_line_by_line_up_to_the_first_error(terminal):
    terminal.send("\x1b[200~x = 41\nx + 1\nMOV P1\nx + 2\x1b[201~")
    terminal.until(". x + 2")
    terminal.send("\r")
    lines = terminal.until("error RBL112", "42")
    assert not any(line.strip() == "43" for line in lines)


def test_help_at_the_word_keeps_what_is_typed(terminal):
    terminal.send("MOVEJ P1")
    terminal.until("> MOVEJ P1")
    terminal.send("\x1bOP")
    terminal.until("taught point", "> MOVEJ P1")
    terminal.send("\x15DELAY?\r")
    terminal.until("lets time pass")


def test_space_escape_and_ctrl_c_stop_what_runs_and_keep_the_prompt(terminal):
    for at, key in enumerate((" ", "\x1b", "\x03")):
        terminal.send(f"DELAY {3600 + at}\r")
        terminal.until(f"prompt  DELAY {3600 + at}")
        start = len(terminal.raw)
        terminal.send(key)
        terminal.until_new(start, "stopped", READY)
        terminal.enter(f"100 + {at}", f"10{at}")


def test_an_arrow_is_not_escape(terminal):
    terminal.send(f"{LONG}\r")
    terminal.until(f"prompt  {LONG}")
    terminal.send("\x1b[D\x1bOC\x1b[1;5Aabc")
    terminal.send("\x03")
    terminal.until("stopped")
    assert sum("stopped" in line for line in terminal.lines) == 1


def test_a_second_ctrl_c_halts_and_the_alarm_stays_until_reset(opened):
    terminal = opened("--realtime")
    terminal.until(READY)
    terminal.send("auto\r")
    terminal.until("AUTO  not armed")
    terminal.send("MOVEJ P3, SPEED 100\r")
    terminal.until("prompt  MOVEJ P3")
    terminal.send("\x03")
    terminal.until("stopping")
    terminal.send("\x03")
    terminal.until("ALARM RBL")
    terminal.send("reset\r")
    terminal.until("acknowledged")
    terminal.until_gone("ALARM RBL")


def test_the_end_of_the_terminal_stops_and_keeps_what_is_unsaved(folder, terminal):
    terminal.send("110\r")
    terminal.until("(unsaved)")
    terminal.send(f"{LONG}\r")
    terminal.until(f"prompt  {LONG}")
    terminal.process.send_signal(signal.SIGHUP)
    assert terminal.ended() == 128 + signal.SIGHUP
    assert list(folder.glob("*.recover")) == [folder / f".{NAME}.rbl.recover"]


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("line", ["", "MOVE P", f"{LONG}\r"], ids=["empty", "typing", "running"])
def test_a_signal_ends_the_prompt_with_its_code(terminal, number, line):
    terminal.send(line)
    terminal.until(line.rstrip())
    terminal.process.send_signal(number)
    assert terminal.ended() == 128 + number


def test_a_closed_terminal_ends_the_prompt(terminal):
    terminal.send(f"{LONG}\r")
    terminal.until(f"prompt  {LONG}")
    terminal.hang_up()
    assert terminal.process.wait() == 128 + signal.SIGHUP


def test_ctrl_d_asks_while_something_is_unsaved(terminal):
    terminal.send("110\r")
    terminal.until("(unsaved)")
    terminal.send("\x04")
    terminal.until("leave without saving? (y/n)")
    terminal.send("n\r1 + 41\r")
    terminal.until("42")
    terminal.send("\x04")
    terminal.until("(y/n) ")
    terminal.send("y\r")
    assert terminal.ended() == 0


def test_the_history_is_there_in_the_next_prompt(opened):
    first = opened()
    first.send("1 + 41\r")
    first.until("42")
    first.send("\x04")
    assert first.ended() == 0
    second = opened()
    second.until(READY)
    second.send("\x1b[A")
    second.until("> 1 + 41")


def test_an_error_of_the_start_is_shown(folder, opened):
    (folder / f"{NAME}.cell.toml").write_text("schema = 1\nrobot = 3\n")
    terminal = opened()
    terminal.until("error RBL6", "no controller")
    terminal.send("help quit\r")
    terminal.until("Leave the prompt")


def test_without_colours_everything_is_a_word(opened):
    terminal = opened(NO_COLOR="1")
    terminal.until(READY)
    terminal.send("MOV P4\r")
    terminal.until("error RBL112", "help: write MOVEJ ")
    assert not COLOURS.search(terminal.raw)


def test_colours_are_there(terminal):
    terminal.send("MOV P4\r")
    terminal.until("error RBL112")
    assert COLOURS.search(terminal.raw)


def test_a_terminal_that_only_shows_lines_gets_lines(opened):
    terminal = opened(TERM="dumb")
    terminal.until(">")
    terminal.send("1 + 41\n")
    terminal.until("42")
    terminal.send("110\n")
    terminal.send("quit\n")
    terminal.until("leave without saving? (y/n)")
    terminal.send("y\n")
    assert terminal.ended() == 0
    assert b"\x1b" not in terminal.raw


def test_a_terminal_that_only_shows_lines_offers_what_was_left(opened):
    lost = opened(TERM="dumb")
    lost.until(">")
    lost.send("110\n")
    lost.send("1 + 41\n")
    lost.until("42")
    lost.process.send_signal(signal.SIGHUP)
    assert lost.ended() == 128 + signal.SIGHUP
    terminal = opened(TERM="dumb")
    terminal.until("take them? (y/n)")
    terminal.send("y\n")
    terminal.send("quit\n")
    terminal.until("leave without saving? (y/n)")
    terminal.send("y\n")
    assert terminal.ended() == 0


# --- keys -------------------------------------------------------------------------------------------------------------

RIGHT, LEFT = "\x1b[C", "\x1b[D"


@pytest.fixture
def keys(terminal):
    terminal.send("jog\r")
    terminal.until("KEYS", "NOT ARMED: e arms", "J1 by 5 deg", "Esc Space stop")
    return terminal


def test_keys_move_nothing_before_they_are_armed(keys):
    keys.send(RIGHT)
    keys.until("not armed: nothing moves", "840.00")
    keys.send("ez")
    keys.until("ARMED   Z by 10 mm")
    keys.send(LEFT)
    keys.until("830.00")
    keys.send("q")
    keys.until("MANUAL  not armed", "830.0")


def test_a_held_key_goes_on_until_it_is_released(keys):
    keys.send("ez")
    keys.until("Z by 10 mm")
    for _ in range(1000):
        keys.send(LEFT)
        keys.read()
        if keys.shows("going on"):
            break
    keys.until_gone("going on")
    keys.send("q")
    keys.until("MANUAL  not armed")


@pytest.mark.parametrize("key", [" ", "\x1b"], ids=["space", "escape"])
def test_a_key_stops_a_jog(keys, key):
    keys.send("ez++")
    keys.until("Z by 100 mm")
    keys.send(LEFT)
    keys.until_gone("840.0")
    keys.send(key)
    keys.send("q")
    keys.until("MANUAL  not armed")
    assert not keys.shows("740.0")


def test_q_enter_and_ctrl_c_leave_the_keys(keys):
    for at, key in enumerate(("q", "\r", "\x03")):
        keys.until("KEYS")
        keys.send(key)
        keys.until_gone("KEYS")
        keys.until("MANUAL  not armed")
        keys.enter(f"100 + {at}", f"10{at}")
        keys.send("jog\r")


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("moving", [False, True], ids=["standing", "moving"])
def test_a_signal_ends_the_keys_and_the_prompt(keys, number, moving):
    keys.send("ez++")
    keys.until("Z by 100 mm")
    if moving:
        keys.send(LEFT)
        keys.until_gone("840.0")
    keys.process.send_signal(number)
    assert keys.ended() == 128 + number


def test_a_jog_beyond_a_limit_says_which(keys):
    keys.send("e5+++")
    keys.until("J5 by 45 deg")
    keys.send(LEFT)
    keys.until("RBL411")
