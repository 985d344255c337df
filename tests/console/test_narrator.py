"""What the console tells of each event, and of places."""

import re

import pytest
from rich.console import Console

from chatrobot.cli.console.commands import COMMANDS
from chatrobot.cli.console.lines import shown
from chatrobot.cli.console.tables import help_table, place_in, places_table, robot_tables
from chatrobot.cli.console.words import Words
from chatrobot.cli.narrator import PLAN_LINES, Narrator
from chatrobot.core.events import (
    FindingSeen,
    Interpreted,
    Limited,
    Rehearsed,
    Result,
)
from chatrobot.core.geometry import Pose, Twist
from chatrobot.core.reason import Reason
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.context import Place
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world

HOME = load_world("home")
WAY = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0))
REHEARSED = Rehearsed(1, True, 3.6, 1.0, Pose(1.0), (), WAY)
UNDERSTANDING = Understanding(load_profile("wheeltec_mini_mec"), HOME, None)


def printed(*renderables, width=80):
    console = Console(width=width, no_color=True, force_terminal=False)
    with console.capture() as capture:
        console.print(*renderables, sep="\n")
    return capture.get()


def told(narrator, *events):
    return printed(*(shown(line) for event in events for line in narrator.tell(event)))


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
    assert printed(*map(shown, narrator.plan(plan_text, REHEARSED))).count("drive ") == 40


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


def test_a_narrow_terminal_tells_all_that_a_wide_one_does():
    commands = [(command.typed, command.help_code) for command in COMMANDS]
    tables = [
        help_table(Words(), HOME, commands),
        *robot_tables(Words(), load_profile("turtlebot4")),
        places_table(Words(), HOME, {}),
    ]
    narrow = printed(*tables, width=42)
    told = set(printed(*tables, width=200).split()) - {"place", "where", "also", "called", "limit", "source"}
    assert told <= set(narrow.split())
    assert max(map(len, narrow.splitlines())) <= 42


@pytest.mark.parametrize("language", ["en", "zh"])
def test_places_are_listed_once_each_in_the_askers_language(language):
    lines = printed(places_table(Words(language), HOME, {"TV": Place(Pose())}), width=200).splitlines()[1:]
    names = [re.split(r"\s{2,}", line.strip())[0] for line in lines]
    assert names == ["TV", *(place_in(language, HOME, name) for name in HOME.places if name != "TV")]
    text = {"en": "what places do you know?", "zh": "你记住了哪些地方？"}[language]
    reply = UNDERSTANDING.interpret(text).reply
    listed = re.split(", |，", reply.partition(": " if language == "en" else "：")[2].rstrip(".。"))
    assert listed == [place_in(language, HOME, name) for name in HOME.places]
