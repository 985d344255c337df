"""Amounts said by way of something else: a step that is defined in passing, wheels of a tricycle."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cache, lru_cache

from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.lexicon import cut, lexicon
from chatrobot.language.normalise import normalise
from chatrobot.language.tokens import Atom, quantity
from chatrobot.plan.steps import Drive, Plan

_IS = frozenset(
    {"being", "is", "=", "equals", "means", "are", "按", "算", "是", "为", "长", "等于", "counts as"}
)


_APART = frozenset({"each", "between", "after_each"})
_FACTORS = {
    "half": 0.5, "twice": 2.0, "double": 2.0, "two times": 2.0, "three times": 3.0, "thrice": 3.0,
    "a third": 1 / 3, "a quarter": 0.25,
}  # fmt: skip
"""`half as many metres as …`"""


@lru_cache(maxsize=1)
def _counts() -> tuple[tuple[re.Pattern[str], dict[str, int]], ...]:
    tables = [load_table(language, "facts") for language in LANGUAGES]
    return tuple(
        (re.compile(pattern), {str(k): int(v) for k, v in table["counts"].items()})
        for table in tables
        for pattern in table["patterns"]
    )


@lru_cache(maxsize=1)
def _unit_patterns() -> tuple[re.Pattern[str], ...]:
    tables = [load_table(language, "facts") for language in LANGUAGES]
    return tuple(re.compile(pattern) for table in tables for pattern in table.get("units", ()))


def defined_unit(text: str) -> tuple[str, str] | None:
    """The counted word and its measure, where all that `text` (normalised) says is what one of them is."""
    for pattern in _unit_patterns():
        found = pattern.fullmatch(text.strip(" ,.!;。"))
        if found:
            return found["unit"], found["measure"]
    return None


def told_of_units(text: str) -> tuple[str, dict[str, str]] | None:
    """The reply to a text (normalised) that only tells what units mean: its name, and what it mentions."""
    defined = defined_unit(text)
    if defined is not None:
        return "unit_set", {"unit": defined[0], "measure": defined[1]}
    word = _unit_chosen(text)
    return ("unit_chosen", {"unit": word}) if word else None


@lru_cache(maxsize=128)
def chosen_unit_m(text: str) -> float | None:
    """The length that a text says all numbers without a unit are in: `we count in feet`; None where it says none."""
    meaning = lexicon().words.get(cut(_unit_chosen(normalise(text))))
    return float(meaning[0][1]) if meaning and meaning[0][0] == "unit_length" else None


def _unit_chosen(text: str) -> str:
    forms = (form for code in LANGUAGES for form in _choices(code))
    found = next(filter(None, (form.fullmatch(text.strip(" ,.!;")) for form in forms)), None)
    return found["unit"] if found else ""


@cache
def _choices(language: str) -> tuple[re.Pattern[str], ...]:
    return tuple(re.compile(form) for form in load_table(language, "facts").get("unit_chosen", ()))


def with_known_counts(text: str) -> str:
    """`as many metres as a tricycle has wheels` → `3 metres`; unknown things stay as they are."""
    for pattern, counts in _counts():
        found = pattern.search(text)
        if found:
            key = f"{found['thing']} {found['part']}"
            value = counts.get(key) or counts.get(f"{found['thing'].rstrip('s')} {found['part']}")
            if value is not None:
                told = value * _FACTORS.get(found.groupdict().get("factor") or "", 1.0)
                return f"{text[: found.start()]} {told:g} {found['unit']} {text[found.end() :]}"
    return text


def with_defined_units(atoms: Sequence[Atom]) -> list[Atom]:
    """`two steps forward, …, a step being 30 cm`: the counted thing becomes a length."""
    for i, atom in enumerate(atoms):
        role = atom.value if atom.kind == "counter" else atom.role if _is_one(atom) else ""
        end = i + 1
        while role and end < len(atoms) and (atoms[end].text in _IS or atoms[end].kind == "filler"):
            end += 1
        linked = end > i + 1 or (bool(atom.text) and ord(atom.text[0]) > 0x2E7F)
        if not (
            role and linked and end < len(atoms) and atoms[end].kind == "q" and atoms[end].value == "length"
        ):
            continue
        start = i - 1 if i and atoms[i - 1].kind == "num" else i
        rest = [*atoms[:start], *atoms[end + 1 :]]
        if any(a.kind == "q" and a.value == "count" and a.role == role for a in rest):
            if any(a.kind == "flag" and a.value in _APART for a in rest):
                unit = quantity("length", atoms[end].number, atoms[end].text, "1.0")
                at = next(k for k, a in enumerate(rest) if a.kind == "q" and a.role == role)
                return [*rest[: at + 1], unit, *rest[at + 1 :]]
            return [_measured(a, role, atoms[end].number) for a in rest]
    return list(atoms)


def with_words_counted(atoms: Sequence[Atom], words: Mapping[str, Plan]) -> list[Atom]:
    """`three steps`, `two laps`, where this dialogue has said what a step or a lap is."""
    out: list[Atom] = []
    for atom in atoms:
        word = _counted_word(atom, words)
        plan = words.get(word)
        length_m = unit_length_m(plan) if plan is not None else None
        if plan is None:
            counted = (
                atom.kind == "defined" and bool(out) and out[-1].kind == "q" and out[-1].value == "number"
            )
            if counted:  # `three shuffles`
                out[-1:] = [atom, quantity("times", out[-1].number, out[-1].text)]
            else:
                out.append(atom)
        elif length_m is not None:
            out.append(_measured(atom, atom.role, length_m))
        else:
            out += [Atom("defined", word, atom.text), quantity("times", atom.number, atom.text)]
    return out


def _counted_word(atom: Atom, words: Mapping[str, Plan]) -> str:
    """The defined word that `atom` counts: `hop` in `three hops`; an empty string for none."""
    if atom.kind != "q" or atom.value != "count":
        return ""
    said = atom.text.split()[-1] if atom.text.split() else ""
    return next((word for word in (said, said.removesuffix("s"), atom.role) if word in words), "")


def unit_length_m(plan: Plan) -> float | None:
    """The length a word stands for where it was said as nothing but a length forward, metres."""
    only = plan.steps[0] if len(plan.steps) == 1 else None
    straight = isinstance(only, Drive) and not only.direction_rad and only.until is None
    return only.distance_m if isinstance(only, Drive) and straight else None


def _is_one(atom: Atom) -> bool:
    return atom.kind == "q" and atom.value == "count" and atom.number == 1.0


def _measured(atom: Atom, role: str, length_m: float) -> Atom:
    if atom.kind == "q" and atom.value == "count" and atom.role == role:
        return quantity("length", atom.number * length_m, atom.text, "1.0")
    return atom
