"""A plan that was edited so that nobody can read it is asked about as it was, and what was typed is there again."""

from chatrobot.core.events import Finished, Interpreted, Notice, Paused, Result, Started
from chatrobot.core.geometry import Pose
from chatrobot.core.reason import Reason
from tests.console.fakes import ask, shown, told

UNREADABLE = Notice(2, Reason("edit_unreadable", {"problem": "line 1: fly"}))


def test_what_could_not_be_read_is_there_again_at_the_next_edit(controller, log):
    ask(controller)
    controller.enter("e")
    controller.take_edited("fly 3 m")
    controller.hear(UNREADABLE)
    assert "line 1: fly" in shown(log)
    ask(controller)
    controller.enter("e")
    assert told(log)[-1] == ("edit", "fly 3 m")


def test_once_it_was_answered_the_plan_is_edited_as_it_is(controller, log):
    ask(controller)
    controller.enter("e")
    controller.take_edited("fly 3 m")
    controller.hear(UNREADABLE)
    controller.hear(
        Finished(controller._approval._edited_turn, "refused", None, Pose(), Pose(), 0.0, 0.0, 0.0, 0.0)
    )
    ask(controller)
    controller.enter("e")
    assert told(log)[-1] == ("edit", "drive 1 m")


def test_an_edit_that_leaves_nothing_says_so(controller, log):
    ask(controller)
    controller.enter("e")
    controller.take_edited("\n")
    assert "Nothing is left after the edit" in shown(log)


def test_what_was_driven_before_the_edit_is_told(controller, log):
    ask(controller)
    controller.enter("e")
    controller.hear(Result(1, "refused", "So far: drove 0.60 m of 1.00 m.", path_m=0.6))
    assert "So far: drove 0.60 m" in shown(log)


def test_a_second_pause_says_what_is_left_and_a_stop_is_told_once(controller, log):
    for turn, said in ((2, "pause"), (3, "puase"), (4, "stop")):
        log.clear()
        controller.enter(said)
        if turn == 2:
            controller.session.is_plan_paused = True
            controller.hear(Paused(1, Pose(), "drive 1 m"))
        controller.hear(Interpreted(turn, "reflex", "", ""))
        controller.hear(
            Result(turn, "stopped", "Stopped." if turn == 4 else "Paused. Still to do: drive forward 1 m.")
        )
        assert shown(log).count("Paused. Still to do: drive forward 1 m.") == (turn < 4), "told once"
        assert "Stopped." not in shown(log), "the plan tells its own end"


def test_the_strip_says_that_a_plan_is_paused(controller):
    def strip():
        return "".join(text for _, text in controller.status_bar.fragments(100))

    assert "standing" in strip()
    controller.hear(Started(1, Pose()))
    controller.hear(Paused(1, Pose(), "drive 1 m"))
    assert "paused" in strip()
    controller.hear(Finished(1, "stopped", None, Pose(), Pose(), 0.0, 0.0, 0.0, 0.0))
    assert "standing" in strip()
