"""Whether what was driven is what a plan says, and the verdict on items that say what must happen as plans.

The kinds are those of `judge`. A dialogue in which a turn was asked about counts as abstained where all that moved is
the plan with as many stretches of steps left out as turns were asked about; any other motion is wrong.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from chatrobot.cli.eval.corpus import Meant
from chatrobot.cli.eval.ideal import Ideal, ideal, without_last_turn
from chatrobot.cli.eval.measure import Measured
from chatrobot.plan.base import Step, expanded
from chatrobot.robots.profile import RobotProfile

POSITION_M, POSITION_SHARE, POSITION_PATH_SHARE = 0.06, 0.05, 0.02
HEADING_DEG = 5.0
TURNED_DEG, TURNED_SHARE = 5.0, 0.03
PATH_M, PATH_SHARE = 0.06, 0.06
PAUSE_S, PAUSE_SHARE = 0.6, 0.10
SPEED_SHARE = 0.12
MAX_STEPS_LEFT_OUT_OF = 60
"""Longer plans are only compared whole: the number of ways to leave something out grows with the square."""


def misfit(meant: Meant, driven: Measured, profile: RobotProfile) -> tuple[str, ...]:
    """What does not hold, for the plan that fits best; empty where one of the plans was driven."""
    found = [
        tuple(_problems(wanted, driven))
        for plan in meant.plans
        for wanted in _wanted(plan.steps, meant, profile)
    ]
    return min(found, key=len, default=("this robot can do none of the plans",))


def fits_in_part(meant: Meant, driven: Measured, gaps: int, profile: RobotProfile) -> bool:
    """Whether what was driven is one of the plans with up to `gaps` stretches of its steps left out."""
    for plan in meant.plans:
        listed = list(expanded(plan.steps))
        if len(listed) > MAX_STEPS_LEFT_OUT_OF:
            continue
        for kept in _left_out(listed, min(gaps, 2)):
            if any(not any(_problems(wanted, driven)) for wanted in _wanted(kept, meant, profile)):
                return True
    return False


def _left_out(steps: list[Step], gaps: int) -> Iterator[list[Step]]:
    """`steps` with one stretch left out, then with two: each way once."""
    seen: set[tuple[int, ...]] = set()
    stretches = list(itertools.combinations(range(len(steps) + 1), 2))
    for chosen in itertools.combinations_with_replacement(stretches, gaps if len(steps) <= 12 else 1):
        kept = tuple(i for i in range(len(steps)) if not any(a <= i < b for a, b in chosen))
        if kept not in seen:
            seen.add(kept)
            yield [steps[i] for i in kept]


def _wanted(steps: Sequence[Step], meant: Meant, profile: RobotProfile) -> Iterator[Ideal]:
    open_end = without_last_turn(steps) if meant.closed_ok else None
    for variant in (steps, open_end):
        numbers = ideal(variant, profile) if variant is not None else None
        if numbers is not None:
            yield numbers
            if meant.mirror_ok:
                yield _mirrored(numbers)


def _mirrored(numbers: Ideal) -> Ideal:
    return replace(numbers, y=-numbers.y, turned_deg=-numbers.turned_deg)


def _problems(wanted: Ideal, driven: Measured) -> Iterator[str]:
    off_m = math.hypot(driven.x - wanted.x, driven.y - wanted.y)
    far_m = math.hypot(wanted.x, wanted.y)
    if off_m > max(POSITION_M, POSITION_SHARE * far_m, POSITION_PATH_SHARE * wanted.path_m):
        yield f"it ended at ({driven.x:.2f}, {driven.y:.2f}), not ({wanted.x:.2f}, {wanted.y:.2f})"
    if (
        not wanted.free_heading
        and abs(math.remainder(driven.turned_deg - wanted.turned_deg, 360)) > HEADING_DEG
    ):
        yield f"its heading is {driven.turned_deg:.0f}°, not {wanted.turned_deg:.0f}°"
    if not wanted.routed:
        yield from _rotation_problems(wanted, driven)
    if abs(driven.path_m - wanted.path_m) > max(PATH_M, PATH_SHARE * wanted.path_m):
        yield f"its path is {driven.path_m:.2f} m, not {wanted.path_m:.2f} m"
    if abs(driven.pause_s - wanted.pause_s) > max(PAUSE_S, PAUSE_SHARE * wanted.pause_s):
        yield f"it stood for {driven.pause_s:.1f} s, not {wanted.pause_s:.1f} s"
    if wanted.max_speed is not None and _is_off(driven.max_speed, wanted.max_speed):
        yield f"its top speed is {driven.max_speed:.2f} m/s, not {wanted.max_speed:.2f} m/s"
    if wanted.max_turn_rate is not None and _is_off(driven.max_turn_rate, wanted.max_turn_rate):
        yield f"its top rate is {driven.max_turn_rate:.2f} rad/s, not {wanted.max_turn_rate:.2f} rad/s"


def _rotation_problems(wanted: Ideal, driven: Measured) -> Iterator[str]:
    slack_deg = max(TURNED_DEG, TURNED_SHARE * wanted.rotation_deg)
    if abs(driven.turned_deg - wanted.turned_deg) > slack_deg:
        yield f"it turned {driven.turned_deg:.0f}°, not {wanted.turned_deg:.0f}°"
    if abs(driven.rotation_deg - wanted.rotation_deg) > slack_deg:
        yield f"it turned {driven.rotation_deg:.0f}° to either side, not {wanted.rotation_deg:.0f}°"


def _is_off(driven: float, wanted: float) -> bool:
    return abs(driven - wanted) > SPEED_SHARE * wanted
