"""Units in atoms: what is measured, and how much one of it is in SI units."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

from chatrobot.language.data_files import LANGUAGES, load_table
from chatrobot.language.tokens import Atom

DIMENSIONS = {
    "unit_length": "length", "unit_angle": "angle", "unit_time": "time", "unit_speed": "speed",
    "unit_rate": "rate", "unit_turn": "turns", "unit_percent": "percent", "unit_times": "times",
    "unit_clock": "clock", "unit_fold": "fold", "unit_faster": "faster", "unit_scale": "scale", "counter": "count",
}  # fmt: skip


@lru_cache(maxsize=1)
def turn_nouns() -> frozenset[str]:
    """The nouns that count whole turns on the spot."""
    return frozenset(w for lang in LANGUAGES for w in load_table(lang, "turn_nouns").get("words", ()))


def unit_at(atoms: Sequence[Atom], i: int) -> tuple[str, float, str] | None:
    """Dimension, factor and noun of the unit at `i`."""
    if not 0 <= i < len(atoms):
        return None
    atom = atoms[i]
    if atom.kind == "second":
        return "time", 1.0, ""
    if atom.text in turn_nouns():
        return "turns", 2.0 * math.pi, ""
    if atom.text == "in" and (i + 1 == len(atoms) or atoms[i + 1].kind in ("sep", "dir", "conn")):
        return "length", 0.0254, ""
    dimension = DIMENSIONS.get(atom.kind)
    if dimension is None:
        return None
    if dimension == "count":
        return dimension, 1.0, atom.value
    factor = float(atom.value)
    return dimension, factor * 2.0 * math.pi if dimension == "turns" else factor, ""
