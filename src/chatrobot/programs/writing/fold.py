"""Steps that are said several times in a row become a loop, as a person would write them."""

from __future__ import annotations

from collections.abc import Sequence

from chatrobot.plan.steps import Block, Go, Repeat, Step


def folded(steps: Sequence[Step]) -> tuple[Step, ...]:
    """The same steps with loops for what repeats. Ways to places are left alone: each begins somewhere else."""
    found: list[Step] = []
    at = 0
    while at < len(steps):
        length, count = _repeats(steps, at)
        block = tuple(steps[at : at + length])
        found.append(Repeat(count, block) if count > 1 else block[0])
        at += length * count
    return tuple(found)


def _repeats(steps: Sequence[Step], at: int) -> tuple[int, int]:
    """Length and count of the block that covers most from there on; (1, 1) where nothing repeats."""
    best = (1, 1)
    for length in range(1, (len(steps) - at) // 2 + 1):
        block = steps[at : at + length]
        if any(isinstance(step, (Go, Block)) for step in block):
            break
        count = 1
        while steps[at + length * count : at + length * (count + 1)] == block:
            count += 1
        if count > 1 and length * count > best[0] * best[1]:
            best = (length, count)
    return best
