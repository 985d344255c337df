"""Two orders that a word joins are done one after the other, or asked about: none is dropped, moved or merged."""

from __future__ import annotations

import itertools

import pytest

from tests.language.test_usual import done

_SQUARE = "; ".join(["drive 0.5 m; turn left 90 deg"] * 4)
_CIRCLE = "arc left 360 deg radius 0.5 m"
ORDERS = {
    "en": {
        "drive 1 m": "drive 1 m",
        "turn right 45 degrees": "turn right 45 deg",
        "turn around": "turn left 180 deg",
        "slide left 30 cm": "drive 0.3 m left",
        "wait 2 s": "wait 2 s",
        "draw a square": _SQUARE,
        "draw a circle": _CIRCLE,
        "spin twice": "turn left 360 deg; turn left 360 deg",
        "curve left": "arc left 90 deg radius 0.5 m",
        "go to x 1 y 1": 'go to 1 1 named "(1, 1)"',
    },
    "zh": {
        "前进一米": "drive 1 m",
        "右转45度": "turn right 45 deg",
        "掉头": "turn left 180 deg",
        "左移三十厘米": "drive 0.3 m left",
        "等两秒": "wait 2 s",
        "画个正方形": _SQUARE,
        "画个圆": _CIRCLE,
        "原地转两圈": "turn left 720 deg",
    },
    "de": {
        "fahr einen Meter": "drive 1 m",
        "dreh dich 45 Grad nach rechts": "turn right 45 deg",
        "dreh dich um": "turn left 180 deg",
        "rutsch 30 cm nach links": "drive 0.3 m left",
        "warte 2 Sekunden": "wait 2 s",
        "fahr ein Quadrat": _SQUARE,
        "fahr einen Kreis": _CIRCLE,
    },
}
JOINED = {
    "en": ("{} and {}", "{}, then {}", "first {}, then {}"),
    "zh": ("{}然后{}", "先{}再{}", "{}，接着{}"),
    "de": ("{} und {}", "{}, dann {}", "erst {}, dann {}"),
}


@pytest.mark.parametrize("joined", [(language, form) for language in JOINED for form in JOINED[language]])
def test_both_are_done_in_their_order(joined: tuple[str, str]) -> None:
    language, form = joined
    merged = []
    for (one, its_plan), (other, other_plan) in itertools.permutations(ORDERS[language].items(), 2):
        plan = done(form.format(one, other))
        if plan not in ("unclear", f"{its_plan}; {other_plan}"):
            merged.append((form.format(one, other), plan))
    assert merged == []


@pytest.mark.parametrize("language", ORDERS)
def test_each_is_done_alone(language: str) -> None:
    assert {said: done(said) for said in ORDERS[language]} == ORDERS[language]
