"""The ledger of measured turns: whatever is done, stopped, undone and done again, it leads to the measured poses."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chatrobot.core.geometry import Pose
from chatrobot.language.context import Context, Dialogue, RobotState
from chatrobot.language.ledger import Ledger, TurnRecord, Walk
from chatrobot.language.unclear import Unclear
from chatrobot.language.undo import Walked, redone, taken_back
from chatrobot.plan.context import LoweringContext
from chatrobot.plan.lowering import CoreWalk, PlannedMotion
from chatrobot.plan.split import Parts, Reached, split
from chatrobot.plan.steps import Arc, Drive, Face, Go, Plan, RawTwist, Repeat, Say, Step, Turn, Wait
from chatrobot.plan.text import format_plan
from chatrobot.plan.trajectory import RampedTwist
from chatrobot.robots.load import load_profile
from tests.language.dialogue_runner import conversation
from tests.language.profiles import MECANUM


@dataclass
class Robot:
    """An ideal robot, what it did, and the poses that undo and redo are to lead to."""

    pose: Pose = field(default_factory=Pose)
    turns: tuple[TurnRecord, ...] = ()
    before: list[tuple[Pose, Pose]] = field(default_factory=list)
    after: list[tuple[Pose, Pose]] = field(default_factory=list)
    has_undone: bool = False
    is_between: bool = False

    def context(self) -> Context:
        return Context(Dialogue(self.turns), RobotState(pose=self.pose))

    def drive(self, steps: tuple[Step, ...], share: float, walk: Walk | None = None) -> bool:
        """Drive that share of `steps`; whether that was all."""
        start, plan = self.pose, Plan(steps)
        parts, self.pose = driven(plan, start, share)
        outcome = "completed" if parts.remaining is None else "stopped"
        record = TurnRecord("…", outcome, plan, start, self.pose, parts.executed, parts.remaining, walk)  # type: ignore[arg-type]
        self.turns = (*self.turns, record)
        return parts.remaining is None

    def move(self, steps: tuple[Step, ...], share: float) -> None:
        start = self.pose
        self.drive(steps, share)
        if self.turns[-1].moved:
            self.before.append((start, self.pose))
            self.after.clear()
            self.has_undone = self.is_between = False

    def undo(self, share: float) -> None:
        if not self.before:
            with pytest.raises(Unclear):
                taken_back(self.context(), MECANUM, 1)
            return
        way = taken_back(self.context(), MECANUM, 1)
        self._walk(way, share, self.before, self.after, self.before[-1][0])

    def redo(self, share: float) -> None:
        way = redone(self.context(), MECANUM)
        if not self.has_undone or not (self.is_between or self.after):
            assert way is None
            return
        assert way is not None
        stack = self.before if self.is_between else self.after
        self._walk(way, share, stack, self.before, stack[-1][1])

    def _walk(
        self,
        way: Walked,
        share: float,
        stack: list[tuple[Pose, Pose]],
        to: list[tuple[Pose, Pose]],
        target: Pose,
    ) -> None:
        start = self.pose
        is_whole = self.drive(way.steps, share, way.walk)
        moved = self.turns[-1].moved
        if is_whole:
            assert_same(self.pose, target)
            to.append(stack.pop())
            self.is_between, self.has_undone = False, True
        elif moved:
            self.before.append(stack.pop())
            self.is_between = self.has_undone = True
        else:
            assert self.pose.distance_to(start) < 0.011


def driven(plan: Plan, start: Pose, share: float) -> tuple[Parts, Pose]:
    """The parts of a plan that is stopped after that share of its motions, and the pose then."""
    context = LoweringContext(MECANUM, start, start)
    items = [item for item in CoreWalk(plan, context) if isinstance(item, PlannedMotion)]
    at = share * len(items)
    if at >= len(items):
        return split(plan.steps, Reached(items[-1].number), context), items[-1].end
    item, part = items[int(at)], at - int(at)
    pose = item.start
    if isinstance(item.motion, RampedTwist):
        pose = item.start.moved(item.motion.twist, part * item.motion.hold_s)
    motions_done = sum(other.number == item.number for other in items[: int(at)])
    reached = Reached(item.number - 1, True, motions_done, part, item.start)
    return split(plan.steps, reached, LoweringContext(MECANUM, pose, start)), pose


def assert_same(pose: Pose, other: Pose) -> None:
    assert pose.distance_to(other) < 0.012
    assert abs(math.degrees(math.remainder(pose.yaw_rad - other.yaw_rad, 2.0 * math.pi))) < 0.7


extents = st.floats(0.1, 2.0)
steps = st.one_of(
    st.builds(Drive, extents, st.none(), st.sampled_from([0.0, math.pi, math.pi / 2, 0.7])),
    st.builds(Turn, st.floats(0.2, 7.0), st.none(), st.booleans()),
    st.builds(Arc, st.floats(0.3, 1.0), st.floats(0.2, 4.0), st.booleans(), st.booleans()),
    st.builds(RawTwist, st.floats(0.1, 0.5), st.floats(-0.2, 0.2), st.floats(-0.5, 0.5), extents),
    st.builds(Go, st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), st.none() | st.floats(-3.0, 3.0)),
    st.builds(Face, st.floats(-3.0, 3.0), st.just("odom")),
    st.just(Wait(1.0)),
    st.just(Say("hello")),
    st.builds(Repeat, st.integers(2, 3), st.builds(Drive, extents).map(lambda step: (step, Turn(0.5)))),
)
shares = st.one_of(st.just(1.0), st.floats(0.0, 0.99))
doings = st.one_of(
    st.tuples(st.just("move"), st.lists(steps, min_size=1, max_size=3).map(tuple), shares),
    st.tuples(st.just("undo"), st.just(()), shares),
    st.tuples(st.just("redo"), st.just(()), shares),
)


@settings(max_examples=150, deadline=None)
@given(st.lists(doings, min_size=1, max_size=12))
def test_undo_and_redo_lead_to_the_measured_poses_wherever_they_were_stopped(
    done: list[tuple[str, tuple[Step, ...], float]],
) -> None:
    robot = Robot()
    for what, way, share in done:
        if what == "move":
            robot.move(way, share)
        elif what == "undo":
            robot.undo(share)
        else:
            robot.redo(share)
    for _ in range(len(robot.before)):
        robot.undo(1.0)
    assert not robot.before


def turn(start: Pose, end: Pose, *steps: Step, walk: Walk | None = None) -> TurnRecord:
    plan = Plan(steps)
    return TurnRecord("…", "completed", plan, start, end, plan, walk=walk)


FORWARD = turn(Pose(), Pose(1.0), Drive(1.0))
AHEAD = Pose(1.0)


def back_from(pose: Pose, *turns: TurnRecord) -> tuple[Step, ...]:
    return taken_back(Context(Dialogue(turns), RobotState(pose=pose)), MECANUM, 1).steps


def test_a_way_back_that_leads_a_little_off_is_ended_with_what_is_missing() -> None:
    assert back_from(AHEAD, FORWARD) == (Drive(1.0, direction_rad=math.pi),)
    assert back_from(Pose(1.0, 0.03), FORWARD)[1:] == (Go(0.0, 0.0, 0.0),)


def test_a_base_that_steers_drives_no_circle_for_a_centimetre() -> None:
    context = Context(Dialogue((FORWARD,)), RobotState(pose=Pose(1.0, 0.03)))
    back = taken_back(context, load_profile("wheeltec_mini_akm"), 1).steps
    assert back == (Drive(1.0, direction_rad=math.pi),)


def test_a_way_back_that_leads_elsewhere_is_no_way_back() -> None:
    assert back_from(Pose(1.0, 0.5), FORWARD) == (Go(0.0, 0.0, 0.0),)
    assert back_from(Pose(1.0, 0.0, 1.0), FORWARD) == (Go(0.0, 0.0, 0.0),)


def test_what_moved_nothing_is_no_entry() -> None:
    still = turn(AHEAD, AHEAD, Wait(1.0), Say("hello"), Go(1.0, 0.0))
    assert len(Ledger([FORWARD, still]).done) == 1


def test_a_turn_that_moved_the_robot_by_no_plan_is_an_entry() -> None:
    program = TurnRecord("run the patrol", "completed", None, AHEAD, Pose(2.0, 1.0))
    assert back_from(Pose(2.0, 1.0), FORWARD, program) == (Go(1.0, 0.0, 0.0),)


def test_an_undo_of_what_has_been_forgotten_is_forgotten_too() -> None:
    ledger = Ledger([turn(AHEAD, Pose(), Drive(1.0, direction_rad=math.pi), walk=Walk("undo"))])
    assert ledger.done == []
    assert ledger.redoes() is None


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("undo at 0.1 m/s", "turn right 90 deg\ndrive 1 m back at 0.1 m/s"),
        ("undo slowly", "turn right 90 deg at 0.3 rad/s\ndrive 1 m back at 0.15 m/s"),
        ("undo half of that", ""),
        ("undo 30 cm", ""),
    ],
)
def test_how_fast_to_undo_is_heeded_and_how_much_is_asked_about(said: str, plan: str) -> None:
    meant = conversation("forward 1 m, then turn left 90 degrees").say(said)
    assert (format_plan(meant.plan) if meant.plan else "") == plan


@pytest.mark.parametrize("said", ["undo everything", "全部撤销", "撤销所有动作"])
def test_everything_is_one_undo_and_one_redo(said: str) -> None:
    talk = conversation("forward 1 m", "turn left 90 degrees", "undo", "forward 1 m", said)
    assert talk.track.pose.x_m == pytest.approx(0.0, abs=1e-6)
    talk.say("redo")
    assert talk.track.pose.x_m == pytest.approx(2.0)


def test_a_way_back_is_a_turn_of_its_own() -> None:
    talk = conversation("forward 1 m", "go back the same way", "undo")
    assert talk.track.pose.x_m == pytest.approx(1.0)


@pytest.mark.parametrize("said", ["redo that twice", "undo the undo", "恢复"])
def test_what_only_an_undo_explains_is_asked_about_without_one(said: str) -> None:
    before = ("forward 1 m", "undo") if said == "redo that twice" else ("forward 1 m",)
    assert conversation(*before).say(said).outcome == "unclear"
