"""German is read through a gloss: what it orders, what orders nothing, and which texts are German at all."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.consent import after_consent, read_consent
from chatrobot.language.detect import language_of
from chatrobot.language.gloss import gloss
from chatrobot.language.gloss_tables import tables
from chatrobot.plan.text import format_plan
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world
from tests.language.dialogue_runner import Conversation

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

HERE = Path(__file__).parent
SOURCES = HERE.parent / "corpus" / "sources"
FRAMES = tomllib.loads((HERE.parent / "corpus" / "frames" / "de.toml").read_text(encoding="utf-8"))
ORDERS = [
    line.split(" => ")
    for line in (HERE / "orders_de.txt").read_text(encoding="utf-8").splitlines()
    if " => " in line and not line.startswith("#")
]


def done(*turns: str) -> list[str]:
    """The plan of each turn, or its outcome."""
    talk = Conversation()
    meant = [talk.say(turn) for turn in turns]
    return [format_plan(m.plan).replace("\n", "; ") if m.plan is not None else m.outcome for m in meant]


def test_orders_of_many_wordings_are_done_as_they_are_said() -> None:
    found = {said: done(said)[0] for said, _ in ORDERS}
    assert found == dict(ORDERS)
    assert len(found) >= 140


def test_what_orders_nothing_moves_nothing_whatever_motion_it_names() -> None:
    texts = [
        frame.format(motion)
        for form, frames in FRAMES["still"].items()
        for frame in frames
        for motion in FRAMES["motions"].get(form, [""])
    ]
    moved = [text for text in texts if Conversation().say(text[0].upper() + text[1:]).plan is not None]
    assert moved == []
    assert len(texts) >= 440


@pytest.mark.parametrize(
    ("turns", "plans"),
    [
        (["Fahr einen Meter vor", "nochmal"], ["drive 1 m", "drive 1 m"]),
        (["Dreh dich 90 Grad nach rechts", "nein, links"], ["turn right 90 deg", "turn left 180 deg"]),
        (["Fahr einen Meter vor", "die Hälfte davon zurück"], ["drive 1 m", "drive 0.5 m back"]),
        (["Fahr 2 m vor", "mach das rückgängig"], ["drive 2 m", "drive 2 m back"]),
        (["Fahr einen Meter vor", "zurück zum Anfang"], ["drive 1 m", "go to 0 0"]),
        (["Merk dir diese Stelle als Werkbank", "Fahr 1 m vor", "zurück zur Werkbank"],
         ["answered", "drive 1 m", 'go to 0 0 named "werkbank"']),
        (["Wenn ich hüpf sage, fährst du 10 cm vor", "hüpf"], ["answered", "drive 0.1 m"]),
        (["Fahr einen Meter vor", "weiter", "stop"], ["drive 1 m", "drive 0.5 m", "stop"]),
    ],
)  # fmt: skip
def test_a_dialogue_refers_to_what_was_done(turns: list[str], plans: list[str]) -> None:
    assert done(*turns) == plans


def test_a_text_is_in_the_language_of_most_of_its_words() -> None:
    german = ["fahr vor", "zurück", "Dreh dich um", "links", "Turtle, fahr bitte 2 m vor", "mach weiter"]
    english = [
        "go",
        "drive forward 1 m",
        "the die is cast",
        "fast",
        "1 m",
        "Jonas, go back",
        "also left",
        "vx 0.2",
    ]
    assert [language_of(text) for text in german] == ["de"] * len(german)
    assert [language_of(text) for text in english] == ["en"] * len(english)
    assert language_of("前进 zwei 米") == "zh"


def test_what_may_be_two_languages_is_in_the_one_spoken_before() -> None:
    assert [language_of("stop", "de"), language_of("2 m", "de"), language_of("ok", "en")] == [
        "de",
        "de",
        "en",
    ]
    assert language_of("go back", "de") == "en"


def test_a_word_that_no_gloss_covers_is_named_as_it_was_written_and_never_mended_to_an_english_one() -> None:
    assert gloss("Fahr zum Schloß", "de").text == "drive to the schlossqx"
    meant = Conversation().say("Fahr zwei Meter zum Rightschloß")
    assert meant.plan is None
    assert "Rightschloß" in meant.reply
    assert "qx" not in meant.reply


@pytest.mark.parametrize(
    ("said", "number"),
    [("zweiundzwanzig", "22"), ("hundertfünf", "105"), ("dreimal", "3 times"), ("viereinhalb", "4.5"),
     ("tausendzweihundert", "1200"), ("siebzehn", "17"), ("null", "0")],
)  # fmt: skip
def test_numbers_are_read_that_are_written_as_one_word(said: str, number: str) -> None:
    assert gloss(said, "de").text == number


def test_a_yes_and_a_no_answer_a_question() -> None:
    assert [read_consent(text) for text in ("Ja", "ja, genau!", "passt", "Mach das bitte")] == [True] * 4
    assert [read_consent(text) for text in ("Nein", "lieber nicht", "bloß nicht!")] == [False] * 3
    assert [read_consent(text) for text in ("vielleicht", "ja aber nicht so", "janein")] == [None] * 3
    assert after_consent("ja, aber langsam") == "aber langsam"


def test_every_rule_of_the_gloss_is_a_pattern_that_some_text_may_match() -> None:
    using = tables("de")
    for rule in (*using.before, *using.rules, *using.after):
        assert rule.pattern.groups >= max((int(n) for n in re.findall(r"\\(\d)", rule.said)), default=0)


@pytest.mark.parametrize(
    "text",
    [
        "Fahr nicht in die Küche", "Geh jetzt nicht zum Sofa!", "Fahr bloß nicht vor", "Roll nicht weiter",
        "Robbi, fahr niemals in die Küche", "Dreh dich bitte nicht um", "Fahr auf keinen Fall zum Sofa",
        "Komm nie zurück",
    ],
)  # fmt: skip
def test_what_is_denied_behind_its_verb_moves_nothing(text: str) -> None:
    understanding = Understanding(load_profile("wheeltec_mini_mec"), load_world("home"), None)
    meant = understanding.interpret(text)
    assert (meant.plan, meant.proposal) == (None, None), meant.reply


def test_german_is_read_after_a_place_was_remembered_without_a_name() -> None:
    talk = Conversation()
    talk.say("remember this place")
    meant = talk.say("fahr einen Meter vor")
    assert meant.plan is not None, meant.reply
    assert format_plan(meant.plan).strip() == "drive 1 m"
