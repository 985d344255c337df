"""A plan that was stopped is split in two: what was executed and what remains make up the whole."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from chatrobot.core.geometry import ORIGIN, Pose, Twist
from chatrobot.plan.base import Step
from chatrobot.plan.context import LoweringContext
from chatrobot.plan.lowering import CoreWalk, PlannedMotion
from chatrobot.plan.primitive import Primitive, register, unregister
from chatrobot.plan.reader import LineReader
from chatrobot.plan.split import Parts, Reached, split
from chatrobot.plan.steps import (
    Arc,
    Drive,
    Face,
    Go,
    Plan,
    RawTwist,
    Remember,
    Repeat,
    Say,
    Turn,
    Wait,
)
from chatrobot.plan.text import format_plan, parse_plan
from chatrobot.plan.trajectory import Pause, RampedTwist, Segment
from tests.plan.robots import MECANUM

START = Pose(1.0, -0.5, 0.3)

lengths = st.floats(0.05, 3.0)
degrees = st.floats(5.0, 400.0).map(math.radians)
bearings = st.floats(-3.0, 3.0)
coordinates = st.floats(-2.0, 2.0)
leaves = st.one_of(
    st.builds(Drive, lengths, st.none(), bearings),
    st.builds(Drive, st.none(), lengths, bearings),
    st.builds(Turn, degrees, st.none(), st.booleans()),
    st.builds(Turn, st.none(), lengths, st.booleans()),
    st.builds(Arc, st.floats(0.2, 2.0), degrees, st.booleans(), st.booleans()),
    st.builds(RawTwist, coordinates, coordinates, coordinates, st.floats(0.1, 2.0)),
    st.builds(Go, coordinates, coordinates, st.none() | bearings, st.sampled_from(["odom", "start"])),
    st.builds(Face, bearings, st.sampled_from(["odom", "start"])),
    st.builds(Wait, st.floats(0.1, 5.0)),
    st.just(Say("hello")),
    st.just(Remember("here")),
)
blocks = st.recursive(
    leaves,
    lambda inner: st.builds(Repeat, st.integers(1, 4), st.lists(inner, min_size=1, max_size=3).map(tuple)),
    max_leaves=6,
)
plans = st.lists(blocks, min_size=1, max_size=4).map(lambda steps: Plan(tuple(steps)))


def driven(plan: Plan | None, start: Pose, plan_start: Pose | None = None) -> list[PlannedMotion]:
    """The motions of `plan` from `start`, all of which are possible."""
    if plan is None:
        return []
    items = list(CoreWalk(plan, LoweringContext(MECANUM, start, plan_start or start)))
    motions = [item for item in items if isinstance(item, PlannedMotion)]
    assert len(motions) == len(items)
    return motions


def end_of(motions: list[PlannedMotion], start: Pose) -> Pose:
    return motions[-1].end if motions else start


def stopped_in(plan: Plan, item: PlannedMotion, share: float, motions_done: int) -> tuple[Pose, Parts]:
    """Where the robot stands when `share` of that motion is driven, and the two parts."""
    pose = item.start
    if isinstance(item.motion, RampedTwist):
        pose = item.start.moved(item.motion.twist, share * item.motion.hold_s)
    first = item.start if motions_done == 0 else START
    reached = Reached(item.number - 1, True, motions_done, share, first)
    return pose, split(plan.steps, reached, LoweringContext(MECANUM, pose, START))


def moments(plan: Plan) -> Iterator[tuple[PlannedMotion, int]]:
    """Every motion of the plan, and how many of its step come before it."""
    before = 0
    for item in driven(plan, START):
        before = 0 if item.first else before + 1
        if not isinstance(item.motion, type(None)):
            yield item, before


def length_m(motions: list[PlannedMotion]) -> float:
    return sum(
        m.motion.twist.speed_mps * m.motion.hold_s for m in motions if isinstance(m.motion, RampedTwist)
    )


def waits_s(motions: list[PlannedMotion]) -> float:
    return sum(m.motion.duration_s for m in motions if isinstance(m.motion, Pause))


def assert_same_pose(pose: Pose, other: Pose, within_m: float = 2e-3) -> None:
    assert pose.distance_to(other) < within_m
    assert abs(math.remainder(pose.yaw_rad - other.yaw_rad, 2.0 * math.pi)) < 2e-3


@settings(max_examples=150)
@given(plans, st.data())
def test_driving_what_was_executed_and_then_what_remains_is_driving_the_whole(
    plan: Plan, data: st.DataObject
) -> None:
    choices = [moment for moment in moments(plan) if isinstance(moment[0].motion, (RampedTwist, Pause))]
    if not choices:
        return
    item, motions_done = data.draw(st.sampled_from(choices))
    share = data.draw(st.floats(0.0, 1.0))
    pose, parts = stopped_in(plan, item, share, motions_done)
    if isinstance(item.step, Go):
        # Nearer than 1 cm a `go to` is there already, and a short leg leads to no exact heading.
        assume(not 0.0 < pose.distance_to(item.start) < 0.011)
        assume(not 0.0 < pose.distance_to(item.end) < 0.15)

    executed = driven(parts.executed, START)
    stand = end_of(executed, START)
    # On a curve a hundredth of a degree, or a millimetre of way, may be told as none.
    assert_same_pose(stand, pose, within_m=5e-3)
    remaining = driven(parts.remaining, stand)
    whole = driven(plan, START)
    assert_same_pose(end_of(remaining, stand), end_of(whole, START), within_m=5e-3)
    if not any(isinstance(moment.step, Go) for moment in whole):
        assert length_m(executed) + length_m(remaining) == pytest.approx(length_m(whole), abs=1e-4)
    assert waits_s(executed) + waits_s(remaining) == pytest.approx(waits_s(whole), abs=1e-4)
    for part in (parts.executed, parts.remaining):
        assert part is None or parse_plan(format_plan(part)) == part


def parts_at(steps_text: str, reached: Reached, pose: Pose = START) -> tuple[str, str]:
    parts = split(parse_plan(steps_text).steps, reached, LoweringContext(MECANUM, pose, START))
    return tuple(format_plan(part) if part else "" for part in (parts.executed, parts.remaining))  # type: ignore[return-value]


@pytest.mark.parametrize(
    ("plan", "reached", "executed", "remaining"),
    [
        ("drive 2 m", Reached(0, True, 0, 0.61), "drive 1.22 m", "drive 0.78 m"),
        ("drive 2 m", Reached(0, True, 0, 0.0), "", "drive 2 m"),
        ("drive 2 m", Reached(1), "drive 2 m", ""),
        ("drive 2 m\nturn left 90 deg", Reached(1), "drive 2 m", "turn left 90 deg"),
        ("drive 2 m", Reached(), "", "drive 2 m"),
        ("turn left 90 deg", Reached(0, True, 0, 1 / 3), "turn left 30 deg", "turn left 60 deg"),
        ("arc left 90 deg radius 1 m", Reached(0, True, 0, 0.5), *["arc left 45 deg radius 1 m"] * 2),
        ("drive 4 s back", Reached(0, True, 0, 0.25), "drive 1 s back", "drive 3 s back"),
        ("twist 0.2 0 0.5 for 3 s", Reached(0, True, 0, 0.5), *["twist 0.2 0 0.5 for 1.5 s"] * 2),
        ("wait 10 s", Reached(0, True, 0, 0.4), "wait 4 s", "wait 6 s"),
        ('say "hello"', Reached(0, True, 0, 0.5), "", 'say "hello"'),
        (
            "repeat 4\n  drive 1 m\n  turn left 90 deg\nend",
            Reached(5, True, 0, 0.5),
            "repeat 2\n  drive 1 m\n  turn left 90 deg\nend\ndrive 1 m\nturn left 45 deg",
            "turn left 45 deg\ndrive 1 m\nturn left 90 deg",
        ),
        (
            "drive forward until obstacle within 0.5 m",
            Reached(1, ended_early={1: 0.1}),
            "drive 2 m",
            "",
        ),
        (
            "drive forward until obstacle within 0.5 m",
            Reached(0, True, 0, 0.1),
            "drive 2 m",
            "drive 18 m until obstacle within 0.5 m",
        ),
        (
            "repeat 2\n  drive forward until obstacle within 0.5 m\n  turn left 90 deg\nend",
            Reached(4, ended_early={1: 0.1, 3: 0.2}),
            "drive 2 m\nturn left 90 deg\ndrive 4 m\nturn left 90 deg",
            "",
        ),
        ("drive 2 m", Reached(0, True, 0, 0.0003), "", "drive 2 m"),
        ("drive 2 m", Reached(0, True, 0, 0.9999), "drive 2 m", ""),
    ],
)  # fmt: skip
def test_a_plan_is_split_where_it_was_left_off(
    plan: str, reached: Reached, executed: str, remaining: str
) -> None:
    assert parts_at(plan, reached) == (executed, remaining)


def test_a_way_to_a_point_is_split_at_the_pose_that_was_reached() -> None:
    executed, remaining = parts_at(
        'go to 3 1 named "kitchen"', Reached(0, True, 1, 0.5), Pose(2.0, 0.25, 0.5)
    )
    assert executed == "go to 2 0.25 facing 28.65 deg"
    assert remaining == 'go to 3 1 named "kitchen"'


def test_what_remains_does_not_count_from_where_it_begins() -> None:
    _, remaining = parts_at("drive 1 m\ngo to 1 0 from start\nface 0 deg from start", Reached(1))
    resolved = START.compose(Pose(1.0, 0.0, 0.0))
    assert remaining.splitlines()[0] == f"go to {round(resolved.x_m, 6)} {round(resolved.y_m, 6)}"
    assert remaining.splitlines()[1] == f"face {round(math.degrees(START.yaw_rad), 6)} deg"


def test_a_long_repeat_whose_rounds_differ_is_told_by_its_end() -> None:
    plan = "repeat 600\n  drive forward until obstacle within 0.5 m\n  turn left 90 deg\nend"
    early = dict.fromkeys(range(1, 1200, 2), 0.1)
    executed, remaining = parts_at(plan, Reached(1200, ended_early=early), Pose(1.0, 2.0, 0.0))
    assert (executed, remaining) == ("go to 1 2 facing 0 deg", "")


@dataclass(frozen=True)
class Hop(Step):
    """A third party's: forward, wait, and a turn."""

    kind: Literal["hop"] = "hop"


class HopPrimitive(Primitive[Hop]):
    kind = verb = "hop"
    step_type = Hop
    usage = "hop"
    help = "Hop."
    examples = ("hop",)

    def parse(self, line: LineReader) -> Hop:
        line.finish("the end of the line")
        return Hop()

    def format(self, step: Hop) -> str:  # noqa: ARG002
        return "hop"

    def lower(self, step: Hop, context: LoweringContext) -> list[RampedTwist | Pause]:  # noqa: ARG002
        limits = context.profile.limits
        ahead, turn = Twist(0.2), Twist(0.0, 0.0, 0.5)
        return [RampedTwist.within(limits, ahead, 2.0), Pause(1.0), RampedTwist.within(limits, turn, 2.0)]


def test_a_step_of_a_third_party_is_split_at_its_core_motions() -> None:
    primitive = HopPrimitive()
    register(primitive)
    try:
        assert parts_at("hop", Reached(0, True, 0, 0.5)) == (
            "twist 0.2 0 0 for 1 s",
            "twist 0.2 0 0 for 1 s\nwait 1 s\ntwist 0 0 0.5 for 2 s",
        )
        assert parts_at("hop", Reached(0, True, 2, 0.25)) == (
            "twist 0.2 0 0 for 2 s\nwait 1 s\ntwist 0 0 0.5 for 0.5 s",
            "twist 0 0 0.5 for 1.5 s",
        )
        assert parts_at("hop\nhop", Reached(1)) == ("hop", "hop")
    finally:
        unregister(primitive)


@given(
    st.floats(-1.0, 1.0),
    st.floats(-1.0, 1.0),
    st.floats(-2.0, 2.0),
    st.floats(0.1, 20.0),
    st.floats(0.0, 1.0),
)
def test_progress_is_read_back_from_a_pose(
    vx: float, vy: float, wz: float, hold_s: float, share: float
) -> None:
    if max(abs(vx), abs(vy)) < 0.01 and abs(wz) < 0.01:
        return
    segment = Segment(RampedTwist.within(MECANUM.limits, Twist(vx, vy, wz), hold_s), START)
    assert segment.progress_at(segment.pose_at_progress(share * hold_s)) == pytest.approx(
        share * hold_s, abs=1e-5
    )


def test_progress_off_the_path_is_that_of_the_nearest_pose() -> None:
    straight = Segment(RampedTwist.within(MECANUM.limits, Twist(0.5), 4.0), ORIGIN)
    assert straight.progress_at(Pose(1.0, 0.02, 0.01)) == pytest.approx(2.0)
    circle = Segment(RampedTwist.within(MECANUM.limits, Twist(0.5, 0.0, 0.25), 30.0), ORIGIN)
    ahead = circle.pose_at_progress(26.0)
    off = Pose(ahead.x_m, ahead.y_m, ahead.yaw_rad + 0.05)
    assert circle.progress_at(off) == pytest.approx(26.0, abs=1e-6)
