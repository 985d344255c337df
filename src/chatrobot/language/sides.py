"""A side that was left open, 往旁边挪二十公分, and the answer that names it: 右边."""

from __future__ import annotations

import re
from functools import cache

from chatrobot.language.data_files import load_table


@cache
def _pattern(language: str, name: str) -> re.Pattern[str]:
    return re.compile(load_table(language, "sides").get(name, "(?!)"))


def is_side(text: str, language: str) -> bool:
    """Whether a text names a side and nothing else."""
    return _pattern(language, "said").fullmatch(text) is not None


def with_side(before: str, answer: str, language: str) -> str:
    """`before` with the side of `answer` where it left one open; else an empty string."""
    said = _pattern(language, "said").fullmatch(answer)
    if said is None or not _pattern(language, "open").search(before):
        return ""
    put = load_table(language, "sides")["put"].format(side=said["side"])
    return _pattern(language, "open").sub(put, before, count=1)
