"""What is told of a pause: all that is left, what waits behind it, and why it is not done where it is not."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from tests.dialogue.talk import Talk, said_while_moving
from tests.link.link_rigs import SimulatedRig, events_until, finished, send_plan
from tests.motion.test_pause import pause, run_s
from tests.motion.test_stream import wait_s

from chatrobot.core.events import Event, Finished, Interpreted, Notice, Paused, Progress
from chatrobot.core.events import event_from_json as read
from chatrobot.dialogue.options import Options
from chatrobot.motion import pausing

WAITS = "turn left 90 degrees"


def paused_before(text: str = WAITS) -> Talk:
    """A metre is paused, and `text` waits behind it."""
    talk = Talk()
    talk.session.say("forward 1 m")
    talk.session.say(text)
    pause(talk)
    run_s(talk, 1.0)
    return talk


def test_what_waits_behind_a_pause_is_named_with_what_is_left() -> None:
    talk = paused_before()
    told = next(event for event in talk.events if isinstance(event, Paused))
    assert told.waiting == (WAITS,)
    again = read(told.to_json())
    assert isinstance(again, Paused)
    assert again.waiting == told.waiting
    assert f"waiting: “{WAITS}”" in talk.results()[3].reply
    talk.session.say("暂停")
    run_s(talk, 0.5)
    assert f"还在排队：“{WAITS}”" in talk.results()[4].reply


def test_what_was_said_to_come_after_it_is_named_too() -> None:
    talk = Talk(options=Options(while_moving="replace"))
    talk.session.say("forward 1 m")
    pause(talk)
    talk.session.say("then turn left 90 degrees")
    run_s(talk, 0.5)
    assert "turn left" not in talk.results()[2].reply
    assert [e.reason.code for e in talk.events if isinstance(e, Notice)] == ["waits_behind_pause"]
    assert "waiting: “then turn left 90 degrees”" in talk.session.do("pause").reply


@pytest.mark.parametrize(
    ("word", "code", "why"),
    [("stop", "stopped_by", "you said “stop”"), ("back 20 cm", "replaced", "new instruction")],
)
def test_what_waited_behind_a_pause_says_why_it_is_not_done(word: str, code: str, why: str) -> None:
    talk = paused_before()
    talk.session.say(word)
    talk.pump_until(lambda: 2 in talk.results())
    dropped = talk.results()[2]
    assert dropped.outcome == "stopped"
    assert dropped.reply == f"“{WAITS}” was waiting behind the pause and is not done ({why})."
    assert dropped.reason is not None
    assert dropped.reason.code == code


def test_a_pause_lapses_after_ten_minutes_and_says_so_for_what_waited_behind_it_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert pausing.KEPT_S == 600.0
    monkeypatch.setattr(pausing, "KEPT_S", 60.0)  # thirty thousand ticks would show no more
    talk = paused_before()
    run_s(talk, 55.0)
    assert talk.session.is_paused
    run_s(talk, 10.0)
    assert talk.results()[1].outcome == "stopped"
    assert talk.results()[1].reason is not None
    assert talk.results()[1].reason.code == "pause_too_long"
    assert "paused for more than 60 s" in talk.results()[2].reply


def test_what_a_new_instruction_dropped_never_comes_back_with_a_later_pause() -> None:
    talk = paused_before()
    before = len([event for event in talk.events if isinstance(event, Paused)])
    talk.session.say("back 50 cm")
    run_s(talk, 1.0)
    talk.session.say("pause")
    talk.pump_until(lambda: len([e for e in talk.events if isinstance(e, Paused)]) > before)
    talk.session.say("continue")
    run_s(talk, 8.0)
    assert talk.results()[2].outcome == "stopped"
    assert abs(talk.results()[4].pose.yaw_rad) < 0.01


@pytest.mark.parametrize(("question", "word"), [("what are you doing?", "Paused"), ("你在干什么", "已暂停")])
def test_what_are_you_doing_is_answered_with_the_pause(question: str, word: str) -> None:
    talk = Talk()
    talk.session.say("forward 1 m")
    pause(talk)
    answer = talk.session.do(question)
    assert answer.outcome == "answered"
    assert answer.reply.startswith(word)
    assert talk.session.is_paused


def test_what_are_you_doing_names_the_motion_that_runs_and_what_is_left() -> None:
    talk = Talk(options=Options(while_moving="replace"))
    talk.session.say("forward 2 m, then turn left 90 degrees")
    run_s(talk, 4.0)
    reply = talk.session.do("what are you doing?").reply
    told = re.fullmatch(
        r"Under way: drive forward 2 m, now at 0\.\d\d m/s\. Still to do: drive forward ([\d.]+) m, turn left 90°\.",
        reply,
    )
    assert told is not None, reply
    assert 0.6 < float(told[1]) < 1.2


# --- keep going ---


@pytest.mark.parametrize("before", ["turn left", "go forward 20 cm, then turn right", ""])
@pytest.mark.parametrize("word", ["keep going", "carry on", "继续走"])
def test_keep_going_asks_where_the_last_motion_was_no_drive(before: str, word: str) -> None:
    talk = Talk()
    if before:
        talk.session.do(before)
    asked = talk.session.do(word)
    assert (asked.outcome, asked.path_m) == ("unclear", 0.0)


def test_keep_going_goes_on_the_way_the_last_drive_went() -> None:
    talk = Talk()
    talk.session.do("back 30 cm")
    assert talk.session.do("keep going").pose.x_m == pytest.approx(-0.8, abs=0.01)
    assert [event.reply for event in talk.events if isinstance(event, Interpreted)][
        -1
    ] == "drive backward 0.5 m"


def test_keep_going_while_it_moves_changes_nothing() -> None:
    talk = said_while_moving("forward 1 m", "keep going")
    assert talk.results()[2].outcome == "answered"
    assert talk.results()[1].path_m == pytest.approx(1.0, abs=0.01)


# --- what cannot be kept ---


def test_a_pause_with_nothing_left_but_steps_to_come_says_that_it_ended(tmp_path: Path) -> None:
    rig = SimulatedRig(tmp_path)
    send_plan(rig, 1, "drive 0.3 m", "queue", more=True)
    events_until(rig, lambda event: isinstance(event, Progress) and event.pose.x_m > 0.2)
    wait_s(rig, 4.0)
    rig.link.send("stop", why="pause", keep=True)
    end = finished(rig, 1)
    assert end.outcome == "stopped"
    assert end.reason is not None
    assert end.reason.code == "nothing_to_keep"
    assert end.path_m == pytest.approx(0.3, abs=0.01)
    rig.close()


def test_a_pause_of_a_robot_that_measures_nothing_says_that_it_was_stopped() -> None:
    from dataclasses import replace

    from tests.dialogue.undo_rig import UndoRig

    from chatrobot.robots.load import load_profile
    from chatrobot.robots.open_loop import driven_open_loop

    profile = load_profile("wheeltec_mini_mec")
    blind = driven_open_loop(
        replace(
            profile,
            wiring=replace(profile.wiring, odom_topic=""),
            safety=replace(profile.safety, requires=()),
        )
    )
    rig = UndoRig(profile=blind)
    rig.session.say("forward 1 m")
    rig.live(1.0)
    rig.session.say("pause")
    rig.live(2.0)
    ends: list[Event] = [event for event in rig.events if isinstance(event, Finished)]
    assert [end.reason.code for end in ends] == ["pause_unmeasured"]  # type: ignore[attr-defined]
