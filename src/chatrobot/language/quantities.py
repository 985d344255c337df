"""Numbers and units → quantities in SI units: one atom of kind `q` whose value is its dimension."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.lexicon import lexicon
from chatrobot.language.numbers import Number, is_chinese, is_kind, read_addition, read_number
from chatrobot.language.tokens import Atom

DIMENSIONS = {
    "unit_length": "length", "unit_angle": "angle", "unit_time": "time", "unit_speed": "speed",
    "unit_rate": "rate", "unit_turn": "turns", "unit_percent": "percent", "unit_times": "times",
    "unit_clock": "clock", "unit_fold": "fold", "unit_faster": "faster", "unit_scale": "scale", "counter": "count",
}  # fmt: skip
_SKIPPED = frozenset({
    "full", "complete", "whole", "single", "个", "整", "of", "more", "further", "tiny", "small", "big",
    "large",
    "short", "little", "equal", "完整的", "的", "additional", "extra", "quick", "straight", "long",
    "小", "大",
    "slow", "new", "一个完整的", "完整", "直", "complete,", "different", "separate", "identical",
    "entire", "wide",
    "half", "good", "measly", "mere", "neat",
})  # fmt: skip


_SPEED_WORDS = frozenset(
    {
        "speed",
        "velocity",
        "a speed of",
        "speed of",
        "速度",
        "速率",
        "a velocity of",
        "the speed",
        "at a speed of",
        "车速",
    }
)
_DETERMINERS = frozenset({
    "the first", "first", "the next", "next", "the last", "last", "the final", "another", "one more",
    "each", "every",
    "the second", "the third", "a further", "the remaining", "remaining", "the other",
})  # fmt: skip


@lru_cache(maxsize=1)
def _turn_nouns() -> frozenset[str]:
    return frozenset(w for lang in LANGUAGES for w in load_table(lang, "turn_nouns").get("words", ()))


def quantity(dimension: str, value: float, text: str, role: str = "") -> Atom:
    """An atom that is a quantity in SI units."""
    return Atom("q", dimension, text, value, role)


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
    return _shared_units(_summed(_calculated(_speeds(out))))


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
        and is_kind(atoms, i - 1, "verb")
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
    unit = _unit(atoms, at)
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
    unit = _unit(atoms, i + 1)
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
    unit = _unit(atoms, at)
    if unit is None:
        return None
    if unit[0] == "turns" and at == i + 1 and atoms[at].kind == "verb":
        return None
    return None if unit[0] in ("count", "times") and unit[2] != "tile" else Number(1.0, i + 1)


_ABOUT = (90.0, 180.0, 270.0, 360.0, 540.0, 720.0)
"""What `a 180` can only mean in degrees."""
_COUNTED = ("turns", "count", "length", "angle", "time", "times")


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
    unit = _unit(atoms, i)
    if unit is None or (kept and unit[0] not in _COUNTED):
        return start, []
    if any(a.kind in ("rot", "dir") for a in kept) and unit[0] not in ("turns", "count"):
        return start, []
    return i, kept


def _unit(atoms: Sequence[Atom], i: int) -> tuple[str, float, str] | None:
    """Dimension, factor and noun of the unit at `i`."""
    if not 0 <= i < len(atoms):
        return None
    atom = atoms[i]
    if atom.kind == "second":
        return "time", 1.0, ""
    if atom.text in _turn_nouns():
        return "turns", 2.0 * math.pi, ""
    if atom.text == "in" and (i + 1 == len(atoms) or atoms[i + 1].kind in ("sep", "dir", "conn")):
        return "length", 0.0254, ""
    dimension = DIMENSIONS.get(atom.kind)
    if dimension is None:
        return None
    if dimension == "count":
        return dimension, 1.0, atom.value
    factor = float(atom.value)
    return dimension, factor * 2.0 * math.pi if dimension == "turns" else factor, ""


def _unit_suffix(
    atoms: Sequence[Atom], number: float, factor: float, dimension: str, i: int
) -> tuple[float, int]:
    """`a metre and a half`, 一米半, 一米二, `five foot six`."""
    value = number * factor
    addition = read_addition(atoms, i)
    if addition and _unit(atoms, addition.end) is None and dimension != "count":
        return value + addition.value * factor, addition.end
    if addition and is_chinese(atoms[i].text):
        return value + addition.value * factor, addition.end
    if dimension != "length" or i >= len(atoms) or atoms[i].kind != "number":
        return value, i
    more = read_number(atoms, i)
    if more is None or more.percent or _unit(atoms, _skip(atoms, more.end)[0]) or not 0 < more.value < 100:
        return value, i
    if is_chinese(atoms[i].text) and all(a.kind == "number" for a in atoms[i : more.end]):
        end = more.end
        while is_kind(atoms, end, "number") and is_chinese(atoms[end].text) and _unit(atoms, end + 1) is None:
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
    unit = _unit(atoms, i + 1)
    if unit is None or unit[0] not in ("length", "time", "angle") or is_kind(atoms, i - 1, "q"):
        return None
    if not atoms[i + 1].text.endswith(("s", "feet")) or len(atoms[i + 1].text) < 3:
        return None
    if (
        number == 4
        and unit[0] == "time"
        and atoms[i].text == "for"
        and not (i and atoms[i - 1].text == "for")
    ):
        return None
    text = f"{atoms[i].text} {atoms[i + 1].text}"
    return [quantity(unit[0], number * unit[1], text)], i + 2


def _speeds(atoms: list[Atom]) -> list[Atom]:
    """Length per time and angle per time, in either order: `10 cm a second`, 每秒十厘米."""
    out: list[Atom] = []
    i = 0
    while i < len(atoms):
        atom = atoms[i]
        if atom.kind == "q" and atom.value in ("length", "angle", "turns"):
            end, time_s = _per_time(atoms, i + 1)
            if time_s:
                kind = "speed" if atom.value == "length" else "rate"
                text = " ".join(a.text for a in atoms[i:end])
                out.append(quantity(kind, atom.number / time_s, text))
                i = end
                continue
        end, time_s = _each_time(atoms, i)
        if time_s and is_kind(atoms, end, "q") and atoms[end].value in ("length", "angle", "turns"):
            kind = "speed" if atoms[end].value == "length" else "rate"
            text = "".join(a.text for a in atoms[i : end + 1])
            verbs = [a for a in atoms[i:end] if a.kind in ("verb", "dir", "rot")]
            role = "" if atom.kind in ("per", "flag") else atoms[end].value
            out.extend([*verbs, quantity(kind, atoms[end].number / time_s, text, role)])
            i = end + 1
            continue
        out.append(atom)
        i += 1
    return out


def _per_time(atoms: list[Atom], i: int) -> tuple[int, float]:
    """The index after `per second`, `/s`, `a second`, `each second`, and the time.

    (i, 0) if it is not there.
    """
    if not (
        is_kind(atoms, i, "per")
        or is_kind(atoms, i, "num", "article")
        or is_kind(atoms, i, "flag", "each")
        or (is_kind(atoms, i, "q", "time") and atoms[i].text.startswith(("a ", "an ", "every ", "each ")))
    ):
        return i, 0.0
    if atoms[i].kind == "q":
        return i + 1, atoms[i].number
    if is_kind(atoms, i + 1, "q", "time"):
        return i + 2, atoms[i + 1].number
    unit = _unit(atoms, i + 1)
    return (i + 2, unit[1]) if unit and unit[0] == "time" else (i, 0.0)


def _each_time(atoms: list[Atom], i: int) -> tuple[int, float]:
    """每秒 [转] or 一秒 [转], `every second`, before a quantity."""
    end, time_s = i, 0.0
    if is_kind(atoms, i, "per") or is_kind(atoms, i, "flag", "each"):
        unit = _unit(atoms, i + 1)
        if unit and unit[0] == "time":
            end, time_s = i + 2, unit[1]
        elif is_kind(atoms, i, "per") and is_kind(atoms, i + 1, "q", "time"):
            end, time_s = i + 2, atoms[i + 1].number
    elif is_kind(atoms, i, "q", "time") and is_chinese(atoms[i].text) and atoms[i].number == 1.0:
        end, time_s = i + 1, atoms[i].number
    while time_s and end < len(atoms) and atoms[end].kind in ("glue", "verb", "dir", "rot"):
        end += 1
    return end, time_s


_LESS, _MORE = frozenset({"minus", "less", "take away", "减", "减去"}), frozenset({"plus", "+", "加", "加上"})
_SUMS = ("length", "angle", "time")


def _calculated(atoms: list[Atom]) -> list[Atom]:
    """`2 m minus 50 cm`, `twice as far as 60 cm`: one quantity."""
    out: list[Atom] = []
    i = 0
    while i < len(atoms):
        atom = atoms[i]
        sign = -1.0 if atom.text in _LESS else 1.0 if atom.text in _MORE else 0.0
        second = atoms[i + 1] if sign and i + 1 < len(atoms) else None
        first = out[-1] if out else None
        if first and second and first.kind == second.kind == "q" and first.value == second.value in _SUMS:
            text = f"{first.text} {atom.text} {second.text}"
            out[-1] = quantity(first.value, first.number + sign * second.number, text, first.role)
            i += 2
            continue
        if (
            first
            and atom.kind == first.kind == "q"
            and atom.value == first.value in _SUMS
            and atom.number < 0
        ):
            text = f"{first.text} {atom.text}"  # `2 m minus 50 cm`, read as a number below zero
            out[-1] = quantity(first.value, first.number + atom.number, text, first.role)
            i += 1
            continue
        factor = _factor_before(out) if atom.kind == "q" and atom.value in ("length", "angle") else None
        if factor is not None:
            text = f"{out[factor].text} {atom.text}"
            atom = quantity(atom.value, atom.number * out[factor].number, text, atom.role)
            del out[factor:]
        out.append(atom)
        i += 1
    return out


def _factor_before(out: list[Atom]) -> int | None:
    """Where `twice as far [as]` stands at the end of `out`."""
    at = len(out) - 1
    while at > 0 and out[at].kind == "glue" and out[at].text in ("as", "of"):
        at -= 1
    said = at >= 0 and at < len(out) - 1 and is_kind(out, at, "q", "scale")
    return at if said and " as " in out[at].text else None


def _summed(atoms: list[Atom]) -> list[Atom]:
    """`1 m 20 cm`, `2 minutes and 30 seconds`: one quantity, if the second is the smaller unit."""
    out: list[Atom] = []
    i = 0
    while i < len(atoms):
        atom = atoms[i]
        if atom.kind == "q" and out and atom.value in ("length", "time") and "." not in atom.text:
            joined = is_kind(out, len(out) - 1, "conn", "and")
            before = out[-2] if joined and len(out) > 1 else out[-1]
            if before.kind == "q" and before.value == atom.value and _is_part(before, atom):
                follows = next((a for a in atoms[i + 1 :] if a.kind not in ("glue", "num")), None)
                apart = follows is not None and follows.kind in ("dir", "verb", "rot", "flag")
                if not (joined and (_is_a_list(out) or (apart and _has_way(out)))):
                    del out[-2 if joined else -1 :]
                    out.append(
                        quantity(atom.value, before.number + atom.number, f"{before.text} {atom.text}")
                    )
                    i += 1
                    continue
        out.append(atom)
        i += 1
    return out


def _is_a_list(atoms: Sequence[Atom]) -> bool:
    """Whether `sides [of]` stands before the amount that ends `atoms`: `sides 1 m and 50 cm` are two."""
    before = [a for a in atoms[:-2] if a.kind != "glue"][-1:]
    return any(
        a.kind in ("counter", "role") and a.text.endswith(("sides", "edges", "legs")) for a in before
    ) or any(a.text.endswith(("sides of", "edges of")) for a in before)


def _has_way(atoms: Sequence[Atom]) -> bool:
    """Whether the clause has its direction before the amount: `forward 1 m and 20 cm left` are two."""
    for atom in reversed(atoms):
        if atom.kind == "sep" or (atom.kind == "conn" and atom.value == "then"):
            return False
        if atom.kind in ("dir", "rot"):
            return True
    return False


def _is_part(whole: Atom, part: Atom) -> bool:
    same = whole.text.split()[-1] == part.text.split()[-1]
    return not same and 0 < part.number < whole.number and part.number < (60 if part.value == "time" else 1.0)


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
            and not (out[j].value == "length" and _is_an_angle(out, i))
        ):
            factor = float(out[j].role)
            out[i] = quantity(out[j].value, out[i].number * factor, out[i].text, out[j].role)
    return out


def _is_an_angle(atoms: Sequence[Atom], i: int) -> bool:
    """`left 90, 50 cm`: a number like that at a side is degrees, whatever follows."""
    sided = is_kind(atoms, i - 1, "dir", "left") or is_kind(atoms, i - 1, "dir", "right")
    return sided and 15 <= atoms[i].number <= 720 and atoms[i].number % 15 == 0
