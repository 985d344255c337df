"""Corners for a base that steers: drive - turn - drive becomes drive - arc - drive, as people draw it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from chatrobot.core.reason import Reason
from chatrobot.plan.base import MAX_LINES, Block, Plan, Step
from chatrobot.plan.context import Finding, max_arc_speed_mps
from chatrobot.plan.primitives.drive import Drive
from chatrobot.plan.primitives.no_motion import Remember, Say, Wait
from chatrobot.plan.primitives.turn import Arc, Turn
from chatrobot.robots.profile import RobotProfile

_ALONG_RAD = 1e-9
_LEFTOVER_M = 1e-6


@dataclass(frozen=True)
class Rounded:
    """The plan to run, and what to say about it. The paths of steps in the findings are of this plan."""

    plan: Plan
    findings: tuple[Finding, ...] = ()


def round_corners(plan: Plan, profile: RobotProfile) -> Rounded:
    """Return the plan as a base that steers can drive it.

    Every turn between two straight legs becomes an arc of the minimum turning radius r, the legs shortened by
    r * tan(angle / 2), so that the lines driven stay where they were. A turn with no leg after it is left out, with a
    note. A turn that cannot be rounded stays as it is, and lowering refuses it.
    """
    if not _has_turn(plan.steps):
        return Rounded(plan)
    flat = _flattened(plan.steps)
    if len(flat) > MAX_LINES:
        reason = Reason("plan_too_large", {"steps": len(flat), "max_steps": MAX_LINES})
        return Rounded(plan, (Finding("refuse", reason),))
    return _Rounding(profile).run(plan, flat)


def _has_turn(steps: Sequence[Step]) -> bool:
    return any(_has_turn(step.steps) if isinstance(step, Block) else isinstance(step, Turn) for step in steps)


def _flattened(steps: Sequence[Step]) -> list[Step]:
    """Blocks with a turn inside are written out: their last corner meets the first leg of the next round."""
    flat: list[Step] = []
    for step in steps:
        if isinstance(step, Block) and _has_turn(step.steps):
            inner = _flattened(step.steps)
            if len(inner) * step.times > MAX_LINES:
                return inner * step.times
            flat += inner * step.times
        else:
            flat.append(step)
    return flat


class _Rounding:
    def __init__(self, profile: RobotProfile) -> None:
        self._profile = profile
        self._radius_m = profile.limits.min_turning_radius_m

    def run(self, plan: Plan, flat: list[Step]) -> Rounded:
        steps: list[Step] = []
        corners = 0
        notes: list[Finding] = []
        position = 0
        while position < len(flat):
            step = flat[position]
            if not isinstance(step, Turn):
                steps.append(step)
                position += 1
                continue
            turns, position = _run_of_turns(flat, position)
            is_last = not any(_moves(later) for later in flat[position:])
            if is_last and any(_moves(earlier) for earlier in steps):
                angle = sum(self._signed_angle(turn) for turn in turns)
                notes.append(
                    Finding("note", Reason("turn_left_out", {"angle_rad": angle}), (len(steps) - 1,))
                )
            elif self._round(steps, turns, flat, position):
                corners += 1
            else:
                steps += turns
        if corners:
            notes.insert(
                0,
                Finding("note", Reason("corners_rounded", {"corners": corners, "radius_m": self._radius_m})),
            )
        return Rounded(Plan(tuple(steps)) if notes else plan, tuple(notes))

    def _round(self, steps: list[Step], turns: list[Turn], flat: list[Step], position: int) -> bool:
        """Replace the corner between the last of `steps` and `flat[position]`; False leaves both as they were."""
        before = steps[-1] if steps else None
        after = flat[position] if position < len(flat) else None
        if not (isinstance(before, Drive) and isinstance(after, Drive)):
            return False
        before_m, after_m = self._length_m(before), self._length_m(after)
        if before_m is None or after_m is None or self._is_backward(before) != self._is_backward(after):
            return False
        angle = sum(self._signed_angle(turn) for turn in turns)
        if abs(angle) >= math.pi:
            return False
        if abs(angle) < _ALONG_RAD:
            return True  # left and right again: no corner at all
        cut_m = self._radius_m * math.tan(abs(angle) / 2.0)
        if cut_m >= before_m - _LEFTOVER_M or cut_m >= after_m - _LEFTOVER_M:
            return False
        steps[-1] = replace(before, distance_m=round(before_m - cut_m, 9), duration_s=None)
        backward = self._is_backward(before)
        steps.append(
            Arc(self._radius_m, abs(angle), (angle > 0.0) != backward, backward, self._arc_speed(before))
        )
        flat[position] = replace(after, distance_m=round(after_m - cut_m, 9), duration_s=None)
        return True

    def _signed_angle(self, turn: Turn) -> float:
        rate = turn.rate_radps or self._profile.defaults.rate_radps
        angle = turn.angle_rad if turn.angle_rad is not None else rate * (turn.duration_s or 0.0)
        return angle if turn.left else -angle

    def _length_m(self, drive: Drive) -> float | None:
        """None where the leg cannot be shortened: nobody knows its end, or it does not go along the wheels."""
        if drive.until is not None or abs(math.sin(drive.direction_rad)) > _ALONG_RAD:
            return None
        if drive.distance_m is not None:
            return drive.distance_m
        length_m = (drive.speed_mps or self._profile.defaults.speed_mps) * (drive.duration_s or 0.0)
        return length_m if math.isfinite(length_m) else None

    @staticmethod
    def _is_backward(drive: Drive) -> bool:
        return math.cos(drive.direction_rad) < 0.0

    def _arc_speed(self, leg: Drive) -> float | None:
        """As the leg before it, but no faster than the turning rate allows on this radius."""
        if leg.speed_mps is None:
            return None
        return min(leg.speed_mps, max_arc_speed_mps(self._profile.limits, self._radius_m))


def _moves(step: Step) -> bool:
    if isinstance(step, Block):
        return any(_moves(inner) for inner in step.steps)
    return not isinstance(step, (Remember, Say, Wait))


def _run_of_turns(flat: list[Step], position: int) -> tuple[list[Turn], int]:
    """The turns that follow one another from `position`, and where they end."""
    turns: list[Turn] = []
    while position < len(flat) and isinstance(step := flat[position], Turn):
        turns.append(step)
        position += 1
    return turns, position
