"""What is typed while a command runs."""

import re
import sys

import pytest

from tests.console.terminal import Terminal


def command(folder, *arguments):
    return Terminal([sys.executable, "-m", "chatrobot", *arguments, "--config-dir", str(folder)])


@pytest.mark.realtime
def test_a_stop_that_is_typed_stops_the_robot_and_what_was_still_to_come(tmp_path):
    with command(tmp_path, "do", "forward 2 m", "turn left") as terminal:
        terminal.wait_for(r"0\.\d\d / 2.00 m")
        terminal.enter("turn right")
        terminal.wait_for("“turn right” was not done: while this runs, only “stop”")
        terminal.enter("stop!")
        assert terminal.wait_for_end() == 5
        assert "Stopped (you said “stop!”)" in terminal.text
        assert "these were not started: “turn left”" in terminal.text
        assert "> turn left" not in terminal.text


def test_a_yes_that_was_typed_before_the_question_is_no_answer(tmp_path):
    with command(tmp_path, "do", "forward 1 m", "--approve", "--fast") as terminal:
        terminal.enter("y")
        terminal.wait_for(r"\[y/N\]")
        terminal.enter("n")
        assert terminal.wait_for_end() == 4
        assert "Done" not in terminal.text


def test_the_end_of_file_is_a_no(tmp_path):
    with command(tmp_path, "do", "forward 1 m", "--approve", "--fast") as terminal:
        terminal.wait_for(r"\[y/N\]")
        terminal.type("\x04")
        assert terminal.wait_for_end() == 4


def test_a_last_line_without_its_newline_is_an_answer(tmp_path):
    with command(tmp_path, "do", "forward 1 m", "--approve", "--fast") as terminal:
        terminal.wait_for(r"\[y/N\]")
        terminal.type("y\x04\x04")
        assert terminal.wait_for_end() == 0


@pytest.mark.realtime
def test_a_pause_that_is_typed_keeps_the_plan_and_continue_goes_on(tmp_path):
    with command(tmp_path, "do", "forward 1.5 m", "turn left") as terminal:
        terminal.wait_for(r"0\.[3-9]\d / 1.50 m")
        terminal.enter("pause")
        terminal.wait_for(r"Paused")
        terminal.enter("continue")
        assert terminal.wait_for_end() == 0
        assert "1.50 m of 1.50 m" in terminal.text
        assert re.search(r"turned (left )?90", terminal.text), "what waits behind it is done"


def test_a_plan_that_waits_for_a_yes_can_be_paused_and_is_asked_about_anew(tmp_path):
    with command(tmp_path, "do", "forward 1 m", "--approve", "--fast") as terminal:
        terminal.wait_for(r"\[y/N\]")
        terminal.enter("pause")
        terminal.wait_for(r"Paused")
        terminal.enter("continue")
        terminal.wait_for(r"\[y/N\]", times=2)
        terminal.enter("y")
        assert terminal.wait_for_end() == 0
        assert "1.00 m of 1.00 m" in terminal.text


@pytest.mark.parametrize("typed", ["stop\r", "\x04"])
def test_a_stop_and_the_end_of_file_drop_what_is_paused(tmp_path, typed):
    with command(tmp_path, "do", "forward 1 m", "turn left", "--approve", "--fast") as terminal:
        terminal.wait_for(r"\[y/N\]")
        terminal.enter("pause")
        terminal.wait_for(r"Paused")
        terminal.type(typed)
        assert terminal.wait_for_end() == 5
        assert "Done" not in terminal.text
