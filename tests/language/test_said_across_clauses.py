"""What is said once for several clauses: where a loop ends, brackets, units, sums, and what is taken back."""

from __future__ import annotations

import math

import pytest

from chatrobot.plan.steps import Drive, Plan, Step, Turn
from chatrobot.plan.text import format_plan
from tests.language.dialogue_runner import Conversation


def _after(*turns: str) -> list[Step]:
    talk = Conversation()
    last = [talk.say(turn) for turn in turns][-1]
    return list(last.plan.steps) if last.plan else []


def _lengths(*turns: str) -> list[float]:
    """Metres of each drive, below zero backwards."""
    drives = [s for s in _after(*turns) if isinstance(s, Drive) and s.distance_m]
    return [round((s.distance_m or 0.0) * math.cos(s.direction_rad), 3) for s in drives]


@pytest.mark.parametrize(
    "said",
    [
        "twice: (left 90, forward 1 m) and after all that reverse 50 cm",
        "do this twice: left 90, forward 1 m. Finally go back 50 cm.",
        "(left 90, forward 1 m) twice, then back 50 cm",
    ],
)
def test_a_loop_ends_where_the_person_says_so(said: str) -> None:
    assert _lengths(said) == [1.0, 1.0, -0.5]


def test_brackets_are_repeated_as_one_in_the_midst_of_a_sentence() -> None:
    steps = _after("forward 1 m, (left 90, forward 50 cm) twice")
    assert [type(step) for step in steps] == [Drive, Turn, Drive, Turn, Drive]
    assert steps == _after("forward 1 m, then twice (left 90, forward 50 cm)")


@pytest.mark.parametrize(
    ("said", "metres"),
    [
        ("two metres minus fifty centimetres, straight ahead", [1.5]),
        ("go twice as far as 60 cm", [1.2]),
        ("half as many metres as a car has wheels, backwards", [-2.0]),
        ("left 90, fwd 50, right 90, fwd 20, centimetres both", [0.5, 0.2]),
        ("fwd 1 / left 90 / fwd 0.5 (metres and degrees)", [1.0, 0.5]),
        ("forward 50 cm, left 90, forward 30", [0.5, 0.3]),
        ("forward 1 m then back 50", []),
    ],
)
def test_amounts_told_by_way_of_others(said: str, metres: list[float]) -> None:
    assert _lengths(said) == metres


def test_undoing_goes_on_to_what_was_before() -> None:
    assert _lengths("forward 2 m", "left 90", "undo", "undo") == [-2.0]
    assert _lengths("forward 2 m", "forward 1 m", "undo both") == [-1.0, -2.0]
    assert _after("forward 2 m", "undo the last three") == []


def test_a_bit_more_is_the_same_way_again() -> None:
    (step,) = _after("turn right a bit", "a bit more")
    assert isinstance(step, Turn)
    assert not step.left
    assert step.angle_rad == pytest.approx(math.pi / 4)


def test_another_motion_after_coming_back_is_not_its_amount() -> None:
    assert _lengths("a metre out at 30 degrees left, come back, and a metre forward")[-1] == 1.0


@pytest.mark.parametrize(
    ("said", "metres"),
    [
        ("go one metre forward if 2 is bigger than 3, otherwise one metre back", [-1.0]),
        ("go one metre forward if 3 is bigger than 2, otherwise two metres back", [1.0]),
        ("back 50 cm. then go one metre forward if 2 is bigger than 3, otherwise 20 cm back", [-0.5, -0.2]),
        ("go one metre forward if 2 is bigger than 3", []),
    ],
)
def test_a_condition_said_afterwards_holds_for_what_is_before_it(said: str, metres: list[float]) -> None:
    assert _lengths(said) == metres


@pytest.mark.parametrize("said", ["go to my room", "drive a few of those units forward", "face the start"])
def test_what_is_not_known_is_asked_about(said: str) -> None:
    assert _after(said) == []


def test_the_same_radius_is_the_one_before() -> None:
    steps = _after("quarter circle right of 1 m radius, then a quarter circle left of the same radius")
    assert [getattr(step, "radius_m", None) for step in steps] == [1.0, 1.0]


def test_the_way_back_is_as_long_as_all_that_was_repeated() -> None:
    assert _lengths("forward 20 cm, three times, then come back") == [0.2, 0.2, 0.2, -0.2, -0.2, -0.2]


def test_at_the_end_comes_after_what_was_put_first() -> None:
    said = "Turn left 90 degrees, but before that go forward half a metre, and at the end go back 20 cm."
    assert [type(step) for step in _after(said)] == [Drive, Turn, Drive]


def test_a_turn_is_undone_only_where_the_last_motion_was_one() -> None:
    assert len(_after("forward 1 m", "left 90", "undo the turn")) == 1
    assert _after("left 90", "forward 1 m", "undo the turn") == []


def test_brackets_are_read_in_chinese_too() -> None:
    once = [Turn, Drive]
    steps = _after("两遍（左转90度，前进1米），之后后退半米")
    assert [type(step) for step in steps] == [*once, *once, Drive]


@pytest.mark.parametrize(
    ("said", "times"),
    [
        ("前进，前进，再前进，每次半米", 3),
        ("前进，前进，前进，都是半米", 3),
        ("后退，后退，每次半米", 2),
        ("forward, forward, and forward, half a metre each time", 3),
        ("go forward, go forward, 50 cm each", 2),
    ],
)
def test_a_motion_said_again_counts_again_where_each_one_has_its_amount(said: str, times: int) -> None:
    assert [abs(metres) for metres in _lengths(said)] == [0.5] * times


@pytest.mark.parametrize("said", ["left, left, left 30 degrees each", "左转，左转，再左转，每次三十度"])
def test_a_turn_said_again_turns_by_its_own_angle(said: str) -> None:
    turns = [step for step in _after(said) if isinstance(step, Turn)]
    assert [math.degrees(turn.angle_rad or 0.0) for turn in turns] == pytest.approx([30.0] * 3)


def test_a_motion_said_again_without_an_amount_only_urges() -> None:
    assert len(_after("前进，前进")) == 1


ITEMS = ("forward 1 m", "turn left 90 degrees", "2 m forward")
ITEMS_ZH = ("前进一米", "左转九十度", "2米前进")


@pytest.mark.parametrize("mark", ["{n}. ", "{n}, ", "{n}) ", "{n}: ", "({n}) ", "- "])
@pytest.mark.parametrize("heading", ["", "do this:", "here is the plan:", "follow these steps in order:"])
def test_a_list_is_a_sequence_however_it_is_numbered(mark: str, heading: str) -> None:
    lines = [f"{mark.format(n=n)}{item}" for n, item in enumerate(ITEMS, 1)]
    assert _after("\n".join([heading, *lines])) == _after(", then ".join(ITEMS))


@pytest.mark.parametrize("mark", ["{n}、", "{n}，", "{n}. ", "{n}：", "- "])
@pytest.mark.parametrize("heading", ["", "计划：", "按下面的步骤做："])
def test_a_chinese_list_is_a_sequence_however_it_is_numbered(mark: str, heading: str) -> None:
    lines = [f"{mark.format(n=n)}{item}" for n, item in enumerate(ITEMS_ZH[: 2 if "，" in mark else 3], 1)]
    steps = _after("\n".join([heading, *lines]))
    assert [type(step) for step in steps] == [Drive, Turn, Drive][: len(lines)]


def test_numbers_that_do_not_count_a_list_are_asked_about() -> None:
    assert not _after("1, forward 1 m\n3, turn left")
    assert not _after("never do this:\n1, forward 1 m\n2, turn left")


def test_numbered_items_may_stand_on_one_line() -> None:
    assert _after("1、前进一米；2、左转九十度") == _after("前进一米，然后左转九十度")


@pytest.mark.parametrize(
    ("said", "first"),
    [
        ("两米乘一米的矩形", 2.0),
        ("走一个1米乘2米的长方形", 1.0),
        ("画一个长方形，两米乘一米", 2.0),
        ("draw a 2 m by 1 m rectangle", 2.0),
        ("a rectangle 1 m by 2 m", 1.0),
    ],
)
def test_a_rectangle_begins_with_the_side_that_is_said_first(said: str, first: float) -> None:
    assert [abs(metres) for metres in _lengths(said)] == [first, 3.0 - first] * 2


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("turn left, but only after 3 seconds", "wait 3 s\nturn left 90 deg"),
        ("drive forward 1 m, but only after 5 seconds", "wait 5 s\ndrive 1 m"),
        ("back up 50 cm, only after two seconds", "wait 2 s\ndrive 0.5 m back"),
        ("turn right 45 degrees, after 3 s", "wait 3 s\nturn right 45 deg"),
        ("forward, and after 3 seconds stop", "drive 3 s"),
    ],
)
def test_a_delay_said_after_a_comma_comes_first(said: str, plan: str) -> None:
    assert format_plan(Plan(tuple(_after(said)))) == plan


@pytest.mark.parametrize("said", ["左转，但是3秒之后", "右转，但两秒之后"])
def test_a_text_that_ends_with_a_delay_in_chinese_is_asked_about(said: str) -> None:
    assert not _after(said)


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        (
            "forward 1 m, then go back to the start and face where you started",
            "{way}drive 1 m back\nface 0 deg",
        ),
        (
            "forward 1 m, turn left, then return to the start and face your original direction",
            "{turned}face 0 deg",
        ),
        ("forward 1 m, turn left, back to the start, facing the way you started", "{turned}face 0 deg"),
        ("前进一米，左转，然后回到起点，面向最初的方向", "{turned}face 0 deg"),
    ],
)
def test_the_return_to_the_start_comes_before_the_facing(said: str, plan: str) -> None:
    way = "drive 1 m\n"
    whole = plan.format(way=way, turned=f"{way}turn left 90 deg\ngo to 0 0 from start\n")
    assert format_plan(Plan(tuple(_after(said)))) == f"{whole} from start"


@pytest.mark.parametrize(
    "said", ["while turning left 90 degrees, go forward 1 m", "meanwhile turn left, then go forward 1 m"]
)
def test_a_turn_beside_what_it_joins_no_motion_with_is_asked_about(said: str) -> None:
    assert _after(said) == []


def test_a_turn_meanwhile_beside_nothing_is_a_turn() -> None:
    assert [type(step) for step in _after("meanwhile turn left")] == [Turn]


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("sidestep 40 centimetres to the left, then 40 to the right", "drive 0.4 m left\ndrive 0.4 m right"),
        ("往左平移40厘米，再往右40", "drive 0.4 m left\ndrive 0.4 m right"),
        ("fahr 2x 50 cm vor und wieder 50 zurück", "\n".join(["drive 0.5 m", "drive 0.5 m back"] * 2)),
        (
            "erst 50 cm vor, dann rechts abbiegen und nochmal 50 cm",
            "drive 0.5 m\nturn right 90 deg\ndrive 0.5 m",
        ),
        ("slide left 30 cm, then right 90", "drive 0.3 m left\nturn right 90 deg"),
        ("2 metres forward, then one further metre", "drive 2 m\ndrive 1 m"),
        ("keep rolling ahead for eight seconds and then quit", "drive 8 s"),
        ("往右拐个半圆,半径0.5米,半圆走完直行1米", "arc right 180 deg radius 0.5 m\ndrive 1 m"),
        ("先按0.2 m/s走1米,紧接着提到0.6 m/s再走1米", "drive 1 m at 0.2 m/s\ndrive 1 m at 0.6 m/s"),
    ],
)
def test_a_unit_or_a_speed_holds_for_what_is_alike_behind_it(said: str, plan: str) -> None:
    assert format_plan(Plan(tuple(_after(said)))).strip() == plan
