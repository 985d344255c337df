"""Several lines at once: one turn after the other, no stop is lost, nothing is done by halves."""

import pytest

from chatrobot.cli.console.pasted import LONGEST_CHARS, MOST_TEXTS
from chatrobot.core.events import Result
from tests.console.fakes import ask, do_posted, shown, told


def end_turn(controller, turn, outcome="completed"):
    controller.hear(Result(turn, outcome, outcome))


def said(log):
    return [entry[1] for entry in log if entry[0] in ("say", "say_plan")]


def said_turn(log):
    """The number that the fake session gave to what it was told last."""
    return max(number for number, entry in enumerate(log, 1) if entry[0] == "say")


def test_pasted_lines_are_turns_one_after_the_other(controller, log):
    controller.enter("forward 1 m\nwhere are you?\n\nturn left\n")
    assert said(log) == ["forward 1 m"]
    end_turn(controller, 99)
    assert said(log) == ["forward 1 m"]
    end_turn(controller, 1)
    assert said(log)[1:] == ["where are you?"]
    end_turn(controller, said_turn(log), "answered")
    assert said(log)[2:] == ["turn left"]


def test_a_heading_and_its_list_are_one_text(controller, log):
    controller.enter("Do as follows:\n1. forward 1 m\n2. turn left")
    assert said(log) == ["Do as follows:\n1. forward 1 m\n2. turn left"]


def test_a_plan_that_was_saved_is_one_plan(controller, log):
    controller.enter("repeat 2\n  drive 0.1 m\nend\n")
    assert told(log) == [("say_plan", "repeat 2\n  drive 0.1 m\nend")]


@pytest.mark.parametrize("stop", ["stop", "停！", "/stop"])
def test_a_stop_among_pasted_lines_comes_first_and_what_is_before_it_is_not_done(controller, log, stop):
    controller.enter(f"forward 1 m\n{stop}\nturn left")
    first, second = told(log)
    assert first == (("stop", "/stop") if stop == "/stop" else ("say", stop))
    assert second == ("say", "turn left")
    assert "：“forward 1 m”" in shown(log) if stop == "停！" else "not done: “forward 1 m”" in shown(log)


@pytest.mark.parametrize("outcome", ["unclear", "refused", "stopped", "failed"])
def test_after_a_turn_that_was_not_done_the_rest_is_not_done_and_that_is_said(controller, log, outcome):
    controller.enter("forward 1 m\nturn left\nforward 2 m")
    end_turn(controller, 1, outcome)
    assert said(log) == ["forward 1 m"]
    assert "“turn left”, “forward 2 m”" in shown(log)
    end_turn(controller, 1)
    assert said(log) == ["forward 1 m"]


@pytest.mark.parametrize("typed", ["", "stop", "/estop", "turn right", "drive 1 m\nturn left 90 deg"])
def test_whatever_is_typed_or_pressed_takes_the_place_of_what_waits(controller, log, typed):
    controller.enter("forward 1 m\nturn left")
    controller.enter(typed) if typed else controller.interrupt()
    end_turn(controller, 1)
    assert "turn left" not in said(log)
    assert "this is not done: “turn left”" in shown(log)


def test_a_stop_is_out_before_the_rest_is_told(controller, log):
    controller.enter("forward 1 m\nturn left")
    log.clear()
    controller.interrupt()
    assert log[0] == ("stop", "Ctrl-C")


def test_a_pasted_yes_answers_no_question(controller, log):
    ask(controller)
    controller.enter("y\nforward 1 m")
    assert told(log) == [("say", "y")]


def test_commands_among_pasted_lines_are_done_in_their_order(controller, log):
    controller.enter("forward 1 m\n/places\nturn left\n/undo")
    assert told(log) == [("say", "forward 1 m")]
    end_turn(controller, 1)
    assert told(log)[1:] == [("say", "turn left")]
    end_turn(controller, said_turn(log))
    assert told(log)[2:] == [("say", "undo")]


@pytest.mark.parametrize("command", ["/run-plan {}", "/program that turns twice"])
def test_what_is_behind_a_command_that_moves_waits_for_its_turn(controller, log, tmp_path, command):
    (tmp_path / "mine").write_text("drive 1 m\n")
    controller.enter(f"{command.format(tmp_path / 'mine')}\nturn left\nforward 1 m")
    do_posted(controller)
    ((word, _),) = told(log)
    turn = next(number for number, entry in enumerate(log, 1) if entry[0] == word)
    assert word in ("say_plan", "say_program")
    end_turn(controller, turn)
    assert said(log)[-1] == "turn left"
    assert "not done" not in shown(log)
    end_turn(controller, said_turn(log), "failed")
    assert "this is not done: “forward 1 m”" in shown(log)


def test_what_is_behind_a_plan_that_cannot_be_read_is_not_done_and_that_is_said(controller, log):
    controller.enter("/run-plan /none\nturn left")
    do_posted(controller)
    assert told(log) == []
    assert "/none: No such file" in shown(log)
    assert "this is not done: “turn left”" in shown(log)


def test_a_list_of_programs_among_pasted_lines_takes_no_turn(controller, log):
    controller.enter("/program\nturn left")
    assert said(log) == ["turn left"]


def test_quit_waits_for_what_was_pasted_before_it(controller, log):
    controller.enter("forward 1 m\n/quit\nturn left")
    assert told(log) == [("say", "forward 1 m")]
    end_turn(controller, 1)
    assert told(log)[1:] == [("leave", 0)]
    assert "this is not done: “turn left”" in shown(log)


def test_a_goodbye_waits_for_what_was_pasted(controller, log):
    controller.enter("forward 1 m\nturn left")
    controller.leave()
    controller.session.is_idle = False
    end_turn(controller, 1)
    assert said(log) == ["forward 1 m", "turn left"]
    assert ("leave", 0) not in log
    controller.session.is_idle = True
    end_turn(controller, said_turn(log))
    assert told(log)[-1] == ("leave", 0)


def test_too_many_lines_are_not_begun(controller, log):
    controller.enter("forward 1 m\n" * (MOST_TEXTS + 1))
    assert told(log) == []
    assert "None of them is done" in shown(log)


def test_a_stop_in_a_paste_that_is_too_long_is_a_stop(controller, log):
    controller.enter("forward 1 m\n" * LONGEST_CHARS + "stop\n")
    assert told(log) == [("stop", "stop")]


def test_a_stop_line_counts_from_the_moment_it_is_pasted(controller, log):
    controller.stop_for_paste("turn left\n")
    controller.stop_for_paste("stop sign\n/quit\n")
    assert told(log) == []
    controller.stop_for_paste("turn left\nstop\n")
    assert told(log) == [("stop", "stop")]


@pytest.mark.parametrize("release", ["/release", "/Release", "/ release", "/release notes"])
@pytest.mark.parametrize("before", ["", "where are you?\n"])
def test_a_pasted_release_releases_nothing_and_what_follows_is_not_done(controller, log, before, release):
    controller.emergency_stop("/estop")
    controller.enter(f"{before}{release}\nforward 1 m")
    end_turn(controller, said_turn(log), "answered") if before else None
    assert ("release",) not in log
    assert said(log) == (["where are you?"] if before else [])
    assert "type /release by itself" in shown(log)
    assert "not done: “forward 1 m”" in shown(log)
    assert controller.latched


def test_a_release_behind_a_pasted_stop_releases_nothing(controller, log):
    controller.enter("/estop\n/release")
    assert ("release",) not in log
