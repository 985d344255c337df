"""Questions about places get true answers, by the way that would be driven, and move nothing."""

from __future__ import annotations

import math

import pytest

from chatrobot.core.geometry import Pose
from chatrobot.dialogue.places import MapWays
from chatrobot.dialogue.understanding import Understanding
from chatrobot.language.context import RobotState
from chatrobot.language.interpretation import Interpretation
from chatrobot.plan.steps import Go
from chatrobot.plan.text import format_plan
from chatrobot.robots.load import DEFAULT_PROFILE, load_profile
from chatrobot.sim.load import load_world
from chatrobot.sim.world import World

PROFILE = load_profile(DEFAULT_PROFILE)
HOME = load_world("home")
PLACES = World(
    "bare",
    places={"shelf": Pose(3.0, 4.0), "lamp": Pose(0.0, 1.0)},
    aliases={"shelf": "shelf", "lamp": "lamp"},
)


def asked(text: str, world: World = HOME, pose: Pose = Pose()) -> Interpretation:  # noqa: B008 - a value
    understanding = Understanding(PROFILE, world, None)
    understanding._state = RobotState(pose)
    return understanding.interpret(text)


@pytest.mark.parametrize(
    "text", ["where is the kitchen?", "how far is it to the kitchen?", "how far is the kitchen"]
)
def test_the_way_is_as_long_as_the_one_that_would_be_driven(text: str) -> None:
    kitchen = HOME.places["kitchen"]
    way_m = MapWays(HOME, PROFILE)(Pose(), kitchen)
    assert way_m is not None
    assert way_m > math.hypot(kitchen.x_m, kitchen.y_m) + 0.05
    meant = asked(text)
    assert meant.plan is None
    assert meant.reply == f"The kitchen is ahead of me, {way_m:.2f} m by the way I would drive."


def test_without_a_map_it_is_told_straight_and_said_so() -> None:
    assert (
        asked("where is the shelf?", PLACES).reply
        == "The shelf is ahead of me to the left, 5.00 m in a straight line."
    )


def test_the_side_is_the_robots_own() -> None:
    behind = Pose(0.0, 2.0, math.pi / 2)
    assert asked("where is the lamp?", PLACES, behind).reply.startswith("The lamp is behind me, 1.00 m")
    assert asked("is the lamp on the left?", PLACES).reply.startswith("Yes. The lamp is to my left")
    assert asked("is the lamp on the left?", PLACES, behind).reply.startswith("No. The lamp is behind me")
    assert asked("where is the lamp?", PLACES, Pose(0.0, 1.0)).reply == "I am there: this is the lamp."


@pytest.mark.parametrize("text", ["which place is nearest?", "哪个地方最近？"])
def test_the_nearest_is_that_by_the_way(text: str) -> None:
    ways = MapWays(HOME, PROFILE)
    far = {
        name: way
        for name, pose in HOME.places.items()
        if (way := ways(Pose(), pose)) is not None and way > 0.25
    }
    assert f"{min(far.values()):.2f}" in asked(text).reply


@pytest.mark.parametrize(
    ("text", "near"), [("where is the televisn?", "TV"), ("how far is the charging dok?", "charging dock")]
)
def test_a_place_that_is_meant_is_shown_as_it_is_written_and_once(text: str, near: str) -> None:
    assert asked(text).reply.endswith(f"Did you mean one of these: {near}?")


@pytest.mark.parametrize(
    ("text", "told"),
    [("厨房在哪里", "厨房在我的正前方"), ("厨房在左边吗？", "不是。"), ("离厨房还有多远", "按我会走的路"),
     ("你知道哪些地方", "冰箱"),
     ("where is the kichen?", "Did you mean one of these: kitchen?"), ("where is the moon?", "Places I know: kitchen"),
     ("how far are you from the start?", "this is the start"), ("which places do you know?", "fridge"),
     ("could you show me where the fridge is", "The fridge is"),
     ("what is near the fridge?", "Nearest to the fridge: kitchen"),
     ("is it far?", "Which place do you mean?"), ("how far is it", "Which place do you mean?"),
     ("冰箱旁边有什么", "离冰箱最近的"), ("远吗", "你问的是哪个地方")],
)  # fmt: skip
def test_what_is_asked_is_answered(text: str, told: str) -> None:
    meant = asked(text)
    assert (meant.outcome, meant.plan) == ("answered", None)
    assert told in meant.reply


@pytest.mark.parametrize(
    ("text", "outcome"),
    [("go to the kitchen", "plan"), ("能去厨房吗", "plan"), ("where is the kitchen? go there", "unclear"),
     ("how far is 2 m", "unclear"), ("两米有多远啊", "unclear")],
)  # fmt: skip
def test_nothing_else_is_taken_for_such_a_question(text: str, outcome: str) -> None:
    assert asked(text).outcome == outcome


def test_a_robot_that_has_not_said_where_it_is_tells_no_distance() -> None:
    understanding = Understanding(PROFILE, HOME, None)
    assert "odometry" in understanding.interpret("where is the kitchen?").reply


@pytest.mark.parametrize(
    ("text", "reply"),
    [
        ("what is in front of you?", "The nearest thing ahead of me is 2.40 m away."),
        ("is there anything on your left?", "The nearest thing to my left is 0.80 m away."),
        ("how much room is there behind you?", "I see nothing behind me."),
        (
            "what is near you?",
            "The nearest things: ahead of me 2.40 m, to my left 0.80 m, to my right 1.50 m.",
        ),
        ("你左边有什么？", "我左边最近的东西有 0.80 米远。"),
        ("Was ist vor dir?", "Das Nächste vor mir ist 2,40 m entfernt."),
    ],
)
def test_what_is_on_a_side_is_what_the_lidar_sees_there(text: str, reply: str) -> None:
    understanding = Understanding(PROFILE, HOME, None)
    understanding._state = RobotState(sectors_m=(2.4, 3.0, 0.8, None, None, 1.9, 1.5, 2.0))
    assert understanding.interpret(text).reply == reply


def test_without_a_lidar_it_says_that_it_cannot_see() -> None:
    assert asked("what is on your right?").reply.startswith("I cannot see that")


@pytest.mark.parametrize(
    "text",
    ["how far from start are you?", "how far from start", "离起点多远", "Wie weit bist du vom Start weg?"],
)
def test_the_way_to_a_near_place_is_told_in_centimetres(text: str) -> None:
    assert "0.20" in asked(text, pose=Pose(0.2, 0.0)).reply.replace(",", ".")


@pytest.mark.parametrize(
    "text",
    [
        "go 50 cm closer to the sofa",
        "geh 50 cm näher ans Sofa",
        "离沙发近半米",
        "drive until you are one metre from the sofa",
        "keep going until there's half a metre to the sofa",
    ],
)
def test_a_distance_to_a_known_place_is_a_way_to_it(text: str) -> None:
    """The sofa is behind: none of these drives ahead."""
    plan = asked(text).plan
    assert plan is not None
    (step,) = plan.steps
    assert isinstance(step, Go)
    assert step.x_m is not None
    assert step.x_m < -0.1


@pytest.mark.parametrize(
    "text",
    [
        "back up until you are 30 cm from the door",
        "rückwärts bis 30 cm vor der Tür",
        "后退到离门三十厘米的地方",
    ],
)
def test_a_way_back_to_a_place_that_may_be_elsewhere_is_asked_about(text: str) -> None:
    assert asked(text).plan is None


def test_what_is_no_place_is_seen_by_a_sensor() -> None:
    plan = asked("drive until you are 50 cm from the wall").plan
    assert plan is not None
    assert format_plan(plan) == "drive forward until obstacle within 0.5 m"


def test_whether_it_is_at_a_place_is_answered_by_where_that_is() -> None:
    assert asked("are you at the sofa now?").reply.startswith("The sofa is behind me")


@pytest.mark.parametrize("text", ["drive until you are 50 cm from the board", "一直往前走，直到离黑板50厘米"])
def test_what_is_driven_to_anyway_is_seen_by_a_sensor(text: str) -> None:
    plan = asked(text, load_world("classroom")).plan
    assert plan is not None
    assert format_plan(plan) == "drive forward until obstacle within 0.5 m"
