"""Slash commands, and what Tab completes."""

import pytest
from prompt_toolkit.completion import CompleteEvent
from prompt_toolkit.document import Document

import chatrobot
from chatrobot.cli.console import commands
from chatrobot.cli.console.completion import ChatCompleter, phrases_of
from chatrobot.cli.console.tables import place_in
from chatrobot.cli.console.words import Words
from chatrobot.core.geometry import Pose
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.data_files import REPLY_LANGUAGES
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world

HOME = load_world("home")


def test_every_command_has_a_help_text_in_every_language():
    for language in REPLY_LANGUAGES:
        for command in commands.COMMANDS:
            assert Words(language).say(command.help_code)


@pytest.mark.parametrize(
    ("typed", "meant"),
    [("hepl", "help"), ("halp", "help"), ("relase", "release"), ("STOPP", "stop"), ("zzz", "")],
)
def test_the_nearest_command_is_the_one_that_was_meant(typed, meant):
    assert commands.nearest(typed) == meant


def test_what_must_not_wait_is_done_where_it_is_typed():
    assert {command.name for command in commands.COMMANDS if command.at_once} == {
        "stop",
        "estop",
        "release",
        "quit",
    }


UNDERSTANDING = Understanding(load_profile("wheeltec_mini_mec"), HOME, None)


def completions(text, by_tab=True, language="en"):
    completer = ChatCompleter(Words(language), UNDERSTANDING.place_names, UNDERSTANDING.can_do)
    event = CompleteEvent(completion_requested=by_tab, text_inserted=not by_tab)
    return [(c.text, c.start_position) for c in completer.get_completions(Document(text), event)]


def test_a_slash_completes_to_commands_while_typing():
    assert completions("/re", by_tab=False) == [("/release", -3)]


def test_words_complete_on_tab_alone():
    assert completions("go to the kit") == [("kitchen", -3)]
    assert completions("go to the kit", by_tab=False) == []
    assert ("forward", -3) in completions("for")
    assert completions("去厨") == [("厨房", -1)]


@pytest.mark.parametrize("language", REPLY_LANGUAGES)
@pytest.mark.parametrize(
    "text", ["", "f", "c", "go to the ", "去", "go to the c", "fahr zu ", "forward 1 m, then t"]
)
def test_tab_offers_each_thing_once(language, text):
    offered = [name for name, _ in completions(text, language=language)]
    assert len({name.casefold() for name in offered}) == len(offered) > 0
    places = [HOME.aliases[name.casefold()] for name in offered if name.casefold() in HOME.aliases]
    assert len(set(places)) == len(places)


def test_places_are_offered_in_the_language_of_what_is_typed():
    mains = list(HOME.places)
    assert [name for name, _ in completions("go to the ")] == mains
    assert [name for name, _ in completions("去")] == [place_in("zh", HOME, name) for name in mains]
    assert completions("go to the living r") == [("living room", -8)]
    assert completions("refr") == [("refrigerator", -4)]
    assert completions("go to the TV") == []


@pytest.mark.parametrize(
    "text", ["go to the s", "drive to t", "forward 1 m, then t", "前进一米，然后左", "xyz "]
)
def test_within_a_sentence_only_what_is_understood_is_offered(text):
    for name, start in completions(text):
        assert UNDERSTANDING.can_do(f"{text[: len(text) + start]}{name}"), name
    assert "stop" not in [name for name, _ in completions(text)]
    assert "turn left" not in [name for name, _ in completions("drive to t")]


@pytest.mark.parametrize("phrase", phrases_of(*REPLY_LANGUAGES))
def test_every_phrase_that_tab_offers_is_understood(phrase):
    names = {"go to the": "kitchen", "去": "厨房", "remember this place as": "base", "记住这里叫": "基地"}
    names |= {"fahr zu": "Küche", "merk dir diesen Ort als": "Basis"}
    with chatrobot.connect(fast=True) as robot:
        robot.do("forward 20 cm")
        if phrase in ("redo", "重做", "wiederherstellen"):
            robot.do("undo")
        outcome = robot.do(f"{phrase} {names.get(phrase, '')}".strip()).outcome
    assert outcome in ("completed", "answered") or (
        phrase in ("stop", "停", "stopp") and outcome == "stopped"
    )


def test_what_a_command_takes_is_completed(tmp_path):
    (tmp_path / "square.plan").touch()
    assert completions(f"/save-plan {tmp_path}/squ") == [("are.plan", 0)]
    assert completions("/map b") == [("big", -1)]
    assert completions("/limit n") == [("none", -1)]
    assert completions("/stop x") == completions("/nonsense x") == []


def test_a_place_of_an_earlier_run_is_not_offered(tmp_path):
    before = Understanding(load_profile("wheeltec_mini_mec"), HOME, tmp_path)
    before.places.add("base", Pose())
    assert ("base",) in before.place_names()
    assert ("base",) not in Understanding(load_profile("wheeltec_mini_mec"), HOME, tmp_path).place_names()
