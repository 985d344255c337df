"""Reads the data files of a language. A third language is a third folder under `data/`."""

from __future__ import annotations

import itertools
import re
import sys
from functools import cache
from pathlib import Path
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

DATA = Path(__file__).parent / "data"
LANGUAGES = ("en", "zh")

_BRACES = re.compile(r"\{([^{}]*)\}")


@cache
def load_table(language: str, name: str) -> dict[str, Any]:
    """One TOML file of a language, as it stands; an empty table where that language has none."""
    path = DATA / language / f"{name}.toml"
    if not path.exists():
        return {}
    return tomllib.loads(path.read_text(encoding="utf-8"))


def expand(pattern: str) -> list[str]:
    """`turn{,s} left` → `turn left`, `turns left`."""
    parts = _BRACES.split(pattern)
    if len(parts) == 1:
        return [pattern]
    choices = [part.split(",") if i % 2 else [part] for i, part in enumerate(parts)]
    return [" ".join("".join(chosen).split()) for chosen in itertools.product(*choices)]
