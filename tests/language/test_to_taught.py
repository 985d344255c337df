"""A place that a person taught is gone to in whatever words order it; so is the one that a motion ended at."""

from __future__ import annotations

import pytest

from tests.language.dialogue_runner import conversation
from tests.language.test_usual import done


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("go 2 m, and the place there will be called mesa", "turn right", "Again to the mesa"), "2 0 mesa"),
        (("Go 1 m. That place there we call the gate", "slide left 1 m", "To the gate again."), "1 0 gate"),
        (("move 2 m ahead and there is the scale", "back 1 m", "over to the scale"), "2 0 scale"),
        (("this place have name door seven", "go 2 m", "go again to door seven"), "0 0 door seven"),
        (("this is the pirate harbour", "go 2 m", "back to the harbour, captain"), "0 0 pirate harbour"),
        (
            ("this is the frog pond", "go 2 m", "the little frog is homesick now, back to the pond with you"),
            "0 0 frog pond",
        ),
        (("this is the sink", "go 1 m", "oh dear, water everywhere. Off to the sink!"), "0 0 sink"),
        (("Fahr 1 m vor. Die Stelle dort nennen wir Tor", "1 m zurück", "Zum Tor"), "1 0 tor"),
        (("2 m geradeaus, und dort ist dann die Waage", "1 m zurück", "zur Waage"), "2 0 waage"),
        (("Hier, wo Sie jetzt stehen, ist das Labor", "1 m vor", "Zurück ins Labor"), "0 0 labor"),
        (("Da wo de getz stehst, dat is Ampel B", "1 m vor", "wieder hin zu Ampel B"), "0 0 ampel b"),
        (("Hier ist die Garage", "1 m vor", "So, Schlafenszeit, ab in die Garage mit dir!"), "0 0 garage"),
        (("Fahr 1 m vor, die Stelle dort heißt Punkt A.", "1 m links", "Wieder zu A, bitte."), "1 0 a"),
        (("走1米，到了那儿就是幼儿园", "后退1米", "哎呀书包忘拿了，再去一趟幼儿园"), "1 0 幼儿园"),
        (("这里是妞妞家", "前进1米", "放学啦，开回妞妞家"), "0 0 妞妞家"),
        (("这里是甲点", "前进1米，那里是乙点", "左移1米", "不用经过乙点，直接回甲点"), "0 0 甲点"),
        (("这儿就是青蛙池塘，记住了", "前进1米", "回池塘去吧"), "0 0 青蛙池塘"),
    ],
)
def test_a_taught_place_is_gone_to(turns: tuple[str, ...], plan: str) -> None:
    x_m, y_m, name = plan.split(" ", 2)
    assert done(*turns) == f'go to {x_m} {y_m} named "{name}"'


def test_half_the_way_to_it() -> None:
    taught = ("this is the printer", "go 2 m")
    assert done(*taught, "towards the printer again, but stop halfway") == "go to 1 0"
    assert (
        done("Hier ist die Waage", "2 m vor", "wieder Richtung Waage, aber auf halbem Weg anhalten")
        == "go to 1 0"
    )


def test_what_says_how_to_go_there_stays() -> None:
    taught = ("this is the mesa", "go 1 m")
    assert done(*taught, "back to the mesa but slowly") == 'go to 0 0 named "mesa" at 0.15 m/s'
    assert done(*taught, "Back to the mesa, don't turn round, just reverse.") == "drive 1 m back"


@pytest.mark.parametrize(
    "turns",
    [
        ("this is the red door", "this is the blue door", "go 1 m", "back to the door"),
        ("this is the bakery", "go 1 m", "my sister wants to go back to the bakery"),
        ("this is the bakery", "go 1 m", "back to the bakery, said grandpa"),
        ("this is the pond", "go 1 m", "drive into the water"),
        ("Hier ist die Waage", "1 m vor", "Die Waage wieder, die spinnt"),
        ("这里是医院", "前进1米", "他想再去一趟医院"),
        ("the place there will be called mesa",),
    ],
)
def test_what_orders_nothing_stays_still(turns: tuple[str, ...]) -> None:
    assert conversation(*turns[:-1]).say(turns[-1]).plan is None
