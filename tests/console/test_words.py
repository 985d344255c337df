"""The console's own words in both languages, what is typed made printable, and lines that wrap."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.cells import cell_len
from rich.text import Text

from chatrobot.cli.console.lines import wrapped
from chatrobot.cli.console.pasted import clean
from chatrobot.cli.console.tables import example_place, place_in
from chatrobot.cli.console.words import Words, language_of_environment
from chatrobot.core.geometry import Pose
from chatrobot.language.context import Context
from chatrobot.language.data_files import REPLY_LANGUAGES
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world

HOME = load_world("home")


def test_the_words_follow_the_language_of_the_last_question():
    words = Words()
    words.follow("前进一米")
    assert words.language == "zh"
    words.follow("42")
    assert words.language == "zh"
    words.follow("forward")
    assert words.language == "en"


@pytest.mark.parametrize(
    ("environment", "language"),
    [
        ({"LANG": "zh_CN.UTF-8"}, "zh"),
        ({"LANG": "zh_CN", "LC_ALL": "C"}, "en"),
        ({"LC_ALL": "", "LANG": "zh"}, "zh"),
        ({"LANG": "de_AT.UTF-8"}, "de"),
        ({}, "en"),
    ],
)
def test_the_first_words_are_in_the_language_of_the_system(environment, language):
    assert language_of_environment(environment) == language


def test_a_pose_is_never_minus_zero_nor_minus_180():
    assert Words().pose(Pose(-0.001, -0.004, -3.14159)) == "(0.00, 0.00) 180°"


@pytest.mark.parametrize("language", REPLY_LANGUAGES)
def test_everything_the_console_offers_to_say_is_understood(language):
    words = Words(language)
    place = place_in(language, HOME, example_place(HOME))
    examples = [
        words.say("example_first"),
        words.say("example_turn"),
        words.say("example_third"),
        words.say("undo_words"),
    ]
    examples += [words.say("example_place", place=place)]
    examples += [part.strip() for part in words.say("help_examples", place=place).split("|")]
    interpreter = OfflineInterpreter(load_profile("wheeltec_mini_mec"))
    context = Context(world_places={alias: HOME.places[main] for alias, main in HOME.aliases.items()})
    for example in examples:
        if example != words.say("undo_words"):
            assert interpreter.interpret(example, context).outcome in ("plan", "answered"), example


@given(st.text())
def test_clean_text_can_be_printed_and_stored(text):
    tidy = clean(text)
    tidy.encode("utf-8")
    assert all(char.isprintable() or char in "\n\t\u3000\u00a0" for char in tidy)
    assert clean(tidy) == tidy


def test_surrogates_and_escapes_become_marks_and_chinese_stays():
    assert clean("前进\udcff\x1b[2J\r\n1 m") == "前进��[2J\n1 m"


@pytest.mark.parametrize("width", [9, 20, 33, 60])
def test_chinese_is_broken_between_its_characters_and_not_before_a_closing_mark(width):
    said = "Wheeltec mini mecanum（仿真），在“home”里。告诉它做什么吧，比如：向前走半米，然后左转。"
    lines = [line.plain for line in wrapped(Text(said), width)]
    assert "".join(line.replace(" ", "") for line in lines) == said.replace(" ", "")
    assert all(cell_len(line) <= width for line in lines)
    assert all(line[0] not in "，。）：”" for line in lines)
    assert len(lines) <= cell_len(said) / (width - 8 if width > 20 else 4) + 1


def test_words_are_broken_at_blanks_and_blank_lines_stay():
    lines = [line.plain for line in wrapped(Text("drive forward one metre\n\nthen stop"), 14)]
    assert lines == ["drive forward", "one metre", "", "then stop"]
    assert [line.plain for line in wrapped(Text("x" * 20), 8)] == ["x" * 8, "x" * 8, "x" * 4]
