"""What a typed line and a key do, without a terminal and without a robot."""

import os
import threading
from types import SimpleNamespace

import pytest

from chatrobot.cli.console import commands
from chatrobot.cli.console.controller import TWICE_S
from chatrobot.cli.console.pasted import LONGEST_CHARS
from chatrobot.core.events import Finished, Interpreted, Notice, Result, Started
from chatrobot.core.geometry import ZERO_TWIST, Pose, Twist
from chatrobot.core.reason import Reason
from tests.console.fakes import ask, do_posted, shown, told


def test_a_stop_is_out_before_anything_is_drawn(controller, log):
    controller.enter("stop")
    assert log[0] == ("say", "stop")
    log.clear()
    controller.interrupt()
    assert log[0] == ("stop", "Ctrl-C")


def test_two_interrupts_at_once_leave_and_two_far_apart_stop_twice(controller, log):
    controller.interrupt()
    controller._clock.advance(TWICE_S + 0.1)
    controller.interrupt()
    assert ("leave", 0) not in log
    controller._clock.advance(TWICE_S - 0.1)
    controller.interrupt()
    assert told(log)[-1] == ("leave", 0)


def test_an_interrupt_after_a_new_order_stops_it_and_does_not_leave(controller, log):
    controller.interrupt()
    controller.enter("forward 2 m")
    controller.interrupt()
    assert ("leave", 0) not in log
    assert told(log).count(("stop", "Ctrl-C")) == 2


def test_leaving_waits_for_what_was_told(controller, log):
    controller.session.is_idle = False
    controller.leave()
    assert told(log) == []
    controller.session.is_idle = True
    controller.hear(Result(1, "completed", "done"))
    assert told(log) == [("leave", 0)]


GOODBYE = Result(1, "answered", "Goodbye.", reason=Reason("parting"))


def test_a_goodbye_leaves_as_quit_does(controller, log):
    controller.hear(GOODBYE)
    assert told(log) == [("leave", 0)]


def test_a_goodbye_while_it_moves_waits_for_what_was_told(controller, log):
    controller.session.is_idle = False
    controller.hear(GOODBYE)
    assert told(log) == []
    controller.session.is_idle = True
    controller.hear(Result(2, "completed", "done"))
    assert told(log) == [("leave", 0)]


def test_leaving_twice_does_not_wait(controller, log):
    controller.session.is_idle = False
    controller.leave()
    controller.leave()
    assert told(log) == [("leave", 0)]


def test_leaving_a_question_is_a_no(controller, log):
    ask(controller)
    controller.session.is_idle = False
    controller.leave()
    assert told(log) == [("approve", 1, False)]


def test_an_interrupt_takes_a_goodbye_back(controller, log):
    controller.session.is_idle = False
    controller.leave()
    controller.interrupt()
    controller.session.is_idle = True
    controller.hear(Result(1, "stopped", "stopped"))
    assert ("leave", 0) not in log


@pytest.mark.parametrize(
    ("answer", "yes"), [("y", True), ("Yes.", True), ("好", True), ("n", False), ("不要", False)]
)
def test_a_question_is_answered(controller, log, answer, yes):
    ask(controller)
    controller.enter(answer)
    assert told(log) == [("approve", 1, yes)]


def test_yes_to_no_question_is_an_instruction_like_any_other(controller, log):
    controller.enter("yes")
    assert told(log) == [("say", "yes")]


def test_a_stop_during_a_question_is_a_stop(controller, log):
    ask(controller)
    controller.enter("stop")
    assert told(log) == [("say", "stop")]


def test_a_question_is_over_once_its_turn_has_begun_or_ended(controller, log):
    for end in (Started(1, Pose()), Finished(1, "refused", None, Pose(), Pose(), 0.0, 0.0, 0.0, 0.0)):
        ask(controller)
        controller.hear(end)
        log.clear()
        controller.enter("y")
        assert told(log) == [("say", "y")]


def test_editing_withdraws_the_plan_silently_and_sends_the_new_one(controller, log):
    ask(controller)
    controller.enter("e")
    assert told(log) == [("approve", 1, False), ("edit", "drive 1 m")]
    controller.hear(Result(1, "refused", "not approved"))
    assert "not approved" not in shown(log)
    controller.take_edited("drive 2 m\n")
    assert told(log)[-1] == ("say_edited_plan", "drive 2 m")


def test_what_is_too_long_is_never_done_in_part(controller, log):
    controller.enter("forward 1 m " * LONGEST_CHARS)
    controller.enter("x" * LONGEST_CHARS + " ")
    controller.take_edited("drive 1 m\n" * LONGEST_CHARS)
    assert told(log) == []


def test_an_empty_line_is_nothing(controller, log):
    controller.enter("  \n")
    assert log == []


@pytest.mark.parametrize("code", ["released", "none_to_release"])
def test_emergency_stop_latches_the_screen_until_release(controller, log, code):
    controller.enter("/estop")
    assert controller.latched
    controller.enter("/release")
    controller.hear(Notice(1, Reason(code, {"source": "console"})))
    assert not controller.latched
    assert told(log) == [("emergency_stop", "/estop"), ("release",)]
    controller.enter("emergency stop")
    assert controller.latched


def test_when_motion_is_gone_the_talk_ends_with_a_word(controller, log):
    controller.session.is_lost = True
    controller.enter("forward 1 m")
    assert ("leave", 1) in log
    assert "Motion is gone" in shown(log)


def test_a_long_line_is_echoed_in_part(controller, log):
    controller.enter("x" * 3000)
    assert len(shown(log)) < 700


def test_a_stop_waits_for_no_line_that_is_being_drawn(controller, log):
    with controller._order:  # as if the terminal were halted by Ctrl-S
        stopper = threading.Thread(target=controller.enter, args=("stop",))
        stopper.start()
        stopper.join(10.0)
        assert not stopper.is_alive()
    assert log[0] == ("say", "stop")


@pytest.mark.parametrize("moving_ends_first", [True, False])
def test_one_stop_is_told_once(controller, log, moving_ends_first):
    ending = [
        Finished(1, "stopped", None, Pose(), Pose(), 0.3, 0.0, 1.0, 0.0),
        Result(1, "stopped", "Stopped after 0.3 m."),
    ]
    heard = [Interpreted(2, "reflex", "", "")]
    controller.hear(Started(1, Pose()))
    controller.enter("stop")
    for event in [*ending, *heard] if moving_ends_first else [*heard, *ending]:
        controller.hear(event)
    controller.hear(Result(2, "stopped", "Stopped."))
    assert shown(log).count("Stopped") == 1
    controller.enter("stop")
    controller.hear(Interpreted(3, "reflex", "", ""))
    controller.hear(Result(3, "stopped", "Stopped."))
    assert shown(log).count("Stopped") == 2


def test_released_is_said_once_and_not_before_motion_has_released(controller, log):
    controller.enter("/estop")
    controller.enter("/release")
    assert ("release",) in log
    assert "is released" not in shown(log)
    assert controller.latched
    controller.hear(Notice(1, Reason("released", {"source": "console"})))
    assert shown(log).count("is released") == 1
    assert not controller.latched


def test_a_refused_release_is_said_and_the_alarm_stays(controller, log):
    controller.enter("/estop")
    controller.enter("/release")
    controller.hear(Notice(1, Reason("release_refused", {"source": "console"})))
    assert "Emergency stop still active" in shown(log)
    assert controller.latched


def test_news_of_a_release_takes_no_alarm_away_that_was_raised_since(controller):
    controller.enter("/estop")
    controller.enter("/release")
    controller.enter("/estop")
    controller.hear(Notice(1, Reason("released", {"source": "console"})))
    assert controller.latched


@pytest.mark.parametrize("typed", ["/release notes are in the drawer", "/quit smoking", "/undo the laces"])
def test_a_command_that_takes_nothing_does_nothing_where_more_was_typed(controller, log, typed):
    controller.enter(typed)
    assert told(log) == []
    assert f"{typed.split()[0]} takes nothing behind it" in shown(log)


@pytest.mark.parametrize("typed", ["quit", "Exit", "/exit", "/quit"])
def test_quit_and_exit_leave_where_nothing_moves(controller, log, typed):
    controller.enter(typed)
    assert told(log) == [("leave", 0)]


@pytest.mark.parametrize("moves", ["is ours", "is another's", "goes on"])
def test_quit_stops_a_robot_that_moves_and_how_to_leave_is_told(controller, log, moves):
    controller.session.is_idle = moves != "is ours"
    controller.motion_view.is_moving = moves == "is another's"
    controller.motion_view.twist = Twist(0.1, 0.0, 0.0) if moves == "goes on" else ZERO_TWIST
    controller.enter("quit")
    assert told(log) == [("say", "quit")]
    assert "/quit, Ctrl-D or “bye” leaves." in shown(log)


def test_exit_lets_a_robot_that_moves_finish_as_slash_quit_does(controller, log):
    controller.session.is_idle = False
    controller.enter("exit")
    assert told(log) == []
    assert "The robot finishes what it was told" in shown(log)


@pytest.mark.parametrize(
    "typed", ["add big 4 4 -1", "add big 4 4 0", "add big 1..2 4", "add big", "move big 1 1"]
)
def test_an_obstacle_that_cannot_be_gets_the_usage(controller, log, typed):
    controller.connection.prepared = SimpleNamespace(setup=SimpleNamespace(on="sim"))
    act = commands.BY_NAME["obstacle"].act
    act(controller, typed)
    assert told(log) == []
    assert "/obstacle add NAME X Y [RADIUS]" in shown(log)
    act(controller, "add big 4 -4.5 .5")
    assert told(log) == [("obstacle", {"add": "big", "circle": [4.0, -4.5, 0.5]})]


def test_a_saved_plan_is_told_to_the_session_and_a_broken_one_is_not(controller, log, tmp_path):
    act = commands.BY_NAME["run-plan"].act
    (tmp_path / "my plan").write_text("drive 1 m\n")
    (tmp_path / "bad").write_text("drive 1 m\nfly 2 m\n")
    act(controller, f"{tmp_path / 'my plan'}")
    assert told(log) == [("say_plan", "drive 1 m\n")]
    act(controller, f"{tmp_path / 'bad'}")
    act(controller, f"{tmp_path / 'none'}")
    assert len(told(log)) == 1
    assert "The plan was not run: " in shown(log)
    assert "bad: line 2: 'fly 2 m': no step begins like this (one of: arc, drive, " in shown(log)
    assert "none: No such file or directory" in shown(log)


@pytest.mark.parametrize("command", ["/run-plan f", "/undo", "/program that turns twice"])
def test_a_command_that_a_stop_overtakes_moves_nothing(controller, log, command):
    controller.enter(command)
    controller.interrupt()
    do_posted(controller)
    assert told(log) == [("stop", "Ctrl-C")]
    assert f"A stop came before “{command}” was done, so it was dropped." in shown(log)


def test_a_stop_while_a_plan_is_read_makes_it_void(controller, log, monkeypatch):
    def read(*_, **__):
        controller.interrupt()
        return "drive 1 m\n"

    monkeypatch.setattr(commands, "read_plan_file", read)
    controller.enter("/run-plan far/away")
    do_posted(controller)
    assert ("say_plan", "drive 1 m\n") not in log
    assert "A stop came before “/run-plan far/away” was done" in shown(log)


def test_a_plan_is_not_read_from_what_others_still_write(controller, log, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    commands.BY_NAME["run-plan"].act(controller, str(tmp_path / "pipe"))
    assert told(log) == []
    assert "pipe: not a file" in shown(log)


def test_a_map_of_a_size_that_there_is_not_says_which_there_are(controller, log):
    commands.BY_NAME["map"].act(controller, "huge")
    assert "There is no map 'huge'. /map shows or hides the small one, /map big draws the big one." in shown(
        log
    )
    assert controller.status_bar.shows_map


def test_a_stop_where_nothing_is_under_way_is_answered(controller, log):
    controller.enter("/stop")
    assert told(log)[0] == ("stop", "/stop")
    assert "The robot was told to stop; nothing was under way." in shown(log)


def test_the_name_of_a_kept_program_writes_no_second_one(controller, log):
    library = SimpleNamespace(names=lambda: ("triangle", "zigzag"))
    controller.session.authoring = SimpleNamespace(library=library)
    for argument in ("triangle", "list"):
        commands.BY_NAME["program"].act(controller, argument)
    assert "“triangle” is kept already: “run the triangle” runs it." in shown(log)
    assert "Kept programs: triangle, zigzag." in shown(log)
    assert not told(log)


@pytest.mark.parametrize(("typed", "word"), [("/stop it now", "stop"), ("/estop now", "emergency_stop")])
def test_a_stop_is_a_stop_whatever_is_typed_behind_it(controller, log, typed, word):
    controller.enter(typed)
    assert told(log)[0][0] == word
