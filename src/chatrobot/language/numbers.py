"""Numbers in atoms: digits, words, fractions, of any language whose data lists digits and scales."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from chatrobot.language.tokens import Atom

FAR_M = 10.0
"""A bare number above that is no number of metres."""

Atoms = Sequence[Atom]


@dataclass(frozen=True)
class Number:
    """A number read from atoms; `end` is the index after it."""

    value: float
    end: int
    percent: bool = False


def is_kind(atoms: Atoms, i: int, kind: str, value: str | None = None) -> bool:
    """Whether there is an atom at `i` of that kind (and value)."""
    return 0 <= i < len(atoms) and atoms[i].kind == kind and (value is None or atoms[i].value == value)


def is_chinese(text: str) -> bool:
    return bool(text) and ord(text[0]) > 0x2E7F


_COUNTED = ("unit_length", "unit_angle", "unit_time")
"""What is counted in hundreds: `hundred centimetres`."""
_FEWEST_DEGREES = 10.0
"""Nobody says less than a degree as `point ninety degrees`."""
_NAMES_A_POINT = frozenset({"the", "a", "that", "this", "to the", "to a", "any", "some"})


def read_number(atoms: Atoms, i: int) -> Number | None:
    """The number that begins at `i`, or None. An article alone is no number."""
    if is_kind(atoms, i, "num", "minus"):
        inner = read_number(atoms, i + 1)
        return Number(-inner.value, inner.end, inner.percent) if inner else None
    if is_kind(atoms, i, "num", "root"):
        inner = read_number(atoms, i + 1)
        return Number(math.sqrt(inner.value), inner.end) if inner and inner.value >= 0 else None
    if is_kind(atoms, i, "num", "percent_of"):
        inner = _plain(atoms, i + 1)
        return Number(inner.value / 100.0, inner.end, percent=True) if inner else None
    number = _fraction(atoms, i) or _plain(atoms, i)
    return _with_fraction(atoms, number) if number else None


def _with_fraction(atoms: Atoms, number: Number) -> Number:
    """What may follow a number: `/ 3`, `over three`, 分之, quarters, `and a half`, `1/2`, 个半."""
    value, end = number.value, number.end
    if is_kind(atoms, end, "num", "parts"):
        over = _plain(atoms, end + 1)
        return Number(over.value / value, over.end) if over and value else number
    if (is_kind(atoms, end, "per") and atoms[end].text == "/") or is_kind(atoms, end, "num", "over"):
        over = _plain(atoms, end + 1)
        if over and over.value:
            return Number(value / over.value, over.end)
    if is_kind(atoms, end, "fraction") and value == int(value if math.isfinite(value) else 0):
        parts = float(atoms[end].value)
        if parts == 2 and value not in (1.0, 0.0):
            turns = is_kind(atoms, end + 1, "verb", "turn") and atoms[end + 1].text.endswith("s")
            if turns and atoms[end].text == "half":
                return Number(value * 0.5, end + 1)  # `three half turns`
            return Number(value + 0.5, end + 1) if atoms[end].text == "half" else number
        return Number(value / parts, end + 1)
    if end < len(atoms) and atoms[end].text == "又":
        part = _fraction(atoms, end + 1) or _plain(atoms, end + 1)
        part = _with_fraction(atoms, part) if part else None
        if part and 0 < part.value < 1:
            return Number(value + part.value, part.end)
    addition = read_addition(atoms, end)
    if addition:
        return Number(value + addition.value, addition.end)
    if is_kind(atoms, end, "number") and is_kind(atoms, end + 1, "per") and atoms[end + 1].text == "/":
        over = _plain(atoms, end)
        whole = _with_fraction(atoms, over) if over else None
        if whole and 0 < whole.value < 1:
            return Number(value + whole.value, whole.end)
    halves = is_kind(atoms, end, "num", "ge") and is_kind(atoms, end + 1, "num", "half")
    if halves and (is_kind(atoms, end + 2, "unit_length") or is_kind(atoms, end + 2, "unit_turn")):
        return Number(value * 0.5, end + 2)  # 两个半米; two and a half would be 两米半
    if halves:
        return Number(value + 0.5, end + 2)
    # "2 pi", "half pi": a number before pi multiplies it.
    if is_kind(atoms, end, "number") and atoms[end].value.startswith("3.14159") and value != math.pi:
        return _with_fraction(atoms, Number(value * math.pi, end + 1))
    return number


def read_addition(atoms: Atoms, i: int) -> Number | None:
    """`and a half`, `and a quarter`, `and three quarters`, or a bare 半."""
    if is_kind(atoms, i, "num", "half") and atoms[i].text == "半":
        return Number(0.5, i + 1)
    if not is_kind(atoms, i, "conn", "and"):
        return None
    i += 1
    if is_kind(atoms, i, "num", "article") and is_kind(atoms, i + 1, "fraction"):
        return Number(1.0 / float(atoms[i + 1].value), i + 2)
    count = _plain(atoms, i)
    if count and count.value in (1.0, 2.0, 3.0) and is_kind(atoms, count.end, "fraction"):
        return Number(count.value / float(atoms[count.end].value), count.end + 1)
    return Number(0.5, i + 1) if is_kind(atoms, i, "fraction", "2") else None


def _fraction(atoms: Atoms, i: int) -> Number | None:
    """`half`, `a half`, `a quarter`, `a third`, 半, 一半."""
    if is_kind(atoms, i, "num", "half"):
        end = i + 1
        return Number(0.5, end + 1 if is_kind(atoms, end, "num", "ge") else end)
    start = i + 1 if is_kind(atoms, i, "num", "article") else i
    if start == i and is_kind(atoms, i, "fraction", "3") and _is_amount(atoms, i + 1):
        return None  # `third, half a metre ahead`
    if is_kind(atoms, start, "fraction") and (start > i or atoms[start].value in ("2", "4", "3")):
        value = 1.0 / float(atoms[start].value)
        if is_kind(atoms, start + 1, "num", "article") and is_kind(atoms, start + 2, "number", "12"):
            return Number(value * 12.0, start + 3)
        if is_kind(atoms, start + 1, "number", "12"):
            return Number(value * 12.0, start + 2)
        return Number(value, start + 1)
    return None


def _is_amount(atoms: Atoms, i: int) -> bool:
    return is_kind(atoms, i, "num", "half") or any(is_kind(atoms, i, k) for k in ("number", "fraction"))


def _plain(atoms: Atoms, i: int) -> Number | None:
    """An integer in words with scales, or a literal, with decimals after a spoken point."""
    start = i
    total, section, current = 0.0, 0.0, None
    scale = 0.0
    after_zero = False
    while i < len(atoms):
        atom = atoms[i]
        if atom.kind == "number":
            written = current is not None and atoms[i - 1].text[-1:].isdigit()  # `a 360 five times`
            joined = None if written and atom.text.isalpha() else _joined(current, atom, float(atom.value))
            if joined is None:
                break
            after_zero = after_zero or (current is None and float(atom.value) == 0 and scale > 0)
            current = joined
        elif atom.kind == "scale":
            if current is None and not (section or total) and not _scale_alone(atoms, i, start):
                break
            scale = float(atom.value)
            if scale >= 1000:
                total += (section + (1.0 if current is None and not section else current or 0.0)) * scale
                section, current = 0.0, None
            else:
                section += (1.0 if current is None else current) * scale
                current = None
        elif not (_is_joining_and(atoms, i) and scale):
            break
        i += 1
    if i == start:
        return None if _points_at_angle(atoms, i) else _decimals(atoms, i, 0.0)
    if (
        current is not None
        and 1 <= current <= 9
        and scale >= 100
        and not after_zero
        and is_chinese(atoms[i - 1].text)
    ):
        current *= scale / 10.0  # 一百八 is 180
    value = total + section + (current or 0.0)
    return _decimals(atoms, i, value) or Number(value, i)


def _scale_alone(atoms: Atoms, i: int, start: int) -> bool:
    """A scale may stand without a number before it in Chinese (十), after an article, and before a unit."""
    counts = _is_joining_and(atoms, i + 1) or any(is_kind(atoms, i + 1, unit) for unit in _COUNTED)
    return counts or is_chinese(atoms[i].text) or is_kind(atoms, start - 1, "num", "article")


def _is_joining_and(atoms: Atoms, i: int) -> bool:
    return (
        is_kind(atoms, i, "conn", "and")
        and is_kind(atoms, i - 1, "scale")
        and is_kind(atoms, i + 1, "number")
        and atoms[i + 1].text.isalpha()
        and not is_chinese(atoms[i + 1].text)
    )


def _joined(current: float | None, atom: Atom, value: float) -> float | None:
    """`current` with one more number word, or None where a new number begins."""
    if current is None:
        return value
    if not atom.text.isalpha() or not math.isfinite(value) or value == math.pi:
        return None
    if current >= 20 and current % 10 == 0 and 1 <= value <= 9:
        return current + value
    if 1 <= current <= 9 and 10 <= value <= 99 and not is_chinese(atom.text):
        return current * 100 + value  # "one eighty"
    if current == 0 and is_chinese(atom.text):
        return value
    return None


def _points_at_angle(atoms: Atoms, i: int) -> bool:
    """`Point 90 degrees to the left`: what is to be done, and no decimal point."""
    whole = is_kind(atoms, i + 1, "number") and float(atoms[i + 1].value) >= _FEWEST_DEGREES
    return whole and is_kind(atoms, i, "num", "point") and is_kind(atoms, i + 2, "unit_angle")


def _decimals(atoms: Atoms, i: int, whole: float) -> Number | None:
    """The digits after a spoken point at `i`."""
    named = i > 0 and atoms[i - 1].text in _NAMES_A_POINT  # `to the point 3 metres ahead`
    if named or not is_kind(atoms, i, "num", "point"):
        return None
    digits = ""
    i += 1
    while is_kind(atoms, i, "number") and math.isfinite(float(atoms[i].value)):
        word = f"{float(atoms[i].value):g}"
        if not word.isdigit():
            break
        if digits and len(word) == 1 and len(digits) == 2 and digits[1] == "0" and digits != "00":
            digits = digits[0] + word  # "point twenty five"
        else:
            digits += word
        i += 1
    return Number(whole + float(f"0.{digits}"), i) if digits else None
