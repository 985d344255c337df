"""`You're facing north. Face east, drive 1 m`: compass words where the person says which way the robot looks.

Each is turned into the turn to it from the heading before. Without that statement, or beside other turns, nothing is
rewritten, and the compass word is asked about.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Any

from chatrobot.language.data_files import load_table


@cache
def _table(language: str) -> tuple[dict[str, float], dict[str, re.Pattern[str]]]:
    table: dict[str, Any] = load_table(language, "facing")
    points = {str(k): float(v) for k, v in table.get("points", {}).items()}
    listed = "|".join(sorted(map(re.escape, points), key=len, reverse=True))
    patterns = {
        k: re.compile(p.replace("POINT", f"(?:{listed})")) for k, p in table.get("patterns", {}).items()
    }
    return points, patterns


def without_compass(text: str, language: str) -> str:
    """`text` (normalised) with turns by degrees in the place of compass points."""
    points, patterns = _table(language)
    stated = patterns["stated"].search(text) if patterns else None
    if stated is None:
        return text
    rest = f"{text[: stated.start()]} {text[stated.end() :]}"
    if not any(point in rest for point in points):
        return rest
    if patterns["other_turns"].search(rest):
        return text
    heading = points[next(v for v in stated.groupdict().values() if v)]

    def turned(found: re.Match[str]) -> str:
        nonlocal heading
        off = (points[found["point"]] - heading + 180.0) % 360.0 - 180.0
        heading = points[found["point"]]
        return f"turn {'left' if off < 0 else 'right'} {abs(off):g} degrees" if off else ""

    return patterns["to"].sub(turned, rest)
