"""The console's parts, without a terminal."""

import re
import string
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from prompt_toolkit.completion import CompleteEvent
from prompt_toolkit.document import Document
from rich.cells import cell_len
from rich.console import Console
from rich.text import Text

import chatrobot
from chatrobot.cli.console import commands
from chatrobot.cli.console.completion import COMMON, ChatCompleter
from chatrobot.cli.console.lines import wrapped
from chatrobot.cli.console.motion_view import MotionView
from chatrobot.cli.console.narrator import PLAN_LINES, Narrator
from chatrobot.cli.console.pasted import clean
from chatrobot.cli.console.status_bar import MAP_ROWS, StatusBar
from chatrobot.cli.console.tables import example_place, place_in, places_table
from chatrobot.cli.console.words import Words, language_of_environment
from chatrobot.core.events import (
    FindingSeen,
    Finished,
    Interpreted,
    Limited,
    Notice,
    Progress,
    Rehearsed,
    Result,
    Started,
    Telemetry,
)
from chatrobot.core.geometry import Pose, Twist
from chatrobot.core.reason import Reason
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.context import Context, Place
from chatrobot.language.data_files import load_table
from chatrobot.language.interpreter import OfflineInterpreter
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world
from chatrobot.sim.world import EMPTY_WORLD

HOME = load_world("home")
WAY = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0))
REHEARSED = Rehearsed(1, True, 3.6, 1.0, Pose(1.0), (), WAY)


def printed(*renderables, width=80):
    console = Console(width=width, no_color=True, force_terminal=False)
    with console.capture() as capture:
        console.print(*renderables, sep="\n")
    return capture.get()


def told(narrator, *events):
    return printed(*(line for event in events for line in narrator.tell(event)))


# --- words ---


def fields(table):
    return {
        key: {name for _, name, _, _ in string.Formatter().parse(text) if name} for key, text in table.items()
    }


def test_both_languages_have_the_same_words_with_the_same_values():
    assert fields(load_table("en", "console")) == fields(load_table("zh", "console"))


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
        ({}, "en"),
    ],
)
def test_the_first_words_are_in_the_language_of_the_system(environment, language):
    assert language_of_environment(environment) == language


def test_a_pose_is_never_minus_zero_nor_minus_180():
    assert Words().pose(Pose(-0.001, -0.004, -3.14159)) == "(0.00, 0.00) 180°"


@pytest.mark.parametrize("language", ["en", "zh"])
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


# --- text that comes in ---


@given(st.text())
def test_clean_text_can_be_printed_and_stored(text):
    tidy = clean(text)
    tidy.encode("utf-8")
    assert all(char.isprintable() or char in "\n\t\u3000\u00a0" for char in tidy)
    assert clean(tidy) == tidy


def test_surrogates_and_escapes_become_marks_and_chinese_stays():
    assert clean("前进\udcff\x1b[2J\r\n1 m") == "前进��[2J\n1 m"


# --- commands ---


def test_every_command_has_a_help_text_in_both_languages():
    for language in ("en", "zh"):
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


# --- completion ---


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


@pytest.mark.parametrize("language", ["en", "zh"])
@pytest.mark.parametrize("text", ["", "f", "c", "go to the ", "去", "go to the c", "forward 1 m, then t"])
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


@pytest.mark.parametrize("phrase", [phrase for phrases in COMMON.values() for phrase in phrases])
def test_every_phrase_that_tab_offers_is_understood(phrase):
    names = {"go to the": "kitchen", "去": "厨房", "remember this place as": "base", "记住这里叫": "基地"}
    with chatrobot.connect(fast=True) as robot:
        robot.do("forward 20 cm")
        if phrase in ("redo", "重做"):
            robot.do("undo")
        outcome = robot.do(f"{phrase} {names.get(phrase, '')}".strip()).outcome
    assert outcome in ("completed", "answered") or (phrase in ("stop", "停") and outcome == "stopped")


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


@pytest.mark.parametrize("language", ["en", "zh"])
def test_places_are_listed_once_each_in_the_askers_language(language):
    lines = printed(places_table(Words(language), HOME, {"TV": Place(Pose())}), width=200).splitlines()[1:]
    names = [re.split(r"\s{2,}", line.strip())[0] for line in lines]
    assert names == ["TV", *(place_in(language, HOME, name) for name in HOME.places if name != "TV")]
    text = {"en": "what places do you know?", "zh": "你记住了哪些地方？"}[language]
    reply = UNDERSTANDING.interpret(text).reply
    listed = re.split(", |，", reply.partition(": " if language == "en" else "：")[2].rstrip(".。"))
    assert listed == [place_in(language, HOME, name) for name in HOME.places]


# --- ride and strip ---


def moving_ride():
    motion_view = MotionView()
    for event in (
        REHEARSED,
        Started(1, Pose()),
        Progress(1, 2, 4, 0.5, Pose(0.5), Twist(0.3)),
        Telemetry(1, Pose(0.5, 0.0, 0.0), Twist(0.3), 0.5, 80.0, 0.8, True),
    ):
        motion_view.hear(event)
    return motion_view


def finished(turn=1):
    return Finished(turn, "completed", None, Pose(), Pose(1.0), 0.0, 1.0, 3.6, 0.0)


def test_a_ride_has_its_way_its_trail_and_its_progress():
    motion_view = moving_ride()
    assert motion_view.is_moving
    assert motion_view.path == ((0.0, 0.0), (1.0, 0.0))
    assert motion_view.trail == ((0.0, 0.0), (0.5, 0.0))
    assert (motion_view.step, motion_view.of, motion_view.fraction) == (2, 4, 0.5)


def test_the_end_of_another_turn_does_not_end_the_ride():
    motion_view = moving_ride()
    motion_view.hear(finished(turn=7))
    assert motion_view.is_moving
    motion_view.hear(finished())
    assert not motion_view.is_moving
    assert motion_view.pose == Pose(1.0)


def strip_text(motion_view, width=100, world=HOME, latched=False, language="en", model_wait_s=None):
    strip = StatusBar(motion_view, Words(language), world)
    return "".join(text for _, text in strip.fragments(width, latched, model_wait_s))


def test_the_strip_shows_no_share_of_what_has_no_known_end():
    motion_view = moving_ride()
    motion_view.hear(Progress(1, 1, 1, None, Pose(0.6), Twist(0.3)))
    assert "%" not in strip_text(motion_view).replace("battery 80 %", "")
    assert "moving" in strip_text(motion_view)
    motion_view.hear(replace(REHEARSED, open_ended=True))
    motion_view.hear(Started(2, Pose()))
    assert motion_view.fraction is None


def test_the_strip_of_a_moving_robot_says_where_how_fast_and_how_far():
    text = strip_text(moving_ride())
    for part in (
        "moving",
        "50 %",
        "step 2 of 4",
        "(0.50, 0.00) 0°",
        "0.30 m/s",
        "0.80 m",
        "battery 80 %",
        "→",
    ):
        assert part in text
    assert "行驶中" in strip_text(moving_ride(), language="zh")
    assert text.count("\n") == MAP_ROWS - 1


def test_a_narrow_strip_has_no_map_and_no_line_is_too_long():
    assert "→" not in strip_text(moving_ride(), width=45)
    for width in range(1, 120):
        assert max(len(line) for line in strip_text(moving_ride(), width=width).split("\n")) <= width


def test_a_standing_robot_has_a_line_and_a_latched_one_an_alarm():
    assert "\n" not in strip_text(MotionView())
    assert "EMERGENCY STOP" in strip_text(moving_ride(), latched=True)


def test_the_strip_says_for_how_long_a_model_thinks_whether_the_robot_moves_or_not():
    assert "the model is thinking, 7 s" in strip_text(MotionView(), model_wait_s=7.9)
    assert "模型正在思考，0 秒" in strip_text(MotionView(), model_wait_s=0.1, language="zh")
    assert "the model is thinking, 7 s" in strip_text(moving_ride(), model_wait_s=7.9)
    assert "thinking" not in strip_text(MotionView()) + strip_text(moving_ride())
    for width in range(1, 120):
        assert max(map(len, strip_text(moving_ride(), width=width, model_wait_s=7.9).split("\n"))) <= width
        assert len(strip_text(MotionView(), width=width, model_wait_s=7.9)) <= width


def test_a_strip_shows_whole_hints_and_the_whole_percentage():
    assert strip_text(MotionView(), width=60).rstrip().endswith("Ctrl-C stops")
    assert strip_text(MotionView(), width=100).rstrip().endswith("Ctrl-D leaves")
    for width in (45, 52, 60, 100):
        assert "50 %" in strip_text(moving_ride(), width=width)


def test_a_strip_without_its_map_is_words_alone():
    strip = StatusBar(moving_ride(), Words(), EMPTY_WORLD)
    strip.shows_map = False
    assert "→" not in "".join(text for _, text in strip.fragments(100))


@pytest.mark.parametrize("moves", [True, False])
def test_the_strip_of_a_robot_without_odometry_says_so_and_tells_no_pose(moves: bool) -> None:
    motion_view = MotionView()
    motion_view.hear(Notice(0, Reason("open_loop", {})))
    motion_view.hear(Started(1, measured=False))
    if not moves:
        motion_view.hear(Finished(1, "completed", None, Pose(), Pose(), 0.0, 0.0, 1.0, 0.0, measured=False))
    shown = strip_text(motion_view)
    assert "not measured" in shown
    assert "0.00" not in shown
    assert "→" not in shown


# --- what is told ---


def test_a_plan_is_numbered_with_its_length_duration_and_findings():
    finding = FindingSeen(1, "warn", Reason("tight_place"), (1,), 1.0)
    text = told(
        Narrator(Words()),
        Interpreted(1, "offline", "repeat 4\n  drive 1 m\nend", "drive"),
        Rehearsed(1, True, 3.6, 1.0, Pose(1.0), (finding,), WAY),
    )
    assert re.search(r"plan  1\.00 m, 3\.6 s\n +1  repeat 4\n +2    drive 1 m\n +3  end\n +! ", text)


def test_a_long_plan_is_shown_in_part_and_whole_on_demand():
    narrator, plan_text = Narrator(Words()), "\n".join(f"drive {n} m" for n in range(1, 41))
    text = told(narrator, Interpreted(1, "offline", plan_text, ""), REHEARSED)
    assert text.count("drive ") == PLAN_LINES - 1
    assert "… 25 more lines" in text
    assert printed(*narrator.plan(plan_text, REHEARSED)).count("drive ") == 40


def test_what_a_plan_does_several_times_is_counted_and_numbered_where_it_begins():
    plan_text = "\n".join(["drive 0.5 m"] * 54 + ["wait 1 s"])
    text = told(Narrator(Words()), Interpreted(1, "offline", plan_text, ""), REHEARSED)
    assert re.search(r"\n +1  54 × drive 0\.5 m\n +55  wait 1 s\n", text)


def test_the_refusal_that_is_the_result_is_not_told_twice():
    hit = FindingSeen(1, "refuse", Reason("unknown_code_a"), (1,), 1.0)
    plan = (Interpreted(1, "offline", "drive 1 m", ""), Rehearsed(1, False, 1.0, 1.0, Pose(), (hit,), WAY))
    assert "unknown_code_a" not in told(Narrator(Words()), *plan)


@pytest.mark.parametrize(
    ("outcome", "mark"),
    [
        ("completed", "✓"),
        ("answered", "•"),
        ("unclear", "?"),
        ("refused", "✗"),
        ("stopped", "■"),
        ("failed", "✗"),
    ],
)
def test_every_outcome_has_its_mark(outcome, mark):
    assert told(Narrator(Words()), Result(1, outcome, "so it was")).strip() == f"{mark} so it was"


def test_what_the_governor_took_away_is_told():
    text = told(Narrator(Words()), Limited(1, "speed", Twist(2.0), Twist(1.0)))
    assert "2.00 m/s asked, 1.00 m/s allowed" in text


def test_wrapped_lines_hang_under_their_first_and_end_without_blanks():
    lines = told(Narrator(Words()), Result(1, "completed", "word " * 40)).splitlines()
    assert len(lines) > 1
    assert all(line.startswith("    ") for line in lines[1:])
    assert all(line == line.rstrip() for line in lines)


def test_markup_in_what_a_person_says_is_just_text():
    assert "[red]x[/red]" in told(Narrator(Words()), Result(1, "unclear", "[red]x[/red]"))


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
