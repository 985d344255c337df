"""docs/safety.md names tests that exist, and numbers that are true."""

from __future__ import annotations

import ast
import re
from collections import Counter
from pathlib import Path

import pytest
from scripts.mutants import Mutant, argued

from chatrobot.robots.load import ProfileEntry, list_profiles

ROOT = Path(__file__).parents[2]
CASE = (ROOT / "docs" / "safety.md").read_text(encoding="utf-8")
BUILT_IN = [entry for entry in list_profiles() if entry.origin == "built-in"]
NAMED = sorted(set(re.findall(r"`((?:tests|src/chatrobot/testing)/[\w/]+\.py)::(?:\w+::)?(\w+)`", CASE)))


@pytest.mark.parametrize(("file", "test"), NAMED, ids=[test for _, test in NAMED])
def test_every_test_that_the_safety_case_names_exists(file: str, test: str) -> None:
    tree = ast.parse((ROOT / file).read_text(encoding="utf-8"))
    assert test in {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}


def test_every_hazard_names_a_test() -> None:
    table = CASE.split("## Hazards")[1].split("## ")[0]
    rows = [row for row in table.splitlines() if row.startswith("| ")][1:]
    assert len(rows) > 15
    assert [row for row in rows if "::test_" not in row.split("|")[3]] == []


@pytest.mark.parametrize("mutant", argued(), ids=lambda mutant: mutant.where)
def test_a_mutant_that_may_survive_is_of_code_that_is_there(mutant: Mutant) -> None:
    package, module, *_ = mutant.where.split(".")
    source = (ROOT / "src" / "chatrobot" / package / f"{module}.py").read_text(encoding="utf-8")
    assert mutant.was in source
    assert mutant.was != mutant.becomes


def test_the_safety_case_counts_the_mutants_that_survive() -> None:
    counted = re.findall(r"^  \| (\d+) \| (.+) \|$", CASE, re.MULTILINE)
    assert sorted((why, int(count)) for count, why in counted) == sorted(Counter(argued().values()).items())
    assert f"The other {len(argued())} are listed" in CASE


def test_it_says_plainly_that_it_is_not_certified() -> None:
    assert "**not certified**" in CASE


@pytest.mark.parametrize(
    "entry", [entry for entry in list_profiles() if entry.origin == "built-in"], ids=lambda e: e.name
)
def test_each_profiles_own_timeout_is_the_one_in_its_file(entry: ProfileEntry) -> None:
    timeout_s = entry.load().wiring.base_timeout_s
    holds = "for ever" if timeout_s is None else f"{timeout_s:g} s"
    assert f"| `{entry.name}` | {holds} |" in CASE
