"""The console in a real terminal. Nothing here sleeps: every step waits for what it is about to see."""

import signal
import sys

import psutil
import pytest
from rich.cells import cell_len

from tests.console.terminal import Terminal, console

pytestmark = pytest.mark.realtime

STANDING, MOVING = "standing · ", "moving  "
EDITING = (
    r"(?s)Edit it\..*plan› drive 0.3 m"  # while the hint is printed above the prompt, nobody hears a key
)
PLAN, DONE, STOPPED = "plan  ", "✓", "■"


def opened(folder, *options):
    with console(folder, *options) as terminal:
        terminal.wait_for(STANDING)
        yield terminal
        assert "Traceback" not in terminal.text
        assert "Unhandled" not in terminal.text


@pytest.fixture
def chat(tmp_path):
    """A console of its own, for a test that ends it."""
    yield from opened(tmp_path)


@pytest.fixture(scope="module")
def at_home(tmp_path_factory):
    """A console as a newcomer gets it, which several tests talk to."""
    yield from opened(tmp_path_factory.mktemp("home"))


@pytest.fixture(scope="module")
def console_in_the_open(tmp_path_factory):
    yield from opened(tmp_path_factory.mktemp("open"), "--world", "empty")


@pytest.fixture
def kept(console_in_the_open):
    """A console that other tests have talked to; its screen is empty, and its robot stands somewhere in the open."""
    console_in_the_open.wait_for(f"{STANDING}|停着")
    console_in_the_open.forget()
    return console_in_the_open


def test_a_newcomer_is_greeted_with_robot_world_and_three_things_to_say(at_home):
    text = " ".join(at_home.text.split())
    assert "Wheeltec mini mecanum (simulated) in world 'home'" in text
    for example in ("drive a 1 m square", "go to the kitchen", "向前走半米，然后左转", "/help"):
        assert example in text


def test_an_unknown_command_gets_the_nearest_one(at_home):
    at_home.enter("/hlep")
    at_home.wait_for("There is no /hlep; did you mean /help?")
    at_home.enter("/qqqqqqq")
    at_home.wait_for("There is no /qqqqqqq. /help lists the commands.")


def test_the_commands_show_robot_world_and_plan(at_home, tmp_path):
    at_home.enter("/plan")
    at_home.wait_for("There is no plan yet")
    at_home.enter("/robot")
    at_home.wait_for("highest speed +1 m/s")
    at_home.enter("/world")
    at_home.wait_for("•kitchen")
    at_home.enter("turn left 20 degrees")
    at_home.wait_for(DONE)
    at_home.enter(f"/save-plan {tmp_path / 'mine.plan'}")
    at_home.wait_for("The plan is saved in")
    assert (tmp_path / "mine.plan").read_text() == "turn left 20 deg\n"
    at_home.enter(f"/run-plan {tmp_path / 'mine.plan'}")
    at_home.wait_for(r"now at .* (39|4[01])°")
    at_home.enter("/run-plan")
    at_home.wait_for(r"Which plan\? /run-plan FILE")


def test_tab_completes_commands_and_places(at_home):
    at_home.type("/rel")
    at_home.wait_for("/release  release the emergency stop")
    at_home.type("\t")
    at_home.wait_for("› /release")
    at_home.type("\r")
    at_home.wait_for("No emergency stop was set")
    at_home.type("go to the kitc\t")
    at_home.wait_for("› go to the kitchen")


def test_a_motion_shows_its_plan_then_the_strip_then_what_was_measured(kept):
    kept.enter("forward 0.4 m")
    kept.wait_for(r"plan  0\.40 m, \d\.\d s\s+1  drive 0\.4 m")
    kept.wait_for(MOVING)
    assert any("%" in line and "─" in line for line in kept.shown)
    kept.wait_for(r"→[⠀-⣿]")  # the robot on its way
    kept.wait_for(r"✓ .*\s+now at \(-?\d\.\d\d, -?\d\.\d\d\) -?\d+°, after \d\.\d s")
    kept.wait_for(STANDING)


def test_a_stop_that_is_typed_while_the_history_is_searched_stops_the_motion(kept):
    kept.enter("turn left 300 degrees")
    kept.wait_for(MOVING)
    kept.control("r")
    kept.wait_for("reverse-i-search")
    kept.enter("stop")
    kept.wait_for(STOPPED)
    kept.control("r")
    kept.type("left 300")
    kept.wait_for("`left 300': turn left 300 degrees")
    kept.type("\r")
    kept.wait_for("› turn left 300 degrees", times=2)
    kept.control("r")
    kept.wait_for("reverse-i-search")
    kept.control("c")
    kept.wait_for("The robot stops.")
    kept.enter("where are you?")
    kept.wait_for("• I am ")


def test_a_stop_word_stops_the_motion_it_is_typed_into(kept):
    kept.enter("forward 2 m")
    kept.wait_for(MOVING)
    kept.enter("stop!")
    kept.wait_for(STOPPED)
    kept.wait_for(STANDING)
    assert DONE not in kept.text


def test_new_motion_replaces_the_old(kept):
    kept.enter("forward 2 m")
    kept.wait_for(MOVING)
    kept.enter("turn left 20 degrees")
    kept.wait_for(STOPPED)
    kept.wait_for(DONE)


def test_ctrl_c_stops_the_robot_and_says_so(kept):
    kept.enter("forward 2 m")
    kept.wait_for(MOVING)
    kept.control("c")
    kept.wait_for("The robot stops. Ctrl-C again leaves.")
    kept.wait_for(STOPPED)
    kept.enter("turn left 20 degrees")
    kept.wait_for(DONE)


def test_after_an_emergency_stop_nothing_moves_until_it_is_released(kept):
    kept.enter("/estop")
    kept.wait_for("EMERGENCY STOP: /release lets it move again")
    kept.enter("turn left 20 degrees")
    kept.wait_for("✗")
    kept.enter("/release")
    kept.wait_for("The emergency stop is released")
    kept.enter("turn left 20 degrees")
    kept.wait_for(DONE)


def test_a_paste_of_a_hundred_kilobytes_and_weird_bytes_do_no_harm(kept):
    kept.type(b"\x1b[200~" + b"forward 1 m, " * 8000 + b"\x1b[201~")
    kept.wait_for("forward 1 m, forward")
    kept.type("\r")
    kept.wait_for("too long", timeout_s=60)
    kept.type(b"\xff\xfe\x00\xc3\x28 \xed\xa0\x80 \x07 \xf0\x9f\r")
    kept.wait_for(r"\?")
    kept.enter("turn left 20 degrees")
    kept.wait_for(DONE)


def test_a_paste_is_done_line_by_line_and_its_stop_does_not_wait_for_enter(kept):
    kept.type(b"\x1b[200~rotate left 10 degrees\rspin right 20 degrees\r\x1b[201~")
    kept.wait_for("› rotate left 10 degrees\n  spin right 20 degrees")
    assert DONE not in kept.text
    kept.type("\r")
    kept.wait_for(DONE, times=2)
    kept.enter("forward 2 m")
    kept.wait_for(MOVING)
    kept.type(b"\x1b[200~turn left\nstop\n\x1b[201~")
    kept.wait_for(STOPPED)
    kept.enter("")


def test_lines_that_a_terminal_pastes_as_keys_do_not_replace_each_other(kept):
    kept.type("rotate left 10 degrees\rspin right 20 degrees\r")
    kept.wait_for(DONE, times=2)
    kept.type("forward 2 m\rstop\rturn left 10 degrees\r")
    kept.wait_for("this is not done: “forward 2 m”")
    kept.wait_for(DONE, times=3)
    assert "2.00 m," not in kept.text


def test_a_window_can_be_made_smaller_and_larger_while_the_robot_moves(kept):
    kept.enter("forward 1 m")
    kept.wait_for(MOVING)
    for rows, columns in ((12, 44), (30, 120)):
        kept.resize(rows, columns)
        kept.wait_for(MOVING)
    kept.wait_for(DONE)


def test_who_speaks_chinese_is_answered_in_chinese(kept):
    kept.enter("前进0.4米")
    kept.wait_for(r"计划  0\.40 米")
    kept.wait_for("行驶中")
    kept.wait_for(r"现在在 \(-?\d\.\d\d, ")
    kept.enter("/mapp")
    kept.wait_for("您是不是想用 /map")


def test_ctrl_c_twice_leaves(chat):
    chat.control("c")
    chat.wait_for("Ctrl-C again leaves")
    chat.control("c")
    assert chat.wait_for_end() == 0
    assert "Bye." in chat.text


def test_a_goodbye_in_words_is_answered_once(chat):
    chat.enter("bye")
    assert chat.wait_for_end() == 0
    assert "Goodbye." in chat.text
    assert "Bye." not in chat.text


def test_ctrl_d_lets_the_robot_finish_first_and_the_next_console_remembers_what_was_said(chat, tmp_path):
    chat.enter("forward 0.4 m")
    chat.wait_for(MOVING)
    chat.control("d")
    chat.wait_for("finishes what it was told")
    assert chat.wait_for_end() == 0
    assert DONE in chat.text
    with console(tmp_path) as second:
        second.wait_for(STANDING)
        second.type("\x1b[A")
        second.wait_for("› forward 0.4 m")


def test_the_end_of_motion_is_told_and_ends_the_talk(chat):
    chat.enter("forward 2 m")
    chat.wait_for(MOVING)
    children = psutil.Process(chat.child.pid).children()
    motion = next(child for child in children if "chatrobot.motion.process" in child.cmdline())
    motion.kill()
    assert chat.wait_for_end() == 1
    assert "Motion is gone" in chat.text


def test_when_the_terminal_is_closed_the_robot_stops_and_everything_ends(chat):
    chat.enter("forward 2 m")
    chat.wait_for(MOVING)
    processes = psutil.Process(chat.child.pid).children(recursive=True)
    chat.child.kill(signal.SIGHUP)
    assert chat.wait_for_end() == 129
    _, alive = psutil.wait_procs(processes, timeout=10.0)
    assert not alive


def test_a_plan_can_be_approved_refused_and_edited(tmp_path):
    with console(tmp_path, "--approve") as chat:
        chat.wait_for(STANDING)
        chat.enter("forward 0.4 m")
        chat.wait_for("Do it?")
        assert "→" in chat.text
        chat.enter("n")
        chat.wait_for("✗")
        chat.enter("forward 0.3 m")
        chat.wait_for("Do it?", times=2)
        chat.enter("e")
        chat.wait_for(EDITING)
        chat.type("\x15turn left 20 deg\x1b\r")
        chat.wait_for("Do it?", times=3)
        chat.enter("y")
        chat.wait_for(r"✓ .*\s+now at \(0\.00, -?0\.00\) (19|20|21)°")
        chat.forget()  # a plan edited wrongly is asked about as it was
        chat.enter("forward 0.3 m")
        chat.wait_for("Do it?")
        chat.enter("e")
        chat.wait_for(EDITING)
        chat.type("\x15fly 3 m\x1b\r")
        chat.wait_for(r"version before it stays: .*fly")
        chat.wait_for("Do it?", times=2)
        chat.enter("e")
        chat.wait_for("plan› fly 3 m")
        chat.type("\x15drive 0.2 m\x1b\r")
        chat.wait_for("Do it?", times=3)
        chat.enter("y")
        chat.wait_for(r"drove 0\.(19|20|21) m of 0\.20 m")


def test_ctrl_z_stops_the_robot_and_really_suspends(tmp_path):
    environment = {"PS1": "$ ", "HISTFILE": ""}
    with Terminal(["bash", "--norc", "--noprofile", "-i"], environment=environment) as shell:
        shell.wait_for(r"\$ ?")
        shell.enter(f"{sys.executable} -m chatrobot --config-dir {tmp_path}")
        shell.wait_for(STANDING)
        shell.enter("forward 2 m")
        shell.wait_for(MOVING)
        shell.control("z")
        shell.wait_for(r"\[1\]\+  Stopped")
        suspended = [
            child for child in psutil.Process(shell.child.pid).children() if child.status() == "stopped"
        ]
        assert len(suspended) == 1
        shell.enter("fg")
        shell.wait_for("The robot was stopped before ChatRobot was suspended.")
        shell.wait_for(STOPPED)
        shell.wait_for(STANDING)
        shell.enter("turn left 20 degrees")
        shell.wait_for(DONE)


def test_a_dumb_terminal_gets_plain_lines_and_does_a_paste_line_by_line(tmp_path):
    with console(tmp_path, environment={"TERM": "dumb"}) as chat:
        chat.wait_for("/help")
        chat.enter("forward 0.4 m")
        chat.wait_for(r"✓ .*\s+now at \(0\.[34]\d, ")
        chat.type("rotate left 10 degrees\nspin right 20 degrees\n")
        chat.wait_for(DONE, times=3)
        chat.type("forward 2 m\nstop\nturn left 10 degrees\n")
        chat.wait_for("this is not done: “forward 2 m”")
        chat.wait_for(DONE, times=4)
        chat.enter("forward 2 m")
        chat.wait_for(r"2\.00 m, \d\.\d s\s+1  drive 2 m")
        chat.control("c")
        chat.wait_for(STOPPED, times=2)
        chat.control("c")
        assert chat.wait_for_end() == 0
        assert b"\x1b" not in chat.raw


def test_a_narrow_terminal_gets_plain_lines(tmp_path):
    with console(tmp_path, columns=30) as chat:
        chat.wait_for("/help")
        greeting = chat.raw.decode().split("starting")[1].splitlines()[1:]
        assert max(map(cell_len, greeting)) <= 30, "no line is left for the terminal to break within a word"
        chat.type(b"\xff\xfe weird\n")
        chat.wait_for(r"\?")
        chat.type("\x04")
        assert chat.wait_for_end() == 0


def test_who_wants_no_colour_gets_plain_lines(tmp_path):
    with console(tmp_path, environment={"NO_COLOR": "1"}) as chat:
        chat.wait_for("/help")
        chat.enter("forward 0.2 m")
        chat.wait_for(DONE)
        chat.type("\x04")
        assert chat.wait_for_end() == 0
        assert b"\x1b" not in chat.raw


def test_fast_is_refused_because_a_talk_is_in_real_time():
    from chatrobot.cli.console.app import run_console
    from chatrobot.cli.lines import TypedAhead
    from chatrobot.compose import Setup, connect
    from chatrobot.core.errors import UsageError

    with pytest.raises(UsageError, match="real time"):
        run_console(Setup(fast=True), TypedAhead(), connect)


@pytest.mark.parametrize("terminal", ["xterm-256color", "dumb"])
def test_an_edited_program_is_shown_and_asked_about_again(tmp_path, terminal):
    with console(tmp_path, environment={"TERM": terminal}) as chat:
        chat.wait_for("›|>")
        chat.enter("Generate a ROS 2 Python program to drive forward 0.4 m")
        chat.wait_for("Do it?")
        source = next(tmp_path.glob("programs/*/program.py")).read_text(encoding="utf-8")
        chat.enter("e")
        if terminal == "dumb":
            chat.wait_for("full stop")
            for line in [*source.replace("0.4 /", "0.2 /").splitlines(), "."]:
                chat.enter(line)
        else:
            chat.wait_for("Edit it")
            chat.type("# edited\x1b\r")  # at its end
        chat.wait_for("version 2")
        chat.wait_for("Do it?", times=2)
        assert "drove" not in chat.text
        chat.enter("n")
        chat.wait_for("✗")
