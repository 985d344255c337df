"""What people said at the console and was done wrongly, or not at all: wordings of questions, places, shapes."""

from __future__ import annotations

import pytest

from tests.dialogue.talk import Talk
from tests.language.dialogue_runner import conversation, plan_of


@pytest.mark.parametrize(
    "text", ["Fahr mal ein Quadrat", "Jetzt fährst du mal ein Quadrat", "Fährst du mal ein Quadrat?"]
)
def test_what_is_driven_for_once_is_the_whole_square(text: str) -> None:
    assert plan_of(text).count("turn left 90 deg") == 4 or "repeat 4" in plan_of(text)


@pytest.mark.parametrize(
    "text", ["now the same square, but only half as big", "that square again but half the size"]
)
@pytest.mark.parametrize("between", ["turn around once", "turn left 90", "forward 20 cm"])
def test_a_figure_that_is_named_is_the_last_of_its_kind(text: str, between: str) -> None:
    plan = plan_of("drive a square with 30 cm sides", between, text)
    assert plan.count("drive 0.15 m") == 4 or "drive 0.15 m" in plan.split("repeat 4")[-1]


@pytest.mark.parametrize(
    ("text", "plan"),
    [
        ("turn quite around", "turn left 360 deg"),
        ("dreh dich mal ganz um dich rum", "turn left 360 deg"),
        ("look around", "turn left 360 deg"),
        ("schau dich um", "turn left 360 deg"),
        ("forward until the obstacle, but keep 10 cm away", "drive forward until obstacle within 0.1 m"),
        ("Vorwärts bis zum Hindernis, aber 10 cm Abstand halten", "drive forward until obstacle within 0.1 m"),
        ("fahre ein halben meter fort werts", "drive 0.5 m"),
        ("dreh dich nach lings", "turn left 90 deg"),
    ],
)  # fmt: skip
def test_it_is_read_as_it_was_meant(text: str, plan: str) -> None:
    assert plan_of(text) == plan


@pytest.mark.parametrize("text", ["speed to 0.1", "Tempo auf 0,1", "set the speed to 0.1 m/s"])
def test_a_speed_alone_is_the_usual_one_from_then_on(text: str) -> None:
    assert conversation(text).say("forward 1 m").plan is not None
    assert plan_of(text, "einen Meter vor") == "drive 1 m at 0.1 m/s"


@pytest.mark.parametrize(
    ("text", "places"),
    [
        ("visit the kitchen, the sofa and the desk", 3),
        ("go to the kitchen, the sofa and the desk", 3),
        ("fahr zum Sofa, zum Tisch und in die Küche", 3),
        ("go to the sofa, the cat is on it", 1),
    ],
)
def test_every_place_of_a_list_is_gone_to(text: str, places: int) -> None:
    understanding = Talk(world="home").session.understanding
    plan = understanding.would_mean(text).plan
    assert plan is not None
    assert len(plan.steps) == places


@pytest.mark.parametrize(
    "text", ["fahr zum Schreibtsich", "fahr zum Kühlschrnk", "go to the charging dok", "go to the kitchn"]
)
def test_a_misspelt_place_is_proposed_in_every_language(text: str) -> None:
    assert Talk(world="home").do(text).proposal is not None


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("wo bist du", "Ich bin bei „Küche“"),
        ("Wo biste grad?", "Ich bin bei „Küche“"),
        ("where are you?", "I am at “kitchen”"),
        ("你在哪里", "我在厨房"),
        ("Wo kannst du hin?", "Orte, die ich kenne"),
        ("Wie weit bist du von der Tür weg?", "„Tür“ ist"),
        ("was haste jetz gemacht?", "Das war „go to the kitchen“"),
    ],
)
def test_it_is_answered(text: str, told: str) -> None:
    talk = Talk(world="home")
    talk.do("go to the kitchen")
    assert told in talk.do(text).reply


@pytest.mark.parametrize("text", ["look at it go!", "wow, watch it turn left", "mum, look at it spin"])
def test_what_is_said_to_somebody_else_of_the_motion_moves_nothing(text: str) -> None:
    assert conversation("forward 1 m").say(text).plan is None


@pytest.mark.parametrize(
    "text",
    [
        "what would happen if you turned left?",
        "was passiert, wenn du dich nach links drehst?",
        "如果你左转会怎么样",
    ],
)
def test_what_would_happen_is_told_and_not_done(text: str) -> None:
    meant = conversation().say(text)
    assert (meant.outcome, meant.plan) == ("answered", None)
    assert "90" in meant.reply


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("turn left", "I said left 45"), "turn right 45 deg"),
        (("slide right 40 cm", "scoot back over"), "drive 0.4 m left"),
        (
            ("a circle to the left, radius 40 cm", "half circle, same radius, to the right"),
            "arc right 180 deg radius 0.4 m",
        ),
        (("画个左圈半径50厘米",), "arc left 360 deg radius 0.5 m"),
    ],
)  # fmt: skip
def test_what_follows_has_the_measure_of_before(turns: tuple[str, ...], plan: str) -> None:
    assert plan_of(*turns) == plan
