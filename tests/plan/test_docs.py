from __future__ import annotations

import re
from pathlib import Path

import pytest

from chatrobot.plan.json_form import plan_from_json
from chatrobot.plan.primitive import primitives
from chatrobot.plan.text import parse_plan
from tests.plan.plans import plan_to_json

DOC = (Path(__file__).parents[2] / "docs" / "plan-language.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", DOC, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("text", blocks("plan"))
def test_every_example_in_the_documentation_parses(text: str) -> None:
    assert parse_plan(text).steps


def test_the_json_example_is_the_first_text_example() -> None:
    (example,) = blocks("json")
    plan = plan_from_json(example)
    assert plan == parse_plan(blocks("plan")[0])
    assert plan_from_json(plan_to_json(plan)) == plan


def test_every_primitive_is_documented_with_its_own_grammar() -> None:
    for primitive in primitives():
        assert f"### {primitive.verb}\n\n    {primitive.usage}\n" in DOC
