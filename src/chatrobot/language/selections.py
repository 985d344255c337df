"""What points at a part of what was done, and wants it again: `repeat the last step`, `do the second leg again`.

The forms and their words are `data/<code>/selections.toml`. Where the last motion was one step, the turns are counted
instead. The same file has the words by which an amount or a shape takes the place of the one before.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

from chatrobot.language.context import Dialogue
from chatrobot.language.data_files import load_table
from chatrobot.language.measures import whole_number
from chatrobot.language.tokens import SILENT, Atom
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Arc, Drive, Step, Turn

_KINDS: dict[str, tuple[type[Step], ...]] = {
    "step": (Step,),
    "turn": (Turn,),
    "leg": (Drive, Arc),
    "said": (Step,),
    "move": (Step,),
}


def selected(
    plain: str, language: str, dialogue: Dialogue, atoms_of: Callable[[str], list[Atom]]
) -> list[Step] | None:
    """The steps of earlier turns that a normalised text points at; None where it points at no part of them.

    Args:
        atoms_of: the atoms of a text; what stands around tells at most how often, and joins nothing on.

    Raises:
        Unclear: there is no such part.
    """
    if dialogue.last_motion is None:
        return None
    found = next(filter(None, (form.search(plain) for form in _forms(language))), None)
    if found is None:
        return None
    around = *atoms_of(plain[: found.start()]), *(after := atoms_of(plain[found.end() :]))
    counts = [a for a in around if (a.kind, a.value) == ("q", "times")]
    silent = sum(a.kind in SILENT for a in around) + len(counts) == len(around)
    if not silent or len(counts) > 1 or any(a.kind == "conn" for a in after):
        return None
    table, said = load_table(language, "selections"), found.groupdict(default="")
    kind = next((kind for kind, words in table["kinds"].items() if said.get("kind", "") in words), "step")
    units = _units(dialogue, kind)
    at, count = _number(said, "nth", table), _number(said, "count", table) or 1
    if (kind == "move" or not said.get("kind")) and (at, count) == (-1, 1):
        return None  # `the last move` is the whole of the last motion
    if at:
        first = at - 1 if at > 0 else len(units) + at - (count - 1 if at == -1 else 0)
        chosen = units[first : first + count] if 0 <= first <= len(units) - count else []
    else:
        chosen = units if said.get("all") or len(units) == count else []
    if not chosen:
        raise Unclear("nothing_before", plain)
    times = whole_number(counts[0].number, counts[0].text) if counts else 1
    return [step for unit in chosen for step in unit] * times


def _units(dialogue: Dialogue, kind: str) -> list[list[Step]]:
    """What is counted: the steps of that kind of the last motion, or the turns that moved."""
    turns = [list(turn.plan.steps) for turn in dialogue.turns if turn.plan is not None]
    if kind == "said" or len(turns[-1]) == 1:
        return [turn for turn in turns if kind == "said" or isinstance(turn[0], _KINDS[kind])]
    return [[step] for step in turns[-1] if isinstance(step, _KINDS[kind])]


def _number(said: dict[str, str], group: str, table: dict[str, Any]) -> int:
    """The number of an ordinal (`nth`) or a count; 0 for none. The last is -1, the one before it -2."""
    word = said.get(group, "")
    named = {**table["numbers"], **(table["ordinals"] if group == "nth" else {})}
    return int(word) if word.isdecimal() else int(named.get(word, 0))


def names_a_part(plain: str, language: str) -> bool:
    """Whether a text names a part of what was done, whatever else it says."""
    return any(form.search(plain) for form in _forms(language, "mentions"))


@cache
def _forms(language: str, name: str = "forms") -> tuple[re.Pattern[str], ...]:
    table = load_table(language, "selections")
    words = {
        **table.get("parts", {}),
        "kind": [word for words in table.get("kinds", {}).values() for word in words],
        "ordinal": table.get("ordinals", ()),
        "number": table.get("numbers", ()),
    }
    parts = {part: "|".join(sorted(named, key=len, reverse=True)) for part, named in words.items()}
    parts["number"] += r"|\d{1,2}"
    return tuple(
        re.compile(re.sub(r"(?<!\?P)<(\w+)>", lambda m: f"(?:{parts[m[1]]})", form))
        for form in table.get(name, ())
    )


def points_at_before(atom: Atom, language: str) -> bool:
    """Whether `again` points at the motion before, not at what is told beside it: `turn around and do the same`."""
    return atom.text in load_table(language, "selections").get("same", ())


def with_another_size(plain: str, atoms: Sequence[Atom], language: str) -> Atom | None:
    """The one length of `now with 50 cm`, `the same with 50 cm`, for the one before; None for anything else."""
    sized = [atom for atom in atoms if atom.kind == "q"]
    again = any(atom.value == "again" for atom in atoms)
    others = [
        atom for atom in atoms if atom.kind not in ("q", "filler", "glue", "sep") and atom.value != "again"
    ]
    with_ = tuple(load_table(language, "selections").get("with", ()))
    before = atoms[atoms.index(sized[0]) - 1].text if again and sized else ""
    opened = plain.startswith(with_) or f"{before} " in with_
    return sized[0] if opened and not others and len(sized) == 1 and sized[0].value == "length" else None
