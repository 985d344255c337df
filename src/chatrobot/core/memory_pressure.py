"""Who goes when memory runs out: Motion offers itself before the guard, which has to be there last."""

from __future__ import annotations

import contextlib

GUARD = (-900, 0)
"""What the guard would like (only root may), and what anybody may go back to."""

MOTION = 200
"""It goes before the rest: the guard then halts the robot. Anybody may raise a score, so this works without root."""

_FILE = "/proc/self/oom_score_adj"


def prefer(*scores: int) -> int | None:
    """Set the first of `scores` that the kernel lets us have; which, or None. Higher goes first (proc(5))."""
    for score in scores:
        with contextlib.suppress(OSError):
            with open(_FILE, "w", encoding="ascii") as file:
                file.write(str(score))
            return score
    return None
