"""Leaves out what carries no motion within a clause: reasons, similes, adverbs of manner, names.

The rule: only a stretch that cannot be an instruction may be passed over. It must have a shape that no
instruction has (a reason, an adverb of manner, a name set off by a comma) and hold no amount, direction, condition
or place. An unknown word anywhere else is asked about. Whole clauses that are talk are left out before: `acts.py`.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear

_BEFORE_MANNER = ("verb", "dir", "rot", "q", "sep", "conn", "filler", "pace", "shape")
_WAYS = frozenset({"q", "number", "dir", "rot", "shape", "place", "defined", "again"})


@lru_cache(maxsize=1)
def _words() -> dict[str, frozenset[str]]:
    found: dict[str, set[str]] = {}
    for language in LANGUAGES:
        for name, listed in load_table(language, "chatter").items():
            found.setdefault(name, set()).update(listed.split("|") if isinstance(listed, str) else listed)
    return {name: frozenset(word.strip() for word in listed) for name, listed in found.items()}


def without_chatter(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms without reasons and the like; whatever could be part of an instruction stays.

    Raises:
        Unclear: for a reason that has an amount or a condition in it.
    """
    out: list[Atom] = []
    for clause, separator in _clauses([_without_manner(atoms, i) for i in range(len(atoms))]):
        kept = _of_clause(clause)
        out.extend(kept)
        if separator is not None:
            out.append(separator)
    return _without_vocative(out)


def without_cautions(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms without `and don't hit anything`, `without bumping into a chair`: no motion is to do that."""
    out: list[Atom] = []
    for clause, separator in _clauses(list(atoms)):
        at = next((i for i, atom in enumerate(clause) if atom.kind == "negation"), None)
        if at is not None and _is_caution(clause[at + 1 :]):
            clause = clause[:at]
        out += clause
        if separator is not None:
            out.append(separator)
    while out and out[-1].kind in ("sep", "conn") and len(out) < len(atoms):
        out.pop()
    return out


def _is_caution(denied: Sequence[Atom]) -> bool:
    """Whether what is denied is to harm something, and no motion."""
    told = [atom for atom in denied if atom.kind not in ("filler", "glue", "verb", "num")]
    harms = [atom for atom in told if atom.value == "harm" or atom.text in _words()["harming"]]
    things = [atom for atom in told if atom not in harms]
    return bool(harms) and all(atom.text in _words()["harmed"] for atom in things)


def _clauses(atoms: list[Atom]) -> list[tuple[list[Atom], Atom | None]]:
    clauses: list[tuple[list[Atom], Atom | None]] = []
    clause: list[Atom] = []
    for atom in atoms:
        if atom.kind == "conn" or (atom.kind == "sep" and (atom.value != "paren" or atom.text in "—–")):
            clauses.append((clause, atom))
            clause = []
        else:
            clause.append(atom)
    clauses.append((clause, None))
    return clauses


def _of_clause(clause: list[Atom]) -> list[Atom]:
    at = next((i for i, a in enumerate(clause) if a.kind == "reason"), None)
    if at is None:
        return _without_beneficiary(_without_simile(clause))
    reason = clause[at:]
    moves = any(a.kind in _WAYS or a.kind == "verb" for a in reason)
    if any(a.kind in ("q", "refuse", "condition") for a in reason) or (
        moves and any(a.kind == "negation" for a in reason)
    ):
        raise Unclear("unknown_part", " ".join(a.text for a in reason))
    before = clause[:at]
    if reason[0].text.startswith("to ") and before and not any(a.kind in _WAYS for a in before):
        raise Unclear("unknown_part", " ".join(a.text for a in reason))
    return before


def _without_manner(atoms: Sequence[Atom], i: int) -> Atom:
    """An unknown adverb of manner (`majestically`) changes no geometry; without an amount it may be the order."""
    atom = atoms[i]
    if not any(each.kind in ("q", "shape", "place") for each in atoms):
        return atom
    manner = atom.kind == "unknown" and atom.text.endswith("ly") and len(atom.text) > 4
    manner = manner and (i == 0 or atoms[i - 1].kind in _BEFORE_MANNER)
    return Atom("filler", "x", atom.text) if manner and atom.text not in _words()["not_manner"] else atom


def _without_simile(clause: list[Atom]) -> list[Atom]:
    """`like a ballerina`: how it looks, not where it goes; but not `like a pendulum`."""
    for i, atom in enumerate(clause):
        if atom.text != "like" or i + 2 >= len(clause) or clause[i + 1].text not in ("a", "an", "some", "my"):
            continue
        end = i + 2
        while end < len(clause) and (clause[end].kind == "unknown" or clause[end].text in ("old", "little")):
            end += 1
        named = [a.text for a in clause[i + 2 : end]]
        if end > i + 2 and end - i <= 5 and not set(named) & _words()["motion_similes"]:
            return [*clause[:i], *clause[end:]]
    return clause


def _without_beneficiary(clause: list[Atom]) -> list[Atom]:
    """`one metre forward for my video`: at the end of a clause that says how far."""
    at = next((i for i in range(len(clause) - 2, 0, -1) if clause[i].text == "for"), None)
    if at is None or clause[at + 1].text not in ("the", "my", "our", "your", "his", "her", "their"):
        return clause
    named = [a for a in clause[at + 2 :] if a.kind != "filler"]
    extent = any(a.kind == "q" and a.value in ("length", "angle", "turns", "time") for a in clause[:at])
    if named and len(named) <= 2 and extent and all(a.kind == "unknown" for a in named):
        return clause[:at]
    return clause


def _without_vocative(atoms: list[Atom]) -> list[Atom]:
    """`Zorblax, go forward`: a name set off at the very beginning, if it is nothing one could do."""
    start = 0
    while start < len(atoms) and atoms[start].kind in ("filler", "sep"):
        start += 1
    if start + 1 >= len(atoms) or atoms[start].kind != "unknown" or atoms[start + 1].kind != "sep":
        return atoms
    word = atoms[start].text
    plausible = word.isalpha() and len(word) > 2 and not word.endswith(("ing", "ed", "ly", "ward", "wards"))
    named = plausible and word.isascii() and word not in _words()["doings"]
    if named and atoms[start + 1].value == "weak" and any(a.kind in _WAYS for a in atoms[start + 2 :]):
        return [*atoms[:start], *atoms[start + 2 :]]
    return atoms
