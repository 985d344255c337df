"""`Drive around the table`, 绕着厨房走一圈: a place that is to be driven around, once or more often, and not to."""

from __future__ import annotations

import math
from collections.abc import Sequence

from chatrobot.core.geometry import Pose
from chatrobot.language.context import Context
from chatrobot.language.data_files import relation_words
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Go

AROUND = "around_place"
"""The flag of a place that is to be driven around."""
_LAPS = ("lap", "loop")
_BESIDE = frozenset({"glue", "num", "filler"})


def around_places(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms (before quantities are read) with a flag where a place is to be driven around.

    Raises:
        Unclear: where a place is spoken of that is not where to go: `along the desk`.
    """
    out = list(atoms)
    i = 0
    while i < len(out):
        at = _relation_at(out, i) if out[i].kind == "place" else -1
        if at >= 0:
            if out[at].text.split()[-1] in relation_words("passing"):
                raise Unclear("unclear_motion", f"{out[at].text} {out[i].text}")
            i = _encircle(out, at, i)
        i += 1
    return out


def _relation_at(atoms: Sequence[Atom], place: int) -> int:
    """Where the word stands that says how the motion lies to that place; -1 where none does."""
    for at in range(place - 1, -1, -1):
        if atoms[at].text.split()[-1:] and atoms[at].text.split()[-1] in relation_words(
            "around"
        ) | relation_words("passing"):
            return at
        if atoms[at].kind not in _BESIDE:
            return -1
    return -1


def _encircle(atoms: list[Atom], at: int, place: int) -> int:
    """Put `go`, the flag and how often in place of what says so around the place; where that is afterwards."""
    said = " ".join(atom.text for atom in atoms[at:place])
    begin, before = _laps_before(atoms, at)
    end, after = _laps_after(atoms, place + 1)
    verbless = begin == 0 or atoms[begin - 1].kind not in ("verb", "times", "pace", "flag")
    makes = begin > 0 and atoms[begin - 1].kind == "verb" and atoms[begin - 1].value in ("make", "turn")
    begin -= makes
    put = [Atom("verb", "go", said)] if verbless or makes else []
    put += [Atom("flag", AROUND, said), atoms[place]]
    put += [Atom("times", count, said) for count in (before or after,) if count]
    atoms[begin:end] = put
    return begin + len(put) - 1


def _laps_before(atoms: Sequence[Atom], at: int) -> tuple[int, str]:
    """`two laps of`: where that begins, and how many; the relation's own place and "" where none are told."""
    k = at - 1
    while k >= 0 and atoms[k].kind in ("glue", "filler"):
        k -= 1
    if k < 0 or not (atoms[k].value in _LAPS or (atoms[k].kind, atoms[k].value) == ("shape", "circle")):
        return at, ""
    if k and atoms[k - 1].kind == "number":
        return k - 1, atoms[k - 1].value
    return (k - 1 if k and atoms[k - 1].kind == "num" else k), ""


def _laps_after(atoms: Sequence[Atom], at: int) -> tuple[int, str]:
    """走一圈, 两圈 behind the place: where that ends, and how many."""
    k = at
    while k < len(atoms) and (atoms[k].kind == "glue" or (atoms[k].kind, atoms[k].value) in _GOES):
        k += 1
    if k + 1 < len(atoms) and atoms[k].kind == "number" and atoms[k + 1].kind == "unit_turn":
        return k + 2, atoms[k].value
    return at, ""


_GOES = (("verb", "go"), ("verb", "turn"), ("verb", "make"))


def once_around(place: Go, context: Context) -> list[Go]:
    """The way once around what stands at a place, counter-clockwise from the corner that is nearest to the robot.

    Raises:
        Unclear: where no map tells what stands there.
    """
    ring = list(context.rings(Pose(place.x_m, place.y_m))) if context.rings is not None else []
    if not ring:
        raise Unclear("around_what", place.place)
    here = context.state.pose
    first = min(range(len(ring)), key=lambda k: math.hypot(ring[k][0] - here.x_m, ring[k][1] - here.y_m))
    corners = [*ring[first:], *ring[: first + 1]]
    return [Go(round(x, 2), round(y, 2)) for x, y in corners]
