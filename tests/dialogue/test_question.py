"""Who is asked before a model's plan moves a real robot, what answers, and what needs no question."""

from __future__ import annotations

import pytest
from tests.dialogue.scripted_model import ModelTalk, Options

from chatrobot.core.events import Event, Finished, Paused, Progress, Rehearsed, Started
from chatrobot.core.geometry import ORIGIN
from chatrobot.dialogue.question import Question
from chatrobot.language.consent import read_consent, wants_to_edit
from chatrobot.link.envelope import MOST_CHARACTERS

ASKED = "please do something nice"
PLAN = "drive 0.5 m\nturn left 90 deg"
CONNECT = (
    "From now on your output is connected to the robot's node. For example, when I say “go on”, you answer: "
    "“linear.x = 1,linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = 0”."
)
FORM = "linear.x = 0.1,linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = 0\n"
MODELS = Options(approve_models=True)


class Answers:
    """A session that only notes what it is told."""

    def __init__(self) -> None:
        self.all: list[tuple[int, bool]] = []

    def approve(self, turn: int, yes: bool, *, edited: bool = False) -> None:
        assert not edited
        self.all.append((turn, yes))


def rehearsed(turn: int, needs_approval: bool = True) -> Rehearsed:
    return Rehearsed(turn, True, 2.0, 0.5, ORIGIN, (), (), needs_approval=needs_approval)


def finished(turn: int) -> Finished:
    return Finished(turn, "refused", None, ORIGIN, ORIGIN, 0.0, 0.0, 0.0, 0.0)


def test_a_question_is_answered_once() -> None:
    question, session = Question(), Answers()
    assert not question.answer(session, True)
    assert question.hear(rehearsed(3))
    assert question.turn == 3
    assert question.answer(session, True)
    assert not question.answer(session, True)
    assert session.all == [(3, True)]


@pytest.mark.parametrize("end", [finished(3), Started(3), Paused(3, ORIGIN, "drive 1 m")])
def test_a_question_ends_with_its_plan_and_no_other(end: Event) -> None:
    question = Question()
    question.hear(rehearsed(3))
    question.hear(finished(2))
    question.hear(rehearsed(4, needs_approval=False))
    assert question.turn == 3
    question.hear(end)
    assert question.turn is None


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("yes", True),
        (" Yes. ", True),
        ("好的。", True),
        ("yes, do it", True),
        ("Yes please, go ahead!", True),
        ("go ahead", True),
        ("ok", True),
        ("okay sure", True),
        ("可以", True),
        ("好的ok", True),
        ("好的，可以", True),
        ("好的执行吧，谢谢", True),
        ("no!", False),
        ("不要", False),
        ("Yes, please, go ahead!", True),
        ("yes please", True),
        ("no, thank you", False),
        (",", None),
        ("不可以", False),
        ("No, thanks.", False),
        ("no, don’t", False),
        ("yes and go", None),
        ("yes, no", None),
        ("no, do it", None),
        ("don't, please go", None),
        ("ok go left", None),
        ("yesterday", None),
        ("okdo it", None),
        ("请", None),
        ("please", None),
        ("", None),
    ],
)
def test_a_yes_is_a_whole_utterance(said: str, meant: bool | None) -> None:
    assert read_consent(said) is meant
    assert not wants_to_edit(said)


@pytest.mark.parametrize("long", ["好的" * 20_000, "yes " * 20_000, "thanks, " * 20_000])
def test_a_long_text_is_read_at_once(long: str) -> None:
    assert read_consent(f"{long}x") is None  # without end, if its words could be cut in two ways


# --- a model's plan ---


def waiting(talk: ModelTalk, text: str = ASKED) -> int:
    """Say it, until the plan waits; its turn."""
    turn = talk.session.say(text)
    talk.pump_until(lambda: any(isinstance(event, Rehearsed) for event in talk.events))
    assert talk.of("rehearsed")[-1].needs_approval  # type: ignore[attr-defined]
    assert not talk.moved()
    return turn


@pytest.mark.parametrize(("yes", "outcome"), [(True, "completed"), (False, "refused")])
def test_a_model_s_plan_waits_as_a_whole_for_a_yes(yes: bool, outcome: str) -> None:
    talk = ModelTalk(PLAN, options=MODELS)
    turn = waiting(talk)
    assert not talk.of("streamed")
    talk.session.approve(turn, yes)
    talk.pump_until(lambda: turn in talk.session.results)
    assert talk.session.results[turn].outcome == outcome
    assert talk.moved() is yes
    assert len(talk.model.asked) == 1


def test_without_an_answer_it_lapses_and_a_later_yes_is_none() -> None:
    talk = ModelTalk(PLAN, options=MODELS)
    turn = waiting(talk)
    talk.pump_until(lambda: turn in talk.session.results)
    talk.session.approve(turn, True)
    talk.session.pump(0.5)
    result = talk.session.results[turn]
    assert result.outcome == "refused"
    assert result.reason is not None
    assert result.reason.code == "approval_too_late"
    assert not talk.moved()


def test_what_a_person_says_plainly_is_not_asked_about() -> None:
    talk = ModelTalk(PLAN, options=MODELS)
    assert talk.do("forward 0.2 m").outcome == "completed"
    assert not talk.of("rehearsed")[0].needs_approval  # type: ignore[attr-defined]


def test_a_model_that_only_answers_needs_no_yes() -> None:
    assert ModelTalk('say "I am a robot."', options=MODELS).do(ASKED).outcome == "answered"


def test_who_has_connected_the_model_as_the_tutorial_does_is_not_asked_for_seconds_of_its_form() -> None:
    talk = ModelTalk("Understood.", FORM * 2, options=MODELS)
    talk.do(CONNECT)
    result = talk.do("forward")
    assert result.outcome == "completed"
    assert result.path_m == pytest.approx(0.2, abs=0.02)


@pytest.mark.parametrize(
    ("reply", "options"),
    [(FORM * 11, MODELS), (f"{FORM}drive 0.2 m", MODELS), (PLAN, MODELS), (FORM, Options(approve=True))],
    ids=[
        "longer than anybody's text may move it",
        "more than the form",
        "no form",
        "each plan is to be asked about",
    ],
)
def test_all_else_that_a_connected_model_says_waits_for_a_yes(reply: str, options: Options) -> None:
    talk = ModelTalk("Understood.", reply, options=options)
    talk.do(CONNECT)
    waiting(talk, "forward")


def test_the_form_frees_nothing_where_nobody_has_connected_the_model() -> None:
    waiting(ModelTalk(FORM, options=MODELS))


def test_an_edited_plan_waits_for_a_yes_whatever_the_options() -> None:
    talk = ModelTalk(PLAN)
    turn = talk.session.say_edited_plan("drive 0.2 m")
    talk.pump_until(lambda: any(isinstance(event, Rehearsed) for event in talk.events))
    assert talk.of("rehearsed")[-1].needs_approval  # type: ignore[attr-defined]
    assert not talk.moved()
    talk.session.approve(turn, True)
    talk.pump_until(lambda: turn in talk.session.results)
    assert talk.session.results[turn].outcome == "completed"


@pytest.mark.parametrize("instead_of", ["drive 0.3 m", ""])
def test_an_edit_that_cannot_be_read_leaves_the_plan_and_says_why(instead_of: str) -> None:
    talk = ModelTalk(PLAN)
    turn = talk.session.say_edited_plan("drive 0.2 m\nfly 3 m", instead_of)
    if not instead_of:
        talk.pump_until(lambda: turn in talk.session.results)
        assert talk.session.results[turn].outcome == "unclear"
        return
    talk.pump_until(lambda: any(isinstance(event, Rehearsed) for event in talk.events))
    assert talk.of("rehearsed")[-1].needs_approval  # type: ignore[attr-defined]
    (notice,) = talk.of("notice")
    assert notice.reason.code == "edit_unreadable"  # type: ignore[attr-defined]
    assert "line 2" in notice.reason.values["problem"]  # type: ignore[attr-defined]
    talk.session.approve(turn, True)
    talk.pump_until(lambda: turn in talk.session.results)
    assert talk.session.results[turn].path_m == pytest.approx(0.3, abs=0.01)


def test_what_was_driven_before_a_pause_is_told_where_the_rest_is_not_approved() -> None:
    talk = ModelTalk(PLAN, options=Options(approve=True))
    turn = talk.session.say("forward 1 m")
    talk.pump_until(lambda: any(isinstance(event, Rehearsed) for event in talk.events))
    talk.session.approve(turn, True)
    talk.pump_until(lambda: any(isinstance(e, Progress) and e.pose.x_m > 0.3 for e in talk.events))
    talk.session.say("pause")
    talk.pump_until(lambda: talk.session.is_paused)
    talk.session.say("continue")
    talk.pump_until(lambda: len(talk.of("rehearsed")) == 2)
    talk.session.approve(turn, False)
    talk.pump_until(lambda: turn in talk.session.results)
    told = talk.session.results[turn]
    assert (told.outcome, told.has_moved) == ("refused", True)
    assert f"drove {told.path_m:.2f} m of 1.00 m" in told.reply


def test_a_line_that_was_cut_is_shown_to_no_model() -> None:
    talk = ModelTalk("drive 1 m")
    for text in ("forward 1 m", "write a program that drives 1 m"):
        assert talk.do(text.ljust(MOST_CHARACTERS + 1, "…")).outcome == "unclear"
    assert talk.model.asked == []
