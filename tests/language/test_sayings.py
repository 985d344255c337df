"""Things people say, a thousand in three languages: none may be done wrongly, and ever fewer be asked back about."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.language.dialogue_runner import run_item

LEAST_CORRECT = {"zh": 1250, "en": 646, "de": 172}


def sayings(language: str) -> Iterator[dict[str, Any]]:
    for line in (Path(__file__).parent / f"sayings_{language}.txt").read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            category, said, expected = (part.strip() for part in line.split(" | "))
            turns = said.split(" || ")
            yield {"category": category, "turns": turns, "expect": yaml.safe_load(f"{{{expected}}}")}


@pytest.mark.parametrize("language", LEAST_CORRECT)
def test_nothing_that_is_said_is_done_wrongly_and_little_is_asked_back(language: str) -> None:
    verdicts: Counter[str] = Counter()
    wrong = []
    for item in sayings(language):
        verdict, why = run_item(item)
        verdicts[verdict] += 1
        if verdict == "wrong":
            wrong.append(f"{item['turns']}: {why}")
    assert wrong == []
    assert verdicts["correct"] >= LEAST_CORRECT[language], verdicts
