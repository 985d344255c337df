"""How far a reader has to go, and how long the pieces are: what was reached is held (`python -m scripts.house`)."""

from __future__ import annotations

import ast
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


def test_there_is_no_cycle_no_file_that_is_too_long_and_no_except_that_says_not_why(
    figures: dict[str, float],
) -> None:
    assert figures["import cycles"] == 0
    assert figures["broad excepts without a reason"] == 0
    assert figures[f"files over {house.LONGEST_FILE} lines"] == 0


def test_a_figure_that_got_worse_is_named() -> None:
    held = {"import cycles": 0, "public docstrings, percent": 84.0, "files": 400}
    now = {"import cycles": 1, "public docstrings, percent": 83.9, "files": 399}
    assert house.worse(now, held) == ["import cycles: 1, was 0", "public docstrings, percent: 83.9, was 84.0"]


@pytest.mark.parametrize(
    "name", ["speed_mps", "x_m", "_ends_s", "s", "step_count", "turn", "RATE_HZ", "slip_share", "steps_done"]
)
def test_a_number_says_its_unit_or_that_it_has_none(name: str) -> None:
    assert house.says_unit(name)


@pytest.mark.parametrize(
    "name", ["speed", "x", "duration", "turn_rate", "timeout", "m_speed", "counted", "done"]
)
def test_a_number_that_says_neither_is_found(name: str) -> None:
    assert not house.says_unit(name)


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("except Exception:", [False]),
        ("except:  # noqa: BLE001", [False]),
        ("except (ValueError, BaseException):", [False]),
        ("except Exception:  # noqa: BLE001 - a stranger's code", [True]),
        ("except Exception:  # the outermost boundary", [True]),
        ("# the outermost boundary\nexcept Exception:", [True]),
        ("except (ValueError, OSError):", []),
    ],
)
def test_an_except_that_catches_everything_is_found_with_its_reason(line: str, found: list[bool]) -> None:
    source = f"try:\n    run()\n{line}\n    pass\n"
    assert list(house.broad_excepts(source, ast.parse(source))) == found
