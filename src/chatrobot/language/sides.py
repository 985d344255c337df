"""A side that was left open, 往旁边挪二十公分, and the answer that names it: 右边."""

from __future__ import annotations

from chatrobot.language.data_files import load_table
from chatrobot.language.rules import form


def is_side(text: str, language: str) -> bool:
    """Whether a text names a side and nothing else."""
    return form(language, "sides", "said").fullmatch(text) is not None


def with_side(before: str, answer: str, language: str) -> str:
    """`before` with the side of `answer` where it left one open; else an empty string."""
    said = form(language, "sides", "said").fullmatch(answer)
    if said is None or not form(language, "sides", "open").search(before):
        return ""
    put = load_table(language, "sides")["put"].format(side=said["side"])
    return form(language, "sides", "open").sub(put, before, count=1)
