"""`Put a box 1 m in front of you`, `remove all boxes`: a simulation is changed. It moves nothing."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from functools import cache

from chatrobot.core.geometry import Pose
from chatrobot.language.context import Context
from chatrobot.language.data_files import load_table
from chatrobot.language.interpretation import Interpretation, LanguageCode, Placement
from chatrobot.language.lexicon import lexicon
from chatrobot.language.numbers import read_number
from chatrobot.language.phrases import say
from chatrobot.language.quantities import read_quantities
from chatrobot.language.rules import Form, forms_of
from chatrobot.language.tokens import tokenise
from chatrobot.language.unclear import Unclear

_SIDES_RAD = {"ahead": 0.0, "left": math.pi / 2.0, "behind": math.pi, "right": -math.pi / 2.0}
AWAY_M = 1.0
"""How far off it is put where nobody says how far, from the middle of the robot."""


@cache
def _patterns(language: str, name: str) -> tuple[Form, ...]:
    def sources() -> list[str]:
        table = load_table(language, "putting")
        things = f"(?P<thing>{'|'.join(table['things'])})"
        said = [frame.replace("WHICH", which) for frame in table[name] for which in table["which"]]
        return [pattern.replace("THING", things) for pattern in dict.fromkeys(said)]

    return forms_of(f"putting_{language}_{name}", sources)


def read_putting(plain: str, language: LanguageCode, context: Context) -> Interpretation | None:
    """What a normalised text puts into the simulation or takes out of it; None for any other text.

    Raises:
        Unclear: where how far off it is to stand is not understood.
    """
    said = plain.strip(" .!?。,")
    for kind in ("put", "remove"):
        found = next(filter(None, (pattern.fullmatch(said) for pattern in _patterns(language, kind))), None)
        if found is None:
            continue
        if kind == "put":
            at_m = _where(found.groupdict(), language, context)
            return _changing("putting", [Placement(found["thing"], at_m)], language)
        names = _taken_away(found.groupdict(), language, context)
        return _changing("removing", [Placement(name) for name in names], language)
    return None


def _changing(code: str, obstacles: list[Placement], language: LanguageCode) -> Interpretation:
    names = say(language, "join").join(one.name for one in obstacles)
    reply = say(language, code, name=names) if obstacles else say(language, "no_obstacle_put")
    return Interpretation("answered", reply, language, obstacles=tuple(obstacles))


def _taken_away(said: Mapping[str, str | None], language: str, context: Context) -> list[str]:
    """The names of what is to be taken away; as it was said, where nothing like it was put there."""
    thing, number = said["thing"] or "", _count(said.get("number") or "")
    is_any = thing in load_table(language, "putting")["any"]
    added = {
        one.names[0]: ["".join(key) for key in one.keys(language)] for one in context.things if one.is_added
    }
    if said.get("all"):
        of_kind = re.compile(rf"{re.escape(thing)}\d*")
        found = [name for name, keys in added.items() if is_any or any(map(of_kind.fullmatch, keys))]
        return found or [thing][: len(added)]
    found = [name for name, keys in added.items() if f"{thing}{number}" in keys]
    if not found and is_any:
        found = [name for name in added if re.search(rf"(?<!\d){number}$", name)]
    return found if len(found) == 1 else [f"{thing} {number}".strip()]


def _count(text: str) -> str:
    """The digits of a number; what else it is, as it is."""
    number = read_number(tokenise(text, lexicon(), {}), 0) if text else None
    return f"{number.value:g}" if number is not None else text


def _where(said: Mapping[str, str | None], language: str, context: Context) -> tuple[float, float]:
    """Where it is to stand, metres, in the odom frame."""
    sides = load_table(language, "putting")["sides"]
    side = next(
        (name for name, words in sides.items() if re.fullmatch(words, said.get("side") or "")), "ahead"
    )
    far_m, angle_rad = _length_m(said.get("far") or said.get("far2") or ""), _SIDES_RAD[side]
    at = context.state.pose.compose(Pose(far_m * math.cos(angle_rad), far_m * math.sin(angle_rad)))
    return round(at.x_m, 3), round(at.y_m, 3)


def _length_m(text: str) -> float:
    if not text.strip():
        return AWAY_M
    lengths = [
        atom.number for atom in read_quantities(tokenise(text, lexicon(), {})) if atom.value == "length"
    ]
    if len(lengths) != 1:
        raise Unclear("how_far", text.strip())
    return lengths[0]
