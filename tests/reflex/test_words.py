"""Stop words are data: a file a language, all active together; a broken one disables no other."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from scripts.compile_stop_words import compiled

from chatrobot.reflex import is_emergency_stop, is_pause, is_release, is_stop, leads_with_stop
from chatrobot.reflex.words import ALL, BY_LANGUAGE, DATA, load, parse, together

GERMAN_STOPS = [
    "Halt! Stopp!", "Anhalten!", "Halte bitte an", "Jetzt bleib doch endlich stehen", "Hör sofort auf damit",
    "hoer auf", "Nicht weiter!", "Keinen Schritt weiter!", "Lass das!", "Brems!", "Schluss jetzt", "Motoren aus!",
    "Stooopp!", "haaalt", "Oh Gott, halt!", "Kannst du bitte anhalten?", "Vorsicht, bleib stehen!",
    "Rühr dich nicht", "Fahr nicht weiter!", "Stopp, da ist die Katze", "Ich hab stopp gesagt!", "Vergiss es",
    "Fahr vorwärts ... ach nein, doch nicht", "Not-Halt!", "Notaus", "Warte mal", "Moment bitte",
]  # fmt: skip
GERMAN_MISTYPED = ["stpp", "bleib sthen", "anhaltne", "hlat an", "bitte anhalten sofrot", "Halt, die Wadn"]
GERMAN_NO_STOPS = [
    "Halt nicht an", "Bleib nicht stehen", "Hör nicht auf", "Halt dich links", "Halte Abstand", "weiter",
    "stoppe für zwei Sekunden", "halt zwei Sekunden an", "Fahr einen Meter und bleib dann stehen", "Stoppschild",
    "fahr bis zur Haltestelle", "dreh dich um", "das ist halt so", "Ich habe nicht genug Platz", "los", "links",
    "ohne anzuhalten weiterfahren", "nicht anhalten", "Bitte nicht anhalten!", "Steh auf", "Wie weit ist es?",
    "Mach den Motor an", "ich warte auf dich", "schneller", "rückwärts", "ja", "nein", "danke", "die Wand",
]  # fmt: skip


@pytest.mark.parametrize("text", GERMAN_STOPS)
def test_a_german_stop_stops(text: str) -> None:
    assert is_stop(text)
    assert leads_with_stop(text)


@pytest.mark.parametrize("text", GERMAN_MISTYPED)
def test_a_mistyped_german_stop_halts_a_moving_robot(text: str) -> None:
    assert leads_with_stop(text)


@pytest.mark.parametrize("text", GERMAN_NO_STOPS)
def test_other_german_is_no_stop(text: str) -> None:
    assert not is_stop(text)
    assert not leads_with_stop(text)


def test_german_pauses_emergencies_and_releases_are_told_apart() -> None:
    assert is_pause("Warte bitte mal")
    assert not is_pause("Halt")
    assert is_emergency_stop("Drück den Not-Aus!")
    assert is_release("Bitte heb den Nothalt auf")
    assert not is_release("Hebe den Nothalt nicht auf")


@pytest.mark.parametrize("language", sorted(BY_LANGUAGE))
def test_every_listed_stop_stops_whatever_the_other_languages_list(language: str) -> None:
    words = BY_LANGUAGE[language]
    for phrase in (*words.stop, *words.pause, *words.emergency):
        assert is_stop(phrase), phrase
    for phrase in words.other_words:
        assert not is_stop(phrase), phrase
    for phrase in words.release:
        assert is_release(phrase), phrase


@pytest.mark.parametrize("path", sorted(DATA.glob("*.toml")), ids=lambda path: path.stem)
def test_the_compiled_file_is_what_the_source_says(path: Path) -> None:
    assert path.with_suffix(".json").read_text(encoding="utf-8") == compiled(path), (
        "run: python -m scripts.compile_stop_words"
    )


@pytest.mark.parametrize(
    "broken", ["", "{", "[]", '{"stop": "halt"}', '{"stopp": ["halt"]}', '{"sounds": []}']
)
def test_a_broken_file_disables_no_other_language(
    broken: str, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    for path in DATA.glob("*.json"):
        shutil.copy(path, tmp_path)
    (tmp_path / "de.json").write_text(broken, encoding="utf-8")
    found = load(tmp_path)
    assert set(found) == set(BY_LANGUAGE) - {"de"}
    assert found["en"] == BY_LANGUAGE["en"]
    assert "de.json" in caplog.text


def test_a_missing_file_disables_no_other_language(tmp_path: Path) -> None:
    shutil.copy(DATA / "zh.json", tmp_path)
    assert together(load(tmp_path)) == BY_LANGUAGE["zh"]
    assert load(tmp_path / "nowhere") == {}


def test_every_word_is_listed_once_in_its_language() -> None:
    for language in BY_LANGUAGE:
        table = json.loads((DATA / f"{language}.json").read_text(encoding="utf-8"))
        for name, value in table.items():
            listed = value.split() if name == "real_words" else value
            if isinstance(listed, list):
                assert sorted(listed) == sorted(set(listed)), (language, name)


def test_all_languages_are_active_together() -> None:
    assert set(BY_LANGUAGE) == {"de", "en", "zh"}
    assert set(BY_LANGUAGE["de"].stop) < set(ALL.stop)
    assert ALL.fold["ö"] == "oe"
    assert ALL.fold["車"] == "车"
    assert ALL.sounds["亭"] == "ting"


def test_a_split_verb_takes_a_word_between_its_parts() -> None:
    words = parse({"split_verbs": ["halt | an"], "inside": ["bitte"]})
    assert words.stop == ("halt  an", "halt bitte an")
