"""What became of an utterance: correct, wrong or abstained. Pure: true poses and outcomes in, a verdict out.

* correct: everything that is expected holds, as measured, and no turn that counts ended as `failed`.
* abstained: the robot asked back or declined (`unclear`, `refused`) where that was not expected, and did not move.
* wrong: everything else. It moved otherwise than meant or when it must not, said it was done without having moved,
  or answered in a way that misleads (answered where it had to ask back or refuse, acted where it had to answer).

Only the state after the last turn counts, measured from the start of the dialogue; a turn with an `expect` of its
own is judged when it ends. `motion: none` and `answer` speak of their own turn alone.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from chatrobot.cli.eval.corpus import Expect, Item, Meant
from chatrobot.cli.eval.judge_plan import fits_in_part, misfit
from chatrobot.cli.eval.measure import Measured, Sample, has_moved, measure
from chatrobot.core.events import Outcome
from chatrobot.robots.profile import RobotProfile

Kind = Literal["correct", "wrong", "abstained"]

POSITION_M, POSITION_SHARE = 0.05, 0.05
HEADING_DEG = 4.0
TURNED_SHARE, TURNED_ZERO_DEG = 0.03, 1.0
PATH_SHARE, PATH_ZERO_M = 0.05, 0.05
DURATION_S, DURATION_SHARE = 0.5, 0.10
PAUSE_S = 0.5
SPEED_SHARE, SPEED_ZERO = 0.10, 0.01
CLOSED_M = 0.1
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
    """The verdict on one item; `records` has one entry a turn. A plan is what it is on the robot of `profile`."""
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
    """The verdict on one turn. `so_far` is measured from the start of the dialogue to the end of this turn."""
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
        actual, slack = {
            "x": (measured.x, POSITION_M),
            "y": (measured.y, POSITION_M),
            "yaw": (measured.turned_deg, HEADING_DEG),
        }[axis]
        if sign != ("0" if abs(actual) <= slack else "+" if actual > 0.0 else "-"):
            yield f"{axis} is {actual:.3f}, not {sign}"
    if expect.closed and measured.distance_m > CLOSED_M + _ROUNDING:
        yield f"it ended {measured.distance_m:.3f} m from where it began"


def _holds(key: str, wanted: float, actual: float) -> bool:
    if key == "stays_within_m":
        return actual <= wanted + _ROUNDING
    if key == "yaw_deg":
        return abs(math.remainder(actual - wanted, 360.0)) <= HEADING_DEG + _ROUNDING
    return abs(actual - wanted) <= _tolerance(key, abs(wanted)) + _ROUNDING


def _tolerance(key: str, wanted: float) -> float:
    """How far off a number may be. A share of nothing would be nothing: zero has a tolerance of its own."""
    if key in ("x", "y"):
        return max(POSITION_M, POSITION_SHARE * wanted)
    if key == "turned_deg":
        return TURNED_SHARE * wanted or TURNED_ZERO_DEG
    if key == "path_m":
        return PATH_SHARE * wanted or PATH_ZERO_M
    if key == "duration_s":
        return max(DURATION_S, DURATION_SHARE * wanted)
    if key == "pause_s":
        return PAUSE_S
    return SPEED_SHARE * wanted or SPEED_ZERO
