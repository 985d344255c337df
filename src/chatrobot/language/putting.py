"""`Put a box 1 m in front of you`: something is put into a simulation, or taken away. It moves nothing."""

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
        return [pattern.replace("THING", things) for pattern in table[name]]

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
        name = found["thing"]
        if kind == "remove":
            return _changing("removing", Placement(name), language)
        return _changing("putting", Placement(name, _where(found.groupdict(), language, context)), language)
    return None


def _changing(code: str, obstacle: Placement, language: LanguageCode) -> Interpretation:
    return Interpretation("answered", say(language, code, name=obstacle.name), language, obstacle=obstacle)


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
