"""Every reason that any stage can give is a sentence in every language."""

from __future__ import annotations

import ast
import string
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import get_args

import pytest

import chatrobot
from chatrobot.cli import arguments
from chatrobot.core.reason import Reason
from chatrobot.language.data_files import DATA, REPLY_LANGUAGES, load_table
from chatrobot.language.interpretation import LanguageCode, language_of_tags
from chatrobot.language.phrases import by_language, describe_text, render_reason, say
from chatrobot.sim.load import load_world, world_names

SOURCE = Path(chatrobot.__file__).parent
TABLES = ("phrases", "outcomes", "console", "lesson")
SAID = (*TABLES, "web", "report", "calibrate")
CODE_AT = {"Reason": 0, "_found": 1, "_mark": 2}
"""Who makes reasons, and which of the arguments is the code."""


@cache
def reason_codes() -> frozenset[str]:
    """Every literal code of a `Reason("…")` in the source, or of a helper that makes one."""
    return frozenset(_reason_codes())


def _reason_codes() -> Iterator[str]:
    for path in SOURCE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            at = CODE_AT.get(getattr(node.func, "id", "")) if isinstance(node, ast.Call) else None
            if isinstance(node, ast.Call) and at is not None and at < len(node.args):
                code = node.args[at]
                if isinstance(code, ast.Constant):
                    yield str(code.value)


def test_reasons_are_found() -> None:
    assert {"beats_missed", "import_unknown", "program_endless"} <= reason_codes()


@pytest.mark.parametrize("language", REPLY_LANGUAGES)
def test_every_reason_is_a_sentence(language: str) -> None:
    known = {code for table in TABLES for code in load_table(language, table)}
    assert reason_codes() - known == set()


@pytest.mark.parametrize("language", REPLY_LANGUAGES)
def test_a_code_means_one_thing(language: str) -> None:
    tables = [set(load_table(language, table)) for table in TABLES]
    for first in range(len(tables)):
        for second in range(first + 1, len(tables)):
            assert not tables[first] & tables[second]


def gaps(table: dict[str, str]) -> dict[str, set[str]]:
    """Return the values that each phrase shows."""
    parsed = {code: string.Formatter().parse(text) for code, text in table.items()}
    return {code: {name for _, name, _, _ in parts if name} for code, parts in parsed.items()}


@pytest.mark.parametrize("language", REPLY_LANGUAGES)
@pytest.mark.parametrize("table", SAID)
def test_languages_have_the_same_phrases_with_the_same_values(table: str, language: str) -> None:
    assert (DATA / language / f"{table}.toml").exists()
    assert gaps(load_table(language, table)) == gaps(load_table("en", table))


def test_every_language_that_is_answered_in_is_a_language_code_and_can_be_chosen() -> None:
    assert REPLY_LANGUAGES == get_args(LanguageCode) == arguments.LANGUAGES
    assert all((DATA / language / "causes.toml").exists() for language in REPLY_LANGUAGES)


@pytest.mark.parametrize(
    ("tags", "language"),
    [
        ("de_AT.UTF-8", "de"), ("de-DE,de;q=0.9,en;q=0.8", "de"), ("fr-FR,fr,DE;q=0.5", "de"), ("zh_CN", "zh"),
        ("en-GB,de;q=0.5", "en"), ("den", "en"), ("C", "en"), ("", "en"),
    ],
)  # fmt: skip
def test_the_first_language_that_is_known_is_spoken(tags: str, language: str) -> None:
    assert language_of_tags(tags) == language


def test_a_plan_is_told_in_german() -> None:
    repeated = "repeat 3\n  arc right 180 deg radius 0.5 m\nend"
    plan = f'drive 2 m at 0.3 m/s\nturn left 90 deg\ngo to 1 2 named "kitchen"\n{repeated}'
    told = (
        "2 m vorwärts fahren (mit 0,3 m/s), 90° nach links drehen, zu „Küche“ fahren, "
        "3 × eine Kurve von 180° nach rechts fahren (Radius 0,5 m)"
    )
    assert describe_text(plan, "de") == told
    assert say("de", "offer", text=describe_text("drive 1 m left", "de")) == "Soll ich 1 m nach links fahren?"


def test_places_and_things_of_every_world_have_a_german_name_of_their_own() -> None:
    table = load_table("de", "names")
    worlds = [load_world(name) for name in world_names()]
    named = {name for world in worlds for name in (*world.places, *(one.name for one in world.obstacles))}
    assert {name.casefold() for name in named} <= set(table)
    assert len(set(table.values())) == len(table)
    blocked = Reason("would_collide_named", {"obstacle": "sofa", "margin_m": 0.1, "total_m": 1.0})
    assert "„Sofa“" in render_reason(blocked, "de")
    assert by_language(("workshop", "车间"), "de") == ["workshop", "车间"]
