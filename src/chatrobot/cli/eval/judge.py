"""Judges what became of an utterance: correct, wrong or abstained. Pure: true poses and outcomes in, a verdict out.

* correct: everything that is expected holds, as measured, and no turn that counts ended as `failed`.
* abstained: the robot asked back or declined (`unclear`, `refused`) where that was not expected, and did not move.
* wrong: everything else. It moved otherwise than meant or when it must not, said it was done without having moved,
  or answered in a way that misleads (answered where it had to ask back or refuse, acted where it had to answer).

Only the state after the last turn counts, measured from the start of the dialogue; a turn with an `expect` of its
own is judged when it ends. `motion: none` and `answer` speak of their own turn alone. Where an item says as plans what
must happen, a dialogue in which a turn was asked about counts as abstained if all that moved is the plan with as many
stretches of steps left out as turns were asked about; any other motion is wrong.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from chatrobot.cli.eval.corpus import Expect, Item, Meant
from chatrobot.cli.eval.measure import Ideal, ideal, without_last_turn
from chatrobot.core.events import Outcome
from chatrobot.plan.base import Step, expanded
from chatrobot.robots.profile import RobotProfile
from chatrobot.sim.trace import Measured, Sample, has_moved, measure

Kind = Literal["correct", "wrong", "abstained"]

POSITION_M, HEADING_DEG, CLOSED_M, PAUSE_S = 0.05, 4.0, 0.1, 0.5
_ROUNDING = 1e-9

_OUTCOMES: Mapping[str, Outcome] = {"clarify": "unclear", "refuse": "refused", "info": "answered"}
_DECLINED = ("unclear", "refused")


@dataclass(frozen=True)
class Record:
    """One turn as it went: its outcome and the true poses until it ended, in the frame of the dialogue's start."""

    outcome: Outcome
    reply: str
    trace: Sequence[Sample]


@dataclass(frozen=True)
class Verdict:
    """`reasons` say what did not hold."""

    kind: Kind
    reasons: tuple[str, ...] = ()


def judge(item: Item, records: Sequence[Record], profile: RobotProfile | None = None) -> Verdict:
    """Judge one item; `records` has one entry a turn. A plan is what it is on the robot of `profile`."""
    verdict = _meant_verdict(item.meant, records, profile) if item.meant else _expected_verdict(item, records)
    # To ask back is as good only of one who has not done something else before.
    return Verdict("correct") if item.ask_ok and verdict.kind == "abstained" else verdict


def _meant_verdict(meant: Meant, records: Sequence[Record], profile: RobotProfile | None) -> Verdict:
    trace = [sample for record in records for sample in record.trace]
    failed = tuple(f"failed: {record.reply}" for record in records if record.outcome == "failed")
    if meant.still:
        return Verdict("wrong", ("it moved, and must not",)) if has_moved(trace) else Verdict("correct")
    if profile is None:
        raise ValueError("plans are judged on a robot")
    driven = measure(trace)
    problems = (*misfit(meant, driven, profile), *failed)
    if not problems:
        return Verdict("correct")
    asked = [record for record in records if record.outcome in _DECLINED and not has_moved(record.trace)]
    if asked and not failed and fits_in_part(meant, driven, len(asked), profile):
        return Verdict("abstained", tuple(f"{record.outcome}: {record.reply}" for record in asked))
    if not driven.has_moved:
        problems += (f"it did not move; {records[-1].outcome}: {records[-1].reply}",)
    return Verdict("wrong", problems)


def _expected_verdict(item: Item, records: Sequence[Record]) -> Verdict:
    trace: list[Sample] = []
    verdicts: list[Verdict] = []
    for number, (turn, record) in enumerate(zip(item.turns, records), 1):
        trace.extend(record.trace)
        expectations = [turn.expect, item.expect if number == len(item.turns) else None]
        verdicts += [
            judge_turn(expect, record, measure(trace)) for expect in expectations if expect is not None
        ]
    for kind in ("wrong", "abstained"):
        matching = [verdict for verdict in verdicts if verdict.kind == kind]
        if matching:
            return Verdict(kind, tuple(reason for verdict in matching for reason in verdict.reasons))
    return Verdict("correct")


def judge_turn(expect: Expect, record: Record, so_far: Measured) -> Verdict:
    """Judge one turn. `so_far` is measured from the start of the dialogue to the end of this turn."""
    moved = has_moved(record.trace)
    if not moved and record.outcome in _DECLINED and record.outcome != _OUTCOMES.get(expect.answer or ""):
        return Verdict("abstained", (f"{record.outcome}: {record.reply}",))
    problems = [*_motion_problems(expect, so_far), *_answer_problems(expect, record, moved)]
    if problems and not moved:
        problems.append(f"it did not move; {record.outcome}: {record.reply}")
    return Verdict("wrong", tuple(problems)) if problems else Verdict("correct")


def _answer_problems(expect: Expect, record: Record, moved: bool) -> Iterator[str]:
    if expect.no_motion and moved:
        yield "it moved, and must not"
    if expect.answer is not None and record.outcome != _OUTCOMES[expect.answer]:
        yield f"{record.outcome} where {_OUTCOMES[expect.answer]} was meant"
    if record.outcome == "failed":
        yield f"failed: {record.reply}"


def _motion_problems(expect: Expect, measured: Measured) -> Iterator[str]:
    for key, wanted in expect.numbers.items():
        actual = measured.farthest_m if key == "stays_within_m" else getattr(measured, key)
        if not _holds(key, wanted, actual):
            yield f"{key} is {actual:.3f}, not {wanted:g}"
    for axis, sign in expect.sign.items():
        actual = measured.turned_deg if axis == "yaw" else getattr(measured, axis)
        slack = HEADING_DEG if axis == "yaw" else POSITION_M
        if sign != ("0" if abs(actual) <= slack else "+" if actual > 0.0 else "-"):
            yield f"{axis} is {actual:.3f}, not {sign}"
    if expect.closed and measured.distance_m > CLOSED_M + _ROUNDING:
        yield f"it ended {measured.distance_m:.3f} m from where it began"


def _holds(key: str, wanted_value: float, actual_value: float) -> bool:
    if key == "stays_within_m":
        return actual_value <= wanted_value + _ROUNDING
    if key == "yaw_deg":
        return abs(math.remainder(actual_value - wanted_value, 360.0)) <= HEADING_DEG + _ROUNDING
    return abs(actual_value - wanted_value) <= _tolerance(key, abs(wanted_value)) + _ROUNDING


def _tolerance(key: str, wanted_value: float) -> float:
    """Return how far off a number may be. A share of nothing would be nothing: zero has a tolerance of its own."""
    at_least = {
        "x": (POSITION_M, 0.05),
        "y": (POSITION_M, 0.05),
        "duration_s": (0.5, 0.10),
        "pause_s": (PAUSE_S, 0.0),
    }
    if key in at_least:
        least, share = at_least[key]
        return max(least, share * wanted_value)
    share, of_zero = {"turned_deg": (0.03, 1.0), "path_m": (0.05, 0.05)}.get(key, (0.10, 0.01))
    return share * wanted_value or of_zero


_MAX_STEPS_LEFT_OUT_OF = 60
"""Longer plans are only compared whole: the number of ways to leave something out grows with the square."""


def misfit(meant: Meant, driven: Measured, profile: RobotProfile) -> tuple[str, ...]:
    """List what does not hold, for the plan that fits best; nothing where one of the plans was driven."""
    found = [
        tuple(_problems(wanted, driven))
        for plan in meant.plans
        for wanted in _wanted(plan.steps, meant, profile)
    ]
    return min(found, key=len, default=("this robot can do none of the plans",))


def fits_in_part(meant: Meant, driven: Measured, gap_count: int, profile: RobotProfile) -> bool:
    """Tell whether what was driven is one of the plans with up to `gap_count` stretches of its steps left out."""
    for plan in meant.plans:
        listed = list(expanded(plan.steps))
        if len(listed) > _MAX_STEPS_LEFT_OUT_OF:
            continue
        for kept in _left_out(listed, min(gap_count, 2)):
            if any(not any(_problems(wanted, driven)) for wanted in _wanted(kept, meant, profile)):
                return True
    return False


def _left_out(steps: list[Step], gap_count: int) -> Iterator[list[Step]]:
    """`steps` with one stretch left out, then with two: each way once."""
    seen: set[tuple[int, ...]] = set()
    stretches = list(itertools.combinations(range(len(steps) + 1), 2))
    for chosen in itertools.combinations_with_replacement(stretches, gap_count if len(steps) <= 12 else 1):
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
                yield replace(numbers, y=-numbers.y, turned_deg=-numbers.turned_deg)


def _problems(wanted: Ideal, driven: Measured) -> Iterator[str]:
    """List what was driven otherwise than a plan says. A tolerance is a least, or a share of what is wanted."""
    off_m = math.hypot(driven.x - wanted.x, driven.y - wanted.y)
    if off_m > max(0.06, 0.05 * math.hypot(wanted.x, wanted.y), 0.02 * wanted.path_m):
        yield f"it ended at ({driven.x:.2f}, {driven.y:.2f}), not ({wanted.x:.2f}, {wanted.y:.2f})"
    off_deg = abs(math.remainder(driven.turned_deg - wanted.turned_deg, 360))
    if not wanted.free_heading and off_deg > 5.0:
        yield f"its heading is {driven.turned_deg:.0f}°, not {wanted.turned_deg:.0f}°"
    slack_deg = max(5.0, 0.03 * wanted.rotation_deg)
    if not wanted.routed and abs(driven.turned_deg - wanted.turned_deg) > slack_deg:
        yield f"it turned {driven.turned_deg:.0f}°, not {wanted.turned_deg:.0f}°"
    if not wanted.routed and abs(driven.rotation_deg - wanted.rotation_deg) > slack_deg:
        yield f"it turned {driven.rotation_deg:.0f}° to either side, not {wanted.rotation_deg:.0f}°"
    if abs(driven.path_m - wanted.path_m) > max(0.06, 0.06 * wanted.path_m):
        yield f"its path is {driven.path_m:.2f} m, not {wanted.path_m:.2f} m"
    if abs(driven.pause_s - wanted.pause_s) > max(0.6, 0.10 * wanted.pause_s):
        yield f"it stood for {driven.pause_s:.1f} s, not {wanted.pause_s:.1f} s"
    for name, unit, is_, should in (
        ("speed", "m/s", driven.max_speed, wanted.max_speed),
        ("rate", "rad/s", driven.max_turn_rate, wanted.max_turn_rate),
    ):
        if should is not None and abs(is_ - should) > 0.12 * should:
            yield f"its top {name} is {is_:.2f} {unit}, not {should:.2f} {unit}"
