"""The two corpora, against an ideal robot. A ratchet: figures only ever go up."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.language.dialogue_runner import run_item

CORPUS = Path(__file__).parent.parent / "corpus"
LEAST_CORRECT = {"en": 124, "zh": 79}


def items(language: str) -> list[dict[str, Any]]:
    loaded = yaml.safe_load((CORPUS / f"{language}.yaml").read_text(encoding="utf-8"))
    assert isinstance(loaded, list)
    return loaded


@pytest.mark.parametrize("language", ["en", "zh"])
def test_no_item_is_done_wrongly_and_no_fewer_are_done_right_than_before(language: str) -> None:
    verdicts: Counter[str] = Counter()
    wrong = []
    for item in items(language):
        verdict, why = run_item(item)
        verdicts[verdict] += 1
        if verdict == "wrong":
            wrong.append(f"{item['id']}: {why}")
    assert wrong == []
    assert verdicts["correct"] >= LEAST_CORRECT[language], verdicts


@pytest.mark.parametrize("language", ["en", "zh"])
def test_outside_of_complex_items_nothing_is_missed(language: str) -> None:
    plain = [item for item in items(language) if item["category"] != "complex"]
    missed = [item["id"] for item in plain if run_item(item)[0] != "correct"]
    assert missed == []
