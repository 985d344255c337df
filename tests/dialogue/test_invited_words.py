"""What replies, page and Tab invite a person to say is understood, in every language that people are answered in."""

from __future__ import annotations

import json
from importlib import resources

import pytest

import chatrobot
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.consent import read_consent
from chatrobot.language.data_files import REPLY_LANGUAGES
from chatrobot.language.detect import language_of
from chatrobot.language.phrases import by_language, say
from chatrobot.language.resuming import wants_to_resume
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world, world_names

PROFILE = load_profile("wheeltec_mini_mec")


@pytest.mark.parametrize("world_name", world_names())
def test_every_place_of_every_world_is_gone_to_by_its_german_name(world_name: str) -> None:
    world = load_world(world_name)
    understanding = Understanding(PROFILE, world, None)
    for place in world.places:
        name = by_language(world.names_of(place), "de")[0]
        plan = understanding.interpret(f"fahr zu „{name}“").plan
        assert plan is not None, name
        assert [world.place(getattr(step, "place", "")) for step in plan.steps] == [world.places[place]]


@pytest.mark.parametrize("language", REPLY_LANGUAGES)
def test_what_the_page_invites_to_say_is_understood(language: str) -> None:
    home = load_world("home")
    page = resources.files("chatrobot.web") / "page"
    words = json.loads((page / f"words.{language}.json").read_text("utf-8"))
    place = by_language(home.names_of("kitchen"), language)[0]
    understanding = Understanding(PROFILE, home, None)
    for code in ("example_forward", "example_turn", "example_square", "example_place"):
        assert understanding.can_do(words[code].format(place=place)), code
    assert (read_consent(words["say_yes"]), read_consent(words["say_no"])) == (True, False)
    yes, no = (answer[:1] for answer in say(language, "yes_or_no").split("/"))
    assert (read_consent(yes), read_consent(no)) == (True, False)


def test_what_german_replies_invite_to_say_is_done() -> None:
    with chatrobot.connect(fast=True) as robot:
        told = [
            robot.do(text)
            for text in (
                "merk dir diesen Ort als Basis",
                "fahr 20 cm vorwärts, aber noch nicht",
                "los",
                "nochmal",
            )
        ]
        told += [robot.do(text) for text in ("rückgängig", "fahr zu Basis", "fahr 50 m vorwärts", "j")]
    assert [result.outcome for result in told] == [
        "answered", "unclear", "completed", "completed", "completed", "completed", "refused", "completed",
    ]  # fmt: skip
    assert "Sag „los“ oder „ja“" in told[1].reply
    assert told[4].reply.startswith("Fertig: 0,20 m")
    assert "Soll ich 2," in told[6].reply
    assert wants_to_resume("weiter")
    assert language_of("ok", "de") == "de", "what is said alike in both leaves the language as it was"
