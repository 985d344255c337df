"""A motion that a text tells twice and means once: `forward 1.2, yes, 1.2 m`, “走一圈，绕完整一圈”.

The rules read each amount as a motion. Where two steps in turn are alike, and the text has only one way or verb for
both, the plan without the second is proposed.
"""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Sequence

from chatrobot.language.last_motion import atoms_said
from chatrobot.language.tokens import Atom
from chatrobot.plan.steps import Arc, Drive, Plan, Step, Turn

_COUNTS = frozenset({"times", "again", "more", "each"})
"""Values of amounts and flags that tell a motion once more."""
_TURNS = frozenset({"turn", "spin"})
_SAME_RAD = 1e-6
_ASLANT = 0.1
"""Of the sine of twice the angle between a drive and the robot's axis: with a greater one it goes aslant."""


def without_repetition(plain: str, plan: Plan) -> Plan | None:
    """The plan of a normalised text without steps that only tell once more what one beside them does; None for none."""
    steps, kept = plan.steps, [*plan.steps[:1]]
    atoms = atoms_said(plain) if any(itertools.starmap(_may_restate, itertools.pairwise(steps))) else []
    for step in steps[1:] if atoms else []:
        before = kept[-1]
        if not (_may_restate(before, step) and _tells_once(before, step, atoms)):
            kept.append(step)
        elif isinstance(before, Turn):
            kept[-1] = step
    return Plan(tuple(kept)) if atoms and len(kept) < len(steps) else None


def _may_restate(first: Step, second: Step) -> bool:
    if isinstance(first, Drive) and isinstance(second, Drive):
        return first == second
    if isinstance(first, Drive) and isinstance(second, Turn):  # `ahead to the left, 45° to the left`
        is_aslant = abs(math.sin(2.0 * first.direction_rad)) > _ASLANT
        same_side = second.left == (first.direction_rad > 0.0)
        return is_aslant and same_side and _is_angle(second, abs(first.direction_rad))
    turn, arc = (first, second) if isinstance(first, Turn) else (second, first)
    return isinstance(turn, Turn) and isinstance(arc, Arc) and _is_angle(turn, arc.angle_rad)


def _is_angle(turn: Turn, angle_rad: float) -> bool:
    return turn.angle_rad is not None and math.isclose(turn.angle_rad, angle_rad, abs_tol=_SAME_RAD)


def _tells_once(first: Step, second: Step, atoms: Sequence[Atom]) -> bool:
    """Whether a text has only one way for two drives, or neither a verb nor a side for a turn beside another motion."""
    if any(atom.value in _COUNTS for atom in atoms):
        return False
    if not (isinstance(first, Drive) and isinstance(second, Drive)):
        verbs = _TURNS | {"uturn"} if isinstance(second, Turn) else _TURNS  # `a u-turn, so a half circle`
        sides = sum(atom.kind in ("dir", "rot") for atom in atoms)
        return sides < 2 and not any(atom.kind == "verb" and atom.value in verbs for atom in atoms)
    lengths = Counter(atom.text for atom in atoms if atom.kind == "q" and atom.value == "length")
    ways = Counter(atom.value for atom in atoms if atom.kind == "dir")
    return ways[_way_of(first)] < 2 <= max(lengths.values(), default=0)


def _way_of(drive: Drive) -> str:
    if abs(math.sin(drive.direction_rad)) < math.sqrt(0.5):
        return "forward" if math.cos(drive.direction_rad) > 0.0 else "back"
    return "left" if drive.direction_rad > 0.0 else "right"
