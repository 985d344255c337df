"""A pause keeps the plan: it goes on with the rest when its own source says so, and never by itself."""

from __future__ import annotations

import math

import pytest
from tests.dialogue.talk import Talk

from chatrobot.core.events import Finished, Interpreted, Paused, Rehearsed, Result, Started, TruePose
from chatrobot.core.geometry import Pose
from chatrobot.dialogue.options import Options

PAUSES = [
    "pause",
    "hold on",
    "wait",
    "hold it",
    "suspend",
    "puase",
    "please wait a second",
    "暂停",
    "等一下",
    "等等",
]
RESUMES = ["continue", "resume", "go on", "carry on please", "ok, continue", "继续", "接着走"]


def paused(talk: Talk) -> list[Paused]:
    return [event for event in talk.events if isinstance(event, Paused)]


def pause(talk: Talk, word: str = "pause") -> Paused:
    """Say it to the moving robot, and wait until it stands."""
    talk.pump_until_moving()
    before = len(paused(talk))
    talk.session.say(word)
    talk.pump_until(lambda: len(paused(talk)) > before and talk.session.is_paused)
    return paused(talk)[-1]


def run_s(talk: Talk, duration_s: float) -> None:
    for _ in range(round(duration_s / 0.02)):
        talk.session.pump(0.02)


def truth(talk: Talk) -> TruePose:
    return next(event for event in reversed(talk.events) if isinstance(event, TruePose))


@pytest.mark.parametrize("word", PAUSES)
def test_a_pause_word_keeps_the_plan_and_continue_drives_the_rest(word: str) -> None:
    talk = Talk()
    talk.session.say("forward 1 m")
    left = pause(talk, word)
    assert left.turn == 1
    assert 1 not in talk.results(), "the turn stays open"
    run_s(talk, 5.0)
    assert truth(talk).vx_mps == 0.0
    talk.session.say("continue")
    talk.pump_until(lambda: 1 in talk.results())
    whole = talk.results()[1]
    assert whole.outcome == "completed"
    assert whole.pose.x_m == pytest.approx(1.0, abs=0.01)
    assert whole.path_m == pytest.approx(1.0, abs=0.01)
    assert whole.paused_s >= 5.0
    assert whole.duration_s < 6.0
    assert "1.00 m of 1.00 m" in whole.reply or "1.00 米" in whole.reply


def test_the_time_that_it_stood_is_told_beside_the_time_that_it_was_driven() -> None:
    talk = Talk()
    alone = talk.do("forward 50 cm")
    assert alone.paused_s == 0.0
    waited = talk.do("forward 25 cm, wait 2 s, forward 25 cm")
    assert waited.paused_s == pytest.approx(2.0, abs=0.3)
    other = Talk()
    other.session.say("forward 50 cm")
    pause(other)
    run_s(other, 3.0)
    other.session.say("continue")
    other.pump_until(lambda: 1 in other.results())
    resumed = other.results()[1]
    assert resumed.paused_s >= 3.0
    for stood in (waited, resumed):  # two ramps more, and nothing of the time that it stood
        assert alone.duration_s < stood.duration_s < alone.duration_s + 1.5


@pytest.mark.parametrize("word", RESUMES)
def test_every_word_for_going_on_goes_on(word: str) -> None:
    talk = Talk()
    talk.session.say("forward 1 m, then turn left 90 degrees")
    left = pause(talk)
    assert "turn left 90 deg" in left.plan_text
    turn = talk.session.say(word)
    talk.pump_until(lambda: 1 in talk.results())
    assert talk.results()[turn].outcome == "answered"
    assert talk.results()[1].outcome == "completed"
    assert talk.results()[1].pose.x_m == pytest.approx(1.0, abs=0.01)
    assert talk.results()[1].pose.yaw_rad == pytest.approx(math.pi / 2, abs=0.01)


def test_the_rest_is_rehearsed_from_the_measured_pose_and_shown() -> None:
    talk = Talk()
    talk.session.say("forward 2 m")
    left = pause(talk)
    talk.session.say("continue")
    talk.pump_until(lambda: 1 in talk.results())
    shown = [event for event in talk.events if isinstance(event, Interpreted) and event.turn == 1]
    assert [event.plan_text for event in shown] == ["drive 2 m", left.plan_text]
    rehearsed = [event for event in talk.events if isinstance(event, Rehearsed)]
    assert rehearsed[1].turn == 1
    assert rehearsed[1].path[0][0] == pytest.approx(left.pose.x_m, abs=0.002)
    assert rehearsed[1].end.x_m == pytest.approx(2.0, abs=0.01)


def test_a_plan_may_be_paused_again_and_again() -> None:
    talk = Talk()
    talk.session.say("forward 2 m")
    for _ in range(3):
        before = len([event for event in talk.events if isinstance(event, Started)])
        pause(talk)
        talk.session.say("pause")
        run_s(talk, 1.0)
        talk.session.say("continue")
        talk.pump_until(lambda n=before: len([e for e in talk.events if isinstance(e, Started)]) > n)  # type: ignore[misc]
        run_s(talk, 1.0)
    talk.pump_until(lambda: 1 in talk.results())
    assert talk.results()[1].path_m == pytest.approx(2.0, abs=0.01)
    assert talk.results()[1].paused_s >= 3.0


def test_what_waits_waits_behind_it_and_is_done_after_it() -> None:
    talk = Talk()
    talk.session.say("forward 1 m")
    talk.session.say("turn left 90 degrees")
    pause(talk)
    run_s(talk, 3.0)
    assert 2 not in talk.results()
    talk.session.say("continue")
    talk.pump_until(lambda: 2 in talk.results())
    assert [talk.results()[turn].outcome for turn in (1, 2)] == ["completed", "completed"]
    assert talk.results()[2].pose.yaw_rad == pytest.approx(math.pi / 2, abs=0.01)


@pytest.mark.parametrize("word", ["stop", "halt", "停", "stpp"])
def test_a_stop_word_drops_it_and_what_waits(word: str) -> None:
    talk = Talk()
    talk.session.say("forward 2 m")
    talk.session.say("turn left 90 degrees")
    pause(talk)
    talk.session.say(word)
    talk.pump_until(lambda: {1, 2} <= set(talk.results()))
    assert [talk.results()[turn].outcome for turn in (1, 2)] == ["stopped", "stopped"]
    assert talk.results()[1].reason is not None
    assert talk.results()[1].reason.code == "stopped_by"
    assert not talk.session.is_moving


def test_an_emergency_stop_drops_it() -> None:
    talk = Talk()
    talk.session.say("forward 2 m")
    pause(talk)
    talk.session.say("emergency stop")
    talk.pump_until(lambda: 1 in talk.results())
    assert talk.results()[1].outcome == "stopped"


def test_a_stop_in_the_same_moment_counts_more_than_the_pause() -> None:
    for first, second in (("pause", "stop"), ("stop", "pause")):
        talk = Talk()
        talk.session.say("forward 2 m")
        talk.pump_until_moving()
        talk.session.say(first)
        talk.session.say(second)
        talk.pump_until(lambda t=talk: len(t.results()) == 3)  # type: ignore[misc]
        assert not paused(talk)
        assert talk.results()[1].outcome == "stopped"


def test_a_new_instruction_takes_its_place_and_says_so() -> None:
    talk = Talk()
    talk.session.say("forward 2 m")
    talk.session.say("turn left 90 degrees")
    pause(talk)
    turn = talk.session.say("back 20 cm")
    talk.pump_until(lambda: turn in talk.results())
    assert talk.results()[1].outcome == "stopped"
    assert "new instruction" in talk.results()[1].reply
    assert talk.results()[2].outcome == "stopped"
    assert talk.results()[turn].outcome == "completed"
    assert talk.results()[turn].pose.x_m == pytest.approx(paused(talk)[0].pose.x_m - 0.2, abs=0.01)


def test_then_comes_after_it() -> None:
    talk = Talk(options=Options(while_moving="replace"))
    talk.session.say("forward 1 m")
    pause(talk)
    turn = talk.session.say("then turn left 90 degrees")
    run_s(talk, 1.0)
    assert turn not in talk.results()
    talk.session.say("continue")
    talk.pump_until(lambda: turn in talk.results())
    assert talk.results()[1].outcome == talk.results()[turn].outcome == "completed"


@pytest.mark.parametrize("text", ["where are you?", "blah blah"])
def test_a_question_leaves_it_paused(text: str) -> None:
    talk = Talk()
    talk.session.say("forward 1 m")
    pause(talk)
    turn = talk.session.say(text)
    talk.pump_until(lambda: turn in talk.results())
    assert talk.session.is_paused
    talk.session.say("continue")
    talk.pump_until(lambda: 1 in talk.results())
    assert talk.results()[1].outcome == "completed"


@pytest.mark.parametrize("moved", [Pose(0.06, 0.0, 0.0), Pose(0.0, 0.0, math.radians(6.0))])
def test_it_is_dropped_where_the_robot_is_moved(moved: Pose) -> None:
    from chatrobot.motion.goal import Goal
    from chatrobot.motion.pausing import PausedGoal

    stood = Pose(1.0, 2.0, 0.5)
    so_far = Finished(1, "stopped", None, Pose(), stood, 0.0, 1.0, 3.0, 0.0, remaining="drive 1 m")
    goal = PausedGoal(Goal(1, "me", "drive 2 m", False, False, 0, 0.0), lambda: so_far, 10.0)
    assert goal.lapsed(20.0, stood.compose(moved)) is None, "it has not come to stand"
    goal.settle()
    assert goal.lapsed(20.0, stood) is None
    assert goal.lapsed(20.0, stood.compose(Pose(0.04, 0.0, math.radians(4.0)))) is None
    lapsed = goal.lapsed(20.0, stood.compose(moved))
    assert lapsed is not None
    assert lapsed.code == "pause_robot_moved"


def test_approval_is_asked_anew_for_the_rest() -> None:
    talk = Talk(options=Options(approve=True))
    talk.session.say("forward 1 m")
    talk.pump_until(lambda: any(isinstance(e, Rehearsed) for e in talk.events))
    talk.session.approve(1, True)
    pause(talk)
    talk.session.say("continue")
    talk.pump_until(lambda: len([e for e in talk.events if isinstance(e, Rehearsed)]) == 2)
    again = [event for event in talk.events if isinstance(event, Rehearsed)][-1]
    assert again.needs_approval
    assert again.turn == 1
    run_s(talk, 2.0)
    assert truth(talk).vx_mps == 0.0
    talk.session.approve(1, True)
    talk.pump_until(lambda: 1 in talk.results())
    assert talk.results()[1].outcome == "completed"
    assert talk.results()[1].pose.x_m == pytest.approx(1.0, abs=0.01)


def test_a_question_for_approval_may_be_paused_too() -> None:
    talk = Talk(options=Options(approve=True))
    talk.session.say("forward 1 m")
    talk.pump_until(lambda: any(isinstance(e, Rehearsed) for e in talk.events))
    talk.session.say("pause")
    talk.pump_until(lambda: talk.session.is_paused)
    assert paused(talk)[0].plan_text == "drive 1 m"
    run_s(talk, 60.0)
    assert 1 not in talk.results()
    talk.session.say("continue")
    talk.pump_until(lambda: len([e for e in talk.events if isinstance(e, Rehearsed)]) == 2)
    talk.session.approve(1, True)
    talk.pump_until(lambda: 1 in talk.results())
    assert talk.results()[1].outcome == "completed"


def test_after_a_stop_continue_offers_the_rest_and_wants_a_yes() -> None:
    talk = Talk()
    talk.session.say("forward 2 m")
    talk.pump_until_moving()
    talk.session.say("stop")
    talk.pump_until(lambda: len(talk.results()) == 2)
    run_s(talk, 1.0)
    offered = talk.session.do("continue")
    assert offered.outcome == "unclear"
    assert offered.proposal is not None
    assert offered.proposal.plan_text.startswith("drive 1.")
    run_s(talk, 3.0)
    assert truth(talk).vx_mps == 0.0
    driven = talk.session.do("yes")
    assert driven.outcome == "completed"
    assert driven.pose.x_m == pytest.approx(2.0, abs=0.02)


def test_after_a_stop_with_nothing_left_continue_moves_nothing() -> None:
    talk = Talk()
    resuming = talk.session._resuming
    resuming.hear(Finished(1, "stopped", None, Pose(), Pose(), 0.0, 0.0, 0.0, 0.0))
    said = talk.session.do("continue")
    assert said.outcome == "answered"
    assert said.path_m == 0.0


def test_after_a_plan_that_was_done_there_is_no_rest() -> None:
    talk = Talk()
    talk.session.do("forward 1 m")
    assert talk.session.do("resume").proposal is None


def test_a_pause_while_nothing_moves_keeps_nothing() -> None:
    talk = Talk()
    assert talk.session.do("pause").outcome == "stopped"
    assert not talk.session.is_paused
    assert talk.session.do("forward 20 cm").outcome == "completed"


def test_a_pause_before_anything_moved_moves_nothing() -> None:
    talk = Talk()
    talk.session.say("forward 2 m")
    talk.session.say("pause")
    run_s(talk, 3.0)
    assert truth(talk).x_m == 0.0
    assert talk.session.is_paused or 1 in talk.results()


def test_what_had_not_begun_waits_for_continue() -> None:
    talk = Talk()
    for text in ("forward 1 m", "back 20 cm", "pause"):
        talk.session.say(text)
    run_s(talk, 1.0)
    assert talk.session.is_paused
    assert list(talk.results()) == [3]
    assert "“forward 1 m”, “back 20 cm”" in talk.results()[3].reply
    assert talk.session.do("where are you?").outcome == "answered"
    assert talk.session.do("continue").outcome == "answered"
    talk.pump_until(lambda: {1, 2} <= talk.results().keys())
    assert truth(talk).x_m == pytest.approx(0.8, abs=0.02)
    assert not talk.session.is_paused


@pytest.mark.parametrize("text", ["stop", "turn left 20 degrees"])
def test_what_had_not_begun_is_dropped_by_a_stop_and_by_what_is_done_instead(text: str) -> None:
    talk = Talk()
    talk.session.say("forward 1 m")
    talk.session.say("pause")
    run_s(talk, 0.5)
    talk.session.do(text)
    run_s(talk, 0.5)
    assert talk.results()[1].outcome == "stopped"
    assert not talk.session.is_paused
    assert truth(talk).x_m == pytest.approx(0.0, abs=0.01)


def test_a_second_pause_keeps_what_had_not_begun() -> None:
    talk = Talk()
    for text in ("forward 50 cm", "pause", "pause", "continue"):
        talk.session.say(text)
    talk.pump_until(lambda: len(talk.results()) == 4)
    assert talk.results()[1].outcome == "completed"


def test_goodbye_drops_it() -> None:
    talk = Talk()
    talk.session.say("forward 2 m")
    pause(talk)
    talk.connection.close()  # it waits for nobody


def test_a_result_is_the_last_event_of_each_turn() -> None:
    talk = Talk()
    talk.session.say("forward 1 m")
    pause(talk)
    talk.session.say("continue")
    talk.pump_until(lambda: len(talk.results()) == 3)
    last = {event.turn: event for event in talk.events if event.turn}
    assert all(isinstance(event, Result) for event in last.values())


def test_what_is_not_understood_is_answered_while_the_robot_moves() -> None:
    talk = Talk()
    talk.session.say("forward 3 m")
    talk.session.say("turn left")
    talk.pump_until_moving()
    turn = talk.session.say("blubber the wibble")
    talk.pump_until(lambda: turn in talk.results())
    assert talk.results()[turn].outcome == "unclear"
    assert 1 not in talk.results()
    assert 2 not in talk.results()
    talk.pump_until(lambda: len(talk.results()) == 3)
    assert talk.results()[2].outcome == "completed"


def test_what_the_running_plan_may_teach_is_understood_after_it() -> None:
    talk = Talk()
    talk.session.say_plan('drive 1 m\nremember "nook"\ndrive back 1 m')
    talk.pump_until_moving()
    turn = talk.session.say("go to the nook")
    talk.pump_until(lambda: turn in talk.results())
    assert talk.results()[turn].outcome == "completed"


@pytest.mark.parametrize("word", ["no", "no!", "nope", "不"])
def test_a_no_to_a_motion_stops_it(word: str) -> None:
    talk = Talk()
    talk.session.say("forward 1 m")
    talk.pump_until_moving()
    turn = talk.session.say(word)
    talk.pump_until(lambda: {1, turn} <= set(talk.results()))
    assert talk.results()[1].outcome == "stopped"
    assert talk.results()[1].path_m < 0.3


def test_a_correction_that_fits_nothing_stops_what_it_corrects() -> None:
    talk = Talk(options=Options(while_moving="replace"))
    talk.session.say("forward 1 m")
    talk.pump_until_moving()
    turn = talk.session.say("no, I meant left")
    talk.pump_until(lambda: {1, turn} <= set(talk.results()))
    assert talk.results()[1].outcome == "stopped"
    assert talk.results()[turn].outcome == "unclear"


@pytest.mark.parametrize("word", ["continue", "resume", "继续"])
def test_where_nothing_is_left_continue_moves_nothing(word: str) -> None:
    talk = Talk()
    turn = talk.session.say(word)
    talk.pump_until(lambda: turn in talk.results())
    assert talk.results()[turn].outcome == "answered"
    assert talk.results()[turn].path_m == 0.0
