"""A yes or a no, said to a question that was asked."""

from __future__ import annotations

import re

_YES = frozenset(
    {"y", "yes", "yeah", "yep", "yes please", "please", "please do", "ok", "okay", "sure", "go", "go ahead"}
    | {"do it", "do that", "yes do it", "yes go ahead", "ok do it", "ok go ahead"}
    | {"好", "好的", "好吧", "是", "是的", "对", "可以", "行", "执行", "做", "做吧", "没问题"}
)
_NO = frozenset(
    {"n", "no", "nope", "no thanks", "no thank you", "don't", "do not", "cancel", "never mind"}
    | {"不", "不要", "不用", "不用了", "否", "不行", "取消", "算了", "别做"}
)
_COMMA = re.compile(r"[,，、]")
_EDIT = frozenset({"e", "edit", "修改", "改", "编辑"})


def read_consent(text: str) -> bool | None:
    """True for a yes, False for a no, None for anything else. What stands between commas has to say the same."""
    parts = [_word(part) for part in _COMMA.split(text)]
    for words, meant in ((_YES, True), (_NO, False)):
        if words.issuperset(parts) or " ".join(parts) in words:
            return meant
    return None


def wants_to_edit(text: str) -> bool:
    """Neither: it is to be changed first."""
    return _word(text) in _EDIT


def _word(text: str) -> str:
    return text.strip().casefold().rstrip(".!。！ ")
