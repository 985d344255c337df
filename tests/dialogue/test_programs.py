"""Programs in a session: asked for, written, rehearsed, mended, kept and asked for again."""

from __future__ import annotations

import itertools
import json
import math
import re
from dataclasses import replace
from importlib.resources import files
from pathlib import Path

import pytest
from tests.dialogue.program_rig import ASKED, BROKEN, DANCE, House
from tests.models.rig import model_at, serving
from tests.programs.requests import ROTATION, SQUARE
from tests.programs.scripted_model import fenced, program

from chatrobot.core.events import (
    ModelCalled,
    ProgramRehearsed,
    ProgramWritten,
    Rehearsed,
    Result,
    TruePose,
)
from chatrobot.dialogue.options import Options
from chatrobot.language.data_files import REPLY_LANGUAGES
from chatrobot.models.usage import totals
from chatrobot.programs.library import KeptProgram


def turned_in(poses: list[TruePose]) -> tuple[float, float]:
    """Radians, and the seconds from the first motion to the last."""
    moving = [pose for pose in poses if abs(pose.wz_radps) > 1e-3 or abs(pose.vx_mps) > 1e-3]
    turned = sum((b.t_s - a.t_s) * 0.5 * (a.wz_radps + b.wz_radps) for a, b in itertools.pairwise(poses))
    return turned, moving[-1].t_s - moving[0].t_s


@pytest.mark.parametrize("writer", ["offline", "model"])
def test_the_tutorials_rotation_turns_three_radians_in_six_seconds(house: House, writer: str) -> None:
    if writer == "model":
        house.model(fenced(program("self.drive(0.0, 0.5, 6.0)")))
        house.authoring.prefers_model = True
    result = house.do(ROTATION)
    assert (result.outcome, house.all(ProgramWritten)[0].by) == ("completed", writer)
    turned_rad, took_s = turned_in(house.all(TruePose))
    assert turned_rad == pytest.approx(3.0, abs=0.02)
    assert took_s == pytest.approx(6.25, abs=0.1)  # the ramp down comes after the six seconds
    assert house.all(TruePose)[-1].wz_radps == 0.0
    assert house.all(ProgramRehearsed)[0].stands_at_end


@pytest.mark.parametrize("writer", ["offline", "model"])
def test_the_tutorials_square_drives_four_sides_and_four_turns_in_twenty_seconds(
    house: House, writer: str
) -> None:
    if writer == "model":
        house.model(
            fenced(
                program("for _ in range(4):\n    self.drive(0.2, 0.0, 3.0)\n    self.drive(0.0, 1.0, 2.0)")
            )
        )
        house.authoring.prefers_model = True
    result = house.do(SQUARE)
    assert result.outcome == "completed"
    assert result.turned_rad == pytest.approx(8.0, abs=0.03)
    assert result.path_m == pytest.approx(2.4, abs=0.05)
    _, took_s = turned_in(house.all(TruePose))
    assert took_s == pytest.approx(20.4, abs=0.2)
    rehearsed = house.all(Rehearsed)[0]
    assert rehearsed.duration_s == pytest.approx(21.0, abs=0.1)  # with the second of rest
    assert house.all(TruePose)[-1].vx_mps == 0.0


def test_what_the_square_promises_and_its_numbers_do_not_give_is_said(house: House) -> None:
    result = house.do(SQUARE)
    assert "promise_corner" in house.marks
    assert "115°" in result.reply


def test_a_sentence_becomes_a_program_that_does_what_the_plan_would(house: House) -> None:
    start = house.do("where are you?").pose
    result = house.do("Generate a ROS 2 Python program to drive forward 1 m and turn left 90 degrees.")
    assert result.outcome == "completed"
    assert result.pose.distance_to(start) == pytest.approx(1.0, abs=0.03)
    assert result.turned_rad == pytest.approx(math.pi / 2, abs=0.03)


def test_what_nobody_can_write_is_unclear_and_says_what_would_help(house: House) -> None:
    result = house.do("Write a ROS 2 Python program that makes the robot follow a ball")
    assert result.outcome == "unclear"
    assert "model" in result.reply


def test_with_a_model_what_the_offline_language_does_not_understand_is_written(house: House) -> None:
    model = house.model(fenced(DANCE))
    result = house.do(ASKED)
    assert result.outcome == "completed"
    (written,) = house.all(ProgramWritten)
    assert (written.by, written.version, written.description) == ("model", 1, "Here you are.")
    assert [message.role for message in model.asked[0]] == ["system", "user"]
    assert "cmd_vel" in model.asked[0][0].text


@pytest.mark.parametrize(("code", "told"), BROKEN.values(), ids=BROKEN.keys())
def test_what_is_wrong_goes_back_to_the_model_and_the_mended_program_runs(
    house: House, code: str, told: str
) -> None:
    model = house.model(fenced(code), fenced(DANCE))
    result = house.do(ASKED)
    assert result.outcome == "completed"
    first, second = house.all(ProgramWritten)
    assert (first.version, second.version) == (1, 2)
    assert second.diff.startswith("--- before\n+++ after")
    assert told in model.asked[1][-1].text
    assert len([event for event in house.events if isinstance(event, Result)]) == 1


def test_the_model_gets_the_traceback_with_the_line(house: House) -> None:
    model = house.model(fenced(BROKEN["an exception"][0]), fenced(DANCE))
    house.do(ASKED)
    assert "drvie" in model.asked[1][-1].text
    assert "Traceback" in model.asked[1][-1].text


def test_it_is_mended_twice_at_most_and_then_refused(house: House) -> None:
    code = BROKEN["an exception"][0]
    model = house.model(fenced(code), fenced(code), fenced(code))
    result = house.do(ASKED)
    assert result.outcome == "refused"
    assert "AttributeError" in result.reply
    assert [written.version for written in house.all(ProgramWritten)] == [1, 2, 3]
    assert len(model.asked) == 3
    assert not any(pose.vx_mps for pose in house.all(TruePose))


def test_a_limit_that_stays_after_two_repairs_is_governed_and_said(house: House) -> None:
    code = BROKEN["a limit"][0]
    house.model(fenced(code), fenced(code), fenced(code))
    result = house.do(ASKED)
    assert result.outcome == "completed"
    assert "limited" in house.findings
    assert max(abs(pose.vx_mps) for pose in house.all(TruePose)) <= 1.0 + 1e-6


def test_an_answer_without_a_program_is_told(house: House) -> None:
    house.model("I would rather write a poem.")
    result = house.do(ASKED)
    assert result.outcome == "unclear"
    assert "poem" in result.reply


@pytest.mark.parametrize(
    ("name", "said"),
    [("square dance", "do the square dance again"), ("evil", "do evil again"), ("square dance", "run the square dance"),
     ("方块舞", "再跳一次方块舞"), ("方块舞", "运行方块舞")],
)  # fmt: skip
def test_a_kept_program_runs_again_by_its_name(house: House, name: str, said: str) -> None:
    house.authoring.library.keep(KeptProgram(name, DANCE))
    result = house.do(said)
    assert result.outcome == "completed"
    assert house.all(ProgramWritten)[0].program == name
    assert house.all(Rehearsed)
    assert house.authoring.library.get(name).runs[-1].outcome == "completed"


@pytest.mark.parametrize(
    ("text", "name", "metres"),
    [
        ("write a program that goes forward 30 cm and call it dash", "dash", 0.3),
        ("write a program called zigzag that goes forward 30 cm and turns left", "zigzag", 0.3),
        ("make a program called pyramid. It goes forward 20 cm and turns left.", "pyramid", 0.2),
        ("schreibe ein Programm namens Tor: 30 cm vor, links drehen", "tor", 0.3),
        ("写一个程序：前进二十厘米，左转九十度，重复四次，叫做小方块", "小方块", 0.8),
        ("写一个程序，前进三十厘米，取名叫大三角形", "大三角形", 0.3),
    ],
)
def test_the_name_that_a_program_is_given_is_no_motion(
    house: House, text: str, name: str, metres: float
) -> None:
    result = house.do(text)
    assert result.outcome == "completed", result.reply
    assert house.all(Result)[-1].path_m == pytest.approx(metres, abs=0.02)
    assert house.authoring.library.find(name) is not None


@pytest.mark.parametrize(
    "said", ["run the door twice", "run the door but slower", "starte door zweimal", "运行door两次"]
)
def test_a_program_is_not_run_otherwise_than_it_is(house: House, said: str) -> None:
    house.do("write a program called door: forward 10 cm")
    result = house.do(said)
    assert result.outcome == "refused"
    assert "door" in result.reply


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("what programs do you have?", "Kept programs: "),
        ("can you write programs?", "write a program that"),
        ("delete the door program", "chatrobot program remove"),
        ("lösche das Programm door", "chatrobot program remove"),
        ("你会写程序吗", "写一个程序"),
    ],
)
def test_a_question_about_programs_is_answered_and_runs_none(house: House, said: str, told: str) -> None:
    house.do("write a program called door: forward 10 cm")
    result = house.do(said)
    assert result.outcome == "answered"
    assert told in result.reply
    assert "door" in result.reply


def test_a_new_program_is_kept_with_where_it_comes_from_and_how_it_went(house: House) -> None:
    house.model(fenced(DANCE + "# kept\n"))
    house.do(ASKED)
    kept = house.authoring.library.get(house.all(ProgramWritten)[0].program)
    assert (kept.provenance.sentence, kept.provenance.by, kept.provenance.model) == (
        ASKED,
        "model",
        "scripted:test",
    )
    assert kept.rehearsal["ok"] is True
    assert kept.runs[-1].outcome == "completed"


def test_what_a_model_uses_to_write_and_to_mend_is_told_call_by_call(house: House) -> None:
    house.model("no program at all, sorry")
    house.do(ASKED)
    assert [(call.model, call.round) for call in house.all(ModelCalled)] == [("scripted:test", 1)]
    house.model(fenced("this is no Python ("), fenced(DANCE + "# mended\n"))
    assert house.do(ASKED).outcome == "completed"
    calls = house.all(ModelCalled)
    assert [call.round for call in calls] == [1, 2]
    assert calls[1].prompt_tokens > calls[0].prompt_tokens > 0
    assert calls[1].reply_tokens > 0
    assert not any(call.counted for call in calls)


def test_what_a_model_uses_to_write_programs_counts_in_usage(house: House, tmp_path: Path) -> None:
    pytest.importorskip("pydantic_ai")
    broken, whole = fenced("this is no Python ("), fenced(DANCE + "# counted\n")
    with serving([{"text": broken}, {"text": whole}]) as fake:
        house.authoring.model = model_at("openai", fake.url, folder=tmp_path)
        assert house.do(ASKED).outcome == "completed"
    total = totals(tmp_path, "model")["openai:fake"]
    told = house.all(ModelCalled)
    assert (total.calls, total.estimated) == (2, 0)
    assert total.prompt_tokens == sum(call.prompt_tokens for call in told) > 0
    assert total.reply_tokens == sum(call.reply_tokens for call in told) > 0


def test_a_program_that_needs_no_model_uses_none(house: House) -> None:
    house.do("Generate a ROS 2 Python program to drive forward 15 cm")
    assert not house.all(ModelCalled)


@pytest.mark.parametrize("code", REPLY_LANGUAGES)
def test_the_example_of_the_page_is_written_when_it_is_said_as_it_stands(house: House, code: str) -> None:
    words = json.loads((files("chatrobot.web") / f"page/words.{code}.json").read_text(encoding="utf-8"))
    example = re.search("[“„](.+)[”“]", words["programs_empty"])
    assert example is not None
    assert house.do(example[1]).outcome == "completed"
    assert house.authoring.library.names()


def test_the_same_program_is_kept_once(house: House) -> None:
    house.do("Generate a ROS 2 Python program called “there and back” to drive forward 10 cm then back 10 cm")
    house.do("Generate a ROS 2 Python program called “there and back” to drive forward 10 cm then back 10 cm")
    assert sum(name.startswith("there and back") for name in house.authoring.library.names()) == 1


def test_findings_ask_and_a_no_moves_nothing(house: House) -> None:
    house.on_event = lambda event: (
        house.session.approve(event.turn, False)
        if isinstance(event, Rehearsed) and event.needs_approval
        else None
    )
    result = house.run(program("self.drive(0.2, 0.0, 0.5)\nreturn"))
    assert house.all(Rehearsed)[0].needs_approval
    assert "program_never_stops" in house.findings
    assert (result.outcome, result.path_m) == ("refused", 0.0)


def test_an_edit_is_asked_about_though_this_session_has_not_shown_the_program(house: House) -> None:
    house.authoring.library.keep(KeptProgram("unseen", program("self.drive(0.1, 0.0, 1.0)")))
    house.on_event = lambda event: (
        house.session.approve(event.turn, True)
        if isinstance(event, Rehearsed) and event.needs_approval
        else None
    )
    result = house.edit("unseen", program("self.drive(0.2, 0.0, 1.0)"))
    assert result.outcome == "completed"
    assert result.path_m == pytest.approx(0.2, abs=0.02)


def test_an_edit_that_rehearsal_refuses_leaves_the_version_before_it_and_one_that_is_cancelled_is_kept(
    house: House,
) -> None:
    library, first = house.authoring.library, program("self.drive(0.1, 0.0, 1.0)")
    library.keep(KeptProgram("walk", first))
    house.on_event = lambda event: (
        house.session.approve(event.turn, False)
        if isinstance(event, Rehearsed) and event.needs_approval
        else None
    )
    assert house.edit("walk", program("import os\nos.system('ls')")).outcome == "refused"
    assert library.get("walk").source == first
    assert not library.get("walk").rehearsal
    second = program("self.drive(0.2, 0.0, 1.0)")
    assert house.edit("walk", second).outcome == "refused"
    assert (library.get("walk").source, library.get("walk").rehearsal["ok"]) == (second, True)


def test_an_edit_of_a_program_that_is_not_kept_is_refused(house: House) -> None:
    result = house.edit("nobody's", program("self.drive(0.2, 0.0, 1.0)"))
    assert (result.outcome, result.path_m) == ("refused", 0.0)
    assert "there is no program" in result.reply


def test_who_said_yes_beforehand_is_not_asked(house: House) -> None:
    house.session.options = Options(ask_findings=False)
    result = house.run(program("self.drive(0.2, 0.0, 0.5)\nreturn"))
    assert result.outcome == "completed"
    assert house.all(TruePose)[-1].vx_mps == 0.0  # it did not stop the robot: I did


def test_what_was_written_just_now_can_be_asked_about(house: House) -> None:
    house.session.options = replace(Options(), ask_new=True)
    house.on_event = lambda event: (
        house.session.approve(event.turn, True)
        if isinstance(event, Rehearsed) and event.needs_approval
        else None
    )
    result = house.do("Generate a ROS 2 Python program to drive forward 20 cm")
    assert house.all(Rehearsed)[0].needs_approval
    assert result.outcome == "completed"
