"""More than nine hundred things people say in Chinese: none may be done wrongly, and ever fewer be asked back about."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

from tests.language.dialogue_runner import run_item

SAYINGS = Path(__file__).parent / "sayings_zh.txt"
LEAST_CORRECT = 914


def sayings() -> Iterator[dict[str, Any]]:
    for line in SAYINGS.read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            category, said, expected = (part.strip() for part in line.split(" | "))
            turns = said.split(" || ")
            yield {"category": category, "turns": turns, "expect": yaml.safe_load(f"{{{expected}}}")}


def test_nothing_that_is_said_is_done_wrongly_and_little_is_asked_back() -> None:
    verdicts: Counter[str] = Counter()
    wrong = []
    for item in sayings():
        verdict, why = run_item(item)
        verdicts[verdict] += 1
        if verdict == "wrong":
            wrong.append(f"{item['turns']}: {why}")
    assert wrong == []
    assert verdicts["correct"] >= LEAST_CORRECT, verdicts
