"""Words that a person has taught are known in the next session, unless they lead to a point that it cannot know."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.dialogue.talk import Talk

from chatrobot.core.events import Notice
from chatrobot.dialogue.options import Options
from chatrobot.dialogue.words import Words
from chatrobot.language.phrases import render_reason
from chatrobot.plan.text import format_plan, parse_plan

JIG = "jig means: forward 20 cm, then back 20 cm"


def test_a_taught_word_is_known_in_the_next_session(tmp_path: Path) -> None:
    Talk(folder=tmp_path).do(JIG)
    result = Talk(folder=tmp_path).do("jig")
    assert result.outcome == "completed"
    assert result.path_m == pytest.approx(0.4, abs=0.02)


def test_a_word_that_is_forgotten_stays_forgotten(tmp_path: Path) -> None:
    Talk(folder=tmp_path).do(JIG)
    Talk(folder=tmp_path).do("forget jig")
    assert Talk(folder=tmp_path).do("jig").outcome == "unclear"


def test_without_a_folder_a_word_is_known_for_the_session() -> None:
    talk = Talk()
    talk.do(JIG)
    assert talk.do("jig").outcome == "completed"
    assert Talk().do("jig").outcome == "unclear"


def test_a_word_that_leads_to_a_point_of_odometry_is_unknown_where_that_counts_from_elsewhere(
    tmp_path: Path,
) -> None:
    plans = {"rounds": parse_plan("go to 1 2"), "jig": parse_plan("drive 0.2 m")}
    Words(tmp_path, "robot", "one").learn(plans, {})
    assert set(Words(tmp_path, "robot", "one").all()) == {"rounds", "jig"}
    assert set(Words(tmp_path, "robot", "two").all()) == {"jig"}
    Words(tmp_path, "robot", "two").learn({}, {"jig": "hop"})
    assert set(Words(tmp_path, "robot", "one").all()) == {"rounds", "hop"}, (
        "what is unusable here is not lost"
    )


def test_words_of_another_robot_are_none_of_this_one(tmp_path: Path) -> None:
    Words(tmp_path, "one", "e").learn({"jig": parse_plan("drive 1 m")}, {})
    assert not Words(tmp_path, "other", "e").all()
    Words(tmp_path, "other", "e").learn({"jig": parse_plan("drive 2 m")}, {})
    assert format_plan(Words(tmp_path, "one", "e").all()["jig"]) == "drive 1 m"


@pytest.mark.parametrize(
    "text", ["{", "[]", '{"robot": {"jig": {}}}', '{"robot": 1}', '{"robot": {"jig": {"plan": "fly"}}}']
)
def test_a_broken_file_is_named_and_stays_as_it_is(tmp_path: Path, text: str) -> None:
    file = tmp_path / "words.json"
    file.write_text(text)
    words = Words(tmp_path, "robot", "e")
    unkept = words.take_unkept()
    assert unkept is not None
    assert "words.json holds cannot be read" in render_reason(unkept, "en")
    assert set(words.learn({"jig": parse_plan("drive 1 m")}, {})) == {"jig"}
    assert file.read_text() == text


def test_a_word_that_cannot_be_kept_is_told_and_known_all_the_same(tmp_path: Path) -> None:
    talk = Talk(folder=tmp_path)
    (tmp_path / "words.json").write_text("{broken")
    assert talk.do(JIG).outcome == "answered"
    assert [e.reason.code for e in talk.events if isinstance(e, Notice)] == ["words_unreadable"]
    assert talk.do("jig").outcome == "completed"


def test_a_rehearsal_keeps_no_word(tmp_path: Path) -> None:
    talk = Talk(folder=tmp_path, options=Options(rehearse_only=True))
    assert talk.do(JIG).reply == "That would work. Nothing has moved."
    assert not (tmp_path / "words.json").exists()
