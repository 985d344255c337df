"""A turn that a model plans: local first, streamed, corrected at most twice, honest about what was done."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

import pytest
from tests.dialogue.scripted_model import ModelOptions, ModelTalk, Options

from chatrobot.core.events import Interpreted, ModelCalled, Streamed
from chatrobot.core.reason import Reason
from chatrobot.dialogue.understanding import Instruction
from chatrobot.language.interpretation import Interpretation

ASKED = "please do something nice"
PLAN = "drive 0.5 m\nturn left 90 deg\ndrive 0.3 m\n"


def test_what_is_understood_offline_costs_no_tokens() -> None:
    talk = ModelTalk(PLAN)
    for text in ("forward 0.2 m", "where are you?", "stop"):
        talk.do(text)
    assert talk.model.asked == []
    assert {event.by for event in talk.of("interpreted")} == {"offline", "reflex"}  # type: ignore[attr-defined]


def test_what_is_not_understood_goes_to_the_model_and_the_reason_is_shown() -> None:
    talk = ModelTalk(PLAN)
    result = talk.do(ASKED)
    assert result.outcome == "completed"
    assert result.pose.x_m == pytest.approx(0.5, abs=0.02)
    assert result.pose.y_m == pytest.approx(0.3, abs=0.02)
    assert talk.codes() == ["asks_model"]
    interpreted = [event for event in talk.events if isinstance(event, Interpreted)]
    assert [(event.by, event.plan_text) for event in interpreted] == [("model", PLAN.strip())]
    assert [
        event.plan_text for event in talk.events if isinstance(event, Streamed)
    ] == PLAN.strip().splitlines()
    call = next(event for event in talk.events if isinstance(event, ModelCalled))
    assert (call.model, call.round, call.prompt_tokens) == ("test:scripted", 1, 100)


@pytest.mark.parametrize("text", ["ram the wall", "run over the cat", "fly to the moon", "sudo rm -rf /"])
@pytest.mark.parametrize("interpreter", ["auto", "model"])
def test_what_is_refused_for_safety_never_reaches_a_model(text: str, interpreter: str) -> None:
    talk = ModelTalk(PLAN, options=Options(interpreter=interpreter))  # type: ignore[arg-type]
    assert talk.do(text).outcome == "refused"
    assert talk.model.asked == []


def test_a_speed_beyond_the_limits_is_refused_without_a_model() -> None:
    talk = ModelTalk(PLAN)
    assert talk.do("drive 1 m at 50 m/s").outcome == "refused"
    assert talk.model.asked == []


def test_offline_asks_nobody_and_model_asks_about_everything() -> None:
    talk = ModelTalk(PLAN, options=Options(interpreter="offline"))
    assert talk.do(ASKED).outcome == "unclear"
    assert talk.model.asked == []
    talk = ModelTalk(PLAN, options=Options(interpreter="model"))
    assert talk.do("forward 5 m").pose.x_m == pytest.approx(0.5, abs=0.02)
    assert len(talk.model.asked) == 1


def test_without_a_model_the_answer_tells_how_to_set_one_up() -> None:
    reply = ModelTalk(PLAN, model=None).do(ASKED).reply
    assert "chatrobot model" in reply
    assert len(reply) < 250
    assert "chatrobot model" not in ModelTalk(PLAN, options=Options(interpreter="offline")).do(ASKED).reply


def test_an_answer_that_only_talks_is_an_answer() -> None:
    talk = ModelTalk('say "I am a robot."\nsay "Two and two is four."')
    result = talk.do("what do you make of two and two, my friend")
    assert (result.outcome, result.reply) == ("answered", "I am a robot.\nTwo and two is four.")
    assert not talk.moved()


def test_a_bad_line_ends_the_run_and_goes_back_with_the_error() -> None:
    talk = ModelTalk("drive 0.5 m\nfly away\nturn left 90 deg", "# rest\nturn right 90 deg")
    result = talk.do(ASKED)
    assert result.outcome == "completed"
    assert result.pose.x_m == pytest.approx(0.5, abs=0.02)
    assert result.turned_rad == pytest.approx(-math.pi / 2, abs=0.03)
    assert "line 2: 'fly away'" in talk.model.last
    assert "Done: drive 0.5 m (measured: drove 0.50 m" in talk.model.last
    assert talk.codes() == ["asks_model", "model_corrected"]


def test_what_was_done_is_not_done_again_by_a_model_that_repeats_itself() -> None:
    talk = ModelTalk("drive 0.5 m\nfly away\n", "drive 0.5 m\nfly away\n")
    result = talk.do(ASKED)
    assert result.outcome == "unclear"
    assert result.path_m == pytest.approx(0.5, abs=0.02)
    assert len(talk.model.asked) == 3
    assert "drove 0.50 m of 0.50 m" in result.reply
    assert "fly away" in result.reply


def test_a_correction_that_gives_the_whole_plan_again_does_only_the_rest() -> None:
    talk = ModelTalk("drive 0.5 m\nfly away\n", "drive 0.5 m\nturn left 90 deg\n")
    result = talk.do(ASKED)
    assert result.outcome == "completed"
    assert result.path_m == pytest.approx(0.5, abs=0.02)
    assert result.turned_rad == pytest.approx(math.pi / 2, abs=0.03)


def test_a_correction_may_say_that_nothing_is_left() -> None:
    for nothing in ("# rest\n", Reason("model_empty", {})):
        result = ModelTalk("drive 0.5 m\nThat is all.\n", nothing).do(ASKED)
        assert (result.outcome, round(result.path_m, 1)) == ("completed", 0.5)


def test_a_refused_step_ends_the_run_at_the_last_accepted_one_and_the_exact_reason_goes_back() -> None:
    talk = ModelTalk("drive 0.4 m\ndrive 1 m at 9 m/s\nturn left 90 deg", "# rest\ndrive 0.1 m")
    result = talk.do(ASKED)
    assert (result.outcome, round(result.path_m, 2)) == ("completed", 0.5)
    assert "speed_above_limit: asked_mps 9.0, max_mps 1.0" in talk.model.last


def test_a_model_that_stays_wrong_is_asked_three_times_at_most_and_moves_nothing() -> None:
    for reply in ("I would love to drive!", "drive 1 m at 9 m/s", "drive 99999 m", '{"steps": 3}', "fly"):
        talk = ModelTalk(reply)
        result = talk.do(ASKED)
        assert result.outcome in ("unclear", "refused"), reply
        assert len(talk.model.asked) == 3
        assert not talk.moved()
        assert result.reply
        assert talk.do("forward 0.1 m").outcome == "completed"


def test_after_a_mistake_nothing_moves_before_the_whole_reply_is_read() -> None:
    talk = ModelTalk("fly", "drive 0.5 m\nfly", "drive 0.5 m\nfly")
    assert talk.do(ASKED).outcome == "unclear"
    assert not talk.moved()


@pytest.mark.parametrize(
    "code",
    ["model_no_key", "model_timeout", "model_cut_off", "model_refused", "model_too_long", "model_no_network"],
)
def test_a_call_that_comes_to_nothing_is_told_and_not_repeated(code: str) -> None:
    talk = ModelTalk(
        Reason(code, {"provider": "test", "host": "h", "said": "s", "variable": "V", "key_page": "k"})
    )
    result = talk.do(ASKED)
    assert (result.outcome, result.reason and result.reason.code) == ("failed", code)
    assert result.reply
    assert len(talk.model.asked) == 1
    assert not talk.moved()
    assert talk.do("forward 0.1 m").outcome == "completed"


def test_a_reply_that_breaks_off_is_done_up_to_there_and_says_so() -> None:
    talk = ModelTalk(["drive 0.5 m\nturn left 90", Reason("model_cut_off", {})])
    result = talk.do(ASKED)
    assert result.outcome == "failed"
    assert result.path_m == pytest.approx(0.5, abs=0.02)
    assert abs(result.turned_rad) < 0.02
    assert "0.50 m" in result.reply


def test_a_plan_that_needs_approval_comes_whole_and_waits_for_a_yes() -> None:
    for yes, outcome in ((True, "completed"), (False, "refused")):
        talk = ModelTalk(PLAN, options=Options(approve=True))
        turn = talk.session.say(ASKED)
        talk.pump_until(lambda talk=talk: bool(talk.of("rehearsed")))  # type: ignore[misc]
        assert talk.of("rehearsed")[0].needs_approval  # type: ignore[attr-defined]
        assert not talk.of("streamed")
        assert not talk.moved()
        talk.session.approve(turn, yes)
        talk.pump_until(lambda talk=talk, turn=turn: turn in talk.session.results)  # type: ignore[misc]
        assert talk.session.results[turn].outcome == outcome
        assert len(talk.model.asked) == 1
        assert talk.moved() == yes


def test_only_to_rehearse_moves_nothing() -> None:
    talk = ModelTalk(PLAN, options=Options(rehearse_only=True))
    assert talk.do(ASKED).outcome == "completed"
    assert not talk.moved()


def test_a_base_that_steers_like_a_car_gets_its_plan_whole() -> None:
    talk = ModelTalk(
        "drive 1.5 m\nturn left 90 deg\ndrive 1.5 m",
        robot="wheeltec_mini_akm",
        options=Options(interpreter="model"),
    )
    result = talk.do("go around the corner")
    assert result.outcome == "completed"
    assert result.turned_rad == pytest.approx(math.pi / 2, abs=0.05)


# --- looking ---


def test_a_model_looks_and_goes_on_with_what_really_happened() -> None:
    talk = ModelTalk("drive 0.5 m\nlook scan pose outcome", 'turn left 90 deg\nsay "done"', sim="slip=0.0")
    result = talk.do("drive a bit and look around for me")
    assert result.outcome == "completed"
    assert result.turned_rad == pytest.approx(math.pi / 2, abs=0.03)
    assert result.path_m == pytest.approx(0.5, abs=0.02)
    seen = talk.model.last
    assert "the last motion was completed: drove 0.50 m of 0.50 m" in seen
    assert "free way to the nearest thing seen: ahead free" in seen
    assert re.search(r"the robot is at 0\.50 -?0\.00, heading -?0 deg", seen)
    assert talk.codes() == ["asks_model", "model_looks"]


def test_looking_costs_no_motion_and_may_end_in_an_answer() -> None:
    talk = ModelTalk("look scan", 'say "Something stands 2 m ahead."', world="home")
    result = talk.do("tell me about the chair that I left here")
    assert (result.outcome, result.reply) == ("answered", "Something stands 2 m ahead.")
    assert "ahead 2." in talk.model.last
    assert not talk.moved()


def test_rounds_are_capped_where_the_person_says() -> None:
    talk = ModelTalk("drive 0.1 m\nlook scan", model_options=ModelOptions(rounds=3))
    result = talk.do(ASKED)
    assert result.outcome == "stopped"
    assert len(talk.model.asked) == 3
    assert result.path_m == pytest.approx(0.3, abs=0.02)
    assert "--rounds" in result.reply


def test_tokens_and_time_are_capped_too() -> None:
    talk = ModelTalk("look scan", model_options=ModelOptions(budget_tokens=150))
    assert "--budget-tokens" in talk.do(ASKED).reply
    assert len(talk.model.asked) == 2
    talk = ModelTalk("look scan", model_options=ModelOptions(budget_s=0.0))
    assert "--budget-s" in talk.do(ASKED).reply
    assert len(talk.model.asked) == 1


def test_places_and_pictures_can_be_asked_for() -> None:
    talk = ModelTalk("look places camera", 'say "ok"', world="home", camera=lambda: b"png")
    talk.do("forward 0.2 m")
    talk.do("remember this spot as dock two")
    talk.do(ASKED)
    assert '"kitchen" 4.00 0.70 0 deg' in talk.model.last
    assert '"dock two" 0.20' in talk.model.last
    assert talk.model.asked[-1][-1].picture == b"png"
    talk = ModelTalk("look camera", 'say "ok"')
    talk.do(ASKED)
    assert "no camera picture" in talk.model.last


# --- what it is told ---


def test_the_first_message_is_the_same_call_after_call_and_one_command_is_cheap() -> None:
    talk = ModelTalk(PLAN, world="home")
    talk.do(ASKED)
    talk.do("forward 0.1 m")
    talk.do("do it differently then")
    first, second = talk.model.asked
    assert first[0] == second[0]
    assert first[0].role == "system"
    assert sum(len(message.text) for message in first) / 4 < 600


def test_a_model_hears_of_what_was_done_without_it() -> None:
    talk = ModelTalk(PLAN)
    talk.do("forward 0.2 m")
    talk.do(ASKED)
    assert "understood without you: forward 0.2 m → drive 0.2 m: completed: drove 0.20 m" in talk.model.last
    talk.do("now something else that is nice")
    roles = [message.role for message in talk.model.asked[-1]]
    assert roles == ["system", "user", "assistant", "user"]
    assert talk.model.asked[-1][2].text == PLAN.strip()
    assert "that ended: completed: drove 0.8" in talk.model.last


def test_the_history_is_bounded() -> None:
    talk = ModelTalk('say "yes"')
    for count in range(60):
        talk.do(
            f"tell me something about number {count} and why it is so interesting, at length " + "x" * 100
        )
    assert sum(len(message.text) for message in talk.model.asked[-1]) < 8000
    assert "earlier turns" in talk.model.asked[-1][1].text


def test_undo_and_again_know_what_a_model_did() -> None:
    talk = ModelTalk("drive 0.5 m\n")
    talk.do(ASKED)
    assert talk.do("again").pose.x_m == pytest.approx(1.0, abs=0.03)
    assert talk.do("undo").pose.x_m == pytest.approx(0.5, abs=0.02)
    assert talk.do("undo").pose.x_m == pytest.approx(0.0, abs=0.02)
    assert talk.do("redo").pose.x_m == pytest.approx(0.5, abs=0.02)


# --- stop, and what else is said meanwhile ---


def test_a_stop_ends_a_turn_whose_model_hangs() -> None:
    talk = ModelTalk(None)
    turn = talk.session.say(ASKED)
    talk.pump_until(lambda: bool(talk.model.asked))
    talk.session.say("stop")
    talk.pump_until(lambda: turn in talk.session.results)
    assert talk.session.results[turn].outcome == "stopped"
    assert talk.session.do("forward 0.1 m").outcome == "completed"


def test_a_stop_counts_that_comes_while_the_text_is_being_understood() -> None:
    talk = ModelTalk(None)
    understand = talk.session.understanding.interpret

    def interpret(text: str, under_way: Sequence[Instruction] = ()) -> Interpretation:
        talk.session.stop("meanwhile")
        return understand(text, under_way)

    talk.session.understanding.interpret = interpret  # type: ignore[method-assign]
    assert talk.do(ASKED).outcome == "stopped"


def test_offline_commands_pass_a_hung_model() -> None:
    talk = ModelTalk(None)
    first = talk.session.say(ASKED)
    talk.pump_until(lambda: bool(talk.model.asked))
    time_for_a_person()
    assert talk.session.do("forward 0.2 m").outcome == "completed"
    assert first not in talk.session.results
    talk.session.stop("test")
    talk.pump_until(lambda: first in talk.session.results)


def test_at_the_keyboard_new_motion_replaces_what_a_model_thinks_of() -> None:
    talk = ModelTalk(None, options=Options(while_moving="replace"))
    first = talk.session.say(ASKED)
    talk.pump_until(lambda: bool(talk.model.asked))
    assert talk.session.do("forward 0.2 m").outcome == "completed"
    assert talk.session.results[first].outcome == "stopped"
    assert talk.session.results[first].reason == Reason("replaced")


def test_at_the_keyboard_a_new_question_replaces_the_old_one() -> None:
    talk = ModelTalk(None, PLAN, options=Options(while_moving="replace"))
    first = talk.session.say(ASKED)
    talk.pump_until(lambda: bool(talk.model.asked))
    assert talk.session.do("no, do something even nicer").outcome == "completed"
    assert talk.session.results[first].outcome == "stopped"


def test_piped_questions_are_answered_in_order() -> None:
    talk = ModelTalk("drive 0.2 m", "turn left 90 deg")
    turns = [talk.session.say(text) for text in (ASKED, "forward 0.1 m", "surprise me once more, will you")]
    talk.pump_until(lambda: len(talk.session.results) == 3)
    assert list(talk.session.results) == turns
    assert [round(talk.session.results[turn].pose.x_m, 1) for turn in turns] == [0.2, 0.3, 0.3]


def test_a_model_that_breaks_in_a_way_of_its_own_is_told_like_any_other() -> None:
    talk = ModelTalk(PLAN)
    talk.model.ask = lambda *_: 1 / 0  # type: ignore[assignment,return-value]
    assert talk.do(ASKED).outcome == "failed"


# --- the tutorial's ways ---

FIRST = (
    "From now on your output is connected to the robot's node. For example, when I say “go on”, you answer: "
    "“linear.x = 1,linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = 0”."
)
FORM = "linear.x = {},linear.y = 0,linear.z = 0,angular.x = 0,angular.y = 0,angular.z = {}"


def test_the_tutorials_first_instruction_connects_the_model_and_then_its_lines_move_the_robot() -> None:
    talk = ModelTalk("Understood.", FORM.format(0.2, 0), FORM.format(-0.2, 0), FORM.format(0, 0.5))
    assert talk.do(FIRST).outcome == "answered"
    assert not talk.moved()
    assert talk.do("forward").pose.x_m == pytest.approx(0.2, abs=0.02)
    assert talk.do("backward").pose.x_m == pytest.approx(0.0, abs=0.02)
    assert talk.do("left").turned_rad == pytest.approx(0.5, abs=0.03)
    assert len(talk.model.asked) == 4
    assert [message.role for message in talk.model.asked[1]] == ["system", "user", "assistant", "user"]
    assert talk.model.asked[1][1].text == FIRST
    assert talk.model.last == "left"
    assert talk.do("stop").outcome == "stopped"


@pytest.mark.parametrize(
    "reply", ["I would say {} here.", "No. “{}” is not safe.", "> {}", "Sorry:\n{}", "{} ok?"]
)
def test_the_same_words_in_prose_refusals_and_quotations_move_nothing(reply: str) -> None:
    talk = ModelTalk("Understood.", reply.format(FORM.format(0.2, 0)))
    talk.do(FIRST)
    assert talk.do("forward").outcome == "unclear"
    assert not talk.moved()


def test_the_answer_to_the_first_instruction_moves_nothing_even_in_the_form() -> None:
    talk = ModelTalk(FORM.format(0.2, 0))
    assert talk.do(FIRST).outcome == "answered"
    assert not talk.moved()


def test_without_a_model_the_first_instruction_is_answered_and_forward_works() -> None:
    talk = ModelTalk(model=None)
    assert talk.do(FIRST).outcome == "answered"
    assert talk.do("forward").outcome == "completed"
    assert talk.do(FORM.format(0.2, 0)).outcome == "completed"


def time_for_a_person() -> None:
    """A person types a little later than the model was asked; a pipe does not."""
    import time

    time.sleep(0.3)
