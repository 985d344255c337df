"""What is said of a plan while it is driven: its speed changes at once, on the same path; its rest is told."""

from __future__ import annotations

import re

import pytest
from tests.dialogue.undo_rig import UndoRig

from chatrobot.core.events import Interpreted, Paused, Started
from chatrobot.dialogue.options import Options
from chatrobot.language.interpreter import OfflineInterpreter

ASKING = Options(while_moving="replace")


@pytest.fixture
def rig() -> UndoRig:
    return UndoRig(options=ASKING)


def driving(rig: UndoRig, order: str = "forward 3 m") -> int:
    """Say an order; return its turn once it drives at its speed."""
    turn = rig.session.say(order)
    rig.live(2.0)
    assert rig.session.is_moving
    return turn


@pytest.mark.parametrize(
    ("said", "speed_mps"),
    [
        ("slower", 0.15), ("slow down", 0.15), ("no hurry", 0.15), ("keine Eile", 0.15), ("不着急", 0.15),
        ("not so fast", 0.15), ("you're going way too fast!", 0.15),
        ("can you go slower?", 0.15), ("make it slower", 0.15), ("half speed", 0.15), ("20 % slower", 0.24),
        ("at 0.1 m/s", 0.1), ("go at 0.1 m/s", 0.1), ("slow down to 10 cm/s", 0.1), ("faster", 0.51),
        ("speed up", 0.51), ("too slow", 0.51),
        ("that was too slow", 0.51), ("nicht so langsam", 0.51), ("别这么慢", 0.51),
        ("twice as fast", 0.6), ("20% faster", 0.36),
        ("慢一点", 0.15), ("你开得太快了", 0.15), ("减速到0.1米每秒", 0.1), ("能不能开快点？", 0.51),
        ("langsamer", 0.15), ("halb so schnell", 0.15), ("half as fast", 0.15), ("一半速度", 0.15), ("slow", 0.15),
        ("nicht so schnell", 0.15), ("zu schnell", 0.15), ("geh vom Gas", 0.15),
        ("mit 0,1 m/s", 0.1), ("kannst du langsamer fahren?", 0.15), ("viel zu langsam", 0.51),
    ],
)  # fmt: skip
def test_the_speed_changes_under_way_and_the_end_stays(rig: UndoRig, said: str, speed_mps: float) -> None:
    turn = driving(rig)
    about = rig.session.say(said)
    rig.live(1.5)
    assert rig.session.results[about].outcome == "answered"
    assert rig.speed_mps == pytest.approx(speed_mps, abs=0.01)
    rig.live(40.0)
    assert rig.session.results[turn].outcome == "completed"
    assert rig.x_m == pytest.approx(3.0, abs=0.02)
    assert sum(isinstance(event, Started) for event in rig.events) == 1, "it never set out anew"


@pytest.mark.parametrize(
    "said",
    [
        "is it fast?",
        "how fast are you?",
        "was it slower before?",
        "这样快吗？",
        "you are quick today",
        "wow, fast!",
        "so fast!",
        "what a fast robot",
        "my cat is faster",
        "du bist schnell",
        "ganz schön flott",
        "der andere war langsamer",
        "好快啊",
    ],
)
def test_a_question_or_a_remark_changes_no_speed(rig: UndoRig, said: str) -> None:
    driving(rig)
    rig.session.say(said)
    rig.live(1.5)
    assert rig.speed_mps == pytest.approx(0.3, abs=0.01)


@pytest.mark.parametrize("said", ["at 99 m/s", "1000 times as fast", "mit 99 m/s"])
def test_a_speed_beyond_the_limits_is_refused_and_told(rig: UndoRig, said: str) -> None:
    driving(rig)
    refused = rig.session.say(said)
    rig.live(1.5)
    assert rig.session.results[refused].outcome == "refused"
    assert "1.00 m/s" in rig.session.results[refused].reply.replace(",", ".")
    assert rig.speed_mps == pytest.approx(0.3, abs=0.01)


@pytest.mark.parametrize(
    "said", ["normal speed", "back to normal speed", "恢复正常速度", "normale Geschwindigkeit"]
)
def test_the_normal_speed_comes_back(rig: UndoRig, said: str) -> None:
    driving(rig, "forward 3 m at 0.1 m/s")
    rig.session.say(said)
    rig.live(1.5)
    assert rig.speed_mps == pytest.approx(0.3, abs=0.01)


@pytest.mark.parametrize(
    "said", ["reduce the speed by 50 percent", "increase speed by 0.1 m/s", "减速60%", "加速0.05米每秒"]
)
def test_no_word_of_slowing_makes_it_faster_and_none_of_haste_slower(rig: UndoRig, said: str) -> None:
    driving(rig)
    rig.session.say(said)
    rig.live(1.0)
    assert rig.speed_mps == pytest.approx(0.3, abs=0.01)


def test_each_change_is_of_the_speed_before(rig: UndoRig) -> None:
    driving(rig)
    for said, speed_mps in (
        ("slower", 0.15),
        ("slower", 0.075),
        ("faster", 0.1275),
        ("twice as fast", 0.255),
    ):
        rig.session.say(said)
        rig.live(1.5)
        assert rig.speed_mps == pytest.approx(speed_mps, abs=0.01)


def test_the_steps_that_follow_have_the_other_speed_too(rig: UndoRig) -> None:
    turn = driving(rig, "drive 1 m, then curve left with radius 1 m for 90 degrees, then drive 1 m")
    rig.session.say("slower")
    rig.live(30.0)
    result = rig.session.results[turn]
    assert result.outcome == "completed"
    assert (rig.pose.x_m, rig.pose.y_m) == (pytest.approx(2.0, abs=0.05), pytest.approx(2.0, abs=0.05))
    assert result.duration_s > 20.0


def test_what_is_left_after_a_stop_is_driven_at_the_speed_that_was_said(rig: UndoRig) -> None:
    driving(rig)
    rig.session.say("slower")
    rig.live(1.0)
    rig.session.say("stop")
    rig.live(1.0)
    offer = rig.do("continue").proposal
    assert offer is not None
    assert offer.plan_text.endswith("at 0.15 m/s")


def test_a_paused_plan_goes_on_at_the_speed_that_was_said(rig: UndoRig) -> None:
    turn = driving(rig)
    rig.session.pause()
    rig.live(1.0)
    reply = rig.do("slower").reply
    assert "at 0.15 m/s" in reply
    assert "continue" in reply
    rig.live(1.0)
    assert rig.speed_mps == 0.0
    assert sum(isinstance(event, Paused) for event in rig.events) == 1, "the reply tells what is left"
    rig.session.say("continue")
    rig.live(2.0)
    assert rig.speed_mps == pytest.approx(0.15, abs=0.01)
    rig.live(20.0)
    assert rig.session.results[turn].outcome == "completed"
    assert rig.x_m == pytest.approx(3.0, abs=0.02)


def test_a_motion_of_a_given_time_lasts_as_long_and_is_made_no_faster(rig: UndoRig) -> None:
    turn = driving(rig, "drive forward for 6 s")
    assert rig.do("faster").outcome == "refused"
    rig.session.say("slower")
    rig.live(8.0)
    assert rig.session.results[turn].duration_s == pytest.approx(6.0, abs=0.5)
    assert rig.x_m == pytest.approx(2.2 * 0.3 + 3.8 * 0.15, abs=0.1)


def test_what_was_approved_is_made_slower_but_not_faster(rig: UndoRig) -> None:
    rig.session.options = Options(while_moving="replace", approve=True)
    turn = rig.session.say("forward 3 m")
    rig.live(0.5)
    rig.session.say("yes")
    rig.live(2.0)
    refused = rig.do("faster")
    assert refused.outcome == "refused"
    assert "continue, but faster" in refused.reply
    rig.session.say("slower")
    rig.live(1.5)
    assert rig.speed_mps == pytest.approx(0.15, abs=0.01)
    rig.live(20.0)
    assert rig.session.results[turn].outcome == "completed"


def test_no_change_lifts_a_spoken_speed_limit(rig: UndoRig) -> None:
    rig.do("never go faster than 0.2 m/s")
    driving(rig)
    rig.session.say("three times as fast")
    rig.live(1.5)
    assert rig.speed_mps <= 0.21


def test_lines_of_a_pipe_wait_for_their_turn() -> None:
    rig = UndoRig(options=Options(answers_in_turn=True))
    driving(rig)
    rig.session.say("slower")
    rig.live(1.5)
    assert rig.speed_mps == pytest.approx(0.3, abs=0.01)


def test_elsewhere_orders_wait_but_no_change_of_speed_and_no_question_does() -> None:
    rig = UndoRig()  # at the node `input`, in a program
    turn = driving(rig)
    rig.session.say("slower")
    asked = rig.session.say("how much longer?")
    rig.session.say("turn left")
    rig.session.say("faster")  # of the turn that waits
    rig.live(1.5)
    assert rig.speed_mps == pytest.approx(0.15, abs=0.01)
    assert rig.session.results[asked].outcome == "answered"
    rig.live(30.0)
    assert rig.session.results[turn].outcome == "completed"
    assert rig.pose.yaw_rad == pytest.approx(1.57, abs=0.03)


@pytest.mark.parametrize(
    "asked",
    [
        "where are you going?", "what's left?", "how far is it still?", "how much longer?", "are we there yet?",
        "what will you do next?", "还有多远？", "你要去哪里？", "到了吗？", "wie weit noch?", "bist du fertig?",
        "wohin fährst du?",
    ],
)  # fmt: skip
def test_a_question_about_the_rest_is_answered_with_the_rest(rig: UndoRig, asked: str) -> None:
    driving(rig)
    answered = rig.session.say(asked)
    rig.live(0.1)
    assert rig.session.results[answered].outcome == "answered"
    assert "2.47" in rig.session.results[answered].reply.replace(",", ".")
    assert rig.speed_mps == pytest.approx(0.3, abs=0.01)


@pytest.mark.parametrize("said", ["go back", "zurück", "fahr zurück"])
def test_the_way_back_of_what_is_driven_is_as_far_as_it_came(rig: UndoRig, said: str) -> None:
    driving(rig)
    rig.session.say(said)
    rig.live(20.0)
    assert rig.x_m == pytest.approx(0.0, abs=0.02)


def test_what_is_driven_afterwards_is_told_at_once(rig: UndoRig) -> None:
    driving(rig)
    later = rig.session.say("and then turn around")
    rig.live(0.1)
    told = [event.reply for event in rig.events if isinstance(event, Interpreted) and event.turn == later]
    assert told == ["After that: turn left 180°."]


@pytest.mark.parametrize(
    "said", ["stop", "stop! there is a child in front", "halt, nicht nach links", "halt, nicht"]
)
def test_a_stop_alone_is_told_in_a_word(rig: UndoRig, said: str) -> None:
    driving(rig)
    assert rig.do(said).reply in ("Stopped.", "Angehalten.")


@pytest.mark.parametrize(
    "said", ["nice", "what are you doing", "turn left", "come back", "bla bla", "yes", "return"]
)
def test_nothing_said_on_the_way_to_a_place_breaks_the_session(said: str) -> None:
    rig = UndoRig("home", options=ASKING)
    driving(rig, "go to the kitchen")
    about = rig.session.say(said)
    rig.live(30.0)
    assert about in rig.session.results


def test_what_is_made_slower_while_paused_tells_its_speed_when_it_goes_on() -> None:
    rig = UndoRig(options=ASKING)
    driving(rig)
    rig.session.pause()
    rig.live(1.0)
    rig.session.say("continue, but slower")
    rig.live(2.0)
    assert "at 0.15 m/s" in rig.do("what's left?").reply


def test_near_the_end_a_change_of_speed_has_something_to_tell(rig: UndoRig) -> None:
    driving(rig, "forward 0.65 m")
    asked = rig.session.say("slower")
    rig.live(0.1)
    assert "Going on: ." not in rig.session.results[asked].reply


def test_a_drive_after_a_wait_is_made_faster(rig: UndoRig) -> None:
    driving(rig, "wait 3 s, then forward 1 m")
    assert rig.do("faster").outcome == "answered"
    rig.live(2.5)
    assert rig.speed_mps == pytest.approx(0.51, abs=0.01)


def test_what_is_said_of_one_part_changes_no_other(rig: UndoRig) -> None:
    driving(rig, "forward 2 m, turn left, forward 1 m")
    rig.session.say("slower only in the turns")
    rig.live(1.0)
    assert rig.speed_mps == pytest.approx(0.3, abs=0.01)


@pytest.mark.parametrize("mode", ["replace", "queue"])
@pytest.mark.parametrize(
    ("order", "said"),
    [
        ("turn left 180 degrees", "don't turn"),
        ("turn left 180 degrees", "not left"),
        ("turn left 180 degrees", "no turning"),
        ("turn left 180 degrees", "dreh dich nicht"),
        ("turn left 180 degrees", "不要转"),
        ("turn left 180 degrees", "not that way!"),
        ("forward 3 m", "wrong direction"),
        ("forward 3 m", "方向错了"),
        ("forward 3 m", "falsche Richtung!"),
        ("forward 3 m", "not forward"),
        ("forward 3 m", "nicht vorwärts"),
        ("forward 1 m, then go to (3, 1)", "not to (3, 1)"),
    ],
)
def test_what_is_forbidden_while_it_is_done_stops(mode: str, order: str, said: str) -> None:
    rig = UndoRig(options=Options(while_moving=mode))
    rig.session.say(order)
    rig.live(1.0)
    turn = rig.session.say(said)
    rig.live(1.0)
    assert not rig.session.is_moving
    assert rig.session.results[turn].outcome == "stopped"


def test_a_forbidden_haste_is_a_slower_speed(rig: UndoRig) -> None:
    turn = driving(rig, "turn left 180 degrees")
    rig.session.say("don't turn so fast")
    rig.live(20.0)
    assert rig.session.results[turn].outcome == "completed"


def test_a_question_about_a_step_that_a_proposal_has_not_keeps_the_session() -> None:
    rig = UndoRig("home")
    rig.session.say("forward 5 m")  # too far there: what is free is proposed
    rig.live(2.0)
    turn = rig.session.say("what was the second step?")
    rig.live(1.0)
    result = rig.session.results[turn]
    assert result.outcome == "unclear"
    assert result.proposal is not None


def test_a_fault_in_reading_one_text_is_told_and_ends_no_session(
    rig: UndoRig, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> None:
        raise KeyError("a table that is not there")

    first = driving(rig)
    with monkeypatch.context() as patched:
        patched.setattr(OfflineInterpreter, "interpret", broken)
        told = rig.session.say("what now?")
        rig.live(1.0)
    assert "KeyError" in rig.session.results[told].reply
    rig.session.say("stop")
    rig.live(1.0)
    assert rig.session.results[first].outcome == "stopped"


@pytest.mark.parametrize("said", ["and after that left 90", "and after that turn left", "and then back home"])
def test_what_is_to_come_after_it_waits_for_its_end(rig: UndoRig, said: str) -> None:
    first = driving(rig, "forward 1 m")
    rig.session.say(said)
    rig.live(20.0)
    assert rig.session.results[first].outcome == "completed"


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("stop and turn left", "turn left 90 deg"),
        ("halt, dreh dich nach links", "turn left 90 deg"),
        ("停，左转", "turn left 90 deg"),
        ("no, stop, back up half a metre", "drive 0.5 m back"),
        ("stop, that's far enough, now turn right 30", "turn right 30 deg"),
    ],
)
def test_an_order_behind_a_stop_is_asked_about_and_done_after_a_yes(
    rig: UndoRig, said: str, plan: str
) -> None:
    first, turn = driving(rig), rig.session.say(said)
    rig.live(2.0)
    stopped = rig.session.results[turn]
    assert (rig.session.results[first].outcome, stopped.outcome) == ("stopped", "stopped")
    assert stopped.proposal is not None
    assert stopped.proposal.plan_text == plan
    assert rig.do("yes").outcome == "completed"


def test_no_stop_waits_for_what_is_asked_behind_it(rig: UndoRig) -> None:
    driving(rig)
    rig.session.say("stop and turn left")
    rig.session.say("stop")
    rig.live(2.0)
    before = rig.pose
    assert rig.do("yes").outcome != "completed"
    assert rig.pose == before


@pytest.mark.parametrize(
    "said",
    [
        "stop",
        "stop, don't turn left",
        "stop, what is that?",
        "stop, the other way",
        "no, stop, only half a metre",
        "stop, undo that",
        "halt, nicht nach links",
        "停，别左转",
        "stop and wait",
    ],
)
def test_what_orders_nothing_behind_a_stop_or_depends_on_how_far_it_came_is_not_asked_about(
    rig: UndoRig, said: str
) -> None:
    driving(rig)
    turn = rig.session.say(said)
    rig.live(2.0)
    assert rig.session.results[turn].outcome == "stopped"
    assert rig.session.results[turn].proposal is None


@pytest.mark.parametrize(
    ("said", "place"),
    [
        ("no wait, I meant the tv", "tv"),
        ("wait, the tv", "tv"),
        ("not the sofa, the tv", "tv"),
        ("no, not the sofa, the desk", "desk"),
        ("warte, in die Küche", "kitchen"),
        ("不是沙发，是电视", "电视"),
        ("停，不去沙发了，去厨房", "厨房"),
    ],
)
def test_another_place_on_the_way_to_one_stops_and_is_asked_about(said: str, place: str) -> None:
    rig = UndoRig("home", options=ASKING)
    driving(rig, "go to the sofa")
    turn = rig.session.say(said)
    rig.live(2.0)
    assert not rig.session.is_moving
    proposal = rig.session.results[turn].proposal
    assert proposal is not None
    assert f'named "{place}"' in proposal.plan_text.casefold()


@pytest.mark.parametrize("said", ["go", "go!", "go go go", "los", "fahr los", "走吧", "come on"])
def test_go_lets_go_on_what_is_driven(rig: UndoRig, said: str) -> None:
    first = driving(rig)
    assert rig.do(said).outcome == "answered"
    rig.live(20.0)
    assert rig.session.results[first].outcome == "completed"
    assert rig.x_m == pytest.approx(3.0, abs=0.02)


@pytest.mark.parametrize(
    "said",
    [
        "turn right when you get there",
        "when you're done, turn right",
        "also turn right once you're there",
        "dreh dich nach rechts, wenn du da bist",
        "到了以后右转",
    ],
)
def test_what_is_to_be_done_there_waits_for_the_end(rig: UndoRig, said: str) -> None:
    first, turn = driving(rig), rig.session.say(said)
    rig.live(30.0)
    assert rig.session.results[first].outcome == "completed"
    assert rig.session.results[turn].outcome == "completed"
    assert rig.x_m == pytest.approx(3.0, abs=0.02)


@pytest.mark.parametrize("said", ["how much longer?", "how far to go?", "wie weit noch?", "还有多远"])
def test_the_metres_and_seconds_to_go_are_told(rig: UndoRig, said: str) -> None:
    def told() -> tuple[float, float]:
        reply = rig.do(said).reply.replace(",", ".")
        return tuple(float(re.findall(rf"([\d.]+) {unit}", reply)[0]) for unit in ("(?:m|米)", "(?:s|秒)"))

    driving(rig)
    at_m = rig.x_m
    assert told() == (pytest.approx(3.0 - at_m, abs=0.03), pytest.approx((3.0 - at_m) / 0.3, abs=1.5))
    rig.session.say("slower")
    rig.live(1.0)
    at_m = rig.x_m
    assert told() == (pytest.approx(3.0 - at_m, abs=0.03), pytest.approx((3.0 - at_m) / 0.15, abs=1.5))


@pytest.mark.parametrize(
    ("orders", "said"),
    [
        (("go to the kitchen", "and then to the fridge"), "oh no, leave out the fridge"),
        (("go to the kitchen", "and then to the fridge"), "not to the fridge"),
        (("Fahr in die Küche", "und danach zum Kühlschrank"), "ach ne, lass den Kühlschrank weg"),
        (("去厨房", "然后去冰箱"), "冰箱就不去了"),
        (("go to the kitchen", "then turn around"), "forget about turning around"),
        (("zum Tisch bitte", "dann drehst du dich um"), "lass das mit dem Umdrehen"),
        (("去厨房", "然后转一圈"), "不用转圈了"),
    ],
)
def test_what_waits_is_dropped_by_its_place_or_its_turn_and_the_rest_goes_on(
    orders: tuple[str, str], said: str
) -> None:
    rig = UndoRig("home", options=ASKING)
    first = rig.session.say(orders[0])
    rig.live(1.0)
    second = rig.session.say(orders[1])
    rig.live(0.5)
    rig.session.say(said)
    rig.live(60.0)
    assert rig.session.results[first].outcome == "completed"
    assert rig.session.results[second].outcome == "stopped"


@pytest.mark.parametrize("said", ["skip the kitchen", "not to the kitchen", "不去厨房了"])
def test_the_way_to_a_place_that_is_dropped_under_way_is_stopped(said: str) -> None:
    rig = UndoRig("home", options=ASKING)
    driving(rig, "go to the kitchen")
    rig.do(said)
    assert not rig.session.is_moving


@pytest.mark.parametrize("said", ["faster again", "ok, faster again", "wieder schneller"])
def test_the_speed_changes_again(rig: UndoRig, said: str) -> None:
    driving(rig, "forward 3 m at 0.1 m/s")
    rig.session.say(said)
    rig.live(1.0)
    assert rig.speed_mps == pytest.approx(0.17, abs=0.01)


@pytest.mark.parametrize(
    "said", ["and at the sofa turn around", "when at the sofa, turn around", "und am Sofa drehst du dich um"]
)
def test_what_is_to_be_done_at_the_place_that_is_driven_to_comes_after_it(said: str) -> None:
    rig = UndoRig("home", options=ASKING)
    first = driving(rig, "go to the sofa")
    then = rig.session.say(said)
    rig.live(30.0)
    assert rig.session.results[first].outcome == "completed"
    assert rig.session.results[then].turned_rad == pytest.approx(3.14, abs=0.05)
