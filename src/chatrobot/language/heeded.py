"""Nothing said may be passed over in silence: what changes nothing when it is changed was not understood.

Where the rules lose an amount or a direction on the way (a slot that nobody reads, two clauses merged into one), the
plan looks fine and is not what was said. So every amount is changed a little, every direction turned round, and the
rules are asked again: the plan must change.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from chatrobot.language.tokens import Atom, quantity
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Step

_CHANGE = 1.07
"""Small enough that no limit or sign turns over, and nothing that is rounded hides it."""

_AMOUNTS = frozenset({"length", "time", "speed", "rate", "radius", "percent", "fold", "faster", "scale"})
"""Changed wherever they are said. Counts and angles are changed where nothing is drawn: a shape tells them twice, as in
`a triangle with three sides`."""

_OTHER_SIDE = {"left": "right", "right": "left"}

_OPPOSITE = {
    "left": "right", "right": "left", "forward": "back", "back": "forward",
    "forward_left": "back_right", "back_right": "forward_left",
    "forward_right": "back_left", "back_left": "forward_right",
}  # fmt: skip

_TAKEN_BACK = frozenset({"correction", "condition", "negation"})
"""Words after which what was said before may rightly count for nothing."""


def check_heeded(
    atoms: Sequence[Atom], steps: Sequence[Step], read: Callable[[list[Atom]], Sequence[Step]]
) -> None:
    """Ask back where an amount, a count or a direction in `atoms` plays no part in `steps`, which `read` made of them.

    Raises:
        Unclear: naming it.
    """
    if any(atom.kind in _TAKEN_BACK or (atom.kind, atom.value) == ("flag", "instead") for atom in atoms):
        return
    for i, atom in enumerate(atoms):
        changed = _changed(atom, atoms)
        adverb = atom.text.endswith("straight") and i + 1 < len(atoms) and atoms[i + 1].kind == "dir"
        if changed is None or adverb:
            continue
        try:
            other = read([*atoms[:i], changed, *atoms[i + 1 :]])
        except Unclear:
            continue  # it matters
        if list(other) == list(steps):
            raise Unclear("unclear_motion", atom.text)


def _changed(atom: Atom, atoms: Sequence[Atom]) -> Atom | None:
    """`atom` as it would have been had something else been said; None where it may be said for nothing."""
    if atom.kind == "q" and atom.value in _AMOUNTS:
        return quantity(atom.value, atom.number * _CHANGE, atom.text, atom.role)
    drawn = any(other.kind in ("shape", "role") for other in atoms)  # a shape may name a side for looks
    if not drawn and (counted := _counted_otherwise(atom, atoms)) is not None:
        return counted
    if not drawn and atom.kind == "rot" and atom.value in _OTHER_SIDE:
        return atom._replace(value=_OTHER_SIDE[atom.value])
    if atom.kind != "dir" or atom.value not in _OPPOSITE or atom.text.endswith("of you"):
        return None
    twice = sum(other.kind == "dir" and other.value == atom.value for other in atoms) > 1
    return None if drawn or twice else atom._replace(value=_OPPOSITE[atom.value])


def _counted_otherwise(atom: Atom, atoms: Sequence[Atom]) -> Atom | None:
    """A count or an angle changed; `the third turn` and the half turn of a U-turn only tell it again."""
    if atom.kind != "q" or any((other.kind, other.value) == ("verb", "uturn") for other in atoms):
        return None
    if atom.value in ("times", "count") and atom.role != "move":  # 走两下: a little
        return quantity(atom.value, atom.number + 1.0, atom.text, atom.role)
    if atom.value in ("angle", "turns") and not atom.text.startswith(("third", "second", "first", "fourth")):
        return quantity(atom.value, atom.number * _CHANGE, atom.text, atom.role)
    if atom.value == "number" and atom.number > 2:
        return quantity(atom.value, atom.number + 15.0, atom.text, atom.role)
    return None
