"""What the lidar sees on one side of the robot, or around it, in words."""

from __future__ import annotations

from chatrobot.core.reason import fixed
from chatrobot.language.context import Context
from chatrobot.language.phrases import say

SECTORS = ("ahead", "ahead_left", "left", "behind_left", "behind", "behind_right", "right", "ahead_right")
"""Of 45 degrees each, from straight ahead counter-clockwise."""
_SEEN_ON = {"ahead": (0,), "left": (1, 2, 3), "behind": (4,), "right": (5, 6, 7)}


def what_is_seen(side: str, language: str, context: Context) -> str:
    """`The nearest thing to my left is 0.82 m away.`; of all four sides where `side` is empty."""
    seen_m = context.state.sectors_m
    if len(seen_m) != len(SECTORS):
        return say(language, "sight_blind")
    nearest = {
        name: min((free_m for free_m in map(seen_m.__getitem__, sectors) if free_m is not None), default=None)
        for name, sectors in _SEEN_ON.items()
    }
    if not side:
        told = [
            say(language, "sight_each", side=say(language, f"sector_{name}"), distance_m=fixed(free_m, 2))
            for name, free_m in nearest.items()
            if free_m is not None
        ]
        return (
            say(language, "sight_all", text=say(language, "join").join(told))
            if told
            else _free("ahead", language)
        )
    free_m = nearest[side]
    if free_m is None:
        return _free(side, language)
    return say(language, "sight_near", side=say(language, f"sector_{side}"), distance_m=fixed(free_m, 2))


def _free(side: str, language: str) -> str:
    return say(language, "sight_free", side=say(language, f"sector_{side}"))
