"""Numbers and units → quantities in SI units: one atom of kind `q` whose value is its dimension."""

from __future__ import annotations

import math
from collections.abc import Sequence

from chatrobot.language.arithmetic import calculated, summed
from chatrobot.language.lexicon import lexicon
from chatrobot.language.numbers import FAR_M, Number, is_chinese, is_kind, read_addition, read_number
from chatrobot.language.speeds import with_speeds
from chatrobot.language.tokens import Atom, quantity
from chatrobot.language.units import unit_at

_SKIPPED = frozenset({
    "full", "complete", "complete,", "whole", "single", "entire", "of", "more", "further", "additional", "extra",
    "tiny", "small", "big", "large", "short", "long", "wide", "little", "equal", "identical", "different",
    "separate", "straight", "quick", "slow", "new", "good", "measly", "mere", "neat",
    "个", "整", "的", "小", "大", "直", "完整", "完整的", "一个完整的",
})  # fmt: skip
"""What may stand between a number and its unit and says nothing of its own."""

_SPEED_WORDS = frozenset({
    "speed", "velocity", "the speed", "speed of", "a speed of", "at a speed of", "a velocity of",
    "速度", "速率", "车速",
})  # fmt: skip

_DETERMINERS = frozenset({
    "first", "the first", "the second", "the third", "next", "the next", "last", "the last", "the final",
    "another", "one more", "a further", "remaining", "the remaining", "the other", "each", "every",
})  # fmt: skip

_ABOUT = (90.0, 180.0, 270.0, 360.0, 540.0, 720.0)
"""What `a 180` can only mean in degrees."""

_FAR_TIMES = 10.0
"""A number of more metres than that, and so many times the length behind it, does not share its unit."""

_COUNTED = ("turns", "count", "length", "angle", "time", "times")


def read_quantities(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms with every number and its unit made one quantity, and speeds put together."""
    out: list[Atom] = []
    i = 0
    while i < len(atoms):
        found = _quantity_at(atoms, i)
        if found is None:
            out.append(atoms[i])
            i += 1
        else:
            made, i = found
            out.extend(made)
    return _shared_units(summed(calculated(with_speeds(out))))


def _quantity_at(atoms: Sequence[Atom], i: int) -> tuple[list[Atom], int] | None:
    heard = _misheard(atoms, i)
    if heard:
        return heard
    if atoms[i].kind == "fullturn":
        return [quantity("turns", float(atoms[i].value) * 2.0 * math.pi, atoms[i].text)], i + 1
    if atoms[i].kind in ("times", "fold", "multiple", "faster"):
        return [
            quantity(
                "scale" if atoms[i].kind == "multiple" else atoms[i].kind,
                float(atoms[i].value),
                atoms[i].text,
            )
        ], i + 1
    number = read_number(atoms, i) or _determined(atoms, i)
    if (
        number is None
        and atoms[i].text in ("一个", "个")
        and is_kind(atoms, i + 1, "unit_turn")
        and any(is_kind(atoms, i - 1, kind) for kind in ("verb", "dir", "rot"))
    ):
        number = Number(1.0, i + 1)  # 转一个圈圈
    if number is None and is_kind(atoms, i, "num", "article"):
        number = _article(atoms, i)
    if number is None:
        return None
    text = " ".join(a.text for a in atoms[i : number.end])
    if number.percent:
        return [quantity("percent", number.value, text)], number.end
    at, between = _skip(atoms, number.end)
    unit = unit_at(atoms, at)
    if unit is None and is_kind(atoms, i, "num", "article") and number.value in _ABOUT:
        turn = Atom("verb", "turn", text)
        return [turn, quantity("angle", math.radians(number.value), text)], number.end
    if unit is None:
        return [quantity(_bare_dimension(atoms, i, number), number.value, text)], number.end
    dimension, factor, noun = unit
    text = " ".join(a.text for a in atoms[i : at + 1])
    value, end = _unit_suffix(atoms, number.value, factor, dimension, at + 1)
    role = noun or (f"{factor!r}" if dimension in ("length", "angle") else "")
    more = [Atom("flag", "more", "another")] if atoms[i].text == "another" else []
    return [*more, *between, quantity(dimension, value, text, role)], end


def _bare_dimension(atoms: Sequence[Atom], i: int, number: Number) -> str:
    """A number beside the word speed is in m/s, unless it cannot be."""
    before = atoms[i - 1].text if i else ""
    if before in ("of", "=", "为", "是", ":") and i > 1:
        before = atoms[i - 2].text
    after = "".join(a.text for a in atoms[number.end : number.end + 2])
    said = before in _SPEED_WORDS or after.startswith(("的速度",))
    if any(a.text in ("π", "pi") for a in atoms[i : number.end]):
        return "angle"
    return "speed" if said and 0 < number.value <= 2 else "number"


def _determined(atoms: Sequence[Atom], i: int) -> Number | None:
    """`the first metre`, `another metre`: one of it."""
    if atoms[i].text not in _DETERMINERS or i + 1 >= len(atoms):
        return None
    unit = unit_at(atoms, i + 1)
    named = (
        unit is not None and unit[0] in ("length", "time") and not atoms[i + 1].text.endswith(("s", "feet"))
    )
    return Number(1.0, i + 1) if named or (unit is not None and is_chinese(atoms[i].text)) else None


def _article(atoms: Sequence[Atom], i: int) -> Number | None:
    """`a metre`, `a hundred`; `a full turn`, but not `a turn`, which is a verb's noun."""
    number = read_number(atoms, i + 1)
    if number:
        return number
    at, _ = _skip(atoms, i + 1)
    unit = unit_at(atoms, at)
    if unit is None:
        return None
    if unit[0] == "turns" and at == i + 1 and atoms[at].kind == "verb":
        return None
    return None if unit[0] in ("count", "times") and unit[2] != "tile" else Number(1.0, i + 1)


def _skip(atoms: Sequence[Atom], i: int) -> tuple[int, list[Atom]]:
    """Past the words that may stand between a number and its unit; rotations and more are kept."""
    kept: list[Atom] = []
    start = i
    while i < len(atoms):
        atom = atoms[i]
        if (
            atom.kind in ("rot", "pace")
            or (atom.kind == "dir" and atom.value in ("left", "right"))
            or (atom.kind == "flag" and atom.value == "more")
        ):
            kept.append(atom)
        elif not (atom.text in _SKIPPED or (atom.kind == "num" and atom.value in ("article", "ge", "of"))):
            break
        i += 1
    unit = unit_at(atoms, i)
    if unit is None or (kept and unit[0] not in _COUNTED):
        return start, []
    if any(a.kind in ("rot", "dir") for a in kept) and unit[0] not in ("turns", "count"):
        return start, []
    return i, kept


def _unit_suffix(
    atoms: Sequence[Atom], number: float, factor: float, dimension: str, i: int
) -> tuple[float, int]:
    """`a metre and a half`, 一米半, 一米二, `five foot six`."""
    value = number * factor
    addition = read_addition(atoms, i)
    if addition and unit_at(atoms, addition.end) is None and dimension != "count":
        return value + addition.value * factor, addition.end
    if addition and is_chinese(atoms[i].text):
        return value + addition.value * factor, addition.end
    if dimension != "length" or i >= len(atoms) or atoms[i].kind != "number":
        return value, i
    more = read_number(atoms, i)
    if more is None or more.percent or unit_at(atoms, _skip(atoms, more.end)[0]) or not 0 < more.value < 100:
        return value, i
    if is_chinese(atoms[i].text) and all(a.kind == "number" for a in atoms[i : more.end]):
        end = more.end
        while (
            is_kind(atoms, end, "number") and is_chinese(atoms[end].text) and unit_at(atoms, end + 1) is None
        ):
            end += 1
        digits = "".join(f"{float(a.value):g}" for a in atoms[i:end])
        return value + float(f"0.{digits}") * factor, end
    if is_chinese(atoms[i - 1].text) and atoms[i].text.isdigit() and more.end == i + 1:
        return value + float(f"0.{atoms[i].text}") * factor, more.end  # 1米2, 1米75
    if factor == 0.3048 and more.value < 12:
        return value + more.value * 0.0254, more.end
    if factor == 1.0 and 10 <= more.value < 100:
        return value + more.value / 100.0, more.end
    return value, i


def _misheard(atoms: Sequence[Atom], i: int) -> tuple[list[Atom], int] | None:
    """`to meters` is two metres, `for for seconds` four; read so only right before a plural unit."""
    number = lexicon().before_unit.get(atoms[i].text)
    if number is None or atoms[i].kind == "q":
        return None
    more = read_addition(atoms, i + 1)
    at = more.end if more else i + 1
    unit = unit_at(atoms, at)
    if unit is None or unit[0] not in ("length", "time", "angle") or is_kind(atoms, i - 1, "q"):
        return None
    if not atoms[at].text.endswith(("s", "feet")) or len(atoms[at].text) < 3:
        return None
    if (
        number == 4
        and unit[0] == "time"
        and atoms[i].text == "for"
        and not (i and atoms[i - 1].text == "for")
    ):
        return None
    text = " ".join(a.text for a in atoms[i : at + 1])
    return [quantity(unit[0], (number + (more.value if more else 0.0)) * unit[1], text)], at + 1


def _shared_units(atoms: list[Atom]) -> list[Atom]:
    """`60, 80 and 100 cm`: a number right before a quantity has its unit."""
    out = list(atoms)
    for i in range(len(out) - 1, -1, -1):
        if out[i].kind != "q" or out[i].value != "number":
            continue
        j = i + 1
        while j < len(out) and (
            out[j].text in ("by", "x", "乘", "*", "或")
            or (out[j].kind == "sep" and out[j].value == "weak")
            or (out[j].kind == "conn" and out[j].value == "and")
        ):
            j += 1
        if (
            i + 1 < j < len(out)
            and out[j].kind == "q"
            and out[j].value in ("length", "angle")
            and out[j].role
            and not (out[j].value == "length" and (_is_an_angle(out, i) or _is_far(out[i], out[j])))
        ):
            factor = float(out[j].role)
            out[i] = quantity(out[j].value, out[i].number * factor, out[i].text, out[j].role)
    return out


def _is_an_angle(atoms: Sequence[Atom], i: int) -> bool:
    """`left 90, 50 cm`, `front right at 45, 1 m`: a number like that at a side is degrees, whatever follows."""
    at = i - 2 if is_kind(atoms, i - 1, "glue") else i - 1
    sided = at >= 0 and atoms[at].kind == "dir" and atoms[at].value.endswith(("left", "right"))
    return sided and 15 <= atoms[i].number <= 720 and atoms[i].number % 15 == 0


def _is_far(number: Atom, length: Atom) -> bool:
    """`forward at 45, 1 m`: hardly 45 m."""
    return number.number * float(length.role) > max(FAR_M, _FAR_TIMES * length.number)
