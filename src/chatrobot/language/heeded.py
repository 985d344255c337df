"""Nothing said may be passed over in silence: an amount that changes nothing when it is changed was not understood.

Where the rules lose an amount on the way (a slot that nobody reads, two clauses merged into one), the plan looks
fine and is not what was said. So every amount is changed a little and the rules are asked again: the plan must change.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from chatrobot.language.quantities import quantity
from chatrobot.language.tokens import Atom
from chatrobot.language.unclear import Unclear
from chatrobot.plan.steps import Step

_CHANGE = 1.07
"""Small enough that no limit or sign turns over, and nothing that is rounded hides it."""

_AMOUNTS = frozenset({"length", "time", "speed", "rate", "radius", "percent", "fold", "faster", "scale"})
"""Counts, angles and numbers are told twice too often: `a triangle with three sides`, `turn round by 180`."""

_TAKEN_BACK = frozenset({"correction", "condition", "negation"})
"""Words after which an amount may rightly count for nothing."""


def check_heeded(
    atoms: Sequence[Atom], steps: Sequence[Step], read: Callable[[Sequence[Atom]], Sequence[Step]]
) -> None:
    """Ask back where an amount in `atoms` plays no part in `steps`, which `read` made of them.

    Raises:
        Unclear: naming the amount.
    """
    if any(atom.kind in _TAKEN_BACK for atom in atoms):
        return
    for i, atom in enumerate(atoms):
        if atom.kind != "q" or atom.value not in _AMOUNTS:
            continue
        changed = quantity(atom.value, atom.number * _CHANGE, atom.text, atom.role)
        try:
            other = read([*atoms[:i], changed, *atoms[i + 1 :]])
        except Unclear:
            continue  # it matters
        if list(other) == list(steps):
            raise Unclear("unclear_motion", atom.text)
