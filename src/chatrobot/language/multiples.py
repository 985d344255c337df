"""四倍的30公分, 一米的三分之二, 20厘米乘以3, `2 m in four equal steps`: an amount told by another.

Only amounts of one clause, side by side, are put together: a multiple of a speed is another thing.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from chatrobot.language.data_files import load_table
from chatrobot.language.numbers import is_chinese
from chatrobot.language.tokens import Atom, quantity
from chatrobot.language.unclear import Unclear

_AMOUNTS = frozenset({"length", "angle", "turns", "time"})
_ENDS = frozenset({"sep", "conn", "filler", "operator", "q"})
_SHARED_BY = ("in", "into", "over", "across")
_ENDS_OF = frozenset({"the first", "the last"})
_SHARES = frozenset({"step", "leg", "move"})


@lru_cache(maxsize=1)
def _operators() -> dict[str, str]:
    sums = load_table("zh", "sums")
    return {word: name for name in ("times", "over", "plus", "minus") for word in sums[name]}


def with_multiples(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms with `four times 30 cm` as one amount, where it is said in Chinese."""
    out = [_of_speed(atom, before) for before, atom in zip([None, *atoms], atoms)]
    i = 0
    while i < len(out):
        found = _multiplied(out, i) or _reckoned(out, i)
        if found is None:
            i += 1
            continue
        made, end = found
        out[i:end] = [made]
    return out


def _of_speed(atom: Atom, before: Atom | None) -> Atom:
    """速度 double: a factor that is said of the speed is none of a distance."""
    named = before is not None and before.kind == "glue" and before.text in _speeds()
    is_factor = atom.kind == "q" and atom.value in ("scale", "fold")
    return quantity("faster", atom.number, atom.text) if named and is_factor else atom


@lru_cache(maxsize=1)
def _speeds() -> frozenset[str]:
    return frozenset(load_table("zh", "sums")["speed"])


def _multiplied(atoms: Sequence[Atom], i: int) -> tuple[Atom, int] | None:
    """四倍的30公分, 30公分的四倍, 一米的三分之二, 一米的一半."""
    if not _is_of(atoms, i + 1) or i + 2 >= len(atoms) or atoms[i].kind != "q" or atoms[i + 2].kind != "q":
        return None
    first, second = atoms[i], atoms[i + 2]
    if _is_factor(first) and second.value in _AMOUNTS:
        return _times(second, first.number, f"{first.text} {second.text}"), i + 3
    ends = i + 3 >= len(atoms) or atoms[i + 3].kind in _ENDS
    if ends and first.value in _AMOUNTS and (_is_factor(second) or _is_part(second)):
        return _times(first, second.number, f"{first.text} {second.text}"), i + 3
    return None


def _reckoned(atoms: Sequence[Atom], i: int) -> tuple[Atom, int] | None:
    """20厘米乘以3, 3乘以20厘米, 一米六除以四; 一米的两倍减三十公分."""
    if i + 2 >= len(atoms) or atoms[i].kind != "q" or atoms[i + 2].kind != "q":
        return None
    name = _operators().get(atoms[i + 1].text, "")
    first, second = atoms[i], atoms[i + 2]
    text = f"{first.text} {atoms[i + 1].text} {second.text}"
    if not name or atoms[i + 1].kind == "q":
        return None
    if name in ("plus", "minus"):
        sign = 1.0 if name == "plus" else -1.0
        fits = first.value == second.value in _AMOUNTS
        return (quantity(first.value, first.number + sign * second.number, text), i + 3) if fits else None
    if first.value in _AMOUNTS and second.value == "number" and second.number > 0:
        return _times(first, second.number if name == "times" else 1.0 / second.number, text), i + 3
    if name == "times" and first.value == "number" and second.value in _AMOUNTS:
        return _times(second, first.number, text), i + 3
    return None


def _is_of(atoms: Sequence[Atom], i: int) -> bool:
    return 0 <= i < len(atoms) and atoms[i].kind == "glue" and atoms[i].text == "的"


def _is_factor(atom: Atom) -> bool:
    """`四倍`, and not `四倍速度`."""
    return atom.value == "fold" and atom.text.endswith("倍") and atom.number > 0


def _is_part(atom: Atom) -> bool:
    """`三分之二`, `一半`, `百分之八十`."""
    return atom.value in ("number", "percent") and is_chinese(atom.text) and 0 < atom.number < 1


def _times(amount: Atom, factor: float, text: str) -> Atom:
    return quantity(amount.value, amount.number * factor, text, amount.role)


def in_shares(atoms: Sequence[Atom]) -> list[Atom]:
    """`2 m in four equal steps`, `one turn, split into 8 moves`: so many times that part of the amount.

    Raises:
        Unclear: where the steps have an amount of their own, too, or only a part of the amount is spoken of.
    """
    out = list(atoms)
    for i, atom in enumerate(atoms):
        _check_whole(atoms, i)
        if atom.kind != "glue" or atom.text.split()[-1] not in _SHARED_BY:
            continue
        share = atoms[i + 1] if i + 1 < len(atoms) and _is_shares(atoms[i + 1]) else None
        at = next((k for k in range(i - 1, -1, -1) if atoms[k].kind in ("q", "shape")), -1)
        if share is None or at < 0 or atoms[at].value not in _AMOUNTS or _is_apart(atoms[at + 1 : i]):
            continue
        own = next((k for k in range(i + 2, len(atoms)) if atoms[k].kind in ("q", "verb", "dir")), None)
        if own is not None and atoms[own].value == atoms[at].value:
            raise Unclear("unclear_motion", " ".join(a.text for a in atoms[at : own + 1]))
        out[at] = _times(atoms[at], 1.0 / share.number, atoms[at].text)
        out[i + 1] = quantity("times", share.number, share.text)
        return out
    return out


def _check_whole(atoms: Sequence[Atom], i: int) -> None:
    """`1 m, the last 20 cm slowly`: that is a part of the metre, and no motion after it.

    Raises:
        Unclear: naming both.
    """
    if atoms[i].text not in _ENDS_OF or i + 1 >= len(atoms) or atoms[i + 1].kind != "q":
        return
    whole = [k for k in range(i) if atoms[k].kind == "q" and atoms[k].value == atoms[i + 1].value in _AMOUNTS]
    if whole and not any(atoms[k - 1].text in _ENDS_OF for k in whole if k):
        raise Unclear("unclear_motion", " ".join(a.text for a in atoms[whole[-1] : i + 2]))


def _is_shares(atom: Atom) -> bool:
    """`four equal steps`, `two goes`."""
    named = (atom.value == "count" and atom.role in _SHARES) or atom.text.endswith(" goes")
    return named and atom.kind == "q" and atom.number.is_integer() and atom.number > 1.0


def _is_apart(between: Sequence[Atom]) -> bool:
    """Whether a motion of its own stands between an amount and its shares."""
    return any(a.kind in ("verb", "conn", "counter") or a.value == "strong" for a in between)
