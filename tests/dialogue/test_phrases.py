"""Every reason that any stage can give is a sentence in every language."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import chatrobot
from chatrobot.language.data_files import load_table

SOURCE = Path(chatrobot.__file__).parent
TABLES = ("phrases", "outcomes", "console", "lesson")
CODE_AT = {"Reason": 0, "_found": 1, "_mark": 2}
"""Who makes reasons, and which of the arguments is the code."""


def reason_codes() -> Iterator[str]:
    """Every literal code of a `Reason("…")` in the source, or of a helper that makes one."""
    for path in SOURCE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            at = CODE_AT.get(getattr(node.func, "id", "")) if isinstance(node, ast.Call) else None
            if isinstance(node, ast.Call) and at is not None and at < len(node.args):
                code = node.args[at]
                if isinstance(code, ast.Constant):
                    yield str(code.value)


def test_reasons_are_found() -> None:
    assert {"beats_missed", "import_unknown", "program_endless"} <= set(reason_codes())


@pytest.mark.parametrize("language", ["en", "zh"])
def test_every_reason_is_a_sentence(language: str) -> None:
    known = {code for table in TABLES for code in load_table(language, table)}
    assert set(reason_codes()) - known == set()


@pytest.mark.parametrize("language", ["en", "zh"])
def test_a_code_means_one_thing(language: str) -> None:
    tables = [set(load_table(language, table)) for table in TABLES]
    for first in range(len(tables)):
        for second in range(first + 1, len(tables)):
            assert not tables[first] & tables[second]


@pytest.mark.parametrize("table", TABLES)
def test_languages_have_the_same_phrases(table: str) -> None:
    assert set(load_table("en", table)) == set(load_table("zh", table))
