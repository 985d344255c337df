"""Reads the data files of a language. A third language is a third folder under `data/`."""

from __future__ import annotations

import itertools
import re
import sys
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

DATA = Path(__file__).parent / "data"
LANGUAGES = ("en", "zh")
"""The languages whose words the reader knows. Any other is put into the English ones first, see `gloss.py`."""
REPLY_LANGUAGES = (*LANGUAGES, "de")
"""The languages that people are answered in."""

_BRACES = re.compile(r"\{([^{}]*)\}")
_DECIMAL = re.compile(r"-?\d+\.\d+")
_PART = re.compile(r"(?<!\?P)<(\w+)>")


@cache
def load_table(language: str, name: str) -> dict[str, Any]:
    """One TOML file of a language, as it stands; an empty table where that language has none.

    A language that is put into English words to be read has the English table where it has none of its own.
    """
    path = DATA / language / f"{name}.toml"
    if not path.exists():
        return {} if language in LANGUAGES else load_table(LANGUAGES[0], name)
    return tomllib.loads(path.read_text(encoding="utf-8"))


def written(text: str, language: str) -> str:
    """Return a number that is text already as the language writes it, and any other text as it is."""
    is_number = _DECIMAL.fullmatch(text) is not None
    return text.replace(".", str(load_table(language, "phrases")["decimal_mark"])) if is_number else text


def filled(template: str, language: str, values: Mapping[str, object]) -> str:
    """Return words of a table with their values filled in."""
    shown = {key: written(one, language) if isinstance(one, str) else one for key, one in values.items()}
    return template.format(**shown)


@cache
def relation_words(name: str) -> frozenset[str]:
    """The words of one list of `relations.toml` in all languages: how a motion lies to something else."""
    tables = (load_table(code, "relations") for code in REPLY_LANGUAGES)
    return frozenset(word for table in tables for word in table.get(name, ()))


def expand(pattern: str) -> list[str]:
    """`turn{,s} left` → `turn left`, `turns left`."""
    parts = _BRACES.split(pattern)
    if len(parts) == 1:
        return [pattern]
    choices = [part.split(",") if i % 2 else [part] for i, part in enumerate(parts)]
    return [" ".join("".join(chosen).split()) for chosen in itertools.product(*choices)]


def in_full(pattern: str, parts: Mapping[str, str]) -> str:
    """A pattern with what each `<name>` in it stands for, which may name others."""
    found = _PART.search(pattern)
    if found is None:
        return pattern
    stands_for = parts[found[1]]
    grouped = stands_for if stands_for.startswith("(") else f"(?:{stands_for})"
    return in_full(pattern.replace(found[0], grouped), parts)
