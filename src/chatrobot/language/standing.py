"""`In front of the fridge`, `halfway to the sofa`, 桌子和沙发之间: a point that lies to a place, and is not the place.

A named place is where a robot stands there, so that `near` it and `in front of` it are the place itself. Behind it is
beyond what the map has there, at the distance that a way around it keeps.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cache

from chatrobot.core.geometry import Pose
from chatrobot.language.context import Context
from chatrobot.language.data_files import LANGUAGES
from chatrobot.language.leading import pose_after
from chatrobot.language.numbers import is_chinese
from chatrobot.language.rules import Form, form
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear
from chatrobot.plan.base import rounded_angle
from chatrobot.plan.ring import RING_MARGIN_M, middle_of, point_beside
from chatrobot.plan.steps import Face, Go, Step

_MARK = "\t"
"""Parts the relation, its amount and the names in the value of an atom: no name has it."""
_LEAST_M = 0.1
"""Of a place that is nearer nobody can tell on which side it is."""
_WIDEST = 7
"""So many atoms say where a point lies to a place."""
_BEFORE = ("near", "front", "behind", "halfway", "towards")
_GOES = {"go": "go", "return": "return", "shift": "go", "make": "go", "halt": "go", "wait": "go"}
_FAR_SIDE_RAD = math.radians(60.0)
"""Behind a thing is its far side from where robots stand at it, and from here: so far those may differ."""


def by_places(atoms: Sequence[Atom]) -> list[Atom]:
    """The atoms with one place where a relation to a place, or to two, is told; nothing is changed elsewhere.

    Raises:
        Unclear: where another one than the place of that name is spoken of: `the second door`.
    """
    out = list(atoms)
    i = 0
    while i < len(out):
        if out[i].kind == "place" and _MARK not in out[i].value:
            i = _related(out, i)
        i += 1
    return out


def _related(atoms: list[Atom], i: int) -> int:
    """Put what lies to the place at `i` in its place; where that is afterwards."""
    _check_the_one(atoms, i)
    if _turned_to(atoms, i) or _headed_to(atoms, i):
        return i + 1
    start, relation, end, names = _relation(atoms, i)
    if not relation:
        return i
    at = start - 1
    while at >= 0 and atoms[at].kind in ("glue", "filler"):
        at -= 1
    off = atoms[at] if at >= 0 and atoms[at].kind == "q" and atoms[at].value == "length" else None
    if (relation == "towards" and off is None) or (off and relation in ("halfway", "between")):
        return i
    verb = at - (off is not None)
    while verb >= 0 and atoms[verb].kind in ("glue", "filler"):
        verb -= 1
    goes = verb >= 0 and atoms[verb].kind == "verb" and atoms[verb].value in _GOES
    begins = verb < 0 or atoms[verb].kind in ("sep", "conn")
    told = relation not in ("near", "front") or any(atom.kind == "verb" for atom in atoms[start:end])
    if (not goes and not (begins and told)) or (goes and _is("stays", [atoms[verb]])):
        return i
    said = " ".join(atom.text for atom in atoms[verb + 1 : end])
    value = _MARK.join((relation, f"{off.number:g}" if off else "", *names))
    put = [Atom("verb", _GOES[atoms[verb].value] if goes else "go", atoms[verb].text if goes else said)]
    begin = verb if goes else verb + 1
    plain = off is None and relation in ("near", "front")
    atoms[begin:end] = [*put, Atom("place", names[0] if plain else value, said)]
    return begin + 1


def _turned_to(atoms: list[Atom], i: int) -> bool:
    """`Turn towards the sofa` is to face it: put so. Whether it stands there."""
    start, before = _before(atoms, i, ("facing",))
    end, _ = _after(atoms, i + 1, ("facing_after",))
    said = [*atoms[start:i], *atoms[i + 1 : end]] if before else []
    verbs = [(atom.kind, atom.value) for atom in said if atom.kind == "verb"]
    if verbs != [("verb", "turn")]:
        return False
    atoms[start:end] = [Atom("verb", "face", " ".join(atom.text for atom in said)), atoms[i]]
    return True


def _headed_to(atoms: list[Atom], i: int) -> bool:
    """朝电视走三十厘米: put as where the verb stands before the place. Whether it stands there."""
    start, found = _before(atoms, i, ("heading",))
    end = i + 1
    while found and end < len(atoms) and atoms[end].kind != "q" and atoms[end].kind in _BESIDE_PLACE:
        end += 1
    said = atoms[i + 1 : end]
    far = atoms[end] if end < len(atoms) and (atoms[end].kind, atoms[end].value) == ("q", "length") else None
    goes = any(atom.kind == "pace" or _GOES.get(atom.value) == "go" for atom in said)
    if far is None or not goes or any(atom.kind == "dir" and atom.value != "forward" for atom in said):
        return False
    text = " ".join(atom.text for atom in atoms[start : end + 1])
    kept = [atom for atom in said if atom.kind == "pace"]
    place = Atom("place", _MARK.join(("towards", f"{far.number:g}", atoms[i].value)), text)
    atoms[start : end + 1] = [Atom("verb", "go", text), place, *kept]
    return True


_BESIDE_PLACE = frozenset({"glue", "flag", "verb", "dir", "pace", "filler"})


def _relation(atoms: Sequence[Atom], i: int) -> tuple[int, str, int, tuple[str, ...]]:
    """Where it begins, which it is, where it ends, and the names in it; none for a place that is meant itself."""
    name = atoms[i].value
    second = next((k for k in range(i + 1, min(i + 4, len(atoms))) if atoms[k].kind == "place"), None)
    if second is not None and _is("middle", atoms[i + 1 : second]):
        names, after = (name, atoms[second].value), _after(atoms, second + 1, ("between_after",))
        before = _before(atoms, i, ("between",))
        if before[1] or after[1]:
            return before[0], "between", after[0], names
        return i, "", i + 1, ()
    start, found = _before(atoms, i, _BEFORE)
    if found:
        return start, found, i + 1, (name,)
    end, found = _after(atoms, i + 1, _BEFORE)
    return i, found, end, (name,)


def _before(atoms: Sequence[Atom], i: int, kinds: Sequence[str]) -> tuple[int, str]:
    spans = [(start, atoms[start:i]) for start in range(max(0, i - _WIDEST), i)]
    return next(((start, kind) for start, said in spans for kind in kinds if _is(kind, said)), (i, ""))


def _after(atoms: Sequence[Atom], i: int, kinds: Sequence[str]) -> tuple[int, str]:
    spans = [(end, atoms[i:end]) for end in range(min(len(atoms), i + _WIDEST), i, -1)]
    return next(((end, kind) for end, said in spans for kind in kinds if _is(kind, said)), (i, ""))


def _is(kind: str, atoms: Sequence[Atom]) -> bool:
    if not atoms or any(atom.kind in ("sep", "place") for atom in atoms):
        return False
    said = ("" if is_chinese(atoms[0].text) else " ").join(atom.text for atom in atoms)
    return any(pattern.fullmatch(said) for pattern in _patterns(kind))


@cache
def _patterns(kind: str) -> list[Form]:
    return [form(code, "standing", kind) for code in LANGUAGES]


def _check_the_one(atoms: Sequence[Atom], i: int) -> None:
    """There is one place of a name, and no `second door`.

    Raises:
        Unclear: naming the place that is not known.
    """
    if _before(atoms, i, ("other",))[1]:
        raise Unclear("which_place", atoms[i].text)


def lies_on_the_way(said: str) -> bool:
    """Whether the value of such an atom is a point of the way there, which begins where the robot is."""
    return said.split(_MARK)[0] in ("halfway", "towards")


def stood(said: str, places: Mapping[str, Go], context: Context) -> Go | None:
    """The point that the value of such an atom means; None where it is no such value.

    Raises:
        Unclear: where no way leads there, or the map does not tell where it is.
    """
    relation, *rest = said.split(_MARK)
    if not rest:
        return None
    off_m, names = float(rest[0] or 0.0), rest[1:]
    there = [places[name] for name in names if name in places]
    if len(there) < len(names):
        raise Unclear("place_unusable", names[-1])
    here = context.state.pose
    if relation == "between":
        (ax, ay), (bx, by) = ((go.x_m, go.y_m) for go in there)
        return _to((ax + bx) / 2.0, (ay + by) / 2.0)
    goal = Pose(there[0].x_m, there[0].y_m)
    if lies_on_the_way(said):
        return _on_the_way(here, goal, off_m, names[0], context)
    ring = list(context.rings(goal)) if context.rings is not None else []
    if not ring:
        raise Unclear("around_what", names[0])
    extra_m = off_m - RING_MARGIN_M if off_m else 0.0
    if relation != "behind":
        return _to(*point_beside(ring, (goal.x_m, goal.y_m), extra_m))
    (mx, my) = middle_of(ring)
    backs = [(2.0 * mx - x, 2.0 * my - y) for x, y in ((goal.x_m, goal.y_m), (here.x_m, here.y_m))]
    bearings = [math.atan2(y - my, x - mx) for x, y in backs]
    if abs(math.remainder(bearings[0] - bearings[1], 2.0 * math.pi)) > _FAR_SIDE_RAD:
        raise Unclear("behind_what", names[0])  # beyond it from here, or at its back?
    return _to(*point_beside(ring, backs[0], extra_m))


def _on_the_way(here: Pose, goal: Pose, off_m: float, name: str, context: Context) -> Go:
    straight_m = math.dist((here.x_m, here.y_m), (goal.x_m, goal.y_m))
    way_m = context.way_m(goal) if context.has_ways else straight_m
    share = 0.5 if not off_m else off_m / way_m if way_m else math.inf
    if way_m is None or share > 1.0:
        raise Unclear("no_way_so_far", name)
    if context.along is None:
        return _to(here.x_m + share * (goal.x_m - here.x_m), here.y_m + share * (goal.y_m - here.y_m))
    point = context.along(here, goal, share)
    if point is None:
        raise Unclear("no_way_so_far", name)
    return _to(*point)


def _to(x_m: float, y_m: float) -> Go:
    return Go(round(x_m, 2), round(y_m, 2))


def facing(place: Go, before: Sequence[Step], context: Context) -> Face:
    """The heading (odom frame) to what the map has at `place`, else to the place, after the steps `before`.

    Raises:
        Unclear: where nobody knows where the robot stands by then, or it stands at the place.
    """
    here = pose_after(before, context.state.pose)
    if here is None:
        raise Unclear("unclear_motion", place.place)
    ring = list(context.rings(Pose(place.x_m, place.y_m))) if context.rings is not None else []
    x_m, y_m = middle_of(ring) if ring else (place.x_m, place.y_m)
    if math.dist((here.x_m, here.y_m), (x_m, y_m)) < _LEAST_M:
        raise Unclear("unclear_motion", place.place)
    return Face(rounded_angle(math.atan2(y_m - here.y_m, x_m - here.x_m), 2), "odom")
