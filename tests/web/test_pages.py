"""What pages say and are told: one steers, the others watch, all hear the same."""

from __future__ import annotations

import pytest

from chatrobot.core.events import FindingSeen, Interpreted, Limited, Notice, Rehearsed, Result, Telemetry
from chatrobot.core.geometry import ORIGIN, Twist
from chatrobot.core.reason import Reason
from tests.processes import wait_until
from tests.web.rig import WebRig

RESULT = Result(1, "completed", "Done: drove 0.50 m of 0.50 m.")


def test_the_first_page_steers_and_the_next_watches(rig: WebRig) -> None:
    first, second = rig.page(), rig.page()
    assert first.wait_for("steering")["you"]
    told = second.wait_for("steering")
    assert not told["you"]
    assert "say" not in told["may"]
    assert {"stop", "emergency_stop", "take"} <= set(told["may"])


def test_what_the_steering_page_says_reaches_the_session_and_everybody(rig: WebRig) -> None:
    first, second = rig.page(), rig.page()
    first.say("say", text="forward 1 m")
    rig.session.wait_for("say", "forward 1 m")
    for page in (first, second):
        assert page.wait_for("said") == {
            "is": "said", "turn": 1, "text": "forward 1 m", "by": "page-" + page.heard[-1]["by"][5:],
            "name": page.heard[-1]["name"],
        }  # fmt: skip


@pytest.mark.parametrize(
    ("do", "fields"),
    [
        ("say", {"text": "forward 1 m"}),
        ("say_plan", {"plan_text": "drive 1 m"}),
        ("approve", {"turn": 1, "yes": True}),
        ("edit", {"plan_text": "drive 1 m", "turn": 1}),
        ("go", {"x_m": 1, "y_m": 0}),
        ("steer", {"vx_mps": 0.2, "vy_mps": 0, "wz_radps": 0}),
        ("pause", {}),
        ("resume", {}),
        ("run_program", {"name": "square"}),
        ("edit_program", {"name": "square", "source": "pass"}),
        ("give", {}),
    ],
)
def test_who_watches_cannot_make_the_robot_do_anything(
    rig: WebRig, do: str, fields: dict[str, object]
) -> None:
    rig.page()
    watcher = rig.page()
    watcher.say(do, **fields)
    assert watcher.wait_for("refused", do=do)["why"] == "not_steering"
    assert rig.session.log == []


def test_who_watches_can_stop(rig: WebRig) -> None:
    rig.page()
    watcher = rig.page()
    watcher.say("stop")
    rig.session.wait_for("stop", "the Stop button")
    watcher.say("emergency_stop")
    rig.session.wait_for("emergency_stop", "the Emergency stop button")
    assert watcher.wait_for("emergency")["set"]


def test_taking_over_is_told_to_both_and_lets_go_of_the_stick(rig: WebRig) -> None:
    first, second = rig.page(), rig.page()
    first.say("steer", vx_mps=0.2, vy_mps=0.0, wz_radps=0.0)
    rig.session.wait_for("steer", 0.2, 0.0, 0.0)
    second.say("take")
    rig.session.wait_for("steer", 0.0, 0.0, 0.0)
    told = second.wait_for("steering", you=True)
    assert first.wait_for("steering", by=told["by"])["you"] is False
    second.say("say", text="turn left")
    rig.session.wait_for("say", "turn left")
    first.say("say", text="turn right")
    assert first.wait_for("refused")["why"] == "not_steering"


def test_a_steering_page_that_lets_go_leaves_the_robot_to_nobody(rig: WebRig) -> None:
    first, second = rig.page(), rig.page()
    first.say("give")
    second.wait_for("steering", by=None)
    second.say("say", text="forward 1 m")
    assert second.wait_for("refused")["why"] == "nobody_steers"


def test_a_page_that_comes_later_is_told_what_was_said_and_what_happened(rig: WebRig) -> None:
    first = rig.page()
    first.say("say", text="forward 0.5 m")
    first.wait_for("said")
    rig.tell(Interpreted(1, "offline", "drive 0.5 m", "drive forward 0.5 m"))
    rig.tell(Telemetry(0, ORIGIN, Twist(), 0.0))
    rig.tell(RESULT)
    later = rig.page()
    kinds = [told.get("event", {}).get("event", told["is"]) for told in later.heard[0]["history"]]
    assert kinds == ["said", "interpreted", "result"]


def test_history_is_bounded(rig: WebRig) -> None:
    for turn in range(500):
        rig.tell(Interpreted(turn, "offline", "", str(turn)))
    history = rig.page().heard[0]["history"]
    assert len(history) == 200
    assert history[-1]["event"]["turn"] == 499


def test_codes_come_with_a_sentence_in_the_language_of_the_page(rig: WebRig) -> None:
    page = rig.page()
    page.say("language", code="zh")
    page.say("history")
    page.wait_for("history")
    rig.tell(Notice(0, Reason("released", {"source": "console"})))
    assert "急停" in page.wait_for_event("notice")["text"]
    finding = FindingSeen(1, "refuse", Reason("emergency_stop", {"source": "console"}))
    rig.tell(Rehearsed(1, False, 1.0, 1.0, ORIGIN, (finding,)))
    assert len(page.wait_for_event("rehearsed")["text"]) == 1
    rig.tell(Limited(1, "limits", Twist(2.0), Twist(1.0)))
    assert "1.00" in page.wait_for_event("limited")["text"]


@pytest.mark.parametrize("text", ["please release the emergency stop", "解除急停"])
def test_a_release_is_typed_where_its_button_is_and_is_no_sentence_for_the_robot(
    rig: WebRig, text: str
) -> None:
    page = rig.page()
    page.say("emergency_stop")
    page.wait_for("emergency", set=True)
    page.say("say", text=text)
    assert page.wait_for("said")["text"] == text
    rig.session.wait_for("release")
    rig.tell(Notice(0, Reason("released", {"source": "console"})))
    page.wait_for("emergency", set=False)
    assert "say" not in [noted[0] for noted in rig.session.log]


def test_a_browser_says_its_language(rig: WebRig) -> None:
    page = rig.page(additional_headers={"Accept-Language": "zh-CN,zh;q=0.9"})
    page.say("say", text="x" * 10, other=1)
    assert "无法理解" in page.wait_for("refused")["text"]


def test_a_tap_on_the_floor_is_a_plan_that_is_asked_about(rig: WebRig) -> None:
    page = rig.page()
    page.say("go", x_m=1.25, y_m=-0.5)
    rig.session.wait_for("say_edited_plan", "go to 1.25 -0.5", "")
    page.say("go", x_m=1, y_m=0, yaw_rad=1.5707963267948966)
    rig.session.wait_for("say_edited_plan", "go to 1 0 facing 90 deg", "")
    page.say("go", x_m=0, y_m=0, ask=False)
    rig.session.wait_for("say_plan", "go to 0 0")


def test_an_answer_counts_for_the_plan_that_waits_and_no_other(rig: WebRig) -> None:
    page = rig.page()
    rig.tell(Interpreted(3, "offline", "drive 1 m", ""))
    rig.tell(Rehearsed(3, True, 1.0, 1.0, ORIGIN, needs_approval=True))
    page.say("approve", turn=2, yes=True)
    assert page.wait_for("refused")["why"] == "question_over"
    page.say("approve", turn=3, yes=True)
    rig.session.wait_for("approve", 3, True)
    page.say("approve", turn=3, yes=True)
    assert page.wait_for("refused")["why"] == "question_over"


def test_an_edited_plan_takes_the_place_of_the_one_that_waits(rig: WebRig) -> None:
    page = rig.page()
    rig.tell(Interpreted(3, "offline", "drive 1 m", ""))
    rig.tell(Rehearsed(3, True, 1.0, 1.0, ORIGIN, needs_approval=True))
    page.say("edit", turn=3, plan_text="drive 0.5 m")
    rig.session.wait_for("say_edited_plan", "drive 0.5 m", "drive 1 m")
    assert rig.session.log[0] == ("approve", 3, False, "edited")


def test_a_person_at_this_machine_releases_an_emergency_stop(rig: WebRig) -> None:
    page = rig.page()
    page.say("emergency_stop")
    page.say("release")
    rig.session.wait_for("release")
    rig.tell(Notice(0, Reason("released", {"source": "console"})))
    assert page.wait_for("emergency", set=False)
    assert rig.room.is_latched is False


def test_an_alarm_after_the_release_was_asked_for_holds(rig: WebRig) -> None:
    page = rig.page()
    page.say("emergency_stop")
    page.say("release")
    page.say("emergency_stop")
    wait_until(lambda: len(rig.session.log) == 3)
    rig.tell(Notice(0, Reason("released", {"source": "console"})))
    assert rig.page().heard[0]["emergency"] is True


def test_a_refused_plan_shows_an_alarm_that_somebody_else_raised(rig: WebRig) -> None:
    reason = Reason("emergency_stop", {"source": "joystick"})
    rig.tell(Result(1, "refused", "The emergency stop is set.", reason=reason))
    assert rig.page().heard[0]["emergency"] is True


def test_motion_that_is_gone_is_told(rig: WebRig) -> None:
    page = rig.page()
    rig.session.is_lost = True
    page.say("say", text="forward 1 m")
    assert page.wait_for("gone")["what"] == "motion"


def test_scans_are_asked_for_only_while_somebody_looks(rig: WebRig) -> None:
    page = rig.page()
    assert rig.session.is_watched
    page.socket.close()
    wait_until(lambda: not rig.session.is_watched)


def test_pages_of_one_robot_hear_nothing_of_another() -> None:
    from tests.web.rig import serving

    with serving(rooms=("a", "b")) as rig:
        one, other = rig.page("/ws?room=a"), rig.page("/ws?room=b")
        one.say("say", text="forward 1 m")
        one.wait_for("said")
        rig.rooms["b"].hear(RESULT)
        other.wait_for_event("result")
        assert not [told for told in other.heard if told["is"] == "said"]
        assert rig.sessions["b"].log == []
