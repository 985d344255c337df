"""The forms of `data/<code>/selections.toml`, and the numbers and speeds that they tell."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from typing import Any

from chatrobot.language.data_files import load_table
from chatrobot.language.rules import Form, forms_of


@cache
def forms(language: str, name: str = "forms") -> tuple[Form, ...]:
    """The forms of that name, in full."""
    return forms_of(f"selections_{language}_{name}", lambda: _in_full(language, name))


def _in_full(language: str, name: str) -> Iterator[str]:
    table = load_table(language, "selections")
    words = {
        **table.get("parts", {}),
        "kind": [word for words in table.get("kinds", {}).values() for word in words],
        "ordinal": table.get("ordinals", ()),
        "number": table.get("numbers", ()),
    }
    parts = {part: "|".join(sorted(named, key=len, reverse=True)) for part, named in words.items()}
    parts["number"] += r"|\d{1,2}"
    for form in table.get(name, ()):
        yield re.sub(r"(?<!\?P)<(\w+)>", lambda m: f"(?:{parts[m[1]]})", form)


def number_said(said: dict[str, str], group: str, table: dict[str, Any]) -> int:
    """The number of an ordinal (`nth`) or a count; 0 for none. The last is -1, the one before it -2."""
    word = said.get(group, "")
    named = {**table["numbers"], **(table["ordinals"] if group == "nth" else {})}
    return int(word) if word.isdecimal() else int(named.get(word, 0))


def speed_for_all(plain: str, language: str) -> tuple[str, str] | None:
    """The speed that a normalised text tells for all it orders, and the rest of it; None where it tells none so."""
    found = next(filter(None, (form.fullmatch(plain) for form in forms(language, "for_all"))), None)
    if found is None:
        return None
    rate = load_table(language, "selections")["rate"]  # of a number alone
    is_rate = re.search(rate["said"], found["speed"]) is not None
    return (found["speed"] if is_rate else f"{found['speed']}{rate['unit']}"), found["rest"]


def same_speed(plain: str, language: str) -> re.Match[str] | None:
    """Where a normalised text asks for the speed of the motion before: 跟刚才一样快."""
    return next(filter(None, (form.search(plain) for form in forms(language, "same_speed"))), None)
