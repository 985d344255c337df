"""Corrections inside a sentence (`left, sorry, I mean right`) and negations (`don't turn left. Turn right.`)."""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence

from chatrobot.language.frames import EXTENTS, Frame
from chatrobot.language.lexicon import cut, lexicon
from chatrobot.language.numbers import FAR_M, is_chinese
from chatrobot.language.tokens import SILENT, Atom, joined, quantity
from chatrobot.language.unclear import Unclear
from chatrobot.language.unfinished import lasts

_NO = frozenset({"no", "nope", "nah", "不", "wait", "sorry", "oops", "whoops", "等等", "no no", "rather"})
_SLIPS = _NO | {"actually", "well actually", "damn", "dang", "argh", "pardon", "excuse me", "apologies", "my apologies",
                "whoopsie", "ehm", "er", "erm", "uh", "um"}  # fmt: skip
"""What stands between an amount and the one that was meant."""
_WAIT = [("sep", ","), ("verb", "wait"), ("sep", ",")]
"""`1 m, wait, 2 m`: to stand still between them, or a slip?"""
_ONLY_AFTER = frozenset({"rather", "wrong", "make it", "还是", "算了", "不是", "应该是"})
"""Corrections only after something in the same sentence."""
_DENIED = frozenset({"no", "nope", "no no", "oops", "whoops", "sorry", "oh no", "oh"})
_DENIALS = frozenset({"不是", "not that"})
_AFTERTHOUGHTS = frozenset({"i mean", "i meant", "i mean to say", "rather"})
_UNIT_FACTOR = re.compile(r"\d[\d.e+-]*")
_PIECE = ("dir", "rot", "q", "pace", "verb", "shape", "place")
_REPLACED = frozenset({"q", "dir", "rot"})
_OFTEN = 12  # a bare number above is rather an amount than so many times
MEANT = "meant"
"""The flag of what corrects the turn before."""
CORRECTING = frozenset({MEANT, "short_of"})
"""The flags of what puts the turn before right: by what was meant, or by the total that was meant."""
_CORRECTED = frozenset({*EXTENTS, "number", "speed", "rate", "radius"})
_TOTALS = frozenset({"total", "until"})
_OPPOSITE = ("other_way", "mirrored")
_ORDERED = ("verb", "dir", "rot", "shape")
_TOLD = frozenset({"q", "place", "flag", "nth"})
"""What makes a verb an order, beside a way and a shape."""
_WAYS = frozenset({"dir", "rot", "shape", "place", "number", "unknown", "num"})
_MOTIONS = frozenset({"length", "angle", "turns", "again", "return", "go", "turn", "count", "fold"})
"""Kinds of atoms, and values of others, which a denial to move goes on with: `don't move forward`, `… 1 m`."""
_OTHER_ROT = {"left": "right", "right": "left"}
_BEFORE_MEANT = frozenset({"sep", "filler", "glue", "negation", "correction"})


def with_slips(atoms: Sequence[Atom]) -> list[Atom]:
    """`Three metres, oops, two metres`: what stands alone between two amounts of one kind corrects the first."""
    amounts = [i for i, a in enumerate(atoms) if a.kind == "q" and a.value in _CORRECTED]
    out = list(atoms)
    for first, second in itertools.pairwise(amounts):
        same = atoms[first].value in (atoms[second].value, "number")
        between = range(first + 1, second)
        if same and [(atoms[i].kind, atoms[i].text) for i in between] == _WAIT:
            raise Unclear("unclear_motion", f"{atoms[first].text}, wait, {atoms[second].text}")
        slips = [i for i in between if atoms[i].text in _SLIPS and atoms[i].kind != "verb"]
        alone = all(atoms[i].kind in ("sep", "filler") for i in between if i not in slips)
        if same and slips and alone:
            out[slips[-1]] = Atom("correction", "replace", atoms[slips[-1]].text)
    return out


def corrected(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms as if they had been said right at once; a flag before what corrects the turn before."""
    out = _of_the_turn_before(list(atoms))
    while True:
        at = next((i for i in range(len(out)) if _is_correction(out, i)), None)
        if at is None:
            return out
        before, after = out[:at], out[at + 1 :]
        if _is_afterthought(before, out[at], after):
            out = [*before, *after]
            continue
        if out[at].kind == "correction" and out[at].value == "cancel":
            if not any(a.kind in _PIECE for a in after):
                raise Unclear("taken_back", out[at].text)
            while after and after[0].kind in ("sep", "negation", "filler", "correction"):
                after = after[1:]
            back = [a.value for a in after if a.kind not in SILENT] in (["go", "back"], ["back"])
            is_undone = back and not any(a.kind in _PIECE for a in before)
            out = [Atom("verb", "undo", out[at].text)] if is_undone else after
        else:
            out = _replaced(_trimmed(before), after)


def _of_the_turn_before(atoms: list[Atom]) -> list[Atom]:
    """`no, I meant right`, `sorry, left`, `not left, right`: a correction of the turn before.

    Amounts alone are a total: what is missing to it is done.
    """
    at = 0
    while at < len(atoms) and (atoms[at].kind in _BEFORE_MEANT or atoms[at].value in _OPPOSITE):
        at += 1
    real = [a for a in atoms[at:] if a.kind not in ("sep", "filler", "glue")]
    if at and real and real[0].value == "overshot":
        return atoms[at:]  # `oh no, too far, come back half of that`: what is to be done is told
    ways = any(a.kind in ("dir", "rot") for a in real)
    cancels = bool(atoms) and (atoms[0].kind, atoms[0].value) == ("correction", "cancel")
    if cancels and len(atoms) > 1 and atoms[1].kind in ("dir", "rot"):
        raise Unclear("unclear_motion", atoms[0].text)  # `not that right, my right`
    said = [a for a in atoms[:at] if (a.kind, a.value) == ("correction", "replace")]
    meant = any(a.text not in _ONLY_AFTER for a in said) and (
        ways or any(a.kind in ("verb", "shape", "place") for a in real)
    )
    totals = any((a.kind, a.value) == ("flag", "total") for a in real)
    sizes = [a for a in real if a.kind != "flag" or a.value not in _TOTALS]
    amounts = bool(sizes) and all(a.kind == "q" for a in sizes) and (totals or sizes == real)
    swapped = any((a.kind, a.value) == ("flag", "instead") for a in real)
    lone = amounts or (
        ways and all(a.kind in ("dir", "rot", "q", "negation") or a.value == "instead" for a in real)
    )
    denied = len(atoms) > 1 and atoms[0].text in _DENIED and atoms[1].kind == "sep"
    negated = any(a.kind == "negation" and a.text == "not" for a in atoms) and len(real) > 1
    if (lone or meant) and not swapped and _is_denied(atoms, at):  # `no, not left`, `oh no, don't turn left`
        raise Unclear("only_forbidden", " ".join(a.text for a in atoms))
    if meant and real[0].kind == "verb" and atoms[at - 1].kind == "negation":
        return atoms[at - 1 :]  # `oh no, don't turn left, turn right`
    opposite = [a for a in atoms[:at] if a.value in _OPPOSITE]
    if (said or denied) and opposite and not real:
        return [Atom("flag", MEANT, (said or atoms)[0].text), opposite[0]]  # 不对，反方向
    if amounts and (said or denied or totals):
        return [Atom("flag", "short_of", atoms[0].text), *atoms[at:]]
    if meant or (lone and ways and (denied or negated or swapped or atoms[0].text == "i said")):
        start = at if meant or not negated else 0
        return [Atom("flag", MEANT, (said or atoms)[0].text), *atoms[start:]]
    return atoms


def _is_denied(atoms: Sequence[Atom], at: int) -> bool:
    """Whether what begins at `at` is the last part, and denied behind a mark; but not `not left, right`."""
    before = [a for a in atoms[:at] if a.kind not in ("filler", "glue")]
    last = not any(a.kind in ("sep", "conn", "negation") and a.text not in ".!?" for a in atoms[at:])
    opens = any(a.kind in ("sep", "correction") for a in before)
    return last and opens and (before[-1].text in _DENIALS or before[-1].kind == "negation")


def _is_correction(atoms: list[Atom], i: int) -> bool:
    atom = atoms[i]
    if atom.kind == "correction":
        if atom.text in _ONLY_AFTER:
            return i > 0 and any(a.kind in _PIECE for a in atoms[:i])
        return True
    if atom.kind == "flag" and atom.value == "instead" and is_chinese(atom.text):  # 左转改成右转
        return any(a.kind in _REPLACED for a in atoms[:i]) and any(a.kind in _PIECE for a in atoms[i + 1 :])
    if atom.text not in _NO or atom.kind not in ("filler", "negation", "verb", "glue"):
        return False
    if not any(a.kind in _PIECE for a in atoms[:i]) or atoms[i - 1].kind not in ("sep", "filler"):
        return False
    following = atoms[i + 1 :]
    if atom.kind == "negation" or atom.text in ("no", "nope", "不"):
        return bool(following) and following[0].kind in ("sep", "dir", "rot", "q", "verb", "filler")
    # `sorry, right`: only where a lone piece follows.
    real = [a for a in following if a.kind not in ("sep", "filler", "glue")]
    return atom.text in ("sorry", "oops", "whoops") and bool(real) and real[0].kind in ("dir", "rot", "q")


def _is_afterthought(before: list[Atom], word: Atom, after: list[Atom]) -> bool:
    """`…, sideways I mean`: what was meant stands before it already."""
    ends = not any(a.kind in _PIECE for a in after)
    return ends and word.text in _AFTERTHOUGHTS and bool(before) and before[-1].kind not in ("sep", "conn")


def _trimmed(atoms: list[Atom]) -> list[Atom]:
    while atoms and (
        atoms[-1].kind in ("sep", "filler", "glue", "conn") or atoms[-1].text in ("等等", "等一下", "等下")
    ):
        atoms = atoms[:-1]
    return atoms


def _replaced(before: list[Atom], after: list[Atom]) -> list[Atom]:
    start = 0
    while start < len(after) and after[start].kind in ("sep", "filler", "glue", "negation", "correction"):
        start += 1
    end = start
    while end < len(after) and not (
        (after[end].kind == "sep" and after[end].value != "paren")
        or (after[end].kind == "conn" and after[end].value == "then")
    ):
        end += 1
    said, rest = after[start:end], after[end:]
    pieces = [a for a in said if a.kind in _PIECE]
    if start and after[start - 1].kind == "negation":
        if any(a.kind in _PIECE for a in rest):
            return _replaced(before, rest)  # `left, no, not left, right`
        raise Unclear("only_forbidden", " ".join(a.text for a in after))  # `stop, I wanted not left`
    unit = next((a for a in said if a.kind in ("unit_length", "unit_angle", "unit_time")), None)
    last = next((i for i in range(len(before) - 1, -1, -1) if before[i].kind == "q"), None)
    if not pieces and unit is not None and last is not None and before[last].value == "number":
        name, factor = unit.kind[5:], float(unit.value)
        amount = quantity(
            name, before[last].number * factor, f"{before[last].text} {unit.text}", repr(factor)
        )
        return [*before[:last], amount, *before[last + 1 :], *rest]
    if pieces and all(a.kind == "q" for a in pieces) and not any(a.kind in _PIECE for a in before):
        again = [
            a for a in before if a.value == "again"
        ]  # `that again, I mean 2 m`: once more, by another amount
        return [*(again or [Atom("flag", "short_of", "not")]), *said, *rest]
    if not pieces:
        raise Unclear("unknown_part", " ".join(a.text for a in after[:end]))
    if _is_clause(pieces):
        return [*before[: _last_clause(before)], *said, *rest]
    out = list(before)
    added: list[Atom] = []
    for piece in pieces:
        at = _same_kind(out, piece)
        if at is None:
            added.append(piece)
        else:
            out[at] = _in_the_unit_of(out[at], piece)
    return [*out, *added, *rest]


def _in_the_unit_of(before: Atom, number: Atom) -> Atom:
    """`2 metres, no, make it 3`: the unit was said already; but not `half a metre, no, make it 75`.

    `5 times, no, make it 3` is so often; but not `twice, no, make it 45`.

    Raises:
        Unclear: where it would be far, or often.
    """
    if (before.value, number.value) == ("times", "number"):
        if number.number > max(_OFTEN, before.number):
            raise Unclear("no_unit", number.text)
        return quantity("times", number.number, number.text, before.role)
    factor = _UNIT_FACTOR.fullmatch(before.role)
    if number.kind != "q" or number.value != "number" or before.value == "number" or factor is None:
        return number
    if before.value == "length" and number.number * float(factor[0]) > max(FAR_M, before.number):
        raise Unclear("no_unit", number.text)
    return quantity(before.value, number.number * float(factor[0]), number.text, before.role)


def _is_clause(pieces: list[Atom]) -> bool:
    has_way = any(a.kind in ("dir", "rot") for a in pieces)
    has_verb = any(a.kind in ("verb", "shape") for a in pieces)
    has_extent = any(a.kind == "q" and a.value in EXTENTS for a in pieces)
    return (has_verb and (has_way or has_extent)) or (has_way and has_extent)


def _last_clause(atoms: list[Atom]) -> int:
    """Where the clause that is corrected begins: after the last break that has a motion behind it."""
    end = len(atoms)
    for i in range(len(atoms) - 1, -1, -1):
        breaks = atoms[i].kind == "conn" or (atoms[i].kind == "sep" and atoms[i].value != "paren")
        if breaks and any(a.kind in ("verb", "dir", "rot", "shape") for a in atoms[i:end]):
            return i + 1
    return 0


def _same_kind(atoms: list[Atom], piece: Atom) -> int | None:
    for i in range(len(atoms) - 1, -1, -1):
        atom = atoms[i]
        if atom.kind == piece.kind == "q" and (
            atom.value in (piece.value, "number")
            or {atom.value, piece.value} <= {"angle", "turns"}
            or (piece.value == "number" and atom.value in ("length", "angle", "times"))
        ):
            return i
        sideways = piece.kind in ("dir", "rot") and atom.kind in ("dir", "rot")
        if sideways or (atom.kind == piece.kind and piece.kind in ("pace", "verb", "shape", "place")):
            return i
    return None


def with_denied_motions(atoms: Sequence[Atom]) -> list[Atom]:
    """`Don't move` is to stand still; `don't move forward`, 别动往前 denies the motion that follows."""
    out: list[Atom] = []
    for i, atom in enumerate(atoms):
        denied = _denied(atom.text) if (atom.kind, atom.value) == ("verb", "wait") else []
        after = next((a for a in atoms[i + 1 :] if a.kind not in ("glue", "filler")), None)
        is_bound = after is not None and (after.kind in _WAYS or after.value in _MOTIONS)
        out += denied if denied and is_bound else [atom]
    return out


def _denied(written: str) -> list[Atom]:
    """The negation that words begin with, and what it denies; nothing where they begin with none."""
    units, known = cut(written), lexicon().words
    for length in range(len(units) - 1, 0, -1):
        kind, value = known.get(units[:length], (("", ""),))[0]
        if kind == "negation":
            return [Atom(kind, value, joined(units[:length])), Atom("verb", "go", joined(units[length:]))]
    return []


def without_negated(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms without what is forbidden. What is left must be a command of its own.

    Raises:
        Unclear: where nothing is left, or an amount is negated.
    """
    out, i = _opened_by_no(atoms)
    denied, ahead = False, False
    sides: list[Atom] = []
    while i < len(atoms):
        if atoms[i].kind != "negation" and not (atoms[i].kind == "correction" and atoms[i].text in _DENIALS):
            out.append(atoms[i])
            i += 1
            continue
        scope, end = _forbidden(atoms, i)
        if scope.verb in ("turn", "spin") and not (scope.direction or scope.rot):
            out.append(Atom("flag", "no_turn", "don't turn"))
        if scope.rot in _OTHER_ROT and not scope.verb:
            sides.append(Atom("rot", _OTHER_ROT[scope.rot], atoms[i].text))
        denied |= bool(scope.moves and not scope.verb)  # `drive not a circle`: the verb alone orders nothing
        ahead |= scope.direction == "forward" and not scope.verb
        i = end
    ordered = ("dir", "rot", "shape") if denied and not any(a.kind in _TOLD for a in out) else _ORDERED
    if len(out) < len(atoms) and not any(a.kind in ordered for a in out):
        said = " ".join(a.text for a in atoms)
        raise Unclear("no_lasting_rule" if lasts(said) else "only_forbidden", said)
    sided = any(a.kind in ("dir", "rot") and a.value in _OTHER_ROT for a in out)
    out = out if sided else [*out, *sides[:1]]  # `spin once, not clockwise`
    if ahead and not any(a.kind in ("dir", "rot", "shape", "place") for a in out):
        raise Unclear("which_way", " ".join(a.text for a in atoms))  # `a metre, not forward`
    return out


def _opened_by_no(atoms: Sequence[Atom]) -> tuple[list[Atom], int]:
    """What a `no` that opens a sentence stands for, and where the sentence goes on behind it."""
    if len(atoms) < 2 or atoms[0].text not in ("no", "不") or atoms[1].kind != "sep":
        return [], 0
    is_total = any(a.kind == "flag" and a.value == "total" for a in atoms)
    return [Atom("flag", "short_of", atoms[0].text)] if is_total else [], 2


def _forbidden(atoms: Sequence[Atom], at: int) -> tuple[Frame, int]:
    """What the negation at `at` forbids, and where that ends.

    Raises:
        Unclear: where it is unknown, or an amount, or announces something.
    """
    scope, end = Frame(), at + 1
    while end < len(atoms) and atoms[end].kind not in ("sep", "conn", "negation"):
        atom = atoms[end]
        is_extent = atom.kind == "q" and atom.value in EXTENTS
        if is_extent or atom.kind in ("unknown", "refuse", "condition"):
            raise Unclear("unknown_part", " ".join(a.text for a in atoms[at : end + 1]))
        is_light = atom.kind in ("glue", "filler") or scope.add(atom)
        if atom.text == "but" or not (is_light or atom.kind in ("dir", "rot")):
            break  # `don't back up to the right` denies both ways
        end += 1
    announces = end < len(atoms) and (atoms[end].kind, atoms[end].value) == ("sep", "colon")
    if not scope.moves and (announces or not (scope.pace or scope.flags)):  # `never do this: …`
        raise Unclear("unknown_part", " ".join(a.text for a in atoms[at:end]))
    return scope, end
