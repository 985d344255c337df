from __future__ import annotations

import math
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.core.errors import PlanTextError
from chatrobot.plan.primitive import primitives
from chatrobot.plan.steps import (
    Arc,
    Drive,
    Face,
    Go,
    ObstacleWithin,
    Plan,
    RawTwist,
    Remember,
    Repeat,
    Say,
    Step,
    Turn,
    Wait,
)
from chatrobot.plan.text import MAX_LINE_CHARS, StreamParser, format_plan, format_step, parse_plan
from tests.plan.plans import plans

CANONICAL: list[tuple[str, Step]] = [
    ("drive 1 m", Drive(distance_m=1)),
    ("drive 2 s left at 0.2 m/s", Drive(duration_s=2, direction_rad=math.pi / 2, speed_mps=0.2)),
    ("drive 1 m back", Drive(distance_m=1, direction_rad=math.pi)),
    ("drive 1 m toward 45 deg", Drive(distance_m=1, direction_rad=math.pi / 4)),
    ("drive forward until obstacle within 0.5 m", Drive(until=ObstacleWithin(0.5))),
    ("drive 0.35 m right", Drive(distance_m=0.35, direction_rad=-math.pi / 2)),
    ("turn left 90 deg at 0.5 rad/s", Turn(angle_rad=math.pi / 2, rate_radps=0.5)),
    ("turn left 90 deg at 30 deg/s", Turn(angle_rad=math.pi / 2, rate_radps=math.radians(30))),
    ("turn right 2 s", Turn(duration_s=2, left=False)),
    ("turn left 0.5 rad", Turn(angle_rad=0.5)),
    ("arc left 90 deg radius 0.5 m", Arc(0.5, math.pi / 2)),
    ("arc back right 180 deg radius 1 m at 0.2 m/s", Arc(1, math.pi, False, True, 0.2)),
    ("twist 0.2 0 0.5 for 3 s", RawTwist(0.2, 0, 0.5, 3)),
    ("go to 1.2 -0.4", Go(1.2, -0.4)),
    ("go to 0 0 from start facing 0 deg", Go(0, 0, 0, "start")),
    ('go to 3 1 named "kitchen" at 0.4 m/s', Go(3, 1, place="kitchen", speed_mps=0.4)),
    ("face 90 deg", Face(math.pi / 2, "odom")),
    ("face 0 deg from start", Face(0, "start")),
    ("wait 3 s", Wait(3)),
    (
        "repeat 4\n  drive 1 m\n  turn left 90 deg\nend",
        Repeat(4, (Drive(distance_m=1), Turn(angle_rad=math.pi / 2))),
    ),
    ('say "hello"', Say("hello")),
    (r'say "a \"quoted\" # back\\slash"', Say(r'a "quoted" # back\slash')),
    ('remember "充电桩"', Remember("充电桩")),
]


@pytest.mark.parametrize(("text", "step"), CANONICAL)
def test_a_step_has_one_canonical_line(text: str, step: Step) -> None:
    assert format_step(step) == text
    assert parse_plan(text) == Plan((step,))


@pytest.mark.parametrize(
    ("loose", "canonical"),
    [
        ("DRIVE 1 Metre", "drive 1 m"),
        ("drive 50 cm backward at 20cm/s", "drive 0.5 m back at 0.2 m/s"),
        ("drive back 1m", "drive 1 m back"),
        ("drive for 2 seconds", "drive 2 s forward"),
        ("drive 1 m forward", "drive 1 m"),
        ("drive 3 ft", "drive 0.9144000000000001 m"),
        ("turn left 90°", "turn left 90 deg"),
        ("turn right by 1 rev at 30°/s", "turn right 360 deg at 30 deg/s"),
        ("arc forward left 90 degrees with radius 0.5", "arc left 90 deg radius 0.5 m"),
        ("twist 0.2 m/s 0 m/s 0.5 rad/s", "twist 0.2 0 0.5 for 1 s"),
        ("twist 0.2, 0, .5 for 1500 ms", "twist 0.2 0 0.5 for 1.5 s"),
        ("go to (1.2, -0.4)", "go to 1.2 -0.4"),
        ("go 1 m 2 m at 0.2 facing 90 deg", "go to 1 2 facing 90 deg at 0.2 m/s"),
        ("wait 2 minutes  # for the kettle", "wait 120 s"),
        ("say hello there # waves", 'say "hello there"'),
        ("remember my spot", 'remember "my spot"'),
        ("\r\n  # nothing\n\nwait 1 s\r\n", "wait 1 s"),
        ("repeat 2 times\nwait 1 s\nEND", "repeat 2\n  wait 1 s\nend"),
    ],
)
def test_reading_is_tolerant_and_writing_is_not(loose: str, canonical: str) -> None:
    written = format_plan(parse_plan(loose))
    assert written.replace(" forward", "") == canonical.replace(" forward", "")
    assert parse_plan(written) == parse_plan(loose)


@given(plans)
def test_every_valid_plan_survives_its_text_exactly(plan: Plan) -> None:
    text = format_plan(plan)
    assert parse_plan(text) == plan
    assert format_plan(parse_plan(text)) == text
    assert max(len(line.strip()) for line in text.split("\n")) <= MAX_LINE_CHARS


@given(plans, st.integers(1, 17))
def test_a_stream_gives_the_same_steps_whatever_the_pieces(plan: Plan, size: int) -> None:
    text = format_plan(plan)
    parser = StreamParser()
    got = [step for i in range(0, len(text), size) for step in parser.feed(text[i : i + size])]
    assert tuple(got + parser.finish()) == plan.steps


def test_a_step_comes_out_with_its_newline_and_a_block_with_its_end() -> None:
    parser = StreamParser()
    assert parser.feed("drive 1 m") == []
    assert parser.feed("\nrepeat 2\nwait 1 s\n") == [Drive(distance_m=1)]
    assert parser.feed("en") == []
    assert parser.feed("d\n") == [Repeat(2, (Wait(1),))]
    assert parser.finish() == []


def test_steps_before_a_bad_line_come_out_before_the_error() -> None:
    parser = StreamParser()
    assert parser.feed("drive 1 m\njump\nwait 1 s\n") == [Drive(distance_m=1)]
    for call in (lambda: parser.feed("wait 1 s\n"), parser.finish, parser.finish):
        with pytest.raises(PlanTextError) as caught:
            call()
        assert caught.value.line_number == 2


@pytest.mark.parametrize(
    ("text", "line", "part"),
    [
        ("", 0, "no step"),
        ("# only a comment", 0, "no step"),
        ("wait 1 s\nhop 3 m", 2, "one of: arc, drive"),
        ("drive", 1, "a distance such as 1 m"),
        ("drive 1", 1, "a distance such as 1 m or a time"),
        ("drive 1 m 2 s", 1, "forward, back"),
        ("drive 1 m at 0 m/s", 1, "above zero"),
        ("drive 1 m at 30 deg/s", 1, "'deg/s'"),
        ("drive nan m", 1, "'nan'"),
        ("drive inf m", 1, "'inf'"),
        ("drive 1e309 m", 1, "too large"),
        ("drive 1e308 km", 1, "too large"),
        ("drive -1 m", 1, "above zero"),
        ("drive until wall within 1 m", 1, "obstacle"),
        ("turn 90 deg", 1, "'left' or 'right'"),
        ("turn left 90", 1, "an angle such as 90 deg"),
        ("turn left 90 deg 2 s", 1, "end of the line"),
        ("arc left 90 deg", 1, "'radius'"),
        ("twist 1 2", 1, "rad/s counter-clockwise"),
        ("go to 1", 1, "a length"),
        ("go to 1 2 from odom", 1, "'start'"),
        ("face north", 1, "an angle"),
        ("wait 4000 s", 1, "at most 3600 s"),
        ("say", 1, "a text"),
        ('say "open', 1, "not closed"),
        ('say "a" "b"', 1, "end of the line"),
        ("say a\u2028x", 1, "printable"),
        ('remember ""', 1, "printable name"),
        ("repeat 2.5\nwait 1 s\nend", 1, "whole number"),
        ("repeat 0\nwait 1 s\nend", 1, "1 to 1000"),
        ("repeat 2\nend", 2, "at least one step"),
        ("wait 1 s\nrepeat 2\nwait 1 s", 2, "not closed"),
        ("end", 1, "no block"),
        ("42", 1, "one of"),
        ("drive 1 m $", 1, "'$'"),
        ("wait 1 s #" + "x" * 400, 1, "at most 400"),
    ],
)
def test_a_mistake_is_named_with_its_line_and_what_is_allowed(text: str, line: int, part: str) -> None:
    with pytest.raises(PlanTextError) as caught:
        parse_plan(text)
    assert caught.value.line_number == line
    assert part in str(caught.value)


def nested(depth: int) -> str:
    return "repeat 1\n" * depth + "wait 1 s\n" + "end\n" * depth


@pytest.mark.parametrize(
    ("fits", "too_much"),
    [
        (nested(8), nested(9)),
        ("wait 1 s\n" * 999 + "wait 1 s", "wait 1 s\n" * 1001),
        ("repeat 1000\n" + "wait 1 s\n" * 10 + "end", "repeat 1000\n" + "wait 1 s\n" * 11 + "end"),
        ("repeat 1000\n" * 1 + "wait 1 s\n" + "end\n", "repeat 1000\n" * 4 + "wait 1 s\n" + "end\n" * 4),
    ],
)
def test_sizes_are_bounded(fits: str, too_much: str) -> None:
    parse_plan(fits)
    with pytest.raises(PlanTextError):
        parse_plan(too_much)


def test_a_stream_counts_the_steps_of_all_its_blocks() -> None:
    block = "repeat 1000\n" + "wait 1 s\n" * 6 + "end\n"
    parser = StreamParser()
    assert len(parser.feed(block)) == 1
    with pytest.raises(PlanTextError, match="more than 10000 steps"):
        parser.feed(block)


def test_an_endless_line_is_refused_before_it_ends() -> None:
    parser = StreamParser()
    for _ in range(30):
        parser.feed("say a a a a ")
    with pytest.raises(PlanTextError, match="at most 400"):
        parser.feed("say a" * 20)


@given(st.text(max_size=200))
def test_any_text_is_a_plan_or_a_plan_text_error(text: str) -> None:
    try:
        plan = parse_plan(text)
    except PlanTextError:
        return
    assert parse_plan(format_plan(plan)) == plan


VOCABULARY = """drive turn arc twist go to face wait repeat end say remember left right back at until obstacle within
radius from start facing named for 1 -2 0.5 1e400 m s deg rad/s m/s ° " # ( nan"""
WORDS = st.sampled_from([*VOCABULARY.split(), "\n"])


@given(st.lists(WORDS, max_size=30).map(" ".join))
def test_any_heap_of_our_own_words_is_a_plan_or_a_plan_text_error(text: str) -> None:
    try:
        plan = parse_plan(text)
    except PlanTextError:
        return
    assert parse_plan(format_plan(plan)) == plan


def test_every_primitive_has_examples_that_parse_to_its_own_step() -> None:
    for primitive in primitives():
        assert primitive.examples
        assert primitive.help
        for example in primitive.examples:
            (step,) = parse_plan(example).steps
            assert type(step) is primitive.step_type
            assert format_step(step) == example


def test_plan_text_needs_neither_numpy_nor_pydantic() -> None:
    code = (
        "import sys; from chatrobot.plan.text import parse_plan; parse_plan('drive 1 m');"
        "import chatrobot.plan.lowering, chatrobot.plan.trajectory;"
        "print([m for m in ('numpy', 'pydantic', 'yaml', 'importlib.metadata') if m in sys.modules])"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == "[]"
