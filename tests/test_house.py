"""How far a reader has to go, and how long the pieces are: what was reached is held (`python -m scripts.house`)."""

from __future__ import annotations

import json

import pytest
from scripts import house


@pytest.fixture(scope="module")
def figures() -> dict[str, float]:
    return house.figures()


def test_no_figure_of_the_house_is_worse_than_it_was(figures: dict[str, float]) -> None:
    worse = house.worse(figures, json.loads(house.HELD.read_text(encoding="utf-8")))
    assert not worse, (
        "split or shorten what grew; if it has to be, python -m scripts.house --write, and say why"
    )


def test_there_is_no_cycle_and_no_file_that_is_too_long(figures: dict[str, float]) -> None:
    assert figures["import cycles"] == 0
    assert figures[f"files over {house.LONGEST_FILE} lines"] == 0


def test_a_figure_that_got_worse_is_named() -> None:
    held = {"import cycles": 0, "public docstrings, percent": 84.0, "files": 400}
    now = {"import cycles": 1, "public docstrings, percent": 83.9, "files": 399}
    assert house.worse(now, held) == ["import cycles: 1, was 0", "public docstrings, percent: 83.9, was 84.0"]
