"""A yes or a no, said to a question that was asked."""

from __future__ import annotations

_YES = frozenset(
    {"y", "yes", "yes please", "ok", "okay", "do it", "go", "go ahead", "sure"}
    | {"好", "好的", "是", "是的", "对", "可以", "行", "执行", "做", "做吧"}
)
_NO = frozenset(
    {"n", "no", "nope", "no thanks", "don't", "cancel", "不", "不要", "否", "不行", "取消", "算了", "别做"}
)
_EDIT = frozenset({"e", "edit", "修改", "改", "编辑"})


def read_consent(text: str) -> bool | None:
    """True for a yes, False for a no, None for anything else."""
    word = _word(text)
    if word in _YES:
        return True
    return False if word in _NO else None


def wants_to_edit(text: str) -> bool:
    """Neither: it is to be changed first."""
    return _word(text) in _EDIT


def _word(text: str) -> str:
    return text.strip().casefold().rstrip(".!。！ ")
