"""`chatrobot do TEXT TEXT …`: what was not done ends the rest, because the robot is not where the rest begins."""

from __future__ import annotations

import pytest

from chatrobot.cli.do import may_follow
from chatrobot.core.event import Proposal
from chatrobot.core.events import Outcome, Result
from tests.cli.running import Command, Done

FAST = ("--fast", "--world", "empty")


def outcomes(done: Done) -> list[str]:
    return [result["outcome"] for result in done.named("result")]


@pytest.mark.parametrize(
    ("text", "options", "outcome", "code"),
    [
        ("fly to the moon", (), "refused", 4),
        ("forward 2 m", ("--sim", "stuck_after_m=0.5,blocked=stall"), "failed", 1),
        ("drive forward until a wall is within 50 cm", ("--max-distance", "1"), "stopped", 5),
        ("forward 2 m", ("--max-distance", "1"), "refused", 4),
        ("stop", (), "stopped", 5),
    ],
)
def test_what_was_not_done_ends_the_rest_and_its_exit_code_is_the_commands(
    chatrobot: Command, text: str, options: tuple[str, ...], outcome: str, code: int
) -> None:
    done = chatrobot("do", "turn left 5 degrees", text, "forward 1 m", "back 1 m", "--json", *options, *FAST)
    assert outcomes(done) == ["completed", outcome]
    assert done.code == code
    (notice,) = [event["reason"] for event in done.named("notice") if event["turn"] == 0]
    assert (notice["code"], notice["count"]) == ("turns_not_done", 2)
    assert notice["texts"] == "“forward 1 m”, “back 1 m”"


def test_what_was_not_begun_is_named_in_a_sentence(chatrobot: Command) -> None:
    done = chatrobot("do", "fly to the moon", "forward 1 m", *FAST)
    assert "these were not started: “forward 1 m”" in done.out
    assert "--keep-going" in done.out
    assert "所以下面的没有开始：“前进一米”" in chatrobot("do", "飞到月球去", "前进一米", *FAST).out


def test_keep_going_does_the_rest_all_the_same(chatrobot: Command) -> None:
    done = chatrobot(
        "do", "fly to the moon", "florble", "florble", "forward 1 m", "--keep-going", "--json", *FAST
    )
    assert outcomes(done) == ["refused", "unclear", "unclear", "completed"]
    assert (done.code, done.named("notice")) == (4, [])


@pytest.mark.parametrize(
    ("texts", "code"),
    [
        (("forward 1 m", "back 1 m"), 0),
        (("where are you?", "forward 1 m"), 0),
        (("forward 1 m", "florble"), 3),
        (("florble", "fly to the moon", "forward 1 m"), 3),
    ],
)
def test_keep_going_tells_that_any_turn_was_not_done(
    chatrobot: Command, texts: tuple[str, ...], code: int
) -> None:
    assert chatrobot("do", *texts, "--keep-going", *FAST).code == code


def test_the_next_text_answers_what_was_asked(chatrobot: Command) -> None:
    done = chatrobot("do", "turn 40 degrees", "left", "forward 1 m", "--json", *FAST)
    assert outcomes(done) == ["unclear", "completed", "completed"]
    assert done.named("result")[1]["turned_rad"] == pytest.approx(0.698, abs=0.03)
    assert done.code == 0


@pytest.mark.parametrize(("answer", "outcome", "code"), [("florble", "unclear", 3), ("fly", "refused", 4)])
def test_where_it_does_not_answer_the_rest_is_not_done(
    chatrobot: Command, answer: str, outcome: str, code: int
) -> None:
    done = chatrobot("do", "turn 40 degrees", answer, "forward 1 m", "--json", *FAST)
    assert outcomes(done) == ["unclear", outcome]
    assert done.code == code


def test_a_last_question_leaves_nothing_to_be_named(chatrobot: Command) -> None:
    done = chatrobot("do", "forward 1 m", "florble", "--json", *FAST)
    assert (done.code, done.named("notice")) == (3, [])


def test_lines_of_a_pipe_and_of_json_go_on(chatrobot: Command) -> None:
    for options in ((), ("--json",)):
        done = chatrobot(*options, *FAST, stdin="fly to the moon\nforward 1 m\n")
        assert done.code == 0


def result(outcome: Outcome, *, offers: bool = False) -> Result:
    return Result(1, outcome, "", proposal=Proposal("drive 2.3 m", "Drive 2.3 m?") if offers else None)


@pytest.mark.parametrize("outcome", ["completed", "answered", "unclear", "refused", "stopped", "failed"])
def test_only_what_was_done_or_asked_once_is_gone_on_after(outcome: Outcome) -> None:
    is_done = outcome in ("completed", "answered")
    assert may_follow("turn left", [result(outcome)]) is (is_done or outcome == "unclear")
    assert may_follow("turn left", [result("completed"), result(outcome)]) is (
        is_done or outcome == "unclear"
    )
    assert may_follow("turn left", [result("unclear"), result(outcome)]) is is_done


@pytest.mark.parametrize(("text", "follows"), [("yes", True), ("不要", True), ("turn left", False)])
def test_a_refusal_that_offers_a_plan_is_followed_by_its_answer_alone(text: str, follows: bool) -> None:
    offer = result("refused", offers=True)
    assert may_follow(text, [offer]) is follows
    assert not may_follow(text, [offer, result("refused", offers=True)])


# --- the motion budget on the command line ---


@pytest.mark.parametrize("value", ["0", "-1", "nan", "inf", "ten", "None", ""])
@pytest.mark.parametrize("option", ["--max-distance", "--max-time"])
def test_what_is_no_limit_is_told(chatrobot: Command, option: str, value: str) -> None:
    done = chatrobot("do", "forward 1 m", f"{option}={value}", *FAST)
    assert done.code == 2
    assert "none" in done.err


@pytest.mark.parametrize(
    ("options", "code"),
    [
        ((), 4),
        (("--max-distance", "130"), 4),
        (("--max-time", "700"), 4),
        (("--max-distance", "130", "--max-time", "700"), 0),
        (("--max-distance", "none", "--max-time", "none"), 0),
    ],
)
def test_the_command_line_lifts_the_motion_budget(
    chatrobot: Command, options: tuple[str, ...], code: int
) -> None:
    assert chatrobot("plan", "forward 125 m at 0.2 m/s", "--world", "empty", *options).code == code


def test_so_does_the_robots_profile_and_the_command_line_goes_before_it(chatrobot: Command) -> None:
    from chatrobot.robots.load import list_profiles

    text = next(entry.file for entry in list_profiles() if entry.name == "wheeltec_mini_mec").read_text(
        "utf-8"
    )
    profile = chatrobot.folder / "far.toml"
    profile.write_text(text + '\n[safety]\nmax_distance_m = "none"\nmax_time_s = 1000\n', encoding="utf-8")
    far = ("plan", "forward 125 m at 0.2 m/s", "--world", "empty", "--robot", str(profile))
    assert chatrobot(*far).code == 0
    assert chatrobot(*far, "--max-distance", "3").code == 4
