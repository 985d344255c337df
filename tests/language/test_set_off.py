"""What an order is for, like or called is left out beside it; what quotes it, bounds it or takes it back never is."""

from __future__ import annotations

from pathlib import Path

import pytest

from chatrobot.plan.text import format_plan, parse_plan
from tests.language.dialogue_runner import Conversation

STILL = (Path(__file__).parent / "set_off_still.txt").read_text(encoding="utf-8").splitlines()[1:]

ORDERS = [
    ("strafe right 1.2 m so the crash cart can get by", "drive right 1.2 m"),
    ("wait ten seconds so the tech can unload you, then reverse a metre", "wait 10 s; drive back 1 m"),
    ("back a metre, wait five seconds while I pour the tea, then ahead 1 m",
     "drive back 1 m; wait 5 s; drive forward 1 m"),
    ("turn right 90 degrees so you're square with the corridor again", "turn right 90 degrees"),
    ("forward 1 metre like you're sneaking up on a cat", "drive forward 1 m"),
    ("leaving the dock: reverse 60 cm, turn left 90 degrees", "drive back 0.6 m; turn left 90 degrees"),
    ("a metre forward, and yes I know we're imperial here", "drive forward 1 m"),
    ("turn left 90 degrees, that's the route to the vaccine fridge", "turn left 90 degrees"),
    ("zwei Meter zurück, damit der Schlauchwagen durchpasst", "drive back 2 m"),
    ("fahr zwei Meter vor, wie beim Löschangriff geübt", "drive forward 2 m"),
    ("drei Sekunden warten, weil die Ampel rot ist, dann einen Meter vor", "wait 3 s; drive forward 1 m"),
    ("dreiviertel Meter vor, dann bist du in der Bauecke", "drive forward 0.75 m"),
    ("往右转四十五度，跟转台似的", "turn right 45 degrees"),
    ("往后退一米，把台口让出来", "drive back 1 m"),
    ("急急风！往前三米", "drive forward 3 m"),
    ("送货路线：前进一米，左转九十度", "drive forward 1 m; turn left 90 degrees"),
]  # fmt: skip


@pytest.mark.parametrize(("said", "wanted"), ORDERS)
def test_what_an_order_is_for_or_like_is_left_out(said: str, wanted: str) -> None:
    plan = Conversation().say(said).plan
    assert plan is not None
    assert format_plan(plan) == format_plan(parse_plan(wanted.replace("; ", "\n")))


def test_no_order_drives_beside_what_quotes_it_bounds_it_or_takes_it_back() -> None:
    assert len(STILL) > 100
    assert [said for said in STILL if Conversation().say(said).plan is not None] == []


@pytest.mark.parametrize(
    "said",
    [
        "forward 1 m, that is 2 metres",
        "three feet forward, that's two metres",
        "einen Meter vor, das sind zwei Meter",
    ],
)
def test_an_amount_told_again_must_agree_and_is_never_driven_twice(said: str) -> None:
    assert Conversation().say(said).code == "contradiction"


def test_an_amount_told_again_in_another_unit_is_driven_once() -> None:
    plan = Conversation().say("forward 90 cm, that's 0.9 m").plan
    assert plan is not None
    assert format_plan(plan).strip() == "drive 0.9 m"
