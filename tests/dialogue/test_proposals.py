"""A question that offers a plan carries it: a yes as the very next text runs it, and nothing else does."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from rich.console import Console
from tests.dialogue.talk import Talk

from chatrobot.cli.console import lines
from chatrobot.cli.console.words import Words
from chatrobot.cli.narrator import Narrator
from chatrobot.core.event import Proposal
from chatrobot.core.events import Interpreted, Rehearsed, Result, Telemetry, event_from_json
from chatrobot.dialogue import question
from chatrobot.dialogue.options import Options
from chatrobot.dialogue.utterances import Utterance

ASKING = "go to the kichen"


def asked(**setup: object) -> Talk:
    """A session that has just asked whether the kitchen was meant."""
    talk = Talk(world="home", **setup)
    result = talk.session.do(ASKING)
    assert (result.outcome, result.path_m) == ("unclear", 0.0)
    return talk


def test_the_question_comes_with_the_plan_that_it_offers() -> None:
    result = asked().session.results[1]
    assert result.proposal == Proposal('go to 4 0.7 named "kitchen"', "Did you mean kitchen?")
    assert result.reply.endswith(result.proposal.say)
    line = json.loads(json.dumps(result.to_json()))
    assert line["proposal"] == {"plan_text": 'go to 4 0.7 named "kitchen"', "say": "Did you mean kitchen?"}
    assert event_from_json(line) == result


def test_a_result_that_offers_nothing_says_so() -> None:
    assert Talk().session.do("forward 10 cm").to_json()["proposal"] is None


@pytest.mark.parametrize("word", ["y", "Yes, do it!", "好的"])
def test_a_yes_runs_the_plan(word: str) -> None:
    talk = asked()
    result = talk.session.do(word)
    assert result.outcome == "completed"
    assert result.pose.distance_to(talk.connection.world.places["kitchen"]) < 0.05
    heard = [event for event in talk.events if event.turn == 2]
    assert [event.plan_text for event in heard if isinstance(event, Interpreted)] == [
        'go to 4 0.7 named "kitchen"'
    ]
    assert any(isinstance(event, Rehearsed) for event in heard)


@pytest.mark.parametrize("word", ["Go!", "ok, now", "开始"])
def test_go_starts_what_was_held_back(word: str) -> None:
    talk = Talk()
    assert talk.session.do("forward 30 cm, but don't do it yet").path_m == 0.0
    result = talk.session.do(word)
    assert (result.outcome, round(result.path_m, 2)) == ("completed", 0.3)


def test_go_starts_what_was_held_back_as_it_was_changed_and_not_after_a_stop() -> None:
    talk = Talk()
    for text in ("forward 30 cm, but don't do it yet", "make it 20", "what's the plan?"):
        assert talk.session.do(text).path_m == 0.0
    assert round(talk.session.do("go").path_m, 2) == 0.2
    for text in ("forward 30 cm, but don't do it yet", "stop", "make it 20", "go"):
        assert talk.session.do(text).path_m == 0.0


def test_go_after_a_change_that_was_not_understood_drives_nothing() -> None:
    talk = Talk()
    for text in ("forward 30 cm when I tell you to", "the frobnicator first", "go"):
        assert talk.session.do(text).path_m == 0.0


def test_what_was_done_is_told_as_it_was_measured() -> None:
    talk = Talk()
    talk.session.do("forward 30 cm")
    talk.session.do("mumble the fnord")
    assert "drove 0.30 m" in talk.session.do("what did you just do?").reply


def test_a_yes_is_approved_where_approval_is_asked() -> None:
    talk = asked(options=Options(approve=True))
    turn = talk.session.say("yes")
    talk.pump_until(lambda: any(isinstance(e, Rehearsed) and e.needs_approval for e in talk.events))
    talk.session.approve(turn, False)
    talk.pump_until(lambda: turn in talk.results())
    assert (talk.results()[turn].outcome, talk.results()[turn].path_m) == ("refused", 0.0)


@pytest.mark.parametrize(
    ("answer", "plan"),
    [
        ("sure, but slowly", "drive 0.5 m at 0.15 m/s"),
        ("Yes, slowly please", "drive 0.5 m at 0.15 m/s"),
        ("go ahead at 0.1 m/s", "drive 0.5 m at 0.1 m/s"),
        ("好的，慢一点", "drive 0.5 m at 0.15 m/s"),
    ],
)
def test_a_yes_may_say_how_fast(answer: str, plan: str) -> None:
    talk = Talk()
    assert talk.session.do("forward 50").proposal is not None
    result = talk.session.do(answer)
    assert result.outcome == "completed"
    plans = [event.plan_text for event in talk.events if isinstance(event, Interpreted) and event.turn == 2]
    assert plans == [plan]
    talk.session.do("forward 10 cm")
    assert [e.plan_text for e in talk.events if isinstance(e, Interpreted)][-1] == "drive 0.1 m"


@pytest.mark.parametrize("answer", ["好慢", "sure, slowly?", "yes, but quietly", "sure, but turn left first"])
def test_what_says_more_than_yes_and_how_fast_runs_no_offer(answer: str) -> None:
    talk = Talk()
    talk.session.do("forward 50")
    assert talk.session.do(answer).path_m == 0.0


@pytest.mark.parametrize("word", ["no", "n", "No, thanks.", "不用了"])
def test_a_no_drops_it(word: str) -> None:
    talk = asked()
    dropped = talk.session.do(word)
    assert (dropped.outcome, dropped.proposal) == ("answered", None)
    assert talk.session.do("yes").outcome == "unclear"


@pytest.mark.parametrize(
    ("between", "outcome"),
    [
        ("where are you?", "answered"),
        ("forward 2 cm", "completed"),
        ("stop", "stopped"),
        ("hrmpf", "unclear"),
    ],
)
def test_anything_else_is_understood_and_drops_it(between: str, outcome: str) -> None:
    talk = asked()
    assert talk.session.do(between).outcome == outcome
    assert talk.session.do("yes").outcome != "completed"


def test_a_stop_button_drops_it() -> None:
    talk = asked()
    talk.session.stop("button")
    assert talk.session.do("yes").outcome == "unclear"


def test_a_plan_given_as_such_drops_it() -> None:
    talk = asked()
    talk.session.say_plan("drive 0.02 m")
    talk.session.say("yes")
    talk.pump_until(lambda: len(talk.results()) == 3)
    assert talk.results()[3].outcome == "unclear"


def test_a_robot_that_was_moved_has_to_be_asked_again(monkeypatch: pytest.MonkeyPatch) -> None:
    talk = asked()
    elsewhere = talk.session.understanding.pose._replace(x_m=0.2)
    monkeypatch.setattr(type(talk.session.understanding), "pose", elsewhere)
    late = talk.session.do("yes")
    assert (late.outcome, late.path_m) == ("refused", 0.0)
    assert "moved" in late.reply


def test_a_yes_that_comes_late_has_to_be_said_again(monkeypatch: pytest.MonkeyPatch) -> None:
    talk = asked()
    began_s = question.time.monotonic()
    monkeypatch.setattr("chatrobot.dialogue.utterances.time.monotonic", lambda: began_s + 31.0)
    late = talk.session.do("yes")
    assert (late.outcome, late.path_m) == ("refused", 0.0)


def test_every_proposal_that_is_shown_asks_for_a_yes_or_a_no() -> None:
    result = asked().session.results[1]
    assert shown(result).endswith("Did you mean kitchen? y/n")
    assert "y/n" not in shown(Result(1, "unclear", "What?"))


def shown(result: Result) -> str:
    """What the console prints of it."""
    console = Console(width=200)
    with console.capture() as capture:
        console.print(*map(lines.shown, Narrator(Words("en")).tell(result)))
    return capture.get().strip()


def test_a_way_that_is_blocked_is_offered_as_far_as_it_is_free() -> None:
    talk = Talk(world="home")
    blocked = talk.session.do("forward 10 m")
    assert (blocked.outcome, blocked.path_m) == ("refused", 0.0)
    assert blocked.proposal == Proposal("drive 2.65 m", "Shall I drive forward 2.65 m?")
    assert blocked.reply.endswith("so I do not drive that. 2.65 m are free. Shall I drive forward 2.65 m?")
    done = talk.session.do("yes")
    assert done.outcome == "completed"
    assert done.path_m == pytest.approx(2.65, abs=0.01)
    assert talk.session.do("forward 1 m").proposal is None, "nothing useful is free"


def test_what_is_only_rehearsed_says_what_is_free_and_asks_nothing() -> None:
    talk = Talk(world="home", options=Options(rehearse_only=True))
    blocked = talk.session.do("前进十米")
    assert blocked.proposal is None
    assert blocked.reply.endswith("前面 2.65 米是空的。")


TABLE = """
name: shop
obstacles:
  - {name: table, rectangle: {x_m: 2.0, y_m: 0.0, length_m: 0.6, width_m: 0.6}}
places:
  - {name: table, aliases: [桌子], x_m: 2.0, y_m: 0.0}
"""


def test_a_place_inside_an_obstacle_is_not_called_reached(tmp_path: Path) -> None:
    file = tmp_path / "shop.yaml"
    file.write_text(TABLE)
    talk = Talk(world=str(file))
    blocked = talk.session.do("forward 20 cm, then go to the table")
    assert (blocked.outcome, blocked.path_m) == ("refused", 0.0)
    assert blocked.reply.startswith("There, the table is in the way:")
    assert "I can get as near as 0.55 m." in blocked.reply
    assert blocked.proposal is not None
    assert blocked.proposal.plan_text == "drive 0.2 m\ngo to 1.45 0"
    done = talk.session.do("go ahead")
    assert (done.outcome, done.pose.x_m) == ("completed", pytest.approx(1.45, abs=0.02))
    assert talk.session.do("去桌子").reply.startswith("那里被“table”挡住")


def test_what_is_said_behind_a_text_that_is_asked_about_waits_for_the_question() -> None:
    talk = Talk()
    for text in ("make a square with 20 cm sides to the left", "clockwise", "yes", "with 30 cm sides"):
        talk.session.say(text)
    talk.pump_until(lambda: len(talk.results()) == 4)
    turns = [event.turn for event in talk.events if isinstance(event, Interpreted)]
    assert turns == [1, 2, 3, 4]
    assert [round(talk.results()[turn].path_m, 1) for turn in turns] == [0.8, 0.0, 0.8, 1.2]


def test_what_nobody_understands_is_answered_before_its_turn() -> None:
    talk = Talk()
    for text in ("make a square with 20 cm sides", "with 30 cm sides", "flurb the gizmo"):
        talk.session.say(text)
    talk.pump_until(lambda: len(talk.results()) == 3)
    assert [event.turn for event in talk.events if isinstance(event, Result)] == [3, 1, 2]


def plan_of_last(talk: Talk) -> str:
    return [event.plan_text for event in talk.events if isinstance(event, Interpreted)][-1]


OFFERED = "turn left 90 and then zorblax 50 cm forward"


@pytest.mark.parametrize(
    ("answer", "plan"),
    [
        ("yes, but 1 m", "turn left 90 deg\ndrive 1 m"),
        ("yes, but turn right", "turn right 90 deg\ndrive 0.5 m"),
        ("sure, and then back 20 cm", "turn left 90 deg\ndrive 0.5 m\ndrive 0.2 m back"),
        ("好，一米", "turn left 90 deg\ndrive 1 m"),
    ],
)
def test_a_yes_with_a_change_runs_the_plan_with_it(answer: str, plan: str) -> None:
    talk = Talk()
    assert talk.session.do(OFFERED).proposal is not None
    assert talk.session.do(answer).outcome == "completed"
    assert plan_of_last(talk) == plan


@pytest.mark.parametrize("answer", ["no, 20 cm", "sorry, I meant 20 cm", "make it 20 cm", "不对，二十厘米"])
def test_what_was_refused_is_done_as_it_is_said_otherwise(answer: str) -> None:
    talk = Talk()
    assert talk.session.do("forward 300 m").outcome == "refused"
    assert talk.session.do(answer).outcome == "completed"
    assert plan_of_last(talk) == "drive 0.2 m"


def test_what_was_refused_is_forgotten_after_the_next_turn() -> None:
    talk = Talk()
    talk.session.do("forward 300 m")
    talk.session.do("thanks")
    assert talk.session.do("no, 20 cm").path_m == 0.0


@pytest.mark.parametrize(
    ("answer", "plan"),
    [
        ("no, right", "turn right 90 deg\ndrive 0.5 m"),
        ("without the turn", "drive 0.5 m"),
        ("make it 20 cm", "turn left 90 deg\ndrive 0.2 m"),
    ],
)
def test_a_change_without_a_yes_is_asked_about_with_the_whole_plan(answer: str, plan: str) -> None:
    talk = Talk()
    talk.session.do(OFFERED)
    result = talk.session.do(answer)
    assert result.path_m == 0.0
    assert result.proposal is not None
    assert result.proposal.plan_text == plan


@pytest.mark.parametrize(
    ("order", "plan"),
    [
        ("ok, 20 cm back", "drive 0.2 m back"),
        ("ok, turn right", "turn right 90 deg"),
        ("ok, slide left 20 cm", "drive 0.2 m left"),
    ],
)
def test_an_order_of_its_own_is_no_change_of_what_was_offered(order: str, plan: str) -> None:
    talk = Talk()
    talk.session.do(OFFERED)
    talk.session.do(order)
    assert plan_of_last(talk) == plan


def test_the_side_of_a_shape_that_was_offered_turns_all_of_it() -> None:
    talk = Talk()
    talk.session.do("draw a square")
    talk.session.do("sides 60 cm")
    result = talk.session.do("to the right")
    assert result.proposal is not None
    assert result.proposal.plan_text == "\n".join(["drive 0.6 m", "turn right 90 deg"] * 4)


def test_a_yes_counts_though_the_question_came_before_the_first_odometry(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    talk = asked()
    understanding, offer = talk.session.understanding, talk.results()[1]
    here = understanding.pose
    monkeypatch.setattr(type(understanding), "known_pose", None)
    talk.session._proposals.hear(replace(offer, pose=here._replace(x_m=5.5)))
    monkeypatch.setattr(type(understanding), "known_pose", here)
    talk.session._proposals.hear(next(event for event in talk.events if isinstance(event, Telemetry)))
    assert talk.session.do("yes").outcome == "completed"


@pytest.mark.parametrize("between", ["slower", "go to the gardn", "fly to the moon"])
def test_a_yes_is_none_to_a_plan_that_was_asked_about_before_the_last_question(between: str) -> None:
    talk = Talk(world="home", options=Options(approve=True))
    turn = talk.session.say("drive forward 50 cm")
    talk.pump_until(lambda: any(isinstance(e, Rehearsed) and e.needs_approval for e in talk.events))
    talk.session.do(between)
    assert talk.session.see_through(turn).outcome == "refused"
    talk.session.approve(turn, True)
    assert talk.results()[turn].path_m == 0.0


@pytest.mark.parametrize(("answer", "path_m"), [("yes", 0.5), ("okay, go", 0.5), ("ja", 0.5), ("好的", 0.5)])
def test_a_typed_yes_or_go_answers_the_plan_that_waits(answer: str, path_m: float) -> None:
    talk = Talk(world="home", options=Options(approve=True))
    turn = talk.session.say("drive forward 50 cm")
    talk.pump_until(lambda: any(isinstance(e, Rehearsed) and e.needs_approval for e in talk.events))
    assert talk.session.do(answer).outcome == "answered"
    assert talk.session.see_through(turn).path_m == pytest.approx(path_m, abs=0.02)
    assert len([event for event in talk.events if isinstance(event, Rehearsed)]) == 1


def test_a_yes_that_was_said_before_the_question_is_no_answer_to_it() -> None:
    talk = Talk(world="home", options=Options(approve=True))
    turn = talk.session.say("drive forward 50 cm")
    talk.session.say("yes")
    talk.pump_until(lambda: 2 in talk.results())
    assert "came before the plan was shown" in talk.results()[2].reply
    assert talk.session.do("yes").outcome == "answered"
    assert talk.session.see_through(turn).outcome == "completed"


def test_only_what_was_said_after_the_question_answers_it_out_of_turn() -> None:
    talk = Talk(world="home", options=Options(approve=True))
    talk.session.say("drive forward 50 cm")
    before_s = question.time.monotonic()
    talk.pump_until(lambda: any(isinstance(e, Rehearsed) and e.needs_approval for e in talk.events))
    awaits = talk.session._proposals.awaits
    assert not awaits(Utterance(3, "yes", "text", before_s))
    assert awaits(Utterance(3, "yes", "text", question.time.monotonic()))
