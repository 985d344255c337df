"""A question is answered with an amount or a manner: what was asked about is done once, with that change."""

from __future__ import annotations

import pytest

from tests.language.test_likeliest import done


@pytest.mark.parametrize(
    ("asked", "answer", "plan"),
    [
        ("forward 50", "50 m", "drive 50 m"),
        ("back 30", "30 centimetres please", "drive 0.3 m back"),
        ("forward fifty", "fifty cm", "drive 0.5 m"),
        ("turn right and go forward 40", "40 cm", "turn right 90 deg\ndrive 0.4 m"),
        ("turn left 50 then forward 50", "50 cm", "turn left 50 deg\ndrive 0.5 m"),
        ("forward 50", "forward 50 cm", "drive 0.5 m"),
        ("forward 50", "50 cm, slowly", "drive 0.5 m at 0.15 m/s"),
        ("forward 50", "2 m", "drive 2 m"),
        ("forward 50", "centimetres", "drive 0.5 m"),
        ("往前走50", "50厘米", "drive 0.5 m"),
        ("向左平移30", "30公分", "drive 0.3 m left"),
    ],
)
def test_an_amount_stands_instead_of_the_number_without_a_unit(asked: str, answer: str, plan: str) -> None:
    assert done(asked, answer) == plan


def test_an_amount_that_fits_no_number_is_asked_about() -> None:
    assert done("forward 50", "30 degrees") == "unclear"


@pytest.mark.parametrize("answer", ["sure, but slowly", "ok, but quickly", "yes, at 0.1 m/s", "好的，慢一点"])
def test_a_change_that_was_not_done_does_not_last(answer: str) -> None:
    assert done(answer, "forward 1 m") == "drive 1 m"
    assert done("forward 50", answer, "back 1 m") == "drive 1 m back"
