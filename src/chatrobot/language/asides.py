"""What is said beside the command: remarks about others, doubts, and sentences that break off.

An aside may be passed over only where it holds no motion, amount, direction, negation or condition.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache

from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear

_HARMLESS = frozenset({"unknown", "glue", "filler", "remark", "reason"})
_IDLE_VERBS = frozenset({"go", "shift", "make", "turn"})


@cache
def _words(name: str) -> frozenset[str]:
    tables = [load_table(language, "asides") for language in LANGUAGES]
    return frozenset(word for table in tables for word in table.get(name, {}).get("x", ()))


@cache
def _clue(language: str, name: str) -> re.Pattern[str] | None:
    pattern = load_table(language, "asides").get("clues", {}).get(name)
    return re.compile(pattern) if pattern else None


@cache
def _unfinished() -> frozenset[str]:
    tables = [load_table(language, "asides").get("clues", {}) for language in LANGUAGES]
    return frozenset(word for table in tables for word in table.get("unfinished", ()))


def is_choice(text: str, language: str) -> bool:
    """Whether `text` leaves a choice open: `left or right?`."""
    pattern = _clue(language, "choice")
    return pattern is not None and pattern.search(text) is not None


def check_finished(atoms: Sequence[Atom]) -> None:
    """A sentence that ends on a word which must be followed by something is not acted on.

    Raises:
        Unclear: for a sentence that breaks off.
    """
    left = [a for a in atoms if a.kind != "sep"]
    while left and left[-1].kind == "filler" and left[-1].text not in _unfinished():
        left.pop()
    if len(left) > 1 and left[-1].text in _unfinished():
        raise Unclear("unknown_part", f"{left[-1].text}…")


def without_asides(atoms: Sequence[Atom], language: str) -> list[Atom]:
    """The atoms without the clauses that are about somebody else: 我手里拿着东西."""
    out: list[Atom] = []
    clause: list[Atom] = []
    for atom in (*atoms, Atom("sep", "end")):
        if atom.kind == "sep" and atom.value != "paren":
            if not _is_aside(clause, language):
                out += [Atom("unknown", a.text, a.text) if a.kind == "remark" else a for a in clause]
            clause = []
            if atom.value != "end":
                out.append(atom)
        else:
            clause.append(atom)
    return out


def _is_aside(clause: Sequence[Atom], language: str) -> bool:
    start = next((i for i, a in enumerate(clause) if a.kind != "filler"), None)
    if start is None:
        return False
    head = clause[start]
    if head.kind != "remark" and head.text not in _words("speaker"):
        return False
    rest = clause[start + (head.kind == "remark") :]
    subject = head.text in _words("speaker")  # 我要 and 我想 are words of their own: they ask for something
    if not subject and not any(a.kind in ("unknown", "remark") for a in clause[start:]):
        return False
    conditional = _clue(language, "conditional")
    if conditional is not None and conditional.search("".join(a.text for a in rest)):
        return False
    return all(
        a.kind in _HARMLESS
        or (a.kind == "verb" and a.value in _IDLE_VERBS)
        or (a.kind == "flag" and a.value == "bit")
        for a in rest
    )
