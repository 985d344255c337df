"""A shape that is driven turn by turn: `a square, only the first two sides`, then `the other two`; slices of a circle.

The words are `data/<code>/shape_parts.toml`. What is missing is told from the shape as it was ordered and from all that
was driven since; where that is no part of it, nothing is.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from chatrobot.language.context import Dialogue
from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.gloss import gloss
from chatrobot.language.normalise import normalise
from chatrobot.language.rephrase import plain_text
from chatrobot.language.rules import form, forms
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Arc, Drive, Step, Turn

Read = Callable[[str], list[Step]]
_FEWEST_SIDES = 3
_MARKS = " ,.;:!?，。！"


def part_of_shape(plain: str, language: str, dialogue: Dialogue, read: Read) -> list[Step] | None:
    """The steps of a text that wants some sides of a shape, or goes on with one; None for any other.

    Args:
        read: the steps of a text that is an order of its own.

    Raises:
        Unclear: the shape has no such part, or is not understood.
    """
    cut = _cut(plain, language)
    if cut is not None:
        whole, count = cut
        return _first_sides(read(whole) if whole.strip(_MARKS) else _before(dialogue), count, plain)
    return _next_sides(plain, language, dialogue, read) or _next_slice(plain, language, dialogue)


def _before(dialogue: Dialogue) -> list[Step]:
    """The steps of the motion before.

    Raises:
        Unclear: there was none.
    """
    last = dialogue.last_motion
    if last is None or last.plan is None:
        raise Unclear("nothing_before")
    return list(last.plan.steps)


def asks_for_rest(text: str, language: str) -> bool:
    """Whether a text asks for what is missing to a shape, if one was begun."""
    known = text if language in LANGUAGES else gloss(text, language).text
    return _said("rest", normalise(known), language) is not None


def _cut(plain: str, language: str) -> tuple[str, int] | None:
    """The text of the whole shape, and how many of its sides are wanted; None where it wants all."""
    for some in forms(language, "shape_parts", "some"):
        found = some.search(plain)
        if found is not None:
            whole = f"{plain[: found.start()]} {plain[found.end() :]}"
            return " ".join(whole.split()), _number(found["count"], language) if found["count"] else 1
    return None


def _first_sides(whole: list[Step], count: int, plain: str) -> list[Step]:
    """The first sides with the turns between them, and none after the last.

    Raises:
        Unclear: it is no outline of sides and turns, or has fewer.
    """
    drives = [i for i, step in enumerate(whole) if isinstance(step, Drive)]
    if not _is_outline(whole) or not 1 <= count < len(drives):
        raise Unclear("unclear_motion", plain[:60])
    return whole[: drives[count - 1] + 1]


def _is_outline(steps: list[Step]) -> bool:
    kinds = [type(step) for step in steps]
    return len(kinds) >= 2 * _FEWEST_SIDES - 1 and all(
        kind is (Turn if i % 2 else Drive) for i, kind in enumerate(kinds)
    )


def _next_sides(plain: str, language: str, dialogue: Dialogue, read: Read) -> list[Step] | None:
    """The sides that a text wants of a shape that is begun.

    Raises:
        Unclear: there are not as many left, or others come first.
    """
    wanted = _said("next", plain, language), _said("rest", plain, language)
    left = _left_of_shape(language, dialogue, read) if any(wanted) else None
    if not left:
        return None
    ends = [i + 1 for i, step in enumerate(left) if isinstance(step, Drive)]
    after, all_left = wanted
    if all_left is not None:
        told = _number(all_left.get("count", ""), language)
        is_one = form(language, "shape_parts", "one_left").search(plain) is not None
        if (told or (1 if is_one else len(ends))) != len(ends):
            raise Unclear("unclear_motion", plain[:60])
        return left
    assert after is not None
    count = _number(after["count"], language) or 1
    done = sum(isinstance(step, Drive) for step in _driven(language, dialogue))
    nth = _number(after["nth"], language)
    if count > len(ends) or (nth and nth != (done + 1 if nth > 0 else -len(ends))):
        raise Unclear("unclear_motion", plain[:60])
    return left if count == len(ends) else left[: ends[count - 1]]


def _left_of_shape(language: str, dialogue: Dialogue, read: Read) -> list[Step] | None:
    """What is missing to the shape of which the turns before drove some sides; None where they drove none."""
    begun = _begun(language, dialogue)
    cut = _cut(begun[0], language) if begun else None
    if cut is None:
        return None
    whole, done = read(cut[0]), _driven(language, dialogue)
    return whole[len(done) :] if whole[: len(done)] == done else None


def _begun(language: str, dialogue: Dialogue) -> list[str]:
    """The texts of the last turn that wanted some sides of a shape, and of those after it that moved."""
    moved = [turn for turn in dialogue.turns if turn.plan is not None]
    at = next((i for i in reversed(range(len(moved))) if _cut(plain_text(moved[i].text), language)), None)
    return [plain_text(turn.text) for turn in moved[at:]] if at is not None else []


def _driven(language: str, dialogue: Dialogue) -> list[Step]:
    moved = [turn for turn in dialogue.turns if turn.plan is not None]
    since = moved[len(moved) - len(_begun(language, dialogue)) :]
    return [step for turn in since if turn.plan is not None for step in turn.plan.steps]


def _next_slice(plain: str, language: str, dialogue: Dialogue) -> list[Step] | None:
    """`The second quarter`, after the first one of a circle.

    Raises:
        Unclear: another part comes next, or none is left.
    """
    said = _said("slice", plain, language) or _said("once_more", plain, language)
    arcs = _arcs_before(dialogue) if said is not None else []
    if said is None or not arcs:
        return None
    last = arcs[-1]
    parts = round(2 * math.pi / last.angle_rad)
    named = load_table(language, "shape_parts")["sizes"].get(said.get("part", ""), parts)
    whole = math.isclose(last.angle_rad * parts, 2 * math.pi, rel_tol=1e-6)
    if not whole or named != parts or len(arcs) >= parts or (len(arcs) < 2 and "part" not in said):
        return None
    nth = _number(said["nth"], language)
    if nth and nth != (len(arcs) + 1 if nth > 0 else len(arcs) - parts):
        raise Unclear("unclear_motion", plain[:60])
    way = load_table(language, "shape_parts")["ways"].get(said.get("way", ""), "")
    return [replace(last, left=way == "left") if way else last]


def _arcs_before(dialogue: Dialogue) -> list[Arc]:
    """The same arc in the last turns that moved, one each."""
    arcs: list[Arc] = []
    for turn in reversed([turn for turn in dialogue.turns if turn.plan is not None]):
        step = turn.plan.steps[0] if turn.plan is not None and len(turn.plan.steps) == 1 else None
        if not isinstance(step, Arc) or (arcs and step != arcs[0]):
            break
        arcs.append(step)
    return arcs


def _number(word: str, language: str) -> int:
    table = load_table(language, "selections")
    own = load_table(language, "shape_parts").get("ordinals", {})
    named = {**table.get("numbers", {}), **table.get("ordinals", {}), **own}
    return int(word) if word.isdecimal() else int(named.get(word, 0))


def _said(name: str, plain: str, language: str) -> dict[str, str] | None:
    found = next(
        filter(None, (one.fullmatch(plain.strip()) for one in forms(language, "shape_parts", name))), None
    )
    return {"count": "", "nth": "", **{k: v or "" for k, v in found.groupdict().items()}} if found else None
